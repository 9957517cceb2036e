"""Steps of a run: what each leaves behind, what is in memory, and what an error loses."""

from __future__ import annotations

import gc
import inspect
import json
import weakref
from pathlib import Path
from typing import Any

import pytest
from small_machine import small_machine

from camwright.geometry.errors import ResultError
from camwright.pipeline import iteration, run
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.recomputation import recompute
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.run import CaseRun, run_case
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve

CASES = Path(__file__).parents[2] / "cases"
QUICK = {"depth": Tier.SCREENING, "jobs": 1}


@pytest.fixture(scope="module")
def case() -> Case:
    return read_case(CASES / "papers" / "eccentric.toml").with_positions(36)


@pytest.fixture(scope="module")
def whole(case: Case, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Files of a run in one call, without its clock and what depends on it."""
    out = tmp_path_factory.mktemp("whole") / "run"
    run_case(case, out, **QUICK)
    return contents(out)


def screened(case: Case) -> Trial:
    contour = case.contour(cam_lift(case, engine_torques(case)))
    return solve(case, contour, tier=Tier.SCREENING)


def contents(out: Path) -> dict[str, bytes]:
    files = {
        path.relative_to(out).as_posix(): path.read_bytes()
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.name not in ("run.json", "signoff.json")
    }
    summary = json.loads((out / "run.json").read_text())
    kept = {key: value for key, value in summary.items() if key not in ("timings_s", "started")}
    return files | {"run.json": json.dumps(kept).encode()}


@pytest.mark.parametrize("function", [run_case, CaseRun, CaseRun.solve, recompute])
def test_no_step_takes_a_callable(function: Any) -> None:
    for each in inspect.signature(function, eval_str=False).parameters.values():
        assert "Callable" not in str(each.annotation), each
    assert not any("Callable" in str(each) for each in run.RunOptions.__annotations__.values())


def test_the_options_of_a_call_are_those_of_the_steps() -> None:
    stated = inspect.signature(CaseRun).parameters
    assert set(run.RunOptions.__annotations__) == set(stated) - {"case", "out"}


def test_the_steps_write_what_one_call_does(
    case: Case, whole: dict[str, bytes], tmp_path: Path
) -> None:
    out = tmp_path / "run"
    with CaseRun(case, out, **QUICK) as made:
        trial = made.solve()
        made.write()
        assert made.certify() is trial
        assert made.finish().summary["final_trial"] == trial.number
    assert contents(out) == whole


def test_a_trial_that_is_solved_is_not_solved_again(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trial = screened(case)
    monkeypatch.setattr(run, "trials", None)
    with CaseRun(case, tmp_path / "run", **QUICK) as made:
        assert made.solve(trial) is trial
        made.write()
        made.certify()
        assert made.finish().summary["statement"].startswith("one trial, ")


@pytest.mark.parametrize("steps", ["write", "finish", "solve finish", "solve draft", "certify"])
def test_steps_out_of_order_are_refused(case: Case, tmp_path: Path, steps: str) -> None:
    with (
        pytest.raises(RuntimeError, match="solve, write, certify and finish"),
        CaseRun(case, tmp_path / "run", **QUICK) as made,
    ):
        for step in steps.split():
            getattr(made, step)()
    assert not (tmp_path / "run").exists()


def test_a_certified_run_is_not_finished_without_its_certificate(
    tmp_path: Path, case: Case
) -> None:
    with (
        pytest.raises(RuntimeError, match="solve, write, certify and finish"),
        CaseRun(case, tmp_path / "run", jobs=1) as made,
    ):
        made.solve(screened(case))
        made.write()
        made.finish()


def test_a_run_that_is_left_is_no_run_yet(case: Case, tmp_path: Path) -> None:
    with CaseRun(case, tmp_path / "run", **QUICK) as made:
        made.solve()
    assert [each.name for each in tmp_path.iterdir()] == [".run.partial"]
    run_case(case, tmp_path / "run", resume=True, **QUICK)
    assert [each.name for each in tmp_path.iterdir()] == ["run"]


def test_pages_are_drawn_from_a_whole_summary(case: Case, tmp_path: Path) -> None:
    """The solution, which takes most of the memory, is released before."""
    with CaseRun(case, tmp_path / "run", **QUICK) as made:
        held = weakref.ref(made.solve().solution)
        made.write()
        made.certify()
        assert held() is not None
        folder = made.draft()
        gc.collect()
        assert held() is None
        assert json.loads((folder / "run.json").read_text())["screen"] in ("open", "fail")
        made.finish()
    assert "report" in read_run(tmp_path / "run").summary["timings_s"]


def solutions_watched(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Number of solutions of earlier trials that live where the next is solved."""
    known: list[weakref.ref[Solution]] = []
    alive: list[int] = []
    original = iteration.solve

    def watched(*arguments: Any, **options: Any) -> Trial:
        gc.collect()
        alive.append(sum(each() is not None for each in known))
        trial = original(*arguments, **options)
        known.append(weakref.ref(trial.solution))
        return trial

    monkeypatch.setattr(iteration, "solve", watched)
    return alive


def test_trials_of_smoothers_hold_one_solution(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alive = solutions_watched(monkeypatch)
    made = run_case(parse_case(small_machine("small")), tmp_path / "run", positions=36, **QUICK)
    assert made.summary["trials"] == len(alive) > 1
    assert set(alive) == {0}


def test_trials_of_a_synthesis_hold_the_best_besides(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alive = solutions_watched(monkeypatch)
    press = read_case(CASES / "machines" / "press.toml").with_positions(72)
    values = {"coefficients": 24, "starts": 1, "corners": False, "correction_margin": 0.0}
    press = with_values(press, {f"smoothing.{name}": value for name, value in values.items()})
    made = run_case(press, tmp_path / "run", **QUICK)
    assert made.summary["trials"] == len(alive) > 1
    assert alive[0] == 0 and max(alive) == 1
    folders = [f"trial_{number}" for number in range(1, len(alive) + 1)]
    assert sorted(each.name for each in made.path.glob("trial_*")) == folders


def test_an_error_of_a_file_discards_a_run_without_pieces(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise ResultError("No space left on device")

    monkeypatch.setattr(run, "write_trial_files", full)
    with pytest.raises(ResultError, match="No space left"):
        run_case(case, tmp_path / "run", **QUICK)
    assert list(tmp_path.iterdir()) == []

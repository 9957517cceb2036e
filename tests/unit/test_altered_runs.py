"""A run that is not as recorded is read by no command, and a run in its place deletes no file of
the user.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from small_run import check, small_case, summary, write_run, write_trial

import camwright
from camwright.geometry.errors import AlteredError, ResultError
from camwright.pipeline.base.files import file_hashes, write_atomic
from camwright.pipeline.commands.terminal import ALTERED, PASSED
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.folder_exchange import amended, complete_exchange
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.studies.batch.study_folder import StudyFolder

Command = Callable[..., tuple[int, str, str]]

RESULTS = ("trial_1/6_checks.json", "trial_1/5_cycle.csv", "1_torque.csv", "case.toml", "run.json")
PAGES = ("8_report.html", "figures/lift.png", "workshop/drawing.pdf", "trial_1/5_cycle.xlsx")
READERS = (
    ("report", "{run}"),
    ("inspect", "{run}", "{points}"),
    ("inspect", "{run}", "{points}", "--out", "{other}"),
    ("contact", "deck", "{run}", "--angle", "10"),
    ("contact", "deck", "{run}", "--angle", "10", "--out", "{other}"),
    ("check", "{sound}", "--baseline", "{run}"),
    ("check", "{run}"),
    ("run", "{case}", "--out", "{run}", "--resume"),
)


@pytest.fixture
def run(tmp_path: Path) -> Path:
    out = write_run(tmp_path / "run")
    with amended(out) as place:
        for name in PAGES:
            write_atomic(place / name, "drawn")
    return out


def contents(folder: Path) -> dict[str, str]:
    return file_hashes(folder, lambda _: True)


def alter(file: Path) -> None:
    """A change of one digit or space that no reader notices."""
    text = file.read_text()
    file.write_text(text.replace("1", "2", 1) if file.suffix == ".csv" else f"{text}\n")


@pytest.mark.parametrize("line", READERS, ids=" ".join)
def test_an_altered_run_is_named_and_nothing_is_written(
    run: Path, tmp_path: Path, line: tuple[str, ...], command: Command
) -> None:
    names = {
        "run": run, "case": tmp_path / "case.toml", "points": tmp_path / "points.csv",
        "other": tmp_path / "other", "sound": write_run(tmp_path / "sound"),
    }  # fmt: skip
    names["case"].write_text(small_case().to_toml())
    names["points"].write_text("x_mm,y_mm\n1,2\n")
    arguments = [each.format(**names) for each in line]
    for name in RESULTS:
        kept = (run / name).read_bytes()
        alter(run / name)
        before = contents(tmp_path)
        code, said, errors = command(*arguments)
        assert (code, said) == (ALTERED, ""), name
        assert f"{run / name}: was changed since the sign-off" in errors
        assert contents(tmp_path) == before
        (run / name).write_bytes(kept)
    (run / "signoff.json").unlink()
    assert command(*arguments)[0] == ALTERED


def test_the_python_interface_refuses_an_altered_run(run: Path) -> None:
    assert camwright.read_run(run).verdict == "pass"
    alter(run / "trial_1" / "5_cycle.csv")
    before = contents(run)
    for read in (camwright.read_run, camwright.report):
        with pytest.raises(AlteredError, match=r"5_cycle\.csv: was changed"):
            read(run)
    assert contents(run) == before


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_no_result(run: Path, name: str, command: Command) -> None:
    """Without or with another page the run is read; `check` names it until it is drawn again."""
    for change in (lambda: (run / name).write_text("edited"), (run / name).unlink):
        change()
        assert camwright.read_run(run).verdict == "pass"
        assert command("check", run)[0] == ALTERED
        with amended(run) as place:
            write_atomic(place / name, "drawn")
        assert signoff.changes(run) == []
        assert command("check", run)[0] == PASSED


def test_a_page_among_the_inputs_is_one(run: Path) -> None:
    assert signoff.Difference("inputs/torque.xlsx", "was changed").of_results
    assert not signoff.Difference("workshop/contour.xlsx", "was changed").of_results
    assert signoff.Difference("workshop/contour.dxf", "was changed").of_results


# --- the same run again

OF_THE_USER = ("workshop/notes.txt", "trial_1/own.csv", "trial_1/a/b/c", "figures/.hidden")
OF_OTHER_COMMANDS = ("inspection/deviation.csv", "exports/loads_010.000.inp")


@pytest.mark.parametrize("replace", [False, True])
@pytest.mark.parametrize("name", OF_THE_USER)
def test_no_file_of_the_user_is_deleted(run: Path, name: str, replace: bool) -> None:
    write_atomic(run / name, "mine")
    before = contents(run)
    with pytest.raises(ResultError, match=f"holds {name}, which no run wrote"):
        RunFolder(run, small_case(), replace=replace)
    assert contents(run) == before
    assert (run / name).read_text() == "mine"
    assert [each.name for each in run.parent.iterdir()] == ["run"]


def test_an_inspection_and_a_deck_are_deleted_by_replace_alone(run: Path) -> None:
    for name in OF_OTHER_COMMANDS:
        with amended(run) as place:
            write_atomic(place / name, "made")
        before = contents(run)
        with pytest.raises(ResultError, match=f"holds {name}, .*--replace deletes it"):
            RunFolder(run, small_case())
        assert contents(run) == before
        again(run, replace=True)
        assert not (run / name).exists()


@pytest.mark.parametrize("name", ["case.toml", "trial_1/5_cycle.csv", "8_report.html"])
def test_a_changed_file_is_deleted_by_replace_alone(run: Path, name: str) -> None:
    (run / name).write_text("edited")
    with pytest.raises(ResultError, match=f"holds {name}, .*--replace deletes it"):
        RunFolder(run, small_case())
    assert (run / name).read_text() == "edited"
    again(run, replace=True)
    assert signoff.changes(run) == []


def test_without_a_record_nothing_is_deleted(run: Path) -> None:
    (run / "signoff.json").unlink()
    for replace in (False, True):
        with pytest.raises(ResultError, match=r"holds no signoff\.json"):
            RunFolder(run, small_case(), replace=replace)


def again(run: Path, *, replace: bool) -> None:
    with RunFolder(run, small_case(), replace=replace) as folder:
        write_trial(folder, [check()])
        folder.finish(summary())


@pytest.mark.parametrize("name", [*OF_THE_USER, "signoff.intoto.jsonl"])
def test_what_is_added_while_a_run_is_solved_is_not_deleted(run: Path, name: str) -> None:
    with pytest.raises(ResultError, match=r"holds"), RunFolder(run, small_case()) as folder:
        write_trial(folder, [check()])
        write_atomic(run / name, "mine")
        folder.finish(summary())
    assert (run / name).read_text() == "mine"
    assert run_reader.read_run(run).verdict == "pass"


def test_what_is_added_after_a_kill_is_not_deleted(run: Path, tmp_path: Path) -> None:
    """A complete run waits in `.run.partial` until the file is moved."""
    write_run(tmp_path / "other", status="fail").rename(tmp_path / ".run.partial")
    write_atomic(run / OF_THE_USER[0], "mine")
    complete_exchange(run)
    assert (run / OF_THE_USER[0]).read_text() == "mine"
    (run / OF_THE_USER[0]).unlink()
    complete_exchange(run)
    assert run_reader.read_run(run).verdict == "fail"


@pytest.mark.parametrize(
    "name",
    ["runs/notes.txt", "runs/mine/a.csv", "runs/a/workshop/own.txt", "runs/a/inspection/x.csv",
     "shards/notes.txt", "timings/notes.txt"],
)  # fmt: skip
def test_a_resumed_study_deletes_no_file_of_the_user(tmp_path: Path, name: str) -> None:
    with StudyFolder(tmp_path / "study", resume=False) as study:
        study.write_inputs("x = 1\n", ())
    write_run(study.path / "runs" / "a")
    with StudyFolder(study.path, resume=True):
        pass
    write_atomic(study.path / name, "mine")
    with (
        pytest.raises(ResultError, match=f"holds {name.replace('mine/a.csv', 'mine/')}"),
        StudyFolder(study.path, resume=True),
    ):
        pass
    assert (study.path / name).read_text() == "mine"


def test_a_run_is_reported_while_it_is_written_and_then_only_as_recorded(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "run", small_case()) as folder:
        write_trial(folder, [check()])
        folder.write_summary(summary())
        assert camwright.report(folder.path, []) == {}
        folder.finish(summary())
    (tmp_path / "run" / "signoff.json").unlink()
    write_atomic(tmp_path / "run" / ".state.json", "{}")
    with pytest.raises(AlteredError, match=r"signoff\.json"):
        camwright.report(tmp_path / "run", [])

"""`camwright design machine`: tables to cases that pass, or a relaxation that does, as printed.

The tables are of nine machines that the search was not tuned on, see `torque_tables`. Each is
designed once; a run by finite elements is without page and stress fields, on which no verdict
rests.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from record_validation import schema_errors
from torque_tables import MACHINES, write_table

from camwright.pipeline.base.progress import SILENT
from camwright.pipeline.base.worker_processes import crew
from camwright.pipeline.cli import run_line
from camwright.pipeline.commands.machine_command import machine
from camwright.pipeline.commands.run_command import run
from camwright.pipeline.commands.terminal import EXIT_CODE, FAILED, PASSED
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.results.run_reader import read_verdict
from camwright.pipeline.search.machine.candidate_search import candidates
from camwright.pipeline.search.machine.synthesised_points import PointStudy, drafts, solved_front
from camwright.pipeline.search.machine.torque_task import task_of

pytestmark = pytest.mark.slow

Designed = Callable[[str], tuple[int, Path]]


@pytest.fixture(scope="module")
def designed(tmp_path_factory: pytest.TempPathFactory) -> Designed:
    """Exit code and case file of the design of a table, made once."""
    folder, known = tmp_path_factory.mktemp("designs"), dict[str, tuple[int, Path]]()

    def made(name: str) -> tuple[int, Path]:
        if name not in known:
            out = folder / f"{name}.toml"
            table = write_table(folder, name)
            known[name] = machine(table, options={"speed": MACHINES[name].speed}, out=out), out
        return known[name]

    return made


def record_of(out: Path) -> dict[str, Any]:
    text = (out.with_name(f"{out.stem}_design") / "design.json").read_text(encoding="utf-8")
    document: dict[str, Any] = json.loads(text)
    assert schema_errors("design", document) == []
    return document


def passes_by_finite_elements(case: Path) -> bool:
    folder = case.parent / "runs" / case.stem
    run(case, out=folder, no_report=True, fields="none", replace=folder.exists())
    return EXIT_CODE[read_verdict(folder)["verdict"]] == PASSED


def passes_as_printed(command: str) -> bool:
    """Whether a command line of `design` finds a case, and that passes by finite elements."""
    words = shlex.split(command)
    assert words[:3] == ["camwright", "design", "machine"]
    out = Path(words[-1])
    return run_line(words[1:]) == PASSED and passes_by_finite_elements(out)


def passes_by_closed_forms(out: Path, name: str, options: dict[str, str]) -> bool:
    """Whether `design` passes with other options, without a search for relaxations."""
    table = out.with_name(f"{name}.csv")
    task = task_of(table, **{"speed": MACHINES[name].speed, **options})
    folder = out.with_name(f"{out.stem}_design").absolute()
    study = PointStudy(task, folder, table.name, versions()["source"])
    with crew(None) as workers:
        screened = candidates(task, study.folder, study.file, SILENT)
        drafted = drafts(study, screened, workers)
        return bool(solved_front(study, drafted, workers, SILENT)[0])


def sampled(first: str, *others: str) -> list[Any]:
    """Tables of which `make verify` designs the first, and `make bench` the others."""
    return [first, *(pytest.param(name, marks=pytest.mark.whole) for name in others)]


@pytest.mark.parametrize("name", sampled("engine", "press", "compressor", "loom", "duplex"))
def test_a_machine_passes_by_finite_elements(designed: Designed, name: str) -> None:
    code, out = designed(name)
    assert code == PASSED
    assert passes_by_finite_elements(out)
    chosen = record_of(out)["chosen"]
    assert chosen["removed"] >= 0.5
    assert chosen["to_be_confirmed"]


@pytest.mark.parametrize("name", sampled("twin", "diesel", "two_stroke"))
def test_the_smallest_relaxation_passes_by_finite_elements(designed: Designed, name: str) -> None:
    code, out = designed(name)
    assert code == FAILED
    conflict = record_of(out)["conflict"]
    assert conflict["limits"]
    least = conflict["relaxations"][0]
    assert all(each["fails_at"] for each in conflict["relaxations"])
    assert not passes_by_closed_forms(out, name, {least["option"][2:]: least["fails_at"]})
    assert passes_as_printed(least["command"])


def test_a_pump_passes_by_finite_elements(designed: Designed) -> None:
    """Its points and picture are beside the case; a repetition is equal, and run."""
    code, out = designed("pump")
    assert code == PASSED
    document, text = record_of(out), out.read_text(encoding="utf-8")
    folder = out.with_name("pump_design")
    assert document["chosen"]["removed"] >= 0.5
    sizes = [row["size_mm"] for row in document["points"]]
    assert sizes == sorted(sizes)
    # the claim: the smallest that was solved, each part of it tried at the next smaller one
    assert document["chosen"]["size_mm"] == sizes[0]
    exchanges = document["chosen"]["exchanges"]
    assert exchanges["complete"] and exchanges["failing"]
    assert all(each["why"] for each in exchanges["failing"])
    assert f"# {exchanges['claim']}." in text
    assert (folder / "design.png").read_bytes().startswith(b"\x89PNG")
    assert 'overspeed = { text = "assumed' in text
    table, speed = out.with_suffix(".csv"), MACHINES["pump"].speed
    assert (
        machine(table, options={"speed": speed}, out=out, and_run=True) == PASSED
    )  # from the cached points
    assert record_of(out) == document
    assert out.read_text(encoding="utf-8") == text


def test_too_small_a_space_names_one_that_passes(tmp_path: Path) -> None:
    table, out = write_table(tmp_path, "pump"), tmp_path / "small.toml"
    options = {"speed": MACHINES["pump"].speed, "space": "70 mm"}
    assert machine(table, options=options, out=out) == FAILED
    relaxations = record_of(out)["conflict"]["relaxations"]
    wider = next(each for each in relaxations if each["option"] == "--space")
    assert passes_as_printed(wider["command"])

"""`camwright design`: torque tables to cases that pass, or to a relaxation that does, as printed.

The tables are of six machines that the search was not tuned on, see `torque_tables`.
"""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import pytest
from torque_tables import MACHINES, write_table

from camwright.pipeline.base.progress import SILENT
from camwright.pipeline.base.worker_processes import crew
from camwright.pipeline.commands.design_command import design
from camwright.pipeline.commands.terminal import FAILED, PASSED
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.studies.design.candidate_search import candidates
from camwright.pipeline.studies.design.synthesised_points import Study, drafts, solved_front
from camwright.pipeline.studies.design.torque_task import task_of

pytestmark = pytest.mark.slow


def record_of(out: Path) -> dict[str, Any]:
    text = (out.with_name(f"{out.stem}_design") / "design.json").read_text(encoding="utf-8")
    document: dict[str, Any] = json.loads(text)
    return document


def run_as_printed(command: str) -> int:
    """Exit code of a command line of `design`, with its case run."""
    words = shlex.split(command)
    assert words[:2] == ["camwright", "design"]
    options = {name[2:]: text for name, text in zip(words[3::2], words[4::2], strict=True)}
    speed, out = options.pop("speed"), Path(options.pop("out"))
    return design(Path(words[2]), speed, out, run=True, **options)


def passes_by_closed_forms(out: Path, name: str, options: dict[str, str]) -> bool:
    """Whether `design` passes with other options, without a search for relaxations."""
    table = out.with_name(f"{name}.csv")
    task = task_of(table, **{"speed": MACHINES[name].speed, **options})
    folder = out.with_name(f"{out.stem}_design").absolute()
    study = Study(task, folder, table.name, versions()["source"])
    with crew(None) as workers:
        screened = candidates(task, study.folder, study.file, SILENT)
        drafted = drafts(study, screened, workers)
        return bool(solved_front(study, drafted, workers, SILENT)[0])


@pytest.mark.parametrize("name", ["engine", "press", "compressor"])
def test_a_machine_passes_by_finite_elements(tmp_path: Path, name: str) -> None:
    out = tmp_path / f"{name}.toml"
    assert design(write_table(tmp_path, name), MACHINES[name].speed, out, run=True) == PASSED
    chosen = record_of(out)["chosen"]
    assert chosen["removed"] >= 0.5
    assert chosen["to_be_confirmed"]


@pytest.mark.parametrize("name", ["diesel", "two_stroke"])
def test_the_smallest_relaxation_passes_by_finite_elements(tmp_path: Path, name: str) -> None:
    out = tmp_path / f"{name}.toml"
    assert design(write_table(tmp_path, name), MACHINES[name].speed, out, run=True) == FAILED
    conflict = record_of(out)["conflict"]
    assert conflict["limits"]
    least = conflict["relaxations"][0]
    assert run_as_printed(least["command"]) == PASSED
    assert not passes_by_closed_forms(out, name, {least["option"][2:]: least["fails_at"]})


def test_a_pump_passes_by_finite_elements(tmp_path: Path) -> None:
    """The chosen case is run; its points and picture are beside it, and a repetition is equal."""
    table, out = write_table(tmp_path, "pump"), tmp_path / "pump.toml"
    speed, folder = MACHINES["pump"].speed, tmp_path / "pump_design"
    assert design(table, speed, out, run=True) == PASSED
    document, text = record_of(out), out.read_text(encoding="utf-8")
    assert document["chosen"]["removed"] >= 0.5
    sizes = [row["size_mm"] for row in document["points"]]
    assert sizes == sorted(sizes)
    assert (folder / "design.png").read_bytes().startswith(b"\x89PNG")
    assert 'overspeed = "assumed' in text
    assert design(table, speed, out) == PASSED  # from the cached points
    assert record_of(out) == document
    assert out.read_text(encoding="utf-8") == text


def test_too_small_a_space_names_one_that_passes(tmp_path: Path) -> None:
    table, out = write_table(tmp_path, "pump"), tmp_path / "small.toml"
    assert design(table, MACHINES["pump"].speed, out, space="70 mm") == FAILED
    relaxations = record_of(out)["conflict"]["relaxations"]
    wider = next(each for each in relaxations if each["option"] == "--space")
    assert run_as_printed(wider["command"]) == PASSED

"""camwright report: its parts by name, from the folder alone, and never a solver in sight."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import pickle
import subprocess
import sys
import webbrowser
from collections.abc import Callable
from pathlib import Path

import pytest
import report_fixture

from camwright.geometry.errors import AlteredError, InputError, ResultError
from camwright.pipeline.cli import PASSED, run_line
from camwright.pipeline.results import signoff
from camwright.reports import documents, figure_svg, page, sections
from camwright.reports import pdf as printing

ROOT = Path(__file__).parents[2]
NEEDED = (
    "camwright.pipeline.records",
    "camwright.geometry",
    "camwright.meshes",
    "camwright.pipeline.base",
    "camwright.pipeline.cli",
    "camwright.pipeline.commands",
    "camwright.pipeline.hand_check",
    "camwright.pipeline.results",
    "camwright.pipeline.smoothing.scenario",  # the spring that a synthesis has drawn
    "camwright.reports",
    # the declarations of the checks, which name the part that each judges, and what they import
    *(
        f"camwright.pipeline.{name}"
        for name in ("case", "checks", "contact", "cycle", "engine", "follower", "torque")
    ),
)
SOLVERS = {"skfem", "gmsh", "clarabel", "cvxopt", "pypardiso"}
ALWAYS = {"outline", "pressure-angle", "lift", "radii", "pressure", "stress", "normal-force",
          "forces", "guides", "jamming", "speed"}  # fmt: skip
LISTING = """
import sys
from camwright.pipeline import cli
sys.argv = ["camwright", "report", sys.argv[1]]
try:
    cli.main()
except SystemExit as leaving:
    print("left with", leaving.code)
print("loaded", *sys.modules)
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    return report_fixture.write_run(tmp_path / "run", positions=36, field=False)


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures left blank, where what counts is which files come."""
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: "<svg></svg>")
    monkeypatch.setattr(figure_svg, "png_of", lambda figure: b"\x89PNG")


def digests(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_a_run_whose_case_was_edited_is_not_drawn_again(run: Path) -> None:
    case = run / "case.toml"
    case.write_text(case.read_text(encoding="utf-8") + "# edited\n", encoding="utf-8")
    before = digests(run)
    with pytest.raises(AlteredError, match=r"case\.toml: was changed since the sign-off"):
        sections.report(run)
    assert digests(run) == before


def report(*arguments: object) -> object:
    return run_line(["report", *map(str, arguments)])


def test_a_report_that_fails_leaves_the_run_as_it_was(
    run: Path, quick: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    sections.report(run)
    before = digests(run)

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(page, "text", lambda _: b"another page")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ResultError, match=r"partial/motion\.svg: No space left on device$"):
        sections.report(run)
    assert digests(run) == before
    assert signoff.changes(run) == []


def test_no_solver_is_even_loaded(run: Path) -> None:
    before = digests(run)
    done = subprocess.run(
        [sys.executable, "-c", LISTING, str(run)], capture_output=True, text=True, cwd=ROOT,
        check=True, timeout=300,
    )  # fmt: skip
    assert "left with 0" in done.stdout
    loaded = set(done.stdout.split("loaded ", 1)[1].split())
    ours = {name for name in loaded if name.startswith("camwright.")}
    ours -= {"camwright.pipeline", "camwright.pipeline.smoothing"}  # packages without a symbol
    assert "camwright.reports.page" in ours
    assert [name for name in sorted(ours) if not name.startswith(NEEDED)] == []
    assert not {name.split(".")[0] for name in loaded} & SOLVERS
    after = digests(run)
    assert before.pop(signoff.NAME) != after[signoff.NAME]  # the page is recorded
    assert {name: after[name] for name in before} == before  # results are left as they were
    assert page.PAGE in after


@pytest.mark.usefixtures("quick")
def test_one_part_alone_writes_its_files_alone(run: Path) -> None:
    before = digests(run)
    assert report(run, "--only", "page") == PASSED
    assert set(digests(run)) - set(before) == {page.PAGE}
    (run / page.PAGE).unlink()
    assert report(run, "--only", "figures") == PASSED
    assert {name.split("/")[0] for name in set(digests(run)) - set(before)} == {"figures"}


@pytest.mark.usefixtures("quick")
def test_a_report_has_all_parts_but_those_to_ask_for(run: Path) -> None:
    made = sections.report(run)
    assert list(made) == [part.name for part in sections.PARTS if not part.on_request]
    assert not (run / "figures").exists()
    assert not (run / documents.PDF).exists()


@pytest.mark.usefixtures("quick")
def test_pictures_come_as_files_when_asked(run: Path) -> None:
    before = digests(run)
    assert report(run, "--png") == PASSED
    made = {Path(name) for name in set(digests(run)) - set(before)}
    assert {path.stem for path in made if path.suffix == ".png"} >= ALWAYS
    assert Path(page.PAGE) in made


class Made:
    """A task that was made at once."""

    def __init__(self, value: object) -> None:
        self.value = value

    def result(self) -> object:
        return self.value


class AtOnce:
    """Two workers that make a task at once; a drawing is what they return of a pickled one."""

    workers = 2

    def submit(self, function: Callable[..., object], *arguments: object) -> Made:
        restored = pickle.loads(pickle.dumps(arguments))
        return Made(pickle.loads(pickle.dumps(function(*restored))))


@pytest.mark.usefixtures("quick")
def test_a_page_is_made_of_drawings_begun_ahead(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sections.report(run)
    alone = (run / page.PAGE).read_bytes()
    drawings = sections.Ahead(sections.chosen())
    drawings.begin(run, AtOnce())
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: pytest.fail("drawn again"))
    drawings.write(run)
    assert (run / page.PAGE).read_bytes() == alone


@pytest.mark.usefixtures("quick")
def test_a_figure_that_has_changed_is_drawn_again(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawings = sections.Ahead(sections.chosen())
    drawings.begin(run, AtOnce())
    trial = run / "trial_2" / "6_checks.json"
    records = json.loads(trial.read_text())
    angle = next(one for one in records if one["id"] == "pressure_angle")
    angle["limit"] += 1.0
    trial.write_text(json.dumps(records))
    drawn: list[str] = []
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: drawn.append(figure.id) or "<svg/>")
    drawings.write(run)
    assert drawn == ["pressure-angle"]


@pytest.mark.usefixtures("quick")
def test_pdf_comes_beside_the_rest_when_asked(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(printing, "typeset", lambda template, document: b"%PDF")
    assert report(run, "--pdf") == PASSED
    assert (run / page.PAGE).is_file()
    assert (run / documents.PDF).is_file()


def test_a_part_nobody_knows_brings_the_list(run: Path) -> None:
    before = digests(run)
    with pytest.raises(InputError) as refusal:
        report(run, "--only", "pgae")
    assert str(refusal.value).startswith("--only = pgae, must be one of figures (")
    assert all(part.name in str(refusal.value) for part in sections.PARTS)
    assert digests(run) == before


@pytest.mark.usefixtures("quick")
def test_open_shows_the_page(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    monkeypatch.setattr(webbrowser, "open", shown.append)
    with pytest.raises(ResultError, match="missing"):
        report(run, "--only", "figures", "--open")
    assert shown == []
    report(run, "--open")
    assert shown == [(run / page.PAGE).resolve().as_uri()]

"""docs/contributing.md: its example of a check is added to a copy of the program and works."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import textwrap
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry import motion_laws
from camwright.pipeline.base.tables import table
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.cycle import cycle
from camwright.pipeline.preview import preview_case

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8")
LIMITS, SHAPE = ROOT / "pipeline" / "case" / "limits.py", ROOT / "pipeline/checks/cam_shape.py"
LIMIT = 120.0  # mm/rad^3; the cam of the small machine has 190 without it


def fragments(heading: str) -> list[str]:
    """Code of a section of the page, each piece as it would stand in its module."""
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    found = re.findall(r"^ *```py\n(.*?)^ *```$", section, re.MULTILINE | re.DOTALL)
    return [textwrap.dedent(piece) for piece in found]


def mirror(source: Path, copy: Path, changed: set[Path]) -> None:
    """Copy of a package by links, in which some files can be other ones."""
    copy.mkdir(parents=True)
    for each in source.iterdir():
        if each.name == "__pycache__" or each in changed:
            continue
        if any(each in file.parents for file in changed):
            mirror(each, copy / each.name, changed)
        else:
            (copy / each.name).symlink_to(each)


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a copy of the program to which the example of a check is added, in two files."""
    folder = tmp_path_factory.mktemp("program")
    package = folder / "camwright"
    mirror(ROOT / "pipeline", package / "pipeline", {LIMITS, SHAPE})
    for name in ("geometry", "meshes", "reports"):
        (package / name).symlink_to(ROOT / name)
    for name in ("__init__.py", "__main__.py"):
        (package / name).symlink_to(ROOT / "src" / "camwright" / name)
    row, declared, _ = fragments("A check with a limit")
    text, rows = LIMITS.read_text(encoding="utf-8"), "\nLIMITS: Mapping"
    assert text.count(rows) == 1
    (package / "pipeline/case/limits.py").write_text(text.replace(rows, f"\n{row}{rows}"))
    text, names = SHAPE.read_text(encoding="utf-8"), "from camwright.pipeline.case.limits import ("
    assert text.count(names) == 1
    text = f"{text.replace(names, f'{names}LIFT_JERK, ')}\n\n{declared}"
    (package / "pipeline/checks/cam_shape.py").write_text(text)
    return folder


USED = """
import json, sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.cli import main
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.screening.design_screening import screen_designs

def command(*words):
    sys.argv, said = ["camwright", *words], StringIO()
    try:
        with redirect_stdout(said):
            main()
    except SystemExit as end:
        assert end.code in (0, 1, 3), said.getvalue()
    return said.getvalue()

command("run", "case.toml", "--out", "run", "--depth", "screening")
(check,) = [each for each in read_run(Path("run")).final.checks if each["id"] == "lift_jerk"]
drawn = read_case(Path("drawn.toml"))
checks = {each.id: each for each in preview_case(drawn, corners=False).checks}
previewed = checks["lift_jerk"]
limits = {"limits.lift_jerk": ["1270 mm/rad^3", "1290 mm/rad^3"]}
screened = screen_designs(drawn, limits)
explained = command("explain", "lift_jerk"), command("explain", "limits.lift_jerk")
columns = {name: list(screened[f"lift_jerk.{name}"]) for name in ("demand", "limit", "status")}
said = {"check": check, "screened": columns, "explained": explained}
print(json.dumps({**said, "previewed": in_unit(previewed.demand, previewed.unit)}))
"""


@pytest.fixture(scope="module")
def used(program: Path, tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """What the copy says of the check in a run, a screening and `explain`, and the page."""
    folder = tmp_path_factory.mktemp("used")
    limits = f'[limits]\nlift_jerk = "{LIMIT:g} mm/rad^3"\n'
    drawn = small_machine("demo").replace("[limits]\n", limits)
    (folder / "drawn.toml").write_text(drawn, encoding="utf-8")
    text = re.sub(
        r'(?m)^kind = "moving_average"\npoints = .*\nspacing = .*$',
        'kind = "constrained"',
        small_machine("demo"),
    )
    text = text.replace("torque_reduction = 0.4 ", "torque_reduction = 0.1 ")  # within reach
    text = text.replace("positions = 72 ", "positions = 36 ")
    text = text.replace("[limits]\n", limits)
    (folder / "case.toml").write_text(text, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, {str(program)!r})\n{USED}"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    page = (folder / "run" / "8_report.html").read_text(encoding="utf-8")
    return SimpleNamespace(page=page, **json.loads(ended.stdout))


def test_the_check_of_the_page_is_judged_and_kept_by_the_synthesis(used: Any) -> None:
    assert used.check["status"] == "pass"
    assert used.check["limit"] == LIMIT
    assert 0.99 * LIMIT < used.check["demand"] <= LIMIT


def test_the_check_of_the_page_is_screened(used: Any) -> None:
    """Against the preview of the same cam: that of the given smoother, which no limit moves."""
    (deviation,) = re.findall(r"deviation=([\d.]+)", fragments("A check with a limit")[1])
    np.testing.assert_allclose(used.screened["demand"], used.previewed, rtol=float(deviation))
    assert used.screened["status"] == ["fail", "pass"]


def test_the_check_of_the_page_is_shown_and_explained(used: Any) -> None:
    assert "Maximum lift jerk" in used.page
    check, key = used.explained
    assert "|s'''| <= j" in check
    assert "Decides the verdict" in check
    assert "40 mm/rad^3" in key


def test_the_entry_of_the_page_is_python() -> None:
    assert ast.parse(fragments("A check with a limit")[2])


def test_the_laws_of_the_page_are_laws() -> None:
    polynomial, function = fragments("A motion law")
    law = eval(polynomial, dict(vars(motion_laws)))
    half = np.array([0.0, 0.5])
    np.testing.assert_allclose(law(half, 0), [0.0, 0.5])
    names = dict(vars(motion_laws))
    exec(function, names)
    own = motion_laws.LAWS["harmonic"](half, 1)
    np.testing.assert_array_equal(names["_harmonic"](half, 1), own)


def test_the_column_of_the_page_is_a_column() -> None:
    (column,) = fragments("An output column")
    case = case_of(tomllib.loads(small_machine("demo"))).with_positions(36)
    turn = preview_case(case, corners=False).cycles[0].turn
    made = eval(column, {**vars(cycle), "loads": turn.loads, "turn": turn})
    np.testing.assert_allclose(
        table(made)["cam_power_W"], turn.loads.cam_torque * turn.machine.cam_speed, rtol=1e-12
    )

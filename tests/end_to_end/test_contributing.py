"""docs/contributing.md: its examples are added to a copy of the program and work.

A check in two files, a motion law in one, a kind of spring in five.
"""

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
LAWS = ROOT / "geometry/motion_laws.py"
KINDS, SPRING = (ROOT / f"pipeline/follower/{name}.py" for name in ("spring_kinds", "spring"))
STRENGTH, DRAWN, MISSING = (
    ROOT / f"{name}.py"
    for name in ("pipeline/checks/shaped_springs", "reports/drawing/spring_shapes",
                 "pipeline/base/missing_kinds")
)  # fmt: skip
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


def edited(file: Path, *changes: tuple[str, str], added: str = "") -> tuple[Path, str]:
    """A file with places of it replaced, each once, and more at its end."""
    text = file.read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return file, f"{text}\n\n{added}" if added else text


def before(place: str, added: str) -> tuple[str, str]:
    return place, f"{added}{place}"


def with_check() -> dict[Path, str]:
    """Files of the example of a check."""
    row, declared, _ = fragments("A check with a limit")
    names = "from camwright.pipeline.case.limits import ("
    return dict((
        edited(LIMITS, before("\nLIMITS: Mapping", f"\n{row}")),
        edited(SHAPE, (names, f"{names}LIFT_JERK, "), added=declared),
    ))  # fmt: skip


def with_law() -> dict[Path, str]:
    """File of the example of a motion law."""
    law, _ = fragments("A motion law")
    place = '    Law("harmonic"'
    return dict((edited(LAWS, before(place, f"{textwrap.indent(law.rstrip(), '    ')},\n")),))


def with_spring() -> dict[Path, str]:
    """Files of the example of a kind of spring."""
    kind, table, declared, read, picture = fragments("A kind of spring")
    one = re.search(r"    MissingKind\(\n        \"a disc .*?\n    \),\n",
                    MISSING.read_text(encoding="utf-8"), re.DOTALL)  # fmt: skip
    assert one is not None
    return dict((
        edited(
            KINDS,
            ('SpringKind = Literal["gas"', 'SpringKind = Literal["disc", "gas"'),
            ('SpringPart = Literal["gas', 'SpringPart = Literal["disc_spring", "gas'),
            ('"gas": GasSpring', '"disc": DiscSpring, "gas": GasSpring'),
            before("SHAPES: Mapping", f"{kind}\n\n"),
        ),
        edited(
            SPRING,
            before("    SpringKind,\n", "    DiscSpring,\n"),
            before("    torsion: Annotated[", textwrap.indent(table, "    ")),
        ),
        edited(
            STRENGTH,
            before("    ExtensionSpring,\n", "    DiscSpring,\n"),
            ("    NONE,\n", "    NONE,\n    STATED,\n"),
            ("    check,\n", "    check,\n    of_key,\n"),
            added=f"{read}\n\n{declared}",
        ),
        edited(
            DRAWN,
            ('{"gas": Drawn', '{"disc": DrawnDiscs.drawn, "gas": Drawn'),
            before("class DrawnSpring", f"{picture}\n\n"),
        ),
        (MISSING, MISSING.read_text(encoding="utf-8").replace(one.group(), "")),
    ))  # fmt: skip


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a copy of the program to which the examples are added."""
    folder = tmp_path_factory.mktemp("program")
    package = folder / "camwright"
    changed = with_check() | with_law() | with_spring()
    for name in ("geometry", "meshes", "pipeline", "reports"):
        mirror(ROOT / name, package / name, set(changed))
    for name in ("__init__.py", "__main__.py"):
        (package / name).symlink_to(ROOT / "src" / "camwright" / name)
    for file, text in changed.items():
        (package / file.relative_to(ROOT)).write_text(text, encoding="utf-8")
    return folder


def test_the_files_of_the_page_are_few() -> None:
    assert [len(each()) for each in (with_check, with_law, with_spring)] == [2, 1, 5]


def ran(program: Path, folder: Path, script: str) -> str:
    """What a script prints that uses the copy of the program in a folder."""
    ended = subprocess.run(
        [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, {str(program)!r})\n{script}"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


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
    """What the copy says of the check in a run, a screening and `explain`, and the page.

    Two trials from one starting point: the limit is kept by each synthesis, from any start.
    """
    folder = tmp_path_factory.mktemp("used")
    limits = f'[limits]\nlift_jerk = "{LIMIT:g} mm/rad^3"\n'
    drawn = small_machine("demo").replace("[limits]\n", limits)
    (folder / "drawn.toml").write_text(drawn, encoding="utf-8")
    text = re.sub(
        r'(?m)^kind = "moving_average"\npoints = .*\nspacing = .*$',
        'kind = "constrained"\nstarts = 1',
        small_machine("demo"),
    )
    assert "max_trials = 3 " in text
    text = text.replace("max_trials = 3 ", "max_trials = 2 ")
    text = text.replace("torque_reduction = 0.4 ", "torque_reduction = 0.1 ")  # within reach
    text = text.replace("positions = 72 ", "positions = 36 ")
    text = text.replace("[limits]\n", limits)
    (folder / "case.toml").write_text(text, encoding="utf-8")
    said = ran(program, folder, USED)
    page = (folder / "run" / "8_report.html").read_text(encoding="utf-8")
    return SimpleNamespace(page=page, **json.loads(said))


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


KIND = """kind = "disc"

[spring.disc]
discs = 60
outer_diameter = "31.5 mm"
inner_diameter = "16.3 mm"
thickness = "1 mm"
cone_height = "0.9 mm"
deflection = "0.2 mm"
stress_limit = "1000 MPa"
source = { text = "recalled", confirmed = false }
"""
USED_KINDS = """
import json
import numpy as np
from pathlib import Path
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.smoothing.allowables import travel_limits

case = read_case(Path("discs.toml"))
trial = preview_case(case, corners=False)
checks = {each.id: each for each in trial.checks}
spring, top = case.spring, float(trial.contour.lift.highest.value)
screened = screen_designs(case, {"cam.prime_radius": [case.cam.prime_radius]})
lawful = preview_case(read_case(Path("law.toml")), corners=False)
print(json.dumps({
    "stress": in_unit(checks["disc_stress"].demand, "MPa"),
    "lift": top,
    "data": checks["data_disc_spring"].missing,
    "confirm": checks["jump"].unconfirmed,
    "rises": [float(spring.force(np.array(each))) for each in (0.0, 0.5 * top, top)],
    "energy": spring.energy(top),
    "screened": list(screened["disc_stress.demand"]),
    "allowed": travel_limits(case)["disc_stress"],
    "highest": float(lawful.contour.lift.highest.value),
}))
"""


@pytest.fixture(scope="module")
def kinds(program: Path, tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """What the copy says of a machine on disc springs, and of a cam by the law of the page."""
    folder = tmp_path_factory.mktemp("kinds")
    text = small_machine("discs").replace('rate = "24.2 kN/m"\n', "")
    preload = 'preload = "400 N"                    # at the smallest cam radius\n'
    assert preload in text
    (folder / "discs.toml").write_text(text.replace(preload, KIND), encoding="utf-8")
    drawn = (ROOT / "cases/papers/petrescu_b1.toml").read_text(encoding="utf-8")
    assert 'law = "harmonic"' in drawn
    lawful = drawn.replace('law = "harmonic"', 'law = "polynomial_56789"')
    (folder / "law.toml").write_text(lawful, encoding="utf-8")
    return SimpleNamespace(**json.loads(ran(program, folder, USED_KINDS)))


def test_the_spring_of_the_page_is_judged_screened_and_kept(kinds: Any) -> None:
    """By the formula of Almen and Laszlo in its usual form."""
    ratio = 31.5 / 16.3
    own = ((ratio - 1.0) / ratio) ** 2 / (ratio + 1.0) * (ratio - 1.0)
    own /= np.pi * (1.0 - 2.0 * (ratio - 1.0) / (ratio + 1.0) / np.log(ratio))
    unit = 4.0 * 206e9 / 0.91 / (own * 0.0315**2)  # t = 1 mm

    def force(lift: float) -> float:
        x, h = 0.2e-3 + lift / 60.0, 0.9e-3
        return float(unit * 1e-3 * x * ((h - x) * (h - 0.5 * x) + 1e-6))

    rises = [force(each) for each in (0.0, 0.5 * kinds.lift, kinds.lift)]
    np.testing.assert_allclose(kinds.rises, rises, rtol=1e-9)
    assert kinds.energy == pytest.approx(
        kinds.lift * (rises[0] + 4.0 * rises[1] + rises[2]) / 6.0, rel=1e-9
    )  # a cubic: Simpson's rule is exact
    stress = 3.0 / np.pi * unit * 1e-3 * (0.2e-3 + kinds.lift / 60.0) * 1e-6
    assert kinds.stress == pytest.approx(stress, rel=1e-9)
    assert kinds.screened[0] == pytest.approx(stress, rel=1e-4)
    assert kinds.allowed == pytest.approx(60.0 * (1000e9 / (3.0 / np.pi * unit) - 0.2e-3), rel=1e-9)
    assert kinds.data == ["spring.travel_max"]
    assert "spring.disc.thickness" in kinds.confirm


def test_the_law_of_the_page_lifts_a_cam(kinds: Any) -> None:
    drawn = (ROOT / "cases/papers/petrescu_b1.toml").read_text(encoding="utf-8")
    (stroke,) = re.findall(r'stroke = "([\d.]+) mm"', drawn)[:1]
    assert kinds.highest == pytest.approx(1e-3 * float(stroke), rel=1e-6)


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

"""Messages in the words of the case file: key, value and unit as written, the limit with its value.

The inputs are those of users who could not tell from the message what to change.
"""

import random
import re
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import ContactError, InputError, MeshError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import cam_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.units import rounded
from camwright.pipeline.case.case_file import case_of, parse_case, with_values
from camwright.pipeline.case.case_values import replaced, text_of
from camwright.pipeline.case.consistency import check_numbers
from camwright.pipeline.contact.cam_body import Keyway
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.two_scale import loaded_cam
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.torque.torque import Torque, uniform_cycle

CASES = Path(__file__).parents[2] / "cases"
GX120 = (CASES / "gx120.toml").read_text(encoding="utf-8")
REDESIGN = (CASES / "gx120-redesign.toml").read_text(encoding="utf-8")


def changed(text: str, *changes: tuple[str, str]) -> str:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def refused(text: str) -> str:
    with pytest.raises(InputError) as error:
        parse_case(text)
    return str(error.value)


ROLLER = 'radius = "8 mm"'
OVERHANG = 'overhang_at_max_lift = "30 mm"'


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([("positions = 720", 'positions = "72"')],
         'solver.positions = "72", must be a whole number, not in quotes'),
        ([("gear_ratio = 2.0", 'gear_ratio = "2"')],
         'mechanism.gear_ratio = "2", must be a number without a unit, not in quotes'),
        ([(ROLLER, 'radius = "70 mm"')],
         "roller.radius = 70 mm, must be < cam.prime_radius = 50 mm"),
        ([(ROLLER, 'radius = "7 cm"')],
         "roller.radius = 7 cm, must be < cam.prime_radius = 50 mm"),
        ([(ROLLER, 'radius = "59.9 mm"'), ('prime_radius = "50 mm"', 'prime_radius = "60 mm"')],
         "roller.radius = 59.9 mm, must be < 51.5 mm, cam.prime_radius = 60 mm less "
         "cam.bore_radius = 8.5 mm"),
        ([(OVERHANG, 'overhang_at_max_lift = "1.0109935417781614 mm"'),
          ('length = "20 mm"', 'length = "24 mm"')],
         "follower.overhang_at_max_lift = 1.011 mm, must be >= 12 mm, half of guides.a.length = "
         "24 mm, or the roller enters guide A"),
        ([("points = 12", "points = 144")],
         "smoothing.points = 144, must be < 144, a cycle of 720 deg over smoothing.spacing = "
         "5 deg: over all of it the average is zero"),
        ([('"8.5 mm"', '"45 mm"')],
         "cam.bore_radius = 45 mm, must be < 42 mm, the base circle: cam.prime_radius = 50 mm less "
         "roller.radius = 8 mm"),
        ([('mass = "175 g"', 'mass = "175 mm"')],
         "follower.mass = 175 mm, must be in a unit of the dimension of g: kg, g or lb"),
        ([("friction_min = 0.01 ", "friction_min = 0.05 ")],
         "guides.a.friction_min = 0.05, must be <= friction = 0.04"),
        ([('spacing = "80 mm"', 'spacing = "2 cm"')],
         "guides.spacing = 2 cm, must be > 20 mm, half of guides.a.length = 20 mm plus half of "
         "guides.b.length = 20 mm"),
        ([('overspeed = "3960 rpm"', 'overspeed = "1400 rpm"')],
         "load_case[0].speed = 1500 rpm, must be <= limits.overspeed = 1400 rpm"),
    ],
)  # fmt: skip
def test_a_case_is_refused_in_its_own_words(changes: list[tuple[str, str]], message: str) -> None:
    assert refused(changed(GX120, *changes)) == message


def test_the_wall_around_the_bore_is_stated_with_all_that_makes_it() -> None:
    assert refused(changed(REDESIGN, ('bore_radius = "15 mm"', 'bore_radius = "30 mm"'))) == (
        "cam.keyway.depth = 3.3 mm, must be < 2.5 mm, the wall around the bore: "
        "cam.prime_radius = 56 mm less roller.radius = 23.5 mm less cam.bore_radius = 30 mm"
    )


def test_contradictions_are_all_named_but_not_those_that_follow() -> None:
    """A bore is no less than the base circle where the roller is refused."""
    text = changed(GX120, (ROLLER, 'radius = "70 mm"'),
                   ('overspeed = "3960 rpm"', 'overspeed = "1400 rpm"'))  # fmt: skip
    assert refused(text).split("; ") == [
        "roller.radius = 70 mm, must be < cam.prime_radius = 50 mm",
        "load_case[0].speed = 1500 rpm, must be <= limits.overspeed = 1400 rpm",
    ]


def test_values_that_would_read_alike_get_more_digits() -> None:
    text = changed(GX120, (ROLLER, 'radius = "50.00001 mm"'))
    expected = "roller.radius = 50.00001 mm, must be < cam.prime_radius = 50 mm"
    assert refused(text) == expected


@pytest.mark.parametrize(
    ("text", "shown"),
    [("72 mm", "72 mm"), ("0.0010109935417781614 m", "0.001011 m"), ("1e-9 N/m", "1e-9 N/m"),
     ("123456 N", "123500 N"), ("nan mm", "nan mm"), ("x", "x"), ("8.50000", "8.50000"),
     ("-1.23456e-7 m", "-1.235e-7 m")],
)  # fmt: skip
def test_text_is_rounded_only_where_it_has_more_digits(text: str, shown: str) -> None:
    assert rounded(text) == shown


def test_text_of_a_value_is_that_of_the_file_its_card_or_its_unit() -> None:
    case = parse_case(GX120)
    assert text_of(case, "materials.nylon.E") == "2.8 GPa"
    assert text_of(case, "load_case[0].speed") == "1500 rpm"
    assert text_of(case, "smoothing.width") == "60 deg"  # a default
    assert text_of(case, "limits.tool_radius") == "missing"
    assert text_of(replaced(case, {"roller.radius": 0.01}), "roller.radius") == "10 mm"


def test_a_design_of_a_study_is_refused_by_its_own_number() -> None:
    case = replaced(parse_case(GX120), {"roller.radius": 0.07})
    with pytest.raises(InputError, match=r"^roller\.radius = 70 mm, must be < cam\.prime_radius ="):
        check_numbers(case)
    with pytest.raises(InputError, match=r"^roller\.radius = 70 mm, must be < cam\.prime_radius ="):
        with_values(parse_case(GX120), {"roller.radius": 0.07})


def test_a_smoothing_that_leaves_no_torque_names_its_key() -> None:
    text = changed(GX120, ('kind = "moving_average"', 'kind = "harmonic"\ntaper = 0.0'))
    case = parse_case(changed(text, ("points = 12", "harmonics = 1.0")))
    theta = uniform_cycle(720)
    torque = Torque(theta, {"twice a turn": np.sin(2.0 * theta)})
    with pytest.raises(InputError) as error:
        cam_lift(case, {case.load_cases[0].name: torque})
    assert str(error.value).startswith("smoothing.harmonics = 1, must be greater: harmonics of")
    assert "leaves no torque for the cam to balance" in str(error.value)


STEEL = Elastic(210e9, 0.3)


def pair(lift: float, roller: float) -> ContactPair:
    """A cam of 50 mm of prime radius that lifts three times a turn."""
    theta = uniform_turn(360)
    curve = PitchCurve(Lift(theta, lift * (1.0 - np.cos(3.0 * theta))), 50e-3)
    body = RollerBody(roller, 0.5 * roller, STEEL)
    return ContactPair(RollerContour(curve, roller), 5e-3, 10e-3, None, STEEL, body)


def test_a_bore_larger_than_the_contour_is_named() -> None:
    with pytest.raises(InputError) as error:
        loaded_cam(replace(pair(1e-3, 8e-3), bore_radius=43.2e-3))
    text = "cam.bore_radius = 43.2 mm, must be < 42 mm, the least radius of the contour, 42 mm at"
    assert str(error.value).startswith(text)


def test_a_thin_wall_is_meshed_finely_where_it_is_thin() -> None:
    """1.5 mm of wall behind the keyway: uniform elements would be 32,000 triangles.

    The stress by bending of the wall is within 3 % of that on elements of half the size.
    """
    keyway = Keyway(width=6e-3, depth=5.5e-3, angle=np.pi)
    thin = replace(pair(1e-3, 8e-3), bore_radius=35e-3, keyway=keyway)
    theta = np.radians([100.0, 180.0])
    at = thin.contour.points(theta), thin.contour.normal(theta)
    coarse, fine = loaded_cam(thin), loaded_cam(thin, refinement=2.0)
    assert coarse.body.mesh.triangles.shape[1] < 2000
    np.testing.assert_allclose(coarse.correction(*at).along, fine.correction(*at).along, rtol=0.03)


def test_a_mesh_too_large_to_solve_is_refused() -> None:
    cam = pair(1e-3, 8e-3)
    with pytest.raises(MeshError, match=r"^mesh = about 560000 triangles of 0\.15 mm, which"):
        cam_mesh(cam.contour, cam.bore_radius, None, ElementSize(far_size=0.15e-3))


def test_an_undercut_is_called_so() -> None:
    with pytest.raises(ContactError, match=r"^the contour is undercut at 60 deg: the roller"):
        pair(4e-3, 45e-3).relative_radius(np.radians([0.0, 60.0]))
    assert (pair(40e-3, 9e-3).relative_radius(0.0) > 0.0).all()  # concave, whatever the roller


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("contact cylinders --r1 -5 --r2 8",
         "--r1 = -5 mm, must be < -8 mm: concave and wider than --r2 = 8 mm"),
        ("contact cylinders --r1 10 --r2 -0.8cm",
         "--r2 = -0.8cm, must be < -10 mm: concave and wider than --r1 = 10 mm"),
        ("contact cylinders --r1 -5 --r2 inf",
         "--r1 = -5 mm, must be > 0, as the other body is flat or concave"),
        ("check no_such_case.toml", "no_such_case.toml: no such case file or run folder"),
        ("run no_such_case.toml --out x", "case = no_such_case.toml, must be an existing file"),
        ("contact deck run --angle 400",
         "--angle = 400 deg, must be >= 0 and <= 360 deg, one cam turn"),
        ("contact deck run --angle -1rad",
         "--angle = -1rad, must be >= 0 and <= 360 deg, one cam turn"),
    ],
)  # fmt: skip
def test_commands_refuse_in_the_words_of_their_options(
    arguments: str,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: Callable[..., tuple[int, str, str]],
) -> None:
    monkeypatch.chdir(tmp_path)
    words = arguments.split()
    if words[1] == "cylinders":
        words += ["--e1", "210000", "--nu1", "0.3", "--line-load", "100"]
    code, _, err = command(*words)
    assert code == 2
    *stages, refusal = err.splitlines()
    assert refusal == f"camwright: {message}"
    assert stages in ([], [words[0]])


KEY = re.compile(r"[a-z_]+(\[\d+\])?(\.\w+(\[\d+\])?)*( = |, )")
NUMBER = re.compile(r"(?<![\w.])\d+\.?\d*")
TIMES = ("0", "-1.23456789", "1.23456789e9", "1.23456789e-9")
WRONG = (5, "abc", True, [1], "3 furlong", "3 K", "72")


def places(table: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Paths of the numbers of a case, with their units."""
    for key, value in table.items() if isinstance(table, dict) else enumerate(table):
        if isinstance(value, (dict, list)):
            if key not in ("source", "sources"):
                yield from places(value, (*path, key))
        elif not isinstance(value, str) or value[:1] in "-0123456789":
            yield (*path, key)


def put(case: Any, path: tuple[str | int, ...], value: object) -> Any:
    """Value at a path before; the one stated is put there."""
    for step in path[:-1]:
        case = case[step]
    old, case[path[-1]] = case[path[-1]], value
    return old


def test_every_number_of_a_case_is_refused_in_its_words() -> None:
    """A seeded sample of numbers set to 0, negative, huge, tiny, another unit, another type."""
    draw, refusals = random.Random(18), 0
    for text in (GX120, REDESIGN):
        paths = sorted(places(tomllib.loads(text)), key=str)
        for path in draw.sample(paths, 40):
            case = tomllib.loads(text)
            old = put(case, path, None)
            unit = old.partition(" ")[2] if isinstance(old, str) else ""
            scaled = [f"{each} {unit}" if unit else float(each) for each in TIMES]
            for value in draw.sample([*scaled, *WRONG], 4):
                case = tomllib.loads(text)
                put(case, path, value)
                try:
                    case_of(case)
                except InputError as error:
                    message, refusals = str(error), refusals + 1
                    assert KEY.match(message), message
                    assert message.count("must be") == 1, message
                    for number in NUMBER.findall(message):
                        digits = number.replace(".", "").lstrip("0").rstrip("0")
                        assert len(digits) <= 4, message
    assert refusals > 200

"""`camwright design sizes`: complete cases that keep the limits by which they are sized."""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from record_validation import schema_errors

import camwright as cw
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.lift_parts import LiftParts
from camwright.pipeline.case.case import Case as ReadCase
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.given_lift import given_lift, motion_of
from camwright.pipeline.case.template import first_case
from camwright.pipeline.commands.sizes_command import sizes
from camwright.pipeline.commands.terminal import INCOMPLETE, PASSED
from camwright.pipeline.search.sizes.open_case import GAPS, OpenCase, parse_open_case
from camwright.pipeline.search.sizes.shapes import RollerShapes, shapes_of
from camwright.pipeline.search.sizes.size_record import size_lines, size_record
from camwright.pipeline.search.sizes.sizing import sized
from camwright.pipeline.search.sizes.spring_choice import spring_of

CASES = Path(__file__).parents[2] / "cases"
STRANGERS = Path(__file__).parents[1] / "data" / "strangers"
EXACT = 1e-6  # mm, of the published digits

Case = dict[str, Any]


def first(kind: str = "lift") -> Case:
    return tomllib.loads(first_case("feed", kind).text)


def without(case: Case, *keys: str) -> Case:
    for key in keys:
        *tables, last = key.split(".")
        inner = case
        for table in tables:
            inner = inner[table]
        del inner[last]
    return case


def motion(case: Case, *segments: tuple[str, int, float]) -> Case:
    case["lift"]["segment"] = [
        {"law": law, "angle": f"{angle} deg"} | ({"stroke": f"{stroke} mm"} if stroke else {})
        for law, angle, stroke in segments
    ]
    return case


def double_rise(law: str) -> Case:
    """Rise 3 mm, return 3 mm, rise 2 mm, return 2 mm with dwells, a roller of 1 mm."""
    case = without(first(), "cam.prime_radius", "cam.keyway", "cam.key", "camshaft")
    strokes = ((90, 3.0), (90, -3.0), (60, 2.0), (60, -2.0))
    motion(case, *(each for angle, stroke in strokes
                   for each in ((law, angle, stroke), ("dwell", 15, 0.0))))  # fmt: skip
    case["cam"] |= {"bore_radius": "1 mm", "offset": "0 mm"}
    without(case, "roller.pin", "roller.fork")
    bearing = {"name": "plain", "C": "1 kN"}
    case["roller"] |= {"radius": "1 mm", "hub_radius": "0.5 mm", "bearing": bearing}
    case["limits"]["tool_radius"] = "1 mm"
    return case


def steep() -> Case:
    """A quick rise and a slow return: an offset helps."""
    case = without(first(), "cam.prime_radius", "spring.design", "spring.rate", "spring.preload")
    case["follower"]["stem_length"] = "300 mm"
    case["spring"]["travel_max"] = "30 mm"
    case["limits"]["curvature_ratio"] = 1.5
    return motion(case, ("modified_sine", 60, 25.0), ("dwell", 30, 0.0),
                  ("modified_sine", 100, -25.0), ("dwell", 170, 0.0))  # fmt: skip


@pytest.mark.parametrize(
    ("law", "base", "radius"),
    [("cycloidal", 4.677017, 3.096907), ("harmonic", 3.291503, 2.588562)],
)
def test_published_size_of_a_roller_cam(law: str, base: float, radius: float) -> None:
    opened = parse_open_case(tomli_w.dumps(double_rise(law)))
    assert opened.gaps == ("cam.prime_radius",)
    shapes = shapes_of(opened)
    shape = shapes.smallest()
    assert shape.base_radius * 1e3 == pytest.approx(base, abs=EXACT)
    least = shapes.cam.extremes(shape.prime_radius, shape.offset).convex_radius
    assert least.value * 1e3 == pytest.approx(radius, abs=EXACT)
    assert shape.governs == "pressure angle of 30 deg"


@pytest.mark.parametrize(
    ("law", "base", "width"), [("cycloidal", 9.895394, 7.639437), ("harmonic", 7.25, 6.0)]
)
def test_published_size_of_a_flat_face(law: str, base: float, width: float) -> None:
    case = without(double_rise(law), "roller")
    face = {"depth": "5 mm", "thickness": "3 mm", "material": "case_hardened"}
    case["follower"] |= {"kind": "flat", "face": face}
    case["limits"]["undercut_factor"] = 0.01
    opened = parse_open_case(tomli_w.dumps(case))
    assert opened.gaps == ("cam.prime_radius", "follower.face.width")
    shape = shapes_of(opened, 0.25e-3).smallest()
    assert shape.base_radius * 1e3 == pytest.approx(base, abs=EXACT)
    assert shape.face_width * 1e3 == pytest.approx(width, abs=EXACT)
    assert shape.governs == "radius of curvature of 0.25 mm"


@pytest.mark.slow
def test_a_steep_cam_is_sized_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "open.toml", tmp_path / "sized.toml"
    path.write_text("# kept\n" + tomli_w.dumps(steep()), encoding="utf-8")
    assert sizes(path, out=out) == PASSED
    shown = capsys.readouterr().out
    assert "spring: " in shown and "active coils" in shown and f"case: {out}" in shown
    assert out.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    text = out.read_text(encoding="utf-8")
    assert text.startswith("# kept")
    case = cw.read_case(out)
    assert case.sources["cam.prime_radius"].text == "sized: curvature of the pitch curve"
    # the complete case passes the checks by which it is sized, and none is far from its limit
    checks = {each.id: each for each in cw.preview_case(case).checks}
    for name in ("pressure_angle", "curvature_ratio", "undercut", "jump", "jump_speed",
                 "contact_at_overspeed", "elastic_contact"):  # fmt: skip
        assert checks[name].status == "pass", name
    assert checks["curvature_ratio"].utilisation == pytest.approx(1.0, abs=1e-3)
    with pytest.raises(ResultError, match="exists already"):
        sizes(path, out=out)


@pytest.mark.slow
def test_a_roller_has_the_least_contact_pressure() -> None:
    case = without(steep(), "roller.radius")
    case["roller"]["bearing"] = {"name": "plain", "C": "20 kN", "C0": "20 kN"}
    sizing = sized(parse_open_case(tomli_w.dumps(case)))
    shape, shapes = sizing.shape, sizing.shapes
    assert shape.offset > 0.005
    assert isinstance(shapes, RollerShapes)
    low, high = shapes.roller_range(shape)
    pressures = {}
    for radius in (low, shape.roller_radius, high):
        other = replaced(sizing.case, {"roller.radius": radius})
        trial = cw.solve(other, other.contour(given_lift(other)), tier=cw.Tier.SCREENING)
        (pressure,) = (each for each in trial.checks if each.id == "contact_pressure")
        pressures[radius] = pressure.demand
    assert low < shape.roller_radius < high
    assert min(pressures, key=pressures.__getitem__) == shape.roller_radius


@pytest.mark.slow
def test_the_radius_grows_until_the_contact_holds() -> None:
    """A soft cam: the pressure along its line governs, and a slightly smaller cam fails by it."""
    case = steep()
    case["materials"]["soft"] = {
        "E": "210 GPa", "nu": 0.3, "yield_strength": "900 MPa", "density": "7850 kg/m^3",
        "endurance_pressure": "850 MPa", "source": "made up",
    }  # fmt: skip
    case["cam"] |= {"material": "soft", "offset": "0 mm"}
    case = without(case, "limits.target_life")
    sizing = sized(parse_open_case(tomli_w.dumps(case)))
    judged = {each.id: each for each in sizing.checks}
    assert judged["contact_pressure"].status == judged["edge_pressure"].status == "pass"
    assert sizing.shape.prime_radius > sizing.exact.prime_radius * 1.01
    assert judged["edge_pressure"].title in sizing.sources["cam.prime_radius"]
    prime = {"cam.prime_radius": 0.97 * sizing.shape.prime_radius}
    smaller = replaced(sizing.case, prime)
    checks = cw.solve(smaller, smaller.contour(given_lift(smaller)), tier=cw.Tier.PREVIEW).checks
    assert {each.id: each for each in checks}["edge_pressure"].status == "fail"


@pytest.mark.slow
def test_a_flat_face_is_sized(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The paper states neither the ends of the face nor a life: with them all checks pass."""
    stated = (CASES / "papers" / "petrescu_c.toml").read_text(encoding="utf-8")
    case = tomllib.loads(stated)
    case["follower"]["face"]["end"] = {"kind": "chamfer", "size": "0.5 mm"}
    case["limits"] = {"target_life": "100 h"}
    source = tmp_path / "face.toml"
    source.write_text(tomli_w.dumps(case), encoding="utf-8")
    free, chart = ["cam.prime_radius", "follower.face.width"], tmp_path / "face.svg"
    code = sizes(CASES / "papers" / "petrescu_c.toml", free=free)
    assert code == INCOMPLETE
    assert "the case lacks\n  limits.target_life, follower.face.end" in capsys.readouterr().out
    assert sizes(source, free=free, chart=chart, as_json=True) == PASSED
    record = json.loads(capsys.readouterr().out)
    assert schema_errors("size", record) == []
    assert record["smallest"]["undercut_factor_min"] == pytest.approx(0.3, abs=1e-9)
    assert chart.read_text(encoding="utf-8").startswith("<?xml")
    assert set(record["sized"]) == {*free, "cam.offset"}


@pytest.mark.slow
def test_an_engine_cam_is_sized_by_its_torque() -> None:
    sizing = cw.size(CASES / "gx120.toml", ["cam.prime_radius"])
    document = size_record(sizing)
    assert schema_errors("size", document) == []
    record: Any = document["smallest"]
    assert record["pressure_angle_rise_deg"] == pytest.approx(30.0, abs=1e-3)
    assert record["pressure_angle_return_deg"] == pytest.approx(30.0, abs=1e-3)
    assert sizing.verdict == "fail"  # the spring of the paper leaves the cam at the overspeed
    assert any(line.startswith("no prime radius up to") for line in size_lines(sizing))


def test_an_eccentric_is_sized_by_its_circle() -> None:
    shapes = shapes_of(parse_open_case(first_case("disc", "eccentric").text, None, GAPS[:2]))
    shape = shapes.smallest()
    assert shape.governs == "wall around the bore"
    angle = shapes.cam.extremes(shape.prime_radius).pressure_angle.value
    assert math.sin(angle) == pytest.approx(0.005 / (shape.prime_radius + 0.005), rel=1e-9)


@pytest.mark.parametrize(
    ("free", "message"),
    [
        (
            ["spring.rate"],
            r"spring\.rate = missing, must be given without .lift.: the lift follows",
        ),
        (["cam.width"], r"--free = cam\.width, must be one of: cam\.prime_radius"),
    ],
)
def test_refuses_what_cannot_be_open(free: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        cw.size(CASES / "gx120.toml", free)


def test_refuses_a_constrained_synthesis() -> None:
    with pytest.raises(InputError, match=r"smoothing\.kind = constrained"):
        cw.size(CASES / "gx120-flat-face.toml")


def test_refuses_a_picture_of_another_kind(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--chart"):
        sizes(CASES / "gx120.toml", chart=tmp_path / "chart.jpg")


def test_a_roller_that_no_cam_carries() -> None:
    case = first()
    case["cam"]["prime_radius"] = "50 mm"
    opened = parse_open_case(tomli_w.dumps(without(case, "roller.radius")))
    with pytest.raises(InputError, match=r"roller\.radius = 23\.5 mm, must be <= "):
        sized(opened)


@pytest.mark.slow
def test_the_return_may_be_steeper() -> None:
    case = without(steep(), "roller.radius")
    case["roller"]["bearing"] = {"name": "plain", "C": "20 kN", "C0": "20 kN"}
    case["cam"]["bore_radius"], case["roller"]["hub_radius"] = "10 mm", "6 mm"
    case["limits"] |= {"return_pressure_angle": "45 deg", "tool_radius": "5 mm"}
    # a tilted sharp end would make the cam grow
    case["limits"] |= {"axis_parallelism": "0.001 mrad", "cam_run_out": "0.1 um"}
    sizing = sized(parse_open_case(tomli_w.dumps(case)))
    assert isinstance(sizing.shapes, RollerShapes)
    angles = sizing.shapes.cam.extremes(sizing.exact.prime_radius, sizing.exact.offset)
    assert "45 deg on the return" in sizing.exact.governs
    assert math.degrees(angles.rise.value) == pytest.approx(30.0, abs=1e-6)
    (judged,) = (each for each in sizing.checks if each.id == "pressure_angle")
    assert judged.status == "pass" and judged.utilisation == pytest.approx(1.0, abs=1e-3)


@pytest.mark.slow
def test_a_larger_roller_fits_the_tool() -> None:
    """A concave flank has the radius of its pitch curve and that of the roller."""
    case = without(steep(), "roller.radius", "roller.bearing.card")
    case["roller"]["hub_radius"], case["cam"]["bore_radius"] = "6 mm", "10 mm"
    case["roller"]["bearing"] = {"name": "plain", "C": "20 kN"}
    case["limits"]["return_pressure_angle"] = "45 deg"
    shapes = shapes_of(parse_open_case(tomli_w.dumps(case)))
    assert isinstance(shapes, RollerShapes)
    shape = shapes.smallest()
    assert shape.roller_radius > 1.5 * 6.6e-3
    pitch = shapes.cam.extremes(shape.prime_radius, shape.offset)
    concave = pitch.concave_radius.value + shape.roller_radius
    # the roller is halved in to a thousandth of the tool radius, which moves both radii
    assert concave == pytest.approx(1.1 * 0.025, rel=5e-3)
    least = replace(shapes, gaps=tuple(key for key in shapes.gaps if key != "roller.radius"))
    assert least.smallest().prime_radius > 1.05 * shape.prime_radius


@pytest.mark.slow
def test_a_spring_of_the_catalogue_keeps_the_follower_on_the_cam_with_its_surge() -> None:
    case = without(first(), "spring.design")
    case["spring"]["catalogue"] = "shipped"
    free = ("spring.rate", "spring.preload")
    sizing = sized(parse_open_case(tomli_w.dumps(case), None, free))
    checks = {each.id: each for each in sizing.checks}
    assert sizing.verdict == "pass"
    assert checks["contact_over_speed"].status == "pass"
    assert sizing.case.spring.design is not None


def test_the_rate_is_found_beside_a_stated_preload() -> None:
    """29.04 lbf/in = 5085.5 N/m beside 2 lbf, by hand in `test_spring_size`; to four digits up.

    The profile at its lowest takes 0.03 % of the jump speed; the first step of the search is 0.5 %.
    """
    sizing = cw.size(STRANGERS / "05-shm-imperial" / "free_rate.toml", ["spring.rate"])
    assert sizing.spring.rate == 5112.0
    assert sizing.case.spring.preload == pytest.approx(2 * 4.4482216152605)
    judged = {each.id: each.status for each in sizing.checks}
    held = ("contact_force_margin", "jump", "jump_speed", "contact_at_overspeed")
    assert {judged[name] for name in held} == {"pass"}


@pytest.mark.slow
def test_the_preload_is_the_least_without_jump_at_the_worst_tolerances() -> None:
    """All tolerances at their worst ends at once; the corners of a preview are milder."""
    sizing = cw.size(STRANGERS / "size_spring.toml", ("spring.preload",))
    case, spring = sizing.case, sizing.case.spring
    assert sizing.verdict == "pass" and "jump" in sizing.sources["spring.preload"]
    worst = {
        "spring.rate": (1.0 - spring.rate_tolerance) * spring.rate,
        "follower.mass": (1.0 + case.tolerances.mass) * case.follower.mass,
    }
    least = (1.0 - spring.preload_tolerance) * spring.preload
    for share, holds in ((1.0, True), (0.98, False)):
        other = replaced(case, {"spring.preload": share * least, **worst})
        trial = cw.solve(other, other.contour(given_lift(other)), tier=cw.Tier.SCREENING)
        (jump,) = (each for each in trial.checks if each.id == "jump_speed")
        assert (jump.demand >= jump.limit) is holds


FINE = 1440  # cam angles, at which the error bars are below the rounding of a spring to four digits
LAWS = ("modified_sine", "cycloidal", "polynomial_345", "polynomial_4567")


def open_spring(seed: int) -> OpenCase:
    """A case of a seed whose preload, rate or both are open."""
    draw = np.random.default_rng(seed)
    case = without(first(), "spring.design")
    stroke, rise = round(float(draw.uniform(8.0, 20.0)), 1), int(draw.integers(60, 110))
    motion(case, (str(draw.choice(LAWS)), rise, stroke), ("dwell", 40, 0.0),
           (str(draw.choice(LAWS)), 140, -stroke), ("dwell", 180 - rise, 0.0))  # fmt: skip
    case["spring"]["travel_max"] = f"{stroke + 2:g} mm"
    case["follower"]["mass"] = f"{draw.uniform(0.5, 2.5):.4g} kg"
    speed = draw.uniform(1200.0, 3500.0)
    case["load_case"][0]["speed"] = f"{speed:.4g} rpm"
    case["limits"]["overspeed"] = f"{1.1 * speed:.4g} rpm"
    case["solver"]["positions"] = 36
    free = [("spring.preload",), ("spring.rate",), ("spring.rate", "spring.preload")][seed % 3]
    case["spring"]["rate"] = f"{draw.uniform(5.0, 40.0):.4g} kN/m"
    case["spring"]["preload"] = f"{draw.uniform(400.0, 900.0):.4g} N"
    return parse_open_case(tomli_w.dumps(case), None, free)


def holds(case: ReadCase, spring: dict[str, float]) -> bool:
    """Whether its closed-form checks hold the follower with all tolerances at their worst ends."""
    stated, worst = case.spring, {}
    weaker = {"spring.rate": stated.rate_tolerance, "spring.preload": stated.preload_tolerance}
    for key, value in spring.items():
        worst[key] = (1.0 - weaker[key]) * value
    for mass in (1.0 + case.tolerances.mass, 1.0 - case.tolerances.mass):
        other = replaced(case, worst | {"follower.mass": mass * case.follower.mass})
        other = other.with_positions(FINE)
        trial = cw.solve(other, other.contour(given_lift(other)), tier=cw.Tier.SCREENING)
        judged = {each.id: each.status for each in trial.checks}
        if {judged["jump_speed"], judged["contact_at_overspeed"]} - {"pass"}:
            return False
    return True


def least_by_closed_forms(seed: int) -> None:
    """The spring of the closed forms holds; 2 % less of what is open does not."""
    opened = open_spring(seed)
    try:
        spring = spring_of(
            opened.case, opened.gaps, LiftParts.of_motion(motion_of(opened.case.lift))
        )
    except InputError as error:  # no rate holds beside the stated preload
        assert "spring.preload" in str(error)
        return
    stated = {"spring.rate": spring.rate, "spring.preload": spring.preload}
    assert holds(opened.case, stated)
    key, reasons = opened.gaps[-1], spring.preload_by + spring.rate_by
    if "share of" not in reasons and "alone holds" not in reasons:
        assert not holds(opened.case, stated | {key: 0.98 * stated[key]})


@pytest.mark.parametrize("seed", range(12))
def test_two_per_cent_less_of_a_spring_does_not_hold(seed: int) -> None:
    least_by_closed_forms(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12, 112))
def test_two_per_cent_less_of_a_hundred_springs_does_not_hold(seed: int) -> None:
    least_by_closed_forms(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 4, 9])
def test_the_sized_spring_passes_its_own_checks_at_the_worst_tolerances(seed: int) -> None:
    opened = open_spring(seed)
    sizing = sized(opened)
    assert sizing.verdict == "pass"
    key = opened.gaps[-1]
    stated = {"spring.rate": sizing.spring.rate, "spring.preload": sizing.spring.preload}
    assert holds(sizing.case, stated)
    held = {"jump", "jump_speed", "contact_at_overspeed", "elastic_contact"}
    assert {each.status for each in sizing.checks if each.id in held} == {"pass"}
    if "jump" in sizing.sources[key]:
        assert not holds(sizing.case, stated | {key: 0.98 * stated[key]})


@pytest.mark.slow
def test_the_preload_is_the_least_that_holds_an_elastic_stem() -> None:
    sizing = cw.size(STRANGERS / "size_spring.toml", ("spring.rate", "spring.preload"))
    assert sizing.verdict == "pass" and "elastic stem" in sizing.sources["spring.preload"]
    less = replaced(sizing.case, {"spring.preload": 0.98 * sizing.spring.preload})
    checks = cw.solve(less, less.contour(given_lift(less)), tier=cw.Tier.PREVIEW).checks
    assert {each.id: each for each in checks}["elastic_contact"].status == "fail"


@pytest.mark.slow
def test_the_preload_holds_against_a_force_of_the_machine() -> None:
    """600 N pull the follower off, of which a fifth of the preload is left: 750 N or more.

    Its tolerance is 5 %; the preload is found within 1 %, with the error bar of the contact and the
    elastic stem.
    """
    case = without(first(), "spring.preload")
    case["follower"]["external_force"] = "-600 N"
    size = sized(parse_open_case(tomli_w.dumps(case)))
    assert size.verdict == "pass"
    assert 750.0 <= size.spring.preload <= 750.0 / 0.95 * 1.03

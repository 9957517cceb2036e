"""Arm and hub of its pivot beside cam, camshaft, gear and machine shaft, against outlines."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from camwright.geometry.arrays import Array, rotation, uniform_turn
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, solution

BY_ID = {declared.id: declared for declared in CHECKS}
SIZES: dict[str, float | str] = {
    "follower.arm.depth": "24 mm", "follower.arm.width": "28 mm",
    "follower.arm.hub": "44 mm", "follower.arm.material": "c45",
    "follower.arm.pivot_notch": 2.0, "follower.arm.roller_notch": 2.0,
}  # fmt: skip


@cache
def plain() -> Case:
    return parse_case(first_case("swing", "arm").text)


def sized(**values: str | None) -> Case:
    changed = {key.replace("__", "."): value for key, value in values.items()}
    return with_values(plain(), SIZES | changed)


def solved(case: Case) -> Solution:
    return solution(case, case.contour(given_lift(case)), Tier.PREVIEW, torques={}, positions=36)


def judged(name: str, of: Solution) -> Check:
    made = BY_ID[name](of)
    assert made is not None
    assert made.demand is not None
    return made


def away(points: Array, one: Array, other: Array) -> float:
    """Least distance of points (2, n) from a line between two points."""
    along = (other - one).reshape(2, 1)
    off = points.reshape(2, -1) - one.reshape(2, 1)
    share = np.clip((off * along).sum(axis=0) / max((along**2).sum(), 1e-30), 0.0, 1.0)
    return float(np.hypot(*(off - share * along)).min())


@pytest.mark.parametrize(("swing", "mesh", "cheeks", "gear", "width"), [
    ("with", 180.0, 22.0, 60.0, 28.0),
    ("against", 60.0, 36.0, 60.0, 28.0),
    ("with", -50.0, 22.0, 38.0, 70.0),
    ("against", 35.0, 60.0, 70.0, 28.0),
])  # fmt: skip
def test_gaps_of_an_arm_by_polygons_over_the_turn(
    swing: str, mesh: float, cheeks: float, gear: float, width: float
) -> None:
    """arm_gap, arm_cam_gap, machine_shaft_gap and counterweight_gap within 1 um.

    The cam turns clockwise below a pivot on the x axis; the roller centre is that of the pitch
    curve, turned back, and the arm the line from there to the pivot. Corners of the polygon are
    0.04 mm apart: of a gap over 2 mm, 0.2 um. Axial: parts as boxes along the camshaft.
    """
    case = sized(
        follower__arm__swing=swing, camshaft__mesh_angle=f"{mesh} deg",
        roller__fork__cheek_height=f"{cheeks} mm", camshaft__gear_radius=f"{gear} mm",
        camshaft__counterweight__radius="25 mm", camshaft__counterweight__width="19 mm",
        follower__arm__width=f"{width} mm",
    )  # fmt: skip
    of = solved(case)
    pivot, mm = np.array([0.110, 0.0]), 1e-3
    contour, tip = of.contour.polygon(7200), of.contour.radius_max().value
    # from the pivot's line as the cam turns, clockwise
    centre = 1.5e-3 * gear * np.array([np.cos(np.radians(mesh)), -np.sin(np.radians(mesh))])
    origin, module = np.zeros(2), 2.0 * gear / 40
    # name: axis, radius and ends along the camshaft, mm from the middle of the cam
    parts = {
        "shaft": (origin, 15.0, -1e9, 1e9), "gear": (origin, gear + module, -70.0, -50.0),
        "pinion": (centre, 0.5 * gear + module, -70.0, -50.0),
        "bearing 1": (origin, 46.5, -43.0, -27.0), "bearing 2": (origin, 46.5, 27.0, 43.0),
    }  # fmt: skip
    gaps = dict[str, list[float]]()

    def put(name: str, plane: float, axial: float) -> None:
        gaps.setdefault(name, []).append(max(plane, axial))

    def at(theta: float) -> None:
        place = (rotation(-theta) @ of.contour.pitch.points(np.array([theta])))[:, 0]
        bridge = place + 0.26 * (pivot - place)
        held = 11.5 + 2.5 + 0.3  # outer face of a cheek
        # bodies: line, half depth, half width along the camshaft, mm
        bodies = {
            "arm": (pivot, bridge, 12.0, 0.5 * width + 0.3),
            "hub": (pivot, pivot, 22.0, 0.5 * width + 0.3),
            "fork": (bridge, place, 0.5 * cheeks, held),
            "roller": (place, place, max(23.5, 0.5 * cheeks), held),
        }  # fmt: skip
        turning = rotation(-theta) @ contour
        for name, (one, other, half, wide) in bodies.items():
            if name in ("arm", "fork"):
                clear = 9.0 if name == "fork" else -wide  # inner face of a cheek
                put("cam", away(turning, one, other) - half * mm, mm * (clear - 7.75 - 0.3))
            if name == "hub":
                put("about", away(origin, one, other) - half * mm - tip, -1.0)
            for axis, radius, low, high in parts.values() if name != "roller" else ():
                axial = max(low - wide, -wide - high) if low > -1e8 else -1e9
                put("about", away(axis, one, other) - (half + radius) * mm, mm * axial)
            put("crank", away(centre, one, other) - (half + 8.0) * mm, -1.0)
            put("weight", away(origin, one, other) - (half + 25.0) * mm, -1.0)
        put("crank", away(centre, *2 * [origin]) - 8.0 * mm - tip, -1.0)

    worst = judged("arm_cam_gap", of)
    for theta in [*uniform_turn(72), *((worst.cam_angle or 0.0) + np.linspace(-0.02, 0.02, 21))]:
        at(float(theta))
    least = {name: min(of_name) for name, of_name in gaps.items()}
    assert worst.demand == pytest.approx(least["cam"], abs=1e-6)
    assert judged("arm_gap", of).demand == pytest.approx(least["about"], abs=1e-6)
    assert judged("machine_shaft_gap", of).demand == pytest.approx(least["crank"], abs=1e-6)
    # the counterweight is 4.4 mm from bearing 1 on its far side
    assert judged("counterweight_gap", of).demand == pytest.approx(
        min(least["weight"], 27e-3 - 9.5e-3), abs=1e-6
    )


def linked(fixed: str, radius: str, thick: float, plane_offset: str) -> Case:
    """Arm in a plane of its own with a spring on a link: one that pulls behind it, or pushes."""
    text = first_case("swing", "arm").text
    before, after = text[: text.index("[spring]")], text[text.index("[cam]") :]
    action = "pull" if fixed.startswith("-") else "push"
    link = f"""
[spring]
travel_max = "16 mm"

[spring.link]
rate = "100 kN/m"
preload = "1000 N"
arm_radius = "80 mm"
arm_angle = "4 deg"
fixed_radius = "{radius}"
fixed_angle = "{fixed}"
action = "{action}"
diameter = "{thick} mm"
plane_offset = "{plane_offset}"

"""
    case = parse_case(before + link + after)
    return with_values(case, SIZES | {"follower.arm.plane_offset": "150 mm"})


@pytest.mark.parametrize(("fixed", "radius", "thick", "plane_offset", "to_bearing"), [
    ("-60 deg", "60 mm", 12.0, 0.0, False), ("-90 deg", "60 mm", 12.0, 18.0, True),
    ("60 deg", "140 mm", 40.0, 0.0, True),
])  # fmt: skip
def test_gaps_of_a_linked_spring_by_polygons_over_the_turn(
    fixed: str, radius: str, thick: float, plane_offset: float, to_bearing: bool
) -> None:
    """arm_cam_gap, and arm_gap where bearing 1 is nearest, within 1 um.

    Both ends are drawn from the pitch curve, turned back as above.
    """
    of = solved(linked(fixed, radius, thick, f"{plane_offset} mm"))
    pivot, out = np.array([0.110, 0.0]), np.radians(float(fixed.split()[0]))
    contour, lowest = of.contour.polygon(7200), of.contour.lift.lowest.theta

    def arm(theta: float) -> Array:
        """Unit vector from the pivot along the arm."""
        line = (rotation(-theta) @ of.contour.pitch.points(np.array([theta])))[:, 0] - pivot
        return np.asarray(line / np.hypot(*line))

    rest, away_from_rest = arm(lowest), arm(lowest + np.pi)
    outwards = np.sign(rest[0] * away_from_rest[1] - rest[1] * away_from_rest[0])
    held = pivot + 1e-3 * float(radius.split()[0]) * (rotation(outwards * out) @ rest)
    cam, centre = list[float](), list[float]()
    worst, half = judged("arm_cam_gap", of), 0.5e-3 * thick
    near = (worst.cam_angle or 0.0) + np.linspace(-0.02, 0.02, 21)
    for theta in [*uniform_turn(180), *near]:
        end = pivot + 0.080 * (rotation(outwards * np.radians(4.0)) @ arm(float(theta)))
        cam.append(away(rotation(-theta) @ contour, held, end) - half)
        centre.append(away(np.zeros(2), held, end) - half)
    assert worst.note == "spring to cam"
    assert worst.demand == pytest.approx(min(cam), abs=1e-6)
    about = judged("arm_gap", of)
    assert (about.note == "spring to bearing 1") == to_bearing
    if to_bearing:  # 93 mm in diameter, 16 mm wide, 35 mm from the cam
        beside = 1e-3 * (35.0 - plane_offset - 8.0) - half
        assert about.demand == pytest.approx(max(min(centre) - 46.5e-3, beside), abs=1e-6)


def test_a_gas_spring_on_an_arm_lacks_its_diameter_for_its_gaps() -> None:
    """That of coils follows from their winding; that of a gas spring is a key of its own."""
    link = {"arm_radius": "80 mm", "fixed_radius": "140 mm", "fixed_angle": "60 deg"}
    gas = {"pressure": "60 bar", "area": "150 mm^2", "volume": "9 cm^3"}
    text = first_case("swing", "arm").text
    table = "\n".join(f'{key} = "{value}"' for key, value in link.items())
    own = "\n".join(f'{key} = "{value}"' for key, value in gas.items())
    before, after = text[: text.index("[spring]")], text[text.index("[cam]") :]
    spring = f'[spring]\nkind = "gas"\n[spring.link]\n{table}\n[spring.gas]\n{own}\n'
    bare = parse_case(before + spring + after)
    for case, lacks in (
        (bare, True),
        (with_values(bare, {"spring.link.diameter": "28 mm"}), False),
    ):
        of = solution(case, case.contour(given_lift(case)), Tier.PREVIEW, torques={}, positions=36)
        check = BY_ID["data_gas_spring"](of)
        assert check is not None
        assert ("spring.link.diameter" in check.missing) == lacks


def test_bearings_of_an_unknown_bore_leave_the_gap_unknown() -> None:
    """Wide cheeks reach over the bearings; on a shaft without a diameter their size is unknown."""
    narrow, wide = (
        judged("arm_gap", solved(sized(camshaft__diameter=None, follower__arm__width=width)))
        for width in ("18 mm", "70 mm")
    )
    assert narrow.status == "pass"
    assert wide.status == "not_evaluated"
    assert wide.missing == ("camshaft.diameter",)

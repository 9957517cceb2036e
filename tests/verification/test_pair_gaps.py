"""Gaps of a second disc and its follower against distances by elementary geometry."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import rotation, uniform_turn
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.checks.pair_assembly import (
    _between_arms,
    _second_arm,
    beside_contour,
    gaps_of,
)
from camwright.pipeline.cycle.arm_bodies import swung_bodies
from camwright.pipeline.preview import preview_case

DATA = Path(__file__).parents[1] / "data"


@cache
def judged(name: str):
    return preview_case(read_case(DATA / f"{name}.toml"), corners=False)


def gaps(name: str):
    return {which: (1e3 * float(pair.plane), 1e3 * float(pair.axial))
            for which, pair in gaps_of(judged(name).solution).items()}  # fmt: skip


@pytest.mark.parametrize(("radius", "gap"), [(30.0, 20.0), (50.0, 0.0), (55.0, 0.0)])
def test_a_follower_goes_on_outwards_from_its_roller(radius, gap):
    """Circles about the axis: the centre on 50 mm, and the axis of the stem beyond it."""
    theta = uniform_turn(360)
    circle = np.stack([np.cos(theta), np.sin(theta)])
    assert beside_contour(50.0 * circle, radius * circle) == pytest.approx(gap, abs=1e-9)


def test_places_along_the_camshaft_of_the_stem():
    """Discs at 35 and 69 mm, 28 mm wide; fork to 24 mm and 0.3 mm offset; bearings at 0 and 104 mm,
    16 mm wide, gear at -25 mm, 20 mm wide.
    """
    by_name = gaps("conjugate_feeder")
    axial = {name: along for name, (_, along) in by_name.items()}
    assert axial["second disc to bearing 2"] == pytest.approx(104.0 - 69.0 - 14.0 - 8.0)
    assert axial["second roller to bearing 2"] == pytest.approx(104.0 - 69.0 - 24.3 - 8.0)
    assert axial["second disc to gear"] == pytest.approx(69.0 + 25.0 - 14.0 - 10.0)
    # the cheek of an overhung pin is on the other side
    assert axial["roller to second disc"] == pytest.approx(34.0 - 14.0 - 8.75 - 0.3)
    # 154 mm between the centres, 68 mm to 86 mm of them above the axis; roller 23.5 mm
    assert by_name["second roller to camshaft"][0] == pytest.approx(68.0 - 23.5 - 15.0, abs=1e-6)


def segment_gap(ends, points) -> float:
    """Least distance of points (2, n) from a segment."""
    start, end = ends
    along = end - start
    share = np.clip(
        ((points - start[:, None]) * along[:, None]).sum(axis=0) / (along @ along), 0, 1
    )
    return float(np.hypot(*(points - start[:, None] - along[:, None] * share)).min())


def test_each_arm_clears_the_disc_of_the_other_by_the_geometry_of_both():
    """Arms of 90 and 85 mm, 24 mm deep, 79 deg apart on a pivot 100 mm from the axis; they end
    at the bridge of the fork, 26 mm before the centre of the roller.
    """
    case, contour = judged("conjugate_arm").case, judged("conjugate_arm").contour
    second = case.cam.second.track(contour.pitch).contour
    discs = [1e3 * each.points(uniform_turn(3600)) for each in (contour, second)]
    least = {"arm to second disc": np.inf, "second arm to first disc": np.inf}
    for theta in uniform_turn(720):
        pivot = 100.0 * np.array([np.cos(theta), np.sin(theta)])
        centre = 1e3 * contour.pitch.points(np.array([theta]))[:, 0]
        turned = [rotation(sign * np.radians(79.0)) @ (centre - pivot) for sign in (1.0, -1.0)]
        other = min((pivot + 85.0 / 90.0 * each for each in turned), key=lambda at: np.hypot(*at))
        for name, end, length, disc in (
            ("arm to second disc", centre, 90.0, discs[1]),
            ("second arm to first disc", other, 85.0, discs[0]),
        ):
            stop = pivot + (end - pivot) * (length - 26.0) / length
            least[name] = min(least[name], segment_gap((pivot, stop), disc) - 12.0)
    by_name = gaps("conjugate_arm")
    for name, gap in least.items():
        assert by_name[name][0] == pytest.approx(gap, abs=2e-3)


@pytest.mark.parametrize("angle", [30.0, 79.0, 170.0])
def test_each_roller_clears_the_other_arm(angle):
    """Points along both arms, 0.01 mm apart, at the angle between them; rollers of 23.5 and 22 mm
    with cheeks 22 mm high, arms 24 mm deep to 26 mm before the centres, hub 36 mm, discs 40 mm
    apart. The centres of both rollers are as far apart at every angle of the turn.
    """
    solution = judged("conjugate_arm").solution
    pair = replace(solution.machine.cam.conjugate, arm_angle=np.radians(angle))
    track = solution.machine.cam.conjugate.roller.track(solution.contour.pitch)
    bodies = swung_bodies(solution.numbers)
    others = _second_arm(solution, track, pair, bodies)
    pieces = {"arm": (0.0, 64.0, 12.0), "roller": (90.0, 90.0, 23.5), "fork": (64.0, 90.0, 11.0),
              "hub": (0.0, 0.0, 18.0)}  # fmt: skip
    line = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    by_name = dict(_between_arms(bodies, others, pair))
    assert len(by_name) == 12  # of 16 those of hubs and arms join
    for name, gap in by_name.items():
        first, second = name.split(" to second ")
        low, high, half = pieces[first]
        start, end, other = pieces[second]
        start, end = (at - 5.0 if at > 0.0 else 0.0 for at in (start, end))
        other = 22.0 if second == "roller" else other
        along = np.linspace(low, high, int(100 * (high - low)) + 1)
        points = np.linspace(start, end, int(100 * (end - start)) + 1)[:, None] * line
        least = np.hypot(points[:, :1] - along, points[:, 1:]).min()
        assert 1e3 * gap.plane == pytest.approx(least - half - other, abs=1e-3), name
    axial = {name: 1e3 * float(gap.axial) for name, gap in by_name.items()}
    assert axial["arm to second roller"] == axial["roller to second arm"]
    theta = uniform_turn(24)
    pivot = 100.0 * np.stack([np.cos(theta), np.sin(theta)])
    ends = [1e3 * each.points(theta) - pivot for each in (solution.contour.pitch,
                                                           track.contour.pitch)]  # fmt: skip
    apart = np.hypot(*(ends[0] - ends[1]))
    if angle == 79.0:
        gap = 1e3 * float(by_name["roller to second roller"].plane) + 45.5
        np.testing.assert_allclose(apart, gap, rtol=1e-9)


def test_rollers_whose_planes_overlap_strike_the_other_arm():
    """Discs 22 mm apart with arms 15 deg apart: the second roller is within the first arm."""
    near = with_values(read_case(DATA / "conjugate_arm.toml"), {
        "cam.conjugate.spacing": "21 mm", "follower.arm.width": "32 mm"})  # fmt: skip
    solution = preview_case(near, corners=False).solution
    pairs = gaps_of(solution)
    assert (
        float(pairs["arm to second roller"].axial)
        < 0.0
        < float(pairs["arm to second roller"].plane)
    )


def test_the_check_names_what_is_within_the_bearing():
    """With both bearings 70 mm apart the second disc at 69 mm is in the second one."""
    far = read_case(DATA / "conjugate_feeder.toml")
    near = with_values(far, {"camshaft.bearing_spacing": "70 mm"})
    check = next(each for each in preview_case(near, corners=False).checks
                 if each.id == "second_track_gap")  # fmt: skip
    assert check.status == "fail"
    assert check.demand == pytest.approx(1e-3 * (70.0 - 69.0 - 24.3 - 8.0))
    assert check.note == "second roller to bearing 2"


def test_an_arm_over_a_groove_is_before_the_face_of_its_disc():
    """The disc of 112 mm reaches beyond the pivot at 100 mm, whose hub has 36 mm; its face is
    18 - 0.4 - 17.5/2 mm from the middle of the roller.
    """
    case = read_case(DATA / "groove_arm.toml")
    pairs = gaps_of(preview_case(case, corners=False).solution)
    assert list(pairs) == ["arm to disc", "hub to disc"]
    assert 1e3 * float(pairs["hub to disc"].plane) == pytest.approx(100.0 - 18.0 - 112.0)
    for pair in pairs.values():
        assert 1e3 * float(pair.axial) == pytest.approx(20.0 - 10.0 - 0.3 - 8.85)
    within = with_values(case, {"follower.arm.plane_offset": "19 mm"})
    check = next(each for each in preview_case(within, corners=False).checks
                 if each.id == "second_track_gap")  # fmt: skip
    assert check.status == "fail"
    assert check.demand == pytest.approx(-0.15e-3)


def test_the_faces_of_a_yoke_clear_the_shaft():
    """Base circle 35 mm, shaft 30 mm in diameter."""
    assert gaps("yoke_pump") == {"face to camshaft": (pytest.approx(20.0), -np.inf)}

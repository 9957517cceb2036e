"""Gaps of a second disc and its follower against distances by elementary geometry."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import rotation, uniform_turn
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.checks.pair_assembly import beside_contour, gaps_of
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


def test_the_check_names_what_is_within_the_bearing():
    """With both bearings 70 mm apart the second disc at 69 mm is in the second one."""
    far = read_case(DATA / "conjugate_feeder.toml")
    near = with_values(far, {"camshaft.bearing_spacing": "70 mm"})
    check = next(each for each in preview_case(near, corners=False).checks
                 if each.id == "second_track_gap")  # fmt: skip
    assert check.status == "fail"
    assert check.demand == pytest.approx(1e-3 * (70.0 - 69.0 - 24.3 - 8.0))
    assert check.note == "second roller to bearing 2"


def test_the_faces_of_a_yoke_clear_the_shaft():
    """Base circle 35 mm, shaft 30 mm in diameter."""
    assert gaps("yoke_pump") == {"face to camshaft": (pytest.approx(20.0), -np.inf)}

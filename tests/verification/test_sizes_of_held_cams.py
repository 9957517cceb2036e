"""Sizes and remedies of cams that pull: the smallest that pass, and what is not sought."""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.preview import preview_case
from camwright.pipeline.search.remedies.remedy_search import remedies_of
from camwright.pipeline.search.sizes.open_case import parse_open_case
from camwright.pipeline.search.sizes.shapes import shapes_of, values_of
from camwright.pipeline.search.sizes.sizing import sized
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).parents[2]
GROOVE = ROOT / "cases" / "motions" / "feeder-groove.toml"
DATA = ROOT / "tests" / "data"


def statuses(text):
    return {each.id: each.status for each in preview_case(parse_case(text), corners=False).checks}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "governs"),
    [(GROOVE, "curvature_ratio"), (DATA / "yoke_pump.toml", "minimum_wall")],
)
def test_the_prime_radius_is_the_smallest_that_passes(file, governs):
    """A tenth of a millimetre less fails the check that governs."""
    text = file.read_text(encoding="utf-8")
    best = sized(parse_open_case(text, free=("cam.prime_radius",)))
    assert best.verdict == "pass" and best.others == ()
    assert not {each.id for each in best.checks} & {"jump", "spring_travel"}
    value, offset = (best.values[f"cam.{key}"] for key in ("prime_radius", "offset"))
    assert offset == 0.0
    stated = next(row for row in text.splitlines() if row.startswith("prime_radius"))
    smaller = text.replace(stated, f'prime_radius = "{1e3 * value - 0.1:.4f} mm"')
    assert statuses(smaller)[governs] == "fail"


PRIME, APART = "cam.prime_radius", "cam.conjugate.distance"
ANGLE, ROLLER = "cam.conjugate.arm_angle", "cam.conjugate.roller_radius"
AXIAL = [('width = "28 mm"', 'width = "28 mm"\noffset = "0 mm"')]


def opened(name, free, changes=()):
    text = (DATA / f"{name}.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return parse_open_case(text, free=free)


@pytest.mark.parametrize(
    ("name", "free"),
    [
        ("conjugate_feeder", (PRIME, APART)),
        ("conjugate_feeder", (PRIME, ROLLER)),
        ("conjugate_arm", (PRIME, ANGLE)),
        pytest.param("conjugate_arm", (PRIME, ANGLE, "follower.arm.centre_distance"),
                     marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_the_second_disc_of_a_shape_is_that_of_its_contour(name, free):
    """By the path of the second roller: its prime radius and least convex radius; the lift of the
    contour is a spline through that of the sizes, to 1e-3 in its curvature.
    """
    case = opened(name, free, AXIAL if name == "conjugate_feeder" else ())
    shapes = shapes_of(case)
    shape = shapes.smallest()
    sized_case = replaced(case.case, dict(values_of(shape, case.gaps)))
    contour = sized_case.contour(cam_lift(sized_case, {}))
    second = sized_case.cam.second.track(contour.pitch).contour
    record = shapes.record(shape)
    assert record["second_prime_radius_mm"] == pytest.approx(
        1e3 * second.pitch.radius_base, rel=1e-8
    )
    assert record["second_roller_radius_mm"] == pytest.approx(1e3 * second.roller_radius)
    convex = 1.0 / second.pitch.curvature_max()[0]
    least = sized_case.limits.curvature_ratio * second.roller_radius
    if {APART, ANGLE} & {*free}:  # else its size follows from that of the first
        assert convex == pytest.approx(least, rel=1e-3)
    assert convex > 0.999 * least


def test_rollers_too_close_for_both_discs_are_refused():
    shapes = shapes_of(opened("conjugate_feeder", (PRIME,), [*AXIAL, ('"154 mm"', '"140 mm"')]))
    with pytest.raises(InputError, match=r"distance = 140 mm, must be farther: the second disc"):
        shapes.smallest()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "free", "key", "closer"),
    [
        ("conjugate_feeder", (PRIME, APART), "distance", "mm"),
        ("conjugate_arm", (PRIME, ANGLE), "arm_angle", "deg"),
    ],
)
def test_the_place_of_the_second_roller_is_the_closest_that_passes(name, free, key, closer):
    """The complete case passes by `check` with its corners; a little closer the second disc fails
    in its curvature.
    """
    best = sized(opened(name, free))
    assert best.verdict == "pass" and best.others == ()
    checks = {each.id: each for each in preview_case(best.case).checks}
    assert {each.id: checks[each.id].status for each in best.checks} == {
        each.id: "pass" for each in best.checks
    }
    assert checks["curvature_ratio"].utilisation > 0.999
    dotted = f"cam.conjugate.{key}"
    less = best.values[dotted] - (1e-4 if closer == "mm" else np.radians(0.2))
    closer_case = with_values(best.case, {dotted: less})
    again = {each.id: each for each in preview_case(closer_case, corners=False).checks}
    assert again["curvature_ratio"].status == "fail"


def test_both_discs_grow_in_proportion():
    """Where the contact asks for a larger cam; of a stated prime radius the second alone."""
    both = shapes_of(opened("conjugate_feeder", (PRIME, APART), AXIAL))
    alone = shapes_of(opened("conjugate_feeder", (APART,), AXIAL))
    for shapes, first in ((both, 1.1), (alone, 1.0)):
        shape = shapes.smallest()
        larger = shapes.enlarged(shape, 1.1 * shape.prime_radius, "contact")
        assert larger.prime_radius == pytest.approx(first * shape.prime_radius, rel=1e-12)
        before, after = (shapes.record(each)["second_prime_radius_mm"] for each in (shape, larger))
        assert after == pytest.approx(1.1 * before, abs=2e-3)  # drawn to a micrometre


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "old", "new", "check", "key"),
    [
        (GROOVE, 'landing_speed = "50', 'landing_speed = "30',
         "landing_speed", "cam.groove.clearance"),
        (GROOVE, 'clearance = "0.02', 'clearance = "0.006',
         "groove_clearance", "cam.groove.clearance"),
        (DATA / "preloaded_arm.toml", 'interference = "0.02', 'interference = "0.009',
         "preload_least", "cam.conjugate.interference"),
        (DATA / "preloaded_feeder.toml", 'interference = "0.013', 'interference = "0.0075',
         "preload_least", "cam.conjugate.interference"),
    ],
)  # fmt: skip
def test_a_remedy_names_the_key_and_holds(file, old, new, check, key):
    """The changed case passes the check at every tolerance corner."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    trial = preview_case(parse_case(text.replace(old, new)))
    remedy = remedies_of(trial)[check]
    ((changed, value),) = remedy.change.values
    assert remedy.cures and changed == key
    cured = preview_case(with_values(trial.case, {key: value}))
    assert next(each for each in cured.checks if each.id == check).status == "pass"

"""Checks of a flat face: at their limits, and what they leave out."""

import hand_calculations as by_hand
import made_trial as made
import pytest
from trial_variants import faced

from camwright.pipeline.checks import (
    cam_shape,
    flat_face_sliding,
    roller_bearing,
    surface_durability,
)

HALF_WIDTH, PV = 1e-4, 1e6 * by_hand.sliding()


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_width_of_the_face_at_its_limit(share, status):
    """Half the stroke either way, and the contact's half-width beyond."""
    needed = 2 * (0.5 * made.STROKE + HALF_WIDTH)
    check = flat_face_sliding.face_width(faced(width=share * needed))
    assert check.demand == pytest.approx(needed, rel=1e-9)
    assert check.status == status
    assert check.must_have


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_sliding_at_its_limit(share, status):
    check = flat_face_sliding.face_pv(faced(pv_limit=share * PV))
    assert check.demand == pytest.approx(PV)
    assert check.status == status
    assert check.must_have


def test_sliding_without_a_limit_is_not_evaluated():
    check = flat_face_sliding.face_pv(faced(pv_limit=None))
    assert check.status == "not_evaluated"
    assert check.blocks
    assert check.missing == ("follower.face.pv_limit",)


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_undercut_at_its_limit(share, status):
    """At the top s'' is minus half the stroke: r + h/2 of r + h is left."""
    solution = faced()
    least = (made.BASE + 0.5 * made.STROKE) / (made.BASE + made.STROKE)
    limits = made.changed(solution.case.limits, undercut_factor=least / share)
    case = made.changed(solution.case, limits=limits)
    check = cam_shape.undercut(made.changed_solution(solution, case=case))
    assert check.demand == pytest.approx(least, rel=1e-6)
    assert check.status == status


def test_checks_of_a_roller_do_not_apply_to_a_face_nor_the_other_way():
    solution = faced()
    for check in (
        cam_shape.pressure_angle, cam_shape.curvature_ratio, cam_shape.concave_radius,
        surface_durability.traction_demand, roller_bearing.roller_static,
        roller_bearing.roller_life, roller_bearing.roller_speed, roller_bearing.roller_radial,
    ):  # fmt: skip
        assert check(solution) is None
    for check in (flat_face_sliding.face_width, flat_face_sliding.face_pv):
        assert check(made.solution()) is None


def test_a_face_is_called_a_face():
    solution = faced()
    second = cam_shape.second_contact(solution)
    assert second.title == "Interference of the face outside the contact"
    assert second.demand == 0.0
    assert surface_durability.film_ratio(solution).note == ""
    bare = surface_durability.film_ratio(faced(roughness=None))
    assert bare.note == "missing: follower.face.roughness"

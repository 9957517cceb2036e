"""Checks of a flat face: at their limits, and what they leave out."""

from types import SimpleNamespace

import numpy as np
import pytest

from geometry.flat_face import FacePath, FlatFaceContour
from pipeline.checks import face, geometry, roller, rolling
from pipeline.checks.everything import DESIGN
from tests.unit import fake_trial as fake

STROKE, BASE, HALF_WIDTH, PV = 0.01, 0.02, 1e-4, 50e6


def contour(base=BASE, stroke=STROKE):
    lift = fake.contour(stroke).pitch.lift
    return FlatFaceContour(FacePath(lift, base))


def evidence(width=0.02, pv_limit=None, base=BASE):
    """The made-up trial with a face in place of its roller."""
    plain = fake.case()
    block = SimpleNamespace(
        width=width, depth=0.01, thickness=0.005, pv_limit=pv_limit, source="maker",
        material="hard", friction=0.1, roughness=1e-7, crowned=False,
    )  # fmt: skip
    follower = SimpleNamespace(**vars(plain.follower), face=block)
    given = fake.cycle()
    contact = fake.changed(given.contact, half_width=np.full(fake.POSITIONS, HALF_WIDTH))
    sliding = SimpleNamespace(pv=np.full(fake.POSITIONS, PV))
    rolls = fake.changed(given.rolling, traction_demand=None, sliding=sliding)
    case = fake.case(follower=follower, roller=None)
    shape = contour(base)
    return fake.evidence(
        case=case, contour=shape, cycles=(fake.changed(given, contact=contact, rolling=rolls),)
    )


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_width_of_the_face_at_its_limit(share, status):
    """Half the stroke either way, and the contact's half-width beyond."""
    needed = 2 * (0.5 * STROKE + HALF_WIDTH)
    check = face.face_width(evidence(width=share * needed))
    assert check.demand == pytest.approx(1e3 * needed, rel=1e-9)
    assert check.status == status
    assert check.must_have


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_sliding_at_its_limit(share, status):
    check = face.face_sliding(evidence(pv_limit=share * PV))
    assert check.demand == pytest.approx(1e-6 * PV)
    assert check.status == status
    assert check.must_have


def test_sliding_without_a_limit_is_not_evaluated():
    check = face.face_sliding(evidence())
    assert check.status == "not_evaluated"
    assert not check.must_have
    assert "no PV limit" in check.note


@pytest.mark.parametrize(("share", "status"), [(0.99, "fail"), (1.01, "pass")])
def test_undercut_at_its_limit(share, status):
    """At the top s'' is minus half the stroke: r + h/2 of r + h is left."""
    trial = evidence()
    least = (BASE + 0.5 * STROKE) / (BASE + STROKE)
    limits = fake.limits(undercut_factor=least / share).limits
    check = geometry.undercut(
        fake.evidence(case=fake.changed(trial.case, limits=limits), contour=trial.contour)
    )
    assert check.demand == pytest.approx(least, rel=1e-6)
    assert check.status == status


def test_what_a_face_has_not_is_not_asked_for():
    trial = evidence()
    for check in (
        geometry.pressure_angle, geometry.curvature_ratio, geometry.concave_radius,
        rolling.roller_grip, *roller.CHECKS,
    ):  # fmt: skip
        assert check(trial) is None
    for check in face.CHECKS:
        assert check(fake.evidence()) is None
    assert face.face_width not in DESIGN


def test_a_face_is_called_a_face():
    trial = evidence()
    assert geometry.second_contact(trial).title == "Face cuts into another part of the cam"
    assert geometry.second_contact(trial).demand == 0.0
    assert "no roughness of the face" not in rolling.film_ratio(trial).note

"""The fit of the cam on its shaft: pressure by hand, temperature, slip torque, refusals."""

from dataclasses import replace

import numpy as np
import pytest
import trial_variants as variants
from check_tools import check

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.contact.shrink_fit import FittedRing, SeatFit

RADIUS = 8.5e-3  # m, of the seat of the made-up cam, which is 10 mm wide


def fit(least=20e-6, greatest=30e-6, **more):
    return SeatFit(least_interference=least, greatest_interference=greatest, **more)


def steel():
    return variants.made.case().materials["steel"]


def test_pressure_of_one_steel():
    """E delta (1 - (a/b)^2)/(2 a), delta of the radii; none of a clearance, NaN without a wall."""
    ring = FittedRing(RADIUS, 2 * RADIUS, steel(), steel())
    assert ring.pressure(10e-6) == pytest.approx(210e9 * 10e-6 * 0.75 / (2 * RADIUS), rel=1e-12)
    assert ring.pressure(-10e-6) == 0.0
    assert np.isnan(FittedRing(RADIUS, RADIUS, steel(), steel()).pressure(10e-6))
    many = FittedRing(RADIUS, np.array([1.5, 2.0]) * RADIUS, steel(), steel()).pressure(10e-6)
    assert many[0] < many[1] == ring.pressure(10e-6)


def test_a_warm_cam_loosens_and_a_warm_shaft_tightens():
    """1.2e-5 1/K times 50 K times the radius, on the side that is worse."""
    numbers = variants.with_fit().numbers
    cold = numbers["cam.fit.least_pressure"], numbers["cam.fit.greatest_pressure"]
    case = variants.with_fit().case
    for part, moved in (("cam", 0), ("shaft", 1)):
        warm = fit(**{f"{part}_temperature": ROOM + 50.0})
        changed = replace(case.cam, fit=warm)
        other = variants.made.changed_solution(
            variants.with_fit(), case=variants.made.changed(case, cam=changed)
        ).numbers
        hot = other["cam.fit.least_pressure"], other["cam.fit.greatest_pressure"]
        assert hot[1 - moved] == cold[1 - moved]
        step = 1.2e-5 * 50.0 * RADIUS / (10e-6 if moved == 0 else 15e-6)
        share = max(1.0 - step, 0.0) if moved == 0 else 1.0 + step
        assert hot[moved] == pytest.approx(share * cold[moved], rel=2e-3)


def test_slip_torque_of_the_fit():
    """2 pi mu p a^2 b, DIN 7190-1; a stated torque takes its place."""
    case = variants.with_fit(shaft_slip_torque=None)
    pressure = case.numbers["cam.fit.least_pressure"]
    expected = 2 * np.pi * 0.12 * pressure * RADIUS**2 * 10e-3
    assert case.numbers["camshaft.slip_torque"] == pytest.approx(expected, rel=1e-12)
    assert variants.with_fit().numbers["camshaft.slip_torque"] == 100.0


def test_a_slip_torque_without_a_fit_lacks_the_fit():
    """The root of the keyway is then not judged: no pressure is known."""
    made = variants.made
    case = made.case()
    loose = made.changed_solution(
        made.solution(), case=made.changed(case, cam=made.changed(case.cam, fit=None))
    )
    judged = check("keyway_root", loose)
    assert judged.status == "not_evaluated"
    assert "cam.fit.greatest_interference" in judged.missing


def test_an_interference_beyond_its_greatest_is_refused():
    with pytest.raises(InputError, match=r"cam.fit.greatest_interference = 10 um, must be >= 20"):
        fit(20e-6, 10e-6)

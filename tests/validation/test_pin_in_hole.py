"""Pin in a hole against Persson's solution and against finite elements.

The table is Persson's closed form, evaluated independently of the code; its load integral is 1
to 1e-14 and its clearance relation was confirmed by a finite-element run in a plate of 400 radii.
"""

import numpy as np
import pytest
from pin_in_hole_elements import pin_in_hole_by_elements

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.pin_in_hole import (
    peak_pressure,
    persson_clearance,
    persson_contact_angle,
    persson_pressure,
    pin_in_hole,
)

STEEL, STEEL_HOLE = SolidBar(210e9, 0.3), Bush(210e9, 0.3)
NYLON_BUSH = Bush(2.8e9, 0.4, 0.5)
E = STEEL.plane_strain_modulus

# half contact angle in degrees, E' dR/Q, p0 R/Q
TABLE = [
    (5.0, 333.0056, 7.302083),
    (10.0, 82.220579, 3.661556),
    (20.0, 19.535251, 1.852391),
    (30.0, 7.943540, 1.260289),
    (45.0, 2.823121, 0.882111),
    (60.0, 1.067202, 0.711721),
    (75.0, 0.287077, 0.628103),
    (84.828, 0.0, 0.599629),
]


@pytest.mark.parametrize(("degrees", "clearance", "peak"), TABLE)
def test_closed_form(degrees, clearance, peak):
    """To the printed digits."""
    angle = np.radians(degrees)
    assert persson_clearance(angle) == pytest.approx(clearance, rel=5e-7, abs=2e-6)
    assert persson_pressure(angle) == pytest.approx(peak, rel=1e-6)
    assert np.degrees(persson_contact_angle(clearance)) == pytest.approx(degrees, abs=1e-4)


def test_closed_form_carries_the_load():
    for angle in np.radians([3.0, 40.0, 84.0]):
        u = np.linspace(0.0, 0.5 * np.pi, 4001)
        phi = angle * np.sin(u)
        integrand = persson_pressure(angle, phi) * np.cos(phi) * angle * np.cos(u)
        assert 2.0 * np.trapezoid(integrand, u) == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(("degrees", "clearance", "peak"), TABLE)
def test_complementarity_meets_the_table(degrees, clearance, peak, measured):
    """Required: 0.2 deg and 0.5 %; held: 0.06 deg and 0.01 %."""
    found = pin_in_hole(1.0, 1.0, clearance / E, STEEL, STEEL_HOLE)
    assert np.degrees(found.contact_angle) == pytest.approx(degrees, abs=0.06)
    name = "Pin in a hole, Persson: peak pressure over load and radius"
    measured(name, found.peak_pressure, peak, rtol=1e-4)
    assert found.equilibrium < 1e-12
    assert found.complementarity < 1e-9


@pytest.mark.parametrize("clearance", [1e-2, 1e-3, 1e-4, 1e-5, 0.0])
@pytest.mark.parametrize("load", [2e4, 2e6])
def test_clearances_down_to_a_perfect_fit(clearance, load):
    """A 10 mm pin; clearance as a share of the radius."""
    R = 5e-3
    found = pin_in_hole(load, R, clearance * R, STEEL, STEEL_HOLE)
    angle = persson_contact_angle(E * clearance * R / load)
    assert np.degrees(found.contact_angle - angle) == pytest.approx(0.0, abs=0.06)
    assert found.peak_pressure == pytest.approx(persson_pressure(angle) * load / R, rel=2e-4)


@pytest.mark.parametrize(
    ("clearance", "bush"), [(2.823121, STEEL_HOLE), (1.0, NYLON_BUSH), (0.1, NYLON_BUSH)]
)
def test_finite_elements_agree(clearance, bush):
    """Steel pin; hole in a plate of 400 radii, nylon bush in a rigid housing: 0.2 % on the peak.

    The edge lies within a knot.
    """
    dR = clearance / bush.plane_strain_modulus
    series = pin_in_hole(1.0, 1.0, dR, STEEL, bush)
    window = min(1.25 * series.contact_angle, 0.5 * np.pi)
    angle, found = pin_in_hole_by_elements(1.0, dR, STEEL, bush, window, knots=20)
    pressure = found.pressure[0]
    assert pressure[0] == pytest.approx(series.peak_pressure, rel=2e-3)
    last = angle[np.flatnonzero(pressure > 0.0)[-1]]
    assert last == pytest.approx(series.contact_angle, abs=1.1 * window / 20)
    np.testing.assert_allclose(
        pressure[:12], np.interp(angle[:12], series.angle, series.pressure), rtol=5e-3
    )


def test_thin_compressible_bush_is_an_elastic_foundation():
    """p = E_c d cos(phi)/t at perfect fit, so p0 R/Q = 2/pi; a wall of 1 % spreads little."""
    found = pin_in_hole(1.0, 1.0, 0.0, SolidBar(1e15, 0.3), Bush(1e9, 0.0, 0.01))
    assert found.peak_pressure == pytest.approx(2.0 / np.pi, rel=2e-3)
    assert np.degrees(found.contact_angle) == pytest.approx(90.0, abs=1.0)


def test_thick_bush_tends_to_the_plate():
    plate = pin_in_hole(1.0, 1.0, 1e-9, STEEL, Bush(2.8e9, 0.4))
    thick = pin_in_hole(1.0, 1.0, 1e-9, STEEL, Bush(2.8e9, 0.4, 300.0))
    assert thick.peak_pressure == pytest.approx(plate.peak_pressure, rel=1e-4)


def test_peaks_of_many_loads():
    """The table between exact solutions, and across to nearly equal cylinders (light loads)."""
    loads = np.array([0.0, 3e2, 2e4, 9e4, 4e5])
    peak, angle = peak_pressure(loads, 5e-3, 2.5e-5, STEEL, NYLON_BUSH)
    assert peak[0] == angle[0] == 0.0
    assert (np.diff(peak) > 0.0).all()
    for load, p, a in zip(loads[2:], peak[2:], angle[2:], strict=True):
        exact = pin_in_hole(load, 5e-3, 2.5e-5, STEEL, NYLON_BUSH)
        assert p == pytest.approx(exact.peak_pressure, rel=1e-3)
        assert a == pytest.approx(exact.contact_angle, abs=np.radians(0.3))
    fine = np.geomspace(10.0, 1e6, 400)
    steps = np.diff(np.log(peak_pressure(fine, 5e-3, 2.5e-5, STEEL, STEEL_HOLE)[0]))
    assert np.abs(np.diff(steps)).max() < 4e-3  # no jump where Hertz takes over
    fit, _ = peak_pressure(np.array([1e4]), 5e-3, 0.0, STEEL, STEEL_HOLE)
    assert fit[0] == pytest.approx(0.599629 * 1e4 / 5e-3, rel=1e-3)


@pytest.mark.parametrize(
    "change", [{"load": 0.0}, {"radius": -1.0}, {"clearance": -1e-6}, {"clearance": np.nan}]
)
def test_refusals(change):
    given = {"load": 1.0, "radius": 1.0, "clearance": 1e-3} | change
    with pytest.raises(InputError, match=f"pin_in_hole.{next(iter(change))}"):
        pin_in_hole(**given, pin=STEEL, bush=STEEL_HOLE)


def test_refuses_negative_loads_and_bad_bodies():
    with pytest.raises(InputError, match="load"):
        peak_pressure(np.array([-1.0]), 1.0, 0.0, STEEL, STEEL_HOLE)
    with pytest.raises(InputError, match="press fit"):
        peak_pressure(np.array([1.0]), 1.0, -1e-9, STEEL, STEEL_HOLE)
    with pytest.raises(InputError, match="press fit"):
        persson_contact_angle(-0.1)
    with pytest.raises(InputError, match="wall"):
        Bush(1e9, 0.3, 0.0)
    with pytest.raises(InputError, match="poisson"):
        SolidBar(1e9, 0.5)
    with pytest.raises(InputError, match="window"):
        pin_in_hole_by_elements(1.0, 0.0, STEEL, STEEL_HOLE, 2.0)
    with pytest.raises(InputError, match="press fit"):
        pin_in_hole_by_elements(1.0, -1.0, STEEL, STEEL_HOLE, 1.0)

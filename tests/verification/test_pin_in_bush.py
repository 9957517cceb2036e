"""Pin in a bush of finite length against plane strain, Hertz and elements in three dimensions."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from bush_elements import BushByElements, WholeBushByElements

from camwright.geometry.errors import ContactError
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.elasticity.radial_compliance import (
    Bush,
    SolidBar,
    bush_compliance,
    pin_compliance,
)
from camwright.pipeline.contact.elasticity.round_body import Meridian, harmonic_compliance
from camwright.pipeline.contact.pin_in_bush import (
    BushedPin,
    BushGrid,
    PinInBush,
    PinLoad,
    pin_in_bush,
)
from camwright.pipeline.contact.pin_in_hole import pin_in_hole
from camwright.pipeline.cycle.part_loads import bore_of

CASES = Path(__file__).parents[2] / "cases"
STEEL, LINED = SolidBar(210e9, 0.3), Bush(10e9, 0.35, 0.15)
COARSE = BushGrid(120, 16)


def seat(clearance=15e-6, bush=LINED, length=0.025):
    return BushedPin(STEEL, bush, 0.010, length, clearance, 1e-4)


@pytest.mark.parametrize("body", ["bush", "pin"])
def test_harmonics_of_a_long_body_are_those_of_plane_strain(body, measured):
    """Under a pressure along its whole length: Michell's solution, in the middle."""
    stations = tuple(np.linspace(-6.0, 6.0, 25).tolist())
    inwards = np.linspace(0.0, 1.0, 8) ** 2.5
    if body == "bush":
        card, radii = LINED, 1.0 + 0.15 * inwards
        exact = LINED.modulus * bush_compliance(40, LINED)
    else:  # of which a core is held, small beside the second harmonic
        card, radii = STEEL, 1.0 - 0.98 * inwards
        exact = STEEL.modulus * pin_compliance(40, STEEL)
    mesh = Meridian(tuple(radii.tolist()), stations, stations)
    solved = harmonic_compliance(mesh, card.poisson, 60)[:, 12].sum(axis=1) / 0.5
    for harmonic in (2, 3, 5, 11, 37):  # the last three between those that are solved, or solved
        measured(f"{body} under a harmonic pressure", solved[harmonic], exact[harmonic], rtol=0.01)


@pytest.mark.parametrize(("clearance", "around"), [(0.0, 120), (15e-6, 120), (60e-6, 240)])
def test_a_level_pin_presses_the_middle_of_its_bush_as_in_plane_strain(clearance, around, measured):
    """At the line load there: a pin in a hole by complementarity, along a bush of 3 diameters."""
    part = seat(clearance, length=0.06)
    made = pin_in_bush(part, BushGrid(around, 16)).pressed(PinLoad(1500.0, 0.0, 0.0))
    middle = made.line.shape[1] // 2
    exact = pin_in_hole(float(made.line[0, middle]), 0.010, clearance, STEEL, LINED)
    peak = float(made.pressure[:, middle].max())
    # five hat functions on half of the contact
    measured("pin in a long bush", peak, exact.peak_pressure, rtol=0.01)


def test_a_light_pin_presses_its_bush_as_hertz(measured):
    """A thick bronze bush in contact over 2.8 deg on either side: cylinders of near radii."""
    part = seat(100e-6, Bush(110e9, 0.34, 0.5), 0.06)
    made = pin_in_bush(part, BushGrid(720, 12)).pressed(PinLoad(900.0, 0.0, 0.0))
    middle = made.line.shape[1] // 2
    modulus = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.34**2) / 110e9)
    hertz = np.sqrt(made.line[0, middle] * modulus / np.pi * 100e-6 / 0.010**2)
    half = 4.0 * made.line[0, middle] / (2.0 * np.pi * hertz) / 0.010
    assert np.radians(2.0) < half < np.radians(4.0)
    measured("pin in a bush by Hertz", made.pressure[:, middle].max(), hertz, rtol=0.01)


@pytest.mark.parametrize(("aside", "share"), [(0.0, 0.3), (400.0, 0.1), (400.0, 0.6), (0.0, 2.0)])
def test_pressures_carry_force_and_couple(aside, share):
    """Summed over the bore by the trapezoidal rule, on a fine grid; no pressure on an open gap."""
    load = PinLoad(500.0, aside, share * 500.0 * 0.025)
    pin = pin_in_bush(seat(), COARSE)
    made = pin.pressed(load)
    cos, sin = np.cos(pin.angles), np.sin(pin.angles)
    step = 0.010 * pin.angles[1]
    line = step * np.stack([cos, sin]) @ made.pressure
    size = np.hypot(500.0, aside)
    # the rule against linear functions, around: (n step)^2/12
    total = np.trapezoid(line, pin.places, axis=1)
    np.testing.assert_allclose(total, [500.0, aside], rtol=0.0, atol=1e-3 * size)
    fine = np.linspace(-0.0125, 0.0125, 20001)
    turned = [np.trapezoid(np.interp(fine, pin.places, each) * fine, fine) for each in line]
    np.testing.assert_allclose(turned, [load.couple, 0.0], rtol=0.0, atol=2e-3 * size * 0.025)
    assert made.equilibrium < 1e-10 and made.complementarity < 1e-10
    assert (made.pressure >= 0.0).all()


def test_a_load_turned_about_the_axis_turns_the_pressure():
    pin = pin_in_bush(seat(), COARSE)
    upright = pin.pressed(PinLoad(600.0, 0.0, 0.0))
    aside = pin.pressed(PinLoad(0.0, 600.0, 0.0))
    np.testing.assert_allclose(
        np.roll(upright.pressure, 30, axis=0), aside.pressure, rtol=0, atol=1e-6 * upright.peak
    )
    assert aside.peak == pytest.approx(upright.peak, rel=1e-9)
    # across the plane of a couple that it cannot carry there it slides within its clearance
    turned = pin.pressed(PinLoad(0.0, 600.0, 0.5))
    assert 5.0 * upright.tilt < turned.tilt < 30e-6 / 0.025


def test_pressure_and_load_scale_with_modulus_and_clearance():
    """Twice the moduli and the load: twice the pressure and the same tilt."""
    soft = pin_in_bush(seat(), COARSE).pressed(PinLoad(500.0, 100.0, 4.0))
    stiff = BushedPin(SolidBar(420e9, 0.3), Bush(20e9, 0.35, 0.15), 0.010, 0.025, 15e-6, 1e-4)
    other = pin_in_bush(stiff, COARSE).pressed(PinLoad(1000.0, 200.0, 8.0))
    assert other.peak == pytest.approx(2.0 * soft.peak, rel=1e-9)
    assert other.tilt == pytest.approx(soft.tilt, rel=1e-7)


def test_a_contact_narrower_than_the_grid_is_refused():
    with pytest.raises(ContactError, match="pin in its bush"):
        pin_in_bush(seat(1e-3), COARSE).pressed(PinLoad(1e-3, 0.0, 0.0))


# --- Elements in three dimensions ---------------------------------------------------------------
FORCE = 640.0  # N, greatest of the pivot of the case


@pytest.mark.slow
def test_a_tilted_pin_presses_its_bush_as_elements_in_three_dimensions(measured):
    """Half of both bodies in hexahedra, the pin on one side and between both edges of its bush.

    Those are linear, 6 deg wide: within 5 % of a finer mesh.
    """
    pivot = read_case(CASES / "gx120-arm.toml").follower.pivot
    bush, card = pivot.bush, pivot.pin_material
    pin = SolidBar(card.E, card.nu)
    solid = BushByElements(bush, pin)
    part = BushedPin(
        pin, bore_of(bush), 0.5 * bush.diameter, bush.length, 0.5 * bush.clearance, 1e-4
    )
    mine = PinInBush(part, COARSE.refined(1.5))
    for share in (0.0, 0.083, 0.35, 0.375, 0.75):
        couple = share * FORCE * bush.length
        there, here = solid.pressed(FORCE, couple), mine.pressed(PinLoad(FORCE, 0.0, couple))
        words = f"pin in its bush in three dimensions, couple {share} F l"
        measured(f"pressure of a {words}", here.peak, there.pressure.max(), rtol=0.05)
        if share:
            measured(f"tilt of a {words}", here.tilt, there.tilt, rtol=0.05)


@pytest.mark.slow
def test_a_load_beside_the_plane_of_the_couple_presses_as_elements_all_around(measured):
    """Both halves in hexahedra; their meshes of 0.4 and 0.5 differ by up to 4 and 2 %."""
    pivot = read_case(CASES / "gx120-arm.toml").follower.pivot
    bush, card = pivot.bush, pivot.pin_material
    pin = SolidBar(card.E, card.nu)
    solid = WholeBushByElements(bush, pin)
    part = BushedPin(
        pin, bore_of(bush), 0.5 * bush.diameter, bush.length, 0.5 * bush.clearance, 1e-4
    )
    mine = PinInBush(part, COARSE.refined(1.5))
    for away in np.radians([15.0, 45.0, 80.0]):
        for share in (0.083, 0.35, 0.5, 0.75):
            load = PinLoad(FORCE * np.cos(away), FORCE * np.sin(away), share * FORCE * bush.length)
            peak, tilt = solid.pressed(*load)
            here = mine.pressed(load)
            words = "pin in its bush in three dimensions, load beside the couple"
            measured(f"pressure of a {words}", here.peak, peak, rtol=0.06)
            measured(f"tilt of a {words}", here.tilt, tilt, rtol=0.02)

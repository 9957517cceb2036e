"""Pin in the bush of a pivot over the turn: between the solved angles, in tilt, check and files."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import ContactError
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.elasticity.radial_compliance import SolidBar
from camwright.pipeline.contact.pin_in_bush import BushedPin, PinLoad, pin_in_bush
from camwright.pipeline.cycle.part_loads import BushLoad, PivotPush, bore_of
from camwright.pipeline.cycle.pivot_history import BushGrid, pin_slopes, pivot_history

CASES = Path(__file__).parents[2] / "cases"
COUNT = 240
THETA = uniform_turn(COUNT)
MEAN = 1e-4


@cache
def push(light=300.0):
    """Load that grows and turns out of the plane of its couple, from one edge to both."""
    pivot = read_case(CASES / "gx120-arm.toml").follower.pivot
    card = pivot.pin_material
    size = light + 240.0 * (1.0 - np.cos(THETA))
    away = np.radians(35.0) * (1.0 + np.sin(THETA))
    couple = size * pivot.bush.length * (0.3 - 0.25 * np.cos(THETA - 1.0))
    beside = size * np.sin(away) / pivot.bush.length
    return PivotPush(pivot.bush, SolidBar(card.E, card.nu), size * np.cos(away), couple, beside)


@cache
def history():
    return pivot_history(push(), MEAN, THETA)


def solid(refined=1.0):
    bush = push().bush
    part = BushedPin(push().pin, bore_of(bush), 0.5 * bush.diameter, bush.length,
                0.5 * bush.clearance, MEAN)  # fmt: skip
    return pin_in_bush(part, BushGrid(120, 16).refined(refined))


def load(row):
    aside = float(push().beside[row]) * push().bush.length
    return PinLoad(float(push().force[row]), aside, float(push().couple[row]))


def test_pressures_between_the_solved_angles():
    """At every seventh angle for itself."""
    made = history()
    scale = made.edge_pressure[made.worst] / made.coarse
    worst = made.edge_pressure[made.worst]
    for row in range(3, COUNT, 7):
        alone = solid().pressed(load(row))
        assert abs(scale * alone.peak - made.edge_pressure[row]) < 0.01 * worst
        assert abs(alone.tilt - made.tilt[row]) < 0.03 * made.tilt.max()
    assert made.difference < 0.01
    assert 48 <= made.solved < COUNT // 2
    near = [solid().pressed(load(made.worst + step)).peak for step in (-1, 1)]
    assert max(near) < made.coarse


def test_the_greatest_pressure_is_solved_on_the_refined_mesh():
    made = history()
    fine = solid(2.0).pressed(load(made.worst))
    assert made.edge_pressure.max() == made.edge_pressure[made.worst]
    assert made.edge_pressure[made.worst] == pytest.approx(fine.peak, rel=1e-9)
    assert made.error == pytest.approx(3.0 * abs(made.coarse / fine.peak - 1.0), rel=1e-9)
    assert made.error < 0.1 and made.equilibrium < 1e-10 and made.complementarity < 1e-10


@pytest.mark.slow
def test_the_error_bar_of_two_meshes_holds_on_a_third():
    made = history()
    finest = solid(3.0).pressed(load(made.worst)).peak
    assert abs(finest / made.edge_pressure[made.worst] - 1.0) < made.error


def test_line_loads_over_the_turn_carry_the_load_of_the_pin():
    """On one side of the bush: their sizes, which turn a little along it, sum up to the load."""
    made, size = history(), push().size
    more = np.trapezoid(np.abs(made.line), made.places, axis=1) / size
    level = push().couple < 0.1 * size * push().bush.length
    assert level.sum() > 20
    # linear over the angle between those solved, while the load turns by up to 3 deg
    assert (more[level] > 0.95).all() and (more[level] < 1.03).all()


def test_foundation_and_elements_of_a_turn():
    """The closed form is on the safe side of the greatest pressure, and too stiff."""
    made, bush = history(), push().bush
    np.testing.assert_array_equal(made.foundation, push().edge_pressure)
    assert 1.0 < made.foundation.max() / made.edge_pressure.max() < 2.0
    slopes = pin_slopes(push(), MEAN)
    closed = 12.0 / (bush.foundation_modulus * bush.length**3)
    assert (slopes > 2.0 * closed).all() and (slopes < 8.0 * closed).all()
    # the contact widens with the load
    order = np.argsort(push().size)
    assert (np.diff(slopes[order]) <= 0.0).all()
    row = int(np.argmax(push().size))
    force = float(push().size[row])
    couple = force * bush.length / 6.0
    alone = solid().pressed(PinLoad(force, 0.0, couple))
    assert slopes[row] == pytest.approx(alone.tilt / couple, rel=1e-9)


def test_a_pivot_without_load_has_no_history():
    still = push()._replace(force=np.zeros(COUNT), beside=np.zeros(COUNT), couple=np.zeros(COUNT))
    assert pivot_history(still, MEAN, THETA) is None
    assert pin_slopes(still, MEAN) is None


def test_a_contact_narrower_than_the_finest_grid_is_refused():
    """1 mm of clearance under 1 N."""
    loose = push()._replace(bush=replace(push().bush, clearance=5e-3))
    light = loose._replace(force=loose.force * 1e-5, beside=loose.beside * 0.0, couple=THETA * 0.0)
    with pytest.raises(ContactError, match="pin in its bush"):
        pivot_history(light, MEAN, THETA)
    assert pin_slopes(light, MEAN) is None


@pytest.mark.parametrize(
    ("away", "share", "ratio", "pushes"),
    [
        (0, 0.0, 0.99, 1.0), (0, 0.45, 1.08, 1.0), (0, 0.5, 1.37, 0.97), (0, 1.0, 1.33, 0.97),
        (45, 0.25, 0.78, 1.08), (80, 0.25, 2.0, 1.23),
    ],
)  # fmt: skip
def test_slices_over_elements_are_as_stated(away, share, ratio, pushes):
    """The ratios of the limits of the model, of the edge pressure and of the pushes on both sides,
    at 640 N.
    """
    force, aside = 640.0 * np.array([np.cos(np.radians(away)), np.sin(np.radians(away))])
    bush, couple = push().bush, share * 640.0 * push().bush.length
    one = [np.array([each]) for each in (force, couple, aside / bush.length)]
    slices = PivotPush(bush, push().pin, *one).edge_pressure[0]
    pin = solid(1.5)
    made = pin.pressed(PinLoad(force, aside, couple))
    along = np.linspace(pin.places[0], pin.places[-1], 2001)
    line = np.hypot(*(np.interp(along, pin.places, each) for each in made.line))
    assert slices / made.peak == pytest.approx(ratio, rel=0.02)
    assert BushLoad(bush, *one).rubbing[0] == pytest.approx(
        pushes * np.trapezoid(line, along), rel=0.01
    )


def test_a_couple_without_a_force_and_angles_without_load():
    """A quarter of the turn without any load, one with a couple alone, on both edges alike."""
    quarter = np.arange(COUNT) < COUNT // 4
    free = push()._replace(
        force=np.where(quarter, 0.0, push().force),
        beside=np.where(quarter, 0.0, push().beside),
        couple=np.where(np.arange(COUNT) < COUNT // 8, 0.0, 4.0),
    )
    made = pivot_history(free, MEAN, THETA)
    assert np.isfinite(made.edge_pressure).all() and np.isfinite(made.line).all()
    assert (made.edge_pressure[1 : COUNT // 8 - 1] == 0.0).all()
    row = COUNT // 8 + COUNT // 16
    assert made.edge_pressure[row] > 5e6
    np.testing.assert_allclose(made.line[row], -made.line[row, ::-1], rtol=1e-6, atol=1e-3)

"""Stick, slip and creep of a line contact; the roller that the cam drives."""

import numpy as np
import pytest
from carter_traction import rolling_traction

from camwright.geometry.errors import InputError
from camwright.pipeline.contact import traction
from camwright.pipeline.contact.traction import Drag, rolling_contact

COUNT = 720
PERIOD = 0.08
R, A, RHO = 0.008, 1e-4, 0.0065


def turn(drag, force=100.0, spin=500.0, speed=4.0):
    ones = np.ones(COUNT)
    return rolling_contact(
        force * ones, spin * ones, 0 * ones, speed * ones, A * ones, RHO * ones,
        drag=drag, radius=R, period=PERIOD,
    )  # fmt: skip


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.64, 1.0])
def test_traction_carries_its_force_and_stays_below_friction(ratio):
    # x = cos(t) puts the points where the root of the ellipse bends.
    x = -np.cos(np.linspace(0, np.pi, 20001))
    q = rolling_traction(x, ratio)
    assert np.trapezoid(q, x) == pytest.approx(ratio * np.pi / 2, abs=2e-6)
    assert (q <= np.sqrt(1 - np.minimum(x**2, 1)) + 1e-12).all()
    assert (q >= -1e-12).all()


def test_rolling_sticks_at_its_leading_edge():
    full = np.sqrt(1 - np.array([-0.9, 0.0, 0.9]) ** 2)
    rolling = rolling_traction([-0.9, 0.0, 0.9], 0.64) < full - 1e-9
    assert rolling.tolist() == [True, True, False]


@pytest.mark.parametrize("ratio", [-0.01, 1.01, np.nan])
def test_a_force_beyond_friction_is_refused(ratio):
    with pytest.raises(InputError):
        traction.stick_half_width(ratio)


def test_without_drag_nothing_is_asked_and_nothing_lost():
    found = turn(Drag(inertia=1e-7, friction=0.1))
    for values in (found.demand, found.force, found.slip, found.creepage, found.utilisation):
        assert not values.any()
    assert found.loss == 0


def test_a_steady_drag_is_carried_by_creep():
    torque = 0.02
    found = turn(Drag(inertia=1e-7, friction=0.1, torque=torque))
    ratio = torque / R / 10.0
    creep = 0.1 * A / RHO * (1 - np.sqrt(1 - ratio))
    assert found.force == pytest.approx(np.full(COUNT, torque / R), rel=1e-9)
    assert found.utilisation == pytest.approx(np.full(COUNT, ratio), rel=1e-9)
    assert found.creepage == pytest.approx(np.full(COUNT, creep), rel=1e-9)
    assert found.loss == pytest.approx(torque / R * creep * 4.0 * PERIOD, rel=1e-9)
    assert not found.skidding.any()


@pytest.mark.parametrize("inertia", [0.0, 1e-7])
def test_a_drag_beyond_friction_stops_the_roller(inertia):
    found = turn(Drag(inertia=inertia, friction=0.1, torque=0.2))
    assert found.skidding.all()
    assert found.force == pytest.approx(np.full(COUNT, 10.0))
    assert found.slip == pytest.approx(np.full(COUNT, R * 500.0))
    assert found.loss == pytest.approx(10.0 * R * 500.0 * PERIOD)


def test_a_roller_that_left_the_cam_slows_down_and_catches_up():
    theta = np.arange(COUNT) * 2 * np.pi / COUNT
    force = np.where(theta < np.pi / 4, 0.0, 100.0)
    inertia, torque = 1e-6, 0.01
    ones = np.ones(COUNT)
    found = rolling_contact(
        force, 500 * ones, 0 * ones, 4 * ones, A * ones, RHO * ones,
        drag=Drag(inertia, 0.1, torque), radius=R, period=PERIOD,
    )  # fmt: skip
    open_time = PERIOD / 8
    assert found.slip.max() == pytest.approx(R * torque / inertia * open_time, rel=2 / 90)
    assert np.isinf(found.utilisation[:90]).all()
    assert found.skidding[:90].sum() == 0, "an open contact does not skid"
    caught = (0.1 * 100 * R - torque) / inertia
    steps = torque / inertia * open_time / caught / (PERIOD / COUNT)
    assert found.skidding.sum() == pytest.approx(steps, abs=2)
    # What the contact gives the roller, the bearing takes, over a turn that repeats itself.
    spin = 500 - found.slip / R
    given = (found.force * R * spin).sum()
    assert given == pytest.approx((torque * spin).sum(), rel=0.02)


def test_inertia_alone_asks_for_its_share():
    theta = np.arange(COUNT) * 2 * np.pi / COUNT
    spin = 500 + 50 * np.sin(theta)
    acceleration = 50 * np.cos(theta) * 2 * np.pi / PERIOD
    ones = np.ones(COUNT)
    found = rolling_contact(
        100 * ones, spin, acceleration, 4 * ones, A * ones, RHO * ones,
        drag=Drag(2e-6, 0.1), radius=R, period=PERIOD,
    )  # fmt: skip
    exact = 2e-6 * 50 * 2 * np.pi / PERIOD / R
    assert np.abs(found.demand).max() == pytest.approx(exact, rel=1e-12)
    assert found.demand == pytest.approx(found.force, abs=1e-12)


def test_bearing_friction_grows_with_the_force():
    drag = Drag(0.0, 0.1, torque=0.001, bearing_friction=0.002, pin_radius=0.004)
    assert drag.bearing_torque(np.array([0.0, 500.0])).tolist() == pytest.approx([0.001, 0.005])


@pytest.mark.parametrize(
    "bad", [{"inertia": -1}, {"friction": 0}, {"torque": np.nan}, {"bearing_friction": np.inf}]
)
def test_drag_refuses(bad):
    with pytest.raises(InputError):
        Drag(**({"inertia": 0.0, "friction": 0.1} | bad))


def test_ring_inertia_of_a_full_disc():
    mass = 7830 * np.pi * 0.01**2 * 0.005
    assert traction.ring_inertia(0.01, 0, 0.005, 7830) == pytest.approx(mass * 0.01**2 / 2)

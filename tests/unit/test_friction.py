"""Friction between bounds, viscous drag, heat and PV of the guides."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    turn_integral,
)
from camwright.pipeline.follower.guide_friction import (
    NYLON_PV,
    FrictionRange,
    bush_resistance,
    bush_temperature,
    friction_bounds,
    friction_power,
)
from camwright.pipeline.follower.guide_reactions import Guide, GuidePair
from camwright.pipeline.follower.spring import Spring

THETA = uniform_turn(360)
PITCH = PitchCurve(Lift(THETA, 0.01 * (1 - np.cos(THETA))), 0.05)
SYSTEM = FollowerSystem(0.175, Spring(rate=24.2e3, preload=242.0), 0.08, 0.03, 0.04, 0.2)
NOMINAL = (0.04, 0.2)
SPEED = 75.0


def loads_of(system):
    return follower_loads(PITCH, system, SPEED, THETA)


def test_force_lies_between_the_bounds():
    found = friction_bounds(loads_of, SYSTEM, FrictionRange(NOMINAL, (0.02, 0.1), (0.1, 0.3)))
    middle = found.nominal.normal_force
    assert (found.normal_force_min <= middle * (1 + 1e-12)).all()
    assert (found.normal_force_max >= middle * (1 - 1e-12)).all()
    rise = found.nominal.lift_slope > 1e-6
    fall = found.nominal.lift_slope < -1e-6
    np.testing.assert_array_equal(found.normal_force_max[rise], found.greatest.normal_force[rise])
    np.testing.assert_array_equal(found.normal_force_max[fall], found.least.normal_force[fall])
    assert (found.jam_index_max[rise] > 0.0).all()
    assert (found.jam_index_max[fall] == 0.0).all()  # on the way back friction cannot lock
    top = np.argmax(found.nominal.lift)  # a dwell of no length: friction has no say
    assert found.normal_force_max[top] == pytest.approx(found.normal_force_min[top], rel=1e-9)


def test_jam_margin_is_the_factor_to_locking():
    """At that many times the worst friction the index is 1."""
    found = friction_bounds(loads_of, SYSTEM, FrictionRange(NOMINAL, (0.0, 0.0), (0.1, 0.3)))
    margin = 1.0 / found.jam_index_max.max()
    locked = replace(SYSTEM, friction_a=0.1 * margin, friction_b=0.3 * margin)
    loads = follower_loads(PITCH, locked, SPEED, THETA)
    assert loads.jam_index[loads.lift_slope > 0].max() == pytest.approx(1.0, rel=1e-12)
    nothing = (0.0, 0.0)
    none = friction_bounds(loads_of, SYSTEM, FrictionRange(nothing, nothing, nothing))
    assert none.jam_index_max.max() == 0.0


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"least": (0.02, 0.21)}, "b"),
        ({"greatest": (0.1, 0.19)}, "b"),
        ({"least": (-0.01, 0.1)}, "a"),
        ({"nominal": (np.nan, 0.2)}, "a"),
        ({"greatest": (0.1, np.nan)}, "b"),
    ],
)
def test_bounds_must_enclose_the_nominal(changes, name):
    good = {"nominal": NOMINAL, "least": (0.02, 0.1), "greatest": (0.1, 0.3)}
    with pytest.raises(InputError, match=rf"guides\.{name}\.friction"):
        FrictionRange(**(good | changes))


def guides(a=None, b=None):
    """Two like guides; friction and bounds of A and B as given."""
    nylon = Material(E=2.8e9, nu=0.4, yield_strength=60e6, density=1150.0, source="maker")
    plain = Guide(length=0.02, diameter=0.01, friction=NOMINAL[0], material=nylon)
    return GuidePair(
        spacing=0.08,
        a=replace(plain, **(a or {})),
        b=replace(plain, friction=NOMINAL[1], **(b or {})),
    )


def test_range_is_that_of_the_guides_else_that_of_the_tolerance():
    """0.04 within 20 % is 0.032 to 0.048; guide B states 0.15 to 0.25 itself."""
    pair = guides(b={"friction_min": 0.15, "friction_max": 0.25})
    found = FrictionRange.of(pair.a, pair.b, 0.2)
    assert found.nominal == NOMINAL
    assert found.least == pytest.approx((0.032, 0.15), rel=1e-12)
    assert found.greatest == pytest.approx((0.048, 0.25), rel=1e-12)
    assert found.factors(0) == pytest.approx((0.8, 1.2), rel=1e-12)
    assert found.factors(1) == pytest.approx((0.75, 1.25), rel=1e-12)


def test_scaled_friction_widens_its_bounds_where_it_leaves_them():
    found = FrictionRange(NOMINAL, (0.02, 0.1), (0.05, 0.3)).scaled(1.5, 0.25)
    assert found.nominal == pytest.approx((0.06, 0.05), rel=1e-12)
    assert found.least == pytest.approx((0.02, 0.05), rel=1e-12)
    assert found.greatest == pytest.approx((0.06, 0.3), rel=1e-12)


def test_viscous_drag_follows_the_speed():
    """c3 v on the axial force where Coulomb friction is none: the loss is c3 v^2 over the turn."""
    free = replace(SYSTEM, friction_a=0.0, friction_b=0.0)
    thick = replace(free, viscous_damping=30.0)
    plain, drag = (follower_loads(PITCH, s, SPEED, THETA) for s in (free, thick))
    np.testing.assert_allclose(
        drag.axial_force - plain.axial_force, 30.0 * plain.velocity, atol=1e-9
    )
    # s' = 0.01 sin: the integral of c3 w s'^2 over the turn is c3 w pi 1e-4
    assert drag.friction_loss == pytest.approx(30.0 * SPEED * np.pi * 1e-4, rel=1e-9)
    assert turn_integral(drag.theta, drag.cam_torque) == pytest.approx(drag.friction_loss, rel=1e-9)
    faster = follower_loads(PITCH, thick, 2 * SPEED, THETA)
    assert faster.friction_loss == pytest.approx(2 * drag.friction_loss, rel=1e-12)
    np.testing.assert_allclose(drag.friction_power, 30.0 * drag.velocity**2, atol=1e-12)


def test_viscous_drag_and_rubbing_together():
    """Work of the cam is heat, both frictions on."""
    loads = follower_loads(PITCH, replace(SYSTEM, viscous_damping=30.0), SPEED, THETA)
    assert turn_integral(loads.theta, loads.cam_torque) == pytest.approx(
        loads.friction_loss, rel=1e-9
    )
    with pytest.raises(InputError, match="viscous_damping"):
        replace(SYSTEM, viscous_damping=-1.0)


def test_heat_and_temperature():
    """mu R v in the mean, and its way out."""
    power = friction_power(np.full(4, 10.0), np.array([1.0, -1.0, 2.0, 0.0]))
    np.testing.assert_allclose(power, [10.0, 10.0, 20.0, 0.0])
    assert bush_temperature(10.0, 5.0, 300.0) == pytest.approx(350.0)
    assert np.isnan(bush_temperature(1.0, None, 300.0))
    assert np.isnan(bush_temperature(1.0, 5.0, None))


def test_heat_of_the_guides_is_the_cycle_s_friction():
    """With point supports the rubbing loads are the reactions: the same power."""
    loads = follower_loads(PITCH, SYSTEM, SPEED, THETA)
    both = [
        friction_power(mu * np.abs(reaction), loads.velocity)
        for reaction, mu in ((loads.reaction_a, 0.04), (loads.reaction_b, 0.2))
    ]
    np.testing.assert_allclose(sum(both), loads.friction_power, rtol=1e-12, atol=1e-12)


def test_resistance_of_a_wall():
    """A quarter of the bore thick: ln(1.5)/(2 pi lambda l)."""
    assert bush_resistance(0.01, 0.0025, 0.02, 0.25) == pytest.approx(np.log(1.5) / (0.01 * np.pi))
    with pytest.raises(InputError, match="conductivity"):
        bush_resistance(0.01, 0.0025, 0.02, 0.0)


def test_nylon_bears_more_the_better_it_is_greased():
    assert list(NYLON_PV.values()) == sorted(NYLON_PV.values())


def test_heat_refusals():
    with pytest.raises(InputError, match="friction_force"):
        friction_power([-1.0], [1.0])
    with pytest.raises(InputError, match="friction_force"):
        friction_power([np.nan], [1.0])

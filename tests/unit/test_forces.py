"""Follower forces at single positions, against hand calculation."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_jump import rigid_jump_speed

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.follower.follower_forces import (
    JAM_FLOOR,
    FollowerSystem,
    follower_loads,
    torque_on_cam,
    turn_integral,
)
from camwright.pipeline.follower.spring import Spring

SYSTEM = FollowerSystem(
    mass=0.2,
    spring=Spring(rate=20e3, preload=200.0),
    guide_spacing=0.08,
    overhang_at_max_lift=0.03,
    friction_a=0.05,
    friction_b=0.2,
)
SPEED = 70.0
STROKE = 0.02


def harmonic(stroke=STROKE, prime_radius=0.05, offset=0.0):
    """s = h (1 - cos theta)/2, exact at the samples to 1e-12."""
    theta = uniform_turn(720)
    return PitchCurve(Lift(theta, 0.5 * stroke * (1.0 - np.cos(theta))), prime_radius, offset)


@pytest.mark.parametrize("angle", [0.5 * np.pi, 1.5 * np.pi], ids=["rise", "return"])
@pytest.mark.parametrize("offset", [0.0, 0.004, -0.004, 0.02])
def test_forces_at_half_lift_by_hand(angle, offset):
    """At 90 and 270 degrees s = h/2, s' = +-h/2, s'' = 0; the offset leans the normal."""
    loads = follower_loads(harmonic(offset=offset), SYSTEM, SPEED, [angle])
    slope = 0.01 * np.sin(angle)
    spring = 200.0 + 20e3 * 0.01
    height = np.sqrt(0.05**2 - offset**2) + 0.01
    lean = (slope - offset) / height
    overhang = 0.03 + 0.01
    factor = 0.05 * (overhang + 0.08) / 0.08 + 0.2 * overhang / 0.08
    axial = spring / (1.0 - np.sign(slope) * factor * abs(lean))
    side = axial * lean
    expected = {
        "lift": 0.01,
        "lift_slope": slope,
        "velocity": slope * SPEED,
        "spring_force": spring,
        "overhang": overhang,
        "axial_force": axial,
        "normal_force": axial * np.hypot(1.0, lean),
        "tangential_force": side,
        "reaction_a": side * (overhang + 0.08) / 0.08,
        "reaction_b": side * overhang / 0.08,
        "friction_force_a": 0.05 * abs(side) * 1.5,
        "friction_force_b": 0.2 * abs(side) * 0.5,
        "friction_force": factor * abs(side),
        "friction_power": factor * abs(side * slope * SPEED),
        "cam_torque": axial * slope,
        "jam_index": factor * abs(lean),
    }
    for name, value in expected.items():
        # 1e-9: the quintic spline of 720 samples misses the cosine by about 1e-13 of the stroke
        np.testing.assert_allclose(getattr(loads, name), [value], rtol=1e-9, err_msg=name)
    assert loads.inertia_force == pytest.approx(0.0, abs=1e-6)


def test_axial_forces_balance_with_friction_against_the_motion():
    theta = uniform_turn(360)
    loads = follower_loads(harmonic(offset=0.01), SYSTEM, SPEED, theta)
    friction = np.sign(loads.velocity) * loads.friction_force
    balance = loads.axial_force - loads.spring_force - loads.inertia_force - friction
    np.testing.assert_allclose(balance, 0.0, atol=1e-11 * loads.axial_force.max())


def test_friction_raises_the_push_on_the_rise_and_spares_it_on_the_return():
    theta = uniform_turn(360)
    free = follower_loads(harmonic(), replace(SYSTEM, friction_a=0, friction_b=0), SPEED, theta)
    rubbing = follower_loads(harmonic(), SYSTEM, SPEED, theta)
    rise = (theta > 0.1) & (theta < np.pi - 0.1)
    back = (theta > np.pi + 0.1) & (theta < 2 * np.pi - 0.1)
    assert (rubbing.normal_force > 1.001 * free.normal_force)[rise].all()
    assert (rubbing.normal_force < 0.9999 * free.normal_force)[back].all()


def test_round_cam_has_no_side_force_and_no_torque():
    theta = uniform_turn(48)
    pitch = PitchCurve(Lift(theta, np.zeros(48)), 0.05)
    loads = follower_loads(pitch, SYSTEM, SPEED, theta)
    np.testing.assert_array_equal(loads.cam_torque, 0.0)
    np.testing.assert_array_equal(loads.tangential_force, 0.0)
    np.testing.assert_array_equal(loads.friction_force, 0.0)
    np.testing.assert_array_equal(loads.normal_force, 200.0)


def test_round_cam_with_offset_dwells_without_sliding_friction():
    theta = uniform_turn(48)
    pitch = PitchCurve(Lift(theta, np.zeros(48)), 0.05, 0.03)
    loads = follower_loads(pitch, SYSTEM, SPEED, theta)
    np.testing.assert_allclose(loads.tangential_force, -200.0 * 0.75, rtol=1e-14)
    np.testing.assert_allclose(loads.axial_force, 200.0, rtol=1e-14)
    np.testing.assert_array_equal(loads.friction_power, 0.0)


@pytest.mark.parametrize(("share", "separated"), [(0.99, False), (1.01, True)])
def test_contact_is_lost_just_above_the_jump_speed(share, separated):
    theta = uniform_turn(720)
    speed, where = rigid_jump_speed(harmonic(), SYSTEM, theta)
    loads = follower_loads(harmonic(), SYSTEM, share * speed, theta)
    assert loads.separated.any() == separated
    if separated:
        assert loads.separated[np.argmin(np.abs(theta - where))]
        for name in ("normal_force", "axial_force", "tangential_force", "reaction_a", "cam_torque"):
            np.testing.assert_array_equal(getattr(loads, name)[loads.separated], 0.0)
    assert (loads.normal_force >= 0.0).all()


def test_jump_speed_of_a_harmonic_lift():
    """With s = h(1-cos)/2 the hold P + k s first meets the throw at full lift or before."""
    theta = uniform_turn(720)
    lift = 0.5 * STROKE * (1 - np.cos(theta))
    throw = -0.2 * 0.5 * STROKE * np.cos(theta)
    falling = throw > 1e-12
    expected = np.sqrt(np.min((200.0 + 20e3 * lift[falling]) / throw[falling]))
    assert rigid_jump_speed(harmonic(), SYSTEM, theta)[0] == pytest.approx(expected, rel=1e-8)


def test_a_massless_follower_never_jumps():
    speed, where = rigid_jump_speed(harmonic(), replace(SYSTEM, mass=0.0), uniform_turn(90))
    assert speed == np.inf
    assert np.isnan(where)


def test_jamming_keeps_forces_finite_and_is_told_by_the_index():
    steep = harmonic(stroke=0.2, prime_radius=0.02)
    rough = replace(SYSTEM, friction_a=0.5, friction_b=0.9)
    theta = uniform_turn(360)
    loads = follower_loads(steep, rough, 0.0, theta)
    assert loads.jammed.any()
    assert (loads.jam_index[loads.jammed] >= 1.0).all()
    assert np.isfinite(loads.normal_force).all()
    np.testing.assert_allclose(
        loads.axial_force[loads.jammed], loads.spring_force[loads.jammed] / JAM_FLOOR
    )
    assert not loads.jammed[theta > np.pi + 1e-9].any()


@pytest.mark.parametrize(("friction", "jammed"), [(0.99, False), (1.01, True)])
def test_jam_limit(friction, jammed):
    """At 90 degrees tan(alpha) = 1/6 and a/b = 1/2: mu (3/2 + 1/2)/6 = 1 at mu = 3."""
    system = replace(SYSTEM, friction_a=3.0 * friction, friction_b=3.0 * friction)
    loads = follower_loads(harmonic(), system, SPEED, [0.5 * np.pi])
    assert loads.jammed.tolist() == [jammed]
    assert loads.jam_index == pytest.approx(friction, rel=1e-9)


def test_varying_cam_speed_adds_the_angular_acceleration():
    theta = uniform_turn(12)
    steady = follower_loads(harmonic(), SYSTEM, SPEED, theta)
    driven = follower_loads(harmonic(), SYSTEM, np.full(12, SPEED), theta, 1000.0)
    extra = 0.2 * 1000.0 * steady.lift_slope
    np.testing.assert_allclose(driven.inertia_force - steady.inertia_force, extra, atol=1e-12)


@pytest.mark.parametrize("face", [0.0, 0.1])
def test_torque_on_the_cam_is_that_of_the_loads_without_inertia(face):
    """The same terms in another order: round-off."""
    pitch, theta = harmonic(), uniform_turn(90)
    system = replace(SYSTEM, viscous_damping=2.0, face_friction=face)
    speed, change = 80.0 + 5.0 * np.cos(theta), 300.0 * np.sin(theta)
    loads = follower_loads(pitch, system, speed, theta, change)
    expected = loads.inertia_force * loads.lift_slope - loads.cam_torque
    torque = torque_on_cam(pitch, system, theta)(speed, change)
    np.testing.assert_allclose(torque, expected, rtol=1e-13, atol=1e-13)


def test_gravity_presses_on_the_cam():
    theta = uniform_turn(24)
    free = replace(SYSTEM, friction_a=0.0, friction_b=0.0)
    hung = replace(free, gravity_along_axis=9.81)
    gain = (
        follower_loads(harmonic(), hung, SPEED, theta).axial_force
        - follower_loads(harmonic(), free, SPEED, theta).axial_force
    )
    np.testing.assert_allclose(gain, 0.2 * 9.81, rtol=1e-10)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("mass", -0.1),
        ("guide_spacing", 0.0),
        ("overhang_at_max_lift", -0.01),
        ("friction_a", -0.01),
        ("friction_b", np.nan),
        ("gravity_along_axis", np.inf),
    ],
)
def test_bad_system_is_refused_by_name(field, value):
    with pytest.raises(InputError, match=field):
        replace(SYSTEM, **{field: value})


@pytest.mark.parametrize(("field", "value"), [("rate", 0.0), ("preload", -1.0)])
def test_bad_spring_of_a_system_is_refused_by_name(field, value):
    with pytest.raises(InputError, match=rf"spring\.{field}"):
        replace(SYSTEM, spring=replace(SYSTEM.spring, **{field: value}))


def test_bad_speed_and_angle_are_refused():
    with pytest.raises(InputError, match="cam_speed"):
        follower_loads(harmonic(), SYSTEM, -1.0, [0.0])
    with pytest.raises(InputError, match="theta"):
        follower_loads(harmonic(), SYSTEM, 1.0, [np.nan])


def test_the_overhang_is_least_at_the_largest_lift():
    loads = follower_loads(harmonic(), SYSTEM, SPEED, [0.0, np.pi])
    np.testing.assert_allclose(loads.overhang, [0.03 + STROKE, 0.03], rtol=1e-9)


def test_turn_integral_by_hand():
    """Corners (0, 1), (1, 2), (3, 4) and back to 1 at the full turn."""
    found = turn_integral(np.array([0.0, 1.0, 3.0]), np.array([1.0, 2.0, 4.0]))
    assert found == pytest.approx(1.5 + 6.0 + 2.5 * (2 * np.pi - 3.0), rel=1e-14)


def test_turn_integral_on_uneven_angles():
    rng = np.random.default_rng(5)
    theta = np.sort(rng.uniform(0.0, 2 * np.pi, 4000))
    assert turn_integral(theta, np.sin(theta) ** 2) == pytest.approx(np.pi, rel=1e-4)
    with pytest.raises(InputError, match="increasing"):
        turn_integral(theta[::-1], theta)


def test_loads_cannot_be_written_to():
    loads = follower_loads(harmonic(), SYSTEM, SPEED, uniform_turn(12))
    with pytest.raises(ValueError, match="read-only"):
        loads.normal_force[0] = 0.0

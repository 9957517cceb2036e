"""Pivot of an arm against a balance of forces in axes at rest, written without its formulas.

Accelerations are differences of positions, the direction of the contact is that of the contour's
normal, and contact and reaction follow from one another until they do not change.
"""

from dataclasses import replace

import numpy as np
import pytest
from stated_loads import pivot_reaction

from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.base.external_force import STANDARD_GRAVITY, ExternalForce
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    torque_on_cam,
    turn_integral,
)
from camwright.pipeline.follower.pivot_forces import ArmPivot, Pressed
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.spring_kinds import PivotSpring
from camwright.pipeline.follower.spring_link import SpringLink

WITH, AGAINST = 1.0, -1.0
ARM, START, STROKE, SPEED = 0.080, np.radians(35.0), 0.080 * np.radians(15.0), 60.0
CENTRES, RATE, PRELOAD = 0.090, 20e3, 250.0
MASS, FORCE = 0.9, 40.0
THETA = np.radians(np.array([10.0, 55.0, 100.0, 170.0, 190.0, 250.0, 300.0, 350.0]))


def cam(sense):
    theta = uniform_turn(720)
    lift = Lift(theta, 0.5 * STROKE * (1.0 - np.cos(theta)))
    return ArmContour(ArmPath(lift, Arm(CENTRES, ARM, sense), START), 0.008)


def pivot(sense, **other):
    every = {
        "length": ARM, "sense": sense, "start": START, "radius": 0.010, "friction": 0.15,
        "mass": MASS, "mass_distance": 0.05, "mass_angle": np.radians(25.0),
        "gravity_angle": np.radians(40.0), "load_distance": 0.06, "load_angle": np.radians(-30.0),
        "load_moment": 1.5,
    }  # fmt: skip
    return ArmPivot(**every | other)


def system(sense, mass=0.4, **other):
    return FollowerSystem(
        mass, Spring(rate=RATE, preload=PRELOAD), 0.1, 0.03, 0.0, 0.0,
        external=ExternalForce.constant(FORCE), pivot=pivot(sense, **other),
    )  # fmt: skip


def pressed(side):
    return Pressed(np.ones(side.shape), side)


def lifted(theta):
    return 0.5 * STROKE * (1.0 - np.cos(theta))


def point(sense, theta, distance, beyond):
    """Point of the arm in axes at rest: x to the pivot, y against the rotation of the cam."""
    angle = START + lifted(theta) / ARM + beyond
    return np.array([CENTRES - distance * np.cos(angle), sense * distance * np.sin(angle)])


def second(of, theta):
    """Second derivative by the cam angle, of eighth order in the step."""
    step = 0.02
    weights = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315,
                        -1 / 560])  # fmt: skip
    return sum(w * of(theta + (k - 4) * step) for k, w in enumerate(weights)) / step**2


def outwards(sense, theta, distance, beyond):
    """Unit vector of the outward swing of a point."""
    ahead, behind = (point(sense, theta, distance, beyond + h) for h in (1e-5, -1e-5))
    return (ahead - behind) / np.hypot(*(ahead - behind))


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


LINK = SpringLink(
    arm_radius=0.05, fixed_radius=0.09, fixed_angle=np.radians(60.0), arm_angle=np.radians(8.0),
    rate=40e3, preload=400.0, length=ARM,
)  # fmt: skip


def springs(sense, theta, kind):
    """Forces of the spring on the arm with their points, and its moment towards the cam."""
    if kind == "coil":
        force = -(PRELOAD + RATE * lifted(theta)) * outwards(sense, theta, ARM, 0.0)
        return [(point(sense, theta, ARM, 0.0), force)], 0.0
    if kind == "pivot":
        return [], 20.0 + 90.0 * lifted(theta) / ARM
    held = START + LINK.fixed_angle
    fixed = np.array([CENTRES - 0.09 * np.cos(held), sense * 0.09 * np.sin(held)])
    end = point(sense, theta, 0.05, np.radians(8.0))
    start = point(sense, 0.0, 0.05, np.radians(8.0))
    size = 400.0 + 40e3 * (np.hypot(*(start - fixed)) - np.hypot(*(end - fixed)))
    return [(end, size * (end - fixed) / np.hypot(*(end - fixed)))], 0.0


def spring_of(kind):
    if kind == "coil":
        return Spring(rate=RATE, preload=PRELOAD)
    own = {"link": LINK}
    if kind == "pivot":
        turned = PivotSpring(moment=20.0, angular_rate=90.0, length=ARM)
        own = {"kind": "torsion_pivot", "torsion_pivot": turned}
    return Spring(rate=1.0, preload=1.0, **own).with_derived()


def balance(sense, theta, pushed, friction=0.15, kind="coil"):
    """Contact force and reaction of the pivot at a cam angle, of forces and moments alone."""
    turned = np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]])
    normal = turned @ pushed.local_frame(np.array([theta])).normal[:, 0]
    at = np.array([CENTRES, 0.0])
    closing, couple = springs(sense, theta, kind)
    roller, centre = point(sense, theta, ARM, 0.0), point(sense, theta, 0.05, np.radians(25.0))
    acted = point(sense, theta, 0.06, np.radians(-30.0))
    up = np.array([np.cos(np.radians(40.0)), np.sin(np.radians(40.0))])
    forces = [
        *closing,
        (acted, -FORCE * outwards(sense, theta, 0.06, np.radians(-30.0))),
        (centre, -MASS * STANDARD_GRAVITY * up),
    ]
    thrown = MASS * SPEED**2 * second(lambda t: point(sense, t, 0.05, np.radians(25.0)), theta)
    # the moment of inertia about the pivot is that of 0.4 kg at the roller
    turning = 0.4 * ARM * SPEED**2 * second(lifted, theta)
    way = 1.0 if np.sin(theta) > 0.0 else -1.0

    # the outward swing is clockwise with the rotation of the cam
    known = -sense * sum(cross(p - at, f) for p, f in forces) - 1.5 - turning - couple
    lever, reaction = -sense * cross(roller - at, normal), np.zeros(2)
    for _ in range(60):
        contact = (way * friction * 0.010 * np.hypot(*reaction) - known) / lever
        reaction = thrown - contact * normal - sum(each for _, each in forces)
    return contact, *reaction


@pytest.mark.parametrize("kind", ["coil", "pivot", "link"])
@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_contact_and_reaction_balance_the_forces_at_rest(sense, kind):
    pushed, spring = cam(sense), spring_of(kind)
    held = system(sense, spring=spring.shape)
    loads = follower_loads(pushed.pitch, replace(held, spring=spring), SPEED, THETA)
    for k, theta in enumerate(THETA):
        contact, along, across = balance(sense, theta, pushed, kind=kind)
        assert contact > 50.0
        size = np.hypot(along, across)
        assert loads.normal_force[k] == pytest.approx(contact, rel=1e-8)
        # across is clockwise in the loads
        reaction = pivot_reaction(loads)[:, k]
        np.testing.assert_allclose(reaction, [along, -across], rtol=0, atol=1e-8 * size)
        assert loads.pivot_friction[k] * ARM == pytest.approx(0.15 * 0.010 * size, rel=1e-8)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_cam_work_over_a_turn_is_the_friction(sense):
    pushed, theta = cam(sense), uniform_turn(720)
    loads = follower_loads(pushed.pitch, system(sense), SPEED, theta)
    work = turn_integral(theta, loads.cam_torque)
    moment = 0.15 * 0.010 * np.hypot(*loads.pivot_load)
    rubbed = turn_integral(theta, moment * np.abs(pushed.lift(theta, 1)) / ARM)
    assert rubbed > 0.05
    assert work == pytest.approx(rubbed, rel=1e-9)
    assert loads.friction_loss == pytest.approx(rubbed, rel=1e-9)
    power = turn_integral(theta, loads.friction_power) / SPEED
    assert power == pytest.approx(rubbed, rel=1e-9)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_without_friction_and_mass_the_torque_is_the_change_of_the_energy(sense):
    """Of spring, weight, external force at its point, and moment."""
    pushed, theta = cam(sense), np.linspace(0.0, FULL_TURN, 41)
    free = system(sense, mass=0.0, friction=0.0)
    loads = follower_loads(pushed.pitch, free, 0.0, theta)

    def energy(at):
        s = pushed.lift(at)
        height = np.array([
            np.cos(np.radians(40.0)), np.sin(np.radians(40.0)),
        ]) @ (np.array([CENTRES + 0.0 * s, 0.0 * s]) + 0.05 * np.array([
            -np.cos(START + s / ARM + np.radians(25.0)),
            sense * np.sin(START + s / ARM + np.radians(25.0)),
        ]))  # fmt: skip
        stored = PRELOAD * s + 0.5 * RATE * s**2 + (FORCE * 0.06 + 1.5) * s / ARM
        return stored + MASS * STANDARD_GRAVITY * height

    step = 4e-3
    near, far = (energy(theta + k * step) - energy(theta - k * step) for k in (1, 2))
    rate = (8.0 * near - far) / (12.0 * step)
    scale = np.abs(rate).max()
    np.testing.assert_allclose(loads.cam_torque, rate, rtol=0, atol=1e-9 * scale)


def test_the_axial_force_is_differentiated_by_a_complex_step():
    """The reference is a difference of fourth order."""
    about, step = pivot(WITH), 1e-30
    required, side = np.array([300.0, 500.0, 90.0]), np.array([0.2, -0.4, 0.05])
    way = np.array([1.0, -1.0, 0.0])

    def solved(x):
        pull = about.pull(required + x, 40.0, 0.7 + 1e-3 * x, 2.0 + 0.1 * x, 30.0 - x)
        return about.balanced(required + 2.0 * x, pressed(side * (1.0 + 0.01 * x)), pull, way)

    exact = solved(1j * step)
    h = 1e-2
    for name in ("axial", "load", "friction", "jam_index"):
        near, far = (
            getattr(solved(k * h), name) - getattr(solved(-k * h), name) for k in (1.0, 2.0)
        )
        difference = (8.0 * near - far) / (12.0 * h)
        slope = np.imag(getattr(exact, name)) / step
        np.testing.assert_allclose(slope, difference, rtol=1e-8, atol=1e-8 * np.abs(slope).max())


def test_a_steep_arm_on_a_thick_pin_locks_itself():
    """At mu r/l sqrt(1 + tan^2) = 1 no contact force moves it; just below it the force is large."""
    side, required = np.array([1.0]), np.array([400.0])
    locking = 1.0 / np.sqrt(2.0)
    for share, locks in ((0.999, False), (1.001, True)):
        about = pivot(WITH, friction=1.0, radius=share * locking * ARM)
        pull = about.pull(required, 0.0, np.zeros(1), 0.0, 0.0)
        free = about.balanced(required, pressed(side), pull, np.ones(1))
        assert (free.axial[0] < 0.0) == locks
        assert (free.jam_index[0] >= 1.0) == locks
        held = about.clipped(required, pressed(side), pull, np.ones(1), 0.01)
        assert 0.0 < held.axial[0] <= 100.0 * 400.0


def test_friction_that_holds_the_arm_off_the_cam_loses_the_contact():
    """On the return a pin under its spring needs more than the force that is left."""
    about = pivot(WITH, friction=0.9, radius=0.05, load_moment=0.0, gravity_angle=None)
    required, side = np.array([40.0]), np.zeros(1)
    pull = about.pull(np.array([400.0]), 0.0, np.zeros(1), 0.0, 0.0)
    assert about.balanced(required, pressed(side), pull, -np.ones(1)).axial[0] < 0.0
    held = about.clipped(required, pressed(side), pull, -np.ones(1), 0.01)
    assert held.axial[0] == 0.0 and held.friction[0] == 0.0


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_the_torque_of_the_crank_speed_is_that_of_the_loads(sense):
    pushed, theta, acted = cam(sense), uniform_turn(90), system(sense)
    rate = 300.0 * np.sin(theta)
    loads = follower_loads(pushed.pitch, acted, SPEED, theta, rate)
    inertia = loads.inertia_force * loads.lift_slope
    torque = torque_on_cam(pushed.pitch, acted, theta)(np.full(90, SPEED), rate)
    np.testing.assert_allclose(torque, inertia - loads.cam_torque, rtol=0, atol=1e-11)


def test_a_long_arm_has_the_forces_of_a_stem_without_friction():
    """A pin of no radius carries no moment."""
    pushed, theta = cam(WITH), uniform_turn(180)
    still = {"gravity_angle": None, "load_distance": ARM, "load_angle": 0.0, "load_moment": 0.0}
    acted = system(WITH, radius=0.0, **still)
    with_pivot = follower_loads(pushed.pitch, acted, SPEED, theta)
    without = follower_loads(pushed.pitch, replace(acted, pivot=None), SPEED, theta)
    np.testing.assert_allclose(with_pivot.axial_force, without.axial_force, rtol=1e-14)

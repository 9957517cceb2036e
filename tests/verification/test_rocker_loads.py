"""Output of a rocker on its arm against forces and moments in axes at rest, and its energy.

The balance takes contact, spring, inertia and the push of the output on its pad as vectors at their
points; the path of the pad is drawn, and the acceleration of the output a difference of it.
"""

from dataclasses import replace

import numpy as np
import pytest
from test_pivot import (
    AGAINST,
    ARM,
    CENTRES,
    FORCE,
    MASS,
    PRELOAD,
    RATE,
    SPEED,
    THETA,
    WITH,
    cam,
    cross,
    lifted,
    outwards,
    point,
    second,
    system,
)

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Jet
from camwright.pipeline.base.external_force import STANDARD_GRAVITY, ExternalForce
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.template import first_case
from camwright.pipeline.cycle.crank_speed import follower_inertia
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.solved_cam import numbers_of
from camwright.pipeline.follower.follower_forces import follower_loads, torque_on_cam
from camwright.pipeline.follower.rocker import Rocker, RockerOutput

LONG, RAISED, OUTPUT, HELD = 0.055, np.radians(-12.0), 0.35, 90.0
STEP = 1e-30


def rocker(side, kind):
    if kind == "ratio":
        return Rocker(ratio=LONG / ARM, side=side, output_mass=OUTPUT, output_force=HELD)
    return Rocker(length=LONG, angle=RAISED, side=side, output_mass=OUTPUT)


def moved(kind, lift):
    """Travel of the output, m: of the pad along its line, or of the end along its arc."""
    if kind == "ratio":
        return LONG * lift / ARM
    return LONG * (np.sin(RAISED + lift / ARM) - np.sin(RAISED))


def loaded(sense, side, kind):
    output = RockerOutput(rocker(side, kind), ARM)
    held = system(sense, mass=0.4 + output.reduced_mass, output=output)
    external = ExternalForce.constant(FORCE + output.reduced_force)
    return replace(held, external=external, output=output)


def pushed_pad(sense, side, kind, theta):
    """Pad of the second arm, and the unit vector against the stroke of the output there."""
    away = 0.0 if side == "same" else np.pi
    pad = point(sense, theta, LONG, away)
    stroke = outwards(sense, theta, LONG, away)  # square to the arm, as the pad swings
    if kind == "length":  # the line of the output is at rest: square to the arm at the angle zero
        stroke = outwards(sense, 0.0, LONG, away - RAISED)
    return pad, -stroke


@pytest.mark.parametrize("kind", ["ratio", "length"])
@pytest.mark.parametrize("side", ["opposite", "same"])
@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_contact_and_reaction_balance_the_push_of_the_output(sense, side, kind):
    pushed, held = cam(sense), loaded(sense, side, kind)
    loads = follower_loads(pushed.pitch, held, SPEED, THETA)
    at, friction = np.array([CENTRES, 0.0]), 0.15
    up = np.array([np.cos(np.radians(40.0)), np.sin(np.radians(40.0))])
    for k, theta in enumerate(THETA):
        turned = np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]])
        normal = turned @ pushed.local_frame(np.array([theta])).normal[:, 0]
        roller, centre = point(sense, theta, ARM, 0.0), point(sense, theta, 0.05, np.radians(25.0))
        acted = point(sense, theta, 0.06, np.radians(-30.0))
        pad, against = pushed_pad(sense, side, kind, theta)
        own = HELD if kind == "ratio" else 0.0
        push = own + OUTPUT * SPEED**2 * second(lambda t: moved(kind, lifted(t)), theta)
        forces = [
            (roller, -(PRELOAD + RATE * lifted(theta)) * outwards(sense, theta, ARM, 0.0)),
            (acted, -FORCE * outwards(sense, theta, 0.06, np.radians(-30.0))),
            (centre, -MASS * STANDARD_GRAVITY * up),
            (pad, push * against),
        ]
        thrown = MASS * SPEED**2 * second(lambda t: point(sense, t, 0.05, np.radians(25.0)), theta)
        turning = 0.4 * ARM * SPEED**2 * second(lifted, theta)
        way = 1.0 if np.sin(theta) > 0.0 else -1.0
        known = -sense * sum(cross(p - at, f) for p, f in forces) - 1.5 - turning
        lever, reaction = -sense * cross(roller - at, normal), np.zeros(2)
        for _ in range(60):
            contact = (way * friction * 0.010 * np.hypot(*reaction) - known) / lever
            reaction = thrown - contact * normal - sum(each for _, each in forces)
        assert contact > 50.0
        size = np.hypot(*reaction)
        assert loads.normal_force[k] == pytest.approx(contact, rel=1e-8)
        assert np.hypot(*loads.pivot_load[:, k]) == pytest.approx(size, rel=1e-8)
        assert loads.pivot_friction[k] * ARM == pytest.approx(friction * 0.010 * size, rel=1e-8)


@pytest.mark.parametrize("kind", ["ratio", "length"])
def test_without_friction_the_torque_is_the_change_of_stored_and_kinetic_energy(kind):
    """Within 1e-9 of the greatest; the kinetic energy by the drawn travel of the output."""
    pushed, theta = cam(WITH), uniform_turn(360)
    free = replace(loaded(WITH, "opposite", kind), pivot=None)
    loads = follower_loads(pushed.pitch, free, SPEED, theta)

    def energy(at):
        s = pushed.lift(at)
        slope = pushed.lift(at, 1)
        ratio = np.imag(moved(kind, s + 1j * STEP)) / STEP
        constant = FORCE * s + (HELD * moved("ratio", s) if kind == "ratio" else 0.0)
        moving = 0.5 * (0.4 + OUTPUT * ratio**2) * (SPEED * slope) ** 2
        return PRELOAD * s + 0.5 * RATE * s**2 + constant + moving

    step = 4e-3
    near, far = (energy(theta + k * step) - energy(theta - k * step) for k in (1, 2))
    wide = energy(theta + 3 * step) - energy(theta - 3 * step)
    rate = (45.0 * near - 9.0 * far + wide) / (60.0 * step)
    scale = np.abs(rate).max()
    np.testing.assert_allclose(loads.cam_torque, rate, rtol=0, atol=1e-9 * scale)
    own = OUTPUT * (np.imag(moved(kind, pushed.lift(theta) + 1j * STEP)) / STEP) ** 2
    turning = follower_inertia(pushed.pitch, free, 2.0, theta.size)
    wanted = (0.4 + own) * (0.5 * pushed.lift(theta, 1)) ** 2
    np.testing.assert_allclose(turning, wanted, rtol=1e-12, atol=1e-20)
    # the torque on the cam at any speed and acceleration leaves the inertia out
    resting = torque_on_cam(pushed.pitch, free, theta)(SPEED, 40.0)
    still = follower_loads(pushed.pitch, free, 0.0, theta).cam_torque
    np.testing.assert_allclose(resting, -still, rtol=0, atol=1e-12 * scale)


def test_a_case_has_the_output_in_cycle_checks_and_synthesis_alike():
    """Force and reaction of a solved cam and of its measures from the numbers of the case."""
    stated = '[rocker]\nlength = "60 mm"\nangle = "-10 deg"\nmass = "400 g"\n\n[lubricant]'
    whole = first_case("swing", "arm").text
    case = parse_case(whole.replace("[lubricant]", stated, 1))
    plain = parse_case(whole)
    (machine, *_), lift = machines(case), given_lift(case)
    assert case.output.mass == pytest.approx(0.4)
    assert parse_case(case.to_toml()).output == case.output
    assert parse_case(case.to_toml()).follower.mass == pytest.approx(case.follower.mass)
    reduced = case.output.reduced_mass
    assert machine.arm_pivot.mass == pytest.approx(machines(plain)[0].arm_pivot.mass, rel=1e-6)
    assert case.follower.mass == pytest.approx(plain.follower.mass + reduced, rel=1e-6)
    contour, theta = case.contour(lift), uniform_turn(24)
    loads = follower_loads(contour.pitch, machine.system, machine.cam_speed, theta)
    jet = Jet(*lift.derivatives(theta, 2))
    measured = LoadedCam(jet, numbers_of(case, [machine]), lift.highest.value)
    np.testing.assert_allclose(measured.inertia, loads.inertia_force, rtol=1e-10, atol=1e-10)
    size = np.hypot(*loads.pivot_load)
    moving = np.abs(loads.lift_slope) > 1e-9
    np.testing.assert_allclose(measured.pivot_load[moving], size[moving], rtol=1e-8)
    still = follower_loads(
        contour.pitch, replace(machine.system, output=None, pivot=replace(
            machine.arm_pivot, output=None)), machine.cam_speed, theta,
    )  # fmt: skip
    assert np.abs(np.hypot(*still.pivot_load) / size - 1.0).max() > 1e-3

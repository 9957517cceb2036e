"""Impact of the teeth in their backlash against the equations of motion of gear and cam."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from trial_variants import struck

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.pipeline.checks.camshaft_strength import gear_impact
from camwright.pipeline.follower.camshaft_loads import (
    MESH_DAMPING,
    Rotor,
    impact,
    torque_reversals,
)

RADIUS, SPEED = 0.04, 180.0  # m, rad/s
GEAR, CAM = 6e-4, 4e-4  # kg m2
MESH = 4e8  # N/m
THETA = uniform_turn(720)


def torque(theta: np.ndarray, size: float = 12.0) -> np.ndarray:
    return size * np.sin(2.0 * theta + 0.3) + 0.2 * size * np.cos(theta)


def integrated(twist: float, gap: float, start: float, size: float) -> tuple[float, float]:
    """Greatest force on the teeth, N, and cam angle of the meeting, from the equations of motion.

    Gear and cam on an elastic shaft, torque on the cam, the drive of steady speed; gap over the
    pitch radius, rad.
    """

    def moved(time: float, state: np.ndarray) -> list[float]:
        gear, cam, gear_speed, cam_speed = state
        shaft = twist * (cam - gear)
        push = sense * float(torque(np.array(start + SPEED * time), size))
        if gear <= gap:
            return [gear_speed, cam_speed, shaft / GEAR, (push - shaft) / CAM]
        braked = damping @ [gear_speed, cam_speed]
        teeth = MESH * RADIUS**2 * (gear - gap)
        return [gear_speed, cam_speed, (shaft - teeth - braked[0]) / GEAR,
                (push - shaft - braked[1]) / CAM]  # fmt: skip

    def meets(time: float, state: np.ndarray) -> float:
        return float(state[0] - gap)

    def parts(time: float, state: np.ndarray) -> float:
        return float(state[0] - gap)

    inertia = np.diag([GEAR, CAM])
    stiff = np.array([[MESH * RADIUS**2 + twist, -twist], [-twist, twist]])
    squares, modes = eigh(stiff, inertia)
    braking = inertia @ modes @ np.diag(2.0 * MESH_DAMPING * np.sqrt(squares))
    damping = braking @ modes.T @ inertia
    sense = 1.0 if torque(np.array(start + 1e-3), size) > 0 else -1.0
    meets.terminal = True  # type: ignore[attr-defined]
    parts.terminal, parts.direction = True, -1.0  # type: ignore[attr-defined]
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-15}
    flight = solve_ivp(moved, (0.0, 0.03), np.zeros(4), events=meets, **options)
    begun = float(flight.t[-1])
    span = (begun, begun + np.pi / np.sqrt(squares[0]))
    contact = solve_ivp(moved, span, flight.y[:, -1], max_step=4e-6, events=parts, **options)
    force = MESH * RADIUS * np.maximum(contact.y[0] - gap, 0.0)
    return float(force.max()), start + SPEED * begun


@pytest.mark.parametrize("twist", [3e3, 1.3e4, 6e4, 1e6])
@pytest.mark.parametrize(("size", "backlash"), [(2.0, 1e-4), (12.0, 2e-5), (60.0, 1.5e-4)])
def test_impact_against_the_equations_of_motion(size: float, backlash: float, twist: float) -> None:
    """Force, speed and place within 0.5 %: trapezia of 800 steps; a stiff shaft takes as many."""
    rotor = Rotor(GEAR, CAM, twist, MESH, RADIUS)
    for reversal in torque_reversals(THETA, torque(THETA, size)):
        found = impact(THETA, torque(THETA, size), reversal, SPEED, rotor, backlash)
        assert found is not None
        force, at = integrated(twist, backlash / RADIUS, reversal.theta, size)
        assert found.force == pytest.approx(force, rel=5e-3)
        assert found.theta == pytest.approx(at % (2.0 * np.pi), abs=5e-4)


def test_flight_under_a_steady_slope() -> None:
    """T = k (theta - theta0): after (6 J b/(k w))^(1/3) with k w t^2/(2 J), and sqrt(c J) v/r."""
    slope, backlash, inertia = 80.0, 1e-4, GEAR + CAM
    steady = slope * (THETA - 1.0)
    (reversal,) = [each for each in torque_reversals(THETA, steady) if each.slope > 0]
    rotor = Rotor(GEAR, CAM, 1e9, MESH, RADIUS)
    found = impact(THETA, steady, reversal, SPEED, rotor, backlash)
    assert found is not None
    time = (6.0 * inertia * backlash / RADIUS / (slope * SPEED)) ** (1.0 / 3.0)
    speed = slope * SPEED * time**2 / (2.0 * inertia) * RADIUS
    push = slope * SPEED * time / RADIUS
    assert found.theta == pytest.approx(1.0 + SPEED * time, abs=5e-4)
    assert found.speed == pytest.approx(speed, rel=5e-3)
    free = push + np.sqrt(push**2 + MESH * inertia / RADIUS**2 * speed**2)
    damped = np.exp(-MESH_DAMPING * np.arccos(MESH_DAMPING))  # of a swing without a push
    assert found.force == pytest.approx(damped * free, rel=0.03)  # the torque grows meanwhile


def test_no_crossing() -> None:
    """A pulse too short for the backlash turns the rotor back; without backlash nothing strikes."""
    pulse = np.where(np.abs(THETA - 1.0) < 0.02, 1e-3, -5.0)
    first, _ = torque_reversals(THETA, pulse)
    rotor = Rotor(GEAR, CAM, 1e4, MESH, RADIUS)
    assert impact(THETA, pulse, first, SPEED, rotor, 4e-3) is None
    closed = impact(THETA, pulse, first, SPEED, rotor, 0.0)
    assert closed is not None and closed.speed == pytest.approx(0.0, abs=1e-6)


def test_polar_moment_of_a_contour() -> None:
    """An eccentric disc by the theorem of Steiner: within 1e-9."""
    radius, eccentricity = 0.02, 0.005
    lift = Lift(THETA, eccentricity * (1.0 - np.cos(THETA)))
    contour = FlatFaceContour(FacePath(lift, radius - eccentricity))
    disc = np.pi * radius**2
    exact = disc * (0.5 * radius**2 + eccentricity**2)
    assert contour.polar_moment() == pytest.approx(exact, rel=1e-9)


def test_gear_impact_of_a_made_turn() -> None:
    """The check under a steady torque, rigid shaft: any inertia strikes as hard, within 5e-4."""
    push = 4.5 / 0.02
    mesh, mass, gap = 20e9 * 210.0 / 206.0 * 0.01, 0.3, 1e-4

    brake = 2.0 * MESH_DAMPING * np.sqrt(mesh * mass)

    def moved(_: float, state: np.ndarray) -> list[float]:
        touching = state[0] > gap
        teeth = mesh * (state[0] - gap) + brake * state[1] if touching else 0.0
        return [state[1], (push - teeth) / mass]

    swing = solve_ivp(moved, (0.0, 2e-2), [0.0, 0.0], max_step=1e-6, rtol=1e-9, atol=1e-13)
    force = mesh * float(swing.y[0].max() - gap)
    root = 0.01 * 1e-3 * np.pi * (0.154 - 0.912 / 20)
    assert gear_impact(struck()).demand == pytest.approx(force / root, rel=5e-4)

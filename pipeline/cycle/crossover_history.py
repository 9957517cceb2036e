"""Landings of the roller in its groove over a turn of one load case, with force, pressure, slip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import Contour
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.conforming_line import concave_line
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.follower.crossover import Landing, landings
from camwright.pipeline.follower.follower_forces import follower_loads

FINE = 14400
"""Angles of a turn at which the force of a flight is evaluated."""


class WallImpact(NamedTuple):
    """Landing on a wall, with what it does there.

    flight; force : greatest normal force, N, of the mass on the stiffness of the follower, NaN
    without one; pressure : under it, Pa, of Hertz or conforming; slip : of the roller's surface on
    the wall as it lands, m/s, 0 on the wall that it has left
    """

    flight: Landing
    force: float
    pressure: float
    slip: float


def impacts(machine: Machine, contour: Contour) -> tuple[WallImpact, ...]:
    """Landings of a rigid follower in a groove; none at standstill and without a groove.

    The roller keeps its spin in flight: on the other wall it is to turn the other way, so that its
    surface slips at twice the speed along the path. A mass m that lands at v under a force F on a
    stiffness k is stopped by F + sqrt(F^2 + k m v^2); contact and walls are taken as rigid.
    """
    groove = machine.cam.groove
    if groove is None or not machine.speed > 0.0:
        return ()
    theta, pitch = uniform_turn(FINE), contour.pitch
    rigid = machine.system.with_friction(0.0, 0.0)
    loads = follower_loads(pitch, rigid, machine.cam_speed, theta)
    found = landings(
        loads.required_force,
        groove.clearance / np.cos(loads.pressure_angle),
        machine.mass,
        machine.cam_speed,
        stiffness=machine.spring.rate,
        damping=machine.viscous_damping,
    )
    return tuple(_impact(machine, contour, one) for one in found)


def _impact(machine: Machine, contour: Contour, flight: Landing) -> WallImpact:
    """What a landing does to the wall: normal force, Hertz pressure and slip; NaN where the flight
    does not end.

    Parameters
    ----------
    flight : Landing   of the rigid follower, with wall, angle, speed and force at the landing
    """
    at, speed = np.array([flight.landing % FULL_TURN]), machine.cam_speed
    if np.isnan(flight.landing):
        return WallImpact(flight, np.nan, np.nan, np.nan)
    pressed, struck = max(flight.force, 0.0), machine.axial_stiffness * machine.mass
    axial = pressed + np.sqrt(pressed**2 + struck * flight.speed**2)
    force = float(axial / np.cos(contour.pitch.pressure_angle(at))[0])
    radius = contour.require_roller().relative_radius(at, np.array([flight.wall]))
    load = np.array([force / machine.contact_width])
    pressure = np.array([np.nan])
    if np.isfinite(force) and radius[0] > 0.0:
        _, pressure = hertz.line_contact(load, radius, machine.contact_modulus)
        bodies = (
            Elastic(card.E, card.nu) for card in (machine.roller.material, machine.cam.material)
        )
        _, line = concave_line(load, radius, machine.roller.radius, *bodies)
        pressure = pressure if line is None else line.p0
    path = float(contour.pitch.speed_and_curvature(at)[0][0])
    slip = 2.0 * speed * path if flight.crosses else 0.0
    return WallImpact(flight, force, float(pressure[0]), slip)

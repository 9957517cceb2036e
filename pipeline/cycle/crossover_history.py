"""Landings of a follower between two tracks in a turn of a load case: force, pressure, slip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.second_track import SecondFollower, discs_of, relative_radius
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.conforming_line import concave_line
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.follower.crossover import INNER, OUTER, Landing, landings
from camwright.pipeline.follower.follower_forces import Carried, follower_loads

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
    """Landings of a rigid follower between its tracks; none at standstill, and of one track.

    A roller keeps its spin in flight: on the other wall of a groove it is to turn the other way, so
    that its surface slips at twice the speed along the path; that of a second disc has kept the
    spin with which it last left the disc. A mass m that lands at v under a force F on a
    stiffness k is stopped by F + sqrt(F^2 + k m v^2); contact and walls are taken as rigid.
    """
    if not (machine.cam.clearance > 0.0 and machine.speed > 0.0):
        return ()
    theta, pitch = uniform_turn(FINE), contour.pitch
    rigid = machine.system.with_friction(0.0, 0.0)
    loads = follower_loads(pitch, rigid, machine.cam_speed, theta)
    pulled = Carried.at(pitch, rigid, theta, np.full(theta.size, OUTER))
    along = pulled.slide.lever * np.cos(pulled.pressure_angle)
    found = landings(
        loads.required_force,
        machine.clearance_on(pitch, theta) / along,
        machine.mass,
        machine.cam_speed,
        stiffness=machine.spring.rate,
        damping=machine.viscous_damping,
    )
    return tuple(_impact(machine, contour, found, k) for k in range(len(found)))


def _impact(
    machine: Machine, contour: Contour, flights: Sequence[Landing], number: int
) -> WallImpact:
    """What a landing does to its track: normal force, pressure and slip; NaN where the flight does
    not end.

    Parameters
    ----------
    flights, number : landings of the rigid follower over the turn, in their order, and which
    """
    flight = flights[number]
    at, wall = np.array([flight.landing % FULL_TURN]), np.array([flight.wall])
    if np.isnan(flight.landing):
        return WallImpact(flight, np.nan, np.nan, np.nan)
    pressed, struck = max(flight.force, 0.0), machine.axial_stiffness * machine.mass
    axial = pressed + np.sqrt(pressed**2 + struck * flight.speed**2)
    second = machine.cam.second
    there = Carried.at(contour.pitch, machine.system, at, wall)
    force = float((axial / (there.slide.lever * np.cos(there.pressure_angle)))[0])
    radius = relative_radius(contour, second, at, wall)
    load = np.array([force / machine.contact_width])
    pressure = np.array([np.nan])
    if np.isfinite(force) and radius[0] > 0.0:
        _, pressure = hertz.line_contact(load, radius, machine.contact_modulus)
    if contour.rolls and not np.isnan(pressure[0]):
        carrying = (
            machine.roller.radius if second is None or flight.wall == INNER else second.radius
        )
        bodies = (
            Elastic(card.E, card.nu) for card in (machine.roller.material, machine.cam.material)
        )
        _, line = concave_line(load, radius, np.array([carrying]), *bodies)
        pressure = pressure if line is None else line.p0
    slip = machine.cam_speed * _slip(contour, second, flights, number) if flight.crosses else 0.0
    return WallImpact(flight, force, float(pressure[0]), slip)


def _slip(
    contour: Contour, second: SecondFollower | None, flights: Sequence[Landing], number: int
) -> float:
    """Slip of the roller on the track on which it lands, m: sliding speed over cam speed.

    In a groove, twice the speed along the path. On a second disc, roller radius times the change of
    the spin over the cam speed since the roller of this disc last left it.

    Parameters
    ----------
    second : SecondFollower or None     None: both tracks are the walls of a groove
    flights, number : sequence, int   landings over the turn, in their order, and which of them
    """
    flight = flights[number]
    if not contour.rolls:  # a face slides as ever
        return 0.0
    if second is None:
        return 2.0 * float(contour.pitch.speed_and_curvature(np.array([flight.landing]))[0][0])
    count = len(flights)
    earlier = [flights[(number - k) % count] for k in range(1, count + 1)]
    left = next((one for one in earlier if one.start == flight.wall), flight)
    disc = discs_of(contour, second)[0 if flight.wall == INNER else 1]
    track = disc.contour.require_roller()
    angles = np.array([flight.landing, left.take_off]) + disc.turn
    motion = track.pitch.centre_motion(track.lift.jet(angles, 2), track.roller_radius)
    there, before = np.asarray(motion.rolling)
    return float(track.roller_radius * abs(there - before))

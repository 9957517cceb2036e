"""Response of the elastic follower over a turn at the computed cam speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.extrema import first_greatest
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import PeriodicPolynomial, periodic_quintic
from camwright.pipeline.base.external_force import ExternalForce
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.follower.elastic_follower import (
    ElasticFollower,
    Response,
    is_steady,
    periodic_response,
)
from camwright.pipeline.follower.follower_flight import Flight, bounce

BOUNCE_TURNS = 1.0
_START_BEFORE = 0.1  # of a turn before a loss of contact, from where the motion is integrated


@dataclass(frozen=True, eq=False)
class ElasticHistory:
    """Response of the elastic follower over one turn; arrays (n,), SI.

    response is the periodic one with the contact kept, deflection the shortening of the train.
    flights are the losses of contact in one turn, which begins with the state of that response in
    its longest contact; force_max is the maximum contact force. method states speed and
    solution.
    """

    response: Response
    deflection: Array
    flights: tuple[Flight, ...]
    force_max: float
    method: str

    def __post_init__(self) -> None:
        freeze(self, deflection=self.deflection)


def elastic_follower(machine: Machine, lift: Array | None = None) -> ElasticFollower:
    """Follower mass on bearing, pin, fork, stem and camshaft in series, with that of the output of
    a rocker.

    Parameters
    ----------
    lift : array (n,)   at equal angles of a turn, m, at which a spring that is not linear differs
                        from its tangent at zero lift, and the weight of an arm from that there;
                        None: neither does
    """
    load = machine.system.load
    if lift is not None and (machine.spring.shape is not None or machine.system.pivot is not None):
        spring, theta = machine.spring, uniform_turn(lift.size)
        bent = spring.force(lift) - (spring.preload + spring.rate * lift)
        load = ExternalForce(theta, machine.system.applied_force(theta, lift) + bent)
    return ElasticFollower.with_damping_ratio(
        machine.mass,
        machine.axial_stiffness,
        machine.spring.rate,
        machine.spring.preload,
        machine.damping_ratio,
        load,
        machine.output if machine.output is not None and machine.output.changes else None,
    )


def elastic_history(
    machine: Machine, lift: Lift, at: Array, cam_speed: Array, *, flights: bool = True
) -> ElasticHistory:
    """Response of the elastic follower at equal angles of a turn.

    Parameters
    ----------
    lift : Lift
    at : array (n,)          the lift at these angles, m
    cam_speed : array (n,)   rad/s
    flights : bool           compute the flights, by far the most expensive part
    """
    follower = elastic_follower(machine, at)
    response = periodic_response(at, cam_speed, follower)
    lost: tuple[Flight, ...] = ()
    force = float(response.contact_force.max())
    if response.lost and flights:
        k = _start_position(response.contact_force)
        start = (float(response.position[k]), float(response.velocity[k]))
        first = float(response.theta[k])
        jump = bounce(lift, _law(cam_speed), follower, BOUNCE_TURNS, start, first)
        lost, force = jump.flights, float(jump.contact_force.max())
    method = _method(cam_speed, constant=follower.output is None)
    return ElasticHistory(response, at - response.position, lost, force, method)


def _start_position(contact_force: Array) -> int:
    """Number of the position from which the motion is integrated: within the longest contact of a
    turn, `_START_BEFORE` of a turn before its end, at most half of the contact before it.

    The response with the contact kept is least disturbed there by what would follow a loss of
    contact. Without any contact the position of the greatest force.

    Parameters
    ----------
    contact_force : array (n,)   of the response with the contact kept, N; negative at a loss of
        contact
    """
    lost, count = np.flatnonzero(contact_force < 0.0), contact_force.size
    if lost.size == count:
        return first_greatest(contact_force)
    spans = np.diff(lost, append=lost[0] + count)
    k = first_greatest(spans)
    back = min(spans[k] // 2, int(_START_BEFORE * count))
    return int((lost[k] + spans[k] - max(back, 1)) % count)


def _law(cam_speed: Array) -> float | PeriodicPolynomial:
    return float(cam_speed[0]) if is_steady(cam_speed) else periodic_quintic(cam_speed)


def _method(cam_speed: Array, *, constant: bool) -> str:
    """Method of the solution in words, by cam speeds (n,), rad/s; constant: of the mass."""
    if is_steady(cam_speed):
        if constant:
            return "harmonic balance at constant speed"
        return "collocation at constant speed, with the mass of the output by its ratio"
    low, high = cam_speed.min(), cam_speed.max()
    swing = 100.0 * (high - low) / (0.5 * (high + low))
    return f"collocation on the computed speed, which varies by {swing:.2g} %"

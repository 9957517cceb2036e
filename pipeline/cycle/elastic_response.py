"""The follower on its elastic stem over a turn of a case, at the speed the crank really has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import PeriodicPolynomial, periodic_quintic
from camwright.pipeline.case.case import Case
from camwright.pipeline.follower.elastic_follower import (
    ElasticFollower,
    Response,
    is_steady,
    periodic_response,
)
from camwright.pipeline.follower.follower_flight import Flight, bounce
from camwright.pipeline.follower.stem_beam import Stem

BOUNCE_TURNS = 1.0


@dataclass(frozen=True, eq=False)
class ElasticHistory:
    """One turn; arrays (n,) SI.

    response is the steady one with the contact held, deflection what it shortens the stem by;
    flights are the losses of contact in one turn from there, where it does not hold, and
    force_max the greatest force of it. method says at which speed, and how.
    """

    response: Response
    deflection: Array
    flights: tuple[Flight, ...]
    force_max: float
    method: str

    def __post_init__(self) -> None:
        freeze(self, deflection=self.deflection)


def elastic_follower(case: Case) -> ElasticFollower:
    """The follower on its stem: a stiffness given, or E A/l of the stem up to guide B."""
    given, stem = case.follower, Stem.from_case(case)
    length = given.overhang_at_max_lift + case.guides.spacing
    stiffness = given.stiffness
    if stiffness is None:
        stiffness = stem.elastic_modulus * 0.25 * np.pi * stem.diameter**2 / length
    return ElasticFollower.with_damping_ratio(
        given.mass, stiffness, case.spring.rate, case.spring.preload, given.damping_ratio
    )


def elastic_history(
    case: Case, lift: Lift, at: Array, cam_speed: Array, flights_too: bool = True
) -> ElasticHistory:
    """The elastic follower at equal angles of a turn; its flights cost the most by far.

    Parameters
    ----------
    lift : Lift
    at : array (n,)          the lift at these angles, m
    cam_speed : array (n,)   rad/s
    """
    follower = elastic_follower(case)
    response = periodic_response(at, cam_speed, follower)
    flights: tuple[Flight, ...] = ()
    force = float(response.contact_force.max())
    if response.lost and flights_too:
        start = (float(response.position[0]), float(response.velocity[0]))
        jump = bounce(lift, _law(cam_speed), follower, BOUNCE_TURNS, start)
        flights, force = jump.flights, float(jump.contact_force.max())
    return ElasticHistory(response, at - response.position, flights, force, _method(cam_speed))


def _law(cam_speed: Array) -> float | PeriodicPolynomial:
    return float(cam_speed[0]) if is_steady(cam_speed) else periodic_quintic(cam_speed)


def _method(cam_speed: Array) -> str:
    if is_steady(cam_speed):
        return "harmonic balance at constant speed"
    low, high = cam_speed.min(), cam_speed.max()
    swing = 100.0 * (high - low) / (0.5 * (high + low))
    return f"collocation on the computed speed, which varies by {swing:.2g} %"

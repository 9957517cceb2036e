"""Cam at sampled angles: lift, motion and forces of a scenario, and the form of a constraint.

All functions take complex numbers: a complex step gives their derivative to round-off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import magnitude, speed_and_curvature
from camwright.pipeline.case.limits import AnyLimit, Limit, OpenLimit
from camwright.pipeline.follower.follower_forces import levers
from camwright.pipeline.follower.roller_motion import rolling_share
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario, Value


class Jet(NamedTuple):
    """Lift and its derivatives by the cam angle, m/rad^k, each (n,)."""

    lift: Array
    slope: Array
    bend: Array
    jerk: Array


def lift_jet(energy: tuple[Array, ...], variables: DesignVariables) -> Jet:
    """Lift and three derivatives from the stored energy and its derivatives, J/rad^k.

    F_s = sqrt(P^2 + 2 k E), s = 2 E / (F_s + P), and E' = F_s s' differentiated.
    """
    level, first, second, third = energy
    force = np.sqrt(variables.preload**2 + 2.0 * variables.rate * level)
    slope = first / force
    bend = (second - variables.rate * slope**2) / force
    return Jet(
        lift=2.0 * level / (force + variables.preload),
        slope=slope,
        bend=bend,
        jerk=(third - 3.0 * variables.rate * slope * bend) / force,
    )


class Motion(NamedTuple):
    """Velocity of the roller centre along and across the follower axis, m/rad; pitch curve."""

    along: Array
    across: Array
    speed: Array
    curvature: Array

    @property
    def tangent(self) -> Array:
        """Tangent of the pressure angle."""
        return self.along / self.across


def motion(jet: Jet, variables: DesignVariables, offset: float) -> Motion:
    """Motion of the roller centre of a translating follower; see `PitchCurve`."""
    along = jet.slope - offset
    across = np.sqrt(variables.prime_radius**2 - offset**2) + jet.lift
    return Motion(along, across, *speed_and_curvature(along, across, jet.slope, jet.bend))


class Forces(NamedTuple):
    """Forces of one scenario, N; factors of the side force on guides A and B.

    lever: reactions of point supports; push: bearing load of the guides; rub: normal load of their
    friction; share: axial force without friction over axial force; surged: normal force with the
    surge of the spring, >= 0.
    """

    spring: Array
    inertia: Array
    axial: Array
    normal: Array
    jam: Array
    lever: tuple[Array, Array]
    push: tuple[Array, Array]
    rub: tuple[Array, Array]
    share: Array
    surged: Array


def forces(
    jet: Jet, path: Motion, highest: float, variables: DesignVariables, scenario: Scenario
) -> Forces:
    """Follower forces with implicit guide friction; see `follower_loads`.

    Unlike there, the forces are not clipped at loss of contact and at jamming: the search needs
    their slope beyond both.

    Parameters
    ----------
    highest : float   maximum lift, m
    """
    spring = (
        variables.preload * scenario.preload_factor
        + variables.rate * scenario.rate_factor * jet.lift
    )
    inertia = scenario.mass * scenario.cam_speed**2 * jet.bend
    viscous = scenario.viscous_damping * scenario.cam_speed * jet.slope
    lever = levers(scenario.overhang + highest - jet.lift, scenario.guide_spacing)
    fix = scenario.correction
    rub = (lever[0] * fix.rubbing_a, lever[1] * fix.rubbing_b)
    jam = (scenario.friction_a * rub[0] + scenario.friction_b * rub[1]) * magnitude(path.tangent)
    share = 1.0 - np.sign(np.real(jet.slope)) * jam
    axial = (spring + inertia + viscous) / share
    gain = np.sqrt(1.0 + path.tangent**2)
    surged = (axial + fix.surge / share) * gain
    return Forces(
        spring=spring,
        inertia=inertia,
        axial=axial,
        normal=axial * gain,
        jam=jam,
        lever=lever,
        push=(lever[0] * fix.guide_a, lever[1] * fix.guide_b),
        rub=rub,
        share=share,
        surged=np.where(np.real(surged) > 0.0, surged, 0.0 * surged),
    )


class Mean(NamedTuple):
    """Power of a mean over the turn; terms (..., n) at equally spaced angles."""

    terms: Array
    power: float = 1.0

    @property
    def value(self) -> Array:
        """(..., 1)"""
        mean = np.mean(self.terms, axis=-1, keepdims=True)
        return np.asarray(np.maximum(np.real(mean), 0.0) ** self.power)


class Shape(NamedTuple):
    """Unloaded cam at n cam angles."""

    jet: Jet
    path: Motion
    ratings: Ratings

    @property
    def bend(self) -> Array:
        """Roller radius times curvature of the pitch curve: 1 at a cusp."""
        return self.ratings.roller_radius * self.path.curvature


class Loads(NamedTuple):
    """Cam in one scenario at n cam angles; in stacked scenarios, each array (..., n).

    spin: of the roller, rad/s; side: side force on the stem, N; highest: maximum lift, m;
    least_spring: spring force at minimum lift, N.
    """

    jet: Jet
    path: Motion
    ratings: Ratings
    scenario: Scenario
    force: Forces
    spin: Array
    side: Array
    highest: float
    least_spring: Value

    @property
    def torque(self) -> Array:
        """Cam torque, N m."""
        return self.force.axial * self.jet.slope

    @property
    def velocity(self) -> Array:
        """Velocity of the follower, m/s."""
        return self.scenario.cam_speed * self.jet.slope


def loaded(
    jet: Jet, highest: float, variables: DesignVariables, ratings: Ratings, scenario: Scenario
) -> Loads:
    """Cam of a lift in one scenario; highest: maximum lift, m."""
    path = motion(jet, variables, ratings.offset)
    force = forces(jet, path, highest, variables, scenario)
    rate = variables.rate * scenario.rate_factor
    return Loads(
        jet,
        path,
        ratings,
        scenario,
        force,
        spin=scenario.cam_speed * rolling_share(path.speed, ratings.roller_radius),
        side=force.axial * path.tangent,
        highest=highest,
        least_spring=variables.preload * scenario.preload_factor
        + rate * scenario.correction.least_lift,
    )


State = TypeVar("State", Shape, Loads)


@dataclass(frozen=True)
class Constraint(Generic[State]):
    """A limit that the synthesis keeps.

    Parameters
    ----------
    check : str              id of the check of the same demand
    limit : Limit or callable   row of the table of limits; or ratings -> limit, SI, of a limit
                             that a part sets. A value of None: not constrained
    utilisation : callable   cam, limit -> (n,), or a `Mean` of the turn; None: does not apply
    factor_max : float       maximum factor on a row's limit where limits conflict; 0: fixed
    value_max : float        maximum value of a row's limit where limits conflict, SI
    """

    check: str
    limit: AnyLimit | Callable[[Ratings], float | None]
    utilisation: Callable[[State, float], Array | Mean | None] = field(repr=False)
    factor_max: float = 0.0
    value_max: float = inf

    @property
    def row(self) -> AnyLimit | None:
        """Row of the table of limits; None: a part sets the limit."""
        return self.limit if isinstance(self.limit, Limit | OpenLimit) else None

    def value(self, ratings: Ratings) -> float | None:
        """Limit, SI; None: not constrained."""
        if isinstance(self.limit, Limit | OpenLimit):
            return ratings.limits.get(self.limit)
        return self.limit(ratings)

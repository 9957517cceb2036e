"""Cam at sampled angles: lift, motion and forces of a scenario, and the form of a constraint.

All functions take complex numbers: a complex step gives their derivative to round-off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import Generic, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import GeometryError
from camwright.geometry.flat_face_contour import FaceMotion
from camwright.geometry.follower_path import Motion, Reaction
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import RollerMotion
from camwright.pipeline.case.limits import AnyLimit, Limit, OpenLimit
from camwright.pipeline.follower.follower_forces import levers
from camwright.pipeline.follower.spring_kinds import SpringShape, rise, shaped_deflection
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario


def lift_jet(energy: tuple[Array, ...], variables: DesignVariables) -> Jet:
    """Lift and three derivatives from the stored energy and its derivatives, J/rad^k.

    F = sqrt(P^2 + 2 k E), s = 2 E / (F + P), and E' = F s' differentiated; P: preload, weight and
    mean external force.
    """
    level, first, second, third = energy
    if variables.shape is not None:
        return _shaped_jet(energy, variables, variables.shape)
    force = np.sqrt(variables.closing**2 + 2.0 * variables.rate * level)
    slope = first / force
    bend = (second - variables.rate * slope**2) / force
    return Jet(
        lift=2.0 * level / (force + variables.closing),
        slope=slope,
        bend=bend,
        jerk=(third - 3.0 * variables.rate * slope * bend) / force,
    )


def _shaped_jet(energy: tuple[Array, ...], variables: DesignVariables, shape: SpringShape) -> Jet:
    """As `lift_jet`, of a spring that is not linear: E' = F s', F = P + k rho(s) differentiated."""
    level, first, second, third = energy
    lift = shaped_deflection(level, variables.rate, variables.closing, shape)
    law = rise(shape, lift)
    force = variables.closing + variables.rate * law.travel
    rate, change = variables.rate * law.slope, variables.rate * law.bend
    slope = first / force
    bend = (second - rate * slope**2) / force
    jerk = (third - 3.0 * rate * slope * bend - change * slope**3) / force
    return Jet(lift=lift, slope=slope, bend=bend, jerk=jerk)


def motion(jet: Jet, variables: DesignVariables, ratings: Ratings) -> Motion:
    """Motion of the translating follower of the ratings; see `PitchCurve` and `FacePath`."""
    prime, face, offset = variables.prime_radius, ratings.face, ratings.offset
    if face is not None:
        return FaceMotion(jet, prime, offset, face.friction)
    return RollerMotion(jet, np.sqrt(prime**2 - offset**2), offset, ratings.roller_radius)


class Forces(NamedTuple):
    """Forces of one scenario, N; loads of guides A and B over the axial force.

    closing: spring, weight and external force.
    rubbing: normal loads of the friction in the guides, corrected; share: axial force without
    friction over axial force; surged: normal force with the surge of the spring, >= 0.
    """

    spring: Array
    closing: Array
    inertia: Array
    axial: Array
    normal: Array
    jam: Array
    guides: tuple[Reaction, Reaction]
    rubbing: tuple[Array, Array]
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
    travel = jet.lift if variables.shape is None else rise(variables.shape, jet.lift).travel
    spring = (
        variables.preload * scenario.preload_factor + variables.rate * scenario.rate_factor * travel
    )
    closing = spring + (scenario.mass * scenario.gravity + scenario.external)
    inertia = scenario.mass * scenario.cam_speed**2 * jet.bend
    viscous = scenario.viscous_damping * scenario.cam_speed * jet.slope
    lever = levers(scenario.overhang + highest - jet.lift, scenario.guide_spacing)
    fix, guides = scenario.correction, path.reactions(lever, scenario.guide_spacing)
    rubbing = (guides[0].corrected(fix.rubbing_a), guides[1].corrected(fix.rubbing_b))
    jam = scenario.friction_a * rubbing[0] + scenario.friction_b * rubbing[1]
    share = 1.0 - np.sign(np.real(jet.slope)) * jam
    axial, gain = (closing + inertia + viscous) / share, path.gain
    surged = (axial + fix.surge / share) * gain
    return Forces(
        spring=spring,
        closing=closing,
        inertia=inertia,
        axial=axial,
        normal=axial * gain,
        jam=jam,
        guides=guides,
        rubbing=rubbing,
        share=share,
        surged=positive(surged),
    )


class Total(NamedTuple):
    """Utilisations over several scenarios.

    Parameters
    ----------
    of : callable       means over the turn (..., m), complex -> utilisations (..., r)
    members : array (r, s)   whether a scenario counts in a utilisation
    """

    of: Callable[[Array], Array]
    members: NDArray[np.bool_]


class Mean(NamedTuple):
    """Utilisations from means over the turn; terms (..., n) at equally spaced angles.

    Of each scenario the power of its mean, or of several scenarios the total; times a factor.
    """

    terms: Array
    power: float = 1.0
    total: Total | None = None
    factor: float = 1.0

    @property
    def means(self) -> Array:
        """(m,)"""
        return np.atleast_1d(np.mean(np.real(self.terms), axis=-1))

    @property
    def members(self) -> NDArray[np.bool_]:
        """Whether a scenario counts in a utilisation, (r, s)."""
        return np.eye(self.means.size, dtype=bool) if self.total is None else self.total.members

    @property
    def value(self) -> Array:
        """Utilisations (r,)."""
        return self._of(self.means)

    @property
    def slopes(self) -> Array:
        """Derivatives (r, m) of the utilisations by the means."""
        return self._slopes(self.means).T

    def bend(self, weights: Array) -> Array:
        """Second derivatives (m, m) of the utilisations by the means, weighted by (r,)."""
        means = self.means
        steps = np.diag(_SHARE * np.maximum(np.abs(means), np.finfo(float).tiny / _SHARE))
        up, down = (self._slopes(means + side * steps) @ weights for side in (1.0, -1.0))
        bend = (up - down) / (2.0 * np.diag(steps)[:, None])
        return np.asarray(0.5 * (bend + bend.T))

    def _slopes(self, means: Array) -> Array:
        """Derivatives (..., m, r) at means (..., m), by complex steps."""
        steps = 1j * _STEP * np.eye(means.shape[-1])
        return np.imag(self._of(means[..., None, :] + steps)) / _STEP

    def _of(self, means: Array) -> Array:
        of_one = positive(means) ** self.power if self.total is None else self.total.of(means)
        return np.asarray(self.factor * of_one)


_STEP = 1e-30  # complex step of a mean
_SHARE = 1e-5  # of a mean: step of the second derivatives


def positive(values: Array) -> Array:
    """Values, and zero where they are negative; complex."""
    return np.where(np.real(values) > 0.0, values, 0.0 * values)


def duty_shares(scenario: Scenario) -> Array | None:
    """Shares (r, s) of stacked scenarios in the operation at each tolerance corner.

    None without a duty: each scenario counts for the whole life.
    """
    if scenario.duty is None:
        return None
    duty, corner = np.broadcast_arrays(np.ravel(scenario.duty), np.ravel(scenario.corner))
    return np.where(corner == np.unique(corner[duty > 0.0])[:, None], duty, 0.0)


def by_duty(terms: Array, scenario: Scenario, power: float = 1.0) -> Mean:
    """Power of the sum of damage or wear of the load cases by their duty.

    Parameters
    ----------
    terms : array (..., n)   whose mean over the turn is the damage of a load case that runs all of
                             the life, over the limit
    scenario : Scenario      stacked

    References
    ----------
    Palmgren (1924), Miner (1945): shares of life add up.
    """
    shares = duty_shares(scenario)
    if shares is None:
        return Mean(terms, power)
    return Mean(terms, power, Total(lambda means: positive(means @ shares.T) ** power, shares > 0))


def roller_of(path: Motion) -> RollerMotion:
    """The motion of a roller.

    Raises
    ------
    GeometryError
        If it is that of a flat face.
    """
    if isinstance(path, RollerMotion):
        return path
    raise GeometryError("the follower of the cam is no roller")


def face_of(path: Motion) -> FaceMotion:
    """The motion of a flat face.

    Raises
    ------
    GeometryError
        If it is that of a roller.
    """
    if isinstance(path, FaceMotion):
        return path
    raise GeometryError("the follower of the cam is no flat face")


class Shape(NamedTuple):
    """Unloaded cam at n cam angles."""

    jet: Jet
    path: Motion
    ratings: Ratings


class Loads(NamedTuple):
    """Cam in one scenario at n cam angles; in stacked scenarios, each array (..., n).

    highest: maximum lift, m; least_spring: spring force at minimum lift, N.
    """

    jet: Jet
    path: Motion
    ratings: Ratings
    scenario: Scenario
    force: Forces
    highest: float
    least_spring: Value

    @property
    def torque(self) -> Array:
        """Cam torque, N m."""
        return self.force.axial * (self.jet.slope + self.path.sliding)

    @property
    def velocity(self) -> Array:
        """Velocity of the follower, m/s."""
        return self.scenario.cam_speed * self.jet.slope

    @property
    def spin(self) -> Array:
        """Of the roller, rad/s."""
        return np.asarray(self.scenario.cam_speed * self.path.rolling)


def loaded(
    jet: Jet, highest: float, variables: DesignVariables, ratings: Ratings, scenario: Scenario
) -> Loads:
    """Cam of a lift in one scenario; highest: maximum lift, m."""
    path = motion(jet, variables, ratings)
    force = forces(jet, path, highest, variables, scenario)
    rate, least = variables.rate * scenario.rate_factor, scenario.correction.least_lift
    if variables.shape is not None:
        least = rise(variables.shape, least).travel
    return Loads(
        jet,
        path,
        ratings,
        scenario,
        force,
        highest=highest,
        least_spring=variables.preload * scenario.preload_factor + rate * least,
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
    needs : str              kind of follower; "": any
    """

    check: str
    limit: AnyLimit | Callable[[Ratings], float | None]
    utilisation: Callable[[State, float], Array | Mean | None] = field(repr=False)
    factor_max: float = 0.0
    value_max: float = inf
    needs: Literal["", "roller", "face"] = ""

    @property
    def row(self) -> AnyLimit | None:
        """Row of the table of limits; None: a part sets the limit."""
        return self.limit if isinstance(self.limit, Limit | OpenLimit) else None

    def value(self, ratings: Ratings) -> float | None:
        """Limit, SI; None: not constrained."""
        if self.needs not in ("", ratings.follower):
            return None
        if isinstance(self.limit, Limit | OpenLimit):
            return ratings.limits.get(self.limit)
        return self.limit(ratings)

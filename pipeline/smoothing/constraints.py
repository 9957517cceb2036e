"""Demands over limits of a cam, point by point and differentiable, as the checks see them.

Every demand is written for complex numbers too, so that one complex step gives its derivative
to round-off. A utilisation of 1 is the limit; a test holds each against its check.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from geometry.arrays import Array, readonly
from pipeline.follower.roller import BALL_LIFE_EXPONENT

# Complex while derivatives are taken, real otherwise.
Values = Any

LIFE_UNIT = 1e6 * 2.0 * np.pi / 3600.0  # rad of a million turns, per hour


class Jet(NamedTuple):
    """Lift and its derivatives by the cam angle, m/rad^k, each (n,)."""

    lift: Values
    slope: Values
    bend: Values


@dataclass(frozen=True)
class Machine:
    """What a synthesis may free: spring rate N/m, preload N, pitch base radius m."""

    rate: Values
    preload: Values
    base_radius: Values


@dataclass(frozen=True)
class Ratings:
    """Limits and fixed sizes, SI; None leaves a limit out. See `pipeline.checks`."""

    roller_radius: float
    offset: float = 0.0
    travel: float | None = None
    pressure_angle: float | None = None
    jam_index: float | None = None
    curvature_ratio: float | None = None
    undercut_factor: float | None = None
    hollow_radius: float | None = None
    cam_radius: float | None = None
    pressure: float | None = None
    stiffness_of_contact: float = 0.0
    contact_force_margin: float | None = None
    jump: float | None = None
    normal_force: float | None = None
    life_force_cubed: float | None = None
    roller_spin: float | None = None
    bush_pressure: tuple[float | None, float | None] = (None, None)
    bush_pv: tuple[float | None, float | None] = (None, None)
    bush_area: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Correction:
    """What finite elements answer over closed forms at the cam angles of a turn, each (n,)."""

    contact: Array
    guide_a: Array
    guide_b: Array
    rubbing_a: Array
    rubbing_b: Array

    @classmethod
    def none(cls, count: int) -> Correction:
        one = readonly(np.ones(count))
        return cls(one, one, one, one, one)

    def at(self, theta: Array) -> Correction:
        """The same at other angles, straight lines between."""
        own = np.arange(self.contact.size) * (2.0 * np.pi / self.contact.size)
        names = ("contact", "guide_a", "guide_b", "rubbing_a", "rubbing_b")
        return Correction(
            *(np.interp(theta, own, getattr(self, name), period=2.0 * np.pi) for name in names)
        )


@dataclass(frozen=True, eq=False)
class Scenario:
    """One load case, or one corner of its tolerances.

    Parameters
    ----------
    cam_speed : float        rad/s
    torque : array (n,)      engine torque at n equal cam angles, of zero mean, crank N m
    weight : float           of its ripple among those of the others; 0: limits only
    mass, viscous_damping, guide_spacing, overhang : float   of the follower, SI
    friction_a, friction_b : float
    friction_worst : two floats   of guides A and B where jamming is judged; None: as above
    rate_factor, preload_factor : float   the spring as delivered over the spring as drawn
    correction : Correction
    """

    name: str
    cam_speed: float
    torque: Array
    mass: float
    guide_spacing: float
    overhang: float
    friction_a: float
    friction_b: float
    viscous_damping: float = 0.0
    rate_factor: float = 1.0
    preload_factor: float = 1.0
    weight: float = 1.0
    friction_worst: tuple[float, float] | None = None
    correction: Correction = field(default_factory=lambda: Correction.none(8))


def lift_jet(energy: Values, first: Values, second: Values, machine: Machine) -> Jet:
    """Lift at which the spring holds the energy, with its derivatives, from those of E.

    F_s = sqrt(P^2 + 2 k E), s = 2 E / (F_s + P), s' = E' / F_s, s'' = E'' / F_s - k E'^2 / F_s^3.
    """
    force = np.sqrt(machine.preload**2 + 2.0 * machine.rate * energy)
    slope = first / force
    return Jet(
        lift=2.0 * energy / (force + machine.preload),
        slope=slope,
        bend=second / force - machine.rate * slope**2 / force,
    )


class Motion(NamedTuple):
    """What the geometry makes of a jet: tan of the pressure angle, speed of the path, curvature."""

    tangent: Values
    stretch: Values
    curvature: Values


def motion(jet: Jet, machine: Machine, offset: float) -> Motion:
    """Pitch curve of a translating follower at each point; see `PitchCurve`."""
    along = jet.slope - offset
    across = np.sqrt(machine.base_radius**2 - offset**2) + jet.lift
    square = along**2 + across**2
    stretch = np.sqrt(square)
    turning = along * (along + jet.slope) - across * (jet.bend - across)
    return Motion(along / across, stretch, turning / (square * stretch))


class Forces(NamedTuple):
    """Forces of one scenario, N, and reaction over side force of each guide."""

    spring: Values
    inertia: Values
    axial: Values
    normal: Values
    lever_a: Values
    lever_b: Values


def forces(jet: Jet, path: Motion, highest: Values, machine: Machine, scenario: Scenario) -> Forces:
    """Follower forces with implicit guide friction; see `follower_loads`."""
    spring = (
        machine.preload * scenario.preload_factor + machine.rate * scenario.rate_factor * jet.lift
    )
    inertia = scenario.mass * scenario.cam_speed**2 * jet.bend
    viscous = scenario.viscous_damping * scenario.cam_speed * jet.slope
    lever = (scenario.overhang + highest - jet.lift) / scenario.guide_spacing
    jam = (
        (scenario.friction_a * (1.0 + lever) + scenario.friction_b * lever)
        * _magnitude(path.tangent)
    )  # fmt: skip
    axial = (spring + inertia + viscous) / (1.0 - np.sign(np.real(jet.slope)) * jam)
    return Forces(
        spring=spring,
        inertia=inertia,
        axial=axial,
        normal=axial * np.sqrt(1.0 + path.tangent**2),
        lever_a=1.0 + lever,
        lever_b=lever,
    )


class Mean(NamedTuple):
    """The power of a mean over the turn; terms (n,) at equal angles."""

    terms: Values
    power: float = 1.0

    @property
    def value(self) -> Array:
        """(1,)"""
        return np.array([max(float(np.mean(self.terms)), 0.0) ** self.power])


def shape_utilisations(jet: Jet, machine: Machine, ratings: Ratings) -> dict[str, Values]:
    """Limits on the shape of the cam, whatever it carries; each (n,)."""
    path = motion(jet, machine, ratings.offset)
    bend = ratings.roller_radius * path.curvature
    found: dict[str, Values] = {}
    if ratings.travel is not None:
        found["spring_travel"] = jet.lift / ratings.travel
    if ratings.pressure_angle is not None:
        found["pressure_angle"] = _magnitude(path.tangent) / np.tan(ratings.pressure_angle)
    if ratings.curvature_ratio is not None:
        found["curvature_ratio"] = bend * ratings.curvature_ratio
    if ratings.undercut_factor is not None:
        found["undercut"] = bend / (1.0 - ratings.undercut_factor)
    if ratings.hollow_radius is not None and ratings.hollow_radius > ratings.roller_radius:
        found["concave_radius"] = -path.curvature * (ratings.hollow_radius - ratings.roller_radius)
    if ratings.cam_radius is not None:
        found["cam_envelope"] = _contour_radius(path, ratings) / ratings.cam_radius
    return found


def _contour_radius(path: Motion, ratings: Ratings) -> Values:
    """Distance of the contact point from the shaft, m; see `Contour.local_frame`."""
    lean = np.sqrt(1.0 + path.tangent**2)  # over the cosine of the pressure angle
    height = (path.stretch - ratings.roller_radius) / lean
    aside = ratings.offset + ratings.roller_radius * path.tangent / lean
    return np.sqrt(height**2 + aside**2)


def load_utilisations(
    jet: Jet, highest: Values, machine: Machine, ratings: Ratings, scenario: Scenario
) -> dict[str, Values]:
    """Limits on what the cam carries in one scenario; each (n,), or a `Mean` of the turn.

    The stress limit is r kappa + N / F_lim <= 1, which is p0 <= p_allowed: the pressure of a
    line contact and the undercut depend on the same factor 1 - r kappa.
    """
    path = motion(jet, machine, ratings.offset)
    load = forces(jet, path, highest, machine, scenario)
    fix = scenario.correction
    found: dict[str, Values] = {}
    if ratings.jam_index is not None:
        first, second = scenario.friction_worst or (scenario.friction_a, scenario.friction_b)
        factor = first * load.lever_a + second * load.lever_b
        rising = np.where(np.real(jet.slope) > 0, 1.0, 0.0)
        found["jam_index"] = rising * factor * _magnitude(path.tangent) / ratings.jam_index
    if ratings.pressure is not None:
        allowed = ratings.pressure**2 * ratings.stiffness_of_contact
        found["contact_pressure"] = (
            ratings.roller_radius * path.curvature + fix.contact**2 * load.normal / allowed
        )
    if ratings.contact_force_margin is not None:
        found["contact_force_margin"] = (
            1.0 + ratings.contact_force_margin - load.normal / machine.preload
        )
    if ratings.jump is not None:
        found["jump"] = -load.inertia / load.spring / ratings.jump
    if ratings.normal_force is not None:
        found["roller_static"] = load.normal / ratings.normal_force
    found |= _roller_utilisations(load, path, ratings, scenario)
    return found | _bush_utilisations(load, path, jet, ratings, scenario)


def _roller_utilisations(
    load: Forces, path: Motion, ratings: Ratings, scenario: Scenario
) -> dict[str, Values]:
    spin = scenario.cam_speed * (path.stretch / ratings.roller_radius - 1.0)
    found: dict[str, Values] = {}
    if ratings.roller_spin is not None:
        found["roller_speed"] = spin / ratings.roller_spin
    if ratings.life_force_cubed is not None:
        # hours = (C / P_m)^3 LIFE_UNIT / mean spin, and P_m^3 mean spin is this mean
        wear = load.normal**BALL_LIFE_EXPONENT * _magnitude(spin) / ratings.life_force_cubed
        found["roller_life"] = Mean(wear, 1.0 / BALL_LIFE_EXPONENT)
    return found


def _bush_utilisations(
    load: Forces, path: Motion, jet: Jet, ratings: Ratings, scenario: Scenario
) -> dict[str, Values]:
    side = _magnitude(load.axial * path.tangent)
    speed = scenario.cam_speed * _magnitude(jet.slope)
    fix = scenario.correction
    rows = (
        ("A", load.lever_a, fix.guide_a, fix.rubbing_a, 0),
        ("B", load.lever_b, fix.guide_b, fix.rubbing_b, 1),
    )
    found: dict[str, Values] = {}
    for name, lever, push, rubbing, place in rows:
        area = ratings.bush_area[place]
        limit, product = ratings.bush_pressure[place], ratings.bush_pv[place]
        if limit is not None:
            found[f"bush_pressure_{name}"] = push * side * lever / (area * limit)
        if product is not None:
            found[f"bush_pv_{name}"] = Mean(rubbing * side * lever * speed / (area * product))
    return found


def delivered_torque(
    jet: Jet, highest: Values, machine: Machine, scenario: Scenario, offset: float
) -> Values:
    """Cam torque F_a s' with friction and inertia inside, N m, (n,)."""
    load = forces(jet, motion(jet, machine, offset), highest, machine, scenario)
    return load.axial * jet.slope


class Gradient(NamedTuple):
    """A value and its partial derivatives by E, E', E'' of each point and by the rest.

    value (n,), local (3, n), shared (4, n): by the greatest lift, k, P, r0. For a `Mean` value
    is (1,), shared (4, 1), and local has the share of each point.
    """

    value: Array
    local: Array
    shared: Array


Function = Callable[[Jet, Values, Machine], Mapping[str, Values | Mean]]
FREED = ("rate", "preload", "base_radius")
_STEP = 1e-30


def differentiated(
    function: Function,
    energy: tuple[Array, Array, Array],
    highest: float,
    machine: Machine,
    freed: bool,
) -> dict[str, Gradient]:
    """Values of a function of the jets with all its derivatives, by complex steps.

    Parameters
    ----------
    function : callable   jet, greatest lift, machine -> values by name
    energy : three arrays (n,)   E, E', E''
    highest : float       greatest lift of the turn, m
    machine : Machine
    freed : bool          derivatives by k, P, r0 are asked for; else they are zero

    References
    ----------
    Squire and Trapp, SIAM Review 40 (1998) 110: the complex step has no cancellation.
    """

    def sides(parts: tuple[Any, ...], top: Values, given: Machine) -> dict[str, Array]:
        found = function(lift_jet(parts[0], parts[1], parts[2], given), top, given)
        return {name: np.imag(_terms(value)) / _STEP for name, value in found.items()}

    step = 1j * _STEP
    directions = [
        sides(tuple(part + step * (j == k) for j, part in enumerate(energy)), highest, machine)
        for k in range(3)
    ]
    directions.append(sides(energy, highest + step, machine))
    for name in FREED if freed else ():
        other = replace(machine, **{name: getattr(machine, name) + step})
        directions.append(sides(energy, highest, other))
    values = function(lift_jet(*energy, machine), highest, machine)
    return {
        name: _gradient(value, [direction[name] for direction in directions])
        for name, value in values.items()
    }


def _terms(value: Values | Mean) -> Values:
    return value.terms if isinstance(value, Mean) else value


def _gradient(value: Values | Mean, sides: list[Array]) -> Gradient:
    none = np.zeros_like(sides[0])
    local = np.stack(sides[:3])
    shared = np.stack([*sides[3:], *[none] * (7 - len(sides))])
    if not isinstance(value, Mean):
        return Gradient(np.asarray(value, dtype=float), local, shared)
    mean = float(np.mean(value.terms))
    front = value.power * mean ** (value.power - 1.0) if mean > 0 else 0.0
    return Gradient(
        value.value,
        front / none.size * local,
        front * shared.mean(axis=1, keepdims=True),
    )


def _magnitude(values: Values) -> Values:
    """|x| along its real part, so that a complex step passes through."""
    return values * np.sign(np.real(values))

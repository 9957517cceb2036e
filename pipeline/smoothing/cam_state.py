"""Cam of a synthesis: lift from stored energy, loads of a scenario, means, constraints.

All functions take complex numbers: a complex step gives their derivative to round-off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.follower_path import Motion
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import magnitude, rolling_share
from camwright.geometry.second_track import SecondMotion
from camwright.pipeline.case.limits import (
    CONTACT_FORCE_MARGIN,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    AnyLimit,
)
from camwright.pipeline.checks.check import ClosedBy, Declaration, Kept, Kind, Stroke
from camwright.pipeline.checks.extremes import BY_DUTY
from camwright.pipeline.checks.form_closure import INTERFERENCE
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.loaded_cam import (
    CarriedCam,
    DiscCam,
    LoadedCam,
    OfGuides,
    TurningRoller,
    greatest_friction,
    not_negative,
    roller_of,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.disc_preload import Squeezed, squeezed
from camwright.pipeline.follower.follower_forces import PressedGuides, wall_of
from camwright.pipeline.follower.spring_kinds import SpringShape, rise, shaped_deflection
from camwright.pipeline.smoothing.scenario import (
    Correction,
    DesignVariables,
    Ratings,
    Scenario,
)


def lift_jet(energy: tuple[Array, ...], variables: DesignVariables) -> Jet:
    """Lift and three derivatives by the cam angle, m/rad^k, of a follower whose spring stores a
    given energy.

    With the force F = sqrt(P^2 + 2 k E) of the spring: s = 2 E / (F + P), and the derivatives from
    E' = F s'. P: preload with weight and mean external force, N; k: spring rate, N/m. A spring that
    is not linear has the law of its shape.

    Parameters
    ----------
    energy : arrays (...)         E, E', E'', E''', above that at zero lift, J/rad^k; of a yoke the
                                  lift itself, m/rad^k
    variables : DesignVariables   k, P and shape of the spring
    """
    level, first, second, third = energy
    if variables.of_lift:
        return Jet(lift=level, slope=first, lift_d2=second, jerk=third)
    if variables.shape is not None:
        return _shaped_jet(energy, variables, variables.shape)
    force = np.sqrt(variables.closing**2 + 2.0 * variables.rate * level)
    slope = first / force
    lift_d2 = (second - variables.rate * slope**2) / force
    return Jet(
        lift=2.0 * level / (force + variables.closing),
        slope=slope,
        lift_d2=lift_d2,
        jerk=(third - 3.0 * variables.rate * slope * lift_d2) / force,
    )


def _shaped_jet(energy: tuple[Array, ...], variables: DesignVariables, shape: SpringShape) -> Jet:
    """Lift and three derivatives by the cam angle of a spring that is not linear; see `lift_jet`.

    F = P + k rho(s), rho: travel of the spring by its shape, m; E' = F s' is differentiated.
    """
    level, first, second, third = energy
    lift = shaped_deflection(level, variables.rate, variables.closing, shape)
    law = rise(shape, lift)
    force = variables.closing + variables.rate * law.travel
    rate, change = variables.rate * law.slope, variables.rate * law.travel_d2
    slope = first / force
    lift_d2 = (second - rate * slope**2) / force
    jerk = (third - 3.0 * rate * slope * lift_d2 - change * slope**3) / force
    return Jet(lift=lift, slope=slope, lift_d2=lift_d2, jerk=jerk)


def _numbers(variables: DesignVariables, ratings: Ratings) -> Numbers:
    """Numbers of the machine with those that a search changes, and limits that measures read."""
    read = {f"limits.{each.id}": ratings.bounds.get(each.id) for each in _READ}
    return ratings.numbers | {"cam.prime_radius": variables.prime_radius, **read}


_READ = (CONTACT_FORCE_MARGIN, PRESSURE_ANGLE, RETURN_PRESSURE_ANGLE)


def unloaded(jet: Jet, variables: DesignVariables, ratings: Ratings) -> LoadedCam:
    """Cam of a lift for the measures of its shape, without loads of the follower."""
    return LoadedCam(jet, _numbers(variables, ratings))


def second_disc(cam: LoadedCam, highest: float) -> LoadedCam | None:
    """Disc of a second roller, from the unloaded cam of the first and its maximum lift, m; None
    without one.
    """
    second = _second_of(cam, cam.motion, highest)
    if second is None or not cam.numbers.known_case.cam.conjugate:
        return None
    other = second.motion
    return DiscCam(roller_of(other).jet, cam.numbers, highest, track=other)


def _second_of(cam: LoadedCam, first: Motion, highest: Value) -> SecondMotion | None:
    """Motion of a second roller or face by that of the first; None without one."""
    case = cam.numbers.case
    fixed = None if case is None else case.cam.second
    return None if fixed is None else fixed.along(first, highest)


@dataclass(frozen=True, eq=False, kw_only=True)
class ScenarioCam(CarriedCam):
    """Loaded cam of a scenario at n cam angles; of stacked scenarios (..., n).

    What finite elements, the surge or the heat of a solved cam add is in the `Correction` of the
    scenario, held while the search runs.

    alone: 1 or -1: as though the first or the second track carried by itself; 0: both.
    """

    scenario: Scenario
    variables: DesignVariables
    ratings: Ratings
    alone: float = 0.0

    @cached_property
    def second(self) -> SecondMotion | None:
        return _second_of(self, self.first, self.highest)

    @cached_property
    def squeeze(self) -> Squeezed | None:
        """With the compliances of both rollers at the spring of the case."""
        second, compliances = self.second, self.ratings.compliances
        if second is None or compliances is None or self.alone:
            return None
        interference = self.numbers[INTERFERENCE]
        return squeezed(interference, compliances, self.first, second.touch, second.leverage)

    @cached_property
    def _in_guides(self) -> _PressedStem | None:
        """Stem whose rollers are preloaded; None of other followers."""
        if self.squeeze is None or self.pivot is not None:
            return None
        near, far = (replace(self, alone=side, facing=None) for side in (1.0, -1.0))
        return _PressedStem(self.squeeze, near, far)

    @cached_property
    def wall(self) -> Array:
        if self.alone:
            return np.full(np.shape(self.required), self.alone)
        if self.scenario.wall is not None:
            return self.scenario.wall
        if self.facing is None and self._in_guides is not None:
            return wall_of(self.axial, held=True)
        return super().wall

    @cached_property
    def axial(self) -> Array:
        stem = self._in_guides
        if stem is None or self.facing is not None:
            return super().axial
        return stem.axial(self, stem.jams)

    @property
    def fix(self) -> Correction:
        """Correction of the scenario."""
        return self.scenario.correction

    @property
    def drag(self) -> Drag | None:
        return self.ratings.drag

    @property
    def spring_shape(self) -> SpringShape | None:
        return self.variables.shape

    @cached_property
    def spin_mean(self) -> Array:
        """Mean speed of the roller about its pin over the turn, rad/s: cam speed times the share
        that the last solved cam has, or, before there is a solved cam, the ratio of prime circle to
        roller without slip.
        """
        rolling, path = self.fix.rolling[..., :1], roller_of(self.first)  # one value
        prime = path.prime_radius[..., :1]
        share = np.where(rolling > 0.0, rolling, rolling_share(prime, path.size))
        return np.asarray(self.speed * share)

    @property
    def heading(self) -> Array:
        """From -1, falling, to 1, rising.

        In the cell of a cam angle, see `Scenario`, in which the follower reverses, the direction is
        the mean over the cell, s' over its change within half of it, so that it can be
        differentiated.
        """
        sharp, cell = super().heading, self.scenario.cell
        if not np.any(cell):
            return sharp
        reach = 0.5 * cell * magnitude(self.jet.lift_d2)
        within = np.abs(np.real(self.slope)) < np.real(reach)
        return np.where(within, self.slope / np.where(within, reach, 1.0), sharp)

    @property
    def crosses(self) -> bool:
        """Whether its force changes the track where it changes its sign, whatever the friction."""
        return self.pulls and self.pivot is None and self.squeeze is None

    @property
    def surge(self) -> Array:
        return self.fix.surge

    @property
    def pressure_factor(self) -> Array:
        return self.fix.contact

    @property
    def pressure_weight(self) -> Array:
        return self.fix.pressure_weight

    @property
    def force_weight(self) -> Array:
        return self.fix.force_weight

    @cached_property
    def follower_moment(self) -> Array:
        return self.fix.lever * not_negative(self.normal)

    @property
    def bush_rubbing(self) -> Array:
        return self.fix.bush_rubbing

    @property
    def bush_bearing(self) -> Array:
        return self.fix.bush_bearing

    def _corrected(self, fix_a: Array, fix_b: Array) -> OfGuides:
        """Loads of the guides over the axial force with corrections."""
        on_a, on_b = self.reactions
        return OfGuides(on_a.corrected(fix_a), on_b.corrected(fix_b))

    @cached_property
    def rubbing_share(self) -> OfGuides:
        return self._corrected(self.fix.rubbing_a, self.fix.rubbing_b)

    def _loads(self, shares: Callable[[ScenarioCam], OfGuides]) -> OfGuides:
        """Loads of the guides, N, by their shares of the axial force of a track."""
        if self._in_guides is None:
            return OfGuides(*(self.axial * each for each in shares(self)))
        return self._in_guides.loads(self.axial, shares)

    @cached_property
    def rubbing(self) -> OfGuides:
        fix = self.fix
        return self._loads(lambda cam: cam._corrected(fix.worn_a, fix.worn_b))

    @property
    def jam_tilted(self) -> Array:
        return self.fix.jam_tilted

    @cached_property
    def bearing(self) -> OfGuides:
        """At most the limit at the temperature of the guide counts, see `Correction`."""
        fix = self.fix
        return self._loads(lambda cam: cam._corrected(fix.guide_a, fix.guide_b))

    @cached_property
    def edge(self) -> OfGuides:
        """Greatest line load of the guides times their length, N."""
        fix = self.fix
        return self._loads(lambda cam: cam._corrected(fix.edge_a, fix.edge_b))

    @cached_property
    def jam(self) -> Array:
        stem = self._in_guides
        return super().jam if stem is None else stem.mean(self.axial, stem.jams)

    @cached_property
    def jam_worst(self) -> Array | None:
        stem = self._in_guides
        if stem is not None and stem.worst is not None:
            return stem.mean(stem.axial(self, stem.worst), stem.worst)
        on_points = super().jam_worst
        return None if on_points is None else on_points * self.fix.jam

    @cached_property
    def hot(self) -> OfGuides | None:
        stem, friction = self._in_guides, greatest_friction(self.numbers)
        if stem is None or stem.worst is None or friction is None:
            return super().hot
        loads = stem.loads(stem.axial(self, stem.worst), lambda cam: cam.hot_share)
        return OfGuides(friction.a * loads.a, friction.b * loads.b)

    @cached_property
    def rollers(self) -> tuple[TurningRoller, ...]:
        """The mean spin of a second roller is that on its prime circle."""
        turning, second = super().rollers, self.second
        if len(turning) == 1 or second is None:
            return turning
        path = roller_of(second.motion)
        far = np.asarray(self.speed * rolling_share(path.prime_radius[..., :1], path.size))
        return tuple(
            each._replace(mean=mean)
            for each, mean in zip(turning, (self.spin_mean, magnitude(far)), strict=True)
        )

    @property
    def hot_share(self) -> OfGuides:
        return self._corrected(self.fix.hot_a, self.fix.hot_b)


class _PressedStem(NamedTuple):
    """Stem whose rollers are preloaded, by its cam on the track of either roller alone."""

    squeeze: Squeezed
    near: ScenarioCam
    far: ScenarioCam

    @property
    def jams(self) -> tuple[Array, Array]:
        """Jam index of either track."""
        return self.near.jam, self.far.jam

    @property
    def worst(self) -> tuple[Array, Array] | None:
        """`jams` at maximum friction; None where it is not known."""
        near, far = self.near.jam_worst, self.far.jam_worst
        return None if near is None or far is None else (near, far)

    def axial(self, cam: ScenarioCam, jams: tuple[Array, Array]) -> Array:
        """Axial force of a cam, N, by the jam index of either track."""
        return PressedGuides(self.squeeze, jams)(cam.required, cam.heading)

    def loads(self, axial: Array, shares: Callable[[ScenarioCam], OfGuides]) -> OfGuides:
        """Loads of the guides, N: those of rollers on opposite sides of the cam add up."""
        near, far = self.squeeze.forces(axial)
        both = zip(shares(self.near), shares(self.far), strict=True)
        return OfGuides(*(near * one + far * other for one, other in both))

    def mean(self, axial: Array, jams: tuple[Array, Array]) -> Array:
        """Jam index over the sum of the forces of both tracks."""
        near, far = self.squeeze.forces(axial)
        return np.asarray((near * jams[0] + far * jams[1]) / (near + far))


def loaded(
    jet: Jet, highest: float, variables: DesignVariables, ratings: Ratings, scenario: Scenario
) -> ScenarioCam:
    """Loaded cam of a lift in a scenario, or in stacked ones; highest: maximum lift, m."""
    numbers = (
        _numbers(variables, ratings)
        | scenario.numbers.changed
        | {
            "spring.preload": variables.preload * scenario.preload_factor,
            "spring.rate": variables.rate * scenario.rate_factor,
        }
    )
    return ScenarioCam(
        jet,
        numbers,
        highest,
        scenario.correction.least_lift,
        scenario.external,
        scenario.gravity,
        scenario=scenario,
        variables=variables,
        ratings=ratings,
    )


class Total(NamedTuple):
    """Combination of means over several scenarios into utilisations.

    Parameters
    ----------
    of : callable       means over the turn (..., m), complex -> utilisations (..., r)
    members : array (r, s)   whether a scenario counts in a utilisation
    """

    of: Callable[[Array], Array]
    members: NDArray[np.bool_]


class Mean(NamedTuple):
    """Utilisations from means over the turn; terms (..., n) at equal angles.

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

    def hessian(self, weights: Array) -> Array:
        """Second derivatives (m, m), by the m means over the turn, of the sum of the utilisations
        with given weights.

        Central differences of the first derivatives.

        Parameters
        ----------
        weights : array (r,)   of the utilisations
        """
        means = self.means
        steps = np.diag(
            _SECOND_STEP * np.maximum(np.abs(means), np.finfo(float).tiny / _SECOND_STEP)
        )
        up, down = (self._slopes(means + side * steps) @ weights for side in (1.0, -1.0))
        hessian = (up - down) / (2.0 * np.diag(steps)[:, None])
        return np.asarray(0.5 * (hessian + hessian.T))

    def _slopes(self, means: Array) -> Array:
        """Derivatives (..., m, r) at means (..., m), by complex steps."""
        steps = 1j * _COMPLEX_STEP * np.eye(means.shape[-1])
        return np.imag(self._of(means[..., None, :] + steps)) / _COMPLEX_STEP

    def _of(self, means: Array) -> Array:
        of_one = not_negative(means) ** self.power if self.total is None else self.total.of(means)
        return np.asarray(self.factor * of_one)


_COMPLEX_STEP = 1e-30  # complex step of a mean
INAPPLICABLE_USE = -10.0  # utilisation in a scenario to which a limit does not apply
_SECOND_STEP = 1e-5  # of a mean: step of the second derivatives


def duty_shares(scenario: Scenario) -> Array | None:
    """Shares of the operating time (r, s): one row per tolerance corner, one column per stacked
    scenario, zero for the scenarios of other corners.

    None where the case states no duty: each scenario then counts for the whole life.
    """
    if scenario.duty is None:
        return None
    duty, corner = np.broadcast_arrays(np.ravel(scenario.duty), np.ravel(scenario.corner))
    return np.where(corner == np.unique(corner[duty > 0.0])[:, None], duty, 0.0)


def by_duty(terms: Array, scenario: Scenario, power: float = 1.0) -> Mean:
    """Utilisation from damage or wear, added over the load cases by their shares of the operating
    time.

    Parameters
    ----------
    terms : array (..., n)   whose mean over the turn is damage over its limit, were the load case
                             to run all of the life
    scenario : Scenario      stacked
    power : float            to which the summed means are raised

    References
    ----------
    Palmgren (1924), Miner (1945): shares of life add up.
    """
    shares = duty_shares(scenario)
    if shares is None:
        return Mean(terms, power)
    return Mean(
        terms, power, Total(lambda means: not_negative(means @ shares.T) ** power, shares > 0)
    )


State = TypeVar("State", LoadedCam, ScenarioCam)


@dataclass(frozen=True)
class Constraint(Generic[State]):
    """Constraint of a synthesis: limit of a check in differentiable form.

    Parameters
    ----------
    check : str              id of the check of the same demand
    key : str                of its limit in the ratings
    utilisation : callable   cam, limit -> (n,), or a `Mean` of the turn; None: does not apply
    row : Limit              row of the table of limits; None: a part sets the limit
    kept : Kept              unit and slope of a limit of a part, how far that of a row is relaxed
    needs : str              kind of follower, or closure of the cam; "": any
    stroke : str             key of the limit of one stroke of the follower; "": of the whole turn
    discs : bool             whether it holds on each of two discs
    """

    check: str
    key: str
    utilisation: Callable[[State, float], Array | Mean | None] = field(repr=False)
    row: AnyLimit | None = None
    kept: Kept = field(default=Kept(), repr=False)
    needs: Kind | ClosedBy = ""
    stroke: str = ""
    discs: bool = False

    @property
    def name(self) -> str:
        """Name of its utilisation: check id, or limit of a stroke."""
        return self.stroke or self.check

    def value(self, ratings: Ratings) -> float | None:
        """Limit, SI; None: not constrained."""
        return ratings.bounds.get(self.key) if self.needs in {"", *ratings.kinds} else None


def where_applies(applies: Value, use: Array) -> Array:
    """Utilisation where a limit applies; far below it in the other scenarios."""
    return np.where(np.asarray(applies) != 0.0, use, INAPPLICABLE_USE + 0.0 * use)


def kept(declared: Declaration) -> Constraint[LoadedCam]:
    """Constraint of a check declared by a measure.

    Raises
    ------
    InputError
        If it is not declared as kept.
    """
    how, measure = declared.measured, declared.measure
    if how is None or measure is None or how.kept is None:
        raise InputError(declared.id, "not declared", "kept by the synthesis, see `Measured`")
    use, row = partial(how.use, measure), None if how.kept.unit else declared.limit

    def of_row(cam: LoadedCam, stated: float) -> Array | None:
        bound = how.bound(stated, cam.numbers)
        return None if bound is None else use(cam, bound)

    return Constraint(
        declared.id,
        declared.kept_at,
        use if row is None or how.kept.use is not None else of_row,
        row,
        how.kept,
        how.kept.needs or declared.needs,
        discs=how.reduce == "contour",
    )


def kept_strokes(declared: Declaration) -> tuple[Constraint[LoadedCam], ...]:
    """Constraints of a check that judges several strokes of the follower, of all but the first:
    each stroke has its own measure and limit.
    """
    constraint, strokes = (
        kept(declared),
        () if declared.measured is None else declared.measured.strokes,
    )

    def of_stroke(stroke: Stroke) -> Constraint[LoadedCam]:
        key, measure = stroke.limit.id, stroke.measure
        return replace(
            constraint, key=key, utilisation=lambda cam, limit: measure(cam) / limit,
            row=stroke.limit, stroke=key,
        )  # fmt: skip

    return tuple(of_stroke(each) for each in strokes[1:])


def kept_loads(declared: Declaration) -> Constraint[ScenarioCam]:
    """Constraint of a synthesis from a check on the loads, reduced over turn and load cases as the
    check is: at each angle, mean over the turn, or sum of damage by the duty of the load cases; see
    `kept`.
    """
    of_cam, how = kept(declared), declared.measured

    def utilisation(cam: ScenarioCam, limit: float) -> Array | Mean | None:
        use = of_cam.utilisation(cam, limit)
        if how is None or use is None or isinstance(use, Mean):
            return use
        if of_cam.kept.once:
            return where_applies(np.multiply(cam.scenario.swept, cam.scenario.nominal), use)
        if how.reduce == "mean":
            return Mean(use, of_cam.kept.power)
        return by_duty(use, cam.scenario, of_cam.kept.power) if how.reduce in BY_DUTY else use

    return Constraint(of_cam.check, of_cam.key, utilisation, of_cam.row, of_cam.kept, of_cam.needs)

"""Least crown that keeps the axial pressure within a ratio at all loads and tilts.

A crown relieves the ends and loads the middle: with a heavier crown the greatest pressure falls as
long as the ends govern, and rises as soon as the middle does. The crowns within a ratio thus lie
between two design loads, about that of the lowest pressure; the least crown is the lighter one. At
either end the ratio is used up, and a deviation exceeds it: a drawing states the middle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, get_args

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.extrema import least_argument
from camwright.pipeline.base.crossing import first_passing
from camwright.pipeline.base.rounding import to_digits
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    Crown,
    FinitePair,
    Straight,
    TabulatedCrown,
    johns_gohar,
    lundberg,
)
from camwright.pipeline.cycle.length_history import ContactLoads
from camwright.pipeline.records.crown_document import CrownKind

IntArray = NDArray[np.intp]
KINDS: tuple[CrownKind, ...] = get_args(CrownKind)

# Design loads tried first, over that of the greatest pressure: powers of two.
_LIGHTEST, _HEAVIEST = -3, 3
# Most times that the heaviest is doubled while the ratio falls, under a great tilt of a light line.
_LADDER_DOUBLED = 6
# Of the design load, relative; of a ratio, between a state and one a cam angle beside it.
_PRECISION, _NEIGHBOUR = 5e-3, 5e-4
# Most states of a load case.
_STATES = 16
# States of the greatest ratios at which the sensitivity is computed.
_TOP = 8
# Golden sections of the search of the lowest ratio: 0.3 % of the range is left.
_LOAD_SECTIONS = 12
# Straight middle parts over the length of the crown that are tried for a relief of the ends, and
# rows of its table on the contact.
_STRAIGHT_PARTS, _RELIEF_ROWS = (0.4, 0.6, 0.8), 41
# Share of half the length where a drop without bound is stated.
_BOUNDED = 0.995
# Digits of a design load; of a radius, and of a drop, m: as they are written.
_LOAD_DIGITS, _RADIUS_DIGITS, _DROP_DECIMALS = 3, 4, 9


@dataclass(frozen=True, eq=False)
class ContactStates:
    """Load states of `count` contacts of two bodies, all (count,), as the rows of a cycle.

    curvature 1/m; force N, > 0; couple N m, the greatest that can hold the bodies tilted; tilt,
    forced: greatest and forced tilt, rad; p0 Pa, of plane strain at the mean line load; load_case,
    number of the load case.
    """

    curvature: Array
    force: Array
    couple: Array
    tilt: Array
    forced: Array
    p0: Array
    load_case: IntArray

    def __post_init__(self) -> None:
        """Refuse states without any contact; the arrays become read-only."""
        names = ("curvature", "force", "couple", "tilt", "forced", "p0")
        freeze(self, **{name: getattr(self, name) for name in names})
        if not self.force.size:
            raise InputError("contact", "without load", "loaded at one angle at least")

    @property
    def share(self) -> Array:
        """Plane-strain p0 (count,) over the greatest of the same load case."""
        greatest = np.zeros(int(self.load_case.max()) + 1)
        np.maximum.at(greatest, self.load_case, self.p0)
        return np.asarray(self.p0 / greatest[self.load_case])

    @property
    def worst(self) -> int:
        """Row of the greatest p0."""
        return int(np.argmax(self.p0))

    @property
    def governing(self) -> IntArray:
        """Indices of the load states at which the pressure of a load case can be greatest: no other
        state of the load case is at least as great in force, curvature, couple, tilt and forced
        tilt alike.

        The pressure grows with each of these. Of more than `_STATES` in a load case as many, evenly
        between them, and those of the greatest p0, force, couple and forced tilt.
        """
        chosen = []
        for case in np.unique(self.load_case):
            rows = np.flatnonzero(self.load_case == case)
            loads = np.stack([self.force, self.curvature, self.couple, self.tilt, self.forced])[
                :, rows
            ]
            more = loads[:, :, None] >= loads[:, None, :]
            same = (loads[:, :, None] == loads[:, None, :]).all(axis=0)
            first = rows[:, None] < rows[None, :]
            beaten = more.all(axis=0) & (~same | first)
            left = rows[~beaten.any(axis=0)]
            evenly = np.linspace(0, left.size - 1, min(left.size, _STATES)).round().astype(np.intp)
            measures = (self.p0, self.force, self.couple, self.forced)
            greatest = [left[np.argmax(each[left])] for each in measures]
            chosen.append(np.union1d(left[evenly], greatest))
        return np.concatenate(chosen)

    def at(self, rows: IntArray) -> ContactStates:
        """Some of the rows."""
        return ContactStates(
            self.curvature[rows], self.force[rows], self.couple[rows],
            self.tilt[rows], self.forced[rows], self.p0[rows], self.load_case[rows],
        )  # fmt: skip

    def loads(self, rows: IntArray, compliance: float, tilt: float = 1.0) -> ContactLoads:
        """Loads of some of the rows.

        Parameters
        ----------
        compliance : float   of the stem against a tilt, rad/(N m)
        tilt : float         factor of all tilts and couples
        """
        return ContactLoads(
            self.curvature[rows], self.force[rows], tilt * self.tilt[rows],
            tilt * self.forced[rows], np.full(rows.size, compliance), tilt * self.couple[rows],
            np.ones(rows.size),
        )  # fmt: skip


@dataclass(frozen=True)
class CrownFamily:
    """Crowns of one kind over a length (m) by design line load w (N/m); 0: straight.

    A `table` is a relief of the ends: straight on a share of the length, from there a parabola up
    to `reach` (m) from the middle. This and a circular crown of w end with the drop of the
    Johns-Gohar crown of w. Radius and table are rounded as they are written.

    curvature : float   1/m, of the contact whose half-width at w bounds the drop of Johns-Gohar
    modulus : float     E*, Pa
    """

    kind: CrownKind
    length: float
    curvature: float
    modulus: float
    reach: float
    straight: float = 0.0

    @property
    def gauge(self) -> float:
        """Axial position, m, of the stated end drop; inside the end where the drop diverges."""
        return 0.5 * self.length * (_BOUNDED if self.kind == "lundberg" else 1.0)

    def drop(self, load: float) -> float:
        """Drop at the end, m, of the crown of a design load, N/m."""
        return float(self.crown(load).drop(np.array([self.gauge]))[0])

    def crown(self, load: float) -> Crown:
        """Crown of the family for a design line load, N/m; straight for 0."""
        if load == 0:
            return Straight()
        if self.kind == "lundberg":
            return lundberg(load, self.length, self.modulus)
        half_width, _ = hertz.line_contact(load, 1.0 / self.curvature, self.modulus)
        bounded = johns_gohar(load, self.length, self.modulus, float(half_width))
        if self.kind == "johns_gohar":
            return bounded
        end = 0.5 * self.length
        drop = float(bounded.drop(np.array([end]))[0])
        if self.kind == "circular":
            radius = (end**2 + drop**2) / (2.0 * drop)
            return CircularCrown(to_digits(radius, _RADIUS_DIGITS, up=False))
        y = np.linspace(0.0, end, _RELIEF_ROWS)
        if self.reach > end:
            y = np.append(y, self.reach)
        beyond = np.maximum(y / end - self.straight, 0.0) / (1.0 - self.straight)
        return TabulatedCrown(y, np.round(drop * beyond**2, _DROP_DECIMALS))


def families(
    kind: CrownKind, length: float, curvature: float, modulus: float, reach: float
) -> tuple[CrownFamily, ...]:
    """Families of a kind of crown: one, or of a relief one per straight length tried."""
    parts = _STRAIGHT_PARTS if kind == "table" else (0.0,)
    return tuple(CrownFamily(kind, length, curvature, modulus, reach, each) for each in parts)


@dataclass(frozen=True)
class DeviatedCrown:
    """Crown with a deviation (m) of its end drop, quadratic towards the middle."""

    crown: Crown
    deviation: float
    length: float

    def drop(self, y: Array) -> Array:
        """Drop (...), m, at axial coordinates (...), m."""
        return np.asarray(self.crown.drop(y) + self.deviation * (2.0 * y / self.length) ** 2)


class AxialFactor(Protocol):
    """Stated axial pressure of a pair over plane strain."""

    def __call__(self, pair: FinitePair, loads: ContactLoads) -> Array:
        """Factors (count,), the worse of aligned and tilted."""
        ...


@dataclass(frozen=True, eq=False)
class CrownProblem:
    """Contact with load states and pressure ratio, for which a crown is sought.

    Parameters
    ----------
    pairs : callable           both bodies with a crown: one pair, or one for each end
    states : ContactStates     loads of each pair
    compliance : float         of the stem against a tilt, rad/(N m)
    families : tuple           crowns to choose from
    factor : AxialFactor            signed axial pressure over plane strain
    """

    pairs: Callable[[Crown], tuple[FinitePair, ...]]
    states: ContactStates
    compliance: float
    families: tuple[CrownFamily, ...]
    factor: AxialFactor

    def factors(self, crown: Crown, rows: IntArray | None = None, tilt: float = 1.0) -> Array:
        """Signed axial pressure over plane strain (count,), of the worse end.

        Infinite where the crown leaves hardly any contact.

        Parameters
        ----------
        rows : array (count,)   of the states; None: all
        tilt : float            factor of all tilts and couples
        """
        states = self.states
        rows = np.arange(states.force.size) if rows is None else rows
        loads = states.loads(rows, self.compliance, tilt)
        try:
            each = [self.factor(pair, loads) for pair in self.pairs(crown)]
        except ContactError:
            return np.full(rows.size, np.inf)
        return np.asarray(np.max(each, axis=0))

    def ratios(self, crown: Crown, rows: IntArray | None = None, tilt: float = 1.0) -> Array:
        """Signed axial pressure over the greatest of plane strain in the load case, (count,)."""
        share = self.states.share if rows is None else self.states.share[rows]
        return np.asarray(self.factors(crown, rows, tilt) * share)


@dataclass(frozen=True, eq=False)
class LeastCrown:
    """Crown within a pressure ratio: the least one, or the middle of the range.

    load : float       design load, N/m; 0: the straight contact keeps the ratio
    lightest : float   least design load that keeps it, N/m
    heaviest : float   greatest design load that keeps it, N/m; infinite beyond those tried
    ratios : array     (count,) of all states with the crown
    straight : array   (count,) of all states without it
    rows : array       states of the search, and those of the greatest ratios
    """

    problem: CrownProblem
    family: CrownFamily
    load: float
    lightest: float
    heaviest: float
    ratios: Array
    straight: Array
    rows: IntArray

    def __post_init__(self) -> None:
        freeze(self, ratios=self.ratios, straight=self.straight)

    @property
    def crown(self) -> Crown:
        """The crown."""
        return self.family.crown(self.load)

    @property
    def ratio(self) -> float:
        """Greatest ratio over all states."""
        return float(self.ratios.max())

    @property
    def drop(self) -> float:
        """Drop at the end, m."""
        return self.family.drop(self.load)

    def at_tilt(self, factor: float) -> float:
        """Greatest ratio of `rows` with the greatest tilt and all couples times a factor."""
        return float(self.problem.ratios(self.crown, self.rows, factor).max())

    def at_deviation(self, deviation: float) -> float:
        """Greatest pressure ratio over `rows` with a deviation of the end drop, m."""
        made = DeviatedCrown(self.crown, deviation, self.family.length)
        return float(self.problem.ratios(made, self.rows).max())


class NoCrownError(InputError):
    """No crown keeps a ratio; the message has the least one that is reached."""


def least_crown(problem: CrownProblem, ratio: float) -> LeastCrown:
    """Crown of least drop, of all families of a problem, whose pressure ratio is at most `ratio` in
    every load state.

    Raises
    ------
    NoCrownError
        If no crown keeps it, naming the least ratio that one reaches.
    InputError
        If the ratio is not positive.
    """
    if not 0 < ratio < np.inf:
        raise InputError("ratio", ratio, "> 0")
    straight = problem.ratios(Straight())
    tried = [_of_family(problem, family, ratio, straight) for family in problem.families]
    within = [each for each in tried if each.ratio <= ratio]
    if within:
        return min(within, key=lambda each: each.drop)
    lowest = min(tried, key=lambda each: each.ratio)
    reached = np.ceil(lowest.ratio * 1e4) / 1e4
    by = f"a drop of {shown(lowest.drop, 'um', 3)} at its ends" if lowest.load else "no crown"
    kind = lowest.family.kind
    raise NoCrownError("ratio", ratio, f">= {reached:.4f}, the least of kind {kind}: by {by}")


def middle_crown(least: LeastCrown, ratio: float) -> LeastCrown:
    """Crown of the mean of the least and the greatest drop of the crowns within a pressure ratio.

    The least crown itself where none is needed, or where the range is no wider than the search is
    precise. Where the heaviest crown tried is within the ratio, it ends the range.

    Parameters
    ----------
    least : LeastCrown   crown of least drop, with the range of its family
    ratio : float        greatest pressure over that of plane strain
    """
    if least.load == 0:
        return least
    problem, family = least.problem, least.family
    low, high = least.load, least.heaviest
    if not np.isfinite(high):
        high = max(low, _ladder(problem, family)[-1])
    wanted = 0.5 * (family.drop(low) + family.drop(high))

    def beyond(load: float) -> float | None:
        return load if family.drop(load) > wanted else None

    load = to_digits(first_passing(beyond, low, (high,), near=_alike) or high, _LOAD_DIGITS)
    ratios = problem.ratios(family.crown(load))
    if not ratios.max() <= ratio:
        return least
    rows = np.union1d(least.rows, np.argsort(-ratios)[:_TOP])
    return replace(least, load=load, ratios=ratios, rows=rows)


def _ladder(problem: CrownProblem, family: CrownFamily) -> list[float]:
    """Design loads tried first, N/m."""
    scale = float(problem.states.force[problem.states.worst]) / family.length
    return [
        0.0,
        *(to_digits(scale * 2.0**k, _LOAD_DIGITS) for k in range(_LIGHTEST, _HEAVIEST + 1)),
    ]


def _of_family(
    problem: CrownProblem, family: CrownFamily, ratio: float, straight: Array
) -> LeastCrown:
    """Crown of least drop of one family within a pressure ratio, or that of the lowest ratio where
    none is within it.

    The search evaluates few load states; after it, those that exceed the ratio at its crown are
    added and it is repeated.

    Parameters
    ----------
    problem : CrownProblem   contact and load states
    family : CrownFamily     crowns of one kind by design load
    ratio : float            greatest pressure over that of plane strain
    straight : array         ratio of each state without a crown
    """
    rows, aim = _governing(problem.states, straight), ratio
    while True:
        search = _CrownSearch(problem, family, rows)
        load, heaviest = search.within(aim)
        ratios = problem.ratios(family.crown(load))
        worst = int(ratios.argmax())
        if ratios[worst] <= max(ratio, (1.0 + _NEIGHBOUR) * search.at(load)) or worst in rows:
            top = [np.argsort(-each)[:_TOP] for each in (ratios, straight)]
            kept = np.unique(np.concatenate([rows, *top]))
            return LeastCrown(problem, family, load, load, heaviest, ratios, straight, kept)
        rows = np.union1d(rows, _greatest_of_each(problem.states, ratios))
        aim = (1.0 - _NEIGHBOUR) * ratio


def _governing(states: ContactStates, straight: Array) -> IntArray:
    """First rows of the search: of each load case the greatest p0, couple and straight ratio."""
    measures = states.p0, states.couple, straight
    return np.unique(np.concatenate([_greatest_of_each(states, each) for each in measures]))


def _greatest_of_each(states: ContactStates, measure: Array) -> IntArray:
    """Row of the greatest measure of each load case."""
    cases = [np.flatnonzero(states.load_case == each) for each in np.unique(states.load_case)]
    return np.array([own[np.argmax(measure[own])] for own in cases], dtype=np.intp)


class _CrownSearch:
    """Greatest ratio of some rows over the design load (N/m), each computed once."""

    def __init__(self, problem: CrownProblem, family: CrownFamily, rows: IntArray) -> None:
        self._problem, self._family, self._rows = problem, family, rows
        self._ladder = _ladder(problem, family)
        self._values: dict[float, float] = {}

    def at(self, load: float) -> float:
        """Greatest pressure ratio, over the load states of the search, with the crown of a design
        load, N/m; computed once for each load.
        """
        if load not in self._values:
            crown = self._family.crown(load)
            self._values[load] = float(self._problem.ratios(crown, self._rows).max())
        return self._values[load]

    def within(self, ratio: float) -> tuple[float, float]:
        """Least and greatest design load, N/m, of the crowns whose greatest pressure ratio is at
        most `ratio`, about the crown of the lowest ratio.

        The greatest is infinite where all loads tried above keep the ratio; where even the lowest
        ratio is too great, both are the load of the lowest ratio.
        """
        lowest = min(self._ladder, key=self.at)
        for _ in range(_LADDER_DOUBLED):
            if self.at(lowest) <= ratio or lowest < self._ladder[-1]:
                break
            self._ladder.append(to_digits(2.0 * lowest, _LOAD_DIGITS))
            lowest = min(self._ladder, key=self.at)
        if not self.at(lowest) <= ratio:
            lowest = self._lowest()
        if not self.at(lowest) <= ratio:
            return lowest, lowest
        least = heaviest = lowest
        for load in reversed(self._ladder):
            if load < lowest:
                if not self.at(load) <= ratio:
                    least = self._crossing(load, least, ratio)
                    break
                least = load
        for load in self._ladder:
            if load > lowest:
                if not self.at(load) <= ratio:
                    return least, self._crossing(load, heaviest, ratio)
                heaviest = load
        return least, np.inf

    def _crossing(self, outside: float, within: float, ratio: float) -> float:
        """Design load, N/m, at which the greatest pressure ratio reaches `ratio`, on its side that
        keeps the ratio; the least load of a range is rounded to few digits where the rounded one
        keeps it.

        Parameters
        ----------
        outside : float   load whose crown exceeds the ratio, N/m
        within : float    load whose crown keeps it, N/m
        ratio : float     greatest pressure over that of plane strain
        """

        def keeps(load: float) -> float | None:
            return load if self.at(load) <= ratio else None

        within = first_passing(keeps, outside, (within,), near=_alike) or within
        if within < outside:
            return within
        rounded = to_digits(within, _LOAD_DIGITS)
        return rounded if self.at(rounded) <= ratio else within

    def _lowest(self) -> float:
        """Design load, N/m, of the lowest ratio, by golden sections between the neighbours of the
        best load tried.
        """
        best, last = min(self._ladder, key=self.at), len(self._ladder) - 1
        place = self._ladder.index(best)
        left, right = self._ladder[max(place - 1, 0)], self._ladder[min(place + 1, last)]
        least_argument(self.at, left, right, _LOAD_SECTIONS)
        return min(self._values, key=lambda load: (self._values[load], load))


def _alike(one: float, other: float) -> bool:
    """Whether two design loads are within `_PRECISION`."""
    return abs(one - other) <= _PRECISION * max(one, other)

"""When no cam keeps all limits: which of them conflict, and what would make room."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import TypedDict

import numpy as np

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.smoothing.bounds import FACTOR_MAX, Eased, bounds_of
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.synthesis_problem import Problem, coarsened

_BISECTIONS = 5
_IN_HAND = 1.02  # a relaxation is given with this much beyond the least one found
_NEARLY = 0.8

Change = Callable[[Problem, float], Problem]


@dataclass(frozen=True)
class Relaxation:
    """One change that makes room: from and to in `unit`; cost is the factor of the change."""

    what: str
    given: float
    asked: float
    unit: str
    factor: float
    change: Change = field(repr=False, compare=False)

    @property
    def sentence(self) -> str:
        unit = f" {self.unit}" if self.unit != "-" else ""
        return f"{self.what}: {self.asked:.4g}{unit} instead of {self.given:.4g}{unit}"

    def applied(self, problem: Problem) -> Problem:
        """The problem as the relaxation would have it."""
        return self.change(problem, self.factor)


class ConflictRecord(TypedDict):
    """JSON record of conflicting limits and of the relaxations, the cheapest first."""

    conflict: list[str]
    relaxations: list[dict[str, str | float]]


@dataclass(frozen=True)
class Infeasibility:
    """Limits of which every smaller set can be kept, and single changes that free them."""

    conflict: tuple[str, ...]
    relaxations: tuple[Relaxation, ...]

    def as_record(self) -> ConflictRecord:
        return {
            "conflict": list(self.conflict),
            "relaxations": [
                {"what": r.what, "from": r.given, "to": r.asked, "unit": r.unit,
                 "factor": r.factor, "sentence": r.sentence}
                for r in self.relaxations
            ],
        }  # fmt: skip

    @property
    def sentence(self) -> str:
        """One line for the statement of a run."""
        names = ", ".join(self.conflict) or "the limits taken together"
        ways = "; or ".join(item.sentence for item in self.relaxations[:3])
        return f"no cam keeps together: {names}" + (f"; what would do: {ways}" if ways else "")


@dataclass(frozen=True)
class _Row:
    """One change to try: words, value as shown, unit, and by what factor at most.

    direction -1: a smaller value makes room.
    """

    what: str
    given: float
    unit: str
    change: Change
    direction: int = 1
    most: float = FACTOR_MAX


def infeasibility(problem: Problem, rollers: Iterable[tuple[str, Problem]] = ()) -> Infeasibility:
    """Smallest set of conflicting limits, and relaxations that are found feasible.

    The set is what a deletion filter leaves: each limit in turn is dropped and stays out where
    the others still conflict. Each relaxation is the least factor, by bisection, at which a cam
    is found; the cheapest comes first. Where a limit of the roller is in the set, the first
    roller of a catalogue that leaves room for a cam is one of them.

    Parameters
    ----------
    problem : Problem   of which no feasible design was found
    rollers : iterable  name and problem of the rollers there are, the smallest first

    References
    ----------
    Chinneck and Dravnieks, ORSA J. Computing 3 (1991) 157: the deletion filter.
    """
    coarse = coarsened(problem)
    asked = synthesise(coarse, ripple_weight=0.0)
    candidates = sorted(asked.utilisation, key=lambda name: asked.utilisation[name])
    out = coarse.left_out
    conflict = []
    for name in candidates:
        if _possible(replace(coarse, left_out=out | {name})):
            conflict.append(name)
        else:
            out = out | {name}
    # The candidates came from the least used: the most used is named first.
    found = [_least(coarse, row) for row in _rows(problem, conflict)]
    kept = [item for item in found if item is not None]
    if any(name.startswith("roller") for name in conflict):
        kept += _from_catalogue(problem, rollers, kept)
    if TORQUE_REDUCTION.id in conflict:
        kept += _less_reduction(coarse)
    return Infeasibility(
        tuple(reversed(conflict)), tuple(sorted(kept, key=lambda item: item.factor))
    )


def _possible(problem: Problem) -> bool:
    """Whether a cam is found. What is asked of the ripple is compared with the least one:

    as a limit it would hold the search up among the limits that conflict with it.
    """
    weights = {item.weight for item in problem.scenarios if item.weight > 0}
    torque_alone = problem.speed_weight == 0.0 and problem.torque_weight == 1.0
    if problem.ceiling is None or weights != {1.0} or not torque_alone:
        return synthesise(problem, ripple_weight=0.0).feasible
    best = synthesise(replace(problem, left_out=problem.left_out | {TORQUE_REDUCTION.id}))
    return best.feasible and best.ripple <= problem.ceiling


def _rows(problem: Problem, conflict: list[str]) -> list[_Row]:
    """Every single change that may make room: bounds of the set, then spring and prime radius."""
    rows = [
        _Row(
            bound.words,
            bound.value,
            bound.unit,
            _eased(bound.eased),
            1 if bound.slope > 0.0 else -1,
            bound.factor_max,
        )
        for name, bound in bounds_of(problem.ratings).items()
        if name in conflict and bound.eased is not None
    ]
    for name, what, unit, direction in (
        ("rate", "spring rate", "N/mm", -1),
        ("preload", "preload", "N", -1),
        ("prime_radius", "prime radius", "mm", 1),
    ):
        if name not in problem.freed:
            value = in_unit(getattr(problem.variables, name), unit)
            rows.append(_Row(what, value, unit, _built(name), direction))
    return rows


def _eased(eased: Eased) -> Change:
    return lambda given, factor: replace(given, ratings=eased(given.ratings, factor))


def _built(name: str) -> Change:
    def change(given: Problem, factor: float) -> Problem:
        value = getattr(given.variables, name) * factor
        return replace(given, variables=replace(given.variables, **{name: value}))

    return change


def _least(problem: Problem, row: _Row) -> Relaxation | None:
    """The least factor that leaves room for a cam, a little in hand; None up to the most."""
    low, high = 1.0, row.most
    if high <= _IN_HAND or not _possible(row.change(problem, high**row.direction)):
        return None
    for _ in range(_BISECTIONS):
        middle = float(np.sqrt(low * high))
        if _possible(row.change(problem, middle**row.direction)):
            high = middle
        else:
            low = middle
    factor = high * _IN_HAND

    def change(given: Problem, cost: float) -> Problem:
        return row.change(given, cost**row.direction)

    asked = row.given * factor**row.direction
    return Relaxation(row.what, row.given, asked, row.unit, factor, change)


def _from_catalogue(
    problem: Problem, rollers: Iterable[tuple[str, Problem]], found: list[Relaxation]
) -> list[Relaxation]:
    """The first roller of a catalogue with which there is a cam.

    Those that bear much less than was found to be needed are passed over: a larger roller may
    do with a little less, as it leans less on the cam.
    """
    given = problem.ratings.normal_force
    if given is None:
        return []
    needed = max(
        [_NEARLY * r.asked for r in found if r.unit == "N" and r.given == given], default=given
    )
    for name, other in rollers:
        borne = other.ratings.normal_force
        if borne is not None and borne >= needed and _possible(coarsened(other)):
            what = f"roller {name} of the catalogue, normal force"
            return [Relaxation(what, given, borne, "N", borne / given, _instead(other))]
    return []


def _instead(other: Problem) -> Change:
    return lambda _given, _factor: other


def _less_reduction(problem: Problem) -> list[Relaxation]:
    """The reduction that the other limits leave room for."""
    floor = problem.torque_reduction
    best = synthesise(replace(problem, left_out=problem.left_out | {TORQUE_REDUCTION.id}))
    if floor is None or not best.feasible:
        return []
    asked = 1.0 - best.ripple * _IN_HAND

    def change(given: Problem, _: float) -> Problem:
        return replace(given, torque_reduction=asked)

    factor = (1.0 - asked) / (1.0 - floor)
    return [Relaxation(TORQUE_REDUCTION.title, floor, asked, "-", factor, change)]

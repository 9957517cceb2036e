"""Conflicting limits of a synthesis, and relaxations that make it feasible."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import FACTOR_MAX
from camwright.pipeline.checks.demands import NORMAL_FORCE
from camwright.pipeline.records.trial_contents import ConflictRecord
from camwright.pipeline.smoothing import bounds
from camwright.pipeline.smoothing.bounds import bounds_of
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.multistart import continued
from camwright.pipeline.smoothing.objective import TORQUE, Weighted
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Problem, coarsened

_BISECTIONS = 5
_RELAXATION_MARGIN = 1.02  # factor of a relaxation over the least feasible one
_ROLLER_FORCE_SHARE = 0.8  # of the necessary force: a larger roller lowers it

Change = Callable[[Problem, float], Problem]


@dataclass(frozen=True)
class Relaxation:
    """Feasible relaxation: a value from `before` to `after` in `unit`, by `factor`."""

    what: str
    before: float
    after: float
    unit: str
    factor: float
    change: Change = field(repr=False, compare=False)

    @property
    def sentence(self) -> str:
        """The change in words."""
        unit = f" {self.unit}" if self.unit != "-" else ""
        return f"{self.what}: {self.after:.4g}{unit} instead of {self.before:.4g}{unit}"


@dataclass(frozen=True)
class Infeasibility:
    """Minimal set of conflicting limits, and relaxations, the smallest first."""

    conflict: tuple[str, ...]
    relaxations: tuple[Relaxation, ...]

    def as_record(self) -> ConflictRecord:
        """The JSON record."""
        return {
            "conflict": list(self.conflict),
            "relaxations": [
                {"what": each.what, "from": each.before, "to": each.after, "unit": each.unit,
                 "factor": each.factor, "sentence": each.sentence}
                for each in self.relaxations
            ],
        }  # fmt: skip

    @property
    def sentence(self) -> str:
        """Conflict and relaxations in one line."""
        names = ", ".join(self.conflict) or "the limits taken together"
        ways = "; or ".join(item.sentence for item in self.relaxations[:3])
        return f"the synthesis does not keep together: {names}" + (
            f"; feasible with {ways}" if ways else ""
        )


@dataclass(frozen=True)
class _Candidate:
    """A change to try. direction -1: a smaller value relaxes the problem."""

    what: str
    value: float
    unit: str
    change: Change
    direction: int = 1
    factor_max: float = FACTOR_MAX


def infeasibility(
    problem: Problem,
    rollers: Iterable[tuple[str, Problem]] = (),
    solved: Problem | None = None,
    margin: float = 0.0,
) -> Infeasibility:
    """Minimal set of conflicting limits by a deletion filter, and feasible relaxations.

    A deletion filter determines the set: each limit in turn is dropped, and stays out where the
    rest still conflict; groups of limits are dropped at once, and halved where they may not. The
    factor of each relaxation is the least feasible one, by bisection. Where a limit of the roller
    is in the set, the first feasible roller of a catalogue is one of the relaxations.

    Parameters
    ----------
    problem : Problem   without a feasible design
    rollers : iterable  name and problem of alternative rollers, the smallest first
    solved : Problem    with the corrections of the nearest solved cam, in which the relaxations are
                        feasible; None: the problem itself
    margin : float      of those corrections, which change with the cam, and of each relaxation

    References
    ----------
    Chinneck and Dravnieks, ORSA J. Computing 3 (1991) 157: the deletion filter.
    """
    coarse = coarsened(problem)
    nearest = synthesise(coarse, ripple_weight=0.0)
    least_used_first = sorted(nearest.utilisation, key=lambda name: nearest.utilisation[name])
    conflict, _ = _conflicting(coarse, least_used_first)
    conflict.reverse()
    wide = _with_margin(coarse if solved is None else coarsened(solved), margin)
    least = _RELAXATION_MARGIN + margin
    corrected = problem if solved is None else solved
    tried = [_smallest(wide, each, least) for each in _candidates(corrected, conflict)]
    relaxations = [item for item in tried if item is not None]
    if any(name.startswith("roller") for name in conflict):
        wider = ((name, _with_margin(other, margin)) for name, other in rollers)
        relaxations += _from_catalogue(problem, wider, relaxations)
    if TORQUE_REDUCTION.id in conflict:
        relaxations += _less_reduction(wide, _with_margin(corrected, margin), least)
    return Infeasibility(tuple(conflict), tuple(sorted(relaxations, key=lambda item: item.factor)))


def _with_margin(problem: Problem, margin: float) -> Problem:
    """The problem with greater corrections."""
    if margin == 0.0:
        return problem
    return replace(
        problem,
        scenarios=tuple(
            replace(item, correction=item.correction.enlarged(margin)) for item in problem.scenarios
        ),
    )


def _conflicting(
    problem: Problem, names: list[str], *, needed: bool = False
) -> tuple[list[str], Problem]:
    """Limits of a group that conflict with the other limits, found by halving the group, and the
    problem in which only these of the group are kept.

    Parameters
    ----------
    problem : Problem   with all limits that are still in question
    names : list        the group
    needed : bool       whether a cam is known to exist without the group; else this is tried first

    References
    ----------
    Junker, AAAI (2004) 167: conflicts by divide and conquer.
    """
    without = replace(problem, left_out=problem.left_out | set(names))
    if not needed and not _feasible(without):
        return [], without
    if len(names) == 1:
        return names, problem
    middle = len(names) // 2
    first, problem = _conflicting(problem, names[:middle])
    second, problem = _conflicting(problem, names[middle:], needed=not first)
    return first + second, problem


def _feasible(problem: Problem) -> bool:
    """Whether a synthesis yields a cam within all limits of a problem.

    A limit on the ripple is compared with the least ripple: as a constraint it would slow the
    search among the limits that conflict with it.
    """
    ripple = _ripple_over_ceilings(problem)
    if ripple is None:
        return synthesise(problem, ripple_weight=0.0, enough=np.inf).feasible
    best = synthesise(ripple, enough=1.0)
    return best.feasible and best.ripple <= 1.0


def _ripple_over_ceilings(problem: Problem) -> Problem | None:
    """Problem that minimises the greatest ratio of the torque ripple of a scenario to its ceiling,
    with the ceilings left out of the limits; None without a ceiling.
    """
    ceilings = [problem.ceiling_of(item) for item in problem.scenarios]
    if all(ceiling is None for ceiling in ceilings):
        return None
    weights = [0.0 if ceiling is None else 1.0 / ceiling for ceiling in ceilings]
    return replace(
        problem,
        scenarios=tuple(
            replace(item, weight=weight)
            for item, weight in zip(problem.scenarios, weights, strict=True)
        ),
        objective=(Weighted(TORQUE, 1.0),),
        left_out=problem.left_out | {TORQUE_REDUCTION.id},
    )


def _candidates(problem: Problem, conflict: list[str]) -> list[_Candidate]:
    """Single changes that may make a problem feasible: a looser bound of a limit in conflict, a
    softer spring, a lower preload, a prime radius as great as an arm reaches; of the last three
    those that are not variables already.

    Parameters
    ----------
    conflict : list   names of the limits that conflict
    """
    candidates = [
        _Candidate(
            bound.words,
            bound.value,
            bound.unit,
            _with_ratings(bound.relaxed),
            1 if bound.slope > 0.0 else -1,
            bound.factor_max,
        )
        for name, bound in bounds_of(problem.ratings).items()
        if name in conflict and bound.relaxed is not None
    ]
    for name, what, unit, direction, most in (
        ("rate", "spring rate", "N/mm", -1, FACTOR_MAX),
        ("preload", "preload", "N", -1, FACTOR_MAX),
        ("prime_radius", "prime radius", "mm", 1, _greatest_growth(problem)),
    ):
        if name not in problem.freed:
            value = in_unit(getattr(problem.variables, name), unit)
            change = _with_variable(name)
            candidates.append(_Candidate(what, value, unit, change, direction, most))
    return candidates


def _greatest_growth(problem: Problem) -> float:
    """Greatest factor on the prime radius: of an arm within its reach."""
    case = problem.ratings.numbers.case
    arm = None if case is None else case.follower.arm
    if case is None or arm is None:
        return FACTOR_MAX
    _, most = arm.reach(case.facing.offset)
    return min(FACTOR_MAX, most / problem.variables.prime_radius)


def _with_ratings(relaxed: bounds.Change) -> Change:
    return lambda problem, factor: replace(problem, ratings=relaxed(problem.ratings, factor))


def _with_variable(name: str) -> Change:
    """Change of a problem, by a factor, that multiplies one of its design variables, `name`."""

    def change(problem: Problem, factor: float) -> Problem:
        value = getattr(problem.variables, name) * factor
        return replace(problem, variables=replace(problem.variables, **{name: value}))

    return change


def _smallest(problem: Problem, tried: _Candidate, margin: float) -> Relaxation | None:
    """Relaxation with the smallest factor of a change for which a cam keeps all limits, found by
    bisection on a logarithmic scale, times a margin.

    None where the greatest factor is within the margin or does not suffice.

    Parameters
    ----------
    problem : Problem    without a feasible cam
    tried : _Candidate   change, with its direction: a factor f > 1 multiplies the value by f or 1/f
    margin : float       factor >= 1 on the smallest one
    """
    low, high = 1.0, tried.factor_max
    if high <= margin or not _feasible(tried.change(problem, high**tried.direction)):
        return None
    for _ in range(_BISECTIONS):
        middle = float(np.sqrt(low * high))
        if _feasible(tried.change(problem, middle**tried.direction)):
            high = middle
        else:
            low = middle
    factor = high * margin

    def change(other: Problem, size: float) -> Problem:
        return tried.change(other, size**tried.direction)

    after = tried.value * factor**tried.direction
    return Relaxation(tried.what, tried.value, after, tried.unit, factor, change)


def _from_catalogue(
    problem: Problem, rollers: Iterable[tuple[str, Problem]], relaxations: list[Relaxation]
) -> list[Relaxation]:
    """List with the first roller of a catalogue with which a cam keeps all limits, as a relaxation
    of the normal force; empty without one.

    Rollers rated below `_ROLLER_FORCE_SHARE` of the necessary force are skipped; the share is below
    1, as a larger roller lowers the pressure angle.

    Parameters
    ----------
    problem : Problem        without a feasible cam
    rollers : iterable       name and problem with each roller, the smallest first
    relaxations : sequence   already found; that of the normal force, N, states the necessary one
    """
    force = problem.ratings.bounds.get(NORMAL_FORCE)
    if force is None:
        return []
    needed = max(
        [_ROLLER_FORCE_SHARE * r.after for r in relaxations if r.unit == "N" and r.before == force],
        default=force,
    )
    for name, other in rollers:
        rated = other.ratings.bounds.get(NORMAL_FORCE)
        if rated is not None and rated >= needed and _feasible(coarsened(other)):
            what = f"roller {name} of the catalogue, normal force"
            return [Relaxation(what, force, rated, "N", rated / force, _replaced_by(other))]
    return []


def _replaced_by(other: Problem) -> Change:
    return lambda _problem, _factor: other


def _less_reduction(problem: Problem, fine: Problem, margin: float) -> list[Relaxation]:
    """Relaxation of the required ripple reduction to the greatest one that a cam within the other
    limits reaches, less a margin; [] where no cam keeps the other limits.

    It is less than the required reduction by the margin at least, since a coarse problem may seem
    to keep that.

    Parameters
    ----------
    problem : Problem   on few splines
    fine : Problem      the same on all its splines, which leave less ripple
    margin : float      factor, > 1, on the least ripple left
    """
    ripple, ripple_of_all = _ripple_over_ceilings(problem), _ripple_over_ceilings(fine)
    best = None if ripple is None else synthesise(ripple)
    if best is None or ripple_of_all is None or not best.feasible:
        return []
    least = continued(ripple_of_all, best)
    left = min(best.ripple, least.ripple) if least.feasible else best.ripple
    factor = max(left * (1.0 - RESERVE), 1.0) * margin

    def less(required: float | None, size: float) -> float | None:
        return None if required is None else 1.0 - (1.0 - required) * size

    def change(other: Problem, size: float) -> Problem:
        scenarios = (
            replace(item, torque_reduction=less(item.torque_reduction, size))
            for item in other.scenarios
        )
        return replace(other, scenarios=tuple(scenarios))

    required = max(item.torque_reduction or 0.0 for item in problem.scenarios)
    after = 1.0 - (1.0 - required) * factor
    return [Relaxation(TORQUE_REDUCTION.title, required, after, "-", factor, change)]

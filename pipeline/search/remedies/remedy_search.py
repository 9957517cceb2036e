"""Search and verification of the smallest single change for each failed check.

The levers of all failed checks are pulled by rising steps, each solved once for every check that
it can cure. Between the last two steps the value is found by interpolation, rounded, put into the
case and judged.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from camwright.geometry.errors import CamError
from camwright.geometry.lift import Lift
from camwright.pipeline.base import units
from camwright.pipeline.base.levers import (
    LENGTHS,
    Catalogued,
    Crowned,
    Drilled,
    Lever,
    Scaled,
)
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.case_values import value_of
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.lost_loads import STALLS
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.follower.follower_forces import LEAVES, LOCKS
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.judge import Depth, Judge, Judgement, used
from camwright.pipeline.search.remedies.lever_steps import Step, Workbench, without_exponent
from camwright.pipeline.search.remedies.remedy import Remedy
from camwright.pipeline.search.remedies.side_effects import effects, newly_failing

IN_A_RUN, LEAST_IN_A_RUN = 18, 3
"""Failed checks of a run whose remedies are sought, the worst ones: their number times that of the
load cases, and the least number."""
LEVELS = (0.15, 0.4, 0.8, math.log(4.0), 2.0, 3.0)
"""Sizes of the steps, |ln| of the factor on a value."""
_SIZES_THAT_TIE = 1.1  # ratio of two sizes that count as equal: the side effects then decide
_LEVERS_VERIFIED = 3  # levers verified for a check
_COARSE_LEVELS = (0.4, math.log(4.0))  # levels of the length of a crowned contact, each a new table
_COARSE_PREVIEWS = 2
_PREVIEWS = 5  # of one lever for a check, at most
_ENOUGH = 0.9  # utilisation of a change that is small enough
_FURTHER = 1.005  # size of a change over the interpolated one
_HOPELESS_USE = 4.0
"""Utilisation, extrapolated to the end of its range, beyond which a lever is left."""
_CORNERS = 5  # worst ones of a check, at which its remedy is sought
_FROM = 0.3  # size of a change from which it is extrapolated
_FIRST = {
    LEAVES: "first keep the follower on the cam",
    LOCKS: "first keep the follower from locking",
    STALLS: "first keep the crank from stalling",
}
"""Until then no change is judged in every load case."""
_LEAST_USED = 1e-3  # utilisation of an interpolation


class Failure(NamedTuple):
    """Failed check: id, utilisation at the worst corner, worst corners in order."""

    check: str
    used: float
    corners: tuple[str, ...]


def failures_of(trial: Trial) -> tuple[Failure, ...]:
    """Failed must-have checks of the design in a trial, worst first."""
    failing = [
        one
        for one in trial.checks
        if one.must_have and one.status == "fail" and not one.evidence and one.declaration.levers
    ]
    made = [Failure(one.id, used(one), _worst_corners(trial, one)) for one in failing]
    return tuple(sorted(made, key=lambda each: (-each.used, each.check)))


def _worst_corners(trial: Trial, one: Check) -> tuple[str, ...]:
    """Names of the `_CORNERS` tolerance corners with the worst demands of a check, the governing
    one first.

    All corners where the worst demands are equal or not finite: another one may then govern.

    Parameters
    ----------
    trial : Trial   with its solved corners
    one : Check     the check
    """
    sign = -1.0 if one.sense == "at_most" else 1.0
    solved = [each for each in trial.corners if one.id in each.demands]
    ranked = sorted(solved, key=lambda each: sign * each.demands[one.id])
    names = (one.corner, *(each.corner.name for each in ranked))
    every = tuple(dict.fromkeys(name for name in names if name))
    demands = [each.demands[one.id] for each in ranked[:_CORNERS]]
    tied = not np.isfinite(demands).all() or len(set(demands)) < len(demands)
    return every if tied else every[:_CORNERS]


class Order(NamedTuple):
    """Input of a remedy search in plain values, for a worker process.

    Parameters
    ----------
    case : str         text of the case, with the smoother of the trial
    folder : Path      of the files that it includes; None: it includes none
    cards : Path       folder of the user's cards; None: shipped cards only
    lift : Lift        of a constrained synthesis; None: drawn from the case
    failures : tuple   of the trial
    sought : tuple     ids of the checks whose remedy is sought; others count as side effects
    """

    case: str
    folder: Path | None
    cards: Path | None
    lift: Lift | None
    failures: tuple[Failure, ...]
    sought: tuple[str, ...]

    @property
    def parts(self) -> tuple[Order, ...]:
        """Remedy search divided into two for two processes, each with half of the checks, related
        ones together.

        The remedy of a check does not depend on the others that are sought.
        """
        names = [name for name in DECLARED if name in self.sought]
        middle = -(-len(names) // 2)
        halves = tuple(names[:middle]), tuple(names[middle:])
        return tuple(self._replace(sought=half) for half in halves if half)


def order_of(trial: Trial, folder: Path | None) -> Order:
    """Remedy search of the worst failed checks of a trial; see `IN_A_RUN`.

    Parameters
    ----------
    folder : Path   with the copies of the included files, such as the run folder
    """
    count = max(LEAST_IN_A_RUN, IN_A_RUN // len(trial.cycles))
    worst = failures_of(trial)[:count]
    return Order(
        case=as_drawn(trial).to_toml(),
        folder=folder,
        cards=trial.case.folder,
        lift=_held_lift(trial),
        failures=worst,
        sought=tuple(each.check for each in worst),
    )


def texts_of(order: Order) -> dict[str, str]:
    """Remedies of an order, one line by check id; runs in a worker process."""
    case = parse_case(order.case, order.folder)
    made = remedies(case, order.cards, order.lift, order.failures, order.sought)
    return {name: remedy.text for name, remedy in made.items()}


def remedies_of(trial: Trial) -> dict[str, Remedy]:
    """Remedies of a trial's failed must-have checks by id; empty if none fails."""
    case = as_drawn(trial)
    return remedies(case, case.folder, _held_lift(trial), failures_of(trial))


def _held_lift(trial: Trial) -> Lift | None:
    """Lift of a constrained synthesis; None: drawn from the case."""
    return trial.lift if trial.case.smoothing.kind == "constrained" else None


def with_remedies(checks: Iterable[Check], texts: Mapping[str, str]) -> tuple[Check, ...]:
    """Checks with the remedies of the failed ones."""
    return tuple(
        replace(one, remedy=texts.get(one.id, "")) if one.status == "fail" else one
        for one in checks
    )


def as_drawn(trial: Trial) -> Case:
    """Case of a trial with its smoother as wide as in the last smoothing of the lift."""
    case, strength = trial.case, trial.smoothing.strength
    if strength is None or strength == 1.0:
        return case
    widths = {"harmonic": "harmonics", "gaussian": "width", "smoothing_spline": "cutoff"}
    key = f"smoothing.{widths.get(case.smoothing.kind, 'spacing')}"
    width: float = value_of(case, key)
    wider = width / strength if case.smoothing.kind == "harmonic" else width * strength
    return with_values(case, {key: wider})


def remedies(
    case: Case,
    cards: Path | None,
    lift: Lift | None,
    failures: Sequence[Failure],
    sought: Collection[str] | None = None,
) -> dict[str, Remedy]:
    """Smallest single change that turns each failed check to pass, by its id.

    Of several levers the one with the smallest ratio of the new value to the old is taken. A check
    without levers has no remedy.

    Parameters
    ----------
    cards : Path     folder of the user's cards; None: shipped cards only
    lift : Lift      held, that of a constrained synthesis; None: drawn from each case
    failures : sequence   of the case
    sought : collection   ids of the checks whose remedy is sought; None: of all failures
    """
    known = {each.check: each for each in failures if DECLARED[each.check].levers}
    wanted = {name: each for name, each in known.items() if sought is None or name in sought}
    if not wanted:
        return {}
    corners = {each.check: each.corners for each in known.values()}
    judge = Judge(case, engine_torques(case), cards, lift, corners)
    base = judge.judged(Change(), _depth(corners, known)._replace(undercut=True))
    bench = Workbench(case, cards, _greatest_line_load(base))
    return _RemedySearch(bench, judge, base, wanted).remedies()


def _depth(corners: Mapping[str, Sequence[str]], names: Iterable[str]) -> Depth:
    """Depth of a preview that judges every check at the corner that governs one of `names`, and
    single checks at the worst corners of `names` and the governing corner of every check.

    Parameters
    ----------
    corners : mapping   worst tolerance corners by check, the governing one first
    names : iterable    ids of checks
    """
    of_names = [corners.get(name, ()) for name in names]
    of_any = {names[0] for names in corners.values() if names}
    governing = {name for names in of_names for name in names[:1]}
    return Depth(corners=governing, worst=of_any.union(*of_names), bounds=False)


def _greatest_line_load(base: Judgement) -> float | None:
    """Greatest line load of the cycles whose loads hold, N/m; None where none is known."""
    held = [cycle.contact.line_load for cycle in base.solved.cycles if cycle.end is None]
    known = [float(np.nanmax(each)) for each in held if not np.isnan(each).all()]
    return max(known, default=None)


class _Seen(NamedTuple):
    """Step of a lever with the utilisation of a check, as judged or by the search."""

    step: Step
    used: float
    judged: bool = False

    def times(self, ratio: float) -> _Seen:
        """The step with the utilisation of the search corrected by a ratio."""
        return self if self.judged else self._replace(used=ratio * self.used)


class _Crossing(NamedTuple):
    """Lever that cures a check between two steps: `above` its limit, None: the case, and below."""

    size: float
    lever: Lever
    above: _Seen | None
    below: _Seen


class _Confirmed(NamedTuple):
    """Step that cures a check, its judgement, and the utilisation at the worst of all corners."""

    step: Step
    judgement: Judgement
    used: float


@dataclass(eq=False)
class _RemedySearch:
    """Search of the remedies of one case.

    base: judgement of the case; judgements by corners and change; closest: step of each check that
    leaves least; previous: last step of each lever that scales; hopeless: levers not pulled further
    for a check.
    """

    bench: Workbench
    judge: Judge
    base: Judgement
    failures: Mapping[str, Failure]
    judgements: dict[tuple[tuple[str, ...], Change], Judgement | None] = field(default_factory=dict)
    closest: dict[str, _Seen] = field(default_factory=dict)
    previous: dict[tuple[Lever, str], _Seen] = field(default_factory=dict)
    hopeless: set[tuple[Lever, str]] = field(default_factory=set)

    def remedies(self) -> dict[str, Remedy]:
        """Remedy of every failed check by id: levers with ever greater changes until
        one cures it.
        """
        quick = self._used(Change(), self.failures)
        self.scale = {
            name: _ratio(failure.used, quick[name]) for name, failure in self.failures.items()
        }
        self.deeper = {
            name: max(1.0, _ratio(failure.used, used(self.base.checks.get(name))))
            for name, failure in self.failures.items()
        }
        made: dict[str, Remedy] = {}
        below = 0.0
        for level in LEVELS:
            names = [name for name in self.failures if name not in made]
            for name, ways in self._crossings(names, below, level).items():
                remedy = self._verified(
                    name, sorted(ways, key=lambda way: way.size)[:_LEVERS_VERIFIED]
                )
                if remedy is not None:
                    made[name] = remedy
            below = level
        return {name: made[name] if name in made else self._none(name) for name in self.failures}

    def _crossings(
        self, names: Iterable[str], below: float, level: float
    ) -> dict[str, list[_Crossing]]:
        """Levers that turn a check to pass by a change of a size between two bounds, by id of the
        check; by closed forms.

        The step nearest to passing is stored in `closest`, the last one of a lever in `previous`.

        Parameters
        ----------
        names : iterable   ids of the failed checks without a remedy so far
        below : float      size of the changes tried before
        level : float      greatest size of a change, |ln| of the ratio of values
        """
        crossings: dict[str, list[_Crossing]] = {}
        for lever, every in self._levers(names):
            checks = [name for name in every if (lever, name) not in self.hopeless]
            if not checks:
                continue
            for step in self._steps(lever, below, level):
                for name, value in self._scaled(step, checks).items():
                    first, seen = self.failures[name].used, _Seen(step, value)
                    if value <= 1.0:
                        above = self.previous.get((lever, name))
                        way = _Crossing(_crossing(above, seen, first), lever, above, seen)
                        crossings.setdefault(name, []).append(way)
                    elif name not in self.closest or value < self.closest[name].used:
                        self.closest[name] = seen
                    if isinstance(lever, Scaled):
                        self.previous[lever, name] = seen
                        if _hopeless(lever, seen, first):
                            self.hopeless.add((lever, name))
        return crossings

    def _levers(self, names: Iterable[str]) -> list[tuple[Lever, list[str]]]:
        """Levers that can be applied to the case, each with the ids of the checks in `names` that
        it can cure.
        """
        table: dict[Lever, list[str]] = {}
        for name in names:
            for lever in DECLARED[name].levers:
                table.setdefault(lever, []).append(name)
        return [(lever, checks) for lever, checks in table.items() if self.bench.acts(lever)]

    def _steps(self, lever: Lever, below: float, level: float) -> Iterator[Step]:
        """Steps of a lever with a size above `below` and up to `level`, |ln| of the ratio of
        values: one of a scaled value, or the cards of that range; a hole or a crown with the first
        range.
        """
        if isinstance(lever, Scaled):
            most = math.log(lever.most)
            if below < most and (level in _COARSE_LEVELS or not self._is_coarse(lever)):
                yield self.bench.scaled(lever, min(level, most))
        elif isinstance(lever, Drilled):
            if below == 0.0:
                yield self.bench.drilled(lever)
        elif isinstance(lever, Crowned):
            if below == 0.0:
                yield from self.bench.crowns(lever)
        else:
            low, top = _SIZES_THAT_TIE * below, _SIZES_THAT_TIE * level
            steps = [
                step
                for step in self.bench.cards(lever)
                if (low < step.size or low == step.size == 0.0) and step.size <= top
            ]
            if not self._is_coarse(lever):
                yield from steps
            elif level <= _COARSE_LEVELS[-1]:
                yield from steps[:1]

    def _is_coarse(self, lever: Scaled | Catalogued) -> bool:
        """Whether each step of a lever is a new table of the pressure along the line.

        Of its steps fewer are tried.
        """
        case = self.bench.case
        crowned = case.cam.crown is not None or case.facing.crown is not None
        return crowned and lever in LENGTHS

    def _scaled(self, step: Step, names: Collection[str]) -> dict[str, float]:
        """Utilisations with a step, times the ratio of the failures to those of the case."""
        used = self._used(step.change, names)
        return {name: self.scale[name] * value for name, value in used.items()}

    def _used(self, change: Change, names: Collection[str]) -> dict[str, float]:
        """Utilisations with a change by the coarse closed forms; infinite without a solution."""
        try:
            return self.judge.used(change, names)
        except CamError:
            return dict.fromkeys(names, math.inf)

    def _verified(self, name: str, ways: Sequence[_Crossing]) -> Remedy | None:
        """Remedy of a check by the first of some levers that a preview confirms; None where it
        confirms none.

        Of changes of about the same size the one that makes the fewest other checks fail.

        Parameters
        ----------
        name : str        id of the check
        ways : sequence   levers that cure it by closed forms, the smallest change first
        """
        best: tuple[int, float, Remedy] | None = None
        for way in ways:
            if best is not None and (best[0] == 0 or way.size > _SIZES_THAT_TIE * best[1]):
                break
            try:
                confirmed = self._confirmed(name, way)
                if confirmed is None:
                    continue
                fails = len(newly_failing(self.base, confirmed.judgement))
            except CamError:  # the guides at a bound of their friction
                continue
            if best is None or fails < best[0]:
                best = fails, confirmed.step.size, self._remedy(name, way.lever, confirmed)
        return None if best is None else best[2]

    def _confirmed(self, name: str, way: _Crossing) -> _Confirmed | None:
        """Smallest step of a lever with which a check passes in the preview at every tolerance
        corner; None without one.

        Of a scaled value by interpolation between a failing and a passing step.

        Parameters
        ----------
        name : str        id of the check
        way : _Crossing   lever with both steps
        """
        if not isinstance(way.lever, Scaled):
            judgement = self._judgement(name, way.below.step)
            return (
                None
                if judgement is None
                else self._at_every_corner(name, way.below.step, judgement)
            )
        above, below = way.above, way.below
        best: tuple[Step, Judgement] | None = None
        is_coarse = self._is_coarse(way.lever)
        size = way.size if is_coarse else self._refined(name, way, way.lever)
        for _ in range(_COARSE_PREVIEWS if is_coarse else _PREVIEWS):
            step = self.bench.scaled(way.lever, size)
            judgement = self._judgement(name, step)
            value = math.inf if judgement is None else self._use(name, judgement)
            if judgement is not None and _ENOUGH <= value <= 1.0:
                value = self._use(name, judgement, everywhere=True)
                if value <= 1.0:
                    return _Confirmed(step, judgement, value)
            # the search expects 1 here, and errs by about the same ratio nearby
            ratio = _ratio(value, 1.0)
            if value <= 1.0 and judgement is not None:
                best = step, judgement
                below, above = _Seen(step, value, True), above and above.times(ratio)
            else:
                above, below = _Seen(step, value, True), below.times(ratio)
            size = _crossing(above, below, self.failures[name].used)
            size = min(_FURTHER * size, math.log(way.lever.most))
        # a larger change than necessary, judged at the worst corners alone so far
        return None if best is None else self._at_every_corner(name, *best)

    def _at_every_corner(self, name: str, step: Step, judgement: Judgement) -> _Confirmed | None:
        """A step that passes at every tolerance corner; None if it fails at one."""
        value = self._use(name, judgement, everywhere=True)
        return _Confirmed(step, judgement, value) if value <= 1.0 else None

    def _refined(self, name: str, way: _Crossing, lever: Scaled) -> float:
        """Size of the change at which a check meets its limit, by one more evaluation of the closed
        forms, at the size expected, and interpolation.

        Parameters
        ----------
        name : str        id of the check
        way : _Crossing   failing and passing step, and the size expected
        lever : Scaled    of the change
        """
        if way.size >= way.below.step.size:
            return way.size
        step = self.bench.scaled(lever, way.size)
        seen = _Seen(step, self._scaled(step, [name])[name])
        above, below = (way.above, seen) if seen.used <= 1.0 else (seen, way.below)
        return _crossing(above, below, self.failures[name].used)

    def _judgement(self, name: str, step: Step) -> Judgement | None:
        """Preview of the case with a step, at the tolerance corners of a check, computed once; None
        where the changed case has no solution.

        Parameters
        ----------
        name : str    id of the check
        step : Step   change of the case
        """
        key = self.failures[name].corners, step.change
        if key not in self.judgements:
            try:
                depth = _depth(self.judge.corners, [name])
                self.judgements[key] = self.judge.judged(step.change, depth)
            except CamError:
                self.judgements[key] = None
        return self.judgements[key]

    def _use(self, name: str, judgement: Judgement, *, everywhere: bool = False) -> float:
        """Utilisation of a check as judged, times the ratio of finite elements to closed forms.

        Infinite where it does not pass for another reason. Another corner than the worst ones of
        the case may govern after a change: `everywhere` judges at all of them.
        """
        one = judgement.check(name, everywhere=everywhere)
        value = used(one) * self.deeper[name]
        return math.inf if value <= 1.0 and (one is None or one.status != "pass") else value

    def _remedy(self, name: str, lever: Lever, confirmed: _Confirmed) -> Remedy:
        """Remedy of a check by a confirmed step, with its side effects and, for a card, the rating
        that would be enough.

        Parameters
        ----------
        name : str               id of the check
        lever : Lever            of the step
        confirmed : _Confirmed   step with its judgement
        """
        step, judgement, value = confirmed
        words = effects(name, self.base, judgement)
        if isinstance(lever, Catalogued) and lever.inverse:
            ((_, card),) = step.change.values
            rating = self.bench.rating(lever, str(card))
            words = (self._least_rating(lever, value * rating), *words)
        return Remedy(name, step.change, step.figure, words)

    def _least_rating(self, lever: Catalogued, value: float) -> str:
        words = f"least {lever.rating.replace('_', ' ')}"
        return f"{words} {without_exponent(value, self.bench.unit(lever))}"

    def _none(self, name: str) -> Remedy:
        """Remedy that states that no single change cures a check, with the change that comes
        closest.
        """
        before = self.base.checks.get(name)
        if before is not None and before.without:
            return Remedy(name, Change(), effects=needed_first(before.without), cures=False)
        seen = self.closest.get(name)
        needed = self._needed(name)
        if seen is None or not math.isfinite(seen.used):
            return Remedy(name, Change(), effects=needed, cures=False)
        left = f"still {units.used(seen.used)} used"
        return Remedy(name, seen.step.change, seen.step.figure, (*needed, left), cures=False)

    def _needed(self, name: str) -> tuple[str, ...]:
        """Rating that a check needs at the loads of the case, in words; empty where no rating
        limits it.
        """
        value = self.failures[name].used
        for lever in DECLARED[name].levers:
            if isinstance(lever, Catalogued) and lever.inverse and self.bench.acts(lever):
                here = self.bench.rating_here(lever)
                if here is not None and math.isfinite(value):
                    return (self._least_rating(lever, value * here),)
        return ()


def needed_first(without: str) -> tuple[str, ...]:
    """Precondition of any remedy of a check, from its load cases without valid loads.

    Parameters
    ----------
    without : str   as that of `Check`
    """
    return tuple(words for why, words in _FIRST.items() if f"{why} at " in without)


def _ratio(wanted: float, known: float) -> float:
    """Ratio of two utilisations; 1 where one is not a positive number."""
    if 0.0 < known < math.inf and 0.0 < wanted < math.inf:
        return wanted / known
    return 1.0


def _hopeless(lever: Scaled, seen: _Seen, first: float) -> bool:
    """Whether a lever would leave a check far above its limit up to its greatest change,
    extrapolated by the slope of the logarithm of the utilisation.

    Parameters
    ----------
    lever : Scaled   with its greatest change
    seen : _Seen     last step, with the utilisation
    first : float    utilisation without a change
    """
    size = seen.step.size
    if size < _FROM or not (0.0 < first < math.inf and 0.0 < seen.used < math.inf):
        return False
    slope = math.log(seen.used / first) / size
    return math.log(first) + slope * math.log(lever.most) > math.log(_HOPELESS_USE)


def _crossing(above: _Seen | None, below: _Seen, first: float) -> float:
    """Size of the change at which the utilisation of a check is 1: linear in the logarithm of the
    utilisation between two steps; their middle where that of the smaller step is infinite.

    Parameters
    ----------
    above : _Seen   failing step; None: the case without a change
    below : _Seen   passing step
    first : float   utilisation without a change
    """
    start, high = (0.0, first) if above is None else (above.step.size, above.used)
    end, low = below.step.size, max(below.used, _LEAST_USED)
    if not math.isfinite(high):
        return 0.5 * (start + end)
    if not low < high:
        return end
    return start + (end - start) * math.log(high) / math.log(high / low)

"""Relaxation of one design option to the least change with which a design passes.

A change is measured by the logarithm of its value over that of the task.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from math import copysign, exp, inf, log
from pathlib import Path

from camwright.geometry.arrays import FULL_TURN
from camwright.pipeline.base import units
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.records.design_document import DesignOptions, RelaxationRecord
from camwright.pipeline.search.machine.candidate_search import Candidate
from camwright.pipeline.search.machine.synthesised_points import (
    RESERVE,
    PointStudy,
    Solved,
    violation,
)
from camwright.pipeline.search.machine.torque_task import DesignTask

SPACE = "--space"
WIDTH = 0.02  # greatest difference of the changes that pass and fail
_LEAST_REMOVED = 0.25  # of the ripple
_SLOWEST = 0.4  # of the speeds
_SHORTEST = 0.05  # of the life
_FREE_SPACE = 5.0  # of the space
_COOL = 20.0  # degC of the surroundings
_SIZE_SPARE = 1.005  # of the size of a design
_EQUAL_CHANGES = 1e-9  # difference of equal changes
_FIRST_CHANGE = 0.6  # change that is tried first, a factor of 1.8
_STRIDE = 0.9 * WIDTH  # from the change that a design needs
_MORE = 0.1 * WIDTH  # above it, for the first trial
_USUAL = 10  # values tried


@dataclass(frozen=True)
class Lever:
    """Design option with its range from the task's value to the loosest one.

    options: options of the command at a value; shown: a value in words; reached: value that a
    draft keeps, None where it does not tell; order: in which designs are drafted; whole: whether
    the loosest value is the next one.
    """

    name: str
    stated: float
    loosest: float
    options: Callable[[float], DesignOptions]
    shown: Callable[[float], str]
    reached: Callable[[Solved], float] | None = None
    order: Callable[[Candidate], float] = violation
    whole: bool = False

    @property
    def greatest(self) -> float:
        """Change to the loosest value."""
        return abs(self._end)

    @property
    def _end(self) -> float:
        return log(self.loosest / self.stated)

    def value(self, change: float) -> float:
        """Value after a change."""
        return self.stated * exp(copysign(change, self._end))

    def needed(self, draft: Solved) -> float:
        """Change with which a design would pass, by its draft; infinite: not known."""
        value = 0.0 if self.reached is None else self.reached(draft)
        return copysign(1.0, self._end) * log(value / self.stated) if value > 0.0 else inf


@dataclass(frozen=True)
class Bracket:
    """Two changes of an option: at `passing` a design passes, at `failing` none does.

    needed: change that the design needs; stride: below it, of the change to be tried next.
    """

    lever: Lever
    failing: float
    passing: float
    needed: float
    stride: float = _STRIDE

    @property
    def narrow(self) -> bool:
        """Whether the bracket is as narrow as `WIDTH`."""
        return self.passing - self.failing <= WIDTH

    @property
    def halved(self) -> bool:
        """Whether half of the change fails, as far as `WIDTH` tells them apart."""
        return self.passing <= max(WIDTH, 2.0 * self.failing + _EQUAL_CHANGES) or self.lever.whole

    def inner(self) -> float:
        """Change of the option to be tried next, between the failing and the passing one, in
        logarithms: just below, at or just above the one that the design needs, else the middle.
        """
        for change in (self.needed - self.stride, self.needed, self.needed + _STRIDE):
            if self.failing + _EQUAL_CHANGES < change < self.passing - _EQUAL_CHANGES:
                return change
        return 0.5 * (self.failing + self.passing)


@dataclass
class _Search:
    """Trials of changes.

    room: space in which a design is known to pass; failing: greatest change known to fail, by
    option.
    """

    study: PointStudy
    workers: Crew
    progress: Progress
    room: float = inf
    failing: dict[str, float] = field(default_factory=dict)
    tried: int = 0

    def fails(self, lever: Lever, change: float) -> bool:
        """Whether no design is known to pass with a change, or with any up to the greatest."""
        return self.failing.get(lever.name, 0.0) > min(change, lever.greatest) - _EQUAL_CHANGES

    def bracket(self, lever: Lever, change: float) -> Bracket | None:
        """Search a design with an option changed; bracket of the change between a failing and this
        passing one, or None where no design passes.

        Parameters
        ----------
        lever : Lever    the option
        change : float   logarithm of its value over that of the task; at most the greatest is taken
        """
        self.progress.advance(self.tried, max(_USUAL, self.tried + 1))
        self.tried += 1
        change = min(change, lever.greatest)
        if lever.name == SPACE and lever.value(change) >= self.room:
            needed = log(self.room / lever.stated)
            return Bracket(lever, self.failing.get(lever.name, 0.0), change, needed)
        options = lever.options(lever.value(change))
        draft = self.study.passing(options, self.workers, lever.order)
        if draft is None:
            self.failing[lever.name] = change
            return None
        failing = self.failing.get(lever.name, 0.0)
        return Bracket(lever, failing, change, lever.needed(draft))

    def narrowed(self, bracket: Bracket) -> Bracket:
        """The bracket narrowed by trials until it is as narrow as `WIDTH`."""
        while not bracket.narrow:
            change = bracket.inner()
            inner = self.bracket(bracket.lever, change)
            if inner is None:
                bracket = replace(bracket, failing=change)
            else:
                bracket = replace(inner, stride=2.0 * bracket.stride)
        return bracket

    def smallest(self, lever: Lever, failing: float) -> Bracket | None:
        """Bracket of a change of an option that passes, half of which fails, by doubling; None
        where not even the greatest change passes.

        Parameters
        ----------
        lever : Lever     the option
        failing : float   change that is known to fail, logarithm of a ratio
        """
        change = lever.greatest if lever.whole else 2.0 * max(failing, WIDTH)
        while not self.fails(lever, change):
            bracket = self.bracket(lever, change)
            if bracket is not None:
                return self.halved(bracket)
            change *= 2.0
        return None

    def halved(self, bracket: Bracket) -> Bracket:
        """The bracket, its passing change halved by trials until half of it fails."""
        while not bracket.halved:
            change = 0.5 * bracket.passing
            inner = self.bracket(bracket.lever, change)
            bracket = replace(bracket, failing=change) if inner is None else inner
        return bracket


def relaxations(
    study: PointStudy,
    nearest: Solved | None,
    out: Path,
    workers: Crew,
    progress: Progress,
    room: float = inf,
) -> list[RelaxationRecord]:
    """Relaxations of single options of the command with which a design passes, with their command
    lines, the smallest first.

    With each the command passes, and does not at `fails_at`, half of the change or more. The first
    is narrowed until its passing and failing change differ by `WIDTH` at most; no other option
    passes with a change by the failing ratio. Every option is looser than that of the task.

    Parameters
    ----------
    study : PointStudy    with whose task no design passes
    nearest : Solved      the design that fails by the least; None: not known
    out : Path            case file of the command
    workers : Crew        processes that solve
    progress : Progress   told the trials
    room : float          space, m, in which a design passes by exchanges of parts; infinite: not
                          known
    """
    every = tuple(_levers(study.task))
    levers = tuple(each for each in every if not each.whole)
    search = _Search(study, workers, progress, room)
    best, larger = _first(search, levers, nearest), list[Bracket]()
    while best is not None:
        best = search.narrowed(best)
        rival = _rival(search, levers, best)
        if rival is None:
            break
        best, larger = rival, [best, *larger]
    if best is None:
        return []
    known = {each.lever.name: each for each in reversed(larger)}
    others = [
        search.smallest(lever, best.failing)
        if lever.name not in known
        else search.halved(known[lever.name])
        for lever in every
        if lever is not best.lever
    ]
    rest = sorted((each for each in others if each is not None), key=lambda each: each.passing)
    return [_record(study.task, each, out) for each in (best, *rest)]


def _first(search: _Search, levers: tuple[Lever, ...], nearest: Solved | None) -> Bracket | None:
    """Bracket of the first change with which a design passes, of those tried in this order: what
    the nearest failing design needs, `_FIRST_CHANGE` of each option, the greatest of each; None
    where none passes.

    Parameters
    ----------
    search : _Search   which tries changes
    levers : tuple     options that may be changed
    nearest : Solved   design that fails by the least; None: not known
    """
    trials = [(lever, change) for change in (_FIRST_CHANGE, inf) for lever in levers]
    if nearest is not None and nearest.has_cam:
        needed = [(lever, lever.needed(nearest) + _MORE) for lever in levers]
        near = [(lever, change) for lever, change in needed if 0.0 < change < lever.greatest]
        trials = sorted(near, key=lambda each: each[1]) + trials
    for lever, change in trials:
        if not search.fails(lever, change):
            bracket = search.bracket(lever, change)
            if bracket is not None:
                return bracket
    return None


def _rival(search: _Search, levers: tuple[Lever, ...], best: Bracket) -> Bracket | None:
    """Bracket of another option that passes with the change at which the best option fails; None
    where no other option does.
    """
    for lever in levers:
        if lever is not best.lever and not search.fails(lever, best.failing):
            bracket = search.bracket(lever, best.failing)
            if bracket is not None:
                return bracket
    return None


def _levers(task: DesignTask) -> Iterator[Lever]:
    """Options of the command that can be relaxed, each with its range: ripple to be removed, space,
    speed, over-speed, life, ambient temperature, and ratio by one more lobe of the cam.
    """
    yield Lever(
        "--remove", task.remove, _LEAST_REMOVED * task.remove,
        lambda value: {"remove": _percent(value)}, _percent, _removed,
    )  # fmt: skip
    if task.space is not None:
        yield Lever(
            SPACE, task.space, _FREE_SPACE * task.space,
            lambda value: {"space": _text(value, "mm")}, lambda value: _text(value, "mm"),
            lambda draft: _SIZE_SPARE * draft.size, lambda candidate: candidate.size,
        )  # fmt: skip
    yield Lever(
        "--speed", task.speed, _SLOWEST * task.speed,
        lambda value: _slower(task, value / task.speed), lambda value: _text(value, "rpm"),
    )  # fmt: skip
    if task.overspeed > (1.0 + WIDTH) * task.speeds[1]:
        yield Lever(
            "--overspeed", task.overspeed, task.speeds[1],
            lambda value: {"overspeed": _text(value, "rpm")}, lambda value: _text(value, "rpm"),
        )  # fmt: skip
    yield Lever(
        "--life", task.life, _SHORTEST * task.life,
        lambda value: {"life": _text(value, "h")}, lambda value: _text(value, "h"),
    )  # fmt: skip
    warm = units.celsius(task.ambient)
    if warm > (1.0 + WIDTH) * _COOL:
        yield Lever("--ambient", warm, _COOL, lambda value: {"ambient": _celsius(value)}, _celsius)
    lobes = round(FULL_TURN * task.ratio / task.demand.cycle)
    slower = task.ratio * (lobes + 1) / lobes
    yield Lever(
        "--ratio", task.ratio, slower,
        lambda value: {"ratio": f"{value:.12g}"}, lambda value: f"{value:.4g}", whole=True,
    )  # fmt: skip


def _slower(task: DesignTask, share: float) -> DesignOptions:
    """Options of the command with all speeds that the task states multiplied by `share`."""
    options: DesignOptions = {"speed": _text(share * task.speed, "rpm")}
    if "speeds" in task.options:
        least, most = (_text(share * each, "rpm") for each in task.speeds)
        options["speeds"] = (least, most)
    if "overspeed" in task.options:
        options["overspeed"] = _text(share * task.overspeed, "rpm")
    return options


def _removed(draft: Solved) -> float:
    """Share of the ripple that a design removes, less the reserve."""
    return 1.0 - draft.ripple / ((1.0 - RESERVE) * draft.design.task.demand.ripple)


def _text(value: float, unit: str) -> str:
    return units.shown(value, unit)


def _celsius(value: float) -> str:
    return f"{value:.3g} degC"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g}%"


def _record(task: DesignTask, bracket: Bracket, out: Path) -> RelaxationRecord:
    """Record of a relaxation."""
    lever, value = bracket.lever, bracket.lever.value(bracket.passing)
    options = lever.options(value)
    return {
        "option": lever.name,
        "from": lever.shown(lever.stated),
        "to": lever.shown(value),
        "fails_at": lever.shown(lever.value(bracket.failing)),
        "options": options,
        "command": task.relaxed(options).command(out),
    }

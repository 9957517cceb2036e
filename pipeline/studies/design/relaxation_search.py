"""Smallest change of one option of a design with which a case passes, by bisection."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import copysign, exp, log, sqrt
from pathlib import Path

from camwright.pipeline.base import units
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.studies.design.candidate_search import Candidate, candidates
from camwright.pipeline.studies.design.synthesised_points import (
    RESERVE,
    Solved,
    Study,
    grown,
    likeliest,
    settled,
    solved_front,
)
from camwright.pipeline.studies.design.torque_task import DesignTask, Options
from camwright.pipeline.studies.redesign.point_store import Record

WIDTH = 0.02  # relative width of the bisection
_ROLLERS = 3  # of the nearest designs, to which the search is limited
_LEAST_REMOVED = 0.1  # of the ripple
_SLOWEST = 0.4  # of the speeds
_SHORTEST = 0.05  # of the life
_FREE_SPACE = 5.0  # of the space
_SPARE = 1.005  # of the size of a design
_TRIES = 3  # steps of WIDTH by which a rounded design is loosened


@dataclass(frozen=True)
class Lever:
    """An option that is relaxed from the value of the task to a loosest one.

    options: options of the command at a value; reached: the value that a design solved at a value
    keeps; shown: a value in words.
    """

    name: str
    stated: float
    loosest: float
    options: Callable[[float], Options]
    shown: Callable[[float], str]
    reached: Callable[[Solved, float], float] = lambda _point, value: value


def relaxations(
    study: Study, screened: Sequence[Candidate], out: Path, workers: Crew, progress: Progress
) -> list[Record]:
    """Relaxations of one option each, with the command line of each; the smallest first.

    Each passes at all tolerance ends and is the smallest within `WIDTH` for one of the nearest
    rollers, with an offset where it does not pass otherwise. The first is reduced until the command
    passes no design at a change that is smaller by `WIDTH`, which its record names.

    Parameters
    ----------
    screened : sequence   designs of the task
    out : Path            case file of the command
    """
    names, rollers = [each.name for each in _levers(study.task)], _rollers(study.task, screened)
    waiting = [workers.submit(_relaxation, study, name, rollers) for name in names]
    changes: list[Relaxation] = []
    for k, each in enumerate(waiting, start=1):
        change = each.result()
        changes += [] if change is None else [change]
        progress.advance(k, len(names))
    changes.sort(key=lambda each: each.size)
    if changes:
        changes[0] = _proven(study, changes[0], workers)
    return [_record(study.task, each, out) for each in changes]


@dataclass(frozen=True)
class Relaxation:
    """A value of an option with which a design passes.

    offset: whether by designs with an offset; failing: value nearer to that of the task with which
    none passes; None: not known.
    """

    name: str
    stated: float
    value: float
    offset: bool
    failing: float | None = None

    @property
    def size(self) -> float:
        """Logarithm of the value over that of the task."""
        return abs(log(self.value / self.stated))


def _relaxation(study: Study, name: str, rollers: frozenset[str]) -> Relaxation | None:
    """Smallest change of an option by the likeliest of some rollers; None: none passes."""
    lever = _lever(study.task, name)
    for offset in (False, True):
        way = Way(rollers, offset)
        point = _passing(study, lever, lever.loosest, way)
        if point is not None:
            way = Way(frozenset({point.design.frame.roller}), offset)
            value = _smallest(study, lever, way, point)
            return None if value is None else Relaxation(name, lever.stated, value, offset)
    return None


def _lever(task: DesignTask, name: str) -> Lever:
    return next(each for each in _levers(task) if each.name == name)


def _proven(study: Study, change: Relaxation, workers: Crew) -> Relaxation:
    """A relaxation reduced until all designs of the command fail at one smaller by `WIDTH`."""
    lever = _lever(study.task, change.name)
    for _ in range(_TRIES):
        less = change.value * exp(-copysign(WIDTH, lever.loosest - lever.stated))
        if change.size <= WIDTH:
            return replace(change, failing=lever.stated)
        own = _relaxed(study, lever, less)
        screened = candidates(own.task, study.folder, study.file, SILENT)
        passing, _ = solved_front(own, screened, workers, SILENT)
        if not passing:
            return replace(change, failing=less)
        values = [lever.reached(each, less) for each in passing]
        change = replace(change, value=_nearer(lever, less, *values))
    return change


def _levers(task: DesignTask) -> Iterator[Lever]:
    """Options of the command that can be relaxed."""
    yield Lever(
        "--remove", task.remove, _LEAST_REMOVED * task.remove,
        lambda value: {"remove": _percent(value)}, _percent, _removed,
    )  # fmt: skip
    if task.space is not None:
        yield Lever(
            "--space", task.space, _FREE_SPACE * task.space,
            lambda value: {"space": _text(value, "mm")}, lambda value: _text(value, "mm"),
            lambda point, _value: _SPARE * point.size,
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


def _slower(task: DesignTask, share: float) -> Options:
    """Options of all speeds given, reduced alike."""
    options: Options = {"speed": _text(share * task.speed, "rpm")}
    if "speeds" in task.options:
        least, most = (_text(share * each, "rpm") for each in task.speeds)
        options["speeds"] = (least, most)
    if "overspeed" in task.options:
        options["overspeed"] = _text(share * task.overspeed, "rpm")
    return options


def _removed(point: Solved, _value: float) -> float:
    """Share of the ripple that a design removes, less the reserve."""
    return 1.0 - point.ripple / ((1.0 - RESERVE) * point.design.task.demand.ripple)


def _text(value: float, unit: str) -> str:
    return units.shown(value, unit)


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g}%"


def _rollers(task: DesignTask, screened: Sequence[Candidate]) -> frozenset[str]:
    """Rollers of the nearest designs."""
    order = sorted(screened, key=lambda each: each.ripple / task.ripple_allowed + each.excess)
    names = dict.fromkeys(each.design.frame.roller for each in order)
    return frozenset(list(names)[:_ROLLERS])


@dataclass(frozen=True)
class Way:
    """Rollers of the designs that are tried, and whether with an offset."""

    rollers: frozenset[str]
    offset: bool = False


def _smallest(study: Study, lever: Lever, way: Way, loosest: Solved) -> float | None:
    """The value nearest to that of the task at which a design passes; None: none does.

    Parameters
    ----------
    loosest : Solved   the design that passes at the loosest value
    """
    low, best = lever.stated, lever.reached(loosest, lever.loosest)
    known = {lever.loosest: loosest}
    while abs(log(best / low)) > WIDTH:
        middle = sqrt(low * best)
        point = _passing(study, lever, middle, way)
        if point is None:
            low = middle
        else:
            known[middle] = point
            best = _nearer(lever, middle, lever.reached(point, middle))
    step = exp(copysign(WIDTH, lever.loosest - lever.stated))
    for _ in range(_TRIES):
        point = known.get(best) or _passing(study, lever, best, way)
        if point is not None and settled(_relaxed(study, lever, best), point).passes:
            return best
        best *= step
    return None


def _nearer(lever: Lever, *values: float) -> float:
    """Of some values that which is nearest to the value of the task."""
    return min(values, key=lambda value: abs(value - lever.stated))


def _relaxed(study: Study, lever: Lever, value: float) -> Study:
    return replace(study, task=study.task.relaxed(lever.options(value)))


def _passing(study: Study, lever: Lever, value: float, way: Way) -> Solved | None:
    """The likeliest design at a value of an option, solved; None where it does not pass."""
    own = _relaxed(study, lever, value)
    screened = candidates(own.task, study.folder, study.file, SILENT, way.rollers)
    candidate = likeliest(own.task, screened)
    if candidate is None:
        return None
    point = grown(own, candidate.with_offset if way.offset else candidate)
    return point if point.has_cam and point.passes else None


def _record(task: DesignTask, change: Relaxation, out: Path) -> Record:
    lever = _lever(task, change.name)
    options = lever.options(change.value)
    return {
        "option": change.name,
        "from": lever.shown(change.stated),
        "to": lever.shown(change.value),
        "fails_at": None if change.failing is None else lever.shown(change.failing),
        "options": options,
        "command": task.relaxed(options).command(out),
    }

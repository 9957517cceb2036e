"""Smallest change of one option of a design with which a case passes, by bisection."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import copysign, exp, log, sqrt
from pathlib import Path

from camwright.pipeline.base import units
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.studies.design.candidate_search import Candidate, candidates
from camwright.pipeline.studies.design.synthesised_points import (
    RESERVE,
    Solved,
    Study,
    grown,
    likeliest,
    settled,
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
    study: Study, screened: Sequence[Candidate], out: Path, progress: Progress
) -> list[Record]:
    """Relaxations of one option each, with the command line of each; the smallest first.

    Each is the smallest one within `WIDTH` of those by the designs solved, and its design passes by
    closed forms.

    Parameters
    ----------
    screened : sequence   designs of the task
    out : Path            case file of the command
    """
    levers = list(_levers(study.task))
    records: list[tuple[float, Record]] = []
    for k, lever in enumerate(levers, start=1):
        value = _smallest(study, lever, _rollers(study.task, screened))
        if value is not None:
            records.append((abs(log(value / lever.stated)), _record(study.task, lever, value, out)))
        progress.advance(k, len(levers))
    return [record for _, record in sorted(records, key=lambda each: each[0])]


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


def _smallest(study: Study, lever: Lever, rollers: frozenset[str]) -> float | None:
    """The value nearest to that of the task at which a design passes; None: none does."""
    point = _passing(study, lever, lever.loosest, rollers)
    if point is None:
        return None
    low, best = lever.stated, lever.reached(point, lever.loosest)
    while abs(log(best / low)) > WIDTH:
        middle = sqrt(low * best)
        point = _passing(study, lever, middle, rollers)
        if point is None:
            low = middle
        else:
            best = _nearer(lever, middle, lever.reached(point, middle))
    step = exp(copysign(WIDTH, lever.loosest - lever.stated))
    for _ in range(_TRIES):
        point = _passing(study, lever, best, rollers)
        if point is not None and settled(_relaxed(study, lever, best), point).passes:
            return best
        best *= step
    return None


def _nearer(lever: Lever, *values: float) -> float:
    """Of some values that which is nearest to the value of the task."""
    return min(values, key=lambda value: abs(value - lever.stated))


def _relaxed(study: Study, lever: Lever, value: float) -> Study:
    return replace(study, task=study.task.relaxed(lever.options(value)))


def _passing(study: Study, lever: Lever, value: float, rollers: frozenset[str]) -> Solved | None:
    """The likeliest design at a value of an option, solved; None where it does not pass."""
    own = _relaxed(study, lever, value)
    screened = candidates(own.task, study.folder, study.file, SILENT, rollers)
    candidate = likeliest(own.task, screened)
    if candidate is None:
        return None
    point = grown(own, candidate)
    return point if point.has_cam and point.passes else None


def _record(task: DesignTask, lever: Lever, value: float, out: Path) -> Record:
    options = lever.options(value)
    return {
        "option": lever.name,
        "from": lever.shown(lever.stated),
        "to": lever.shown(value),
        "options": options,
        "command": task.relaxed(options).command(out),
    }

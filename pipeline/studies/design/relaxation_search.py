"""Smallest change of one option of a design with which a case passes, by bisection."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import copysign, exp, log, sqrt
from pathlib import Path

from camwright.pipeline.base import units
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.studies.design.candidate_search import candidates
from camwright.pipeline.studies.design.synthesised_points import (
    RESERVE,
    Solved,
    Study,
    drafts,
    passing_design,
)
from camwright.pipeline.studies.design.torque_task import DesignTask, Options
from camwright.pipeline.studies.redesign.point_store import Record

WIDTH = 0.02  # relative width of the bisection
_LEAST_REMOVED = 0.25  # of the ripple
_SLOWEST = 0.4  # of the speeds
_SHORTEST = 0.05  # of the life
_FREE_SPACE = 5.0  # of the space
_SPARE = 1.005  # of the size of a design
_EQUAL = 1e-9  # difference of equal sizes
_INNER = 0.1  # least share of a bracket between its ends and the next value


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

    def changed(self, size: float) -> float:
        """The value a logarithm away from that of the task, at most the loosest."""
        end = log(self.loosest / self.stated)
        return self.stated * exp(copysign(min(size, abs(end)), end))


@dataclass(frozen=True)
class Bracket:
    """Two values of an option: no design passes with `failing`, one does with `passing`.

    reached: value that the design at `passing` keeps, at most as far from that of the task.
    """

    lever: Lever
    failing: float
    passing: float
    reached: float

    @property
    def size(self) -> float:
        """Logarithm of the passing value over that of the task."""
        return abs(log(self.passing / self.lever.stated))

    @property
    def least(self) -> float:
        """Logarithm of the failing value over that of the task."""
        return abs(log(self.failing / self.lever.stated))

    @property
    def narrow(self) -> bool:
        """Whether the bracket is as narrow as `WIDTH`."""
        return self.size - self.least <= WIDTH

    def middle(self) -> float:
        """The value to be tried next: that reached, if it is inside, else the geometric mean."""
        share = log(self.reached / self.failing) / log(self.passing / self.failing)
        if _INNER < share < 1.0 - _INNER:
            return self.reached
        return sqrt(self.failing * self.passing)


def relaxations(study: Study, out: Path, workers: Crew, progress: Progress) -> list[Record]:
    """Relaxations of one option each, with the command line of each; the smallest first.

    With each the command passes. With the first it does not at `fails_at`, which is nearer to the
    value of the task by `WIDTH` at most, nor with another option changed by that ratio.

    Parameters
    ----------
    study : Study   with whose task no design passes
    out : Path      case file of the command
    """
    levers = tuple(_levers(study.task))
    tried: list[Bracket | None] = []
    for k, lever in enumerate(levers):
        progress.advance(k, len(levers) + 1)
        tried.append(_loosest(study, lever, workers))
    progress.advance(len(levers), len(levers) + 1)
    brackets = _ranked(study, [each for each in tried if each is not None], workers)
    progress.advance(len(levers) + 1, len(levers) + 1)
    return [_record(study.task, each, out, first=k == 0) for k, each in enumerate(brackets)]


def _ranked(study: Study, brackets: list[Bracket], workers: Crew) -> list[Bracket]:
    """The brackets by size; the first narrow, and no other known to allow a smaller change."""
    brackets = sorted(brackets, key=lambda each: abs(log(each.reached / each.lever.stated)))
    while brackets:
        first, *others = brackets
        rival = next((each for each in others if each.least < first.least - _EQUAL), None)
        if not first.narrow:
            brackets[0] = _narrowed(study, first, first.middle(), workers)
        elif rival is not None:
            value = rival.lever.changed(first.least)
            others[others.index(rival)] = _narrowed(study, rival, value, workers)
            brackets = sorted([first, *others], key=lambda each: each.size)
        else:
            break
    return brackets


def _loosest(study: Study, lever: Lever, workers: Crew) -> Bracket | None:
    """Bracket of all values of an option; None: no design passes with the loosest."""
    point = _passing(study, lever, lever.loosest, workers)
    if point is None:
        return None
    return Bracket(lever, lever.stated, lever.loosest, lever.reached(point, lever.loosest))


def _narrowed(study: Study, bracket: Bracket, value: float, workers: Crew) -> Bracket:
    """The bracket after the search with a value inside it."""
    point = _passing(study, bracket.lever, value, workers)
    if point is None:
        return replace(bracket, failing=value)
    return replace(bracket, passing=value, reached=bracket.lever.reached(point, value))


def _passing(study: Study, lever: Lever, value: float, workers: Crew) -> Solved | None:
    """A design with which the command passes at a value of an option; None: it does not."""
    own = replace(study, task=study.task.relaxed(lever.options(value)))
    screened = candidates(own.task, study.folder, study.file, SILENT)
    return passing_design(own, drafts(own, screened, workers))


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


def _record(task: DesignTask, bracket: Bracket, out: Path, *, first: bool) -> Record:
    """Record of a relaxation; first: whether it is the smallest."""
    lever = bracket.lever
    options = lever.options(bracket.passing)
    return {
        "option": lever.name,
        "from": lever.shown(lever.stated),
        "to": lever.shown(bracket.passing),
        "fails_at": lever.shown(bracket.failing) if first else None,
        "options": options,
        "command": task.relaxed(options).command(out),
    }

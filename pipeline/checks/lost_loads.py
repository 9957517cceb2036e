"""Checks of load cases in which the follower leaves the cam or locks, or the crank stalls.

After it the loads of the cam are not those of the follower: it lands with an impact, or does not
move. A check that rests on them is made in the other load cases alone. It fails where they exceed
its limit; otherwise it is not evaluated. The contact force, the jump and what follows from the lift
alone are judged in every load case.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from camwright.pipeline.base.units import shown
from camwright.pipeline.checks.check import FIRED, LASTING, RIPPLE, STEADY, Check, Declaration
from camwright.pipeline.checks.extremes import fired, lasting, steady
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.follower_forces import LOCKS

STALLS = "drives a crank that stalls"
"""End of the loads at a constant speed: the torque swings more energy than turns in the crank."""


class LoadEnd(NamedTuple):
    """Load case, cam angle, rad, and reason at which the loads of a follower end."""

    load_case: str
    cam_angle: float
    why: str

    @property
    def words(self) -> str:
        """Text such as ``leaves the cam at 150.5 deg (over-speed)``."""
        return f"{self.why} at {shown(self.cam_angle, 'deg')} ({self.load_case})"


def load_ends(solution: Solution) -> tuple[LoadEnd, ...]:
    """End of the loads of each load case that has one."""
    ends = ((cycle.load_case, _end(cycle)) for cycle in solution.cycles)
    return tuple(LoadEnd(name, *end) for name, end in ends if end is not None)


def _end(cycle: Cycle) -> tuple[float, str] | None:
    """Cam angle, rad, and reason at which the loads of a load case end: jump, lock or stall; None
    where they hold over the turn.
    """
    stall = cycle.turn.driven.stall
    return cycle.end or (None if stall is None else (stall, STALLS))


def checks_on_sound_loads(
    declarations: Iterable[Declaration], solution: Solution
) -> Iterator[Check]:
    """Checks of a solution; those that rest on loads are made in the load cases whose loads hold
    over the turn, and fail or stay open for the others.
    """
    ends = load_ends(solution)
    left = tuple(end for end in ends if end.why != LOCKS)
    parts = {"loads": _Parts.of(solution, ends), "contact": _Parts.of(solution, left)}
    for declared in declarations:
        check = _on_sound_loads(declared, solution, parts.get(declared.rests_on))
        if check is not None:
            yield check


class _Parts(NamedTuple):
    """Solution in the load cases with and without lost loads; None without any."""

    lost: Solution
    sound: Solution | None
    words: str

    @classmethod
    def of(cls, solution: Solution, ends: Sequence[LoadEnd]) -> _Parts | None:
        """Solution split into load cases with and without lost loads, by their `ends`; None where
        there are no ends.
        """
        names = {end.load_case for end in ends}
        if not names:
            return None
        others = {cycle.load_case for cycle in solution.cycles} - names
        words = f"the follower {', '.join(end.words for end in ends)}"
        return cls(_in(solution, names), _in(solution, others) if others else None, words)


def _on_sound_loads(
    declared: Declaration, solution: Solution, parts: _Parts | None
) -> Check | None:
    """Check of a declaration made in the sound load cases alone, or in all where it does not judge
    the lost ones. None where it does not apply.
    """
    if parts is None or not _judges_lost(declared, parts.lost):
        return declared(solution)
    rest = None if parts.sound is None else declared(parts.sound)
    if rest is not None:
        return rest if _lacks_data(rest) else replace(rest, without=parts.words)
    check = declared(solution)
    if check is None or _lacks_data(check):
        return check
    return replace(check, demand=None, error_share=None, without=parts.words)


def _judges_lost(declared: Declaration, lost: Solution) -> bool:
    """Whether a check applies to one of the load cases with lost loads; lost : solution in
    these.
    """
    if declared.load_cases == RIPPLE:
        return declared(lost) is not None
    if declared.load_cases == FIRED:
        return bool(fired(lost))
    cycles = steady(lost) if declared.load_cases == STEADY else lost.cycles
    by_duty = declared.load_cases in (STEADY, LASTING)
    return bool(lasting(cycles) if by_duty else cycles)


def _lacks_data(one: Check) -> bool:
    """Whether it has no demand, for want of a value and not by a load case."""
    return (one.demand is None or math.isnan(one.demand)) and not one.load_case


def _in(solution: Solution, load_cases: Collection[str]) -> Solution:
    """The solution in some of its load cases."""
    return replace(
        solution,
        machines=tuple(each for each in solution.machines if each.load_case in load_cases),
        cycles=tuple(each for each in solution.cycles if each.load_case in load_cases),
    )

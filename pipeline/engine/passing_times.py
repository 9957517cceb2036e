"""Passing times of trigger-wheel edges, averaged over cycles of nearly one speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, distinct, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.trigger_wheel import Edges, TriggerWheel

SPEED_STEP = 0.02  # of the speed, within which cycles are averaged
PASSAGES_MAX = 40  # of one start on the wheel, beyond which the steps widen
_NOISE_MIN = 1e-8  # rad, of a record without noise


@dataclass(frozen=True, eq=False)
class Passage:
    """Edge times over one cycle, averaged over several cycles at nearly one speed.

    Parameters
    ----------
    angle : array (n,)    rad, of the edges of a wheel without errors, from the first edge to the
                          same one a cycle later
    edge : array (n,)     number of the edge on the wheel: rising ones first, then falling ones
    times : array (n,)    s, from the first edge
    count : int           cycles averaged
    """

    angle: Array
    edge: Array
    times: Array
    count: int

    def __post_init__(self) -> None:
        freeze(self, angle=self.angle, times=self.times)

    @property
    def mean_speed(self) -> float:
        """rad/s."""
        return float((self.angle[-1] - self.angle[0]) / (self.times[-1] - self.times[0]))


@dataclass(frozen=True, eq=False)
class Passages:
    """Mean edge times of a record by speed, with noise and half orders.

    Parameters
    ----------
    passages : tuple     one per start on the wheel and step of the speed
    noise : float        rad, standard deviation of the crank angle at which an edge of one cycle is
                         seen, its pitch error apart
    half_orders : array  rad, of the differences between the two times of an edge in the first cycle
    edges : int          number of edges on the wheel, of each kind recorded
    """

    passages: tuple[Passage, ...]
    noise: float
    half_orders: Array
    edges: int

    @property
    def speeds(self) -> Array:
        """Mean speed of each passage, rad/s."""
        return np.array([one.mean_speed for one in self.passages])


def passages_of(
    source: str,
    runs: Sequence[Sequence[Edges]],
    wheel: TriggerWheel,
    harmonics: int,
    like: Array | None = None,
) -> Passages:
    """Mean edge times of a record of a trigger wheel, averaged over cycles of nearly one speed.

    A wheel on the crank does not distinguish the two turns of a cycle: each run begins in the turn
    in which its half orders are most like those of the first run, or of another record.

    Parameters
    ----------
    source : str              name of the record, for messages
    runs : sequence of runs   each the edges of `counted`
    wheel : TriggerWheel      its own edge angles are not used
    harmonics : int           highest harmonic of the cycle; what is above in a time is noise
    like : array, optional    half orders of another record; see `_half_orders`

    Raises
    ------
    InputError
        If no run holds a whole cycle, or the teeth are too few for the harmonics.
    """
    groups: dict[float, list[tuple[Array, Array, Array]]] = {}
    squares: list[Array] = []
    for run in runs:
        cycles = _cycles(run, wheel.regular)
        if not cycles:
            continue
        half_orders, variance = _half_orders(source, cycles, harmonics)
        squares.append(variance)
        like = half_orders if like is None else like
        turn = FULL_TURN if half_orders @ like < 0.0 else 0.0
        start = round(float(np.mod(cycles[0][0][0] + turn, CYCLE_ANGLE)), 6)
        known = groups.setdefault(start, [])
        known += [(angle + turn, edge, times) for angle, edge, times in cycles
                  if not known or known[0][0].size == angle.size]  # fmt: skip
    if like is None or not groups:
        held = max(sum(edges.times.size for edges in run) for run in runs)
        limit = f"a whole cycle, {len(runs[0]) * (2 * wheel.present + 1)} edges or more"
        raise InputError(source, f"{held} edges", limit)
    passages: list[Passage] = []
    for group in groups.values():
        angle, edge, _ = group[0]
        times = np.array([cycle[2] for cycle in group])
        lengths = np.log(times[:, -1])
        step = max(SPEED_STEP, float(np.ptp(lengths)) / PASSAGES_MAX)
        bins = np.floor((lengths - lengths.min()) / step)
        for number in distinct(bins):
            inside = times[bins == number]
            passages.append(Passage(angle, edge, inside.mean(axis=0), inside.shape[0]))
    noise = float(np.sqrt(np.concatenate(squares).mean()))
    edges = len(runs[0]) * wheel.present
    return Passages(tuple(passages), max(noise, _NOISE_MIN), like, edges)


def _cycles(run: Sequence[Edges], wheel: TriggerWheel) -> list[tuple[Array, Array, Array]]:
    """Edges of each whole cycle of a run: angles of a wheel without errors, rad, as in the first
    cycle; numbers of the edges on the wheel; times from the first edge of the cycle, s.

    Both ends of a cycle belong to it. Edges that are missed or too many have been refused before
    (`counted`); a cycle whose number of edges differs from that of the first, by round-off at its
    ends, is left out.

    Parameters
    ----------
    run : sequence         edges of each kind, rising and falling
    wheel : TriggerWheel   of equal pitches
    """
    angle = np.concatenate([wheel.angle(edges.places, edges.falling) for edges in run])
    times = np.concatenate([edges.times for edges in run])
    edge = np.concatenate([edges.numbers(wheel) for edges in run])
    order = np.argsort(angle, kind="stable")
    angle, times, edge = angle[order], times[order], edge[order]
    first = float(wheel.angle(run[0].places[:1], run[0].falling)[0])
    cycles: list[tuple[Array, Array, Array]] = []
    for k in range(int((angle[-1] - first + 1e-6) // CYCLE_ANGLE)):
        begin, end = (
            int(np.searchsorted(angle, first + (k + more) * CYCLE_ANGLE - 1e-6)) for more in (0, 1)
        )
        part = slice(begin, end + 1)
        cycle = angle[part] - k * CYCLE_ANGLE, edge[part], times[part] - times[begin]
        if not cycles or cycle[0].size == cycles[0][0].size:
            cycles.append(cycle)
    return cycles


def _half_orders(
    source: str, cycles: Sequence[tuple[Array, Array, Array]], harmonics: int
) -> tuple[Array, Array]:
    """Half orders in the times between the two passages of an edge in a cycle, mean of a run:
    cosines, then sines, rad; and the variance of the angle at which an edge is seen, rad2, in each
    of the m cycles.

    The difference of the two times of an edge is free of pitch errors and holds half orders of the
    torque alone; those above `harmonics` are noise.

    Parameters
    ----------
    source : str        name of the record, for messages
    cycles : sequence   of `_cycles`
    harmonics : int     highest harmonic of the cycle; with n edges in a turn, fewer than n

    Raises
    ------
    InputError
        If the edges of the two turns differ, or are too few for the harmonics.
    """
    angle, edge, _ = cycles[0]
    times = np.array([cycle[2] for cycle in cycles])
    first = np.flatnonzero(angle < angle[0] + FULL_TURN - 1e-6)
    second = first + first.size
    if second[-1] >= edge.size or not np.array_equal(edge[first], edge[second]):
        raise InputError(source, "two turns with unlike edges", "the same edges in every turn")
    phase = np.outer(angle[first], 0.5 * np.arange(1, harmonics + 1, 2))
    matrix = np.hstack([np.ones((first.size, 1)), np.cos(phase), np.sin(phase)])
    freedom = matrix.shape[0] - matrix.shape[1]
    if freedom < 1:
        limit = f"< {first.size} for {first.size} edges in a turn"
        raise InputError(f"{source}: engine.harmonics", harmonics, limit)
    lag = (times[:, second] - times[:, first]) * (CYCLE_ANGLE / times[:, -1:])
    series = lag @ np.linalg.pinv(matrix).T
    left = lag - series @ matrix.T
    return series[:, 1:].mean(axis=0), np.asarray((left**2).sum(axis=1) / (2.0 * freedom))

"""Pin in the bush of an arm's pivot by finite elements over the turn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, freeze
from camwright.geometry.errors import ContactError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base.tables import Column
from camwright.pipeline.contact.pin_in_bush import (
    BushedPin,
    BushGrid,
    PinInBush,
    PinLoad,
    PressedPin,
    pin_in_bush,
)
from camwright.pipeline.contact.pin_in_hole import peak_pressure
from camwright.pipeline.cycle.part_loads import PivotPush, bore_of
from camwright.pipeline.follower.pivot_bush import pressed_bush

_AT_FIRST = 24  # of the turn, solved at first
_MISSED = 0.01  # of the greatest pressure, by which halfway between solved angles it may be missed
_AROUND, _ALONG = (72, 96, 120, 180, 240, 360), 16
_ON_HALF = 5.0  # hat functions on half of the contact at the greatest force
_RESOLVED = 2.0  # the least that are solved
_REFINED = 2.0
_SAFETY = 3.0  # of the error of two meshes at the order 1
_KERN = 1.0 / 6.0  # couple over force and length up to which a rigid pin lies flat
_FORCES = 9  # of the turn, for the tilt per couple


@dataclass(frozen=True, eq=False)
class PivotHistory:
    """Pin in the bush of a pivot over the turn, by finite elements; arrays (n,).

    edge_pressure: greatest between pin and bush, Pa; foundation: the same by `pressed_bush`; tilt
    of the pin, rad, that of the clearance included; line (n, k): line load at places (k,), m,
    negative on the side away from the force, N/m; worst: number of the angle of the greatest
    pressure, with the pressure (m, k), Pa, at angles (m,), rad, from the plane of the couple;
    solved: angles in all, between which pressures over the root of the load are linear; difference:
    greatest error of that halfway, over the greatest pressure, before it was solved there; coarse:
    the greatest pressure before the refined mesh; equilibrium, complementarity: greatest relative
    residuals.
    """

    edge_pressure: Array
    foundation: Array
    tilt: Array
    line: Array
    places: Array
    angles: Array
    pressure: Array
    worst: int
    coarse: float
    solved: int
    difference: float
    equilibrium: float
    complementarity: float

    def __post_init__(self) -> None:
        freeze(
            self,
            edge_pressure=self.edge_pressure,
            foundation=self.foundation,
            tilt=self.tilt,
            line=self.line,
            places=self.places,
            angles=self.angles,
            pressure=self.pressure,
        )

    @property
    def error(self) -> float:
        """Relative discretisation error of the greatest pressure: of two meshes at the order 1.

        References
        ----------
        Roache (1998), sec. 5.6.
        """
        fine = float(self.edge_pressure[self.worst])
        return _SAFETY * abs(self.coarse / fine - 1.0) / (_REFINED - 1.0)

    def columns(self) -> Mapping[Column, Array]:
        """Columns of ``5_cycle.csv``."""
        return {
            Column(
                "pivot_edge_pressure_foundation", "MPa", "The same by a rigid pin on slices"
            ): self.foundation,
            Column("pivot_tilt", "mrad", "Tilt of the pin in the bush of the pivot"): self.tilt,
        }


class _Rows(NamedTuple):
    """Loads of the turn on a grid, of which some are solved, by the number of their angle."""

    push: PivotPush
    pin: PinInBush
    resolved: NDArray[np.bool_]
    solved: dict[int, PressedPin]

    @classmethod
    def of(cls, push: PivotPush, mean_length: float) -> _Rows | None:
        """None where no load presses the pin."""
        bush, bore, gap = push.bush, bore_of(push.bush), 0.5 * push.bush.clearance
        line = np.hypot(pressed_bush(bush, push.force, push.couple).line_load, push.beside)
        if not line.max() > 0.0:
            return None
        radius = 0.5 * bush.diameter
        half = peak_pressure(line, radius, gap, push.pin, bore)[1]
        greatest = float(push.size.max()) / bush.length
        least = float(peak_pressure([greatest], radius, gap, push.pin, bore)[1][0])
        around = next((n for n in _AROUND if n * least >= _ON_HALF * FULL_TURN), _AROUND[-1])
        seat = BushedPin(push.pin, bore, radius, bush.length, gap, mean_length)
        resolved = (line > 0.0) & (half * around >= _RESOLVED * FULL_TURN)
        return cls(push, pin_in_bush(seat, BushGrid(around, _ALONG)), resolved, {})

    def load(self, row: int) -> PinLoad:
        push = self.push
        aside = float(push.beside[row]) * push.bush.length
        return PinLoad(float(push.force[row]), aside, float(push.couple[row]))

    def solve(self, rows: Iterable[int]) -> None:
        """Solve at the angles of these numbers, each from the contact of the nearest angle; one
        whose contact is not found is left out.
        """
        count = self.resolved.size
        for row in rows:
            away = {(row - each) % count: each for each in self.solved}
            away |= {(each - row) % count: each for each in self.solved}
            start = self.solved[away[min(away)]].active if away else None
            with suppress(ContactError):
                self.solved[row] = self.pin.pressed(self.load(row), start)

    def refine(self, root: Array) -> float:
        """Solve halfway between neighbours until pressures over a root (n,) of the load are linear
        between them, and those about the greatest pressure next to it.

        Returns
        -------
        float   greatest miss of the linear pressures halfway, over the greatest pressure
        """
        count, missed = root.size, 0.0
        places = sorted(self.solved)
        pairs = list(zip(places, [*places[1:], *places[:1]], strict=True))
        while pairs:
            parts = [(a, b, (b - a - 1) % count + 1) for a, b in pairs]
            halves = [(a, (a + wide // 2) % count, b, wide) for a, b, wide in parts if wide > 1]
            self.solve([m for _, m, _, _ in halves if self.resolved[m]])
            peaks = {row: each.peak for row, each in self.solved.items()}
            worst, pairs = max(peaks, key=lambda row: (peaks[row], -row)), []
            for a, m, b, wide in halves:
                if m not in peaks:
                    continue
                share = wide // 2 / wide
                line = (1.0 - share) * peaks[a] / root[a] + share * peaks[b] / root[b]
                miss = abs(root[m] * line - peaks[m]) / peaks[worst]
                if miss > _MISSED or worst in {a, m, b}:
                    pairs += [(a, m), (m, b)]
                else:
                    missed = max(missed, float(miss))
        return missed

    def spread(self) -> list[int]:
        """Numbers of the angles at equal steps whose contact the grid resolves."""
        count = self.resolved.size
        rows = np.unique(np.linspace(0, count, _AT_FIRST, endpoint=False).astype(int))
        return [int(each) for each in rows if self.resolved[each]]


def pivot_history(push: PivotPush, mean_length: float, theta: Array) -> PivotHistory | None:
    """Pin in its bush over the turn; None where nothing presses it.

    Solved at equal steps and where the pressure is greatest, there on a refined mesh as well, by
    whose ratio all pressures are scaled.

    Parameters
    ----------
    mean_length : float   of the mean pressure at an end of the bush, m
    theta : array (n,)    cam angles, rad

    Raises
    ------
    ContactError
        If the contact at the greatest pressure is not found.
    """
    rows = _Rows.of(push, mean_length)
    if rows is None:
        return None
    # a narrow contact has a pressure in proportion to the root of its load
    effort, every = push.size + push.couple / push.bush.length, rows.solved
    root, foundation, searched = np.sqrt(effort), push.edge_pressure, False
    worst = first_greatest(foundation)
    rows.solve(rows.spread())
    while not searched:
        if worst not in every:
            every[worst] = rows.pin.pressed(rows.load(worst))
        missed = rows.refine(root)
        edge = root * _linear({row: each.peak / root[row] for row, each in every.items()}, theta)
        worst = first_greatest(edge)
        searched = worst in every
    governing, coarse = every[worst], rows.pin
    refined = pin_in_bush(coarse.seat, coarse.grid.refined(_REFINED)).pressed(rows.load(worst))
    scale = refined.peak / governing.peak
    signed = {row: _signed(each.line) / effort[row] for row, each in every.items()}
    return PivotHistory(
        edge_pressure=scale * edge,
        foundation=foundation,
        tilt=_linear({row: each.tilt for row, each in every.items()}, theta),
        line=effort[:, None] * _linear(signed, theta),
        places=coarse.places,
        angles=coarse.angles,
        pressure=scale * governing.pressure,
        worst=worst,
        coarse=governing.peak,
        solved=len(every),
        difference=missed,
        equilibrium=max(each.equilibrium for each in (refined, *every.values())),
        complementarity=max(each.complementarity for each in (refined, *every.values())),
    )


def pin_slopes(push: PivotPush, mean_length: float) -> Array | None:
    """Elastic tilt of the pin per couple over the turn (n,), rad/(N m), by finite elements.

    By the couple at which a rigid pin just lies flat on its bush under the whole load in the plane
    of the couple: under a load across that plane it first slides aside within its clearance, which
    is not part of the slope. Linear over the load between those solved; None where none is.
    """
    size = push.size
    couple = _KERN * push.bush.length * size
    flat = push._replace(force=size, beside=np.zeros_like(size), couple=couple)
    rows = _Rows.of(flat, mean_length)
    if rows is None:
        return None
    places = np.linspace(0, size.size - 1, _FORCES).astype(int)
    by_size = np.argsort(size, kind="stable")[places]
    rows.solve([int(each) for each in by_size if rows.resolved[each]])
    solved = [int(each) for each in by_size if int(each) in rows.solved]
    slopes = [rows.solved[each].tilt / couple[each] for each in solved]
    return np.interp(size, size[solved], slopes) if slopes else None


def _signed(line: Array) -> Array:
    """Line load (k,) by its parts (2, k), negative where that in the plane of the couple is."""
    return np.asarray(np.where(line[0] < 0.0, -1.0, 1.0) * np.hypot(*line))


def _linear(values: Mapping[int, Array | float], theta: Array) -> Array:
    """Values over the turn (n, ...), linear between those at the angles of the numbers stated."""
    rows = np.array(sorted(values))
    solved = np.array([values[int(row)] for row in rows])
    before = np.searchsorted(rows, np.arange(theta.size), side="right") - 1
    after = (before + 1) % rows.size
    start = theta[rows[before]]
    wide = (theta[rows[after]] - start) % FULL_TURN
    share = (theta - start) % FULL_TURN / np.where(wide > 0.0, wide, FULL_TURN)
    share = share.reshape(-1, *(1,) * (solved.ndim - 1))
    return np.asarray((1.0 - share) * solved[before] + share * solved[after])

"""Contact of two bodies of finite length on pressure cells, under a force and a tilt or moment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.contact.elasticity import active_set
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells


class WideContactError(ContactError):
    """Contact that reaches the last cells across it."""


@dataclass(frozen=True, eq=False)
class LengthContact:
    """Contact of `count` problems: pressure (count, m, k), Pa, on cells; approach (count,), m.

    tilt (count,), rad, closes the gap at y > 0; force (count,), N, and moment (count,), N m, of the
    pressures about the middle; equilibrium and complementarity (count,), relative residuals.
    """

    cells: PressureCells
    pressure: Array
    approach: Array
    tilt: Array
    force: Array
    moment: Array
    equilibrium: Array
    complementarity: Array

    def __post_init__(self) -> None:
        names = ("pressure", "approach", "tilt", "force", "moment")
        freeze(self, **{name: getattr(self, name) for name in names})
        freeze(self, equilibrium=self.equilibrium, complementarity=self.complementarity)

    @property
    def centre_line(self) -> Array:
        """Pressure (count, m), Pa, at x = 0, by a parabola through the two cells beside it."""
        first, second = self.pressure[:, :, 0], self.pressure[:, :, 1]
        return np.where(second > 0, (7.0 * first - second) / 6.0, first)

    @property
    def centre(self) -> Array:
        """Pressure (count,), Pa, at x = 0 and y = 0."""
        return at_middle(self.edges, self.centre_line)

    @property
    def edges(self) -> Array:
        """Edges (count, m + 1), m, of the cells along y."""
        return np.broadcast_to(self.cells.y, (self.force.size, self.cells.y.size))

    @property
    def greatest(self) -> Array:
        """Greatest pressure (count,), Pa, on the centre line."""
        return np.asarray(self.centre_line.max(axis=1))

    def end_means(self, length: float) -> Array:
        """Mean pressures (count, 2), Pa, over the last `length`, m, of contact at y < 0 and y > 0,
        on the centre line, from the last cell in contact.

        Raises
        ------
        ContactError
            If a contact is shorter than this length.
        """
        means, lengths = means_at_ends(self.edges, self.centre_line, length)
        if not (lengths >= length).all():
            raise ContactError("the contact is shorter than the length of the mean at its end")
        return means


def at_middle(edges: Array, line: Array) -> Array:
    """Pressures (count,) at y = 0, linear between the middles of cells.

    Parameters
    ----------
    edges : array (count, m + 1)   of the cells along y, m
    line : array (count, m)        pressures on the cells
    """
    middles, rows = 0.5 * (edges[:, 1:] + edges[:, :-1]), np.arange(len(line))
    left = np.clip((middles <= 0.0).sum(axis=1) - 1, 0, line.shape[1] - 2)
    start, end = middles[rows, left], middles[rows, left + 1]
    share = np.clip(-start / (end - start), 0.0, 1.0)
    return np.asarray(line[rows, left] + share * (line[rows, left + 1] - line[rows, left]))


def means_at_ends(edges: Array, line: Array, length: float) -> tuple[Array, Array]:
    """Mean pressures over the last `length`, m, of each end of contact, at small and large y,
    (count, 2), in the unit of `line`, and the length of contact (count,), m.

    From the last cell in contact; of the whole contact where that is shorter.

    Parameters
    ----------
    edges : array (count, m + 1)   of the cells along y, m
    line : array (count, m)        pressures on the cells
    """
    touching, rows, cells = line > 0, np.arange(len(line)), line.shape[1]
    first = touching.argmax(axis=1)
    last = cells - touching[:, ::-1].argmax(axis=1)
    start, end = edges[rows, first], edges[rows, last]
    over = np.minimum(length, end - start)
    primitive = np.zeros(edges.shape)
    np.cumsum(line * np.diff(edges), axis=1, out=primitive[:, 1:])

    def integral(place: Array) -> Array:
        left = np.clip((edges <= place[:, None]).sum(axis=1) - 1, 0, cells - 1)
        return np.asarray(primitive[rows, left] + line[rows, left] * (place - edges[rows, left]))

    sums = [
        integral(start + over) - primitive[rows, first],
        primitive[rows, last] - integral(end - over),
    ]
    return np.stack(sums, axis=1) / over[:, None], end - start


class SignedPressure(NamedTuple):
    """Pressure stated in a sign-off (count,), whether a corner mean; pressure in the middle."""

    value: Array
    at_corner: NDArray[np.bool_]
    centre: Array


def signed_pressure(
    edges: Array, line: Array, flat: float, length: float, *, has_corner: bool
) -> SignedPressure:
    """Pressure that a sign-off states (count,): greatest on the line, or a mean at a sharp corner.

    Where the greatest pressure is at a corner, the mean at the ends or, if greater, the greatest
    pressure between them; else the greatest one.

    Parameters
    ----------
    edges : array (count, m + 1)   of the cells along y, m
    line : array (count, m)        pressures on the cells, in any unit
    flat : float                   length of the line without ends, m
    length : float                 of the mean at a corner, m
    has_corner : bool              whether the pressure grows without bound at the ends
    """
    means, _ = means_at_ends(edges, line, length)
    most = line.argmax(axis=1)
    greatest = np.take_along_axis(line, most[:, None], axis=1)[:, 0]
    peak_at_corner = ((most == 0) | (most == line.shape[1] - 1)) & has_corner
    at = np.flatnonzero(peak_at_corner)
    middles = 0.5 * (edges[at, 1:] + edges[at, :-1])
    between = np.abs(middles) <= 0.5 * flat - length
    mean, bounded = means.max(axis=1), np.zeros(len(line))
    bounded[at] = np.where(between, line[at], 0.0).max(axis=1, initial=0.0)
    greatest[at] = np.maximum(mean, bounded)[at]
    return SignedPressure(greatest, peak_at_corner & (mean >= bounded), at_middle(edges, line))


def rebinned(edges: Array, line: Array, common: Array) -> Array:
    """Mean pressures (count, k) on the cells of common edges (k + 1,), m; the force is conserved.

    edges (count, m + 1), m; line (count, m).
    """
    total = np.cumsum(np.pad(line * np.diff(edges), ((0, 0), (1, 0))), axis=1)
    at = np.array([np.interp(common, *row) for row in zip(edges, total, strict=True)])
    return np.asarray(np.diff(at, axis=1) / np.diff(common))


def solve(
    cells: PressureCells,
    compliance: Array,
    gap: ArrayLike,
    force: ArrayLike,
    *,
    tilt: ArrayLike | None = None,
    moment: ArrayLike | None = None,
    guess: ArrayLike | None = None,
) -> LengthContact:
    """Contact pressures of problems that differ in gap, force, and tilt or moment.

    Parameters
    ----------
    compliance : array (n, n)   of the cells, m3/Pa
    gap : array (count, n)      integrated over the cells, m3
    force : array (count,)      N, > 0, of the whole contact
    tilt : array (count,)       rad, prescribed between the supports of the compliance; default: 0
    moment : array (count,)     N m, about y = 0, prescribed instead of the tilt
    guess : array (n,) of bool  cells in contact to begin with; the solution does not depend on them

    Raises
    ------
    InputError
        If both tilt and moment are prescribed.
    ContactError
        If a problem has no solution.
    WideContactError
        If the contact reaches the last cells across it.
    """
    if tilt is not None and moment is not None:
        raise InputError("moment", "prescribed", "left out beside a tilt")
    gaps = np.atleast_2d(np.asarray(gap, dtype=float))
    count, areas = len(gaps), cells.areas
    levers = areas * cells.centres[1]
    forces = np.broadcast_to(np.asarray(force, dtype=float), (count,))
    if moment is None:
        turned = np.broadcast_to(np.asarray(0.0 if tilt is None else tilt, dtype=float), (count,))
        solution = active_set.solve(
            compliance, gaps - np.outer(turned, levers), areas, forces / 2.0, guess
        )
    else:
        moments = np.broadcast_to(np.asarray(moment, dtype=float), (count,))
        solution = active_set.solve(
            compliance, gaps, areas, forces / 2.0, guess, levers=levers, moment=moments / 2.0
        )
        turned = solution.tilt
    pressure = solution.pressure.reshape(count, *cells.shape)
    if (pressure[:, :, -1] > 0).any():
        raise WideContactError("contact wider than the window of its pressure cells")
    return LengthContact(
        cells=cells,
        pressure=pressure,
        approach=solution.approach,
        tilt=turned,
        force=2.0 * solution.pressure @ areas,
        moment=2.0 * solution.pressure @ levers,
        equilibrium=solution.equilibrium,
        complementarity=solution.complementarity,
    )

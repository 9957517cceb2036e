"""Axial pressure by half-spaces solved directly: few contacts with many crowns.

A table of factors is for many contacts of one crown.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.factor_table import GREATEST_MOMENT
from camwright.pipeline.contact.finite_length.half_space import shared_compliance
from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.length_tiers import cycle_sizes
from camwright.pipeline.contact.finite_length.pressure_cells import pressure_cells
from camwright.pipeline.cycle.length_history import (
    ContactLoads,
    greatest_moment,
    signed_factor,
)

# Ratio of the half-widths, m, of neighbouring cells: contacts between them have the wider ones.
_LADDER = 1.1


@dataclass(frozen=True, eq=False)
class SolvedLines:
    """Axial pressure of a pair by direct solution; mean_length (m) of the end means."""

    pair: FinitePair
    mean_length: float

    def axial_pressure(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Edges (count, m + 1), m, along y and pressures (count, m) over plane-strain p0, x = 0.

        Parameters
        ----------
        curvature : array (count,)  1/m, > 0
        force : array (count,)      N, > 0
        moment : array (count,)     N m, about y = 0
        """
        solved = list(self._solved(curvature, force, moment=moment))
        cells, count = solved[0][1].cells, sum(rows.size for rows, _, _ in solved)
        edges, line = np.empty((count, cells.y.size)), np.empty((count, cells.shape[0]))
        for rows, contact, p0 in solved:
            edges[rows], line[rows] = contact.cells.y, contact.centre_line / p0[:, None]
        return edges, line

    def moment_at_tilt(
        self,
        curvature: ArrayLike,
        force: ArrayLike,
        tilt: ArrayLike,
        most: ArrayLike = np.inf,
        compliance: ArrayLike = 0.0,
    ) -> Array:
        """Moment (count,), N m, that tilts each contact by a given angle.

        A light line whose tilt is more than that of the greatest moment is not solved at its tilt,
        at which it would touch at one end alone. The support of one body yields to the moment; of
        the compliances given the least is taken for all.

        Parameters
        ----------
        curvature, force : arrays (count,)   1/m; N
        tilt : array (count,)                rad
        most : array (count,)                greatest moment, N m, at most `GREATEST_MOMENT`
        compliance : array                   of the support, rad/(N m)
        """
        kappa, load, turn = np.broadcast_arrays(*np.atleast_1d(curvature, force, tilt))
        limit = GREATEST_MOMENT * load * self.pair.contact_length
        moment, yields = np.sign(turn) * np.minimum(most, limit), float(np.min(compliance))
        within = np.zeros(load.shape, dtype=bool)
        for each, contact, _ in self._solved(kappa, load, yields, moment=moment):
            within[each] = np.abs(contact.tilt) > np.abs(turn[each])
        at, rows = np.flatnonzero(within), (kappa[within], load[within])
        for each, contact, _ in self._solved(*rows, yields, tilt=turn[within]):
            moment[at[each]] = contact.moment
        return moment

    def _solved(
        self, curvature: ArrayLike, force: ArrayLike, yields: float = 0.0, **turned: ArrayLike
    ) -> Iterator[tuple[NDArray[np.intp], LengthContact, Array]]:
        """Solve contacts in groups of similar half-width, which share their cells; yields of each
        group the indices of its contacts, their solution, and p0 of plane strain, Pa.

        Parameters
        ----------
        curvature, force : arrays (count,)   1/m; N
        yields : float                       compliance of the support, rad/(N m)
        turned : array (count,)              either `moment`, N m, or `tilt`, rad, by name
        """
        (name, value), pair = next(iter(turned.items())), self.pair
        kappa, load, turn = np.broadcast_arrays(
            *(np.atleast_1d(np.asarray(v, dtype=float)) for v in (curvature, force, value))
        )
        half_width, p0 = hertz.line_contact(
            load / pair.contact_length, 1.0 / kappa, pair.contact_modulus
        )
        step = np.ceil(np.log(half_width) / np.log(_LADDER)).astype(int)
        for each in np.unique(step):
            rows = np.flatnonzero(step == each)
            widest = rows[np.argmax(kappa[rows] * half_width[rows] ** 2)]
            here = replace(pair, curvature=float(kappa[widest]))
            cells = pressure_cells(here, _LADDER ** int(each), cycle_sizes(pair))
            gaps = [
                cells.integrated_gap(replace(pair, curvature=float(value))) for value in kappa[rows]
            ]
            compliance = shared_compliance(cells, pair.bodies)
            if yields:  # the moment of both halves turns the gap
                levers = cells.areas * cells.centres[1]
                compliance = compliance + 2.0 * yields * np.outer(levers, levers)
            contact = length_contact.solve(
                cells, compliance, gaps, load[rows], **{name: turn[rows]}
            )
            yield rows, contact, p0[rows]


class SignedRange(NamedTuple):
    """Stated over plane-strain pressure (count,), the worse of aligned and tilted; moment, N m.

    The moment is the greatest, see `greatest_moment`.
    """

    factor: Array
    moment: Array


def signed_range(lines: SolvedLines, loads: ContactLoads) -> SignedRange:
    """Signed axial pressure of contacts over that of plane strain, the greatest of aligned and at
    the greatest moment to either side; and this moment, N m.

    Parameters
    ----------
    lines : SolvedLines    pair with its crown
    loads : ContactLoads   curvature, force and tilt of each contact
    """
    moment = greatest_moment(lines, loads)
    sides = (0.0, 1.0) if lines.pair.is_symmetric else (-1.0, 0.0, 1.0)
    at = loads.curvature, loads.force
    signed = [signed_factor(lines, *at, side * moment).value for side in sides]
    return SignedRange(np.max(signed, axis=0), moment)

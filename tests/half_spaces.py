"""Axial factors of contacts by half-spaces, each solved: what the table of factors interpolates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.errors import InputError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.half_space import half_space_compliance
from camwright.pipeline.contact.finite_length.length_tiers import (
    MEAN_LENGTH,
    AxialFactors,
    cycle_sizes,
)
from camwright.pipeline.contact.finite_length.pressure_cells import pressure_cells

# Contacts whose half-widths lie within this ratio share their cells.
_SHARED = 1.1


def half_space_factors(
    pair: FinitePair,
    curvature: ArrayLike,
    force: ArrayLike,
    moment: ArrayLike = 0.0,
    *,
    mean_length: float = MEAN_LENGTH,
) -> AxialFactors:
    """Axial factors by half-spaces of many contacts of the same bodies, as over a cycle.

    Parameters
    ----------
    pair : FinitePair           its curvature is not used
    curvature : array (count,)  1/m
    force : array (count,)      N, > 0
    moment : array (count,)     N m, about y = 0
    """
    kappa, load, couple = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(v, dtype=float)) for v in (curvature, force, moment))
    )
    if not (load > 0).all():
        raise InputError("force", float(load.min()), "> 0 N")
    half_width, p0 = hertz.line_contact(
        load / pair.contact_length, 1.0 / kappa, pair.contact_modulus
    )
    group = np.ceil(np.log(half_width / half_width.min()) / np.log(_SHARED)).astype(int)
    table = np.empty((load.size, 4))
    for each in np.unique(group):
        rows = np.flatnonzero(group == each)
        widest = rows[np.argmax(half_width[rows])]
        here = replace(pair, curvature=float(kappa[widest]))
        cells = pressure_cells(here, float(half_width[widest]), cycle_sizes(pair))
        gaps = [
            cells.integrated_gap(replace(pair, curvature=float(value))) for value in kappa[rows]
        ]
        contact = length_contact.solve(
            cells, half_space_compliance(cells, pair.bodies), gaps, load[rows], moment=couple[rows]
        )
        table[rows] = AxialFactors.of(contact, p0[rows], mean_length).all
    return AxialFactors(table[:, 0], table[:, 1], table[:, 2:], mean_length)

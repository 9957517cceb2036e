"""Extent of a crowned contact along its line by a strip foundation, and cells on it.

Light loads touch a short part of a crowned line, and a moment shifts it. The estimate places the
cells on which half-spaces are solved; it enters no result.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.finite_length.axial_drop import Crown, FinitePair, Straight
from camwright.pipeline.contact.finite_length.pressure_cells import (
    CellSizes,
    PressureCells,
    edges_across,
    edges_along,
)

_STRIPS, _NEWTON_STEPS, _STRIP_REFINEMENTS = 400, 60, 6
_FORCE_CONVERGED = 1e-6  # of the force: a rougher estimate moves the cells
# Cells beyond the estimated ends over its length: the estimate is up to a third too long, and at
# most some per cent too short.
_SPAN_MARGIN = 0.05
# Shares of the window across that a contact takes which no end of the line bounds, and one does.
_ACROSS, _ACROSS_AT_END = 0.16, 0.3
# Distance of the contact from an end of the line, over half its length, from which the cells there
# shrink with the contact; greatest share of the contact that they take below it.
_FREE, _END_SHARE = 0.25, 0.4
# Least length of line at an end whose cells do not shrink, over half the length.
_END_ZONE = 0.05


class ContactSpan(NamedTuple):
    """Ends of the contact along the line, m; greatest over mean line load."""

    start: float
    end: float
    concentration: float


def contact_cells(pair: FinitePair, force: float, moment: float, sizes: CellSizes) -> PressureCells:
    """Pressure cells on the part of the line in contact under a force, N, and a moment about y = 0,
    N m.

    The number of cells along the line does not depend on the load; their edges follow the contact.
    Without a crown they are on the whole line.

    Parameters
    ----------
    sizes : CellSizes   of the cells across and along the line
    """
    half_width, _ = hertz.line_contact(
        force / pair.contact_length, 1.0 / pair.curvature, pair.contact_modulus
    )
    wide, along = float(half_width), edges_along(pair, float(half_width), sizes)
    if isinstance(pair.crown, Straight):
        return PressureCells(edges_across(wide, sizes), along)
    span, flat, reach = contact_span(pair, force, moment), 0.5 * pair.contact_length, along[-1]
    margin = _SPAN_MARGIN * (span.end - span.start)
    low = -reach if span.start - margin <= -flat else span.start - margin
    high = reach if span.end + margin >= flat else span.end + margin
    if high - low == 2.0 * reach:
        return PressureCells(edges_across(wide, sizes), along)
    local = wide * max(1.0, np.sqrt(span.concentration))
    share = _ACROSS if -reach < low and high < reach else _ACROSS_AT_END
    across = edges_across(local, replace(sizes, window=share * sizes.window))
    zone = max(2.0 * (reach - flat), _END_ZONE * flat)
    return PressureCells(across, _mapped(along, low, high, min(zone, _END_SHARE * reach)))


def _mapped(edges: Array, low: float, high: float, zone: float) -> Array:
    """Cell edges, m, of the whole line mapped to its part from `low` to `high`; within `zone`, m,
    of an end that the part reaches they keep their distances.
    """
    reach = float(edges[-1])
    share = (high - low) / (2.0 * reach)
    first, last = (
        min(zone * share ** min(1.0, apart / (_FREE * reach)), _END_SHARE * (high - low))
        for apart in (low + reach, reach - high)
    )
    from_knots = [-reach, zone - reach, reach - zone, reach]
    return np.asarray(np.interp(edges, from_knots, [low, low + first, high - last, high]))


def contact_span(pair: FinitePair, force: float, moment: float) -> ContactSpan:
    """Extent of the contact under a force, N, and a moment about y = 0, N m.

    The foundation has the stiffness of a line contact as long as the strips that touch.

    Raises
    ------
    ContactError
        If force and moment cannot be balanced on the line.
    """
    return _span(
        pair.contact_length, pair.curvature, pair.contact_modulus, pair.crown, force, moment
    )


@lru_cache(maxsize=16)
def _span(
    whole: float, curvature: float, modulus: float, crown: Crown, force: float, moment: float
) -> ContactSpan:
    """Extent of the contact on a crowned line under a force and a moment, by springs along the
    line; cached for bodies that share these inputs.

    Parameters
    ----------
    whole : float           length of the line, m
    curvature : float       1/R1 + 1/R2 across the line, 1/m
    modulus : float         E*, Pa
    force, moment : float   N; N m about y = 0
    """
    low, high, length = -0.5 * whole, 0.5 * whole, whole
    pressed = np.empty(0)
    edges = np.empty(0)
    for _ in range(_STRIP_REFINEMENTS):
        edges = np.linspace(low, high, _STRIPS + 1)
        y = 0.5 * (edges[1:] + edges[:-1])
        half_width, _ = hertz.line_contact(force / length, 1.0 / curvature, modulus)
        # Indentation of a line contact of that length by its line load, in its middle.
        softness = 2.0 * max(np.log(4.0 * length / float(half_width)) + 0.5, 1.0)
        stiffness = np.pi * modulus / softness
        pressed = stiffness * _pressed(
            y, crown.drop(y), force / (stiffness * (edges[1] - edges[0])), moment / force
        )
        touching = np.flatnonzero(pressed > 0)
        start, end = edges[touching[0]], edges[touching[-1] + 1]
        length = end - start
        reach = 0.5 * length
        low, high = max(start - reach, -0.5 * whole), min(end + reach, 0.5 * whole)
    return ContactSpan(float(start), float(end), float(pressed.max()) * whole / force)


def _pressed(y: Array, drop: Array, total: float, lever: float) -> Array:
    """Indentations (k,), m, >= 0, of equal strips under a rigid motion, with a given sum and
    centre.

    Newton on the convex energy, damped where a step does not lower it.

    Parameters
    ----------
    y : array (k,)      middles of the strips along the line, m
    drop : array (k,)   of the crown, m
    total : float       sum of the indentations, m
    lever : float       centre of the indentations along y, m: moment over force

    Raises
    ------
    ContactError
        If the iteration does not converge.
    """
    scale = float(np.abs(y).max())
    basis = np.column_stack([np.ones_like(y), y / scale])
    target = total * np.array([1.0, lever / scale])

    def energy(motion: Array) -> float:
        return float(0.5 * (np.maximum(basis @ motion - drop, 0.0) ** 2).sum() - target @ motion)

    # All strips touch at first.
    motion = np.asarray(np.linalg.solve(basis.T @ basis, target + basis.T @ drop), dtype=float)
    for _ in range(_NEWTON_STEPS):
        indentation = np.maximum(basis @ motion - drop, 0.0)
        residual = basis.T @ indentation - target
        if np.abs(residual).max() <= _FORCE_CONVERGED * total:
            return np.asarray(indentation, dtype=float)
        on = basis[indentation > 0]
        hessian = on.T @ on + 1e-9 * np.eye(2)
        step, damping = np.linalg.solve(hessian, residual), 1.0
        before, slope = energy(motion), float(residual @ step)
        while damping > 1e-12 and energy(motion - damping * step) > before - 1e-4 * damping * slope:
            damping *= 0.5
        motion = motion - damping * step
    raise ContactError("the force and moment of a crowned contact are not balanced on its line")

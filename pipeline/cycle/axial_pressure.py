"""Pressure along the line of contact at every position of a cycle, ends and tilt included."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base.tables import Column
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.length_contact import rebinned
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.length_history import length_table, raised_load

_MM, _MPA = 1e3, 1e-6

AXIAL_ARRAYS = (
    Column("load_case", "", "(n,) load case of each row of `5_cycle.csv`"),
    Column("cam_angle", "deg", "(n,) cam angle of the row"),
    Column("axial_edge", "mm", "(k + 1,) ends of the cells along the line, from its middle"),
    Column("level_pressure", "MPa", "(n, k) mean over the cell without tilt, middle of the width"),
    Column("tilted_pressure", "MPa", "(n, k) the same at the greatest moment, of the worse sign"),
    Column("mean_length", "mm", "length of the cells at a corner that ends the contact"),
)
"""Arrays of ``5_length.npz``."""


def axial_arrays(cycles: Sequence[Cycle]) -> Mapping[str, ArrayLike] | None:
    """Arrays of ``5_length.npz``, by half-spaces; None without body ends or contact. Of preloaded
    discs they are those of the disc with the greater signed pressure at each angle.

    At a corner the pressure of the last cell is the mean over the stated length: the peak there
    depends on the cells. With an axial offset each half of the line is that of its own end.

    Returns
    -------
    mapping   by the headers of `AXIAL_ARRAYS`
    """
    machine, first = cycles[0].machine, cycles[0].length
    if first is None or any(cycle.length is None for cycle in cycles):
        return None
    p0, radius, force, moment = np.concatenate([_of_lines(cycle) for cycle in cycles], axis=1)
    rows = np.flatnonzero(np.isfinite(radius) & (radius > 0) & (force > 0))
    if not rows.size:
        return None
    raised = raised_load(force[rows])
    at, couple = (1.0 / radius[rows], raised * force[rows]), raised * moment[rows]
    states = np.zeros(rows.size), couple, -couple
    pairs = machine.finite_pairs
    halves = pairs if len(pairs) > 1 else pairs * 2
    (ends_left, left), (ends_right, right) = (
        _cells(pair, first.mean_length, at, states) for pair in halves
    )
    low, high = ends_left.size // 2, ends_right.size // 2
    edges = np.concatenate([ends_left[:low], ends_right[high:]])
    level, *tilted = (
        np.hstack([one[:, :low], other[:, high:]]) * p0[rows, None]
        for one, other in zip(left, right, strict=True)
    )
    worse = tilted[first_greatest([pressure.max() for pressure in tilted])]
    arrays: dict[str, ArrayLike] = {
        "load_case": np.repeat([c.load_case for c in cycles], [c.theta.size for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
        "axial_edge_mm": _MM * edges,
        "mean_length_mm": np.array(_MM * first.mean_length),
    }
    for name, pressure in (("level_pressure_MPa", level), ("tilted_pressure_MPa", worse)):
        pressure_rows = np.zeros((p0.size, edges.size - 1))
        pressure_rows[rows] = _MPA * pressure
        arrays[name] = pressure_rows
    return arrays


def _of_lines(cycle: Cycle) -> Array:
    """Pressure of plane strain, Pa, relative radius, m, force, N, and moment, N m, of the contacts
    of a turn (4, n); of preloaded discs at each angle of that with the greater signed pressure.
    """

    def of(track: Cycle) -> Array:
        moment = np.full(track.theta.size, np.nan) if track.length is None else track.length.moment
        contact, force = track.contact, track.loads.normal_force
        return np.stack([contact.p0, contact.relative_radius, force, moment])

    here, other = of(cycle), cycle.on_other_track
    if other is None:
        return here
    return np.where(other.signed_pressure > cycle.signed_pressure, of(other), here)


def _cells(
    pair: FinitePair, mean_length: float, at: tuple[Array, Array], moments: Sequence[Array]
) -> tuple[Array, list[Array]]:
    """Edges (c + 1,), m, and for each of the moments (m,), N m, the pressure over p0, in a list of
    arrays, on the cells of the worst load; at : curvature, 1/m, and force, N, (m,) each.

    At a corner the last cell is that of the mean.
    """
    table, worst = length_table(pair, mean_length), first_greatest(at[1])
    edges = table.edges_of_line(*(float(each[worst]) for each in at))
    if pair.has_singular_end:
        edges = with_end_cells(edges, mean_length)
    return edges, [rebinned(*table.axial_pressure(*at, moment), edges) for moment in moments]


def with_end_cells(edges: Array, length: float) -> Array:
    """Cell edges, m, with first and last cells of a given length, m."""
    inner = edges[np.abs(edges) < edges[-1] - length - 1e-9]
    return np.concatenate([[edges[0], edges[0] + length], inner, [edges[-1] - length, edges[-1]]])

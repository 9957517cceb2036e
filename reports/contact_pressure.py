"""Pressure over one contact, read from a run: what stands above the picture of its stress."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.tables import Table
from camwright.reports.field_raster import Above

FILE = "5_pressure.npz"
_NEAR = 1e-6  # deg
_ELLIPSE = np.linspace(-1.0, 1.0, 201)


def over_the_contact(path: Path, cycle: Table, angle: float, half_width: float) -> Above | None:
    """Pressure and Hertz's ellipse over places in half-widths (mm), at a cam angle, deg.

    Of several load cases the one with the greatest pressure there; None where the run keeps none.
    """
    try:
        with np.load(path, allow_pickle=False) as entry:
            rows = np.flatnonzero(np.abs(entry["cam_angle_deg"] - angle) < _NEAR)
            along, pressure = entry["xi_mm"][rows], entry["pressure_MPa"][rows]
    except (OSError, ValueError, KeyError, EOFError, IndexError):
        return None
    if not rows.size or not np.isfinite(pressure).any():
        return None
    chosen = int(np.nanargmax(np.nanmax(pressure, axis=1)))
    curves: tuple[tuple[str, Array, Array], ...] = (
        ("finite elements", along[chosen] / half_width, pressure[chosen]),
    )
    row = int(rows[chosen])
    if "p0_hertz_MPa" in cycle and "half_width_hertz_mm" in cycle:
        places = _ELLIPSE * cycle["half_width_hertz_mm"][row] / half_width
        hertz = cycle["p0_hertz_MPa"][row] * np.sqrt(1 - _ELLIPSE**2)
        curves += (("Hertz", places, hertz),)
    return Above("pressure, MPa", curves)

"""Pressure in both guides over the turn and, where it is greatest, all round the bore."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from geometry.arrays import Array
from geometry.errors import ContactError
from pipeline.case import Case
from pipeline.contact.pin_in_hole import Conforming, pin_in_hole
from pipeline.cycle import Cycle
from pipeline.part_fields import Guide
from pipeline.parts import bush_pair

ANGLES = 721
"""Angles round the bore, from half a turn before the line of action to half a turn beyond."""

_MM, _MPA, _N_PER_MM = 1e3, 1e-6, 1e-3


def bush_arrays(case: Case, cycles: Sequence[Cycle]) -> Mapping[str, Any]:
    """Arrays of ``5_bushes.npz``.

    Returns
    -------
    mapping   load_case (n,) and cam_angle_deg (n,), a row per position of each load case; for
              the guides A and B: A_along_mm (k,) from the middle of the guide, growing away from
              the roller; A_line_N_per_mm (n, k), the guide's push on the stem, positive against
              the side force; A_row the row of the greatest; A_round_deg (m,) from the line of
              action of a positive push; A_pressure_MPa (k, m) in the bore at that row
    """
    found: dict[str, Any] = {
        "load_case": np.repeat([c.load_case for c in cycles], [c.theta.size for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
    }
    for side, guide in (("a", case.guides.a), ("b", case.guides.b)):
        lines = np.concatenate([getattr(c.guides, f"line_pressure_{side}") for c in cycles], axis=1)
        row = int(np.argmax(np.abs(lines).max(axis=0)))
        name = side.upper()
        found |= {
            f"{name}_along_mm": _MM * getattr(cycles[0].guides, f"knots_{side}"),
            f"{name}_line_N_per_mm": _N_PER_MM * lines.T,
            f"{name}_row": np.array(row),
            f"{name}_round_deg": np.degrees(_round()),
            f"{name}_pressure_MPa": _MPA * bore_pressure(case, guide, lines[:, row]),
        }
    return found


def bore_pressure(case: Case, guide: Guide, line: Array) -> Array:
    """Pressure (k, m), Pa, round the bore under pushes (k,), N/m, of a guide on its stem.

    Each slice of the guide is a pin in a hole of its own; a negative push is that of the other
    side of the bore. Not a number where the stem would wedge itself into the bore.
    """
    pressure = np.zeros((line.size, ANGLES))
    for k, push in enumerate(line):
        if push == 0.0:
            continue
        try:
            pressure[k] = _spread(_slice(case, guide, abs(float(push))), turned=bool(push < 0))
        except ContactError:
            pressure[k] = np.nan
    return pressure


def _slice(case: Case, guide: Guide, load: float) -> Conforming:
    pin, bush = bush_pair(case, guide)
    return pin_in_hole(load, 0.5 * case.follower.stem_diameter, 0.5 * guide.clearance, pin, bush)


def _spread(found: Conforming, *, turned: bool) -> Array:
    """Pressure (m,) at the angles of `_round`, both sides of the line of action alike."""
    away = np.abs(_round())
    if turned:
        away = np.pi - away
    inside = np.append(found.pressure[found.angle < found.contact_angle], 0.0)
    at = np.append(found.angle[found.angle < found.contact_angle], found.contact_angle)
    return np.interp(away, at, inside, right=0.0)


def _round() -> Array:
    return np.linspace(-np.pi, np.pi, ANGLES)

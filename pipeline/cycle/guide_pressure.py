"""Pressure in both guides over the turn and, where it is greatest, all round the bore."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.pin_in_hole import Conforming, pin_in_hole
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import guide_bodies
from camwright.pipeline.follower.guide_reactions import Guide

ANGLES = 721
"""Angles round the bore, from half a turn before the line of action to half a turn beyond."""

SLICES = 81
"""Slices over the loaded length of a guide."""

_MM, _MPA, _N_PER_MM = 1e3, 1e-6, 1e-3
_KNOTS = 48  # of the pressure on half a contact; its peak is within 1e-3 of that of twice as many
_LOADS, _LEAST = 8, 0.01
_SHARES = np.sin(np.linspace(0.0, 0.5 * np.pi, 65))  # densest where the pressure falls


def guide_arrays(cycles: Sequence[Cycle]) -> Mapping[str, Any]:
    """Arrays of ``5_guides.npz``.

    Returns
    -------
    mapping   load_case (n,) and cam_angle_deg (n,), a row per position of each load case; for
              the guides A and B: A_along_mm (k,) from the middle of the guide, growing away from
              the roller; A_line_N_per_mm (n, k), the guide's push on the stem, positive against
              the side force; A_row the row of the greatest; A_round_deg (m,) from the line of
              action of a positive push; A_pressure_MPa (s, m) in the bore at that row, at
              A_slices_mm (s,) along the part of the guide that is loaded then
    """
    found: dict[str, Any] = {
        "load_case": np.repeat([c.load_case for c in cycles], [c.theta.size for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
    }
    machine = cycles[0].machine
    for side, guide in (("a", machine.guides.a), ("b", machine.guides.b)):
        lines = np.concatenate([getattr(c.guides, f"line_pressure_{side}") for c in cycles], axis=1)
        row = int(np.argmax(np.abs(lines).max(axis=0)))
        knots = getattr(cycles[0].guides, f"knots_{side}")
        slices = loaded_length(knots, lines[:, row])
        pushes = np.interp(slices, knots, lines[:, row])
        name = side.upper()
        found |= {
            f"{name}_along_mm": _MM * knots,
            f"{name}_line_N_per_mm": _N_PER_MM * lines.T,
            f"{name}_row": np.array(row),
            f"{name}_slices_mm": _MM * slices,
            f"{name}_round_deg": np.degrees(_round()),
            f"{name}_pressure_MPa": _MPA * bore_pressure(machine, guide, pushes),
        }
    return found


def loaded_length(knots: Array, line: Array) -> Array:
    """Even places over the knots (k,) that are loaded and those next to them; m."""
    on = np.flatnonzero(line)
    if not on.size:
        return np.linspace(knots[0], knots[-1], SLICES)
    ends = knots[max(on[0] - 1, 0)], knots[min(on[-1] + 1, knots.size - 1)]
    return np.linspace(*ends, SLICES)


def bore_pressure(machine: Machine, guide: Guide, pushes: Array) -> Array:
    """Pressure (k, m), Pa, round the bore under pushes (k,), N/m, of a guide on its stem.

    Each slice of the guide is a pin in a hole of its own; a negative push is that of the other
    side of the bore. Exact at `_LOADS` loads, between them along lines of equal share of the
    contact's angle; far below the greatest as Hertz has it. Not a number where the stem would
    wedge itself into the bore.
    """
    size = np.abs(pushes)
    pressure = np.zeros((pushes.size, ANGLES))
    if not size.any():
        return pressure
    loads = float(size.max()) * np.geomspace(_LEAST, 1.0, _LOADS)
    try:
        solved = [_slice(machine, guide, float(load)) for load in loads]
    except ContactError:
        pressure[size > 0] = np.nan
        return pressure
    half = np.array([one.contact_angle for one in solved])
    shapes = np.stack([_shape(one) for one in solved])
    for k in np.flatnonzero(size):
        at = np.interp(np.log(size[k]), np.log(loads), np.arange(_LOADS))
        low, share = int(at), at % 1.0
        high = min(low + 1, _LOADS - 1)
        light = np.sqrt(min(size[k] / loads[0], 1.0))
        # Both go nearly as powers of the load.
        angle = light * half[low] ** (1 - share) * half[high] ** share
        shape = light * shapes[low] ** (1 - share) * shapes[high] ** share
        away = np.abs(_round()) if pushes[k] > 0 else np.pi - np.abs(_round())
        pressure[k] = np.interp(away / angle, _SHARES, shape, right=0.0)
    return pressure


def _slice(machine: Machine, guide: Guide, load: float) -> Conforming:
    pin, bore = guide_bodies(machine, guide)
    radius, clearance = 0.5 * machine.stem.diameter, 0.5 * guide.clearance
    return pin_in_hole(load, radius, clearance, pin, bore, _KNOTS)


def _shape(found: Conforming) -> Array:
    """Pressure at `_SHARES` of the contact's angle, which ends with no pressure."""
    inside = found.angle < found.contact_angle
    at = np.append(found.angle[inside], found.contact_angle) / found.contact_angle
    return np.interp(_SHARES, at, np.append(found.pressure[inside], 0.0))


def _round() -> Array:
    return np.linspace(-np.pi, np.pi, ANGLES)

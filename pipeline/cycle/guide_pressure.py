"""Line load of both guides, or in the bush of a pivot, over the turn; its bore pressure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.errors import ContactError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.elasticity.radial_compliance import SolidBar
from camwright.pipeline.contact.pin_in_hole import Conforming, pin_in_hole
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import PivotPush, bore_of, guide_bodies
from camwright.pipeline.follower.guide_reactions import Guide

ANGLES = 721
"""Angles around the bore, from -180 to 180 deg about the line of action."""

SLICES = 81
"""Slices over the loaded length of a guide."""

_MM, _MPA, _N_PER_MM = 1e3, 1e-6, 1e-3
_KNOTS = 48  # of the pressure on half a contact; the peak is within 1e-3 of that of 96
_TABLE_LOADS, _LEAST_LOAD = 8, 0.01  # of a table, the least over the greatest
_ANGLE_SHARES = np.sin(np.linspace(0.0, 0.5 * np.pi, 65))  # densest where the pressure falls


GUIDE_ARRAYS = (
    Column("load_case", "", "(n,) load case of each row of `5_cycle.csv`"),
    Column("cam_angle", "deg", "(n,) cam angle of the row"),
    *(
        Column(f"guide_{name}_{what}", unit, meaning)
        for name in "AB"
        for what, unit, meaning in (
            ("position", "mm", "(k,) from the middle of the guide, away from the roller"),
            ("line_load", "N/mm", "(n, k) on the stem there, positive against the side force"),
            ("worst_row", "", "row of the maximum line load"),
            ("slice_position", "mm", "(s,) along the loaded part of the guide in that row"),
            ("bore_angle", "deg", "(m,) from the line of action of a positive line load"),
            ("bore_pressure", "MPa", "(s, m) in the bore in that row"),
        )
    ),
)
"""Arrays of ``5_guides.npz``."""


def guide_arrays(cycles: Sequence[Cycle]) -> Mapping[str, ArrayLike]:
    """Arrays of ``5_guides.npz``.

    Returns
    -------
    mapping   by the headers of `GUIDE_ARRAYS`
    """
    arrays: dict[str, ArrayLike] = {
        "load_case": np.repeat([c.load_case for c in cycles], [c.theta.size for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
    }
    machine = cycles[0].machine
    for side, guide in (("a", machine.guides.a), ("b", machine.guides.b)):
        lines = np.concatenate([getattr(c.guides, f"line_pressure_{side}") for c in cycles], axis=1)
        row = first_greatest(np.abs(lines).max(axis=0))
        knots = getattr(cycles[0].guides, f"knots_{side}")
        slices = loaded_length(knots, lines[:, row])
        loads = np.interp(slices, knots, lines[:, row])
        name = f"guide_{side.upper()}"
        arrays |= {
            f"{name}_position_mm": _MM * knots,
            f"{name}_line_load_N_per_mm": _N_PER_MM * lines.T,
            f"{name}_worst_row": np.array(row),
            f"{name}_slice_position_mm": _MM * slices,
            f"{name}_bore_angle_deg": np.degrees(_round()),
            f"{name}_bore_pressure_MPa": _MPA * bore_pressure(machine, guide, loads),
        }
    return arrays


PIVOT_ARRAYS = (
    *GUIDE_ARRAYS[:2],
    Column("position", "mm", "(k,) from the middle of the bush, towards the end that is pressed"),
    Column("line_load", "N/mm", "(n, k) on the pin there, negative on its other side"),
    Column("worst_row", "", "row of the maximum line load; by finite elements of the pressure"),
    Column(
        "bore_angle",
        "deg",
        "(m,) from the line of action of the line load; by finite elements from the plane of the"
        " couple",
    ),
    Column("bore_pressure", "MPa", "(k, m) in the bore in that row"),
)
"""Arrays of ``5_pivot.npz``."""


def pivot_arrays(cycles: Sequence[Cycle]) -> Mapping[str, ArrayLike] | None:
    """Arrays of ``5_pivot.npz`` by the headers of `PIVOT_ARRAYS`; None without a bush.

    By finite elements where every cycle has them; else each slice of the bush is an independent pin
    in a hole.
    """
    turned = {
        "load_case": np.repeat([c.load_case for c in cycles], [c.theta.size for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
    }
    solved = [each.pivot for each in cycles if each.pivot is not None]
    if len(solved) == len(cycles):
        index = first_greatest([each.edge_pressure.max() for each in solved])
        worst = solved[index]
        row = worst.worst + sum(each.tilt.size for each in solved[:index])
        places = np.linspace(worst.places[0], worst.places[-1], SLICES)
        along = np.stack(
            [np.interp(places, worst.places, hat) for hat in np.eye(worst.places.size)]
        )
        around = [
            np.interp(_round(), worst.angles, each, period=FULL_TURN) for each in worst.pressure.T
        ]
        return turned | {
            "position_mm": _MM * places,
            "line_load_N_per_mm": _N_PER_MM
            * np.concatenate([each.line for each in solved])
            @ along,
            "worst_row": np.array(row),
            "bore_angle_deg": np.degrees(_round()),
            "bore_pressure_MPa": _MPA * along.T @ np.array(around),
        }
    pushes = [PivotPush.of(c.machine, c.loads, c.follower_moment) for c in cycles]
    pressed = [each for each in pushes if each is not None]
    if not pressed:
        return None
    bush, pin = pressed[0].bush, pressed[0].pin
    places = 0.5 * bush.length * np.linspace(-1.0, 1.0, SLICES)
    lines = np.concatenate([each.lines(places) for each in pressed], axis=1)
    row = first_greatest(np.abs(lines).max(axis=0))
    return turned | {
        "position_mm": _MM * places,
        "line_load_N_per_mm": _N_PER_MM * lines.T,
        "worst_row": np.array(row),
        "bore_angle_deg": np.degrees(_round()),
        "bore_pressure_MPa": _MPA * _around(pin, bush.diameter, bush, lines[:, row]),
    }


def loaded_length(knots: Array, line: Array) -> Array:
    """Evenly spaced positions (SLICES,), m, over the loaded knots of a guide and their neighbours;
    over all knots without load.

    Parameters
    ----------
    knots : array (k,)   positions along the guide, m, ascending
    line : array (k,)    line load at the knots, N/m
    """
    on = np.flatnonzero(line)
    if not on.size:
        return np.linspace(knots[0], knots[-1], SLICES)
    ends = knots[max(on[0] - 1, 0)], knots[min(on[-1] + 1, knots.size - 1)]
    return np.linspace(*ends, SLICES)


def bore_pressure(machine: Machine, guide: Guide, line_load: Array) -> Array:
    """Pressure (k, m), Pa, of the stem around a guide's bore under line loads (k,), N/m."""
    return _around(guide_bodies(machine, guide)[0], machine.stem.diameter, guide, line_load)


def _around(pin: SolidBar, diameter: float, guide: Guide, line_load: Array) -> Array:
    """Pressure (k, m), Pa, of a pin of a diameter, m, around a bore under line loads (k,), N/m.

    Each slice of the guide is an independent pin in a hole; a negative load acts on the other side
    of the bore. Solved at `_TABLE_LOADS` loads, interpolated between them at equal shares of the
    contact angle, and scaled as a Hertz contact below the least of them. NaN where the pin in the
    hole has no solution.
    """
    size = np.abs(line_load)
    pressure = np.zeros((line_load.size, ANGLES))
    if not size.any():
        return pressure
    loads = float(size.max()) * np.geomspace(_LEAST_LOAD, 1.0, _TABLE_LOADS)
    try:
        solved = [_slice(pin, diameter, guide, float(load)) for load in loads]
    except ContactError:
        pressure[size > 0] = np.nan
        return pressure
    half = np.array([one.contact_angle for one in solved])
    shapes = np.stack([_shape(one) for one in solved])
    for k in np.flatnonzero(size):
        at = np.interp(np.log(size[k]), np.log(loads), np.arange(_TABLE_LOADS))
        low, share = int(at), at % 1.0
        high = min(low + 1, _TABLE_LOADS - 1)
        light = np.sqrt(min(size[k] / loads[0], 1.0))
        # Both are nearly powers of the load.
        angle = light * half[low] ** (1 - share) * half[high] ** share
        shape = light * shapes[low] ** (1 - share) * shapes[high] ** share
        away = np.abs(_round()) if line_load[k] > 0 else np.pi - np.abs(_round())
        pressure[k] = np.interp(away / angle, _ANGLE_SHARES, shape, right=0.0)
    return pressure


def _slice(pin: SolidBar, diameter: float, guide: Guide, load: float) -> Conforming:
    """Pressure of a pin of a diameter, m, in the bore of a guide at a line load, N/m."""
    return pin_in_hole(load, 0.5 * diameter, 0.5 * guide.clearance, pin, bore_of(guide), _KNOTS)


def _shape(contact: Conforming) -> Array:
    """Pressure at `_ANGLE_SHARES` of the contact angle; zero at its end."""
    inside = contact.angle < contact.contact_angle
    at = np.append(contact.angle[inside], contact.contact_angle) / contact.contact_angle
    return np.interp(_ANGLE_SHARES, at, np.append(contact.pressure[inside], 0.0))


def _round() -> Array:
    return np.linspace(-np.pi, np.pi, ANGLES)

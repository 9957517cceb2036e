"""What each limit costs: multipliers of a synthesis as ripple per newton, degree, megapascal."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from pipeline.smoothing.design import RESERVE, Design, Problem
from pipeline.smoothing.scenario import Machine, Ratings

BINDING = 2e-3  # below the reserve by less than this share of a limit: it binds


class Unit(NamedTuple):
    """How a limit is spoken of: its name, its value as shown, the unit."""

    words: str
    limit: float
    unit: str


def named_limits(ratings: Ratings, machine: Machine) -> dict[str, Unit]:
    """The limits of a synthesis in the units of a drawing."""
    found: dict[str, Unit] = {}

    def put(name: str, words: str, value: float | None, scale: float, unit: str) -> None:
        if value is not None:
            found[name] = Unit(words, float(value) * scale, unit)

    put("spring_travel", "spring travel", ratings.travel, 1e3, "mm")
    if ratings.pressure_angle is not None:
        put("pressure_angle", "pressure angle", np.degrees(ratings.pressure_angle), 1.0, "deg")
    put("jam_index", "jam index", ratings.jam_index, 1.0, "-")
    put("concave_radius", "radius of the tool's hollow", ratings.hollow_radius, 1e3, "mm")
    put("contact_pressure", "contact pressure", ratings.pressure, 1e-6, "MPa")
    put("roller_static", "roller rating", ratings.normal_force, 1.0, "N")
    for place, side in enumerate("AB"):
        pressure, product = ratings.bush_pressure[place], ratings.bush_pv[place]
        put(f"bush_pressure_{side}", f"pressure in guide {side}", pressure, 1e-6, "MPa")
        put(f"bush_pv_{side}", f"PV of guide {side}", product, 1e-6, "MPa m/s")
    if ratings.life_force_cubed is not None:
        put("roller_life", "share of the roller's life load", 1.0, 1.0, "-")
    put("contact_force_margin", "least contact force", machine.preload, 1.0, "N")
    return found


def prices(design: Design, problem: Problem) -> list[dict[str, Any]]:
    """One record for each limit that costs ripple, the dearest first.

    The price is the crank-torque ripple (std, N m) that one more unit of the limit would take
    away, to first order; where it binds is given as ranges of cam angle.

    Parameters
    ----------
    design : Design     with its multipliers
    problem : Problem   it answers
    """
    units = named_limits(problem.ratings, design.machine)
    before = max(float(np.std(item.torque)) for item in problem.scenarios if item.weight > 0)
    found = []
    for name, multiplier in design.multipliers.items():
        words, limit, unit = units.get(name, Unit(name.replace("_", " "), 1.0, "-"))
        slope = _slope(name, limit, problem.ratings)
        price = multiplier * before * slope
        found.append(
            {
                "limit": name,
                "value": limit,
                "unit": unit,
                "ripple_per_unit_Nm": price,
                "ripple_per_percent_Nm": multiplier * before / 100.0,
                "binds_at_deg": _ranges(*design.strip[name]) if name in design.strip else [],
                "sentence": _sentence(words, limit, unit, price),
            }
        )
    return sorted(found, key=lambda record: -record["ripple_per_percent_Nm"])


def _slope(name: str, limit: float, ratings: Ratings) -> float:
    """By how much the utilisation falls for one more unit of the limit."""
    if name == "contact_pressure":
        # only the share N / F_lim falls, with the square; at the limit it is 1 - r kappa
        return 2.0 / limit
    if name == "concave_radius" and ratings.hollow_radius is not None:
        return -1e-3 / (ratings.hollow_radius - ratings.roller_radius)
    return 1.0 / limit


def _sentence(words: str, limit: float, unit: str, price: float) -> str:
    shown = "" if unit == "-" else f" {unit}"
    one = f"one more{shown}" if shown else "one unit more"
    return f"{words} of {limit:.4g}{shown}: {one} changes the ripple by {-price:.3g} N m"


def _ranges(theta: Any, use: Any) -> list[tuple[float, float]]:
    """Where a limit binds, as ranges of cam angle, deg."""
    tight = np.asarray(use) >= 1.0 - RESERVE - BINDING
    if not tight.any():
        return []
    degrees = np.degrees(theta)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], tight.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(round(float(degrees[a]), 3), round(float(degrees[b]), 3)) for a, b in pairs]

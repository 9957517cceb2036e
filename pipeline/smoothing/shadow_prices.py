"""Shadow prices: change of the torque ripple per unit of a bound."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.smoothing.bounds import Bound, bounds_of
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem

BINDING = 2e-3  # of a limit: a constraint this near to its reserve is active


class PriceRecord(TypedDict):
    """JSON record of a shadow price."""

    limit: str
    words: str
    value: float
    unit: str
    ripple_per_unit_Nm: float
    ripple_per_percent_Nm: float
    binds_at_deg: list[tuple[float, float]]
    sentence: str


def prices(design: Design, problem: Problem) -> list[PriceRecord]:
    """Shadow prices of the active limits, highest first.

    The price is the decrease of the crank-torque ripple (std, N m) per unit of the limit, to
    first order: the multiplier times the slope of the utilisation. Of the utilisation of the
    contact pressure, r kappa + N/F_lim, only the second part depends on the limit, by its square;
    its mean over the active angles is taken. A mean over the turn has no active angles.

    Parameters
    ----------
    design : Design     with its multipliers
    problem : Problem   of the design

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 9.1: multipliers as sensitivities.
    """
    bounds = bounds_of(problem.ratings)
    before = max(float(np.std(item.torque)) for item in problem.scenarios if item.weight > 0)
    records: list[PriceRecord] = []
    for name, multiplier in design.multipliers.items():
        known = bounds.get(name, Bound(name.replace("_", " "), 1.0, "-", 1.0))
        slope = known.slope
        if name == "contact_pressure":
            slope *= 2.0 * _load_share(design, problem)
        price = multiplier * before * slope
        records.append(
            {
                "limit": name,
                "words": known.words,
                "value": known.value,
                "unit": known.unit,
                "ripple_per_unit_Nm": price,
                "ripple_per_percent_Nm": multiplier * before / 100.0,
                "binds_at_deg": _ranges_record(*design.strip[name]) if name in design.strip else [],
                "sentence": _sentence(known, price),
            }
        )
    return sorted(records, key=lambda record: -record["ripple_per_percent_Nm"])


def limits_in_use(design: Design) -> tuple[Array, dict[str, Array]]:
    """Cam angles (n,), rad, ascending, and the utilisation of each limit at them, by check.

    The greatest first. A limit on a mean over the turn has the same utilisation at every angle.
    """
    theta = next(iter(design.strip.values()))[0]
    angles = np.mod(theta + float(design.variables.phase), FULL_TURN)
    order = np.argsort(angles, kind="stable")
    names = sorted(design.strip, key=lambda name: -float(np.max(design.strip[name][1])))
    uses = {name: np.asarray(design.strip[name][1])[order] for name in names}
    return angles[order], uses


def _load_share(design: Design, problem: Problem) -> float:
    """N / F_lim of the contact pressure, mean over the active angles."""
    theta, use = design.strip["contact_pressure"]
    binds = _binding(use)
    if not binds.any():
        return 1.0
    pitch = PitchCurve(design.lift(), float(design.variables.prime_radius), problem.ratings.offset)
    bend = problem.ratings.roller_radius * pitch.curvature(theta[binds])
    return float(np.mean(np.asarray(use)[binds] - bend))


def _sentence(known: Bound, price: float) -> str:
    shown = "" if known.unit == "-" else f" {known.unit}"
    if price < 0.0:
        one = f"one{shown} less" if shown else "one less"
    else:
        one = f"one more{shown}" if shown else "one unit more"
    off = f"takes {abs(price):.3g} N m off the ripple"
    return f"{known.words} of {known.value:.4g}{shown}: {one} {off}"


def _binding(use: Array) -> NDArray[np.bool_]:
    return np.asarray(np.asarray(use) >= 1.0 - RESERVE - BINDING)


def _ranges_record(theta: Array, use: Array) -> list[tuple[float, float]]:
    """Active ranges of cam angle, deg."""
    tight = _binding(use)
    if not tight.any() or np.ptp(use) == 0.0:
        return []
    degrees = np.degrees(theta)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], tight.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(round(float(degrees[a]), 3), round(float(degrees[b]), 3)) for a, b in pairs]

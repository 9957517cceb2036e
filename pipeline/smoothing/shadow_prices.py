"""What each limit costs: multipliers of a synthesis as ripple per newton, degree, megapascal."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.smoothing.scenario import Ratings
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem

BINDING = 2e-3  # below the reserve by less than this share of a limit: it binds
_RPM = 30.0 / np.pi
_PRESSURES = {
    "contact_pressure": "endurance of the contact",
    "edge_pressure": "endurance at the roller's ends",
    "contact_pressure_at_life": "endurance at the target life",
    "shakedown": "shakedown pressure",
    "shakedown_traction": "shakedown pressure under sliding",
}


class Unit(NamedTuple):
    """A limit as it is spoken of, and by how much its utilisation falls for one more unit."""

    words: str
    limit: float
    unit: str
    slope: float


def named_limits(ratings: Ratings) -> dict[str, Unit]:
    """The limits of a synthesis in the units of a drawing.

    The slope is the derivative of demand over limit where that is 1, sign turned: 1/limit for
    most. A larger tool, a larger curvature ratio or a larger margin takes room away: below zero.
    That of the contact pressure is for a limit of which all is load; see `prices`.
    """
    found: dict[str, Unit] = {}

    def put(name: str, words: str, value: float | None, scale: float, unit: str) -> None:
        if value is not None:
            found[name] = Unit(words, value * scale, unit, 1.0 / (value * scale))

    put("spring_travel", "spring travel", ratings.travel, 1e3, "mm")
    put("pressure_angle", "pressure angle", ratings.pressure_angle, 180.0 / np.pi, "deg")
    put("jam_index", "jam index", ratings.jam_index, 1.0, "-")
    put("jam_at_worst_friction", "jam index at the greatest friction", ratings.jam_index, 1.0, "-")
    put("curvature_rate", "change of curvature", ratings.curvature_rate, 1e-6, "1/(mm rad)")
    put("cam_envelope", "room for the cam, its radius", ratings.cam_radius, 1e3, "mm")
    put("contact_pressure", _PRESSURES.get(ratings.pressure_by, "contact pressure"),
        ratings.pressure, 1e-6, "MPa")  # fmt: skip
    put("jump", "inertia over spring force", ratings.jump, 1.0, "-")
    put("roller_speed", "speed of the roller", ratings.roller_spin, _RPM, "rpm")
    static = "static rating of the roller"
    words = static if ratings.normal_force_by == "roller_static" else "load its outer ring bears"
    put("roller_static", words, ratings.normal_force, ratings.force_safety, "N")
    if ratings.life_force_cubed is not None:
        put("roller_life", "dynamic rating of the roller", ratings.dynamic_rating, 1.0, "N")
    for place, side in enumerate("AB"):
        pressure, product = ratings.bush_pressure[place], ratings.bush_pv[place]
        put(f"bush_pressure_{side}", f"pressure in guide {side}", pressure, 1e-6, "MPa")
        put(f"bush_pv_{side}", f"PV of guide {side}", product, 1e-6, "MPa m/s")
    return found | _taking_room(ratings)


def _taking_room(ratings: Ratings) -> dict[str, Unit]:
    """Limits that leave the less room the greater they are."""
    found: dict[str, Unit] = {}
    hollow, ratio, factor = ratings.hollow_radius, ratings.curvature_ratio, ratings.undercut_factor
    if hollow is not None and hollow > ratings.roller_radius:
        # -kappa (a R_tool - r) <= 1
        slope = -1e-3 * TOOL_ALLOWANCE / (hollow - ratings.roller_radius)
        words = "radius of the tool for the hollow"
        found["concave_radius"] = Unit(words, 1e3 * hollow / TOOL_ALLOWANCE, "mm", slope)
    if ratio is not None:
        found["curvature_ratio"] = Unit("pitch radius over roller radius", ratio, "-", -1.0 / ratio)
    if factor is not None:
        found["undercut"] = Unit("undercut factor", factor, "-", -1.0 / (1.0 - factor))
    if ratings.jump_speed is not None:
        # m w^2 s'' over the spring force: it grows with the square of the speed
        speed = ratings.jump_speed * _RPM
        words = "cam speed without a jump"
        found["jump_speed"] = Unit(words, speed, "rpm", -2.0 / speed)
    margin = ratings.contact_force_margin
    if margin is not None:
        words = "least contact force over preload"
        found["contact_force_margin"] = Unit(words, margin, "-", -1.0)
        found["contact_at_overspeed"] = Unit(f"{words} at over-speed", margin, "-", -1.0)
    return found


def prices(design: Design, problem: Problem) -> list[dict[str, Any]]:
    """One record for each limit that costs ripple, the dearest first.

    The price is the crank-torque ripple (std, N m) that one more unit of the limit would take
    away, to first order: the multiplier times what a unit takes off the utilisation. Of the
    contact's utilisation r kappa + N/F_lim only the second part falls with the pressure allowed,
    by its square; it is taken as it is on the mean where the limit binds. Where a limit binds is
    given as ranges of cam angle; a mean over the turn binds everywhere and nowhere.

    Parameters
    ----------
    design : Design     with its multipliers
    problem : Problem   it answers

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 9.1: multipliers as sensitivities.
    """
    units = named_limits(problem.ratings)
    before = max(float(np.std(item.torque)) for item in problem.scenarios if item.weight > 0)
    found = []
    for name, multiplier in design.multipliers.items():
        known = units.get(name, Unit(name.replace("_", " "), 1.0, "-", 1.0))
        slope = known.slope
        if name == "contact_pressure":
            slope *= 2.0 * _load_share(design, problem)
        price = multiplier * before * slope
        found.append(
            {
                "limit": name,
                "words": known.words,
                "value": known.limit,
                "unit": known.unit,
                "ripple_per_unit_Nm": price,
                "ripple_per_percent_Nm": multiplier * before / 100.0,
                "binds_at_deg": _ranges(*design.strip[name]) if name in design.strip else [],
                "sentence": _sentence(known, price),
            }
        )
    return sorted(found, key=lambda record: -record["ripple_per_percent_Nm"])


def limits_in_use(design: Design) -> tuple[Array, dict[str, Array]]:
    """Cam angles (n,), rad, rising, and the share in use of each limit at them, by its name.

    The most used first. A limit on a mean of the turn has the same share at every angle.
    """
    theta = next(iter(design.strip.values()))[0]
    angles = np.mod(theta + float(design.machine.phase), FULL_TURN)
    order = np.argsort(angles, kind="stable")
    names = sorted(design.strip, key=lambda name: -float(np.max(design.strip[name][1])))
    uses = {name: np.asarray(design.strip[name][1])[order] for name in names}
    return angles[order], uses


def _load_share(design: Design, problem: Problem) -> float:
    """N / F_lim of the contact's utilisation, on the mean where it binds."""
    theta, use = design.strip["contact_pressure"]
    binds = _binding(use)
    if not binds.any():
        return 1.0
    pitch = PitchCurve(design.lift(), float(design.machine.prime_radius), problem.ratings.offset)
    bend = problem.ratings.roller_radius * pitch.curvature(theta[binds])
    return float(np.mean(np.asarray(use)[binds] - bend))


def _sentence(known: Unit, price: float) -> str:
    shown = "" if known.unit == "-" else f" {known.unit}"
    if price < 0.0:
        one = f"one{shown} less" if shown else "one less"
    else:
        one = f"one more{shown}" if shown else "one unit more"
    off = f"takes {abs(price):.3g} N m off the ripple"
    return f"{known.words} of {known.limit:.4g}{shown}: {one} {off}"


def _binding(use: Array) -> NDArray[np.bool_]:
    return np.asarray(np.asarray(use) >= 1.0 - RESERVE - BINDING)


def _ranges(theta: Array, use: Array) -> list[tuple[float, float]]:
    """Where a limit binds, as ranges of cam angle, deg."""
    tight = _binding(use)
    if not tight.any() or np.ptp(use) == 0.0:
        return []
    degrees = np.degrees(theta)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], tight.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(round(float(degrees[a]), 3), round(float(degrees[b]), 3)) for a, b in pairs]

"""Checks of coil springs: strength, fatigue, solid length, buckling, surge, relaxation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SOLID, SPRING_SURGE
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    NONE,
    SPEED_RANGE,
    STATED,
    Allowed,
    Demand,
    Kept,
    check,
    of_key,
)
from camwright.pipeline.checks.demands import FatiguePoint
from camwright.pipeline.checks.extremes import Extreme, Measure
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam, wire_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.speed_sweep import SpringSweep
from camwright.pipeline.follower.spring import (
    BUCKLING,
    COIL_GAP,
    FATIGUE,
    RELAXATION,
    SOLID,
    SOLID_STRESS,
    STRESS,
    HelicalSpring,
    WireLimit,
    end_travel,
    surge_harmonics,
)
from camwright.pipeline.follower.wound_wire import ZIMMERLI, SpringWork

HARDEST = "preload and rate high"
STABLE = "stable at any deflection"


_HIGH = "spring_preload (1 + spring.preload_tolerance)"
_STIFF = "spring.design.rate (1 + spring.rate_tolerance)"
_SOLID_LENGTH = "spring.design.wire_diameter (spring.design.coils + 2) [mm]"
_WIRE = {
    "R_m": "spring.design.strength_at_1mm"
    " (1000 spring.design.wire_diameter)^(-spring.design.strength_exponent) [MPa]",
    "D": "spring.design.mean_diameter",
    "d": "spring.design.wire_diameter",
    "C": "[-]",
    "K_w": "[-]",
}
_WAHL = "K_w = (4 C - 1)/(4 C - 4) + 0.615/C: Wahl factor, C = D/d"
"""Preload high, rate high, solid length, wire and Wahl factor in the symbols of a formula."""


def _design(solution: Solution) -> HelicalSpring:
    """Wound spring of the machine; InputError where it has none."""
    design = solution.machine.spring.design
    if design is None:
        raise InputError("spring.design", "missing", "given for the checks of the spring")
    return design


def _measure(
    limit: WireLimit, work: Callable[[LoadedCam], SpringWork[Value]] = lambda cam: cam.hardest
) -> Measure:
    """Demand of a limit of the wire up to the lift; work: of the loaded cam."""

    def demand(cam: LoadedCam) -> Array:
        return np.asarray(limit.demand(cam.wire, work(cam)))

    return demand


def _allowed(limit: WireLimit) -> Callable[[Numbers], Allowed]:
    """Function for the limit that the wire of a spring sets, SI."""
    by_wire = limit.allowed
    if by_wire is None:
        raise InputError(limit.words, "no limit", "set by the wire")
    return lambda numbers: Allowed(by_wire(wire_of(numbers)))


def _of_wire(demand: Demand, solution: Solution) -> Demand:
    """With the source of the wire; of the hardest spring in tolerance."""
    return replace(demand, figures=(_design(solution).source,), corner=HARDEST)


def _at_rest(demand: Demand, solution: Solution) -> Demand:
    return replace(_of_wire(demand, solution), note="without surge")


def _stable(demand: Demand, solution: Solution) -> Demand:
    """Demand with the modulus of the wire, and a note where the spring is stable at any
    deflection.
    """
    design = _design(solution)
    note = STABLE if np.isinf(design.buckling_deflection) else ""
    stated = {"E": design.known_modulus}
    return replace(_of_wire(demand, solution), note=note, stated=stated)


def _surge_over_speed(demand: Demand, solution: Solution) -> Demand:
    """Demand with a note on the harmonics that the surge meets and the greatest force that it
    adds.
    """
    design, lift = _design(solution), solution.contour.pitch.lift.values
    travel = np.asarray(end_travel(solution.machine.spring.shape, lift))
    highest, margin = surge_harmonics(travel, demand.value or 0.0)
    sweeps = solution.speed_sweeps
    sweep = sweeps[first_greatest([each.surge_force.max() for each in sweeps])]
    added = float(sweep.surge_force.max())
    speed = float(sweep.crank_speed[first_greatest(sweep.surge_force)])
    note = (
        f"highest harmonic of at least 1 % of the acceleration: {highest}; surge lies"
        f" {margin:.2f} times above it and adds up to {shown(added, 'N', 3)} at"
        f" {shown(speed, 'rpm', 4)} of the machine with a damping ratio of"
        f" {design.damping:g}"
    )
    return replace(demand, note=note)


class OverSpeed(NamedTuple):
    """Greatest value over the speed, its value at least surge damping, and its speed.

    low, high: least and greatest force, N, at the end of the spring with that value
    """

    value: float
    least_damped: float
    words: str
    low: float
    high: float


def _over_speed(solution: Solution, use: Callable[[SpringSweep], Array]) -> OverSpeed:
    """Greatest over both ends of the spring and all speeds of `use`, a function of the sweep for
    values (2, m); NaN without a wound spring.
    """
    sweep, damped = solution.hardest_spring, solution.least_damped
    if sweep is None:
        return OverSpeed(np.nan, np.nan, "", np.nan, np.nan)
    of_ends = use(sweep)
    values = np.max(of_ends, axis=0)
    k = first_greatest(values)  # the first NaN, where there is one
    end = first_greatest(of_ends[:, k])
    value, further = float(values[k]), None if damped is None else damped.hardest_spring
    most = value if further is None else max(float(np.max(use(further))), value)
    words = f"at {shown(float(sweep.crank_speed[k]), 'rpm', 4)} of the machine"
    return OverSpeed(value, most, words, float(sweep.least[end, k]), float(sweep.greatest[end, k]))


def _stress_over_speed(solution: Solution) -> Demand:
    """Greatest shear stress of the wire with surge over its static strength, over the speed
    range.
    """
    design = _design(solution)
    worst = _over_speed(solution, lambda sweep: design.static_use(sweep.greatest))
    share = worst.least_damped / worst.value - 1.0
    at = Extreme(worst.value, error_share=share)
    stated = {"F": worst.high}
    return _of_wire(Demand(worst.value, 1.0, at, note=worst.words, stated=stated), solution)


def _fatigue_over_speed(solution: Solution) -> Demand:
    """Least fatigue safety of the wire with surge over the speed range."""
    design = _design(solution)
    worst = _over_speed(solution, lambda sweep: design.fatigue_use(sweep.least, sweep.greatest))
    safety = 1.0 / worst.value  # of a preload above zero
    share = 0.0 if safety == 0.0 else 1.0 - worst.value / worst.least_damped
    allowed = solution.machine.limits[SPRING_FATIGUE]
    at = Extreme(safety, error_share=share)
    amplitude, mean = ZIMMERLI[design.treatment]
    stated = {"F_1": worst.low, "F_2": worst.high, "s_a": amplitude, "s_m": mean}
    return _of_wire(Demand(safety, allowed, at, note=worst.words, stated=stated), solution)


spring_stress = check(
    id="spring_stress",
    title="Spring shear stress / static strength",
    unit="-",
    source=Source(
        "0.56 R_m, which EN 13906-1:2013, read second-hand, permits the uncorrected stress at solid"
        " length; here it bounds the corrected stress, which is safer",
        confirmed=False,
    ),
    method="Wahl factor, greatest force at either end of the spring over the speed range, surge"
    " included",
    lift_can_help=True,
    fails_from=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="tau / (0.56 R_m) <= 1; tau = K_w 8 D F / (pi d^3), F: greatest force in the coils"
    " from standstill to over-speed with preload and rate high, resonances of any rate in tolerance"
    f" included, {_WAHL}, R_m: tensile strength of the wire",
    symbols={**_WIRE, "F": f"{STATED} [N]", "tau": "[MPa]"},
    reason="A spring beyond its yield strength sets and loses the preload that keeps the"
    " follower on the cam.",
    load_cases=SPEED_RANGE,
    rests_on="loads",
    values=(*given.SPRING, *given.SURGE, *given.WIRE, "limits.overspeed"),
    levers=(levers.one("spring.design.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    allowed=_allowed(STRESS),
    remark=_at_rest,
    solved=_stress_over_speed,
    deviation=0.1,
    kept=Kept(),
)(_measure(STRESS, lambda cam: cam.stressed))


spring_fatigue = check(
    SPRING_FATIGUE,
    id="spring_fatigue",
    title="Fatigue safety factor of the spring",
    method="Wahl factor, range of force at either end of the spring over the speed range, surge"
    " included",
    lift_can_help=True,
    fails_from=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="1 / (tau_a / S_e + tau_m / S_su) >= limits.spring_fatigue; tau_a = K_w 4 D (F_2 - F_1)"
    " / (pi d^3), tau_m = K_w 4 D max(F_2 + F_1, 0) / (pi d^3): amplitude and mean, F_1, F_2: least"
    " and greatest force at the end of the spring with the greater use, over all speeds from"
    f" standstill to over-speed, {_WAHL}, S_e = s_a / (1 - s_m / S_su): endurance by Zimmerli's"
    " point, s_a, s_m: its amplitude and mean, S_su = 0.67 R_m: shear strength, R_m: tensile"
    " strength of the wire",
    symbols={
        **_WIRE,
        **dict.fromkeys(("F_1", "F_2"), f"{STATED} [N]"),
        **dict.fromkeys(("s_a", "s_m"), f"{STATED} [MPa]"),
        **dict.fromkeys(("tau_a", "tau_m", "S_e", "S_su"), "[MPa]"),
    },
    reason="A broken spring releases the follower.",
    load_cases=SPEED_RANGE,
    rests_on="loads",
    values=(*given.SPRING, *given.SURGE, *given.WIRE, "limits.overspeed"),
    levers=(levers.one("spring.design.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    value=lambda worst, _: 1.0 / worst,
    bound=lambda limit, _: 1.0 / limit,
    remark=_at_rest,
    solved=_fatigue_over_speed,
    deviation=0.1,
    kept=Kept(),
)(_measure(FATIGUE, lambda cam: cam.fatigued))


def spring_fatigue_points(solution: Solution) -> list[FatiguePoint]:
    """Stress amplitude and mean of the wire, Pa, at its worst speed, for the Goodman diagram; empty
    without a wound spring, and where a force is not known or the wire has no endurance.
    """
    design, sweep = solution.machine.spring.design, solution.hardest_spring
    if design is None or sweep is None or not np.isfinite(sweep.greatest).all():
        return []
    amplitude, mean = design.fatigue_stress(sweep.least, sweep.greatest)
    use = design.fatigue_use(sweep.least, sweep.greatest)
    worst = np.unravel_index(first_greatest(use.ravel()), amplitude.shape)
    endurance, strength = design.fatigue_strengths
    if not endurance > 0.0:
        return []
    return [FatiguePoint("wire", float(amplitude[worst]), float(mean[worst]), endurance, strength)]


spring_solid = check(
    SPRING_SOLID,
    id="spring_solid",
    title="Spring solid-height clearance",
    method="free length less solid length less deflection at maximum lift, over that deflection",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="(L0 - Lc - s_max) / s_max >= limits.spring_solid; L0, Lc: free and solid length,"
    " s_max = P/k + h: deflection at maximum lift, preload P high, h: travel of the ends",
    symbols={
        "L0": "spring.design.free_length",
        "Lc": _SOLID_LENGTH,
        "P": f"{_HIGH} [N]",
        "k": "spring.design.rate [N/mm]",
        "h": "spring_travel_highest",
        "s_max": "[mm]",
    },
    reason="A spring that goes solid stops the follower.",
    load_cases=NONE,
    values=(*given.SPRING, *given.RATE),
    levers=(
        levers.one("spring.design.free_length", most=2.0),
        *levers.GENTLER,
    ),
    page="Spring",
).measured(
    "top",
    remark=_of_wire,
    deviation=1e-4,
    kept=Kept(),
)(_measure(SOLID))
spring_coil_gap = check(
    id="spring_coil_gap",
    title="Sum of the gaps between the coils at maximum lift",
    sense="at_least",
    unit="mm",
    source=Source(
        "1.5 S_a, dynamic load, cold coiled, EN 13906-1:2013, 9.9, read second-hand",
        confirmed=False,
    ),
    method="free length less solid length less deflection at maximum lift",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="L0 - Lc - s_max >= 1.5 n (0.0015 D^2/d + 0.1 d); L0, Lc: free and solid length, s_max:"
    " deflection at maximum lift with the preload high, n: active coils, D: mean diameter, d: wire",
    symbols={
        "L0": "spring.design.free_length",
        "Lc": _SOLID_LENGTH,
        "s_max": f"{_HIGH}/spring.design.rate + spring_travel_highest [mm]",
        "n": "spring.design.coils",
        "D": "spring.design.mean_diameter",
        "d": "spring.design.wire_diameter",
    },
    reason="Below it coils touch before the solid length, the rate rises and the wire wears.",
    load_cases=NONE,
    values=(*given.SPRING, *given.RATE),
    levers=(
        levers.one("spring.design.free_length", most=2.0),
        *levers.GENTLER,
    ),
    page="Spring",
).measured(
    "top",
    allowed=_allowed(COIL_GAP),
    remark=_of_wire,
    deviation=1e-4,
    kept=Kept(),
)(_measure(COIL_GAP))
spring_solid_stress = check(
    id="spring_solid_stress",
    title="Shear stress of the spring at its solid length",
    unit="MPa",
    source=Source(
        "0.56 R_m, uncorrected stress at solid length, cold coiled, EN 13906-1:2013, read"
        " second-hand",
        confirmed=False,
    ),
    method="rate times free less solid length, without correction factor, rate high",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="tau_c = 8 D F_c / (pi d^3) <= 0.56 R_m; F_c = k (L0 - Lc): force at solid length with"
    " the rate high, R_m: tensile strength of the wire",
    symbols={
        "k": f"{_STIFF} [N/mm]",
        "F_c": "[N]",
        "L0": "spring.design.free_length",
        "Lc": _SOLID_LENGTH,
        "D": "spring.design.mean_diameter",
        "d": "spring.design.wire_diameter",
        "R_m": _WIRE["R_m"],
    },
    reason="A spring is pressed solid when it is coiled, mounted and over-run, and sets"
    " beyond this stress.",
    load_cases=NONE,
    values=(*given.SPRING, *given.RATE, *given.WIRE),
    levers=(levers.one("spring.design.free_length", -1, 2.0),),
    page="Spring",
).measured(
    "case",
    allowed=_allowed(SOLID_STRESS),
    remark=_of_wire,
    deviation=1e-4,
)(_measure(SOLID_STRESS))
spring_buckling = check(
    id="spring_buckling",
    unit="-",
    title="Spring deflection / buckling deflection",
    source=Source(
        "EN 13906-1:2013, after Haringx, formula and seatings read second-hand", confirmed=False
    ),
    method="deflection at maximum lift over s_K with the seating coefficient"
    " spring.design.end_factor; 0: stable at any deflection",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="step(1 - x) s_max / s_K <= 1; s_K = L0 / (2 (1 - G/E)) (1 - sqrt(max(1 - x, 0))): of"
    " buckling, x = (1 - G/E) / (0.5 + G/E) (pi D / (nu L0))^2: above 1 the spring is stable at any"
    " deflection, step: 0 below zero, else 1, s_max: deflection at maximum lift with the preload"
    " high, L0: free length, D: mean diameter, G, E: shear and elastic modulus, nu: seating"
    " coefficient",
    symbols={
        "L0": "spring.design.free_length",
        "D": "spring.design.mean_diameter",
        "G": "spring.design.shear_modulus",
        "E": f"{STATED} [GPa]",
        "nu": "spring.design.end_factor",
        "s_max": f"{_HIGH}/spring.design.rate + spring_travel_highest [mm]",
        "s_K": "[mm]",
        "x": "[-]",
    },
    reason="A spring that buckles rubs on the stem and loses its force.",
    load_cases=NONE,
    levers=(
        levers.one("spring.design.mean_diameter", most=2.0),
        *levers.GENTLER,
    ),
    page="Spring",
).measured(
    "top",
    allowed=_allowed(BUCKLING),
    remark=_stable,
    deviation=1e-4,
    kept=Kept(),
)(_measure(BUCKLING))


@check(
    title="Deviation of the spring design from the spring rate",
    unit="-",
    source=Source("tolerance of the rate in the case, else 5 %", confirmed=True),
    method="G d^4/(8 D^3 n) of the spring design against spring.rate",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="|G d^4 / (8 D^3 n) / k - 1| <= spring.rate_tolerance; k: spring.rate",
    symbols={
        "G": "spring.design.shear_modulus",
        "d": "spring.design.wire_diameter",
        "D": "spring.design.mean_diameter",
        "n": "spring.design.coils",
        "k": "spring_stiffness",
    },
    reason="All loads are those of spring.rate, all stresses those of the design.",
    load_cases=NONE,
    values=("spring.rate", *given.RATE),
    levers=(levers.one("spring.design.coils"), levers.one("spring.design.coils", -1)),
    page="Spring",
).measured("case", allowed=of_key("spring.rate_tolerance"), remark=_of_wire, deviation=1e-4)
def spring_rate(cam: LoadedCam) -> Array:
    """Relative deviation of the spring design's rate from the stated rate."""
    return np.asarray(cam.wire.rate_error(cam.spring_rate))


@check(
    SPRING_SURGE,
    title="Spring surge frequency / cam frequency",
    method="sqrt(k/m)/2 of the active coils over the highest speed of the sweep",
    must_have=False,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="f1 / f_cam >= limits.spring_surge; f1 = sqrt(k/m)/2: first natural frequency of the"
    " active coils, f_cam: turns of the cam at over-speed, at least at the fastest load case",
    symbols={
        "k": "spring.design.rate [N/mm]",
        "m": (
            "spring.design.density pi^2 spring.design.wire_diameter^2 "
            "spring.design.mean_diameter spring.design.coils/4 [g]"
        ),
        "f_cam": "cam.fastest/(2 pi) [Hz]",
        "f1": "[Hz]",
    },
    reason="Below it strong harmonics of the lift drive the coils. A rule of thumb: the sweep over"
    " the speeds decides, with the least damping, in contact_over_speed, spring_stress and"
    " spring_fatigue.",
    load_cases=SPEED_RANGE,
    values=(*given.SURGE, "limits.overspeed"),
    page="Spring",
).measured("case", worst="least", remark=_surge_over_speed, deviation=1e-4)
def spring_surge(cam: LoadedCam) -> Array:
    """Lowest natural frequency of the spring over the highest cam frequency."""
    return np.asarray(cam.wire.surge_ratio(cam.numbers["cam.fastest"]))


spring_relaxation = check(
    id="spring_relaxation",
    title="Loss of preload by relaxation / preload",
    unit="-",
    source=Source("tolerance of the preload in the case, else 5 %", confirmed=True),
    method="spring.design.relaxation of the greatest force, lost at every deflection",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="R F_max / P <= spring.preload_tolerance; R: spring.design.relaxation, share of the"
    " force lost in 48 h at spring.design.temperature, F_max: force at maximum lift, P: preload",
    symbols={
        "R": "spring.design.relaxation",
        "F_max": f"{_HIGH} + {_STIFF} spring_travel_highest [N]",
        "P": f"{_HIGH} [N]",
    },
    reason="A relaxed spring no longer has the preload on which every force is based.",
    load_cases=NONE,
    values=(
        *given.SPRING,
        *given.RATE,
        "spring.design.relaxation",
        "spring.design.temperature",
    ),
    page="Spring",
).measured(
    "top",
    allowed=of_key("spring.preload_tolerance"),
    needed=("spring.design.temperature", "spring.design.relaxation"),
    remark=_of_wire,
    deviation=1e-4,
    kept=Kept(),
)(_measure(RELAXATION))

"""Checks of the spring design: strength, fatigue, solid length, buckling, surge, relaxation.

Of a gas spring: pressure, stroke, speed, temperature, strokes per time, force lost by cold and
leakage, self-heating; of a torsion spring: bending stress.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.cooling import Cooling
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SOLID, SPRING_SURGE
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.cam_shape import lift
from camwright.pipeline.checks.check import (
    NONE,
    SPEED_RANGE,
    STATED,
    Allowed,
    Declaration,
    Declaring,
    Demand,
    Kept,
    check,
    of_key,
)
from camwright.pipeline.checks.demands import FatiguePoint, slope_at
from camwright.pipeline.checks.extremes import Extreme, Measure, over_duty, steady
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, wire_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solved_cam import ContourCam
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
from camwright.pipeline.follower.spring_kinds import (
    ATMOSPHERE,
    CHARGED_AT,
    HOOKED_SHARES,
    ExtensionSpring,
    GasSpring,
    SpringPart,
    TorsionWire,
)
from camwright.pipeline.follower.wound_wire import ZIMMERLI, SpringWork

BENDING_STRENGTH = 0.54  # permissible bending stress over R_m, above 1e6 strokes
HARDEST = "preload and rate high"
STABLE = "stable at any deflection"
_TURN_SAMPLES = 720  # of the turn, among which the rises of the lift are counted
_DWELL_SLOPE = 1e-6  # of the greatest slope of the lift: a dwell


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


def _of_gas(demand: Demand, solution: Solution) -> Demand:
    gas = solution.machine.spring.gas
    return replace(demand, figures=() if gas is None else (gas.source,))


def _of_hard_gas(demand: Demand, solution: Solution) -> Demand:
    force = ContourCam.at_top(solution.contour, solution.numbers).hardest.greatest
    hardest = replace(_of_gas(demand, solution), corner=HARDEST)
    return replace(hardest, stated={"F": float(np.ravel(force)[0])})


def _gas_check(
    name: str,
    *,
    title: str,
    unit: str,
    method: str,
    formula: str,
    symbols: Mapping[str, str],
    reason: str,
    lift_can_help: bool = True,
    values: tuple[str, ...],
    cured_by: tuple[Lever, ...] = (),
    kept_as: str = "",
) -> Declaring:
    """Check of a gas spring against a limit of its maker."""
    return check(
        id=name,
        title=title,
        unit=unit,
        source=Source("data sheet of the maker", confirmed=True),
        method=method,
        lift_can_help=lift_can_help,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part="gas_spring",
        kept_as=kept_as,
        formula=formula,
        symbols=symbols,
        reason=reason,
        load_cases=NONE,
        values=values,
        levers=cured_by,
        page="Spring",
    )


def _gas_pressure(cam: LoadedCam) -> Array:
    """Pressure above the surroundings of the hardest spring in tolerance, Pa."""
    return np.asarray(cam.hardest.greatest / cam.numbers["spring.gas.area"])


def _spring_travel(cam: LoadedCam) -> Array:
    """Travel of the ends of the spring, m."""
    return cam.spring_travel


def _piston_speed(cam: LoadedCam) -> Array:
    """Speed of the ends of the spring to one another, m/s."""
    return magnitude(cam.velocity * cam.spring_lever)


def _travel_slope_over(cam: LoadedCam, limit: float) -> Array:
    """Slope of its travel over its value at the greatest piston speed, see `slope_over`."""
    return magnitude(cam.jet.slope * cam.spring_lever) / limit


def _gas_temperature(cam: LoadedCam) -> Array:
    """Temperature of the gas, degC."""
    return np.asarray(celsius(cam.numbers["spring.gas.temperature"]))


def _warmest(numbers: Numbers) -> Allowed:
    limit = of_key("spring.gas.temperature_limit")(numbers)
    return limit if limit.value is None else limit._replace(value=celsius(limit.value))


gas_pressure = _gas_check(
    "gas_pressure",
    title="Maximum pressure of the gas spring",
    unit="MPa",
    method="force at maximum lift over the area, preload and rise of the force high",
    formula="F / A <= spring.gas.pressure_limit; F: force at maximum lift, preload and rise high in"
    " tolerance, A: area; above the pressure of the surroundings",
    symbols={"F": f"{STATED} [N]", "A": "spring.gas.area"},
    reason="beyond it seals and cylinder of the spring fail.",
    values=given.SPRING,
    cured_by=(
        levers.one("spring.gas.volume", most=2.0),
        *levers.GENTLER,
    ),
).measured(
    "top",
    allowed=of_key("spring.gas.pressure_limit"),
    remark=_of_hard_gas,
    deviation=1e-4,
    kept=Kept(),
)(_gas_pressure)
gas_stroke = _gas_check(
    "gas_stroke",
    title="Stroke of the gas spring",
    unit="mm",
    method="travel of its ends at the greatest lift, between samples too",
    formula="h <= spring.gas.stroke; h: travel of its ends at maximum lift, on a stem the lift",
    symbols={"h": "spring_travel_highest"},
    reason="a gas spring that strikes its stop breaks.",
    values=("spring.gas.stroke",),
    cured_by=(
        *levers.SPRING,
        *levers.GENTLER,
    ),
).measured("top", allowed=of_key("spring.gas.stroke"), remark=_of_gas, deviation=1e-4, kept=Kept())(
    _spring_travel
)
gas_speed = _gas_check(
    "gas_speed",
    title="Maximum piston speed of the gas spring",
    unit="m/s",
    method="greatest speed of its ends to one another over the load cases",
    kept_as="travel per radian at the maximum speed of the gas spring",
    formula="|v| <= spring.gas.speed_limit over all load cases; v: w s' u', greatest over the turn,"
    " w: cam speed, s': slope of the lift, u': travel of its ends per lift, 1 on a stem",
    symbols={"v": "follower_velocity spring_lever [m/s]"},
    reason="a faster seal overheats and wears.",
    values=(*given.MOTION, "spring.gas.speed_limit"),
    cured_by=(
        *levers.SPRING,
        *levers.GENTLER,
    ),
).measured(
    "angles",
    allowed=of_key("spring.gas.speed_limit"),
    remark=_of_gas,
    deviation=2e-3,
    bound=slope_at,
    kept=Kept(_travel_slope_over, unit="mm", unloaded=True),
)(_piston_speed)
gas_temperature = _gas_check(
    "gas_temperature",
    title="Temperature of the gas spring",
    unit="degC",
    method="spring.gas.temperature, at which the pressure is computed",
    formula="T <= spring.gas.temperature_limit; T: spring.gas.temperature",
    symbols={"T": "spring.gas.temperature - 273.15 [degC]"},
    reason="seals and oil of the spring age above it.",
    lift_can_help=False,
    values=("spring.gas.*temperature*",),
).measured(
    "case",
    allowed=_warmest,
    needed=("spring.gas.temperature",),
    remark=_of_gas,
    deviation=0.0,
)(_gas_temperature)


def _lost_force(cam: LoadedCam) -> Array:
    """Share of the preload that a gas spring lacks at the coldest start at the end of the service
    interval.
    """
    numbers = cam.numbers
    absolute = cam.spring_preload / numbers["spring.gas.area"] + ATMOSPHERE
    warm = numbers.get("spring.gas.temperature")
    cold = numbers["spring.gas.cold_temperature"] / (CHARGED_AT if warm is None else warm)
    left = absolute * (1.0 - numbers["spring.gas.loss"]) * cold
    return np.asarray((absolute - left) / (absolute - ATMOSPHERE))


def _of_warm_gas(demand: Demand, solution: Solution) -> Demand:
    """Demand with the temperature in operation and the source of the gas spring."""
    warm = solution.numbers.get("spring.gas.temperature")
    stated = {"T": CHARGED_AT if warm is None else float(warm)}
    return replace(_of_gas(demand, solution), stated=stated)


gas_force_lost = _gas_check(
    "gas_force_lost",
    title="Force of the gas spring lost by cold and leakage",
    unit="-",
    method="ideal gas at constant volume",
    formula="(p - p (1 - c) T_c/T)/(p - p_0) <= spring.preload_tolerance; p: absolute pressure at"
    " zero lift and T, spring.gas.temperature, p_0: of the surroundings, T_c:"
    " spring.gas.cold_temperature, c: spring.gas.loss",
    symbols={
        "p": "spring_preload/spring.gas.area + 101325 [MPa]",
        "c": "spring.gas.loss",
        "T_c": "spring.gas.cold_temperature",
        "T": f"{STATED} [K]",
        "p_0": "101325 [MPa]",
    },
    reason="a cold spring, and one that has lost gas, is weaker than the tolerance at which all"
    " else is judged, and the follower leaves the cam.",
    lift_can_help=False,
    values=("spring.gas.*temperature*", "spring.gas.loss", "spring.preload_tolerance"),
    cured_by=levers.SPRING,
).measured(
    "case",
    allowed=of_key("spring.preload_tolerance"),
    needed=("spring.gas.cold_temperature", "spring.gas.loss"),
    remark=_of_warm_gas,
    deviation=1e-6,
)(_lost_force)


def strokes_of(slope: Array) -> int:
    """Rises of the lift in a turn, by its slope (n,)."""
    way = np.sign(slope[np.abs(slope) > _DWELL_SLOPE * np.abs(slope).max()])
    return int(np.sum((way > 0) & (np.roll(way, -1) < 0)))


def _strokes(solution: Solution) -> int:
    return strokes_of(solution.contour.pitch.lift(uniform_turn(_TURN_SAMPLES), 1))


def gas_of(case: Case) -> GasSpring:
    """Gas spring of a case.

    Raises
    ------
    InputError
        If it has none.
    """
    gas = case.spring.gas
    if gas is None:
        raise InputError("spring.gas", "missing", "given for the checks of the gas spring")
    return gas


def gas_warmth(case: Case, work: Value, rate: Value) -> Value:
    """Temperature of the gas (...), degC, by the energy of a stroke (...), J, and the strokes per
    time (...), 1/s: heat of the friction of its seals.
    """
    gas, ambient = gas_of(case), case.cooling.ambient_temperature
    cooling = Cooling(ambient_temperature=ambient, conductance=gas.conductance)
    loss = 2.0 * gas.friction * work * rate
    return celsius(cooling.temperature(loss, gas.surface))


def _self_heating(solution: Solution) -> Demand:
    """Temperature of the gas by the friction of its seals, degC, over the load cases by their
    duty.
    """
    spring, gas = solution.machine.spring, gas_of(solution.case)
    work = spring.energy(float(solution.contour.pitch.lift.highest.value))

    def rate(cycle: Cycle) -> float:
        return _strokes(solution) * cycle.cam_speed / FULL_TURN

    def warm(cycle: Cycle) -> float:
        return float(gas_warmth(solution.case, work, rate(cycle)))

    worst, often = (over_duty(steady(solution), each) for each in (warm, rate))
    carried = Cooling(conductance=gas.conductance).carried(gas.surface)
    stated = {"W": work, "m": often.value, "G": float(carried)}
    limit = float(celsius(gas.warm))
    return _of_gas(Demand(worst.value, limit, worst, stated=stated), solution)


gas_heating = _gas_check(
    "gas_heating",
    title="Temperature of the gas by its own friction vs. that stated",
    unit="degC",
    method="friction of the seals over each stroke to and fro, given off by the cylinder",
    formula="T_amb + 2 f W m/G <= spring.gas.temperature; f: spring.gas.friction, W: energy of"
    " the spring at maximum lift, m: strokes per time, sum of q_i z n_i of the load cases by"
    " load_case.duty, else the greatest z n_i, T_amb: cooling.ambient_temperature, G:"
    " spring.gas.conductance, else 10 W/(m^2 K) of the surface of the cylinder",
    symbols={
        "T_amb": "cooling.ambient_temperature - 273.15 [degC]",
        "f": "spring.gas.friction",
        "W": f"{STATED} [J]",
        "m": f"{STATED} [1/s]",
        "G": f"{STATED} [W/K]",
    },
    reason="pressure and force are those of the stated temperature, and a hotter seal leaks.",
    values=(
        "load_case.speed",
        "load_case.duty",
        "spring.gas.*temperature",
        "spring.gas.friction",
        "spring.gas.conductance",
        "cooling.ambient_temperature",
    ),
    cured_by=(levers.one("spring.gas.conductance"), *levers.SPRING),
)(_self_heating)


def _stroke_rate(solution: Solution) -> Demand:
    """Greatest number of strokes of the gas spring per time, 1/s."""
    gas = solution.machine.spring.gas
    strokes = _strokes(solution)
    rate = strokes * float(solution.numbers["cam.fastest"]) / FULL_TURN
    limit = None if gas is None else gas.stroke_rate_limit
    lacks = () if gas is None else lacking(GasSpring.table, gas, "stroke_rate_limit")
    stated = {"z": float(strokes)}
    return _of_gas(Demand(rate, limit, missing=lacks, stated=stated), solution)


gas_stroke_rate = _gas_check(
    "gas_stroke_rate",
    title="Strokes per time of the gas spring",
    unit="1/min",
    method="rises of the lift in a turn times the greatest speed of the cam",
    formula="z n <= spring.gas.stroke_rate_limit; z: rises of the lift in a turn, n: greatest speed"
    " of the cam",
    symbols={"z": STATED, "n": "cam.fastest/(2 pi) [1/s]"},
    reason="each stroke heats gas and seal, which cool between the strokes alone.",
    lift_can_help=False,
    values=("load_case.speed", "limits.overspeed", "spring.gas.stroke_rate_limit"),
    cured_by=levers.SPRING,
)(_stroke_rate)


def _torsion(cam: LoadedCam) -> TorsionWire:
    """Torsion spring of the cam; InputError where it has none."""
    torsion = cam.spring_shape
    if not isinstance(torsion, TorsionWire):
        raise InputError("spring.torsion", "missing", "given for the checks of the spring")
    return torsion


def _bending_stress(cam: LoadedCam) -> Array:
    """Bending stress of the hardest spring in tolerance, Pa; NaN without the wire."""
    torsion, work = _torsion(cam), cam.hardest
    return torsion.bending_stress(torsion.moment_at(work.greatest, work.travel))


def _stress_range(cam: LoadedCam) -> Array:
    """Bending stress less that at zero lift, Pa."""
    torsion, work = _torsion(cam), cam.hardest
    least = torsion.bending_stress(torsion.moment_at(work.preload, 0.0 * work.travel))
    return _bending_stress(cam) - least


def _of_torsion(demand: Demand, solution: Solution) -> Demand:
    spring = solution.machine.spring
    torsion = spring.torsion or spring.torsion_pivot
    return replace(demand, figures=() if torsion is None else (torsion.source,), corner=HARDEST)


_WOUND = ("torsion", "torsion_pivot")


def _shaped_check(
    name: str, measure: Measure, allowed: Callable[[Numbers], Allowed],
    remark: Callable[[Demand, Solution], Demand], *, part: SpringPart, title: str, source: Source,
    method: str, formula: str, reason: str, tables: Sequence[str],
) -> Declaration:  # fmt: skip
    """Check of a stress, at maximum lift, of a spring that is no compression spring; tables: those
    of a case with its `wire_diameter`, the first lever.
    """
    return check(
        id=name,
        title=title,
        unit="MPa",
        source=source,
        method=method,
        lift_can_help=True,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part=part,
        formula=formula,
        reason=reason,
        load_cases=NONE,
        values=given.SPRING,
        levers=(
            *(levers.one(f"{table}.wire_diameter", most=2.0) for table in tables),
            *levers.GENTLER,
        ),
        page="Spring",
    ).measured("top", allowed=allowed, remark=remark, deviation=1e-4, kept=Kept())(measure)


def _torsion_check(
    name: str, measure: Measure, key: str, share: float, *, title: str, source: Source, method: str,
    formula: str, reason: str,
) -> Declaration:  # fmt: skip
    """Check of a bending stress of a torsion spring against a `share` of the value at a `key` of
    its table.
    """

    def allowed(numbers: Numbers) -> Allowed:
        """Allowed bending stress, Pa: the share of the value at the key; its missing keys."""
        table = f"spring.{numbers.known_case.spring.kind}"
        value = numbers.get(f"{table}.{key}")
        needed = (f"{table}.{each}" for each in ("wire_diameter", "mean_diameter", key))
        missing = tuple(each for each in needed if numbers.get(each) is None)
        return Allowed(None if value is None else share * value, missing)

    return _shaped_check(
        name, measure, allowed, _of_torsion, part="torsion_spring", title=title, source=source,
        method=method, formula=formula, reason=reason,
        tables=[f"spring.{each}" for each in _WOUND],
    )  # fmt: skip


torsion_stress = _torsion_check(
    "torsion_stress",
    _bending_stress,
    "tensile_strength",
    BENDING_STRENGTH,
    title="Maximum bending stress of the torsion spring",
    source=Source(
        "0.54 R_m of high-carbon wire above 1e6 strokes, 0.55 of oil-tempered wire, the safer:"
        " Analysis and Design of Machine Elements, p. 408, table 14.3; DIN EN 13906-3, recalled,"
        " has 0.7 R_m",
        confirmed=False,
    ),
    method="q 32 M/(pi d^3) at maximum lift, preload and rise of the force high",
    formula="q 32 M / (pi d^3) <= 0.54 R_m; M: moment at maximum lift with the tolerances high,"
    " q = (w + 0.07)/(w - 0.75), w = D/d, R_m: tensile strength of the wire",
    reason="A spring beyond its yield strength sets and loses the force that keeps the follower on"
    " the cam.",
)
torsion_fatigue = _torsion_check(
    "torsion_fatigue",
    _stress_range,
    "stress_range",
    1.0,
    title="Range of the bending stress of the torsion spring",
    source=Source(
        "stress_range of the spring: fatigue diagram of DIN EN 13906-3, or of the maker",
        confirmed=True,
    ),
    method="difference of q 32 M/(pi d^3) at maximum and zero lift, preload and rise high",
    formula="q 32 (M_h - M_0) / (pi d^3) <= S; S: stress_range of the table of the spring, M_h,"
    " M_0: moments at maximum and zero lift with the tolerances high, q: as of `torsion_stress`",
    reason="A broken spring releases the follower.",
)


def _extension(cam: LoadedCam) -> ExtensionSpring:
    """Extension spring of the cam; InputError where it has none."""
    hooked = None if cam.spring_shape is None else cam.spring_shape.own
    if not isinstance(hooked, ExtensionSpring):
        raise InputError("spring.extension", "missing", "given for the checks of the spring")
    return hooked


def _of_extension(demand: Demand, solution: Solution) -> Demand:
    spring = solution.machine.spring.extension
    return replace(demand, figures=() if spring is None else (spring.source,), corner=HARDEST)


_HOOKED = "spring.extension"
_HOOKED_TABLE = Source(
    "shares of R_m, body 45 to 50 %, ends 40 % in torsion and 75 % in bending, of austenitic wire"
    " 35, 30 and 55 %: amesweb.info, Maximum allowable stresses for coil extension springs, as"
    " Shigley, table 10-7, p. 529; hooks 40 to 45 and 75 %: a maker, tinmy.cn, Custom extension"
    " springs",
    confirmed=True,
)
_LOOSE = "A hook or coil that breaks or sets releases the follower."
_F = "F: force of the spring at maximum lift, preload and rate high"


def _extension_check(
    name: str, measure: Measure, share: str, *needed: str, title: str, source: Source,
    formula: str,
) -> Declaration:  # fmt: skip
    """Check of a stress of an extension spring against a `share` of the tensile strength of its
    wire, by its name in `HookedShares`; needed: other keys without which it is not known.
    """

    def allowed(numbers: Numbers) -> Allowed:
        """Allowed stress, Pa; its missing keys."""
        strength = numbers.get(f"{_HOOKED}.tensile_strength")
        keys = (f"{_HOOKED}.{each}" for each in ("tensile_strength", *needed))
        missing = tuple(each for each in keys if numbers.get(each) is None)
        hooked = numbers.known_case.spring.extension
        if strength is None or hooked is None:
            return Allowed(None, missing)
        return Allowed(getattr(HOOKED_SHARES[hooked.wire_kind], share) * strength, missing)

    return _shaped_check(
        name, measure, allowed, _of_extension, part="extension_spring", title=title, source=source,
        method="at maximum lift, preload and rate high; without surge", formula=formula,
        reason=_LOOSE, tables=[_HOOKED],
    )  # fmt: skip


extension_stress = _extension_check(
    "extension_stress",
    lambda cam: _extension(cam).body_stress(cam.hardest.greatest),
    "body",
    title="Maximum shear stress of the coils of the extension spring",
    source=_HOOKED_TABLE,
    formula="K_w 8 D F / (pi d^3) <= c R_m; K_w = (4 C - 1)/(4 C - 4) + 0.615/C, C = D/d, c = 0.45,"
    f" 0.35 of austenitic wire, R_m: tensile strength of the wire, {_F}",
)
extension_hook_bending = _extension_check(
    "extension_hook_bending",
    lambda cam: _extension(cam).hook_bending(cam.hardest.greatest),
    "bending",
    title="Maximum normal stress of the hook of the extension spring",
    source=_HOOKED_TABLE,
    formula="F (K_A 16 D/(pi d^3) + 4/(pi d^2)) <= c R_m; K_A = (4 C^2 - C - 1)/(4 C (C - 1)), C ="
    f" 2 r_1/d, r_1: mean radius of the hook, c = 0.75, 0.55 of austenitic wire, {_F}",
)
extension_hook_torsion = _extension_check(
    "extension_hook_torsion",
    lambda cam: _extension(cam).hook_torsion(cam.hardest.greatest),
    "torsion",
    "side_radius",
    title="Maximum shear stress of the bend from the coils to the hook",
    source=_HOOKED_TABLE,
    formula="K_B 8 D F/(pi d^3) <= c R_m; K_B = (4 C - 1)/(4 C - 4), C = 2 r_2/d, r_2: mean radius"
    f" of the bend, c = 0.40, 0.30 of austenitic wire, {_F}",
)
extension_fatigue = check(
    SPRING_FATIGUE,
    id="extension_fatigue",
    title="Fatigue safety factor of the extension spring",
    method="least of coils, bend and hook at maximum and zero lift, preload and rate high; without"
    " surge",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="extension_spring",
    formula="1 / max(tau_a/S_e + tau_m/(0.67 R_m), 0.577 s_a/S_e + s_m/R_m) >="
    " limits.spring_fatigue; tau: shear stress with the greater of K_w and K_B, s: normal stress of"
    " the hook, _a and _m amplitude and mean, S_e: endurance by Zimmerli's point of a wire that is"
    " not peened, of the hook at most 0.577 of that of 0.45 R_m from zero at 1e7 strokes; as of"
    " `spring_fatigue`, `extension_hook_bending`, `extension_hook_torsion`",
    reason=_LOOSE,
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one(f"{_HOOKED}.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    value=lambda worst, _: 1.0 / worst,
    bound=lambda limit, _: 1.0 / limit,
    needed=(f"{_HOOKED}.tensile_strength", f"{_HOOKED}.side_radius"),
    remark=_of_extension,
    deviation=1e-4,
    kept=Kept(),
)(lambda cam: _extension(cam).fatigue_use(cam.hardest.preload, cam.hardest.greatest))


def _wound_tension(worst: Value, numbers: Numbers) -> Value:
    """Initial tension of an extension spring, N."""
    tension: Value = numbers[f"{_HOOKED}.initial_tension"]
    return tension + 0.0 * worst


def _tension_limit(numbers: Numbers) -> Allowed:
    """Least of the preload with its tolerance low and what coiling gives, N."""
    spring = numbers.known_case.spring
    if spring.extension is None:
        return Allowed(None)
    least = spring.extension.preload * (1.0 - numbers["spring.preload_tolerance"])
    return Allowed(min(least, spring.extension.most_initial_tension))


extension_initial_tension = check(
    id="extension_initial_tension",
    title="Initial tension of the extension spring",
    unit="N",
    source=Source(
        "upper end of what a maker winds in routinely: Shigley, eq. 10-41, read second-hand",
        confirmed=False,
    ),
    method="stated value against the preload with its tolerance low, and what coiling gives",
    lift_can_help=False,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="extension_spring",
    formula="F_0 <= min(F_1, pi d^3 tau_0/(8 D)); F_0: spring.extension.initial_tension, F_1:"
    " preload low, tau_0 = 231/e^(0.105 C) + 6.9 (4 - (C - 3)/6.5) MPa, C = D/d",
    reason="Below its initial tension the coils close and the rate is no longer that of the spring;"
    " more than coiling gives cannot be made.",
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one(f"{_HOOKED}.force", most=2.0),),
    page="Spring",
).measured(
    "top",
    value=_wound_tension,
    allowed=_tension_limit,
    remark=_of_extension,
    deviation=1e-4,
)(lift)


def _rising(numbers: Numbers) -> Allowed:
    """Lift up to which the force of a linked spring rises; None without a link."""
    shape = numbers.spring_shape
    return Allowed(
        None if numbers.known_case.spring.linked is None or shape is None else shape.reach
    )


def _of_link(demand: Demand, solution: Solution) -> Demand:
    """Demand with the source of the link and the swing to the dead centre of the spring."""
    link = solution.machine.spring.linked
    if link is None:
        return demand
    note = f"dead centre of the spring at a lift of {shown(float(link.most_lift), 'mm', 4)}"
    return replace(demand, figures=(link.source,), note=note)


link_reach = check(
    id="link_reach",
    title="Lift up to which the spring on the arm closes with a rising force",
    unit="mm",
    source=Source("lift from energy has one solution", confirmed=True),
    method="lift at which the lever of the spring falls as fast as its force rises, or the law of"
    " a gas spring ends; before its dead centre",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    needs="arm",
    formula="h <= s_r; h: maximum lift, s_r: lift at which F_s du/ds is greatest, F_s: force of the"
    " spring, u: travel of its ends",
    symbols={"h": "lift_highest"},
    reason="Towards the dead centre the lever of the spring vanishes, and with it the force that"
    " keeps the follower on the cam.",
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one("spring.link.arm_radius", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    allowed=_rising,
    applies=lambda _, numbers: np.array(numbers.known_case.spring.linked is not None),
    remark=_of_link,
    deviation=1e-4,
    kept=Kept(),
)(lift)

"""Checks of the spring design: strength, fatigue, solid length, buckling, surge, relaxation.

Of a gas spring: pressure, stroke, speed and temperature; of a torsion spring: bending stress.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import levers
from camwright.pipeline.base import value_groups as given
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SOLID, SPRING_SURGE, Limit, Sense
from camwright.pipeline.checks.check import NONE, SPEED_RANGE, Declaration, Demand, check
from camwright.pipeline.checks.demands import FatiguePoint
from camwright.pipeline.checks.extremes import Extreme, greatest
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.speed_sweep import SpringSweep, highest_speed
from camwright.pipeline.follower.spring import (
    HelicalSpring,
    Number,
    Spring,
    WoundWire,
    surge_harmonics,
)
from camwright.pipeline.follower.spring_kinds import GasSpring, TorsionSpring

RATE_TOLERANCE = 0.05  # of the rate, where the case has none
PRELOAD_TOLERANCE = 0.05  # of the preload, where the case has none
BENDING_STRENGTH = 0.7  # permissible bending stress over R_m, DIN EN 13906-3: verify
HARDEST = "preload and rate high"
STABLE = "stable at any deflection"


class Work(NamedTuple, Generic[Number]):
    """Hardest spring in tolerance: preload, maximum force, N; travel, m; rate, N/m."""

    preload: Number
    greatest: Number
    travel: Number
    rate: Number


Measure = Callable[[HelicalSpring, Work[float]], float]


def hardest_work(
    spring: Spring, design: WoundWire[Number], preload: Number, travel: Number
) -> Work[Number]:
    """Working range of the hardest spring in tolerance.

    Parameters
    ----------
    preload : float or array (m,)   greatest of the load cases, N
    travel : float or array (m,)    maximum lift, m
    """
    hard = preload * (1.0 + spring.preload_tolerance)
    rate = design.rate * (1.0 + spring.rate_tolerance)
    return Work(hard, hard + rate * travel, travel, rate)


def relaxation_allowed(spring: Spring) -> float:
    """Permissible loss of preload by relaxation, relative: the tolerance of the preload."""
    return spring.preload_tolerance or PRELOAD_TOLERANCE


def _design(solution: Solution) -> HelicalSpring:
    design = solution.machine.spring.design
    if design is None:
        raise InputError("spring.design", "missing", "given for the checks of the spring")
    return design


def _work(solution: Solution) -> Work[float]:
    preload = max(machine.spring.preload for machine in solution.machines)
    travel = solution.contour.pitch.lift.highest.value
    return hardest_work(solution.machine.spring, _design(solution), preload, travel)


def _slow(
    name: str,
    measure: Measure,
    *,
    title: str,
    method: str,
    formula: str,
    reason: str,
    limit: Limit | None = None,
    allowed: Callable[[HelicalSpring], float] = lambda _: 1.0,
    sense: Sense = "at_most",
    unit: str = "-",
    source: str = "",
    note: Callable[[HelicalSpring], str] = lambda _: "",
    lift_can_help: bool = True,
    values: tuple[str, ...] = (),
    cured_by: tuple[Lever, ...] = (),
) -> Declaration:
    """Check of the spring design at the upper ends of its tolerances, without surge."""

    @check(
        limit,
        id=name,
        title=title,
        unit=unit,
        sense=sense,
        method=method,
        source=source,
        lift_can_help=lift_can_help,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part="spring",
        formula=formula,
        reason=reason,
        load_cases=NONE,
        values=values,
        levers=cured_by,
        page="Spring",
    )
    def demand(solution: Solution) -> Demand:
        design = _design(solution)
        bound = allowed(design) if limit is None else solution.machine.limits[limit]
        return Demand(
            measure(design, _work(solution)),
            bound,
            note=note(design),
            figures=(design.source,),
            corner=_corner(solution.machine.spring, HARDEST),
        )

    return demand


def _corner(spring: Spring, words: str) -> str:
    return words if spring.preload_tolerance > 0 or spring.rate_tolerance > 0 else ""


class OverSpeed(NamedTuple):
    """Greatest value over the speed, the same at the least damping of the surge, the speed."""

    value: float
    least_damped: float
    words: str


def _at_rest(work: Work[float]) -> SpringSweep:
    """Working range of the spring without surge: a lower bound of its forces."""
    forces = (np.full((2, 1), force) for force in (work.preload, work.greatest))
    return SpringSweep(np.zeros(1), *forces)


def _over_speed(solution: Solution, use: Callable[[SpringSweep], Array]) -> OverSpeed:
    """Greatest value (2, m) over both ends of the spring and all speeds."""
    if solution.tier is Tier.SCREENING:
        most = float(np.max(use(_at_rest(_work(solution)))))
        return OverSpeed(most, most, "without surge")
    sweep, damped = solution.hardest_spring, solution.least_damped
    if sweep is None:
        return OverSpeed(np.nan, np.nan, "")
    values = np.max(use(sweep), axis=0)
    k = first_greatest(values)  # the first NaN, where there is one
    value, further = float(values[k]), None if damped is None else damped.hardest_spring
    most = value if further is None else max(float(np.max(use(further))), value)
    return OverSpeed(
        value, most, f"at {shown(float(sweep.crank_speed[k]), 'rpm', 4)} of the machine"
    )


@check(
    id="spring_stress",
    title="Spring shear stress / static strength",
    unit="-",
    source="0.56 R_m, EN 13906-1: verify",
    method="Wahl factor, greatest force at either end of the spring over the speed range, surge"
    " included",
    lift_can_help=True,
    fails_from=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="tau_max / (0.56 R_m) <= 1, tau = K_w 8 D F / (pi d^3); F: greatest force in the coils"
    " from standstill to over-speed with preload and rate high, resonances of any rate in tolerance"
    " included, K_w: Wahl factor, R_m: tensile strength of the wire",
    reason="A spring beyond its yield strength sets and loses the preload that keeps the"
    " follower on the cam.",
    load_cases=SPEED_RANGE,
    rests_on="loads",
    values=(*given.SPRING, *given.SURGE, *given.WIRE, "limits.overspeed"),
    levers=(levers.one("spring.design.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
)
def spring_stress(solution: Solution) -> Demand:
    """Greatest shear stress of the wire with surge over the static strength."""
    design = _design(solution)
    worst = _over_speed(
        solution, lambda sweep: design.stress(sweep.greatest) / design.static_strength
    )
    share = worst.least_damped / worst.value - 1.0
    return Demand(
        worst.value,
        1.0,
        Extreme(worst.value, error_share=share),
        note=worst.words,
        figures=(design.source,),
        corner=_corner(solution.machine.spring, HARDEST),
    )


@check(
    SPRING_FATIGUE,
    title="Fatigue safety factor of the spring",
    method="Wahl factor, range of force at either end of the spring over the speed range, surge"
    " included",
    lift_can_help=True,
    fails_from=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="1 / (tau_a / S_e + tau_m / S_su) >= limits.spring_fatigue; tau_a, tau_m: amplitude and"
    " mean at the end of the spring with the greater range, over all speeds from standstill to"
    " over-speed, S_su = 0.67 R_m, S_e: endurance by Zimmerli's point",
    reason="A broken spring releases the follower.",
    load_cases=SPEED_RANGE,
    rests_on="loads",
    values=(*given.SPRING, *given.SURGE, *given.WIRE, "limits.overspeed"),
    levers=(levers.one("spring.design.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
)
def spring_fatigue(solution: Solution) -> Demand:
    """Least fatigue safety of the wire with surge over the speed range."""
    design = _design(solution)
    worst = _over_speed(solution, lambda sweep: design.fatigue_use(sweep.least, sweep.greatest))
    safety = 1.0 / worst.value  # of a preload above zero
    share = 0.0 if safety == 0.0 else 1.0 - worst.value / worst.least_damped
    return Demand(
        safety,
        solution.machine.limits[SPRING_FATIGUE],
        Extreme(safety, error_share=share),
        note=worst.words,
        figures=(design.source,),
        corner=_corner(solution.machine.spring, HARDEST),
    )


def spring_fatigue_points(solution: Solution) -> list[FatiguePoint]:
    """Stress of the wire where it is fatigued most over the speed range; none without a design."""
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


spring_solid = _slow(
    "spring_solid",
    lambda design, work: design.solid_clearance(work.preload, work.travel),
    title="Spring solid-height clearance",
    limit=SPRING_SOLID,
    sense="at_least",
    method="free length less solid length less deflection at maximum lift, over that deflection",
    formula="(L0 - Lc - s_max) / s_max >= limits.spring_solid; L0, Lc: free and solid length,"
    " s_max = P/k + h: deflection at maximum lift h, preload P high",
    reason="A spring that goes solid stops the follower.",
    values=(*given.SPRING, *given.RATE),
    cured_by=(
        levers.one("spring.design.free_length", most=2.0),
        *levers.GENTLER,
    ),
)
spring_coil_gap = _slow(
    "spring_coil_gap",
    lambda design, work: design.gap_left(work.preload, work.travel),
    title="Sum of the gaps between the coils at maximum lift",
    allowed=lambda design: design.minimum_gaps,
    sense="at_least",
    unit="mm",
    source="1.5 S_a, dynamic load, cold coiled, EN 13906-1:2013, 9.9: verify",
    method="free length less solid length less deflection at maximum lift",
    formula="L0 - Lc - s_max >= 1.5 n (0.0015 D^2/d + 0.1 d); L0, Lc: free and solid length, s_max:"
    " deflection at maximum lift with the preload high, n: active coils, D: mean diameter, d: wire",
    reason="Below it coils touch before the solid length, the rate rises and the wire wears.",
    values=(*given.SPRING, *given.RATE),
    cured_by=(
        levers.one("spring.design.free_length", most=2.0),
        *levers.GENTLER,
    ),
)
spring_solid_stress = _slow(
    "spring_solid_stress",
    lambda design, work: design.solid_stress(work.rate),
    title="Shear stress of the spring at its solid length",
    allowed=lambda design: design.static_strength,
    unit="MPa",
    source="0.56 R_m, cold coiled, EN 13906-1:2013, 10.1.1: verify",
    method="rate times free less solid length, without correction factor, rate high",
    formula="tau_c = 8 D F_c / (pi d^3) <= 0.56 R_m; F_c = k (L0 - Lc): force at solid length with"
    " the rate high, R_m: tensile strength of the wire",
    reason="A spring is pressed solid when it is coiled, mounted and over-run, and sets"
    " beyond this stress.",
    lift_can_help=False,
    values=(*given.SPRING, *given.RATE, *given.WIRE),
    cured_by=(levers.one("spring.design.free_length", -1, 2.0),),
)
spring_buckling = _slow(
    "spring_buckling",
    lambda design, work: (
        (design.deflection(work.preload) + work.travel) / design.buckling_deflection
    ),
    title="Spring deflection / buckling deflection",
    source="EN 13906-1:2013, 9.14, after Haringx: verify",
    method="deflection at maximum lift over s_K with the seating coefficient"
    " spring.design.end_factor; 0: stable at any deflection",
    formula="s_max / s_K <= 1, s_K = L0 / (2 (1 - G/E)) (1 - sqrt(1 - (1 - G/E) / (0.5 + G/E)"
    " (pi D / (nu L0))^2)); s_max: deflection at maximum lift with the preload high, nu: seating"
    " coefficient",
    reason="A spring that buckles rubs on the stem and loses its force.",
    note=lambda design: STABLE if np.isinf(design.buckling_deflection) else "",
    cured_by=(
        levers.one("spring.design.mean_diameter", most=2.0),
        *levers.GENTLER,
    ),
)


@check(
    title="Deviation of the spring design from the spring rate",
    unit="-",
    source="tolerance of the rate in the case, else 5 %",
    method="G d^4/(8 D^3 n) of the spring design against spring.rate",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="|G d^4 / (8 D^3 n) / k - 1| <= tolerance of the rate; k: spring.rate",
    reason="All loads are those of spring.rate, all stresses those of the design.",
    load_cases=NONE,
    values=("spring.rate", *given.RATE),
    levers=(levers.one("spring.design.coils"), levers.one("spring.design.coils", -1)),
    page="Spring",
)
def spring_rate(solution: Solution) -> Demand:
    """Deviation of the rate of the spring design from that of the case, relative."""
    spring, design = solution.machine.spring, _design(solution)
    allowed = spring.rate_tolerance or RATE_TOLERANCE
    error = abs(design.rate / spring.rate - 1.0)
    return Demand(error, allowed, figures=(design.source,), corner=_corner(spring, HARDEST))


@check(
    SPRING_SURGE,
    title="Spring surge frequency / cam frequency",
    method="sqrt(k/m)/2 of the active coils over the highest speed of the sweep",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="f1 / f_cam >= limits.spring_surge; f1 = sqrt(k/m)/2: first natural frequency of the"
    " active coils, f_cam: turns of the cam at over-speed, at least at the fastest load case",
    reason="Below it strong harmonics of the lift drive the coils, and the force on the"
    " cam depends on a damping that is hardly known.",
    load_cases=SPEED_RANGE,
    values=(*given.SURGE, "limits.overspeed"),
    page="Spring",
)
def spring_surge(solution: Solution) -> Demand:
    """First natural frequency of the spring over the highest cam frequency."""
    machine, design = solution.machine, _design(solution)
    top = highest_speed(solution.machines) / machine.gear_ratio
    lift = solution.contour.pitch.lift.values
    highest, ratio, margin = surge_harmonics(lift, top, design.surge_frequency)
    sweeps = solution.speed_sweeps
    sweep = sweeps[first_greatest([each.surge_force.max() for each in sweeps])]
    added = float(sweep.surge_force.max())
    speed = float(sweep.crank_speed[first_greatest(sweep.surge_force)])
    return Demand(
        ratio,
        machine.limits[SPRING_SURGE],
        Extreme(ratio),
        note=f"highest harmonic of at least 1 % of the acceleration: {highest}; surge lies"
        f" {margin:.2f} times above it and adds up to {shown(added, 'N', 3)} at"
        f" {shown(speed, 'rpm', 4)} of the machine with a damping ratio of"
        f" {design.damping:g}",
    )


@check(
    title="Loss of preload by relaxation / preload",
    unit="-",
    source="tolerance of the preload in the case, else 5 %",
    method="spring.design.relaxation of the greatest force, lost at every deflection",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="spring",
    formula="R F_max / P <= tolerance of the preload; R: spring.design.relaxation, share of the"
    " force lost in 48 h at spring.design.temperature, F_max: force at maximum lift, P: preload",
    reason="A relaxed spring no longer has the preload on which every force is based.",
    load_cases=NONE,
    values=(
        *given.SPRING,
        *given.RATE,
        "spring.design.relaxation",
        "spring.design.temperature",
    ),
    page="Spring",
)
def spring_relaxation(solution: Solution) -> Demand:
    """Loss of preload by relaxation at temperature, relative."""
    spring, design = solution.machine.spring, _design(solution)
    work = _work(solution)
    return Demand(
        design.relaxed_preload(work.preload, work.greatest),
        relaxation_allowed(spring),
        missing=lacking("spring.design", design, "temperature", "relaxation"),
        figures=(design.source,),
        corner=_corner(spring, HARDEST),
    )


def _gas(solution: Solution) -> GasSpring:
    gas = solution.machine.spring.gas
    if gas is None:
        raise InputError("spring.gas", "missing", "given for the checks of the gas spring")
    return gas


def hardest_force(spring: Spring, travel: ArrayLike) -> Array:
    """Force at lifts (...), m, of the hardest spring in tolerance, N."""
    preload = spring.preload * (1.0 + spring.preload_tolerance)
    risen = spring.force(np.asarray(travel)) - spring.preload
    return np.asarray(preload + risen * (1.0 + spring.rate_tolerance))


def gas_pressure_at(spring: Spring, gas: GasSpring, travel: ArrayLike) -> Array:
    """Pressure above the surroundings at lifts (...), m, of the hardest spring in tolerance, Pa."""
    return np.asarray(hardest_force(spring, travel) / gas.area)


def _gas_check(
    name: str,
    measure: Callable[[Solution, GasSpring], float | Extreme | None],
    allowed: str,
    *,
    title: str,
    unit: str,
    method: str,
    formula: str,
    reason: str,
    needs: tuple[str, ...] = (),
    lift_can_help: bool = True,
    corner: str = "",
    values: tuple[str, ...],
    cured_by: tuple[Lever, ...] = (),
) -> Declaration:
    """Check of a gas spring against the limit of its maker, `spring.gas.<allowed>`."""
    in_display_unit = celsius if unit == "degC" else float

    @check(
        id=name,
        title=title,
        unit=unit,
        source="data sheet of the maker",
        method=method,
        lift_can_help=lift_can_help,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part="gas_spring",
        formula=formula,
        reason=reason,
        load_cases=NONE,
        values=values,
        levers=cured_by,
        page="Spring",
    )
    def demand(solution: Solution) -> Demand:
        gas = _gas(solution)
        measured, limit = measure(solution, gas), getattr(gas, allowed)
        at = measured if isinstance(measured, Extreme) else None
        value = measured.value if isinstance(measured, Extreme) else measured
        return Demand(
            None if value is None else in_display_unit(value),
            None if limit is None else in_display_unit(limit),
            at,
            missing=lacking("spring.gas", gas, allowed, *needs),
            figures=(gas.source,),
            corner=_corner(solution.machine.spring, corner) if corner else "",
        )

    return demand


def _travel(solution: Solution) -> float:
    return float(solution.contour.pitch.lift.highest.value)


def _greatest_speed(solution: Solution) -> Extreme:
    """Greatest speed of the follower over the load cases, m/s."""
    return greatest(solution.cycles, lambda cycle: np.abs(cycle.loads.velocity))


gas_pressure = _gas_check(
    "gas_pressure",
    lambda solution, gas: float(gas_pressure_at(solution.machine.spring, gas, _travel(solution))),
    "pressure_limit",
    title="Maximum pressure of the gas spring",
    unit="MPa",
    method="force at maximum lift over the area, preload and rise of the force high",
    formula="F / A <= spring.gas.pressure_limit; F: force at maximum lift, preload and rise high in"
    " tolerance, A: area; above the pressure of the surroundings",
    reason="beyond it seals and cylinder of the spring fail.",
    corner=HARDEST,
    values=given.SPRING,
    cured_by=(
        levers.one("spring.gas.volume", most=2.0),
        *levers.GENTLER,
    ),
)
gas_stroke = _gas_check(
    "gas_stroke",
    lambda solution, _: _travel(solution),
    "stroke",
    title="Stroke of the gas spring",
    unit="mm",
    method="greatest lift, between samples too",
    formula="h <= spring.gas.stroke; h: maximum lift",
    reason="a gas spring that strikes its stop breaks.",
    values=("spring.gas.stroke",),
    cured_by=(
        *levers.SPRING,
        *levers.GENTLER,
    ),
)
gas_speed = _gas_check(
    "gas_speed",
    lambda solution, _: _greatest_speed(solution),
    "speed_limit",
    title="Maximum piston speed of the gas spring",
    unit="m/s",
    method="greatest speed of the follower over the load cases",
    formula="max|w s'| <= spring.gas.speed_limit over all load cases; w: cam speed, s': slope of"
    " the lift",
    reason="a faster seal overheats and wears.",
    values=(*given.MOTION, "spring.gas.speed_limit"),
    cured_by=(
        *levers.SPRING,
        *levers.GENTLER,
    ),
)
gas_temperature = _gas_check(
    "gas_temperature",
    lambda _, gas: gas.temperature,
    "temperature_limit",
    title="Temperature of the gas spring",
    unit="degC",
    method="spring.gas.temperature, at which the pressure is computed",
    formula="T <= spring.gas.temperature_limit; T: spring.gas.temperature",
    reason="seals and oil of the spring age above it.",
    needs=("temperature",),
    lift_can_help=False,
    values=("spring.gas.*temperature*",),
)


def torsion_stress_at(
    spring: Spring, torsion: TorsionSpring, travel: ArrayLike
) -> tuple[Array, Array] | None:
    """Bending stress at zero lift and at lifts (...), m, of the hardest spring in tolerance, Pa.

    None without the wire.
    """
    lift = np.stack([np.zeros_like(travel, dtype=float), np.asarray(travel, dtype=float)])
    stress = torsion.bending_stress(torsion.moment_at(hardest_force(spring, lift), lift))
    return None if stress is None else (stress[0], stress[1])


def _torsion_check(
    name: str,
    measure: Callable[[Array, Array], Array],
    allowed: Callable[[TorsionSpring], float | None],
    *,
    title: str,
    source: str,
    method: str,
    formula: str,
    reason: str,
    needs: str,
) -> Declaration:
    """Check of the bending stress of a torsion spring at zero and maximum lift."""

    @check(
        id=name,
        title=title,
        unit="MPa",
        source=source,
        method=method,
        lift_can_help=True,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part="torsion_spring",
        formula=formula,
        reason=reason,
        load_cases=NONE,
        values=given.SPRING,
        levers=(levers.one("spring.torsion.wire_diameter", most=2.0), *levers.GENTLER),
        page="Spring",
    )
    def demand(solution: Solution) -> Demand:
        spring = solution.machine.spring
        torsion = spring.torsion
        if torsion is None:
            raise InputError("spring.torsion", "missing", "given for the checks of the spring")
        stress = torsion_stress_at(spring, torsion, _travel(solution))
        return Demand(
            None if stress is None else float(measure(*stress)),
            allowed(torsion),
            missing=lacking("spring.torsion", torsion, "wire_diameter", "mean_diameter", needs),
            figures=(torsion.source,),
            corner=_corner(spring, HARDEST),
        )

    return demand


def torsion_strength(torsion: TorsionSpring) -> float | None:
    """Permissible bending stress of a torsion spring, 0.7 R_m, Pa; None without R_m."""
    strength = torsion.tensile_strength
    return None if strength is None else BENDING_STRENGTH * strength


torsion_stress = _torsion_check(
    "torsion_stress",
    lambda _, most: most,
    torsion_strength,
    title="Maximum bending stress of the torsion spring",
    source="0.7 R_m, DIN EN 13906-3: verify",
    method="q 32 M/(pi d^3) at maximum lift, preload and rise of the force high",
    formula="q 32 M / (pi d^3) <= 0.7 R_m; M: moment at maximum lift with the tolerances high,"
    " q = (w + 0.07)/(w - 0.75), w = D/d, R_m: tensile strength of the wire",
    reason="A spring beyond its yield strength sets and loses the force that keeps the follower on"
    " the cam.",
    needs="tensile_strength",
)
torsion_fatigue = _torsion_check(
    "torsion_fatigue",
    lambda least, most: most - least,
    lambda torsion: torsion.stress_range,
    title="Range of the bending stress of the torsion spring",
    source="spring.torsion.stress_range: fatigue diagram of DIN EN 13906-3, or of the maker",
    method="difference of q 32 M/(pi d^3) at maximum and zero lift, preload and rise high",
    formula="q 32 (M_h - M_0) / (pi d^3) <= spring.torsion.stress_range; M_h, M_0: moments at"
    " maximum and zero lift with the tolerances high, q: as of `torsion_stress`",
    reason="A broken spring releases the follower.",
    needs="stress_range",
)

"""Checks of gas springs: pressure, stroke, speed, temperature, force lost, self-heating."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.cooling import Cooling
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    NONE,
    STATED,
    Allowed,
    Declaring,
    Demand,
    Kept,
    check,
    of_key,
)
from camwright.pipeline.checks.demands import slope_at
from camwright.pipeline.checks.extremes import over_duty, steady
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.checks.spring_strength import HARDEST
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solved_cam import ContourCam
from camwright.pipeline.follower.spring_kinds import (
    ATMOSPHERE,
    CHARGED_AT,
    GasSpring,
)

_TURN_SAMPLES = 720  # of the turn, among which the rises of the lift are counted
_DWELL_SLOPE = 1e-6  # of the greatest slope of the lift: a dwell


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

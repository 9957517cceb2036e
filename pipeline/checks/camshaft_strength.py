"""Checks of the camshaft: fatigue, yield, deflection, bearings, driving gear."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest, first_least
from camwright.geometry.second_track import discs_of
from camwright.pipeline.base import levers
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    GEAR_BENDING_SAFETY,
    GEAR_CONTACT_SAFETY,
    SHAFT_BEARING_LIFE,
    SHAFT_BEARING_STATIC_SAFETY,
    SHAFT_DEFLECTION,
    SHAFT_RELIABILITY,
    SHAFT_SAFETY,
    SHAFT_SLOPE,
    SHAFT_YIELD_SAFETY,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    BY_DUTY,
    LASTING,
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.demands import (
    NORMAL_FORCE,
    TOOTH_TORQUE,
    FatiguePoint,
    PerLoad,
    tooth_torque,
)
from camwright.pipeline.checks.extremes import (
    Extreme,
    cycle_of,
    greatest,
    over_duty,
    row_of,
    worst_case,
)
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card, unset
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    CamshaftGear,
    Impact,
    Rotor,
    ShaftLoads,
    ShaftSection,
    impact,
)
from camwright.pipeline.follower.roller_motion import rating_life, static_safety
from camwright.pipeline.follower.shaft_strength import (
    Sections,
    ShaftBending,
    bending_moment,
    fatigue_safety,
    fibre_stresses,
    greatest_stress,
    judged_sections,
    reliability_factor,
    shaft_bending,
    size_factor,
    surface_factor,
    tooth_contact_stress,
    tooth_root_stress,
    torque_at,
)

REVERSED = 0.7  # of the bending limit, for reversed torque
_RIGID_STIFFNESS = 1e9  # N m/rad, of a shaft without diameter or material
MESH_STIFFNESS = 20e9
"""Of steel teeth over their width, N/m2: ISO 6336-1, mean value (recalled, verify)."""
_STEEL = 206e9  # Pa, of the teeth of `MESH_STIFFNESS`
RATED = 0.5  # of the dynamic rating: greatest load of the rating life, ISO 281
BREAKS = "a broken or seized camshaft stops the engine"


@dataclass(frozen=True)
class _Shaft:
    """Camshaft with the data of its strength: diameter, material and judged sections."""

    camshaft: Camshaft
    material: Material
    least_diameter: float
    sections: tuple[ShaftSection, ...]


def camshaft_of(machine: Machine | Case) -> Camshaft:
    """Camshaft of a machine or case; without one its checks are not made."""
    if machine.camshaft is None:
        raise InputError("camshaft", "missing", "described for its checks")
    return machine.camshaft


def gear_of(shaft: Camshaft) -> CamshaftGear:
    """Gear of the camshaft; without one its checks are not made."""
    if shaft.gear is None:
        raise InputError("camshaft.gear", "missing", "described for its checks")
    return shaft.gear


def _strength_data(machine: Machine) -> _Shaft | tuple[str, ...]:
    """Camshaft with its diameter, material and sections to be judged, or else the dotted keys that
    the case lacks.
    """
    shaft, cam = camshaft_of(machine), machine.cam
    if shaft.diameter is None or shaft.thinnest is None or shaft.material is None:
        return lacking(shaft.table, shaft, "diameter", "material")
    key_length = 0.0 if cam.key is None else cam.key.length or 0.0
    reach = 0.5 * max(cam.width, key_length)
    gear_reach = 0.0 if shaft.gear is None else 0.5 * shaft.gear.width
    sections = judged_sections(shaft, shaft.diameter, reach, gear_reach, cam.spacing or 0.0)
    return _Shaft(shaft, shaft.material, shaft.thinnest, sections)


def _by_value(each: tuple[Extreme, int]) -> float:
    return each[0].value


def _place(section: ShaftSection) -> str:
    return f"{section.name}, {shown(section.position, 'mm')} from bearing 1"


@check(
    SHAFT_SAFETY,
    id="shaft_fatigue",
    title="Fatigue safety factor of the camshaft, least of all sections",
    method="rotating bending and torsion at every section, unbalance included; Goodman line",
    lift_can_help=True,
    part="camshaft",
    kept_as="normal force at the fatigue of the camshaft",
    formula="1/(s_a/S_e + s_m/R_m) >= S; s_a, s_m: von Mises amplitude and mean of bending K_f M"
    " and torsion K_fs (T + drag) of the turning fibre, S_e = k_a k_b k_e S_e': endurance with"
    " factors of surface, size and reliability, S: limits.shaft_safety. Least over cam, gear, both"
    " bearings and camshaft.sections, and over all load cases",
    symbols={
        **dict.fromkeys(("s_a", "s_m"), f"{STATED} [MPa]"),
        **dict.fromkeys(("k_a", "k_b", "k_e"), STATED),
        "S_e'": "camshaft.material.fatigue_bending",
        "R_m": "camshaft.material.tensile_strength",
        "S_e": "[MPa]",
    },
    reason=BREAKS,
    values=(
        *given.SHAFT,
        "camshaft.material.tensile_strength",
        "camshaft.material.fatigue_bending",
        "camshaft.*notch_*",
        "limits.shaft_reliability",
    ),
    levers=(levers.one("camshaft.diameter", most=2.0), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 1.0),
)
def shaft_fatigue(solution: Solution) -> Demand:
    """Least fatigue safety factor over the camshaft sections, in bending and torsion."""
    machine, limit = solution.machine, solution.machine.limits[SHAFT_SAFETY]
    shaft = _strength_data(machine)
    if isinstance(shaft, tuple):
        return Demand(None, limit, missing=shaft)
    card = shaft.material
    endurance, tensile = card.fatigue_bending, card.tensile_strength
    if endurance is None or tensile is None:
        missing = lacking_of_card(card, "fatigue_bending", "tensile_strength")
        return Demand(None, limit, missing=missing)
    finish = surface_factor(shaft.camshaft.surface, tensile)
    rest = reliability_factor(machine.limits[SHAFT_RELIABILITY])

    sections, strength = Sections.of(shaft.sections), _endurance(shaft, finish * rest * endurance)

    @cache
    def fibres(cycle: Cycle) -> tuple[Array, Array]:
        return fibre_stresses(cycle.theta, *_at_sections(cycle, shaft, sections), sections)

    @cache
    def safety(cycle: Cycle) -> Array:
        return fatigue_safety(*fibres(cycle), strength, tensile)

    worst, number = min(
        (
            (worst_case(solution.cycles, _entry(safety, k), at_least=True), k)
            for k in range(len(shaft.sections))
        ),
        key=_by_value,
    )
    section = shaft.sections[number]
    size = float(size_factor(section.diameter))
    amplitude, mean = (each[number] for each in fibres(cycle_of(solution.cycles, worst)))
    most = first_greatest(amplitude / strength[number] + mean / tensile)
    return Demand(
        worst.value,
        limit,
        worst,
        note=f"governing section: {_place(section)}",
        figures=(
            machine.limits.source(SHAFT_RELIABILITY),
            f"{card.name}: {card.source}",
            "Shigley, 10th ed., sec. 6-9 (to be confirmed)",
        ),
        method="rotating bending and torsion at every section, unbalance included; Goodman line;"
        f" fatigue notch factors {section.notch_bending:g} and {section.notch_torsion:g},"
        f" k_a {finish:.3f} ({shaft.camshaft.surface}), k_b {size:.3f}, k_e {rest:.3f}",
        stated={
            "s_a": float(amplitude[most]),
            "s_m": float(mean[most]),
            "k_a": finish,
            "k_b": size,
            "k_e": rest,
        },
    )


def _endurance(shaft: _Shaft, endurance: float) -> Array:
    """Fully reversed strength of each section (k,), Pa, from that without the factor of size."""
    return np.array([size_factor(one.diameter) * endurance for one in shaft.sections])


def _entry(values: Callable[[Cycle], Array], k: int) -> Callable[[Cycle], float]:
    return lambda cycle: float(values(cycle)[k])


def _at_sections(cycle: Cycle, shaft: _Shaft, sections: Sections) -> tuple[Array, Array]:
    """Bending moment (k, 2, n) and torque (k, n) at the sections, N m."""
    loads = _loads(cycle)
    moment = bending_moment(loads, shaft.camshaft, sections.place)
    torque = cycle.loads.cam_torque
    return moment, torque_at(torque, shaft.camshaft, sections.place, loads.second)


def shaft_fatigue_points(solution: Solution) -> list[FatiguePoint]:
    """Stress amplitude and mean of each camshaft section, Pa, at its most utilised fibre over all
    load cases, for the Goodman diagram; empty without data.
    """
    machine = solution.machine
    if machine.camshaft is None or isinstance(shaft := _strength_data(machine), tuple):
        return []
    endurance, tensile = shaft.material.fatigue_bending, shaft.material.tensile_strength
    if endurance is None or tensile is None:
        return []
    factors = surface_factor(shaft.camshaft.surface, tensile)
    factors *= reliability_factor(machine.limits[SHAFT_RELIABILITY])
    sections, strengths = Sections.of(shaft.sections), _endurance(shaft, factors * endurance)
    fibres = [
        fibre_stresses(cycle.theta, *_at_sections(cycle, shaft, sections), sections)
        for cycle in solution.cycles
    ]
    amplitudes, means = (np.concatenate(each, axis=1) for each in zip(*fibres, strict=True))
    used, points = dict[str, float](), dict[str, FatiguePoint]()
    for section, strength, amplitude, mean in zip(
        shaft.sections, strengths.tolist(), amplitudes, means, strict=True
    ):
        use = amplitude / strength + mean / tensile
        k = first_greatest(np.nan_to_num(use))
        if use[k] > used.get(section.name, 0.0):
            used[section.name] = float(use[k])
            points[section.name] = FatiguePoint(
                section.name, float(amplitude[k]), float(mean[k]), strength, tensile
            )
    return list(points.values())


@check(
    SHAFT_YIELD_SAFETY,
    id="shaft_yield",
    title="Greatest von Mises stress of the camshaft at a notch",
    unit="MPa",
    method="bending and torsion at every section, with the fatigue notch factors",
    lift_can_help=True,
    part="camshaft",
    kept_as="normal force at the yield of the camshaft",
    formula="sqrt((K_f M/W)^2 + 3 (K_fs T/(2 W))^2) <= R_p / S; M, T: bending moment and torque of"
    " the section at one angle, the drag included, K_f, K_fs: its fatigue notch factors, W ="
    " pi d^3/32, d: its diameter, R_p: yield strength of the core, S: limits.shaft_yield_safety."
    " Greatest over all sections, angles and load cases",
    symbols={
        **dict.fromkeys(("M", "T"), f"{STATED} [N m]"),
        **dict.fromkeys(("K_f", "K_fs"), STATED),
        "d": f"{STATED} [mm]",
        "W": "[mm^3]",
        "R_p": f"{STATED} [MPa]",
    },
    reason=f"a bent camshaft turns out of true; {BREAKS}",
    values=(*given.SHAFT, "camshaft.material.*yield_strength", "camshaft.*notch_*"),
    levers=(levers.one("camshaft.diameter", most=2.0), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 1.0),
)
def shaft_yield(solution: Solution) -> Demand:
    """Greatest von Mises stress over the camshaft sections, Pa."""
    safety, shaft = solution.machine.limits[SHAFT_YIELD_SAFETY], _strength_data(solution.machine)
    if isinstance(shaft, tuple):
        return Demand(None, None, missing=shaft)

    sections = Sections.of(shaft.sections)

    @cache
    def stress(cycle: Cycle) -> Array:
        return greatest_stress(*_at_sections(cycle, shaft, sections), sections)

    def at_section(k: int) -> Extreme:
        return greatest(solution.cycles, lambda cycle: stress(cycle)[k])

    worst, number = max(((at_section(k), k) for k in range(len(shaft.sections))), key=_by_value)
    section, card = shaft.sections[number], shaft.material
    strength = card.core_yield
    cycle, at = row_of(solution.cycles, worst)
    moment, torque = (each[number] for each in _at_sections(cycle, shaft, sections))
    return Demand(
        worst.value,
        strength / safety,
        worst,
        note=f"governing section: {_place(section)}",
        figures=(f"{card.name}: {card.source}",),
        stated={
            "M": float(np.hypot(*moment[:, at])),
            "T": float(torque[at]),
            "K_f": section.notch_bending,
            "K_fs": section.notch_torsion,
            "d": section.diameter,
            "R_p": strength,
        },
    )


@check(
    SHAFT_DEFLECTION,
    title="Deflection of the camshaft at the cam over its bearing spacing",
    unit="-",
    method="beam of the least diameter of the sections on two rigid bearings, without shear",
    lift_can_help=True,
    part="camshaft",
    kept_as="normal force at the maximum deflection of the camshaft",
    formula="f/l <= limits.shaft_deflection; f: greatest deflection at the cam by the unit-load"
    " method, l: bearing spacing",
    symbols={"f": f"{STATED} [um]", "l": "camshaft.bearing_spacing"},
    reason="the deflection is an error of the lift and tilts the contact line",
    values=(*given.SHAFT, "camshaft.material.E"),
    levers=(levers.one("camshaft.diameter", most=2.0), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 1.0),
)
def shaft_deflection(solution: Solution) -> Demand:
    """Greatest deflection of the camshaft at the cam over the bearing spacing."""
    limit, shaft = solution.machine.limits[SHAFT_DEFLECTION], _strength_data(solution.machine)
    if isinstance(shaft, tuple):
        return Demand(None, limit, missing=shaft)
    spacing = shaft.camshaft.bearing_spacing

    def bent(cycle: Cycle) -> Array:
        return np.asarray(np.hypot(*_bending(cycle, shaft).deflection))

    worst = greatest(solution.cycles, lambda cycle: bent(cycle) / spacing)
    amount = shown(worst.value * spacing, "um", 3)
    cycle, k = row_of(solution.cycles, worst)
    stated = {"f": float(bent(cycle)[k])}
    return Demand(worst.value, limit, worst, note=f"{amount} at the cam", stated=stated)


@check(
    SHAFT_SLOPE,
    title="Slope of the camshaft at a bearing",
    method="beam of the least diameter of the sections on two rigid bearings, without shear",
    lift_can_help=True,
    part="camshaft",
    kept_as="normal force at the maximum slope of the camshaft",
    formula="phi <= limits.shaft_slope; phi: greatest slope at either bearing by the unit-load"
    " method",
    symbols={"phi": f"{STATED} [mrad]"},
    reason="beyond their slope the balls run on the edge of the groove, and the rating"
    " life does not hold",
    values=(*given.SHAFT, "camshaft.material.E"),
    levers=(levers.one("camshaft.diameter", most=2.0), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 1.0),
)
def shaft_slope(solution: Solution) -> Demand:
    """Greatest slope of the camshaft at its bearings, rad."""
    limit, shaft = solution.machine.limits[SHAFT_SLOPE], _strength_data(solution.machine)
    if isinstance(shaft, tuple):
        return Demand(None, limit, missing=shaft)

    def slope(cycle: Cycle) -> Array:
        bent = _bending(cycle, shaft)
        return np.asarray(np.maximum(np.hypot(*bent.slope_1), np.hypot(*bent.slope_2)))

    worst = greatest(solution.cycles, slope)
    return Demand(worst.value, limit, worst, stated={"phi": worst.value})


@check(
    SHAFT_BEARING_STATIC_SAFETY,
    id="shaft_bearing_static",
    title="Static safety factor of the camshaft bearings",
    method="static rating over the greatest load of either bearing, unbalance included",
    lift_can_help=True,
    part="camshaft_bearings",
    kept_as="normal force at the static load rating of the camshaft bearings",
    formula="C0/P0 >= limits.shaft_bearing_static_safety; C0: camshaft.bearing_static_rating, P0:"
    " greatest radial load of either bearing over all load cases and angles",
    symbols={
        "C0": "camshaft.bearing_static_rating",
        "P0": "max(shaft_bearing_load_1, shaft_bearing_load_2) [N]",
    },
    reason="dents of the raceway under the greatest load are permanent",
    values=(*given.SHAFT, "camshaft.bearing_static_rating"),
    levers=(levers.one("camshaft.bearing_static_rating"), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 1.0),
)
def shaft_bearing_static(solution: Solution) -> Demand:
    """Least static safety factor s0 of the two camshaft bearings."""
    shaft = camshaft_of(solution.machine)
    rating = shaft.bearing_static_rating

    def load(cycle: Cycle) -> Array:
        loads = _loads(cycle)
        return np.maximum(loads.load_1, loads.load_2)

    worst = greatest(solution.cycles, load)
    rated = rating is not None and worst.value > 0
    return Demand(
        static_safety(worst.value, rating) if rated and rating is not None else None,
        solution.machine.limits[SHAFT_BEARING_STATIC_SAFETY],
        worst,
        lacking(shaft.table, shaft, "bearing_static_rating"),
        figures=(shaft.source,),
    )


@check(
    SHAFT_BEARING_LIFE,
    title="L10 rating life of the camshaft bearings",
    method="(C/P_m)^3 million turns, P_m the cube mean of the bearing's load, unbalance included",
    lift_can_help=True,
    part="camshaft_bearings",
    kept_as="normal force at the rating life of the camshaft bearings",
    formula="L10 >= limits.shaft_bearing_life; L10 = (C/P_m)^3 10^6 turns, C:"
    " camshaft.bearing_rating, P_m: cube mean of the radial load over the turn, P <= C/2"
    f" throughout. Least over both bearings; over the load cases {BY_DUTY}",
    symbols={
        "C": "camshaft.bearing_rating",
        "P_m": ("max(mean(shaft_bearing_load_1^3), mean(shaft_bearing_load_2^3))^(1/3) [N]"),
        "turns": "2 pi/cam.speed [s]",
        "L10": "[h]",
    },
    reason=BREAKS,
    load_cases=LASTING,
    values=(*given.SHAFT, "camshaft.bearing_rating"),
    levers=(levers.one("camshaft.bearing_rating"), *levers.LOAD),
    page="Camshaft",
    scales_with=(NORMAL_FORCE, 3.0),
)
def shaft_bearing_life(solution: Solution) -> Demand:
    """Rating life of the more heavily loaded camshaft bearing, s."""
    shaft = camshaft_of(solution.machine)
    rating, target = shaft.bearing_rating, solution.machine.limits[SHAFT_BEARING_LIFE]
    missing = lacking(shaft.table, shaft, "bearing_rating")
    missing += unset(solution.machine.limits, SHAFT_BEARING_LIFE)
    if rating is None:
        return Demand(None, target, missing=missing)

    def of_bearing(load_of: Callable[[ShaftLoads], Array]) -> Extreme:
        """Life of a bearing over the load cases, s; load_of : its load over the turn, N."""

        def life(cycle: Cycle) -> float:
            """Life in one load case, s; NaN for a load above C/2."""
            load = load_of(_loads(cycle))
            if not (load <= RATED * rating).all():
                return float(np.nan)
            spin = np.full(cycle.theta.size, cycle.cam_speed)
            return float(rating_life(load, spin, rating).seconds)

        return over_duty(solution.cycles, life, life=True)

    both = [of_bearing(lambda loads: loads.load_1), of_bearing(lambda loads: loads.load_2)]
    worst = both[first_least([each.value for each in both])]
    if np.isfinite(worst.value):  # the other bearing may be the worse one within its error
        least = min(each.value * (1.0 - each.error_share) for each in both)
        worst = worst._replace(error_share=1.0 - least / worst.value)
    return Demand(
        worst.value,
        target,
        worst,
        missing,
        note="a load above C/2, where ISO 281 does not hold" if np.isnan(worst.value) else "",
        figures=(shaft.source,),
    )


def _geared(numbers: Numbers) -> tuple[Camshaft, CamshaftGear]:
    """Camshaft and its gear, of the case of these numbers."""
    shaft = camshaft_of(numbers.known_case)
    return shaft, gear_of(shaft)


def _push(numbers: Numbers) -> float:
    """Force on the pitch circle, application factor included, of a torque of 1 N m, N."""
    shaft, gear = _geared(numbers)
    return gear.application_factor / shaft.gear_radius


def _tooth_bending(
    name: str,
    title: str,
    formula: str,
    reason: str,
    values: tuple[str, ...],
    key: str,
    wheel: Callable[[CamshaftGear], tuple[int, Material]],
    *,
    teeth: str,
    kept_as: str,
) -> Declaration:
    """Check of the tooth root stress of a wheel, camshaft gear or pinion, with its own form factor.

    Parameters
    ----------
    name : str              id of the check
    values : tuple of str   keys on which the check rests besides those of both wheels
    key, teeth : str        dotted keys of the bending limit and of the number of teeth
    wheel : callable        gear -> number of teeth and material of the wheel
    kept_as : str           what the synthesis bounds, in words
    """

    def per_torque(numbers: Numbers) -> float:
        shaft, gear = _geared(numbers)
        module, teeth = 2.0 * shaft.gear_radius / gear.teeth, wheel(gear)[0]
        return float(tooth_root_stress(_push(numbers), gear.width, module, teeth))

    def allowed(numbers: Numbers) -> Allowed:
        """Allowed tooth root stress, Pa, of a load that reverses; its missing key."""
        limit = numbers.get(key)
        if limit is None:
            return Allowed(None, (key,))
        return Allowed(REVERSED * limit / numbers.limit(GEAR_BENDING_SAFETY))

    def with_card(demand: Demand, solution: Solution) -> Demand:
        gear = gear_of(camshaft_of(solution.machine))
        figure = f"{wheel(gear)[1].name}: {gear.source}".rstrip(": ")
        return replace(demand, figures=(figure,))

    return check(
        GEAR_BENDING_SAFETY,
        id=name,
        title=title,
        unit="MPa",
        method="F K/(b m pi y) at the greatest torque, load on the tip of one tooth",
        lift_can_help=True,
        tier=Tier.SCREENING,
        part="gear",
        kept_as=kept_as,
        formula=formula,
        symbols={
            "T": "cam_torque",
            "drag": "camshaft.drag",
            "r": "camshaft.gear_radius",
            "K_A": "camshaft.gear.application_factor",
            "b": "camshaft.gear.width",
            "m": "2 camshaft.gear_radius/camshaft.gear.teeth [mm]",
            "z": teeth,
            "F": "[N]",
            "s_F": key,
            "S": f"limits.{GEAR_BENDING_SAFETY.id}",
        },
        reason=reason,
        values=(
            *given.LOADS,
            *values,
            "camshaft.gear.bending_limit",
            "camshaft.gear.application_factor",
            "camshaft.drag",
        ),
        levers=(levers.one("camshaft.gear.width"), *levers.GENTLER),
        page="Camshaft",
    ).measured(
        "angles",
        value=PerLoad(per_torque).value,
        bound=PerLoad(per_torque).bound,
        allowed=allowed,
        remark=with_card,
        deviation=0.003,
        kept=Kept(group=TOOTH_TORQUE, unit="N m"),
    )(tooth_torque)


gear_bending = _tooth_bending(
    TOOTH_TORQUE,
    "Tooth root bending stress of the driving gear",
    "F K_A/(b m pi y) <= 0.7 s_F / S; F = |T + drag|/r, y = 0.154 - 0.912/z: Lewis, s_F:"
    " camshaft.gear.bending_limit, 0.7: reversed torque, S: limits.gear_bending_safety",
    "a broken tooth stops the camshaft",
    (),
    "camshaft.gear.bending_limit",
    lambda gear: (gear.teeth, gear.material),
    teeth="camshaft.gear.teeth",
    kept_as="torque at the maximum root stress of the driving gear",
)
pinion_bending = _tooth_bending(
    "pinion_bending",
    "Tooth root bending stress of the pinion on the machine shaft",
    "F K_A/(b m pi y) <= 0.7 s_F / S; F = |T + drag|/r, y = 0.154 - 0.912/z: Lewis, z: teeth of the"
    " pinion, thinner at the root, s_F: camshaft.gear.pinion_bending_limit, else as gear_bending",
    "a broken tooth stops the camshaft, and the pinion has the weaker tooth",
    ("camshaft.gear.pinion_bending_limit",),
    "camshaft.gear.pinion_bending_limit",
    lambda gear: (gear.pinion_teeth, gear.pinion_material or gear.material),
    teeth="camshaft.gear.pinion_teeth",
    kept_as="torque at the maximum root stress of the pinion",
)


def _flank(numbers: Numbers) -> float:
    """Hertz pressure of the teeth at a torque of 1 N m, Pa; that at any torque is in proportion to
    its root.
    """
    shaft, gear = _geared(numbers)
    card, mate = gear.material, gear.pinion_material or gear.material
    ratio = max(gear.teeth, gear.pinion_teeth) / min(gear.teeth, gear.pinion_teeth)
    pinion = 2.0 * shaft.gear_radius * min(1.0, gear.pinion_teeth / gear.teeth)
    modulus = contact_modulus(card.E, card.nu, mate.E, mate.nu)
    force = _push(numbers)
    return float(
        tooth_contact_stress(force, gear.width, pinion, ratio, shaft.pressure_angle, modulus)
    )


def _flank_allowed(numbers: Numbers) -> Allowed:
    """Allowed Hertz pressure of the teeth, Pa: the lower contact limit of gear and pinion over the
    safety.
    """
    gear = _geared(numbers)[1]
    limits = gear.contact_limit, gear.pinion_contact_limit
    missing = lacking(gear.table, gear, "contact_limit", "pinion_contact_limit")
    stated = [limit for limit in limits if limit is not None]
    if missing:
        return Allowed(None, missing)
    return Allowed(min(stated) / numbers.limit(GEAR_CONTACT_SAFETY))


def _with_card_of_gear(demand: Demand, solution: Solution) -> Demand:
    """Demand with material card and source of the gear."""
    gear = gear_of(camshaft_of(solution.machine))
    return replace(demand, figures=(f"{gear.material.name}: {gear.source}".rstrip(": "),))


gear_contact = check(
    GEAR_CONTACT_SAFETY,
    id="gear_contact",
    title="Tooth flank contact pressure of the driving gear",
    unit="MPa",
    method="Z_H Z_E sqrt(F K (u + 1)/(b d u)) at the pitch point, at the greatest torque",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="gear",
    kept_as="torque at the maximum flank pressure of the driving gear",
    formula="Z_H Z_E sqrt(F K_A (u + 1)/(b d u)) <= s_H / S; d, u: pitch diameter of the smaller"
    " wheel and ratio of teeth, s_H: lower contact limit of gear and pinion, S:"
    " limits.gear_contact_safety",
    symbols={
        "?": "camshaft.gear.pinion_material None",
        "Z_H": "sqrt(2/(sin(camshaft.pressure_angle) cos(camshaft.pressure_angle)))",
        "Z_E": ("sqrt(camshaft.gear.material.E/(2 pi (1 - camshaft.gear.material.nu^2)))"),
        "F": "|cam_torque + camshaft.drag|/camshaft.gear_radius [N]",
        "K_A": "camshaft.gear.application_factor",
        "u": (
            "max(camshaft.gear.teeth/camshaft.gear.pinion_teeth, "
            "camshaft.gear.pinion_teeth/camshaft.gear.teeth)"
        ),
        "b": "camshaft.gear.width",
        "d": ("2 camshaft.gear_radius min(1, camshaft.gear.pinion_teeth/camshaft.gear.teeth) [mm]"),
        "s_H": "min(camshaft.gear.contact_limit, camshaft.gear.pinion_contact_limit) [MPa]",
    },
    reason="pitted flanks break",
    values=(
        *given.LOADS,
        "camshaft.gear.*contact_limit",
        "camshaft.gear.application_factor",
        "camshaft.drag",
        "camshaft.gear.material.E",
        "camshaft.gear.material.nu",
    ),
    levers=(levers.one("camshaft.gear.width"), *levers.GENTLER),
    page="Camshaft",
).measured(
    "angles",
    value=lambda worst, numbers: _flank(numbers) * np.sqrt(worst),
    bound=lambda limit, numbers: (limit / _flank(numbers)) ** 2,
    allowed=_flank_allowed,
    remark=_with_card_of_gear,
    deviation=0.003,
    pointwise=True,
    kept=Kept(group=TOOTH_TORQUE),
)(tooth_torque)


def _rotor(machine: Machine, contour: Contour) -> Rotor:
    """Camshaft as a torsional oscillator: inertias of gear and cam, kg m2, and the stiffness of the
    shaft between both, N m/rad, rigid without diameter or material.
    """
    shaft, cam = camshaft_of(machine), machine.cam
    gear, card, twist = gear_of(shaft), shaft.material, _RIGID_STIFFNESS
    discs = discs_of(contour, cam.second)
    rings = [each.contour.polar_moment() - 0.5 * np.pi * cam.bore_radius**4 for each in discs]
    ring = sum(rings)
    if shaft.thinnest is not None and card is not None:
        section = np.pi * shaft.thinnest**4 / 32.0
        apart = _twisted([each / ring for each in rings], shaft, cam.spacing)
        twist = min(twist, card.E / (2.0 * (1.0 + card.nu)) * section / apart)
    return Rotor(
        gear=gear.inertia(shaft.gear_radius),
        cam=cam.material.density * cam.width * ring,
        shaft=twist,
        mesh=_mesh_stiffness(gear) * gear.width,
        radius=shaft.gear_radius,
    )


def _twisted(shares: Sequence[float], shaft: Camshaft, spacing: float | None) -> float:
    """Length of the shaft, m, that discs twist against the gear as one.

    Mean of the lengths that both of two discs twist, each by its share of the inertia: of the
    energy of the shaft while both are accelerated alike. Of one disc its distance from the gear.

    References
    ----------
    Rayleigh's quotient with the twist by the inertia of equal accelerations.
    """
    spacings = np.array([0.0] if spacing is None else [0.0, spacing])
    from_gear = shaft.cam_position + spacings - shaft.gear_position
    lengths = np.minimum(np.abs(from_gear)[:, None], np.abs(from_gear))
    lengths = np.where(from_gear[:, None] * from_gear > 0.0, lengths, 0.0)
    return float(np.asarray(shares) @ lengths @ np.asarray(shares))


def _hardest_impact(cycle: Cycle, rotor: Rotor, drag: float, backlash: float) -> Impact | None:
    """Impact of the greatest tooth force over a turn; drag, N m, backlash, m. None where no
    reversal of the torque lets the teeth cross their backlash, and at standstill.
    """
    if cycle.cam_speed <= 0.0:
        return None
    torque = cycle.loads.cam_torque + drag
    impacts = [
        impact(cycle.theta, torque, reversal, cycle.cam_speed, rotor, backlash)
        for reversal in cycle.parts.reversals
    ]
    return max(filter(None, impacts), key=lambda each: each.force, default=None)


def _mesh_stiffness(gear: CamshaftGear) -> float:
    """Of the teeth over their width, N/m2: that of steel by the moduli of both wheels."""
    mate = gear.pinion_material or gear.material
    share = 2.0 * gear.material.E * mate.E / ((gear.material.E + mate.E) * _STEEL)
    return MESH_STIFFNESS * share


@check(
    GEAR_BENDING_SAFETY,
    id="gear_impact",
    title="Tooth root stress of the impact in the backlash",
    unit="MPa",
    method="flight of cam and gear across the backlash after each reversal of the torque, then the"
    " greatest force on elastic teeth and shaft: 20 N/mm/um of steel teeth, damped by 3 %",
    lift_can_help=True,
    part="gear",
    formula="F/(b m pi y) <= 0.7 s_F / S; F: greatest force on the teeth, y = 0.154 - 0.912/z,"
    " z: teeth of gear or pinion, whichever has less reserve, s_F: its bending limit, S:"
    " limits.gear_bending_safety, 0.7: reversed torque. 0 where no reversal crosses"
    " the backlash",
    symbols={
        "F": f"{STATED} [N]",
        "z": STATED,
        "s_F": f"{STATED} [MPa]",
        "b": "camshaft.gear.width",
        "m": "2 camshaft.gear_radius/camshaft.gear.teeth [mm]",
        "S": f"limits.{GEAR_BENDING_SAFETY.id}",
    },
    reason="flanks that meet at every reversal break their teeth before the steady torque does",
    values=(
        *given.LOADS,
        "camshaft.gear.backlash",
        "camshaft.gear.*bending_limit",
        "camshaft.gear.material.E",
        "camshaft.drag",
    ),
    levers=(
        levers.one("camshaft.gear.backlash", -1),
        levers.one("camshaft.gear.width"),
        *levers.GENTLER,
    ),
    page="Camshaft",
)
def gear_impact(solution: Solution) -> Demand:
    """Greatest root stress, Pa, of teeth that cross their backlash at a reversal of the torque and
    meet on the other flank.
    """
    shaft = camshaft_of(solution.machine)
    gear = gear_of(shaft)
    safety = solution.machine.limits[GEAR_BENDING_SAFETY]
    missing = lacking(gear.table, gear, "bending_limit", "pinion_bending_limit")
    bending_limits = (gear.bending_limit or np.nan), (gear.pinion_bending_limit or np.nan)
    limits = [REVERSED * each / safety for each in bending_limits]
    module, teeth = 2.0 * shaft.gear_radius / gear.teeth, (gear.teeth, gear.pinion_teeth)
    root = [float(tooth_root_stress(1.0, gear.width, module, each)) for each in teeth]
    weaker = first_greatest([each / limit for each, limit in zip(root, limits, strict=True)])
    backlash = gear.known_backlash(shaft.gear_radius)
    rotor = _rotor(solution.machine, solution.contour)

    @cache
    def hardest(cycle: Cycle) -> Impact | None:
        return _hardest_impact(cycle, rotor, shaft.drag, backlash)

    def stress(cycle: Cycle) -> float:
        met = hardest(cycle)
        return 0.0 if met is None else root[weaker] * met.force

    worst = worst_case(solution.cycles, stress, integral=False)
    met = hardest(cycle_of(solution.cycles, worst))
    card = gear.material if weaker == 0 else gear.pinion_material or gear.material
    note = f"backlash {shown(backlash, 'mm')}"
    if met is None:
        note += " is not crossed"
    else:
        note += f": flanks meet at {shown(met.speed, 'm/s')}, {shown(met.theta, 'deg')}"
    return Demand(
        worst.value,
        None if missing else limits[weaker],
        worst,
        missing,
        note=note,
        figures=(f"{card.name}: {gear.source}".rstrip(": "),),
        stated={
            "F": 0.0 if met is None else met.force,
            "z": float(teeth[weaker]),
            "s_F": bending_limits[weaker],
        },
    )


def _loads(cycle: Cycle) -> ShaftLoads:
    """Forces and bearing loads of the camshaft over the turn; InputError where the case has
    none.
    """
    if cycle.shaft is None:
        raise InputError("camshaft", "missing", "described for its checks")
    return cycle.shaft


def _bending(cycle: Cycle, shaft: _Shaft) -> ShaftBending:
    return shaft_bending(_loads(cycle), shaft.camshaft, shaft.least_diameter, shaft.material.E)

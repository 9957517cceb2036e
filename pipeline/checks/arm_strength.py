"""Checks of the arms of an oscillating follower and its rocker: fatigue and yield."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import Literal, NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import levers
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import ARM_SAFETY, ARM_YIELD_SAFETY, SHAFT_RELIABILITY
from camwright.pipeline.case.scope_section import PartName
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    STATED,
    Allowed,
    Declaration,
    Declaring,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE, rating_over
from camwright.pipeline.checks.extremes import Extreme, cam_of, cycle_of, row_of, worst_case
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.arm_beam import ArmBar, ArmForces, ArmSection, SectionLoads
from camwright.pipeline.follower.camshaft_loads import Surface
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.roller import on_second_track
from camwright.pipeline.follower.second_arm import SecondArmBar
from camwright.pipeline.follower.shaft_strength import (
    reliability_factor,
    size_factor,
    surface_factor,
)

_ARM = FollowerArm.table
_LEAST_FORCE = 1.0  # N, of a contact that presses the arm aside, where another one takes over
_BREAKS = "a broken arm drops its roller into the cam"
_VALUES = (*given.LENGTH, "follower.arm.*_notch")
_LEVERS = (
    levers.one("follower.arm.depth", most=2.0),
    levers.one("follower.arm.width", most=2.0),
    *levers.LOAD,
)
_LOADS = (
    "M, F, L, T: moment in the plane of the cam, force along the arm, moment across the plane and"
    " torque of the section, by contact, spring and inertia, and by the ends, tilt and offset of"
    " the contact; in a fork of its more loaded cheek times their number, in the eye F of the"
    " contact force alone; of conjugate discs in both arms"
)


def _lacking(arm: FollowerArm, *keys: str) -> tuple[str, ...]:
    return lacking(arm.table, arm, "width", "depth", "material", *keys)


def _lacking_of_second(numbers: Numbers) -> tuple[str, ...]:
    """Keys of section and material that the second arm of a rocker lacks."""
    rocker, arm = numbers.known_case.rocker, _arm_of(numbers)
    if rocker is None:
        raise InputError(Rocker.table, "missing", "given for its checks")
    missing = lacking(Rocker.table, rocker, "width", "depth", "notch")
    has_material = rocker.material is not None or arm.material is not None
    return missing if has_material else (*missing, f"{Rocker.table}.material")


def _source(numbers: Numbers, table: str) -> str:
    """Source of the table of the first or second arm."""
    rocker = numbers.known_case.rocker
    second = rocker if table == Rocker.table else None
    return str((_arm_of(numbers) if second is None else second).source)


def _arm_of(numbers: Numbers) -> FollowerArm:
    """Arm of the case; InputError where it has none."""
    arm = numbers.known_case.follower.arm
    if arm is None:
        raise InputError(_ARM, "missing", "given for its checks")
    return arm


def bars_of(numbers: Numbers) -> tuple[ArmBar, ...]:
    """Arm of a case as a bar, and the second arm of conjugate discs; () where it is not
    described.
    """
    case, link = numbers.known_case, numbers.known_case.spring.link
    arm = None if case.follower.arm is None else numbers.of_part(case.follower.arm)
    link = None if link is None else numbers.of_part(link)
    output = 0.0 if case.output is None else case.output.reduced_mass
    mass, length = numbers["follower.mass"] - output, numbers.get("cam.conjugate.arm_length")
    if case.facing.slides:
        return ArmBar.each(arm, case.facing, mass, link)
    roller, second = numbers.of_part(case.roller), None
    if length is not None:
        radius = {"radius": numbers["cam.conjugate.roller_radius"]}
        second = length, on_second_track(roller, case.cam).of_many(radius)
    return ArmBar.each(arm, roller, mass, link, second)


def bar_of(numbers: Numbers) -> ArmBar | None:
    """Arm of a case as a bar, the first of two; None where it is not described."""
    return next(iter(bars_of(numbers)), None)


def second_bar_of(numbers: Numbers) -> SecondArmBar | None:
    """Second arm of a case as a bar; None without one on an arm, or without a material."""
    case = numbers.known_case
    arm = case.follower.arm
    if arm is None or case.rocker is None:
        return None
    material = case.rocker.material or arm.material
    if material is None:
        return None
    return SecondArmBar(case.rocker, numbers["follower.arm.length"], material)


def second_loads(bar: SecondArmBar, cam: LoadedCam) -> SectionLoads:
    """Loads (..., n) of the section of the second arm of a loaded cam."""
    return bar.loads(cam.output_force, cam.jet.lift, cam.acceleration)


class _JudgedSection(NamedTuple):
    """Section of an arm that is judged: its loads on a loaded cam, material and surface finish."""

    section: ArmSection
    loads: Callable[[LoadedCam], SectionLoads]
    material: Material
    surface: Surface


def _arms(numbers: Numbers, which: str = "sections") -> tuple[_JudgedSection, ...]:
    """Sections of the arm, and of the second one of conjugate discs; () where not described.

    which: name of those of `ArmBar`: `sections`, all, `pivot` or `roller`
    """

    def loads(number: int, bar: ArmBar, section: ArmSection, cam: LoadedCam) -> SectionLoads:
        return bar.loads(section, arm_forces(cam, number))

    return tuple(
        _JudgedSection(
            each._replace(name=("", "second arm ")[number] + each.name),
            partial(loads, number, bar, each),
            *(bar.material, bar.arm.surface),
        )
        for number, bar in enumerate(bars_of(numbers))
        for each in getattr(bar, which)
    )


def _second_arm(numbers: Numbers) -> tuple[_JudgedSection, ...]:
    """Section of the second arm at the pivot; () without one, or without a material."""
    bar = second_bar_of(numbers)
    if bar is None:
        return ()
    return (
        _JudgedSection(bar.section, partial(second_loads, bar), bar.material, bar.rocker.surface),
    )


def arm_forces(cam: LoadedCam, number: int = 0) -> ArmForces:
    """Forces on the arm of a loaded cam (..., n), or on the second one of conjugate discs, number
    1, along and across its own travel, which is opposite to that of the first.
    """
    motion, across, normal, _ = cam.on_bodies[number]
    sense, inertia = _arm_of(cam.numbers).sense, np.asarray(cam.inertia - cam.output_inertia)
    closing = np.asarray(cam.closing - cam.output_closing)
    if number:
        numbers = cam.numbers
        ratio = numbers["follower.arm.length"] / numbers["cam.conjugate.arm_length"]
        sense, inertia, closing = -sense, -ratio * inertia, 0.0 * closing
    loaded = np.real(normal) > (_LEAST_FORCE if cam.pulls else 0.0)
    return ArmForces(
        across=across,
        pressed=across * motion.pressing,
        along=np.asarray(-sense * across * motion.side),
        normal=normal,
        closing=closing,
        inertia=inertia,
        away=np.where(loaded, cam.follower_moment, 0.0) / np.where(loaded, cam.normal, 1.0),
    )


def _nan_first(each: tuple[Extreme, _JudgedSection]) -> float:
    return -np.inf if np.isnan(each[0].value) else each[0].value


def _governing(section: ArmSection) -> str:
    distance = shown(float(section.distance), "mm")
    return f"governing section: {section.name}, {distance} from the pivot"


def _reliability(numbers: Numbers) -> tuple[float]:
    """Factor k_e of the reliability of an arm."""
    return (reliability_factor(float(numbers.limit(SHAFT_RELIABILITY))),)


def _strength(judged: _JudgedSection, rest: Value) -> tuple[Value, ...]:
    """Endurance strength of a section (...), Pa, and its factors of surface k_a and size k_b; all
    NaN where the material has no tensile or fatigue strength.

    Parameters
    ----------
    rest : float   factor of the reliability
    """
    card = judged.material
    tensile, endured = card.tensile_strength, card.fatigue_bending
    if tensile is None or endured is None:
        return (np.nan,) * 3
    finish = surface_factor(judged.surface, tensile)
    size = size_factor(judged.section.diameter)
    return finish * size * rest * endured, finish, size


def _used(judged: _JudgedSection, stresses: tuple[Array, Array], rest: Value) -> Array:
    """Inverse (4, ...) of the fatigue safety factor at the corners of a section by Goodman's line;
    NaN without a tensile strength.

    Parameters
    ----------
    stresses : pair   amplitude and mean at the corners (4, ...), Pa
    rest : float      factor of the reliability
    """
    amplitude, mean = stresses
    tensile = judged.material.tensile_strength or np.nan
    return np.asarray(amplitude / _strength(judged, rest)[0] + mean / tensile)


def fatigue_use(cam: LoadedCam, at: ArmPlace, *, along: bool = False) -> Array:
    """Inverse (..., 1) of the fatigue safety factor at a place of an arm over the turn of a loaded
    cam (..., n); NaN without section, strength or notch factor.

    Parameters
    ----------
    along : bool   that of each cam angle (n,), see `ArmSection.range_to`
    """
    sections = at.sections(cam.numbers)
    if not sections:
        return np.full_like(cam.normal[..., :1], np.nan)
    ranged = ArmSection.range_to if along else ArmSection.amplitude_and_mean
    (rest,) = cam.numbers.each(_reliability, (f"limits.{SHAFT_RELIABILITY.id}",))
    uses = (_used(each, ranged(each.section, each.loads(cam)), rest) for each in sections)
    return np.asarray(np.max([each.max(axis=0) for each in uses], axis=0))


class ArmPlace(NamedTuple):
    """Place of an arm that is judged: its words, its part of the scope, keys and sections."""

    where: str
    part: PartName
    needs: Literal["arm", "roller"]
    table: str
    method: str
    loads: str
    reason: str
    card: Mapping[str, str]
    values: tuple[str, ...]
    levers: tuple[Lever, ...]
    lacking: Callable[[Numbers], tuple[str, ...]]
    sections: Callable[[Numbers], tuple[_JudgedSection, ...]]


_METHOD = "Goodman line, bending, torsion and force along the arm over the turn"
_CARD = {
    "S_e'": f"{_ARM}.material.fatigue_bending",
    "R_m": f"{_ARM}.material.tensile_strength",
}


def _at(place: Literal["pivot", "roller"], needs: Literal["arm", "roller"]) -> ArmPlace:
    """The arm at its pivot or roller."""
    return ArmPlace(
        *(f"arm at its {place}", "arm", needs, _ARM, f"{_METHOD}, by contact, spring and inertia"),
        *(_LOADS, _BREAKS, _CARD, _VALUES, _LEVERS),
        lambda numbers: _lacking(_arm_of(numbers), f"{place}_notch"),
        partial(_arms, which=place),
    )


_OF_SECOND = ArmPlace(
    *("second arm at its pivot", "rocker", "arm", Rocker.table),
    f"{_METHOD}, by its output and its own inertia",
    "M, F: moment in the plane of the cam and force along the second arm, by mass, force and spring"
    " of its output and by its own mass, as if without lash; L = 0, T = 0",
    "a broken second arm drops what it moves, and its spring no longer holds the follower",
    dict.fromkeys(_CARD, f"{STATED} [MPa]"),
    (*given.LENGTH, "rocker.notch"),
    (*(levers.one(f"rocker.{key}", most=2.0) for key in ("depth", "width")), *levers.LOAD),
    _lacking_of_second,
    _second_arm,
)


def _fatigue(name: str, at: ArmPlace) -> Declaration:
    """Check of the fatigue of an arm at a place; name: its id."""

    @check(
        ARM_SAFETY,
        id=name,
        title=f"Fatigue safety factor of the {at.where}",
        method=at.method,
        lift_can_help=True,
        tier=Tier.SCREENING,
        needs=at.needs,
        part=at.part,
        kept_as=f"normal force at the fatigue of the {at.where}",
        formula="1/(s_a/S_e + s_m/R_m) >= S; s_a, s_m: von Mises amplitude and mean of K_f (M/W +"
        " F/A + L/W_y) and K_f T/W_t over a turn, S_e = k_a k_b k_e S_e': endurance with factors of"
        " surface, size and reliability, S: limits.arm_safety. Least over the sections;"
        f" {at.loads}",
        symbols={
            **dict.fromkeys(("s_a", "s_m"), f"{STATED} [MPa]"),
            **dict.fromkeys(("k_a", "k_b", "k_e"), STATED),
            **at.card,
            "S_e": "[MPa]",
        },
        reason=at.reason,
        values=(
            *at.values,
            f"{at.table}.material.tensile_strength",
            f"{at.table}.material.fatigue_bending",
            "limits.shaft_reliability",
        ),
        levers=at.levers,
        page="Follower",
        scales_with=(NORMAL_FORCE, 1.0),
        along=lambda solution, cycle: fatigue_use(cam_of(solution, cycle), at, along=True),
    )
    def fatigue(solution: Solution) -> Demand:
        """Least fatigue safety factor over the sections at the place and the load cases."""
        machine, limit = solution.machine, solution.machine.limits[ARM_SAFETY]
        missing, sections = at.lacking(solution.numbers), at.sections(solution.numbers)
        if sections:
            card = sections[0].material
            missing += lacking_of_card(card, "fatigue_bending", "tensile_strength")
        if not sections or missing:
            return Demand(None, limit, missing=missing)
        (rest,) = _reliability(solution.numbers)

        @cache
        def stresses(judged: _JudgedSection, cycle: Cycle) -> tuple[Array, Array]:
            return judged.section.amplitude_and_mean(judged.loads(cam_of(solution, cycle)))

        def safety_of(judged: _JudgedSection) -> Callable[[Cycle], float]:
            """Function for the fatigue safety factor of a section over the turn of a load case."""
            return lambda cycle: float(
                rating_over(1.0, _used(judged, stresses(judged, cycle), rest).max(), np.inf)
            )

        worst, judged = min(
            (
                (worst_case(solution.cycles, safety_of(each), at_least=True), each)
                for each in sections
            ),
            key=_nan_first,
        )
        _, finish, size = map(float, _strength(judged, rest))
        amplitude, mean = map(np.ravel, stresses(judged, cycle_of(solution.cycles, worst)))
        k = first_greatest(_used(judged, (amplitude, mean), rest))
        stated = {
            "s_a": float(amplitude[k]),
            "s_m": float(mean[k]),
            "k_a": finish,
            "k_b": size,
            "k_e": rest,
            "S_e'": card.fatigue_bending or np.nan,
            "R_m": card.tensile_strength or np.nan,
        }
        return Demand(
            worst.value,
            limit,
            worst,
            note=_governing(judged.section),
            figures=(
                _source(solution.numbers, at.table),
                machine.limits.source(SHAFT_RELIABILITY),
                f"{card.name}: {card.source}",
                "Shigley, 10th ed., sec. 6-9 (to be confirmed)",
            ),
            method=f"{_METHOD}; fatigue notch factor {judged.section.notch:g}, k_a {finish:.3f}"
            f" ({judged.surface}), k_b {size:.3f}, k_e {rest:.3f}",
            stated={
                key: value for key, value in stated.items() if STATED in at.card.get(key, STATED)
            },
        )

    return fatigue


JUDGED: Mapping[str, ArmPlace] = {
    "arm_fatigue_pivot": _at("pivot", "arm"),
    "arm_fatigue_roller": _at("roller", "roller"),
    "rocker_fatigue": _OF_SECOND,
}
"""Places that are judged by their fatigue, by check."""
arm_fatigue_pivot, arm_fatigue_roller, rocker_fatigue = (
    _fatigue(name, at) for name, at in JUDGED.items()
)


def _yield_allowed(numbers: Numbers) -> Allowed:
    """Allowed stress of the arm, Pa: yield strength over the safety; its missing keys."""
    arm, holds_pin = _arm_of(numbers), "pin" in numbers.known_case.facing.parts
    missing = _lacking(arm, "pivot_notch", *(("roller_notch",) if holds_pin else ()))
    if arm.material is None or missing:
        return Allowed(None, missing)
    return Allowed(arm.material.core_yield / numbers.limit(ARM_YIELD_SAFETY))


def _second_allowed(numbers: Numbers) -> Allowed:
    """Allowed stress of the second arm, Pa: yield strength over the safety; its missing keys."""
    missing, bar = _lacking_of_second(numbers), second_bar_of(numbers)
    if bar is None or missing:
        return Allowed(None, missing)
    return Allowed(bar.material.core_yield / numbers.limit(ARM_YIELD_SAFETY))


def _with_section(
    sections: Callable[[Numbers], tuple[_JudgedSection, ...]], demand: Demand, solution: Solution
) -> Demand:
    """Demand with the section that governs, its loads, N and N m, and its moduli."""
    every = sections(solution.numbers)
    if demand.at is None or not every:
        return demand
    cycle, k = row_of(solution.cycles, demand.at)
    cam = cam_of(solution, cycle)
    worst = max(every, key=lambda each: float(each.section.greatest(each.loads(cam))[k]))
    section, loads, card = worst.section, worst.loads(cam), worst.material
    return replace(
        demand,
        note=_governing(section),
        figures=(f"{card.name}: {card.source}",),
        stated={
            "M": abs(float(loads.bending[k])),
            "F": abs(float(loads.along[k])),
            "L": abs(float(loads.sideways[k])),
            "T": float(loads.twisting[k]),
            "W": float(section.modulus),
            "A": float(section.area),
            "W_y": float(section.side_modulus),
            "W_t": float(section.torsion_modulus),
            "K_f": float(section.notch),
            "R_p": card.core_yield,
        },
    )


def _yield_check(
    words: str, part: PartName, loads: str, reason: str, table: str, values: tuple[str, ...],
    change: tuple[Lever, ...],
) -> Declaring:  # fmt: skip
    """Declaration of the check of the greatest stress of an arm against yield."""
    return check(
        ARM_YIELD_SAFETY,
        title=f"Greatest von Mises stress of the {words} at a notch",
        unit="MPa",
        method="bending, torsion and force along the arm at every section, with the fatigue notch"
        " factors",
        lift_can_help=True,
        tier=Tier.SCREENING,
        needs="arm",
        part=part,
        kept_as=f"von Mises stress of the {words}",
        formula="sqrt((K_f (M/W + F/A + L/W_y))^2 + 3 (K_f T/W_t)^2) <= R_p / S; K_f: fatigue notch"
        " factor, W, A, W_y, W_t: moduli and area of the section, R_p: yield strength of the core,"
        " S: limits.arm_yield_safety. Greatest over the sections at pivot and roller, all angles"
        f" and load cases; {loads}",
        symbols={
            **dict.fromkeys(("M", "L", "T"), f"{STATED} [N m]"),
            "F": f"{STATED} [N]",
            **dict.fromkeys(("W", "W_y", "W_t"), f"{STATED} [mm^3]"),
            "A": f"{STATED} [mm^2]",
            "K_f": STATED,
            "R_p": f"{STATED} [MPa]",
        },
        reason=f"a bent arm moves the roller off its path; {reason}",
        values=(*values, f"{table}.material.*yield_strength"),
        levers=change,
        page="Follower",
        scales_with=(NORMAL_FORCE, 1.0),
    )


def _greatest(sections: tuple[_JudgedSection, ...], cam: LoadedCam) -> Array:
    """Greatest von Mises stress over sections at each cam angle (..., n), Pa; NaN without any."""
    if not sections:
        return np.full_like(cam.normal, np.nan)
    worst, *others = (each.section.greatest(each.loads(cam)) for each in sections)
    for other in others:
        # a NaN of either stays one
        worst = np.where(np.real(other) <= np.real(worst), worst, other + 0.0 * worst)
    return worst


@_yield_check("arm", "arm", _LOADS, _BREAKS, _ARM, _VALUES, _LEVERS).measured(
    "angles",
    allowed=_yield_allowed,
    remark=partial(_with_section, _arms),
    deviation=0.005,
    bounded="line",
    kept=Kept(unit="MPa"),
)
def arm_yield(cam: LoadedCam) -> Array:
    """Greatest von Mises stress over the sections of the arm at each cam angle (..., n), Pa; NaN
    where the arm is not described.
    """
    return _greatest(_arms(cam.numbers), cam)


@_yield_check(
    *("second arm", _OF_SECOND.part, _OF_SECOND.loads, _OF_SECOND.reason, Rocker.table),
    *(_OF_SECOND.values, _OF_SECOND.levers),
).measured(
    "angles",
    allowed=_second_allowed,
    remark=partial(_with_section, _second_arm),
    deviation=0.005,
)
def rocker_yield(cam: LoadedCam) -> Array:
    """Von Mises stress of the second arm at its pivot at each cam angle (..., n), Pa; NaN where it
    is not described.
    """
    return _greatest(_second_arm(cam.numbers), cam)

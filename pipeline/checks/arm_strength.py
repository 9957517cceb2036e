"""Checks of the arm of an oscillating follower: fatigue at pivot and roller, yield."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import levers
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import ARM_SAFETY, ARM_YIELD_SAFETY, SHAFT_RELIABILITY
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE
from camwright.pipeline.checks.extremes import Extreme, cam_of, cycle_of, row_of, worst_case
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.arm_beam import ArmBar, ArmForces, ArmSection
from camwright.pipeline.follower.shaft_strength import (
    fatigue_safety,
    reliability_factor,
    size_factor,
    surface_factor,
)

_ARM = FollowerArm.table
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
    " contact force alone"
)


def _lacking(arm: FollowerArm, *keys: str) -> tuple[str, ...]:
    return lacking(arm.table, arm, "width", "depth", "material", *keys)


def _arm_of(numbers: Numbers) -> FollowerArm:
    """Arm of the case; InputError where it has none."""
    arm = numbers.known_case.follower.arm
    if arm is None:
        raise InputError(_ARM, "missing", "given for its checks")
    return arm


def bar_of(numbers: Numbers) -> ArmBar | None:
    """Arm of a case as a bar; None where it is not described."""
    case, link = numbers.known_case, numbers.known_case.spring.link
    arm = None if case.follower.arm is None else numbers.of_part(case.follower.arm)
    link = None if link is None else numbers.of_part(link)
    return ArmBar.of(arm, case.facing, numbers["follower.mass"], link)


def arm_forces(cam: LoadedCam) -> ArmForces:
    """Forces on the arm of a loaded cam (..., n)."""
    across, sense = cam.axial, _arm_of(cam.numbers).sense
    return ArmForces(
        across=across,
        pressed=across * cam.motion.pressing,
        along=np.asarray(-sense * across * cam.motion.side),
        normal=cam.normal,
        closing=cam.closing,
        inertia=cam.inertia,
        couple=cam.follower_moment,
    )


def _nan_first(each: tuple[Extreme, ArmSection]) -> float:
    return -np.inf if np.isnan(each[0].value) else each[0].value


def _governing(section: ArmSection) -> str:
    distance = shown(float(section.distance), "mm")
    return f"governing section: {section.name}, {distance} from the pivot"


def _sections(bar: ArmBar, place: str) -> tuple[ArmSection, ...]:
    return bar.pivot if place == "pivot" else bar.roller


def _strength(section: ArmSection, bar: ArmBar, reliability: float) -> tuple[float, ...]:
    """Endurance strength of a section, Pa, and its factors of surface k_a, size k_b and reliability
    k_e; all NaN where the material has no tensile or fatigue strength.

    Parameters
    ----------
    reliability : float   share of the arms that survive, 0.5 to 1
    """
    card = bar.material
    tensile, endured = card.tensile_strength, card.fatigue_bending
    if tensile is None or endured is None:
        return (np.nan,) * 4
    finish, rest = surface_factor(bar.arm.surface, tensile), reliability_factor(reliability)
    size = size_factor(section.diameter)
    return finish * size * rest * endured, finish, size, rest


def _arm_fatigue(place: Literal["pivot", "roller"], needs: Literal["", "roller"]) -> Declaration:
    """Check of the fatigue of the arm at its pivot or roller.

    Parameters
    ----------
    needs : str   kind of follower that has this place, see `Kind`; "": any
    """
    notch = f"{place}_notch"

    @check(
        ARM_SAFETY,
        id=f"arm_fatigue_{place}",
        title=f"Fatigue safety factor of the arm at its {place}",
        method="Goodman line, bending, torsion and force along the arm over the turn, by contact,"
        " spring and inertia",
        lift_can_help=True,
        needs=needs,
        part="arm",
        kept_as=f"normal force at the fatigue of the arm at its {place}",
        formula="1/(s_a/S_e + s_m/R_m) >= S; s_a, s_m: von Mises amplitude and mean of K_f (M/W +"
        " F/A + L/W_y) and K_f T/W_t over a turn, S_e = k_a k_b k_e S_e': endurance with factors of"
        f" surface, size and reliability, S: limits.arm_safety. Least over the sections; {_LOADS}",
        symbols={
            **dict.fromkeys(("s_a", "s_m"), f"{STATED} [MPa]"),
            **dict.fromkeys(("k_a", "k_b", "k_e"), STATED),
            "S_e'": "follower.arm.material.fatigue_bending",
            "R_m": "follower.arm.material.tensile_strength",
            "S_e": "[MPa]",
        },
        reason=_BREAKS,
        values=(
            *_VALUES,
            "follower.arm.material.tensile_strength",
            "follower.arm.material.fatigue_bending",
            "limits.shaft_reliability",
        ),
        levers=_LEVERS,
        page="Follower",
        scales_with=(NORMAL_FORCE, 1.0),
    )
    def fatigue(solution: Solution) -> Demand:
        """Least fatigue safety factor over the sections at the place and the load cases."""
        machine, limit = solution.machine, solution.machine.limits[ARM_SAFETY]
        arm, bar = _arm_of(solution.numbers), machine.arm_bar
        missing = _lacking(arm, notch)
        if arm.material is not None:
            missing += lacking_of_card(arm.material, "fatigue_bending", "tensile_strength")
        if bar is None or missing:
            return Demand(None, limit, missing=missing)
        tensile, rest = bar.material.tensile_strength or np.nan, machine.limits[SHAFT_RELIABILITY]

        @cache
        def stresses(section: ArmSection, cycle: Cycle) -> tuple[Array, Array]:
            forces = arm_forces(cam_of(solution, cycle))
            return section.amplitude_and_mean(bar.loads(section, forces))

        def safety_of(section: ArmSection) -> Callable[[Cycle], float]:
            """Function for the fatigue safety factor of a section over the turn of a load case."""
            endured = np.array([_strength(section, bar, rest)[0]])

            def safety(cycle: Cycle) -> float:
                amplitude, mean = stresses(section, cycle)
                return float(fatigue_safety(amplitude[None], mean[None], endured, tensile)[0])

            return safety

        worst, section = min(
            (
                (worst_case(solution.cycles, safety_of(each), at_least=True), each)
                for each in _sections(bar, place)
            ),
            key=_nan_first,
        )
        endured, finish, size, reliable = _strength(section, bar, rest)
        amplitude, mean = stresses(section, cycle_of(solution.cycles, worst))
        k = first_greatest(amplitude / endured + mean / tensile)
        return Demand(
            worst.value,
            limit,
            worst,
            note=_governing(section),
            figures=(
                arm.source,
                machine.limits.source(SHAFT_RELIABILITY),
                f"{bar.material.name}: {bar.material.source}",
                "Shigley, 10th ed., sec. 6-9 (to be confirmed)",
            ),
            method="Goodman line, bending, torsion and force along the arm over the turn;"
            f" fatigue notch factor {section.notch:g}, k_a {finish:.3f} ({arm.surface}), k_b"
            f" {size:.3f}, k_e {reliable:.3f}",
            stated={
                "s_a": float(amplitude[k]),
                "s_m": float(mean[k]),
                "k_a": finish,
                "k_b": size,
                "k_e": reliable,
            },
        )

    return fatigue


arm_fatigue_pivot = _arm_fatigue("pivot", "")
arm_fatigue_roller = _arm_fatigue("roller", "roller")


def _yield_allowed(numbers: Numbers) -> Allowed:
    """Allowed stress of the arm, Pa: yield strength over the safety; its missing keys."""
    arm, holds_pin = _arm_of(numbers), "pin" in numbers.known_case.facing.parts
    missing = _lacking(arm, "pivot_notch", *(("roller_notch",) if holds_pin else ()))
    if arm.material is None or missing:
        return Allowed(None, missing)
    return Allowed(arm.material.core_yield / numbers.limit(ARM_YIELD_SAFETY))


def _with_section(demand: Demand, solution: Solution) -> Demand:
    """Demand with the section that governs, its loads, N and N m, and its moduli."""
    bar = solution.machine.arm_bar
    if demand.at is None or bar is None:
        return demand
    cycle, k = row_of(solution.cycles, demand.at)
    forces = arm_forces(cam_of(solution, cycle))
    section = max(bar.sections, key=lambda each: float(each.greatest(bar.loads(each, forces))[k]))
    loads = bar.loads(section, forces)
    return replace(
        demand,
        note=_governing(section),
        figures=(f"{bar.material.name}: {bar.material.source}",),
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
            "R_p": bar.material.core_yield,
        },
    )


@check(
    ARM_YIELD_SAFETY,
    title="Greatest von Mises stress of the arm at a notch",
    unit="MPa",
    method="bending, torsion and force along the arm at every section, with the fatigue notch"
    " factors",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="arm",
    kept_as="von Mises stress of the arm",
    formula="sqrt((K_f (M/W + F/A + L/W_y))^2 + 3 (K_f T/W_t)^2) <= R_p / S; K_f: fatigue notch"
    " factor, W, A, W_y, W_t: moduli and area of the section, R_p: yield strength of the core, S:"
    f" limits.arm_yield_safety. Greatest over the sections at pivot and roller, all angles and load"
    f" cases; {_LOADS}",
    symbols={
        **dict.fromkeys(("M", "L", "T"), f"{STATED} [N m]"),
        "F": f"{STATED} [N]",
        **dict.fromkeys(("W", "W_y", "W_t"), f"{STATED} [mm^3]"),
        "A": f"{STATED} [mm^2]",
        "K_f": STATED,
        "R_p": f"{STATED} [MPa]",
    },
    reason=f"a bent arm moves the roller off its path; {_BREAKS}",
    values=(*_VALUES, "follower.arm.material.*yield_strength"),
    levers=_LEVERS,
    page="Follower",
    scales_with=(NORMAL_FORCE, 1.0),
).measured(
    "angles",
    allowed=_yield_allowed,
    remark=_with_section,
    deviation=0.005,
    bounded="line",
    kept=Kept(unit="MPa"),
)
def arm_yield(cam: LoadedCam) -> Array:
    """Greatest von Mises stress over the sections of the arm at each cam angle (..., n), Pa; NaN
    where the arm is not described.
    """
    bar, forces = bar_of(cam.numbers), arm_forces(cam)
    if bar is None:
        return np.full_like(cam.normal, np.nan)
    worst, *others = (each.greatest(bar.loads(each, forces)) for each in bar.sections)
    for other in others:
        # a NaN of either stays one
        worst = np.where(np.real(other) <= np.real(worst), worst, other + 0.0 * worst)
    return worst

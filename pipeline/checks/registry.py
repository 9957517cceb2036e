"""Registry of all checks; checks of a solution."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import ModuleType

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.verdict import in_order
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.case.requirements_section import Waiver
from camwright.pipeline.checks import (
    arm_assembly,
    arm_strength,
    assembly,
    cam_shape,
    camshaft_strength,
    contact_strength,
    flat_face_sliding,
    form_closure,
    gas_spring,
    guide_strength,
    guide_wear,
    jump_and_jamming,
    key_strength,
    manufacture,
    pair_assembly,
    part_data,
    part_strength,
    pivot_bearing,
    roller_bearing,
    shaped_springs,
    solution_verification,
    spring_strength,
    surface_durability,
    torque_balance,
)
from camwright.pipeline.checks.check import (
    STATED,
    Check,
    Declaration,
    Demand,
    Waived,
    check,
    made_from_others,
)
from camwright.pipeline.checks.confirmation import with_values_to_confirm
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.checks.lost_loads import checks_on_sound_loads
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution

MODULES: tuple[ModuleType, ...] = (
    part_data,
    torque_balance,
    cam_shape,
    jump_and_jamming,
    contact_strength,
    form_closure,
    surface_durability,
    roller_bearing,
    guide_strength,
    spring_strength,
    gas_spring,
    shaped_springs,
    part_strength,
    arm_strength,
    key_strength,
    camshaft_strength,
    flat_face_sliding,
    guide_wear,
    pivot_bearing,
    assembly,
    arm_assembly,
    pair_assembly,
    manufacture,
    solution_verification,
)
"""Modules of checks, in the order of the calculation; each check declared in one is listed."""


def declared_in(module: ModuleType) -> Iterator[Declaration]:
    """Checks of a module in their order: by a name of their own, or one of a tuple of them."""
    for value in vars(module).values():
        several = value if isinstance(value, tuple) else (value,)
        yield from (each for each in several if isinstance(each, Declaration))


CHECKS: tuple[Declaration, ...] = tuple(each for module in MODULES for each in declared_in(module))
OF_THE_DESIGN = tuple(each.id for each in CHECKS if not each.evidence)
"""Ids of the checks of the design."""
FORECAST = tuple(
    each
    for each in CHECKS
    if each.must_have and (each.lift_can_help or each.id == TORQUE_REDUCTION.id)
)
"""What a smoother changes: the torque reduction, and what a gentler lift can pass."""
TOLERANCED = tuple(each for each in CHECKS if each.moved_by_tolerance and not each.evidence)
"""Checks of the design whose demand differs at a tolerance corner."""
WAIVERS_WITHOUT_EFFECT = check(
    id="waivers_without_effect",
    title="Waivers without effect",
    unit="waivers",
    source=Source(
        "a waiver names a check of the design; a verification check cannot be waived",
        confirmed=True,
    ),
    method="check ids of the waivers of the case against the ids of its checks",
    must_have=False,
    evidence=True,
    tier=Tier.SCREENING,
    formula="n <= 0; n: waivers that name no check of the design",
    symbols={"n": STATED},
    reason="a waiver without effect improves no check.",
)(made_from_others)
TOLERANCE_CORNERS = check(
    id="tolerance_corners",
    title="Tolerance corners that cannot be solved",
    unit="corners",
    source=Source("tolerances of the case, one at a time and by a seeded sample", confirmed=True),
    method="closed forms at the corners",
    formula="n = 0; n: corners at which loads or guides have no solution",
    symbols={"n": STATED},
    reason="a cam that has no solution at a tolerance cannot be signed",
    evidence=True,
    tier=Tier.PREVIEW,
)(made_from_others)
DECLARED: Mapping[str, Declaration] = {
    each.id: each for each in (*CHECKS, WAIVERS_WITHOUT_EFFECT, TOLERANCE_CORNERS)
}
"""Every declaration by id, in the order of the calculation."""


def _declared(name: str) -> Declaration:
    return DECLARED[name]


def _pickled(declared: Declaration) -> tuple[Callable[[str], Declaration], tuple[str]]:
    return _declared, (declared.id,)


copyreg.pickle(Declaration, _pickled)  # a check from a worker process has the declaration here


def checks_of(
    solution: Solution, declarations: Iterable[Declaration] = CHECKS
) -> tuple[Check, ...]:
    """Checks of a solution, with error bars and waivers, sorted as of `in_order`.

    Checks that do not apply, such as the torque reduction of a cam without an engine, and those
    above the tier of the solution are left out.
    """
    checks = tuple(checks_on_sound_loads(declarations, solution))
    return in_order(waived(with_error_bars(solution, checks), solution.case.waivers))


def all_checks(solution: Solution) -> tuple[Check, ...]:
    """All checks of a solution with their unconfirmed values, and one for unused waivers.

    Those that a deeper solution judges are not evaluated.
    """
    checks = with_values_to_confirm(checks_of(solution), solution.case, OF_THE_DESIGN)
    if solution.tier < Tier.CYCLE:
        mark = f"{solution.tier.word}: "
        checks = tuple(replace(one, method=mark + one.method) for one in checks)
    judged = {one.id for one in checks}
    later = (each.deeper(solution) for each in CHECKS if each.id not in judged)
    checks = (*checks, *(one for one in later if one is not None))
    design_ids = {one.id for one in checks if not one.evidence}
    idle = [waiver.check for waiver in solution.case.waivers if waiver.check not in design_ids]
    if idle:
        count = float(len(idle))
        demand = Demand(count, 0.0, note=", ".join(idle), stated={"n": count})
        checks = (*checks, WAIVERS_WITHOUT_EFFECT.judged(solution.machine, demand))
    return in_order(checks)


def waived(checks: Iterable[Check], waivers: Sequence[Waiver]) -> tuple[Check, ...]:
    """Checks with the waivers of the case; evidence cannot be waived.

    Raises
    ------
    InputError
        If the value of a waiver is not in the unit of its check.
    """
    waiver_of = {w.check: w for w in waivers}
    return tuple(
        one
        if one.evidence or one.id not in waiver_of
        else replace(one, waiver=accepted(waiver_of[one.id], one.unit))
        for one in checks
    )


def accepted(waiver: Waiver, unit: str) -> Waived:
    """Demand that a waiver accepts, in SI, and who accepts it; unit : of the check.

    Raises
    ------
    InputError
        If the accepted value has another unit.
    """
    text = f"{waiver.name}, {waiver.date}: {waiver.reason}"
    quantity = In("" if unit == "-" else unit)
    try:
        return Waived(text, quantity.read(waiver.up_to))
    except InputError as error:
        raise InputError(f"waivers.{waiver.check}.up_to", waiver.up_to, error.limit) from None

"""Every check of a trial, waivers applied."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from camwright.pipeline.checks import (
    cam_shape,
    camshaft_strength,
    contact_strength,
    flat_face_sliding,
    guide_bushes,
    jump_and_jamming,
    manufacture,
    part_strength,
    plane_strain_validity,
    proof,
    roller_bearing,
    room,
    solution_verification,
    spring_strength,
    surface,
    surface_durability,
    wear_and_grease,
)
from camwright.pipeline.checks import torque_balance as function
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.verdict import in_order

if TYPE_CHECKING:
    from camwright.pipeline.case.requirements_section import Waiver

CheckFunction = Callable[[TrialEvidence], Check | None]

DESIGN: tuple[CheckFunction, ...] = (
    *function.CHECKS,
    *cam_shape.CHECKS,
    *jump_and_jamming.CHECKS,
    *contact_strength.CHECKS,
    *roller_bearing.CHECKS,
    *guide_bushes.CHECKS,
)
"""Limits on the design itself."""

SLOW = (cam_shape.self_intersection, cam_shape.second_contact)
"""Searches over all pairs of places: too slow to foresee a cam not yet chosen."""

ALL: tuple[CheckFunction, ...] = (
    *DESIGN,
    *surface_durability.CHECKS,
    *flat_face_sliding.CHECKS,
    *solution_verification.CHECKS,
)


SIGNED: tuple[CheckFunction, ...] = (
    *jump_and_jamming.SIGNED,
    *contact_strength.SIGNED,
    *room.CHECKS,
    *roller_bearing.SIGNED,
    *guide_bushes.SIGNED,
    *surface.CHECKS,
    *camshaft_strength.CHECKS,
    *manufacture.CHECKS,
)
"""What a sign-off asks for besides."""

PROOF: tuple[CheckFunction, ...] = (*plane_strain_validity.CHECKS, *proof.CHECKS)
"""What the plane model leaves out; meshes and benchmarks behind the figures of a trial."""

PARTS: tuple[CheckFunction, ...] = (
    *part_strength.CHECKS,
    *spring_strength.CHECKS,
    *wear_and_grease.CHECKS,
)
"""Limits of the parts around the cam, which only a trial with its cycles tells of."""


def all_checks(trial: TrialEvidence) -> tuple[Check, ...]:
    """Every check of a trial: not evaluated first, then by falling utilisation.

    A check that does not apply, such as the torque reduction of a cam without an engine, is
    left out.
    """
    found = checked_by(trial, (*ALL, *PROOF, *SIGNED, *PARTS))
    known = {check.id for check in found if not check.evidence} | {"tolerance_corners"}
    idle = [waiver.check for waiver in trial.case.waivers if waiver.check not in known]
    return in_order((*found, _idle_waivers(idle))) if idle else found


def _idle_waivers(names: Sequence[str]) -> Check:
    """A waiver that fits no check, or one of the evidence, which stands or falls by itself."""
    return Check(
        id="idle_waivers",
        title="Waivers of no effect",
        demand=float(len(names)),
        limit=0.0,
        unit="waivers",
        source="a waiver names a check of the design; a wrong number cannot be accepted",
        method="names of the case's waivers against the ids of its checks",
        must_have=False,
        note=", ".join(names),
    )


def design_checks(trial: TrialEvidence) -> tuple[Check, ...]:
    """The checks of the design that are quick; of closed-form cycles, without parts and rolling."""
    return checked_by(trial, (function for function in DESIGN if function not in SLOW))


def waived(checks: Iterable[Check], waivers: Sequence[Waiver]) -> tuple[Check, ...]:
    """The checks, each with the waiver the case has for it; the evidence cannot be waived."""
    texts = {w.check: f"{w.name}, {w.date}: {w.reason}" for w in waivers}
    return tuple(
        check if check.evidence else replace(check, waiver=texts.get(check.id)) for check in checks
    )


def checked_by(trial: TrialEvidence, functions: Iterable[CheckFunction]) -> tuple[Check, ...]:
    """The checks that some functions find, with error bars and waivers, in order."""
    found = [check for check in (function(trial) for function in functions) if check is not None]
    return in_order(waived(with_error_bars(trial, found), trial.case.waivers))

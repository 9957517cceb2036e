"""Every check of a trial, waivers applied."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from pipeline.checks import (
    contact,
    evidence,
    face,
    forces,
    function,
    geometry,
    guides,
    manufacture,
    parts,
    plane,
    proof,
    roller,
    rolling,
    room,
    running,
    shaft,
    spring,
    surface,
)
from pipeline.checks.check import Check
from pipeline.checks.errors import with_error_bars
from pipeline.checks.trial import TrialEvidence
from pipeline.checks.verdict import in_order

if TYPE_CHECKING:
    from pipeline.design_fields import Waiver

CheckFunction = Callable[[TrialEvidence], Check | None]

DESIGN: tuple[CheckFunction, ...] = (
    *function.CHECKS,
    *geometry.CHECKS,
    *forces.CHECKS,
    *contact.CHECKS,
    *roller.CHECKS,
    *guides.CHECKS,
)
"""Limits on the design itself."""

SLOW = (geometry.self_intersection, geometry.second_contact)
"""Searches over all pairs of places: too slow to foresee a cam not yet chosen."""

ALL: tuple[CheckFunction, ...] = (*DESIGN, *rolling.CHECKS, *face.CHECKS, *evidence.CHECKS)


SIGNED: tuple[CheckFunction, ...] = (
    *forces.SIGNED,
    *contact.SIGNED,
    *room.CHECKS,
    *roller.SIGNED,
    *guides.SIGNED,
    *surface.CHECKS,
    *shaft.CHECKS,
    *manufacture.CHECKS,
)
"""What a sign-off asks for besides."""

PROOF: tuple[CheckFunction, ...] = (*plane.CHECKS, *proof.CHECKS)
"""What the plane model leaves out; meshes and benchmarks behind the figures of a trial."""

PARTS: tuple[CheckFunction, ...] = (*parts.CHECKS, *spring.CHECKS, *running.CHECKS)
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

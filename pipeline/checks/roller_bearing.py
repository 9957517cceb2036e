"""Limits of the roller's bearing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import (
    TrialEvidence,
    cited,
    greatest,
    rollers_only,
    worst_case,
)
from camwright.pipeline.follower.roller_motion import rating_life, roller_motion, static_safety

if TYPE_CHECKING:
    from camwright.pipeline.cycle.cycle import Cycle

RPM = 30.0 / np.pi


def _spin(evidence: TrialEvidence, cycle: Cycle) -> Array:
    """Speed of the roller on its pin, rad/s, (n,)."""
    contour = evidence.contour.require_roller()
    speed = evidence.cam_speed(cycle)
    return roller_motion(contour.pitch, contour.roller_radius, speed, cycle.theta).spin


def _life(evidence: TrialEvidence, cycle: Cycle) -> float:
    """L10, hours; NaN without a rating or a force, infinite for a roller at rest."""
    rating, force = evidence.case.roller.bearing.C, cycle.loads.normal_force
    if rating is None or not np.isfinite(force).all():
        return np.nan
    spin = _spin(evidence, cycle)
    return rating_life(force, spin, rating).hours if spin.any() else np.inf


@rollers_only
def roller_static(evidence: TrialEvidence) -> Check:
    """Static safety s0 of the bearing."""
    bearing = evidence.case.roller.bearing
    rating = bearing.C0
    worst = greatest(evidence, lambda cycle: cycle.loads.normal_force)
    return Check(
        id="roller_static",
        title="Static safety of the roller bearing",
        demand=static_safety(worst.value, rating)
        if rating is not None and worst.value > 0
        else None,
        limit=evidence.case.limits.roller_static_safety,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "roller_static_safety", "s0 = C0/P0, ISO 76", f"{bearing.name}: {bearing.source}"
        ),
        method="static rating over the greatest normal force",
        lift_can_help=True,
        note="" if rating is not None else f"no static rating is given for {bearing.name}",
        **worst.place,
    )


@rollers_only
def roller_life(evidence: TrialEvidence) -> Check:
    """Rating life of the bearing over the turn."""
    bearing = evidence.case.roller.bearing
    rating, target = bearing.C, evidence.case.limits.roller_life

    worst = worst_case(evidence, lambda cycle: _life(evidence, cycle), at_least=True)
    missing = [
        text
        for value, text in ((rating, "no dynamic rating"), (target, "no life is asked for"))
        if value is None
    ]
    return Check(
        id="roller_life",
        title="Rating life L10 of the roller bearing",
        demand=worst.value,
        limit=None if target is None else target / 3600.0,
        unit="h",
        sense="at_least",
        source=evidence.source(
            "roller_life", "ISO 281", f"{bearing.name}: {bearing.source}".rstrip(": ")
        ),
        method="(C / P_m)^3 million revolutions, P_m the cube mean of the normal force",
        lift_can_help=True,
        note="; ".join(missing),
        **worst.place,
    )


@rollers_only
def roller_speed(evidence: TrialEvidence) -> Check:
    """Roller speed against the share of the bearing's limiting speed."""
    bearing = evidence.case.roller.bearing
    share, ceiling = evidence.case.limits.roller_speed_share, bearing.speed_limit
    limit = None if ceiling is None else RPM * share * ceiling
    worst = greatest(evidence, lambda cycle: np.abs(_spin(evidence, cycle)))
    return Check(
        id="roller_speed",
        title="Speed of the roller",
        demand=RPM * worst.value,
        limit=limit,
        unit="rpm",
        source=evidence.source("roller_speed_share", "share of the maker's limit", bearing.source),
        method="rolling without slip: w (|dP/dtheta| - r) / r",
        lift_can_help=True,
        note="" if limit is not None else f"no limiting speed is given for {bearing.name}",
        **worst.place,
    )


@rollers_only
def roller_radial(evidence: TrialEvidence) -> Check:
    """Greatest force on the roller against what its outer ring bears unsupported."""
    bearing = evidence.case.roller.bearing
    limit = bearing.radial_limit
    worst = greatest(evidence, lambda cycle: cycle.loads.normal_force)
    return Check(
        id="roller_radial",
        title="Force on the roller against the rating of its outer ring",
        demand=worst.value,
        limit=limit,
        unit="N",
        source=cited("F_r,max of a track roller", f"{bearing.name}: {bearing.source}"),
        method="greatest normal force over the turn",
        lift_can_help=True,
        note=""
        if limit is not None
        else f"{bearing.name} has no rating for an outer ring without a housing",
        **worst.place,
    )


CHECKS = (roller_static, roller_life, roller_speed)
SIGNED = (roller_radial,)
"""What a sign-off asks for besides; a look ahead does without."""

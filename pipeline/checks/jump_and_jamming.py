"""Limits on the forces that keep the follower on the cam and free in its guides."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, greatest, least

if TYPE_CHECKING:
    from camwright.pipeline.cycle.cycle import Cycle

RPM = 30.0 / math.pi


def contact_margin(evidence: TrialEvidence) -> dict[str, Any]:
    """What every check of the least contact force over the preload is held against."""
    return {
        "limit": evidence.case.limits.contact_force_margin,
        "unit": "-",
        "sense": "at_least",
        "source": evidence.source(
            "contact_force_margin", "0.2 to 0.3 of the preload at the highest speed, Norton (2009)"
        ),
    }


def jam_limit(evidence: TrialEvidence) -> dict[str, Any]:
    """What every jam index is held against."""
    return {
        "limit": evidence.case.limits.jam_index,
        "unit": "-",
        "source": evidence.source(
            "jam_index", "locks at 1, Rothbart (2004) eq. 6.8; half of it held"
        ),
    }


def contact_force_margin(evidence: TrialEvidence) -> Check:
    """Least contact force beside the preload."""
    worst = least(evidence, lambda cycle: cycle.loads.normal_force / evidence.preload(cycle))
    return Check(
        id="contact_force_margin",
        title="Least contact force over preload",
        demand=worst.value,
        **contact_margin(evidence),
        method="least normal force over the turn, guide friction and inertia included",
        lift_can_help=True,
        **worst.place,
    )


def jump(evidence: TrialEvidence) -> Check:
    """Share of the spring force that the follower's inertia takes away from the contact."""
    worst = greatest(
        evidence,
        lambda cycle: np.maximum(
            demands.unloading(cycle.loads.inertia_force, cycle.loads.spring_force), 0.0
        ),
    )
    return Check(
        id="jump",
        title="Unloading inertia over spring force",
        demand=worst.value,
        limit=evidence.case.limits.jump,
        unit="-",
        source=evidence.source(
            "jump", "F_s + m w^2 s'' > 0, follower jump, Norton (2009) and Rothbart (2004)"
        ),
        method="greatest -m w^2 s'' / F_s over the turn; the jump speed is w / sqrt of it",
        lift_can_help=True,
        **worst.place,
    )


def jam_index(evidence: TrialEvidence) -> Check:
    """How near the guides are to locking on the rise."""
    worst = greatest(
        evidence,
        lambda cycle: demands.jam_outward(cycle.loads.lift_slope, cycle.loads.jam_index),
    )
    return Check(
        id="jam_index",
        title="Jam index",
        demand=worst.value,
        **jam_limit(evidence),
        method="greatest friction of both guides over the cam's axial push on the way out, the"
        " guides with their length and clearance",
        lift_can_help=True,
        note=_on_points(evidence),
        **worst.place,
    )


def _on_points(evidence: TrialEvidence) -> str:
    """The same on point supports, c |tan alpha| with c = (mu_A (a + b) + mu_B a) / b."""
    worst = greatest(
        evidence,
        lambda cycle: demands.jam_outward(cycle.loads.lift_slope, cycle.loads.jam_index_statics),
    )
    return f"{worst.value:.3g} on point supports"


def jump_speed(evidence: TrialEvidence) -> Check:
    """Crank speed at which the follower leaves the cam, against the over-speed."""
    worst = least(evidence, _jump_speed)
    factor = evidence.case.limits.jump_speed
    over, note = _overspeed(evidence)
    return Check(
        id="jump_speed",
        title="Crank speed of the first jump",
        demand=RPM * worst.value,
        limit=RPM * factor * over,
        unit="rpm",
        sense="at_least",
        source=evidence.source(
            "jump_speed", f"{factor} times the over-speed, Norton (2009), Rothbart (2004): verify"
        ),
        method="least w sqrt(F_s / (-m w^2 s'')) where the follower slows, friction-free",
        lift_can_help=True,
        note=note,
        load_case="",
        cam_angle_deg=worst.cam_angle_deg,
        error_share=worst.error_share,
    )


def contact_at_overspeed(evidence: TrialEvidence) -> Check:
    """Least contact force at the over-speed beside the preload."""
    over, note = _overspeed(evidence)

    def force(cycle: Cycle) -> Array:
        scale = (over / cycle.crank_speed) ** 2
        loads = cycle.loads
        return np.asarray(
            demands.force_left(
                loads.spring_force, scale * loads.inertia_force, evidence.preload(cycle)
            )
        )

    worst = least(evidence, force)
    return Check(
        id="contact_at_overspeed",
        title="Least contact force over preload at the over-speed",
        demand=worst.value,
        **contact_margin(evidence),
        method="least spring force plus m w^2 s'' at the over-speed, friction-free",
        lift_can_help=True,
        note=note,
        load_case="",
        cam_angle_deg=worst.cam_angle_deg,
        error_share=worst.error_share,
    )


def _jump_speed(cycle: Cycle) -> Array:
    """Crank speed (n,), rad/s, at which each place of the turn lets go; a NaN stays."""
    pull = -cycle.loads.inertia_force
    slows = pull > 0
    ratio = np.sqrt(cycle.loads.spring_force / np.where(slows, pull, 1.0))
    free = np.where(np.isnan(pull), np.nan, np.inf)
    return np.where(slows, cycle.crank_speed * ratio, free)


def _overspeed(evidence: TrialEvidence) -> tuple[float, str]:
    """Over-speed of the crank, rad/s, and what to say of it."""
    over = evidence.case.limits.overspeed
    fastest = max(cycle.crank_speed for cycle in evidence.cycles)
    if over is not None and over >= fastest:
        return over, ""
    return fastest, "no over-speed is given: that of the fastest load case"


CHECKS = (contact_force_margin, jump, jam_index)
SIGNED = (
    jump_speed,
    contact_at_overspeed,
)
"""What a sign-off asks for besides; a look ahead does without."""

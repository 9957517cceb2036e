"""Limits on the forces that keep the follower on the cam and free in its guides."""

from __future__ import annotations

import numpy as np

from pipeline.checks import demands
from pipeline.checks.check import Check
from pipeline.checks.trial import TrialEvidence, greatest, least


def contact_force_margin(evidence: TrialEvidence) -> Check:
    """Least contact force beside the preload."""
    worst = least(evidence, lambda cycle: cycle.loads.normal_force / evidence.preload(cycle))
    return Check(
        id="contact_force_margin",
        title="Least contact force over preload",
        demand=worst.value,
        limit=evidence.limit("contact_force_margin", 0.2),
        unit="-",
        sense="at_least",
        source=evidence.source(
            "contact_force_margin", "0.2 to 0.3 of the preload at the highest speed, Norton (2009)"
        ),
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
        limit=evidence.limit("jump", 1.0),
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
        limit=evidence.limit("jam_index", 0.5),
        unit="-",
        source=evidence.source("jam_index", "locks at 1, Rothbart (2004) eq. 6.8; half of it held"),
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


CHECKS = (contact_force_margin, jump, jam_index)

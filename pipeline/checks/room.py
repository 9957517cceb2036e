"""Limits of the room around the cam."""

from __future__ import annotations

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence


def guide_clearance(evidence: TrialEvidence) -> Check:
    """Gap between guide A and whatever of cam and follower comes nearest."""
    case, contour = evidence.case, evidence.contour
    pitch, guide = contour.pitch, case.guides.a
    overhang = case.follower.overhang_at_max_lift
    mouth = overhang - 0.5 * guide.length
    highest = pitch.height_base + pitch.lift.highest.value + mouth
    face = evidence.face
    behind = contour.require_roller().roller_radius if face is None else face.thickness
    gap = float(np.minimum(highest - contour.radius_max().value, mouth - behind))
    return Check(
        id="guide_clearance",
        title=f"Gap between guide A and cam or {evidence.facing_name}",
        demand=1e3 * gap,
        limit=1e3 * case.limits.clearance,
        unit="mm",
        sense="at_least",
        source=evidence.source("clearance", "1 to 2 mm, shop practice: verify"),
        method="guide's face less the greatest contour radius, and less the "
        f"{evidence.facing_name}, at full lift",
        lift_can_help=True,
        note="the spring's and the frame's places are not in the case",
    )


def cam_envelope(evidence: TrialEvidence) -> Check:
    """Greatest radius of the cam beside the room there is."""
    value, theta = evidence.contour.radius_max()
    room = evidence.case.limits.cam_radius
    return Check(
        id="cam_envelope",
        title="Greatest radius of the cam",
        demand=1e3 * float(value),
        limit=None if room is None else 1e3 * room,
        unit="mm",
        cam_angle_deg=float(np.rad2deg(theta)) % 360.0,
        source=evidence.source("cam_radius", "room as given in the case"),
        method="greatest radius of the contour, refined between samples",
        lift_can_help=True,
        note="" if room is not None else "no room for the cam is given",
    )


CHECKS = (guide_clearance, cam_envelope)

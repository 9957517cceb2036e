"""Limits of a flat face that slides on the cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, greatest

if TYPE_CHECKING:
    from camwright.pipeline.cycle.cycle import Cycle


def face_width(evidence: TrialEvidence) -> Check | None:
    """The contact stays on the face, half-width included."""
    face = evidence.face
    if face is None:
        return None
    path = evidence.contour.pitch

    def needed(cycle: Cycle) -> Array:
        return 2.0 * (np.abs(path.push_arm(cycle.theta)) + cycle.contact.half_width)

    worst = greatest(evidence, needed)
    return Check(
        id="face_width",
        title="Width of the face that the contact needs",
        demand=1e3 * worst.value,
        limit=1e3 * face.width,
        unit="mm",
        source="contact inside the face, Norton (2009) ch. 7",
        method="twice the greatest |s' - e| plus the contact's half-width",
        lift_can_help=True,
        **worst.place,
    )


def face_sliding(evidence: TrialEvidence) -> Check | None:
    """Mean contact pressure times sliding speed beside what the pair bears without scuffing."""
    face = evidence.face
    if face is None:
        return None
    worst = greatest(evidence, _pv)
    limit = face.pv_limit
    return Check(
        id="face_sliding",
        title="Contact pressure times sliding speed of the face",
        demand=1e-6 * worst.value,
        limit=None if limit is None else 1e-6 * limit,
        unit="MPa m/s",
        source=face.source or "PV limit of the face as given",
        method="greatest pi/4 p0 w (r + s) over the turn",
        must_have=limit is not None,
        lift_can_help=True,
        note="" if limit is not None else "no PV limit of the face is given",
        **worst.place,
    )


def _pv(cycle: Cycle) -> Array:
    """Pressure times speed (n,), Pa m/s; NaN where it is not known."""
    sliding = None if cycle.rolling is None else cycle.rolling.sliding
    return np.full(cycle.theta.size, np.nan) if sliding is None else sliding.pv


CHECKS = (face_width, face_sliding)

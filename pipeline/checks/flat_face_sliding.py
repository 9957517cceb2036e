"""Checks of a flat face sliding on the cam: width and PV value."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base import levers
from camwright.pipeline.base import value_groups as given
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import greatest
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution


@check(
    title="Required face width",
    tier=Tier.SCREENING,
    unit="mm",
    source="contact inside the face, Norton (2009) ch. 7",
    method="twice the sum of |s' - e| and contact half-width, greatest over the turn",
    lift_can_help=True,
    needs="face",
    formula="2 (|s' - e| + a) <= w; s': slope of the lift, e: cam.offset, a: half-width of the"
    " contact, w: follower.face.width",
    reason="beyond the face the contact runs on its edge",
    levers=(levers.one("follower.face.width"), *levers.GENTLER),
    page="Flat face",
)
def face_width(solution: Solution) -> Demand | None:
    """Required width of the face, contact half-width included, m."""
    face = solution.machine.face
    if face is None:
        return None

    def needed(cycle: Cycle) -> Array:
        arm = np.abs(cycle.contour.pitch.push_arm(cycle.theta))
        return 2.0 * (arm + cycle.contact.half_width)

    worst = greatest(solution.cycles, needed)
    return Demand(worst.value, face.width, worst)


@check(
    title="PV value of the flat face",
    tier=Tier.SCREENING,
    unit="MPa m/s",
    source="PV limit of the face",
    method="greatest pi/4 p0 w (r + s) over the turn",
    lift_can_help=True,
    needs="face",
    formula="pi/4 p0 omega (r + s) <= PV; p0: contact pressure, omega: speed of the cam, r: base"
    " radius, s: lift, PV: follower.face.pv_limit",
    reason="a face slides at all angles, and beyond its PV limit it seizes or melts",
    values=(*given.CONTACT, "follower.face.pv_limit"),
    levers=(levers.one("follower.face.depth"), *levers.GENTLER),
    page="Flat face",
)
def face_pv(solution: Solution) -> Demand | None:
    """Mean contact pressure times sliding speed, Pa m/s."""
    face = solution.machine.face
    if face is None:
        return None
    worst, limit = greatest(solution.cycles, _pv), face.pv_limit
    return Demand(
        worst.value,
        limit,
        worst,
        lacking(face.table, face, "pv_limit"),
        source=face.source,
    )


def _pv(cycle: Cycle) -> Array:
    """PV value (n,), Pa m/s; NaN where it is not known."""
    sliding = cycle.rolling.sliding
    return np.full(cycle.theta.size, np.nan) if sliding is None else sliding.pv

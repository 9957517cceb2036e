"""Limits on the shape of the cam, held over the continuous turn and not at samples only."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.extrema import greatest
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, rollers_only

RESTING = 1e-9  # swing of s'' over the lift, 1/rad^2, of a cam that is round
TOOL_ALLOWANCE = 1.1  # a hollow is ground by a wheel at least a tenth smaller


def closure(evidence: TrialEvidence) -> Check:
    """The lift ends its turn where it began."""
    return Check(
        id="closure",
        title="Lift closes after one turn",
        demand=float(evidence.contour.pitch.lift.closure),
        limit=evidence.case.limits.closure,
        unit="m",
        source=evidence.source("closure", "fundamental law of cam design, Norton (2009) ch. 2"),
        method="difference of the lift at the two ends of the turn, as its source gave it",
    )


def acceleration_step(evidence: TrialEvidence) -> Check:
    """The acceleration has no step: what is left between samples shrinks with their distance."""
    lift = evidence.contour.pitch.lift
    bend = np.asarray(lift(lift.theta, 2), dtype=float)
    steps = np.abs(np.diff(bend, append=bend[:1]))
    worst, swing = int(np.argmax(steps)), float(np.ptp(bend))
    return Check(
        id="acceleration_step",
        title="Step of the acceleration over its swing",
        # Rest, and the round-off of it, has no step.
        demand=0.0 if swing <= RESTING * lift.highest.value else float(steps[worst] / swing),
        limit=evidence.case.limits.acceleration_step,
        unit="-",
        cam_angle_deg=_degrees(float(lift.theta[worst])),
        source=evidence.source(
            "acceleration_step", "finite jerk, fundamental law of cam design, Norton (2009) ch. 2"
        ),
        method=f"greatest difference of s'' between {len(lift.theta)} neighbouring samples of the"
        " lift over all of its swing: a jump stays, a slope does not",
        lift_can_help=True,
    )


@rollers_only
def pressure_angle(evidence: TrialEvidence) -> Check:
    """Greatest angle between the contact normal and the follower's axis."""
    value, theta = evidence.contour.pitch.pressure_angle_max()
    limit = float(np.rad2deg(evidence.case.limits.pressure_angle))
    return Check(
        id="pressure_angle",
        title="Pressure angle",
        demand=float(np.rad2deg(abs(value))),
        limit=round(limit, 9),  # 30, not 29.9...96
        unit="deg",
        cam_angle_deg=_degrees(theta),
        source=evidence.source(
            "pressure_angle", "30 deg for a translating follower, Rothbart (2004) ch. 6"
        ),
        method="greatest |atan((s' - e)/d)| of the pitch curve, refined between samples",
        lift_can_help=True,
    )


@rollers_only
def curvature_ratio(evidence: TrialEvidence) -> Check:
    """Least convex radius of the pitch curve beside that of the roller."""
    contour = evidence.contour.require_roller()
    value, theta = contour.pitch.least_convex_radius()
    return Check(
        id="curvature_ratio",
        title="Least convex pitch radius over roller radius",
        demand=float(value / contour.roller_radius),
        limit=evidence.case.limits.curvature_ratio,
        unit="-",
        sense="at_least",
        cam_angle_deg=_degrees(theta),
        source=evidence.source("curvature_ratio", "1.5 to 3 roller radii, Norton (2009) ch. 7"),
        method="least radius of curvature of the convex pitch curve, refined between samples",
        lift_can_help=True,
    )


def undercut(evidence: TrialEvidence) -> Check:
    """What the offset by the roller leaves of the pitch curve's arc, or a face of its height."""
    found = evidence.contour.undercut()
    if evidence.rolls:
        factor, default = "1 - r kappa", "1 - r kappa > 0, a cusp at zero, Rothbart (2004) ch. 6"
        method = "least 1 - roller radius x pitch curvature, refined between samples"
    else:
        factor, default = "(r + s + s'')/(r + s)", "r + s + s'' > 0, Norton (2009) ch. 7"
        method = "least radius of curvature over the face's height, refined between samples"
    return Check(
        id="undercut",
        title=f"Undercut factor {factor}",
        demand=float(found.factor),
        limit=evidence.case.limits.undercut_factor,
        unit="-",
        sense="at_least",
        cam_angle_deg=_degrees(found.theta),
        source=evidence.source("undercut_factor", default),
        method=method,
        lift_can_help=True,
    )


def self_intersection(evidence: TrialEvidence) -> Check:
    """The contour crosses itself nowhere."""
    crossings = evidence.contour.self_intersections()
    return Check(
        id="self_intersection",
        title="Contour crosses itself",
        demand=float(len(crossings)),
        limit=0.0,
        unit="crossings",
        cam_angle_deg=_degrees(crossings[0][0]) if crossings else None,
        source="a contour that crosses itself is cut away",
        method="crossings of the contour with itself, found between samples too",
        lift_can_help=True,
    )


def second_contact(evidence: TrialEvidence) -> Check:
    """The follower touches the cam in one place only."""
    nearest = evidence.contour.second_contact()
    return Check(
        id="second_contact",
        title=f"{evidence.facing_name.capitalize()} cuts into another part of the cam",
        demand=1e3 * float(np.maximum(0.0, -nearest.clearance)),  # NaN stays, infinity is no depth
        limit=1e3 * evidence.case.limits.second_contact_depth,
        unit="mm",
        cam_angle_deg=_degrees(nearest.theta),
        source=evidence.source(
            "second_contact_depth", "one contact at a time, Rothbart (2004) ch. 6"
        ),
        method=f"depth of the {evidence.facing_name} in contour parts away from its contact",
        lift_can_help=True,
    )


@rollers_only
def concave_radius(evidence: TrialEvidence) -> Check | None:
    """Room for the tool in the hollow flanks; a cam without a hollow asks for none."""
    value, theta = evidence.contour.concave_radius_min()
    if np.isposinf(value):
        return None
    tool = evidence.case.largest_tool
    return Check(
        id="concave_radius",
        title="Least hollow radius of the contour",
        demand=1e3 * value,
        limit=None if tool is None else 1e3 * TOOL_ALLOWANCE * tool,
        unit="mm",
        sense="at_least",
        cam_angle_deg=_degrees(theta),
        source=evidence.source(
            "tool_radius", "hollow at least a tenth above the tool radius, Rothbart (2004) ch. 6"
        ),
        method="least concave pitch radius plus the roller radius, refined between samples",
        lift_can_help=True,
        note="" if tool is not None else "no tool radius is given",
    )


def curvature_rate(evidence: TrialEvidence) -> Check | None:
    """How fast the contour's curvature changes; a case that gives no bound asks for none."""
    limit, contour = evidence.case.limits.curvature_rate, evidence.contour
    if limit is None:
        return None
    count = contour.pitch.lift.search_count
    worst = greatest(lambda theta: np.abs(contour.curvature_slope(theta)), count)
    return Check(
        id="curvature_rate",
        title="Change of the contour's curvature",
        demand=float(worst.value),
        limit=limit,
        unit="1/m/rad",
        cam_angle_deg=_degrees(worst.theta),
        source=evidence.source("curvature_rate", "bound of the case, for grinding and for wear"),
        method="greatest change of curvature per radian of cam angle, refined between samples",
        lift_can_help=True,
    )


def minimum_wall(evidence: TrialEvidence) -> Check:
    """The ring of steel about the bore and its keyway."""
    cam = evidence.case.cam
    contour = evidence.contour
    keyway = cam.keyway
    # The key's far edge may point at the lowest place of the contour; assume it does.
    inside = cam.bore_radius + (keyway.depth if keyway is not None else 0.0)
    outside, theta = contour.radius_min()
    return Check(
        id="minimum_wall",
        title="Least contour radius over bore radius with keyway",
        demand=float(outside / inside),
        limit=evidence.case.limits.minimum_wall,
        unit="-",
        sense="at_least",
        cam_angle_deg=_degrees(theta),
        source=evidence.source("minimum_wall", "hub of 1.75 shaft diameters, common practice"),
        method="least contour radius over bore radius plus keyway depth",
    )


def spring_travel(evidence: TrialEvidence) -> Check:
    """The spring is not driven solid."""
    travel = evidence.case.spring.travel_max
    lift = evidence.contour.pitch.lift
    return Check(
        id="spring_travel",
        title="Lift against spring travel",
        demand=1e3 * float(lift.highest.value),
        limit=None if travel is None else 1e3 * float(travel),
        unit="mm",
        cam_angle_deg=_degrees(lift.highest.theta),
        source="travel of the spring as given in the case",
        method="greatest lift, between samples too",
        lift_can_help=True,
        note="" if travel is not None else "no spring travel is given",
    )


CHECKS = (
    closure,
    acceleration_step,
    pressure_angle,
    curvature_ratio,
    undercut,
    self_intersection,
    second_contact,
    concave_radius,
    curvature_rate,
    minimum_wall,
    spring_travel,
)


def _degrees(theta: float) -> float | None:
    return float(np.rad2deg(np.mod(theta, FULL_TURN))) if np.isfinite(theta) else None

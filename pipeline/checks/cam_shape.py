"""Checks of the cam shape, refined between samples."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.extrema import Extremum
from camwright.geometry.extrema import greatest as greatest_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    ACCELERATION_STEP,
    CLOSURE,
    CURVATURE_RATE,
    CURVATURE_RATIO,
    MINIMUM_WALL,
    PRESSURE_ANGLE,
    SECOND_CONTACT_DEPTH,
    TOOL_RADIUS,
    UNDERCUT_FACTOR,
)
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import Extreme
from camwright.pipeline.cycle.solution import Solution

AT_REST = 1e-9  # range of s'' over the lift, 1/rad^2, of a round cam
TOOL_ALLOWANCE = 1.1  # minimum concave radius over tool radius


def _place(theta: float) -> Extreme:
    """Cam angle of a demand; None where it is not finite."""
    return Extreme(np.nan, "", float(np.mod(theta, FULL_TURN)) if np.isfinite(theta) else None)


def _at(extremum: Extremum) -> Extreme:
    return _place(float(extremum.theta))


@check(
    CLOSURE,
    title="Lift closure over one turn",
    unit="m",
    method="difference of the lift between the ends of the turn, before closing",
    forecast=True,
    moved_by_tolerance=False,
)
def closure(solution: Solution) -> Demand:
    """Difference of the lift between the ends of the turn, m."""
    lift = solution.contour.pitch.lift
    return Demand(float(lift.closure), solution.machine.limits[CLOSURE])


@check(
    ACCELERATION_STEP,
    title="Maximum acceleration step / acceleration range",
    method="greatest difference of s'' between neighbouring samples over the range of s'';"
    " independent of the spacing at a discontinuity",
    lift_can_help=True,
    forecast=True,
    moved_by_tolerance=False,
)
def acceleration_step(solution: Solution) -> Demand:
    """Greatest step of the acceleration between samples over its range."""
    lift = solution.contour.pitch.lift
    bend = np.asarray(lift(lift.theta, 2), dtype=float)
    steps = np.abs(np.diff(bend, append=bend[:1]))
    worst, swing = int(np.argmax(steps)), float(np.ptp(bend))
    return Demand(
        # round-off of a cam at rest is no step
        0.0 if swing <= AT_REST * lift.highest.value else float(steps[worst] / swing),
        solution.machine.limits[ACCELERATION_STEP],
        _place(float(lift.theta[worst])),
        note=f"{len(lift.theta)} samples",
    )


@check(
    PRESSURE_ANGLE,
    title="Maximum pressure angle",
    method="greatest |atan((s' - e)/d)| of the pitch curve, refined between samples",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def pressure_angle(solution: Solution) -> Demand:
    """Greatest angle between contact normal and follower axis, rad."""
    extremum = solution.contour.pitch.pressure_angle_max()
    allowed = solution.machine.limits[PRESSURE_ANGLE]
    return Demand(float(abs(extremum.value)), allowed, _at(extremum))


@check(
    CURVATURE_RATIO,
    title="Minimum convex pitch radius / roller radius",
    method="least radius of curvature of the convex pitch curve, refined between samples",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def curvature_ratio(solution: Solution) -> Demand:
    """Least convex radius of the pitch curve over the roller radius."""
    contour = solution.contour.require_roller()
    extremum = contour.pitch.least_convex_radius()
    ratio = float(extremum.value / contour.roller_radius)
    return Demand(ratio, solution.machine.limits[CURVATURE_RATIO], _at(extremum))


@check(
    UNDERCUT_FACTOR,
    id="undercut",
    title="Minimum undercut factor",
    method="least 1 - roller radius x pitch curvature, refined between samples",
    lift_can_help=True,
    forecast=True,
)
def undercut(solution: Solution) -> Demand:
    """Undercut factor: 1 - r kappa, of a face (r + s + s'')/(r + s)."""
    least = solution.contour.undercut()
    return Demand(
        float(least.factor),
        solution.machine.limits[UNDERCUT_FACTOR],
        _place(float(least.theta)),
        method=""
        if solution.machine.face is None
        else "least (r + s + s'')/(r + s), refined between samples",
    )


@check(
    title="Contour self-intersections",
    unit="crossings",
    source="no undercut: the cutter removes a self-intersecting part",
    method="number of crossings of the contour with itself, between samples too",
    lift_can_help=True,
    moved_by_tolerance=False,
)
def self_intersection(solution: Solution) -> Demand:
    """Number of crossings of the contour with itself."""
    crossings = solution.contour.self_intersections()
    return Demand(float(len(crossings)), 0.0, _place(crossings[0][0]) if crossings else None)


@check(
    SECOND_CONTACT_DEPTH,
    id="second_contact",
    title="Interference of the {follower} outside the contact",
    method="greatest penetration of the follower into the contour outside the contact",
    lift_can_help=True,
    moved_by_tolerance=False,
)
def second_contact(solution: Solution) -> Demand:
    """Penetration of the follower into the contour outside the contact, m."""
    nearest = solution.contour.second_contact()
    depth = float(np.maximum(0.0, -nearest.clearance))  # NaN stays, infinite clearance is 0
    place = _place(float(nearest.theta))
    return Demand(depth, solution.machine.limits[SECOND_CONTACT_DEPTH], place)


@check(
    TOOL_RADIUS,
    id="concave_radius",
    title="Minimum concave radius",
    method="least concave pitch radius plus the roller radius, refined between samples",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def concave_radius(solution: Solution) -> Demand | None:
    """Least concave radius of the contour, m; None for a convex cam."""
    least, allowed = solution.contour.concave_radius_min(), least_concave_radius(solution.case)
    if np.isposinf(least.value):
        return None
    return Demand(
        float(least.value),
        allowed,
        _at(least),
        note="" if allowed is not None else "no tool radius is given",
    )


def least_concave_radius(case: Case) -> float | None:
    """Minimum concave radius that the tool of the case can machine, m; None without a tool."""
    tool = case.largest_tool
    return None if tool is None else TOOL_ALLOWANCE * tool


@check(
    CURVATURE_RATE,
    title="Maximum rate of change of contour curvature",
    method="greatest change of curvature per radian of cam angle, refined between samples",
    lift_can_help=True,
    forecast=True,
)
def curvature_rate(solution: Solution) -> Demand | None:
    """Greatest change of the contour's curvature, 1/(m rad); None without a bound."""
    allowed, contour = solution.machine.limits[CURVATURE_RATE], solution.contour
    if allowed is None:
        return None
    count = contour.pitch.lift.search_count
    worst = greatest_of(lambda theta: np.abs(contour.curvature_slope(theta)), count)
    return Demand(float(worst.value), allowed, _at(worst))


@check(
    MINIMUM_WALL,
    title="Minimum contour radius / bore radius including keyway",
    method="least contour radius over bore radius plus keyway depth",
    forecast=True,
)
def minimum_wall(solution: Solution) -> Demand:
    """Least contour radius over the radius of bore and keyway.

    The keyway is assumed at the cam angle of the least radius.
    """
    outside = solution.contour.radius_min()
    ratio = float(outside.value / solution.machine.cam.held_radius)
    return Demand(ratio, solution.machine.limits[MINIMUM_WALL], _at(outside))


@check(
    title="Maximum lift vs. spring travel",
    unit="mm",
    source="spring travel of the case",
    method="greatest lift, between samples too",
    lift_can_help=True,
    forecast=True,
    moved_by_tolerance=False,
    formula="s_max <= spring.travel_max; s_max: greatest lift",
    reason="The spring and its seat are drawn for that travel.",
)
def spring_travel(solution: Solution) -> Demand:
    """Maximum lift, m, against the spring travel."""
    travel, highest = solution.machine.spring.travel_max, solution.contour.pitch.lift.highest
    note = "" if travel is not None else "no spring travel is given"
    return Demand(float(highest.value), travel, _at(highest), note=note)

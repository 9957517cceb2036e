"""Checks of the cam shape, with extremes refined between samples."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.cutter_path import tool_interference
from camwright.geometry.extrema import Extremum, first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.geometry.second_track import CamDisc
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    ACCELERATION_STEP,
    CLOSURE,
    CURVATURE_RATE,
    CURVATURE_RATIO,
    MINIMUM_WALL,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    SECOND_CONTACT_DEPTH,
    TOOL_RADIUS,
    UNDERCUT_FACTOR,
)
from camwright.pipeline.checks.check import (
    NONE,
    STATED,
    Allowed,
    Demand,
    Kept,
    Stroke,
    check,
    of_key,
)
from camwright.pipeline.checks.extremes import Extreme
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam, not_negative, round_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.spring import of_no_force

_TINY = float(np.finfo(float).tiny)
AT_REST = 1e-9  # range of s'' over the lift, 1/rad^2, of a round cam
TOOL_ALLOWANCE = 1.1  # minimum concave radius over tool radius
_TOOL = "workshop.tool_radius"


def _place(theta: float) -> Extreme:
    """Cam angle of a demand; None where it is not finite."""
    return Extreme(np.nan, "", float(np.mod(theta, FULL_TURN)) if np.isfinite(theta) else None)


def _at(extremum: Extremum) -> Extreme:
    return _place(float(extremum.theta))


@check(
    CLOSURE,
    title="Lift closure over one turn",
    formula="d <= c; d: |s(2 pi) - s(0)| of the lift s as its source gives it, before closing, c:"
    " limits.closure",
    symbols={"d": f"{STATED} [um]"},
    reason="A step of the lift at the end of the turn is a step of the cam surface.",
    unit="um",
    method="difference of the lift between the ends of the turn, before closing",
    evidence=True,
    moved_by_tolerance=False,
    load_cases=NONE,
)
def closure(solution: Solution) -> Demand:
    """Difference of the lift between the ends of the turn, m."""
    lift = solution.contour.pitch.lift
    open_by = float(lift.closure)
    return Demand(open_by, solution.machine.limits[CLOSURE], stated={"d": open_by})


@check(
    ACCELERATION_STEP,
    title="Maximum acceleration step / acceleration range",
    method="greatest discontinuity of s'' by one-sided fits to the values of the lift, over the"
    " range of s''",
    lift_can_help=True,
    moved_by_tolerance=False,
    formula="J / R <= c; J: |s''(theta+) - s''(theta-)|, s'': second derivative of the lift by the"
    " cam angle on either side of theta, R: max s'' - min s'', c: limits.acceleration_step",
    symbols=dict.fromkeys("JR", f"{STATED} [mm/rad^2]"),
    reason="A jump of the acceleration is a jump of the contact force and excites the follower at"
    " every frequency.",
    load_cases=NONE,
    levers=levers.smoothing(1),
    page="Cam",
)
def acceleration_step(solution: Solution) -> Demand:
    """Greatest discontinuity of s'' over the range of s'' in the turn."""
    lift = solution.contour.pitch.lift
    jump = lift.acceleration_jump
    coarse = "the table is too coarse or too rough to tell a step from a bend of the acceleration"
    rests = jump.span <= AT_REST * lift.highest.value
    return Demand(
        # round-off of a cam at rest is no step
        0.0 if rests else jump.size / jump.span,
        solution.machine.limits[ACCELERATION_STEP],
        _place(jump.theta),
        note="" if jump.resolved else coarse,
        stated={} if rests else {"J": jump.size, "R": jump.span},
    )


def sharpness(cam: LoadedCam) -> Array:
    """1 less the undercut factor: 1 at a cusp."""
    return cam.motion.sharpness


def lift(cam: LoadedCam) -> Array:
    """Measure: lift of the follower, m."""
    return cam.jet.lift


def contour_radius(cam: LoadedCam) -> Array:
    """Distance of the contour from the cam axis, m."""
    return cam.motion.contour_radius


def angle_on_rise(cam: LoadedCam) -> Array:
    """Magnitude of the pressure angle on the rise, rad; elsewhere its value at zero slope."""
    return _angle(cam, not_negative(cam.jet.slope))


def angle_on_return(cam: LoadedCam) -> Array:
    """Magnitude of the pressure angle on the return, rad; elsewhere its value at zero slope."""
    return _angle(cam, -not_negative(-cam.jet.slope))


def _angle(cam: LoadedCam, slope: Array) -> Array:
    path = round_of(cam.motion)
    return magnitude(np.arctan((slope - path.travel_offset) / path.height))


def _method_of_undercut(demand: Demand, solution: Solution) -> Demand:
    if solution.machine.follower.contact_radius is not None:
        return demand
    return replace(demand, method="least (r + s + s'')/(r + s), refined between samples")


def _tool_allowed(numbers: Numbers) -> Allowed:
    """Least allowed concave radius of the contour, m, by the tool of the case or the limit of its
    radius.
    """
    limit, stated = numbers.get(f"limits.{TOOL_RADIUS.id}"), numbers.get(_TOOL)
    if limit is None and stated is None:
        return Allowed(None, (_TOOL,))
    allowed = stated if limit is None else limit
    if limit is not None and stated is not None:
        allowed = np.where(np.isnan(limit), stated, limit)[()]
    return Allowed(TOOL_ALLOWANCE * np.asarray(allowed)[()])


def _in_hollow(cam: LoadedCam, hollow: float) -> Array | None:
    """No constraint where the roller is larger: it cannot roll in a smaller hollow."""
    room = hollow - np.asarray(cam.motion.size)
    return -cam.motion.path_curvature * room if room > 0.0 else None


def _wall_left(cam: LoadedCam, limit: float) -> Array | None:
    """No constraint where nothing is held: the prime radius is that of the case."""
    held = cam.numbers.get("cam.held_radius")
    return None if held is None else limit * held / cam.motion.contour_radius


@check(
    PRESSURE_ANGLE,
    title="Maximum pressure angle",
    tier=Tier.SCREENING,
    formula="max |atan((s' - e)/(d + s))| <= alpha; s, s': lift and its slope, e: offset, d:"
    " height of the roller centre at zero lift, alpha: limits.pressure_angle, on the return"
    " limits.return_pressure_angle where the case sets it",
    symbols={
        "s": "lift",
        "s'": "lift_slope",
        "e": "cam.offset",
        "d": "pitch_height",
        "?": "follower.kind roller",
    },
    reason="Side force, guide friction and jamming grow with the tangent of the angle.",
    method="greatest |atan((s' - e)/d)| of the pitch curve, refined between samples",
    lift_can_help=True,
    needs="round",
    load_cases=NONE,
    levers=(*levers.SHAPE, *levers.SPRING),
    page="Cam",
).measured(
    "contour",
    strokes=(
        Stroke(angle_on_rise, PRESSURE_ANGLE, "on the rise"),
        Stroke(angle_on_return, RETURN_PRESSURE_ANGLE, "on the return"),
    ),
    deviation=1e-4,
    kept=Kept(factor_max=inf, value_max=np.radians(60.0)),
)
def pressure_angle(cam: LoadedCam) -> Array:
    """Magnitude of the angle between contact normal and follower axis, rad."""
    return magnitude(cam.motion.pressure_angle)


curvature_ratio = check(
    CURVATURE_RATIO,
    id="curvature_ratio",
    title="Minimum convex pitch radius / roller radius",
    tier=Tier.SCREENING,
    formula="min rho_p / r >= c; rho_p: convex radius of curvature of the pitch curve, r: roller"
    " radius, c: limits.curvature_ratio",
    symbols={
        "rho_p": "1/pitch_curvature [mm]",
        "r": "roller.radius",
    },
    reason="Near a ratio of 1 the convex cam surface becomes an edge.",
    method="least radius of curvature of the convex pitch curve, refined between samples",
    lift_can_help=True,
    needs="round",
    load_cases=NONE,
    levers=(levers.one("roller.radius", -1, 2.0), *levers.SHAPE),
    page="Cam",
).measured(
    "contour",
    value=lambda worst, _: 1.0 / worst,
    deviation=1e-4,
    kept=Kept(lambda cam, limit: cam.motion.sharpness * limit),
)(sharpness)


undercut = check(
    UNDERCUT_FACTOR,
    id="undercut",
    title="Minimum undercut factor",
    tier=Tier.SCREENING,
    formula="min(1 - r kappa_p) >= c; r: roller radius, kappa_p: curvature of the pitch curve, c:"
    " limits.undercut_factor; flat face: min((R + s + s'')/(R + s)), R: base radius",
    symbols={
        "r": "roller.radius",
        "kappa_p": "pitch_curvature",
        "?": "follower.face None",
    },
    reason="At zero the cam has a cusp; below, the follower does not follow the lift.",
    method="least 1 - roller radius x pitch curvature, refined between samples",
    lift_can_help=True,
    load_cases=NONE,
    levers=(levers.one("roller.radius", -1, 2.0), *levers.SHAPE),
    page="Cam",
).measured(
    "contour",
    value=lambda worst, _: 1.0 - worst,
    bound=lambda limit, _: 1.0 - limit,
    remark=_method_of_undercut,
    deviation=1e-4,
    kept=Kept(),
)(sharpness)


@check(
    title="Contour self-intersections",
    formula="n = 0; n: number of pairs of cam angles with the same contour point",
    symbols={"n": STATED},
    reason="A contour that crosses itself bounds no body.",
    unit="crossings",
    source=Source("no undercut: the cutter removes a self-intersecting part", confirmed=True),
    method="number of crossings of the contour with itself, between samples too",
    lift_can_help=True,
    moved_by_tolerance=False,
    load_cases=NONE,
    levers=levers.SHAPE,
    page="Cam",
)
def self_intersection(solution: Solution) -> Demand:
    """Number of crossings of the contour with itself."""
    crossings = [
        disc.angle(each[0]) for disc in solution.discs for each in disc.contour.self_intersections()
    ]
    count, angle = float(len(crossings)), _place(crossings[0]) if crossings else None
    return Demand(count, 0.0, angle, stated={"n": count})


@check(
    SECOND_CONTACT_DEPTH,
    id="second_contact",
    title="Interference of the {follower} outside the contact",
    formula="max(-g, 0) <= d; g: least gap between the follower and any other point of the contour,"
    " d: limits.second_contact_depth",
    symbols={"g": f"{STATED} [mm]"},
    reason="A follower with two contacts does not follow the lift.",
    method="greatest penetration of the follower into the contour outside the contact",
    lift_can_help=True,
    moved_by_tolerance=False,
    load_cases=NONE,
    levers=levers.SHAPE,
    page="Cam",
)
def second_contact(solution: Solution) -> Demand:
    """Greatest penetration of the follower into the contour away from the contact, m; 0 where it
    has a clearance.
    """
    every = [(each, each.contour.second_contact()) for each in solution.discs]
    disc, nearest = every[first_greatest([-one.clearance for _, one in every])]
    depth = float(np.maximum(0.0, -nearest.clearance))  # NaN stays, infinite clearance is 0
    angle, gap = _place(disc.angle(float(nearest.theta))), float(nearest.clearance)
    limit = solution.machine.limits[SECOND_CONTACT_DEPTH]
    return Demand(depth, limit, angle, stated={"g": gap})


@check(
    TOOL_RADIUS,
    id="concave_radius",
    title="Minimum concave radius",
    tier=Tier.SCREENING,
    formula="min(r - 1/kappa_p) >= 1.1 R; the concave radius of the contour: r: radius of roller or"
    " face, kappa_p: curvature of the pitch curve, negative in a hollow, R: limits.tool_radius or"
    " workshop.tool_radius",
    symbols={"r": "surface_radius", "kappa_p": "pitch_curvature"},
    reason="A larger wheel or cutter cannot make the contour.",
    method="least concave pitch radius plus the roller radius, refined between samples",
    lift_can_help=True,
    needs="round",
    load_cases=NONE,
    levers=(levers.TOOL, *levers.SHAPE),
    closed_by="plate",
    page="Cam",
).measured(
    "contour",
    worst="least",
    value=lambda worst, numbers: numbers["follower.surface"] - 1.0 / np.minimum(worst, -_TINY),
    allowed=_tool_allowed,
    applies=lambda radius, _: ~(np.asarray(radius) >= 1.0 / _TINY),
    deviation=1e-4,
    kept=Kept(_in_hollow, unit="mm"),
)
def concave_radius(cam: LoadedCam) -> Array:
    """Measure: pitch curvature, 1/m; demand: least concave radius of the contour, m.

    That of another roller, of a second disc, as of the first at the same concave radius.
    """
    curvature, larger = cam.motion.path_curvature, cam.motion.size - cam.numbers["follower.surface"]
    return curvature / (1.0 - curvature * larger)


@check(
    SECOND_CONTACT_DEPTH,
    id="tool_gouge",
    title="Gouge depth of the tool",
    unit="mm",
    method="greatest penetration of the tool into the contour outside their contact, the tool on"
    " every point of the contour",
    lift_can_help=True,
    moved_by_tolerance=False,
    formula="max(R - D, 0) <= d; D: least |Q - P - R n|, the distance of the middle of the tool"
    " from the contour beside their contact, P, n: point and outward normal of the contour, Q: any"
    " other point of it, R of a convex cam, R: radius of cutter or grinding wheel, d:"
    " limits.second_contact_depth",
    symbols=dict.fromkeys("RD", f"{STATED} [mm]"),
    reason="A wheel that fits the concave radius can still cut a flank across it.",
    load_cases=NONE,
    levers=(levers.TOOL, *levers.SHAPE),
    closed_by="plate",
    page="Cam",
)
def tool_gouge(solution: Solution) -> Demand:
    """Depth of the tool in the contour away from its contact, m; 0 for a convex cam. Not evaluated
    without a tool radius.
    """
    tool = solution.case.workshop_order.tool_radius
    every = [_gouged(disc, tool, solution) for disc in solution.discs]
    return every[first_greatest([np.nan if one.value is None else one.value for one in every])]


def _gouged(disc: CamDisc, tool: float | None, solution: Solution) -> Demand:
    """Depth, m, by which a tool of radius `tool`, m, cuts the contour of one disc away from its
    contact; 0 of a convex contour. Without a value where the tool or the concave radius is not
    known.
    """
    contour, allowed = disc.contour, solution.machine.limits[SECOND_CONTACT_DEPTH]
    concave = contour.concave_radius_min().value
    if np.isposinf(concave):
        touching = {} if tool is None else dict.fromkeys("RD", tool)
        note = "the cam is convex: no tool cuts it twice"
        return Demand(0.0, allowed, note=note, stated=touching)
    if tool is None or np.isnan(concave):
        return Demand(None, allowed, missing=(_TOOL,) if tool is None else ())
    nearest = tool_interference(contour, tool)
    depth = float(np.maximum(0.0, -nearest.clearance))  # NaN stays, infinite clearance is 0
    return Demand(
        depth,
        allowed,
        _place(disc.angle(float(nearest.theta))),
        note=f"tool of {shown(tool, 'mm')}",
        stated={"R": tool, "D": tool + float(nearest.clearance)},
    )


def least_concave_radius(case: Case) -> float | None:
    """Minimum concave radius that the tool of the case can machine, m; None without a tool."""
    tool = case.largest_tool
    return None if tool is None else TOOL_ALLOWANCE * tool


@check(
    CURVATURE_RATE,
    title="Maximum change of contour curvature per length",
    method="greatest |d kappa/ds| along the contour, refined between samples",
    lift_can_help=True,
    formula="max |kappa_p'| / (v (1 - r kappa_p)^3) <= c; d kappa/ds of the contour: kappa_p,"
    " kappa_p': curvature of the pitch curve and its derivative by the cam angle, v: speed along"
    " the pitch curve by the cam angle, r: roller radius, c: limits.curvature_rate; flat face:"
    " |s' + s'''|/(R + s + s'')^3, R: base radius",
    symbols={
        "kappa_p'": "pitch_curvature_slope",
        "v": "pitch_speed",
        "r": "roller.radius",
        "kappa_p": "pitch_curvature",
        "?": "follower.face None",
    },
    reason="Decides where the case sets the limit: its value depends on the grinding machine.",
    load_cases=NONE,
    page="Cam",
).measured(
    "contour",
    remark=lambda demand, _: replace(demand, must_have=demand.allowed is not None),
    order=3,
    kept=Kept(),
)
def curvature_rate(cam: LoadedCam) -> Array:
    """Derivative of the contour's curvature by arc length, 1/m^2."""
    return magnitude(cam.motion.curvature_slope)


minimum_wall = check(
    MINIMUM_WALL,
    id="minimum_wall",
    title="Minimum contour radius / bore radius including keyway",
    tier=Tier.SCREENING,
    formula="min |P| / (R_b + t) >= c; P: contour, R_b: bore radius, t: depth of the keyway, c:"
    " limits.minimum_wall",
    symbols={
        "P": "contour_radius",
        "R_b": "cam.bore_radius",
        "t": "cam.keyway.depth",
    },
    reason="A thinner ring bursts at the keyway or opens on the shaft.",
    method="least contour radius over bore radius plus keyway depth",
    within=("bore",),
    load_cases=NONE,
    levers=(levers.SEAT, *levers.SHAPE),
    page="Cam",
).measured(
    "contour",
    worst="least",
    value=lambda worst, numbers: worst / numbers["cam.held_radius"],
    deviation=1e-4,
    kept=Kept(_wall_left),
)(contour_radius)


spring_travel = check(
    id="spring_travel",
    title="Maximum lift vs. spring travel",
    tier=Tier.SCREENING,
    kept_as="spring travel",
    formula="max s <= x; s: lift, x: spring.travel_max",
    symbols={
        "s": "lift",
    },
    reason="Beyond its travel the spring is solid and the follower is blocked.",
    unit="mm",
    source=Source("spring travel of the case", confirmed=True),
    method="greatest lift, between samples too",
    lift_can_help=True,
    moved_by_tolerance=False,
    load_cases=NONE,
    values=("spring.travel_max",),
    levers=(*levers.SPRING, *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    allowed=of_key("spring.travel_max"),
    applies=lambda _, at: ~of_no_force(at["spring.preload"], at["spring.rate"]),
    deviation=1e-4,
    kept=Kept(unit="mm"),
)(lift)

"""Checks of form closure: walls of a groove, pair of discs, landings in the clearance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.extrema import first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.geometry.second_track import relative_radius
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import (
    ASSEMBLY_GAP,
    CAM_RADIUS,
    CONTACT_FORCE_MARGIN,
    CONTACT_SAFETY,
    CROSSOVER_SLIP,
    FATIGUE_SAFETY,
    FRICTION_BALANCE,
    LANDING_SPEED,
    SECOND_CONTACT_DEPTH,
    SURFACE_TEMPERATURE,
    UNDERCUT_FACTOR,
    WORN_CLEARANCE,
)
from camwright.pipeline.checks import contact_strength
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import NONE, STATED, Allowed, Demand, Kept, check
from camwright.pipeline.checks.extremes import (
    Extreme,
    cam_of,
    cycle_of,
    on_both_tracks,
    row_of,
    worst_case,
)
from camwright.pipeline.checks.flat_face_sliding import bulk_allowed, heat_missing
from camwright.pipeline.checks.missing_keys import lacking_of_card
from camwright.pipeline.contact.cam_body import TWO_TRACKS
from camwright.pipeline.contact.flash_temperature import bulk_rise
from camwright.pipeline.contact.hertz import peak_pressure_square
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cam_balance import groove_of
from camwright.pipeline.cycle.crossover_history import WallImpact
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, round_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.crossover import INNER, OUTER, Landing
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import Carried

INTERFERENCE = "cam.conjugate.interference"
PLATE_MOMENT = 0.509
"""Greatest moment per length at the root of a long cantilever plate over a load at its edge."""


@check(
    UNDERCUT_FACTOR,
    title="Minimum undercut factor of the outer wall",
    formula="min(1 + r kappa_p) >= c; r: radius of its roller, kappa_p: curvature of the pitch"
    " curve, negative in a hollow, c: limits.undercut_factor",
    symbols={"r": "cam.groove.second.radius", "kappa_p": "pitch_curvature"},
    reason="At zero the outer wall has a cusp; below, the roller is not held.",
    tier=Tier.SCREENING,
    method="least 1 + roller radius x pitch curvature, refined between samples",
    lift_can_help=True,
    needs="roller",
    closed_by="groove",
    load_cases=NONE,
    levers=(
        *(levers.one(each, -1, 2.0) for each in ("roller.radius", "cam.groove.second.radius")),
        *levers.SHAPE,
    ),
    page="Cam",
    kept_as="hollow of the outer wall over the roller",
).measured(
    "contour",
    value=lambda worst, _: 1.0 - worst,
    bound=lambda limit, _: 1.0 - limit,
    deviation=1e-4,
    kept=Kept(unit="-"),
)
def outer_undercut(cam: LoadedCam) -> Array:
    """1 less the undercut factor of the outer wall."""
    return -(cam.numbers["cam.groove.second.radius"] * round_of(cam.motion).path_curvature)


@check(
    SECOND_CONTACT_DEPTH,
    title="Interference of the roller with the outer wall outside the contact",
    formula="max(-g, 0) <= d; g: least gap between the roller and any other point of the outer"
    " wall, d: limits.second_contact_depth",
    symbols={"g": f"{STATED} [mm]"},
    reason="A wall that comes back to the roller blocks it.",
    method="greatest penetration of the roller into the outer wall outside the contact",
    lift_can_help=True,
    moved_by_tolerance=False,
    needs="roller",
    closed_by="groove",
    load_cases=NONE,
    levers=levers.SHAPE,
    page="Cam",
)
def outer_second_contact(solution: Solution) -> Demand:
    """Penetration of the roller into the outer wall away from the contact, m."""
    nearest = groove_of(solution.machine.cam, solution.contour).second_contact("outer")
    depth, gap = float(np.maximum(0.0, -nearest.clearance)), float(nearest.clearance)
    at = None if np.isnan(nearest.theta) else Extreme(depth, "", float(nearest.theta))
    return Demand(depth, solution.machine.limits[SECOND_CONTACT_DEPTH], at, stated={"g": gap})


def _wall_allowed(numbers: Numbers) -> Allowed:
    """Greatest pulsating bending stress of the cam by its Goodman line, Pa."""
    card = numbers.known_case.cam.material
    lacks = lacking_of_card(card, "fatigue_bending", "tensile_strength")
    if card.fatigue_bending is None or card.tensile_strength is None:
        return Allowed(None, lacks)
    both = 1.0 / card.fatigue_bending + 1.0 / card.tensile_strength
    return Allowed(2.0 / both / numbers.limit(FATIGUE_SAFETY))


def _of_wall(demand: Demand, solution: Solution) -> Demand:
    """Demand with the source of the material and the radius of the outer wall at its angle."""
    card = solution.machine.cam.material
    judged = replace(demand, figures=(f"{card.name}: {card.source}",))
    if demand.at is None or not demand.at.load_case:
        return judged
    cycle, k = row_of(solution.cycles, demand.at)
    return replace(judged, stated={"P": float(_outer_radius(cam_of(solution, cycle))[k])})


def _outer_radius(cam: LoadedCam) -> Array:
    """Radius of the outer wall (..., n), m, of two rollers that of the widest step at or below the
    second.
    """
    path, second = round_of(cam.motion), cam.numbers.known_case.cam.on_pin
    point = path.contact_point
    if second is not None:
        point = path.inside(-cam.numbers.of_part(second).rim_distance(cam.numbers["roller.radius"]))
    return np.asarray(np.sqrt(point[0] ** 2 + point[1] ** 2))


@check(
    title="Bending stress at the root of the outer wall",
    unit="MPa",
    source=Source(
        "moment 0.509 F at the root of a long cantilever plate under a load at its edge, Jaramillo,"
        " J. Appl. Mech. 17 (1950) 67, recalled: verify; Goodman line of the material",
        confirmed=False,
    ),
    tier=Tier.SCREENING,
    method="the rim as a plate held at the floor, the whole normal force at its edge; it is the"
    " same of any depth",
    lift_can_help=True,
    needs="roller",
    closed_by="groove",
    formula="max(6 0.509 N/(R - |P|)^2) <= 2/((1/f + 1/R_m) S) where the outer wall carries; N:"
    " normal force, R: cam.groove.outer_radius, P: point of the outer wall, of two rollers that of"
    " the widest step at or below the second, f, R_m: fatigue limit in bending and tensile strength"
    " of the cam, S: limits.fatigue_safety",
    symbols={
        "N": "normal_force",
        "R": "cam.groove.outer_radius",
        "P": f"{STATED} [mm]",
        "f": "cam.material.fatigue_bending",
        "R_m": "cam.material.tensile_strength",
        "S": f"limits.{FATIGUE_SAFETY.id}",
    },
    reason="A thin rim breaks off the disc.",
    values=(*given.LOADS, "cam.material.fatigue_bending", "cam.material.tensile_strength"),
    levers=(levers.one("cam.groove.outer_radius", most=1.5), *levers.GENTLER),
    page="Cam",
).measured("angles", allowed=_wall_allowed, remark=_of_wall, deviation=0.02)
def groove_wall(cam: LoadedCam) -> Array:
    """Bending stress at the root of the rim, Pa; infinite without a rim, 0 on the inner wall."""
    thick = cam.numbers["cam.groove.outer_radius"] - _outer_radius(cam)
    left = np.where(thick > 0.0, thick, np.nan)
    stress = np.where(thick > 0.0, 6.0 * PLATE_MOMENT * cam.normal / left**2, np.inf)
    return np.where(cam.wall < 0.0, stress, 0.0 * cam.normal)


@check(
    title="Profile tolerance over the clearance of the groove",
    unit="-",
    source=Source("a roller between walls that close in on it is blocked", confirmed=True),
    tier=Tier.SCREENING,
    method="width of the profile tolerance, by which both walls together may narrow the groove",
    moved_by_tolerance=False,
    needs="roller",
    closed_by="groove",
    formula="T/c <= 1; T: cam.profile_tolerance, c: cam.groove.clearance",
    symbols={"T": "cam.profile_tolerance", "c": "cam.groove.clearance"},
    reason="On both walls at once the roller slides on one of them, seizes or breaks.",
    load_cases=NONE,
    values=("cam.profile_tolerance", "cam.groove.clearance"),
    levers=(levers.one("cam.groove.clearance"), levers.one("cam.profile_tolerance", -1)),
    page="Cam",
).measured("case", allowed=lambda _: Allowed(1.0), deviation=1e-9)
def groove_clearance(cam: LoadedCam) -> Array:
    """Width of the profile tolerance over the clearance of the groove."""
    numbers = cam.numbers
    return np.asarray(numbers["cam.profile_tolerance"] / numbers["cam.groove.clearance"])


@check(
    CAM_RADIUS,
    id="groove_radius",
    title="Radius of the disc around the groove",
    formula="R <= r; R: cam.groove.outer_radius, r: limits.cam_radius",
    symbols={"R": "cam.groove.outer_radius"},
    reason="The cam must fit into its space.",
    tier=Tier.SCREENING,
    method="radius of the disc as stated",
    moved_by_tolerance=False,
    needs="roller",
    closed_by="groove",
    load_cases=NONE,
    levers=(levers.one("cam.groove.outer_radius", -1, 1.5),),
    page="Cam",
).measured("case", deviation=1e-9)
def groove_radius(cam: LoadedCam) -> Array:
    """Radius of the disc, m."""
    return np.asarray(cam.numbers["cam.groove.outer_radius"])


@check(
    ASSEMBLY_GAP,
    id="second_disc_gap",
    title="Gap between each roller and the disc of the other",
    formula="a - (B + b)/2 - |o| >= g; a: cam.conjugate.spacing, B: cam.width, b: roller.width, o:"
    " roller.axial_offset, g: limits.assembly_gap",
    symbols={
        "a": "cam.conjugate.spacing",
        "B": "cam.width",
        "b": "roller.width",
        "o": "roller.axial_offset",
    },
    reason="A roller that runs on both discs at once is blocked.",
    tier=Tier.SCREENING,
    method="distance of the discs along the shaft less half of disc, roller and its axial offset",
    moved_by_tolerance=False,
    needs="roller",
    closed_by="conjugate",
    load_cases=NONE,
    levers=(levers.one("cam.conjugate.spacing"),),
    page="Cam",
).measured("case", deviation=1e-9)
def second_disc_gap(cam: LoadedCam) -> Array:
    """Gap along the shaft, m."""
    numbers = cam.numbers
    spacing, offset = numbers["cam.conjugate.spacing"], numbers.get("roller.axial_offset")
    beside = 0.0 if offset is None else magnitude(np.asarray(offset))
    return np.asarray(spacing - 0.5 * (numbers["cam.width"] + numbers["roller.width"]) - beside)


def _breadths(solution: Solution) -> Array:
    """Breadth of the cam between parallel faces at equal cam angles (n,), m."""
    pitch = solution.contour.pitch
    theta = uniform_turn(2 * (pitch.lift.search_count // 2))
    height = pitch.height(theta)
    return np.asarray(height + np.roll(height, theta.size // 2))


@check(
    title="Change of the breadth of the cam over the clearance of the yoke",
    unit="-",
    source=Source("faces that close in on the cam are blocked", confirmed=True),
    formula="(B - b + T)/c <= 1; B, b: greatest and least breadth of the cam between parallel faces"
    " over the turn, T: cam.profile_tolerance, c: cam.yoke.clearance",
    symbols={
        **dict.fromkeys("Bb", f"{STATED} [mm]"),
        "T": "cam.profile_tolerance",
        "c": "cam.yoke.clearance",
    },
    reason="Only a cam of constant breadth keeps its clearance between two faces.",
    tier=Tier.SCREENING,
    method="breadth of the nominal cam at equal angles, and the width of the profile tolerance",
    lift_can_help=True,
    moved_by_tolerance=False,
    closed_by="yoke",
    load_cases=NONE,
    values=("cam.profile_tolerance", "cam.yoke.clearance"),
    levers=(levers.one("cam.yoke.clearance"), levers.one("cam.profile_tolerance", -1)),
    page="Cam",
)
def yoke_breadth(solution: Solution) -> Demand | None:
    """Change of the breadth with the profile tolerance over the clearance."""
    cam = solution.machine.cam
    if cam.yoke is None:
        return None
    breadth = _breadths(solution)
    most, least = float(breadth.max()), float(breadth.min())
    change = (most - least + cam.profile_tolerance) / cam.yoke.clearance
    return Demand(change, 1.0, stated={"B": most, "b": least})


def _squeezed(cycle: Cycle, narrower: float) -> tuple[Squeezed, Array, Array] | None:
    """Preload over a turn with an interference larger by a length, m, and the forces (2, n) of both
    tracks along the travel of the first roller; None without an interference.
    """
    loads, preload = cycle.loads, cycle.machine.disc_preload
    if preload is None or loads.second is None:
        return None
    more = replace(preload, interference=preload.interference + narrower)
    squeeze = more.at(loads.second.track(cycle.contour.pitch), loads.theta)
    first, second = squeeze.forces(loads.axial_force)
    return squeeze, first, second


def _of_turns(
    solution: Solution, measure: Callable[[Cycle], Array | None], sign: float
) -> tuple[float, Cycle, int] | None:
    """Worst value of a measure over the turns, greatest for a `sign` of 1, least for -1, with its
    cycle and number; None where it does not apply.
    """
    worst: tuple[float, Cycle, int] | None = None
    for cycle in solution.cycles:
        values = measure(cycle)
        if values is None:
            return None
        k = first_greatest(sign * values)
        if worst is None or not sign * values[k] <= sign * worst[0]:
            worst = float(values[k]), cycle, k
    return worst


@check(
    CONTACT_FORCE_MARGIN,
    id="preload_least",
    title="Minimum force on the disc that bears less over the preload",
    formula="min(f - P T/i)/P >= c; f: force on the disc that bears less, along the travel of the"
    " first roller, P: that of both without an axial force, T: cam.profile_tolerance, i:"
    " cam.conjugate.interference, c: limits.contact_force_margin",
    symbols={
        **dict.fromkeys("fP", f"{STATED} [N]"),
        "T": "cam.profile_tolerance",
        "i": INTERFERENCE,
        "c": f"limits.{CONTACT_FORCE_MARGIN.id}",
    },
    reason="A roller without load stops and lands with a blow.",
    tier=Tier.SCREENING,
    method="axial force shared by the compliances of both rollers with what holds them, the"
    " interference less by the width of the profile tolerance",
    lift_can_help=True,
    needs="roller",
    closed_by="preload",
    values=(*given.LOADS, INTERFERENCE, "cam.profile_tolerance"),
    levers=(
        levers.one(INTERFERENCE),
        *(levers.one(each, -1) for each in ("cam.profile_tolerance", "cam.conjugate.wear_depth")),
        levers.MASS,
        *levers.GENTLER,
    ),
    page="Contact",
    kept_as="force of the lesser disc over the preload",
)
def preload_least(solution: Solution) -> Demand | None:
    """Least force of both discs over the preload; None without an interference."""

    def left(cycle: Cycle) -> Array | None:
        pressed = _squeezed(cycle, 0.0)
        if pressed is None:
            return None
        squeeze, first, second = pressed
        lost = cycle.machine.cam.profile_tolerance / squeeze.interference
        return np.asarray(np.minimum(first, second) / squeeze.preload - lost)

    worst = _of_turns(solution, left, -1.0)
    if worst is None:
        return None
    value, cycle, k = worst
    pressed = _squeezed(cycle, 0.0)
    stated = {}
    if pressed is not None:
        squeeze, first, second = pressed
        least = min(float(first[k]), float(second[k]))
        stated = {"f": least, "P": float(squeeze.preload[k])}
    at = Extreme(value, cycle.load_case, float(cycle.theta[k]))
    limit = solution.machine.limits[CONTACT_FORCE_MARGIN]
    return Demand(value, limit, at, note=_preload_words(solution), stated=stated)


def _preload_words(solution: Solution) -> str:
    """Least and greatest preload over the turn, in words."""
    pressed = _squeezed(solution.cycles[0], 0.0)
    if pressed is None:
        return ""
    low, high = float(pressed[0].preload.min()), float(pressed[0].preload.max())
    return f"preload {shown(low, 'N')} to {shown(high, 'N')} over the turn"


@check(
    title="Contact pressure of both discs at the greatest preload",
    unit="MPa",
    source=Source("surface endurance of cam and follower", confirmed=True),
    formula="max(p) <= p_E/S; p: sqrt(N E*/(pi b R)) on either disc, N: its normal force with an"
    " interference greater by cam.profile_tolerance, p_E: least endurance pressure of cam and"
    " roller, S: limits.contact_safety",
    symbols={
        "p": f"{STATED} [MPa]",
        "p_E": f"{STATED} [MPa]",
        "S": "limits.contact_safety",
    },
    reason="The preload presses at every angle, on the disc that bears less, too.",
    tier=Tier.SCREENING,
    method="pressure of Hertz on both discs, the interference greater by the width of the profile"
    " tolerance; of finite elements with their ratio to Hertz on the disc at the nominal preload",
    lift_can_help=True,
    needs="roller",
    closed_by="preload",
    values=(*given.LOADS, *given.CONTACT, INTERFERENCE, "cam.profile_tolerance"),
    levers=(levers.one(INTERFERENCE, -1),),
    page="Contact",
    kept_as="contact pressure of both discs at the greatest preload",
)  # fmt: skip
def preload_pressure(solution: Solution) -> Demand | None:
    """Greatest contact pressure on either disc, Pa; None without an interference."""
    tolerance = solution.machine.cam.profile_tolerance

    def pressure(cycle: Cycle) -> Array | None:
        pressed = _squeezed(cycle, tolerance)
        if pressed is None:
            return None
        machine, loads = cycle.machine, cycle.loads
        every = []
        for wall, force in zip((1.0, -1.0), pressed[1:], strict=True):
            walls = np.full(loads.theta.size, wall)
            there = Carried.at(cycle.contour.pitch, machine.system, loads.theta, walls)
            normal = force / (there.slide.lever * np.cos(there.pressure_angle))
            radius = relative_radius(cycle.contour, loads.second, loads.theta, walls)
            load = np.where(radius > 0.0, normal / machine.contact_width, np.nan)  # not undercut
            square = peak_pressure_square(load, 1.0 / radius, machine.contact_modulus)
            every.append(np.sqrt(square) * _over_hertz(cycle, wall))
        return np.maximum(*every)

    worst = _of_turns(solution, pressure, 1.0)
    if worst is None:
        return None
    value, cycle, k = worst
    at = Extreme(value, cycle.load_case, float(cycle.theta[k]))
    return _within_endurance(solution, at, _preload_words(solution))


def _within_endurance(solution: Solution, worst: Extreme, words: str) -> Demand:
    """Demand of a contact pressure, Pa, on either track beside the least endurance pressure."""
    limit = contact_strength.endurance_allowed(solution.numbers)
    allowed, stated = limit.against(worst.value), {"p": worst.value}
    if allowed is not None:
        stated["p_E"] = allowed * solution.machine.limits[CONTACT_SAFETY]
    pressure = None if np.isnan(worst.value) else worst.value
    return Demand(pressure, allowed, worst, limit.missing, note=words, stated=stated)


def _over_hertz(cycle: Cycle, wall: float) -> Array:
    """Pressure by finite elements over that of Hertz (n,) on a track of preloaded discs; 1 in a
    preview and without load.
    """
    ratio = np.ones(cycle.theta.size)
    if cycle.idle is None or cycle.contact.tier is not Tier.CYCLE:
        return ratio
    history = cycle.contact.where(cycle.loads.wall != wall, cycle.idle)
    return np.divide(history.p0, history.p0_hertz, out=ratio, where=history.p0_hertz > 0.0)


class _Worst(NamedTuple):
    """Greatest figure of the landings, the cycle in which it occurs, and the flight before it."""

    value: float
    cycle: Cycle
    flight: Landing

    @property
    def at(self) -> Extreme:
        """Load case, and cam angle of the landing, or of the take-off where none follows."""
        lost = np.isnan(self.flight.landing)
        angle = self.flight.take_off if lost else self.flight.landing
        return Extreme(self.value, self.cycle.load_case, angle)

    @property
    def words(self) -> str:
        """Number of landings in a turn of the load case, and the flight."""
        one = self.flight
        if np.isnan(one.landing):
            return f"the flight from {shown(one.take_off, 'deg')} does not end within a turn"
        cam, words, each = self.cycle.machine.cam, ("first", "second"), "face"
        if cam.groove is not None:
            words, each = ("inner", "outer"), "wall"
        elif cam.conjugate is not None:
            each = "disc"
        tracks = dict(zip((INNER, OUTER), words, strict=True))
        return (
            f"{len(self.cycle.impacts)} landings a turn; from the {tracks[one.start]} {each} at"
            f" {shown(one.take_off, 'deg')} to the {tracks[one.wall]}, {shown(one.time, 'ms')}"
        )


def _no_landing(solution: Solution) -> str:
    """Why there is no landing, in words."""
    if solution.machine.disc_preload is not None:
        return "the preloaded discs leave no clearance"
    return "one track carries all over the turn"


def _worst_impact(solution: Solution, measure: Callable[[WallImpact], float]) -> _Worst | None:
    """Greatest figure of the landings of all load cases; None without a landing."""
    every = [_Worst(measure(one), cycle, one.flight) for cycle in solution.cycles
             for one in cycle.impacts]  # fmt: skip
    return every[first_greatest([each.value for each in every])] if every else None


_CLEARANCES = tuple(f"cam.{each}.clearance" for each in TWO_TRACKS)
_WEARS = tuple(f"cam.{each}.wear_depth" for each in TWO_TRACKS)


@check(
    WORN_CLEARANCE,
    title="Greatest clearance of the worn tracks",
    method="greatest clearance over the turn, square to the second track or outer wall, of first"
    " order in the deviations of radii, places and angles",
    closed_by="form",
    if_limited=True,
    load_cases=NONE,
    formula="c + o <= limits.worn_clearance; c: clearance as stated, o: by which the wear of both"
    " tracks opens it, w (1 + (l_2/l_1) cos(alpha_2)/cos(alpha_1)), in a groove 2 w, w: wear of a"
    " track with its roller, l_2/l_1: of the arms, 1 of a stem, alpha_1, alpha_2: pressure angles",
    symbols={"c": f"{STATED} [mm]", "o": f"{STATED} [mm]"},
    reason="The follower no longer goes where the cam is to guide it.",
    values=_CLEARANCES,
    levers=tuple(levers.one(each, -1) for each in (*_CLEARANCES, *_WEARS)),
    page="Cam",
)
def worn_clearance(solution: Solution) -> Demand | None:
    """Greatest clearance after wear, m; None with an interference."""
    machine, path = solution.machine, solution.contour.pitch
    stated = machine.cam.clearance
    if not stated > 0.0:
        return None
    worn = machine.deviation.worn(machine.cam.wear_depth)
    opened = worn.opened(path, machine.cam.second, uniform_turn(path.lift.search_count))
    k = first_greatest(opened)
    at = Extreme(stated + float(opened[k]), "", FULL_TURN * k / opened.size)
    limit = machine.limits[WORN_CLEARANCE]
    return Demand(at.value, limit, at, stated={"c": stated, "o": float(opened[k])})


_FLIGHT = (
    "flight of the rigid mass under inertia, weight, external and spring force through the"
    " clearance, with rebounds by follower.restitution, else by the damping of the elastic follower"
)
_CLEARANCE = (
    *(levers.one(each, -1) for each in (*_CLEARANCES, *_WEARS, "cam.profile_tolerance")),
    *levers.GENTLER,
)


@check(
    LANDING_SPEED,
    title="Maximum landing speed on a track",
    tier=Tier.SCREENING,
    method=_FLIGHT,
    lift_can_help=True,
    closed_by="form",
    if_limited=True,
    formula="v <= limits.landing_speed; v: greatest speed of roller or face against the track at"
    " the end of a flight through the clearance, along the travel; of a small clearance c under"
    " inertia alone (9/2 c^2 j)^(1/3), j: jerk of the follower where its acceleration is zero",
    symbols={"v": f"{STATED} [mm/s]"},
    reason="The noise and the wear of a cam that pulls grow with it.",
    values=(*given.LOADS, *_CLEARANCES),
    levers=_CLEARANCE,
    page="Follower",
)
def landing_speed(solution: Solution) -> Demand:
    """Greatest landing speed, m/s; 0 without a landing."""
    limit = solution.machine.limits[LANDING_SPEED]
    worst = _worst_impact(solution, lambda one: one.flight.speed)
    if worst is None:
        return Demand(0.0, limit, note=_no_landing(solution), stated={"v": 0.0})
    return Demand(worst.value, limit, worst.at, note=worst.words, stated={"v": worst.value})


@check(
    title="Contact pressure at the landing on a track",
    unit="MPa",
    source=Source("surface endurance of cam and follower, once a turn", confirmed=True),
    tier=Tier.SCREENING,
    method=f"{_FLIGHT}; stopped on the stiffness of the follower, pressure under the greatest"
    " force",
    lift_can_help=True,
    closed_by="form",
    formula="p <= p_E / S; p: sqrt(N E*/(pi b R)) on the track of the landing, or of the conforming"
    " contact where it is concave, N: F + sqrt(F^2 + k m"
    " v^2) over cos(alpha), F: axial force at the landing, v: landing speed, k: follower.stiffness"
    " or that of the parts between cam and mass in series, m: follower.mass, p_E: least endurance"
    " pressure of cam and follower, S: limits.contact_safety",
    symbols={
        "p": f"{STATED} [MPa]",
        "p_E": f"{STATED} [MPa]",
        "S": "limits.contact_safety",
    },
    reason="Each landing is a blow on the same places of the tracks.",
    values=(*given.LOADS, *given.CONTACT, *_CLEARANCES, "follower.stiffness"),
    levers=_CLEARANCE,
    page="Contact",
)
def landing_pressure(solution: Solution) -> Demand | None:
    """Greatest pressure of Hertz at a landing, Pa; None without a landing."""
    worst = _worst_impact(solution, lambda one: one.pressure)
    if worst is None:
        return None
    demand, machine = _within_endurance(solution, worst.at, worst.words), solution.machine
    if machine.compliances or machine.stiffness is not None:
        return demand
    return replace(demand, missing=(*demand.missing, "follower.stiffness"))


@check(
    FRICTION_BALANCE,
    id="landing_balance",
    title="Work of the tracks vs. energy lost at the landings",
    formula="|W - S - L - K|/E <= c; W: work of both tracks over a turn with the impulses of the"
    " landings, S: that against spring, weight, external and viscous force, L: energy lost at the"
    " landings, K: kinetic energy gained, 0 where the follower comes to rest on a track, E: half of"
    " the integral of |F s'|, F: axial force without friction, s': slope of the lift, c:"
    " limits.friction_balance",
    symbols=dict.fromkeys("WSLKE", f"{STATED} [J]"),
    reason="Energy that the landings do not take would be an error of the flights.",
    method=f"{_FLIGHT}; forces of the tracks times their velocity, without friction",
    evidence=True,
    moved_by_tolerance=False,
    closed_by="form",
)
def landing_balance(solution: Solution) -> Demand | None:
    """Energy of a turn with landings that the works leave unexplained over that exchanged; None
    without a landing.
    """
    every = {cycle.load_case: cycle.flights for cycle in solution.cycles}
    flown = {name: one.energy for name, one in every.items() if one is not None and one.landings}
    if not flown:
        return None
    running = [cycle for cycle in solution.cycles if cycle.load_case in flown]
    worst = worst_case(running, lambda cycle: flown[cycle.load_case].left, integral=False)
    energy = flown[worst.load_case]
    words = [
        f"{cycle.load_case}: {shown(cycle.landing_power, 'W', 3)}, {len(cycle.impacts)} landings a"
        " turn"
        for cycle in running
    ]
    limit = solution.machine.limits[FRICTION_BALANCE]
    return Demand(
        worst.value,
        limit,
        worst,
        note=f"lost at the landings: {'; '.join(words)}",
        stated=dict(zip("WSLKE", energy, strict=True)),
    )


@check(
    CROSSOVER_SLIP,
    title="Maximum slip of the roller at a crossover",
    tier=Tier.SCREENING,
    method="spin of each roller by the friction of its tracks and the drag of its bearing, at equal"
    " angles, without the flights",
    lift_can_help=True,
    needs="roller",
    closed_by="form",
    if_limited=True,
    formula="max |v| <= limits.crossover_slip; v: speed of the surface of the roller that carries,"
    " of preloaded discs of either, against its track",
    symbols={"v": "slip_speed [m/s]"},
    reason="It wears and heats roller and walls at the same places in each turn.",
    values=(*given.LOADS, "roller.friction"),
    levers=(levers.one("cam.prime_radius", -1, 2.0),),
    page="Contact",
)
def crossover_slip(solution: Solution) -> Demand:
    """Greatest slip of a roller that carries over the turn, m/s."""
    machine = solution.machine

    def slip(cycle: Cycle) -> Array | None:
        unknown = cycle.rolling.contact is None
        return None if unknown else on_both_tracks(cycle, _slip)

    limit, worst = machine.limits[CROSSOVER_SLIP], _of_turns(solution, slip, 1.0)
    if worst is None:
        lacks = () if machine.follower.friction is not None else ("roller.friction",)
        return Demand(None, limit, missing=lacks)
    value, cycle, k = worst
    at = Extreme(value, cycle.load_case, float(cycle.theta[k]))
    return contact_strength.with_its_track(Demand(value, limit, at), solution, _slip, {"v": _slip})


def _slip(cycle: Cycle) -> Array:
    """Slip of the roller of a track (n,), m/s, >= 0; NaN where it is not known."""
    contact = cycle.rolling.contact
    return np.full(cycle.theta.size, np.nan) if contact is None else np.abs(contact.slip)


@check(
    SURFACE_TEMPERATURE,
    id="slip_temperature",
    title="Temperature of the contact of the roller while it slips",
    unit="degC",
    method="oil, bulk by the mean flash temperature of the turn, and flash temperature of a band"
    " source, of the friction by which cam or wall turns the roller the other way",
    lift_can_help=True,
    needs="roller",
    closed_by="form",
    formula="T_oil + 0.47 1.2 T_m + T_f <= limits.surface_temperature, and that of the cards of cam"
    " and roller where they state one; T_oil: lubricant.temperature, T_m: mean of T_f over the"
    " turn, of preloaded discs of each roller, T_f: greatest 1.11 F v/(b (B_1 sqrt|u| + B_2"
    " sqrt|u - v|) sqrt(2 a)), F: friction on"
    " the roller, v: its slip, b: width of the contact, u: speed of the contact along the track, B:"
    " root of conductivity times density times specific heat of cam and roller, a: half-width",
    symbols={
        "T_oil": "lubricant.temperature - 273.15 [degC]",
        **dict.fromkeys(("T_m", "T_f"), f"{STATED} [K]"),
    },
    reason="A roller that changes between two tracks turns the wrong way at first: above it the"
    " layer that keeps the steels apart is lost, and hardened surfaces are tempered.",
    values=(*given.LOADS, *given.CONTACT, "roller.friction", "lubricant.temperature"),
    levers=(levers.one("cam.prime_radius", -1, 2.0),),
    page="Contact",
)
def slip_temperature(solution: Solution) -> Demand:
    """Greatest temperature of the contact of a slipping roller over the load cases, degC."""
    machine = solution.machine
    oil, limit = machine.lubricant, machine.limits[SURFACE_TEMPERATURE]
    allowed = float(bulk_allowed(machine, limit))
    missing = heat_missing(machine, "temperature")
    if missing or oil is None or oil.temperature is None:
        return Demand(None, allowed, missing=missing)
    cold = oil.temperature

    def flash(cycle: Cycle) -> Array:
        rise = cycle.rolling.flash
        return np.full(cycle.theta.size, np.nan) if rise is None else rise

    def hot(rise: Array) -> float:
        return float(celsius(cold + bulk_rise(rise) + rise.max()))

    worst = worst_case(
        solution.cycles,
        lambda cycle: float(np.max([hot(each) for each in cycle.on_each_disc(flash)])),
        integral=False,
    )
    rise = max(cycle_of(solution.cycles, worst).on_each_disc(flash), key=hot)
    stated = {"T_m": float(rise.mean()), "T_f": float(rise.max())}
    return Demand(worst.value, allowed, worst, figures=(oil.source,), stated=stated)

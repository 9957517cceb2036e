"""Drawing data of the mechanism: sizes and motion from a run's stored results."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import numpy as np

from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Array, median, rotation
from camwright.geometry.rocker_lift import RockerArm, RockerLinkage
from camwright.pipeline.base.counterweight_body import CounterweightBody
from camwright.pipeline.base.envelope import Disc, MechanismSizes, Sleeve
from camwright.pipeline.base.files import Json
from camwright.pipeline.base.stem_layout import SEAT_MOST, StemLayout
from camwright.reports.drawing import arrangement
from camwright.reports.drawing.arm_parts import ArmSpring, LinkCoil, LinkGas, SecondArm, polar
from camwright.reports.drawing.arrangement import (
    FORCES,
    DrawnArm,
    DrawnBush,
    DrawnGroove,
    DrawnMechanism,
    DrawnMotion,
    DrawnSector,
    DrawnStep,
)
from camwright.reports.drawing.drawing_shapes import Drawing
from camwright.reports.drawing.second_follower import DrawnSecond
from camwright.reports.drawing.spring_shapes import (
    DRAWN,
    Coil,
    DrawnSpring,
    NoSpring,
    SpringPlaces,
)
from camwright.reports.sheet_turn import SheetTurn, beside_path

_COLUMNS = {"contact": "normal_force_N", "spring": "spring_force_N",
            "guide-a": "guide_reaction_A_N", "guide-b": "guide_reaction_B_N"}  # fmt: skip
# Shares of the stem diameter where the case has no size.
_COIL, _WIRE, _GUIDE, _OVERHANG_STEMS, _SPACING = 2.6, 0.42, 2.0, 3.0, 7.0
_PIN_SHARE = 0.5  # of the roller
_TURNS = 7.0
_BEARING = 0.1  # radius about the pivot of an arm, over its length
_OUTPUT = 6.0  # length of the output of a second arm that is drawn, over half of the arm's depth
_THROUGH = 1.5  # length of an output over that of the spring around it
_COIL_SHARE, _BODY_SHARE = 0.25, 0.6  # of the length of a spring: diameter of coils, gas cylinder
_STEEL_DENSITY = 7850.0  # kg/m3
_OUTLINE_POINTS = 360
"""Most cam angles at which a page draws the arrangement."""


def arrangement_at(turn: SheetTurn, row: int | None = None) -> Drawing:
    """Drawing of the mechanism at a row of the cycle; None: at maximum contact pressure."""
    return arrangement.drawing(mechanism_of(turn), motion_of(turn), turn.worst if row is None
                               else row)  # fmt: skip


def moving_data(turn: SheetTurn) -> dict[str, Json]:
    """Record of the drawing over the turn for the script of a page: poses, arrows and words as by
    `moving_record`, and the lift as text.

    `at` is the place of the maximum contact pressure among the drawn angles, `shaft` the angle of
    the machine's shaft, deg.
    """
    count = turn.crank.size
    stride = -(-count // _OUTLINE_POINTS)
    rows = range(turn.worst % stride, count, stride)
    motion = motion_of(turn)
    return {
        **arrangement.moving_record(mechanism_of(turn), motion, rows),
        "at": turn.worst // stride,
        "shaft": [round(float(motion.shaft_angle[row]), 3) for row in rows],
        "lift": [f"{motion.lift[row]:.3f} mm" for row in rows],
    }


def motion_of(turn: SheetTurn) -> DrawnMotion:
    """Motion and forces of the drawn load case."""
    c = turn.columns
    return DrawnMotion(
        turn.load_case, np.radians(c["cam_angle_deg"]), turn.crank, turn.words.shaft,
        c["lift_mm"], np.radians(c["pressure_angle_deg"]), c.get("face_contact_offset_mm"),
        {name: np.nan_to_num(c[_COLUMNS[name]]) for name in FORCES if _COLUMNS[name] in c},
        turn.walls, pulling_at(turn, c["cam_angle_deg"]),
    )  # fmt: skip


def pulling_at(turn: SheetTurn, angle: Array) -> tuple[Array, Array] | None:
    """Contact of the second track and its outward normal in the drawing (2, n), mm, at cam angles
    (n,), deg; None of a cam without one.
    """
    table = turn.contour
    if "second_normal_x" not in table:
        return None

    def at(name: str) -> Array:
        return np.interp(angle, table["cam_angle_deg"], table[name], period=360.0)

    # of the drawn cam, which is turned by `cam_turn`, a right angle less the cam angle
    cos, sin = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    pairs = (tuple(at(f"second_{name}") for name in names)
             for names in (("contour_x_mm", "contour_y_mm"), ("normal_x", "normal_y")))  # fmt: skip
    touch, normal = (np.stack([cos * x - sin * y, sin * x + cos * y]) for x, y in pairs)
    return touch, normal


@lru_cache(maxsize=2)
def mechanism_of(turn: SheetTurn) -> DrawnMechanism:
    """Sizes of the drawn mechanism from the case and the contour; sizes that the case does not
    state are scaled from the diameter of the stem.
    """
    contour = np.array([turn.contour["contour_x_mm"], turn.contour["contour_y_mm"]])
    axis, lowest = _reference(turn)
    stroke = float(np.max(turn.lift["lift_mm"]))
    stem = turn.length("follower", "stem_diameter") or 0.2 * float(np.hypot(*contour).min())
    guides = _guides(turn, stem, lowest + stroke)
    seat = turn.length("spring", "seat_thickness") or SEAT_MOST * stem
    spring = _spring(turn, stem, (lowest, stroke), guides, seat)
    end, second = _stem_end(turn, stem, lowest, guides, spring), _second(turn, lowest, stroke)
    roller = turn.length("roller", "radius") if turn.rolls else None
    return DrawnMechanism(
        contour, turn.length("cam", "bore_radius"), turn.keyway, _drilled(turn), axis, lowest,
        stroke, roller, _pin(turn, roller or 0.0), _face(turn) if roller is None else None, stem,
        end, guides, spring, seat,
        _sizes(turn, (axis, lowest, stroke, stem, end - lowest), guides, spring, seat, second),
        _counterweight(turn), _arm(turn), _groove(turn), second,
    )  # fmt: skip


def _second(turn: SheetTurn, lowest: float, stroke: float) -> DrawnSecond | None:
    """Second roller or face of a cam that pulls; None without one, or if its place is not stated.

    Parameters
    ----------
    lowest, stroke : float   height of the first above the cam axis at zero lift, greatest lift, mm
    """
    disc = turn.second_disc
    gap = turn.length("cam", "yoke", "clearance")
    if disc is None:
        if gap is None:
            return None
        return DrawnSecond(np.array([0.0, -(2.0 * lowest + stroke + gap)]), None, None, 0.0)

    def of(key: str, unit: str = "mm") -> float | None:
        return turn.length("cam", "conjugate", key, unit=unit)

    spacing, distance, length = of("spacing"), of("distance"), of("arm_length")
    arm, between = _arm(turn), of("arm_angle", "rad")
    if arm is not None and length is not None and between is not None:
        centre = rotation(arm.sense * between) @ np.array([0.0, -length])
    elif distance is not None:
        centre = np.array([0.0, -distance])
    else:
        return None
    return DrawnSecond(centre, of("roller_radius"), disc, spacing or 0.0)


def _groove(turn: SheetTurn) -> DrawnGroove | None:
    """Groove in which the roller runs; None without an outer wall, or if radius or depth is not
    stated.
    """
    wall = turn.outer_wall
    radius, depth = (turn.length("cam", "groove", key) for key in ("outer_radius", "depth"))
    if wall is None or radius is None or depth is None:
        return None
    second = turn.length("cam", "groove", "second", "radius")
    return DrawnGroove(wall, radius, depth, second, _steps(turn, depth, wall, second))


def _steps(
    turn: SheetTurn, depth: float, wall: Array, second: float | None
) -> tuple[DrawnStep, ...]:
    """Steps of a groove from the face down, each with the roller that runs in it.

    Parameters
    ----------
    depth : float           of the groove, mm
    wall : array (2, n)     outer, on which a roller runs
    second : float          radius of a second roller, mm; None without one
    """
    inner = np.array([turn.contour["contour_x_mm"], turn.contour["contour_y_mm"]])
    relief, middle = (
        turn.length("cam", "groove", "second", key) or 0.0 for key in ("relief", "step_depth")
    )
    if second is None:
        return (DrawnStep(0.0, depth, inner, wall),)
    first = turn.length("roller", "radius") or 0.0
    of_first = (inner, beside_path(turn.contour, first + relief), (True, False))
    of_second = (beside_path(turn.contour, -second - relief), wall, (False, True))
    upper, lower = (of_second, of_first) if second > first else (of_first, of_second)
    return DrawnStep(0.0, middle, *upper), DrawnStep(middle, depth, *lower)


def _arm(turn: SheetTurn) -> DrawnArm | None:
    """Arm of an oscillating follower; None where a stem in guides carries the follower, or if
    centre distance, arm length or prime radius is not stated.
    """
    distance, length = (
        turn.length("follower", "arm", key) for key in ("centre_distance", "length")
    )
    prime = turn.length("cam", "prime_radius")
    if not turn.on_arm or distance is None or length is None or prime is None:
        return None
    sense = 1.0 if turn.case["follower"]["arm"].get("swing") == "with" else -1.0
    deep, hub = (turn.length("follower", "arm", key) for key in ("depth", "hub"))
    linkage = Arm(distance, length, sense)
    bearing = 0.5 * (hub or deep or 2.0 * _BEARING * length)
    offset, radius = (turn.length("follower", "face", key) for key in ("offset", "radius"))
    start, depth = float(linkage.start_angle(prime, offset)), offset or radius or 0.0
    half = None if deep is None else 0.5 * deep
    second = _second_arm(turn, length, 0.6 * bearing if half is None else half)
    spring = _arm_spring(turn, second)
    return DrawnArm(distance, length, sense, start, bearing, depth, radius, half, second, spring)


def _second_arm(turn: SheetTurn, arm_length: float, half: float) -> SecondArm | None:
    """Second arm of a rocker, on the pivot of the first one, mm; None without one, or if neither
    its ratio nor its length is stated.

    With a constant ratio its end travels on an arc; it is drawn with the output along the tangent
    of the arc at zero lift.

    Parameters
    ----------
    arm_length : float   of the first arm, mm
    half : float         half of the depth of the first arm, mm, by which pad and output are drawn
    """
    rocker = turn.case.get("rocker")
    if not isinstance(rocker, dict):
        return None
    ratio, stated = rocker.get("ratio"), turn.length("rocker", "length")
    raised = turn.length("rocker", "angle", unit="rad") or 0.0
    if isinstance(ratio, (int, float)):
        stated, second = ratio * arm_length, RockerArm(ratio * arm_length)
    elif stated is not None:
        second = RockerArm(stated, raised)
    else:
        return None
    linkage = RockerLinkage(RockerArm(arm_length), second, turn.length("rocker", "lash") or 0.0)
    side = 1.0 if rocker.get("side") == "same" else -1.0
    rod = _OUTPUT * half
    if isinstance(turn.case.get("spring", {}).get("rocker"), dict):
        rod = _THROUGH * (_installed(turn) or rod)
    return SecondArm(stated, side, raised, half, rod, linkage)


def _arm_spring(turn: SheetTurn, second: SecondArm | None) -> ArmSpring | None:
    """Spring between a fixed end and the arm, or the output of its second arm; None without such a
    spring or with a radius of its ends not stated.

    Sizes of the spring that the case does not state are scaled from its length.
    """
    spring = turn.case.get("spring", {})
    link = spring.get("link")
    if isinstance(link, dict):
        radii = [turn.length("spring", "link", key) for key in ("arm_radius", "fixed_radius")]
        turned = [
            turn.length("spring", "link", key, unit="rad") or 0.0
            for key in ("arm_angle", "fixed_angle")
        ]
        if radii[0] is None or radii[1] is None:
            return None
        ends = (radii[0], turned[0]), (radii[1], turned[1])
        length = float(np.hypot(*(polar(*ends[0]) - polar(*ends[1]))))
        pulls = link.get("action") == "pull"
        return ArmSpring(_between(turn, length, "eyes" if pulls else "pins"), *ends)
    if not isinstance(spring.get("rocker"), dict) or second is None:
        return None
    length = second.rod / _THROUGH
    return ArmSpring(_between(turn, length, "seats"), None, distance=length)


def _between(
    turn: SheetTurn, length: float, ends: Literal["eyes", "pins", "seats"]
) -> LinkCoil | LinkGas:
    """Gas or coil spring drawn between its two ends; sizes that the case does not state are shares
    of its length.

    Parameters
    ----------
    length : float   between the ends at zero lift, mm
    ends : str       fittings of a coil spring, see `LinkCoil`; a gas spring has pins
    """
    spring = turn.case.get("spring", {})
    if isinstance(spring.get("gas"), dict):
        area = turn.length("spring", "gas", "area", unit="mm^2") or (_COIL_SHARE * length) ** 2
        bore = float(np.sqrt(4.0 * area / np.pi))
        return LinkGas(bore, _BODY_SHARE * length, (1.06 - _BODY_SHARE) * length)
    wound = "extension" if isinstance(spring.get("extension"), dict) else "design"
    diameter = turn.length("spring", wound, "mean_diameter") or _COIL_SHARE * length
    active = spring.get(wound, {}).get("coils")
    turns = float(active) + 2.0 if isinstance(active, (int, float)) else _TURNS
    wire = turn.length("spring", wound, "wire_diameter")
    return LinkCoil(wire or 0.5 * length / turns * _WIRE, diameter, turns, ends)


def _counterweight(turn: SheetTurn) -> DrawnSector | None:
    """Sector drawn for the counterweight, as wide and high as `counterweight_body` makes it; None
    without a counterweight or if a size it needs is not stated.

    Its unbalance is the stated one; where the case states a residual instead, it is what the cam
    with its drilled hole leaves plus this residual, opposite to the unbalance of the cam.
    """

    def of(key: str, unit: str = "mm") -> float | None:
        return turn.length("camshaft", "counterweight", key, unit=unit)

    hole, balance = turn.counter_hole, turn.balance
    drilled = hole is not None and hole[3]
    cam = balance["residual_unbalance_g_mm" if drilled else "unbalance_g_mm"]
    turned, left = balance["unbalance_angle_deg"], of("residual", "g mm")
    product, angle, position = of("unbalance", "g mm"), of("angle", "rad"), of("position")
    if left is not None and isinstance(cam, (int, float)) and isinstance(turned, (int, float)):
        product, angle = float(cam) + left, np.radians(float(turned) + 180.0)
    middle, width = turn.length("camshaft", "cam_position"), turn.length("cam", "width")
    inner, radius = turn.length("cam", "bore_radius"), of("radius") or _below_follower(turn)
    if product is None or angle is None or position is None or middle is None:
        return None
    if width is None or inner is None or not radius > inner:
        return None
    body = CounterweightBody.of(
        position - middle, width, (radius, of("width")), inner, _density(turn), product
    )
    half = body.half_angle(product)
    return DrawnSector(angle, half, inner, radius, float(body.width), position - middle)


def _below_follower(turn: SheetTurn) -> float:
    """Outer radius of a counterweight whose size is not stated, mm: prime radius less the
    follower's reach and two assembly gaps.
    """
    prime = turn.length("cam", "prime_radius") or 0.0
    cheeks = turn.length("roller", "fork", "cheek_height") or 0.0
    reach = max(turn.length("roller", "radius") or 0.0, 0.5 * cheeks) if turn.rolls else 0.0
    return prime - reach - 2.0 * (turn.length("limits", "assembly_gap") or 0.0)


def _density(turn: SheetTurn) -> float:
    """Density of a counterweight, g/mm3: that of the camshaft, else that of the cam."""
    parts = (turn.case.get(part, {}).get("material") for part in ("camshaft", "cam"))
    name = next((each for each in parts if isinstance(each, str)), "")
    return (turn.length("materials", name, "density", unit="kg/m^3") or _STEEL_DENSITY) * 1e-6


def _sizes(
    turn: SheetTurn, stem: tuple[float, float, float, float, float],
    guides: tuple[DrawnBush, DrawnBush], spring: DrawnSpring, seat: float,
    second: DrawnSecond | None,
) -> MechanismSizes:  # fmt: skip
    """Sizes of all parts of the mechanism, mm; heights of guides and spring are over roller centre
    or face at maximum lift.

    Parameters
    ----------
    stem : tuple           x of the follower axis, height of roller centre or face above the cam
                           axis at zero lift, greatest lift, diameter of the stem, its end over
                           roller centre or face, mm
    guides : tuple         guides A and B
    spring : DrawnSpring
    seat : float           thickness of the moving seat of the spring, mm
    second : DrawnSecond   second roller or face; None: none
    """
    axis, lowest, lift, diameter, end = stem
    highest, cheeks = lowest + lift, turn.length("roller", "fork", "cheek_height") or 0.0
    sleeves = [
        Sleeve(_bottom(each) - highest, _top(each) - highest,
               each.bore + 2.0 * (turn.length("guides", name, "wall") or 0.0))
        for name, each in zip("ab", guides, strict=True)
    ]  # fmt: skip
    if not isinstance(spring, NoSpring):
        sleeves.append(
            Sleeve(spring.seat - seat - highest, spring.top - highest, 2.0 * spring.reach)
        )
    half = max(turn.length("roller", "radius") or 0.0, 0.5 * cheeks)
    deep = 0.5 * (turn.length("roller", "width") or 0.0)
    if not turn.rolls:
        half = 0.5 * _face(turn)[0]
        deep = 0.5 * (turn.length("follower", "face", "depth") or 0.0)
    span, cheek = (
        turn.length("roller", *key) for key in (("pin", "span"), ("fork", "cheek_width"))
    )
    if span is not None and cheek is not None:
        held = turn.case["roller"]["pin"].get("mounting") == "overhung"
        deep = max(deep, span + cheek if held else 0.5 * (span + cheek))
    deep += turn.length("roller", "axial_offset") or 0.0
    edge = np.hypot(turn.contour["contour_x_mm"], turn.contour["contour_y_mm"])
    radius = turn.length("cam", "groove", "outer_radius") or float(edge.max())
    width = turn.length("cam", "width") or 0.0
    beside, below = [], 0.0
    if second is not None:
        reach = second.radius or _face(turn)[1]
        half, below = max(half, second.radius or 0.0), reach - float(second.centre[1])
        if second.disc is not None:
            beside.append(Disc(second.spacing, width, 2.0 * float(np.hypot(*second.disc).max())))
            deep += second.spacing
    return MechanismSizes(radius, width, axis, lowest, lift, (half, deep), diameter, end,
                          tuple(sleeves), (*beside, *_discs(turn)), below)  # fmt: skip


def _discs(turn: SheetTurn) -> tuple[Disc, ...]:
    """Bearings, counterweight and gear on the camshaft, each placed by its distance from the cam,
    mm; () where the case states no positions, and without the parts of unknown size.
    """

    def at(*path: str) -> float | None:
        return turn.length("camshaft", *path)

    cam, spacing = at("cam_position"), at("bearing_spacing")
    if cam is None or spacing is None:
        return ()
    diameter = at("diameter") or 2.0 * (turn.length("cam", "bore_radius") or 0.0)
    width = at("bearing_width") or at("diameter") or 0.0
    discs = [Disc(place - cam, width, diameter) for place in (0.0, spacing)]
    place, radius, wide = at("gear_position"), at("gear_radius"), at("gear", "width")
    teeth = turn.case["camshaft"].get("gear", {}).get("teeth")
    held, thick, outer = (at("counterweight", key) for key in ("position", "width", "radius"))
    if held is not None and thick is not None and outer is not None:
        discs.append(Disc(held - cam, thick, 2.0 * outer))
    if place is not None and radius is not None and wide is not None and teeth:
        discs.append(Disc(place - cam, wide, 2.0 * radius * (1.0 + 2.0 / int(teeth))))
    return tuple(discs)


def _reference(turn: SheetTurn) -> tuple[float, float]:
    """x of the follower axis and height of roller centre or face at zero lift, mm: medians over the
    turn, from the recorded contour.
    """
    c, lift = turn.contour, turn.lift["lift_mm"]
    if not turn.rolls:
        support = (c["contour_x_mm"] * c["normal_x"] + c["contour_y_mm"] * c["normal_y"]) - lift
        return 0.0, median(support)
    theta = np.radians(c["cam_angle_deg"])
    x, y = c["pitch_x_mm"], c["pitch_y_mm"]
    along, across = x * np.cos(theta) + y * np.sin(theta), x * np.sin(theta) - y * np.cos(theta)
    return median(across), median(along - lift)


def _drilled(turn: SheetTurn) -> tuple[float, float, float] | None:
    hole = turn.counter_hole
    return hole[:3] if hole is not None and hole[3] else None


def _pin(turn: SheetTurn, roller: float) -> float:
    """Radius of the roller pin, mm, at most 0.8 of the roller: as stated, else that of the hub,
    else a share of the roller.

    Parameters
    ----------
    roller : float   radius of the roller, mm
    """
    stated = turn.length("roller", "pin", "diameter")
    hub = turn.length("roller", "hub_radius")
    radius = 0.5 * stated if stated else hub or _PIN_SHARE * roller
    return min(radius, 0.8 * roller)


def _face(turn: SheetTurn) -> tuple[float, float]:
    """Width and thickness of a flat face, mm; an unknown width is just above twice the greatest
    contact offset.
    """
    width = turn.length("follower", "face", "width")
    thick = turn.length("follower", "face", "thickness")
    wanders = turn.columns.get("face_contact_offset_mm")
    least = 2.2 * float(np.max(np.abs(wanders))) if wanders is not None else 1.0
    return width or least, thick or 0.3 * (width or least)


def _guides(turn: SheetTurn, stem: float, highest: float) -> tuple[DrawnBush, DrawnBush]:
    """Guides A and B on a stem of diameter `stem`: A at its overhang from roller centre or face at
    maximum lift (height `highest`, mm), B beyond it.
    """
    overhang = turn.length("follower", "overhang_at_max_lift") or _OVERHANG_STEMS * stem
    spacing = turn.length("guides", "spacing") or _SPACING * stem
    a, b = (
        DrawnBush(middle, turn.length("guides", name, "length") or _GUIDE * stem,
             max(turn.length("guides", name, "diameter") or stem, stem))
        for name, middle in (("a", highest + overhang), ("b", highest + overhang + spacing))
    )  # fmt: skip
    return a, b


def _spring(
    turn: SheetTurn, stem: float, places: tuple[float, float],
    guides: tuple[DrawnBush, DrawnBush], seat: float,
) -> DrawnSpring:  # fmt: skip
    """Spring as the case describes it: a coil between the guides where it fits there, else above
    them, see `StemLayout`; another kind by `DRAWN`; none where no spring acts.

    Parameters
    ----------
    stem : float     diameter of the stem, mm
    places : tuple   height of roller centre or face above the cam axis at zero lift, and the
                     greatest lift, mm
    guides : tuple   guides A and B
    seat : float     thickness of the moving seat, mm
    """
    lowest, stroke = places
    kind = turn.case.get("spring", {}).get("kind", "coil")
    end = turn.length("follower", "stem_length")
    if not turn.sprung:
        return NoSpring(_top(guides[0]))
    if kind in DRAWN:
        between, above = (_top(guide) + seat + 0.3 * stem for guide in guides)
        stated = turn.length("spring", "seat_height")
        between = between if stated is None else lowest + stated
        on_end = above if end is None else lowest + end
        return DRAWN[kind](turn, SpringPlaces(between, on_end, stroke, stem))
    diameter = turn.length("spring", "design", "mean_diameter") or _COIL * stem
    active = turn.case.get("spring", {}).get("design", {}).get("coils")
    turns = float(active) + 2.0 if isinstance(active, (int, float)) else _TURNS
    room = _bottom(guides[1]) - _top(guides[0]) - seat
    installed = _installed(turn)
    length = installed or (room if room > 1.3 * stroke else 1.8 * stroke + 2.0 * stem)
    thickest = min(_WIRE * stem, 0.75 * (length - stroke) / (turns + 1.0))
    wire = turn.length("spring", "design", "wire_diameter") or thickest
    layout = StemLayout(
        overhang=guides[0].middle - lowest - stroke,
        spacing=guides[1].middle - guides[0].middle,
        length_a=guides[0].length,
        length_b=guides[1].length,
        lift=stroke,
        extent=0.0,
        stem_diameter=stem,
        stem_length=end,
        spring_length=length,
        spring_bore=diameter - wire,
        outer_a=np.nan,
        outer_b=np.nan,
    )
    clearance = turn.bound("spring_gap") or 0.0
    place = layout.seated(seat, clearance, turn.length("spring", "seat_height"))
    return Coil(wire, diameter, turns, lowest + float(place.height), length)


def _installed(turn: SheetTurn) -> float | None:
    """Length of a coil spring at zero lift, mm: free length less force over rate, both by the
    recorded spring forces.

    None if the free length is not stated, the force does not rise with the lift, or the length is
    not greater than the travel.
    """
    free = turn.length("spring", "design", "free_length")
    lift, force = turn.columns["lift_mm"], turn.columns["spring_force_N"]
    low, high = int(np.argmin(lift)), int(np.argmax(lift))
    rise, travel = float(force[high] - force[low]), float(lift[high] - lift[low])
    if free is None or not rise > 0.0 or not travel > 0.0:
        return None
    length = free - float(force[low]) * travel / rise + float(lift[low])
    return length if length > travel else None


def _stem_end(
    turn: SheetTurn,
    stem: float,
    lowest: float,
    guides: tuple[DrawnBush, DrawnBush],
    spring: DrawnSpring,
) -> float:
    """Height of the upper end of the stem above the cam axis at zero lift, mm.

    By the length of the stem in the case, else 0.4 stem diameters above guide B; never below the
    spring seat on the stem.

    Parameters
    ----------
    stem : float     diameter of the stem, mm
    lowest : float   height of the roller centre or face above the cam axis at zero lift, mm
    """
    stated = turn.length("follower", "stem_length")
    if stated is not None:
        return max(lowest + stated, spring.seat)
    return max(_top(guides[1]) + 0.4 * stem, spring.seat)


def _top(bush: DrawnBush) -> float:
    return bush.middle + 0.5 * bush.length


def _bottom(bush: DrawnBush) -> float:
    return bush.middle - 0.5 * bush.length

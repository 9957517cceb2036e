"""Line drawing of cam, follower, guides and spring at a cam angle, with forces to scale.

The stem moves along y, or the pivot of an arm lies above the cam; the cam turns clockwise about the
origin. Forces are those on the follower: the contact force along the normal of the contact, the
reactions across the stem.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, rotation
from camwright.pipeline.base.envelope import Box, MechanismSizes, around
from camwright.pipeline.base.files import Json
from camwright.reports.drawing.arm_parts import ArmSpring, SecondArm, ground, polar
from camwright.reports.drawing.drawing_shapes import (
    Arrow,
    Drawing,
    DrawnOutline,
    Pen,
    Pose,
    Shape,
    ShapeGroup,
    Text,
    bore_outline,
    circle,
    hatching,
    rectangle,
    segment,
)
from camwright.reports.drawing.second_follower import DrawnSecond
from camwright.reports.drawing.spring_shapes import Coil, DrawnSpring, NoSpring

_EDGE, _THIN = 0.45, 0.22  # mm, of lines on a mechanism `_WHOLE` high
_WHOLE = 260.0
_FORCE_SHARE = 0.85
"""Length of the greatest force over the least radius of the cam."""
_FACE_POINTS = 25  # of a curved face
FORCES = {"contact": "Contact force", "spring": "Spring force",
          "guide-a": "Guide A", "guide-b": "Guide B"}  # fmt: skip
COLOURS = {"contact": "vermillion", "spring": "green", "guide-a": "blue", "guide-b": "blue"}


@dataclass(frozen=True)
class DrawnBush:
    """Guide bush: height of its middle, length and bore, mm."""

    middle: float
    length: float
    bore: float

    @property
    def wall(self) -> float:
        """Thickness of the drawn wall, mm."""
        return 0.16 * self.bore


class DrawnSector(NamedTuple):
    """Counterweight: direction of its middle in the frame of the cam and half of its angle, rad.

    Inner and outer radius, width along the shaft, position of its middle from that of the cam, mm.
    """

    angle: float
    half: float
    inner: float
    outer: float
    width: float
    position: float


class DrawnStep(NamedTuple):
    """Step of a groove: depths of face and floor below the face of the disc, inner and outer wall
    (2, n), and which of them carry; mm.
    """

    top: float
    bottom: float
    inner: Array
    outer: Array
    carries: tuple[bool, bool] = (True, True)

    @property
    def walls(self) -> tuple[Array, Array]:
        """Inner and outer wall."""
        return self.inner, self.outer


@dataclass(frozen=True, eq=False)
class DrawnGroove:
    """Groove in a disc around the contour, its inner wall: outer wall (2, n), radius of the disc,
    depth; `second`: radius of a roller on the outer wall alone, None without; steps from the face
    down; mm.
    """

    wall: Array
    radius: float
    depth: float
    second: float | None = None
    steps: tuple[DrawnStep, ...] = ()


@dataclass(frozen=True)
class DrawnArm:
    """Arm of an oscillating follower on its pivot, at a height above the cam axis, mm and rad.

    sense: of the outward swing, 1 clockwise as the cam turns, -1 against it; start: angle from the
    line to the cam axis at zero lift; bearing: radius drawn about the pivot; depth: of the middle
    of a face below the line from the pivot to the end, towards the cam: its offset or, of a curved
    face, its radius; bar: half of the depth of the arm, None where it is not stated; second: of a
    rocker; spring: between the arm or its output and a fixed end
    """

    pivot: float
    length: float
    sense: float
    start: float
    bearing: float
    depth: float = 0.0
    radius: float | None = None
    bar: float | None = None
    second: SecondArm | None = None
    spring: ArmSpring | None = None

    @property
    def half(self) -> float:
        """Half of the depth drawn of the arm, mm."""
        return 0.6 * self.bearing if self.bar is None else self.bar

    def turn(self, lift: Array | float) -> Array:
        """Counter-clockwise rotation of the arm from the line to the cam axis, rad."""
        return np.asarray(-self.sense * (self.start + lift / self.length))

    def travel(self, lift: Array | float) -> Array:
        """Direction of travel of the roller centre from y, counter-clockwise, rad."""
        return np.asarray(self.sense * 0.5 * np.pi + self.turn(lift))

    def end(self, lift: Array | float) -> Array:
        """Roller centre (2, ...), mm."""
        turn = self.turn(lift)
        return np.stack([self.length * np.sin(turn), self.pivot - self.length * np.cos(turn)])

    def hung(self, point: Array) -> Array:
        """Points (2, ...) along the arm and outwards, mm, in the frame of the drawn arm: it hangs
        down from its pivot at the origin.
        """
        along, outwards = point
        return np.stack([-self.sense * outwards, -along])

    def placed(self, point: Array, lift: float = 0.0) -> Array:
        """Point (2,) along the arm and outwards, mm, in the drawing at a lift, mm."""
        turned = rotation(float(self.turn(lift))) @ self.hung(point)
        return np.asarray(turned + np.array([0.0, self.pivot]))

    def spring_ends(self, lift: float) -> tuple[Array, Array] | None:
        """Moving and fixed end (2,) of the spring in the drawing, mm; None without one."""
        if self.spring is None:
            return None
        if self.spring.arm_end is not None:
            moving, fixed = polar(*self.spring.arm_end), polar(*self.spring.fixed)
            return self.placed(moving, lift), self.placed(fixed)
        if self.second is None:
            return None
        head = self.second.head * self.second.line
        fixed = self.second.flat(0.0) + head + self.spring.distance * self.second.line
        return self.placed(self.second.flat(lift) + head), self.placed(fixed)

    def beside(self, lift: float) -> list[tuple[Array, float]]:
        """Points (2,) of second arm, output and spring in the drawing at a lift, each with the
        radius of what lies around it, mm.
        """
        reached = []
        if self.second is not None:
            far = self.second.flat(lift) + self.second.rod * self.second.line
            pad = self.second.pad
            reached += [
                (self.placed(self.second.end, lift), pad),
                (self.placed(self.second.flat(lift)), 1.5 * pad),
                (self.placed(far), pad),
            ]
        ends = self.spring_ends(lift)
        if ends is not None and self.spring is not None:
            reached += [(end, 1.2 * self.spring.shape.half) for end in ends]
        return reached


@dataclass(frozen=True, eq=False)
class DrawnMechanism:
    """Sizes of the mechanism for its drawing, mm and rad.

    contour : array (2, n)   in the frame of the cam, angle zero along x
    bore, keyway             radius; width, depth and angle; None: not stated
    counter_hole             centre x, y and radius of a drilled hole, or None
    axis                     x of the follower axis
    lowest, stroke           height of roller centre or face at zero lift; greatest lift
    roller, pin              radii; None: a face
    face                     width and thickness of a face; None: a roller
    stem, stem_end           diameter; height of its end at zero lift
    seat                     thickness of the seats of the spring
    sizes                    of all parts, by which the envelope goes
    counterweight            in the frame of the cam; None: none
    arm                      that carries the roller, in place of stem, guides and spring; or None
    groove                   around the contour, in which the roller runs; or None
    second                   roller or face that pulls the follower back; or None
    """

    contour: Array
    bore: float | None
    keyway: tuple[float, float, float] | None
    counter_hole: tuple[float, float, float] | None
    axis: float
    lowest: float
    stroke: float
    roller: float | None
    pin: float
    face: tuple[float, float] | None
    stem: float
    stem_end: float
    guides: tuple[DrawnBush, DrawnBush]
    spring: DrawnSpring
    seat: float
    sizes: MechanismSizes
    counterweight: DrawnSector | None
    arm: DrawnArm | None = None
    groove: DrawnGroove | None = None
    second: DrawnSecond | None = None

    @property
    def sprung(self) -> bool:
        """Whether a spring acts on the stem."""
        return not isinstance(self.spring, NoSpring)

    @cached_property
    def envelope(self) -> Box:
        """Bounding box of the mechanism over the turn, mm; of an arm with its second arm and spring
        at zero, half and greatest lift.
        """
        if self.arm is None:
            return self.sizes.envelope
        ends = self.arm.end(np.linspace(0.0, self.stroke, 31))
        reach, deep = self.roller or 0.0, self.sizes.follower[1]
        if self.face is not None:
            reach = float(np.hypot(0.5 * self.face[0], max(self.arm.depth, self.face[1])))
        across, along = ((float(e.min()) - reach, float(e.max()) + reach) for e in ends)
        round_pivot = 2.0 * self.arm.bearing
        pivot = Box(
            (-round_pivot, round_pivot),
            (self.arm.pivot - round_pivot, self.arm.pivot + round_pivot),
            (-deep, deep),
        )
        beside = [
            Box((x - size, x + size), (y - size, y + size), (-deep, deep))
            for lift in (0.0, 0.5 * self.stroke, self.stroke)
            for (x, y), size in self.arm.beside(lift)
        ]
        if self.arm is not None and self.second is not None:
            beside.append(self._second_box(self.arm, self.second))
        return around((*self.sizes.on_shaft, Box(across, along, (-deep, deep)), pivot, *beside))

    def _second_box(self, arm: DrawnArm, second: DrawnSecond) -> Box:
        """Box of the second roller of an arm over its swing."""
        turned = [rotation(float(arm.turn(lift))) @ second.centre
                  for lift in (0.0, 0.5 * self.stroke, self.stroke)]  # fmt: skip
        left, right, low, high = second.reach(np.stack(turned, axis=1))
        deep = self.sizes.follower[1]
        return Box((left, right), (arm.pivot + low, arm.pivot + high), (-deep, deep))

    @property
    def shown_forces(self) -> tuple[str, ...]:
        """Forces drawn, by their names in `FORCES`."""
        if self.arm is not None:
            return ("contact",)
        return tuple(name for name in FORCES if self.sprung or name != "spring")

    def reference(self, lift: Array) -> tuple[Array, Array]:
        """Roller centre or middle of the face (2, n), mm, at lifts (n,), mm, and the angle of its
        direction of travel from the y axis (n,), rad, counter-clockwise.
        """
        if self.arm is not None:
            return self.arm.end(lift), self.arm.travel(lift)
        height = self.lowest + lift
        return np.stack([np.full_like(height, self.axis), height]), np.zeros_like(height)

    @cached_property
    def reach(self) -> float:
        """Greatest radius about the camshaft, of cam, gear and bearings, mm."""
        if self.second is not None:  # a roller below the shaft
            return -min(box.along[0] for box in self.sizes.on_shaft)
        return -self.envelope.along[0]

    @cached_property
    def radius_max(self) -> float:
        """Greatest radius of the cam, mm: of the contours, or of the disc with a groove."""
        if self.groove is not None:
            return self.groove.radius
        discs = [self.contour]
        if self.second is not None and self.second.disc is not None:
            discs.append(self.second.disc)
        return max(float(np.hypot(*disc).max()) for disc in discs)

    @cached_property
    def top(self) -> float:
        """Height of the highest part, mm."""
        return self.envelope.along[1]

    @cached_property
    def height(self) -> float:
        """Height of cam and follower together, mm."""
        return self.top + max(self.reach, -self.envelope.along[0])

    @cached_property
    def scale(self) -> float:
        """Size of lines and texts relative to a mechanism `_WHOLE` high."""
        return self.height / _WHOLE

    @cached_property
    def text(self) -> float:
        """Height of the text, mm."""
        return 7.2 * self.scale

    @cached_property
    def arrow_length(self) -> float:
        """Length of the greatest force, mm."""
        return _FORCE_SHARE * float(np.hypot(*self.contour).min())


@dataclass(frozen=True, eq=False)
class DrawnMotion:
    """Motion and forces of one load case over the turn; arrays (n,), SI but lengths in mm.

    theta : cam angle, rad; lift, mm; pressure_angle, rad; contact_offset : of the contact from the
    axis of a flat face, mm, None of a roller; forces : N by the names of `FORCES`, reactions
    positive where they act against a side force that is positive; wall : that carries, 1 the first
    track or inner wall, -1 the second or outer, which pulls; None of one track; pulling : contact
    of the second track in the drawing (2, n), mm, with its normal towards roller or face; None in a
    groove
    """

    load_case: str
    theta: Array
    shaft_angle: Array
    shaft: str
    lift: Array
    pressure_angle: Array
    contact_offset: Array | None
    forces: dict[str, Array]
    wall: Array | None = None
    pulling: tuple[Array, Array] | None = None

    @property
    def pushes(self) -> Array:
        """Sense (n,) of the contact force along the travel: 1 outwards, -1 of a cam that pulls."""
        return np.ones(self.theta.shape) if self.wall is None else self.wall

    def carried(self, second: Array, first: Array) -> Array:
        """Of values (2, n) on both tracks those on the track that carries."""
        return np.where(self.pushes < 0.0, second, first)

    @cached_property
    def greatest_force(self) -> float:
        """Greatest force of the turn, N."""
        return max(float(np.abs(each).max()) for each in self.forces.values())


def cam_turn(theta: float) -> float:
    """Counter-clockwise rotation of the drawn cam, rad, at a cam angle; the follower is upright."""
    return 0.5 * np.pi - theta


def drawing(mechanism: DrawnMechanism, motion: DrawnMotion, row: int) -> Drawing:
    """Drawing of the mechanism at row `row` of the motion, in groups from the bottom layer to the
    top one.
    """
    m, lift = mechanism, float(motion.lift[row])
    turn = cam_turn(float(motion.theta[row]))
    groups = (
        ShapeGroup("axes", (*_axes(m), *_gear(m))),
        *second_track(m, lift, turn),
        ShapeGroup("cam", tuple(_cam(m)), Pose(turn)),
        *(() if m.second is None else m.second.hidden(turn, Pen("ink", _EDGE * m.scale))),
        ShapeGroup("turning", tuple(_turning(m))),
        *(_stem_groups(m, lift) if m.arm is None else arm_groups(m, m.arm, lift)),
        ShapeGroup("forces", tuple(arrows(m, motion, row))),
        ShapeGroup("values", tuple(_values(m, motion, row))),
    )
    size = " x ".join(f"{length:.4g}" for length in m.envelope.size)
    line = "the stem" if m.arm is None else "the line to the pivot"
    words = (
        f"{alt(m, motion, row)} Envelope across and along {line} and along the camshaft: {size} mm."
    )
    return Drawing("Arrangement", words, groups, _box(m))


def second_track(m: DrawnMechanism, lift: float, turn: float) -> tuple[ShapeGroup, ...]:
    """Groups of the second roller or face with its arm or frame, and of the second disc, behind the
    cam turned by `turn`, rad; none without them. Lift in mm.
    """
    second, edge = m.second, Pen("ink", _EDGE * m.scale, "steel")
    if second is None:
        return ()
    pose = Pose(shift=(m.axis, m.lowest + lift))
    carrier: tuple[Shape, ...]
    if m.arm is not None:
        pose = Pose(float(m.arm.turn(lift)), (0.0, m.arm.pivot))
        carrier = second.arm(m.arm.half, edge)
    elif m.face is not None:
        room = m.radius_max + 0.3 * m.stem
        carrier = (second.frame(m.face, room, m.stem, edge),)
    else:
        lifts = m.lowest, m.lowest + m.stroke
        carrier = (second.plate(lifts, m.bore or 0.5 * m.stem, m.stem, edge),)
    holes = [] if m.bore is None else [bore_outline(m.bore, m.keyway)]
    return (
        ShapeGroup("frame", carrier, pose),
        *second.behind(turn, holes, edge),
        ShapeGroup("second-roller", second.roller(m.pin, edge), pose),
    )


def _stem_groups(m: DrawnMechanism, lift: float) -> tuple[ShapeGroup, ...]:
    """Groups of a follower on its stem, from back to front: spring behind the stem, follower,
    spring before it, guides; lift in mm.
    """
    behind, before = m.spring.groups(m.axis, lift)
    follower = ShapeGroup("follower", tuple(_follower(m)), Pose(shift=(m.axis, m.lowest + lift)))
    return (*behind, follower, *before, ShapeGroup("guides", tuple(_guides(m))))


def arm_groups(m: DrawnMechanism, arm: DrawnArm, lift: float) -> tuple[ShapeGroup, ...]:
    """Groups of a follower on an arm, from back to front: second arm, arm with its roller or face
    turned to the lift, fixed pivot, spring.

    Parameters
    ----------
    lift : float   of the reference point along its arc, mm
    """
    edge, thin = Pen("ink", _EDGE * m.scale, "steel"), Pen("muted", _THIN * m.scale)
    half, end = arm.half, (0.0, -arm.length)
    bar = rectangle(-half, -arm.length, half, 0.0)
    swung: tuple[Shape, ...] = (
        DrawnOutline((bar,), edge),
        *(() if m.roller is None else _rollers(m, edge, end)),
        DrawnOutline((circle(arm.bearing),), edge),
    )
    if m.face is not None:
        outlines = (_bar_of_face(arm, m.face), _face_of(arm, m.face), circle(arm.bearing))
        swung = tuple(DrawnOutline((each,), edge) for each in outlines)
    wide, top = 1.6 * arm.bearing, arm.pivot + 2.0 * arm.bearing
    held = (-wide, arm.pivot + 1.2 * arm.bearing, wide, top)
    fixed = (
        DrawnOutline(hatching(held, 3.2 * m.scale), thin, closed=False),
        DrawnOutline(
            (segment((-wide, held[1]), (wide, held[1])),), Pen("ink", edge.width), closed=False
        ),
        DrawnOutline(
            (circle(0.5 * arm.bearing, (0.0, arm.pivot)),), Pen("ink", edge.width, "card")
        ),
    )
    pose = Pose(float(arm.turn(lift)), (0.0, arm.pivot))
    second, spring = _second_groups(m, arm, lift), _spring_groups(m, arm, lift)
    return (
        *second,
        ShapeGroup("follower", (*_lug(arm, edge), *swung), pose),
        ShapeGroup("pivot", fixed),
        *spring,
    )


def _second_groups(m: DrawnMechanism, arm: DrawnArm, lift: float) -> tuple[ShapeGroup, ...]:
    """Groups of the output and of the second arm of a rocker, which lie behind the first arm; ()
    without one.

    Parameters
    ----------
    lift : float   of the reference point along its arc, mm
    """
    second, edge = arm.second, Pen("ink", _EDGE * m.scale, "steel")
    if second is None:
        return ()
    end = arm.hung(second.end)
    bar = rectangle(-0.8 * arm.half, min(0.0, end[1]), 0.8 * arm.half, max(0.0, end[1]))
    pad = circle(second.pad, (float(end[0]), float(end[1])))
    swung = DrawnOutline((bar,), edge), DrawnOutline((pad,), edge)
    start, ahead = (arm.placed(second.flat(lift) + far * second.line) for far in (0.0, 1.0))
    x, y = ahead - start
    output = Pose(float(np.arctan2(-x, y)), (float(start[0]), float(start[1])))
    return (
        ShapeGroup("output", second.output(), output),
        ShapeGroup("second-arm", swung, Pose(float(arm.turn(lift)), (0.0, arm.pivot))),
    )


def _spring_groups(m: DrawnMechanism, arm: DrawnArm, lift: float) -> tuple[ShapeGroup, ...]:
    """Groups of the spring of an arm and of the ground at its fixed end; () without a spring.

    Parameters
    ----------
    lift : float   of the reference point along its arc, mm
    """
    ends = arm.spring_ends(lift)
    if arm.spring is None or ends is None:
        return ()
    held = arm.spring.shape.groups(*ends)
    anchor = next(each.pose for each in held if each.name == "link-anchor")
    wide = 1.1 * arm.spring.shape.half
    return (ShapeGroup("link-ground", ground(wide, 3.2 * m.scale, _EDGE * m.scale), anchor), *held)


def _lug(arm: DrawnArm, edge: Pen) -> tuple[DrawnOutline, ...]:
    """Bar from the pivot to the end of the spring where this end does not lie on the arm; () where
    it does or without a spring on the arm.

    The arm hangs down from its pivot at the origin, as in its group.
    """
    if arm.spring is None or arm.spring.arm_end is None:
        return ()
    along, outwards = end = polar(*arm.spring.arm_end)
    if abs(outwards) < arm.half and 0.0 < along < arm.length:
        return ()
    x, y = tip = arm.hung(end)
    aside = 0.7 * arm.half * np.array([-y, x]) / np.hypot(x, y)
    return (DrawnOutline((np.stack([aside, tip + aside, tip - aside, -aside], axis=1),), edge),)


def _face_of(arm: DrawnArm, face: tuple[float, float]) -> Array:
    """Outline (2, n) of the face of an arm that hangs down from its pivot at the origin, mm.

    Parameters
    ----------
    face : tuple   width along the arm and thickness, mm
    """
    width, thick = face
    along = 0.5 * width * np.linspace(-1.0, 1.0, _FACE_POINTS)
    sunk = 0.0 * along
    if arm.radius is not None:
        sunk = arm.radius - np.sqrt(np.maximum(arm.radius**2 - along**2, 0.0))
    back = arm.depth - thick
    towards = arm.sense * np.array([*(arm.depth - sunk), back, back])
    return np.stack([towards, np.array([*along, along[-1], along[0]]) - arm.length])


def _bar_of_face(arm: DrawnArm, face: tuple[float, float]) -> Array:
    """Corners (2, 4), mm, of the bar from the pivot to the middle of the back of a face."""
    back = np.array([arm.sense * (arm.depth - 0.5 * face[1]), -arm.length])
    aside = arm.half * np.array([-back[1], back[0]]) / np.hypot(*back)
    return np.stack([aside, back + aside, back - aside, -aside], axis=1)


def alt(m: DrawnMechanism, motion: DrawnMotion, row: int) -> str:
    """Text alternative of the drawing: angle and forces."""
    forces = ", ".join(
        f"{FORCES[key].lower()} {_newtons(motion, key, row)}" for key in m.shown_forces
    )
    carried = "face" if m.roller is None else "roller"
    stem = "follower, guides and spring"
    if not m.sprung:
        stem = "follower and guides" if m.groove is None else "follower in its groove and guides"
    parts = stem if m.arm is None else f"{carried} and arm on its pivot"
    if m.arm is not None and m.arm.second is not None:
        parts += ", second arm with its output"
    if m.arm is not None and m.arm.spring is not None:
        parts += ", spring"
    if m.second is not None:
        parts += f", {m.second.words}"
    return (
        f"Cam, {parts} in the plane of the cam at "
        f"{_angle_words(motion, row)}, load case {motion.load_case}. Lift "
        f"{motion.lift[row]:.4g} mm; {forces}. The cam turns clockwise."
    )


def _angle_words(motion: DrawnMotion, row: int) -> str:
    cam, shaft = np.degrees(motion.theta[row]), motion.shaft_angle[row]
    return f"cam {cam:.1f}°, {motion.shaft} {shaft:.1f}°"


def _newtons(motion: DrawnMotion, name: str, row: int) -> str:
    value = abs(float(motion.forces[name][row]))
    return f"{value:.0f} N" if value >= 100.0 else f"{value:.3g} N"


def _axes(m: DrawnMechanism) -> list[Shape]:
    """Follower axis, or line to the pivot of an arm, and centre line of the cam."""
    pen = Pen("muted", _THIN * m.scale, dash="dashdot")
    reach, axis = m.reach + 0.8 * m.text, m.axis if m.arm is None else 0.0
    return [
        DrawnOutline((segment((axis, -reach), (axis, m.top + 0.8 * m.text)),), pen, closed=False),
        DrawnOutline((segment((-reach, 0.0), (reach, 0.0)),), pen, closed=False),
    ]


def _gear(m: DrawnMechanism) -> list[Shape]:
    """Outline of the greatest part about the camshaft beyond the cam, such as the gear, behind it;
    empty where none is greater.
    """
    if not m.reach > m.radius_max:
        return []
    pen = Pen("muted", _THIN * m.scale, dash="dashdot")
    return [DrawnOutline((circle(m.reach),), pen)]


def _counterweight(m: DrawnMechanism) -> list[Shape]:
    """Sector with the unbalance of the counterweight in the frame of the cam, before the cam; empty
    without one.
    """
    weight = m.counterweight
    if weight is None:
        return []
    angle = weight.angle + weight.half * np.linspace(-1.0, 1.0, 29)
    arc = np.stack([np.cos(angle), np.sin(angle)])
    outline = np.concatenate([weight.outer * arc, weight.inner * arc[:, ::-1]], axis=1)
    return [DrawnOutline((outline,), Pen("ink", _EDGE * m.scale, "muted"))]


def _cam(m: DrawnMechanism) -> list[Shape]:
    """Contour, openings and the mark of the angle zero, in the frame of the cam."""
    edge = Pen("ink", _EDGE * m.scale, "steel")
    holes = [] if m.bore is None else [bore_outline(m.bore, m.keyway)]
    if m.counter_hole is not None:
        x, y, radius = m.counter_hole
        holes.append(circle(radius, (x, y)))
    zero = float(np.hypot(*m.contour[:, 0])) * np.array([0.86, 1.0])
    along = m.contour[:, 0] / np.hypot(*m.contour[:, 0])
    mark = np.outer(along, zero)
    words = Text("0°", tuple(0.78 * m.contour[:, 0] - 0.4 * m.text * np.array([0.0, 1.0])),
                 0.85 * m.text, "muted", "middle")  # fmt: skip
    disc = [DrawnOutline((m.contour, *holes), edge)]
    if m.groove is not None:
        floor = Pen("ink", edge.width, "shade")
        steps = (DrawnOutline((each.outer, each.inner), floor) for each in m.groove.steps)
        disc = [DrawnOutline((circle(m.groove.radius), *holes), edge), *steps]
    return [
        *disc,
        *_counterweight(m),
        DrawnOutline((mark,), Pen("ink", 1.6 * edge.width), closed=False),
        words,
    ]


def _turning(m: DrawnMechanism) -> list[Shape]:
    """Arc with an arrow in the direction of turning, below the cam on its left."""
    radius = m.reach + 0.9 * m.text
    angle = np.radians(np.linspace(247.0, 218.0, 25))
    arc = radius * np.stack([np.cos(angle), np.sin(angle)])
    width = 0.8 * m.scale
    return [
        DrawnOutline((arc[:, :-1],), Pen("muted", width), closed=False),
        Arrow("turning", tuple(arc[:, -5]), tuple(arc[:, -1] + 0.6 * (arc[:, -1] - arc[:, -2])),
              "muted", width),
    ]  # fmt: skip


def _follower(m: DrawnMechanism) -> list[Shape]:
    """Roller with pin and fork, or face; stem and moving seat; origin at roller centre or face."""
    edge = Pen("ink", _EDGE * m.scale, "steel")
    half, end = 0.5 * m.stem, m.stem_end - m.lowest
    made: list[Shape] = []
    if m.roller is not None:
        bridge = max(_rollers_of(m)) + 0.25 * m.stem
        made += [
            DrawnOutline((rectangle(-half, 0.0, half, end),), edge),
            DrawnOutline(
                (rectangle(-1.1 * half, bridge, 1.1 * half, bridge + 0.35 * m.stem),), edge
            ),
            *_rollers(m, edge),
        ]
    elif m.face is not None:
        width, thick = m.face
        made += [
            DrawnOutline((rectangle(-half, thick, half, end),), edge),
            DrawnOutline((rectangle(-0.5 * width, 0.0, 0.5 * width, thick),), edge),
        ]
    if not m.sprung:
        return made
    seat, reach = m.spring.seat - m.lowest, min(m.spring.reach, 4.0 * m.stem)
    thick = m.seat
    if not isinstance(m.spring, Coil):
        reach = 0.8 * m.stem
    made.append(DrawnOutline((rectangle(-reach, seat - thick, reach, seat),), edge))
    return made


def _rollers_of(m: DrawnMechanism) -> list[float]:
    """Radii of the roller, and of a second one on its pin, mm."""
    second = None if m.groove is None else m.groove.second
    return [each for each in (m.roller, second) if each is not None]


def _rollers(m: DrawnMechanism, edge: Pen, at: tuple[float, float] = (0.0, 0.0)) -> list[Shape]:
    """Roller about its pin; of two the larger one, which is at the face of the groove, with the
    other dashed behind it. at : place of their centres, mm
    """
    *behind, largest = sorted(_rollers_of(m))
    drawn: list[Shape] = [
        DrawnOutline((circle(largest, at), circle(m.pin, at)), Pen("ink", edge.width, "card")),
        DrawnOutline((circle(m.pin, at),), edge),
    ]
    hidden = Pen("ink", 0.5 * edge.width, dash="dashed")
    drawn += [DrawnOutline((circle(each, at),), hidden) for each in behind]
    return drawn


def _guides(m: DrawnMechanism) -> list[Shape]:
    """Bushes in hatched housings, and the fixed seat of the spring."""
    edge, thin = Pen("ink", _EDGE * m.scale, "shade"), Pen("muted", _THIN * m.scale)
    made: list[Shape] = []
    for bush in m.guides:
        low, high = bush.middle - 0.5 * bush.length, bush.middle + 0.5 * bush.length
        for side in (-1.0, 1.0):
            inner = m.axis + side * 0.5 * bush.bore
            outer, far = inner + side * bush.wall, inner + side * (bush.wall + 0.55 * m.stem)
            box = (min(outer, far), low, max(outer, far), high)
            made += [
                DrawnOutline(hatching(box, 3.2 * m.scale), thin, closed=False),
                DrawnOutline((segment((outer, low), (outer, high)),), Pen("ink", edge.width),
                        closed=False),
                DrawnOutline((rectangle(min(inner, outer), low, max(inner, outer), high),), edge),
            ]  # fmt: skip
    if isinstance(m.spring, Coil):
        for side in (-1.0, 1.0):
            inner, outer = (
                m.axis + side * 0.55 * m.stem,
                m.axis + side * (m.spring.reach + m.stem / 4),
            )
            box = (min(inner, outer), m.spring.top, max(inner, outer), m.spring.top + m.seat)
            made += [DrawnOutline(hatching(box, 3.2 * m.scale), thin, closed=False),
                     DrawnOutline((segment((inner, m.spring.top), (outer, m.spring.top)),),
                             Pen("ink", edge.width), closed=False)]  # fmt: skip
    return made


def contact_point(mechanism: DrawnMechanism, motion: DrawnMotion) -> Array:
    """Contact of cam and follower in the drawing, over the turn, (2, n), mm, on the track that
    carries.
    """
    first = _first_contact(mechanism, motion)
    return first if motion.pulling is None else motion.carried(motion.pulling[0], first)


def _first_contact(mechanism: DrawnMechanism, motion: DrawnMotion) -> Array:
    """Contact of the first roller or face, or in a groove of the wall that carries, (2, n), mm."""
    m, (centre, travel) = mechanism, mechanism.reference(motion.lift)
    radius = m.roller if m.arm is None or m.arm.radius is None else m.arm.radius
    if radius is None and m.arm is not None and motion.contact_offset is not None:
        depth, beside = m.arm.depth, motion.contact_offset
        cos, sin = np.cos(travel), np.sin(travel)
        return np.asarray(
            centre + np.stack([depth * sin - beside * cos, -depth * cos - beside * sin])
        )
    if radius is None:
        across = 0.0 if motion.contact_offset is None else motion.contact_offset
        return np.stack([centre[0] - across, centre[1]])
    angle = motion.pressure_angle - travel
    inwards = motion.pushes * np.stack([np.sin(angle), np.cos(angle)])
    if m.groove is not None and m.groove.second is not None:
        return np.asarray(centre - np.where(motion.pushes < 0.0, m.groove.second, radius) * inwards)
    return np.asarray(centre - radius * inwards)


def arrows(mechanism: DrawnMechanism, motion: DrawnMotion, row: int) -> list[Arrow]:
    """Arrows of the forces on the follower at row `row`, tail and tip in mm, all to the scale at
    which the greatest force of the turn is `arrow_length` long.

    A contact force ends at the contact, a guide reaction at the edge of the stem, the spring force
    beside its moving seat; a negative force points the other way.
    """
    m = mechanism
    scale = m.arrow_length / motion.greatest_force if motion.greatest_force > 0.0 else 0.0
    touch = contact_point(m, motion)[:, row]
    angles = motion.pressure_angle - m.reference(motion.lift)[1]
    push = np.stack([np.sin(angles), np.cos(angles)])
    push = (
        motion.pushes * push if motion.pulling is None else motion.carried(motion.pulling[1], push)
    )
    at = {"contact": (touch, push[:, row])}
    if m.arm is None:
        beside = m.axis + m.spring.reach + 1.6 * m.scale
        seat = np.array([beside, m.spring.seat + motion.lift[row]])
        # a positive side force points along +x: guide A pushes back, guide B with it
        at |= {
            "spring": (seat, np.array([0.0, -1.0])),
            "guide-a": (np.array([m.axis, m.guides[0].middle]), np.array([-1.0, 0.0])),
            "guide-b": (np.array([m.axis, m.guides[1].middle]), np.array([1.0, 0.0])),
        }
    made = []
    for name, (tip, along) in at.items():
        if name not in m.shown_forces:
            continue
        force = float(motion.forces[name][row])
        push = np.sign(force) * along
        end = tip - 0.5 * m.stem * push if name.startswith("guide") else tip
        tail = end - abs(force) * scale * push
        made.append(Arrow(name, (float(tail[0]), float(tail[1])), (float(end[0]), float(end[1])),
                          COLOURS[name], 1.5 * m.scale))  # fmt: skip
    return made


def label_places(mechanism: DrawnMechanism) -> dict[str, tuple[float, float]]:
    """Left end of the baseline (x, y), mm, of each value label by name of the force, in a column
    right of the mechanism, moved up where they would overlap.
    """
    m, pitch = mechanism, 2.7 * mechanism.text
    wanted = {"contact": m.reach + 0.6 * m.text}
    if m.arm is None:
        wanted |= {"guide-a": m.guides[0].middle, "spring": m.spring.seat + 0.5 * m.stroke,
                   "guide-b": m.guides[1].middle}  # fmt: skip
    wanted = {name: height for name, height in wanted.items() if name in m.shown_forces}
    across, free = _column(m), m.reach + 0.6 * m.text
    places = {}
    for name, height in sorted(wanted.items(), key=lambda item: item[1]):
        places[name] = (across, max(height, free))
        free = places[name][1] + pitch
    return places


def _column(m: DrawnMechanism) -> float:
    """x of the left edge of the value labels, mm: right of spring, face, guides and the arrows
    beside them.
    """
    if m.arm is not None:
        return m.envelope.across[1] + 0.8 * m.text
    bush = max(0.5 * each.bore + each.wall for each in m.guides) + 0.55 * m.stem
    face = 0.0 if m.face is None else 0.5 * m.face[0]
    beside = m.spring.reach + 4.0 * m.scale
    return m.axis + max(beside, face, bush, 0.5 * m.stem + m.arrow_length) + 0.8 * m.text


def _values(m: DrawnMechanism, motion: DrawnMotion, row: int) -> list[Shape]:
    """Texts with names and values of the forces and with the angle at row `row`, and a bar with the
    force that its length stands for.
    """
    made: list[Shape] = []
    for name, (x, y) in label_places(m).items():
        words = _newtons(motion, name, row)
        made += [
            Text(FORCES[name], (x, y + 1.05 * m.text), 0.82 * m.text, "muted"),
            Text(words, (x, y), m.text, COLOURS[name], bold=True, name=name),
        ]
    left, bottom, right, _ = _box(m)
    foot = bottom + 0.7 * m.text
    made.append(Text(_angle_words(motion, row), (left + 0.4 * m.text, foot), m.text, bold=True,
                     name="angle"))  # fmt: skip
    if motion.greatest_force > 0.0:
        stated = _round(0.5 * motion.greatest_force)
        length = stated * m.arrow_length / motion.greatest_force
        end = right - 0.4 * m.text
        low = foot + 1.6 * m.text  # above the line of the angle
        bar, y = segment((end - length, low), (end, low)), low + 0.5 * m.text
        made += [
            DrawnOutline((bar,), Pen("ink", 1.5 * m.scale), closed=False),
            Text(f"{stated:g} N", (end, y), 0.82 * m.text, "muted", "end"),
        ]
    return made


def _round(value: float) -> float:
    """Greatest number of the form 1, 2 or 5 times a power of ten that is not above a positive
    value.
    """
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value))


@lru_cache(maxsize=2)
def _box(m: DrawnMechanism) -> tuple[float, float, float, float]:
    """Left, bottom, right and top of the drawing with its labels and margins, mm."""
    margin = 1.4 * m.text
    places = label_places(m)
    widest = max(Text(name, (0.0, 0.0), 0.82 * m.text).box[2] for name in FORCES.values())
    right = max(m.reach + margin, _column(m) + widest)
    left = m.envelope.across[0] - margin
    if m.arm is None:
        left = min(left, m.axis - 0.5 * m.stem - m.arrow_length - 0.5 * margin)
    top = max(m.top + margin, max(y for _, y in places.values()) + 2.2 * m.text)
    bottom = min(-m.reach, m.envelope.along[0]) - 2.4 * margin
    return left, bottom, right, top


def moving_record(
    mechanism: DrawnMechanism, motion: DrawnMotion, rows: Sequence[int]
) -> dict[str, Json]:
    """Poses of the groups that move, arrows and words at rows of the motion, for an animated page,
    each as a list over the rows by name of group or force.

    Poses are turn (deg, counter-clockwise), shift x and y (mm) and stretch of each row; arrows x
    and y of tail and tip, mm.
    """
    poses: dict[str, list[Pose]] = {}
    shown = mechanism.shown_forces
    tips: dict[str, list[list[float]]] = {name: [] for name in shown}
    words: dict[str, list[str]] = {name: [] for name in (*shown, "angle")}
    for row in rows:
        for group in drawing(mechanism, motion, row).groups:
            poses.setdefault(group.name, []).append(group.pose)
        for arrow in arrows(mechanism, motion, row):
            tips[arrow.name].append([round(v, 2) for v in (*arrow.tail, *arrow.tip)])
            words[arrow.name].append(_newtons(motion, arrow.name, row))
        words["angle"].append(_angle_words(motion, row))
    return {
        "poses": {
            name: [
                [round(v, 3) for v in (np.degrees(p.turn), *p.shift, p.stretch)] for p in of_group
            ]
            for name, of_group in poses.items()
            if any(pose != of_group[0] for pose in of_group)
        },
        "arrows": tips,
        "words": words,
    }

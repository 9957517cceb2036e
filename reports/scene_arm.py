"""Solids of the 3-D scene that an arm carries: second arm, output and spring, with their poses."""

from __future__ import annotations

from collections.abc import Iterator

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import Json
from camwright.reports.drawing.arm_parts import PIN_SHARE, PLATE_SHARE, LinkCoil, LinkGas, SecondArm
from camwright.reports.drawing.arrangement import DrawnArm, DrawnMechanism, arm_groups
from camwright.reports.scene_solids import Solid, box, helix, joined, pin, rod

_BEHIND = 0.8  # width of the cam by which a second arm on the side of the first lies behind it


def moving(mechanism: DrawnMechanism, lifts: Array, width: float, digits: int) -> list[Json]:
    """Records of the solids that an arm carries, each with its poses as drawn at lifts (f,): turn,
    rad, shift, mm, and stretch along y; [] of a follower without an arm.

    Parameters
    ----------
    lifts : array (f,)   mm
    width : float        of the cam, mm
    digits : int         kept in the records
    """
    arm = mechanism.arm
    if arm is None:
        return []
    poses = [
        {group.name: group.pose for group in arm_groups(mechanism, arm, float(lift))}
        for lift in lifts
    ]
    return [
        {
            "body": solid.as_record(digits),
            "turn": [round(pose[name].turn, digits) for pose in poses],
            "x": [round(pose[name].shift[0], digits) for pose in poses],
            "y": [round(pose[name].shift[1], digits) for pose in poses],
            "stretch": [round(pose[name].stretch, digits) for pose in poses],
        }
        for name, solid in _solids(mechanism, arm, width)
    ]


def _solids(m: DrawnMechanism, arm: DrawnArm, width: float) -> Iterator[tuple[str, Solid]]:
    """Pairs (name, solid) of second arm, output and spring of an arm, each in the frame of the
    drawing's group of this name, mm.

    Parameters
    ----------
    width : float   of the cam, mm
    """
    if arm.second is not None:
        yield "second-arm", _second_arm(arm, arm.second, width)
        head = pin_along(arm.second.pad, 0.0, arm.second.head)
        stem = pin_along(0.5 * arm.second.pad, arm.second.head, arm.second.rod)
        yield "output", joined([head, stem])
    ends = arm.spring_ends(0.0)
    if arm.spring is None or ends is None:
        return
    shape = arm.spring.shape
    if isinstance(shape, LinkGas):
        axle = pin(0.5 * shape.bore, 0.4 * shape.bore)
        yield "link-anchor", joined([axle, pin_along(shape.half, 0.0, shape.body)])
        yield "link-end", joined([axle, pin_along(0.25 * shape.bore, 0.0, shape.rod)])
    elif isinstance(shape, LinkCoil):
        coils = next(g for g in arm_groups(m, arm, 0.0) if g.name == "link-before")
        wound = helix(shape.diameter, shape.wire, shape.turns, coils.pose.stretch)
        yield "link-before", Solid(wound.points / [[1.0], [coils.pose.stretch], [1.0]],
                                   wound.triangles)  # fmt: skip
        fitted = _fitting(shape)
        yield "link-end", fitted
        yield "link-anchor", fitted


def _second_arm(arm: DrawnArm, second: SecondArm, width: float) -> Solid:
    """Bar and pad of a second arm, its pivot at the origin, while the first arm lies along -y; mm.

    Parameters
    ----------
    width : float   of the cam, mm
    """
    far, half = -second.side * second.length, 0.8 * arm.half
    bar = box((-half, min(0.0, far), -0.25 * width), (half, max(0.0, far), 0.25 * width))
    both = joined([bar, pin(second.pad, 0.3 * width).raised(far)])
    return both.deeper(-_BEHIND * width) if second.side > 0.0 else both


def _fitting(shape: LinkCoil) -> Solid:
    """Pin at the origin with the eye or the seat of a coil spring along +y; the seat alone on an
    output.
    """
    axle = pin(PIN_SHARE * shape.diameter, 0.5 * shape.diameter)
    if shape.ends == "eyes":
        return joined([axle, rod(shape.wire, 0.0, shape.fitting)])
    low = shape.fitting - PLATE_SHARE * shape.diameter
    seat = pin_along(shape.half, low, shape.fitting)
    return seat if shape.ends == "seats" else joined([seat, axle])


def pin_along(radius: float, start: float, end: float) -> Solid:
    """Cylinder along y with its end faces, mm."""
    return pin(radius, 0.5 * (end - start)).upright(0.5 * (start + end))

"""Solids of the 3-D scene of a second roller or face that pulls the follower, and of its disc."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, rotation
from camwright.pipeline.base.files import Json
from camwright.reports.drawing.arrangement import DrawnMechanism, second_track
from camwright.reports.drawing.second_follower import FRAME_BAR, PAST, SLOT, SLOT_SIDE, DrawnSecond
from camwright.reports.scene_solids import (
    Solid,
    box,
    fork,
    joined,
    pin,
    ring,
    rod,
    tube,
    unit_circle,
)

_DISC_GREY, _ROLLER_GREY, _ARM_GREY = "#c3cbd4", "#e3e8ed", "#8b95a1"
_PLATE_AT, _PLATE_THICK = 0.6, 0.25  # of the cam width: plate from the middle, its thickness
_PIN_END = 0.55  # half of a pin within its roller


def carrier(m: DrawnMechanism, width: float, radius: float) -> Solid | None:
    """Stem with all that joins both rollers or faces, about the first of them, mm; None on an arm
    and without a second one.

    Rollers are held by overhung pins on a plate on the far side of the first disc, with a slot
    around the shaft; faces by a frame around the cam.

    Parameters
    ----------
    width : float    of the cam
    radius : float   of the pins
    """
    second, end = m.second, m.stem_end - m.lowest
    if second is None or m.arm is not None:
        return None
    if m.face is not None:
        return joined([*_frame(m, second, m.face, width), rod(m.stem, m.face[1], end)])
    return joined([*_plate(m, second, width, radius), rod(m.stem, 0.0, end)])


def _frame(
    m: DrawnMechanism, second: DrawnSecond, face: tuple[float, float], width: float
) -> Iterator[Solid]:
    """Bars of the frame of a yoke around the cam."""
    wide, thick = face
    half, foot = max(m.radius_max + 0.3 * m.stem, 0.5 * wide), float(second.centre[1])
    outside, deep = half + FRAME_BAR * m.stem, 0.5 * width
    for low, high in ((0.0, thick), (foot - thick, foot)):
        yield box((-outside, low, -deep), (outside, high, deep))
    for left, right in ((-outside, -half), (half, outside)):
        yield box((left, foot, -deep), (right, 0.0, deep))


def _plate(m: DrawnMechanism, second: DrawnSecond, width: float, radius: float) -> Iterator[Solid]:
    """Plate with a slot around the shaft, the pins of both rollers and the joint to the stem."""
    slot, foot = SLOT * (m.bore or 0.5 * m.stem), float(second.centre[1])
    half, near = slot + SLOT_SIDE * m.stem, -_PLATE_AT * width
    far, roller = near - _PLATE_THICK * width, m.roller or radius
    bottom, top = foot - PAST * (second.radius or roller), 1.25 * roller
    for left, right in ((-half, -slot), (slot, half)):
        yield box((left, bottom, far), (right, top, near))
    highest = m.lowest + m.stroke
    for low, high in ((bottom, -highest - slot), (slot - m.lowest, top)):
        yield box((-slot, low, far), (slot, high, near))
    yield box((-0.5 * m.stem, roller + 1.0, far), (0.5 * m.stem, top, 0.5 * m.stem))
    for height, middle in ((0.0, 0.0), (foot, second.spacing)):
        reach = 0.5 * (middle + _PIN_END * width - far)
        yield pin(radius, reach).deeper(far + reach).raised(height)


def moving(
    m: DrawnMechanism, bore: Array, at: tuple[Array, Array], width: float, digits: int,
    stresses: tuple[list[float], list[str]] | None,
) -> list[Json]:  # fmt: skip
    """Records of second disc, roller and arm with their poses as drawn, see `scene_arm.moving`; []
    without a disc of its own.

    Parameters
    ----------
    bore : array (2, n)      of the cam, and the number of points of the disc
    at : tuple               lift (f,), mm, and rotation of the cam (f,), rad
    width : float            of the cam, mm
    stresses                 greatest von Mises stress of the turn, MPa, and its words at the points
                             of the disc where it carries; None where not known
    """
    second = m.second
    if second is None or second.disc is None:
        return []
    poses = [{group.name: group.pose for group in second_track(m, float(lift), float(angle))}
             for lift, angle in zip(*at, strict=True)]  # fmt: skip
    count = second.disc.shape[1]
    disc = second.disc[:, np.arange(bore.shape[1]) * count // bore.shape[1]]
    records: list[Json] = []
    for name, solid, colour in _bodies(m, second, disc, bore, width):
        body = solid.as_record(digits)
        if name == "flank" and stresses is not None:
            body |= {"values": 2 * stresses[0], "words": 2 * stresses[1]}
        drawn = [pose["second-cam" if name == "flank" else name] for pose in poses]
        records.append({
            "body": body, "colour": colour, "plain": name == "second-cam",
            "turn": [round(each.turn, digits) for each in drawn],
            "x": [round(each.shift[0], digits) for each in drawn],
            "y": [round(each.shift[1], digits) for each in drawn],
            "stretch": [1.0] * len(drawn),
        })  # fmt: skip
    return records


def _bodies(
    m: DrawnMechanism, second: DrawnSecond, disc: Array, bore: Array, width: float
) -> Iterator[tuple[str, Solid, str]]:
    """Name of the group of the drawing, solid about its origin, mm, and colour of each body."""
    away, around = np.hypot(*bore), np.arctan2(bore[1], bore[0])
    order, angle = np.argsort(around), np.arctan2(disc[1], disc[0])
    hole = np.interp(angle, around[order], away[order], period=2.0 * np.pi)
    inner = hole * disc / np.hypot(*disc)
    faces = [tube(disc, inner, side * width / 2) for side in (-1, 1)]
    yield "flank", ring(disc, width).deeper(second.spacing), _DISC_GREY
    yield "second-cam", joined([*faces, ring(inner, width)]).deeper(second.spacing), _DISC_GREY
    radius = second.radius or 0.0
    hub = min(m.pin, 0.8 * radius)
    rims = radius * unit_circle(), hub * unit_circle()
    ends = [tube(*rims, side * width / 2) for side in (-1, 1)]
    roller = joined([*(ring(rim, width) for rim in rims), *ends]).deeper(second.spacing)
    x, y = (float(each) for each in second.centre)
    yield "second-roller", roller.shifted(x).raised(y), _ROLLER_GREY
    if m.arm is None:
        return
    length = float(np.hypot(x, y))
    swung = fork(radius, hub, width, 2.0 * m.arm.half, length).deeper(second.spacing)
    turned = rotation(float(np.arctan2(x, -y)))
    points = swung.points.copy()
    points[:2] = turned @ points[:2] + second.centre[:, None]
    yield "frame", replace(swung, points=points), _ARM_GREY

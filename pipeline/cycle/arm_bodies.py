"""Bodies of an oscillating follower, as swung bars: arm, hub of its pivot, fork, roller, spring."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Value
from camwright.geometry.swung_bar import SwungBar, SwungLink
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers

HUB, FORK, SPRING = "hub", "fork", "spring"
_LIFT = "arm.lift"
ARM_DEPTH, ARM_WIDTH = "follower.arm.depth", "follower.arm.width"


class SwungBody(NamedTuple):
    """Body with round ends about a bar: half of its depth in the plane, m, and its place beside.

    `beside`: distance of the middle from that of the cam along the camshaft, to either side, and
    half of the width, m; NaN: not stated.
    """

    bar: SwungBar | SwungLink
    half: Value
    beside: tuple[Value, Value]

    def beyond(self, ends: tuple[Value, Value]) -> Value:
        """Axial gap from a part by its middle from that of the cam and half of its width, m."""
        apart: Value = np.abs(np.abs(ends[0]) - self.beside[0]) - self.beside[1] - ends[1]
        return apart

    def from_disc(self, along: Value, across: Value, radius: Value) -> Value:
        """Least gap from a disc over the swing, m, in the plane of the cam."""
        gap: Value = self.bar.from_point(along, across) - self.half - radius
        return gap


def with_swing(cams: Iterable[LoadedCam]) -> dict[str, Value]:
    """Numbers of the swing, from the loaded cams of the load cases: the maximum lift, m."""
    return {_LIFT: next(iter(cams)).highest}


def swung_bodies(numbers: Numbers) -> dict[str, SwungBody]:
    """Parts of an arm of stated size by name, over the swing; {} of a stem.

    From zero to the maximum lift, where that is among the numbers (`with_swing`). The arm ends at
    the bridge of a fork that is described, else at its reference point, about which roller and
    cheeks are, or a disc of the radius of a curved face. The block of a flat one is within as far
    on both sides of the line of the arm. A spring between arm and fixed point is as thick as
    stated, or as its coils.
    """
    case = numbers.known_case
    stated, keys = case.follower.arm, ("centre_distance", "length")
    if stated is None:
        return {}
    distance, length = (numbers[f"follower.arm.{key}"] for key in keys)
    arm = Arm(distance, length, stated.sense)
    offset, prime = numbers.get("follower.face.offset"), numbers["cam.prime_radius"]
    start = arm.start_angle(prime, offset)
    lift, aside = (numbers.get(key) for key in (_LIFT, "roller.axial_offset"))
    swing, aside = (0.0 if each is None else each for each in (lift, aside))
    bar = SwungBar(arm, start, start + swing / length, 0.0, length)
    deep = numbers["follower.half_depth"] + aside
    bodies = dict[str, SwungBody]()
    if offset is None:
        around = bar._replace(inner=length), numbers["follower.round"]
    else:
        half, thick = 0.5 * numbers["follower.face.width"], numbers["follower.face.thickness"]
        block = bar._replace(inner=np.maximum(length - half, 0.0), outer=length + half)
        around = block, np.maximum(np.abs(offset), np.abs(thick - offset))
    bodies[case.facing.word] = SwungBody(*around, (0.0, deep))
    cheek, bridge = (numbers.get(f"roller.fork.cheek_{name}") for name in ("height", "length"))
    end = length
    if cheek is not None and bridge is not None:
        end = np.maximum(length - bridge, 0.0)
        bodies[FORK] = SwungBody(bar._replace(inner=end), 0.5 * cheek, (0.0, deep))
    depth, width, hub = (numbers.get(key) for key in (ARM_DEPTH, ARM_WIDTH, "follower.arm.hub"))
    if depth is not None:
        beside = (
            numbers["follower.arm.plane_offset"],
            (np.nan if width is None else 0.5 * width + aside),
        )
        bodies["arm"] = SwungBody(bar._replace(outer=end), 0.5 * depth, beside)
        diameter = depth if hub is None else hub
        bodies[HUB] = SwungBody(bar._replace(outer=0.0), 0.5 * diameter, beside)
    body = numbers.get("spring.link.body")
    if body is not None:
        radius, fixed, angle, out, beside_cam = (
            numbers[f"spring.link.{key}"]
            for key in ("arm_radius", "fixed_radius", "arm_angle", "fixed_angle", "plane_offset")
        )
        axis = SwungLink(arm, bar.low, bar.high, radius, angle, fixed, start + out)
        bodies[SPRING] = SwungBody(axis, 0.5 * body, (beside_cam, 0.5 * body))
    return bodies

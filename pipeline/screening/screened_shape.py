"""Demand and limit of the checks of the cam shape, of many designs at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    CURVATURE_RATIO,
    GUIDE_GAP,
    GUIDE_LENGTH,
    MINIMUM_WALL,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    TOOL_RADIUS,
    UNDERCUT_FACTOR,
)
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.screening.design_arrays import Designs, Judged


def pressure_angle(designs: Designs) -> Judged:
    allowed, on_return = designs.limit(PRESSURE_ANGLE), designs.limit(RETURN_PRESSURE_ANGLE)
    either = sampled_greatest(np.abs(designs.whole.motion.pressure_angle))
    if np.isnan(on_return).all():
        return either, allowed
    offset, slope = designs.value("cam.offset"), designs.jets[1]
    rise, back = (
        sampled_greatest(np.arctan2(np.abs(of_stroke - offset), designs.whole.motion.height))
        for of_stroke in (np.maximum(slope, 0.0), np.minimum(slope, 0.0))
    )
    steeper = back / on_return > rise / allowed  # false for NaN: no limit of the return
    demand = np.where(np.isnan(on_return), either, np.where(steeper, back, rise))
    return demand, np.where(steeper, on_return, allowed)


def curvature_ratio(designs: Designs) -> Judged:
    return designs.least_convex_radius / designs.value("roller.radius")[:, 0], designs.limit(
        CURVATURE_RATIO
    )


def undercut(designs: Designs) -> Judged:
    return designs.least_factor, designs.limit(UNDERCUT_FACTOR)


def is_concave(designs: Designs) -> NDArray[np.bool_]:
    """Whether a cam has concave places; any tool fits a convex one."""
    return sampled_least(designs.whole.motion.path_curvature) < -np.finfo(float).tiny


def concave_radius(designs: Designs) -> Judged:
    hollow = np.minimum(sampled_least(designs.whole.motion.path_curvature), -np.finfo(float).tiny)
    radius = designs.value("roller.radius")[:, 0] - 1.0 / hollow
    tool, stated = designs.limit(TOOL_RADIUS), designs.case.workshop.tool_radius
    largest = np.where(np.isnan(tool), np.nan if stated is None else stated, tool)
    return np.where(is_concave(designs), radius, np.nan), TOOL_ALLOWANCE * largest


def minimum_wall(designs: Designs) -> Judged:
    keyway = designs.case.cam.held_radius - designs.case.cam.bore_radius
    held = designs.value("cam.bore_radius")[:, 0] + keyway
    return sampled_least(designs.whole.motion.contour_radius) / held, designs.limit(MINIMUM_WALL)


def cam_radius(designs: Designs) -> Judged:
    return sampled_greatest(designs.whole.motion.contour_radius), designs.limit(CAM_RADIUS)


def spring_travel(designs: Designs) -> Judged:
    return designs.highest, designs.value("spring.travel_max")[:, 0]


def guide_gap(designs: Designs) -> Judged:
    overhang, length = (
        designs.value("follower.overhang_at_max_lift"),
        designs.value("guides.a.length"),
    )
    mouth = (overhang - 0.5 * length)[:, 0]
    base = designs.whole.motion.height[:, 0] - designs.jets[0][:, 0]
    highest = base + designs.highest + mouth
    over_cam = highest - sampled_greatest(designs.whole.motion.contour_radius)
    extent = designs.of_kind("roller.radius", "follower.face.thickness")[:, 0]
    gap = np.minimum(over_cam, mouth - extent)
    return gap, designs.limit(GUIDE_GAP)


def guide_length(designs: Designs) -> Judged:
    lengths = designs.value("guides.a.length") + designs.value("guides.b.length")
    spread = (designs.value("guides.spacing") + 0.5 * lengths)[:, 0]
    overhang = designs.value("follower.overhang_at_max_lift")[:, 0] + designs.highest
    return spread / overhang, designs.limit(GUIDE_LENGTH)

"""Chart of cam size: pressure angle and curvature over the base radius."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.cam_size import PitchLimits
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import UNDERCUT_FACTOR
from camwright.pipeline.records.size_document import SizeChart, SizeCurve, SizePanel
from camwright.pipeline.search.sizes.shapes import FaceShapes, RollerShapes, Shape, Shapes

_RADIUS_FROM, _RADIUS_TO = 0.4, 2.2
"""Range of the chart over the prime or base radius of the sized cam."""
_BEYOND_OFFSET = 1.02
"""Least prime radius of the chart over offset and roller radius."""
_CHART_POINTS, _BEST_POINTS = 73, 19


def chart_record(case: Case, shapes: Shapes, shape: Shape) -> SizeChart:
    """Curves of the chart around a sized shape, in mm and deg."""
    panels = (
        _face_panels(case, shapes, shape)
        if isinstance(shapes, FaceShapes)
        else _roller_panels(shapes, shape)
    )
    return {"base_radius_mm": in_unit(shape.base_radius, "mm"), "panels": panels}


def _roller_panels(shapes: RollerShapes, shape: Shape) -> list[SizePanel]:
    cam, inset = shapes.cam, shape.roller_radius
    low = max(
        _RADIUS_FROM * shape.prime_radius,
        _BEYOND_OFFSET * abs(shape.offset),
        _BEYOND_OFFSET * shape.roller_radius,
    )
    primes, some = (
        _about(low, shape.prime_radius, count) for count in (_CHART_POINTS, _BEST_POINTS)
    )

    def best(prime: float) -> float:
        offset = cam.best_offset(prime, shapes.angle_limits)
        return cam.extremes(prime, offset).pressure_angle.value

    def curve(
        label: str, at: Array, measure: Callable[[float], float], unit: str, *, dashed: bool = False
    ) -> SizeCurve:
        return _curve(label, at, [measure(float(each)) for each in at], inset, unit, dashed=dashed)

    sized = {float(prime): cam.extremes(float(prime), shape.offset) for prime in primes}
    angles = [
        curve("rise", primes, lambda prime: sized[prime].rise.value, "deg"),
        curve("return", primes, lambda prime: sized[prime].back.value, "deg"),
    ]
    if shape.offset != 0.0:
        angles.append(
            curve("no offset", some, lambda p: cam.extremes(p).pressure_angle.value, "deg")
        )
    angles.append(curve("balanced offset of each radius", some, best, "deg", dashed=True))
    radius = [curve("", primes, lambda prime: sized[prime].convex_radius.value, "mm")]
    least = in_unit(shapes.limits(shape.roller_radius).convex_radius, "mm")
    return [
        _panel("pressure angle", "deg", _angle_limits(shapes.angle_limits), angles),
        _panel("convex pitch radius", "mm", {"limit": least}, radius),
    ]


def _face_panels(case: Case, shapes: FaceShapes, shape: Shape) -> list[SizePanel]:
    bases, cam = (
        _about(_RADIUS_FROM * shape.prime_radius, shape.prime_radius, _CHART_POINTS),
        shapes.cam,
    )
    radii = bases + cam.least_radius(0.0).value
    factors = [cam.undercut_factor(float(each)) for each in bases]
    limit, least = case.limits[UNDERCUT_FACTOR], in_unit(shapes.least_radius, "mm")
    radius = [_curve("", bases, radii.tolist(), 0.0, "mm")]
    return [
        _panel("radius of curvature", "mm", {"limit" if least else "cusp": least}, radius),
        _panel("undercut factor", "", {"limit": limit}, [_curve("", bases, factors, 0.0, "")]),
    ]


def _about(least: float, radius: float, count: int) -> Array:
    return np.linspace(least, max(_RADIUS_TO * radius, 1.5 * least), count)


def _curve(
    label: str, at: Array, values: list[float], inset: float, unit: str, *, dashed: bool = False
) -> SizeCurve:
    x = [in_unit(float(each) - inset, "mm") for each in at]
    return {"label": label, "x": x, "y": [in_unit(each, unit) for each in values], "dashed": dashed}


def _angle_limits(limits: PitchLimits) -> dict[str, float]:
    """Limits of the pressure angle by label, deg."""
    rise, back = in_unit(limits.rise, "deg"), in_unit(limits.back, "deg")
    return {"limit": rise} if rise == back else {"limit, rise": rise, "limit, return": back}


def _panel(
    quantity: str, unit: str, limits: dict[str, float], curves: list[SizeCurve]
) -> SizePanel:
    return {"quantity": quantity, "unit": unit, "limits": limits, "curves": curves}

"""Chart of cam size: pressure angle and curvature over the base radius."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.cam_size import PitchLimits
from camwright.geometry.figures import SERIES, AxisMark, Curve, Figure, LimitLine, Panel, over
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import UNDERCUT_FACTOR
from camwright.pipeline.records.size_document import SizeChart, SizeCurve, SizePanel
from camwright.pipeline.search.sizes.shapes import FaceShapes, RollerShapes, Shape, Shapes

_RADIUS_FROM, _RADIUS_TO = 0.4, 2.2
"""Range of the chart over the prime or base radius of the sized cam."""
_HEADROOM = 1.9
"""Greatest value of a panel over the greater of limit and value at the sized radius."""
_BEYOND_OFFSET = 1.02
"""Least prime radius of the chart over offset and roller radius."""
_CHART_POINTS, _BEST_POINTS = 73, 19


def size_figure(case: Case, shapes: Shapes, shape: Shape) -> Figure:
    """Figure over base radii, mm, about that of a sized cam, which is marked.

    Of a roller pressure angle, deg, and radius of curvature, mm; of a face radius of curvature and
    undercut factor.

    Parameters
    ----------
    shapes : Shapes   maker of the cams of the case at other base radii
    shape : Shape     the sized cam
    """
    panels = (
        _face_panels(case, shapes, shape)
        if isinstance(shapes, FaceShapes)
        else _roller_panels(shapes, shape)
    )
    size = in_unit(shape.base_radius, "mm")
    mark = AxisMark(size, f"{size:.6g} mm")
    title = "Size of the cam"
    figure = over("size", title, "", "base radius", "mm", panels, dots=False, marks=(mark,))
    return replace(figure, panels=tuple(_about_size(panel, size) for panel in panels))


def _about_size(panel: Panel, size: float) -> Panel:
    """Panel over the base radius with a spot at the sized cam, and its vertical axis cut at
    `_HEADROOM` times the greatest of limits and values there.

    Parameters
    ----------
    panel : Panel   curves over the base radius, mm
    size : float    base radius of the sized cam, mm
    """
    here = [float(np.interp(size, curve.x, curve.y)) for curve in panel.curves]
    reached = [*here, *(line.value for line in panel.limits)]
    spot = Curve(np.array([size]), np.array(here[:1]), colour="ink", look="spot")
    span = min(0.0, *reached), _HEADROOM * max(reached)
    return replace(panel, curves=(*panel.curves, spot), span=span)


def chart_record(figure: Figure) -> SizeChart:
    """Record of the figure of `size_figure`."""
    panels: list[SizePanel] = [
        {
            "quantity": panel.quantity,
            "unit": panel.unit,
            "limits": {line.label: line.value for line in panel.limits},
            "curves": [_curve_record(curve) for curve in panel.curves if curve.look != "spot"],
        }
        for panel in figure.panels
    ]
    return {"base_radius_mm": figure.axis.marks[0].start, "panels": panels}


def _curve_record(curve: Curve) -> SizeCurve:
    dashed = curve.look == "dashed"
    return {"label": curve.label, "x": curve.x.tolist(), "y": curve.y.tolist(), "dashed": dashed}


def _roller_panels(shapes: RollerShapes, shape: Shape) -> list[Panel]:
    """Panels of pressure angle, deg, and least convex radius of the pitch curve, mm, of roller cams
    over the base radius, mm.

    Parameters
    ----------
    shapes : RollerShapes   cams at other base radii
    shape : Shape           the sized cam, whose offset and roller all have
    """
    cam, inset = shapes.cam, shape.roller_radius
    least, most = cam.reach(shape.offset)
    low = max(
        _RADIUS_FROM * shape.prime_radius,
        _BEYOND_OFFSET * least,
        _BEYOND_OFFSET * shape.roller_radius,
    )
    primes, some = (
        np.minimum(_about(low, shape.prime_radius, count), most)
        for count in (_CHART_POINTS, _BEST_POINTS)
    )
    bases, few = (_in(radii - inset, "mm") for radii in (primes, some))

    def best(prime: float) -> float:
        offset = cam.best_offset(prime, shapes.angle_limits)
        return cam.extremes(prime, offset).pressure_angle.value

    sized = [cam.extremes(float(prime), shape.offset) for prime in primes]
    angles = [
        Curve(bases, _in([each.rise.value for each in sized], "deg"), "rise"),
        Curve(bases, _in([each.back.value for each in sized], "deg"), "return", SERIES[1]),
    ]
    if shape.offset != 0.0 and cam.has_offset:
        plain = [cam.extremes(float(prime)).pressure_angle.value for prime in some]
        angles.append(Curve(few, _in(plain, "deg"), "no offset", SERIES[2]))
    balanced = _in([best(float(prime)) for prime in some], "deg")
    label = f"balanced {cam.aside} of each radius"
    angles.append(Curve(few, balanced, label, SERIES[len(angles)], "dashed"))
    radius = Curve(bases, _in([each.convex_radius.value for each in sized], "mm"))
    least = in_unit(shapes.limits(shape.roller_radius).convex_radius, "mm")
    return [
        Panel("pressure angle", "deg", tuple(angles), _angle_limits(shapes.angle_limits)),
        Panel("convex pitch radius", "mm", (radius,), (LimitLine(least, "limit"),)),
    ]


def _face_panels(case: Case, shapes: FaceShapes, shape: Shape) -> list[Panel]:
    """Panels of least radius of curvature, mm, and undercut factor of flat-face cams over the base
    radius, mm.

    Parameters
    ----------
    case : Case           with the limit of the undercut factor
    shapes : FaceShapes   cams at other base radii
    shape : Shape         the sized cam
    """
    cam, offset = shapes.cam, shape.offset
    low, high = cam.reach(offset)
    bases = _about(max(_RADIUS_FROM * shape.prime_radius, low), shape.prime_radius, _CHART_POINTS)
    bases, least = np.minimum(bases, high), in_unit(shapes.least_radius, "mm")
    radii = [cam.least_radius(float(each), offset).value for each in bases]
    factors = np.array([cam.undercut_factor(float(each), offset) for each in bases])
    edge, limit = LimitLine(least, "limit" if least else "cusp"), case.limits[UNDERCUT_FACTOR]
    x = _in(bases, "mm")
    return [
        Panel("radius of curvature", "mm", (Curve(x, _in(radii, "mm")),), (edge,)),
        Panel("undercut factor", "", (Curve(x, factors),), (LimitLine(limit, "limit"),)),
    ]


def _about(least: float, radius: float, count: int) -> Array:
    return np.linspace(least, max(_RADIUS_TO * radius, 1.5 * least), count)


def _in(values: Iterable[float], unit: str) -> Array:
    return np.array([in_unit(float(each), unit) for each in values])


def _angle_limits(limits: PitchLimits) -> tuple[LimitLine, ...]:
    """Lines of the limits of the pressure angle, deg; one where rise and return have the same."""
    rise, back = in_unit(limits.rise, "deg"), in_unit(limits.back, "deg")
    if rise == back:
        return (LimitLine(rise, "limit"),)
    return LimitLine(rise, "limit, rise"), LimitLine(back, "limit, return")

"""CAD drawing of the cam: contour as chords and as a spline, and the DXF file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze, positive
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import HoleLike, KeywayLike, keyway_corners
from camwright.geometry.errors import GeometryError, InputError, ResultError

if TYPE_CHECKING:
    from ezdxf.layouts import Modelspace
    from scipy.interpolate import BSpline

LAYERS = ("surface", "pitch", "bore", "keyway", "note", "counter_hole")
"""Layers of the DXF file."""

AREA_ERROR = 1e-6
"""Default error of the area within the chords, over the area."""

SPLINE_ERROR = 1e-9
"""m: default distance of the spline from the contour between its knots, below any machine's."""

_FINE = 8
_SPLINE_DEGREE = 3
_SPLINE_PARTS = (22, 45, 90, 180, 360, 720, 1440, 2880, 5760, 11520)
_MILLIMETRE = 1e-3
_METRIC = 4  # code of millimetres in a DXF header


class CurveLike(Protocol):
    """Closed curve by cam angle: contour or pitch curve."""

    def points(self, theta: Array) -> Array: ...
    def velocity(self, theta: Array) -> Array: ...


@dataclass(frozen=True, eq=False)
class Chords:
    """Closed polyline on a contour: angles (n,), rad; points (2, n), m; chord error, m."""

    theta: Array
    points: Array
    error: float

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, points=self.points)


@dataclass(frozen=True, eq=False)
class Outline:
    """Outline of the cam: contour, bore radius (m), keyway and counter-hole."""

    contour: Contour
    bore_radius: float
    keyway: KeywayLike | None = None
    counter_hole: HoleLike | None = None


def chords(contour: Contour, error: float | None = None) -> Chords:
    """Chords of the contour with a uniform distance from it, at most `error`.

    Parameters
    ----------
    contour : Contour
    error : float      m, > 0; by default the area within the chords differs from that of the
                       contour by at most one millionth

    Raises
    ------
    GeometryError
        If the contour is undercut.
    InputError
        If the error is not positive, or requires more than a million points.

    Notes
    -----
    A chord of length L is k L^2 / 8 from a curve of curvature k; the angles are spaced so that
    this is constant. The point of maximum radius is always included.
    """
    contour.require_no_undercut()
    if error is None:
        error = AREA_ERROR * contour.area() / contour.perimeter()
    positive("chord_error", error, "m")
    count = _FINE * contour.lift.search_count
    start = contour.radius_max().theta
    theta = start + np.linspace(0.0, FULL_TURN, count + 1)
    # at least a share of the mean curvature, or the chord over an inflection would be long
    curvature = np.abs(contour.curvature(theta))
    curvature = np.maximum(curvature, 0.05 * FULL_TURN / contour.perimeter())
    density = np.sqrt(curvature / (8 * error)) * contour.speed(theta)
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(theta)
    count_to = np.concatenate([[0.0], np.cumsum(steps)])
    parts = int(np.ceil(1.02 * count_to[-1])) + 3
    if parts > 1_000_000:
        raise InputError("chord_error", error, "large enough for a million chords")
    at = np.interp(np.linspace(0.0, count_to[-1], parts, endpoint=False), count_to, theta)
    return Chords(at, contour.points(at), error)


def clamped_spline(
    curve: CurveLike, error: float = SPLINE_ERROR, start: float = 0.0, stop: float = FULL_TURN
) -> BSpline:
    """Clamped cubic spline of fewest parts within `error` of a closed curve, by cam angle.

    It has the curve's tangents at `start` and `stop`, rad: over a turn, or in pieces, it is
    closed and smooth in CAD programs that read clamped splines alone.

    Raises
    ------
    GeometryError
        If the finest spline is farther than `error` (m) from the curve.
    """
    from scipy.interpolate import make_interp_spline

    positive("spline_error", error, "m")
    first, last = curve.velocity(np.array([start, stop])).T
    for parts in _SPLINE_PARTS:
        theta = np.linspace(start, stop, parts + 1)
        points = curve.points(theta)
        if stop - start == FULL_TURN:
            points[:, -1] = points[:, 0]  # closed to the last bit
        ends = ([(1, first)], [(1, last)])
        spline = make_interp_spline(theta, points.T, _SPLINE_DEGREE, bc_type=ends)
        between = theta[:-1, None] + np.array([0.25, 0.5, 0.75]) * (theta[1] - theta[0])
        deviation = spline(between.ravel()).T - curve.points(between.ravel())
        worst = float(np.hypot(*deviation).max())
        if worst <= error:
            return spline
    raise GeometryError(f"error of the finest spline = {worst:.3g} m, must be <= {error:g} m")


def write_dxf(path: Path, outline: Outline, error: float | None = None) -> float:
    """DXF file in millimetres: contour, pitch curve, bore, keyway and counter-hole.

    The layer ``surface`` has the contour twice, as a closed LWPOLYLINE of chords and as a SPLINE;
    the layer ``note`` states the chord error.

    Returns
    -------
    float    chord error, m

    Raises
    ------
    GeometryError
        If the contour is undercut.
    ResultError
        If the file cannot be written.
    """
    import ezdxf

    polyline = chords(outline.contour, error)
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no date, no random identifier
    document = ezdxf.new("R2010", units=_METRIC)
    for colour, layer in enumerate(LAYERS, start=1):
        document.layers.add(layer, color=colour)
    space = document.modelspace()
    corners = [(x, y) for x, y in (polyline.points / _MILLIMETRE).T.tolist()]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "surface"})
    _add_spline(space, outline.contour, "surface")
    if outline.contour.rolls:  # a face has no pitch curve
        _add_spline(space, outline.contour.pitch, "pitch")
    _add_hole(space, outline)
    if outline.counter_hole is not None:
        x, y = (outline.counter_hole.centre / _MILLIMETRE).tolist()
        radius = outline.counter_hole.radius / _MILLIMETRE
        space.add_circle((x, y), radius, dxfattribs={"layer": "counter_hole"})
    note = f"chord error {polyline.error / _MILLIMETRE:.6g} mm, {len(corners)} chords, units mm"
    low = float(polyline.points[1].min()) / _MILLIMETRE - 6.0
    space.add_text(note, height=2.0, dxfattribs={"layer": "note", "insert": (0.0, low)})
    for kind in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(kind)  # ezdxf itself adds them in the order of a set
    try:
        document.saveas(path)
    except OSError as failure:
        raise ResultError(f"{path}: {failure.strerror or failure}") from None
    return polyline.error


def _add_spline(space: Modelspace, curve: CurveLike, layer: str) -> None:
    spline = clamped_spline(curve)
    entity = space.add_spline(degree=_SPLINE_DEGREE, dxfattribs={"layer": layer})
    entity.control_points = [(x, y, 0.0) for x, y in (spline.c / _MILLIMETRE).tolist()]
    entity.knots = spline.t.tolist()
    entity.dxf.flags = entity.dxf.flags | entity.CLOSED


def _add_hole(space: Modelspace, outline: Outline) -> None:
    radius = outline.bore_radius / _MILLIMETRE
    if outline.keyway is None:
        space.add_circle((0.0, 0.0), radius, dxfattribs={"layer": "bore"})
        return
    corners = keyway_corners(outline.bore_radius, outline.keyway) / _MILLIMETRE
    turned = np.degrees(np.arctan2(corners[1], corners[0]))
    space.add_arc((0.0, 0.0), radius, turned[3], turned[0], dxfattribs={"layer": "bore"})
    points = [(x, y) for x, y in corners.T.tolist()]
    space.add_lwpolyline(points, dxfattribs={"layer": "keyway"})

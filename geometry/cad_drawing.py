"""CAD drawing of the cam: clamped spline of a curve, and the DXF file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from camwright.geometry.arc_polyline import ARC_ERROR, ArcPolyline, arc_polyline
from camwright.geometry.arrays import FULL_TURN, Array, positive
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import HoleLike, KeywayLike, keyway_corners
from camwright.geometry.errors import GeometryError, ResultError

if TYPE_CHECKING:
    from ezdxf.layouts import Modelspace
    from scipy.interpolate import BSpline

CUT = "cut"
"""Layer of the curves to cut: contour and bore with keyway, each once and closed."""
LAYERS = {CUT: True, "counter_hole": True, "pitch": False, "mark": False, "note": False}
"""Layers of the DXF file, and whether they plot."""

GROOVE = "groove"
"""Layer of the walls of a groove, which are milled to its depth."""

_SPLINE_DEGREE = 3
_SPLINE_PARTS = (22, 45, 90, 180, 360, 720, 1440, 2880, 5760, 11520)
_MILLIMETRE = 1e-3
_METRIC = 4  # code of millimetres in a DXF header
_LETTER = 2.0  # mm, height of the notes
_LINE = 3.2  # mm, from note to note


class CurveLike(Protocol):
    """Closed curve by cam angle: contour or pitch curve."""

    def points(self, theta: Array) -> Array: ...
    def velocity(self, theta: Array) -> Array: ...


class StepCut(NamedTuple):
    """Step of a groove: inner and outer wall, and depth of its floor below the face, m."""

    inner: Contour
    outer: Contour
    bottom: float


@dataclass(frozen=True, eq=False)
class GrooveCut:
    """Groove in the face of a disc.

    steps : tuple          from the face down; the contour is the inner wall of one of them
    outer_radius : float   of the disc, m
    """

    steps: tuple[StepCut, ...]
    outer_radius: float

    @property
    def walls(self) -> tuple[Contour, ...]:
        """Inner and outer wall of each step."""
        return tuple(wall for step in self.steps for wall in step[:2])


@dataclass(frozen=True, eq=False)
class Outline:
    """Outline of the cam: contour, bore radius (m), keyway, counter-hole, groove around it."""

    contour: Contour
    bore_radius: float
    keyway: KeywayLike | None = None
    counter_hole: HoleLike | None = None
    groove: GrooveCut | None = None


def clamped_spline(
    curve: CurveLike, error: float, start: float = 0.0, stop: float = FULL_TURN
) -> BSpline:
    """Clamped cubic spline of fewest parts within `error`, m, of a closed curve, over the cam
    angle: values (2,), m.

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
        if np.isclose(stop - start, FULL_TURN, rtol=1e-12, atol=0.0):
            points[:, -1] = points[:, 0]  # closed to the last bit
        ends = ([(1, first)], [(1, last)])
        spline = make_interp_spline(theta, points.T, _SPLINE_DEGREE, bc_type=ends)
        between = theta[:-1, None] + np.array([0.25, 0.5, 0.75]) * (theta[1] - theta[0])
        deviation = spline(between.ravel()).T - curve.points(between.ravel())
        worst = float(np.hypot(*deviation).max())
        if worst <= error:
            return spline
    raise GeometryError(f"error of the finest spline = {worst:.3g} m, must be <= {error:g} m")


def write_dxf(
    path: Path, outline: Outline, error: float = ARC_ERROR, notes: Sequence[str] = ()
) -> ArcPolyline:
    """DXF file in millimetres: the curves to cut, and others on layers that do not plot.

    The layer ``cut`` has the contour once, as a closed polyline of arcs within `error` (m) of it,
    and the bore with its keyway as one closed polyline with arcs; a bore without keyway is a
    circle. ``counter_hole`` has the counter-hole, ``pitch`` the pitch curve, ``mark`` the line of
    cam angle zero and an arrow in the direction of turning, ``note`` the error and the `notes`.
    Of a disc with a groove the layer ``cut`` has its circle, and ``groove`` the walls.

    Returns
    -------
    ArcPolyline    the contour as drawn

    Raises
    ------
    GeometryError
        If the contour is undercut.
    ResultError
        If the file cannot be written.
    """
    import ezdxf

    arcs = arc_polyline(outline.contour, error)
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no date, no random identifier
    document = ezdxf.new("R2010", units=_METRIC)
    for colour, (layer, plots) in enumerate(LAYERS.items(), start=1):
        document.layers.add(layer, color=colour, plot=plots)
    space = document.modelspace()
    curves, groove = [arcs.points], outline.groove
    if groove is None:
        _add_arcs(space, arcs.points, arcs.bulges)
    else:
        document.layers.add(GROOVE, color=len(LAYERS) + 1)
        for wall in groove.walls:
            each = arcs if wall is outline.contour else arc_polyline(wall, error)
            _add_arcs(space, each.points, each.bulges, GROOVE)
        radius = groove.outer_radius / _MILLIMETRE
        space.add_circle((0.0, 0.0), radius, dxfattribs={"layer": CUT})
        curves.append(np.diag([groove.outer_radius, groove.outer_radius]))
    _add_bore(space, outline)
    if outline.counter_hole is not None:
        x, y = (outline.counter_hole.centre / _MILLIMETRE).tolist()
        radius = outline.counter_hole.radius / _MILLIMETRE
        space.add_circle((x, y), radius, dxfattribs={"layer": "counter_hole"})
    if outline.contour.rolls:  # a face has no pitch curve
        curves.append(_add_spline(space, outline.contour.pitch, error, "pitch"))
    around = np.hstack(curves) / _MILLIMETRE
    reach = float(np.hypot(*around).max())
    _add_marks(space, reach)
    low, high = np.minimum(around.min(axis=1), -reach), np.maximum(around.max(axis=1), reach)
    layer = CUT if groove is None else GROOVE
    lines = [
        f"layer {layer}: contour of {arcs.bulges.size} arcs within {error / _MILLIMETRE:.6g} mm; "
        "units mm",
        *(" ".join(note.split()) for note in notes),
    ]
    for k, line in enumerate(lines, start=1):
        at = (float(low[0]), float(low[1]) - k * _LINE - _LETTER)
        space.add_text(line, height=_LETTER, dxfattribs={"layer": "note", "insert": at})
    high[0] = max(high[0], low[0] + 0.9 * _LETTER * max(map(len, lines)))
    low[1] -= len(lines) * _LINE + _LETTER
    space.reset_extents((*low.tolist(), 0.0), (*high.tolist(), 0.0))
    for kind in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(kind)  # ezdxf itself adds them in the order of a set
    try:
        document.saveas(path)
    except OSError as failure:
        raise ResultError(f"{path}: {failure.strerror or failure}") from None
    return arcs


def _add_arcs(space: Modelspace, points: Array, bulges: Array, layer: str = CUT) -> None:
    """Add a closed polyline to a layer: vertices (2, n), m, and bulges (n,), tangent of a quarter
    of the angle of the arc behind each vertex.
    """
    rows = np.vstack([points / _MILLIMETRE, bulges]).T.tolist()
    space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": layer})


def _add_spline(space: Modelspace, curve: CurveLike, error: float, layer: str) -> Array:
    """Add the closed spline of a curve, within `error`, m, to the drawing; returns its control
    points (2, n), m, which enclose it.
    """
    spline = clamped_spline(curve, error)
    entity = space.add_spline(degree=_SPLINE_DEGREE, dxfattribs={"layer": layer})
    entity.control_points = [(x, y, 0.0) for x, y in (spline.c / _MILLIMETRE).tolist()]
    entity.knots = spline.t.tolist()
    entity.dxf.flags = entity.dxf.flags | entity.CLOSED
    control: Array = spline.c.T
    return control


def _add_bore(space: Modelspace, outline: Outline) -> None:
    """Bore with its keyway as a closed polyline of arcs, or a circle, to cut."""
    radius = outline.bore_radius
    if outline.keyway is None:
        space.add_circle((0.0, 0.0), radius / _MILLIMETRE, dxfattribs={"layer": CUT})
        return
    corners = keyway_corners(radius, outline.keyway)
    middle = corners.mean(axis=1)
    far = -radius * middle / np.hypot(*middle)  # two arcs: some machines turn less than half
    turned = np.pi - np.arcsin(0.5 * outline.keyway.width / radius)
    bulge = np.tan(turned / 4.0)
    _add_arcs(space, np.column_stack([corners, far]), np.array([0.0, 0.0, 0.0, bulge, bulge]))


def _add_marks(space: Modelspace, reach: float) -> None:
    """Draw the line of cam angle zero from the axis to the outermost curve, `reach`, mm, and the
    arrow of turning.

    The cam angle grows counter-clockwise on the cam, past a follower at rest: the cam turns
    clockwise.
    """
    on = {"layer": "mark"}
    space.add_line((0.0, 0.0), (reach, 0.0), dxfattribs=on)
    space.add_text("0 deg", height=_LETTER, dxfattribs=on | {"insert": (0.8 * reach, 1.0)})
    radius, tip = 0.75 * reach, np.radians(60.0)
    space.add_arc((0.0, 0.0), radius, 60.0, 120.0, dxfattribs=on)
    end = radius * np.array([np.cos(tip), np.sin(tip)])
    for angle in (-np.pi / 6, np.pi / 6):  # a barb back along the arc, to both sides
        back = tip + np.pi / 2 + angle
        barb = end + 0.06 * reach * np.array([np.cos(back), np.sin(back)])
        space.add_line(tuple(end.tolist()), tuple(barb.tolist()), dxfattribs=on)

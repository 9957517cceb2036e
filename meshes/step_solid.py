"""Solid of the cam in a STEP file: its outline with bore, keyway and counter-hole, extruded."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, positive, uniform_turn
from camwright.geometry.cad_drawing import CurveLike, GrooveCut, Outline, StepCut, clamped_spline
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import keyway_corners
from camwright.geometry.errors import GeometryError, ResultError
from camwright.meshes.cam_outline import wall_at
from camwright.meshes.element_size import MILLIMETRE
from camwright.meshes.step_text import Entities, PartTitle, listed, quoted, real, step_text

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

_STEP_ERROR = 1e-8  # m; a smaller one only enlarges the file
_EDGES_MOST = 24
"""Edges at each rim of the contour's face: OpenCASCADE errs by 1e-3 in the volume with one, up to
3e-5 with 8, 3e-7 with these."""

_UP, _DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
_REMARKS = (
    "one solid from z = 0, millimetres",
    "angle zero: the seam of the face contour, on the axis +x; angles grow counter-clockwise",
)

_SHARP = "the groove is open to the upper face, its floor without fillets: see the drawing"


class Side(Protocol):
    """Side of the cam's outline with its wall in a STEP solid, mm; the material is on its left."""

    @property
    def name(self) -> str: ...

    @property
    def corners(self) -> Array:
        """End points (n, 2) of the edges of the side; a long side has several edges."""

    def curve(self, file: Entities, z: float) -> str:
        """STEP reference of the side's curve at height `z`, mm."""

    def wall(self, file: Entities, low: float, high: float) -> tuple[str, bool]:
        """STEP reference of the wall surface between two heights, mm, and whether its normal points
        out of the solid.
        """


@dataclass(frozen=True, eq=False)
class _Line:
    """Straight side."""

    name: str
    corners: Array

    @property
    def _along(self) -> Array:
        way: Array = self.corners[1] - self.corners[0]
        return way / np.hypot(*way)

    def curve(self, file: Entities, z: float) -> str:
        return _line(file, (*self.corners[0], z), (*self._along, 0.0))

    def wall(self, file: Entities, low: float, high: float) -> tuple[str, bool]:  # noqa: ARG002
        x, y = self._along
        return file.add(
            "PLANE", "''", file.frame((*self.corners[0], 0.0), (y, -x, 0.0), (x, y, 0.0))
        ), True


@dataclass(frozen=True, eq=False)
class _Arc:
    """Side of a hole along a circle, clockwise; a whole circle where it ends at its start."""

    name: str
    corners: Array
    centre: Array
    radius: float

    def curve(self, file: Entities, z: float) -> str:
        return file.add("CIRCLE", "''", self._frame(file, z, _DOWN), real(self.radius))

    def wall(self, file: Entities, low: float, high: float) -> tuple[str, bool]:  # noqa: ARG002
        frame = self._frame(file, 0.0, _UP)
        return file.add("CYLINDRICAL_SURFACE", "''", frame, real(self.radius)), False

    def _frame(self, file: Entities, z: float, axis: Sequence[float]) -> str:
        first = (self.corners[0] - self.centre) / self.radius
        return file.frame((*self.centre, z), axis, (*first, 0.0))


class _Rim(_Arc):
    """Circle of a disc, counter-clockwise, with the material within."""

    def curve(self, file: Entities, z: float) -> str:
        return file.add("CIRCLE", "''", self._frame(file, z, _UP), real(self.radius))

    def wall(self, file: Entities, low: float, high: float) -> tuple[str, bool]:
        return super().wall(file, low, high)[0], True


@dataclass(frozen=True, eq=False)
class _Spline:
    """Closed side along a clamped spline."""

    name: str
    spline: BSpline

    @property
    def corners(self) -> Array:
        """End points of the edges (n, 2), mm, the first again as the last; see `Side`."""
        first, last = self.spline.t[[0, -1]]
        corners: Array = self.spline(np.linspace(first, last, _EDGES_MOST + 1))
        corners[-1] = corners[0]
        return corners

    def curve(self, file: Entities, z: float) -> str:
        """STEP reference of the spline curve at height `z`, mm."""
        controls = listed(file.point((*point, z)) for point in self.spline.c)
        repeats, knots = self._knots
        form = (".UNSPECIFIED.", ".T.", ".F.", repeats, knots, ".UNSPECIFIED.")
        return file.add("B_SPLINE_CURVE_WITH_KNOTS", "''", self.spline.k, controls, *form)

    def wall(self, file: Entities, low: float, high: float) -> tuple[str, bool]:
        # The height comes first: OpenCASCADE integrates volumes along the second parameter edge by
        # edge, and along the first at once, which erred by 1 % along a contour.
        """STEP reference of the spline surface between two heights, mm, and False: its normal
        points into the solid.
        """
        controls = listed(
            listed(file.point((*point, z)) for point in self.spline.c) for z in (low, high)
        )
        repeats, knots = self._knots
        form = (".UNSPECIFIED.", ".F.", ".T.", ".F.")
        ends = ("(2,2)", repeats, listed(map(real, (low, high))), knots, ".UNSPECIFIED.")
        degrees = (1, self.spline.k)
        return file.add(
            "B_SPLINE_SURFACE_WITH_KNOTS", "''", *degrees, controls, *form, *ends
        ), False

    @property
    def _knots(self) -> tuple[str, str]:
        """Multiplicities and knots."""
        knots, repeats = np.unique(self.spline.t, return_counts=True)
        return listed(repeats.tolist()), listed(map(real, knots))


def write_step(path: Path, outline: Outline, width: float, title: PartTitle) -> None:
    """STEP file of the cam: one solid from z = 0 to its width, mm, named as its title.

    The contour is one face. Its seam, on the axis +x, marks angle zero. A groove is open to the
    upper face; its fillets are left out.

    Parameters
    ----------
    path
    outline : Outline
    width : float        m
    title : PartTitle

    Raises
    ------
    GeometryError
        If the contour is undercut, intersects itself, or meets bore or keyway.
    ResultError
        If the file cannot be written.
    """
    positive("cam.width", width, "m")
    outline.contour.require_no_undercut()
    _require_wall(outline)
    file = Entities()
    loops = _loops(outline)
    remarks = _REMARKS if outline.groove is None else (*_REMARKS, _SHARP)
    if outline.groove is None:
        solid = _solid(file, loops, width / MILLIMETRE, title.name)
    else:
        solid = _grooved(file, loops, outline.groove, width / MILLIMETRE, title.name)
    try:
        path.write_text(step_text(title, remarks, file, solid), encoding="ascii", newline="\n")
    except OSError as failure:
        raise ResultError(f"{path}: {failure.strerror or failure}") from None


def _require_wall(outline: Outline) -> None:
    """Refuse a contour that intersects itself, and one that leaves no wall around bore
    and keyway.
    """
    contour = outline.contour
    if contour.self_intersections():
        raise GeometryError("contour = intersects itself, must bound one body")
    for inner in _islands(outline):
        points = inner.points(uniform_turn(contour.lift.search_count))
        wall = float(wall_at(points, outline.bore_radius, outline.keyway).min())
        if not wall > 0:
            shown = f"{wall / MILLIMETRE:.4g} mm"
            raise GeometryError(f"wall around the bore = {shown}, must be > 0 mm")
    if outline.groove is None:
        return
    for outer in outline.groove.walls:
        outer.require_no_undercut()
        if outer.self_intersections():
            raise GeometryError("wall of the groove = intersects itself, must be one curve")
        if not (rim := outline.groove.outer_radius - float(outer.radius_max().value)) > 0:
            shown = f"{rim / MILLIMETRE:.4g} mm"
            raise GeometryError(f"rim around the groove = {shown}, must be > 0 mm")


def _islands(outline: Outline) -> tuple[Contour, ...]:
    """Contour, or the inner walls of the steps of a groove, around the bore."""
    if outline.groove is None:
        return (outline.contour,)
    return tuple(step.inner for step in outline.groove.steps)


# --- outline, mm


def _loops(outline: Outline) -> list[list[Side]]:
    """Sides of the contour, counter-clockwise, then those of each hole, clockwise: bore with
    keyway, counter-hole; mm.
    """
    start = _angle_zero(outline.contour)
    contour = _spline("contour", outline.contour, start)
    loops: list[list[Side]] = [[contour], _bore(outline)]
    if outline.counter_hole is not None:
        hole = outline.counter_hole
        loops.append([_circle("counter-hole", hole.centre / MILLIMETRE, hole.radius / MILLIMETRE)])
    return loops


def _spline(name: str, curve: CurveLike, start: float) -> _Spline:
    """Closed side along a curve from a cam angle, rad."""
    spline = clamped_spline(curve, _STEP_ERROR, start, start + FULL_TURN)
    spline.c = spline.c / MILLIMETRE
    return _Spline(name, spline)


@dataclass(frozen=True, eq=False)
class _Clockwise:
    """Closed curve run through against its angle."""

    curve: CurveLike

    def points(self, theta: Array) -> Array:
        return self.curve.points(-theta)

    def velocity(self, theta: Array) -> Array:
        return -self.curve.velocity(-theta)


def _angle_zero(contour: Contour) -> float:
    """Cam angle, rad, at which the contour crosses the axis +x."""
    from scipy.optimize import brentq

    theta = np.linspace(-0.5 * FULL_TURN, 0.5 * FULL_TURN, contour.lift.search_count + 1)
    x, y = contour.points(theta)
    crossings = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0) & (x[:-1] > 0))
    k = crossings[np.argmin(np.abs(theta[crossings]))]
    return float(
        brentq(lambda at: float(contour.points(at)[1]), theta[k], theta[k + 1], xtol=1e-15)
    )


def _bore(outline: Outline) -> list[Side]:
    """Sides of the bore and its keyway, clockwise, mm."""
    radius, centre = outline.bore_radius / MILLIMETRE, np.zeros(2)
    if outline.keyway is None:
        return [_circle("bore", centre, radius)]
    corners = keyway_corners(outline.bore_radius, outline.keyway).T[::-1] / MILLIMETRE
    sides: list[Side] = [_Line("keyway", np.array(ends)) for ends in pairwise(corners)]
    return [*sides, _Arc("bore", corners[[-1, 0]], centre, radius)]


def _circle(name: str, centre: Array, radius: float) -> Side:
    start = centre + np.array([radius, 0.0])
    return _Arc(name, np.array([start, start]), centre, radius)


# --- solid


def _solid(file: Entities, loops: Sequence[Sequence[Side]], width: float, name: str) -> str:
    """STEP reference of the solid between z = 0 and `width`, mm: walls on all sides of the loops,
    and both end faces.
    """
    parts = [_walls(file, sides, 0.0, width) for sides in loops]
    floor = [_turned(file, each.foot) for each in parts]
    top = [_loop(file, [(edge, True) for edge in each.top]) for each in parts]
    ends = [_end(file, "bottom", floor, 0.0, _DOWN), _end(file, "top", top, width, _UP)]
    return _shell(file, [*(face for each in parts for face in each.faces), *ends], name)


def _grooved(
    file: Entities, loops: Sequence[Sequence[Side]], cut: GrooveCut, width: float, name: str
) -> str:
    """STEP reference of a disc with a groove of one or more steps in its upper face, mm.

    loops: of the contour and of the holes
    """
    radius, high, faces = cut.outer_radius / MILLIMETRE, width, list[str]()
    holes = [_walls(file, sides, 0.0, width) for sides in loops[1:]]
    rim = _walls(
        file, [_Rim("rim", np.array([[radius, 0.0]] * 2), np.zeros(2), radius)], 0.0, width
    )
    above: _StepWalls | None = None
    for step in cut.steps:
        low = width - step.bottom / MILLIMETRE
        walls = _step_walls(file, step, low, high)
        if above is None:
            around, within = (_loop(file, [(edge, True) for edge in each.top])
                              for each in (rim, walls.outer))  # fmt: skip
            island, *bores = (_loop(file, [(edge, True) for edge in each.top])
                              for each in (walls.inner, *holes))  # fmt: skip
            faces += [
                _end(file, "rim face", [around, within], width, _UP),
                _end(file, "top", [island, *bores], width, _UP),
            ]
        else:
            faces += _ledges(file, above, walls, high)
        above, high = walls, low
        faces += walls.faces
    if above is None:
        raise GeometryError("groove = without a step, must have one")
    floor = [_turned(file, each.foot) for each in (above.outer, above.inner)]
    below = [_turned(file, each.foot) for each in (rim, *holes)]
    faces += [
        *(face for each in (rim, *holes) for face in each.faces),
        _end(file, "floor", floor, high, _UP),
        _end(file, "bottom", below, 0.0, _DOWN),
    ]
    return _shell(file, faces, name)


class _StepWalls(NamedTuple):
    """Walls of a step of a groove, and their distances from the path of the roller, m."""

    inner: _Walls
    outer: _Walls
    distances: tuple[float, float]

    @property
    def faces(self) -> list[str]:
        return [*self.inner.faces, *self.outer.faces]


def _step_walls(file: Entities, step: StepCut, low: float, high: float) -> _StepWalls:
    """Walls of a step between two heights, mm."""
    inner = _spline("inner wall", step.inner, _angle_zero(step.inner))
    outer = _spline("outer wall", _Clockwise(step.outer), -_angle_zero(step.outer))
    first, last = (each.require_roller().roller_radius for each in step[:2])
    within, around = (_walls(file, [each], low, high) for each in (inner, outer))
    return _StepWalls(within, around, (first, last))


def _ledges(file: Entities, above: _StepWalls, below: _StepWalls, z: float) -> Iterator[str]:
    """Annular faces between the walls of two steps at a height, mm: upward where the lower step is
    the narrower one on this side, else under the upper wall.
    """
    for name, upper, lower, (wide, narrow) in zip(
        ("inner ledge", "outer ledge"), above[:2], below[:2],
        zip(above.distances, below.distances, strict=True), strict=True,
    ):  # fmt: skip
        if wide == narrow:
            raise GeometryError(f"{name} of the groove = 0 mm, must be a wall or a ledge")
        loops = _turned(file, upper.foot), _loop(file, [(edge, True) for edge in lower.top])
        up = wide > narrow
        outermost = 0 if up == (name == "outer ledge") else 1
        ordered = loops[outermost], loops[1 - outermost]
        yield _end(file, name, ordered, z, _UP if up else _DOWN)


class _Walls(NamedTuple):
    """STEP references of the wall faces of a loop of sides, and of the edges at foot and top."""

    faces: list[str]
    foot: list[str]
    top: list[str]


def _walls(file: Entities, sides: Sequence[Side], low: float, high: float) -> _Walls:
    """Wall faces of a loop of sides between two heights, mm, with the edges at both ends."""
    faces: list[str] = []
    below: list[str] = []
    above: list[str] = []
    for side in sides:
        foot, top = _edges(file, side, low), _edges(file, side, high)
        rise, fall = (_upright(file, side.corners[end], low, high) for end in (-1, 0))
        around = [(edge, True) for edge in (*foot, rise)]
        around += [(edge, False) for edge in (*reversed(top), fall)]
        surface, outward = side.wall(file, low, high)
        faces.append(_face(file, side.name, [_loop(file, around)], surface, outward))
        below += foot
        above += top
    return _Walls(faces, below, above)


def _turned(file: Entities, edges: Sequence[str]) -> str:
    """Reference of a loop of edges against their directions."""
    return _loop(file, [(edge, False) for edge in reversed(edges)])


def _shell(file: Entities, faces: Sequence[str], name: str) -> str:
    shell = file.add("CLOSED_SHELL", "''", listed(faces))
    return file.add("MANIFOLD_SOLID_BREP", quoted(name), shell)


def _end(file: Entities, name: str, loops: Sequence[str], z: float, normal: Sequence[float]) -> str:
    plane = file.add("PLANE", "''", file.frame((0.0, 0.0, z), normal, (1.0, 0.0, 0.0)))
    return _face(file, name, loops, plane, True)


def _face(file: Entities, name: str, loops: Sequence[str], surface: str, outward: bool) -> str:
    """STEP reference of a face bounded by loops, the outer one first; outward: whether the normal
    of its surface points out of the solid.
    """
    outer, *inner = loops
    bounds = [file.add("FACE_OUTER_BOUND", "''", outer, ".T.")]
    bounds += [file.add("FACE_BOUND", "''", loop, ".T.") for loop in inner]
    sense = ".T." if outward else ".F."
    return file.add("ADVANCED_FACE", quoted(name), listed(bounds), surface, sense)


def _loop(file: Entities, edges: Sequence[tuple[str, bool]]) -> str:
    """Reference of a loop of edges, each along its curve or against it."""
    turned = [
        file.add("ORIENTED_EDGE", "''", "*", "*", edge, ".T." if along else ".F.")
        for edge, along in edges
    ]
    return file.add("EDGE_LOOP", "''", listed(turned))


def _edges(file: Entities, side: Side, z: float) -> list[str]:
    curve = side.curve(file, z)
    vertices = [_vertex(file, corner, z) for corner in side.corners]
    return [file.add("EDGE_CURVE", "''", *ends, curve, ".T.") for ends in pairwise(vertices)]


def _upright(file: Entities, at: Array, low: float, high: float) -> str:
    """Reference of the edge of two walls; of the seam of one wall all round."""
    ends = (_vertex(file, at, low), _vertex(file, at, high))
    return file.add("EDGE_CURVE", "''", *ends, _line(file, (*at, low), _UP), ".T.")


def _vertex(file: Entities, at: Array, z: float) -> str:
    return file.add("VERTEX_POINT", "''", file.point((*at, z)))


def _line(file: Entities, at: Sequence[float], along: Sequence[float]) -> str:
    vector = file.add("VECTOR", "''", file.direction(along), "1.")
    return file.add("LINE", "''", file.point(at), vector)

"""Closed polyline of arcs on a contour within a tolerance, as machines cut it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze, positive
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError

ARC_ERROR = 1e-6
"""m: default distance of the arcs from the contour."""

AREA_ERROR = 1e-6
"""Greatest error of the enclosed area, over the area."""

_FIRST_PARTS = 16
_PART_HALVINGS = 16  # of a part, up to parts of a few micrometres
_SAMPLES = np.arange(1, 16) / 16  # of a part, at which its distance from the contour is measured


@dataclass(frozen=True, eq=False)
class ArcPolyline:
    """Closed polyline of arcs with a common tangent at each vertex, counter-clockwise.

    points : array (2, n)    vertices, m
    bulges : array (n,)      tangent of a quarter of the angle of the arc behind each vertex
    error : float            greatest distance from the contour, m
    """

    points: Array
    bulges: Array
    error: float

    def __post_init__(self) -> None:
        freeze(self, points=self.points, bulges=self.bulges)

    @property
    def area(self) -> float:
        """Enclosed area, m^2: of the polygon, and of the segments between chords and arcs."""
        (x, y), (to_x, to_y) = self.points, np.roll(self.points, -1, axis=1)
        half = 2.0 * np.arctan(self.bulges)  # half of the angle of each arc
        chord = np.hypot(to_x - x, to_y - y)
        bent = np.abs(half) > 1e-9
        sine = np.sin(np.where(bent, half, 1.0))
        segments = np.where(bent, (half - sine * np.cos(half)) / sine**2, 0.0) * chord**2 / 4.0
        return float(0.5 * np.sum(x * to_y - to_x * y) + np.sum(segments))


def arc_polyline(contour: Contour, error: float = ARC_ERROR) -> ArcPolyline:
    """Closed polyline of tangent arcs, each as long as it stays within `error`, m, of the
    contour.

    Each pair has points and tangents of the contour at both of its ends; a part of the turn is
    halved until its pair is close enough. The enclosed area is that of the contour to one
    millionth, by closer arcs where necessary.

    Raises
    ------
    GeometryError
        If the contour is undercut, or parts of 2 pi/2^20 are farther than `error` (m) from it.
    InputError
        If the error is not positive.

    References
    ----------
    Bolton, Biarc curves, Computer-Aided Design 7 (1975) 89.
    """
    positive("arc_error", error, "m")
    contour.require_no_undercut()
    area = contour.area()
    while True:
        arcs = _fitted(contour, error)
        if abs(arcs.area - area) <= AREA_ERROR * area:
            return arcs
        error *= 0.5


def _fitted(contour: Contour, error: float) -> ArcPolyline:
    """Polyline of tangent arcs within a distance `error`, m, of the contour; parts of the turn are
    halved until their pair of arcs is close enough.

    Raises
    ------
    GeometryError
        If the shortest parts are farther than this from the contour.
    """
    edges = np.linspace(0.0, FULL_TURN, _FIRST_PARTS + 1)
    start, stop = edges[:-1], edges[1:]
    kept: list[Array] = []
    worst = 0.0
    for _ in range(_PART_HALVINGS + 1):
        apart = _distance(contour, start, stop)
        close = apart <= error
        kept.append(start[close])
        worst = max(worst, float(np.max(apart, where=close, initial=0.0)))
        start, stop = start[~close], stop[~close]
        if start.size == 0:
            break
        middle = 0.5 * (start + stop)
        start, stop = np.concatenate([start, middle]), np.concatenate([middle, stop])
    else:
        raise GeometryError(f"error of the shortest arcs = {np.max(apart):.3g} m, must be <= "
                            f"{error:g} m")  # fmt: skip
    first = np.sort(np.concatenate(kept))
    corners, tangents, middles, _ = _pairs(contour, first, np.append(first[1:], FULL_TURN))
    points = np.stack([corners, middles], axis=2).reshape(2, -1)
    heading = np.arctan2(tangents[1], tangents[0])
    chord = middles - corners
    into = _turned(np.arctan2(chord[1], chord[0]) - heading)
    behind = np.roll(corners, -1, axis=1) - middles
    out_of = _turned(np.roll(heading, -1) - np.arctan2(behind[1], behind[0]))
    bulges = np.tan(0.5 * np.stack([into, out_of], axis=1).ravel())
    return ArcPolyline(points, bulges, worst)


def _heading(contour: Contour, theta: Array) -> Array:
    """Unit tangents (2, n) along the cam angle; the tangent of an outer wall points against it."""
    return np.asarray(np.sign(contour.speed(theta)) * contour.tangent(theta))


def _pairs(contour: Contour, start: Array, stop: Array) -> tuple[Array, Array, Array, Array]:
    """Pairs of tangent arcs (biarcs) over the parts of the turn from `start` to `stop` (n,), rad:
    start points, m, and unit tangents there, points at which the two arcs of a pair meet, m, and
    unit tangents there; each (2, n).
    """
    p, q = contour.points(start), contour.points(stop)
    t, u = _heading(contour, start), _heading(contour, stop)
    v = q - p
    along, square = np.sum(v * (t + u), axis=0), np.sum(v * v, axis=0)
    opening = 2.0 * (1.0 - np.sum(t * u, axis=0))
    leg = square / (along + np.sqrt(along**2 + opening * square))
    before, after = p + leg * t, q - leg * u
    middle = 0.5 * (before + after)
    joint = after - before
    return p, t, middle, joint / np.hypot(*joint)


def _distance(contour: Contour, start: Array, stop: Array) -> Array:
    """Greatest distance of the contour from the pair of arcs (n,), m, over each part of the turn
    from `start` to `stop` (n,), rad; at samples within the part.
    """
    p, t, middle, joint = _pairs(contour, start, stop)
    u, q = _heading(contour, stop), contour.points(stop)
    theta = start[:, None] + _SAMPLES * (stop - start)[:, None]
    points = contour.points(theta.ravel()).reshape(2, *theta.shape)
    on_first = np.sum((points - middle[..., None]) * joint[..., None], axis=0) < 0.0
    from_first = _from_arc(points, p, t, middle)
    from_second = _from_arc(points, q, -u, middle)
    apart: Array = np.max(np.where(on_first, from_first, from_second), axis=1)
    return apart


def _from_arc(points: Array, at: Array, tangent: Array, through: Array) -> Array:
    """Distance, m, of points (2, n, k) from n circles, each through two points `at` and `through`
    (2, n), with a unit tangent (2, n) in the first.

    With d from the point, normal n and curvature c it is |d.n - c d.d / 2| up to a factor of
    1 + O(distance c), which is 1 to the digits of a tolerance.
    """
    normal = np.stack([-tangent[1], tangent[0]])
    chord = through - at
    curvature = 2.0 * np.sum(chord * normal, axis=0) / np.sum(chord * chord, axis=0)
    d = points - at[..., None]
    height = np.sum(d * normal[..., None], axis=0)
    apart: Array = np.abs(height - 0.5 * curvature[:, None] * np.sum(d * d, axis=0))
    return apart


def _turned(angle: Array) -> Array:
    """An angle within half a turn, rad."""
    return (angle + np.pi) % FULL_TURN - np.pi

"""Outline of the cam: contour, bore and keyway, and the wall between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, positive, rotation
from camwright.geometry.cutouts import HoleLike, KeywayLike
from camwright.geometry.errors import GeometryError, InputError, in_millimetres
from camwright.geometry.extrema import least_argument
from camwright.geometry.monotone_cubic import MonotoneCubic
from camwright.meshes.element_size import EDGES_PER_TURN, ElementSize, SizeField
from camwright.meshes.outline import OutlinePiece, Zone, arc, line

_CONTOUR_SAMPLES = 7200  # of the contour, 0.05 deg apart
_WALL_MIN = 0.01  # over the bore radius
_EDGES_PER_FILLET = 4.0
_EDGES_ACROSS_HOLE_WALL = 4
_WALL_DECIMALS = 9  # of a wall, m: walls nearer to each other are equal


class ContourLike(Protocol):
    """Interface of a contour for the mesher; see ``geometry.contour.Contour``."""

    def points(self, theta: Array) -> Array: ...
    def normal(self, theta: Array) -> Array: ...
    def curvature(self, theta: Array) -> Array: ...


@dataclass(frozen=True, eq=False)
class Backwards:
    """Contour run through against the cam angle, as one with its material outside is meshed."""

    contour: ContourLike

    def points(self, theta: Array) -> Array:
        return self.contour.points(-theta)

    def normal(self, theta: Array) -> Array:
        return self.contour.normal(-theta)

    def curvature(self, theta: Array) -> Array:
        return self.contour.curvature(-theta)


@dataclass(frozen=True, eq=False)
class SampledContour:
    """Contour sampled over one turn: cam angle, rad; points and arc length, m."""

    contour: ContourLike
    theta: Array
    points: Array
    arc_length: Array

    @property
    def length(self) -> float:
        """Length of the contour, m."""
        return float(self.arc_length[-1])


def trace(contour: ContourLike) -> SampledContour:
    """Samples of a contour over one turn.

    Raises
    ------
    GeometryError
        If the contour is undercut: its samples run backwards.
    """
    theta = np.linspace(0.0, FULL_TURN, _CONTOUR_SAMPLES + 1)
    points = contour.points(theta)
    chord = np.diff(points, axis=1)
    normal = contour.normal(0.5 * (theta[1:] + theta[:-1]))
    forward = normal[0] * chord[1] - normal[1] * chord[0]
    if not (forward > 0).all():
        worst = theta[int(np.argmin(forward))]
        where = f"cam angle {np.degrees(worst):.2f} deg"
        raise GeometryError(f"contour = undercut at {where}, must be sound")
    return SampledContour(contour, theta, points, np.r_[0.0, np.cumsum(np.hypot(*chord))])


def contour_piece(path: SampledContour, sizing: ElementSize) -> OutlinePiece:
    """Outline of the cam by its arc length, m, with equal element edges about the contact point,
    where the sizes have one.

    Parameters
    ----------
    path : SampledContour   cam contour, m, with its arc length at cam angles
    sizing : ElementSize    with the contact point in the axes of the cam, m

    Raises
    ------
    InputError
        If the contact point is further from the contour than its zone of equal size.
    """
    theta_of = MonotoneCubic(path.arc_length, path.theta)

    def at(s: Array) -> Array:
        return path.contour.points(theta_of(np.mod(s, path.length)))

    zone = None
    if sizing.contact_size is not None and sizing.contact_point is not None:
        theta = _foot(path, sizing.contact_point, sizing.contact_extent + sizing.contact_size)
        inverse = MonotoneCubic(path.theta, path.arc_length)
        centre = float(inverse(theta)) + sizing.phase * sizing.contact_size
        zone = Zone(centre, sizing.contact_size, sizing.steps)
    return OutlinePiece("contour", at, path.length, zone, closed=True)


def _foot(path: SampledContour, point: Array, tolerance: float) -> float:
    """Cam angle, rad in 0..2 pi, of the contour point nearest to `point`, (2,), m.

    Raises
    ------
    InputError
        If the contour point is further than `tolerance`, m, from `point`.
    """
    from scipy.optimize import brentq

    squared = ((path.points - point[:, None]) ** 2).sum(axis=0)
    near = path.theta[int(np.argmin(squared))]
    step = 2.0 * FULL_TURN / _CONTOUR_SAMPLES

    def along(theta: float) -> float:
        """Distance of the contour point from `point` along the tangent, m; 0 at the foot."""
        here = np.array([theta])
        normal = path.contour.normal(here)[:, 0]
        offset = path.contour.points(here)[:, 0] - point
        return float(normal[0] * offset[1] - normal[1] * offset[0])

    theta = float(brentq(along, near - step, near + step, xtol=1e-15))
    distance = float(np.hypot(*(path.contour.points(np.array([theta]))[:, 0] - point)))
    if not distance <= tolerance:
        raise InputError(
            "sizing.contact_point", f"{distance:.3g} m off the contour", f"<= {tolerance:.3g} m"
        )
    return theta % FULL_TURN


def cam_size(
    path: SampledContour, bore_radius: float, keyway: KeywayLike | None, sizing: ElementSize
) -> SizeField:
    """Element size in the cam: the sizing, limited by bore, keyway, fillets, wall and curvature.

    Parameters
    ----------
    path : SampledContour         contour of the cam
    bore_radius : float           m
    keyway : KeywayLike or None   None: no keyway
    sizing : ElementSize          size at the contact and far from it

    Raises
    ------
    GeometryError
        If the wall between contour and bore or keyway is not above 0.01 of the bore radius.
    """
    wall, place = least_wall(path, bore_radius, keyway)
    if not wall > _WALL_MIN * bore_radius:
        raise GeometryError(
            f"minimum wall between bore or keyway and contour = {wall * 1e3:.4g} mm "
            f"(cam.bore_radius = {bore_radius * 1e3:.4g} mm), "
            f"must be > {_WALL_MIN * bore_radius * 1e3:.4g} mm"
        )
    size = sizing.field()
    size = size.with_spot((0.0, 0.0), FULL_TURN * bore_radius / EDGES_PER_TURN, bore_radius)
    if keyway is not None:
        centre = rotation(keyway.angle) @ np.array([bore_radius + 0.5 * keyway.depth, 0.0])
        extent = 0.5 * float(np.hypot(keyway.width, keyway.depth))
        size = size.with_spot(centre, min(keyway.width, keyway.depth) / 3.0, extent)
        size = finer_at_fillets(size, bore_radius, keyway, _EDGES_PER_FILLET, 1.0)
    if wall / 2 < float(size(place[:, None])[0]):
        size = size.with_spot(place, wall / 2, wall)
    floor = sizing.contact_size or sizing.far_size / 200.0
    kappa = np.maximum(np.abs(path.contour.curvature(path.theta)), 1e-12)
    limits = np.maximum(FULL_TURN / EDGES_PER_TURN / kappa, floor)
    # An element longer than its wall is a sliver, wherever along the contour the wall is thin.
    across = wall_at(path.points, bore_radius, keyway) / sizing.wall_edges
    limits = np.minimum(limits, across)
    return size.below(path.points, limits)


def rim_size(path: SampledContour, outer_radius: float, sizing: ElementSize) -> SizeField:
    """Element size in the rim around a groove: the sizing, limited by circle, rim and curvature.

    Parameters
    ----------
    path : SampledContour   outer wall of the groove
    outer_radius : float    of the disc, m
    sizing : ElementSize    size at the contact and far from it

    Raises
    ------
    GeometryError
        If the rim between wall and outer circle is not thicker than 0.01 of the outer radius.
    """
    thick = outer_radius - np.hypot(*path.points)
    if not (least := float(thick.min())) > _WALL_MIN * outer_radius:
        raise GeometryError(
            f"minimum rim between outer wall and outer circle = {least * 1e3:.4g} mm "
            f"(cam.groove.outer_radius = {outer_radius * 1e3:.4g} mm), "
            f"must be > {_WALL_MIN * outer_radius * 1e3:.4g} mm"
        )
    size = sizing.field().capped(FULL_TURN * outer_radius / EDGES_PER_TURN)
    floor = sizing.contact_size or sizing.far_size / 200.0
    kappa = np.maximum(np.abs(path.contour.curvature(path.theta)), 1e-12)
    limits = np.maximum(FULL_TURN / EDGES_PER_TURN / kappa, floor)
    return size.below(path.points, np.minimum(limits, thick / sizing.wall_edges))


def hole_size(size: SizeField, path: SampledContour, hole: HoleLike) -> SizeField:
    """Element size limited by a hole and by the wall between it and the contour.

    Raises
    ------
    GeometryError
        If the hole reaches the contour.
    """
    wall = float(np.hypot(*(path.points - hole.centre[:, None])).min()) - hole.radius
    if not wall > 0.0:
        raise GeometryError(f"wall of the counter-hole = {wall * 1e3:.3f} mm, must be > 0 mm")
    finest = min(FULL_TURN * hole.radius / EDGES_PER_TURN, wall / _EDGES_ACROSS_HOLE_WALL)
    return size.with_spot(hole.centre, finest, hole.radius + wall)


def finer_at_fillets(
    size: SizeField, bore_radius: float, keyway: KeywayLike, edges: float, reach: float
) -> SizeField:
    """Element size made finer so that each fillet of the keyway has a number of edges, up to a
    reach around it in fillet radii.
    """
    fillet = keyway.fillet
    if fillet > 0:
        outer, half = bore_radius + keyway.depth, 0.5 * keyway.width
        for side in (-1.0, 1.0):
            corner = rotation(keyway.angle) @ np.array([outer - fillet, side * (half - fillet)])
            size = size.with_spot(corner, 0.5 * np.pi * fillet / edges, reach * fillet)
    return size


def least_wall(
    path: SampledContour, bore_radius: float, keyway: KeywayLike | None
) -> tuple[float, Array]:
    """Minimum distance from bore and keyway to the contour, m, and its contour point (2,), m.

    Negative where the bore or the keyway crosses the contour.
    """
    # rounded: on a dwell all are equal but for round-off, and the first is taken
    worst = int(np.argmin(np.round(wall_at(path.points, bore_radius, keyway), _WALL_DECIMALS)))
    step = FULL_TURN / _CONTOUR_SAMPLES

    def wall_of(theta: float) -> float:
        return float(wall_at(path.contour.points(np.array([theta])), bore_radius, keyway)[0])

    wall = wall_of(least_argument(wall_of, path.theta[worst] - step, path.theta[worst] + step))
    if not _winds_around_origin(path.points):
        wall = -bore_radius
    return wall, path.points[:, worst]


def wall_at(points: Array, bore_radius: float, keyway: KeywayLike | None) -> Array:
    """Distances (n,) from bore and keyway to points (2, n), m; negative inside them."""
    wall = np.hypot(*points) - bore_radius
    if keyway is None:
        return np.asarray(wall)
    local = rotation(keyway.angle).T @ points
    beyond = np.array(
        [local[0] - bore_radius - keyway.depth, np.abs(local[1]) - 0.5 * keyway.width]
    )
    beyond[0] = np.where(local[0] > 0, beyond[0], -local[0])
    distance = np.hypot(*np.maximum(beyond, 0.0)) + np.minimum(beyond.max(axis=0), 0.0)
    return np.asarray(np.minimum(wall, distance))


def _winds_around_origin(points: Array) -> bool:
    turning = np.diff(np.unwrap(np.arctan2(points[1], points[0])))
    return bool(np.isclose(turning.sum(), FULL_TURN, atol=1e-6))


def hole_pieces(bore_radius: float, keyway: KeywayLike | None) -> list[OutlinePiece]:
    """Outline pieces of bore and keyway, a clockwise loop.

    Raises
    ------
    InputError
        If a dimension of bore or keyway is out of bounds.
    """
    positive("cam.bore_radius", bore_radius, "m")
    if keyway is None:
        return [arc("bore", bore_radius, FULL_TURN, 0.0)]
    positive("cam.keyway.width", keyway.width, "m")
    positive("cam.keyway.depth", keyway.depth, "m")
    if not keyway.width < 1.8 * bore_radius:
        shown, most = in_millimetres(keyway.width, 1.8 * bore_radius)
        raise InputError("cam.keyway.width", shown, f"< {most}, 1.8 bore radii")
    half, outer = 0.5 * keyway.width, bore_radius + keyway.depth
    mouth = float(np.arcsin(half / bore_radius))
    fillet = keyway.fillet
    # a short straight side between the fillets would give sliver triangles
    fillet_max = 0.8 * min(half, outer - bore_radius * np.cos(mouth))
    if not 0 <= fillet <= fillet_max:
        shown, most = in_millimetres(fillet, fillet_max)
        raise InputError("cam.keyway.fillet", shown, f">= 0 and <= {most}")
    frame, x = rotation(keyway.angle), bore_radius * np.cos(mouth)
    # clockwise along the bore from the lower edge of the mouth to the upper one
    pieces = [arc("bore", bore_radius, keyway.angle + FULL_TURN - mouth, keyway.angle + mouth)]
    # upper side, floor and lower side of the slot
    path = [(x, half), (outer - fillet, half), (outer, half - fillet)]
    path += [(outer, fillet - half), (outer - fillet, -half), (x, -half)]
    corners = [frame @ np.array(corner) for corner in path]
    pieces.append(line("keyway", corners[0], corners[1]))
    if fillet > 0:
        centre = tuple(frame @ np.array([outer - fillet, half - fillet]))
        top = keyway.angle + 0.5 * np.pi
        pieces.append(arc("keyway", fillet, top, keyway.angle, centre))
    pieces.append(line("keyway", corners[2], corners[3]))
    if fillet > 0:
        centre = tuple(frame @ np.array([outer - fillet, fillet - half]))
        pieces.append(arc("keyway", fillet, keyway.angle, keyway.angle - 0.5 * np.pi, centre))
    pieces.append(line("keyway", corners[4], corners[5]))
    return pieces

"""A measured contour against the nominal one: phase, size, deviation, and the real part."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, rotation, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift

POINTS_MIN = 48
HARMONICS_MAX = 60
"""Waves a turn beyond this are roughness and noise, not form, for a roller of this size."""

_STEPS_MAX = 50
_ROUND_OFF = 1e-13
_TURNS_TRIED = 72
_POLYGON = 5760
_SAMPLES = 1440


@dataclass(frozen=True, eq=False)
class Inspection:
    """A measured contour fitted to the nominal one.

    phase : float                  by which the part is turned against the drawing, rad
    size : float                   mean deviation, m, positive where the part is too large
    theta, deviation : array (n,)  nominal cam angle (rad) of each measured point and its
                                   distance from the nominal contour along the normal, outwards, m,
                                   with the phase taken out and the size left in
    cosine, sine : array (k,)      harmonics of the deviation over the cam angle, m, from wave 0
    scatter : float                what the harmonics leave, root mean square, m
    """

    phase: float
    size: float
    theta: Array
    deviation: Array
    cosine: Array
    sine: Array
    scatter: float

    def __post_init__(self) -> None:
        freeze(
            self,
            theta=self.theta,
            deviation=self.deviation,
            cosine=self.cosine,
            sine=self.sine,
        )

    def form(self, theta: ArrayLike) -> Array:
        """Deviation at any cam angle (rad) by its harmonics, m."""
        waves = np.multiply.outer(np.asarray(theta, dtype=float), np.arange(len(self.cosine)))
        return np.cos(waves) @ self.cosine + np.sin(waves) @ self.sine

    def wave(self, count: int) -> float:
        """Amplitude of the wave of `count` periods a turn, m."""
        return float(np.hypot(self.cosine[count], self.sine[count]))


def inspected(contour: Contour, points: ArrayLike) -> Inspection:
    """Fit a measured contour to the nominal one in phase and size, least squares of distance.

    Parameters
    ----------
    contour : Contour        nominal
    points : array (2, n)    of the surface about the cam axis, m, any order, n >= 48, no gap
                             above 30 degrees; the probe's radius is taken off already

    Raises
    ------
    InputError
        For too few points, a gap, or NaN.
    GeometryError
        If the points are not near the contour at any phase.

    References
    ----------
    ISO 12181-1: harmonics of a closed form. Forbes, Least-Squares Best-Fit Geometric Elements
    (NPL Report DITC 140/89): Gauss-Newton on orthogonal distances.
    """
    measured = _checked(points)
    phase, size = _rough_phase(contour, measured), 0.0
    for _ in range(_STEPS_MAX):
        turned = rotation(-phase) @ measured
        theta, distance = _feet(contour, turned)
        normal = contour.normal(theta)
        # turning the part on by d(phase) takes its points back against the drawing
        lever = -(normal[1] * turned[0] - normal[0] * turned[1])
        system = np.column_stack([lever, np.full(lever.size, -1.0)])
        step = np.linalg.lstsq(system, -(distance - size), rcond=None)[0]
        phase, size = phase + step[0], size + step[1]
        if np.hypot(step[0] * contour.pitch.radius_base, step[1]) < _ROUND_OFF:
            break
    else:
        raise GeometryError("measured contour: the phase cannot be told, is the part a circle?")
    theta, distance = _feet(contour, rotation(-phase) @ measured)
    cosine, sine = _harmonics(theta, distance)
    left = distance - Inspection(0, 0, theta, distance, cosine, sine, 0).form(theta)
    phase = float(np.mod(phase + np.pi, FULL_TURN) - np.pi)
    scatter = float(np.sqrt(np.mean(left**2)))
    return Inspection(phase, float(size), np.mod(theta, FULL_TURN), distance, cosine, sine, scatter)


def real_contour(contour: Contour, found: Inspection, *, keep_phase: bool = False) -> Contour:
    """The contour whose surface is the measured one, by letting the follower down on it.

    Parameters
    ----------
    contour : Contour       nominal
    found : Inspection
    keep_phase : bool       the measurement's angles are those of the keyway: the part runs turned
    """
    theta = uniform_turn(_POLYGON)
    surface = contour.points(theta) + found.form(theta) * contour.normal(theta)
    if keep_phase:
        surface = rotation(found.phase) @ surface
    angles = uniform_turn(_SAMPLES)
    height = contour.standing(surface, angles)
    rough = Lift(angles, height - height.min())
    base = float(height.min()) + min(rough.lowest.value, 0.0)
    return replace(contour, pitch=contour.pitch.with_lift(Lift(angles, height - base), base))


def _checked(points: ArrayLike) -> Array:
    measured = finite("measured", points)
    if measured.ndim != 2 or measured.shape[0] != 2 or measured.shape[1] < POINTS_MIN:
        raise InputError("measured", f"shape {measured.shape}", f"(2, n) with n >= {POINTS_MIN}")
    angles = np.sort(np.arctan2(measured[1], measured[0]))
    gap = np.diff(np.append(angles, angles[0] + FULL_TURN)).max()
    if gap > np.radians(30.0):
        raise InputError("measured", f"a gap of {np.degrees(gap):.4g} deg", "at most 30 deg")
    return measured


def _rough_phase(contour: Contour, measured: Array) -> float:
    """Phase at which the radii agree best, out of equal steps of the turn."""
    theta = uniform_turn(contour.lift.search_count)
    polar, radius = _polar(contour.points(theta))
    order = np.argsort(polar)
    angle, found = _polar(measured)
    tried = np.arange(_TURNS_TRIED) * (FULL_TURN / _TURNS_TRIED)
    nominal = np.interp(
        np.mod(angle[None, :] - tried[:, None], FULL_TURN),
        polar[order],
        radius[order],
        period=FULL_TURN,
    )
    apart = found[None, :] - nominal
    return float(tried[np.argmin(np.var(apart, axis=1))])


def _feet(contour: Contour, points: Array) -> tuple[Array, Array]:
    """Cam angle of the contour point below each point, and the distance along its normal."""
    grid = uniform_turn(contour.lift.search_count)
    polar, _ = _polar(contour.points(grid))
    order = np.argsort(polar)
    away = np.mod(grid - polar + np.pi, FULL_TURN) - np.pi
    angle, _ = _polar(points)
    theta = angle + np.interp(angle, polar[order], away[order], period=FULL_TURN)
    for _ in range(_STEPS_MAX):
        frame = contour.local_frame(theta)
        apart = points - frame.point
        height = np.sum(apart * frame.normal, axis=0)
        along = np.sum(apart * frame.tangent, axis=0)
        # a point at a height above a curved surface passes more, or less, of it
        way = contour.speed(theta) * np.maximum(1.0 + height * contour.curvature(theta), 0.1)
        step = np.clip(along / way, -0.1, 0.1)
        theta = theta + step
        if np.abs(step).max() < _ROUND_OFF:
            break
    else:
        raise GeometryError("measured contour: points too far from the nominal one to compare")
    apart = points - contour.points(theta)
    return theta, np.sum(apart * contour.normal(theta), axis=0)


def _harmonics(theta: Array, deviation: Array) -> tuple[Array, Array]:
    """Cosine and sine harmonics by least squares, as many as the points bear."""
    count = min(HARMONICS_MAX, theta.size // 4)
    waves = np.multiply.outer(theta, np.arange(count + 1))
    basis = np.hstack([np.cos(waves), np.sin(waves[:, 1:])])
    weights = np.linalg.lstsq(basis, deviation, rcond=None)[0]
    return weights[: count + 1], np.concatenate([[0.0], weights[count + 1 :]])


def _polar(points: Array) -> tuple[Array, Array]:
    return np.mod(np.arctan2(points[1], points[0]), FULL_TURN), np.hypot(*points)

"""Measured contour: its phase, size and deviation from the nominal one, and its lift."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, rotation, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.lift_fit import measured_lift

POINTS_MIN = 48
HARMONICS_MAX = 60
"""Maximum waves per turn of a form deviation; above are roughness and noise."""

_FIT_STEPS_MAX = 50  # of an iteration of phase, size or contact angle
_LAST_STEP = 1e-13  # m or rad, of a converged fit
_TURNS_TRIED = 72
_ALIKE, _EXACT = 1.5, 1e-7  # variance over the least one; m: of phases of a contour that recurs
_POLYGON = 5760
_LIFT_SAMPLES = 1440  # of the lift of a real contour


@dataclass(frozen=True, eq=False)
class Inspection:
    """Measured contour against the nominal one: phase, size, harmonics of the form deviation.

    phase : float                  rotation of the part against the drawing, rad
    size : float                   mean deviation, m, positive where the part is too large
    theta, deviation : array (n,)  nominal cam angle, rad, of each measured point and its distance
                                   from the nominal contour along the outward normal, m, phase
                                   removed, size included
    cosine, sine : array (k,)      harmonics of the deviation over the cam angle, m, from wave 0
    scatter : float                root mean square of the deviation less its harmonics, m
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
        """Form deviation from its harmonics at a cam angle, rad; m, outward positive."""
        waves = np.multiply.outer(np.asarray(theta, dtype=float), np.arange(len(self.cosine)))
        deviation: Array = np.cos(waves) @ self.cosine + np.sin(waves) @ self.sine
        return deviation

    def wave(self, count: int) -> float:
        """Amplitude of the harmonic of `count` periods per turn, m."""
        return float(np.hypot(self.cosine[count], self.sine[count]))


def inspected(contour: Contour, points: ArrayLike) -> Inspection:
    """Phase, size and deviation of a measured contour, by least squares of the normal distance.

    Parameters
    ----------
    contour : Contour        nominal
    points : array (2, n)    surface points about the cam axis, m, in any order, n >= 48, no gap
                             above 30 degrees, probe radius subtracted

    Raises
    ------
    InputError
        For too few points, a gap, or NaN.
    GeometryError
        If the points are near the contour at no phase, or at every one.

    References
    ----------
    ISO 12181-1: harmonics of a closed form. Forbes, Least-Squares Best-Fit Geometric Elements
    (NPL Report DITC 140/89): Gauss-Newton on orthogonal distances.
    """
    measured = _checked(points)
    phase, size = _rough_phase(contour, measured), 0.0
    for _ in range(_FIT_STEPS_MAX):
        turned = rotation(-phase) @ measured
        theta, distance = _feet(contour, turned)
        normal = contour.normal(theta)
        # a larger phase turns the points back against the drawing
        lever = -(normal[1] * turned[0] - normal[0] * turned[1])
        system = np.column_stack([lever, np.full(lever.size, -1.0)])
        step = np.linalg.lstsq(system, -(distance - size), rcond=None)[0]
        phase, size = phase + step[0], size + step[1]
        if np.hypot(step[0] * contour.pitch.radius_base, step[1]) < _LAST_STEP:
            break
    else:
        raise GeometryError("phase of the measured contour = any, must be unique: is it a circle?")
    theta, distance = _feet(contour, rotation(-phase) @ measured)
    cosine, sine = _harmonics(theta, distance)
    residual = distance - Inspection(0, 0, theta, distance, cosine, sine, 0).form(theta)
    phase = float(np.mod(phase + np.pi, FULL_TURN) - np.pi)
    scatter = float(np.sqrt(np.mean(residual**2)))
    return Inspection(phase, float(size), np.mod(theta, FULL_TURN), distance, cosine, sine, scatter)


def surface_of_lift(contour: Contour, theta: ArrayLike, values: ArrayLike) -> Array:
    """Surface points (2, n), m, of a part whose lift was measured with the nominal follower.

    The contour of the fitted lift, and what the fit leaves of each value along the normal. The
    base circle, which a lift does not tell, is that of the drawing.

    Parameters
    ----------
    contour : Contour      nominal
    theta : array (n,)     cam angle, rad, strictly increasing within one turn
    values : array (n,)    measured lift, m; its zero is the base circle

    Raises
    ------
    InputError
        For angles that do not increase, gaps above 30 degrees, an open end, or NaN.
    """
    angle, value = finite("lift.theta", theta), finite("lift.values", values)
    low = float(value.min())
    fit = measured_lift(angle, value - low)
    lift = Lift.from_samples(angle, value - low) if fit is None else fit.lift
    height = contour.pitch.height_base + low
    real = replace(contour, pitch=contour.pitch.with_lift(lift, height))
    left = (value - low - lift(angle)) * np.cos(real.pitch.pressure_angle(angle))
    return np.asarray(real.points(angle) + left * real.normal(angle))


def real_contour(contour: Contour, inspection: Inspection, *, keep_phase: bool = False) -> Contour:
    """Contour of the measured part, from the heights of the follower resting on its surface.

    Parameters
    ----------
    contour : Contour          nominal
    inspection : Inspection
    keep_phase : bool          whether the angles are measured from the keyway, so that the part
                               runs with its phase error
    """
    theta = uniform_turn(_POLYGON)
    surface = contour.points(theta) + inspection.form(theta) * contour.normal(theta)
    if keep_phase:
        surface = rotation(inspection.phase) @ surface
    angles = uniform_turn(_LIFT_SAMPLES)
    height = contour.standing(surface, angles)
    rough = Lift(angles, height - height.min())
    base = float(height.min()) + min(rough.lowest.value, 0.0)
    return replace(contour, pitch=contour.pitch.with_lift(Lift(angles, height - base), base))


def _checked(points: ArrayLike) -> Array:
    """Measured points (2, n), m, as a read-only array; InputError for too few, NaN, or a gap above
    30 degrees.
    """
    measured = finite("measured", points)
    if measured.ndim != 2 or measured.shape[0] != 2 or measured.shape[1] < POINTS_MIN:
        raise InputError("measured", f"shape {measured.shape}", f"(2, n) with n >= {POINTS_MIN}")
    angles = np.sort(np.arctan2(measured[1], measured[0]))
    gap = np.diff(np.append(angles, angles[0] + FULL_TURN)).max()
    if gap > np.radians(30.0):
        raise InputError("measured", f"a gap of {np.degrees(gap):.4g} deg", "at most 30 deg")
    return measured


def _rough_phase(contour: Contour, measured: Array) -> float:
    """Rotation, rad, of measured points (2, n), m, against the nominal contour, among 72 equal
    steps of the turn: that of least variance of the radii less the nominal ones; of a contour that
    recurs within the turn that of the smallest angle.
    """
    theta = uniform_turn(contour.lift.search_count)
    polar, radius = _polar(contour.points(theta))
    order = np.argsort(polar)
    angle, measured_radius = _polar(measured)
    phases = np.arange(_TURNS_TRIED) * (FULL_TURN / _TURNS_TRIED)
    nominal = np.interp(
        np.mod(angle[None, :] - phases[:, None], FULL_TURN),
        polar[order],
        radius[order],
        period=FULL_TURN,
    )
    variance = np.var(measured_radius[None, :] - nominal, axis=1)
    away = np.abs(np.mod(phases + np.pi, FULL_TURN) - np.pi)
    alike = variance <= _ALIKE * variance.min() + _EXACT**2
    return float(phases[np.argmin(np.where(alike, away, np.inf))])


def _feet(contour: Contour, points: Array) -> tuple[Array, Array]:
    """Cam angles (n,), rad, of the feet of the normals from points (2, n), m, on the contour, and
    distances along the outward normal (n,), m. By Newton's method; GeometryError where it does not
    converge.
    """
    grid = uniform_turn(contour.lift.search_count)
    polar, _ = _polar(contour.points(grid))
    order = np.argsort(polar)
    away = np.mod(grid - polar + np.pi, FULL_TURN) - np.pi
    angle, _ = _polar(points)
    theta = angle + np.interp(angle, polar[order], away[order], period=FULL_TURN)
    for _ in range(_FIT_STEPS_MAX):
        frame = contour.local_frame(theta)
        apart = points - frame.point
        height = np.sum(apart * frame.normal, axis=0)
        along = np.sum(apart * frame.tangent, axis=0)
        # derivative of `along` by the cam angle at this height over a curved surface
        rate = contour.speed(theta) * np.maximum(1.0 + height * contour.curvature(theta), 0.1)
        step = np.clip(along / rate, -0.1, 0.1)
        theta = theta + step
        if np.abs(step).max() < _LAST_STEP:
            break
    else:
        raise GeometryError("measured points = far from the nominal contour, must be near it")
    apart = points - contour.points(theta)
    return theta, np.sum(apart * contour.normal(theta), axis=0)


def _harmonics(theta: Array, deviation: Array) -> tuple[Array, Array]:
    """Cosine and sine harmonics (k,) and (k,), m, of wave 0 to k - 1 of a deviation (n,), m, over
    cam angles (n,), rad; by least squares, at most one wave per four points.
    """
    count = min(HARMONICS_MAX, theta.size // 4)
    waves = np.multiply.outer(theta, np.arange(count + 1))
    basis = np.hstack([np.cos(waves), np.sin(waves[:, 1:])])
    weights = np.linalg.lstsq(basis, deviation, rcond=None)[0]
    return weights[: count + 1], np.concatenate([[0.0], weights[count + 1 :]])


def _polar(points: Array) -> tuple[Array, Array]:
    return np.mod(np.arctan2(points[1], points[0]), FULL_TURN), np.hypot(*points)

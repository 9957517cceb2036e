"""Motion laws: lift by segments of rise, dwell and return, with derivatives to the jerk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, Values, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift

JERK = 3
"""Order of the highest derivative of a law."""

CLOSURE_TOLERANCE = 1e-9
"""Closure error of the segments over a turn and over the maximum stroke: round-off."""

REPEAT_MAX = 12

_SAMPLED, _ROUNDED = 1440, 2880

_QUARTER = 4.0 * np.pi
"""Frequency of a sine whose quarter wave spans an eighth of the segment."""

_TRAPEZOID = 8.0 * np.pi / (2.0 + np.pi)
_SINE = 4.0 * np.pi**2 / (4.0 + np.pi)


class Piece(Protocol):
    """Normalised lift, or its derivative of an order, as a function of x in 0 to 1, (...)."""

    def __call__(self, x: Values, order: int, /) -> Values: ...


def _polynomial(coefficients: ArrayLike) -> Piece:
    """Law of a polynomial with these coefficients in rising powers of x."""
    rising = np.polynomial.Polynomial(np.asarray(coefficients, dtype=float))
    derivatives: list[list[float]] = [
        (rising.deriv(k) if k else rising).coef.tolist() for k in range(JERK + 1)
    ]

    def piece(x: Values, order: int) -> Values:
        """Polynomial or its derivative of an order at x (...), by Horner's scheme."""
        value = np.zeros_like(x)
        for coefficient in derivatives[order][::-1]:
            value = value * x + coefficient
        return value

    return piece


def _wave(x: Values, frequency: float, order: int) -> Values:
    """Derivative of order 0 to 4 of cos(frequency x) by x."""
    wave: Values = -np.sin(frequency * x) if order % 2 else np.cos(frequency * x)
    sign = -1.0 if order in (2, 3) else 1.0
    return sign * frequency**order * wave


def _harmonic(x: Values, order: int) -> Values:
    # 1 - cos = 2 sin^2 keeps the small lifts at the start
    return np.sin(0.5 * np.pi * x) ** 2 if order == 0 else -0.5 * _wave(x, np.pi, order)


def _cycloidal(x: Values, order: int) -> Values:
    linear = (x, np.ones_like(x))
    sine = _wave(x, FULL_TURN, order + 1) / FULL_TURN**2
    return sine + linear[order] if order < 2 else sine


def _start(x: Values, order: int) -> Values:
    """Quarter sine of unit acceleration amplitude, from rest, over the first eighth."""
    sine = _wave(x, _QUARTER, order + 1) / _QUARTER**3
    linear = (x / _QUARTER, np.full_like(x, 1.0 / _QUARTER))
    return sine + linear[order] if order < 2 else sine


def _from_state(state: tuple[float, float], x: Values, order: int) -> Values:
    """Motion at constant velocity from a state (lift, slope)."""
    if order == 0:
        return state[0] + state[1] * x
    return np.full_like(x, state[1] if order == 1 else 0.0)


def _after(state: tuple[float, float], x: Values, frequency: float, order: int) -> Values:
    """Motion with the acceleration cos(frequency x) from a state (lift, slope)."""
    cosine = -_wave(x, frequency, order) / frequency**2
    constant = 1.0 / frequency**2 if order == 0 else 0.0
    return _from_state(state, x, order) + cosine + constant


def _state(at: float, piece: Piece) -> tuple[float, float]:
    return float(piece(np.array(at), 0)), float(piece(np.array(at), 1))


_EIGHTH = _state(0.125, _start)


def _plateau(x: Values, order: int) -> Values:
    """Motion at unit acceleration from the end of the first eighth."""
    constant = (0.5 * x**2, x, np.ones_like(x), np.zeros_like(x))
    return _from_state(_EIGHTH, x, order) + constant[order]


_THREE_EIGHTHS = _state(0.25, _plateau)


def _modified_trapezoid(x: Values, order: int) -> Values:
    """Modified trapezoid on the first half: the acceleration rises by a quarter sine up to x = 1/8,
    is constant up to 3/8 and falls to zero by a quarter cosine.
    """
    late = _after(_THREE_EIGHTHS, x - 0.375, _QUARTER, order)
    after_start: Values = np.where(x.real < 0.375, _plateau(x - 0.125, order), late)
    whole: Values = np.where(x.real < 0.125, _start(x, order), after_start)
    return _TRAPEZOID * whole


def _modified_sine(x: Values, order: int) -> Values:
    """Modified sine on the first half: the acceleration rises by a quarter sine up to x = 1/8 and
    falls to zero by a quarter cosine up to 1/2.
    """
    late = _after(_EIGHTH, x - 0.125, _QUARTER / 3.0, order)
    whole: Values = np.where(x.real < 0.125, _start(x, order), late)
    return _SINE * whole


def _parabolic(x: Values, order: int) -> Values:
    constant = (2.0 * x**2, 4.0 * x, np.full_like(x, 4.0), np.zeros_like(x))
    return constant[order]


@dataclass(frozen=True)
class Law:
    """Normalised rise: y from 0 to 1 over x from 0 to 1, point-symmetric about its middle.

    name : str               as in the case file
    first_half : callable    (x, order) -> y or its derivative for x up to 1/2
    """

    name: str
    first_half: Piece

    def __call__(self, x: Values, derivative: int = 0) -> Values:
        """Normalised lift y or a derivative of it at x (...), in 0..1; exact at both ends.

        The second half follows from the first by y(x) = 1 - y(1 - x).

        Raises
        ------
        InputError
            If the derivative is none up to the jerk.
        """
        if derivative not in range(JERK + 1):
            raise InputError("derivative", derivative, "0, 1, 2 or 3")
        second = x.real > 0.5
        half = self.first_half(np.where(second, 1.0 - x, x), derivative)
        mirrored = 1.0 - half if derivative == 0 else (-1.0) ** (derivative + 1) * half
        return np.asarray(np.where(second, mirrored, half))


LAWS: Mapping[str, Law] = MappingProxyType(
    {
        law.name: law
        for law in (
            Law("parabolic", _parabolic),
            Law("harmonic", _harmonic),
            Law("cycloidal", _cycloidal),
            Law("modified_trapezoid", _modified_trapezoid),
            Law("modified_sine", _modified_sine),
            Law("polynomial_345", _polynomial([0, 0, 0, 10, -15, 6])),
            Law("polynomial_4567", _polynomial([0] * 4 + [35, -84, 70, -20])),
        )
    }
)
"""Motion laws by name.

References
----------
Norton, Cam Design and Manufacturing Handbook (2009), chs 2-4.
"""

DWELL = "dwell"


@dataclass(frozen=True)
class Segment:
    """Segment of the turn: a law over an angle, rad, with a stroke, m, negative on the return.

    Raises
    ------
    InputError
        For an unknown law, an angle that is not positive, a dwell with a stroke.
    """

    law: str
    angle: float
    stroke: float = 0.0

    def __post_init__(self) -> None:
        """Refuse an unknown law, an angle out of bounds, a dwell with a stroke and any other law
        without.
        """
        if self.law != DWELL and self.law not in LAWS:
            raise InputError("lift.segment.law", self.law, f"one of {', '.join((DWELL, *LAWS))}")
        if not 0.0 < self.angle <= FULL_TURN * (1.0 + CLOSURE_TOLERANCE):
            raise InputError(
                "lift.segment.angle", f"{np.degrees(self.angle):.4g} deg", "> 0 and <= 360 deg"
            )
        if not abs(self.stroke) < np.inf:
            raise InputError("lift.segment.stroke", self.stroke, "finite")
        if (self.law == DWELL) != (self.stroke == 0.0):
            limit = "0 mm in a dwell" if self.law == DWELL else "other than 0: write a dwell"
            raise InputError("lift.segment.stroke", f"{1e3 * self.stroke:.4g} mm", limit)


@dataclass(frozen=True)
class SegmentMotion:
    """Lift by segments from angle 0, zero at its minimum, repeated over the turn.

    Parameters
    ----------
    segments : tuple of Segment    in order; their angles add up to the turn over `repeat`
    repeat : int                   periods per turn: 3 for a cam of three lobes

    Raises
    ------
    InputError
        If the angles do not add up, or the strokes do not close.
    """

    segments: tuple[Segment, ...]
    repeat: int = 1

    def __post_init__(self) -> None:
        """Refuse segments whose angles do not add up to the period, whose strokes do not add up to
        zero, or that are all dwells.
        """
        if not self.segments:
            raise InputError("lift.segment", "none", "at least one segment")
        if not 1 <= self.repeat <= REPEAT_MAX:
            raise InputError("lift.repeat", self.repeat, f">= 1 and <= {REPEAT_MAX}")
        angle = sum(segment.angle for segment in self.segments)
        if not abs(angle - self.period) <= CLOSURE_TOLERANCE * FULL_TURN:
            limit = f"{np.degrees(self.period):.4g} deg in all, the turn over lift.repeat"
            raise InputError("lift.segment.angle", f"{np.degrees(angle):.4g} deg in all", limit)
        strokes = [segment.stroke for segment in self.segments]
        if not any(strokes):
            raise InputError("lift.segment.stroke", "dwells only", "a rise and a return")
        if not abs(sum(strokes)) <= CLOSURE_TOLERANCE * max(map(abs, strokes)):
            limit = "0 mm in all: the lift must close"
            raise InputError("lift.segment.stroke", f"{1e3 * sum(strokes):.4g} mm in all", limit)

    @property
    def period(self) -> float:
        """Period of the motion, rad."""
        return FULL_TURN / self.repeat

    @property
    def closure(self) -> float:
        """|lift at the end of the segments|, m: round-off of the strokes."""
        return abs(sum(segment.stroke for segment in self.segments))

    @property
    def joints(self) -> Array:
        """Angles at which the segments of the first period begin, rad."""
        angles = [segment.angle for segment in self.segments]
        return np.concatenate([[0.0], np.cumsum(angles[:-1])])

    def __call__(self, theta: ArrayLike, derivative: int = 0) -> Array:
        """Lift s or a derivative of it, m/rad^k, k = 0..3, in closed form.

        At a joint with a discontinuous derivative the value is that of the next segment.

        Parameters
        ----------
        theta : array (...)    cam angle, rad; periodic
        """
        angle = np.mod(np.asarray(theta, dtype=float), self.period)
        index = np.clip(np.searchsorted(self.joints, angle, "right") - 1, 0, None)
        ends = np.cumsum([segment.stroke for segment in self.segments])
        levels = np.concatenate([[0.0], ends[:-1]])
        levels = levels - min(levels.min(), 0.0)
        value = np.zeros(angle.shape)
        for k, (segment, start) in enumerate(zip(self.segments, self.joints, strict=True)):
            here = index == k
            x = np.clip((angle[here] - start) / segment.angle, 0.0, 1.0)
            rise = np.zeros(x.shape)
            if segment.law != DWELL:
                law = LAWS[segment.law](x, derivative)
                rise = segment.stroke / segment.angle**derivative * law
            value[here] = rise + (levels[k] if derivative == 0 else 0.0)
        return value

    @property
    def jumps(self) -> bool:
        """Whether the acceleration is discontinuous at a joint, as between harmonic and dwell."""
        ends = [
            (0.0, 0.0)
            if part.law == DWELL
            else tuple(part.stroke / part.angle**2 * LAWS[part.law](np.array([0.0, 1.0]), 2))
            for part in self.segments
        ]
        size = max(abs(value) for pair in ends for value in pair)
        # the halves of every other law meet to round-off
        inside = any(part.law == "parabolic" for part in self.segments)
        before = [pair[1] for pair in ends[-1:] + ends[:-1]]
        steps = [abs(pair[0] - last) for pair, last in zip(ends, before, strict=True)]
        return inside or max(steps) > 1e-9 * size

    def lift(self, count: int | None = None) -> Lift:
        """Lift as a periodic quintic on `count` equal angles; None: 1440 or, with a discontinuous
        acceleration, 2880.

        With a continuous acceleration the spline interpolates the law at 1440 angles; its error
        is of order count^-6. With a discontinuous one an interpolating spline oscillates and has
        concave or undercut parts that the law has not. There the law's values at 2880 angles are
        the control points: every derivative stays within the law's bounds, and the lift error is
        s'' step^2 / 4, 0.1 um for a rise of 20 mm in 60 deg.

        References
        ----------
        de Boor, A Practical Guide to Splines (1978), ch. XI: Schoenberg's approximation.
        """
        count = count or (_ROUNDED if self.jumps else _SAMPLED)
        values = self(uniform_turn(count))
        if self.jumps:
            near, far = (np.roll(values, k) + np.roll(values, -k) for k in (1, 2))
            values = (66.0 * values + 26.0 * near + far) / 120.0
        return Lift(uniform_turn(count), values, self.closure)

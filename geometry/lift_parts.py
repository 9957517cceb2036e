"""Lift in smooth parts, and extremes over all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.extrema import Extremum, refined
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import DWELL, LAWS, Segment, SegmentMotion

LiftFunction = Callable[[Array, Array, Array], Array]
"""Lift s, s' and s'' (...) -> value (...)."""

AngleFunction = Callable[[Array], Array]
"""Cam angle (...), rad -> value (...)."""

_PART_SAMPLES = 33
"""Per half of a segment: extremes of a law are further apart than a step."""
_DWELL_SAMPLES = 2
"""Samples of half a dwell."""
_ZOOMS = 7
_LEAVES_MIDDLE = np.nextafter(0.5, 1.0)


@dataclass(frozen=True, eq=False)
class LiftPart:
    """Part of the lift with continuous derivatives, its ends included.

    Parameters
    ----------
    start, span : float       cam angle at which it begins and which it covers, rad
    derivatives : callable    place x (...), 0 at the start and 1 at the end -> (3, ...): s, s', s''
                              by the cam angle, m/rad^k, one-sided at the ends
    count : int               samples that bracket every extreme of a function of the lift
    """

    start: float
    span: float
    derivatives: Callable[[Array], Array]
    count: int

    @cached_property
    def places(self) -> Array:
        """Sampled places, (count,)."""
        return np.linspace(0.0, 1.0, self.count)

    @cached_property
    def samples(self) -> Array:
        """s, s' and s'' at the places, (3, count)."""
        return self.derivatives(self.places)


@dataclass(frozen=True, eq=False)
class LiftParts:
    """Lift over one period as smooth parts, each with its own one-sided values at a joint.

    Where s'' jumps, as between a harmonic rise and a dwell, both values count.

    Parameters
    ----------
    parts : tuple of LiftPart
    """

    parts: tuple[LiftPart, ...]

    @classmethod
    def of_lift(cls, lift: Lift) -> LiftParts:
        """A lift with a continuous acceleration: one part."""

        def derivatives(x: Array) -> Array:
            return lift.derivatives(FULL_TURN * x, 2)

        return cls((LiftPart(0.0, FULL_TURN, derivatives, lift.search_count + 1),))

    @classmethod
    def of_motion(cls, motion: SegmentMotion) -> LiftParts:
        """Lift of segments by their motion laws in closed form; each segment as two parts, for laws
        whose derivatives jump in the middle.
        """
        ends = np.cumsum([segment.stroke for segment in motion.segments])
        levels = np.concatenate([[0.0], ends[:-1]])
        levels = levels - min(float(levels.min()), 0.0)
        parts = []
        for segment, start, level in zip(motion.segments, motion.joints, levels, strict=True):
            half = 0.5 * segment.angle
            for k in range(2):
                law = partial(_half, segment, float(level), k)
                count = _DWELL_SAMPLES if segment.law == DWELL else _PART_SAMPLES
                parts.append(LiftPart(float(start) + k * half, half, law, count))
        return cls(tuple(parts))

    def finer(self, spacing: float) -> LiftParts:
        """The lift with samples no further apart than a spacing, rad."""
        counts = [max(part.count, int(np.ceil(part.span / spacing)) + 1) for part in self.parts]
        return LiftParts(
            tuple(replace(part, count=n) for part, n in zip(self.parts, counts, strict=True))
        )

    def greatest(self, function: LiftFunction, added: AngleFunction | None = None) -> Extremum:
        """Maximum of a function of s, s' and s'' over the continuous turn, and its cam angle, rad.

        Local maxima among the samples are refined to round-off.

        Parameters
        ----------
        added : callable   of the cam angle, added to the function; None: nothing
        """
        sampled = [_at(part, function, added, part.places, part.samples) for part in self.parts]
        best = max(float(values.max()) for values in sampled)
        top = Extremum(-np.inf, 0.0)
        for part, values in zip(self.parts, sampled, strict=True):
            low = np.minimum(np.append(values[1:], values[-1]), np.append(values[0], values[:-1]))
            before, after = np.append(-np.inf, values[:-1]), np.append(values[1:], -np.inf)
            # twice the fall to a neighbour exceeds what a smooth maximum rises above its sample
            rises = (values > before) & (values >= after) & (3.0 * values - 2.0 * low >= best)
            if not rises.any():
                continue
            evaluate = partial(_minus_at, part, function, added)
            least, at = refined(evaluate, part.places[rises], 1.0 / (part.count - 1), _ZOOMS)
            k = int(np.argmin(least))
            theta = part.start + part.span * float(np.clip(at[k], 0.0, 1.0))
            top = max(top, Extremum(-float(least[k]), theta))
        return top

    def least(self, function: LiftFunction) -> Extremum:
        """Minimum of a function of the lift; see `greatest`."""
        value, theta = self.greatest(lambda s, s1, s2: -function(s, s1, s2))
        return Extremum(-value, theta)

    def sunk(self, ratio: float = 1.0) -> LiftParts:
        """Lift of a second roller, which goes down as the first goes up, times a ratio."""
        top = self.greatest(lambda s, *_: s).value
        parts = (replace(part, derivatives=partial(_sunk, part, top, ratio)) for part in self.parts)
        return LiftParts(tuple(parts))

    @cached_property
    def stroke(self) -> float:
        """Maximum less minimum lift, m."""
        return self.greatest(lambda s, *_: s).value - self.least(lambda s, *_: s).value


def _at(
    part: LiftPart, function: LiftFunction, added: AngleFunction | None, x: Array, lift: Array
) -> Array:
    """Values (...) of `function`, and of `added`, at places x (...), 0 to 1, of a part; lift : (3,
    ...), s, s', s'' there.
    """
    values = function(*lift)
    return values if added is None else values + added(part.start + part.span * x)


def _minus_at(
    part: LiftPart, function: LiftFunction, added: AngleFunction | None, x: Array
) -> Array:
    inside = np.clip(x, 0.0, 1.0)
    return -_at(part, function, added, inside, part.derivatives(inside))


def _sunk(part: LiftPart, top: float, ratio: float, x: Array) -> Array:
    """Derivatives (3, ...) at places x (...) of `ratio` times `top` less the lift of a part, m."""
    rows = -ratio * part.derivatives(x)
    rows[0] += ratio * top
    return rows


def _half(segment: Segment, level: float, half: int, x: Array) -> Array:
    """Lift and derivatives (3, ...), m/rad^k, of the first (0) or second (1) half of a segment at
    places x (...), 0 to 1 over the half; level : lift at the start of the segment, m.
    """
    place = 0.5 * (x + half)
    if half:
        place = np.maximum(place, _LEAVES_MIDDLE)
    if segment.law == DWELL:
        return np.stack([np.full(x.shape, level), *np.zeros((2, *x.shape))])
    law = LAWS[segment.law]
    rows = [segment.stroke / segment.angle**k * law(place, k) for k in range(3)]
    rows[0] = rows[0] + level
    return np.stack(rows)

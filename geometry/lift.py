"""Lift of the follower over one cam turn, and its derivatives."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.acceleration_jump import Jump, acceleration_jump
from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, readonly, uniform_turn
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.figures import Curve, DrawnAxes, Panel, over, plotted
from camwright.geometry.periodic_spline import (
    DEGREE,
    LEAST_SAMPLES,
    PeriodicPolynomial,
    interpolant,
    periodic_quintic,
)

ANGLE_TOLERANCE = 1e-9
"""rad: angles closer than this are equal, the round-off of a table in degrees."""

NEGATIVE_TOLERANCE = 1e-6
"""m: maximum undershoot of a spline below a dwell at zero, less than any grinding accuracy."""

CLOSURE_LIMIT = 1e-6
"""m: maximum difference between the ends of a closed table, its last digit."""

GAP_MAX = np.radians(30.0)

_RESAMPLED = 720
_DRAWN = 721
_SEARCH_FACTOR = 4
"""Search points per sample: a quintic has at most four extremes per part."""


_UNKNOWN = readonly(np.nan)


class Jet(NamedTuple):
    """Lift and its derivatives by the cam angle, m/rad^k, (..., n), real or complex.

    jerk: NaN () where it is not evaluated.
    """

    lift: Array
    slope: Array
    lift_d2: Array
    jerk: Array = _UNKNOWN

    def at(self, take: Callable[[Array], Array]) -> Jet:
        """Lift and derivatives at a selection of the angles."""
        return Jet(*(each if each is _UNKNOWN else take(each) for each in self))


@dataclass(frozen=True, eq=False, repr=False)
class Lift(Displayed):
    """Lift s of the follower against the cam angle: a periodic quintic (C4) spline.

    Parameters
    ----------
    theta : array (n,)     cam angle, rad, equally spaced over [0, 2 pi), n >= 12
    values : array (n,)    s, m, >= 0
    closure : float        |s(2 pi) - s(0)| of the source of the lift, m
    spacing : float        greatest step of the table that the lift interpolates or fits, rad; 0:
                           that of theta

    Raises
    ------
    InputError
        If the angles are not equally spaced over one turn, or a lift is negative or NaN.
    """

    theta: Array
    values: Array
    closure: float = 0.0
    spacing: float = 0.0

    @property
    def facts(self) -> Mapping[str, object]:
        """Number of samples, greatest lift."""
        return {"samples": self.values.size, "lift_max": f"{1e3 * self.highest.value:.4g} mm"}

    def __post_init__(self) -> None:
        """Refuse angles that are not equal steps of one turn, negative lifts and NaN."""
        theta, values = finite("lift.theta", self.theta), finite("lift.values", self.values)
        require_uniform_turn("lift.theta", theta)
        if values.shape != theta.shape:
            raise InputError("lift.values", len(values), f"{len(theta)} values, one per angle")
        if not values.min() >= -NEGATIVE_TOLERANCE:
            raise InputError("lift.values", f"{1e3 * values.min():.4g} mm", ">= 0 mm")
        if not 0 <= self.closure < np.inf:
            raise InputError("lift.closure", self.closure, ">= 0 m and finite")
        freeze(self, theta=theta, values=values)

    @classmethod
    def from_samples(cls, theta: ArrayLike, values: ArrayLike) -> Lift:
        """Lift through a table of any spacing over one turn.

        A table at equal angles from 0 is used directly. Any other is interpolated by a periodic
        quintic on its own angles, sampled at 720 angles or four times the table's, whichever is
        more; the error is of order h^6 for a spacing h.

        Parameters
        ----------
        theta : array (n,)     cam angle, rad, strictly increasing; the end of the turn may
                               repeat the start
        values : array (n,)    s, m, >= 0

        Raises
        ------
        InputError
            For angles that do not increase, gaps above 30 degrees, more than one turn, an open
            end, negative lifts, NaN.
        """
        angle, value = finite("lift.theta", theta), finite("lift.values", values)
        angle, value, closure = one_turn(angle, value)
        if len(angle) < LEAST_SAMPLES:
            raise InputError("lift.theta", f"{len(angle)} angles", f">= {LEAST_SAMPLES} angles")
        gaps = np.append(np.diff(angle), angle[0] + FULL_TURN - angle[-1])
        if gaps.max() > GAP_MAX + ANGLE_TOLERANCE:
            where = f"a gap of {gaps.max():.6g} rad after {angle[np.argmax(gaps)]:.6g} rad"
            raise InputError("lift.theta", where, f"without gaps above {GAP_MAX:.6g} rad")
        if not value.min() >= -NEGATIVE_TOLERANCE:
            at = f"{1e3 * value.min():.4g} mm at {np.degrees(angle[value.argmin()]):.4g} deg"
            raise InputError("lift.values", at, ">= 0 mm; lift.noise fits a measured lift")
        even = uniform_turn(len(angle))
        if np.abs(angle - even).max() <= ANGLE_TOLERANCE:
            return cls(even, value, closure)
        table = interpolant(np.append(angle, angle[0] + FULL_TURN), value)
        even = uniform_turn(max(_RESAMPLED, 4 * len(angle)))
        return cls(even, table(even), closure, float(gaps.max()))

    @cached_property
    def spline(self) -> PeriodicPolynomial:
        """Interpolating spline, m against rad."""
        return periodic_quintic(self.values)

    def __call__(self, theta: ArrayLike, derivative: int = 0) -> Array:
        """Lift s or a derivative of it, m/rad^k, periodic.

        Parameters
        ----------
        theta : array (...)    cam angle, rad
        derivative : int       order k, 0 to 4

        Raises
        ------
        InputError
            If the derivative is not continuous.
        """
        if derivative not in range(DEGREE):
            raise InputError("derivative", derivative, "0, 1, 2, 3 or 4")
        return self.spline(theta, derivative)

    def jet(self, theta: ArrayLike, order: int = 3) -> Jet:
        """Lift and its derivatives up to `order`, 2 or 3, see `derivatives`."""
        return Jet(*self.derivatives(theta, order))

    def derivatives(self, theta: ArrayLike, order: int = 3) -> Array:
        """Lift s and its derivatives up to `order`, m/rad^k, by one look-up.

        Parameters
        ----------
        theta : array (...)    cam angle, rad
        order : int            highest derivative, 0 to 4

        Returns
        -------
        array (order + 1, ...)    row k in m/rad^k
        """
        if order not in range(DEGREE):
            raise InputError("order", order, "0, 1, 2, 3 or 4")
        return self.spline.derivatives(theta, order)

    @property
    def search_count(self) -> int:
        """Equal angles per turn that bracket every extreme of a function of this lift."""
        return _SEARCH_FACTOR * len(self.theta)

    @cached_property
    def acceleration_jump(self) -> Jump:
        """Greatest discontinuity of s'' of the law behind the values."""
        thinned = self.spacing and max(LEAST_SAMPLES, int(FULL_TURN / self.spacing))
        return acceleration_jump(self(uniform_turn(thinned or len(self.theta))))

    @cached_property
    def lowest(self) -> Extremum:
        """Minimum lift, m, and its cam angle, on the continuous turn."""
        return least(self.spline, self.search_count)

    @cached_property
    def highest(self) -> Extremum:
        """Maximum lift, m, and its cam angle, on the continuous turn."""
        return greatest(self.spline, self.search_count)

    @property
    def stroke(self) -> float:
        """Maximum less minimum lift, m."""
        return self.highest.value - self.lowest.value

    def plot(self) -> DrawnAxes:
        """Lift s, s' and s'' over the cam angle, a panel each; see `Table.plot`."""
        theta = np.linspace(0.0, FULL_TURN, _DRAWN)
        names = (("s", "mm"), ("s′", "mm/rad"), ("s″", "mm/rad²"))
        panels = [
            Panel(*name, (Curve(np.degrees(theta), 1e3 * values),))
            for name, values in zip(names, self.derivatives(theta, 2), strict=True)
        ]
        return plotted(over("lift", "Lift", "", "cam angle", "deg", panels))


def require_uniform_turn(field: str, theta: Array) -> None:
    """Check that angles are n >= 12 equal steps over [0, 2 pi), rad.

    Raises
    ------
    InputError
        With the first angle that is not.
    """
    if theta.ndim != 1 or len(theta) < LEAST_SAMPLES:
        raise InputError(field, f"{theta.shape} angles", f"one row of >= {LEAST_SAMPLES} angles")
    away = np.abs(theta - uniform_turn(len(theta))) > ANGLE_TOLERANCE
    if away.any():
        wrong = float(theta[np.argmax(away)])
        raise InputError(field, wrong, "equally spaced over [0, 2 pi) rad, from 0")


def one_turn(theta: Array, values: Array, field: str = "lift.theta") -> tuple[Array, Array, float]:
    """Angles and lifts of a table over one turn without its repeated end, and the absolute
    difference of lift between its ends, m, 0 if the end is not repeated.

    Parameters
    ----------
    theta : array (n,)     cam angle, rad, strictly increasing; `field` is its name in errors
    values : array (n,)    lift, m

    Raises
    ------
    InputError
        For angles that do not increase, more than one turn, or an open end.
    """
    if theta.ndim != 1 or theta.shape != values.shape:
        shapes = f"{theta.shape} angles and {values.shape} values"
        raise InputError("lift", shapes, "a row of angles and as many values")
    rising = np.diff(theta) > ANGLE_TOLERANCE
    if not rising.all():
        raise InputError(field, float(theta[1:][~rising][0]), "strictly increasing")
    span = float(theta[-1] - theta[0]) if len(theta) else 0.0
    closure = 0.0
    if span > FULL_TURN + ANGLE_TOLERANCE:
        raise InputError(field, float(theta[-1]), "within one turn of the first angle")
    if span > FULL_TURN - ANGLE_TOLERANCE:
        closure = float(abs(values[-1] - values[0]))
        theta, values = readonly(theta[:-1]), readonly(values[:-1])
    if not closure <= CLOSURE_LIMIT:
        limit = f"<= {1e6 * CLOSURE_LIMIT:.4g} um: the turn must close"
        raise InputError("lift.closure", f"{1e6 * closure:.4g} um", limit)
    return theta, values, closure

"""First and second derivatives of cam functions by complex steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet
from camwright.pipeline.smoothing.cam_state import Mean, lift_jet
from camwright.pipeline.smoothing.scenario import DesignVariables

Function = Callable[[Jet, float, DesignVariables], Mapping[str, "Array | Mean"]]
FREED = ("rate", "preload", "prime_radius")
_COMPLEX_STEP = 1e-30  # of any variable: no difference is formed
_SECOND_STEP = 1e-5  # of a variable: step of the second derivatives


class Gradient(NamedTuple):
    """Terms (...) of a value with their partial derivatives.

    local (4, ...): by E, E', E'', E''' of each point; shared (1 or 4, ...): by the maximum lift
    and, where they are free, k, P, r0. mean: of the terms (m, n); None: they are the value.
    """

    terms: Array
    local: Array
    shared: Array
    mean: Mean | None = None


class Point(NamedTuple):
    """Arguments of a cam function: E to E''' (n,), J/rad^k; maximum lift, m; variables."""

    energy: tuple[Array, ...]
    highest: float
    variables: DesignVariables


def values_of(function: Function, at: Point) -> Mapping[str, Array | Mean]:
    """Values, by name, of a function of the lift, its maximum and the free variables."""
    return function(lift_jet(at.energy, at.variables), at.highest, at.variables)


def differentiated(function: Function, at: Point, freed: bool) -> dict[str, Gradient]:
    """Values of a cam function with their first derivatives, by name.

    Parameters
    ----------
    function : callable   jet, maximum lift, variables -> values by name
    at : Point            at which it is evaluated
    freed : bool          with the derivatives by k, P, r0

    References
    ----------
    Squire and Trapp, SIAM Review 40 (1998) 110: the complex step has no cancellation.
    """
    slopes = [values_of(function, stepped) for stepped in _steps(at, 1j * _COMPLEX_STEP, freed)]
    orders = len(at.energy)
    gradients = {}
    for name, value in values_of(function, at).items():
        terms = np.asarray(_terms(value), dtype=float)
        sides = [
            np.broadcast_to(np.imag(_terms(slope[name])) / _COMPLEX_STEP, terms.shape)
            for slope in slopes
        ]
        mean = value if isinstance(value, Mean) else None
        gradients[name] = Gradient(terms, np.stack(sides[:orders]), np.stack(sides[orders:]), mean)
    return gradients


def second_derivatives(
    function: Function, at: Point, freed: bool, weights: Mapping[str, Array]
) -> Array:
    """Hessians (q, q, n), at each cam angle, of a weighted sum of the terms of a cam function.

    The q arguments are E, E', E'', E''', the maximum lift and, where they are free, k, P, r0: q is
    5 or 8. Central differences of derivatives by complex step.

    Parameters
    ----------
    function : Function   arguments -> terms (..., n) by name
    at : Point            arguments at which it is differentiated
    freed : bool          whether spring rate k, preload P and prime radius r0 are variables
    weights : mapping     of the terms (...) by name; values without a weight do not count
    """

    def slopes(point: Point, places: Sequence[int]) -> Array:
        """Derivatives (len(places), n) in some of the q directions."""
        sides = []
        for variable in places:
            values = values_of(function, _step(point, variable, 1j * _COMPLEX_STEP))
            parts = (weight * np.imag(_terms(values[name])) for name, weight in weights.items())
            sides.append(
                sum(np.sum(each, axis=tuple(range(each.ndim - 1))) for each in parts)
                / _COMPLEX_STEP
            )
        return np.stack(sides)

    sizes = [float(np.abs(part).max()) or 1.0 for part in at.energy]
    sizes.append(at.highest or 1.0)
    sizes += [getattr(at.variables, name) for name in FREED] if freed else []
    steps, jerk = [_SECOND_STEP * size for size in sizes], len(at.energy) - 1
    by_jerk = slopes(at, [jerk])
    second = np.zeros((len(steps), len(steps), *by_jerk.shape[1:]))
    # Loads do not depend on the third derivative.
    used = [k for k in range(len(steps)) if k != jerk or by_jerk.any()]
    for row, k in enumerate(used):
        rest, step = used[row:], steps[k]
        up, down = (slopes(_step(at, k, side * step), rest) for side in (1.0, -1.0))
        second[k, rest] = second[rest, k] = (up - down) / (2.0 * step)
    return second


def _steps(at: Point, step: complex, freed: bool) -> list[Point]:
    count = len(at.energy) + 1 + (len(FREED) if freed else 0)
    return [_step(at, k, step) for k in range(count)]


def _step(at: Point, place: int, step: complex) -> Point:
    """Arguments of a cam function with a step added to one of them.

    Parameters
    ----------
    at : Point       the arguments
    place : int      which one, in the order E to E''', maximum lift, k, P, r0
    step : complex   in its unit, SI
    """
    orders = len(at.energy)
    if place < orders:
        part = np.asarray(at.energy[place] + step)
        return at._replace(energy=(*at.energy[:place], part, *at.energy[place + 1 :]))
    if place == orders:
        return at._replace(highest=_sum(at.highest, step))
    name = FREED[place - orders - 1]
    value = _sum(getattr(at.variables, name), step)
    return at._replace(variables=at.variables.with_value(name, value))


def _sum(value: float, step: complex) -> float:
    """Value plus the step, typed as the real value."""
    total: float = np.add(value, step)
    return total


def _terms(value: Array | Mean) -> Array:
    return value.terms if isinstance(value, Mean) else value

"""Derivatives of functions of lift and design variables by complex steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.constraints import Jet, Mean, lift_jet
from camwright.pipeline.smoothing.scenario import DesignVariables

Function = Callable[[Jet, float, DesignVariables], Mapping[str, "Array | Mean"]]
FREED = ("rate", "preload", "prime_radius")
Number = TypeVar("Number", float, Array)
_STEP = 1e-30


class Gradient(NamedTuple):
    """Value (n,) and its partial derivatives.

    local (4, n): by E, E', E'', E''' of each point; shared (4, n): by the maximum lift, k, P, r0.
    For a `Mean`, value is (1,), shared (4, 1), and local the contribution of each point.
    """

    value: Array
    local: Array
    shared: Array
    mean: bool = False


def differentiated(
    function: Function,
    energy: tuple[Array, ...],
    highest: float,
    variables: DesignVariables,
    freed: bool,
) -> dict[str, Gradient]:
    """Values of a function of the lift with all derivatives, by name.

    Parameters
    ----------
    function : callable   jet, maximum lift, variables -> values by name
    energy : four arrays (n,)   E, E', E'', E''', J/rad^k
    highest : float       maximum lift, m
    variables : DesignVariables
    freed : bool          with the derivatives by k, P, r0; else they are zero

    References
    ----------
    Squire and Trapp, SIAM Review 40 (1998) 110: the complex step has no cancellation.
    """

    def slopes(parts: tuple[Array, ...], top: float, at: DesignVariables) -> dict[str, Array]:
        values = function(lift_jet(parts, at), top, at)
        return {name: np.imag(_terms(value)) / _STEP for name, value in values.items()}

    directions = [
        slopes((*energy[:k], _stepped(energy[k]), *energy[k + 1 :]), highest, variables)
        for k in range(len(energy))
    ]
    directions.append(slopes(energy, _stepped(highest), variables))
    for name in FREED if freed else ():
        other = replace(variables, **{name: _stepped(getattr(variables, name))})
        directions.append(slopes(energy, highest, other))
    values = function(lift_jet(energy, variables), highest, variables)
    return {
        name: _gradient(value, [direction[name] for direction in directions], len(energy))
        for name, value in values.items()
    }


def _stepped(value: Number) -> Number:
    """Value plus the imaginary step, typed as the real value."""
    stepped: Number = np.add(value, 1j * _STEP)
    return stepped


def _terms(value: Array | Mean) -> Array:
    return value.terms if isinstance(value, Mean) else value


def _gradient(value: Array | Mean, slopes: list[Array], orders: int) -> Gradient:
    none = np.zeros_like(slopes[0])
    local = np.stack(slopes[:orders])
    shared = np.stack([*slopes[orders:], *[none] * (orders + 1 + len(FREED) - len(slopes))])
    if not isinstance(value, Mean):
        return Gradient(np.asarray(value, dtype=float), local, shared)
    mean = float(np.mean(value.terms))
    front = value.power * mean ** (value.power - 1.0) if mean > 0 else 0.0
    return Gradient(
        value.value,
        front / none.size * local,
        front * shared.mean(axis=1, keepdims=True),
        mean=True,
    )

"""Derivatives by complex steps of functions of lift and design variables."""

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
    """A value and its partial derivatives by E, E', E'', E''' of each point and by the rest.

    value (n,), local (4, n), shared (4, n): by the greatest lift, k, P, r0. For a `Mean` value
    is (1,), shared (4, 1), and local has the share of each point.
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
    """Value of a function of the jets with all its derivatives.

    Parameters
    ----------
    function : callable   jet, greatest lift, variables -> values by name
    energy : four arrays (n,)   E, E', E'', E'''
    highest : float       greatest lift of the turn, m
    variables : DesignVariables
    freed : bool          derivatives by k, P, r0 are asked for; else they are zero

    References
    ----------
    Squire and Trapp, SIAM Review 40 (1998) 110: the complex step has no cancellation.
    """

    def sides(parts: tuple[Array, ...], top: float, given: DesignVariables) -> dict[str, Array]:
        found = function(lift_jet(parts, given), top, given)
        return {name: np.imag(_terms(value)) / _STEP for name, value in found.items()}

    directions = [
        sides((*energy[:k], _stepped(energy[k]), *energy[k + 1 :]), highest, variables)
        for k in range(len(energy))
    ]
    directions.append(sides(energy, _stepped(highest), variables))
    for name in FREED if freed else ():
        other = replace(variables, **{name: _stepped(getattr(variables, name))})
        directions.append(sides(energy, highest, other))
    values = function(lift_jet(energy, variables), highest, variables)
    return {
        name: _gradient(value, [direction[name] for direction in directions], len(energy))
        for name, value in values.items()
    }


def _stepped(value: Number) -> Number:
    """A value with the imaginary step, under the type of the real one it stands for."""
    stepped: Number = np.add(value, 1j * _STEP)
    return stepped


def _terms(value: Array | Mean) -> Array:
    return value.terms if isinstance(value, Mean) else value


def _gradient(value: Array | Mean, sides: list[Array], orders: int) -> Gradient:
    none = np.zeros_like(sides[0])
    local = np.stack(sides[:orders])
    shared = np.stack([*sides[orders:], *[none] * (orders + 1 + len(FREED) - len(sides))])
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

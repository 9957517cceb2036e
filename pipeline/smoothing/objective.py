"""Objective of a synthesis: torque residuals and costs, each over an engine reference.

A residual is linear in the crank torque: its square, weighted, adds to that of the torque ripple,
and the root of the sum over the engine is minimised. A cost adds its greatest weighted value. At a
weight of 1 each term counts as much as a torque ripple equal to that of the engine. Costs are
functions of complex numbers, as the constraints are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.errors import InputError
from camwright.pipeline.follower.spring_kinds import rise
from camwright.pipeline.smoothing.cam_state import Mean, ScenarioCam
from camwright.pipeline.smoothing.scenario import DesignVariables, Scenario


class Scale(NamedTuple):
    """Reference values of the costs: energy swing of the engine, J, and greatest force, N.

    The energy swing is the range of the integral of the torque over a cycle; the force is that of
    the greatest torque at the prime radius.
    """

    energy: float
    force: float


def scale_of(scenarios: Sequence[Scenario], gear_ratio: float, prime_radius: float) -> Scale:
    """Reference values from the scenario of greatest weight; prime radius in m."""
    torque = gear_ratio * max(scenarios, key=lambda item: item.weight).torque
    stored = torque_integral(torque - torque.mean())
    return Scale(float(np.ptp(stored)), float(np.abs(torque).max()) / prime_radius)


@dataclass(frozen=True)
class Residual:
    """Objective term linear in the crank torque.

    Parameters
    ----------
    key : str          of its weight, KEY_weight
    words : str        quantity
    reference : str    value at which it is 1
    columns : callable   scenario, columns of crank torque (n, w), N m -> columns (m, w), of the
                         norm of the quantity over its reference
    transposed : callable   scenario, (m,) -> (n,): the transposed linear map
    """

    key: str
    words: str
    reference: str
    columns: Callable[[Scenario, Array], Array] = field(repr=False)
    transposed: Callable[[Scenario, Array], Array] = field(repr=False)


class Turning(NamedTuple):
    """Loaded cam of a scenario with the references of the costs."""

    loads: ScenarioCam
    variables: DesignVariables
    scale: Scale


@dataclass(frozen=True)
class Cost:
    """Smooth objective term that is not linear in the crank torque.

    Parameters
    ----------
    key, words, reference : str   as of `Residual`
    value : callable      cam -> quantity over its reference, (n,), or a `Mean` of the turn
    everywhere : bool     in every scenario; False: where the ripple counts, times its weight
    """

    key: str
    words: str
    reference: str
    value: Callable[[Turning], Array | Mean] = field(repr=False)
    everywhere: bool = False


class Weighted(NamedTuple):
    """Objective term with its weight, > 0."""

    term: Residual | Cost
    weight: float


Objective = tuple[Weighted, ...]


def torque_ripple(item: Scenario, values: Array) -> Array:
    """Crank torque about its mean, (n, w), scaled so that the norm is the ripple ratio."""
    before = item.torque - item.torque.mean()
    return np.asarray((values - values.mean(axis=0)) / (np.sqrt(before.size) * np.std(before)))


def _speed_ripple(item: Scenario, values: Array) -> Array:
    """Columns of the integral of the crank torque; at constant inertia the speed is as it."""
    before = torque_integral(item.torque - item.torque.mean())
    return np.asarray(torque_integral(values) / (np.sqrt(before.size) * np.std(before)))


def harmonics(orders: Iterable[int]) -> Residual:
    """Residual of chosen torque harmonics, rms over the engine's ripple.

    Parameters
    ----------
    orders : iterable of int   periods of each in a cam turn, >= 1; samples do not resolve those of
                               half of their number and above, which are zero
    """
    chosen = tuple(orders)

    def waves(item: Scenario, count: int) -> Array:
        resolved = np.array([[order] for order in chosen if 2 * order < count]).reshape(-1, 1)
        angle = resolved * np.arange(count) * (FULL_TURN / count)
        scale = np.sqrt(2.0) / (count * np.std(item.torque))
        return np.asarray(scale * np.concatenate([np.cos(angle), np.sin(angle)]))

    return Residual(
        "harmonic",
        "chosen harmonics of the torque",
        _ENGINE,
        lambda item, values: waves(item, values.shape[0]) @ values,
        lambda item, level: level @ waves(item, item.torque.size),
    )


def torque_integral(values: Array) -> Array:
    """Integral over an angle that makes one turn, of zero mean, of periodic columns (n, ...) less
    their mean; by Fourier series.
    """
    spectrum = np.fft.rfft(values, axis=0)
    order = np.arange(spectrum.shape[0]).reshape(-1, *[1] * (spectrum.ndim - 1))
    spectrum = np.divide(spectrum, 1j * order, out=np.zeros_like(spectrum), where=order > 0)
    return np.fft.irfft(spectrum, n=values.shape[0], axis=0)


def _loss(at: Turning) -> Mean:
    """Work of the friction of guides, and of roller bearing or face, over a turn."""
    return Mean(FULL_TURN / at.scale.energy * at.loads.friction_work)


def _spring_energy(at: Turning) -> Array:
    """Cost (..., n): energy in the spring at each cam angle, with that of the preload, over the
    energy swing of the engine.

    F_s^2/(2 k), F_s: spring force, k: rate; of a spring that is not linear the work from zero lift
    plus P^2/(2 k), P: preload.
    """
    rate = at.variables.rate * at.loads.scenario.rate_factor
    if at.variables.shape is not None:
        preload = at.variables.preload * at.loads.scenario.preload_factor
        held = preload * at.loads.jet.lift + rate * rise(at.variables.shape, at.loads.jet.lift).work
        return np.asarray((held + preload**2 / (2.0 * rate)) / at.scale.energy)
    return at.loads.spring_force**2 / (2.0 * rate * at.scale.energy)


def _rest_force(at: Turning) -> Mean:
    """Contact force at standstill without friction; every angle is as likely."""
    return Mean(at.loads.closing * at.loads.motion.gain / at.scale.force)


def _size(at: Turning) -> Mean:
    """Half of the energy and half of the force at standstill."""
    return Mean(0.5 * (_spring_energy(at) + _rest_force(at).terms))


_ENGINE = "torque ripple of the engine"
_SWING = "energy swing of the engine torque in the design load case"
_FORCE = "greatest engine torque of the design load case over the prime radius, at the cam"

# The mean is removed by a symmetric map; integration over a turn is antisymmetric.
TORQUE = Residual("torque", "torque ripple", _ENGINE, torque_ripple, torque_ripple)
SPEED = Residual(
    "speed",
    "speed ripple",
    "speed ripple of the engine",
    _speed_ripple,
    lambda item, level: -_speed_ripple(item, level),
)
LOSS = Cost(
    "loss", "mean loss of guides and roller bearing or face, work per cam turn", _SWING, _loss
)
COSTS: tuple[Cost, ...] = (
    LOSS,
    Cost(
        "size",
        "size: mean energy of the spring, preload included, and mean contact force at standstill, "
        "half of each",
        "energy swing and greatest force of the engine, as of the next two",
        _size,
        everywhere=True,
    ),
    Cost(
        "spring_energy",
        "greatest energy of the spring, preload included",
        _SWING,
        _spring_energy,
        everywhere=True,
    ),
    Cost(
        "rest_force",
        "contact force at standstill, mean over the angles",
        _FORCE,
        _rest_force,
        everywhere=True,
    ),
    Cost(
        "peak_force",
        "greatest contact force",
        _FORCE,
        lambda at: at.loads.normal / at.scale.force,
        everywhere=True,
    ),
)
"""Costs, by their weights."""

KEYS: tuple[str, ...] = (TORQUE.key, SPEED.key, "harmonic", *(each.key for each in COSTS))
"""Keys of all terms; the weight of each is smoothing.KEY_weight."""


def objective_of(weights: Mapping[str, float], orders: Iterable[int] = ()) -> Objective:
    """Objective from the weights of its terms; zero weights are left out.

    Parameters
    ----------
    weights : mapping          by the key of a term, >= 0
    orders : iterable of int   of the harmonics, periods in a cam turn

    Raises
    ------
    InputError
        If no term has a weight, or the harmonics have one and no orders.
    """
    chosen = tuple(orders)
    if weights.get("harmonic", 0.0) > 0 and not chosen:
        raise InputError("smoothing.harmonic_orders", "missing", "given with harmonic_weight")
    candidates: tuple[Residual | Cost, ...] = (TORQUE, SPEED, harmonics(chosen), *COSTS)
    terms = {term.key: term for term in candidates}
    objective = tuple(
        Weighted(terms[key], float(weight)) for key, weight in weights.items() if weight > 0
    )
    if not objective:
        raise InputError("smoothing.torque_weight", 0.0, "> 0, or another weight of smoothing")
    return objective


def residuals(objective: Objective, item: Scenario, values: Array) -> Array:
    """Stacked residuals (m, w) of crank torques (n, w), N m, whose norm is minimised."""
    parts = [
        np.sqrt(each.weight) * each.term.columns(item, values)
        for each in objective
        if isinstance(each.term, Residual)
    ]
    return np.concatenate(parts) if parts else np.zeros((1, *values.shape[1:]))


def residuals_slope(objective: Objective, item: Scenario, values: Array) -> Array:
    """Gradient (n,), 1/(N m), of the norm of `residuals` by the crank torque at each of n angles;
    zero where the norm is zero.

    Parameters
    ----------
    objective : Objective   weighted terms
    item : Scenario         load case
    values : array (n,)     crank torque, N m
    """
    slope, square = np.zeros_like(values), 0.0
    for each in objective:
        if isinstance(each.term, Residual):
            level = each.term.columns(item, values)
            slope += each.weight * each.term.transposed(item, level)
            square += each.weight * float(level @ level)
    return slope / np.sqrt(square) if square > 0.0 else slope


def costs(
    objective: Objective,
    scale: Scale,
    weight: Value,
    loads: ScenarioCam,
    variables: DesignVariables,
) -> Mapping[str, Array | Mean]:
    """Weighted costs by key, each (..., n) or a `Mean` over the turn.

    Parameters
    ----------
    loads : ScenarioCam   in one scenario, or in several, of the `weight` (..., 1) of their ripples
    """
    terms = [
        (each.term, each.weight * (1.0 if each.term.everywhere else weight))
        for each in objective
        if isinstance(each.term, Cost)
    ]
    at = Turning(loads, variables, scale)
    return {term.key: _times(term.value(at), weight) for term, weight in terms}


def _times(value: Array | Mean, weight: Value) -> Array | Mean:
    """Weighted cost; the power of a mean of a cost is 1."""
    return value._replace(terms=weight * value.terms) if isinstance(value, Mean) else weight * value

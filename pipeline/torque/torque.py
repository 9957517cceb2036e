"""Torque of a machine on its shaft, a sum of components over a cycle or cam turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.periodic_spline import periodic_cubic
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.period import FOUR_STROKE, Period

SAMPLES = 720
"""Angles of a cycle."""
_SAME = 1e-9  # of an angle


@dataclass(frozen=True, eq=False, repr=False)
class Torque(Displayed):
    """Torque of a machine on its shaft, positive when it drives the shaft.

    Parameters
    ----------
    theta : array (n,)                     rad of the shaft, uniform over [0, span); of a
                                           four-stroke engine 0 is the TDC of intake
    components : mapping to array (n,)     N m, by name; the total is their sum
    varying_inertia : array (n,)           kg m2, of the reciprocating masses whose torque at
                                           constant speed is the component ``inertia``; None: not
                                           known
    error_bar : array (n,)                 N m, half-width of the band about a measured total that
                                           holds it at all angles at once, 95 %; None: not known
    span : float                           rad of the shaft: one cycle, or after `over_cam_turn` the
                                           cycles of a cam turn

    Raises
    ------
    InputError
        If the angles are not uniform over the span, or a component is of another length or not
        finite.
    """

    theta: Array
    components: Mapping[str, Array]
    varying_inertia: Array | None = None
    error_bar: Array | None = None
    span: float = FOUR_STROKE.angle

    def __post_init__(self) -> None:
        """Refuse angles that are not uniform over the span, and components that are none, not
        finite or of another size; the arrays become read-only.
        """
        theta = finite("torque.theta", self.theta)
        if theta.ndim != 1 or theta.size < 12:
            raise InputError("torque.theta", f"{theta.shape} angles", "(12 or more,)")
        if not np.allclose(theta, uniform_cycle(theta.size, self.span), rtol=0.0, atol=1e-9):
            limit = f"uniform over [0, {shown(self.span, 'deg')})"
            raise InputError("torque.theta", "angles", limit)
        if not self.components:
            raise InputError("torque.components", "nothing", "one component or more")
        parts = {name: finite(f"torque.{name}", part) for name, part in self.components.items()}
        for name, part in parts.items():
            if part.shape != theta.shape:
                raise InputError(f"torque.{name}", f"{part.shape} values", f"{theta.shape}")
        freeze(self, theta=theta)
        object.__setattr__(self, "components", MappingProxyType(parts))

    @property
    def total(self) -> Array:
        """Sum of the components, N m."""
        return np.asarray(sum(self.components.values()))

    @property
    def mean(self) -> float:
        return float(self.total.mean())

    @property
    def throughput(self) -> float:
        """Mean torque of the driving or of the loading components, the greater one, N m.

        Times the speed it is the mean power of the machine.
        """
        means = np.array([part.mean() for part in self.components.values()])
        return float(max(means[means > 0.0].sum(), -means[means < 0.0].sum()))

    @property
    def std(self) -> float:
        """Standard deviation about the mean, N m."""
        return float(self.total.std())

    @property
    def peak(self) -> float:
        return float(self.total.max())

    @property
    def peak_to_peak(self) -> float:
        return float(np.ptp(self.total))

    def without_mean(self) -> Torque:
        """Torque with a constant component `load` that brings its mean to zero."""
        load = np.full_like(self.theta, -self.mean)
        known = self.components.get("load", np.zeros_like(load))
        return replace(self, components={**self.components, "load": known + load})

    def resampled(self, n: int) -> Torque:
        """Torque at `n` equal angles: a subset of its samples where these are a multiple of n, else
        by periodic cubic splines through them.
        """
        if n == self.theta.size:
            return self
        step, rest = divmod(self.theta.size, n)
        if rest == 0:  # exactly: without the round-off of a spline
            parts = {name: part[::step] for name, part in self.components.items()}
            varying, bar = (
                None if values is None else values[::step]
                for values in (self.varying_inertia, self.error_bar)
            )
            return Torque(self.theta[::step], parts, varying, bar, self.span)
        theta, span = uniform_cycle(n, self.span), self.span
        parts = {name: _periodic(part, theta, span) for name, part in self.components.items()}
        varying, bar = (
            # The spline of an inertia undershoots at a dead centre.
            None if values is None else np.maximum(_periodic(values, theta, span), 0.0)
            for values in (self.varying_inertia, self.error_bar)
        )
        return Torque(theta, parts, varying, bar, span)


def over_cam_turn(torque: Torque, period: Period) -> Torque:
    """Torque at equal shaft angles over the span of a cam turn, repeated from that over a machine
    cycle.

    Every module that draws, solves or smooths a cam takes the torque from here.

    Parameters
    ----------
    torque : Torque   over the cycle of the machine
    period : Period   number of cycles in a cam turn

    Raises
    ------
    InputError
        If the torque is over another angle than the cycle.
    """
    if abs(torque.span - period.angle) > _SAME * period.angle:
        limit = f"{shown(period.angle, 'deg')}, the cycle of the machine"
        raise InputError("torque.cycle", shown(torque.span, "deg"), limit)
    if period.cycles == 1:
        return torque
    varying, bar = (
        None if values is None else period.on_cam(values)
        for values in (torque.varying_inertia, torque.error_bar)
    )
    return Torque(
        uniform_cycle(period.cycles * torque.theta.size, period.cam_turn),
        {name: period.on_cam(part) for name, part in torque.components.items()},
        varying,
        bar,
        period.cam_turn,
    )


def together(one: Torque, other: Torque) -> Torque:
    """Sum of the torques of two machines on one shaft, over the longer cycle; components of equal
    name, and error bars, are added.

    Raises
    ------
    InputError
        If the longer cycle is no whole multiple of the shorter one.
    """
    short, long = sorted((one, other), key=lambda each: each.span)
    times = long.span / short.span
    if abs(times - round(times)) > _SAME * times:
        limit = f"a whole part or multiple of {shown(long.span, 'deg')}"
        raise InputError("torque.cycle", shown(short.span, "deg"), limit)
    repeated = over_cam_turn(short, Period(short.span, long.span / FULL_TURN))
    size = max(repeated.theta.size, long.theta.size)
    first, second = repeated.resampled(size), long.resampled(size)
    parts = dict(first.components)
    for name, part in second.components.items():
        parts[name] = parts[name] + part if name in parts else part
    varying = _sum_of_known(first.varying_inertia, second.varying_inertia)
    bar = _sum_of_known(first.error_bar, second.error_bar)
    return Torque(second.theta, parts, varying, bar, long.span)


def _sum_of_known(one: Array | None, other: Array | None) -> Array | None:
    """Sum of two arrays, of which None counts as zero; None if both are."""
    if one is None or other is None:
        return other if one is None else one
    return one + other


def uniform_cycle(count: int, span: float = FOUR_STROKE.angle) -> Array:
    """`count` equal shaft angles from 0 over a span (rad), its end excluded."""
    return np.arange(float(count)) * (span / count)


def _periodic(values: Array, theta: Array, span: float) -> Array:
    """Values at equal angles over a span (rad) at other shaft angles (rad)."""
    return periodic_cubic(values)(theta * (FULL_TURN / span))


def all_cylinders(
    parts: Mapping[str, Array],
    theta: Array,
    offsets: tuple[float, ...],
    span: float = FOUR_STROKE.angle,
) -> dict[str, Array]:
    """Torque components (n,), N m, of all cylinders, each the sum of that of one cylinder shifted
    by the offsets.

    Parameters
    ----------
    parts : mapping      components of one cylinder (n,), N m, by name
    theta : array (n,)   equal shaft angles, rad
    offsets : tuple      angles by which the cylinders come later, rad
    span : float         of the cycle, rad
    """
    if offsets == (0.0,):
        return dict(parts)
    shifted = [theta - offset for offset in offsets]
    return {
        name: np.asarray(sum(_periodic(part, at, span) for at in shifted))
        for name, part in parts.items()
    }

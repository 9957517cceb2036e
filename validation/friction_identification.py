"""Identification of viscous and dry friction from a pendulum decay or a shaft run-down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.torque.trace_file import (
    ANGLE_UNITS,
    QUANTITY_UNITS,
    trace_text,
    unit_factor,
)

GRAVITY = 9.80665
ROWS_MIN = 20
CONFIDENCE = 0.95
_STEP = 1e-2  # of the scale of a parameter: widths of intervals are then within 2e-4


@dataclass(frozen=True, eq=False)
class Identified:
    """Friction by least squares, with confidence intervals.

    viscous (N m s/rad), coulomb (N m): estimates; *_interval: bounds at `confidence`; residual
    (n,): measured less fitted, in the unit of the signal.
    """

    viscous: float
    viscous_interval: tuple[float, float]
    coulomb: float
    coulomb_interval: tuple[float, float]
    residual: Array
    confidence: float = CONFIDENCE

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual)

    @property
    def residual_rms(self) -> float:
        """Root mean square of the residual."""
        return float(np.sqrt(np.mean(self.residual**2)))


@dataclass(frozen=True)
class Pendulum:
    """Pendulum: mass m (kg), distance l of its centre (m), inertia I_G about it (kg m^2)."""

    mass: float
    length: float
    inertia: float

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"pendulum.{name}", getattr(self, name), "> 0")

    @property
    def total_inertia(self) -> float:
        """Inertia about the pin m l^2 + I_G, kg m^2."""
        return self.mass * self.length**2 + self.inertia

    def swing(self, time: Array, angle: float, rate: float, viscous: float, dry: float) -> Array:
        """Angle theta (n,), rad, by (m l^2 + I_G) theta'' + c theta' + T_c sign + m g l sin = 0."""
        weight, inertia = self.mass * GRAVITY * self.length, self.total_inertia
        # sign function smoothed over a speed far below that of the swing
        creep = 1e-3 * np.sqrt(weight / inertia)

        def motion(_: float, state: Array) -> list[float]:
            drag = viscous * state[1] + dry * np.tanh(state[1] / creep)
            return [state[1], -(drag + weight * np.sin(state[0])) / inertia]

        span = (float(time[0]), float(time[-1]))
        solution = solve_ivp(
            motion, span, [angle, rate], t_eval=time, rtol=1e-9, atol=1e-11, method="DOP853"
        )
        return np.asarray(solution.y[0])


def from_pendulum(
    time: ArrayLike, angle: ArrayLike, pendulum: Pendulum, *, small: bool = False
) -> Identified:
    """Viscous and dry friction of a pin from a pendulum decay (eq. A52 with a dry term).

    Parameters
    ----------
    time : array (n,)       s, strictly increasing, n >= 20
    angle : array (n,)      from the rest position, rad
    small : bool            linear equation with viscous friction only, in closed form

    Raises
    ------
    InputError
        If the signal is too short or not a decaying swing.
    """
    at, seen = _signal(time, angle)
    stiffness = pendulum.mass * GRAVITY * pendulum.length
    frequency = float(np.sqrt(stiffness / pendulum.total_inertia))
    if at[-1] - at[0] < 2.0 * 2.0 * np.pi / frequency:
        raise InputError("decay.time", f"{at[-1] - at[0]:.4g} s", "at least two swings long")
    viscous = 0.01 * frequency * pendulum.total_inertia
    start = [seen[0], float(np.gradient(seen, at)[0]), viscous]
    # A swing may begin at rest: its speed has the scale of the swing.
    swing = float(np.abs(seen).max())
    scale = [swing, swing * frequency, viscous]

    def closed(p: Array) -> Array:
        decay = p[2] / (2.0 * pendulum.total_inertia)
        turned = np.sqrt(max(frequency**2 - decay**2, 1e-300))
        t = at - at[0]
        sine = (p[1] + decay * p[0]) / turned * np.sin(turned * t)
        return np.exp(-decay * t) * (p[0] * np.cos(turned * t) + sine) - seen

    def numeric(p: Array) -> Array:
        return pendulum.swing(at, p[0], p[1], abs(p[2]), abs(p[3])) - seen

    if small:
        return _fitted(closed, np.array(start), np.array(scale), (2, None))
    dry = 1e-3 * stiffness
    return _fitted(numeric, np.array([*start, dry]), np.array([*scale, dry]), (2, 3))


def from_run_down(time: ArrayLike, speed: ArrayLike, inertia: float) -> Identified:
    """Viscous and dry friction of a shaft from its run-down, I w' = -c w - T_c.

    Parameters
    ----------
    time : array (n,)      s, strictly increasing, n >= 20
    speed : array (n,)     rad/s, >= 0
    inertia : float        kg m^2, > 0
    """
    if not 0.0 < inertia < np.inf:
        raise InputError("inertia", inertia, "> 0 kg m^2")
    at, seen = _signal(time, speed)
    if not seen[0] > seen[-1] >= 0.0:
        raise InputError(
            "run_down.speed", float(seen[-1]), ">= 0 and below the first: running down"
        )
    t = at - at[0]

    def miss(p: Array) -> Array:
        # w = (w0 + T/c) exp(-c t / I) - T/c, in a form regular at c = 0
        rate = p[1] / inertia
        grown = -np.expm1(-rate * t) / rate if abs(rate) > 1e-12 else t
        return p[0] * np.exp(-rate * t) - p[2] / inertia * grown - seen

    drop = inertia * (seen[0] - seen[-1]) / t[-1]
    start = np.array([seen[0], 0.5 * drop / seen[0], 0.5 * drop])
    return _fitted(miss, start, start, (1, 2))


def read_decay(path: str | Path) -> tuple[Array, Array]:
    """Time (s) and angle (rad) or speed (rad/s) from a CSV file of two columns with a header.

    Columns whose header has no unit are in s, rad and rad/s.

    Raises
    ------
    InputError
        If the file is not such a table; see `trace_text`.
    """
    text = trace_text(Path(path), "time_s,speed_rad/s")
    if len(text.header) != 2:
        raise InputError(text.name, f"{len(text.header)} columns", "two: time in s, rad or rad/s")
    first, second = text.header
    signal = ANGLE_UNITS, QUANTITY_UNITS["speed"]
    factors = [
        unit_factor(first, QUANTITY_UNITS["time"]) or 1.0,
        next((factor for known in signal if (factor := unit_factor(second, known))), 1.0),
    ]
    time, values = (text.numbers((0, 1)) * factors).T
    return time, values


def _signal(time: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    at, seen = finite("decay.time", time), finite("decay.signal", values)
    if at.ndim != 1 or at.shape != seen.shape or at.size < ROWS_MIN:
        raise InputError("decay", f"{at.size} rows", f"at least {ROWS_MIN} of time and signal")
    if not (np.diff(at) > 0.0).all():
        raise InputError("decay.time", "not increasing", "strictly increasing")
    return at, seen


def _fitted(
    miss: Callable[[Array], Array], start: Array, scale: Array, places: tuple[int, int | None]
) -> Identified:
    """Least squares; intervals by the linearised covariance and Student's t.

    Slopes by central differences over a share of the scale (k,) > 0 of each parameter: far above
    the integration error at sign changes of the speed, also where the parameter vanishes.
    """
    steps = _STEP * scale

    def slopes(p: Array) -> Array:
        sides = [[miss(p + sign * step) for sign in (1.0, -1.0)] for step in np.diag(steps)]
        return np.stack([up - down for up, down in sides], axis=1) / (2.0 * steps)

    fit = least_squares(miss, start, slopes, x_scale=scale, xtol=1e-9, ftol=1e-9)
    if not fit.success:
        raise InputError("decay", str(fit.message), "a decay by viscous and dry friction")
    freedom = len(fit.fun) - len(start)
    slope = np.asarray(fit.jac)
    covariance = np.linalg.pinv(slope.T @ slope) * (2.0 * fit.cost / freedom)
    reach = stats.t.ppf(0.5 + 0.5 * CONFIDENCE, freedom) * np.sqrt(np.diag(covariance))

    def at(place: int | None) -> tuple[float, tuple[float, float]]:
        if place is None:
            return 0.0, (0.0, 0.0)
        value = abs(float(fit.x[place]))
        return value, (value - float(reach[place]), value + float(reach[place]))

    viscous, dry = at(places[0]), at(places[1])
    return Identified(*viscous, *dry, residual=-fit.fun)

"""Crank speed over a cycle from torques and inertia, by work and kinetic energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze, positive, readonly
from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.base.quantities import In, Known, Part, TableSource, Used
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.torque.motor_line import MotorLine, MotorPoint

SETTLED = 1e-13  # change of the speed between two passes over its mean
PASSES_MAX = 200
_ENERGY_STEP_END = 1e-12  # relative step of the kinetic energy; the next one would be its square
_SPEED_STEPS_MAX = 60  # of Newton's method on mean speed or motor line
_STEEP = 3.0  # greatest range of the logarithm of an integrating factor

# Crank torque (n,) of a mechanism without the inertia of its moving parts, N m, from crank
# speed (n,), rad/s, and crank acceleration (n,), rad/s2.
MechanismTorque = Callable[[Array, Array], Array]


class StallError(CamError):
    """Crank whose torque swings more energy than its rotation holds; angle of the stall, rad."""

    def __init__(self, words: str, crank_angle: float) -> None:
        super().__init__(words)
        self.crank_angle = crank_angle


@dataclass(frozen=True, kw_only=True)
class Crankshaft(Part):
    """Rotating parts of the engine and the load it drives; needed for the speed, not for the cam.

    Reciprocating masses that the engine states are left out of `inertia`. With a motor line the
    motor follows its line in place of the load, and the mean speed with it.

    Raises
    ------
    InputError
        If a value is out of its bounds; as `MotorLine`.
    """

    table: ClassVar[str] = "crankshaft"

    inertia: Annotated[
        float,
        In("kg m^2", above=0, at_most=1e6),
        Known("drawing or run-down test", "0.0139 kg m^2"),
    ]
    """moment of inertia of all that turns with the crank, flywheel included"""
    mechanism_inertia: Annotated[float, In("kg m^2", at_least=0, at_most=1e6), Known("drawing")] = (
        0.0
    )
    """moment of inertia of the turning parts of the mechanism, at the crank"""
    load_exponent: Annotated[float, In(at_least=0, at_most=4), Known("kind of load")] = 0.0
    """power of the speed that the load follows: 0 constant, 2 a pump"""
    measured_speed_std: Annotated[
        float | None, In("rad/s", above=0, at_most=1e3), Known("test bench", "3.74 rad/s")
    ] = None
    """measured standard deviation of the crank speed, for comparison"""
    motor_line: Annotated[tuple[MotorPoint, ...], Used("torque")] = ()
    """torque of the motor that drives the shaft, over its speed"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a load exponent beside a motor line, and a load that cannot be made."""
        super().__post_init__()
        if self.motor_line and self.load_exponent:
            limit = "left out beside crankshaft.motor_line"
            raise InputError("crankshaft.load_exponent", self.load_exponent, limit)
        _ = self.load

    @property
    def load(self) -> Load | MotorLine:
        """Load on the crank: a torque by a power law of the speed, or a motor on its line."""
        return MotorLine(self.motor_line) if self.motor_line else Load(self.load_exponent)


@dataclass(frozen=True, eq=False)
class Inertia:
    """Moment of inertia at the crank: a constant part, and one that varies with crank angle.

    Parameters
    ----------
    constant : float       kg m2, >= 0, of everything that turns at a fixed ratio
    varying : array (n,)   kg m2, >= 0, at equal crank angles over the cycle from 0: of parts
                           of mass m and transmission x'(theta) = dx/dtheta it is m x'^2

    Raises
    ------
    InputError
        If a part is negative, or their sum is zero at an angle.
    """

    constant: float
    varying: Array

    def __post_init__(self) -> None:
        """Refuse negative parts, fewer than 12 angles, and a total inertia of zero; the array
        becomes read-only.
        """
        if not 0.0 <= self.constant < np.inf:
            raise InputError("crankshaft.inertia", self.constant, ">= 0 kg m^2")
        varying = finite("crankshaft.varying_inertia", self.varying)
        if varying.ndim != 1 or varying.size < 12 or not varying.min() >= 0.0:
            raise InputError("crankshaft.varying_inertia", varying.shape, "12 values or more, >= 0")
        freeze(self, varying=varying)
        positive("crankshaft.inertia", self.total, "kg m^2")

    @classmethod
    def constant_only(cls, value: float, count: int = 720) -> Inertia:
        """Inertia that is constant over `count` angles."""
        return cls(value, np.zeros(count))

    @property
    def total(self) -> Array:
        return readonly(self.constant + self.varying)

    @property
    def mean(self) -> float:
        return float(self.total.mean())

    def plus(self, constant: float, varying: ArrayLike = 0.0) -> Inertia:
        """Inertia with that of further parts added, kg m2."""
        return Inertia(self.constant + constant, self.varying + np.asarray(varying, dtype=float))


@dataclass(frozen=True)
class Load:
    """Load torque T = T0 (omega / mean omega)^exponent; T0 balances the mean torque.

    Parameters
    ----------
    exponent : float    0 a constant torque, 1 viscous drag, 2 a fan
    """

    exponent: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.exponent <= 4.0:
            raise InputError("crankshaft.load_exponent", self.exponent, "from 0 to 4")


@dataclass(frozen=True, eq=False)
class CrankMotion:
    """Periodic motion of the crank: speed, energy, torques over the cycle.

    Parameters
    ----------
    theta : array (n,)          shaft angle, rad, uniform over [0, span)
    speed : array (n,)          rad/s
    acceleration : array (n,)   rad/s2
    load_torque : array (n,)    N m, taken from the crank
    mechanism_torque : array (n,)    N m, on the crank, inertia of its parts left out
    net_torque : array (n,)     N m, derivative of the kinetic energy by the crank angle
    closure : float             work of the net torque over the cycle at the final speed, over the
                                mean kinetic energy
    span : float                rad of the shaft, whole cycles
    """

    theta: Array
    speed: Array
    acceleration: Array
    load_torque: Array
    mechanism_torque: Array
    net_torque: Array
    closure: float
    span: float = CYCLE_ANGLE

    def __post_init__(self) -> None:
        names = ("theta", "speed", "acceleration", "load_torque", "mechanism_torque", "net_torque")
        freeze(self, **{name: finite(f"motion.{name}", getattr(self, name)) for name in names})

    @property
    def statistics(self) -> SpeedStatistics:
        return speed_statistics(self.speed, self.span)


@dataclass(frozen=True)
class SpeedStatistics:
    """Ripple of a crank speed at equal crank angles: mean, extremes, deviation, rad/s."""

    mean: float  # over the time of the cycle: what a tachometer shows
    std: float  # over the crank angle, about the mean over the angle
    peak_to_peak: float
    minimum: float
    minimum_angle: float
    maximum: float
    maximum_angle: float

    @property
    def fluctuation(self) -> float:
        """Coefficient of fluctuation, (max - min) / mean."""
        return self.peak_to_peak / self.mean


def speed_statistics(speed: ArrayLike, span: float = CYCLE_ANGLE) -> SpeedStatistics:
    """Ripple of a speed (rad/s) at equal shaft angles over a span (rad) of whole cycles."""
    omega = positive("speed", speed, "rad/s")
    step = span / omega.size
    return SpeedStatistics(
        mean=_time_mean(omega),
        std=float(omega.std()),
        peak_to_peak=float(np.ptp(omega)),
        minimum=float(omega.min()),
        minimum_angle=float(omega.argmin() * step),
        maximum=float(omega.max()),
        maximum_angle=float(omega.argmax() * step),
    )


def crank_motion(
    engine_torque: ArrayLike,
    inertia: Inertia,
    mean_speed: float,
    *,
    load: Load | MotorLine = Load(),
    mechanism: MechanismTorque | None = None,
    span: float = CYCLE_ANGLE,
) -> CrankMotion:
    r"""Periodic solution of J omega domega/dtheta + omega^2 J'/2 = T_engine + T_mech - T_load.

    In the form of work and kinetic energy, d(J omega^2 / 2)/dtheta = T, the speed at each angle
    follows from the integral of the torques, and the cycle closes when their mean is zero, which
    sets the level of the load. The integral is that of the trigonometric interpolant. Loads that
    depend on the motion are iterated until loads and speed agree. With a motor line the line is
    the load, its torque taken negative, and the mean speed follows from it, not from `mean_speed`.

    Parameters
    ----------
    engine_torque : array (n,)   N m at equal shaft angles over [0, span); without the inertia of
                                 parts that `inertia` holds
    inertia : Inertia            at the same angles
    mean_speed : float           rad/s over the time of the cycle
    load : Load or MotorLine     what the shaft drives, or the motor that drives it
    mechanism : function, optional
    span : float                 rad of the shaft, whole cycles of the machine

    Raises
    ------
    InputError
        If lengths differ or a value is out of bounds.
    CamError
        If the torques stop the crank within the cycle, the motor cannot carry them, or the
        iteration does not converge.

    References
    ----------
    Uicker, Pennock and Shigley, Theory of Machines and Mechanisms, ch. on flywheels.
    """
    torque, total = finite("engine_torque", engine_torque), inertia.total
    if torque.shape != total.shape:
        raise InputError("engine_torque", torque.shape, f"{total.shape}, as the inertia")
    if not 0.0 < mean_speed < np.inf:
        raise InputError("mean_speed", mean_speed, "> 0 rad/s")
    slope = _derivative(total, span)
    level = mean_speed if isinstance(load, Load) else load.balance(-float(torque.mean()))
    speed, acceleration = np.full_like(torque, level), np.zeros_like(torque)
    for _ in range(PASSES_MAX):
        mechanical = np.zeros_like(torque) if mechanism is None else mechanism(speed, acceleration)
        driven = torque + mechanical
        before = speed
        if isinstance(load, Load):
            loaded = _closing_load(driven, speed, load)
            net = driven - loaded
            speed = _speed(_integral(net, span), total, mean_speed, span)
        else:
            speed = _speed_on_line(driven, total, load, speed, span)
            loaded = -load.torque(speed)
            net = driven - loaded
        acceleration = (net - 0.5 * speed**2 * slope) / total
        change = float(np.abs(speed - before).max()) / mean_speed
        if change < SETTLED:
            break
    else:
        text = f"the crank speed did not converge within {PASSES_MAX} passes"
        raise CamError(f"{text}: it still changes by {change:.1e} of its mean")
    again = mechanical if mechanism is None else mechanism(speed, acceleration)
    loaded_again = loaded
    if isinstance(load, Load):
        loaded_again = float(loaded.mean()) * _shape(speed, load)
    work = span * float((torque + again - loaded_again).mean())
    return CrankMotion(
        theta=readonly(np.arange(torque.size) * (span / torque.size)),
        speed=speed,
        acceleration=acceleration,
        load_torque=loaded,
        mechanism_torque=mechanical,
        net_torque=net,
        closure=abs(work) / float((0.5 * total * speed**2).mean()),
        span=span,
    )


def equivalent_inertia(
    engine_torque: ArrayLike, mean_speed: float, speed_std: float, span: float = CYCLE_ANGLE
) -> float:
    """Constant inertia at which the engine torque alone causes a given speed ripple, kg m2.

    Parameters
    ----------
    engine_torque : array (n,)   N m at equal shaft angles over a span (rad) of whole cycles
    mean_speed : float           rad/s
    speed_std : float            rad/s, standard deviation of the ripple, > 0

    Raises
    ------
    InputError
        If the ripple is not positive, or the torque is constant.
    """
    torque = finite("engine_torque", engine_torque)
    if not 0.0 < speed_std < mean_speed:
        raise InputError("speed_std", speed_std, f"> 0 and < {mean_speed:g} rad/s")
    energy = _integral(torque - torque.mean(), span)
    guess = float(energy.std()) / (mean_speed * speed_std)
    if not guess > 0.0:
        raise InputError("engine_torque", "constant", "a torque that varies over the cycle")

    def excess(inertia: float) -> float:
        total = np.full_like(torque, inertia)
        return float(_speed(energy, total, mean_speed, span).std()) - speed_std

    low = guess
    while excess(low) < 0.0:
        low *= 0.9
    return float(scipy.optimize.brentq(excess, low, 2.0 * guess, xtol=1e-14 * guess, rtol=1e-12))


def energy_swing(torque: ArrayLike, span: float = CYCLE_ANGLE) -> Array:
    """Kinetic energy over the shaft angle, J, of zero mean: integral of the torque about its mean.

    Parameters
    ----------
    torque : array (n,)   N m at equal shaft angles over the span
    span : float          rad of the shaft, whole cycles
    """
    values = finite("torque", torque)
    return readonly(_integral(values - values.mean(), span))


def torque_of_motion(speed: ArrayLike, inertia: float) -> Array:
    """Accelerating torque J omega domega/dtheta of a speed at equal crank angles, N m."""
    energy = 0.5 * positive("speed", speed, "rad/s") ** 2
    return readonly(inertia * _derivative(energy, CYCLE_ANGLE))


def _closing_load(driven: Array, speed: Array, load: Load) -> Array:
    """Load torque whose work over the cycle is that of the driving torque, N m."""
    shape = _shape(speed, load)
    return np.asarray(float(driven.mean()) * shape)


def _shape(speed: Array, load: Load) -> Array:
    shape = (speed / speed.mean()) ** load.exponent
    return np.asarray(shape / shape.mean())


def _speed(energy: Array, inertia: Array, mean_speed: float, span: float) -> Array:
    """Speed (n,), rad/s, of a crank over its cycle from the energy that its torques have given it,
    with a constant of energy for which the mean speed over time is the stated one.

    By Newton's method on the constant.

    Parameters
    ----------
    energy : array (n,)    integral of the torque over the angle, J, at equal angles
    inertia : array (n,)   kg m2
    mean_speed : float     mean over time, rad/s
    span : float           angle of the cycle, rad, for the message

    Raises
    ------
    StallError
        If no constant with which the speed is at least 1 % of the mean everywhere gives that mean.
    CamError
        If the steps do not converge.
    """

    def speed(floor: float) -> Array:
        return np.asarray(np.sqrt(2.0 * (energy + floor) / inertia))

    least = -float(energy.min())
    # Where the speed is no less than 1 % of the mean everywhere; a slower crank is called stalled.
    low = least + float((0.5 * inertia).max()) * (0.01 * mean_speed) ** 2
    if _time_mean(speed(low)) > mean_speed:
        swing = float(np.ptp(energy))
        stored = 0.5 * float(inertia.mean()) * mean_speed**2
        angle = span * int(np.argmin(energy / inertia)) / energy.size
        raise StallError(
            f"the crank stalls at {shown(angle, 'deg')} of its cycle: its torque swings"
            f" {swing:.3g} J of the {stored:.3g} J that turn at {shown(mean_speed, 'rpm')}",
            angle,
        )
    # The mean is a concave rising function of the constant: Newton's steps approach it from below.
    floor = max(low, 0.5 * float(inertia.mean()) * mean_speed**2)
    for _ in range(_SPEED_STEPS_MAX):
        omega = speed(floor)
        mean = _time_mean(omega)
        step = (mean_speed - mean) / (mean**2 * float((1.0 / (inertia * omega**3)).mean()))
        floor, before = max(low, floor + step), floor
        if abs(floor - before) <= _ENERGY_STEP_END * floor:
            return speed(floor)
    raise CamError(f"the mean crank speed did not converge within {_SPEED_STEPS_MAX} steps")


def _speed_on_line(
    driven: Array, inertia: Array, motor: MotorLine, start: Array, span: float
) -> Array:
    """Periodic speed (n,), rad/s, of a shaft driven by a motor and other torques T: dE/dtheta = T +
    T_motor(omega), E = J omega^2/2.

    Newton's steps, each the solution of the linearised equation dE/dtheta + c E = r, with c > 0
    where the torque of the motor falls. With the integrating factor of c about its mean it has
    constant coefficients, and each harmonic its own equation. A steep line on a light crank has a
    factor that harmonics do not resolve: c is then the middle of its range, and each step leaves
    the share of the error that c departs from it.

    Parameters
    ----------
    driven : array (n,)    T without the motor, N m, at equal angles
    inertia : array (n,)   J, kg m2
    motor : MotorLine      torque over speed
    start : array (n,)     first speed, rad/s
    span : float           angle of the cycle, rad

    Raises
    ------
    CamError
        If the torque of the motor does not fall with the speed, or the steps do not converge.
    """
    speed, order = start, _orders(driven.size, span)
    for _ in range(_SPEED_STEPS_MAX):
        energy = 0.5 * inertia * speed**2
        fall = -motor.slope(speed) / (inertia * speed)
        rate = float(fall.mean())
        exponent = _integral(fall - rate, span)
        if np.ptp(exponent) > _STEEP:
            rate = 0.5 * float(fall.min() + fall.max())
            fall, exponent = np.full_like(fall, rate), np.zeros_like(fall)
        if not rate > 0.0:
            raise CamError(
                f"the motor cannot carry its load: at {shown(_time_mean(speed), 'rpm')} its torque"
                " does not fall with the speed"
            )
        factor = np.exp(exponent)
        right = factor * (driven + motor.torque(speed) + fall * energy)
        raised = np.fft.irfft(np.fft.rfft(right) / (1j * order + rate), n=driven.size) / factor
        before, speed = speed, np.sqrt(2.0 * np.maximum(raised, 0.25 * energy) / inertia)
        if float(np.abs(speed - before).max()) < SETTLED * float(speed.mean()):
            return np.asarray(speed)
    text = f"the speed on the motor line did not converge within {_SPEED_STEPS_MAX} steps"
    raise CamError(f"{text}: the motor cannot carry its load")


def _time_mean(speed: Array) -> float:
    return float(1.0 / (1.0 / speed).mean())


def _orders(count: int, span: float) -> Array:
    """Order of each harmonic per radian of the shaft."""
    return np.arange(count // 2 + 1, dtype=float) * (2.0 * pi / span)


def _integral(values: Array, span: float) -> Array:
    """Integral over the shaft angle of periodic values (n,) of zero mean at equal angles over a
    cycle of `span`, rad; the integral has zero mean. By Fourier series.
    """
    spectrum, order = np.fft.rfft(values), _orders(values.size, span)
    spectrum[0] = 0.0
    spectrum[1:] /= 1j * order[1:]
    return np.asarray(np.fft.irfft(spectrum, n=values.size), dtype=float)


def _derivative(values: Array, span: float) -> Array:
    """Derivative by the shaft angle, 1/rad, of values (n,) at equal angles over `span`, rad; by
    Fourier series.
    """
    spectrum = np.fft.rfft(values) * 1j * _orders(values.size, span)
    if values.size % 2 == 0:
        spectrum[-1] = 0.0  # the highest harmonic of an even count has no slope at the samples
    return np.asarray(np.fft.irfft(spectrum, n=values.size), dtype=float)

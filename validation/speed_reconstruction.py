"""Crank speed of the GX120 reconstructed from published statistics; not measured data.

Cardoso et al., Energies 18 (2025) 3256, print statistics and a few points of the speed of the stock
engine at idle, no curve. The reconstruction is the smoothest curve that satisfies all of them, by
third differences over the 72 teeth of two turns of the 36-tooth wheel, together with the effective
inertia. Run as a script this module writes ``gx120_speed.csv``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse import csr_array

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ResultError
from camwright.pipeline.engine.crankshaft import torque_of_motion
from camwright.pipeline.smoothing.cone_program import Cones

FILE = "gx120_speed.csv"
TEETH = 72  # teeth of a cycle, 10 deg apart

SPEED_STD = 3.74  # rad/s, stock
SPEED_AMPLITUDE = 11.08 * 3.74 / 3.58  # printed with the mechanism mounted; scaled by the std
SPEED_MEAN = 151.0  # of the printed points
POINTS = {0: 153.0, 18: 147.0}  # rad/s at 0 and 180 deg
SLOWEST, FASTEST = 35, 45  # "just before 360 deg", "around 450 deg"
TORQUE_STD, TORQUE_AMPLITUDE, TORQUE_PEAK = 6.25, 29.79, 25.0
MAX_STEPS = 100  # of the initial guess, and of the solution
SETTLED = 1e-7  # last step, rad/s and g m2
FARTHEST = 0.5  # maximum step, rad/s and g m2
_APART = 1e-3  # step of difference quotients, rad/s and g m2
PEAK, TROUGH = 37, 48  # teeth of the torque extremes, chosen for a smooth curve


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Speed (72,), rad/s, at every 10 deg of the cycle, and effective inertia, kg m2."""

    speed: Array
    inertia: float

    def __post_init__(self) -> None:
        freeze(self, speed=self.speed)

    def speed_at(self, count: int) -> Array:
        """Speed (count,) at equal angles by trigonometric interpolation, rad/s."""
        spectrum = np.fft.rfft(self.speed)
        if count > self.speed.size:
            spectrum[-1] *= 0.5  # shared by two harmonics
        return np.asarray(np.fft.irfft(spectrum, n=count) * (count / self.speed.size), dtype=float)

    def torque_at(self, count: int) -> Array:
        """Torque (count,) J omega domega/dtheta, N m."""
        return torque_of_motion(self.speed_at(count), self.inertia)


def reconstruct() -> Reconstruction:
    """The smoothest curve that satisfies the published statistics.

    Raises
    ------
    ResultError
        If no curve satisfies them.

    Notes
    -----
    Sequential quadratic programming with the Hessian of the Lagrangian: the optimum is flat, and
    weighted least squares stop early.
    """
    guess = np.append(_first_guess(), 13.3)  # the inertia in g m2, to be of one size
    unknowns = least_squares(_residuals, guess, x_scale="jac", max_nfev=MAX_STEPS).x
    multipliers = np.zeros(_limits(unknowns).size)
    for _ in range(MAX_STEPS):
        advance = _step(unknowns, multipliers)
        if advance is None:
            break
        step, multipliers = advance
        unknowns = unknowns + step * min(1.0, FARTHEST / np.abs(step).max())
        if np.abs(step).max() < SETTLED:
            return Reconstruction(unknowns[:-1], float(unknowns[-1]) * 1e-3)
    miss = float(np.abs(_misses(unknowns)).max())
    raise ResultError(f"speed curve: residual of the published statistics = {miss:.2g}")


def _step(unknowns: Array, multipliers: Array) -> tuple[Array, Array] | None:
    """Step to the optimum of the quadratic model, and multipliers; None without one."""
    level, slopes = _limits(unknowns), _slopes(_limits, unknowns)
    hessian = _slopes(lambda at: multipliers @ _slopes(_limits, at), unknowns)
    smooth = np.zeros_like(hessian)
    smooth[:-1, :-1] = _THIRD.T @ _THIRD
    values, vectors = np.linalg.eigh(smooth - 0.5 * (hessian + hessian.T))
    program = Cones(unknowns.size)
    program.charge(smooth @ unknowns)
    program.charge_square((vectors * np.maximum(values, 1e-8)) @ vectors.T)
    met = _misses(unknowns).size  # equalities; the others are inequalities
    program.at_most(csr_array(-slopes), level)
    program.at_most(csr_array(slopes[:met]), -level[:met])
    solution = program.solved()
    if solution is None:
        return None
    step, pushes, _ = solution
    pushes[:met] -= pushes[level.size :]
    return step, pushes[: level.size]


def _slopes(function: Callable[[Array], Array], at: Array) -> Array:
    """Derivatives by central differences of a nearly quadratic function."""
    steps = _APART * np.eye(at.size)
    return np.array([(function(at + h) - function(at - h)) / (2 * _APART) for h in steps]).T


def _residuals(unknowns: Array) -> Array:
    """Third differences, residuals of the published values and of their extremes."""
    passed = np.minimum(_room(unknowns), 0.0)
    return np.concatenate([_differences(unknowns[:-1]), _misses(unknowns), passed])


def _limits(unknowns: Array) -> Array:
    return np.concatenate([_misses(unknowns), _room(unknowns)])


def _first_guess() -> Array:
    places = [0, 18, SLOWEST, FASTEST, 54, TEETH]
    return np.asarray(np.interp(np.arange(TEETH), places, [153, 147, 145, 156.5, 154, 153]))


def _differences(speed: Array) -> Array:
    for _ in range(3):
        speed = np.roll(speed, -1) - speed
    return speed


_THIRD = np.stack([_differences(row) for row in np.eye(TEETH)], axis=1)


def _torque(unknowns: Array) -> Array:
    return torque_of_motion(unknowns[:-1], float(unknowns[-1]) * 1e-3)


def _misses(unknowns: Array) -> Array:
    """Residuals of the published values."""
    speed, torque = unknowns[:-1], _torque(unknowns)
    return np.array(
        [
            speed.mean() - SPEED_MEAN,
            speed.std() - SPEED_STD,
            speed[FASTEST] - speed[SLOWEST] - SPEED_AMPLITUDE,
            *(speed[place] - value for place, value in POINTS.items()),
            torque.std() - TORQUE_STD,
            torque[PEAK] - TORQUE_PEAK,
            torque[TROUGH] - (TORQUE_PEAK - TORQUE_AMPLITUDE),
        ]
    )


def _room(unknowns: Array) -> Array:
    """Margins of torque and speed to their published extremes, >= 0."""
    speed, torque = unknowns[:-1], _torque(unknowns)
    return np.concatenate(
        [
            TORQUE_PEAK - torque,
            torque - (TORQUE_PEAK - TORQUE_AMPLITUDE),
            speed - speed[SLOWEST],
            speed[FASTEST] - speed,
        ]
    )


def load() -> Reconstruction:
    """The shipped reconstruction."""
    text = Path(__file__).with_name(FILE).read_text(encoding="utf-8")
    inertia = next(line for line in text.splitlines() if line.startswith("# inertia_kg_m2"))
    rows = [line.split(",") for line in text.splitlines() if line[:1].isdigit()]
    return Reconstruction(np.array(rows, dtype=float)[:, 1], float(inertia.split("=")[1]))


def to_csv(reconstruction: Reconstruction) -> str:
    """Text of the shipped file; floats are exact."""
    head = [
        "# RECONSTRUCTED, not measured: the smoothest crank speed (third differences) that meets",
        "# the statistics of the stock GX120 at idle in Cardoso et al., Energies 2025, 18, 3256.",
        "# Written by: python -m validation.speed_reconstruction",
        f"# inertia_kg_m2 = {reconstruction.inertia!r}",
        "crank_angle_deg,speed_rad_per_s,torque_Nm",
    ]
    torque = torque_of_motion(reconstruction.speed, reconstruction.inertia)
    rows = [
        f"{10 * k},{float(speed)!r},{float(value)!r}"
        for k, (speed, value) in enumerate(zip(reconstruction.speed, torque, strict=True))
    ]
    return "\n".join([*head, *rows]) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name(FILE).write_text(to_csv(reconstruct()), encoding="utf-8")

"""A crank speed of the GX120 that meets every statistic published of it; not measured data.

Cardoso et al., Energies 2025, 18, 3256, print statistics and a few points of the speed of the
stock engine at idle, no curve. They leave the curve open. Here it is the smoothest that meets
them all, by third differences over the 72 tooth places of two turns of their 36-tooth wheel; the
effective inertia is found with it. This module, run as a script, writes
``gx120_speed.csv`` anew.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse import csr_array

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ResultError
from camwright.pipeline.engine.crankshaft import torque_of_motion
from camwright.pipeline.smoothing.cone_program import Cones

FILE = "gx120_speed.csv"
TEETH = 72  # tooth places of a cycle, 10 deg apart

SPEED_STD = 3.74  # rad/s, stock
SPEED_AMPLITUDE = 11.08 * 3.74 / 3.58  # printed with the mechanism mounted; scaled by the std
SPEED_MEAN = 151.0  # of the printed points
POINTS = {0: 153.0, 18: 147.0}  # rad/s at 0 and 180 deg
SLOWEST, FASTEST = 35, 45  # "just before 360 deg", "around 450 deg"
TORQUE_STD, TORQUE_AMPLITUDE, TORQUE_PEAK = 6.25, 29.79, 25.0
MAX_STEPS = 100  # towards a first guess, and from it
SETTLED = 1e-7  # rad/s and g m2, the last step
FARTHEST = 0.5  # of one step
_APART = 1e-3  # of the differences behind slopes of smooth functions, rad/s and g m2
PEAK, TROUGH = 37, 48  # tooth places of the torque, chosen for a smooth curve


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """Speed (72,), rad/s, at every 10 deg of the cycle, and the inertia it implies, kg m2."""

    speed: Array
    inertia: float

    def __post_init__(self) -> None:
        freeze(self, speed=self.speed)

    def speed_at(self, count: int) -> Array:
        """The trigonometric interpolant at `count` equal angles, rad/s."""
        spectrum = np.fft.rfft(self.speed)
        if count > self.speed.size:
            spectrum[-1] *= 0.5  # shared by both of the harmonics it stands for
        return np.asarray(np.fft.irfft(spectrum, n=count) * (count / self.speed.size), dtype=float)

    def torque_at(self, count: int) -> Array:
        """J omega domega/dtheta of it, N m."""
        return torque_of_motion(self.speed_at(count), self.inertia)


def reconstruct() -> Reconstruction:
    """The smoothest curve that meets the published statistics.

    Raises
    ------
    ResultError
        If no curve meets them.

    Notes
    -----
    Steps of sequential quadratic programming with the curvature of the Lagrangian: the optimum is
    flat, and weighted least squares stop wherever they tire.
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
    raise ResultError(f"no speed curve meets the published statistics: off by {miss:.2g}")


def _step(unknowns: Array, multipliers: Array) -> tuple[Array, Array] | None:
    """To the optimum of the quadratic model, and its multipliers; None where it has none."""
    level, slopes = _limits(unknowns), _slopes(_limits, unknowns)
    bend = _slopes(lambda at: multipliers @ _slopes(_limits, at), unknowns)
    smooth = np.zeros_like(bend)
    smooth[:-1, :-1] = _THIRD.T @ _THIRD
    values, vectors = np.linalg.eigh(smooth - 0.5 * (bend + bend.T))
    program = Cones(unknowns.size)
    program.charge(smooth @ unknowns)
    program.charge_square((vectors * np.maximum(values, 1e-8)) @ vectors.T)
    met = _misses(unknowns).size  # from both sides; the rest are one-sided
    program.at_most(csr_array(-slopes), level)
    program.at_most(csr_array(slopes[:met]), -level[:met])
    solution = program.solved()
    if solution is None:
        return None
    step, pushes, _ = solution
    pushes[:met] -= pushes[level.size :]
    return step, pushes[: level.size]


def _slopes(function: Callable[[Array], Array], at: Array) -> Array:
    """Derivatives by central differences: what is differentiated is nearly quadratic."""
    steps = _APART * np.eye(at.size)
    return np.array([(function(at + h) - function(at - h)) / (2 * _APART) for h in steps]).T


def _residuals(unknowns: Array) -> Array:
    """Third differences, what misses the published figures and what passes their extremes."""
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
    """By how much each published figure is missed."""
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
    """Not below zero where neither torque nor speed passes its published extremes."""
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
    """The reconstruction as shipped."""
    text = files(__package__).joinpath(FILE).read_text(encoding="utf-8")
    inertia = next(line for line in text.splitlines() if line.startswith("# inertia_kg_m2"))
    rows = [line.split(",") for line in text.splitlines() if line[:1].isdigit()]
    return Reconstruction(np.array(rows, dtype=float)[:, 1], float(inertia.split("=")[1]))


def to_csv(reconstruction: Reconstruction) -> str:
    """Text of the file shipped; floats read back bit for bit."""
    head = [
        "# RECONSTRUCTED, not measured: the smoothest crank speed (third differences) that meets",
        "# the statistics of the stock GX120 at idle in Cardoso et al., Energies 2025, 18, 3256.",
        "# Written by: python -m camwright.pipeline.studies.papers.speed_reconstruction",
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
    from pathlib import Path

    Path(__file__).with_name(FILE).write_text(to_csv(reconstruct()), encoding="utf-8")

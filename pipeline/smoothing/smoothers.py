"""Named zero-phase smoothers of one engine cycle of torque."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import savgol_coeffs

from geometry.arrays import Array, finite, readonly
from geometry.errors import InputError

CYCLE = 4.0 * np.pi  # rad of crank in one engine cycle

KINDS = ("none", "moving_average", "gaussian", "harmonic", "savitzky_golay")


@dataclass(frozen=True)
class Smoother:
    """A linear, zero-phase filter on the engine cycle, with one knob.

    `strength` stretches the filter along the crank angle: at 2 a moving average of 60 deg
    becomes one of 120 deg, a cut at harmonic 24 one at harmonic 12. It moves continuously,
    because the filter is applied to the harmonics of the cycle and not to samples.

    Parameters
    ----------
    kind : str          one of `KINDS`
    points : int        moving average, Savitzky-Golay: intervals in the window
    spacing : float     moving average, Savitzky-Golay: crank angle between points, rad
    width : float       gaussian: crank angle, rad, of the box with the same variance
    harmonics : float   harmonic: harmonics of the cycle that are kept
    taper : float       harmonic: 0 cuts hard; else the half-width of the cosine edge as a share
    degree : int        Savitzky-Golay: degree of the fitted polynomial
    strength : float    1 as given; above 1 gentler on the cam

    Raises
    ------
    InputError
        If the kind is unknown or a value is out of bounds; NaN included.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256: "moving average of 12 values".
    Schoenberg, Quart. Appl. Math. 4 (1946) 45: a smoothing formula never amplifies.
    """

    kind: str = "moving_average"
    points: int = 12
    spacing: float = float(np.deg2rad(5.0))
    width: float = float(np.deg2rad(60.0))
    harmonics: float = 12.0
    taper: float = 0.25
    degree: int = 2
    strength: float = 1.0

    def __post_init__(self) -> None:
        rules = (
            ("kind", self.kind in KINDS, "one of " + ", ".join(KINDS)),
            ("points", self.points >= 1, ">= 1"),
            ("spacing", 0 < self.spacing * self.points <= CYCLE, "> 0 rad, within one cycle"),
            ("width", 0 < self.width <= CYCLE, "> 0 rad, within one cycle"),
            ("harmonics", 1 <= self.harmonics < np.inf, ">= 1"),
            ("taper", 0 <= self.taper < 1, "0 to 1"),
            ("degree", self.kind != "savitzky_golay" or self._fits(), ">= 0, below the points"),
            ("strength", 0 < self.strength < np.inf, "> 0"),
        )
        for name, holds, limit in rules:
            if not holds:
                raise InputError(f"smoothing.{name}", getattr(self, name), limit)

    @classmethod
    def from_case(cls, smoothing: Any) -> Smoother:
        """The smoother a case asks for; what the case leaves out keeps its default."""
        names = ("kind", "points", "spacing", "width", "harmonics", "taper", "degree")
        given = {name: getattr(smoothing, name, None) for name in names}
        return cls(**{name: value for name, value in given.items() if value is not None})

    def _fits(self) -> bool:
        return 0 <= self.degree < 2 * (self.points // 2) + 1

    def stretched(self, strength: float) -> Smoother:
        """The same smoother at another strength."""
        return replace(self, strength=float(strength))

    @property
    def angular_width(self) -> float:
        """Crank angle (rad) over which the torque is spread; `width_in_words` says how meant."""
        widths = {
            "none": 0.0,
            "moving_average": self.points * self.spacing,
            "gaussian": self.width,
            "harmonic": CYCLE / self.harmonics,
            "savitzky_golay": 2 * (self.points // 2) * self.spacing,
        }
        return float(widths[self.kind] * self.strength)

    @property
    def width_in_words(self) -> str:
        """What the filter does and what its angular width stands for."""
        degrees = np.rad2deg(self.angular_width)
        spacing = np.rad2deg(self.spacing * self.strength)
        words = {
            "none": "no smoothing",
            "moving_average": f"centred moving average of {self.points} values "
            f"{spacing:.4g} deg apart: a window of {degrees:.4g} deg of crank",
            "gaussian": f"gaussian with the variance of a window of {degrees:.4g} deg of crank",
            "harmonic": f"harmonics of the cycle up to {self.harmonics / self.strength:.4g}: "
            f"the last one kept is {degrees:.4g} deg of crank long",
            "savitzky_golay": f"Savitzky-Golay fit of degree {self.degree} to "
            f"{2 * (self.points // 2) + 1} values {spacing:.4g} deg apart: "
            f"a window of {degrees:.4g} deg of crank",
        }
        return words[self.kind]

    def transfer(self, harmonic: ArrayLike) -> Array:
        """Factor on each harmonic of the cycle, real, within -1 and 1, and 1 at zero.

        Parameters
        ----------
        harmonic : array (...)   order, 1 is once in two crank turns
        """
        order = np.abs(np.asarray(harmonic, dtype=float)) * self.strength
        return _TRANSFER[self.kind](self, order)


def smoothed(torque: ArrayLike, smoother: Smoother) -> Array:
    """Torque after smoothing, on the same angles.

    Parameters
    ----------
    torque : array (..., n)   uniform over one engine cycle, the end left out, N m
    smoother : Smoother

    Returns
    -------
    array (..., n)   N m, read-only; the mean is kept exactly

    Raises
    ------
    InputError
        If a value is not finite.
    """
    values = finite("torque", torque)
    if smoother.kind == "none":
        return values
    count = values.shape[-1]
    spectrum = np.fft.rfft(values, axis=-1)
    spectrum *= smoother.transfer(np.arange(spectrum.shape[-1]))
    return readonly(np.fft.irfft(spectrum, n=count, axis=-1))


def _sample_phase(smoother: Smoother, order: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Phase of a harmonic from one point to the next, and whether the points resolve it.

    What the points cannot resolve is removed: the papers' average acts on samples, and samples
    carry nothing above half their own rate.
    """
    phase = order * (2.0 * np.pi / CYCLE) * smoother.spacing
    return phase, phase <= np.pi * (1.0 + 1e-12)


def _moving_average(smoother: Smoother, order: Array) -> Array:
    phase, resolved = _sample_phase(smoother, order)
    reach = smoother.points // 2
    weights = np.full(reach + 1, 2.0 / smoother.points)
    weights[0] /= 2.0
    if smoother.points % 2 == 0:
        weights[-1] /= 2.0  # an even count is centred by two half values at its ends
    return np.where(resolved, _cosine_sum(weights, phase), 0.0)


def _savitzky_golay(smoother: Smoother, order: Array) -> Array:
    phase, resolved = _sample_phase(smoother, order)
    reach = smoother.points // 2
    weights = savgol_coeffs(2 * reach + 1, smoother.degree)[reach:].copy()
    weights[1:] *= 2.0
    return np.where(resolved, _cosine_sum(weights / weights.sum(), phase), 0.0)


def _gaussian(smoother: Smoother, order: Array) -> Array:
    variance = smoother.width**2 / 12.0  # that of a box of this width
    return np.exp(-0.5 * variance * (order * 2.0 * np.pi / CYCLE) ** 2)


def _harmonic(smoother: Smoother, order: Array) -> Array:
    share = order / smoother.harmonics
    if smoother.taper == 0:
        return np.where(share <= 1.0 + 1e-12, 1.0, 0.0)
    edge = np.clip((share - 1.0) / smoother.taper, -1.0, 1.0)
    return 0.5 * (1.0 - np.sin(0.5 * np.pi * edge))


def _none(_smoother: Smoother, order: Array) -> Array:
    return np.ones_like(order)


def _cosine_sum(weights: Array, phase: Array) -> Array:
    return np.cos(phase[..., None] * np.arange(len(weights))) @ weights


_TRANSFER: dict[str, Callable[[Smoother, Array], Array]] = {
    "none": _none,
    "moving_average": _moving_average,
    "gaussian": _gaussian,
    "harmonic": _harmonic,
    "savitzky_golay": _savitzky_golay,
}

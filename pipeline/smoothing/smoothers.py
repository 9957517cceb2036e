"""Zero-phase filters of a machine torque, by the harmonics of its cycle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NoReturn

import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.period import FOUR_STROKE, Period

if TYPE_CHECKING:
    from camwright.pipeline.case.requirements_section import Smoothing

KINDS = ("none", "moving_average", "gaussian", "harmonic", "savitzky_golay", "smoothing_spline")


@dataclass(frozen=True)
class Smoother:
    """Linear zero-phase filter of a periodic torque with adjustable strength.

    `strength` stretches the filter along the shaft angle: at 2 a moving average of 60 deg
    becomes one of 120 deg, a cut-off at harmonic 24 one at harmonic 12. The filter acts on the
    harmonics of the cycle, not on samples, and is continuous in the strength; the moving average
    of an odd count alone has steps, of 1/points, in a harmonic at the spacing of its points.

    Parameters
    ----------
    kind : str          one of `KINDS`
    points : int        moving average, Savitzky-Golay: values averaged
    spacing : float     moving average, Savitzky-Golay: shaft angle between values, rad
    width : float       gaussian: width, rad of the shaft, of the box of equal variance
    harmonics : float   harmonic: cut-off harmonic of the cycle
    taper : float       harmonic: half-width of the cosine edge over the cut-off; 0: sharp
    degree : int        Savitzky-Golay: degree of the fitted polynomial
    cutoff : float      smoothing spline: wavelength, rad of the shaft, of the transfer factor 1/2
    strength : float    1: as in the case; above 1 wider
    period : Period     cycle of the torque, and cycles in a cam turn

    Raises
    ------
    InputError
        If the kind is unknown or a value is out of bounds; NaN included.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256: "moving average of 12 values".
    Schoenberg, Quart. Appl. Math. 4 (1946) 45: a smoothing formula never amplifies.
    Craven and Wahba, Numer. Math. 31 (1979) 377: a periodic smoothing spline as a filter.
    """

    kind: str = "moving_average"
    points: int = 12
    spacing: float = float(np.deg2rad(5.0))
    width: float = float(np.deg2rad(60.0))
    harmonics: float = 12.0
    taper: float = 0.25
    degree: int = 2
    cutoff: float = float(np.deg2rad(120.0))
    strength: float = 1.0
    period: Period = FOUR_STROKE

    def __post_init__(self) -> None:
        cycle = self.period.angle
        rules = (
            ("kind", self.kind in KINDS, "one of " + ", ".join(KINDS)),
            ("points", self.points >= 1, ">= 1"),
            ("spacing", 0 < self.spacing * self.points <= cycle, "> 0 rad, within one cycle"),
            ("width", 0 < self.width <= cycle, "> 0 rad, within one cycle"),
            ("harmonics", 1 <= self.harmonics < np.inf, ">= 1"),
            ("taper", 0 <= self.taper < 1, "0 to 1"),
            ("degree", 0 <= self.degree <= 20, "0 to 20"),
            ("cutoff", 0 < self.cutoff <= cycle, "> 0 rad, within one cycle"),
            ("strength", 0 < self.strength < np.inf, "> 0"),
        )
        for name, holds, limit in rules:
            if not holds:
                raise InputError(f"smoothing.{name}", getattr(self, name), limit)

    @classmethod
    def from_case(cls, smoothing: Smoothing, period: Period) -> Smoother:
        """Smoother of a case, for the period of its machine."""
        names = ("kind", "points", "spacing", "width", "harmonics", "taper", "degree", "cutoff")
        return cls(**{name: getattr(smoothing, name) for name in names}, period=period)

    def stretched(self, strength: float) -> Smoother:
        """Smoother at another strength."""
        return replace(self, strength=float(strength))

    @property
    def angular_width(self) -> float:
        """Width of the filter, rad of the shaft, by kind as `width_in_words` states."""
        widths = {
            "none": 0.0,
            "moving_average": self.points * self.spacing,
            "gaussian": self.width,
            "harmonic": self.period.angle / self.harmonics,
            "savitzky_golay": self.points * self.spacing,
            "smoothing_spline": self.cutoff,
        }
        return float(widths[self.kind] * self.strength)

    def refuse_as_too_wide(self) -> NoReturn:
        """Refuse a smoother that leaves no torque; the message names the key to narrow it."""
        key, value, sense = {
            "gaussian": ("width", shown(self.width, "deg"), "smaller"),
            "harmonic": ("harmonics", f"{self.harmonics:.4g}", "greater"),
            "smoothing_spline": ("cutoff", shown(self.cutoff, "deg"), "smaller"),
        }.get(self.kind, ("points", str(self.points), "smaller"))
        limit = f"{sense}: {self.width_in_words} leaves no torque for the cam to balance"
        raise InputError(f"smoothing.{key}", value, limit)

    @property
    def curvature_weight(self) -> float:
        """w of the smoothing spline, rad^4, which minimises (T - T_0)^2 + w T''^2."""
        return (self.cutoff * self.strength / (2.0 * np.pi)) ** 4

    @property
    def width_in_words(self) -> str:
        """Filter and angular width in words."""
        degrees = np.rad2deg(self.angular_width)
        spacing = np.rad2deg(self.spacing * self.strength)
        words = {
            "none": "no smoothing",
            "moving_average": f"centred moving average of {self.points} values "
            f"{spacing:.4g} deg apart: a window of {degrees:.4g} deg of the shaft",
            "gaussian": f"gaussian with the variance of a window of {degrees:.4g} deg of the shaft",
            "harmonic": f"harmonics of the cycle up to {self.harmonics / self.strength:.4g}: "
            f"the last one kept is {degrees:.4g} deg of the shaft long",
            "savitzky_golay": f"Savitzky-Golay fit of degree {self.degree}: "
            f"a window of {degrees:.4g} deg of the shaft",
            "smoothing_spline": f"smoothing spline of curvature weight {self.curvature_weight:.3g} "
            f"rad^4: a wave of {degrees:.4g} deg of the shaft is halved",
        }
        return words[self.kind]

    def transfer(self, harmonic: ArrayLike) -> Array:
        """Transfer factor of each harmonic of the cycle, real, from -1 to 1, and 1 at zero.

        Parameters
        ----------
        harmonic : array (...)   order, 1 is once in a cycle
        """
        order = np.abs(np.asarray(harmonic, dtype=float)) * self.strength
        return _TRANSFER[self.kind](self, order)


def smoothed(torque: ArrayLike, smoother: Smoother) -> Array:
    """Torque filtered at equal angles.

    Parameters
    ----------
    torque : array (..., n)   N m, equally spaced over a cam turn, the end excluded
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
    spectrum *= smoother.transfer(np.arange(spectrum.shape[-1]) / smoother.period.cycles)
    return readonly(np.fft.irfft(spectrum, n=count, axis=-1))


def _moving_average(smoother: Smoother, order: Array) -> Array:
    """Transfer factor of a centred moving average of `points` values by harmonic order of the cycle
    (...); 0 above half the rate of the values.
    """
    step = 2.0 * np.pi / smoother.period.angle
    phase = order * step * smoother.spacing  # from one point to the next
    reach = smoother.points // 2
    weights = np.full(reach + 1, 2.0 / smoother.points)
    weights[0] /= 2.0
    if smoother.points % 2 == 0:
        weights[-1] /= 2.0  # an even count is centred by two half values at its ends
    averaged = np.cos(phase[..., None] * np.arange(reach + 1)) @ weights
    # The averages of the papers act on samples, which have no waves above half their rate.
    return np.where(phase <= np.pi * (1.0 + 1e-12), averaged, 0.0)


def _savitzky_golay(smoother: Smoother, order: Array) -> Array:
    # Fit to a continuous window: a polynomial in the Legendre basis, at the middle.
    """Transfer factor of a Savitzky-Golay fit over a continuous window by harmonic order of the
    cycle.
    """
    step = 2.0 * np.pi / smoother.period.angle
    argument = 0.5 * smoother.points * smoother.spacing * order * step
    factor = np.zeros_like(order)
    for even in range(0, smoother.degree + 1, 2):
        middle = float(scipy.special.eval_legendre(even, 0.0)) * (-1.0) ** (even // 2)
        factor += (2 * even + 1) * middle * scipy.special.spherical_jn(even, argument)
    return factor


def _gaussian(smoother: Smoother, order: Array) -> Array:
    variance = smoother.width**2 / 12.0  # that of a box of this width
    return np.exp(-0.5 * variance * (order * 2.0 * np.pi / smoother.period.angle) ** 2)


def _harmonic(smoother: Smoother, order: Array) -> Array:
    """Transfer factor (...) of a low-pass filter by harmonic order of the cycle: 1 below and 0
    above the cut-off h = `harmonics`, with a cosine flank between h (1 - taper) and h (1 + taper).
    """
    share = order / smoother.harmonics
    if smoother.taper == 0:
        return np.where(share <= 1.0 + 1e-12, 1.0, 0.0)
    edge = np.clip((share - 1.0) / smoother.taper, -1.0, 1.0)
    return 0.5 * (1.0 - np.sin(0.5 * np.pi * edge))


def _smoothing_spline(smoother: Smoother, order: Array) -> Array:
    return 1.0 / (1.0 + (order * smoother.cutoff / smoother.period.angle) ** 4)


def _none(_smoother: Smoother, order: Array) -> Array:
    return np.ones_like(order)


_TRANSFER: dict[str, Callable[[Smoother, Array], Array]] = {
    "none": _none,
    "moving_average": _moving_average,
    "gaussian": _gaussian,
    "harmonic": _harmonic,
    "savitzky_golay": _savitzky_golay,
    "smoothing_spline": _smoothing_spline,
}

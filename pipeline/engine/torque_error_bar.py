"""Error bar of a torque derived from a measured speed: record noise to torque noise."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from camwright.geometry.arrays import Array, freeze

SIGNIFICANT = 6.0  # squared amplitude of a harmonic over its variance by noise
WEIGHT_MIN = 0.01  # of a harmonic whose amplitude without the filter is inferred
CUT_MARGIN = 1.3  # on what a filter cuts off: amplitudes beyond the last are extrapolated
FADING = (0.1, 0.85)  # bounds of the ratio of successive harmonics
CONFIDENCE = 0.95
"""Probability that the torque lies within its error bar at all crank angles at once."""


@dataclass(frozen=True, eq=False)
class SlopeNoise:
    """Propagation of observation noise to the slope domega/dtheta of one cycle.

    Parameters
    ----------
    gain : array (n,)    1/rad, standard deviation of the slope at equal crank angles of a cycle,
                         per unit of the noise of one observation
    path : float         length of the closed curve that the unit rows of the linear map describe
    dimensions : float   number of independent values in a slope over the cycle
    freedom : float      degrees of freedom of the noise that one cycle shows about its fit
    """

    gain: Array
    path: float
    dimensions: float
    freedom: float

    def __post_init__(self) -> None:
        freeze(self, gain=self.gain)

    @classmethod
    def of(cls, slope: Array, freedom: float) -> SlopeNoise:
        """Noise of the slope domega/dtheta from that of the observations.

        Parameters
        ----------
        slope : array (n, observations)   linear map from independent unit noises of the
                                          observations to the slope at n angles
        freedom : float                   degrees of freedom of the estimated noise
        """
        gain = np.sqrt((slope**2).sum(axis=1))
        unit = slope / gain[:, None]
        steps = np.diff(unit, axis=0, append=unit[:1])
        path = float(np.sqrt((steps**2).sum(axis=1)).sum())
        shared = float((unit.T @ unit).ravel() @ (unit.T @ unit).ravel())
        return cls(gain, path, gain.size**2 / shared, freedom)

    @property
    def mean_gain(self) -> float:
        """Root mean square of the gain over the cycle, 1/rad."""
        return float(np.sqrt((self.gain**2).mean()))

    @property
    def band(self) -> Array:
        """Half-width (n,) of the simultaneous band of the slope for a known unit noise."""
        return np.asarray(self._factor(np.inf) * self.gain)

    def half_width(self, slopes: Array, noise: float) -> Array:
        """Half-width (n,) of the simultaneous band about the mean slope, rad/s per rad.

        The scatter of several cycles, else the noise of the one cycle about its fit, shows the
        standard error; it follows the gain over the cycle.

        Parameters
        ----------
        slopes : array (m, n)   domega/dtheta of each cycle, rad/s per rad
        noise : float           of one observation, in the unit of the gain
        """
        count = slopes.shape[0]
        if count == 1:
            return self._factor(self.freedom) * noise * self.gain
        scatter = ((slopes - slopes.mean(axis=0)) / self.gain) ** 2
        error = np.sqrt(scatter.mean(axis=1).sum() / (count - 1) / count)
        return np.asarray(self._factor((count - 1) * self.dimensions) * error * self.gain)

    def _factor(self, freedom: float) -> float:
        """Half-width, over the standard error, of a band that holds a whole closed curve at 95 %.

        Parameters
        ----------
        freedom : float   degrees of freedom of the estimated noise; infinite: known noise

        References
        ----------
        Sun and Loader, Annals of Statistics 22 (1994) 1328, eq. 3.1, t instead of normal; the curve
        is closed, so the term of its ends is absent.
        """
        share = pi * (1.0 - CONFIDENCE) / self.path
        if np.isinf(freedom):
            return float(np.sqrt(-2.0 * np.log(min(share, 1.0))))
        return float(np.sqrt(freedom * (min(share, 1.0) ** (-2.0 / freedom) - 1.0)))


def cut_off(speeds: Array, weights: Array, inertia: float, noise_floor: float) -> float:
    """Estimated greatest torque above the filter of a speed, N m.

    Parameters
    ----------
    speeds : array (m, n)       rad/s at equal crank angles, filtered, of each cycle
    weights : array (last + 1,) factors of the filter on harmonics from 0
    inertia : float             kg m2
    noise_floor : float         N m, standard deviation of the mean torque; used for one cycle
    """
    orders = np.flatnonzero(weights > WEIGHT_MIN)[1:]
    slowness = 2.0 / speeds.shape[1] * np.fft.rfft(1.0 / speeds, axis=1)[:, orders]
    # J omega domega/dtheta for a small ripple; the cycle is two turns.
    waves = inertia * speeds.mean() ** 3 * 0.5 * orders * slowness / weights[orders]
    # The noise of a slope rises with the order: that of all orders shows in few cycles.
    if speeds.shape[0] > 1:
        scatter = (waves / orders).var(axis=0, ddof=1).mean() / speeds.shape[0]
    else:
        scatter = 2.0 * noise_floor**2 / (orders**2 * weights[orders] ** 2).sum()
    return _beyond(np.abs(waves.mean(axis=0)), weights[orders], scatter * orders**2)


def _beyond(spectra: Array, weights: Array, noise: Array) -> float:
    """Greatest amplitude that the harmonics above a filter would add to a curve over the cycle, in
    its unit.

    Harmonics that stand out of the noise are known. Beyond the last of them, amplitudes are taken
    to fall by the ratio by which they fall from the greatest one on, at least so fast that the
    noise hides the next.

    Parameters
    ----------
    spectra : array (last,)      amplitudes of harmonics 1 to `last` without the filter
    weights : array (last,)      factors of the filter on them
    noise : array (last,)        variance of the amplitudes
    """
    order = np.arange(1, spectra.size + 1)
    clear = spectra**2 > SIGNIFICANT * noise
    hidden = ~(clear | np.append(clear[1:], False))
    highest = int(hidden.argmax()) if hidden.any() else spectra.size  # the next two are hidden
    if highest == 0:
        return 0.0
    unseen = np.sqrt(SIGNIFICANT * noise)
    seen = np.where(clear & (order <= highest), spectra, 0.0)
    falling = order[(seen > 0.0) & (order > seen.argmax())]
    ratio = FADING[1]
    if falling.size > 1:
        ratio = float(np.exp(np.polyfit(falling, np.log(spectra[falling - 1]), 1)[0]))
    centre = float(np.log(spectra[falling - 1]).mean())
    level = float(np.exp(centre + (highest - falling.mean()) * np.log(ratio)))
    if highest + 1 < spectra.size:
        ratio = min(ratio, float(np.sqrt(unseen[highest + 1] / level)))  # the second is hidden
    ratio = float(np.clip(ratio, *FADING))
    tail = level * ratio ** (order - highest)
    cut = np.where(order > highest, np.minimum(tail, unseen), np.where(clear, spectra, 0.0))
    beyond = tail[-1] * ratio / (1.0 - ratio)
    return float(CUT_MARGIN * (((1.0 - weights) * cut).sum() + beyond))

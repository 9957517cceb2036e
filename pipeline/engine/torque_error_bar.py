"""Error bar of a torque that is the slope of a measured speed: noise of the record to torque."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from camwright.geometry.arrays import Array, freeze

CONFIDENCE = 0.95
"""Probability that the torque lies within its error bar at all crank angles at once."""


@dataclass(frozen=True, eq=False)
class SlopeNoise:
    """How the noise of single observations passes to the slope domega/dtheta of one cycle.

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
        """That of a linear map (n, observations) whose observations have independent noise."""
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
        """Half-width (n,) of the band that holds the true slope if the noise is known to be 1."""
        return np.asarray(self._factor(np.inf) * self.gain)

    def half_width(self, slopes: Array, noise: float) -> Array:
        """Half-width (n,) of the band about the mean slope that holds the true one, rad/s per rad.

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
        """Standard errors in the half-width of a band that holds a whole closed curve.

        References
        ----------
        Sun and Loader, Annals of Statistics 22 (1994) 1328, eq. 3.1, t instead of normal; the
        curve is closed, so the term of its ends is absent.
        """
        share = pi * (1.0 - CONFIDENCE) / self.path
        if np.isinf(freedom):
            return float(np.sqrt(-2.0 * np.log(min(share, 1.0))))
        return float(np.sqrt(freedom * (min(share, 1.0) ** (-2.0 / freedom) - 1.0)))

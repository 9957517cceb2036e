"""Preload of conjugate discs: both rollers pressed by an interference on their compliances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.second_track import SecondTrack, Touch
from camwright.geometry.track_deviation import EXACT, TrackDeviation
from camwright.pipeline.base import units


class Squeezed(NamedTuple):
    """Axial forces of both tracks at the first roller by their difference x, the axial force.

    The first bears P + b x and the second P - (1 - b) x while both are pressed, else one bears
    all.

    Parameters
    ----------
    preload : array (n,)   P, N, > 0
    share : float          b, of the axial force that the first bears
    """

    preload: Array
    share: Value

    def forces(self, axial: Array) -> tuple[Array, Array]:
        """Forces (n,) of the first and of the second track at axial forces (n,), N, >= 0."""
        first = self.preload + self.share * axial
        second = self.preload - (1.0 - self.share) * axial
        pushed, pulled = second < 0.0, first < 0.0
        first = np.where(pushed, axial, np.where(pulled, 0.0, first))
        second = np.where(pulled, -axial, np.where(pushed, 0.0, second))
        return first, second

    def both(self, axial: Array) -> Array:
        """Whether both tracks are pressed at axial forces (n,), N; bool (n,)."""
        first, second = self.forces(axial)
        return np.asarray((first > 0.0) & (second > 0.0))


def squeezed(interference: Value, compliance: Value, touch: Touch, leverage: Value) -> Squeezed:
    """Preload (...) of an interference, m, on the compliance of each roller, m/N.

    touch : Touch      of the second track
    leverage : float   force along the travel of the second over that of the first roller
    """
    closed = interference / (touch.slide.lever * np.cos(touch.pressure_angle))
    first, second = compliance, compliance * leverage**2
    return Squeezed(closed / (first + second), second / (first + second))


@dataclass(frozen=True)
class DiscPreload:
    """Interference of a pair of discs with its rollers.

    Parameters
    ----------
    interference : float   square to the second disc, m, > 0
    compliance : float     of each roller with its arm, from disc to follower mass, along the travel
                           of that roller, m/N, > 0
    deviation : TrackDeviation   that opens or closes the interference
    """

    interference: float
    compliance: float
    deviation: TrackDeviation = EXACT

    def at(self, track: SecondTrack, theta: Array) -> Squeezed:
        """Preload at cam angles (n,), rad, reduced to the first roller.

        The interference i opens i/(l_2/l_1 cos alpha_2) along the travel of the first roller; the
        compliance of the second is (l_1/l_2)^2 of its own there.

        Raises
        ------
        InputError
            If deviations leave no interference.
        """
        left = self.interference - self.deviation.on(track, theta)
        if not float(np.min(left)) > 0.0:
            shown = units.shown(float(np.min(left)), "mm")
            raise InputError("cam.conjugate.interference", shown, "> 0 mm at every angle")
        return squeezed(left, self.compliance, track.touch(theta), track.leverage)

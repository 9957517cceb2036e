"""Preload of conjugate discs: both rollers pressed by an interference on their compliances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

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
    preload : array (n,)          P, N, > 0
    share : float or array (n,)   b, of the axial force that the first bears
    stiffness : float or array (n,)   of both tracks together against the follower mass, along the
                                  travel of the first roller, N/m
    interference : float or array (n,)   that presses them, m
    """

    preload: Array
    share: Value
    stiffness: Value
    interference: Value

    @classmethod
    def joined(cls, every: Sequence[Squeezed]) -> Squeezed:
        """Preloads of several motions, one after another."""
        of_all = zip(*(np.broadcast_arrays(*each) for each in every), strict=True)
        return cls(*map(np.concatenate, of_all))

    def part(self, at: NDArray[np.intp]) -> Squeezed:
        """Preload at the positions of these numbers."""
        return Squeezed(*(each[at] for each in np.broadcast_arrays(*self)))

    def forces(self, axial: Array) -> tuple[Array, Array]:
        """Forces (n,) of the first and of the second track at axial forces (n,), N, >= 0."""
        first = self.preload + self.share * axial
        second = self.preload - (1.0 - self.share) * axial
        pushed, pulled = np.real(second) < 0.0, np.real(first) < 0.0
        first = np.where(pushed, axial, np.where(pulled, 0.0, first))
        second = np.where(pulled, -axial, np.where(pushed, 0.0, second))
        return first, second

    def both(self, axial: Array) -> Array:
        """Whether both tracks are pressed at axial forces (n,), N; bool (n,)."""
        first, second = self.forces(axial)
        return np.asarray((np.real(first) > 0.0) & (np.real(second) > 0.0))


class Pushing(Protocol):
    """Contact force of a track along and across the travel of the first roller, over the axial
    force there.
    """

    @property
    def pressing(self) -> Value: ...
    @property
    def side(self) -> Array: ...


class Compliances(NamedTuple):
    """Compliances of both rollers along the travel of each, m/N, > 0: from its disc to where the
    forces of both meet, the mass of arms, or the stem at the first roller.

    at_first, at_second: deflection of the camshaft at each disc per force there, m/N; between: at
    either per force at the other; 0 of a rigid shaft.
    """

    first: Value
    second: Value
    at_first: Value = 0.0
    between: Value = 0.0
    at_second: Value = 0.0


def squeezed(
    interference: Value, compliances: Compliances, first: Pushing, touch: Touch, leverage: Value
) -> Squeezed:
    """Preload (...) of an interference, m, on the compliances of both rollers.

    Both forces bend the camshaft: opposite ones bend it back, each at the disc of the other. NaN
    where one bends it there by more than the other roller and its disc yield under their own force:
    an axial force would press both.

    first : Pushing    of the first track
    touch : Touch      of the second track
    leverage : float   force along the travel of the second over that of the first roller
    """
    closed = interference / (touch.slide.lever * np.cos(touch.pressure_angle))
    second = touch.slide
    # the axial force is negative where the second track carries
    bent_back = -compliances.between * _product(first, second)
    near = compliances.first + compliances.at_first * _product(first, first) + bent_back
    far = compliances.second * leverage**2 + compliances.at_second * _product(second, second)
    far = far + bent_back
    both = near + far
    stiffness = both / (near * far - bent_back * both)
    apart = (np.real(np.asarray(near)) > 0.0) & (np.real(np.asarray(far)) > 0.0)
    preload = np.where(apart, closed / both, np.nan)
    return Squeezed(preload, far / both, stiffness, interference)


def _product(one: Pushing, other: Pushing) -> Value:
    """Scalar product of two contact forces over the axial force at the first roller."""
    return one.pressing * other.pressing + one.side * other.side


@dataclass(frozen=True)
class DiscPreload:
    """Interference of a pair of discs with its rollers.

    Parameters
    ----------
    interference : float   square to the second disc, m, > 0
    compliances : Compliances   of both rollers
    deviation : TrackDeviation   that opens or closes the interference
    """

    interference: float
    compliances: Compliances
    deviation: TrackDeviation = EXACT

    def left(self, track: SecondTrack, theta: Array) -> Array:
        """Interference (n,), m, that the deviations leave at cam angles (n,), rad."""
        return self.interference - self.deviation.on(track, theta)

    def at(self, track: SecondTrack, theta: Array) -> Squeezed:
        """Preload at cam angles (n,), rad, reduced to the first roller.

        The interference i opens i/(l_2/l_1 cos alpha_2) along the travel of the first roller; the
        compliance of the second is (l_1/l_2)^2 of its own there; see `squeezed`.

        Raises
        ------
        InputError
            If deviations leave no interference, or the camshaft bends too much, see `squeezed`.
        """
        left = self.left(track, theta)
        if not float(np.min(left)) > 0.0:
            shown = units.shown(float(np.min(left)), "mm")
            raise InputError("cam.conjugate.interference", shown, "> 0 mm at every angle")
        first = track.first.slide(theta, 0.0)
        squeeze = squeezed(left, self.compliances, first, track.touch(theta), track.leverage)
        if np.isnan(squeeze.preload).any():
            bent = "bent at one disc by the other more than by its own"
            raise InputError("camshaft", bent, "stiffer, or the discs nearer to a bearing")
        return squeeze

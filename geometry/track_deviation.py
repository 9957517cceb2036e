"""Deviations of a follower between two tracks from its drawing; change of the clearance by them.

The clearance is square to the second track, or to the outer wall of a groove, while the first
carries.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.measured_contour import Inspection
from camwright.geometry.second_track import SecondFollower, SecondTrack, Touch, touch_of


@dataclass(frozen=True)
class TrackDeviation:
    """Small deviations of tracks, rollers and their places.

    Parameters
    ----------
    tracks : float    of each track towards its roller or face, m
    rollers : float   of the radius of each roller, m
    second_roller : float  of the radius of the second roller beyond that of the first, m
    apart : float     of the second roller away from its disc, along its own travel, or of the
                      second face from the first, m
    centre : float    of the pivot of an arm away from the cam axis, m
    turn : float      of the second disc against the first, ahead, rad
    wear_depth : float depth that each track has lost with its roller or face, m
    """

    tracks: float = 0.0
    rollers: float = 0.0
    second_roller: float = 0.0
    apart: float = 0.0
    centre: float = 0.0
    turn: float = 0.0
    wear_depth: float = 0.0

    def worn(self, depth: float) -> Self:
        """The deviations with another wear, m."""
        return replace(self, wear_depth=depth)

    def beside(self, other: TrackDeviation) -> Self:
        """Sum with other deviations, of first order."""
        names = (each.name for each in fields(TrackDeviation))
        return replace(self, **{name: getattr(self, name) + getattr(other, name) for name in names})

    def opened(self, first: FollowerPath, second: SecondFollower | None, theta: Array) -> Array:
        """Change of the clearance (n,), m, at cam angles (n,), rad, to first order.

        A displacement x of the first roller along its travel is x cos(alpha_1) square to its track
        and x (l_2/l_1) cos(alpha_2) square to the second, so that what fills the first contact by n
        closes the second by n (l_2/l_1) cos(alpha_2)/cos(alpha_1).

        Parameters
        ----------
        first : FollowerPath      path of the first roller or face
        second : SecondFollower   the second one; None: a groove
        """
        if self == EXACT:
            return np.zeros(theta.shape)
        if second is None:
            one = np.ones(theta.shape)
            return np.asarray(-2.0 * self._filled * one - self._measured(theta, theta, one))
        return self.on(second.track(first), theta)

    def _measured(self, first: Array, second: Array, ratio: Array) -> Array:  # noqa: ARG002
        """By which measured tracks close the clearance (n,), m, at the cam angles of each (n,)."""
        return np.zeros(first.shape)

    @property
    def _filled(self) -> float:
        """By which each contact is filled, m."""
        return self.tracks + self.rollers - self.wear_depth

    def on(self, track: SecondTrack, theta: Array) -> Array:
        """Change of the clearance to a second track (n,), m, see `opened`."""
        first = track.first
        near, other = touch_of(first, theta), track.touch(theta)
        along = np.cos(near.pressure_angle), np.cos(other.pressure_angle)
        ratio = np.asarray(other.slide.lever * along[1] / along[0])
        rise = track.contour.lift.derivatives(theta + track.turn, 1)[1]
        travel = first.travel(theta)
        away = _from_the_axis(near, travel) * ratio + _from_the_axis(other, travel)
        displaced = self.apart - self.turn * rise
        opened = displaced * along[1] + self.centre * away - self._filled * (1.0 + ratio)
        opened = opened - self.second_roller
        return np.asarray(opened - self._measured(theta, theta + track.turn, ratio))


@dataclass(frozen=True)
class MeasuredTracks(TrackDeviation):
    """Deviations with the form of measured tracks, the other one as drawn.

    first, second : Inspection   of a track; None: it is not measured
    """

    first: Inspection | None = None
    second: Inspection | None = None

    def _measured(self, first: Array, second: Array, ratio: Array) -> Array:
        closed = np.zeros(first.shape)
        if self.first is not None:
            closed = closed + ratio * self.first.form(first)
        return closed if self.second is None else closed + self.second.form(second)


def _from_the_axis(touch: Touch, travel: Array) -> Array:
    """Cosine (n,) of the angle between the outward normal of a contact and u, the direction from
    the cam axis to the pivot; `travel` (n,) of the first roller, rad.
    """
    return np.asarray(np.cos(touch.pressure_angle - travel - touch.turned))


EXACT = TrackDeviation()
"""As drawn."""

"""Discs of a cam under the contacts of their own followers: place, force and torque over a turn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.pipeline.follower.follower_forces import Loads


class PressedDisc(NamedTuple):
    """Disc under its contacts at n cam angles of the first track.

    contour : of the disc; theta (n,) : cam angles of the contact on it, rad; force (n,) : contact
    force, N, >= 0; torque (n,) : that drives the disc, N m
    """

    contour: Contour
    theta: Array
    force: Array
    torque: Array


def pressed_discs(contour: Contour, loads: Loads) -> tuple[PressedDisc, ...]:
    """Each disc of a cam: one, or both of a conjugate pair.

    Both faces of a yoke press on the same disc. The force of the outer wall of a groove is taken as
    one of the same size on the inner wall.
    """
    force, second = np.maximum(loads.normal_force, 0.0), loads.second
    if second is None:
        return (PressedDisc(contour, loads.theta, force, loads.cam_torque),)
    track = second.track(contour.pitch)
    there = np.mod(loads.theta + track.turn, FULL_TURN)
    if not second.own_disc:
        at = np.where(loads.wall < 0.0, there, loads.theta)
        return (PressedDisc(contour, at, force, loads.cam_torque),)
    near, far = loads.track_forces
    return _rolled(contour, loads.theta, near), _rolled(track.contour, there, far)


def _rolled(contour: Contour, theta: Array, force: Array) -> PressedDisc:
    """Disc under a roller, whose force along its travel turns the disc by the slope of its lift."""
    along = force * np.cos(contour.pitch.pressure_angle(theta))
    return PressedDisc(contour, theta, force, along * contour.lift(theta, 1))

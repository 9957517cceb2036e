"""Forces and line contact of a translating flat-faced follower, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geometry.arrays import Array, finite, freeze, positive
from geometry.errors import ContactError, InputError
from geometry.flat_face import FlatFaceContour
from pipeline.contact import hertz
from pipeline.follower.forces import JAM_FLOOR, FollowerSystem


@dataclass(frozen=True, eq=False)
class FlatFaceLoads:
    """What acts on a flat-faced follower and on its contact; arrays (n,), SI.

    normal_force runs along the stem, `arm` off its axis; their moment presses the guides with
    `reaction`, at A and B alike and opposite. jam_index must stay below 1 on the rise. half_width
    and peak_pressure are those of Hertz; the relative radius is the contour's own.
    """

    theta: Array
    lift: Array
    arm: Array
    normal_force: Array
    reaction: Array
    jam_index: Array
    cam_torque: Array
    line_load: Array
    relative_radius: Array
    half_width: Array
    peak_pressure: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def face_needed(self) -> float:
        """Width of a centred face that carries the contact to its edges, m."""
        return float(2.0 * np.max(np.abs(self.arm) + self.half_width))


def flat_face_loads(
    contour: FlatFaceContour,
    system: FollowerSystem,
    cam_speed: float,
    theta: ArrayLike,
    contact_width: float,
    contact_modulus: float,
) -> FlatFaceLoads:
    """Forces and Hertz contact under a flat face, guide friction included.

    The push F at s' off the axis tilts the stem: the guides, b apart, answer with F s'/b each,
    and rub with (mu_A + mu_B) |F s'|/b against the motion. Friction on the face is left out; a
    follower that turns about its stem does away with most of it.

    Parameters
    ----------
    contour : FlatFaceContour
    system : FollowerSystem
    cam_speed : float           rad/s, >= 0
    theta : array (n,)          rad
    contact_width : float       along the line of contact, m, > 0
    contact_modulus : float     E*, Pa, > 0

    Raises
    ------
    ContactError
        If the contour is undercut: no surface carries the face there.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7; Johnson (1985), sec. 4.2(c).
    """
    angle = finite("theta", theta)
    if not 0.0 <= cam_speed < np.inf:
        raise InputError("cam_speed", cam_speed, ">= 0 rad/s")
    positive("cam.width", contact_width, "m")
    worst = contour.radius_of_curvature_min()
    if not worst.value > 0.0:
        where = float(np.degrees(worst.theta))
        raise ContactError(f"the cam of the flat face is undercut at {where:.3f} deg")
    lift, slope, bend = contour.pitch.lift.derivatives(angle, 2)
    demand = system.preload + system.spring_rate * lift + system.mass * bend * cam_speed**2
    demand = demand + system.mass * system.gravity_along_axis
    friction = (system.friction_a + system.friction_b) / system.guide_spacing
    jam_index = friction * np.abs(slope)
    share = np.maximum(1.0 - np.sign(slope) * jam_index, JAM_FLOOR)
    force = np.maximum(demand, 0.0) / share
    radius = contour.radius_of_curvature(angle)
    load = force / contact_width
    half_width, pressure = hertz.line_contact(load, radius, contact_modulus)
    return FlatFaceLoads(
        theta=angle,
        lift=lift,
        arm=slope,
        normal_force=force,
        reaction=force * slope / system.guide_spacing,
        jam_index=jam_index,
        cam_torque=force * slope,
        line_load=load,
        relative_radius=radius,
        half_width=half_width,
        peak_pressure=pressure,
    )

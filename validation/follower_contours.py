"""Cam contours of a roller and of flat faces for the same torque: figure 12 of Energies 18 (2025).

The lift follows from torque and spring alone, F_s s', so that every follower has the same lift; the
contour under it differs. Friction of guides and face, and inertia, come on top.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.limits import UNDERCUT_FACTOR
from camwright.pipeline.contact.hertz import contact_modulus, peak_pressure_square
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from validation.balancing_cam import (
    FOLLOWER_2025,
    POSITIONS,
    PRIME_RADIUS,
    RATIO,
)

ROLLER_RADIUS = 0.008  # of the paper, 625-2RS
FACE_FRICTION = 0.05  # assumed, oiled ground steel; the paper built the roller alone
WIDTH = 0.005  # of the contact, m: that of the roller
_MODULUS = contact_modulus(210e9, 0.3, 210e9, 0.3)
_FINE = 7200  # angles of the turn in the search of the least base radius


@dataclass(frozen=True, eq=False)
class FollowerContour:
    """Cam under one follower.

    Parameters
    ----------
    follower : str       in words
    points : array (2, n)   contour, m
    row : mapping        figures of the cam, names with units
    """

    follower: str
    points: Array
    row: dict[str, float | str | None]

    def __post_init__(self) -> None:
        freeze(self, points=self.points)


def follower_contours(
    lift: Lift, cam_speed: float, system: FollowerSystem = FOLLOWER_2025
) -> tuple[FollowerContour, ...]:
    """Contours for one lift: the paper's roller, a face on its radius, a face on the least radius.

    The least base radius of a face is that of the least undercut factor of `limits`.

    Parameters
    ----------
    lift : Lift
    cam_speed : float           rad/s
    system : FollowerSystem     of the roller; a face has friction on the cam besides
    """
    sliding = replace(system, face_friction=FACE_FRICTION)
    least = least_base_radius(lift)
    return (
        _cam("roller", RollerContour(PitchCurve(lift, PRIME_RADIUS), ROLLER_RADIUS),
             system, cam_speed),
        *(
            _cam(f"flat face, base radius {1e3 * radius:.1f} mm",
                 FlatFaceContour(FacePath(lift, radius)), sliding, cam_speed)
            for radius in (PRIME_RADIUS, least)
        ),
    )  # fmt: skip


def least_base_radius(lift: Lift, factor: float = UNDERCUT_FACTOR.default) -> float:
    """Least base radius of a flat face, m: (r + s + s'')/(r + s) >= factor at every angle."""
    s, _, lift_d2 = lift.derivatives(uniform_turn(_FINE), 2)
    return float(np.max(-lift_d2 / (1.0 - factor) - s))


def _cam(name: str, contour: Contour, system: FollowerSystem, cam_speed: float) -> FollowerContour:
    theta, pitch = uniform_turn(POSITIONS), contour.pitch
    loads = follower_loads(pitch, system, cam_speed, theta)
    factor = float(contour.undercut().factor)
    arm = float(np.abs(pitch.push_arm(theta)).max())
    points = contour.points(theta)
    curvature = contour.curvature(theta) + contour.follower_curvature
    pressure = None
    if factor > 0.0:  # else the contour has a cusp
        line_load = np.maximum(loads.normal_force, 0.0) / WIDTH
        pressure = float(np.sqrt(peak_pressure_square(line_load, curvature, _MODULUS).max()))
    spring = loads.spring_force * loads.lift_slope / RATIO
    row: dict[str, float | str | None] = {
        "follower": name,
        "base_radius_mm": 1e3 * (pitch.radius_base - (ROLLER_RADIUS if contour.rolls else 0.0)),
        "radius_max_mm": 1e3 * float(np.hypot(*points).max()),
        "undercut_factor_min": factor,
        "radius_of_curvature_min_mm": 1e3 * _least_convex(contour),
        "pressure_angle_max_deg": float(np.degrees(np.abs(pitch.pressure_angle(theta)).max())),
        "face_width_min_mm": None if contour.rolls else 2e3 * arm,
        "p0_max_MPa": None if pressure is None else 1e-6 * pressure,
        "guide_reaction_A_max_N": float(np.abs(loads.reaction_a).max()),
        "friction_loss_J": loads.friction_loss,
        "torque_std_of_spring_alone_Nm": float(spring.std()),
        "torque_std_delivered_Nm": float((loads.cam_torque / RATIO).std()),
    }
    return FollowerContour(name, points, row)


def _least_convex(contour: Contour) -> float:
    """Least radius of curvature of the convex contour, m; <= 0: undercut."""
    theta = uniform_turn(_FINE)
    if not contour.rolls:
        return float(contour.speed(theta).min())
    curvature = contour.curvature(theta)
    return float(1.0 / curvature.max())

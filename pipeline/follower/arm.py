"""Arm of an oscillating follower: dimensions, and the cam contour under its roller."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.quantities import Known, Length, Part, Resolved, TableSource
from camwright.pipeline.base.source import NO_SOURCE


@dataclass(frozen=True, kw_only=True)
class FollowerArm(Part):
    """Arm of an oscillating follower on a fixed pivot.

    The lift is the arc of its roller centre, and forces, masses and springs are those reduced to
    it: a moment about the pivot over the length, an inertia and an angular rate over its square.
    """

    table: ClassVar[str] = "follower.arm"
    resolved: ClassVar[Mapping[str, Resolved]] = {
        "start_angle": Resolved(
            "> 0, < 180 deg",
            "angle at the pivot from the line to the cam axis to the arm at zero lift, in place of"
            " `cam.prime_radius`, which follows from it",
            Known("drawing", "35 deg"),
        ),
        "inertia": Resolved(
            "> 0 kg m^2",
            "moment of inertia of all that swings about the pivot, in place of `follower.mass`,"
            " which follows from it",
            Known("drawing, or measured", "0.005 kg m^2"),
        ),
    }

    centre_distance: Annotated[Length, Known("drawing", "90 mm")]
    """distance of the pivot from the cam axis"""
    length: Annotated[Length, Known("drawing", "80 mm")]
    """distance of the roller centre from the pivot"""
    swing: Annotated[Literal["with", "against"], Known("drawing", "with")]
    """sense of the outward swing: with the rotation of the cam, or against it"""
    source: TableSource = NO_SOURCE

    @property
    def sense(self) -> float:
        """Sense of the outward swing: 1 with the rotation of the cam, -1 against it."""
        return 1.0 if self.swing == "with" else -1.0

    @property
    def linkage(self) -> Arm:
        """Geometry of the arm."""
        return Arm(self.centre_distance, self.length, self.sense)

    def angle(self, lift: Array, prime_radius: float) -> Array:
        """Angle at the pivot from the line to the cam axis to the arm (...), rad, at a lift, m."""
        return np.asarray(self.linkage.angle(prime_radius) + lift / self.length)

    def roller_contour(self, lift: Lift, prime_radius: float, roller_radius: float) -> Contour:
        """Cam contour under the roller of the arm.

        Raises
        ------
        InputError
            If the arm does not reach the prime circle, or swings past a line of centres.
        """
        arm = self.linkage
        path = ArmPath(lift, arm, float(arm.angle(prime_radius)))
        return ArmContour(path, roller_radius)

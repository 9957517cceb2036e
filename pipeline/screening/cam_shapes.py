"""Cam contour and its contact under a roller or a flat face, of many designs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.pitch_curve import speed_and_curvature
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import value_of
from camwright.pipeline.checks import demands

Columns = Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Values:
    """Values of the keys of m designs: of `columns`, each (m, 1), SI, else of the case."""

    case: Case
    columns: Columns
    count: int

    def __call__(self, key: str) -> Array:
        """Values of a key (m, 1), SI; NaN where the case leaves it out."""
        if key in self.columns:
            return self.columns[key]
        stated = value_of(self.case, key)
        return np.full((self.count, 1), np.nan if stated is None else float(stated))


@dataclass(frozen=True, eq=False)
class CamShape(ABC):
    """Shape of the cams of many designs; arrays (m, N), or (m, 1) where stated.

    jets: lift and two derivatives (3, m, N), m/rad^k; part: table of the follower in the case.
    """

    part: ClassVar[str]
    jets: Array
    value: Values

    @property
    @abstractmethod
    def base_height(self) -> Array:
        """Height of roller centre or face over the cam axis at zero lift (m, 1), m."""

    @property
    @abstractmethod
    def pressure_angle(self) -> Array:
        """Pressure angle, rad."""

    @property
    @abstractmethod
    def side(self) -> Array:
        """Side force on the stem over the axial force."""

    @property
    @abstractmethod
    def arm(self) -> Array:
        """Distance of the axial force from the stem axis, m."""

    @property
    @abstractmethod
    def pitch_speed(self) -> Array:
        """Path length of the reference point of the follower per cam angle, m/rad."""

    @property
    @abstractmethod
    def pitch_curvature(self) -> Array:
        """Curvature of that path, 1/m, positive where convex."""

    @property
    @abstractmethod
    def undercut_factor(self) -> Array:
        """Undercut factor: zero at a cusp."""

    @property
    @abstractmethod
    def contact_path(self) -> Array:
        """Length that the contact runs along the contour per cam angle, m/rad."""

    @property
    @abstractmethod
    def contour_radius(self) -> Array:
        """Distance of the contour from the cam axis, m."""

    @property
    @abstractmethod
    def relative_radius(self) -> Array:
        """Relative radius of cam and follower, m; not positive where undercut."""

    @property
    @abstractmethod
    def body_width(self) -> Array:
        """Length of the follower along the line of contact (m, 1), m."""

    @property
    @abstractmethod
    def extent(self) -> Array:
        """Extent of the follower towards guide A (m, 1), m."""

    @property
    def line_width(self) -> Array:
        """Flat width of the follower between its ends (m, 1), m."""
        return self.body_width - 2.0 * np.nan_to_num(self.value(f"{self.part}.end.size"))

    @cached_property
    def height(self) -> Array:
        """Height of roller centre or face over the cam axis, m."""
        return np.asarray(self.base_height + self.jets[0])

    @cached_property
    def least_factor(self) -> Array:
        """Minimum undercut factor (m,)."""
        return sampled_least(self.undercut_factor)

    @property
    def least_convex_radius(self) -> Array:
        """Minimum convex radius of the path of the reference point (m,), m."""
        return np.asarray(1.0 / sampled_greatest(self.pitch_curvature))


@dataclass(frozen=True, eq=False)
class RollerShape(CamShape):
    """Under rollers: the reference point is the roller centre."""

    part = "roller"

    @property
    def base_height(self) -> Array:
        return np.sqrt(self.value("cam.prime_radius") ** 2 - self.value("cam.offset") ** 2)

    @cached_property
    def along(self) -> Array:
        """Velocity of the roller centre along the follower axis, m/rad."""
        return np.asarray(self.jets[1] - self.value("cam.offset"))

    @cached_property
    def pressure_angle(self) -> Array:
        return np.asarray(np.arctan2(self.along, self.height))

    @property
    def side(self) -> Array:
        return np.tan(self.pressure_angle)

    @property
    def arm(self) -> Array:
        return np.zeros(self.jets.shape[1:])

    @cached_property
    def _path(self) -> tuple[Array, Array]:
        return speed_and_curvature(self.along, self.height, self.jets[1], self.jets[2])

    @property
    def pitch_speed(self) -> Array:
        return self._path[0]

    @property
    def pitch_curvature(self) -> Array:
        return self._path[1]

    @cached_property
    def undercut_factor(self) -> Array:
        return np.asarray(1.0 - self.value("roller.radius") * self.pitch_curvature)

    @property
    def contact_path(self) -> Array:
        return self.pitch_speed * self.undercut_factor

    @cached_property
    def contour_radius(self) -> Array:
        inset = self.value("roller.radius") / self.pitch_speed
        return demands.contour_radius(self.along, self.height, self.value("cam.offset"), inset)

    @property
    def relative_radius(self) -> Array:
        """From 1/R = 1/r + kappa/(1 - r kappa) of roller and contour."""
        return np.asarray(self.value("roller.radius") * self.undercut_factor)

    @property
    def body_width(self) -> Array:
        return self.value("roller.width")

    @property
    def extent(self) -> Array:
        return self.value("roller.radius")


@dataclass(frozen=True, eq=False)
class FaceShape(CamShape):
    """Under flat faces: the reference point is the contact; see `FlatFaceContour`."""

    part = "follower.face"

    @property
    def base_height(self) -> Array:
        return self.value("cam.prime_radius")

    @cached_property
    def pressure_angle(self) -> Array:
        return np.zeros(self.jets.shape[1:])

    @cached_property
    def side(self) -> Array:
        friction = np.nan_to_num(self.value("follower.face.friction"))
        return np.broadcast_to(friction, self.jets.shape[1:])

    @cached_property
    def arm(self) -> Array:
        return np.asarray(self.jets[1] - self.value("cam.offset"))

    @cached_property
    def relative_radius(self) -> Array:
        """Radius of curvature of the contour, r + s + s''."""
        return np.asarray(self.height + self.jets[2])

    @property
    def pitch_speed(self) -> Array:
        return np.abs(self.relative_radius)

    @property
    def pitch_curvature(self) -> Array:
        radius = self.relative_radius
        return np.divide(1.0, radius, out=np.full_like(radius, np.inf), where=radius != 0.0)

    @cached_property
    def undercut_factor(self) -> Array:
        return np.asarray(self.relative_radius / self.height)

    @property
    def contact_path(self) -> Array:
        return self.relative_radius

    @cached_property
    def contour_radius(self) -> Array:
        return np.hypot(self.height, self.jets[1])

    @property
    def body_width(self) -> Array:
        return self.value("follower.face.depth")

    @property
    def extent(self) -> Array:
        return self.value("follower.face.thickness")

    @cached_property
    def face_width(self) -> Array:
        """Minimum width 2 max|s' - e| of a face centred on the stem (m,), m."""
        return 2.0 * np.maximum(sampled_greatest(self.arm), -sampled_least(self.arm))

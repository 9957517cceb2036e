"""Slider-crank, with or without an offset of its line of travel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError


@dataclass(frozen=True)
class SliderCrank:
    """Crank, connecting rod and slider.

    At crank angle 0 the crank lies along the slider's line. With an offset the dead centres are
    near 0 and pi, and the stroke exceeds two crank radii.

    Parameters
    ----------
    crank_radius : float    r, m, > 0
    rod_length : float      l, m, > r + |offset|
    offset : float          e, m, of the slider's line from the crank axis, positive on the side
                            to which the crank pin moves from angle 0

    Raises
    ------
    InputError
        If the linkage cannot rotate fully.
    """

    crank_radius: float
    rod_length: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a linkage that cannot rotate fully."""
        if not 0 < self.crank_radius < np.inf:
            raise InputError("crank_radius", self.crank_radius, "> 0 m")
        if not abs(self.offset) < np.inf:
            raise InputError("pin_offset", self.offset, "finite")
        least = self.crank_radius + abs(self.offset)
        if not least < self.rod_length < np.inf:
            raise InputError("rod_length", self.rod_length, f"> {least:g} m for a full rotation")

    @property
    def top(self) -> float:
        """Maximum distance of the slider from the crank axis, m."""
        return float(np.sqrt((self.rod_length + self.crank_radius) ** 2 - self.offset**2))

    @property
    def bottom(self) -> float:
        """Minimum distance of the slider from the crank axis, m."""
        return float(np.sqrt((self.rod_length - self.crank_radius) ** 2 - self.offset**2))

    @property
    def top_angle(self) -> float:
        """Crank angle of the maximum distance, rad; 0 without an offset."""
        return float(np.arcsin(self.offset / (self.rod_length + self.crank_radius)))

    @property
    def bottom_angle(self) -> float:
        """Crank angle of the minimum distance, rad; pi without an offset."""
        return float(np.pi + np.arcsin(self.offset / (self.rod_length - self.crank_radius)))

    @property
    def stroke(self) -> float:
        """Maximum less minimum distance of the slider, m."""
        return self.top - self.bottom

    def travel(self, theta: ArrayLike) -> Array:
        """Distance of the slider from its top dead centre, m, at crank angles (...), rad."""
        _, cos, _, along = self._rod(theta)
        return np.asarray(self.top - self.crank_radius * cos - along)

    def travel_rate(self, theta: ArrayLike) -> Array:
        """First derivative of the travel, m/rad."""
        sin, cos, across, along = self._rod(theta)
        r = self.crank_radius
        return np.asarray(r * sin + across * r * cos / along)

    def travel_acceleration(self, theta: ArrayLike) -> Array:
        """Second derivative of the travel by the crank angle (...), m/rad^2."""
        sin, cos, across, along = self._rod(theta)
        r = self.crank_radius
        rod_part = ((r * cos) ** 2 - across * r * sin) / along + (across * r * cos) ** 2 / along**3
        return np.asarray(r * cos + rod_part)

    def _rod(self, theta: ArrayLike) -> tuple[Array, ...]:
        """Sine and cosine of the crank angle, and components of the rod across and along the
        slider's line, m; each (...).
        """
        sin, cos = np.sin(theta), np.cos(theta)
        across = self.crank_radius * sin - self.offset
        return sin, cos, across, np.sqrt(self.rod_length**2 - across**2)

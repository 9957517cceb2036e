"""Axial shape of two bodies of finite length: ends, crown, distance along the contact line.

y is the axial coordinate from the middle of both bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.contact.elasticity.elastic_body import Elastic

EndKind = Literal["sharp", "chamfer", "radius"]

# Share of the half-width over half the length that a Johns-Gohar crown leaves at its end.
_JOHNS_GOHAR = 0.3033
# Scales of ISO/TS 16281 over the roller diameter, and the longest roller, in diameters, that is
# crowned over all of its length.
_ISO_SHORT, _ISO_LONG, _ISO_LENGTH = 0.00035, 0.0005, 2.5


@dataclass(frozen=True)
class BodyEnd:
    """Both ends of a body: a sharp edge, a chamfer of 45 deg or a radius of `size` (m).

    The radius is tangent to the flat and ends at the end face.
    """

    kind: EndKind = "sharp"
    size: float = 0.0

    def __post_init__(self) -> None:
        if self.kind == "sharp" and self.size != 0:
            raise InputError("end.size", self.size, "0 m at a sharp end")
        if self.kind != "sharp" and not 0 < self.size < np.inf:
            raise InputError("end.size", self.size, "> 0 m")

    def drop(self, beyond: Array) -> Array:
        """Distance (...), m, of the end from the flat at distances (...), m, beyond the flat."""
        reach = np.maximum(beyond, 0.0)
        if self.kind == "radius":
            inside = np.minimum(reach / self.size, 1.0)
            return np.asarray(self.size * (1.0 - np.sqrt(1.0 - inside**2)))
        return reach if self.kind == "chamfer" else np.zeros_like(reach)


@dataclass(frozen=True)
class FiniteBody:
    """Material, length (m; infinite: no ends), ends; depth (m) below which the body is held."""

    material: Elastic
    length: float
    end: BodyEnd
    depth: float

    def __post_init__(self) -> None:
        for name in ("length", "depth"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "> 0 m")
        if not self.flat_length > 0:
            raise InputError("end.size", self.end.size, f"< {self.length / 2:.4g} m, half a length")

    @property
    def flat_length(self) -> float:
        """Length without the ends, m."""
        return self.length - 2.0 * self.end.size


class Crown(Protocol):
    """Drop of the surface towards its ends."""

    def drop(self, y: Array) -> Array:
        """Drop (...), m, at axial coordinates (...), m, within the contact."""
        ...


@dataclass(frozen=True)
class Straight:
    """No crown."""

    def drop(self, y: Array) -> Array:
        """Zero drop (...)."""
        return np.zeros_like(y)


@dataclass(frozen=True)
class CircularCrown:
    """Arc of a radius, m."""

    radius: float

    def __post_init__(self) -> None:
        if not 0 < self.radius < np.inf:
            raise InputError("crown.radius", self.radius, "> 0 m")

    def drop(self, y: Array) -> Array:
        """Drop (...), m, of the arc."""
        if not np.abs(y).max() < self.radius:
            raise InputError("crown.radius", self.radius, "> half the length of the contact")
        share = y / self.radius
        return np.asarray(y * share / (1.0 + np.sqrt(1.0 - share**2)))


@dataclass(frozen=True)
class LogarithmicCrown:
    """Drop scale ln(1/(1 - share t^2)), t = (2|y| - straight)/(length - straight) >= 0.

    scale, length and straight part in m; a share of 1 drops without bound at the end.
    """

    scale: float
    length: float
    share: float = 1.0
    straight: float = 0.0

    def __post_init__(self) -> None:
        if not 0 < self.scale < self.length:
            raise InputError("crown.scale", self.scale, "> 0 m and less than the length")
        if not 0 < self.share <= 1:
            raise InputError("crown.share", self.share, "in (0, 1]")
        if not 0 <= self.straight < self.length < np.inf:
            raise InputError("crown.straight", self.straight, "in [0, length)")

    def drop(self, y: Array) -> Array:
        """Drop (...), m, of the logarithm."""
        t = np.maximum(2.0 * np.abs(y) - self.straight, 0.0) / (self.length - self.straight)
        return np.asarray(-self.scale * np.log1p(-self.share * np.minimum(t**2, 1.0 - 1e-12)))


@dataclass(frozen=True, eq=False)
class TabulatedCrown:
    """Drop at axial coordinates, both (k,), m, ascending, linear between them.

    A table that begins at y = 0 holds for both sides.
    """

    y: Array
    table: Array

    def __post_init__(self) -> None:
        freeze(self, y=finite("crown.y", self.y), table=finite("crown.drop", self.table))
        if self.y.ndim != 1 or self.y.shape != self.table.shape or self.y.size < 2:
            raise InputError("crown.y", self.y.size, "two or more rows of y and drop")
        if not (np.diff(self.y) > 0).all():
            raise InputError("crown.y", "not ascending", "ascending")
        deepest = float(np.abs(self.table).max())
        if not deepest < self.y[-1] - self.y[0]:
            raise InputError("crown.drop", deepest, "less than the range of y, m")

    def drop(self, y: Array) -> Array:
        """Drop (...), m, interpolated."""
        place = np.abs(y) if self.y[0] == 0 else y
        if not (self.y[0] <= place.min() and place.max() <= self.y[-1]):
            raise InputError("crown.y", float(self.y[-1]), "at least half the length of contact")
        return np.interp(place, self.y, self.table)


def lundberg(line_load: float, length: float, modulus: float) -> LogarithmicCrown:
    """Crown of uniform pressure of a line load (N/m) over a length (m); E* Pa.

    References
    ----------
    Lundberg, Forschung Ing. 10 (1939) 201: drop w/(pi E*) ln(1/(1 - (2y/l)^2)).
    """
    return LogarithmicCrown(line_load / (np.pi * modulus), length)


def johns_gohar(
    line_load: float, length: float, modulus: float, half_width: float
) -> LogarithmicCrown:
    """Lundberg's crown with a bounded drop at the end, half-width b (m) at the line load.

    References
    ----------
    Johns and Gohar, Tribol. Int. 14 (1981) 131: (2y/l)^2 times 1 - 0.3033 (2b/l): verify.
    """
    scale = line_load / (np.pi * modulus)
    return LogarithmicCrown(scale, length, share=1.0 - _JOHNS_GOHAR * 2.0 * half_width / length)


def iso16281(diameter: float, length: float) -> LogarithmicCrown:
    """Crown of a roller of a diameter and an effective length, m.

    References
    ----------
    ISO/TS 16281 (2008), reference geometry: 0.00035 D up to a length of 2.5 D; 0.0005 D beyond it,
    on 1.25 D at each end: verify.
    """
    straight = max(0.0, length - _ISO_LENGTH * diameter)
    scale = _ISO_LONG if straight > 0 else _ISO_SHORT
    return LogarithmicCrown(scale * diameter, length, straight=straight)


@dataclass(frozen=True, eq=False)
class FinitePair:
    """Two bodies of finite length, their curvature 1/R1 + 1/R2 (1/m) and the crown of the gap."""

    bodies: tuple[FiniteBody, FiniteBody]
    curvature: float
    crown: Crown

    def __post_init__(self) -> None:
        if not 0 < self.curvature < np.inf:
            raise InputError("curvature", self.curvature, "> 0 1/m")

    @property
    def contact_length(self) -> float:
        """Length on which both bodies are without ends, m."""
        return min(body.flat_length for body in self.bodies)

    @property
    def contact_modulus(self) -> float:
        """E*, Pa."""
        return 1.0 / sum(1.0 / body.material.plane_strain_modulus for body in self.bodies)

    @property
    def has_singular_end(self) -> bool:
        """Whether a corner ends the contact, so that the pressure there depends on the mesh."""
        return not any(
            body.end.kind == "radius" and body.flat_length == self.contact_length
            for body in self.bodies
        )

    def gap(self, x: Array, y: Array) -> Array:
        """Distance (...), m, of the undeformed surfaces at x and y (...), m; circles as parabolas.

        The parabola of the circles is that of Hertz.
        """
        apart = 0.5 * self.curvature * x**2 + self.crown.drop(y)
        for body in self.bodies:
            apart = apart + body.end.drop(np.abs(y) - 0.5 * body.flat_length)
        return np.asarray(apart)

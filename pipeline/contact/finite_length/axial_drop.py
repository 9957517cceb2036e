"""Axial profile of two bodies of finite length: ends, crown, drop along the contact line.

y is the axial coordinate from the middle of both bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.elasticity.elastic_body import Elastic

# Half of the distance over which the slope of a crown is taken, m.
_SLOPE_STEP = 1e-6
# Places at which the halves of a gap are compared.
_HALVES = 101
# Share of the half-width over half the length that a Johns-Gohar crown leaves at its end.
_JOHNS_GOHAR = 0.3033
# Scales of ISO/TS 16281 over the roller diameter, and the longest roller, in diameters, that is
# crowned over all of its length.
_ISO_SHORT, _ISO_LONG, _ISO_LENGTH = 0.00035, 0.0005, 2.5


@dataclass(frozen=True)
class FiniteBody:
    """Body of finite length: material, length (m; infinite: no ends), ends, depth (m)."""

    material: Elastic
    length: float
    end: BodyEnd
    depth: float

    def __post_init__(self) -> None:
        """Refuse a length or depth, m, that is not positive, and ends that leave nothing between
        them.
        """
        for name in ("length", "depth"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "> 0 m")
        if not self.flat_length > 0:
            raise InputError("end.size", self.end.size, f"< {self.length / 2:.4g} m, half a length")

    @property
    def flat_length(self) -> float:
        """Length without the ends, m."""
        return flat_width(self.length, self.end)


class Crown(Protocol):
    """Interface of a crown: drop of the surface towards its ends."""

    def __hash__(self) -> int: ...

    def drop(self, y: Array) -> Array:
        """Drop (...), m, at axial coordinates (...), m, within the contact."""
        ...


@dataclass(frozen=True)
class Straight:
    """Crown of zero drop."""

    def drop(self, y: Array) -> Array:
        """Zero drop (...)."""
        return np.zeros_like(y)


@dataclass(frozen=True)
class CircularCrown:
    """Crown of a constant radius along the axis, m."""

    radius: float

    def __post_init__(self) -> None:
        if not 0 < self.radius < np.inf:
            raise InputError("crown.radius", self.radius, "> 0 m")

    def drop(self, y: Array) -> Array:
        """Drop (...), m, of the arc at axial coordinates y (...), m, from its middle.

        Raises
        ------
        InputError
            If a coordinate is beyond the radius.
        """
        if not np.abs(y).max() < self.radius:
            radius = units.shown(self.radius, "mm")
            raise InputError("crown.radius", radius, "> half the length of the contact")
        share = y / self.radius
        return np.asarray(y * share / (1.0 + np.sqrt(1.0 - share**2)))

    def is_stated(self, y: Array) -> NDArray[np.bool_]:
        """Whether the arc reaches axial coordinates (...), m."""
        return np.asarray(np.abs(y) < self.radius)


@dataclass(frozen=True)
class LogarithmicCrown:
    """Crown with drop scale ln(1/(1 - share t^2)), t = (2|y| - straight)/(length - straight).

    scale, length and straight part in m; a share of 1 drops without bound at the end.
    """

    scale: float
    length: float
    share: float = 1.0
    straight: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a scale, m, outside 0 to the length, a share outside 0 to 1, and a straight part
        that is not shorter than the length.
        """
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

    def is_stated(self, y: Array) -> NDArray[np.bool_]:
        """Whether the drop is bounded at axial coordinates (...), m."""
        return np.asarray((self.share < 1.0) | (2.0 * np.abs(y) < (1.0 - 1e-9) * self.length))


@dataclass(frozen=True, eq=False)
class TabulatedCrown:
    """Crown by a table: drop at ascending axial coordinates, both (k,), m, linear between.

    A table that begins at y = 0 holds for both sides.
    """

    y: Array
    table: Array

    def __post_init__(self) -> None:
        """Refuse fewer than two rows, coordinates y that do not ascend, and a drop, m, of the range
        of y or more.
        """
        freeze(self, y=finite("crown.y", self.y), table=finite("crown.drop", self.table))
        if self.y.ndim != 1 or self.y.shape != self.table.shape or self.y.size < 2:
            raise InputError("crown.y", self.y.size, "two or more rows of y and drop")
        if not (np.diff(self.y) > 0).all():
            raise InputError("crown.y", "not ascending", "ascending")
        deepest = float(np.abs(self.table).max())
        if not deepest < self.y[-1] - self.y[0]:
            raise InputError("crown.drop", deepest, "less than the range of y, m")

    @classmethod
    def read(cls, path: Path) -> TabulatedCrown:
        """Table of a CSV file with the columns y_mm and drop_um.

        Raises
        ------
        ResultError
            If the file cannot be read or lacks a column.
        InputError
            If y does not ascend, or a drop is out of bounds.
        """
        rows = read_table(path)
        for header in ("y_mm", "drop_um"):
            if header not in rows:
                raise ResultError(f"{path}: column {header} is missing")
        return cls(rows["y_mm"] * units.factor("mm"), rows["drop_um"] * units.factor("um"))

    def drop(self, y: Array) -> Array:
        """Drop (...), m, at axial coordinates y (...), m, interpolated linearly.

        Raises
        ------
        InputError
            If a coordinate is beyond the table.
        """
        if not self.is_stated(y).all():
            end = units.shown(float(self.y[-1]), "mm")
            raise InputError("crown.y", end, "at least half the length of contact")
        return np.interp(self._place(y), self.y, self.table)

    @property
    def is_symmetric(self) -> bool:
        """Whether the drop is alike on both sides of y = 0, as far as the table has both; to 1e-9
        of its greatest drop.
        """
        mirrored = np.interp(-self.y, self.y, self.table)
        within = np.abs(self.y) <= min(-self.y[0], self.y[-1])
        scale = 1e-9 * float(np.abs(self.table).max())
        return bool(self.y[0] == 0 or (np.abs(self.table - mirrored)[within] <= scale).all())

    def is_stated(self, y: Array) -> NDArray[np.bool_]:
        """Whether the table reaches axial coordinates (...), m."""
        place = self._place(y)
        return np.asarray((self.y[0] <= place) & (place <= self.y[-1]))

    def _place(self, y: Array) -> Array:
        return np.abs(y) if self.y[0] == 0 else y


def lundberg(line_load: float, length: float, modulus: float) -> LogarithmicCrown:
    """Lundberg's crown: uniform pressure at a line load (N/m) over a length (m); E* in Pa.

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
    """Crown of ISO 16281 for a roller of a diameter and an effective length, m.

    References
    ----------
    ISO/TS 16281 (2008), reference geometry: 0.00035 D up to a length of 2.5 D; 0.0005 D beyond it,
    on 1.25 D at each end: verify.
    """
    straight = max(0.0, length - _ISO_LENGTH * diameter)
    scale = _ISO_LONG if straight > 0 else _ISO_SHORT
    return LogarithmicCrown(scale * diameter, length, straight=straight)


@dataclass(frozen=True)
class CrownPlace:
    """Contact for which a crown of a case is laid out: length, curvature, E*, roller diameter.

    length: of the contact, m; curvature: at which its half-width counts, 1/m; modulus: E*, Pa;
    diameter: of the roller, m, None without one.
    """

    length: float
    curvature: float
    modulus: float
    diameter: float | None


BodyCrown = CircularCrown | LogarithmicCrown | TabulatedCrown
"""Crown of one body."""


def crown_of(shape: AxialCrown, place: CrownPlace, drops: TabulatedCrown | None) -> BodyCrown:
    """Crown of a body as a case states it, laid out for the contact of `place`.

    Parameters
    ----------
    drops : TabulatedCrown or None   table of the crown's file, of kind "table" alone

    Raises
    ------
    InputError
        If it does not fit the contact; it names the key within the crown.
    """
    length = shape.length or place.length
    if shape.kind == "circular" and shape.radius is not None:
        return CircularCrown(shape.radius)
    if shape.kind == "lundberg" and shape.line_load is not None:
        return lundberg(shape.line_load, length, place.modulus)
    if shape.kind == "johns_gohar" and shape.line_load is not None:
        half_width, _ = hertz.line_contact(shape.line_load, 1.0 / place.curvature, place.modulus)
        if not float(half_width) < length:
            raise InputError("crown.line_load", shape.line_load, "of less half-width than length")
        return johns_gohar(shape.line_load, length, place.modulus, float(half_width))
    if shape.kind == "iso16281":
        if place.diameter is None:
            raise InputError("crown.kind", shape.kind, "of a roller")
        return iso16281(place.diameter, place.length)
    if drops is None:
        raise InputError("crown.file", shape.file, "a file of y_mm and drop_um")
    return drops


@dataclass(frozen=True)
class SummedCrown:
    """Sum of the crowns of two bodies, each shifted by its middle from that of the contact, m.

    Crowns beside the middle count on both sides by their drop on one, -1 or 1, less the slope in
    the middle, to which the bodies align.
    """

    crowns: tuple[tuple[Crown, float], ...]
    side: int = 1

    def drop(self, y: Array) -> Array:
        """Drop (...), m, of all crowns together at axial coordinates y (...), m, from the middle of
        the contact.
        """
        total = np.zeros_like(y)
        for crown, middle in self.crowns:
            total = total + (self._beside(crown, middle, y) if middle else crown.drop(y))
        return np.asarray(total)

    def _beside(self, crown: Crown, middle: float, y: Array) -> Array:
        """Drop (...), m, at y (...), m, of a crown with its middle at `middle`, m, less its value
        and slope at y = 0; the drop on the side `side` of y = 0 counts on both.
        """
        before, level, after = crown.drop(np.array([-_SLOPE_STEP, 0.0, _SLOPE_STEP]) - middle)
        slope = (after - before) / (2.0 * _SLOPE_STEP)
        along = self.side * np.abs(y)
        return np.asarray(crown.drop(along - middle) - level - slope * along)


@dataclass(frozen=True, eq=False)
class FinitePair:
    """Two bodies of finite length with curvature 1/R1 + 1/R2 (1/m) and crown of the gap."""

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
        """Whether a sharp corner ends the contact: its pressure then depends on the mesh."""
        return not any(
            body.end.kind == "radius" and body.flat_length == self.contact_length
            for body in self.bodies
        )

    @property
    def is_symmetric(self) -> bool:
        """Whether both halves of the gap are alike."""
        y = 0.5 * self.contact_length * np.linspace(0.0, 1.0, _HALVES)
        drop, other = self.crown.drop(y), self.crown.drop(-y)
        return bool(np.allclose(drop, other, rtol=1e-9, atol=1e-9 * np.abs(drop).max()))

    def gap(self, x: Array, y: Array) -> Array:
        """Distance (...), m, of the undeformed surfaces at x across and y along the line (...), m:
        parabola of the relative curvature, as Hertz, and drops of crown and ends.
        """
        apart = 0.5 * self.curvature * x**2 + self.crown.drop(y)
        for body in self.bodies:
            apart = apart + body.end.drop(np.abs(y) - 0.5 * body.flat_length)
        return np.asarray(apart)

"""Bearing of a roller, and its outer ring, as a case states them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi, sin
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    Count,
    Force,
    In,
    Known,
    Length,
    Meaning,
    Part,
    Pressure,
    Resolved,
    TableSource,
    Temperature,
    Used,
    card_of,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown

Cleanliness = Literal[
    "extreme_cleanliness", "high_cleanliness", "normal_cleanliness", "slight_contamination",
    "typical_contamination", "severe_contamination", "very_severe_contamination",
]  # fmt: skip
"""Classes of contamination of ISO 281:2007, table 13."""
Lubrication = Literal["grease_for_life", "grease_relubricated", "oil"]
RadialLimit = Annotated[float, In("N", above=0, at_most=1e9)]
Hours = Annotated[float, In("h", above=0, at_most=1e6)]


DynamicRating = Annotated[Force, Meaning("dynamic rating")]
StaticRating = Annotated[Force, Meaning("static rating")]
BallCircle = Annotated[Length, Meaning("diameter of the circle of the ball centres")]


@dataclass(frozen=True, kw_only=True)
class OuterRing(Part):
    """Outer ring of a bearing as roller, supported by its balls."""

    table: ClassVar[str] = "roller.bearing.ring"

    outer_diameter: Annotated[Length, Known("bearing catalogue", "47 mm")]
    """outer diameter of the ring"""
    thickness: Annotated[Length, Known("bearing maker, or measured", "4 mm")]
    """thickness below the groove"""
    pitch_diameter: Annotated[BallCircle, Known("bearing maker", "30 mm")]
    balls: Annotated[int, Count(3, 100), Known("bearing maker, or counted", 9)]
    """balls per row"""
    rows: Annotated[int, Count(1, 4), Known("bearing catalogue")] = 1
    """rows of balls"""
    fatigue_bending: Annotated[Pressure | None, Known("card of bearing steel", "700 MPa")] = None
    """fatigue strength of the ring steel in bending"""
    tensile_strength: Annotated[Pressure | None, Known("card of bearing steel", "2000 MPa")] = None
    """tensile strength of the ring steel"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a ring without room for its balls, balls that overlap, and a thick ring."""
        super().__post_init__()
        if not self.ball_diameter > 0.0:
            least = self.outer_diameter - self.ball_diameter
            limit = (
                f"> {shown(least, 'mm')}, pitch_diameter = {shown(self.pitch_diameter, 'mm')} plus "
                f"twice thickness = {shown(self.thickness, 'mm')}, to leave the balls room"
            )
            self._refuse("outer_diameter", shown(self.outer_diameter, "mm"), limit)
        if not self.ball_diameter < self.pitch_diameter * sin(pi / self.balls):
            self._refuse("balls", self.balls, "fewer: they overlap on the pitch circle")
        if not self.thickness < 0.2 * self.outer_diameter:
            limit = f"< 0.2 times outer_diameter = {shown(self.outer_diameter, 'mm')}, a thin ring"
            self._refuse("thickness", shown(self.thickness, "mm"), limit)

    @property
    def ball_diameter(self) -> float:
        """Ball diameter from ring and pitch circle, m."""
        return self.outer_diameter - 2.0 * self.thickness - self.pitch_diameter

    def _refuse(self, name: str, value: str | float, limit: str) -> None:
        raise InputError(f"{self.table}.{name}", value, limit)


@dataclass(frozen=True, kw_only=True)
class Bearing(Part):
    """Bearing of the roller with the ratings of its manufacturer."""

    table: ClassVar[str] = "roller.bearing"
    # Keys of its use, which a second bearing beside it has, too, where it states no others.
    of_use: ClassVar[tuple[str, ...]] = (
        *("viscosity", "contamination", "lubrication", "temperature", "relubrication_interval"),
    )
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "card of the bearing, which fills the keys left out", "bearings.toml", "track_roller_47x18"
    )
    defaults: ClassVar[Mapping[str, str]] = {
        "pitch_diameter": "that of the ring",
        "drag_torque": "zero",
        "friction": "zero",
        "grease_life": "estimated from speed, load and temperature",
        "temperature": "not needed with oil, nor with a grease_life",
        "relubrication_interval": "not needed with oil, nor with grease for life",
    }

    name: Annotated[str, Known("bearing catalogue", "LR6204")]
    """designation of the bearing"""
    C: Annotated[DynamicRating | None, Known("bearing catalogue", "14 kN")] = None
    C0: Annotated[StaticRating | None, Known("bearing catalogue", "7.8 kN")] = None
    fatigue_load_limit: Annotated[RadialLimit | None, Known("bearing catalogue", "335 N")] = None
    """fatigue load limit P_u, ISO 281"""
    radial_limit: Annotated[RadialLimit | None, Known("catalogue of track rollers", "8.3 kN")] = (
        None
    )
    """greatest dynamic radial load F_r,max of an outer ring without a housing"""
    static_radial_limit: Annotated[
        RadialLimit | None, Known("catalogue of track rollers", "11.8 kN")
    ] = None
    """greatest static radial load F_0r,max of an outer ring without a housing"""
    speed_limit: Annotated[
        float | None, In("rpm", above=0, at_most=1e6), Known("bearing catalogue", "9500 rpm")
    ] = None
    """limiting speed"""
    drag_torque: Annotated[
        float | None,
        In("N mm", at_least=0, at_most=1e6),
        Known("bearing maker's calculation", "5 N mm"),
    ] = None
    """drag of seals and grease"""
    friction: Annotated[
        float | None,
        In(at_least=0, below=1),
        Known("bearing catalogue; 0.0015 of ball bearings", 0.0015),
    ] = None
    """friction coefficient of the bearing at its pitch circle"""
    viscosity: Annotated[
        float | None,
        In("mm^2/s", above=0, at_most=1e5),
        Known("data sheet of oil or grease", "30 mm^2/s"),
    ] = None
    """viscosity of the oil, or of the base oil of the grease, in operation"""
    contamination: Annotated[
        Cleanliness | None, Known("seals and surroundings", "normal_cleanliness")
    ] = None
    """class of contamination, ISO 281 table 13"""
    lubrication: Annotated[Lubrication | None, Known("bearing catalogue; own choice", "oil")] = None
    """grease for life, relubricated grease, or oil"""
    temperature: Annotated[Temperature | None, Known("measured at the machine", "70 degC")] = None
    """temperature of the bearing in operation"""
    grease_life: Annotated[Hours | None, Known("maker's calculation", "5000 h")] = None
    """life of the grease for this duty, in place of the estimate"""
    relubrication_interval: Annotated[Hours | None, Known("maintenance plan", "1000 h")] = None
    """interval of relubrication"""
    pitch_diameter: Annotated[
        BallCircle | None, Known("bearing maker; mean of bore and outer diameter", "33.5 mm")
    ] = None
    ring: Annotated[OuterRing | None, Used("contact, checks of the ring")] = None
    """outer ring of the bearing, where it is the roller itself"""
    source: TableSource = NO_SOURCE

    @property
    def ball_circle(self) -> float | None:
        """Pitch diameter of the balls, m: stated, else of the ring."""
        ring = None if self.ring is None else self.ring.pitch_diameter
        return ring if self.pitch_diameter is None else self.pitch_diameter

    def beside(self, first: Bearing) -> Bearing:
        """The bearing in the use of the first one, where it states no other."""
        unstated = (name for name in self.of_use if getattr(self, name) is None)
        return replace(self, **{name: getattr(first, name) for name in unstated})

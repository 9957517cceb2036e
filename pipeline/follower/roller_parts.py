"""Parts of a roller: bearing, its outer ring, pin, fork."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, sin
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import MadeOf
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


@dataclass(frozen=True, kw_only=True)
class Pin(Part):
    """Pin of the roller, straddled or overhung."""

    table: ClassVar[str] = "roller.pin"

    diameter: Annotated[Length, Known("drawing; bore of the bearing", "17 mm")]
    """diameter of the pin"""
    span: Annotated[Length, Known("drawing", "23 mm")]
    """distance between the middles of the cheeks; of an overhung pin from the cheek to the middle
    of the roller"""
    mounting: Annotated[Literal["straddled", "overhung"], Known("drawing")] = "straddled"
    """whether the pin is held at both ends or at one"""
    material: Annotated[MadeOf, Known("drawing", "case_hardened")]
    source: TableSource = NO_SOURCE

    @property
    def overhung(self) -> bool:
        """Whether the pin is held at one end."""
        return self.mounting == "overhung"

    def mass(self, cheek_width: float) -> float:
        """Mass of the solid pin up to the outer faces of its cheeks (m), kg.

        An overhung pin ends as far beyond the middle of the bearing as it starts before it.
        """
        length = 2.0 * self.span + cheek_width if self.overhung else self.span + cheek_width
        return float(self.mass_per_length * length)

    @property
    def mass_per_length(self) -> float:
        """Of the solid pin, kg/m."""
        return self.material.density * 0.25 * pi * self.diameter**2


@dataclass(frozen=True, kw_only=True)
class Fork(Part):
    """Fork that holds the pin: two cheeks under a straddled pin, one beside an overhung one."""

    table: ClassVar[str] = "roller.fork"
    defaults: ClassVar[Mapping[str, str]] = {
        "pressure_limit": "limits.pin_pressure_share of the tensile strength of fork or pin,"
        " the lower",
    }

    cheek_width: Annotated[Length, Known("drawing", "5 mm")]
    """width of each cheek along the pin"""
    cheek_height: Annotated[Length | None, Known("drawing", "22 mm")] = None
    """height of the cheeks across pin and stem"""
    cheek_length: Annotated[Length | None, Known("drawing", "26 mm")] = None
    """length from the middle of the pin to the bridge"""
    bridge_length: Annotated[Length | None, Known("drawing", "4 mm")] = None
    """length of the bridge along the stem"""
    material: Annotated[MadeOf, Known("drawing", "c45")]
    pressure_limit: Annotated[
        Pressure | None, Known("textbooks of machine elements", "120 MPa")
    ] = None
    """permissible pressure of the pin in the cheeks"""
    source: TableSource = NO_SOURCE

    def cheeks(self, pin: Pin) -> int:
        """Number of cheeks: one beside an overhung pin, else two."""
        return 1 if pin.overhung else 2

    def faces(self, pin: Pin) -> tuple[float, float]:
        """Inner and outer face of a cheek from the middle of the roller along the pin, m."""
        inner = pin.span if pin.overhung else 0.5 * (pin.span - self.cheek_width)
        return inner, inner + self.cheek_width

    def mass(self, pin: Pin) -> float | None:
        """Mass of the fork, kg, as blocks of one height: cheeks, and bridge between them; None
        without a dimension.
        """
        height, length, bridge = self.cheek_height, self.cheek_length, self.bridge_length
        if height is None or length is None or bridge is None:
            return None
        cheeks = self.cheeks(pin) * self.cheek_width * length
        return self.material.density * height * (cheeks + bridge * (pin.span + self.cheek_width))

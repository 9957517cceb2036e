"""Parts of a roller: bearing, outer ring of the bearing, pin, fork."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, sin
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import (
    Count,
    Force,
    In,
    Length,
    Part,
    Pressure,
    Temperature,
)
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import shown

Cleanliness = Literal[
    "extreme_cleanliness", "high_cleanliness", "normal_cleanliness", "slight_contamination",
    "typical_contamination", "severe_contamination", "very_severe_contamination",
]  # fmt: skip
"""Classes of contamination of ISO 281:2007, table 13."""
Lubrication = Literal["grease_for_life", "grease_relubricated", "oil"]
RadialLimit = Annotated[float, In("N", above=0, at_most=1e9)]
Hours = Annotated[float, In("h", above=0, at_most=1e6)]


@dataclass(frozen=True, kw_only=True)
class OuterRing(Part):
    """Outer ring of a bearing as roller, supported by its balls.

    thickness: below the groove; pitch_diameter: of the ball centres; balls: number per row;
    strengths: of the ring steel.
    """

    table: ClassVar[str] = "roller.bearing.ring"

    outer_diameter: Length
    thickness: Length
    pitch_diameter: Length
    balls: Annotated[int, Count(3, 100)]
    rows: Annotated[int, Count(1, 4)] = 1
    fatigue_bending: Pressure | None = None
    tensile_strength: Pressure | None = None
    source: Source = NO_SOURCE

    def __post_init__(self) -> None:
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
    """Bearing of the roller with the ratings of its manufacturer.

    fatigue_load_limit: P_u of ISO 281; radial_limit, static_radial_limit: maximum dynamic and
    static load of an outer ring without a housing, F_r,max and F_0r,max; viscosity: of the oil, or
    of the base oil of the grease, at the temperature in operation; grease_life: of the
    manufacturer for this duty, in place of the estimate.
    """

    table: ClassVar[str] = "roller.bearing"
    defaults: ClassVar[Mapping[str, str]] = {
        "pitch_diameter": "that of the ring",
        "drag_torque": "zero",
        "friction": "zero",
        "grease_life": "estimated from speed, load and temperature",
        "temperature": "not needed with oil, nor with a grease_life",
        "relubrication_interval": "not needed with oil, nor with grease for life",
    }

    name: str
    C: Force | None = None
    C0: Force | None = None
    fatigue_load_limit: RadialLimit | None = None
    radial_limit: RadialLimit | None = None
    static_radial_limit: RadialLimit | None = None
    speed_limit: Annotated[float, In("rpm", above=0, at_most=1e6)] | None = None
    drag_torque: Annotated[float, In("N mm", at_least=0, at_most=1e6)] | None = None
    friction: Annotated[float, In(at_least=0, below=1)] | None = None
    viscosity: Annotated[float, In("mm^2/s", above=0, at_most=1e5)] | None = None
    contamination: Cleanliness | None = None
    lubrication: Lubrication | None = None
    temperature: Temperature | None = None
    grease_life: Hours | None = None
    relubrication_interval: Hours | None = None
    pitch_diameter: Length | None = None
    ring: OuterRing | None = None
    source: Source = NO_SOURCE


@dataclass(frozen=True, kw_only=True)
class Pin(Part):
    """Pin of the roller: straddled, span between supports; overhung, span from its support."""

    table: ClassVar[str] = "roller.pin"

    diameter: Length
    span: Length
    mounting: Literal["straddled", "overhung"] = "straddled"
    material: Material
    source: Source = NO_SOURCE

    @property
    def overhung(self) -> bool:
        """Whether it is held at one end."""
        return self.mounting == "overhung"

    def mass(self, cheek_width: float) -> float:
        """Mass of the solid pin up to the outer faces of its cheeks (m), kg.

        An overhung pin ends as far beyond the middle of the bearing as it starts before it.
        """
        length = 2.0 * self.span + cheek_width if self.overhung else self.span + cheek_width
        return float(self.material.density * 0.25 * pi * self.diameter**2 * length)


@dataclass(frozen=True, kw_only=True)
class Fork(Part):
    """Fork that holds the pin: two cheeks under a straddled pin, one beside an overhung one.

    cheek_width: along the pin, of each cheek; cheek_height: across pin and stem; cheek_length: from
    the middle of the pin to the bridge; bridge_length: of the bridge along the stem;
    pressure_limit: of the pin in the cheeks.
    """

    table: ClassVar[str] = "roller.fork"
    defaults: ClassVar[Mapping[str, str]] = {
        "pressure_limit": "limits.pin_pressure_share of the tensile strength of fork or pin,"
        " the lower",
    }

    cheek_width: Length
    cheek_height: Length | None = None
    cheek_length: Length | None = None
    bridge_length: Length | None = None
    material: Material
    pressure_limit: Pressure | None = None
    source: Source = NO_SOURCE

    def cheeks(self, pin: Pin) -> int:
        """Number of cheeks: one beside an overhung pin, else two."""
        return 1 if pin.overhung else 2

    def faces(self, pin: Pin) -> tuple[float, float]:
        """Inner and outer face of a cheek from the middle of the roller along the pin, m."""
        inner = pin.span if pin.overhung else 0.5 * (pin.span - self.cheek_width)
        return inner, inner + self.cheek_width

    def mass(self, pin: Pin) -> float | None:
        """Mass of cheeks and bridge, blocks of one height, kg; None without a dimension."""
        height, length, bridge = self.cheek_height, self.cheek_length, self.bridge_length
        if height is None or length is None or bridge is None:
            return None
        cheeks = self.cheeks(pin) * self.cheek_width * length
        return self.material.density * height * (cheeks + bridge * (pin.span + self.cheek_width))

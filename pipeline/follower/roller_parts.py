"""Parts of a roller: bearing, outer ring of the bearing, pin."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sin
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Count, Force, In, Length, Part, Pressure


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
    source: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.ball_diameter > 0.0:
            limit = "> pitch_diameter + 2 thickness, to leave the balls room"
            self._refuse("outer_diameter", self.outer_diameter, limit)
        if not self.ball_diameter < self.pitch_diameter * sin(pi / self.balls):
            self._refuse("balls", self.balls, "fewer: they overlap on the pitch circle")
        if not self.thickness < 0.2 * self.outer_diameter:
            self._refuse("thickness", self.thickness, "< 0.2 outer_diameter, a thin ring")

    @property
    def ball_diameter(self) -> float:
        """Ball diameter from ring and pitch circle, m."""
        return self.outer_diameter - 2.0 * self.thickness - self.pitch_diameter

    def _refuse(self, name: str, value: float, limit: str) -> None:
        raise InputError(f"{self.table}.{name}", value, limit)


@dataclass(frozen=True, kw_only=True)
class Bearing(Part):
    """Bearing of the roller with the ratings of its manufacturer; oil viscosity in operation."""

    table: ClassVar[str] = "roller.bearing"

    name: str
    C: Force | None = None
    C0: Force | None = None
    radial_limit: Annotated[float, In("N", above=0, at_most=1e9)] | None = None
    speed_limit: Annotated[float, In("rpm", above=0, at_most=1e6)] | None = None
    drag_torque: Annotated[float, In("N mm", at_least=0, at_most=1e6)] | None = None
    friction: Annotated[float, In(at_least=0, below=1)] | None = None
    viscosity: Annotated[float, In("mm^2/s", above=0, at_most=1e5)] | None = None
    pitch_diameter: Length | None = None
    ring: OuterRing | None = None
    source: str = ""


@dataclass(frozen=True, kw_only=True)
class Pin(Part):
    """Pin of the roller: straddled, span between supports; overhung, span from its support."""

    table: ClassVar[str] = "roller.pin"

    diameter: Length
    span: Length
    mounting: Literal["straddled", "overhung"] = "straddled"
    material: Material
    source: str = ""

"""Parts of a roller: pin, fork."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, Literal

from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import Known, Length, Part, Pressure, TableSource
from camwright.pipeline.base.source import NO_SOURCE


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

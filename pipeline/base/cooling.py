"""Heat balance of the housing: heat given to the surroundings, temperature rise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from camwright.geometry.arrays import Value
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.base.quantities import In, Known, Part, Temperature
from camwright.pipeline.base.source import NO_SOURCE, Source

STILL_AIR = 10.0
"""Heat that a housing in still air gives to it, W/(m^2 K): 10 to 18 of gear cases, ISO/TR 14179-2,
recalled: verify."""


@dataclass(frozen=True, kw_only=True)
class Cooling(Part):
    """Heat that leaves the mechanism per kelvin above the surroundings, and heat that enters.

    The conductance is that of housing, oil and shaft together.
    """

    table: ClassVar[str] = "cooling"
    defaults: ClassVar[Mapping[str, str]] = {
        "conductance": "still air on the box around cam and follower"
    }

    ambient_temperature: Annotated[Temperature, Known("place of the machine", "30 degC")] = ROOM
    """greatest temperature around the housing"""
    conductance: Annotated[
        float | None,
        In("W/K", above=0, at_most=1e6),
        Known("measured: friction power over the rise of the oil", "4 W/K"),
    ] = None
    """heat that leaves the housing per kelvin above the surroundings"""
    heat: Annotated[
        float, In("W", at_least=0, at_most=1e9), Known("measured, or their losses", "50 W")
    ] = 0.0
    """heat of other parts into the same housing"""
    source: Annotated[Source, Known("own choice", "run-in test")] = NO_SOURCE
    """source of the values of the table"""

    def temperature(self, loss: Value, area: Value) -> Value:
        """Steady temperature of the mechanism, K.

        Parameters
        ----------
        loss : float   mean friction power, W, or an array
        area : float   of the housing at least, m^2: gives heat to still air where no conductance
                       is stated
        """
        return self.ambient_temperature + (loss + self.heat) / self.carried(area)

    def carried(self, area: Value) -> Value:
        """Thermal conductance to the surroundings, W/K; area as of `temperature`."""
        return STILL_AIR * area if self.conductance is None else self.conductance


def housing_area(diameter: Value, height: Value, width: Value) -> Value:
    """Least outer area of a housing, m^2: that of the bounding box of cam and follower."""
    return 2.0 * (diameter * height + diameter * width + height * width)

"""Quantities of an input: SI floats read from text with a unit, within bounds."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite
from typing import TYPE_CHECKING, Annotated, Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema


@dataclass(frozen=True)
class In:
    """Marks a float field: read from a unit string into SI, bounds in the unit shown.

    With no unit it is a pure number, written bare.
    """

    unit: str = ""
    above: float = -inf
    at_least: float = -inf
    below: float = inf
    at_most: float = inf

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import PydanticCustomError, core_schema

        def read(given: object) -> float:
            try:
                return self.read(given)
            except InputError as error:
                limit = {"limit": error.limit}
                raise PydanticCustomError("limit", "must be {limit}", limit) from None

        return core_schema.no_info_plain_validator_function(read)

    def read(self, given: object) -> float:
        """The value in SI.

        Raises
        ------
        InputError
            If it is no finite number with a unit of this dimension, or out of bounds; the field
            is left empty.
        """
        value = self._number(given)
        shown = [f"> {self.above:g}"] if self.above > -inf else []
        shown += [f">= {self.at_least:g}"] if self.at_least > -inf else []
        shown += [f"< {self.below:g}"] if self.below < inf else []
        shown += [f"<= {self.at_most:g}"] if self.at_most < inf else []
        inside = self._si(self.above) < value < self._si(self.below) and self._si(
            self.at_least
        ) <= value <= self._si(self.at_most)
        if not inside:
            raise InputError("", str(given), f"{' and '.join(shown)} {self.unit}".rstrip())
        return value

    def _number(self, given: object) -> float:
        if self.unit:
            return units.parse(given, self.unit, "")
        if isinstance(given, bool) or not isinstance(given, (int, float)):
            shown = given if isinstance(given, str) else repr(given)
            raise InputError("", shown, "a number without a unit")
        value = float(given) if abs(given) < 1e308 else inf
        if not isfinite(value):
            raise InputError("", given, "finite")
        return value

    def _si(self, bound: float) -> float:
        if not isfinite(bound) or not self.unit:
            return bound
        return units.parse(f"{bound!r} {self.unit}", self.unit, "")


Length = Annotated[float, In("mm", above=0, at_most=10_000)]
Angle = Annotated[float, In("deg")]
Duration = Annotated[float, In("deg", above=0, at_most=720)]
Mass = Annotated[float, In("g", above=0, at_most=1e6)]
Pressure = Annotated[float, In("MPa", above=0, at_most=1e6)]
GasPressure = Annotated[float, In("kPa", above=0, at_most=1e5)]
Temperature = Annotated[float, In("K", above=0, at_most=5000)]
Force = Annotated[float, In("N", at_least=0, at_most=1e9)]
Share = Annotated[float, In(at_least=0, at_most=1)]
Positive = Annotated[float, In(above=0, at_most=1e6)]
Fraction = Annotated[float, In(above=0, at_most=1)]
Safety = Annotated[float, In(above=0, at_most=100)]
Rate = Annotated[float, In("kN/m", above=0, at_most=1e6)]
Preload = Annotated[float, In("N", above=0, at_most=1e9)]
Residual = Annotated[float, In(above=0, at_most=1e-3)]

"""Material card: elastic constants, strengths and their source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from camwright.pipeline.base.quantities import In, Length, Part, Pressure, Temperature


@dataclass(frozen=True, kw_only=True)
class Material(Part):
    """Material card: elastic constants, strengths and their source.

    swelling is the relative growth of a length from dry to fully moist, hardness Brinell or
    Vickers, name that of the card in the case.
    """

    table: ClassVar[str] = "material"
    labels: ClassVar[tuple[str, ...]] = ("name",)

    E: Annotated[float, In("GPa", above=0, at_most=1e5)]
    nu: Annotated[float, In(at_least=0, below=0.5)]
    yield_strength: Pressure
    tensile_strength: Pressure | None = None
    hardness: Annotated[float, In(above=0, at_most=10_000)] | None = None
    endurance_pressure: Pressure | None = None
    endurance_slope: Annotated[float, In(above=0, at_most=100)] | None = None
    endurance_intercept: Annotated[float, In(above=0, at_most=1000)] | None = None
    conductivity: Annotated[float, In("W/m/K", above=0, at_most=1e4)] | None = None
    temperature_limit: Temperature | None = None
    fatigue_torsion: Pressure | None = None
    fatigue_bending: Pressure | None = None
    case_depth: Length | None = None
    core_yield_strength: Pressure | None = None
    expansion: Annotated[float, In("1/K", at_least=0, at_most=1e-2)] | None = None
    swelling: Annotated[float, In(at_least=0, below=1)] = 0.0
    treatment: Literal["case_hardened", "induction_hardened", "through_hardened"] | None = None
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    condition: str = ""
    source: str
    name: str = ""

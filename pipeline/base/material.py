"""Material card: elastic constants, strengths and their source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal, NamedTuple

from camwright.pipeline.base.quantities import In, Length, Part, Pressure, Temperature


class Endurance(NamedTuple):
    """Endurance of a surface: contact pressure, Pa, and its line over the load cycles.

    slope and intercept: A and B of log10 K = (B - log10 n)/A, K in psi; None: not known.
    """

    motion: str
    pressure: float | None
    slope: float | None
    intercept: float | None


@dataclass(frozen=True, kw_only=True)
class Material(Part):
    """Material card: elastic constants, strengths and their source.

    swelling is the relative growth of a length from dry to fully moist, name that of the card in
    the case. endurance_ holds for rolling, sliding_endurance_ for rolling with 9 % sliding, both
    pressures for endurance_cycles load cycles. The scales of hardness are not converted into one
    another: a card of both has the second from a table such as ISO 18265. core_fatigue_torsion is
    the fully reversed fatigue limit below a hardened case, fatigue_torsion that of the surface.
    """

    table: ClassVar[str] = "material"
    labels: ClassVar[tuple[str, ...]] = ("name",)
    defaults: ClassVar[Mapping[str, str]] = {
        "hardness_brinell": "unknown: no Buckingham estimate, which is advisory",
        "hardness_vickers": "unknown: no allowable of gear flanks, which is advisory",
        "endurance_slope": "none: the endurance pressure holds up to endurance_cycles",
        "endurance_intercept": "none: the endurance pressure holds up to endurance_cycles",
        "sliding_endurance_slope": "none: the endurance pressure holds up to endurance_cycles",
        "sliding_endurance_intercept": "none: the endurance pressure holds up to endurance_cycles",
        "fatigue_bending": "unknown: no criteria of Crossland and Dang Van, which are advisory",
    }

    E: Annotated[float, In("GPa", above=0, at_most=1e5)]
    nu: Annotated[float, In(at_least=0, below=0.5)]
    yield_strength: Pressure
    tensile_strength: Pressure | None = None
    hardness_brinell: Annotated[float, In(above=0, at_most=650)] | None = None
    hardness_vickers: Annotated[float, In(above=0, at_most=10_000)] | None = None
    endurance_pressure: Pressure | None = None
    endurance_slope: Annotated[float, In(above=0, at_most=100)] | None = None
    endurance_intercept: Annotated[float, In(above=0, at_most=1000)] | None = None
    sliding_endurance_pressure: Pressure | None = None
    sliding_endurance_slope: Annotated[float, In(above=0, at_most=100)] | None = None
    sliding_endurance_intercept: Annotated[float, In(above=0, at_most=1000)] | None = None
    endurance_cycles: Annotated[float, In(at_least=1, at_most=1e15)] = 1e8
    conductivity: Annotated[float, In("W/m/K", above=0, at_most=1e4)] | None = None
    temperature_limit: Temperature | None = None
    fatigue_torsion: Pressure | None = None
    fatigue_bending: Pressure | None = None
    case_depth: Length | None = None
    core_yield_strength: Pressure | None = None
    core_fatigue_torsion: Pressure | None = None
    expansion: Annotated[float, In("1/K", at_least=0, at_most=1e-2)] | None = None
    swelling: Annotated[float, In(at_least=0, below=1)] = 0.0
    treatment: (
        Literal["case_hardened", "induction_hardened", "through_hardened", "not_hardened"] | None
    ) = None
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    condition: str = ""
    source: str
    name: str = ""

    @property
    def surface_hardened(self) -> bool | None:
        """Whether a hardened case lies on a softer core; None if the card does not state it."""
        if self.case_depth is not None:
            return True
        if self.treatment is None:
            return None
        return self.treatment in ("case_hardened", "induction_hardened")

    def endurance(self, *, sliding: bool) -> Endurance:
        """Endurance of the surface in rolling, or in rolling with sliding.

        A card without endurance in rolling has that in rolling with sliding, which is lower.
        """
        if sliding or self.endurance_pressure is None:
            return Endurance(
                "rolling with sliding",
                self.sliding_endurance_pressure,
                self.sliding_endurance_slope,
                self.sliding_endurance_intercept,
            )
        return Endurance(
            "rolling", self.endurance_pressure, self.endurance_slope, self.endurance_intercept
        )

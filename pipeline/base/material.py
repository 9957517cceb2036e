"""Material card: elastic constants, strengths and their source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, takewhile
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In, Length, Part, Pressure, Temperature
from camwright.pipeline.base.source import Source

ROOM = 293.15
"""Temperature of cards and drawings, K: 20 degC, ISO 1."""

METAL_MODULUS = 40e9
"""Young's modulus from which a material counts as metal, Pa: above plastics, below magnesium."""

STRENGTH_HOLDS_TO = {True: 373.15, False: 303.15}
"""Temperature to which the yield strength of a metal (True) or of a plastic holds, K.

Metals: EN 1993-1-2, table 3.1, has no reduction of the yield strength of steel to 400 degC; copper
alloys of bushes to 100 degC: verify. Plastics: the standard atmosphere of 23 degC, ISO 291, and a
margin of 7 K, in which polyamide loses up to a twentieth: verify.
"""


@dataclass(frozen=True, kw_only=True)
class StrengthAt(Part):
    """Yield strength at a temperature above 20 degC."""

    table: ClassVar[str] = "strength_at"

    temperature: Temperature
    yield_strength: Pressure


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
    the case. strength_at are yield strengths by temperature, in ascending order; the strength is
    linear between them and from that at 20 degC. endurance_ holds for rolling,
    sliding_endurance_ for rolling with 9 % sliding, both pressures for endurance_cycles load
    cycles. The scales of hardness are not converted into one another: a card of both has the second
    from a table such as ISO 18265. core_fatigue_torsion is the fully reversed fatigue limit below a
    hardened case, fatigue_torsion that of the surface.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the temperatures do not ascend from 20 degC.
    """

    table: ClassVar[str] = "material"
    labels: ClassVar[tuple[str, ...]] = ("name",)
    defaults: ClassVar[Mapping[str, str]] = {
        "endurance_pressure": "that of rolling with sliding, which is lower",
        "sliding_endurance_pressure": "needed by a flat face, or without endurance_pressure",
        "treatment": "hardened where case_depth is stated, else missing",
        "swelling": "0 of a metal (Young's modulus of at least 40 GPa), else missing",
        "strength_at": "the yield strength holds to 100 degC of a metal, to 30 degC of a plastic",
        "hardness_brinell": "unknown: no Buckingham estimate, which is advisory",
        "hardness_vickers": "unknown: no allowable of gear flanks, which is advisory",
        "endurance_slope": "none: the endurance pressure holds up to endurance_cycles",
        "endurance_intercept": "none: the endurance pressure holds up to endurance_cycles",
        "sliding_endurance_slope": "none: the endurance pressure holds up to endurance_cycles",
        "sliding_endurance_intercept": "none: the endurance pressure holds up to endurance_cycles",
        "conductivity": "unknown: needed under a flat face, which slides, and by guides",
        "specific_heat": "unknown: needed under a flat face, which slides",
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
    specific_heat: Annotated[float, In("J/kg/K", above=0, at_most=1e5)] | None = None
    temperature_limit: Temperature | None = None
    fatigue_torsion: Pressure | None = None
    fatigue_bending: Pressure | None = None
    case_depth: Length | None = None
    core_yield_strength: Pressure | None = None
    core_fatigue_torsion: Pressure | None = None
    expansion: Annotated[float, In("1/K", at_least=0, at_most=1e-2)] | None = None
    swelling: Annotated[float, In(at_least=0, below=1)] | None = None
    strength_at: tuple[StrengthAt, ...] = ()
    treatment: (
        Literal["case_hardened", "induction_hardened", "through_hardened", "not_hardened"] | None
    ) = None
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    condition: str = ""
    source: Source
    name: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        temperatures = [ROOM, *(each.temperature for each in self.strength_at)]
        for before, after in pairwise(temperatures):
            if not before < after:
                raise InputError("material.strength_at", f"{after:g} K", f"> {before:g} K")

    @property
    def is_metal(self) -> bool:
        """Whether Young's modulus is that of a metal."""
        return self.E >= METAL_MODULUS

    @property
    def moisture_growth(self) -> float | None:
        """Relative growth of a length by moisture; 0 of a metal, None: not known."""
        return 0.0 if self.swelling is None and self.is_metal else self.swelling

    def yield_strength_at(self, temperature: float) -> float:
        """Yield strength, Pa, at a temperature, K; NaN above the temperatures of the card."""
        if np.isnan(temperature):
            return np.nan
        if not self.strength_at:
            holds = temperature <= STRENGTH_HOLDS_TO[self.is_metal]
            return self.yield_strength if holds else np.nan
        at = [ROOM, *(each.temperature for each in self.strength_at)]
        strengths = [self.yield_strength, *(each.yield_strength for each in self.strength_at)]
        return float(np.interp(temperature, at, strengths, right=np.nan))

    @property
    def core_yield(self) -> float:
        """Yield strength of the core, Pa; of a body without a hardened case that of the card."""
        return self.core_yield_strength or self.yield_strength

    @property
    def holds_to(self) -> float:
        """Temperature to which limit and yield strength at 20 degC of the card hold, K."""
        warm = STRENGTH_HOLDS_TO[self.is_metal]
        if self.strength_at:
            kept = takewhile(
                lambda each: each.yield_strength >= self.yield_strength, self.strength_at
            )
            warm = max((each.temperature for each in kept), default=ROOM)
        return warm if self.temperature_limit is None else min(warm, self.temperature_limit)

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

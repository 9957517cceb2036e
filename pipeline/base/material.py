"""Material card: elastic constants, strengths and their source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, takewhile
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Meaning,
    Part,
    Pressure,
    Resolved,
    Temperature,
    Used,
    card_of,
)
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

    temperature: Annotated[Temperature, Known("data sheet of the plastic", "120 degC")]
    """temperature"""
    yield_strength: Annotated[Pressure, Known("data sheet of the plastic", "30 MPa")]
    """yield strength at this temperature"""


class Endurance(NamedTuple):
    """Endurance pressure of a surface, Pa, at its load cycles, and the S-N line beyond.

    slope and intercept: A and B of log10 K = (B - log10 n)/A, K in psi; None: not known.
    """

    motion: str
    pressure: float | None
    slope: float | None
    intercept: float | None


@dataclass(frozen=True, kw_only=True)
class Material(Part):
    """Material card: elastic constants, strengths and their source.

    The yield strength is linear in the temperature between those of `strength_at` and from that at
    20 degC. The endurance in rolling with sliding holds for 9 % sliding. The scales of hardness are
    not converted into one another: a card of both has the second from a table such as ISO 18265.
    `name` is that of the card in the case.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the temperatures do not ascend from 20 degC.
    """

    table: ClassVar[str] = "material"
    labels: ClassVar[tuple[str, ...]] = ("name",)
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "shipped card, which fills the keys left out", "materials.toml", "case_hardened"
    )
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

    E: Annotated[float, In("GPa", above=0, at_most=1e5), Known("material card", "210 GPa")]
    """Young's modulus"""
    nu: Annotated[float, In(at_least=0, below=0.5), Known("material card", 0.3)]
    """Poisson ratio"""
    yield_strength: Annotated[Pressure, Known("material card or certificate", "370 MPa")]
    """yield strength at 20 degC; of a hardened case that of the surface"""
    tensile_strength: Annotated[
        Pressure | None, Known("material card or certificate", "630 MPa")
    ] = None
    """tensile strength"""
    hardness_brinell: Annotated[
        float | None, In(above=0, at_most=650), Known("certificate, or measured", 250)
    ] = None
    """Brinell hardness"""
    hardness_vickers: Annotated[
        float | None, In(above=0, at_most=10_000), Known("certificate, or measured", 600)
    ] = None
    """Vickers hardness of the surface"""
    endurance_pressure: Annotated[
        Pressure | None, Known("Rothbart (2004) table 9.3", "1770 MPa")
    ] = None
    """endurance limit of the contact pressure in rolling"""
    endurance_slope: Annotated[
        float | None, In(above=0, at_most=100), Known("Rothbart (2004) table 9.3", 7.39)
    ] = None
    """A of log10 K = (B - log10 n)/A, K in psi, in rolling"""
    endurance_intercept: Annotated[
        float | None, In(above=0, at_most=1000), Known("Rothbart (2004) table 9.3", 38.33)
    ] = None
    """B of log10 K = (B - log10 n)/A, K in psi, in rolling"""
    sliding_endurance_pressure: Annotated[
        Pressure | None, Known("Rothbart (2004) table 9.3", "1610 MPa")
    ] = None
    """endurance limit of the contact pressure in rolling with sliding"""
    sliding_endurance_slope: Annotated[
        float | None, In(above=0, at_most=100), Known("Rothbart (2004) table 9.3", 13.2)
    ] = None
    """A of log10 K = (B - log10 n)/A, K in psi, in rolling with sliding"""
    sliding_endurance_intercept: Annotated[
        float | None, In(above=0, at_most=1000), Known("Rothbart (2004) table 9.3", 61.06)
    ] = None
    """B of log10 K = (B - log10 n)/A, K in psi, in rolling with sliding"""
    endurance_cycles: Annotated[
        float, In(at_least=1, at_most=1e15), Known("Rothbart (2004) table 9.3")
    ] = 1e8
    """load cycles for which the endurance limits are stated"""
    conductivity: Annotated[
        float | None, In("W/m/K", above=0, at_most=1e4), Known("material card", "45 W/m/K")
    ] = None
    """thermal conductivity"""
    specific_heat: Annotated[
        float | None, In("J/kg/K", above=0, at_most=1e5), Known("material card", "460 J/kg/K")
    ] = None
    """specific heat, for the temperature of a sliding contact"""
    temperature_limit: Annotated[
        Temperature | None, Known("data sheet of the bush", "120 degC")
    ] = None
    """greatest temperature in continuous use"""
    fatigue_torsion: Annotated[Pressure | None, Known("DIN 743-3, or material card", "300 MPa")] = (
        None
    )
    """fully reversed fatigue limit in torsion; of a hardened case that of the surface"""
    fatigue_bending: Annotated[
        Pressure | None, Known("DIN 743-3, or half of the tensile strength of steel", "315 MPa")
    ] = None
    """fully reversed fatigue limit in bending, polished specimen"""
    case_depth: Annotated[Length | None, Known("drawing", "1.1 mm")] = None
    """effective case depth of a hardened surface"""
    core_yield_strength: Annotated[Pressure | None, Known("material card", "600 MPa")] = None
    """yield strength of the core below the case"""
    core_fatigue_torsion: Annotated[Pressure | None, Known("DIN 743-3", "300 MPa")] = None
    """fully reversed fatigue limit of the core in torsion"""
    expansion: Annotated[
        float | None, In("1/K", at_least=0, at_most=1e-2), Known("material card", "1.15e-5 1/K")
    ] = None
    """coefficient of thermal expansion"""
    swelling: Annotated[
        float | None, In(at_least=0, below=1), Known("data sheet of the plastic", 0.01)
    ] = None
    """relative growth of a length from dry to fully moist"""
    strength_at: Annotated[
        tuple[StrengthAt, ...],
        Used("checks of the guides"),
        Known(
            "data sheet of the plastic", ({"temperature": "120 degC", "yield_strength": "30 MPa"},)
        ),
    ] = ()
    """yield strengths above 20 degC, by ascending temperature"""
    treatment: Annotated[
        Literal["case_hardened", "induction_hardened", "through_hardened", "not_hardened"] | None,
        Known("drawing", "through_hardened"),
    ] = None
    """heat treatment of the surface"""
    density: Annotated[
        float, In("kg/m^3", above=0, at_most=1e5), Known("material card", "7850 kg/m^3")
    ]
    """density"""
    condition: Annotated[str, Known("certificate", "C45+QT, 16 to 40 mm")] = ""
    """melt, size and treatment for which the values hold"""
    source: Annotated[Source, Known("standard, certificate or textbook", "EN ISO 683-1")]
    """source of the values of the card"""
    name: str = ""

    def __post_init__(self) -> None:
        """Refuse strengths whose temperatures do not ascend from 20 degC."""
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
        """Yield strength below a hardened case, Pa; the card's yield strength without a case."""
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


MadeOf = Annotated[Material, Meaning("name of its material in [materials]")]
"""A field with the material of a body."""

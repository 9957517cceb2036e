"""Bearing cards: ratings and dimensions of ball bearings from the makers' tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Count, In, Length, Part, Pressure
from camwright.pipeline.base.source import Source
from camwright.pipeline.contact.rolling_bearing import Bearing, OuterRing

_Rating = Annotated[float, In("N", above=0, at_most=1e9)]
_RING = ("balls", "pitch_diameter", "ring_thickness")
_STRENGTHS = ("ring_fatigue_bending", "ring_tensile_strength")
_OF_THE_RING = {
    "outer_diameter": "outer_diameter",
    "ring_thickness": "thickness",
    "pitch_diameter": "pitch_diameter",
    "balls": "balls",
    "rows": "rows",
    "ring_fatigue_bending": "fatigue_bending",
    "ring_tensile_strength": "tensile_strength",
}


@dataclass(frozen=True, kw_only=True)
class BearingCard(Part):
    """Ball bearing of a catalogue: dimensions and ratings of its maker.

    radial_limit and static_radial_limit are the load limits of the outer ring without a housing;
    fatigue_load_limit is P_u.
    balls is the number in one row, pitch_diameter that of the ball centres, ring_thickness that
    of the outer ring under the groove; the ring is described completely or not at all.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the ring incomplete or larger than the bearing.
    """

    table: ClassVar[str] = "bearing"

    name: str
    C: _Rating
    C0: _Rating
    speed_limit: Annotated[float, In("rpm", above=0, at_most=1e6)]
    bore: Length
    outer_diameter: Length
    width: Length
    source: Source
    fatigue_load_limit: _Rating | None = None
    radial_limit: _Rating | None = None
    static_radial_limit: _Rating | None = None
    balls: Annotated[int, Count(3, 100)] | None = None
    pitch_diameter: Length | None = None
    ring_thickness: Length | None = None
    ring_fatigue_bending: Pressure | None = None
    ring_tensile_strength: Pressure | None = None
    rows: Annotated[int, Count(1, 4)] = 1

    def __post_init__(self) -> None:
        """Refuse a ring that is described in part, or does not fit into the bearing."""
        super().__post_init__()
        if any(getattr(self, name) is not None for name in (*_RING, *_STRENGTHS)):
            for name in _RING:
                if getattr(self, name) is None:
                    raise InputError(f"bearing.{name}", "missing", "given")
        pitch, thickness = self.pitch_diameter, self.ring_thickness
        if pitch is None or thickness is None:
            return
        if not self.bore < pitch < self.outer_diameter:
            raise InputError("bearing.pitch_diameter", pitch, "between bore and outside")
        if not thickness < 0.5 * (self.outer_diameter - pitch):
            raise InputError("bearing.ring_thickness", thickness, "outside the pitch circle")

    @property
    def bearing(self) -> Bearing:
        """Bearing of a roller with the ratings of the card, and its outer ring if the card
        describes it.
        """
        ring = None
        if self.balls is not None and self.pitch_diameter and self.ring_thickness:
            ring = OuterRing(
                outer_diameter=self.outer_diameter,
                thickness=self.ring_thickness,
                pitch_diameter=self.pitch_diameter,
                balls=self.balls,
                rows=self.rows,
                fatigue_bending=self.ring_fatigue_bending,
                tensile_strength=self.ring_tensile_strength,
                source=self.source,
            )
        return Bearing(
            name=self.name,
            C=self.C,
            C0=self.C0,
            fatigue_load_limit=self.fatigue_load_limit,
            radial_limit=self.radial_limit,
            static_radial_limit=self.static_radial_limit,
            speed_limit=self.speed_limit,
            ring=ring,
            source=self.source,
        )


def bearing_keys(words: Mapping[str, Source]) -> dict[str, Source]:
    """Sources by card key, renamed to the keys of ``roller.bearing``."""
    of_ring = {f"ring.{_OF_THE_RING[key]}": words[key] for key in words if key in _OF_THE_RING}
    return dict(words) | of_ring

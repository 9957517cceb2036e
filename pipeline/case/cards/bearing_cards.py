"""Bearing cards: what a maker says of a bearing, in TOML."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units

CARDS = Path(__file__).parent / "bearings.toml"

_UNITS = {
    "C": "N",
    "C0": "N",
    "speed_limit": "rpm",
    "bore": "mm",
    "outer_diameter": "mm",
    "width": "mm",
    "fatigue_load_limit": "N",
    "radial_limit": "N",
    "pitch_diameter": "mm",
    "ring_thickness": "mm",
    "ring_fatigue_bending": "MPa",
    "ring_tensile_strength": "MPa",
}
_RING = {"balls", "pitch_diameter", "ring_thickness"}
_STRENGTHS = {"ring_fatigue_bending", "ring_tensile_strength"}
_OPTIONAL = {"fatigue_load_limit", "radial_limit", "rows", *_RING, *_STRENGTHS}


@dataclass(frozen=True)
class BearingCard:
    """A ball bearing as its maker rates it, SI.

    Parameters
    ----------
    C, C0 : float             dynamic and static rating, N, > 0
    speed_limit : float       rad/s, > 0
    bore, outer_diameter, width : float    m, > 0
    source : str              where the numbers come from; "verify" marks recalled ones
    fatigue_load_limit : float   P_u, N; None when not given
    radial_limit : float      N that the outer ring bears without a housing; None when not given
    balls : int               of a row, >= 3; None with the next two where the ring is not known
    pitch_diameter : float    of the balls' middles, m
    ring_thickness : float    of the outer ring under the groove, m
    ring_fatigue_bending, ring_tensile_strength : float   of the ring's steel, Pa; None when not
                                                          given
    rows : int                of balls, >= 1
    """

    name: str
    C: float
    C0: float
    speed_limit: float
    bore: float
    outer_diameter: float
    width: float
    source: str
    fatigue_load_limit: float | None = None
    radial_limit: float | None = None
    balls: int | None = None
    pitch_diameter: float | None = None
    ring_thickness: float | None = None
    ring_fatigue_bending: float | None = None
    ring_tensile_strength: float | None = None
    rows: int = 1

    def __post_init__(self) -> None:
        for name in _UNITS:
            value = getattr(self, name)
            if value is not None and not 0.0 < value < np.inf:
                raise InputError(f"bearing.{name}", value, "> 0")
        if self.balls is not None and self.balls < 3:
            raise InputError("bearing.balls", self.balls, ">= 3")
        if self.rows < 1:
            raise InputError("bearing.rows", self.rows, ">= 1")
        pitch, thickness = self.pitch_diameter, self.ring_thickness
        if pitch is not None and not self.bore < pitch < self.outer_diameter:
            raise InputError("bearing.pitch_diameter", pitch, "between bore and outside")
        if (
            pitch is not None
            and thickness is not None
            and not thickness < 0.5 * (self.outer_diameter - pitch)
        ):
            raise InputError("bearing.ring_thickness", thickness, "outside the pitch circle")


def read_card(name: str, entry: Any) -> BearingCard:
    """A card from its table; all of the ring is told, or nothing of it.

    Raises
    ------
    InputError
        For a card without C0 or another value, an unknown key, or a value out of its bounds.
    """
    if not isinstance(entry, dict):
        raise InputError(f"cards.{name}", entry, "a table")
    known = {*_UNITS, "name", "balls", "rows", "source"}
    for key in sorted(set(entry) - known):
        raise InputError(
            f"cards.{name}.{key}", "unknown key", f"one of: {', '.join(sorted(known))}"
        )
    ring = _RING if set(entry) & (_RING | _STRENGTHS) else set()
    for key in sorted((known - _OPTIONAL | ring) - set(entry)):
        raise InputError(f"cards.{name}.{key}", "missing", "given")
    values = {
        key: units.parse(entry[key], unit, f"cards.{name}.{key}")
        for key, unit in _UNITS.items()
        if key in entry
    }
    counts = {key: entry[key] for key in ("balls", "rows") if key in entry}
    for key, count in counts.items():
        if isinstance(count, bool) or not isinstance(count, int):
            raise InputError(f"cards.{name}.{key}", count, "a whole number")
    told: dict[str, Any] = {**counts, **values}
    return BearingCard(name=str(entry["name"]), source=str(entry["source"]), **told)


def as_case_table(card: BearingCard) -> dict[str, Any]:
    """What a card puts into ``[roller.bearing]``, as a case file has it."""
    ratings = {"C": "N", "C0": "N", "speed_limit": "rpm", "radial_limit": "N"}
    table: dict[str, Any] = {"name": card.name, **_written(card, ratings), "source": card.source}
    if card.balls is not None:
        lengths = {"outer_diameter": "mm", "pitch_diameter": "mm", "ring_thickness": "mm"}
        strengths = dict.fromkeys(sorted(_STRENGTHS), "MPa")
        written = _written(card, lengths | strengths)
        ring = {key.removeprefix("ring_"): text for key, text in written.items()}
        counts = {"balls": card.balls, "rows": card.rows}
        table["ring"] = {**counts, **ring, "source": card.source}
    return table


def _written(card: BearingCard, names: dict[str, str]) -> dict[str, str]:
    return {
        name: units.format(getattr(card, name), unit)
        for name, unit in names.items()
        if getattr(card, name) is not None
    }

"""Bearing cards: what a maker says of a bearing, in TOML."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geometry.errors import InputError
from pipeline import units

CARDS = Path(__file__).parent / "cards" / "bearings.toml"

_UNITS = {
    "C": "N",
    "C0": "N",
    "speed_limit": "rpm",
    "bore": "mm",
    "outer_diameter": "mm",
    "width": "mm",
    "pitch_diameter": "mm",
    "ring_thickness": "mm",
    "fatigue_load_limit": "N",
    "radial_limit": "N",
}
_OPTIONAL = {"fatigue_load_limit", "radial_limit"}


@dataclass(frozen=True)
class BearingCard:
    """A ball bearing as its maker rates it, SI.

    Parameters
    ----------
    C, C0 : float             dynamic and static rating, N, > 0
    speed_limit : float       rad/s, > 0
    bore, outer_diameter, width : float    m, > 0
    balls : int               >= 3
    pitch_diameter : float    of the balls' middles, m
    ring_thickness : float    of the outer ring under the groove, m
    source : str              where the numbers come from; "verify" marks recalled ones
    fatigue_load_limit : float   P_u, N; 0 when not given
    radial_limit : float      N that the outer ring bears without a housing; None when not given
    """

    name: str
    C: float
    C0: float
    speed_limit: float
    bore: float
    outer_diameter: float
    width: float
    balls: int
    pitch_diameter: float
    ring_thickness: float
    source: str
    fatigue_load_limit: float = 0.0
    radial_limit: float | None = None

    def __post_init__(self) -> None:
        for name in _UNITS.keys() - _OPTIONAL:
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"bearing.{name}", getattr(self, name), "> 0")
        if self.balls < 3:
            raise InputError("bearing.balls", self.balls, ">= 3")
        if not self.bore < self.pitch_diameter < self.outer_diameter:
            raise InputError(
                "bearing.pitch_diameter", self.pitch_diameter, "between bore and outside"
            )
        if not self.ring_thickness < 0.5 * (self.outer_diameter - self.pitch_diameter):
            raise InputError(
                "bearing.ring_thickness", self.ring_thickness, "outside the pitch circle"
            )

    @property
    def to_verify(self) -> bool:
        """Whether the source admits that numbers are recalled."""
        return "verify" in self.source


def read_cards(path: str | Path = CARDS) -> dict[str, BearingCard]:
    """Cards of a file, by the name of their table.

    Raises
    ------
    InputError
        For a file that is not TOML, a card without C0 or another value, an unknown key.
    """
    try:
        given = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError("cards", " ".join(str(error).split()), "a readable TOML file") from None
    return {name: _card(name, entry) for name, entry in given.items()}


def _card(name: str, entry: Any) -> BearingCard:
    if not isinstance(entry, dict):
        raise InputError(f"cards.{name}", entry, "a table")
    known = {*_UNITS, "name", "balls", "source"}
    for key in sorted(set(entry) - known):
        raise InputError(
            f"cards.{name}.{key}", "unknown key", f"one of: {', '.join(sorted(known))}"
        )
    for key in sorted(known - _OPTIONAL - set(entry)):
        raise InputError(f"cards.{name}.{key}", "missing", "given")
    values = {
        key: units.parse(entry[key], unit, f"cards.{name}.{key}")
        for key, unit in _UNITS.items()
        if key in entry
    }
    if isinstance(entry["balls"], bool) or not isinstance(entry["balls"], int):
        raise InputError(f"cards.{name}.balls", entry["balls"], "a whole number")
    return BearingCard(
        name=str(entry["name"]), balls=entry["balls"], source=str(entry["source"]), **values
    )

"""Cards put into a case as it is read: ``card = "NAME"`` fills what its table leaves out.

Cards come from the files shipped here and from ``cards.toml`` beside the case, which goes first.
A filled case names no cards any more: its resolved text holds every number and its source. So it
is with ``spring.catalogue``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.spring_selection import put_spring
from camwright.pipeline.case.toml_text import tables_of

KINDS = ("materials", "bushes", "oils", "wires", "bearings")
FOLDER = Path(__file__).parent
USER_FILE = "cards.toml"
USER_BYTES = 256 * 1024
CELSIUS = 273.15

Cards = Mapping[str, Mapping[str, Mapping[str, Any]]]


def fill_cards(case: dict[str, Any], folder: Path | None) -> None:
    """Put the cards that a case names into its tables, and the spring of its catalogue.

    Parameters
    ----------
    case : dict        tables of a case file, changed in place
    folder : Path      folder of the case; None: shipped cards only

    Raises
    ------
    InputError
        For an unknown card, or a file of cards that cannot be read.
    """
    put_spring(case, folder)
    named = [place for place in _places(case) if isinstance(place[2], dict) and "card" in place[2]]
    if not named:
        return
    cards = known_cards(folder)
    for field, kind, table in named:
        name = table.pop("card")
        card = cards[kind].get(name) if isinstance(name, str) else None
        if card is None:
            raise InputError(f"{field}.card", name, f"one of: {', '.join(sorted(cards[kind]))}")
        card = _oil(card, table, field) if kind == "oils" else card
        if kind == "bearings":
            card = tables_of(read_part(BearingCard, card, f"cards.{name}").bearing)
        own = dict(table)
        table.update(card)
        table.update(own)
        if "source" not in own:
            table["source"] = f"card {name}: {card['source']}"
        if kind == "bushes":
            _with_material(case, table["material"], cards["materials"])


def known_cards(folder: Path | None) -> Cards:
    """Shipped cards by kind and name, those of the user beside the case over them."""
    cards = {kind: dict(cards) for kind, cards in _shipped().items()}
    path = None if folder is None else folder / USER_FILE
    if path is None or not path.is_file():
        return cards
    for kind, own in read_toml(path, path.name, USER_BYTES).items():
        if kind not in KINDS or not isinstance(own, dict):
            raise InputError(f"{USER_FILE}: {kind}", "unknown", f"one of: {', '.join(KINDS)}")
        for name, card in own.items():
            cards[kind][name] = _sourced(card, f"{USER_FILE}: {kind}.{name}")
    return cards


def viscosity(at_40: float, at_100: float, temperature: float) -> float:
    """Kinematic viscosity (mm2/s) of an oil at a temperature (K) from those at 40 and 100 degC.

    References
    ----------
    Walther's equation, ASTM D341: log log (v + 0.7) is straight over log T.
    """
    low, high = (math.log10(math.log10(v + 0.7)) for v in (at_40, at_100))
    start, end = math.log10(CELSIUS + 40.0), math.log10(CELSIUS + 100.0)
    place = (math.log10(temperature) - start) / (end - start)
    return float(10.0 ** (10.0 ** (low + place * (high - low))) - 0.7)


@cache
def _shipped() -> Cards:
    files = {kind: FOLDER / f"{kind}.toml" for kind in KINDS}
    return {
        kind: {
            name: _sourced(card, f"{kind}.{name}")
            for name, card in read_toml(path, path.name, USER_BYTES).items()
        }
        for kind, path in files.items()
    }


def _sourced(card: Any, field: str) -> Mapping[str, Any]:
    """A card says where its numbers come from, or it is none."""
    if not isinstance(card, dict):
        raise InputError(field, card, "a table")
    if not isinstance(card.get("source"), str) or not card["source"].strip():
        raise InputError(f"{field}.source", "missing", "given: where the numbers come from")
    return card


def _places(case: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Every table that may name a card: its dotted name, the kind of card, the table."""

    def table(*path: str) -> Any:
        found: Any = case
        for part in path:
            found = found.get(part) if isinstance(found, dict) else None
        return found

    materials = table("materials")
    for name in materials if isinstance(materials, dict) else ():
        yield f"materials.{name}", "materials", materials[name]
    for side in ("a", "b"):
        yield f"guides.{side}", "bushes", table("guides", side)
    yield "lubricant", "oils", table("lubricant")
    yield "spring.design", "wires", table("spring", "design")
    yield "roller.bearing", "bearings", table("roller", "bearing")


def _with_material(case: dict[str, Any], name: Any, cards: Mapping[str, Any]) -> None:
    materials = case.setdefault("materials", {})
    if isinstance(materials, dict) and name not in materials and name in cards:
        card = cards[name]
        materials[name] = {**card, "source": f"card {name}: {card['source']}"}


def _oil(card: Mapping[str, Any], table: dict[str, Any], field: str) -> dict[str, Any]:
    """The dynamic viscosity of an oil's card at the temperature of the contact."""
    given = table.pop("temperature", "313.15 K")
    temperature = units.parse(given, "K", f"{field}.temperature")
    density = units.parse(card["density"], "kg/m^3", f"{field}.density")
    kinematic = viscosity(card["viscosity_40"], card["viscosity_100"], temperature)
    dynamic = 1e-6 * kinematic * density
    return {
        "viscosity": units.format(dynamic, "mPa s"),
        "pressure_viscosity": card["pressure_viscosity"],
        "source": f"{card['source']}; at {temperature - CELSIUS:.1f} degC by ASTM D341",
    }

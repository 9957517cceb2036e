"""Cards of a case: ``card = "NAME"`` supplies the keys that its table leaves out.

Cards are read from the files of this package and from ``cards.toml`` in the folder of the case,
which takes precedence. The resolved case states every value, its source in ``[sources]``, and no
card. The same holds for ``spring.catalogue``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import cast

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.missing_kinds import missing_kind
from camwright.pipeline.base.source import Source, entry_of, reworded, source_in
from camwright.pipeline.case.cards.bearing_cards import BearingCard, bearing_keys
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import (
    numbers_of,
    source_in_card,
    without_provenance,
)
from camwright.pipeline.case.cards.spring_selection import put_force, put_spring
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.case.value_sources import UNSTATED, put_sources
from camwright.pipeline.contact.cam_body import SECOND_BEARING

_RANGE = ("diameter_least", "diameter_most", "temperature_most")
KINDS = ("materials", "bushes", "oils", "wires", "gas_springs", "bearings")
FOLDER = Path(__file__).parent
USER_FILE = "cards.toml"
USER_BYTES = 256 * 1024

Cards = Mapping[str, Mapping[str, Tables]]
"""Cards by kind and name."""


def fill_cards(case: Tables, folder: Path | None) -> None:
    """Tables of a case completed from the cards and the spring catalogue it names.

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
    _fill_places(case, folder)
    put_force(case)


def _fill_places(case: Tables, folder: Path | None) -> None:
    """Complete, in place, each table of a case that names a card by the values of the card; values
    that the table states are kept.
    """
    named = [place for place in _places(case) if "card" in place[2]]
    if not named:
        return
    cards = known_cards(folder)
    for field, kind, table in named:
        name = table.pop("card")
        card = cards[kind].get(name) if isinstance(name, str) else None
        if card is None:
            missing = missing_kind(field, str(name))
            listed = f"; {missing.sentence}" if missing is not None else ""
            limit = f"one of: {', '.join(sorted(cards[kind]))}{listed}"
            raise InputError(f"{field}.card", str(name), limit)
        place, raw = f"cards.{kind}.{name}", card["source"]
        words = {key: source_in_card(card, key, place) for key in numbers_of(card)}
        if kind == "oils":
            words = _oil_words(words)
            card = _oil(card, table, place, field)
        elif kind == "wires":
            card = _wire(card, table, str(name), field)
            words = {key: source for key, source in words.items() if key not in _RANGE}
        elif kind == "bearings":
            words = bearing_keys(words)
            part = read_part(BearingCard, without_provenance(card), f"cards.{name}")
            if field == SECOND_BEARING:
                raw = _beside(part, case, raw)
            card = tables_of(part.bearing)
        own, stated = dict(table), card["source"] if kind == "oils" else raw
        table.update(without_provenance(card))
        table.update(own)
        if "source" not in own:
            table["source"] = _from_card(str(name), stated)
            words |= dict.fromkeys(numbers_of(own), UNSTATED)
        else:
            words = {key: source for key, source in words.items() if key not in own}
        entries = {key: entry_of(source) for key, source in words.items()}
        if "source" in own:  # a plain source of the card stays plain where it is read, as in a case
            entries |= {key: raw for key, source in words.items() if source == source_in(raw)}
        put_sources(case, field, table, entries)
        if kind == "bushes":
            material = _entry(table, "material", field)
            _with_material(case, material, cards["materials"])


def _beside(card: BearingCard, case: Tables, source: TomlValue) -> TomlValue:
    """Source of the bearing of the second roller, which says where its width is not that of the
    rollers: both have one line of contact and one mass by `roller.width`.
    """
    roller = case.get("roller")
    width = roller.get("width") if isinstance(roller, dict) else None
    if width is None or math.isclose(units.parse(width, "mm", "roller.width"), card.width):
        return source
    note = f"; {units.shown(card.width, 'mm')} wide, computed as wide as roller.width = {width}"
    return cast("TomlValue", reworded(source, lambda text: text + note))


def known_cards(folder: Path | None) -> Cards:
    """Cards by kind and name: the shipped ones, and those in ``cards.toml`` of `folder`, which take
    precedence; None: shipped ones alone.

    Raises
    ------
    InputError
        If the file is unreadable, has an unknown kind, or a card is no table or states no source.
    """
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
    """Kinematic viscosity (mm2/s) of an oil at a temperature (K), by its values at 40 and 100 degC.

    References
    ----------
    Walther's equation, ASTM D341: log log (v + 0.7) is linear in log T.
    """
    level = math.log10(math.log10(at_40 + 0.7))
    level -= thinning(at_40, at_100) * math.log10(temperature / 313.15)
    return float(10.0 ** (10.0**level) - 0.7)


def thinning(at_40: float, at_100: float) -> float:
    """Slope m of Walther's equation from kinematic viscosities (mm2/s) at 40 and 100 degC."""
    low, high = (math.log10(math.log10(v + 0.7)) for v in (at_40, at_100))
    return (low - high) / math.log10(373.15 / 313.15)


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


def _sourced(card: TomlValue, field: str) -> Tables:
    """The card; InputError if it is no table or states no source of its values."""
    if not isinstance(card, dict):
        raise InputError(field, str(card), "a table")
    if not source_in(card.get("source")):
        raise InputError(f"{field}.source", "missing", "given: the source of its values")
    return card


def _places(case: Tables) -> Iterator[tuple[str, str, Tables]]:
    """Every table that may name a card: its dotted name, the kind of card, the table."""
    materials = case.get("materials")
    kinds = {
        **{
            f"materials.{name}": "materials"
            for name in (materials if isinstance(materials, dict) else ())
        },
        "guides.a": "bushes",
        "guides.b": "bushes",
        "follower.pivot.bush": "bushes",
        "lubricant": "oils",
        "spring.design": "wires",
        "spring.gas": "gas_springs",
        "roller.bearing": "bearings",
        SECOND_BEARING: "bearings",
    }
    for field, kind in kinds.items():
        table: TomlValue | None = case
        for part in field.split(".", 1 if field.startswith("materials.") else -1):
            table = table.get(part) if isinstance(table, dict) else None
        if isinstance(table, dict):
            yield field, kind, table


def _with_material(case: Tables, name: TomlValue, cards: Mapping[str, Tables]) -> None:
    """Put the card of the material that a bush names among the materials of the case, in place,
    unless the case has one of its name.

    Parameters
    ----------
    case : Tables     changed
    name : value      of the material, as the bush states it
    cards : mapping   cards of materials by name
    """
    materials = case.setdefault("materials", {})
    if isinstance(materials, dict) and isinstance(name, str) and name not in materials:
        card = cards.get(name)
        if card is not None:
            place = f"cards.materials.{name}"
            source = _from_card(name, card["source"])
            words = {key: entry_of(source_in_card(card, key, place)) for key in numbers_of(card)}
            materials[name] = {**without_provenance(card), "source": source}
            put_sources(case, f"materials.{name}", materials[name], words)


def _from_card(name: str, source: TomlValue) -> TomlValue:
    """Source of a table that a card of that name fills, from the one of the card."""
    return cast("TomlValue", reworded(source, lambda text: f"card {name}: {text}"))


def _oil_words(words: Mapping[str, Source]) -> dict[str, Source]:
    """Sources of the values of a lubricant by key, from those of the values of its oil; the
    viscosity, which is interpolated, has those of the values it is made of.
    """
    made_of = ("viscosity_40", "viscosity_100", "density")
    used = dict.fromkeys(words[key] for key in made_of if key in words)
    text = "; ".join(dict.fromkeys(source.text for source in used))
    viscosity = Source(text, confirmed=all(source.confirmed for source in used))
    kept = {key: source for key, source in words.items() if key not in made_of}
    return kept | {"viscosity": viscosity}


def _oil(card: Tables, table: Tables, source: str, field: str) -> Tables:
    """The dynamic viscosity of an oil's card at the temperature of the contact.

    Parameters
    ----------
    card : dict         of the oil, `source` its dotted name
    table : dict        of the lubricant, `field` its dotted name
    """
    temperature = units.parse(table.get("temperature", "313.15 K"), "K", f"{field}.temperature")
    density = units.parse(_entry(card, "density", source), "kg/m^3", f"{source}.density")
    at_40, at_100 = (_positive(card, f"viscosity_{celsius}", source) for celsius in (40, 100))
    dynamic = 1e-6 * viscosity(at_40, at_100, temperature) * density
    converted = f"; at {units.celsius(temperature):.1f} degC by ASTM D341"
    return {
        "viscosity": units.format(dynamic, "mPa s"),
        "pressure_viscosity": _entry(card, "pressure_viscosity", source),
        "temperature": units.format(temperature, "degC"),
        "thinning": round(thinning(at_40, at_100), 3),
        **{
            key: card[key]
            for key in ("scuffing_temperature", "boundary_temperature")
            if key in card
        },
        "source": reworded(card["source"], lambda text: text + converted),
    }


def _wire(card: Tables, table: Tables, name: str, field: str) -> Tables:
    """Values of the card of a spring wire by key, after a check that the card holds for the
    diameter and temperature of the spring.

    Parameters
    ----------
    card : Tables    of the wire
    table : Tables   `[spring.design]`, as stated
    name : str       of the card
    field : str      dotted name of the table, for messages

    Raises
    ------
    InputError
        If the wire is thinner, thicker or hotter, and its strength is not stated.
    """
    known = wire_values(card)
    if {"strength_at_1mm", "strength_exponent"} <= table.keys():
        return known

    def stated(key: str, unit: str) -> float | None:
        return units.parse(table[key], unit, f"{field}.{key}") if key in table else None

    def end(key: str, unit: str, otherwise: float) -> float:
        return (
            units.parse(card[key], unit, f"cards.wires.{name}.{key}") if key in card else otherwise
        )

    own = "; or with strength_at_1mm and strength_exponent of the wire"
    diameter, temperature = stated("wire_diameter", "m"), stated("temperature", "K")
    least, most = end("diameter_least", "m", 0.0), end("diameter_most", "m", math.inf)
    if diameter is not None and not least <= diameter <= most:
        limit = (
            f"from {units.shown(least, 'mm')} to {units.shown(most, 'mm')}, for which card {name}"
        )
        limit += f" has the strength{own}"
        raise InputError(
            f"{field}.wire_diameter", units.rounded(str(table["wire_diameter"])), limit
        )
    hottest = end("temperature_most", "K", math.inf)
    if temperature is not None and temperature > hottest:
        limit = f"<= {units.celsius(hottest):g} degC, up to which card {name} has the strength{own}"
        raise InputError(f"{field}.temperature", units.rounded(str(table["temperature"])), limit)
    return known


def wire_values(card: Tables) -> Tables:
    """Values of a wire card, without the diameters and temperature they hold for."""
    return {key: value for key, value in card.items() if key not in _RANGE}


def _positive(card: Tables, key: str, field: str) -> float:
    """Value of a key of a card that is a number above zero without a unit; InputError, with the
    dotted name `field` of the card, for any other.
    """
    value = _entry(card, key, field)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 < value < math.inf:
        raise InputError(f"{field}.{key}", str(value), "> 0, a number without a unit")
    return float(value)


def _entry(card: Tables, key: str, field: str) -> TomlValue:
    if key not in card:
        raise InputError(f"{field}.{key}", "missing", "given")
    return card[key]

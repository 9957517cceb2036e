"""Bearing cards of a file, as the shipped one and that beside a case are read."""

from pathlib import Path

from camwright.pipeline.base.files import read_toml
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import FOLDER
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import without_provenance

CARDS = FOLDER / "bearings.toml"


def read_cards(path: Path = CARDS) -> dict[str, BearingCard]:
    tables = read_toml(path, "cards", 64 * 1024)
    return {
        name: read_part(
            BearingCard,
            without_provenance(table) if isinstance(table, dict) else table,
            f"cards.{name}",
        )
        for name, table in tables.items()
    }

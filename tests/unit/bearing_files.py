"""Bearing cards of a file, as the shipped one and that beside a case are read."""

from pathlib import Path

from camwright.pipeline.base.files import read_toml
from camwright.pipeline.case.cards.bearing_cards import CARDS, BearingCard, read_card


def read_cards(path: Path = CARDS) -> dict[str, BearingCard]:
    tables = read_toml(path, "cards", 64 * 1024)
    return {name: read_card(name, table) for name, table in tables.items()}

"""Bearing cards of a file, as the shipped one and that beside a case are read."""

from pathlib import Path

from pipeline.files import read_toml
from pipeline.follower.bearing_cards import CARDS, BearingCard, read_card


def read_cards(path: Path = CARDS) -> dict[str, BearingCard]:
    tables = read_toml(path, "cards", 64 * 1024)
    return {name: read_card(name, table) for name, table in tables.items()}

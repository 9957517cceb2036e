"""Seats of a camshaft: cam bore and keyway, with the ball bearing of the same bore."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.quantities import Force, Length, Part
from camwright.pipeline.base.source import Source, source_in
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.toml_text import Tables

_FILE = Path(__file__).with_name("shaft_seats.toml")
_BYTES_MAX = 64 * 1024


@dataclass(frozen=True, kw_only=True)
class Seat(Part):
    """Cam bore with keyway, and the ball bearing of the same bore with its width."""

    table: ClassVar[str] = "seat"

    bore: Length
    key_width: Length
    hub_depth: Length
    bearing: str
    width: Length
    C: Force
    C0: Force


def seats() -> tuple[Seat, ...]:
    """Shipped cam seats with their bearings, by increasing bore."""
    table: Tables = read_toml(_FILE, _FILE.name, _BYTES_MAX)
    rows = table["seat"]
    listed = rows if isinstance(rows, list) else []
    read = [read_part(Seat, row, f"cards.seat[{k}]") for k, row in enumerate(listed)]
    return tuple(sorted(read, key=lambda seat: seat.bore))


def seat_source() -> Source:
    """Source of the seats."""
    return source_in(read_toml(_FILE, _FILE.name, _BYTES_MAX)["source"])

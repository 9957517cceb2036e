"""Closure in the tables of a case: what stands for the spring that a cam does without."""

from __future__ import annotations

from camwright.pipeline.base import units
from camwright.pipeline.base.source import Source, entry_of
from camwright.pipeline.case.toml_text import Tables, TomlValue
from camwright.pipeline.contact.cam_body import TWO_TRACKS

_NONE = Source("none: cam or weight hold the follower", confirmed=True)
_NO_RATE, _NO_PRELOAD = 1e-6, 1e-9  # N/m, N


def with_closure(tables: Tables) -> Tables:
    """Tables of a case with, in place of the missing spring of a cam that pulls its follower or
    bears its weight, one of negligible force; other cases unchanged.

    A cam whose closure is misspelt, or left out beside a table of one, is refused by that later,
    not by its missing spring.
    """
    cam = tables.get("cam")
    if not isinstance(cam, dict) or "spring" in tables:
        return tables
    closure = cam.get("closure", "spring")
    if closure == "spring" and not any(each in cam for each in TWO_TRACKS):
        return tables
    source: TomlValue = entry_of(_NONE)
    rate, preload = units.format(_NO_RATE, "kN/m"), units.format(_NO_PRELOAD, "N")
    return tables | {"spring": {"rate": rate, "preload": preload, "source": source}}

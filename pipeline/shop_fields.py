"""The shop in a case file: its tool, how dense its tables are, how true its chords."""

from __future__ import annotations

from math import radians
from typing import Annotated

from pipeline.case_fields import In, Length, Section


class Shop(Section):
    """What the files of ``shop/`` are written for.

    table_step : rad        between the rows of its tables
    tool_radius : m         of the cutter or grinding wheel; the roller's, or base circle's, if none
    chord_error : m         of the drawing's polyline; by default its area is true to a millionth
    """

    table_step: Annotated[float, In("deg", at_least=0.1, at_most=1)] = radians(0.5)
    tool_radius: Length | None = None
    chord_error: Annotated[float, In("um", at_least=0.001, at_most=1000)] | None = None

"""The workshop in a case file: its tool, the step of its tables, the error of its chords."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Annotated

from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.base.quantities import In, Length
from camwright.pipeline.case.section import Section

FORM_TOLERANCE = 20e-6
"""m: band of the inspection sheet where the case states no profile tolerance."""


class Workshop(Section):
    """What the files of ``workshop/`` are written for.

    table_step : rad        between the rows of its tables
    tool_radius : m         of the cutter or grinding wheel; the roller's, or base circle's, if none
    chord_error : m         of the drawing's polyline; by default its area is true to a millionth
    """

    table_step: Annotated[float, In("deg", at_least=0.1, at_most=1)] = radians(0.5)
    tool_radius: Length | None = None
    chord_error: Annotated[float, In("um", at_least=0.001, at_most=1000)] | None = None


@dataclass(frozen=True)
class WorkshopOrder:
    """Step of the tables, rad; tool, tolerance band of the form, chord error, m.

    A tool of the roller's radius, or the base circle's, is taken where none is given: it fits
    wherever the follower does.
    """

    step: float
    tool_radius: float | None
    tolerance: float
    chord_error: float | None

    @property
    def theta(self) -> Array:
        """Angles of the tables (n,), rad: the nearest equal division of the turn."""
        return uniform_turn(round(2.0 * pi / self.step))

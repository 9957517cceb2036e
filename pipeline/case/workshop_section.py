"""Workshop section of a case file: tool, table step, chord error."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Annotated

from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.base.quantities import In, Length
from camwright.pipeline.case.section import Section


class Workshop(Section):
    """Settings of the files in ``workshop/``.

    table_step : rad        between the rows of the tables
    tool_radius : m         of milling cutter or grinding wheel; by default that of the roller, or
                            of the base circle
    chord_error : m         of the polyline of the drawing; by default its area is exact to 1e-6
    """

    table_step: Annotated[float, In("deg", at_least=0.1, at_most=1)] = radians(0.5)
    tool_radius: Length | None = None
    chord_error: Annotated[float, In("um", at_least=0.001, at_most=1000)] | None = None


@dataclass(frozen=True)
class WorkshopOrder:
    """Step of the tables, rad; tool radius, tolerance band of the form, chord error, m.

    Without a tool radius that of the roller, or of the base circle, is used: such a tool fits
    wherever the follower does.
    """

    step: float
    tool_radius: float | None
    tolerance: float
    chord_error: float | None

    @property
    def theta(self) -> Array:
        """Cam angles of the tables (n,), rad: the nearest equal division of the turn."""
        return uniform_turn(round(2.0 * pi / self.step))

"""Sections of the workshop files and of the title block of drawing and sign-off sheet."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, radians
from typing import Annotated, ClassVar

from camwright.geometry.arc_polyline import ARC_ERROR
from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.base.fits import BoreFit, KeywayFit
from camwright.pipeline.base.quantities import Characters, In, Length
from camwright.pipeline.case.section import Section


class Workshop(Section):
    """Settings of the files in ``workshop/``.

    table_step : rad        between the rows of the tables
    tool_radius : m         of milling cutter or grinding wheel; by default that of the roller, or
                            of the base circle
    arc_error : m           of the arcs of the drawing from the contour
    bore_fit, keyway_fit    tolerance classes of ISO 286 on the drawing
    """

    table_step: Annotated[float, In("deg", at_least=0.1, at_most=1)] = radians(0.5)
    tool_radius: Length | None = None
    arc_error: Annotated[float, In("um", at_least=0.001, at_most=1000)] = ARC_ERROR
    bore_fit: BoreFit = "H7"
    keyway_fit: KeywayFit = "JS9"


Entry = Annotated[str, Characters(1, 60)]


class Document(Section):
    """Title block of drawing and sign-off sheet; an entry left out is a field to fill by hand."""

    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("project", "part_number", "revision", "author", "date", "material"),
        "an empty field, to fill by hand",
    )

    project: Entry | None = None
    part_number: Entry | None = None
    revision: Annotated[str, Characters(1, 12)] | None = None
    author: Entry | None = None
    date: dt.date | None = None
    material: Entry | None = None


@dataclass(frozen=True)
class WorkshopOrder:
    """Step of the tables, rad; tool radius, tolerance band of the form, error of the arcs, m.

    Without a tool radius that of the roller, or of the base circle, is used: such a tool fits
    wherever the follower does.
    """

    step: float
    tool_radius: float | None
    tolerance: float
    arc_error: float

    @property
    def theta(self) -> Array:
        """Cam angles of the tables (n,), rad: the nearest equal division of the turn."""
        return uniform_turn(round(2.0 * pi / self.step))

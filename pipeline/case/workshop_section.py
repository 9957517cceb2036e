"""Case sections of the workshop files, and of the title block of drawings."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, radians
from typing import Annotated, ClassVar

from camwright.geometry.arc_polyline import ARC_ERROR
from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.base.fits import BoreFit, KeywayFit
from camwright.pipeline.base.quantities import Characters, In, Known, Length
from camwright.pipeline.case.section import Section


class Workshop(Section):
    """Settings of the files in ``workshop/``.

    Without a tool radius it is that of the roller, or of the base circle. The fits are tolerance
    classes of ISO 286.
    """

    table_step: Annotated[float, In("deg", at_least=0.1, at_most=1), Known("machine tool")] = (
        radians(0.5)
    )
    """cam angle between the rows of the tables"""
    tool_radius: Annotated[Length | None, Known("machine tool", "25 mm")] = None
    """radius of milling cutter or grinding wheel"""
    arc_error: Annotated[float, In("um", at_least=0.001, at_most=1000), Known("machine tool")] = (
        ARC_ERROR
    )
    """greatest distance of the arcs of the drawing from the contour"""
    bore_fit: Annotated[BoreFit, Known("seat of the cam on its shaft")] = "H7"
    """tolerance class of the bore, on the drawing"""
    keyway_fit: Annotated[KeywayFit, Known("DIN 6885: light or tight fit")] = "JS9"
    """tolerance class of the keyway's width, on the drawing"""


Entry = Annotated[str, Characters(1, 60)]


class Document(Section):
    """Title block of drawing and sign-off sheet; an entry left out is a field to fill by hand."""

    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("project", "part_number", "revision", "author", "date", "material"),
        "an empty field, to fill by hand",
    )

    project: Annotated[Entry | None, Known("own choice", "Balancing of a one-cylinder engine")] = (
        None
    )
    """project"""
    part_number: Annotated[Entry | None, Known("parts list", "CW-0042")] = None
    """number of the cam"""
    revision: Annotated[str | None, Characters(1, 12), Known("parts list", "A")] = None
    """revision of the documents"""
    author: Annotated[Entry | None, Known("own responsibility", "A. Engineer")] = None
    """name of who prepared the documents"""
    date: Annotated[dt.date | None, Known("own responsibility", dt.date(2026, 3, 2))] = None
    """date of the documents; none is taken from the clock"""
    material: Annotated[
        Entry | None, Known("parts list", "16MnCr5, EN ISO 683-3, case-hardened")
    ] = None
    """ordering designation of the material of the cam"""


@dataclass(frozen=True)
class WorkshopOrder:
    """Workshop tables: angle step, rad; tool radius, form tolerance, error of the arcs, m.

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

"""The lift of a case file: a table, motion laws by segments, points, or an eccentric circle."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from camwright.geometry.motion_laws import DWELL, LAWS, Segment, SegmentMotion
from camwright.pipeline.base.quantities import FileName, In, Length
from camwright.pipeline.case.section import Section, Table, refusal, suggestion
from camwright.pipeline.case.toml_text import TomlValue
from camwright.pipeline.engine.cylinder import LiftPoint

Stroke = Annotated[float, In("mm", above=-10_000, below=10_000)]


def _known_law(name: str) -> str:
    laws = (DWELL, *LAWS)
    if name not in laws:
        raise refusal(f"a motion law{suggestion(name, laws)}")
    return name


LawName = Annotated[str, AfterValidator(_known_law)]


class LiftTable(Section):
    """Lift over one cam turn, from a file: cam angle column, lift column.

    Without `noise` the lift passes through every row; with it, the standard deviation of the
    rows' errors, a smoother lift is fitted and the residual stated.
    """

    kind: Literal["table"] = "table"
    file: FileName
    noise: Annotated[float, In("um", above=0, at_most=1e6)] | None = None


class LiftSegment(Section):
    """A rise (stroke > 0), a return (< 0) or a dwell over an angle of the cam."""

    law: LawName
    angle: Annotated[float, In("deg", above=0, at_most=360)]
    stroke: Stroke = 0.0


class LiftSegments(Section):
    """Lift by motion laws; the segments, times `repeat`, fill the turn."""

    kind: Literal["segments"]
    repeat: Annotated[int, Field(ge=1, le=12)] = 1
    segments: Annotated[
        tuple[LiftSegment, ...], Field(alias="segment", strict=False, min_length=1, max_length=64)
    ]


class LiftPoints(Section):
    """Lift by a B-spline through points of one cam turn."""

    kind: Literal["points"]
    points: Annotated[
        tuple[Table[LiftPoint], ...],
        Field(alias="point", strict=False, min_length=6, max_length=720),
    ]


class LiftEccentric(Section):
    """Lift of an eccentric circle."""

    kind: Literal["eccentric"]
    eccentricity: Length


def _kind(
    lift: TomlValue | LiftTable | LiftSegments | LiftPoints | LiftEccentric,
) -> str | None:
    """The kind of a lift; a table may leave it out. None for what is no table."""
    if isinstance(lift, dict):
        return str(lift.get("kind", "table"))
    if isinstance(lift, (LiftTable, LiftSegments, LiftPoints, LiftEccentric)):
        return lift.kind
    return None


GivenLift = Annotated[
    Annotated[LiftTable, Tag("table")]
    | Annotated[LiftSegments, Tag("segments")]
    | Annotated[LiftPoints, Tag("points")]
    | Annotated[LiftEccentric, Tag("eccentric")],
    Discriminator(_kind),
]
LIFT_KINDS = ("table", "segments", "points", "eccentric")


def motion_of(section: LiftSegments) -> SegmentMotion:
    """Motion of the segments of a case.

    Raises
    ------
    InputError
        If they do not add up to a turn or do not close.
    """
    segments = tuple(Segment(part.law, part.angle, part.stroke) for part in section.segments)
    return SegmentMotion(segments, section.repeat)

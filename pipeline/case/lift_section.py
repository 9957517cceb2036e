"""Lift section of a case file: table, segments of motion laws, points, or eccentric circle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from camwright.geometry.motion_laws import DWELL, LAWS, Segment, SegmentMotion
from camwright.pipeline.base.quantities import Angle, FileName, In, Known, Length, Used
from camwright.pipeline.case.section import Section, Table, refusal, suggestion
from camwright.pipeline.case.toml_text import TomlValue
from camwright.pipeline.engine.cylinder import LiftPoint

Stroke = Annotated[float, In("mm", above=-10_000, below=10_000)]


def _known_law(name: str) -> str:
    """Name of a motion law or dwell itself; refused, with the closest one, if it is unknown."""
    laws = (DWELL, *LAWS)
    if name not in laws:
        raise refusal(f"a motion law{suggestion(name, laws)}")
    return name


LawName = Annotated[str, AfterValidator(_known_law)]


class LiftTable(Section):
    """Lift over one cam turn, from a file: cam angle column, lift column.

    Without `noise` the lift passes through every row; with it, a smoother lift is fitted and the
    residual stated.
    """

    kind: Annotated[Literal["table"], Known("own choice")] = "table"
    """form in which the lift is stated"""
    file: Annotated[FileName, Known("measured, or lift design", "lift.csv")]
    """table of cam angle and lift, relative to the case file"""
    noise: Annotated[
        float | None, In("um", above=0, at_most=1e6), Known("measuring machine", "5 um")
    ] = None
    """standard deviation of the errors of the table, which is smoothed by it"""


class LiftSegment(Section):
    """A rise (stroke > 0), a return (< 0) or a dwell over an angle of the cam."""

    law: Annotated[LawName, Known("VDI 2143-1; Norton (2009) ch. 4", "modified_sine")]
    """motion law of the segment"""
    angle: Annotated[
        float, In("deg", above=0, at_most=360), Known("timing of the machine", "50 deg")
    ]
    """cam angle of the segment"""
    stroke: Annotated[Stroke, Known("timing of the machine")] = 0.0
    """rise, or return where negative; 0: dwell; with an arm an angle of its swing, too"""


class LiftSegments(Section):
    """Lift by motion laws; the segments, times `repeat`, fill the turn."""

    kind: Literal["segments"]
    repeat: Annotated[int, Field(ge=1, le=12), Known("own choice")] = 1
    """times that the segments fill the turn: lobes"""
    segments: Annotated[
        tuple[LiftSegment, ...],
        Field(alias="segment", strict=False, min_length=1, max_length=64),
        Used("lift"),
    ]
    """motion laws in the order of the turn"""


@dataclass(frozen=True, kw_only=True)
class CamLiftPoint(LiftPoint):
    """One point of the lift of a cam."""

    angle: Annotated[Angle, Known("measured, or own choice", "90 deg")]
    """cam angle of the point"""
    lift: Annotated[
        float, In("mm", at_least=0, at_most=1000), Known("measured, or own choice", "4 mm")
    ]
    """lift at this cam angle; with an arm an angle of its swing, too"""


class LiftPoints(Section):
    """Lift by a B-spline through points of one cam turn."""

    kind: Literal["points"]
    points: Annotated[
        tuple[Table[CamLiftPoint], ...],
        Field(alias="point", strict=False, min_length=6, max_length=720),
        Used("lift"),
    ]
    """points of the lift, joined by a spline"""


class LiftEccentric(Section):
    """Lift of an eccentric circle."""

    kind: Literal["eccentric"]
    eccentricity: Annotated[Length, Known("drawing", "10 mm")]
    """distance of the disc's centre from the cam axis"""


def _kind(
    lift: TomlValue | LiftTable | LiftSegments | LiftPoints | LiftEccentric,
) -> str | None:
    """Kind of a lift section; "table" where a file alone is stated, None where nothing tells it."""
    if isinstance(lift, dict):
        kind = lift.get("kind", "table" if "file" in lift else None)
        return None if kind is None else str(kind)
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
    """Motion by the segments of a case.

    Raises
    ------
    InputError
        If they do not add up to a turn or do not close.
    """
    segments = tuple(Segment(part.law, part.angle, part.stroke) for part in section.segments)
    return SegmentMotion(segments, section.repeat)

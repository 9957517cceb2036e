"""Form of ``redesign.json``, the output of ``design parts --json``."""

from typing import Literal

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import Count, Sha256, form
from camwright.pipeline.records.judgement_record import (
    DraftJudgement,
    PreviewJudgement,
    RefusedJudgement,
)

Against = Literal["size", "mass"]


@form()
class ChoiceRecord(TypedDict):
    """Parts of a choice."""

    roller: str
    """Name of the roller."""
    spring: str
    """Name of the spring."""
    bush: str
    """Name of the bushes."""
    room_mm: float | None
    """Limit of the cam radius; null: that of the case."""


@form()
class FrontPoint(ChoiceRecord, PreviewJudgement):
    """A point of the front."""

    file: str
    """Name of its case file."""


@form()
class RefusedChoice(ChoiceRecord):
    """A choice that is solved in full and not on the front."""

    why: str
    """Reason, in one line."""


@form()
class TriedPoint(ChoiceRecord, DraftJudgement):
    """A choice by the synthesis alone."""


@form()
class TriedRefusal(ChoiceRecord, RefusedJudgement):
    """A choice without a cam."""


@form()
class PrunedRecord(TypedDict):
    """A part excluded without solution."""

    part: str
    """Name of the part."""
    why: str
    """Reason, in one line."""
    limit: str
    """Id of the limit that excludes it; empty: none."""


@form()
class ExcludingLimit(TypedDict):
    """A limit that excludes choices."""

    limit: str
    """Id of the check, or the key of the case that is refused."""
    title: str
    """Limit in words; empty for a key."""
    count: Count
    """Number of choices and parts that it excludes."""


@form()
class ExclusionReasons(TypedDict):
    """Limits that exclude all choices, and what would admit one."""

    excluded: list[ExcludingLimit]
    """Limits by the number of choices that they exclude."""
    nearest: str | None
    """Parts of the choice that exceeds its limit least; null: those of the case."""
    conflict: list[str]
    """Ids of its conflicting limits."""
    ways: list[str]
    """Changes that would admit it, the smallest first."""


@form()
class ExclusionRecord(ExclusionReasons):
    """Reasons why no choice is on the front."""

    lines: list[str]
    """All in words."""


@form()
class RedesignDocument(TypedDict):
    """Front of ripple and size or mass over the catalogues."""

    schema: Literal[2]
    """Number of the form of this record."""
    case: str
    """Name of the case."""
    input_sha256: Sha256
    """Hash of the case file with its included files."""
    version: str
    """Hash of the source text of the program."""
    against: Against
    """Second objective beside the ripple."""
    given: PreviewJudgement | RefusedJudgement
    """The case before any change."""
    points: list[FrontPoint]
    """Points of the front by increasing size or mass."""
    refused: list[RefusedChoice]
    """Other choices that were solved in full."""
    without_result: ExclusionRecord | None
    """Reasons why no choice is on the front; null where one is."""
    pruned: list[PrunedRecord]
    """Parts excluded without solution."""
    as_given: list[str]
    """Lines on the kinds of part that are not exchanged, and why."""
    tried: list[TriedPoint | TriedRefusal]
    """All choices by the synthesis alone."""

"""Form of ``redesign.json``, the output of ``redesign --json``, and of the points in its store."""

from collections.abc import Mapping
from typing import Literal

from typing_extensions import TypedDict, TypeIs

from camwright.pipeline.base.verdict import Verdict
from camwright.pipeline.records.forms import Count, Sha256, form
from camwright.pipeline.records.trial_contents import ConflictRecord

Against = Literal["size", "mass"]


@form()
class RefusedPoint(TypedDict):
    """A case without a cam."""

    feasible: Literal[False]
    """There is no such cam."""
    why: str
    """Reason, in one line."""


@form()
class RoughRecord(TypedDict):
    """Result of the synthesis alone, SI."""

    feasible: bool
    """Whether it keeps the limits."""
    ripple: float
    """Torque ripple left over that of the engine."""
    cam_radius: float
    """Greatest radius of the contour, m."""
    mass: float
    """Mass of cam, follower and half of the spring, kg."""
    limit: str
    """Id of the limit furthest exceeded; empty where it is feasible."""
    utilisation: float
    """Utilisation of that limit; 0 where it is feasible."""
    prime_radius: float
    """Prime radius, m."""
    preload: float
    """Preload of the spring, N."""
    lift_max: float
    """Maximum lift, m."""
    binding: list[str]
    """Ids of the limits that are used up, the most used first."""


@form()
class Shortfall(TypedDict):
    """A blocking check that fails."""

    check: str
    """Id of the check."""
    title: str
    """Quantity checked, in words."""
    demand: float | None
    """Demand in its unit; null: infinite."""
    limit: float | None
    """Limit in its unit; null: infinite."""
    unit: str
    """Unit of demand and limit."""
    utilisation: float | None
    """Demand over limit, or limit over it for a least value; null: infinite."""


@form()
class PointRecord(TypedDict):
    """Result of a case by its preview."""

    feasible: bool
    """Whether the synthesis keeps its limits."""
    verdict: Verdict
    """Verdict of the preview, without the certificate of a sign-off."""
    ripple_before_Nm: float
    """Standard deviation of the engine torque."""
    ripple_left_Nm: float
    """Standard deviation of the crank torque with the cam."""
    torque_reduction: float
    """1 less the ripple left over that before."""
    cam_radius_mm: float
    """Greatest radius of the contour."""
    mass_g: float
    """Mass of cam, follower and half of the spring."""
    prime_radius_mm: float
    """Prime radius of the cam."""
    preload_N: float
    """Preload of the spring."""
    spring_rate_N_per_mm: float
    """Rate of the spring."""
    lift_max_mm: float
    """Maximum lift."""
    pressure_angle_max_deg: float
    """Maximum pressure angle."""
    normal_force_max_N: float
    """Greatest contact force of all load cases."""
    p0_max_MPa: float | None
    """Greatest contact pressure; null where the contour bounds no body."""
    failing: list[str]
    """Ids of the blocking checks that fail, the worst first."""
    shortfalls: list[Shortfall]
    """The same with their figures."""
    open: list[str]
    """Ids of the blocking checks that lack data."""
    binding: list[str]
    """Ids of the limits by decreasing shadow price."""


@form()
class ConflictPoint(ConflictRecord):
    """A case whose limits conflict."""

    feasible: bool
    """False: they are not kept together."""


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
class FrontPoint(ChoiceRecord, PointRecord):
    """A point of the front."""

    file: str
    """Name of its case file."""


@form()
class RefusedChoice(ChoiceRecord):
    """A choice that is solved in full and not on the front."""

    why: str
    """Reason, in one line."""


@form()
class TriedPoint(ChoiceRecord, RoughRecord):
    """A choice with its point of the synthesis alone."""


@form()
class TriedRefusal(ChoiceRecord, RefusedPoint):
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

    schema: Literal[1]
    """Number of the form of this record."""
    case: str
    """Name of the case."""
    input_sha256: Sha256
    """Hash of the case file with its included files."""
    version: str
    """Hash of the source text of the program."""
    against: Against
    """Second objective beside the ripple."""
    given: PointRecord | RefusedPoint
    """The case before any change."""
    points: list[FrontPoint]
    """Points of the front by increasing size or mass."""
    refused: list[RefusedChoice]
    """Other choices that were solved in full."""
    without_result: ExclusionRecord | None
    """Reasons why no choice is on the front; null where one is."""
    pruned: list[PrunedRecord]
    """Parts excluded without solution."""
    tried: list[TriedPoint | TriedRefusal]
    """All choices by the synthesis alone."""


def is_refused(record: Mapping[str, object]) -> TypeIs[RefusedPoint]:
    """Whether the record of a point says that its case has no cam."""
    return "why" in record


def is_whole(record: Mapping[str, object]) -> TypeIs[PointRecord]:
    """Whether the record of a point is that of a full preview, not of a draft."""
    return {"feasible", "shortfalls"} <= record.keys()

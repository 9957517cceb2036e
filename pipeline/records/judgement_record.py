"""Forms of the judgements of changed cases, as a search stores them."""

from collections.abc import Mapping
from typing import Literal

from typing_extensions import TypedDict, TypeIs

from camwright.pipeline.base.verdict import Verdict
from camwright.pipeline.records.forms import form
from camwright.pipeline.records.trial_contents import ConflictRecord


@form()
class RefusedJudgement(TypedDict):
    """A case without a cam."""

    feasible: Literal[False]
    """There is no such cam."""
    why: str
    """Reason, in one line."""


@form()
class SynthesisedCam(TypedDict):
    """Cam and spring of a synthesis, with units in the names."""

    feasible: bool
    """Whether the synthesis keeps its limits."""
    cam_radius_mm: float
    """Greatest radius of the contour."""
    mass_g: float
    """Mass of cam, follower and half of the spring."""
    prime_radius_mm: float
    """Prime radius of the cam."""
    preload_N: float
    """Preload of the spring."""
    lift_max_mm: float
    """Maximum lift."""
    binding: list[str]
    """Ids of the limits that are used up, or exceeded if it is not feasible, the worst first."""


@form()
class DraftJudgement(SynthesisedCam):
    """A case by its synthesis alone."""

    ripple_left_share: float
    """Torque ripple left over that of the engine."""
    limit: str
    """Id of the limit furthest exceeded; empty where it is feasible."""
    utilisation: float
    """Utilisation of that limit; 0 where it is feasible."""


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
class PreviewJudgement(SynthesisedCam):
    """A case by its preview."""

    verdict: Verdict
    """Verdict of the preview, without the certificate of a sign-off."""
    ripple_before_Nm: float
    """Standard deviation of the engine torque."""
    ripple_left_Nm: float
    """Standard deviation of the crank torque with the cam."""
    torque_reduction: float
    """1 less the ripple left over that before."""
    spring_rate_N_per_mm: float
    """Rate of the spring."""
    pressure_angle_max_deg: float
    """Maximum pressure angle."""
    normal_force_max_N: float | None
    """Greatest contact force of the load cases without lift-off or locking; null without one."""
    p0_max_MPa: float | None
    """Greatest contact pressure; null there, too, and where the contour bounds no body."""
    failing: list[str]
    """Ids of the blocking checks that fail, the worst first."""
    shortfalls: list[Shortfall]
    """The same with their figures."""
    open: list[str]
    """Ids of the blocking checks that lack data."""


@form()
class ConflictJudgement(ConflictRecord):
    """A case whose limits conflict."""

    feasible: bool
    """False: they are not kept together."""


def is_refused(record: Mapping[str, object]) -> TypeIs[RefusedJudgement]:
    """Whether the record of a judgement says that its case has no cam."""
    return "why" in record


def is_whole(record: Mapping[str, object]) -> TypeIs[PreviewJudgement]:
    """Whether the record of a judgement is of a full preview, not of a draft."""
    return {"feasible", "shortfalls"} <= record.keys()

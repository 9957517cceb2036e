"""Form of the output of ``check --json``."""

from typing import Annotated, Literal, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Status
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.forms import (
    Count,
    JsonBound,
    Least0,
    Sha256,
    Time,
    Unit,
    form,
)
from camwright.pipeline.records.run_summary import (
    BindingRecord,
    Finding,
    HeadlineRecord,
    LoadEndRecord,
    Measurement,
    StatedVerdict,
)

Role = Literal["prepared", "checked", "approved"]
ChangeKind = Literal["status", "demand", "limit", "new", "gone"]


@form()
class LoadCaseFigures(TypedDict):
    """Figures of a stated load case; null: not known."""

    load_case: str
    """Name of the load case."""
    speed_rpm: float | None
    """Speed of the machine."""
    cam_speed_rpm: float | None
    """Speed of the cam."""
    normal_force_min_N: float | None
    """Least contact force."""
    normal_force_max_N: float | None
    """Greatest contact force."""
    drive_torque_min_Nm: float | None
    """Least torque that drives the cam."""
    drive_torque_max_Nm: float | None
    """Greatest torque that drives the cam."""
    p0_hertz_max_MPa: float | None
    """Greatest contact pressure by Hertz."""
    half_width_max_mm: float | None
    """Greatest half-width of the contact."""


@form()
class CamFigures(TypedDict):
    """Figures of a previewed cam; null: not known."""

    lift_max_mm: float | None
    """Maximum lift."""
    pressure_angle_max_deg: float | None
    """Maximum magnitude of the pressure angle."""
    convex_radius_min_mm: float | None
    """Least convex radius of curvature of the contour."""
    cam_radius_max_mm: float | None
    """Greatest radius of the contour."""
    load_cases: list[LoadCaseFigures]
    """Figures of the stated load cases."""


@form()
class SignatureRecord(TypedDict):
    """A valid signature of the record by a trusted key."""

    role: Role
    """In which the run is signed."""
    name: Unit
    """Name of the signer, as signed."""
    date: Time
    """UTC, by the clock of the signer."""
    key: Annotated[str, JsonBound(pattern="^SHA256:[A-Za-z0-9+/]{43}$")]
    """Fingerprint of the key, as ssh-keygen -l prints it."""


@form()
class CheckChange(TypedDict):
    """Change of a check against the baseline run."""

    id: str
    """Key of the check."""
    kinds: Annotated[list[ChangeKind], JsonBound(minItems=1)]
    """What differs."""
    unit: str
    """Unit of the demands."""
    demand_before: float | None
    """Demand in the baseline; null where it is missing."""
    demand: float | None
    """Demand now; null where it is missing."""
    error_bars: Least0
    """Sum of both error bars."""
    status_before: Status | None
    """Status in the baseline; null where the check is absent."""
    status: Status | None
    """Status now; null where the check is absent."""


@form()
class CheckDocument(StatedVerdict, BindingRecord):
    """Checks of one run folder or case file.

    A case file has no trials, statement, headline, consistency and limitations.
    """

    target: NotRequired[str]
    """Run folder or case file, as on the command line."""
    case: str
    """Name of the case."""
    input_sha256: Sha256
    """Hash of the case file with its included files."""
    to_be_confirmed: list[str]
    """Values on which the must-have checks rest and which no source confirms."""
    load_ends: list[LoadEndRecord]
    """Load cases in which the follower leaves the cam or locks: the loads end there."""
    trials: NotRequired[Count]
    """Number of trials of a run."""
    statement: NotRequired[str]
    """Stopping criterion of a run, in words."""
    headline: NotRequired[HeadlineRecord]
    """Key figures of a run."""
    figures: NotRequired[CamFigures]
    """Figures of a previewed cam; null: not known."""
    consistency: NotRequired[list[Finding]]
    """Inputs beside the values that the others imply."""
    measurement: NotRequired[Measurement | None]
    """As in run.json."""
    checks: list[CheckRecord]
    """The checks, those of --only alone."""
    signatures: NotRequired[Annotated[list[SignatureRecord], JsonBound(minItems=1)]]
    """Valid signatures of a run, with --verify-record."""
    changes: NotRequired[list[CheckChange]]
    """Changes against the run of --baseline."""
    limitations: NotRequired[list[str]]
    """Limits of the model."""
    singularities: NotRequired[list[str]]
    """Stresses without bound, which are excluded."""


@form()
class UnreadTarget(TypedDict):
    """A target that cannot be read or solved."""

    target: str
    """Run folder or case file, as on the command line."""
    error: str
    """Reason, in one line."""


@form()
class SeveralTargets(TypedDict):
    """Several targets, in the order of the command line."""

    runs: list[CheckDocument | UnreadTarget]
    """A report or an error for each target."""

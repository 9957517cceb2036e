"""Forms of ``signoff.json`` and of its parts."""

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Status
from camwright.pipeline.records.check_record import CheckFigure
from camwright.pipeline.records.forms import Count, Sha256, Versions, form
from camwright.pipeline.records.run_summary import (
    BindingRecord,
    HeadlineRecord,
    RecordHead,
    StatedVerdict,
)
from camwright.pipeline.records.trial_contents import CertificateRecord, MeshRecord


@form()
class WaiverRecord(TypedDict):
    """A waiver."""

    check: str
    """Id of the check."""
    waiver: str
    """Name, date and reason."""
    up_to: float
    """Worst demand that it accepts."""
    unit: str
    """Unit of the demand."""
    status: Status
    """Status of the check."""


@form()
class LimitStatement(TypedDict):
    """A limit of the model."""

    statement: str
    """The limit in words."""
    check: str
    """Id of its check."""
    status: Status | None
    """Status of the check; null where it was not made."""


@form()
class Program(TypedDict):
    """The program."""

    camwright: str
    """Version."""
    source: str
    """Hash of its source text."""


@form()
class Environment(TypedDict):
    """Where it ran."""

    platform: str
    """System and processor."""
    versions: Versions
    """Versions of camwright, its source text, Python and the libraries."""


@form()
class EvidenceRecord(TypedDict):
    """Verification of the solution."""

    mesh: MeshRecord | None
    """Meshes; null without finite elements or without a body."""
    certificate: list[CertificateRecord]
    """Contact solved in full; empty unless certified."""
    contact_method: str
    """Solution of the contact."""
    benchmarks: dict[str, float] | None
    """Relative deviations from published contact benchmarks; null below the certified depth."""
    corners: int | None
    """Number of tolerance corners tried; null without tolerances."""
    statements: list[LimitStatement]
    """Limits of the model that have a check."""


@form()
class LimitationsRecord(TypedDict):
    """What the model does not say."""

    limitations: list[str]
    """Limits of the model."""
    singularities: list[str]
    """Stresses without bound, which are excluded."""


@form()
class SignoffRecord(RecordHead, StatedVerdict, BindingRecord, LimitationsRecord):
    """Figures with error bars, verdict, evidence and the hash of every file.

    It follows from the files of the run alone.
    """

    case_sha256: Sha256
    """Hash of the case file with its included files."""
    results_sha256: Sha256
    """Hash of the results, as the page states it: of the lines of HASH, two spaces and path, by
    path, of files in run.json."""
    code: Program
    """The program."""
    environment: Environment
    """Where it ran."""
    not_evaluated: list[str]
    """Ids of the checks without data or judged deeper."""
    not_proven: list[str]
    """Ids of the checks whose limit lies within the error bar."""
    waivers: list[WaiverRecord]
    """Failed checks that a person has accepted."""
    to_be_confirmed: list[str]
    """Values on which the must-have checks rest and which no source confirms."""
    trial: Count
    """Number of the final trial."""
    headline: HeadlineRecord
    """Key figures of the final trial."""
    figures: list[CheckFigure]
    """Every check with its error bar."""
    evidence: EvidenceRecord
    """Verification of the solution."""
    files: dict[str, Sha256]
    """SHA-256 of every file by path, relative to the run folder, without the record and its
    signatures."""

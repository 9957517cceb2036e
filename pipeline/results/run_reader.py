"""A finished run read from its folder: tables, checks, summary. `run_folder` writes it.

Reading needs no solver and no case parser.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypedDict

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import Json, hash_inputs, read_json, read_text, sha256_of
from camwright.pipeline.base.tables import Table, read_table

SCHEMA = 2
"""Number of the form of a run folder; a folder of another form is refused."""
HEADLINE = (
    *("torque_std_before_Nm", "torque_std_after_Nm", "torque_p2p_before_Nm", "torque_p2p_after_Nm"),
    *("lift_max_mm", "pressure_angle_max_deg", "pitch_radius_of_curvature_min_mm"),
    *("normal_force_min_N", "normal_force_max_N"),
    *("p0_max_MPa", "p0_hertz_max_MPa", "half_width_max_mm", "von_mises_max_MPa"),
    *("guide_reaction_A_max_N", "guide_reaction_B_max_N", "friction_loss_J_per_cam_turn"),
    *("p0_difference_max_percent", "residual_equilibrium_max"),
)
STATUSES = ("pass", "fail", "not_evaluated", "waived")
LIMITS_FILE = "2_limits.csv"


class TrialContents(TypedDict):
    """Contents of ``trial.json``."""

    number: int
    why: str
    smoothing_kind: str | None
    smoothing_strength: float | None
    smoothing_width_deg: float | None
    smoothing_description: str
    prices: Json
    contact_method: str
    balance: dict[str, Json]
    mesh: dict[str, Json] | None
    certificate: list[dict[str, Json]]


class CheckRecord(TypedDict):
    """A record of ``6_checks.json``, in `unit` and degrees; null: missing, or infinite."""

    id: str
    title: str
    demand: float | None
    limit: float | None
    unit: str
    utilisation: float | None
    status: str
    load_case: str
    cam_angle_deg: float | None
    source: str
    method: str
    sense: str
    must_have: bool
    waiver: str | None
    note: str
    error: float | None
    corner: str | None
    corner_demand: float | None
    evidence: bool


class Finding(TypedDict):
    """An input beside the value that the other inputs imply."""

    load_case: str
    title: str
    given: float
    implied: float
    unit: str
    difference_percent: float | None
    flagged: bool


class SummaryOfAnyRun(TypedDict):
    """Contents of ``run.json`` that every run has."""

    schema: int
    case: str
    input_sha256: str
    versions: dict[str, str]
    platform: str
    timings_s: dict[str, float]
    trials: int
    verdict: str
    binding: list[str]
    statement: str
    headline: dict[str, float | None]
    prices: Json
    benchmarks: Json
    speed: Json
    consistency: list[Finding]
    files: dict[str, str]


class Summary(SummaryOfAnyRun, total=False):
    """Contents of ``run.json``."""

    valve_train: Json


@dataclass(frozen=True, eq=False)
class TrialRecord:
    """A trial read from its folder: lift, contour, cycle, checks and record."""

    number: int
    path: Path
    lift: Table
    contour: Table
    cycle: Table
    checks: tuple[CheckRecord, ...]
    record: TrialContents
    limits: Table | None = None

    @property
    def verdict(self) -> str:
        """``pass`` when every must-have check passes or is waived; without checks ``fail``."""
        return verdict_of(self.checks)

    @property
    def binding(self) -> tuple[str, ...]:
        """Ids of the must-have checks that fail or are not evaluated."""
        return binding_of(self.checks)


@dataclass(frozen=True, eq=False)
class Run:
    """A run read from its folder; the last trial is the result."""

    path: Path
    case_text: str
    summary: Summary
    torque: Table | None
    trials: tuple[TrialRecord, ...]
    speed: Table | None = None

    @property
    def final(self) -> TrialRecord:
        """The last trial."""
        return self.trials[-1]

    @property
    def verdict(self) -> str:
        """Verdict by the checks of the final trial."""
        return self.final.verdict


def read_run(path: str | Path) -> Run:
    """Read a run folder.

    Raises
    ------
    ResultError
        If a file is missing or unreadable, or if two records disagree.
    """
    path = Path(path)
    summary = read_summary(path)
    torque, speed = path / "1_torque.csv", path / "1_speed.csv"
    run = Run(
        path=path,
        case_text=read_text(path / "case.toml"),
        summary=summary,
        torque=read_table(torque) if torque.exists() else None,
        trials=tuple(_read_trial(path, k + 1) for k in range(summary["trials"])),
        speed=read_table(speed) if speed.exists() else None,
    )
    _require_verdict(path, summary, run.verdict)
    return run


def read_verdict(path: Path) -> dict[str, Any]:
    """Summary of a finished run and checks of its last trial; no table is read.

    Raises
    ------
    ResultError
        If a file is missing or unreadable, or if summary and checks disagree.
    """
    summary = read_summary(path)
    checks = read_checks(path / f"trial_{summary['trials']}")
    _require_verdict(path, summary, verdict_of(checks))
    return {
        "case": summary["case"],
        "input_sha256": summary["input_sha256"],
        "verdict": summary["verdict"],
        "binding": list(binding_of(checks)),
        "trials": summary["trials"],
        "statement": summary["statement"],
        "headline": summary["headline"],
        "consistency": summary["consistency"],
        "checks": list(checks),
    }


def verify_run(path: Path) -> None:
    """Compare the files of a run with the hashes in ``run.json``; ResultError for a difference."""
    summary = read_summary(path)
    if input_sha256(path) != summary["input_sha256"]:
        raise ResultError(f"{path}: case.toml or inputs/ are not those of the run")
    for name, digest in summary["files"].items():
        file = path / name
        if not file.is_file() or sha256_of(file) != digest:
            state = "was changed" if file.is_file() else "is missing"
            raise ResultError(f"{file}: {state} since the run")


def read_summary(path: Path) -> Summary:
    """Contents of ``run.json``; ResultError for a folder that holds no run of this schema."""
    if not path.is_dir():
        raise ResultError(f"{path}: no such folder")
    file = path / "run.json"
    if not file.is_file():
        raise ResultError(f"{path}: holds no finished run (run.json is missing)")
    summary: Summary = read_json(file)
    require_schema(file, summary)
    _require(file, summary, SummaryOfAnyRun.__annotations__)
    if not isinstance(summary["trials"], int) or summary["trials"] < 1:
        raise ResultError(f"{file}: trials = {summary['trials']}, must be a count >= 1")
    return summary


def require_schema(file: Path, record: Json | Summary) -> None:
    """Refuse a record of another schema."""
    schema = record.get("schema", SCHEMA) if isinstance(record, dict) else SCHEMA
    if schema != SCHEMA:
        raise ResultError(f"{file}: schema = {schema}, must be {SCHEMA}: run the case again")


def input_sha256(path: Path) -> str:
    """Hash of the resolved case and its included files, as `Case.sha256` has it."""
    inputs = path / "inputs"
    kept = {
        f"{inputs.name}/{file.name}": file.read_bytes()
        for file in (sorted(inputs.iterdir()) if inputs.is_dir() else ())
    }
    return hash_inputs(read_text(path / "case.toml"), kept)


def is_result(name: str) -> bool:
    """Whether a file of a run is a table, a record, a mesh or an array; the rest can be redrawn."""
    file = Path(name)
    made_last = ("run.json", "signoff.json")
    return file.suffix in (".csv", ".json", ".msh", ".npz") and file.name not in made_last


def binding_of(checks: Iterable[CheckRecord]) -> tuple[str, ...]:
    """Ids of the must-have checks that fail or are not evaluated."""
    return tuple(
        check["id"]
        for check in checks
        if check["must_have"] and check["status"] not in ("pass", "waived")
    )


def verdict_of(checks: Collection[CheckRecord]) -> str:
    """``pass`` when every must-have check passes or is waived; without checks ``fail``."""
    return "fail" if not checks or binding_of(checks) else "pass"


def _require_verdict(path: Path, summary: Summary, verdict: str) -> None:
    said = summary["verdict"]
    if said != verdict:
        raise ResultError(f"{path}: run.json says {said}, the checks of the last trial {verdict}")


def _read_trial(run: Path, number: int) -> TrialRecord:
    path = run / f"trial_{number}"
    limits = path / LIMITS_FILE
    return TrialRecord(
        number=number,
        path=path,
        lift=read_table(path / "2_lift.csv"),
        contour=read_table(path / "3_contour.csv"),
        cycle=read_table(path / "5_cycle.csv"),
        checks=read_checks(path),
        record=read_trial_record(path),
        limits=read_table(limits) if limits.is_file() else None,
    )


def read_trial_record(trial: Path) -> TrialContents:
    """Contents of ``trial.json`` in the folder of a trial."""
    file = trial / "trial.json"
    record: TrialContents = read_json(file)
    _require(file, record, TrialContents.__annotations__)
    return record


def read_checks(trial: Path) -> tuple[CheckRecord, ...]:
    """Records of ``6_checks.json`` in the folder of a trial.

    Raises
    ------
    ResultError
        If a record lacks a key, has an unknown status, or passes against its numbers.
    """
    file = trial / "6_checks.json"
    records: list[CheckRecord] = read_json(file)
    if not isinstance(records, list):
        raise ResultError(f"{file}: must be a list of checks")
    for record in records:
        _require(file, record, CheckRecord.__annotations__, "a check ")
        if record["status"] not in STATUSES:
            raise ResultError(f"{file}: {record['id']}: status {record['status']} is unknown")
        if record["status"] == "pass" and not _holds(record):
            raise ResultError(f"{file}: {record['id']} is marked pass, its numbers say otherwise")
    return tuple(records)


def _require(file: Path, record: Mapping[str, object], keys: Iterable[str], what: str = "") -> None:
    missing = [key for key in keys if not isinstance(record, dict) or key not in record]
    if missing:
        raise ResultError(f"{file}: {what}lacks {', '.join(missing)}")


def _holds(record: CheckRecord) -> bool:
    """Whether demand and limit of a record pass; a missing number never does."""
    demand, limit = record["demand"], record["limit"]
    if not isinstance(demand, (int, float)) or not isinstance(limit, (int, float)):
        return False
    return bool(demand >= limit if record["sense"] == "at_least" else demand <= limit)

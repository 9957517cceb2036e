"""A finished run as it lies on disk: tables, checks, summary. `run_folder` writes it.

Reading needs no solver and no case parser, so that a run of long ago can be reported again.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import hash_inputs, read_json, read_text, sha256_of
from camwright.pipeline.base.tables import Table, read_table

SCHEMA = 1
HEADLINE = (
    *("torque_std_before_Nm", "torque_std_after_Nm", "torque_p2p_before_Nm", "torque_p2p_after_Nm"),
    *("lift_max_mm", "pressure_angle_max_deg", "pitch_radius_of_curvature_min_mm"),
    *("normal_force_min_N", "normal_force_max_N"),
    *("p0_max_MPa", "p0_hertz_max_MPa", "half_width_max_mm", "von_mises_max_MPa"),
    *("guide_reaction_A_max_N", "guide_reaction_B_max_N", "friction_loss_J_per_cam_turn"),
    *("p0_difference_max_percent", "residual_equilibrium_max"),
)
STATUSES = ("pass", "fail", "not_evaluated", "waived")
_REQUIRED = ("schema", "case", "input_sha256", "versions", "timings_s", "trials", "verdict",
             "binding", "headline")  # fmt: skip
_CHECK_KEYS = ("id", "title", "demand", "limit", "unit", "utilisation", "status", "load_case",
               "cam_angle_deg", "source", "method")  # fmt: skip


LIMITS_FILE = "2_limits.csv"


@dataclass(frozen=True, eq=False)
class TrialRecord:
    """One trip down the road: a lift, everything that follows from it, and what was checked."""

    number: int
    path: Path
    lift: Table
    contour: Table
    cycle: Table
    checks: tuple[Mapping[str, Any], ...]
    record: Mapping[str, Any]
    limits: Table | None = None

    @property
    def verdict(self) -> str:
        """`pass` when every must-have passes or is waived; no checks, no pass."""
        return "fail" if not self.checks or self.binding else "pass"

    @property
    def binding(self) -> tuple[str, ...]:
        """Must-have checks that fail or are not evaluated."""
        return _binding(self.checks)


@dataclass(frozen=True, eq=False)
class Run:
    """A run folder read back; the last trial is the answer."""

    path: Path
    case_text: str
    summary: Mapping[str, Any]
    torque: Table | None
    trials: tuple[TrialRecord, ...]
    speed: Table | None = None

    @property
    def final(self) -> TrialRecord:
        return self.trials[-1]

    @property
    def verdict(self) -> str:
        """Drawn from the checks of the final trial, not from the summary."""
        return self.final.verdict


def load_run(path: str | Path) -> Run:
    """Read a run folder.

    Raises
    ------
    ResultError
        If something is missing or unreadable, or if two records disagree.
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
    if run.verdict != summary["verdict"]:
        said, found = summary["verdict"], run.verdict
        raise ResultError(f"{path}: run.json says {said}, the checks of the last trial {found}")
    return run


def read_verdict(path: Path) -> dict[str, Any]:
    """What a finished run says of itself, no table read: summary and checks of the last trial.

    Raises
    ------
    ResultError
        If something is missing or unreadable, or if summary and checks disagree.
    """
    summary = read_summary(path)
    checks = tuple(_read_checks(path / f"trial_{summary['trials']}" / "6_checks.json"))
    found = "fail" if not checks or _binding(checks) else "pass"
    if found != summary["verdict"]:
        said = summary["verdict"]
        raise ResultError(f"{path}: run.json says {said}, the checks of the last trial {found}")
    return {
        "case": summary["case"],
        "input_sha256": summary["input_sha256"],
        "verdict": found,
        "binding": list(_binding(checks)),
        "trials": summary["trials"],
        "statement": summary.get("statement", ""),
        "headline": summary["headline"],
        "consistency": summary.get("consistency") or [],
        "checks": [dict(record) for record in checks],
    }


def verify_run(path: Path) -> None:
    """Compare the files of a run with the hashes taken when it was finished."""
    summary = read_summary(path)
    if input_sha256(path) != summary["input_sha256"]:
        raise ResultError(f"{path}: case.toml or inputs/ are not those of the run")
    for name, digest in summary.get("files", {}).items():
        file = path / name
        if not file.is_file() or sha256_of(file) != digest:
            state = "was changed" if file.is_file() else "is missing"
            raise ResultError(f"{file}: {state} since the run")


def read_summary(path: Path) -> dict[str, Any]:
    """The contents of ``run.json``."""
    if not path.is_dir():
        raise ResultError(f"{path}: no such folder")
    file = path / "run.json"
    if not file.is_file():
        raise ResultError(f"{path}: holds no finished run (run.json is missing)")
    summary = read_json(file)
    missing = [key for key in _REQUIRED if not isinstance(summary, dict) or key not in summary]
    if missing:
        raise ResultError(f"{file}: lacks {', '.join(missing)}")
    if summary["schema"] != SCHEMA:
        raise ResultError(f"{file}: schema {summary['schema']}, must be {SCHEMA}")
    if not isinstance(summary["trials"], int) or summary["trials"] < 1:
        raise ResultError(f"{file}: trials = {summary['trials']}, must be a count >= 1")
    return summary


def input_sha256(path: Path) -> str:
    """Hash of the resolved case and its included files, as `Case.sha256` has it."""
    inputs = path / "inputs"
    kept = {
        file.relative_to(path).as_posix(): file.read_bytes()
        for file in (sorted(inputs.iterdir()) if inputs.is_dir() else ())
    }
    return hash_inputs(read_text(path / "case.toml"), kept)


def file_hashes(path: Path) -> dict[str, str]:
    """SHA-256 of the tables, checks and meshes of a run; pictures and pages can be redrawn."""
    kept, later = (".csv", ".json", ".msh", ".npz"), ("run.json", "signoff.json")
    return {
        file.relative_to(path).as_posix(): sha256_of(file)
        for file in sorted(path.rglob("*"))
        if file.suffix in kept and file.name not in later and not _hidden(file, path)
    }


def _binding(checks: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    return tuple(
        check["id"]
        for check in checks
        if check.get("must_have", True) and check["status"] not in ("pass", "waived")
    )


def _read_trial(run: Path, number: int) -> TrialRecord:
    path = run / f"trial_{number}"
    record = read_json(path / "trial.json")
    if not isinstance(record, dict):
        raise ResultError(f"{path / 'trial.json'}: must be an object")
    limits = path / LIMITS_FILE
    return TrialRecord(
        number=number,
        path=path,
        lift=read_table(path / "2_lift.csv"),
        contour=read_table(path / "3_contour.csv"),
        cycle=read_table(path / "5_cycle.csv"),
        checks=tuple(_read_checks(path / "6_checks.json")),
        record=MappingProxyType(record),
        limits=read_table(limits) if limits.is_file() else None,
    )


def _read_checks(path: Path) -> Iterator[Mapping[str, Any]]:
    records = read_json(path)
    if not isinstance(records, list):
        raise ResultError(f"{path}: must be a list of checks")
    for record in records:
        missing = [key for key in _CHECK_KEYS if not isinstance(record, dict) or key not in record]
        if missing:
            raise ResultError(f"{path}: a check lacks {', '.join(missing)}")
        if record["status"] not in STATUSES:
            raise ResultError(f"{path}: {record['id']}: status {record['status']} is unknown")
        if record["status"] == "pass" and not _holds(record):
            raise ResultError(f"{path}: {record['id']} is marked pass, its numbers say otherwise")
        yield MappingProxyType(record)


def _holds(record: Mapping[str, Any]) -> bool:
    """Whether the numbers of a record bear out a pass; a missing one never does."""
    demand, limit = record["demand"], record["limit"]
    if not all(isinstance(number, (int, float)) for number in (demand, limit)):
        return False
    return bool(demand >= limit if record.get("sense") == "at_least" else demand <= limit)


def _hidden(file: Path, folder: Path) -> bool:
    return any(re.match(r"\.", part) for part in file.relative_to(folder).parts)

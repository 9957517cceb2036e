"""A finished run read from its folder: tables, checks, summary. `run_folder` writes it.

Reading needs no solver and no case parser.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from camwright.geometry.errors import AlteredError, InputError, ResultError
from camwright.pipeline.base.files import (
    Json,
    hash_inputs,
    parse_toml,
    read_json,
    read_text,
    require_plain,
    sha256_of,
)
from camwright.pipeline.base.tables import Table, read_table
from camwright.pipeline.base.verdict import STATUSES, binding, governing_id
from camwright.pipeline.results.check_records import (
    AnyCheck,
    CheckList,
    CheckRecord,
    CheckRecordOfAnyCheck,
    RecordedCheck,
    WithChecks,
    judgement,
    of_records,
    to_be_confirmed,
)

if TYPE_CHECKING:
    from camwright.pipeline.smoothing.fe_correction import SynthesisRecord

SCHEMA = 7
"""Number of the form of a run folder; a folder of another form is refused."""
_TYPES: Mapping[str, tuple[tuple[type, ...], str]] = {
    "str": ((str,), "text"), "int": ((int,), "a whole number"), "None": ((type(None),), "null"),
    "float": ((float, int), "a number"), "bool": ((bool,), "true or false"),
    "list": ((list,), "a list"), "dict": ((dict,), "an object"),
}  # fmt: skip
"""Types of JSON by the words of an annotation, and what they are called."""
_ITEMS = re.compile(r"\[(?:[^][]|\[[^][]*\])*\]")
HEADLINE = (
    *("torque_std_before_Nm", "torque_std_after_Nm", "torque_p2p_before_Nm", "torque_p2p_after_Nm"),
    *("lift_max_mm", "pressure_angle_max_deg", "pitch_radius_of_curvature_min_mm"),
    *("normal_force_min_N", "normal_force_max_N"),
    *("p0_max_MPa", "p0_hertz_max_MPa", "half_width_max_mm", "von_mises_max_MPa"),
    *("von_mises_depth_mm", "follower_von_mises_max_MPa", "follower_von_mises_depth_mm"),
    "ring_stress_max_MPa",
    *("guide_reaction_A_max_N", "guide_reaction_B_max_N", "friction_loss_J_per_cam_turn"),
    *("p0_difference_max_percent", "residual_equilibrium_max"),
)
LIMITS_FILE = "2_limits.csv"
SPLINE_FILE = "2_spline.csv"
SWEEP_FILE = "5_speed_sweep.csv"


class ContentsOfAnyTrial(TypedDict):
    """Contents of ``trial.json`` that every trial has."""

    number: int
    why: str
    smoothing_kind: str | None
    smoothing_strength: float | None
    smoothing_width_deg: float | None
    smoothing_description: str
    synthesis: SynthesisRecord | None
    prices: Json
    closure_mm: float
    table_step_deg: float
    depth: str
    contact_method: str
    hertz_difference: dict[str, Json] | None
    balance: dict[str, Json]
    mesh: dict[str, Json] | None
    certificate: list[dict[str, Json]]


class TrialContents(ContentsOfAnyTrial, total=False):
    """Contents of ``trial.json``.

    fatigue: points of the Goodman diagrams by part; length_certificate: ends of the contact;
    length_refused: why finite elements did not solve them.
    """

    fatigue: dict[str, Json]
    length_certificate: list[dict[str, Json]]
    length_refused: str | None


class ScopeRecord(TypedDict):
    """Parts that the sign-off does not cover, the reason, and both in a sentence."""

    not_covered: list[str]
    reason: str
    statement: str


class Finding(TypedDict):
    """An input beside the value that the other inputs imply."""

    load_case: str
    id: str
    how: str
    title: str
    given: float
    implied: float
    unit: str
    difference_percent: float | None
    flagged: bool


class TrialPointRecord(TypedDict):
    """Ripple and worst utilisation of a trial; see `trial.TrialPoint`."""

    trial: int
    ripple_Nm: float | None
    limit: str
    utilisation: float | None
    passes: bool


class LoadEndRecord(TypedDict):
    """Cam angle from which a load case has no loads of the cam; see `checks.lost_loads`."""

    load_case: str
    cam_angle_deg: float
    statement: str


class SummaryOfAnyRun(TypedDict):
    """Contents of ``run.json`` that every run has."""

    schema: int
    case: str
    input_sha256: str
    versions: dict[str, str]
    platform: str
    timings_s: dict[str, float]
    trials: int
    final_trial: int
    trial_points: list[TrialPointRecord]
    depth: str
    verdict: str | None
    screen: str | None
    binding: list[str]
    scope: ScopeRecord
    statement: str
    headline: dict[str, float | None]
    prices: Json
    machine_prices: Json
    benchmarks: Json
    speed: Json
    ripple_map: dict[str, Json] | None
    consistency: list[Finding]
    files: dict[str, str]


class Summary(SummaryOfAnyRun, total=False):
    """Contents of ``run.json``; started: of the program, UTC, None of a design of a study."""

    started: str | None
    valve_train: Json
    measurement: Json
    governing: str | None
    load_ends: list[LoadEndRecord]


@dataclass(frozen=True, eq=False, repr=False)
class TrialRecord(WithChecks):
    """A trial read from its folder: lift, contour, cycle, checks, record, speed sweep."""

    number: int
    path: Path
    lift: Table
    contour: Table
    cycle: Table
    checks: tuple[CheckRecord, ...]
    record: TrialContents
    limits: Table | None = None
    sweep: Table | None = None

    @property
    def facts(self) -> Mapping[str, object]:
        """Number, folder, depth, verdict or screen, and the checks by status."""
        return {
            "number": self.number,
            "path": self.path,
            "depth": self.depth,
            **({"verdict": self.verdict} if self.verdict else {"screen": self.screen}),
            **CheckList(self.checks).facts,
        }

    @property
    def depth(self) -> str:
        """Depth of the solution, such as ``preview``."""
        return self.record["depth"]

    @property
    def verdict(self) -> str | None:
        """``fail``, ``incomplete`` or ``pass``; None below certified. See `judgement`."""
        return judgement(self.checks, self.depth)["verdict"]

    @property
    def screen(self) -> str | None:
        """``fail`` or ``open``; None of a certified trial. See `judgement`."""
        return judgement(self.checks, self.depth)["screen"]

    @property
    def binding(self) -> tuple[str, ...]:
        """Ids of the must-have checks that fail or lack data."""
        return binding(of_records(self.checks))


@dataclass(frozen=True, eq=False, repr=False)
class Run(WithChecks):
    """A run read from its folder; the final trial is the result."""

    path: Path
    case_text: str
    summary: Summary
    torque: Table | None
    trials: tuple[TrialRecord, ...]
    speed: Table | None = None

    @property
    def facts(self) -> Mapping[str, object]:
        """Case, folder, trials, and the facts of the final trial."""
        run = {"case": self.summary["case"], "path": self.path, "trials": len(self.trials)}
        own = ("number", "path")
        final = {name: fact for name, fact in self.final.facts.items() if name not in own}
        return run | {"final": self.final.number} | final

    @property
    def checks(self) -> tuple[CheckRecord, ...]:  # type: ignore[override]
        """Checks of the final trial."""
        return self.final.checks

    @property
    def final(self) -> TrialRecord:
        """The trial that is the result: the best one of a synthesis, else the last one."""
        return self.trials[self.summary["final_trial"] - 1]

    @property
    def ripples(self) -> tuple[float | None, ...]:
        """Std of the torque with the cam of each trial, design load case, N m; None: no torque."""
        known = {point["trial"]: point["ripple_Nm"] for point in self.summary["trial_points"]}
        return tuple(known.get(trial.number) for trial in self.trials)

    @property
    def verdict(self) -> str | None:
        """Verdict by the checks of the final trial; None below certified."""
        return self.final.verdict

    @property
    def screen(self) -> str | None:
        """``fail`` or ``open`` by the checks of the final trial; None of a certified run."""
        return self.final.screen


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
        case_text=_case_text(path, summary),
        summary=summary,
        torque=read_table(torque) if torque.exists() else None,
        trials=tuple(_read_trial(path, k + 1) for k in range(summary["trials"])),
        speed=read_table(speed) if speed.exists() else None,
    )
    _require_judgement(path, summary, run.final.checks, run.final.depth)
    return run


def read_verdict(path: Path) -> dict[str, Any]:
    """Summary of a finished run and checks of its final trial; no table is read.

    Raises
    ------
    ResultError
        If a file is missing or unreadable, or if summary and checks disagree.
    """
    summary = read_summary(path)
    _case_text(path, summary)
    trial = path / f"trial_{summary['final_trial']}"
    checks, depth = read_checks(trial), read_trial_record(trial)["depth"]
    _require_judgement(path, summary, checks, depth)
    return {
        "case": summary["case"],
        "input_sha256": summary["input_sha256"],
        **judgement(checks, depth),
        "to_be_confirmed": to_be_confirmed(checks),
        "binding": list(binding(of_records(checks))),
        "governing": governing_id(of_records(checks)),
        "load_ends": summary.get("load_ends", []),
        "trials": summary["trials"],
        "scope": summary["scope"],
        "statement": summary["statement"],
        "headline": summary["headline"],
        "consistency": summary["consistency"],
        "measurement": summary.get("measurement"),
        "checks": list(checks),
    }


def verify_run(path: Path) -> None:
    """Compare the files of a run with the hashes in ``run.json``; ResultError for a difference."""
    _require_own_case(path)
    summary = read_summary(path)
    for name, digest in summary["files"].items():
        file = path / name
        if not file.is_file() or sha256_of(file) != digest:
            state = "was changed" if file.is_file() else "is missing"
            raise ResultError(f"{file}: {state} since the run")


def _require_own_case(path: Path) -> None:
    """Refuse a run whose case file or measured data were edited since."""
    summary = read_summary(path)
    if summary["input_sha256"] != input_sha256(path):
        raise ResultError(f"{path}: case.toml or inputs/ are not those of the run: run it again")


def read_summary(path: Path) -> Summary:
    """Contents of ``run.json``; ResultError for a folder that holds no run of this schema.

    AlteredError where it holds a link, see `files.require_plain`.
    """
    require_folder(path)
    file = path / "run.json"
    if not file.is_file():
        raise ResultError(f"{path}: holds no finished run (run.json is missing)")
    summary: Summary = read_json(file)
    require_schema(file, summary)
    _require(file, summary, SummaryOfAnyRun)
    if summary["trials"] < 1:
        raise ResultError(f"{file}: trials = {summary['trials']}, must be a count >= 1")
    final = summary["final_trial"]
    if not 1 <= final <= summary["trials"]:
        limit = f"must be from 1 to {summary['trials']}"
        raise ResultError(f"{file}: final_trial = {final}, {limit}")
    return summary


def require_folder(path: Path) -> None:
    """Refuse a path that is no folder, and with AlteredError one that holds a link or pipe."""
    if not path.is_dir():
        raise ResultError(f"{path}: no such folder")
    require_plain(path, AlteredError)


def require_schema(file: Path, record: Json | Summary) -> None:
    """Refuse a record of another schema."""
    schema = record.get("schema", SCHEMA) if isinstance(record, dict) else SCHEMA
    if schema != SCHEMA:
        raise ResultError(f"{file}: schema = {schema}, must be {SCHEMA}: run the case again")


def input_sha256(path: Path) -> str:
    """Hash of the resolved case and its included files, as `Case.sha256` has it."""
    inputs = path / "inputs"
    kept = {
        file.relative_to(path).as_posix(): file.read_bytes()
        for file in inputs.rglob("*")
        if file.is_file()
    }
    return hash_inputs(read_text(path / "case.toml"), kept)


def results_sha256(files: Mapping[str, str]) -> str:
    """Hash of the results of a run: of the lines `HASH  NAME`, by name, of its `files`.

    These are the lines that sha256sum prints.
    """
    lines = (f"{digest}  {name}\n" for name, digest in sorted(files.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def is_result(name: str) -> bool:
    """Whether a file of a run is a table, a record, a mesh or an array; the rest can be redrawn."""
    file = Path(name)
    made_last = ("run.json", "signoff.json")
    return file.suffix in (".csv", ".json", ".msh", ".npz") and file.name not in made_last


def load_end_words(ends: Iterable[LoadEndRecord]) -> str:
    """Such as ``leaves the cam at 150.5 deg (over-speed)``; "" without any."""
    return ", ".join(end["statement"] for end in ends)


def _case_text(path: Path, summary: Summary) -> str:
    """Text of ``case.toml``; ResultError if the summary states another scope."""
    text = read_text(path / "case.toml")
    try:
        scope = parse_toml(text, str(path / "case.toml")).get("scope", {})
    except InputError as error:
        raise ResultError(str(error)) from None
    said = summary["scope"]
    left_out = scope.get("not_covered", []) if isinstance(scope, dict) else None
    if not isinstance(said, dict) or said.get("not_covered") != left_out:
        raise ResultError(f"{path}: the scope in run.json is not that of case.toml")
    return text


def _require_judgement(
    path: Path, summary: Summary, checks: Iterable[AnyCheck], depth: str
) -> None:
    """Refuse a summary whose depth, verdict or screen is not that of the final trial."""
    judged = judgement(checks, depth)
    for name, said in (
        ("depth", summary["depth"]),
        ("verdict", summary["verdict"]),
        ("screen", summary["screen"]),
    ):
        if said != judged[name]:
            whose = "the final trial" if name == "depth" else "the checks of the final trial"
            raise ResultError(f"{path}: run.json says {said}, {whose} {judged[name]}")


def _read_trial(run: Path, number: int) -> TrialRecord:
    path = run / f"trial_{number}"
    limits, sweep = path / LIMITS_FILE, path / SWEEP_FILE
    return TrialRecord(
        number=number,
        path=path,
        lift=read_table(path / "2_lift.csv"),
        contour=read_table(path / "3_contour.csv"),
        cycle=read_table(path / "5_cycle.csv"),
        checks=read_checks(path),
        record=read_trial_record(path),
        limits=read_table(limits) if limits.is_file() else None,
        sweep=read_table(sweep) if sweep.is_file() else None,
    )


def read_trial_record(trial: Path) -> TrialContents:
    """Contents of ``trial.json`` in the folder of a trial."""
    file = trial / "trial.json"
    record: TrialContents = read_json(file)
    _require(file, record, ContentsOfAnyTrial)
    return record


def read_checks(trial: Path) -> tuple[CheckRecord, ...]:
    """Records of ``6_checks.json`` in the folder of a trial.

    Raises
    ------
    ResultError
        If a record lacks a key, has an unknown status, or one better than its numbers.
    """
    return read_records(trial / "6_checks.json")


def read_records(file: Path) -> tuple[CheckRecord, ...]:
    """Records of checks of a file; see `read_checks`."""
    records: list[CheckRecord] = read_json(file)
    if not isinstance(records, list):
        raise ResultError(f"{file}: must be a list of checks")
    for record in records:
        _require(file, record, CheckRecordOfAnyCheck, "a check ")
        status = record["status"]
        if status not in STATUSES:
            raise ResultError(f"{file}: {record['id']}: status {status} is unknown")
        if STATUSES.index(status) < STATUSES.index(RecordedCheck(record).status_by_numbers):
            raise ResultError(
                f"{file}: {record['id']} is marked {status}, its numbers say otherwise"
            )
    return CheckList(records)


def _require(file: Path, record: Mapping[str, object], kind: type, what: str = "") -> None:
    """Refuse a record without the keys of a typed dictionary, or with a value of another type."""
    types = kind.__annotations__
    missing = [key for key in types if not isinstance(record, dict) or key not in record]
    if missing:
        raise ResultError(f"{file}: {what}lacks {', '.join(missing)}")
    for key, each in types.items():
        named = set(_ITEMS.sub("", each.__forward_arg__).split(" | "))
        if named <= _TYPES.keys() and type(record[key]) not in {
            one for name in named for one in _TYPES[name][0]
        }:
            limit = " or ".join(sorted(_TYPES[name][1] for name in named))
            raise ResultError(f"{file}: {what}has {key} = {record[key]!r:.40}, must be {limit}")

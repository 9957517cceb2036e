"""Reading of finished runs: tables, checks, summary, hashes.

Reading needs no solver and no case parser.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

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
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.forms import Depth
from camwright.pipeline.records.run_summary import SCHEMA, HeadlineRecord, LoadEndRecord, Summary
from camwright.pipeline.records.trial_contents import TrialContents
from camwright.pipeline.results.check_records import (
    AnyCheck,
    CheckList,
    RecordedCheck,
    WithChecks,
    judgement,
    of_records,
    to_be_confirmed,
)

_WORDS: Mapping[type, str] = {
    str: "text", int: "a whole number", NoneType: "null", float: "a number",
    bool: "true or false", list: "a list", dict: "an object",
}  # fmt: skip
"""Types of JSON, and what they are called."""
HEADLINE = tuple(HeadlineRecord.__annotations__)
LIMITS_FILE = "2_limits.csv"
SPLINE_FILE = "2_spline.csv"
SWEEP_FILE = "5_speed_sweep.csv"
LIVE = "8_live.json"
"""Response surfaces of the live preview; fitted when the other results are there, for the page."""


@dataclass(frozen=True, eq=False, repr=False)
class TrialRecord(WithChecks):
    """Trial read from its folder: lift, contour, cycle, checks, record, speed sweep."""

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
    def depth(self) -> Depth:
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
    """Run read from its folder; its final trial is the result."""

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
        """Final trial: the best of a synthesis, else the last."""
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
    """Run read from its folder.

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
    """Summary of a finished run with the checks of its final trial as a document, without reading
    its tables.

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
    """Compare the files of a run with their recorded hashes; ResultError for a difference."""
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
    """Contents of ``run.json``; ResultError without a run of this schema.

    AlteredError where it holds a link, see `files.require_plain`.
    """
    require_folder(path)
    file = path / "run.json"
    if not file.is_file():
        raise ResultError(f"{path}: holds no finished run (run.json is missing)")
    summary: Summary = read_json(file)
    require_schema(file, summary)
    _require(file, summary, Summary)
    if summary["trials"] < 1:
        raise ResultError(f"{file}: trials = {summary['trials']}, must be a count >= 1")
    final = summary["final_trial"]
    if not 1 <= final <= summary["trials"]:
        limit = f"must be from 1 to {summary['trials']}"
        raise ResultError(f"{file}: final_trial = {final}, {limit}")
    return summary


def require_folder(path: Path) -> None:
    """Refuse a path that is no folder, and with AlteredError a folder with links or pipes."""
    if not path.is_dir():
        raise ResultError(f"{path}: no such folder")
    require_plain(path, AlteredError)


def require_schema(file: Path, record: Json | Summary) -> None:
    """Refuse a record of another schema version."""
    schema = record.get("schema", SCHEMA) if isinstance(record, dict) else SCHEMA
    if schema != SCHEMA:
        raise ResultError(f"{file}: schema = {schema}, must be {SCHEMA}: run the case again")


def input_sha256(path: Path) -> str:
    """Hash of the resolved case and its included files, equal to `Case.sha256`."""
    inputs = path / "inputs"
    kept = {
        file.relative_to(path).as_posix(): file.read_bytes()
        for file in inputs.rglob("*")
        if file.is_file()
    }
    return hash_inputs(read_text(path / "case.toml"), kept)


def results_sha256(files: Mapping[str, str]) -> str:
    """Hash of the results of a run: of lines `HASH NAME` sorted by name.

    These are the lines that sha256sum prints.
    """
    lines = (f"{digest}  {name}\n" for name, digest in sorted(files.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def is_result(name: str) -> bool:
    """Whether a file is a result (table, record, mesh, array), not a drawing of results."""
    file = Path(name)
    made_last = ("run.json", "signoff.json", LIVE)
    return file.suffix in (".csv", ".json", ".msh", ".npz") and file.name not in made_last


def load_end_words(ends: Iterable[LoadEndRecord]) -> str:
    """End of the loads, such as ``leaves the cam at 150.5 deg (over-speed)``; "" without one."""
    return ", ".join(end["statement"] for end in ends)


def _case_text(path: Path, summary: Summary) -> str:
    """Text of ``case.toml`` in a run folder; ResultError if its scope is not that of the
    summary.
    """
    text = read_text(path / "case.toml")
    try:
        scope = parse_toml(text, str(path / "case.toml")).get("scope", {})
    except InputError as error:
        raise ResultError(str(error)) from None
    left_out = scope.get("not_covered", []) if isinstance(scope, dict) else None
    if summary["scope"].get("not_covered") != left_out:
        raise ResultError(f"{path}: the scope in run.json is not that of case.toml")
    return text


def _require_judgement(
    path: Path, summary: Summary, checks: Iterable[AnyCheck], depth: Depth
) -> None:
    """Refuse, by ResultError, a run whose summary states another depth, verdict or screen than
    follows from the checks of its final trial.

    Parameters
    ----------
    path : Path         run folder
    summary : mapping   contents of ``run.json``
    checks : iterable   records of the final trial
    depth : str         of the final trial
    """
    judged = judgement(checks, depth)
    for said, known, whose in (
        (summary["depth"], judged["depth"], "the final trial"),
        (summary["verdict"], judged["verdict"], "the checks of the final trial"),
        (summary["screen"], judged["screen"], "the checks of the final trial"),
    ):
        if said != known:
            raise ResultError(f"{path}: run.json says {said}, {whose} {known}")


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
    """Contents of ``trial.json`` of a trial."""
    file = trial / "trial.json"
    record: TrialContents = read_json(file)
    _require(file, record, TrialContents)
    return record


def read_checks(trial: Path) -> tuple[CheckRecord, ...]:
    """Check records of ``6_checks.json`` of a trial.

    Raises
    ------
    ResultError
        If a record lacks a key, has an unknown status, or one better than its numbers.
    """
    return read_records(trial / "6_checks.json")


def read_records(file: Path) -> tuple[CheckRecord, ...]:
    """Check records of a file; see `read_checks`."""
    records: list[CheckRecord] = read_json(file)
    if not isinstance(records, list):
        raise ResultError(f"{file}: must be a list of checks")
    for record in records:
        _require(file, record, CheckRecord, "a check ")
        status = record["status"]
        if status not in STATUSES:
            raise ResultError(f"{file}: {record['id']}: status {status} is unknown")
        if STATUSES.index(status) < STATUSES.index(RecordedCheck(record).status_by_numbers):
            raise ResultError(
                f"{file}: {record['id']} is marked {status}, its numbers say otherwise"
            )
    return CheckList(records)


def _require(file: Path, record: Mapping[str, object], kind: type, what: str = "") -> None:
    """Refuse, by ResultError, a record that lacks a key of a form, or has a value of another type.

    Parameters
    ----------
    file : Path        which holds the record
    record : mapping   read from it
    kind : type        form, a typed dictionary
    what : str         words for the part of the file, for the message
    """
    known = _known(kind)
    missing = [key for key in known if not isinstance(record, dict) or key not in record]
    if missing:
        raise ResultError(f"{file}: {what}lacks {', '.join(missing)}")
    for key, types in known.items():
        if type(record[key]) not in (types | {int} if float in types else types):
            limit = " or ".join(sorted(_WORDS[each] for each in types))
            raise ResultError(f"{file}: {what}has {key} = {record[key]!r:.40}, must be {limit}")


@cache
def _known(kind: type) -> Mapping[str, frozenset[type]]:
    """Types of JSON by the keys that a record of every version has."""
    hints = get_type_hints(kind)
    return {key: frozenset(_types(hint)) for key, hint in hints.items() if key in _required(kind)}


def _required(kind: type) -> frozenset[str]:
    return getattr(kind, "__required_keys__", frozenset())


def _types(hint: object) -> Iterator[type]:
    """Python types of the JSON values that an annotation allows; dict for a form."""
    origin = get_origin(hint)
    if origin in (Union, UnionType):
        for each in get_args(hint):
            yield from _types(each)
    elif origin is Literal:
        yield from map(type, get_args(hint))
    else:
        made = origin or hint
        yield made if made in _WORDS else dict  # type: ignore[misc]  # a form

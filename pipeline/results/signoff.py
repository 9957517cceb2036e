"""Sign-off record of a run: figures with error bars, verdict, evidence, file hashes.

It follows from the files of the run alone and can be reproduced from them. `signatures` are on this
record alone.
"""

from __future__ import annotations

import platform
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from camwright.geometry.errors import AlteredError, ResultError
from camwright.pipeline.base.files import (
    Json,
    file_hashes,
    json_text,
    not_plain,
    read_json,
    shown_name,
    unplain,
    write_atomic,
)
from camwright.pipeline.base.verdict import binding, governing_id
from camwright.pipeline.records.check_record import CheckFigure, CheckRecord
from camwright.pipeline.records.signoff_record import LimitStatement, SignoffRecord
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.check_records import judgement, of_records, to_be_confirmed
from camwright.pipeline.results.model_limits import MODEL_LIMITS, limitations

NAME = "signoff.json"
SIGNATURES = "signoff.intoto.jsonl"
AMENDMENT = ".amendment"
COMPLETE = f"{AMENDMENT}/complete"
"""Folder of files on their way into a finished run; see `folder_exchange.staged`."""

_ADDED = "was added since the sign-off"
_BY = "`camwright report`, `inspect`, `contact deck` or `sign run`"
_HALF_MOVED = f"an interrupted {_BY} has not moved all its files into place: run it again"
_INCOMPLETE = f"belongs to {_BY}, which is running or was interrupted; run again, it removes this"
_DRAWN = (".html", ".pdf", ".png", ".xlsx")
_SHA256 = re.compile(r"[0-9a-f]{64}")


def record(path: Path) -> SignoffRecord:
    """Sign-off record of the run in a folder.

    Raises
    ------
    ResultError
        If a file of the run is missing or unreadable.
    """
    return _record(path, hashes(path))


def _record(path: Path, files: dict[str, str]) -> SignoffRecord:
    """Sign-off record of the run in a folder: figures, verdict, scope, waivers, evidence, and the
    hashes `files` by file name.
    """
    summary = run_reader.read_summary(path)
    trial = path / f"trial_{summary['final_trial']}"
    made, checks = run_reader.read_trial_record(trial), run_reader.read_checks(trial)
    corners = path / "corners.json"
    return {
        "schema": run_reader.SCHEMA,
        "case": summary["case"],
        "case_sha256": run_reader.input_sha256(path),
        "results_sha256": run_reader.results_sha256(summary["files"]),
        "code": {
            "camwright": summary["versions"].get("camwright", ""),
            "source": summary["versions"].get("source", ""),
        },
        "environment": {
            "platform": summary["platform"],
            "versions": summary["versions"],
        },
        **judgement(checks, made["depth"]),
        "binding": list(binding(of_records(checks))),
        "governing": governing_id(of_records(checks)),
        "not_evaluated": [c["id"] for c in checks if c["status"] == "not_evaluated"],
        "not_proven": [c["id"] for c in checks if c["not_proven"]],
        "scope": {
            "not_covered": summary["scope"]["not_covered"],
            "reason": summary["scope"]["reason"],
            "statement": summary["scope"]["statement"],
        },
        "waivers": [
            {
                "check": c["id"],
                "waiver": c["waiver"],
                "up_to": up_to,
                "unit": c["unit"],
                "status": c["status"],
            }
            for c in checks
            if c["waiver"] and (up_to := c["waived_up_to"]) is not None
        ],
        "to_be_confirmed": to_be_confirmed(checks),
        "trial": summary["final_trial"],
        "headline": summary["headline"],
        "figures": [_figure(check) for check in checks],
        "evidence": {
            "mesh": made["mesh"],
            "certificate": made["certificate"],
            "contact_method": made["contact_method"],
            "benchmarks": summary["benchmarks"],
            "corners": read_json(corners)["tried"] if corners.is_file() else None,
            "statements": _statements(checks),
        },
        **limitations(),
        "files": files,
    }


def _statements(checks: Sequence[CheckRecord]) -> list[LimitStatement]:
    """Limits of the model with their checks; a status of null: the check was not made."""
    status = {check["id"]: check["status"] for check in checks}
    return [
        {"statement": each.statement, "check": each.check, "status": status.get(each.check)}
        for each in MODEL_LIMITS
        if each.check
    ]


def write(path: Path) -> None:
    """Write the sign-off record into a run folder that is otherwise complete."""
    write_atomic(path / NAME, json_text(record(path)) + "\n")


def write_amended(path: Path, added: Path) -> None:
    """Write the sign-off record of a run and of files to be added to it.

    The other hashes are those of the record before.
    """
    files = read_json(path / NAME)["files"] | hashes(added)
    ordered = {name: files[name] for name in sorted(files, key=Path)}
    write_atomic(added / NAME, json_text(_record(path, ordered)) + "\n")


class Difference(NamedTuple):
    """Difference between a run and its record.

    Parameters
    ----------
    name : str     relative name of the file
    words : str    what differs
    added : bool   whether the record does not know the file, which is in no result
    """

    name: str
    words: str
    added: bool = False

    def __str__(self) -> str:
        return f"{shown_name(self.name)}: {self.words}"

    @property
    def of_results(self) -> bool:
        """Whether the file is read again: not of one that was added, nor of a page or picture,
        which follows from the others."""
        drawn = not self.name.startswith("inputs/") and self.name.endswith(_DRAWN)
        return not (self.added or drawn)


def changes(path: Path) -> list[Difference]:
    """Differences of the files of a run from its sign-off record, by file name.

    The signatures are not among the files, see `signatures.verified`. Where the folder holds more
    than files and folders, that alone is named and no file is read.

    Raises
    ------
    ResultError
        If the folder holds no run that can be read.
    """
    odd = [Difference(name, not_plain(kind)) for name, kind in unplain(path)]
    if odd:
        return odd
    if _holds_file(path / COMPLETE):
        return [Difference(AMENDMENT, _HALF_MOVED)]
    try:
        known = _recorded_hashes(path, recorded := read_json(path / NAME))
    except ResultError as error:
        run_reader.read_summary(path)  # raises where the folder holds no run at all
        return [Difference(NAME, str(error).removeprefix(f"{path / NAME}: "))]
    now = hashes(path)
    differences = [
        Difference(name, f"{'was changed' if name in now else 'is missing'} since the sign-off")
        for name, digest in known.items()
        if now.get(name) != digest
    ]
    unknown = [name for name in now if name not in known]
    own = [name for name in _of_every_run(path) if name in unknown] if unknown else []
    differences += (Difference(NAME, f"holds no hash of {name}") for name in own)
    if not differences:
        differences = _disagreements(recorded, _record(path, known))
    added = (*(name for name in unknown if name not in own), *_unhashed(path))
    differences += (Difference(name, _ADDED, added=True) for name in added)
    if _holds_file(path / AMENDMENT):
        differences.append(Difference(AMENDMENT, _INCOMPLETE, added=True))
    return sorted(differences)


def require_recorded(path: Path) -> None:
    """Refuse a finished run whose results, case or record differ from the record.

    Pages and pictures are not looked at: no number is read from them.

    Raises
    ------
    AlteredError
        Naming each file that differs.
    ResultError
        If the folder holds no run that can be read.
    """
    run_reader.require_folder(path)
    lines = [str(path / str(each)) for each in changes(path) if each.of_results]
    if lines:
        raise AlteredError("; ".join(lines))


def read_run(path: str | Path) -> run_reader.Run:
    """Finished run read from its folder, verified against its record.

    Raises
    ------
    AlteredError
        If a result, the case or the record was changed since the run, or a file is missing.
    ResultError
        If the folder holds no run that can be read, or if two records disagree.
    """
    require_recorded(Path(path))
    return run_reader.read_run(path)


def _recorded_hashes(path: Path, recorded: Json) -> dict[str, str]:
    """Hash by file name in a sign-off record; ResultError if it is no record of this schema.

    Parameters
    ----------
    path : Path       run folder
    recorded : JSON   contents of the record
    """
    run_reader.require_schema(path / NAME, recorded)
    known = recorded.get("files") if isinstance(recorded, dict) else None
    if not isinstance(known, dict) or not all(_is_sha256(each) for each in known.values()):
        raise ResultError(f"{path / NAME}: holds no hashes")
    return known


def hashes(path: Path) -> dict[str, str]:
    """SHA-256 of every file of a run but the record and its signatures."""
    return file_hashes(path, lambda name: name not in (NAME, SIGNATURES))


def _of_every_run(path: Path) -> tuple[str, ...]:
    """Names of the files that every run has: case, summary, and the results that the
    summary lists.
    """
    try:
        results = run_reader.read_summary(path)["files"]
    except ResultError:
        results = {}
    return ("case.toml", "run.json", *results)


def _unhashed(path: Path) -> Iterator[str]:
    """Names of the hidden files in a run folder, which no run writes; files on their way into the
    run are left out.
    """
    for entry in sorted(path.rglob("*")):
        parts = entry.relative_to(path).parts
        if parts[0] == AMENDMENT and len(parts) > 1:
            continue
        if any(part.startswith(".") for part in parts) and entry.is_file():
            yield "/".join(parts)


def _holds_file(folder: Path) -> bool:
    """Whether anything but folders is in a folder."""
    return any(not entry.is_dir() for entry in folder.rglob("*"))


def _is_sha256(value: Json) -> bool:
    return isinstance(value, str) and _SHA256.fullmatch(value) is not None


def environment() -> str:
    """Operating system and processor, for the summary of a run."""
    return f"{platform.system()} {platform.machine()}"


def _disagreements(recorded: Mapping[str, Json], drawn: Mapping[str, object]) -> list[Difference]:
    """Entries of the record that differ from the files of the run.

    The limitations are those of the version that wrote them; they follow from no file of the run.
    """
    left_out = tuple(limitations())
    names = [*drawn, *(name for name in recorded if name not in drawn)]
    return [
        Difference(NAME, f"{name} is not what the files of the run say")
        for name in names
        if (name not in left_out and recorded.get(name) != drawn.get(name))
        or (name in recorded) != (name in drawn)
    ]


def _figure(check: CheckRecord) -> CheckFigure:
    return {
        "id": check["id"],
        "demand": check["demand"],
        "error": check["error"],
        "limit": check["limit"],
        "unit": check["unit"],
        "utilisation": check["utilisation"],
        "status": check["status"],
        "not_proven": check["not_proven"],
        "load_case": check["load_case"],
        "cam_angle_deg": check["cam_angle_deg"],
        "source": check["source"],
        "method": check["method"],
        "corner": check["corner"],
        "corner_demand": check["corner_demand"],
    }

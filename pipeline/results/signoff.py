"""Sign-off record of a run: figures with error bars, verdict, evidence, hash of every file.

It follows from the files of the run alone and can be reproduced from them.
"""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from pathlib import Path

from camwright.pipeline.base.files import (
    Json,
    file_hashes,
    files_in,
    json_text,
    read_json,
    write_atomic,
)
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.model_limits import MODEL_LIMITS, limitations
from camwright.pipeline.results.run_reader import CheckRecord, to_be_confirmed

NAME = "signoff.json"
PRESENTATION = ("figures", "exports", "inspection")
"""Folders of files that are drawn from the results or measured later; they are not signed."""
PRESENTATION_SUFFIXES = (".html", ".png", ".svg", ".pdf")


def record(path: Path) -> dict[str, Json]:
    """The sign-off record of the run in a folder.

    Raises
    ------
    ResultError
        If a file of the run is missing or unreadable.
    """
    summary = run_reader.read_summary(path)
    trial = path / f"trial_{summary['final_trial']}"
    made, checks = run_reader.read_trial_record(trial), run_reader.read_checks(trial)
    corners = path / "corners.json"
    return {
        "schema": run_reader.SCHEMA,
        "case": summary["case"],
        "case_sha256": run_reader.input_sha256(path),
        "code": {name: summary["versions"].get(name) for name in ("camwright", "source")},
        "environment": {
            "platform": summary["platform"],
            "versions": summary["versions"],
        },
        **run_reader.judgement(checks, made["depth"]),
        "binding": list(run_reader.binding_of(checks)),
        "governing": run_reader.governing_id(checks),
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
                "up_to": c["waived_up_to"],
                "unit": c["unit"],
                "status": c["status"],
            }
            for c in checks
            if c["waiver"]
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
        "files": hashes(path),
        "presentation": [name for name, _ in files_in(path) if is_presentation(name)],
    }


def _statements(checks: Sequence[CheckRecord]) -> list[Json]:
    """Limits of the model with their checks; a status of null: the check was not made."""
    status = {check["id"]: check["status"] for check in checks}
    return [
        {"statement": each.statement, "check": each.check, "status": status.get(each.check)}
        for each in MODEL_LIMITS
        if each.check
    ]


def write(path: Path) -> None:
    """Write the record into the folder of a run that is otherwise complete."""
    write_atomic(path / NAME, json_text(record(path)) + "\n")


def changes(path: Path) -> list[str]:
    """Differences from the sign-off record, one line a file; empty without any.

    Raises
    ------
    ResultError
        If the record is missing, unreadable or of another schema.
    """
    signed = read_json(path / NAME)
    run_reader.require_schema(path / NAME, signed)
    known = signed.get("files") if isinstance(signed, dict) else None
    if not isinstance(known, Mapping):
        return [f"{NAME}: holds no hashes"]
    now = hashes(path)
    differences = [f"{name}: is missing since the sign-off" for name in known if name not in now]
    differences += [f"{name}: was added since the sign-off" for name in now if name not in known]
    differences += [
        f"{name}: was changed since the sign-off"
        for name in known
        if name in now and now[name] != known[name]
    ]
    return sorted(differences) or _disagreements(signed, record(path))


def hashes(path: Path) -> dict[str, str]:
    """SHA-256 of every input, result and field file, without the record and presentation."""
    return file_hashes(path, lambda name: name != NAME and not is_presentation(name))


def is_presentation(name: str) -> bool:
    """Whether a file is drawn from the results and can be drawn again."""
    return name.startswith(tuple(f"{f}/" for f in PRESENTATION)) or name.endswith(
        PRESENTATION_SUFFIXES
    )


def environment() -> str:
    """System and processor, for the summary of a run."""
    return f"{platform.system()} {platform.machine()}"


def _disagreements(signed: Mapping[str, Json], drawn: Mapping[str, Json]) -> list[str]:
    """Entries of the record that differ from the files of the run.

    The limitations are those of the version that signed; they follow from no file of the run.
    """
    left_out = ("presentation", "files", "limitations", "singularities")
    words = [
        name for name in drawn if name not in left_out and not _agree(signed.get(name), drawn[name])
    ]
    return [f"{NAME}: {name} is not what the files of the run say" for name in words]


def _agree(signed: Json, drawn: Json) -> bool:
    """Whether all signed values agree; a later version may add entries."""
    if isinstance(signed, Mapping) and isinstance(drawn, Mapping):
        return all(key in drawn and _agree(value, drawn[key]) for key, value in signed.items())
    if isinstance(signed, list) and isinstance(drawn, list):
        same = len(signed) == len(drawn)
        return same and all(_agree(a, b) for a, b in zip(signed, drawn, strict=True))
    return signed == drawn


def _figure(check: CheckRecord) -> dict[str, Json]:
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

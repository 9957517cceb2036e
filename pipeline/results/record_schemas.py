"""JSON Schemas, draft 2020-12, of ``run.json``, checks and ``signoff.json``; in ``schemas/``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_json

NAMES = {
    "run": "run.json",
    "checks": "6_checks.json",
    "check": "output of camwright check --json",
    "signoff": "signoff.json",
}
"""Names of the schemas and the documents that they describe."""
_FOLDER = Path(__file__).parent / "schemas"


def record_schema(name: str) -> dict[str, Any]:
    """Schema of a record, complete in itself: it bundles the definitions it refers to.

    Raises
    ------
    InputError
        If the name is none of `NAMES`.
    """
    if name not in NAMES:
        raise InputError("schema", name, f"one of: {', '.join(NAMES)}")
    schema: dict[str, Any] = read_json(_FOLDER / f"{name}.json")
    schema["$defs"] = {**schema.get("$defs", {}), "common": read_json(_FOLDER / "common.json")}
    return schema

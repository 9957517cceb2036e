"""Reading a case file: TOML, cards, included files; the first error as one line."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import TypeAdapter, ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import inside
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.cards.card_filling import filled
from camwright.pipeline.case.case import Case, includes, kept_as
from camwright.pipeline.case.consistency import check_sections
from camwright.pipeline.case.error_text import first_error
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.renamed_keys import with_new_keys
from camwright.pipeline.case.section import Table, named

CASE_BYTES = 256 * 1024
INCLUDE_BYTES = 16 * 1024 * 1024
SCHEMA_VERSION = 1
_CARD = TypeAdapter(Table[Material])
_REFUSED = Material(E=1.0, nu=0.0, yield_strength=1.0, density=1.0, source="refused")


def read_case(path: str | Path) -> Case:
    """Read and check a case file.

    Raises
    ------
    InputError
        For the first thing that is wrong, by its dotted name.
    """
    path = Path(path)
    return parse_case(_read(path, "case", CASE_BYTES), path.resolve().parent)


def parse_case(content: str | bytes, folder: Path | None = None) -> Case:
    """A case from its text; included files are looked for in `folder`."""
    data = _parse_toml(content)
    version = data.get("schema_version")
    if version is not None and version != SCHEMA_VERSION:
        raise InputError("schema_version", version, f"{SCHEMA_VERSION}, the one known here")
    case = case_of(data, folder)
    case._folder = folder
    case._included = MappingProxyType(_read_includes(case, folder))
    if case.lift is not None and case.follower.face is not None:
        case.follower.face.contour(given_lift(case), case.cam)  # refuses a face too narrow
    return case


def case_of(data: Mapping[str, Any], folder: Path | None = None) -> Case:
    """A case from its tables, cards of `folder` filled in; files it includes are not read."""
    tables = filled(with_new_keys(data), folder)
    try:
        case = Case.model_validate(tables, context={"materials": _cards(tables.get("materials"))})
    except ValidationError as error:
        raise first_error(error) from None
    check_sections(case)
    return case


def _cards(tables: object) -> dict[str, Material]:
    """Material cards by name; a card that is refused stands for itself until `Case` refuses it."""
    found = {}
    for name, table in tables.items() if isinstance(tables, dict) else ():
        try:
            found[name] = _CARD.validate_python(table)
        except ValidationError:
            found[name] = _REFUSED
    return named(found)


def _parse_toml(content: str | bytes) -> dict[str, Any]:
    try:
        text = content if isinstance(content, str) else content.decode("utf-8-sig")
        return tomllib.loads(text)
    except RecursionError:
        raise InputError("case", "nested too deeply", "at most a few tables deep") from None
    except ValueError as error:  # UnicodeDecodeError and TOMLDecodeError alike
        raise InputError("case", " ".join(str(error).split()), "UTF-8 text in TOML") from None


def _read(path: Path, field: str, limit: int) -> bytes:
    try:
        if not path.is_file():
            raise InputError(field, str(path), "an existing file")
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(field, f"{path} ({reason})", "a readable file") from None
    if len(content) > limit:
        raise InputError(field, f"{path} is larger", f"at most {limit // 1024} KiB")
    return content


def _read_includes(case: Case, folder: Path | None) -> dict[str, bytes]:
    read: dict[str, bytes] = {}
    origin: dict[str, str] = {}
    for field, name in includes(case):
        if folder is None:
            raise InputError(field, name, "left out where a case has no folder")
        content = _read(inside(folder, name, field), field, INCLUDE_BYTES)
        kept = kept_as(name)
        if origin.setdefault(kept, name) != name:
            raise InputError(field, name, f"another file name than that of {origin[kept]}")
        read[kept] = content
    return read

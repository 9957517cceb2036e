"""Reading of a case file: TOML, cards, included files; errors as one line each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import inside, parse_toml
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.missing_kinds import missing_kind
from camwright.pipeline.base.quantities import In
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.added_tables import with_added, with_examples
from camwright.pipeline.case.arm_tables import with_arm
from camwright.pipeline.case.cards.card_filling import fill_cards
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.case import Case, includes, kept_as
from camwright.pipeline.case.case_values import (
    following,
    quantity_of,
    refused_as_written,
    steps_of,
)
from camwright.pipeline.case.closure_tables import with_closure
from camwright.pipeline.case.consistency import check_sections
from camwright.pipeline.case.error_text import MissingKeysError, Written, refusal_of
from camwright.pipeline.case.external_load import external_force
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.renamed_keys import with_new_keys
from camwright.pipeline.case.rocker_tables import with_rocker
from camwright.pipeline.case.scope_section import with_every_name, with_stand_ins
from camwright.pipeline.case.section import named
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.case.unknown_keys import with_unknown_keys

CASE_BYTES = 256 * 1024
INCLUDE_BYTES = 16 * 1024 * 1024
SCHEMA_VERSION = 1
_REFUSED = Material(E=1.0, nu=0.0, yield_strength=1.0, density=1.0, source=NO_SOURCE)


def read_case(path: str | Path) -> Case:
    """Case read from a file and checked.

    Raises
    ------
    InputError
        For the first error, by its dotted name.
    """
    return parse_case(case_bytes(path), Path(path).resolve().parent)


def case_bytes(path: str | Path) -> bytes:
    """Contents of a case file, bounded in size.

    Raises
    ------
    InputError
        If it is missing, unreadable or too large.
    """
    return _read(Path(path), str(path), "case", CASE_BYTES)


def parse_case(content: str | bytes, folder: Path | None = None) -> Case:
    """Case from its text; included files are read from `folder`."""
    return completed(case_of(tables_in(content), folder), folder)


def tables_in(content: str | bytes) -> Tables:
    """Tables of the text of a case; InputError for another schema version."""
    data: Tables = parse_toml(content, "case")
    version = data.get("schema_version")
    if version is not None and version != SCHEMA_VERSION:
        raise InputError(
            "schema_version", str(version), f"{SCHEMA_VERSION}, the version of this program"
        )
    return data


def completed(case: Case, folder: Path | None) -> Case:
    """Case with the files to which it refers read from `folder`; None: it may refer to none.

    A face too narrow, a second roller that its disc does not reach and a file without an external
    force are refused.
    """
    case._folder = folder
    case._included = MappingProxyType(_read_includes(case, folder))
    external_force(case)  # refuses a file without one
    second = case.cam.second
    if case.lift is not None and (case.follower.face is not None or second is not None):
        with refused_as_written(case):
            contour = case.contour(given_lift(case))  # refuses a face too narrow
            if second is not None:
                second.of(contour.pitch)  # refuses a second roller beyond the cam axis
    return case


def case_of(data: Tables, folder: Path | None = None) -> Case:
    """Case from its tables and the cards of `folder`; files to which it refers are not read.

    Raises
    ------
    InputError
        With all unknown keys, whatever else is refused: one of them may be the reason.
    """
    try:
        tables = resolved(data, folder)
        try:
            return validated(tables)
        except MissingKeysError as error:
            raise with_examples(error, tables, folder) from None
    except InputError as error:
        raise with_unknown_keys(error, data) from None


def resolved(data: Tables, folder: Path | None = None) -> Tables:
    """Tables of a case as they are validated: added tables, cards and new names in place, arm,
    rocker and groove reduced, and stand-ins for parts out of scope.

    Parameters
    ----------
    data : Tables   of the case file
    folder : Path   of its cards; None: shipped cards alone
    """
    named_tables = with_every_name(with_new_keys(with_added(data)))
    tables = with_stand_ins(with_closure(with_rocker(with_arm(named_tables))))
    fill_cards(tables, folder)
    return tables


def validated(tables: Tables) -> Case:
    """Case from resolved tables, checked by itself; InputError with all errors. Files are not
    read.
    """
    try:
        case = Case.model_validate(tables, context={"materials": _cards(tables.get("materials"))})
    except ValidationError as error:
        raise refusal_of(error) from None
    case = case.with_spring_on_arm()
    case._written = Written(tables)
    check_sections(case)
    return case


def with_values(case: Case, values: Mapping[str, TomlValue]) -> Case:
    """Case with other values, read and checked as a case file.

    Parameters
    ----------
    values : mapping   by dotted key: text as in a case file; a float of a field with a unit in SI

    Raises
    ------
    InputError
        If a key is unknown, or the case is refused; by its dotted name.
    """
    tables = tables_of(case)
    for key in following(values):
        if key not in values:
            leave_out(tables, key)
    for key, value in values.items():
        quantity = quantity_of(key)
        if isinstance(value, float) and isinstance(quantity, In) and quantity.unit:
            enter(tables, key, units.format(value, quantity.unit))
        else:
            enter(tables, key, value)
    return completed(case_of(tables, case.folder), case.folder)


def enter(tables: Tables, key: str, value: TomlValue) -> None:
    """Write a value into the tables of a case at a dotted key, in place; missing tables are
    made.
    """
    *path, last = steps_of(key)
    table: Any = tables
    for step in path:
        known = isinstance(table, list) if isinstance(step, int) else isinstance(table, dict)
        if not known or (isinstance(step, int) and step >= len(table)):
            raise InputError("factor", key, "a value in a table of the case")
        table = table[step] if isinstance(step, int) else table.setdefault(step, {})
    if not isinstance(table, dict) or isinstance(last, int):
        raise InputError("factor", key, "a value in a table of the case")
    table[last] = value


def leave_out(tables: Tables, key: str) -> None:
    """Remove the value of a dotted key from the tables of a case, in place, where it is there."""
    *path, last = steps_of(key)
    table: Any = tables
    for step in path:
        table = table.get(step, {})
    table.pop(last, None)


def _cards(tables: TomlValue | None) -> dict[str, Material]:
    """Materials of the case by name, a placeholder for an invalid one, which `Case` refuses by its
    field.
    """
    cards = {}
    for name, table in tables.items() if isinstance(tables, dict) else ():
        try:
            cards[name] = read_part(Material, table, f"materials.{name}")
        except InputError:
            cards[name] = _REFUSED
    return named(cards)


def _read(path: Path, name: str, field: str, limit: int) -> bytes:
    """Contents of a file of at most `limit` bytes.

    Parameters
    ----------
    path : Path   of the file
    name : str    of the file, for messages
    field : str   key that names it, for messages
    limit : int   bytes

    Raises
    ------
    InputError
        If there is no such file, or it cannot be read or is larger.
    """
    try:
        if not path.is_file():
            raise InputError(field, name, "an existing file")
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(field, f"{name} ({reason})", "a readable file") from None
    if len(content) > limit:
        raise InputError(field, f"{name} is larger", f"at most {limit // 1024} KiB")
    return content


def _read_includes(case: Case, folder: Path | None) -> dict[str, bytes]:
    """Contents of the files to which a case refers, by the name under which a run keeps them.

    Raises
    ------
    InputError
        If the case has no folder, a file cannot be read, is outside the folder or of a kind that is
        not read, or two would be kept under one name.
    """
    read: dict[str, bytes] = {}
    origin: dict[str, str] = {}
    for field, name in includes(case):
        if folder is None:
            raise InputError(field, name, "left out where a case has no folder")
        if (kind := missing_kind(field, Path(name).suffix)) is not None:
            raise InputError(field, name, f"a table; {kind.sentence}")
        content = _read(inside(folder, name, field), name, field, INCLUDE_BYTES)
        kept = kept_as(name)
        if origin.setdefault(kept, name) != name:
            raise InputError(field, name, f"another file name than that of {origin[kept]}")
        read[kept] = content
    return read

"""Unknown keys of a case file, told beside whatever else is refused."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from camwright.geometry.errors import InputError, SeveralInputsError, as_one
from camwright.pipeline.base.missing_kinds import missing_kind
from camwright.pipeline.case.added_tables import with_added
from camwright.pipeline.case.keys import NAME, case_keys
from camwright.pipeline.case.renamed_keys import with_new_keys
from camwright.pipeline.case.section import suggestion
from camwright.pipeline.case.toml_text import Tables


def with_unknown_keys(error: InputError, data: Tables) -> InputError:
    """Refusal of a case with its unknown keys before it; those that it names are not repeated.

    Parameters
    ----------
    error : InputError   refusal, by a rule that reads a few tables alone
    data : Tables        of the case file
    """
    try:
        tables = with_new_keys(with_added(data))
    except InputError:  # what the keys are is what is refused
        return error
    told = error.errors if isinstance(error, SeveralInputsError) else (error,)
    named = {each.field for each in told}
    return as_one((*(each for each in _unknown(tables) if each.field not in named), *told))


def _unknown(table: Tables, path: str = "", place: str = "") -> Iterator[InputError]:
    """Refusals of the keys of a table, and of those in it, that no kind of the table has.

    Parameters
    ----------
    path : str    of the table, dotted, as in the registry of keys
    place : str   the same with the numbers of rows, for messages
    """
    names = _names().get(path, ())
    for key, value in table.items():
        named, inner = f"{place}.{key}".lstrip("."), f"{path}.{key}".lstrip(".")
        if names == (NAME,):
            inner = f"{path}.{NAME}"
        elif names and key not in names:
            kind = missing_kind(named, "")
            limit = f"a known key{suggestion(key, names)}"
            limit += f"; {kind.sentence}" if kind is not None else ""
            yield InputError(named, "unknown key", limit)
            continue
        for k, row in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(row, dict):
                yield from _unknown(row, inner, f"{named}[{k}]" if row is not value else named)


@cache
def _names() -> dict[str, tuple[str, ...]]:
    """Names of the keys and tables in each table, by its path; those of all its kinds."""
    names: dict[str, dict[str, None]] = {}
    for key in case_keys():
        path = key.path
        while path:
            table, _, name = path.rpartition(".")
            names.setdefault(table, {})[name] = None
            path = table
    return {path: tuple(each) for path, each in names.items()}

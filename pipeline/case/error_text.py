"""Error messages of a case file, one line each: field, value as written, limit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from camwright.geometry.errors import InputError, as_one
from camwright.pipeline.base.missing_kinds import missing_kind
from camwright.pipeline.base.quantities import PURE
from camwright.pipeline.base.units import rounded
from camwright.pipeline.case.engine_section import KINDS
from camwright.pipeline.case.lift_section import LIFT_KINDS
from camwright.pipeline.case.toml_text import Tables, TomlValue
from camwright.pipeline.case.torque_section import TORQUE_KINDS

_NUMBERS = ("a whole number", PURE, "true or false")
_NAMING = ("kind", "law")  # last words of the keys whose values name a kind
_KINDS = {"engine": KINDS, "torque": TORQUE_KINDS, "lift": LIFT_KINDS}
_WORDS = {
    "missing": "given",
    "string_type": "text in quotes",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "model_type": "a table",
    "dict_type": "a table",
    "model_attributes_type": "a table",
    "tuple_type": "an array of tables",
    "date_type": "a date such as 2025-06-30",
    "union_tag_not_found": "a table with kind = {kinds}",
    "too_short": "at least {min_length} long",
    "too_long": "at most {max_length} long",
    "string_too_short": "at least {min_length} characters",
    "string_too_long": "at most {max_length} characters",
    "greater_than_equal": ">= {ge}",
    "less_than_equal": "<= {le}",
    "literal_error": "{expected}",
    "union_tag_invalid": "{expected_tags}",
    "limit": "{limit}",
}


@dataclass(frozen=True)
class Written:
    """Tables of a case file with the source text of their values, cards included.

    All are equal: two cases are, whose files state the same values in other words.
    """

    tables: Tables = field(default_factory=dict, compare=False)

    def value(self, steps: Iterable[str | int]) -> TomlValue | None:
        """Value at a dotted key in its steps, names and numbers of rows; None where the file omits
        it.
        """
        node: Any = self.tables
        for step in steps:
            try:
                node = node[step]
            except (KeyError, IndexError, TypeError):
                return None
        return node


def as_written(value: object, digits: int = 4) -> str:
    """Value of a case file for a message, unchanged but its number rounded to `digits`."""
    if isinstance(value, bool):
        return str(value).lower()
    return rounded(repr(value) if isinstance(value, float) else str(value), digits)


class MissingKeysError(InputError):
    """Case file without some required keys.

    Parameters
    ----------
    keys : tuple     dotted, all of them
    examples : str   lines of TOML with an example each, by their tables; "": none is known
    toml : str       the same as text to be pasted
    """

    def __init__(self, keys: tuple[str, ...], examples: str = "", toml: str = "") -> None:
        """Message that names the first key, with examples if there are any, else the other keys."""
        self.keys, self.toml = keys, toml
        limit = "given"
        if examples:
            count = f", as all {len(keys)} missing keys" if len(keys) > 1 else ""
            paste = "camwright check CASE --missing prints them as TOML to be pasted"
            limit = f"given{count}; with examples: {examples}; {paste}"
        elif len(keys) > 1:
            names = {key: key.rpartition(".")[2] for key in keys[1:]}
            limit = f"given, and so must {grouped(names)}"
        super().__init__(keys[0], "missing", limit)


def grouped(texts: Mapping[str, str]) -> str:
    """Dotted keys in one line, grouped by table: ``[cam] width, end; [roller] radius``.

    Parameters
    ----------
    texts : mapping   by dotted key, such as its last word, or a line of TOML
    """
    tables: dict[str, list[str]] = {}
    for key, text in texts.items():
        tables.setdefault(key.rpartition(".")[0], []).append(text)
    parts = ((f"[{table}] " if table else "", ", ".join(each)) for table, each in tables.items())
    return "; ".join(f"{table}{each}" for table, each in parts)


def refusal_of(error: ValidationError, section: str = "") -> InputError:
    """Exception with the errors of a section of a case file, the first of each key.

    Unknown keys stand first and missing keys last, in one message: an unknown key is often the
    misspelling of a missing one.

    Parameters
    ----------
    section : str   dotted name before the keys of the messages; "" at the top of the file
    """
    entries = error.errors(include_url=False)
    within = {entry["loc"][:k] for entry in entries for k in range(len(entry["loc"]))}
    # a list without its refused rows is too short, too
    entries = [each for each in entries if each["type"] != "too_short" or each["loc"] not in within]
    entries.sort(key=lambda entry: "unknown_key" not in entry.get("ctx", {}))
    by_key = {_key_of(entry, section): entry for entry in reversed(entries)}
    missing = tuple(key for key in reversed(by_key) if by_key[key]["type"] == "missing")
    errors = [_refusal(by_key[key], key) for key in reversed(by_key) if key not in missing]
    errors += [MissingKeysError(missing)] if missing else []
    return as_one(tuple(errors))


def _refusal(entry: Mapping[str, Any], key: str) -> InputError:
    """InputError of one key from an error of pydantic: value as written, limit in words and, for a
    kind that is not provided, what to do about it.

    Parameters
    ----------
    entry : mapping   error of pydantic
    key : str         dotted key; "": the case
    """
    context, value = dict(entry.get("ctx", {})), entry["input"]
    word = value if isinstance(value, str) else ""
    if "field" in context:
        value = _stated(entry["input"], context)
        word = str(value)
    elif "unknown_key" in context:
        word = str(value.get("kind", "")) if context["unknown_key"] == "kind" else ""
        value = "unknown key"
    elif entry["type"] == "union_tag_invalid":
        value = word = context["tag"]
    if entry["type"] == "union_tag_not_found":
        context["kinds"] = " or ".join(f'"{kind}"' for kind in _kinds(entry["loc"]))
    quoted = isinstance(value, str)
    if isinstance(value, (dict, list)):
        value = "a table" if isinstance(value, dict) else "an array"
    limit = _WORDS.get(entry["type"], entry["msg"]).format_map(context)
    if quoted and limit in _NUMBERS:
        value, limit = f'"{value}"', f"{limit}, not in quotes"
    named = key.rpartition(".")[2] in _NAMING or value == "unknown key"
    kind = missing_kind(key, word) if named else None
    limit += f"; {kind.sentence}" if kind is not None else ""
    return InputError(key or "case", as_written(value), limit)


def _key_of(entry: Mapping[str, Any], section: str) -> str:
    """Dotted key of an error of pydantic; where the error is of the kind of a table, that of
    `kind`.

    Parameters
    ----------
    entry : mapping   error of pydantic
    section : str     dotted name of the section that was validated
    """
    context = entry.get("ctx", {})
    key = f"{section}.{_dotted(entry['loc'])}".strip(".")
    if entry["type"] == "union_tag_invalid":
        return f"{key}.kind"
    inner = context.get("field", context.get("unknown_key", ""))
    return f"{key}.{inner}".strip(".")


def _stated(table: object, context: Mapping[str, Any]) -> object:
    """The refused value of a part as its table states it; else in words."""
    stated = table.get(context["field"]) if isinstance(table, dict) else None
    return context["value"] if stated is None or isinstance(stated, (dict, list)) else stated


def _dotted(location: tuple[int | str, ...]) -> str:
    """``("load_case", 0, "speed")`` as ``load_case[0].speed``; without the tag of a union."""
    text = ""
    for position, part in enumerate(location):
        if position == 1 and part in _kinds(location):
            continue
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")


def _kinds(location: tuple[int | str, ...]) -> tuple[str, ...]:
    return _KINDS.get(str(location[0]), ())

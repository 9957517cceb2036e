"""First error of a case file in one line, its value as written: field, value, limit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import PURE
from camwright.pipeline.base.units import rounded
from camwright.pipeline.case.engine_section import KINDS
from camwright.pipeline.case.lift_section import LIFT_KINDS
from camwright.pipeline.case.toml_text import Tables, TomlValue
from camwright.pipeline.case.torque_section import TORQUE_KINDS

_NUMBERS = ("a whole number", PURE, "true or false")
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
    """Tables of a case file with the texts of their values, those of its cards included.

    All are equal: two cases are, whose files state the same values in other words.
    """

    tables: Tables = field(default_factory=dict, compare=False)

    def value(self, steps: Iterable[str | int]) -> TomlValue | None:
        """Value at the steps of a dotted key; None where the file leaves it out."""
        node: Any = self.tables
        for step in steps:
            try:
                node = node[step]
            except (KeyError, IndexError, TypeError):
                return None
        return node


def as_written(value: object, digits: int = 4) -> str:
    """Value of a case file in a message: as it stands, its number rounded to `digits`."""
    if isinstance(value, bool):
        return str(value).lower()
    return rounded(repr(value) if isinstance(value, float) else str(value), digits)


def first_error(error: ValidationError, section: str = "") -> InputError:
    """First error in one line; an unknown key comes before a missing one, often its misspelling."""
    errors = error.errors(include_url=False)
    errors.sort(key=lambda entry: "unknown_key" not in entry.get("ctx", {}))
    first, others = errors[0], len(errors) - 1
    context = dict(first.get("ctx", {}))
    key, value = f"{section}.{_dotted(first['loc'])}".strip("."), first["input"]
    if "field" in context:
        key, value = f"{key}.{context['field']}", _stated(first["input"], context)
    elif "unknown_key" in context:
        key = f"{key}.{context['unknown_key']}".lstrip(".")
        value = "unknown key"
    elif first["type"] == "missing":
        value = "missing"
    elif first["type"] == "union_tag_invalid":
        key, value = f"{key}.kind", context["tag"]
    if first["type"] == "union_tag_not_found":
        context["kinds"] = " or ".join(f'"{kind}"' for kind in _kinds(first["loc"]))
    quoted = isinstance(value, str)
    if isinstance(value, (dict, list)):
        value = "a table" if isinstance(value, dict) else "an array"
    limit = _WORDS.get(first["type"], first["msg"]).format_map(context)
    if quoted and limit in _NUMBERS:
        value, limit = f'"{value}"', f"{limit}, not in quotes"
    more = f" (and {others} more)" if others else ""
    return InputError(key or "case", as_written(value), f"{limit}{more}")


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

"""First error of a case file in one line: field, value, limit."""

from __future__ import annotations

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.case.engine_section import KINDS
from camwright.pipeline.case.lift_section import LIFT_KINDS

_KINDS = {"engine": KINDS, "lift": LIFT_KINDS}
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


def first_error(error: ValidationError, section: str = "") -> InputError:
    """First error in one line; an unknown key comes before a missing one, often its misspelling."""
    errors = error.errors(include_url=False)
    errors.sort(key=lambda entry: "unknown_key" not in entry.get("ctx", {}))
    first, others = errors[0], len(errors) - 1
    context = dict(first.get("ctx", {}))
    field, value = f"{section}.{_dotted(first['loc'])}".strip("."), first["input"]
    if "field" in context:
        field, value = f"{field}.{context['field']}", context["value"]
    elif "unknown_key" in context:
        field = f"{field}.{context['unknown_key']}".lstrip(".")
        value = "unknown key"
    elif first["type"] == "missing":
        value = "missing"
    elif first["type"] == "union_tag_invalid":
        field, value = f"{field}.kind", context["tag"]
    if first["type"] == "union_tag_not_found":
        context["kinds"] = " or ".join(f'"{kind}"' for kind in _kinds(first["loc"]))
    if isinstance(value, (dict, list)):
        value = "a table" if isinstance(value, dict) else "an array"
    limit = _WORDS.get(first["type"], first["msg"]).format_map(context)
    more = f" (and {others} more)" if others else ""
    return InputError(field or "case", value, f"{limit}{more}")


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

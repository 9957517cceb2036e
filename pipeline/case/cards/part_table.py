"""Reading of a part from a table of a card or catalogue."""

from __future__ import annotations

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In, Part, marks_of
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.section import PartType, part_of, section_of
from camwright.pipeline.case.toml_text import Tables, TomlValue


def read_part(part: type[PartType], table: TomlValue, field: str) -> PartType:
    """Part of a machine read from a table, with units and bounds checked.

    Parameters
    ----------
    part : type          class of the part
    table : TOML value   refused unless a table
    field : str          dotted name of the table, for messages

    Raises
    ------
    InputError
        For an unknown or missing key, or a value out of its bounds.
    """
    try:
        section = section_of(part).model_validate(table)
    except ValidationError as error:
        raise refusal_of(error, field) from None
    try:
        return part_of(part, section)
    except InputError as error:
        raise InputError(f"{field}.{error.field}", error.value, error.limit) from None


def read_value(part: type[Part], key: str, table: Tables, bounds: str = "") -> float:
    """Number of one key in the table of a part, SI, within the bounds of the key; the rest of the
    table is not read.

    Parameters
    ----------
    part : type      class of the part
    key : str        of a field, or of a value from which another follows
    table : Tables   the part's own
    bounds : str     key whose bounds hold, where not the same

    Raises
    ------
    InputError
        If the key is missing, or its value is no number of its unit within its bounds.
    """
    resolved = part.resolved.get(bounds or key)
    mark = marks_of(part)[bounds or key] if resolved is None else resolved.quantity
    if not isinstance(mark, In):
        raise TypeError(f"{part.table}.{bounds or key} is no number with bounds")
    try:
        return mark.read(table.get(key))
    except InputError as error:
        raise InputError(f"{part.table}.{key}", error.value, error.limit) from None

"""Reading of a part from a table of a card or catalogue."""

from __future__ import annotations

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.section import PartType, part_of, section_of
from camwright.pipeline.case.toml_text import TomlValue


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

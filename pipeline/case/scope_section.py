"""Scope of the sign-off: parts of the machine that it does not cover."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.case.section import Section, Text

PartName = Literal[
    "roller_bearing", "pin", "fork", "spring", "guides", "camshaft", "camshaft_bearings", "key",
    "gear",
]  # fmt: skip
PART_WORDS: dict[PartName, str] = {
    "roller_bearing": "bearing of the roller",
    "pin": "pin of the roller",
    "fork": "fork of the roller",
    "spring": "spring design",
    "guides": "guides",
    "camshaft": "camshaft",
    "camshaft_bearings": "camshaft bearings",
    "key": "key",
    "gear": "driving gear",
}
"""Parts that a sign-off may leave out, in the order of the flow of force."""


class Scope(Section):
    """Parts that the sign-off does not cover, and why; every other part has to be described."""

    not_covered: Annotated[tuple[PartName, ...], Field(strict=False, max_length=16)] = ()
    reason: Text = ""

    def covers(self, part: PartName) -> bool:
        """Whether the sign-off covers a part."""
        return part not in self.not_covered

    @model_validator(mode="after")
    def _says_why(self) -> Self:
        if self.not_covered and not self.reason.strip():
            raise InputError("scope.reason", "missing", "given with scope.not_covered")
        return self

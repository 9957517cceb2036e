"""Scope of the sign-off: parts of the machine that it does not cover."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.case.section import Section, Text

PartName = Literal[
    "roller_bearing", "pin", "fork", "spring", "gas_spring", "torsion_spring", "guides",
    "camshaft", "camshaft_bearings", "key", "gear",
]  # fmt: skip
PART_WORDS: dict[PartName, str] = {
    "roller_bearing": "bearing of the roller",
    "pin": "pin of the roller",
    "fork": "fork of the roller",
    "spring": "spring design",
    "gas_spring": "gas spring",
    "torsion_spring": "torsion spring",
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

    @property
    def statement(self) -> str:
        """The parts left out and the reason on one line; "" without any."""
        parts = ", ".join(words for part, words in PART_WORDS.items() if not self.covers(part))
        reason = " ".join(self.reason.split())
        return f"Not covered by this sign-off: {parts}: {reason}" if parts else ""

    def as_record(self) -> dict[str, str | list[str]]:
        """The scope for ``run.json`` and ``signoff.json``."""
        return {
            "not_covered": list(self.not_covered),
            "reason": self.reason,
            "statement": self.statement,
        }

    def covers(self, part: PartName) -> bool:
        """Whether the sign-off covers a part."""
        return part not in self.not_covered

    @model_validator(mode="after")
    def _says_why(self) -> Self:
        if self.not_covered and not self.reason.strip():
            raise InputError("scope.reason", "missing", "given with scope.not_covered")
        return self

"""Scope of the sign-off: parts of the machine that it does not cover."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.case.section import Section, Text
from camwright.pipeline.case.toml_text import Tables, TomlValue

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


_STAND_IN = "assumed, as the scope leaves out the {}"
_OVERHANG = "overhang_at_max_lift"
_STEM = 10e-3  # m, where the case does not state its diameter


def with_stand_ins(tables: Tables) -> Tables:
    """Tables of a case with stand-ins for required parts that it leaves out and does not cover.

    Guides without friction and clearance, of the bore of the stem: four diameters apart, one
    diameter long, at most twice the overhang. A roller bearing without data. Their sources say
    that they are assumed.
    """
    scope, roller = tables.get("scope"), tables.get("roller")
    left_out = scope.get("not_covered") if isinstance(scope, dict) else None
    if not isinstance(left_out, list):
        return tables
    if "roller_bearing" in left_out and isinstance(roller, dict) and "bearing" not in roller:
        words = _STAND_IN.format(PART_WORDS["roller_bearing"])
        own: Tables = dict(roller)
        own["bearing"] = {"name": "none", "source": words}
        tables = tables | {"roller": own}
    if "guides" in left_out and "guides" not in tables:
        tables = tables | {"guides": _guides(tables.get("follower"))}
        sources, words = tables.get("sources", {}), _STAND_IN.format(PART_WORDS["guides"])
        if isinstance(sources, dict):
            stated: Tables = {"guides.spacing": words}
            tables["sources"] = stated | sources
    return tables


def is_stand_in(tables: Tables, key: str) -> bool:
    """Whether a key stands in a guide that `with_stand_ins` has put there."""
    first, _, rest = key.partition(".")
    guides = tables.get(first) if first == "guides" else None
    side = guides.get(rest.partition(".")[0]) if isinstance(guides, dict) else None
    return isinstance(side, dict) and side.get("source") == _STAND_IN.format(PART_WORDS["guides"])


def _guides(follower: TomlValue | None) -> Tables:
    """Guides that neither rub nor tilt, on the stem of a follower."""
    stem = follower if isinstance(follower, dict) else {}
    diameter, overhang = _length(stem, "stem_diameter", _STEM), _length(stem, _OVERHANG, _STEM)
    guide: Tables = {
        "length": units.format(min(diameter, 2.0 * overhang), "mm"),
        "diameter": stem.get("stem_diameter", units.format(_STEM, "mm")),
        "friction": 0.0,
        "source": _STAND_IN.format(PART_WORDS["guides"]),
    }
    if "stem_material" in stem:
        guide["material"] = stem["stem_material"]
    spacing = units.format(4.0 * diameter, "mm")
    return {"spacing": spacing, "a": dict(guide), "b": dict(guide)}


def _length(table: Tables, key: str, default: float) -> float:
    """Length at a key of a table, m; the default where there is none, which is refused later."""
    try:
        value = units.parse(table.get(key), "mm", key)
    except InputError:
        return default
    return value if value > 0.0 else default

"""Scope of the sign-off: parts of the machine that it excludes."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from fnmatch import fnmatchcase
from types import MappingProxyType
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import Known
from camwright.pipeline.base.source import Source, entry_of
from camwright.pipeline.case.section import Section, Text
from camwright.pipeline.case.toml_text import Tables, TomlValue
from camwright.pipeline.follower.spring_kinds import TABLES_OF_PARTS, SpringPart
from camwright.pipeline.records.run_summary import ScopeRecord

PartName = Literal[
    "roller_bearing", "pin", "fork", "arm", "rocker", "pivot", "spring", SpringPart, "guides",
    "camshaft", "camshaft_bearings", "key", "gear",
]  # fmt: skip
Subject = Literal["stem", "bore", "line_ends", "friction", "requirements"]
"""What is left out besides parts: data that a part which is judged would need as well."""
ScopeName = PartName | Subject
PART_WORDS: dict[PartName, str] = {
    "roller_bearing": "bearing of the roller",
    "pin": "pin of the roller",
    "fork": "fork of the roller",
    "arm": "arm of the follower",
    "rocker": "second arm of the rocker",
    "spring": "spring design",
    **{part: part.replace("_", " ") for part in TABLES_OF_PARTS},
    "guides": "guides",
    "pivot": "pivot of the arm",
    "camshaft": "camshaft",
    "camshaft_bearings": "camshaft bearings",
    "key": "key",
    "gear": "driving gear",
}
"""Parts that a sign-off may leave out, in the order of the flow of force."""
SUBJECT_WORDS: dict[Subject, str] = {
    "stem": "stem of the follower",
    "bore": "bore of the cam",
    "line_ends": "ends of the line of contact",
    "friction": "friction, film and finish of the contact",
    "requirements": "life, over-speed and room",
}
SCOPE_WORDS: Mapping[ScopeName, str] = MappingProxyType(
    dict((*PART_WORDS.items(), *SUBJECT_WORDS.items()))
)
OF_STEM: tuple[ScopeName, ...] = ("guides", "stem")
"""What an arm does not have."""
ROCKER: ScopeName = "rocker"
"""What an arm without a second one does not have."""
OF_ARM: tuple[ScopeName, ...] = ("arm", ROCKER, "pivot")
"""What a stem does not have."""
EVERY = "all"
"""Word of a case file for all that a sign-off may leave out."""
_KEYS: dict[ScopeName, tuple[str, ...]] = {
    "roller_bearing": ("roller.bearing", "roller.hub_radius"),
    "pin": ("roller.pin",),
    "fork": ("roller.fork",),
    "arm": tuple(f"follower.arm.{key}" for key in ("width", "depth", "material", "*_notch")),
    ROCKER: tuple(f"rocker.{key}" for key in ("width", "depth", "notch")),
    "spring": ("spring.design", "spring.travel_max"),
    **dict(TABLES_OF_PARTS.items()),
    "guides": ("guides", "follower.overhang_at_max_lift", "follower.anti_rotation"),
    "pivot": ("follower.pivot",),
    "camshaft": ("camshaft",),
    "key": ("cam.keyway", "cam.key"),
    "gear": ("camshaft.gear",),
    "stem": ("follower.stem_*", "follower.overhang_at_max_lift", "follower.anti_rotation",
             "follower.face.thickness"),
    "bore": ("cam.bore_radius", "cam.fit"),
    "line_ends": ("cam.end", "roller.end", "follower.face.end", "roller.axial_offset",
                  "roller.width", "follower.face.depth"),
    "friction": ("roller.friction", "follower.face.friction", "*.roughness", "lubricant",
                 "follower.face.pv_limit"),
    "requirements": ("limits.overspeed", "limits.target_life", "limits.cam_radius",
                     "limits.*_life", "limits.tool_radius", "workshop.tool_radius",
                     "limits.curvature_rate"),
}  # fmt: skip
"""Keys, and tables by theirs, that a part alone needs: not missed where it is left out."""


_NOT_COVERED = "Not covered by this sign-off: "


class Scope(Section):
    """Parts that the sign-off does not cover, and why; every other part has to be described."""

    not_covered: Annotated[
        tuple[ScopeName, ...],
        Field(strict=False, max_length=32),
        Known("own responsibility", ("gear",)),
    ] = ()
    """parts left out of the sign-off"""
    reason: Annotated[
        Text, Known("own responsibility", "signed off by the maker of the engine")
    ] = ""
    """why they are left out"""
    without: Annotated[
        tuple[ScopeName, ...],
        Field(strict=False, max_length=2),
        Known("entered by the reader of a case", ("guides", "stem")),
    ] = ()
    """parts that the follower does not have: stem and guides of an arm"""

    @property
    def statement(self) -> str:
        """Excluded parts with the reason, in one line; "" without any."""
        parts = ", ".join(
            words
            for part, words in SCOPE_WORDS.items()
            if part in self.not_covered and part not in self.without
        )
        reason = " ".join(self.reason.split())
        return f"{_NOT_COVERED}{parts}: {reason}" if parts else ""

    def as_record(self, undescribed: str = "") -> ScopeRecord:
        """The scope for ``run.json`` and ``signoff.json``.

        Parameters
        ----------
        undescribed : str   part that no case describes, and so none can leave out
        """
        said = self.statement
        if undescribed:
            begin = f"{said}; " if said else _NOT_COVERED
            said = f"{begin}{undescribed}: not in the case"
        return {"not_covered": list(self.not_covered), "reason": self.reason, "statement": said}

    def covers(self, part: ScopeName) -> bool:
        """Whether the sign-off covers a part or subject."""
        return part not in (*self.not_covered, *self.without)

    def leaves_out(self, key: str) -> bool:
        """Whether a key belongs to an excluded part and need not be stated."""
        return self.lacks(key) or _is_of(key, self.not_covered)

    def lacks(self, key: str) -> bool:
        """Whether a key belongs to a part that the follower does not have."""
        return _is_of(key, self.without)

    @model_validator(mode="after")
    def _says_why(self) -> Self:
        """Refuse a scope that leaves out parts without a reason."""
        if self.not_covered and not self.reason.strip():
            raise InputError("scope.reason", "missing", "given with scope.not_covered")
        return self


def _is_of(key: str, parts: tuple[ScopeName, ...]) -> bool:
    """Whether a key is one of `_KEYS` of any of the parts, or of a table of theirs."""
    return any(
        fnmatchcase(key, pattern) or fnmatchcase(key, f"{pattern}.*")
        for part in parts
        for pattern in _KEYS.get(part, ())
    )


_STAND_IN = "assumed, as the scope leaves out the {}"


def _stand_in(words: str) -> TomlValue:
    """Source of a value that stands in for what the scope leaves out."""
    stated: TomlValue = entry_of(Source(_STAND_IN.format(words), confirmed=False))
    return stated


_OVERHANG = "overhang_at_max_lift"
_STEM = 10e-3  # m, where the case does not state its diameter
_SHORT = "30 mm", "10 mm"  # overhang of a stem, thickness of a face, that are left out
_HALF = 0.5  # radius of a bore and of a hub over that of the body around it


def with_every_name(tables: Tables) -> Tables:
    """Tables of a case with `EVERY` in the scope expanded to names."""
    scope = tables.get("scope")
    if not isinstance(scope, dict) or scope.get("not_covered") not in (EVERY, [EVERY]):
        return tables
    follower = tables.get("follower")
    has_arm = isinstance(follower, dict) and "arm" in follower
    absent = OF_ARM if not has_arm else () if "rocker" in tables else (ROCKER,)
    names: list[TomlValue] = [name for name in SCOPE_WORDS if name not in absent]
    return tables | {"scope": scope | {"not_covered": names}}


def with_stand_ins(tables: Tables) -> Tables:
    """Tables of a case with stand-ins for the required values of excluded parts.

    - guides: without friction and clearance, of the bore of the stem: four diameters apart, one
      diameter long, at most twice the overhang
    - roller_bearing: without data, on a hub of half the radius of the roller
    - stem: 10 mm thick, of the material of the cam, 30 mm from guide A; a face 10 mm thick
    - bore: half of the base radius
    - line_ends: roller or face as wide as the cam
    - gear: the cam on the shaft whose speed is stated, where the case has a lift and no machine
    - requirements: over-speed: the greatest speed of the load cases

    Only keys that the case does not state, and no value that is refused elsewhere. Their sources
    say that they are assumed.
    """
    scope = tables.get("scope")
    if not isinstance(scope, dict):
        return tables
    listed = [scope.get(key, []) for key in ("not_covered", "without")]
    left_out = [name for names in listed if isinstance(names, list) for name in names]
    whole = _StandIns(deepcopy(tables), {})
    follower, cam, wheel = (whole.table(name) for name in ("follower", "cam", "roller"))
    plate = whole.table("follower.face")
    if "stem" in left_out and follower:
        whole.put("stem", "follower.stem_diameter", units.format(_STEM, "mm"))
        materials, own = whole.table("materials"), cam.get("material")
        known = own if isinstance(own, str) and own in materials else next(iter(materials), None)
        whole.put("stem", "follower.stem_material", known)
        whole.put("stem", f"follower.{_OVERHANG}", _SHORT[0])
        if plate:
            whole.put("stem", "follower.face.thickness", _SHORT[1])
    for body, key in ((plate, "follower.face.depth"), (wheel, "roller.width")):
        if "line_ends" in left_out and body:
            width = units.format(_length(cam, "width", _STEM), "mm")
            whole.put("line_ends", key, width)
    if "roller_bearing" in left_out and wheel:
        radius = _length(wheel, "radius", 2.0 * _STEM)
        whole.put("roller_bearing", "roller.hub_radius", units.format(_HALF * radius, "mm"))
        if "bearing" not in wheel:
            wheel["bearing"] = {"name": "none", "source": _stand_in(PART_WORDS["roller_bearing"])}
    if "bore" in left_out and cam:
        base = _length(cam, "prime_radius", 2.0 * _STEM) - _length(wheel, "radius", 0.0)
        whole.put("bore", "cam.bore_radius", units.format(_HALF * abs(base), "mm"))
    if "requirements" in left_out and (fastest := _fastest(tables.get("load_case"))):
        whole.tables.setdefault("limits", {})
        whole.put("requirements", "limits.overspeed", fastest)
    if "gear" in left_out and "lift" in tables and not {"engine", "torque"} & set(tables):
        whole.tables.setdefault("mechanism", {})
        whole.put("gear", "mechanism.gear_ratio", 1.0)
    if "guides" in left_out and "guides" not in tables:
        whole.tables["guides"] = _guides(follower)
        whole.sources["guides.spacing"] = _stand_in(PART_WORDS["guides"])
    return whole.with_sources()


class _StandIns(NamedTuple):
    """Tables of a case with the stand-ins so far, and their sources by key."""

    tables: Tables
    sources: Tables

    def table(self, name: str) -> Tables:
        """A table of the case; an empty one where there is none."""
        node: TomlValue = self.tables
        for step in name.split("."):
            node = node.get(step, {}) if isinstance(node, dict) else {}
        return node if isinstance(node, dict) else {}

    def put(self, part: ScopeName, key: str, value: TomlValue | None) -> None:
        """Write a value into the tables, in place, where the case does not state it, with the
        source that it stands in for an excluded part.

        Parameters
        ----------
        part : str    name of the excluded part in the scope
        key : str     dotted
        value : any   as in a case file; None: nothing is written
        """
        path, _, name = key.rpartition(".")
        table = self.table(path)
        if name not in table and value is not None:
            table[name] = value
            self.sources[key] = _stand_in(SCOPE_WORDS[part])

    def with_sources(self) -> Tables:
        """The tables of the case, changed in place, with `sources` (where a value comes from, by
        key): those of `limits.*` in [limits.sources], others in [sources]. A source that the case
        states is kept.
        """
        limits = {key: text for key, text in self.sources.items() if key.startswith("limits.")}
        others = {key: text for key, text in self.sources.items() if key not in limits}
        if others and isinstance(stated := self.tables.get("sources", {}), dict):
            self.tables["sources"] = {**others, **stated}
        for key, text in limits.items():
            sources = self.table("limits").setdefault("sources", {})
            if isinstance(sources, dict):
                sources.setdefault(key.removeprefix("limits."), text)
        return self.tables


def _fastest(load_cases: TomlValue | None) -> str:
    """Greatest speed of load cases as written; "" where none can be read."""
    fastest, words = 0.0, ""
    for each in load_cases if isinstance(load_cases, list) else ():
        text = each.get("speed") if isinstance(each, dict) else None
        try:
            speed = units.parse(text, "rpm", "speed")
        except InputError:
            continue
        if isinstance(text, str) and speed > fastest:
            fastest, words = speed, text
    return words


def is_stand_in(tables: Tables, key: str) -> bool:
    """Whether a value of a guide is a stand-in of `with_stand_ins`."""
    first, _, rest = key.partition(".")
    guides = tables.get(first) if first == "guides" else None
    side = guides.get(rest.partition(".")[0]) if isinstance(guides, dict) else None
    return isinstance(side, dict) and side.get("source") == _stand_in(PART_WORDS["guides"])


def _guides(stem: Tables) -> Tables:
    """Table of guides that neither rub nor tilt, as stand-ins for guides that the scope leaves out.

    Parameters
    ----------
    stem : Tables   `[follower]`, with diameter, overhang and material of the stem
    """
    diameter, overhang = _length(stem, "stem_diameter", _STEM), _length(stem, _OVERHANG, _STEM)
    guide: Tables = {
        "length": units.format(min(diameter, 2.0 * overhang), "mm"),
        "diameter": stem.get("stem_diameter", units.format(_STEM, "mm")),
        "friction": 0.0,
        "source": _stand_in(PART_WORDS["guides"]),
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

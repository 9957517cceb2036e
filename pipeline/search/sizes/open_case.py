"""Case with open keys for `design sizes`, and its completion."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from camwright.geometry.arm_path import Arm
from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.case.case import Case, includes
from camwright.pipeline.case.case_file import (
    case_bytes,
    completed,
    enter,
    parse_case,
    resolved,
    tables_in,
    validated,
)
from camwright.pipeline.case.case_values import unit_at
from camwright.pipeline.case.case_writer import added_text, tables_text
from camwright.pipeline.case.keys import written
from camwright.pipeline.case.toml_text import Tables, TomlValue

PRIME, OFFSET = "cam.prime_radius", "cam.offset"
ROLLER, FACE = "roller.radius", "follower.face.width"
DISTANCE = "follower.arm.centre_distance"
APART, ARMS_ANGLE = "cam.conjugate.distance", "cam.conjugate.arm_angle"
SECOND_ROLLER = "cam.conjugate.roller_radius"
PLACES = APART, ARMS_ANGLE
"""Keys of the place of the second roller of a pair of discs, on a stem or an arm."""
RATE, PRELOAD = "spring.rate", "spring.preload"

_PROVISIONAL: Mapping[str, str] = {
    PRIME: "9000 mm", OFFSET: "0 mm", ROLLER: "4000 mm", FACE: "9900 mm",
    RATE: "1 kN/m", PRELOAD: "1 N", DISTANCE: "9000 mm", APART: "9900 mm", ARMS_ANGLE: "179 deg",
    SECOND_ROLLER: "1 mm",
}  # fmt: skip
"""Values that contradict no others, until the sizes are known; of a roller without a hub, and of a
follower on a stem."""
GAPS = tuple(_PROVISIONAL)
"""Keys that a case may leave open."""

_WITHIN_THICKNESS = 0.999  # depth of a provisional curved face over its thickness
HUB_WALL = 1.1
"""Least radius of a roller over that of its hub, where the bearing has no ring."""
_WITHIN_GROOVE = 1.01
"""Distance of a provisional path from the rim of its disc over the roller radius."""
_HEAD = "\n# Values of the keys that the case left open, by camwright design sizes.\n"


@dataclass(frozen=True, eq=False)
class OpenCase:
    """Case with open keys.

    Parameters
    ----------
    case : Case      with provisional values of the open keys
    gaps : tuple     dotted keys that it leaves open, in the order of `GAPS`
    text : str       of its file
    folder : Path    of its file; None: without files
    """

    case: Case
    gaps: tuple[str, ...]
    text: str
    folder: Path | None = None

    @property
    def grows(self) -> bool:
        """Whether the size of a disc is open: its prime radius, or the place of a second roller."""
        return bool({PRIME, *PLACES} & {*self.gaps})

    def with_sources(self, values: Mapping[str, float], sources: Mapping[str, str]) -> str:
        """Text of the complete case: the file's text, the values as tables ``[[added]]``.

        Parameters
        ----------
        values : mapping    SI number by key
        sources : mapping   source by key
        """
        if not values:
            return self.text
        table: Tables = {}
        for key, value in values.items():
            enter(table, key, written(value, unit_at(key)))
        enter(table, "sources", dict(sources))
        return f"{self.text.rstrip()}\n{_HEAD}{added_text(table)}"

    def sized(self, text: str) -> Case:
        """Complete case, from its text.

        Raises
        ------
        InputError
            If the values contradict the rest of the case.
        """
        return parse_case(text, self.folder)

    def write(self, text: str, out: Path) -> Path:
        """Write the complete case `text` to `out`, and copies of the files it includes if it lies
        in another folder.

        Raises
        ------
        ResultError
            If the case file exists already, or a file of the name of a copy with other content.
        """
        if out.exists():
            raise ResultError(f"{out}: exists already, not overwritten")
        if self.folder is not None and out.resolve().parent != self.folder.resolve():
            for _, name in includes(self.case):
                copy = out.parent / name
                content = (self.folder / name).read_bytes()
                if copy.exists() and copy.read_bytes() != content:
                    raise ResultError(f"{copy}: exists already, not overwritten")
                write_atomic(copy, content)
        return write_atomic(out, text)


def read_open_case(path: str | Path, free: Collection[str] = ()) -> OpenCase:
    """Case read from a file that may leave the keys of `GAPS` open.

    Parameters
    ----------
    free : collection   keys whose values in the file are not kept: open as well

    Raises
    ------
    InputError
        For the first error, by its dotted name.
    """
    return parse_open_case(case_bytes(path), Path(path).resolve().parent, free)


def parse_open_case(
    content: str | bytes, folder: Path | None = None, free: Collection[str] = ()
) -> OpenCase:
    """Case with open keys from its text: keys in `GAPS` that it does not state get provisional
    values.

    Parameters
    ----------
    content : str or bytes   of the case file
    folder : Path            of included files; None: it includes none
    free : collection        keys to be left open although the text states them

    Raises
    ------
    InputError
        If a key in `free` cannot be open, the case is invalid, or the lift would follow from an
        open spring or a constrained synthesis.
    """
    stated = tables_in(content)
    text = content if isinstance(content, str) else content.decode("utf-8-sig")
    if free:
        for key in free:
            _open(stated, key)
        text = tables_text(stated)
    tables = resolved(stated, folder)
    flat = _entry(tables, "follower.kind") == "flat"
    other = ROLLER if flat or _entry(tables, "follower.face.depth") is not None else FACE
    swings = isinstance(_entry(tables, "follower.arm"), dict)
    absent = {other, *((OFFSET, APART) if swings else (DISTANCE, ARMS_ANGLE))}
    if _entry(tables, "cam.closure") != "conjugate":
        absent |= {*PLACES, SECOND_ROLLER}
    gaps = tuple(key for key in GAPS if key not in absent and _entry(tables, key) is None)
    provisional = {
        **_PROVISIONAL,
        **_of_arm(tables),
        **_of_groove(tables),
        **_between_rollers(tables),
    }
    for key in gaps:
        enter(tables, key, _least_roller(tables) if key == ROLLER else provisional[key])
    case = completed(validated(tables), folder)
    if case.lift is None:
        for key in (RATE, PRELOAD):
            if key in gaps:
                limit = "given without [lift]: the lift follows from torque and spring"
                raise InputError(key, "missing", limit)
        if case.smoothing.kind == "constrained":
            limit = "a filter, or a lift in place of the engine: a constrained synthesis finds"
            limit += " spring and prime radius itself"
            raise InputError("smoothing.kind", "constrained", limit)
    return OpenCase(case, gaps, text, folder)


def _of_arm(tables: Tables) -> Mapping[str, str]:
    """Values of the open keys that contradict no others of an arm, {} of a stem: prime radius and
    centre distance of an arm square to its line to the cam, or of a flat face that touches where
    the arm ends; the width of a curved face that its thickness allows.
    """
    arm = _entry(tables, "follower.arm")
    if not isinstance(arm, dict):
        return {}
    length, distance, prime, plane, radius, thickness = (
        None if (stated := _entry(tables, key)) is None else units.parse(stated, "mm", key)
        for key in (
            *("follower.arm.length", DISTANCE, PRIME),
            *("follower.face.offset", "follower.face.radius", "follower.face.thickness"),
        )
    )
    face = dict[str, str]()
    if radius is not None:
        deep = radius if thickness is None else min(_WITHIN_THICKNESS * thickness, radius)
        face = {FACE: units.format(2.0 * float(np.sqrt(deep * (2.0 * radius - deep))), "mm")}
    if length is None:
        return face
    lowered = 0.0 if plane is None else plane
    if distance is None:
        distance = float(np.hypot(length, length if prime is None else prime + lowered))
    if prime is None and plane is None:
        prime = float(np.hypot(length, distance))
    elif prime is None:
        prime = float(np.sqrt(max(distance**2 - length**2, 0.5 * distance**2))) - lowered
    return face | {PRIME: units.format(prime, "mm"), DISTANCE: units.format(distance, "mm")}


def _of_groove(tables: Tables) -> Mapping[str, str]:
    """Prime radius that leaves a groove a rim around it; {} without one."""
    outer, roller = _entry(tables, "cam.groove.outer_radius"), _entry(tables, ROLLER)
    if not isinstance(outer, str):
        return {}
    size = units.parse(_least_roller(tables) if roller is None else roller, "mm", ROLLER)
    within = units.parse(outer, "mm", "cam.groove.outer_radius") - _WITHIN_GROOVE * size
    return {PRIME: units.format(within, "mm")}


def _between_rollers(tables: Tables) -> Mapping[str, str]:
    """Prime radius half way between both rollers of a pair of discs whose place is stated: at half
    of their distance, or of the angle between their arms; {} otherwise.
    """
    keys = (*PLACES, DISTANCE, "follower.arm.length")
    apart, angle, distance, length = (_entry(tables, key) for key in keys)
    if isinstance(apart, str):
        return {PRIME: units.format(0.5 * units.parse(apart, "mm", APART), "mm")}
    if not (isinstance(angle, str) and isinstance(distance, str) and isinstance(length, str)):
        return {}
    centre, long = (units.parse(each, "mm", DISTANCE) for each in (distance, length))
    arm = Arm(centre, long, 1.0)
    half = 0.5 * units.parse(angle, "deg", ARMS_ANGLE)
    return {PRIME: units.format(float(arm.radius(half)), "mm")}


def _least_roller(tables: Tables) -> str:
    """Radius of the smallest roller, as text with unit: that of the bearing's ring, or a tenth
    above that of the hub.
    """
    ring = _entry(tables, "roller.bearing.ring.outer_diameter")
    if isinstance(ring, str):
        return units.format(0.5 * units.parse(ring, "mm", ROLLER), "mm")
    hub = _entry(tables, "roller.hub_radius")
    if isinstance(hub, str):
        return units.format(HUB_WALL * units.parse(hub, "mm", "roller.hub_radius"), "mm")
    return _PROVISIONAL[ROLLER]


def _open(tables: Tables, key: str) -> None:
    """Remove the value of an open key from the tables of a file, in place; InputError for a key
    that cannot be open.
    """
    if key not in GAPS:
        raise InputError("--free", key, f"one of: {', '.join(GAPS)}")
    table, _, name = key.rpartition(".")
    added = tables.get("added")
    for each in (tables, *(added if isinstance(added, list) else ())):
        inner = _entry(each, table) if isinstance(each, dict) else None
        if isinstance(inner, dict):
            inner.pop(name, None)


def _entry(tables: Tables, key: str) -> TomlValue | None:
    """Value at a dotted key of tables; None where a table has none."""
    node: TomlValue | None = tables
    for step in key.split("."):
        node = node.get(step) if isinstance(node, dict) else None
    return node

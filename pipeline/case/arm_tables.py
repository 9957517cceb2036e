"""Oscillating follower in the tables of a case: its scope, start angle, inertia and swing."""

from __future__ import annotations

from camwright.geometry.arm_path import Arm
from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import MASS
from camwright.pipeline.case.cards.part_table import read_value
from camwright.pipeline.case.scope_section import OF_ARM, OF_STEM, is_stand_in
from camwright.pipeline.case.toml_text import Tables, TomlValue
from camwright.pipeline.follower.arm import FollowerArm

OSCILLATING = "oscillating"
_PIVOT = "pivot"
_START, _INERTIA = "follower.arm.start_angle", "follower.arm.inertia"
_OFFSET = "follower.face.offset"


def with_arm(tables: Tables) -> Tables:
    """Tables of a case with an oscillating follower as those of a translating one; others
    unchanged.

    A start angle is replaced by the prime radius that follows from it, a moment of inertia by the
    mass, angles of swing in the lift by arcs of the roller centre. The scope is without stem and
    guides, which only a translating follower has; one that leaves out the arm leaves out a pivot
    that is not described.

    Raises
    ------
    InputError
        If a follower of another kind has an arm, the case has guides, or start angle or inertia are
        wrong, or stated beside prime radius or mass; if another case leaves out an arm or its
        pivot, or is without stem or guides.
    """
    follower, scope = tables.get("follower"), tables.get("scope")
    left_out = scope.get("not_covered") if isinstance(scope, dict) else None
    if not isinstance(follower, dict) or follower.get("kind") != OSCILLATING:
        if isinstance(follower, dict) and "arm" in follower:
            limit = f'left out, or follower.kind = "{OSCILLATING}"'
            raise InputError("follower.arm", "a table", limit)
        if isinstance(left_out, list) and (named := [each for each in OF_ARM if each in left_out]):
            limit = f'without "{named[0]}", which follower.kind = "{OSCILLATING}" alone has'
            raise InputError("scope.not_covered", _shown(left_out), limit)
        if isinstance(scope, dict) and scope.get("without"):
            limit = f'left out: of follower.kind = "{OSCILLATING}" alone'
            raise InputError("scope.without", "stated", limit)
        return tables
    if "guides" in tables and not is_stand_in(tables, "guides.a"):
        limit = f'left out with follower.kind = "{OSCILLATING}", which has [follower.arm]'
        raise InputError("guides", "a table", limit)
    arm, cam = follower.get("arm"), tables.get("cam")
    stated = scope if isinstance(scope, dict) else {}
    stated = stated | {"without": list(OF_STEM)}
    if isinstance(left_out, list) and "arm" in left_out and _PIVOT not in {*follower, *left_out}:
        stated = stated | {"not_covered": [*left_out, _PIVOT]}
    tables = tables | {"scope": stated}
    if not isinstance(arm, dict):
        return tables
    rocker = tables.get("rocker")
    of_output = isinstance(rocker, dict) and rocker.get("lift") == "output"
    if isinstance(lift := tables.get("lift"), dict) and not of_output:
        tables = tables | {"lift": _as_arcs(lift, arm)}
    if "inertia" in arm:
        if "mass" in follower:
            raise InputError(_INERTIA, str(arm["inertia"]), "left out with follower.mass")
        follower = follower | {"mass": units.format(_mass(arm), "g")}
    if "start_angle" in arm and isinstance(cam, dict):
        if "prime_radius" in cam:
            raise InputError(_START, str(arm["start_angle"]), "left out with cam.prime_radius")
        prime = units.format(_prime_radius(arm, follower.get("face")), "mm")
        tables = tables | {"cam": cam | {"prime_radius": prime}}
    stated = {key: value for key, value in arm.items() if key not in FollowerArm.resolved}
    return tables | {"follower": follower | {"arm": stated}}


def _mass(arm: Tables) -> float:
    """Mass at the end of the arm that has the stated moment of inertia about the pivot, kg: inertia
    over length squared.
    """
    inertia, length = (read_value(FollowerArm, key, arm) for key in ("inertia", "length"))
    mass = inertia / length / length
    if not MASS.holds(mass):
        limit = f"such that inertia over length squared, the mass at the end, is {MASS.limit}"
        raise InputError(_INERTIA, str(arm["inertia"]), limit)
    return mass


def _prime_radius(arm: Tables, face: TomlValue | None) -> float:
    """Prime radius that follows from the start angle of an arm: distance from the cam axis, m, of
    the roller centre at this angle, or of the plane of a flat face.

    Parameters
    ----------
    arm : Tables   `[follower.arm]` with start_angle, centre_distance and length
    face : table   `[follower.face]`; flat where it has an offset; None: a roller

    Raises
    ------
    InputError
        If the start angle is not within 0 to 180 deg, or the face is beyond the cam axis.
    """
    start, distance, length = (
        read_value(FollowerArm, key, arm) for key in ("start_angle", "centre_distance", "length")
    )
    linkage = Arm(distance, length, 1.0)
    if not isinstance(face, dict) or "offset" not in face:
        return float(linkage.radius(start))
    height = float(linkage.face_radius(start, units.parse(face["offset"], "mm", _OFFSET)))
    if not height > 0.0:
        limit = f"such that the face is > 0 mm over the cam axis, not {units.shown(height, 'mm')}"
        raise InputError(_START, str(arm["start_angle"]), limit)
    return height


def _as_arcs(lift: Tables, arm: Tables) -> Tables:
    """Table of a lift in which strokes and points stated as angles of the arm are written as arcs,
    mm, at the length of the arm; other values are left as they are, for the reader to refuse.

    Parameters
    ----------
    lift : Tables   `[lift]`
    arm : Tables    `[follower.arm]` with its length
    """

    def arc(value: TomlValue) -> TomlValue:
        """An angle as text of the arc at the length of the arm; anything else as it is."""
        try:
            swing = units.parse(value, "deg", "")
            return units.format(swing * units.parse(arm.get("length"), "mm", ""), "mm")
        except InputError:
            return value

    in_arcs = dict(lift)
    for rows, key in (("segment", "stroke"), ("point", "lift")):
        if isinstance(stated := lift.get(rows), list):
            in_arcs[rows] = [
                each | {key: arc(each[key])} if isinstance(each, dict) and key in each else each
                for each in stated
            ]
    return in_arcs


def _shown(left_out: TomlValue | None) -> str:
    return (
        ", ".join(map(str, left_out)) if isinstance(left_out, list) else str(left_out or "missing")
    )

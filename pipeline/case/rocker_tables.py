"""Rocker in the tables of a case: mass and force of its output, reduced to the follower."""

from __future__ import annotations

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.case.cards.part_table import read_part, read_value
from camwright.pipeline.case.toml_text import Tables
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.rocker import Rocker

_MASS, _FORCE = "mass", "force"


def with_rocker(tables: Tables) -> Tables:
    """Tables of a case, with what the output of a rocker carries reduced to the follower.

    The mass is added to that of the follower by the square of the ratio at zero lift, a force to
    its external force by the ratio, which is constant; what the rocker itself moves stands in its
    table from then on.

    Raises
    ------
    InputError
        If a value is wrong, or a force is stated on a rocker without a constant ratio.
    """
    stated, follower = tables.get("rocker"), tables.get("follower")
    carried = {_MASS, _FORCE}
    if not isinstance(stated, dict) or not isinstance(follower, dict) or not carried & set(stated):
        return tables
    table = {key: value for key, value in stated.items() if key not in carried}
    for key in carried & set(stated):
        if f"output_{key}" in stated:
            raise InputError(f"rocker.output_{key}", str(stated[key]), f"left out with {key}")
    rocker = read_part(Rocker, table, Rocker.table)
    arm = follower.get("arm")
    if isinstance(arm, dict) and "length" not in arm:
        return tables  # refused when the arm is read
    length = read_value(FollowerArm, "length", arm) if isinstance(arm, dict) else None
    ratio = float(rocker.linkage(length).ratio(0.0))
    reduced = dict(follower)
    if _MASS in stated and "mass" in follower:
        mass = read_value(Rocker, _MASS, stated, "output_mass")
        total = units.parse(follower["mass"], "kg", "follower.mass") + mass * ratio * ratio
        reduced["mass"] = units.format(total, "g")
        table["output_mass"] = stated[_MASS]
    if _FORCE in stated:
        force = read_value(Rocker, _FORCE, stated, "output_force")
        if rocker.ratio is None or "external_force_file" in follower:
            limit = "left out without a constant ratio, or with follower.external_force_file"
            raise InputError("rocker.force", str(stated[_FORCE]), limit)
        own_force = units.parse(
            follower.get("external_force", "0 N"), "N", "follower.external_force"
        )
        reduced["external_force"] = units.format(own_force + force * ratio, "N")
        table["output_force"] = stated[_FORCE]
    return tables | {"rocker": table, "follower": reduced}

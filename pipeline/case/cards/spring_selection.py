"""Selection of a catalogue spring for a case by ``spring.catalogue = "FILE"``.

The resolved case states the dimensions of the selected spring instead of the catalogue. Rate and
preload of a spring that is not linear follow from its table.
"""

from __future__ import annotations

from pathlib import Path

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import inside
from camwright.pipeline.base.source import reworded
from camwright.pipeline.case.cards.part_table import read_part, read_value
from camwright.pipeline.case.cards.spring_catalogue import (
    CATALOGUE,
    SpringDemand,
    lightest,
    read_catalogue,
    sources_in,
)
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SOLID
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.case.value_sources import put_sources
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.spring_kinds import SHAPES, SpringShape
from camwright.pipeline.follower.spring_link import RockerSpring, SpringLink, linked

SHIPPED = "shipped"
_REASONS_SHOWN = 3  # refused springs in a message, the nearest


def put_spring(case: Tables, folder: Path | None) -> None:
    """Replace ``spring.catalogue`` by the ``[spring.design]`` of the selected spring.

    The spring must meet the rate, the preloads of all load cases, ``spring.travel_max`` and the
    limits of fatigue and solid clearance, also at the upper bounds of its tolerances.

    Parameters
    ----------
    case : dict        tables of a case file, changed in place
    folder : Path      folder of the case; None: shipped catalogue only

    Raises
    ------
    InputError
        If the catalogue cannot be read, the travel is missing, a design is given, or no spring
        meets the demand.
    """
    spring = case.get("spring")
    if not isinstance(spring, dict) or "catalogue" not in spring:
        return
    name = spring.pop("catalogue")
    for key in ("design", "link", "rocker"):
        if key in spring:
            raise InputError(f"spring.{key}", "a table", "left out with spring.catalogue")
    if "travel_max" not in spring:
        raise InputError("spring.travel_max", "missing", "given with spring.catalogue")
    demand = _demand(case, spring)
    if demand is None:
        return  # `Case` refuses the rate or preload
    path = _path(name, folder)
    springs = read_catalogue(path)
    best, reasons = lightest(springs, demand)
    if best is None:
        nearest = sorted(reasons, key=lambda each: len(reasons[each]))[:_REASONS_SHOWN]
        why = "; ".join(f"{each}: {', '.join(reasons[each])}" for each in nearest)
        limit = f"a catalogue with a suitable spring; nearest are {why}"
        raise InputError("spring.catalogue", str(name), limit if springs else "not empty")
    why = f"lightest of {len(springs)} in catalogue {name}: {best.name}; "
    source, sources = sources_in(path, best.name)
    spring["design"] = tables_of(best) | {"source": reworded(source, lambda text: why + text)}
    put_sources(case, "spring.design", spring["design"], sources)


def put_force(case: Tables) -> None:
    """Write rate and preload that follow from the table of a gas or torsion spring, or one with a
    link, into the case, in place.

    Raises
    ------
    InputError
        If the case states one of them, or its table is refused.
    """
    spring = case.get("spring")
    if not isinstance(spring, dict):
        return
    law = _law(spring)
    if law is None:
        return  # `Case` refuses a kind without its table
    shape = _reduced(law, case)
    rate, preload = float(shape.rate), float(shape.preload)
    for key, value, unit in (("rate", rate, "kN/m"), ("preload", preload, "N")):
        if key in spring:
            limit = f"left out: by {shape.table} it is {units.shown(value, unit)}"
            raise InputError(f"spring.{key}", str(spring[key]), limit)
        spring[key] = units.format(value, unit)


def _law(spring: Tables) -> SpringShape | None:
    """Force law of the spring of a case from its table: gas or torsion spring, or one with a link
    or on a rocker; None where rate and preload are stated, or the table is missing and refused
    later. A kind that is left out or unknown, refused later, too, is that of the table.
    """
    kind = str(spring.get("kind"))
    if kind not in ("coil", *SHAPES):
        kind = next((each for each in SHAPES if each in spring), "coil")
    part = SHAPES.get(kind)
    if part is not None and kind not in spring:
        return None
    shape = None if part is None else read_part(part, spring[kind], f"spring.{kind}")
    if shape is not None and not shape.linkable:
        return shape
    if "link" in spring:
        return linked(read_part(SpringLink, spring["link"], SpringLink.table), shape)
    if "rocker" in spring:
        return linked(read_part(RockerSpring, spring["rocker"], RockerSpring.table), shape)
    return shape


def _reduced(law: SpringShape, case: Tables) -> SpringShape:
    """Force law of a spring reduced to the follower by arm and rocker of the case; an arm of 1 m
    where the case lacks its length, which is refused later.

    Parameters
    ----------
    law : SpringShape   of the spring at its own place
    case : Tables       with follower and rocker
    """
    follower, rocker = case.get("follower"), case.get(Rocker.table)
    arm = follower.get("arm") if isinstance(follower, dict) else None
    length = 1.0 if law.carried == "arm" else None
    if isinstance(arm, dict):
        try:
            length = read_value(FollowerArm, "length", arm)
        except InputError:
            length = 1.0
    table = None if rocker is None else read_part(Rocker, rocker, Rocker.table)
    return law.on_arm(length, table)


def _demand(case: Tables, spring: Tables) -> SpringDemand[float] | None:
    """Demand of a case on its spring: rate, greatest preload, travel, tolerances and limits; None
    if its rate or preload is missing or not positive.

    Parameters
    ----------
    case : Tables     with load cases and limits
    spring : Tables   `[spring]`

    Raises
    ------
    InputError
        If the greatest travel is not above zero.
    """

    def number(table: Tables, key: str, default: float) -> float:
        """Number at a key of a table; the default for anything else, which is refused later."""
        value = table.get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return default
        return float(value)

    states = case.get("load_case")
    own = [state for state in states if isinstance(state, dict)] if isinstance(states, list) else []
    preloads = [table["preload"] for table in (spring, *own) if "preload" in table]
    limits = case.get("limits")
    limits = limits if isinstance(limits, dict) else {}
    try:
        rate = units.parse(spring.get("rate"), "kN/m", "spring.rate")
        preload = max((units.parse(each, "N", "spring.preload") for each in preloads), default=0.0)
    except InputError:
        return None
    travel = units.parse(spring["travel_max"], "mm", "spring.travel_max")
    if not (rate > 0.0 and preload > 0.0):
        return None
    if not travel > 0.0:
        raise InputError("spring.travel_max", str(spring["travel_max"]), "> 0 mm")
    spread = number(spring, "rate_tolerance", Spring.rate_tolerance)
    return SpringDemand(
        rate=rate,
        preload=preload,
        travel=travel,
        rate_tolerance=spread,
        fatigue_safety=number(limits, SPRING_FATIGUE.id, SPRING_FATIGUE.default),
        solid_clearance=number(limits, SPRING_SOLID.id, SPRING_SOLID.default),
        rate_spread=spread,
        preload_spread=number(spring, "preload_tolerance", Spring.preload_tolerance),
    )


def _path(name: TomlValue, folder: Path | None) -> Path:
    """Path of a catalogue by its name in the case: the shipped one, or a file in `folder`, that of
    the case; InputError for any other.
    """
    if name == SHIPPED:
        return CATALOGUE
    if not isinstance(name, str) or not name:
        raise InputError("spring.catalogue", str(name), f'a file name, or "{SHIPPED}"')
    if folder is None:
        raise InputError("spring.catalogue", name, f'"{SHIPPED}" where a case has no folder')
    return inside(folder, name, "spring.catalogue")

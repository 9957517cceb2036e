"""Consistency of the sections of a case with one another."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.lift_section import LiftSegments, motion_of
from camwright.pipeline.case.limits import OVERSPEED, TOOL_RADIUS
from camwright.pipeline.case.requirements_section import OVER_SPEED, STANDSTILL, Tolerances
from camwright.pipeline.case.value_sources import require_known
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.pickup_voltage import VoltageTable
from camwright.pipeline.engine.speed_trace import SpeedTable
from camwright.pipeline.follower.roller import Roller
from camwright.pipeline.follower.spring import Spring

if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case


_ROUND_OFF = 1e-9  # of a share of the friction
_SHARES = 1e-6  # of the sum of the duty


def check_sections(case: Case) -> None:
    """Refuse a case whose sections contradict one another.

    Raises
    ------
    InputError
        For the first contradiction, by its dotted name.
    """
    check_numbers(case)
    _check_values(case)


def check_numbers(case: Case) -> None:
    """As `check_sections`, but for the names of the values with a source or a confirmation."""
    _check_start(case)
    _check_geometry(case)
    _check_names(case)
    _check_duty(case)
    _check_film(case)
    _check_tolerances(case)
    _check_mass(case)


def _check_values(case: Case) -> None:
    """Refuse the source or confirmation of a value that the case does not state."""
    tables = case.tables()
    for value in case.sources:
        require_known(tables, "sources", value)
    for each in case.confirmed:
        require_known(tables, "confirmed.value", each.value)


def _check_start(case: Case) -> None:
    """A case starts either at the torque of an engine or at a lift."""
    if (case.engine is None) == (case.lift is None):
        count = "neither" if case.engine is None else "both"
        raise InputError("engine, lift", count, "exactly one of the two")
    if isinstance(case.lift, LiftSegments):
        motion_of(case.lift)
    elif case.valve_train is not None:
        limit = 'left out unless lift.kind = "segments"'
        raise InputError("valve_train", "a table", limit)
    if case.follower.kind == "roller":
        _ = case.roller  # refuses a case without roller
    elif case.roller_given is not None:
        raise InputError("roller", "a table", 'left out with follower.kind = "flat"')
    elif case.smoothing.kind == "constrained":
        limit = 'other than "constrained" with a flat face'
        raise InputError("smoothing.kind", "constrained", limit)
    ratio = case.mechanism.gear_ratio
    if case.engine is not None and ratio != 2.0:
        raise InputError("mechanism.gear_ratio", ratio, "2 with an engine: a cam turn is 720 deg")
    engine = case.engine
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is None:
        raise InputError(
            "crankshaft.inertia", "missing", "given, for the torque of a measured speed"
        )
    if case.engine is not None and not case.load_cases[0].speed > 0:
        raise InputError(
            "load_case[0].speed", "0 rpm", "> 0 rpm, as its torque is that of the cam design"
        )
    share, constrained = case.mechanism.compensation, case.smoothing.kind == "constrained"
    if share != 1.0 and (case.engine is None or constrained):
        limit = "1 with a lift" if case.engine is None else '1 with smoothing.kind = "constrained"'
        raise InputError("mechanism.compensation", share, limit)
    for k, load_case in enumerate(case.load_cases):
        if constrained and load_case.preload is not None:
            limit = 'left out with smoothing.kind = "constrained", which has one spring'
            raise InputError(f"load_case[{k}].preload", load_case.preload, limit)
        for name in ("torque", "torque_reduction", "speed_reduction"):
            value = getattr(load_case, name)
            if case.engine is None and value is not None:
                raise InputError(f"load_case[{k}].{name}", value, "left out with a lift")
        modelled = isinstance(case.engine, CylinderEngine) and load_case.torque is None
        if not modelled and (load_case.intake_pressure is not None or not load_case.fired):
            name = "fired" if load_case.intake_pressure is None else "intake_pressure"
            limit = 'left out unless engine.kind = "cylinder" without a torque file'
            raise InputError(f"load_case[{k}].{name}", getattr(load_case, name), limit)


def tightened_tolerances(case: Case) -> dict[str, tuple[str, str]]:
    """Tolerances tighter than their default, by dotted name: value and bound of the default."""
    stated, usual, spring = case.tolerances, Tolerances(), case.spring
    least: dict[str, tuple[float, float, str]] = {
        "tolerances.friction": (stated.friction, usual.friction, ""),
        "tolerances.mass": (stated.mass, usual.mass, ""),
        "tolerances.inertia": (stated.inertia, usual.inertia, ""),
        "tolerances.phase": (stated.phase, usual.phase, "deg"),
        "spring.rate_tolerance": (spring.rate_tolerance, Spring.rate_tolerance, ""),
        "spring.preload_tolerance": (spring.preload_tolerance, Spring.preload_tolerance, ""),
        "cam.profile_tolerance": (
            case.cam.profile_tolerance, CamBody.profile_tolerance, "mm",
        ),
    }  # fmt: skip
    tight = {
        name: (shown(value, unit), f">= {shown(bound, unit)}")
        for name, (value, bound, unit) in least.items()
        if value < bound
    }
    share = usual.friction * (1.0 - _ROUND_OFF)
    for side, guide in (("a", case.guides.a), ("b", case.guides.b)):
        low, high = guide.friction * (1.0 - share), guide.friction * (1.0 + share)
        if guide.friction_min is not None and guide.friction_min > low:
            bounds = shown(guide.friction_min, ""), f"<= {shown(low, '')}"
            tight[f"guides.{side}.friction_min"] = bounds
        if guide.friction_max is not None and guide.friction_max < high:
            bounds = shown(guide.friction_max, ""), f">= {shown(high, '')}"
            tight[f"guides.{side}.friction_max"] = bounds
    return tight


def _check_tolerances(case: Case) -> None:
    """A tolerance is tighter than its default only with a source."""
    sources = {f"guides.{side}": getattr(case.guides, side).source for side in "ab"}
    for name, (value, bound) in tightened_tolerances(case).items():
        part = name.rpartition(".")[0]
        if not (case.tolerances.source.strip() or sources.get(part, "").strip()):
            raise InputError(name, value, f"{bound} without tolerances.source")


def _check_mass(case: Case) -> None:
    """The mass of the follower contains a share of the spring's."""
    mass, share = case.follower.mass, case.spring_mass
    if not mass > share:
        limit = f"> {shown(share, 'g')}, follower.spring_share of the spring's mass"
        raise InputError("follower.mass", shown(mass, "g"), limit)


def _check_film(case: Case) -> None:
    if case.lubricant is None or case.lubricant.film == "smooth":
        return
    cards = (case.cam.material, case.facing.material)
    needed = {
        "cam.roughness": case.cam.roughness,
        f"{case.facing.table}.roughness": case.facing.roughness,
        **{f"materials.{card.name}.hardness_vickers": card.hardness_vickers for card in cards},
    }
    for field, value in needed.items():
        if value is None:
            raise InputError(field, "missing", 'given, as lubricant.film is "mixed"')


def _check_geometry(case: Case) -> None:
    if case.roller_given is not None:
        _check_roller(case.cam, case.roller_given)
    cam, surface = case.cam, case.base_circle
    _require(
        "cam.offset",
        cam.offset,
        abs(cam.offset) < cam.prime_radius,
        "smaller than cam.prime_radius",
    )
    _require(
        "cam.bore_radius",
        cam.bore_radius,
        cam.bore_radius < surface,
        f"< {surface:.6g} m, the base circle of the surface",
    )
    tool, largest = case.workshop.tool_radius, case.limits[TOOL_RADIUS]
    if tool is not None and largest is not None:
        _require("workshop.tool_radius", tool, tool <= largest, "<= limits.tool_radius")
    if cam.keyway is not None:
        reach = cam.bore_radius + cam.keyway.depth
        _require(
            "cam.keyway.depth",
            cam.keyway.depth,
            reach < surface,
            f"< {surface - cam.bore_radius:.6g} m, the ring of steel around the bore",
        )
        _require(
            "cam.keyway.width",
            cam.keyway.width,
            cam.keyway.width < 1.8 * cam.bore_radius,
            "< 1.8 bore radii",
        )
    _check_key(cam)
    for side, guide in (("a", case.guides.a), ("b", case.guides.b)):
        _require(
            f"guides.{side}.diameter",
            guide.diameter,
            guide.diameter >= case.follower.stem_diameter,
            ">= follower.stem_diameter",
        )


def _check_key(cam: CamBody) -> None:
    if cam.key is None:
        return
    if cam.keyway is None:
        raise InputError("cam.key", "a table", "given with cam.keyway")
    flanks, data = cam.key_flanks, cam.key_data
    if flanks is None:
        return
    length, depth, height = data["length"], data["shaft_depth"], data["height"]
    width = f"> {cam.keyway.width:.6g} m, the round ends of form A"
    _require("cam.key.length", length or 0.0, flanks.length > 0.0, width)
    _require("cam.key.shaft_depth", depth or 0.0, flanks.shaft_height > 0.0, "> cam.key.chamfer")
    limit = "> cam.key.shaft_depth + cam.key.chamfer"
    _require("cam.key.height", height or 0.0, flanks.hub_height > 0.0, limit)


def _check_roller(cam: CamBody, roller: Roller) -> None:
    radius, width = roller.radius, roller.width
    _require("roller.radius", radius, radius < cam.prime_radius, "< cam.prime_radius")
    _require("roller.hub_radius", roller.hub_radius, roller.hub_radius < radius, "< roller.radius")
    half = "< half of roller.width"
    _require("roller.chamfer", roller.chamfer, 2 * roller.chamfer < width, half)
    ring = roller.bearing.ring
    if ring is not None:
        # A ring is stated to a micrometre; a tyre on it may be larger.
        holds = radius >= 0.5 * ring.outer_diameter - 1e-6
        limit = f">= {0.5 * ring.outer_diameter:.6g} m, half of roller.bearing.ring.outer_diameter"
        _require("roller.radius", radius, holds, limit)
    pin = roller.pin
    if pin is not None and pin.mounting == "straddled":
        _require("roller.pin.span", pin.span, pin.span >= width, f">= {width:.6g} m, roller.width")


def _require(field: str, value: float, holds: bool, limit: str) -> None:
    if not holds:
        raise InputError(field, f"{value:.6g} m", limit)


def _check_duty(case: Case) -> None:
    """The duty is that of all load cases or of none, and its shares add to 1."""
    shares = [load_case.duty for load_case in case.load_cases]
    stated = [share for share in shares if share is not None]
    if not stated:
        return
    for k, share in enumerate(shares):
        if share is None:
            limit = "given, 0 where it takes no time, as other load cases have one"
            raise InputError(f"load_case[{k}].duty", "missing", limit)
    if not abs(sum(stated) - 1.0) <= _SHARES:
        raise InputError("load_case.duty", f"{sum(stated):.6g} in sum", "1 in sum")


def _check_names(case: Case) -> None:
    seen: set[str] = set()
    over = case.limits[OVERSPEED]
    for k, load_case in enumerate(case.load_cases):
        name, speed = load_case.name.casefold(), load_case.speed
        if name in seen:
            raise InputError(f"load_case[{k}].name", load_case.name, "unlike every other")
        seen.add(name)
        if name.startswith(STANDSTILL) and speed != 0.0:
            raise InputError(f"load_case[{k}].speed", shown(speed, "rpm"), "0 rpm at standstill")
        if over is not None and speed > over:
            limit = f"<= {shown(over, 'rpm')}, limits.overspeed"
            raise InputError(f"load_case[{k}].speed", shown(speed, "rpm"), limit)
        if name.startswith(OVER_SPEED) and speed != over:
            raise InputError(f"load_case[{k}].speed", shown(speed, "rpm"), "limits.overspeed")

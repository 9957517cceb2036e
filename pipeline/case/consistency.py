"""Consistency of the sections of a case with one another."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case_values import quantity_of, text_of
from camwright.pipeline.case.lift_section import LiftSegments, motion_of
from camwright.pipeline.case.limits import (
    OVERSPEED,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    TOOL_RADIUS,
)
from camwright.pipeline.case.requirements_section import OVER_SPEED, STANDSTILL, Tolerances
from camwright.pipeline.case.value_sources import require_known
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.pickup_voltage import VoltageTable
from camwright.pipeline.engine.speed_file import SpeedTable
from camwright.pipeline.follower.guide_friction import friction_limits
from camwright.pipeline.follower.roller import Roller
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.torque.machine_torque import require_marks
from camwright.pipeline.torque.period import ratio_text

if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case


_KEYWAY_WIDTH = 1.8  # greatest, over the bore radius
_DIGITS = (4, 8, 17)  # more where a value and its limit would read alike
_ROUND_OFF = 1e-9  # of a share of the friction, and of an angle
_POSITIONS_MIN = 36  # of the cam per cycle of the machine
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
    """A case starts either at the torque of an engine or a machine, or at a lift."""
    driven = case.engine is not None or case.torque is not None
    if driven == (case.lift is not None):
        count = "both" if driven else "neither"
        limit = "exactly one of the two; [torque] is that of another machine than an engine"
        raise InputError("engine, lift", count, limit)
    if case.torque is not None and "gear_ratio" not in case.mechanism.model_fields_set:
        cycle = shown(case.torque.cycle, "deg")
        limit = f"given with [torque]: {ratio_text(case.torque.cycle / FULL_TURN)} for one cycle"
        raise InputError("mechanism.gear_ratio", "missing", f"{limit} of {cycle} in a cam turn")
    if isinstance(case.lift, LiftSegments):
        motion_of(case.lift)
    elif case.valve_train is not None:
        limit = 'left out unless lift.kind = "segments"'
        raise InputError("valve_train", "a table", limit)
    if case.follower.kind == "roller":
        _ = case.roller  # refuses a case without roller
    elif case.roller_given is not None:
        raise InputError("roller", "a table", 'left out with follower.kind = "flat"')
    _check_period(case)
    engine = case.engine
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is None:
        raise InputError(
            "crankshaft.inertia", "missing", "given, for the torque of a measured speed"
        )
    if case.balances and not case.load_cases[0].speed > 0:
        raise InputError(
            "load_case[0].speed", "0 rpm", "> 0 rpm, as its torque is that of the cam design"
        )
    freed = {"spring_rate", "preload"} & set(case.smoothing.free)
    if freed and case.spring.shape is not None:
        limit = f'left out with spring.kind = "{case.spring.kind}"'
        raise InputError("smoothing.free", min(freed), limit)
    share, constrained = case.mechanism.compensation, case.smoothing.kind == "constrained"
    if share != 1.0 and (not case.balances or constrained):
        limit = "1 with a lift" if not case.balances else '1 with smoothing.kind = "constrained"'
        _require(case, "mechanism.compensation", False, limit)
    for k, load_case in enumerate(case.load_cases):
        if constrained and load_case.preload is not None:
            limit = 'left out with smoothing.kind = "constrained", which has one spring'
            _require(case, f"load_case[{k}].preload", False, limit)
        if case.spring.shape is not None and load_case.preload is not None:
            limit = f'left out with spring.kind = "{case.spring.kind}"'
            _require(case, f"load_case[{k}].preload", False, limit)
        for name in ("torque", "torque_reduction", "speed_reduction"):
            unused = case.balances or getattr(load_case, name) is None
            _require(case, f"load_case[{k}].{name}", unused, "left out with a lift")
        modelled = isinstance(case.engine, CylinderEngine) and load_case.torque is None
        if not modelled and (load_case.intake_pressure is not None or not load_case.fired):
            name = "fired" if load_case.intake_pressure is None else "intake_pressure"
            limit = 'left out unless engine.kind = "cylinder" without a torque file'
            _require(case, f"load_case[{k}].{name}", False, limit)


def _check_period(case: Case) -> None:
    """A cam turn holds whole cycles, which the smoothing and the positions resolve."""
    period, smoothing = case.period, case.smoothing
    cycle = shown(period.angle, "deg")
    if case.torque is not None:
        require_marks(case.torque.marks, case.torque.cycle)
    if case.balances:
        fill = period.angle / smoothing.spacing
        words = f"a cycle of {cycle} over {{smoothing.spacing}}"
        fits = smoothing.points <= fill * (1.0 + _ROUND_OFF)
        _require(case, "smoothing.points", fits, f"<= {fill:.4g}, {words}")
        fits = smoothing.kind != "moving_average" or smoothing.points < fill * (1.0 - _ROUND_OFF)
        limit = f"< {fill:.4g}, {words}: over all of it the average is zero"
        _require(case, "smoothing.points", fits, limit)
        for name in ("width", "cutoff"):
            fits = getattr(smoothing, name) <= period.angle * (1.0 + _ROUND_OFF)
            _require(case, f"smoothing.{name}", fits, f"<= {cycle}, a cycle")
    for order in smoothing.harmonic_orders:
        waves = order * period.angle / FULL_TURN
        if abs(waves - round(waves)) > _ROUND_OFF * waves:
            limit = f"a multiple of {FULL_TURN / period.angle:g}: whole waves in a cycle of {cycle}"
            raise InputError("smoothing.harmonic_orders", order, limit)
    least = _POSITIONS_MIN * period.cycles
    limit = f">= {least}, {_POSITIONS_MIN} per cycle of {cycle}"
    _require(case, "solver.positions", case.solver.positions >= least, limit)


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
        low, high = map(float, friction_limits(guide.friction, None, None, share))
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
    share = case.spring_mass
    limit = "> {}, the share {follower.spring_share} of the spring's mass"
    _require(case, "follower.mass", case.follower.mass > share, limit, share)


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
    cam, roller, face = case.cam, case.roller_given, case.follower.face
    _check_ends(case)
    if roller is not None:
        _check_roller(case, roller)
    smaller = "smaller than {cam.prime_radius}"
    _require(case, "cam.offset", abs(cam.offset) < cam.prime_radius, smaller)
    back = case.limits[RETURN_PRESSURE_ANGLE]
    steeper = back is None or back >= case.limits[PRESSURE_ANGLE]
    _require(case, "limits.return_pressure_angle", steeper, ">= {limits.pressure_angle}")
    _check_ring(case)
    tool, largest = case.workshop.tool_radius, case.limits[TOOL_RADIUS]
    if tool is not None and largest is not None:
        _require(case, "workshop.tool_radius", tool <= largest, "<= {limits.tool_radius}")
    if cam.keyway is not None:
        most = _KEYWAY_WIDTH * cam.bore_radius
        limit = f"< {{}}, {_KEYWAY_WIDTH:g} times {{cam.bore_radius}}"
        _require(case, "cam.keyway.width", cam.keyway.width < most, limit, most)
    _check_key(case)
    for side, guide in (("a", case.guides.a), ("b", case.guides.b)):
        wide = guide.diameter >= case.follower.stem_diameter
        _require(case, f"guides.{side}.diameter", wide, ">= {follower.stem_diameter}")
    least, overhang = 0.5 * case.guides.a.length, case.follower.overhang_at_max_lift
    part = "roller" if face is None else "face"
    limit = f">= {{}}, half of {{guides.a.length}}, or the {part} enters guide A"
    _require(case, "follower.overhang_at_max_lift", overhang >= least, limit, least)


def _check_ends(case: Case) -> None:
    """Each body keeps a flat between its ends, and each crown fits the contact."""
    other = case.facing
    width = "roller.width" if case.roller_given is not None else "follower.face.depth"
    for part, key in ((case.cam, "cam.width"), (other, width)):
        if part.end is not None:
            most = 0.5 * part.line_width + part.end.size
            limit = f"< {{}}, half of {{{key}}}"
            _require(case, f"{part.table}.end.size", part.line_width > 0.0, limit, most)
        crowned = case.cam.crown is not None or other.crown is not None
        if crowned and part.end is None:
            raise InputError(f"{part.table}.end", "missing", "given with a crown")
        if part.crown is not None and part.crown.kind == "iso16281" and case.roller_given is None:
            raise InputError(f"{part.table}.crown.kind", "iso16281", "that of a cam with a roller")


def _check_ring(case: Case) -> None:
    """Steel is left between the bore with its keyway and the base circle of the cam."""
    cam, roller, surface = case.cam, case.roller_given, case.base_circle
    base = "{cam.prime_radius}" + ("" if roller is None else " less {roller.radius}")
    if roller is not None and roller.radius > cam.bore_radius:
        most = cam.prime_radius - cam.bore_radius
        limit = "< {}, {cam.prime_radius} less {cam.bore_radius}"
        _require(case, "roller.radius", roller.radius < most, limit, most)
    limit = f"< {{}}, the base circle: {base}"
    _require(case, "cam.bore_radius", cam.bore_radius < surface, limit, surface)
    if cam.keyway is not None:
        wall = surface - cam.bore_radius
        limit = f"< {{}}, the wall around the bore: {base} less {{cam.bore_radius}}"
        _require(case, "cam.keyway.depth", cam.keyway.depth < wall, limit, wall)


def _check_key(case: Case) -> None:
    cam = case.cam
    if cam.key is None:
        return
    if cam.keyway is None:
        raise InputError("cam.key", "a table", "given with cam.keyway")
    flanks = cam.key_flanks
    if flanks is None:
        return
    ends = "> {cam.keyway.width}, the round ends of form A"
    _require(case, "cam.key.length", flanks.length > 0.0, ends)
    _require(case, "cam.key.shaft_depth", flanks.shaft_height > 0.0, "> {cam.key.chamfer}")
    limit = "> {cam.key.shaft_depth} plus {cam.key.chamfer}"
    _require(case, "cam.key.height", flanks.hub_height > 0.0, limit)


def _check_roller(case: Case, roller: Roller) -> None:
    radius, width = roller.radius, roller.width
    _require(case, "roller.radius", radius < case.cam.prime_radius, "< {cam.prime_radius}")
    _require(case, "roller.hub_radius", roller.hub_radius < radius, "< {roller.radius}")
    reach = 0.5 * (case.cam.line_width + roller.line_width)
    limit = "< {}, beyond which the roller runs beside the cam"
    _require(case, "roller.axial_offset", (roller.axial_offset or 0.0) < reach, limit, reach)
    ring = roller.bearing.ring
    if ring is not None:
        # A ring is stated to a micrometre; a tyre on it may be larger.
        least = 0.5 * ring.outer_diameter
        limit = ">= {}, half of {roller.bearing.ring.outer_diameter}"
        _require(case, "roller.radius", radius >= least - 1e-6, limit, least)
    pin = roller.pin
    if pin is not None and pin.mounting == "straddled":
        _require(case, "roller.pin.span", pin.span >= width, ">= {roller.width}")


def _require(case: Case, key: str, holds: bool, limit: str, bound: float | None = None) -> None:
    """Refuse the number at a key unless it holds.

    Parameters
    ----------
    limit : str     ``{KEY}``: the key and its value as written; ``{}``: the bound
    bound : float   SI
    """
    if holds:
        return
    quantity = quantity_of(key)
    unit = quantity.unit if isinstance(quantity, In) else ""
    for digits in _DIGITS:
        value = text_of(case, key, digits)
        texts = {"": shown(bound or 0.0, unit, digits)}
        for other in re.findall(r"{([^}]+)}", limit):
            texts[other] = text_of(case, other, digits)
        if value not in texts.values():
            break
    texts |= {other: f"{other} = {text}" for other, text in texts.items() if other}
    raise InputError(key, value, re.sub(r"{([^}]*)}", lambda match: texts[match[1]], limit))


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
        key = f"load_case[{k}].speed"
        at_rest = not name.startswith(STANDSTILL) or speed == 0.0
        _require(case, key, at_rest, "0 rpm at standstill")
        _require(case, key, over is None or speed <= over, "<= {limits.overspeed}")
        at_most = not name.startswith(OVER_SPEED) or speed == over
        _require(case, key, at_most, "{limits.overspeed}")

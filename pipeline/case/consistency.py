"""Consistency rules between the sections of a case."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.errors import InputError, as_one
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case_values import text_of, unit_at, value_of, wound_spring
from camwright.pipeline.case.lift_section import LiftSegments, motion_of
from camwright.pipeline.case.limits import SPEED_REDUCTION, TORQUE_REDUCTION
from camwright.pipeline.case.requirements_section import OVER_SPEED, STANDSTILL, Tolerances
from camwright.pipeline.case.value_sources import require_known
from camwright.pipeline.contact.cam_body import (
    SECOND_BEARING,
    TWO_TRACKS,
    CamBody,
    CamConjugate,
    GrooveRoller,
)
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.pickup_voltage import VoltageTable
from camwright.pipeline.engine.speed_file import SpeedTable
from camwright.pipeline.follower.bearing_life import rating_bound, static_rating_bound
from camwright.pipeline.follower.follower_kind import FollowerKind
from camwright.pipeline.follower.guide_friction import friction_limits
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.torque.machine_torque import require_marks
from camwright.pipeline.torque.period import ratio_text

if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case


_NAMED = re.compile(r"{([^}]+)}")  # keys in the words of a limit
_KEYWAY_WIDTH = 1.8  # greatest, over the bore radius
_MESSAGE_DIGITS = (4, 8, 17)  # more where a value and its limit would read alike
_DECIMALS = 12  # of a difference of lengths, m
_RULE_ROUND_OFF = 1e-9  # of a share of the friction, and of an angle
_POSITIONS_MIN = 36  # of the cam per cycle of the machine
_DUTY_TOLERANCE = 1e-6  # of the sum of the duty
_OUTSIDE, _WIDE = 4.0, 2.0  # of a rolling bearing over its bore, more than dimension series 4


At = Callable[[str], Any]
"""Value of a key, SI, or array (m,) of those of many designs; NaN where the case leaves it out."""


class Rule(NamedTuple):
    """Inequality between numbers of a case, for one case or arrays of designs.

    key : str           that is refused
    breaks : callable   whether the relation is broken, bool or array (m,); NaN breaks none
    limit : str         ``{KEY}``: the key and its value as written; ``{}``: the bound
    bound : callable    of the value at the key, SI
    """

    key: str
    breaks: Callable[[At], Any]
    limit: str
    bound: Callable[[At], Any] | None = None


def check_sections(case: Case) -> None:
    """Refuse a case whose sections contradict one another.

    Raises
    ------
    InputError
        For all contradictions of numbers, else for the first other one, by its dotted name.
    """
    check_numbers(case)
    _check_values(case)


def check_numbers(case: Case) -> None:
    """Refuse numbers of a case that contradict one another, as `check_sections`, without the check
    that sources name existing values.

    A relation of a number that an earlier one refuses, or names, is not tried: it may be right.
    """
    at = _values(case)
    refused: list[InputError] = []
    doubtful: set[str] = set()
    try:
        for rule in rules(case):
            keys = {rule.key, *_NAMED.findall(rule.limit)}
            if not keys & doubtful and rule.breaks(at):
                refused.append(_refusal(case, rule, at))
                doubtful |= keys
    except InputError as error:
        refused += [] if error.field in doubtful else [error]
    if refused:
        raise as_one(tuple(refused))


def _values(case: Case) -> At:
    """Function from dotted key to number, SI, NaN where the case omits it; each is looked up
    once.
    """

    @cache
    def at(key: str) -> float:
        value = value_of(case, key)
        return nan if value is None else float(value)

    return at


def rules(case: Case) -> Iterator[Rule]:
    """Inequalities between the numbers of a case, in the order of their refusals.

    They depend on its structure alone: those of many designs are those of the case that they share.

    Raises
    ------
    InputError
        For a contradiction that is none of numbers, in its place of the order.
    """
    yield from _start(case)
    yield from _geometry(case)
    yield from _load_cases(case)
    _check_duty(case)
    _check_film(case)
    yield from _tolerances(case)
    share = case.follower.spring_share
    limit = "> {}, the share {follower.spring_share} of the spring's mass"
    yield _more("follower.mass", lambda at: share * _spring_mass(case, at), limit)


def _less(key: str, bound: Callable[[At], Any], limit: str) -> Rule:
    return Rule(key, lambda at: at(key) >= bound(at), limit, bound)


def _at_most(key: str, bound: Callable[[At], Any], limit: str) -> Rule:
    return Rule(key, lambda at: at(key) > bound(at), limit, bound)


def _more(key: str, bound: Callable[[At], Any], limit: str) -> Rule:
    return Rule(key, lambda at: at(key) <= bound(at), limit, bound)


def _at_least(key: str, bound: Callable[[At], Any], limit: str) -> Rule:
    return Rule(key, lambda at: at(key) < bound(at), limit, bound)


def _equal(key: str, bound: Callable[[At], Any], limit: str) -> Rule:
    return Rule(key, lambda at: at(key) != bound(at), limit, bound)  # broken by a missing bound


def _left_out(key: str, limit: str) -> Rule:
    return Rule(key, lambda at: at(key) == at(key), limit)  # not NaN


def _fixed(value: Any) -> Callable[[At], Any]:
    return lambda _: value


def _or_zero(value: Any) -> Any:
    """A value, or an array (m,), with 0 in place of NaN."""
    return np.nan_to_num(value)


def _spring_mass(case: Case, at: At) -> Any:
    """Mass of the spring as wound that moves as the follower, kg; 0 without a spring design."""
    wound = wound_spring(case, at)
    return 0.0 if wound is None else wound.mass * case.spring.lever_at_rest**2


def _check_values(case: Case) -> None:
    """Refuse the source or confirmation of a value that the case does not state."""
    tables = case.tables()
    for value in case.sources:
        require_known(tables, "sources", value)
    for each in case.confirmed:
        require_known(tables, "confirmed.value", each.value)


def _start(case: Case) -> Iterator[Rule]:
    """Rules of the start of a case, either at the torque of an engine or a machine, or at a lift,
    and of what belongs to each.
    """
    driven = case.engine is not None or case.torque is not None
    if driven == (case.lift is not None):
        count = "both" if driven else "neither"
        limit = "exactly one of the two; [torque] is that of another machine than an engine"
        raise InputError("engine, lift", count, limit)
    if case.torque is not None and "gear_ratio" not in case.mechanism.model_fields_set:
        cycle = shown(case.torque.cycle, "deg")
        limit = f"given with [torque]: {ratio_text(case.torque.cycle / FULL_TURN)} for one cycle"
        raise InputError("mechanism.gear_ratio", "missing", f"{limit} of {cycle} in a cam turn")
    _closure(case)
    key = case.spring.preload_key
    if key and (not case.cam.pulls or case.spring.design is not None):
        limit = '> {}, or cam.closure = "groove", "conjugate" or "yoke" without spring.design'
        yield _more(key, _fixed(0.0), limit)
    if case.valve_train is not None and case.follower.arm is not None:
        raise InputError("valve_train", "a table", "left out with an arm")
    if case.rocker_linkage is not None and case.rocker is not None and case.rocker.lift == "output":
        if case.lift is None:
            raise InputError("rocker.lift", "output", "follower without [lift]")
        if case.valve_train is not None:
            raise InputError("valve_train", "a table", 'left out with rocker.lift = "output"')
    if isinstance(case.lift, LiftSegments):
        motion_of(case.lift)
    elif case.valve_train is not None:
        limit = 'left out unless lift.kind = "segments"'
        raise InputError("valve_train", "a table", limit)
    if case.follower.face is None:
        _ = case.roller  # refuses a case without roller
    elif case.roller_given is not None:
        raise InputError("roller", "a table", "left out with follower.face")
    yield from _period(case)
    engine = case.engine
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is None:
        raise InputError(
            "crankshaft.inertia", "missing", "given, for the torque of a measured speed"
        )
    if case.balances:
        limit = "> 0 rpm, as its torque is that of the cam design"
        yield _more("load_case[0].speed", _fixed(0.0), limit)
    freed = case.smoothing.of_spring
    if freed and case.spring.shape is not None:
        limit = f'left out with spring.kind = "{case.spring.kind}"'
        raise InputError("smoothing.free", min(freed), limit)
    constrained = case.smoothing.kind == "constrained"
    if not case.balances or constrained:
        limit = "1 with a lift" if not case.balances else '1 with smoothing.kind = "constrained"'
        yield _equal("mechanism.compensation", _fixed(1.0), limit)
    for k, load_case in enumerate(case.load_cases):
        if constrained:
            limit = 'left out with smoothing.kind = "constrained", which has one spring'
            yield _left_out(f"load_case[{k}].preload", limit)
        if case.spring.shape is not None:
            limit = f'left out with spring.kind = "{case.spring.kind}"'
            yield _left_out(f"load_case[{k}].preload", limit)
        for name in ("torque", TORQUE_REDUCTION.id, SPEED_REDUCTION.id):
            if not case.balances and getattr(load_case, name) is not None:
                yield Rule(f"load_case[{k}].{name}", _fixed(True), "left out with a lift")
        modelled = isinstance(case.engine, CylinderEngine) and load_case.torque is None
        if not modelled and (load_case.intake_pressure is not None or not load_case.fired):
            name = "fired" if load_case.intake_pressure is None else "intake_pressure"
            limit = 'left out unless engine.kind = "cylinder" without a torque file'
            yield Rule(f"load_case[{k}].{name}", _fixed(True), limit)


_LEAST_WEIGHT = 1e-6  # m/s2, above the round-off of a stem that lies level


def _closure(case: Case) -> None:
    """Refuse what a case whose cam pulls its follower states and cannot have, and what it lacks:
    such a cam guides rollers by a stated lift.

    Raises
    ------
    InputError
        If something is stated that such a cam does not have, or that is not done for one.
    """
    cam = case.cam
    for name in TWO_TRACKS:
        if getattr(cam, name) is not None and cam.closure != name:
            raise InputError(f"cam.{name}", "a table", f'left out, or cam.closure = "{name}"')
    if cam.closure == "gravity":
        _weight(case)
    if not cam.pulls:
        return
    stated_as = f'cam.closure = "{cam.closure}"'
    if getattr(cam, cam.closure) is None:
        raise InputError(f"cam.{cam.closure}", "missing", f"given with {stated_as}")
    if cam.conjugate is not None:
        _conjugate(case, cam.conjugate)
    elif cam.yoke is not None:
        if case.follower.kind != "flat":
            limit = f'"flat" with {stated_as}, which is done for a stem alone'
            raise InputError("follower.kind", case.follower.kind, limit)
    elif case.roller_given is None or case.rocker is not None:
        limit = f'"roller", or "oscillating" with a roller, with {stated_as}'
        raise InputError("follower.kind", case.follower.kind, limit)
    if case.lift is None:
        _stores(case, stated_as)
    for key, stated in (("cam.counter_hole", cam.counter_hole), ("valve_train", case.valve_train)):
        if stated is not None:
            raise InputError(key, "a table", f"left out with {stated_as}")
    if case.roller_given is None:
        return
    pin = case.roller.pin
    if cam.groove is not None and pin is not None and not pin.overhung:
        limit = f'"overhung" with {stated_as}: a cheek on both sides cannot enter it'
        raise InputError("roller.pin.mounting", pin.mounting, limit)
    for table, bearing in case.bearings.items():
        if case.spring.absent and bearing.ring is not None and bearing.C0 is None:
            limit = "given with a ring and without a spring"
            raise InputError(f"{table}.C0", "missing", limit)
        for name in ("drag_torque", "friction") if table == SECOND_BEARING else ():
            if getattr(bearing, name) is not None:
                limit = f"left out: the drag of both rollers is that of {Bearing.table}"
                raise InputError(f"{table}.{name}", "stated", limit)


def _stores(case: Case, stated_as: str) -> None:
    """Check a cam that pulls whose lift is drawn from a torque: a spring stores its work.

    Raises
    ------
    InputError
        If the spring is missing, or the lift is that of a constrained synthesis by a spring that
        pulls, which is not done, or of a spring which pulls by a force that is not linear in the
        lift.
    """
    if case.spring.absent:
        limit = f"given with {stated_as} and without [lift]: it stores the work of the torque"
        raise InputError("spring", "missing", limit)
    shape, key = case.spring.shape, case.spring.preload_key
    if shape is not None and not (shape.linear or case.spring.preload > 0.0):
        limit = "> 0 without [lift]: the lift of a spring that pulls needs a force linear in it"
        raise InputError(key, text_of(case, key), limit)
    if case.smoothing.kind == "constrained" and not case.spring.preload > 0.0:
        limit = f"a filter with {stated_as} and {key} <= 0 N"
        raise InputError("smoothing.kind", "constrained", limit)


def _weight(case: Case) -> None:
    """Check a cam on which the weight alone presses the follower: no spring, a stated lift, and a
    weight towards the cam.

    Raises
    ------
    InputError
        If one of these does not hold.
    """
    bears = 'cam.closure = "gravity"'
    if not case.spring.absent:
        raise InputError("spring", "a table", f"left out with {bears}")
    if case.lift is None:
        limit = f"given with {bears}: its synthesis from a torque is not done"
        raise InputError("lift", "missing", limit)
    if case.follower.arm is None and not case.follower.gravity_along_axis > _LEAST_WEIGHT:
        limit = f"< 90 deg with {bears}: the weight presses the follower on the cam"
        raise InputError("follower.gravity_angle", text_of(case, "follower.gravity_angle"), limit)
    pivot = case.follower.pivot
    if case.follower.arm is not None and (pivot is None or pivot.gravity_angle is None):
        raise InputError("follower.pivot.gravity_angle", "missing", f"given with {bears}")


def _conjugate(case: Case, second: CamConjugate) -> None:
    """Check the second roller of a conjugate pair of discs: it is on the stem at a distance, or on
    a second arm of a length and an angle.

    Raises
    ------
    InputError
        If the follower has no roller or moves a rocker, or the second roller lacks its place or
        states one of the other kind of follower.
    """
    pair, arm = 'cam.closure = "conjugate"', case.follower.arm is not None
    kind = 'follower.kind = "oscillating"' if arm else "a stem"
    if case.roller_given is None or case.rocker is not None:
        limit = f'"roller", or "oscillating" with a roller, with {pair}'
        raise InputError("follower.kind", case.follower.kind, limit)
    if (second.clearance is None) == (second.interference is None):
        beside = "missing" if second.clearance is None else "stated beside an interference"
        limit = "given" if second.clearance is None else "left out"
        limit += ", or cam.conjugate.interference in its place"
        raise InputError("cam.conjugate.clearance", beside, limit)
    of_stem, of_arm = ("distance",), ("arm_length", "arm_angle")
    for key in of_stem if arm else of_arm:
        if getattr(second, key) is not None:
            others = ", ".join(of_arm if arm else of_stem)
            limit = f"left out with {kind}, which has {others} in its place"
            raise InputError(f"cam.conjugate.{key}", text_of(case, f"cam.conjugate.{key}"), limit)
    for key in of_arm if arm else of_stem:
        if getattr(second, key) is None:
            raise InputError(f"cam.conjugate.{key}", "missing", f"given with {pair} and {kind}")


def _discs() -> Iterator[Rule]:
    """Both discs of a conjugate pair are beside one another."""
    yield _at_least("cam.conjugate.spacing", lambda at: at("cam.width"), ">= {cam.width}")


def _groove(second: GrooveRoller | None) -> Iterator[Rule]:
    """Rules of a groove: its floor and outer wall are within the disc, and each roller runs within
    its step above the fillet.
    """
    depth, fillet = "cam.groove.depth", "cam.groove.corner_radius"
    yield _less(depth, lambda at: at("cam.width"), "< {cam.width}: a floor is left")
    if second is not None:
        yield from _steps(second)
        return
    limit = ">= {roller.width}: the roller is within the groove"
    yield _at_least(depth, lambda at: at("roller.width"), limit)
    limit = "<= {}, {cam.groove.depth} less {roller.width}: the roller runs above the fillet"
    room = lambda at: np.round(at(depth) - at("roller.width"), _DECIMALS)  # noqa: E731
    yield _at_most(fillet, room, limit)
    limit = "> {}, {cam.prime_radius} plus {roller.radius}"
    key = "cam.groove.outer_radius"
    yield _more(key, lambda at: at("cam.prime_radius") + at("roller.radius"), limit)
    key, limit = "workshop.tool_radius", "<= {}, {roller.radius} plus half of the clearance"
    half = lambda at: at("roller.radius") + 0.5 * at("cam.groove.clearance")  # noqa: E731
    yield _at_most(key, half, limit)


def _steps(second: GrooveRoller) -> Iterator[Rule]:
    """Rules of a groove of two steps: each roller is around its bearing and runs in its own step,
    above the fillet and clear of the wall that is not its own.
    """
    depth, fillet, wide = "cam.groove.depth", "cam.groove.corner_radius", "roller.width"
    radius, spacing, upper, relief = (
        f"{GrooveRoller.table}.{key}" for key in ("radius", "spacing", "step_depth", "relief")
    )

    def less(*keys: str) -> Callable[[At], Any]:
        """The first number less the others."""
        return lambda at: np.round(at(keys[0]) - sum(at(key) for key in keys[1:]), _DECIMALS)

    yield _more(radius, lambda at: at("roller.hub_radius"), "> {roller.hub_radius}")
    yield _less(radius, lambda at: at("cam.prime_radius"), "< {cam.prime_radius}")
    if second.bearing is None:
        ring, thick = (f"roller.bearing.ring.{each}" for each in ("outer_diameter", "thickness"))
        limit = f"> {{}}, half of {{{ring}}} less {{{thick}}}: it runs on balls as the first"
        balls = lambda at: np.round(0.5 * at(ring) - at(thick), _DECIMALS)  # noqa: E731
        yield _more(radius, balls, limit)
    yield _around(SECOND_BEARING, radius)
    yield from _rated(SECOND_BEARING, radius)
    above, within = "the roller runs above the fillet", "each roller is in its step"
    limit = f">= {{}}, twice {{{wide}}}: a step for each roller"
    yield _at_least(depth, lambda at: np.round(2.0 * at(wide), _DECIMALS), limit)
    yield _at_least(upper, lambda at: at(wide), f">= {{{wide}}}: {within}")
    yield _at_most(upper, less(depth, wide), f"<= {{}}, {{{depth}}} less {{{wide}}}: {within}")
    yield _at_most(fillet, less(upper, wide), f"<= {{}}, {{{upper}}} less {{{wide}}}: {above}")
    limit = f"<= {{}}, {{{depth}}} less {{{upper}}} and {{{wide}}}: {above}"
    yield _at_most(fillet, less(depth, upper, wide), limit)
    limit = f">= {{}}, {{{wide}}} plus {{{fillet}}}: {within}"
    yield _at_least(spacing, lambda at: np.round(at(wide) + at(fillet), _DECIMALS), limit)
    limit = f"<= {{}}, {{{depth}}} less {{{wide}}} and {{{fillet}}}: {within}"
    yield _at_most(spacing, less(depth, wide, fillet), limit)
    limit = "> {cam.groove.clearance}: each roller is clear of the wall of the other"
    yield _more(relief, lambda at: at("cam.groove.clearance"), limit)
    first, under = "roller.radius", f"{GrooveRoller.table}.undercut"

    def room(at: At) -> Any:
        apart = abs(at(radius) - at(first)) + 0.5 * at("cam.groove.clearance")
        return np.round(apart + at(under), _DECIMALS)

    limit = (
        f"<= {{}}, the difference of {{{radius}}} and {{{first}}} plus half of the clearance and"
        f" {{{under}}}: beyond it the lower step is under the upper one"
    )
    yield _at_most(relief, room, limit)
    rim, prime = "cam.groove.outer_radius", "cam.prime_radius"
    yield _more(rim, lambda at: at(prime) + at(radius), f"> {{}}, {{{prime}}} plus {{{radius}}}")
    limit = f"> {{}}, {{{prime}}} plus {{roller.radius}} and {{{relief}}}"
    yield _more(rim, lambda at: at(prime) + at("roller.radius") + at(relief), limit)
    for size in ("roller.radius", radius):

        def half(at: At, size: str = size) -> Any:
            return at(size) + 0.5 * at(relief) + 0.25 * at("cam.groove.clearance")

        limit = f"<= {{}}, half of the width of the step around {{{size}}}"
        yield _at_most("workshop.tool_radius", half, limit)


def _period(case: Case) -> Iterator[Rule]:
    """Rules that a cam turn holds whole cycles, which smoothing and positions resolve."""
    period, smoothing = case.period, case.smoothing
    cycle = shown(period.angle, "deg")

    def fill(at: At) -> Any:
        return period.angle / at("smoothing.spacing")

    if case.torque is not None:
        require_marks(case.torque.marks, case.torque.cycle)
    if case.balances:
        words = f"a cycle of {cycle} over {{smoothing.spacing}}"
        key = "smoothing.points"
        over = lambda at: at(key) > fill(at) * (1.0 + _RULE_ROUND_OFF)  # noqa: E731
        yield Rule(key, over, f"<= {{}}, {words}", fill)
        if smoothing.kind == "moving_average":
            limit = f"< {{}}, {words}: over all of it the average is zero"
            whole = lambda at: at(key) >= fill(at) * (1.0 - _RULE_ROUND_OFF)  # noqa: E731
            yield Rule(key, whole, limit, fill)
        for name in ("width", "cutoff"):
            most = period.angle * (1.0 + _RULE_ROUND_OFF)
            yield _at_most(f"smoothing.{name}", _fixed(most), f"<= {cycle}, a cycle")
    for order in smoothing.harmonic_orders:
        waves = order * period.angle / FULL_TURN
        if abs(waves - round(waves)) > _RULE_ROUND_OFF * waves:
            limit = f"a multiple of {FULL_TURN / period.angle:g}: whole waves in a cycle of {cycle}"
            raise InputError("smoothing.harmonic_orders", order, limit)
    least = _POSITIONS_MIN * period.cycles
    limit = f">= {least}, {_POSITIONS_MIN} per cycle of {cycle}"
    yield _at_least("solver.positions", _fixed(least), limit)


def _no_tighter() -> Iterator[Rule]:
    """Rules that tolerances are not tighter than their defaults, and that the stated limits of a
    guide's friction enclose the nominal one with the default tolerance.
    """
    usual = Tolerances()
    least = {
        "tolerances.friction": usual.friction,
        "tolerances.mass": usual.mass,
        "tolerances.inertia": usual.inertia,
        "tolerances.phase": usual.phase,
        "spring.rate_tolerance": Spring.rate_tolerance,
        "spring.preload_tolerance": Spring.preload_tolerance,
        "cam.profile_tolerance": CamBody.profile_tolerance,
    }
    for key, bound in least.items():
        yield _at_least(key, _fixed(bound), ">= {}")
    share = usual.friction * (1.0 - _RULE_ROUND_OFF)

    def band(side: str, end: int) -> Callable[[At], Any]:
        return lambda at: friction_limits(at(f"guides.{side}.friction"), None, None, share)[end]

    for side in "ab":
        yield _at_most(f"guides.{side}.friction_min", band(side, 0), "<= {}")
        yield _at_least(f"guides.{side}.friction_max", band(side, 1), ">= {}")


def tightened_tolerances(case: Case) -> dict[str, tuple[str, str]]:
    """Tolerances below their default by dotted name: value and default bound."""
    at = _values(case)
    return {
        rule.key: (text_of(case, rule.key), rule.limit.format(_bound_text(rule, at, 4)))
        for rule in _no_tighter()
        if rule.breaks(at)
    }


def _tolerances(case: Case) -> Iterator[Rule]:
    """Rules that tolerances are no tighter than their defaults, of those whose tolerances or guide
    state no source.
    """
    if case.tolerances.source:
        return
    for rule in _no_tighter():
        part = rule.key.rpartition(".")[0]
        guide = value_of(case, part) if part.startswith("guides.") else None
        if guide is None or not guide.source:
            yield rule._replace(limit=f"{rule.limit} without tolerances.source")


def _check_film(case: Case) -> None:
    """Refuse, by InputError, a mixed oil film without roughness and hardness of both bodies."""
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


def _geometry(case: Case) -> Iterator[Rule]:
    """Rules of the dimensions of cam, follower, camshaft and guides."""
    yield from _ends(case)
    if case.roller_given is not None:
        yield from _roller(case)
    yield Rule(
        "cam.offset",
        lambda at: abs(at("cam.offset")) >= at("cam.prime_radius"),
        "smaller than {cam.prime_radius}",
    )
    if case.follower.arm is not None:
        yield from _arm(case)
    if case.cam.groove is not None:
        yield from _groove(case.cam.groove.second)
    if case.cam.conjugate is not None:
        yield from _discs()
    key = "limits.return_pressure_angle"
    yield _at_least(key, lambda at: at("limits.pressure_angle"), ">= {limits.pressure_angle}")
    yield from _ring(case)
    key = "workshop.tool_radius"
    yield _at_most(key, lambda at: at("limits.tool_radius"), "<= {limits.tool_radius}")
    if case.cam.keyway is not None:
        limit = f"< {{}}, {_KEYWAY_WIDTH:g} times {{cam.bore_radius}}"
        yield _less("cam.keyway.width", lambda at: _KEYWAY_WIDTH * at("cam.bore_radius"), limit)
    yield from _key(case)
    _fit(case)
    yield from _camshaft(case)
    for side in "ab":
        limit = ">= {follower.stem_diameter}"
        yield _at_least(f"guides.{side}.diameter", lambda at: at("follower.stem_diameter"), limit)
    limit = f">= {{}}, half of {{guides.a.length}}, or the {case.facing.word} enters guide A"
    key = "follower.overhang_at_max_lift"
    yield _at_least(key, _half("guides.a.length"), limit)


def _fit(case: Case) -> None:
    """Refuse a fit with temperatures whose materials lack their thermal expansion.

    Raises
    ------
    InputError
        If one is missing.
    """
    fit, shaft = case.cam.fit, case.camshaft
    if fit is None or shaft is None:
        return
    for part, card in (("cam", case.cam.material), ("camshaft", shaft.material)):
        if fit.heated and card is not None and card.expansion is None:
            limit = "given with the temperatures of cam.fit"
            raise InputError(f"materials.{card.name}.expansion", f"missing for the {part}", limit)


def _camshaft(case: Case) -> Iterator[Rule]:
    """Rules of the camshaft: the machine shaft is within its pinion, and no bearing has a greater
    rating than rolling bearings of its size.
    """
    shaft = case.camshaft
    if shaft is None:
        return
    if shaft.gear is not None:
        teeth, pinion = "camshaft.gear.teeth", "camshaft.gear.pinion_teeth"

        def pitch(at: At) -> Any:
            return 2.0 * at("camshaft.gear_radius") * at(pinion) / at(teeth)

        limit = "< {}, the pitch diameter of its pinion"
        yield _less("camshaft.gear.machine_shaft_diameter", pitch, limit)
    # outside and width of any ball bearing on the widest section
    widest = shaft.widest or nan
    outside, wide = _OUTSIDE * widest, _WIDE * widest
    limit = "<= {}, the greatest of rolling bearings on a shaft of {camshaft.diameter}, ISO 281"
    for key, bound in (
        ("camshaft.bearing_rating", rating_bound(outside, wide)),
        ("camshaft.bearing_static_rating", static_rating_bound(outside, wide)),
    ):
        yield _at_most(key, _fixed(bound), limit)


def _half(key: str) -> Callable[[At], Any]:
    return lambda at: 0.5 * at(key)


def _flat(body: CamBody | FollowerKind, at: At) -> Any:
    """Width of a body without its ends, m."""
    return at(body.width_key) - 2.0 * _or_zero(at(f"{body.table}.end.size"))


def _ends(case: Case) -> Iterator[Rule]:
    """Rules that each body keeps a flat between its ends; InputError where a crown lacks the ends
    or does not fit the contact.
    """
    for part in (case.cam, case.facing):
        if part.end is not None:
            limit = f"< {{}}, half of {{{part.width_key}}}"
            yield _less(f"{part.table}.end.size", _half(part.width_key), limit)
        crowned = case.cam.crown is not None or case.facing.crown is not None
        of_roller = part.crown is not None and part.crown.kind == "iso16281"
        if crowned and part.end is None:
            raise InputError(f"{part.table}.end", "missing", "given with a crown")
        if of_roller and case.facing.contact_radius is None:
            raise InputError(f"{part.table}.crown.kind", "iso16281", "that of a cam with a roller")


def _ring(case: Case) -> Iterator[Rule]:
    """Rules that metal is left between the bore with its keyway and the base circle of the cam."""
    roller = case.roller_given is not None
    base = "{cam.prime_radius}" + (" less {roller.radius}" if roller else "")

    def surface(at: At) -> Any:
        return at("cam.prime_radius") - (at("roller.radius") if roller else 0.0)

    def most(at: At) -> Any:
        return at("cam.prime_radius") - at("cam.bore_radius")

    if roller:  # the greater of the two is at fault
        limit = "< {}, {cam.prime_radius} less {cam.bore_radius}"
        large = _less("roller.radius", most, limit)
        yield large._replace(
            breaks=lambda at: large.breaks(at) & (at("roller.radius") > at("cam.bore_radius"))
        )
    yield _less("cam.bore_radius", surface, f"< {{}}, the base circle: {base}")
    if case.cam.keyway is not None:
        limit = f"< {{}}, the wall around the bore: {base} less {{cam.bore_radius}}"
        yield _less("cam.keyway.depth", lambda at: surface(at) - at("cam.bore_radius"), limit)


def _arm(case: Case) -> Iterator[Rule]:
    """Rules of an arm: its roller reaches the prime circle, or its face the base circle and is not
    sunk into its carrier; the follower has no offset.
    """
    distance, length = "follower.arm.centre_distance", "follower.arm.length"
    yield _equal("cam.offset", _fixed(0.0), "0 mm with an arm")
    face, plane = case.follower.face, "follower.face.offset"
    if face is not None and face.radius is None:
        limit = f"< {{}}, {{{distance}}} less {{{plane}}}"
        yield _less("cam.prime_radius", lambda at: at(distance) - at(plane), limit)
        return
    if face is not None:
        radius = "follower.face.radius"
        yield _less(radius, lambda at: at("cam.prime_radius"), "< {cam.prime_radius}")
        limit = "<= {}, twice {follower.face.radius}"
        yield _at_most("follower.face.width", lambda at: 2.0 * at(radius), limit)

        def sunk(at: At) -> Any:
            square = at(radius) ** 2 - 0.25 * at("follower.face.width") ** 2
            return at(radius) - np.sqrt(np.maximum(square, 0.0))

        limit = "> {}, the depth of the curved {follower.face.width}"
        yield _more("follower.face.thickness", sunk, limit)
    between = f"{{}}, {{{distance}}} and {{{length}}}"
    yield _more("cam.prime_radius", lambda at: abs(at(distance) - at(length)), f"> {between} apart")
    yield _less("cam.prime_radius", lambda at: at(distance) + at(length), f"< {between} together")


def _key(case: Case) -> Iterator[Rule]:
    """Rules that flanks of the key are left in shaft and hub; judged on the case alone, as no
    search varies its dimensions.
    """
    cam = case.cam
    if cam.key is None:
        return
    if cam.keyway is None:
        raise InputError("cam.key", "a table", "given with cam.keyway")
    flanks = cam.key_flanks
    if flanks is None:
        return
    for name, length, limit in (
        ("length", flanks.length, "> {cam.keyway.width}, the round ends of form A"),
        ("shaft_depth", flanks.shaft_height, "> {cam.key.chamfer}"),
        ("height", flanks.hub_height, "> {cam.key.shaft_depth} plus {cam.key.chamfer}"),
    ):
        yield Rule(f"cam.key.{name}", _fixed(not length > 0.0), limit)


def _roller(case: Case) -> Iterator[Rule]:
    """Rules of the roller: within the prime circle, around its hub and bearing, beside the cam no
    more than it may.
    """
    yield _less("roller.radius", lambda at: at("cam.prime_radius"), "< {cam.prime_radius}")
    yield _less("roller.hub_radius", lambda at: at("roller.radius"), "< {roller.radius}")
    limit = "< {}, beyond which the roller runs beside the cam"
    cam, roller = case.cam, case.roller
    yield _less("roller.axial_offset", lambda at: 0.5 * (_flat(cam, at) + _flat(roller, at)), limit)
    yield _around(Bearing.table, "roller.radius")
    yield from _rated(Bearing.table, "roller.radius")
    pin = case.roller.pin
    if pin is not None and pin.mounting == "straddled":
        yield _at_least("roller.pin.span", lambda at: at("roller.width"), ">= {roller.width}")


def _around(table: str, radius: str) -> Rule:
    """Rule that a roller is around the outer ring of its bearing; keys as in `_rated`.

    A ring is stated to a micrometre; a tyre on it may be larger.
    """
    ring = f"{table}.ring.outer_diameter"
    limit = f">= {{}}, half of {{{ring}}}"
    return Rule(radius, lambda at: at(radius) < 0.5 * at(ring) - 1e-6, limit, _half(ring))


def _rated(table: str, radius: str) -> Iterator[Rule]:
    """Rules that no bearing has greater ratings than rolling bearings of its size.

    table : of the ratings; radius : dotted key of the radius of its roller
    """
    limit = f"<= {{}}, the greatest of rolling bearings within {{{radius}}} and {{roller.width}}"

    def dynamic(at: At) -> Any:
        return rating_bound(2.0 * at(radius), at("roller.width"))

    def static(at: At) -> Any:
        return static_rating_bound(2.0 * at(radius), at("roller.width"))

    for name, bound in (
        ("C", dynamic), ("C0", static), ("radial_limit", static), ("static_radial_limit", static),
    ):  # fmt: skip
        yield _at_most(f"{table}.{name}", bound, limit)


def _refusal(case: Case, rule: Rule, at: At) -> InputError:
    """InputError for the number at the key of a broken rule, with value and limit as text; with
    more digits where both read alike.

    Parameters
    ----------
    case : Case   with the number
    rule : Rule   that it breaks
    at : At       dotted key -> number, SI
    """
    for digits in _MESSAGE_DIGITS:
        value = text_of(case, rule.key, digits)
        texts = {"": _bound_text(rule, at, digits)}
        for other in _NAMED.findall(rule.limit):
            texts[other] = text_of(case, other, digits)
        if value not in texts.values():
            break
    texts |= {other: f"{other} = {text}" for other, text in texts.items() if other}
    limit = re.sub(r"{([^}]*)}", lambda match: texts[match[1]], rule.limit)
    return InputError(rule.key, value, limit)


def _bound_text(rule: Rule, at: At, digits: int) -> str:
    """Bound of a rule in the unit of its key."""
    return shown(0.0 if rule.bound is None else float(rule.bound(at)), unit_at(rule.key), digits)


def _check_duty(case: Case) -> None:
    """Refuse a duty that only some load cases have, or whose shares do not add to 1."""
    shares = [load_case.duty for load_case in case.load_cases]
    stated = [share for share in shares if share is not None]
    if not stated:
        return
    for k, share in enumerate(shares):
        if share is None:
            limit = "given, 0 where it takes no time, as other load cases have one"
            raise InputError(f"load_case[{k}].duty", "missing", limit)
    if not abs(sum(stated) - 1.0) <= _DUTY_TOLERANCE:
        raise InputError("load_case.duty", f"{sum(stated):.6g} in sum", "1 in sum")


def _load_cases(case: Case) -> Iterator[Rule]:
    """Rules of the load cases: names differ, speeds are those of their names, and none is above the
    over-speed.
    """
    seen: set[str] = set()
    for k, load_case in enumerate(case.load_cases):
        name = load_case.name.casefold()
        if name in seen:
            raise InputError(f"load_case[{k}].name", load_case.name, "unlike every other")
        seen.add(name)
        key = f"load_case[{k}].speed"
        if name.startswith(STANDSTILL):
            yield _at_most(key, _fixed(0.0), "0 rpm at standstill")
        yield _at_most(key, lambda at: at("limits.overspeed"), "<= {limits.overspeed}")
        if name.startswith(OVER_SPEED):
            yield _equal(key, lambda at: at("limits.overspeed"), "{limits.overspeed}")

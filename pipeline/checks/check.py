"""Declarations of checks, and checks: demand against limit, with method and source."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from types import MappingProxyType
from typing import Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.base.verdict import (
    Sense,
    Status,
    blocks,
    evaluated,
    is_bound,
    not_proven,
    status,
    upper_utilisation,
    utilisation,
    worst,
)
from camwright.pipeline.case.limits import TORQUE_REDUCTION, AnyLimit
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.case.scope_section import PartName, ScopeName
from camwright.pipeline.checks.extremes import Extreme, Measure, Reduce, worst_measure
from camwright.pipeline.contact.cam_body import TWO_TRACKS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.forms import Depth

Error = Literal["sampling", "contact", "ends", "guides", "guide_edges", "pivot", "bore", "unknown"]
Bounded = Literal["", "crown", "line", "surge"]
RestsOn = Literal["", "contact", "loads"]
Page = Literal[
    "",
    "Torque",
    "Cam",
    "Contact",
    "Follower",
    "Roller",
    "Flat face",
    "Guides",
    "Pivot",
    "Spring",
    "Camshaft",
]
"""Parts of the mechanism in the order of the flow of force; "": of evidence."""
Kind = Literal["", "roller", "face", "round", "swung_face", "stem", "arm"]
"""Needed of a check: roller, face, round surface of either, face of an arm, stem, arm; "": none."""
ClosedBy = Literal[
    "", "force", "form", "plate", "groove", "rollers", "conjugate", "preload", "yoke"
]
EVERY = "all, standstill and over-speed included"
BY_DUTY = (
    "by load_case.duty, 1/L = sum q_i/L_i with q_i the shares; without a duty the worst load case"
    " counts for the whole life"
)
NONE = "none: the shape of the cam or a part as drawn"
RIPPLE = "those with an engine torque and a required reduction"
LASTING = "those with a share of the operating time, load_case.duty; all without one"
STEADY = "those of the case: in standstill and over-speed nothing warms up"
FIRED = "those of the case that are fired, with a mean power of the machine"
SPEED_RANGE = "every speed from standstill to over-speed"
BOUNDLESS = 1e12
"""Record, SI, of a demand without bound that keeps its limit, and of a stated number without one:
JSON has no infinity."""
FACTOR_MAX = 4.0
"""Maximum factor of a relaxation of a limit."""
STATED = "stated"
"""Place of a symbol of a formula whose number the check states, as in ``stated [MPa]``."""


@dataclass(frozen=True)
class Waived:
    """Waiver of a failed demand up to a value.

    Parameters
    ----------
    text : str      name, date and reason
    up_to : float   worst demand that is accepted, SI
    """

    text: str
    up_to: float


@dataclass(frozen=True)
class Demand:
    """Demand and limit of one solution, SI.

    Parameters
    ----------
    value : float       None or NaN: missing
    allowed : float     limit; None or infinite: missing
    at : Extreme        load case and cam angle of the demand; None: it has none
    missing : tuple     dotted keys that the case lacks and the demand or limit needs
    note : str          remark
    figures : tuple     sources of further data, such as a material card
    method, source   in place of the declared ones, where they depend on the case
    must_have : bool    False: optional for this solution
    corner : str        tolerance corner of the demand; "": nominal
    stated : mapping    numbers of solvers and reductions in the formula by their symbol, SI
    """

    value: float | None
    allowed: float | None
    at: Extreme | None = None
    missing: tuple[str, ...] = ()
    note: str = ""
    figures: tuple[Source | str, ...] = ()
    method: str = ""
    source: Source = NO_SOURCE
    must_have: bool = True
    corner: str = ""
    judged_at: Depth | Literal[""] = ""
    stated: Mapping[str, float] = field(default_factory=dict, hash=False)


class Allowed(NamedTuple):
    """Limit of a demand, SI; None: none stated. missing: dotted keys that the case lacks.

    if_exceeded: the value is that of the known parts alone: a demand can only fail by it.
    """

    value: Value | None
    missing: tuple[str, ...] = ()
    if_exceeded: bool = False

    def against(self, demand: float) -> float | None:
        """Limit of a demand, SI; None: none stated, or that of the known parts alone, which the
        demand does not exceed.
        """
        if self.value is None or (self.if_exceeded and not demand > self.value):
            return None
        return float(self.value)

    def against_each(self, demand: Array) -> Array:
        """Limits of demands (m,) or (m, 1), SI; NaN where `against` gives None."""
        demand, limit = np.broadcast_arrays(demand, np.nan if self.value is None else self.value)
        return np.where(demand > limit, limit, np.nan) if self.if_exceeded else np.array(limit)


def of_key(key: str, share: AnyLimit | None = None) -> Callable[[Numbers], Allowed]:
    """Function that gives the limit stated at a `key` of the case, or a share of it.

    Parameters
    ----------
    share : AnyLimit   row of the table of limits that states the share of the value; None: all of
        it
    """

    def allowed(numbers: Numbers) -> Allowed:
        """Limit at the key, or the share of it; without a value its missing key."""
        value = numbers.get(key)
        if value is None:
            return Allowed(None, (key,))
        return Allowed(value if share is None else numbers.limit(share) * value)

    return allowed


def of_row(row: AnyLimit | None) -> Callable[[Numbers], Allowed]:
    """Function that gives the limit stated in a row of the table of limits.

    Raises
    ------
    InputError
        If there is none.
    """
    if row is None:
        raise InputError("limit of a check", "missing", "a row, or a function of numbers")
    return of_key(f"limits.{row.id}")


class Kept(NamedTuple):
    """Form in which the synthesis keeps a limit as a constraint.

    Parameters
    ----------
    use : callable       loaded cam, limit -> utilisation (..., n), another form of the inequality
                         that has no poles; None where it does not apply. None: measure over limit
    factor_max : float   maximum factor on the limit where limits conflict; 0: fixed
    value_max : float    maximum limit where limits conflict, SI
    power : float        of a mean, wear or life over the turn that is the utilisation
    once : bool          the same in the load cases of a preload and at tolerance corners
    group : str          checks of one measure that are one constraint, at the least of their limits
    unit : str           in which a limit of a part, or the least of a group, is shown; "": the
                         limit is the row of the check, or another check of the group has the unit
    falls : float        power of a limit with a unit with which the utilisation falls; negative: it
                         rises, and the limit is not relaxed
    unloaded : bool      the utilisation is that of the shape of the cam, of a measure of its loads
    needs : str          kind of follower, or closure of its cam, with which it is the constraint
                         of its group; "": the check that names the group is
    """

    use: Callable[[LoadedCam, float], Array | None] | None = None
    factor_max: float = 0.0
    value_max: float = math.inf
    power: float = 1.0
    once: bool = False
    group: str = ""
    unit: str = ""
    falls: float = 1.0
    unloaded: bool = False
    needs: Kind | ClosedBy = ""


class Stroke(NamedTuple):
    """Measure of the rise or of the return alone, with its limit and name."""

    measure: Measure
    limit: AnyLimit
    words: str


class Measured(NamedTuple):
    """Relation of a demand to a pointwise measure of the loaded cam.

    Parameters
    ----------
    reduce : str         how the measure is reduced over the cam, by `worst_measure`
    worst : str          whether its greatest or its least value governs
    value : callable     worst measure, numbers -> demand: monotone
    error : float        error share of the demand over that of the measure: power of `value`
    known : callable     loaded cams of the load cases -> numbers that demand and limit need besides
                         those of the machine; None: no others
    bound : callable     limit of the demand, numbers -> limit of the measure: its inverse, if
                         `kept`; None: every value of the measure is within the limit
    allowed : callable   numbers -> limit
    needed : tuple       dotted keys without which there is no demand
    applies : callable   demand, numbers -> whether the check applies to the cam
    remark : callable    demand, solution -> demand, with what it has in words; None where the check
                         does not apply
    solved : callable    solution above the screening -> demand, of which that by the measure is a
                         bound; None: the measure is the demand at every depth
    order : int          highest derivative of the lift in the measure, 2 or 3
    deviation : float    of the demand of the screening from that of the preview, over the greater
                         of demand and limit, as measured; None: not screened
    pointwise : bool     the demand bends over the measure: made at each angle, so that its error
                         bar is that of the demand
    smooth : bool        the screening refines the measure between samples; False: it has poles
    bounded : str        the screened utilisation is a lower bound where the lines of contact are
                         too many to be solved: "crown", of crowned bodies; "line", of any; without
                         the surge of a wound spring: "surge"; "": never
    strokes : tuple      measures with limits of their own, where the case sets each of them: that
                         of the greatest utilisation governs
    kept : Kept          None: the synthesis does not keep it
    """

    reduce: Reduce
    worst: Literal["greatest", "least"]
    value: Callable[[Value, Numbers], Value]
    error: float
    bound: Callable[[float, Numbers], float | None]
    allowed: Callable[[Numbers], Allowed]
    needed: tuple[str, ...]
    applies: Callable[[Value, Numbers], NDArray[np.bool_]]
    known: Callable[[Iterable[LoadedCam]], Mapping[str, Value]] | None
    remark: Callable[[Demand, Solution], Demand | None]
    solved: Callable[[Solution], Demand] | None
    order: int
    deviation: float | None
    pointwise: bool
    smooth: bool
    bounded: Bounded
    strokes: tuple[Stroke, ...]
    kept: Kept | None

    def limits_of_strokes(self, numbers: Numbers) -> tuple[Value, ...]:
        """Limits of the strokes; (): not all of them are set."""
        limits = [numbers.get(f"limits.{each.limit.id}") for each in self.strokes]
        stated = tuple(each for each in limits if each is not None)
        return stated if len(stated) == len(limits) else ()

    def limit_of_measure(self, numbers: Numbers) -> float | None:
        """Limit of the measure, SI, that corresponds to the limit of the demand; None where this is
        not known or every value of the measure is within it.
        """
        limit = self.allowed(numbers).value
        if limit is None or any(numbers.get(key) is None for key in self.needed):
            return None
        return self.bound(float(limit), numbers)

    def use(self, measure: Measure, cam: LoadedCam, limit: float) -> Array | None:
        """Utilisation (..., n) of the measure of a cam at a limit, SI, the constraint of a
        synthesis, see `Kept`.

        Where the case limits every stroke by itself, that of the first stroke; the others are
        constraints of their own.
        """
        if self.limits_of_strokes(cam.numbers):
            measure = self.strokes[0].measure
        if self.kept is not None and self.kept.use is not None:
            return self.kept.use(cam, limit)
        return measure(cam) / limit if self.worst == "greatest" else 1.0 + limit - measure(cam)


HELD = ("form", "preload", *TWO_TRACKS)
"""Of `ClosedBy` those of a cam that pulls its follower."""


Along = Callable[[Solution, Cycle], Array]
"""Solution, one of its cycles -> values by cam angle (n,), see `Declaration.along`."""


@dataclass(frozen=True)
class Declaration:
    """Declaration of a check: title, limit, formula, sources; calling it checks a solution.

    Parameters
    ----------
    id, title : str            key, and heading; ``{follower}`` is replaced by roller or face
    unit : str                 of the record, such as MPa
    sense : str                "at_most": demand <= limit passes; "at_least": demand >= limit
    method : str               calculation of the demand
    source : Source            clause or book of the limit, without a row of the table
    limit : Limit              row of the table; None: not set by the user
    must_have : bool           it decides the verdict
    evidence : bool            verification of the solution or of the input, which no change of
                               the design moves: it decides the verdict when it fails, cannot be
                               waived and never governs
    lift_can_help : bool       a gentler lift can pass it
    tier : Tier                least tier that can judge it; below it the check is not evaluated
    fails_from : Tier          least tier with a lower bound of its utilisation: below `tier` it
                               fails by it or is not evaluated
    moved_by_tolerance : bool  its demand differs at a tolerance corner
    error : str                origin of the error bar of the demand
    needs : str                kind of follower, see `Kind`; "": any
    closed_by : str            what keeps the follower on the cam: "force", of a spring or weight,
                               or "form", of a second track;
                               "plate": any cam of plates; "groove", "conjugate", "yoke": that
                               closure; "rollers": two rollers in a groove; "preload": discs
                               with an interference;
                               "": any
    part : str                 part of the scope that it judges; "": cam or follower
    if_limited : bool          it is made only where the case sets its limit
    within : tuple             parts and subjects of the scope, without all of which it is not
                               judged; (): none
    formula : str              demand and limit with their symbols, for the documentation
    symbols : mapping          where the symbols of the formula stand in a run, for the hand-check
                               sheet: dotted keys, columns of the cycle, figures of the cam, or
                               expressions of them, numbers that the check states (`STATED`);
                               empty: the demand is stated, not evaluated
    reason : str               why it decides the verdict, or why it does not
    load_cases : str           load cases in which it is made, in words
    rests_on : str             "loads": of the cam, none where the follower has left it or locked;
                               "contact": with it; "": neither, such as the contact force itself
    values : tuple             values besides its own limit on which it rests, dotted names in a
                               case, see `value_groups`
    levers : tuple             changes of the case that can turn it to pass; (): none, its data are
                               missing, or what it compares is stated in the case
    page : str                 part of the mechanism that it judges
    kept_as : str              what the synthesis bounds where a part sets the limit, in words
    certified_by : str         certified quantity of its error on the contact; "": that of the
                               greatest error
    scales_with : tuple        group of the measure, `NORMAL_FORCE` or `PRESSURE`, and the power of
                               its greatest value with which the utilisation grows, about; ():
                               neither
    along : callable           solution, one of its cycles -> values by cam angle (n,), of which the
                               greatest of all load cases makes the demand of such a check: the
                               synthesis keeps its limit at each angle; None: at the greatest value
                               of the group alone
    demand : callable          solution -> demand; None where the check does not apply
    measured : Measured        how the demand follows from a measure of the loaded cam; None: it is
                               a demand of the whole solution
    measure : callable         loaded cam -> measure by cam angle (..., n); None: likewise
    """

    id: str
    title: str
    unit: str
    sense: Sense
    method: str
    source: Source
    limit: AnyLimit | None
    must_have: bool
    evidence: bool
    lift_can_help: bool
    tier: Tier
    fails_from: Tier
    moved_by_tolerance: bool
    error: Error
    needs: Kind
    closed_by: ClosedBy
    part: PartName | Literal[""]
    within: tuple[ScopeName, ...]
    if_limited: bool
    formula: str
    symbols: Mapping[str, str] = field(repr=False, hash=False)
    reason: str
    load_cases: str
    rests_on: RestsOn
    values: tuple[str, ...]
    levers: tuple[Lever, ...]
    page: Page
    kept_as: str
    certified_by: str
    scales_with: tuple[str, float] | tuple[()]
    along: Along | None = field(repr=False)
    demand: Callable[[Solution], Demand | None] = field(repr=False)
    measured: Measured | None = field(default=None, repr=False)
    measure: Measure | None = field(default=None, repr=False)

    def __call__(self, solution: Solution) -> Check | None:
        """Check of a solution.

        None where it does not apply, its part is not described, its tier is a deeper one, or it
        lacks a key of what the scope leaves out; also where the demand is a bound of which the
        check does not fail.

        Whether a part is described has a check of its own, see `part_data`.
        """
        if solution.tier < self.fails_from or not self.concerns(solution.machine):
            return None
        demand = self.demand(solution)
        if demand is None:
            return None
        check = self.judged(solution.machine, demand)
        scope = solution.machine.scope
        if check.status == "not_evaluated" and any(map(scope.leaves_out, check.missing)):
            return None
        # a lower bound within the limit says nothing
        return check if check.status == "fail" or not self.is_bound(solution.tier) else None

    def is_bound(self, tier: Tier) -> bool:
        """Whether its utilisation at a tier is a lower bound, which can fail but not pass."""
        return self.fails_from <= tier < self.tier

    @property
    def kept_at(self) -> str:
        """Key of its limit in a synthesis: group, row of the limit, or own id."""
        rule = None if self.measured is None else self.measured.kept
        group, of_part = ("", "") if rule is None else (rule.group, rule.unit)
        return group or (self.id if of_part or self.limit is None else self.limit.id)

    def deeper(self, solution: Solution) -> Check | None:
        """The check marked as not evaluated below its tier; None at or above it, and where it does
        not apply to the machine.
        """
        if solution.tier >= self.tier or not self.concerns(solution.machine):
            return None
        word = self.tier.word
        missing = Demand(None, None, note=f"judged at the depth {word}")
        return replace(self.judged(solution.machine, missing), judged_at=word)

    def concerns(self, machine: Machine) -> bool:
        """Whether the check applies to a machine: by kind of follower, limits that are set, and
        parts that it describes within the scope.
        """
        if self.needs not in {"", machine.carrier, *machine.follower.kinds}:
            return False
        if self.closed_by not in ("", *machine.cam.closed_by):
            return False
        if self.if_limited and self.limit is not None and machine.limits[self.limit] is None:
            return False
        within = (each for each in self.within if each not in machine.absent)
        if self.within and not any(map(machine.scope.covers, within)):
            return False
        return not self.part or (machine.scope.covers(self.part) and machine.describes(self.part))

    def lacks_left_out(self, machine: Machine, numbers: Numbers) -> bool:
        """Whether the limit or the demand lacks a key that belongs to a part outside the scope."""
        if self.measured is None:
            return False
        needed = (key for key in self.measured.needed if numbers.get(key) is None)
        missing = (*self.measured.allowed(numbers).missing, *needed)
        return any(map(machine.scope.leaves_out, missing))

    def judged(self, machine: Machine, demand: Demand) -> Check:
        """Check of a demand on a machine, with title, source, method and note of the demand or else
        of the declaration.
        """
        missing = tuple(dict.fromkeys(demand.missing))
        source = demand.source or self.source
        if self.limit is not None and not demand.source:
            source = machine.limits.source(self.limit)
        check = Check(
            declaration=self,
            title=self.title.format(follower=machine.follower.word),
            demand=demand.value,
            limit=demand.allowed,
            load_case="" if demand.at is None else demand.at.load_case,
            cam_angle=None if demand.at is None else demand.at.cam_angle,
            source="; ".join(
                dict.fromkeys(str(each) for each in (source, *demand.figures) if each)
            ),
            method=demand.method or self.method,
            must_have=self.must_have and demand.must_have,
            missing=missing,
            note="; ".join(filter(None, (_missing_words(missing), demand.note))),
            error_share=None if demand.at is None else demand.at.error_share,
            corner=demand.corner,
            judged_at=demand.judged_at,
            stated=demand.stated,
            corner_demand=demand.value if demand.corner else None,
        )
        # a demand beyond its limit by what is known is judged without the rest
        return replace(check, missing=()) if missing and check.evaluated else check


def check(
    limit: AnyLimit | None = None,
    *,
    title: str,
    method: str,
    id: str = "",  # noqa: A002 - key of the record
    unit: str = "",
    sense: Sense | None = None,
    source: Source = NO_SOURCE,
    must_have: bool = True,
    evidence: bool = False,
    lift_can_help: bool = False,
    tier: Tier = Tier.PREVIEW,
    fails_from: Tier | None = None,
    moved_by_tolerance: bool = True,
    error: Error = "sampling",
    needs: Kind = "",
    closed_by: ClosedBy = "",
    part: PartName | Literal[""] = "",
    within: tuple[ScopeName, ...] = (),
    if_limited: bool = False,
    formula: str = "",
    symbols: Mapping[str, str] = MappingProxyType({}),
    reason: str = "",
    load_cases: str = EVERY,
    rests_on: RestsOn | None = None,
    values: tuple[str, ...] = (),
    levers: tuple[Lever, ...] = (),
    page: Page = "",
    kept_as: str = "",
    certified_by: str = "",
    scales_with: tuple[str, float] | tuple[()] = (),
    along: Along | None = None,
) -> Declaring:
    """Decorator that declares a check of the demand that the decorated function returns; see
    `Declaration`.

    Id, unit and sense default to those of the function and the limit, fails_from to the tier; a
    check of the design made in load cases rests on their loads.
    """

    if rests_on is None:
        rests_on = "" if evidence or load_cases in (NONE, SPEED_RANGE) else "loads"

    def declared(
        name: str,
        demand: Callable[[Solution], Demand | None],
        measured: Measured | None = None,
        measure: Measure | None = None,
    ) -> Declaration:
        return Declaration(
            id=id or name,
            title=title,
            unit=unit or ("-" if limit is None else limit.quantity.unit or "-"),
            sense=sense or ("at_most" if limit is None else limit.sense),
            method=method,
            source=source,
            limit=limit,
            must_have=must_have,
            evidence=evidence,
            lift_can_help=lift_can_help,
            tier=tier,
            fails_from=tier if fails_from is None else fails_from,
            moved_by_tolerance=moved_by_tolerance,
            error=error,
            needs=needs,
            closed_by=closed_by,
            part=part,
            within=within,
            if_limited=if_limited,
            formula=formula,
            symbols=symbols,
            reason=reason,
            load_cases=load_cases,
            rests_on=rests_on,
            values=values,
            levers=levers,
            page=page,
            kept_as=kept_as,
            certified_by=certified_by,
            scales_with=scales_with,
            along=along,
            demand=demand,
            measured=measured,
            measure=measure,
        )

    return Declaring(declared, limit)


class Made(Protocol):
    """Declaration of a check from its demand, or from the measure of the demand."""

    def __call__(
        self,
        name: str,
        demand: Callable[[Solution], Demand | None],
        measured: Measured | None = None,
        measure: Measure | None = None,
    ) -> Declaration: ...


@dataclass(frozen=True)
class Declaring:
    """Decorator that declares a check by its demand or measure; see `check`."""

    made: Made
    limit: AnyLimit | None

    def __call__(self, demand: Callable[[Solution], Demand | None]) -> Declaration:
        return self.made(demand.__name__, demand)

    def measured(
        self,
        reduce: Reduce,
        *,
        worst: Literal["greatest", "least"] = "greatest",
        value: Callable[[Value, Numbers], Value] = lambda worst, _: worst,
        error: float = 1.0,
        bound: Callable[[float, Numbers], float | None] = lambda limit, _: limit,
        allowed: Callable[[Numbers], Allowed] | None = None,
        needed: tuple[str, ...] = (),
        applies: Callable[[Value, Numbers], NDArray[np.bool_]] = lambda *_: np.array(True),
        known: Callable[[Iterable[LoadedCam]], Mapping[str, Value]] | None = None,
        remark: Callable[[Demand, Solution], Demand | None] = lambda demand, _: demand,
        solved: Callable[[Solution], Demand] | None = None,
        order: int = 2,
        deviation: float | None = None,
        pointwise: bool = False,
        smooth: bool = True,
        bounded: Bounded = "",
        strokes: tuple[Stroke, ...] = (),
        kept: Kept | None = None,
    ) -> Callable[[Measure], Declaration]:
        """Decorator that declares the check by a measure of the loaded cam, which the decorated
        function returns; see `Measured`.
        """
        limit = of_row(self.limit) if allowed is None else allowed
        how = Measured(
            reduce=reduce,
            worst=worst,
            value=value,
            error=error,
            bound=bound,
            allowed=limit,
            needed=needed,
            applies=applies,
            known=known,
            remark=remark,
            solved=solved,
            order=order,
            deviation=deviation,
            pointwise=pointwise,
            smooth=smooth,
            bounded=bounded,
            strokes=strokes,
            kept=kept,
        )

        def declared(measure: Measure) -> Declaration:
            return self.made(measure.__name__, partial(_demand, measure, how), how, measure)

        return declared


def _demand(measure: Measure, how: Measured, solution: Solution) -> Demand | None:
    """Demand of a solution by the worst value of a measure over its load cases or, above the
    screening, as `how.solved` gives it; None where the check does not apply.
    """
    if how.solved is not None and solution.tier > Tier.SCREENING:
        return how.solved(solution)
    numbers = solution.numbers
    if how.known is not None:
        numbers = numbers | how.known(solution.cams.values())
    limit = how.allowed(numbers)
    lacks = tuple(key for key in how.needed if numbers.get(key) is None)
    if not how.applies(np.nan, numbers):
        return None
    if lacks:
        allowed = None if limit.value is None else float(limit.value)
        return how.remark(Demand(None, allowed, missing=(*lacks, *limit.missing)), solution)

    def worst_of(measured: Measure) -> Extreme:
        """Worst value of a measure, as demand, with its place and error share."""

        def value(worst: Value) -> Value:
            return how.value(worst, numbers)

        worst = worst_measure(
            solution,
            (lambda cam: np.asarray(value(measured(cam)))) if how.pointwise else measured,
            how.reduce,
            float if how.pointwise else lambda worst: float(value(worst)),
            at_least=how.worst == "least",
            order=how.order,
        )
        return worst._replace(error_share=how.error * worst.error_share)

    if of_strokes := how.limits_of_strokes(numbers):
        worsts = [worst_of(each.measure) for each in how.strokes]
        uses = [
            each.value / float(stroke_limit)
            for each, stroke_limit in zip(worsts, of_strokes, strict=True)
        ]
        most = uses.index(max(uses))  # of the first, where it is not known
        stroke, worst = how.strokes[most], worsts[most]
        source = solution.machine.limits.source(stroke.limit)
        return Demand(worst.value, float(of_strokes[most]), worst, note=stroke.words, source=source)
    worst = worst_of(measure)
    if not how.applies(worst.value, numbers):
        return None
    return how.remark(
        Demand(worst.value, limit.against(worst.value), worst, limit.missing), solution
    )


def _missing_words(keys: tuple[str, ...]) -> str:
    return f"missing: {', '.join(keys)}" if keys else ""


def made_from_others(_: Solution) -> None:
    """Demand of a check that is derived from other checks: None here."""


@dataclass(frozen=True, repr=False)
class Check(Displayed):
    """Check of one solution: demand against limit, SI.

    Parameters
    ----------
    declaration : Declaration
    demand, limit : float    None or NaN: missing
    load_case : str          of the worst demand; "": none
    cam_angle : float        of the worst demand, rad; None: none
    title, source, method : str   of this solution
    must_have : bool         it decides the verdict
    missing : tuple          dotted keys that the case lacks and without which it is not evaluated
    note : str               remark; names the missing keys first
    error_share : float      half of the error bar over the demand; None: not known
    waiver : Waived          None: not waived
    corner : str             tolerance corner of the worst demand; "": none was solved
    corner_demand : float    demand at that corner; None: none was solved
    unconfirmed : tuple      dotted keys of the values on which it rests and no source confirms
    relaxed : tuple          its limits that the case makes weaker than their defaults, in words
    judged_at : str          depth that judges it, where the solution is less deep; "": judged
    without : str            load cases without loads, as the follower has left the cam or locked:
                             the demand is that of the others, by which it can only fail; "": none
    remedy : str             smallest change of the case that cures it, in one line; "": none known
    stated : mapping         numbers in its formula of solvers and reductions, see `Demand`
    """

    declaration: Declaration
    demand: float | None
    limit: float | None
    title: str
    source: str
    method: str
    load_case: str = ""
    cam_angle: float | None = None
    must_have: bool = True
    missing: tuple[str, ...] = ()
    note: str = ""
    error_share: float | None = None
    waiver: Waived | None = None
    corner: str = ""
    corner_demand: float | None = None
    unconfirmed: tuple[str, ...] = ()
    relaxed: tuple[str, ...] = ()
    judged_at: Depth | Literal[""] = ""
    without: str = ""
    remedy: str = ""
    stated: Mapping[str, float] = field(default_factory=dict, hash=False)

    def __str__(self) -> str:
        """Title, worst demand, limit and status in one line, in `unit`."""
        demand, limit = (
            "unknown" if value is None or math.isnan(value) else shown(value, self.unit)
            for value in (self.worst, self.limit)
        )
        sign = "<=" if self.sense == "at_most" else ">="
        return f"{self.title}: {demand}, must be {sign} {limit}: {self.status}"

    @property
    def facts(self) -> Mapping[str, object]:
        """Id, statement, governing place and remedy of the check."""
        known = {
            "id": self.id,
            "says": str(self),
            "load_case": self.load_case,
            "corner": self.corner,
            "note": self.note,
            "remedy": self.remedy,
        }
        return {name: text for name, text in known.items() if text}

    @property
    def id(self) -> str:
        return self.declaration.id

    @property
    def unit(self) -> str:
        """Unit of the record."""
        return self.declaration.unit

    @property
    def sense(self) -> Sense:
        return self.declaration.sense

    @property
    def evidence(self) -> bool:
        """Whether it verifies solution or input rather than the design; see `Declaration`."""
        return self.declaration.evidence

    @property
    def lift_can_help(self) -> bool:
        """Whether a gentler lift can turn it to pass."""
        return self.declaration.lift_can_help

    @property
    def error(self) -> float | None:
        """Half of the demand's error bar, SI; None if it is not known."""
        demand, share = self.demand, self.error_share
        if demand is None or share is None or not math.isfinite(demand * share):
            return None
        return abs(demand) * share

    @property
    def waived_up_to(self) -> float | None:
        """Worst demand accepted by a waiver; None: not waived."""
        return None if self.waiver is None else self.waiver.up_to

    @property
    def worst(self) -> float | None:
        """Judged demand: the worse of the nominal and the governing tolerance corner."""
        return worst(self)

    @property
    def margin(self) -> float | None:
        """1 - utilisation; negative beyond the limit."""
        used = self.utilisation
        return None if used is None else 1.0 - used

    @property
    def evaluated(self) -> bool:
        """Whether demand and limit are known; see `verdict.evaluated`."""
        return evaluated(self)

    @property
    def is_bound(self) -> bool:
        """Whether its demand is a bound that keeps the limit and so proves nothing."""
        return is_bound(self)

    @property
    def utilisation(self) -> float | None:
        """Judged demand over limit, its inverse for a least value; None if one is missing."""
        return utilisation(self)

    @property
    def upper_utilisation(self) -> float | None:
        """Utilisation at the unfavourable end of the error bar; None if one is missing."""
        return upper_utilisation(self)

    @property
    def status(self) -> Status:
        """`pass`, `fail`, `not_evaluated`, or `waived`; see `verdict.status`."""
        return status(self)

    @property
    def not_proven(self) -> bool:
        """Whether a demand within its limit has the limit inside its error bar."""
        return not_proven(self)

    @property
    def blocks(self) -> bool:
        """Whether it prevents PASS: a must-have check neither passed nor waived."""
        return blocks(self)

    def as_record(self) -> CheckRecord:
        """JSON record, in `unit` and degrees; NaN and infinity become null.

        A demand without bound that keeps its limit, such as the fatigue safety factor of a constant
        load, is recorded as `BOUNDLESS`.

        The demand of a check `without` the loads of a load case is null as well, unless it fails.
        A utilisation of null is infinite with the status `fail` or `waived`, missing with
        `not_evaluated`.
        """
        unit = self.unit
        bound = self.is_bound
        demand, corner = (None, None) if bound else (self.demand, self.corner_demand)
        if self.sense == "at_least":
            demand, corner = (BOUNDLESS if each == math.inf else each for each in (demand, corner))
        return {
            "id": self.id,
            "title": self.title,
            "demand": _shown(demand, unit),
            "limit": _shown(self.limit, unit),
            "unit": unit,
            "utilisation": _shown(self.utilisation),
            "status": self.status,
            "load_case": "" if bound else self.load_case,
            "cam_angle_deg": None if bound else _shown(self.cam_angle, "deg"),
            "source": self.source,
            "method": self.method,
            "sense": self.sense,
            "must_have": self.must_have,
            "lift_can_help": self.lift_can_help,
            "waiver": None if self.waiver is None else self.waiver.text,
            "waived_up_to": _shown(self.waived_up_to, unit),
            "not_proven": self.not_proven,
            "missing": list(self.missing),
            "note": "; ".join(filter(None, (self.without, self.note))),
            "error": None if bound else _shown(self.error, unit),
            "margin": _shown(self.margin),
            "corner": "" if bound else self.corner,
            "corner_demand": _shown(corner, unit),
            "evidence": self.evidence,
            "to_be_confirmed": list(self.unconfirmed),
            "relaxed": list(self.relaxed),
            "judged_at": self.judged_at,
            "remedy": self.remedy,
            "stated": {} if bound else self._stated,
        }

    @property
    def _stated(self) -> dict[str, float]:
        """Stated numbers in the units of the symbols of the formula; those known."""
        symbols = self.declaration.symbols
        known = {
            name: _shown(min(value, BOUNDLESS), symbols[name].partition("[")[2].rstrip("]"))
            for name, value in self.stated.items()
        }
        return {name: value for name, value in known.items() if value is not None}


def depends_on_lift(one: Check | Declaration) -> bool:
    """Whether a synthesis of the lift can change the demand of a check."""
    return one.lift_can_help or one.id == TORQUE_REDUCTION.id


def _shown(value: float | None, unit: str = "") -> float | None:
    """Value of a record, to 15 digits: 30 deg is 30, not 29.999999999999996."""
    if value is None or not math.isfinite(value):
        return None
    return float(f"{in_unit(value, unit):.15g}")

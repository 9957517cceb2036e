"""One limit: what is demanded, what is allowed, who says so; and the verdict of many."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Literal

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import AnyLimit, Sense
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.extremes import Extreme
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution

Status = Literal["pass", "fail", "not_evaluated", "waived"]
Verdict = Literal["pass", "fail"]
Error = Literal["sampling", "contact", "guides", "unknown"]
Record = dict[str, str | float | bool | None]


@dataclass(frozen=True)
class Demand:
    """Demand of one solution beside what is allowed, SI.

    Parameters
    ----------
    value : float       None or NaN: the number is missing
    allowed : float     None or infinite: the number is missing
    at : Extreme        load case and angle of the demand; None: it has none
    note : str          what a reader must know besides
    figures : tuple     sources of figures besides that of the limit, such as a material card's
    method, source : str   in place of the declared ones, where they depend on the case
    must_have : bool    False: not required of this solution, though declared so
    corner : str        tolerance corner where the demand already stands; "" at the nominal
    """

    value: float | None
    allowed: float | None
    at: Extreme | None = None
    note: str = ""
    figures: tuple[str, ...] = ()
    method: str = ""
    source: str = ""
    must_have: bool = True
    corner: str = ""


@dataclass(frozen=True)
class Declaration:
    """A check as declared, once for all solutions; calling it checks one.

    Parameters
    ----------
    id, title : str            stable name, and what a reader sees; ``{follower}`` in a title
                               stands for roller or face
    unit : str                 of the record, such as MPa
    sense : str                "at_most": demand <= limit passes; "at_least": demand >= limit
    method : str               how the demand is computed
    source : str               clause behind the limit, where no row of the table has it
    limit : Limit              row of the table; None: the limit is not the user's to set
    must_have : bool           decides the verdict
    evidence : bool            about the numbers, not the design: nobody can waive it
    lift_can_help : bool       a gentler lift can lower the demand
    tier : Tier                least tier that can judge it; below it is left out
    forecast : bool            quick enough to forecast a smoother
    moved_by_tolerance : bool  its demand differs at a corner of the tolerances
    error : str                what the error bar of the demand is made of
    needs : str                kind of follower; "": any
    """

    id: str
    title: str
    unit: str
    sense: Sense
    method: str
    source: str
    limit: AnyLimit | None
    must_have: bool
    evidence: bool
    lift_can_help: bool
    tier: Tier
    forecast: bool
    moved_by_tolerance: bool
    error: Error
    needs: Literal["", "roller", "face"]
    demand: Callable[[Solution], Demand | None] = field(repr=False)

    def __call__(self, solution: Solution) -> Check | None:
        """The check of a solution; None where it does not apply."""
        kind = solution.machine.follower
        if solution.tier < self.tier or self.needs not in ("", kind.word):
            return None
        demand = self.demand(solution)
        return None if demand is None else self.judged(solution.machine, demand)

    def judged(self, machine: Machine, demand: Demand) -> Check:
        """The check of a demand whose solution is known by its machine."""
        source = demand.source or self.source
        if self.limit is not None and not demand.source:
            source = machine.limits.source(self.limit)
        return Check(
            declaration=self,
            title=self.title.format(follower=machine.follower.word),
            demand=demand.value,
            limit=demand.allowed,
            load_case="" if demand.at is None else demand.at.load_case,
            cam_angle=None if demand.at is None else demand.at.cam_angle,
            source="; ".join(dict.fromkeys(each for each in (source, *demand.figures) if each)),
            method=demand.method or self.method,
            must_have=self.must_have and demand.must_have,
            note=demand.note,
            error_share=None if demand.at is None else demand.at.error_share,
            corner=demand.corner,
            corner_demand=demand.value if demand.corner else None,
        )


def check(
    limit: AnyLimit | None = None,
    *,
    title: str,
    method: str,
    id: str = "",  # noqa: A002 - as a record has it
    unit: str = "",
    sense: Sense | None = None,
    source: str = "",
    must_have: bool = True,
    evidence: bool = False,
    lift_can_help: bool = False,
    tier: Tier = Tier.PREVIEW,
    forecast: bool = False,
    moved_by_tolerance: bool = True,
    error: Error = "sampling",
    needs: Literal["", "roller", "face"] = "",
) -> Callable[[Callable[[Solution], Demand | None]], Declaration]:
    """Declare a check: the decorated function gives its demand. See `Declaration`.

    Id, unit and sense are those of the function and the limit unless they are given.
    """

    def declared(demand: Callable[[Solution], Demand | None]) -> Declaration:
        return Declaration(
            id=id or demand.__name__,
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
            forecast=forecast,
            moved_by_tolerance=moved_by_tolerance,
            error=error,
            needs=needs,
            demand=demand,
        )

    return declared


def made_from_others(_: Solution) -> None:
    """None: the demand is made from other checks, after them."""


@dataclass(frozen=True)
class Check:
    """A demand beside its limit, SI.

    Parameters
    ----------
    declaration : Declaration
    demand, limit : float    None or NaN: the number is missing
    load_case : str          where the demand is worst; "" when it has none
    cam_angle : float        where the demand is worst, rad; None when it has none
    title, source, method : str   of this solution
    must_have : bool         decides the verdict
    note : str               what a reader must know besides
    error_share : float      error bar of the demand over the demand; None: not known
    waiver : str             name, reason and date; None when nobody waived it
    corner : str             the tolerance corner where the demand is worst; "" when none was tried
    corner_demand : float    the demand there; None when none was tried
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
    note: str = ""
    error_share: float | None = None
    waiver: str | None = None
    corner: str = ""
    corner_demand: float | None = None

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
        """Whether it is about the numbers, not the design."""
        return self.declaration.evidence

    @property
    def lift_can_help(self) -> bool:
        """Whether a gentler lift can lower the demand."""
        return self.declaration.lift_can_help

    @property
    def error(self) -> float | None:
        """Half of the demand's error bar; None where it is not known."""
        demand, share = self.demand, self.error_share
        if demand is None or share is None or not math.isfinite(demand * share):
            return None
        return abs(demand) * share

    @property
    def margin(self) -> float | None:
        """Share of the limit that is left; negative beyond it."""
        used = self.utilisation
        return None if used is None else 1.0 - used

    @property
    def evaluated(self) -> bool:
        """Whether both numbers are there; NaN is a missing number, so is an infinite limit."""
        demand, limit = self.demand, self.limit
        return not (
            demand is None or math.isnan(demand) or limit is None or not math.isfinite(limit)
        )

    @property
    def utilisation(self) -> float | None:
        """Share of the limit in use, passing at <= 1; None when a number is missing.

        A demand that is not positive cannot meet a positive least value by any factor:
        infinite. So is a positive demand against a limit of zero.
        """
        if not self.evaluated:
            return None
        demand, limit = float(self.demand or 0.0), float(self.limit or 0.0)
        part, whole = (demand, limit) if self.sense == "at_most" else (limit, demand)
        if whole > 0:
            return part / whole
        return 0.0 if part <= whole else math.inf

    @property
    def status(self) -> Status:
        """`pass`, `fail`, `not_evaluated`, or `waived` where it would not have passed."""
        if self.evaluated and self._holds():
            return "pass"
        if self.waiver is not None:
            return "waived"
        return "fail" if self.evaluated else "not_evaluated"

    def _holds(self) -> bool:
        demand, limit = float(self.demand or 0.0), float(self.limit or 0.0)
        return demand <= limit if self.sense == "at_most" else demand >= limit

    @property
    def blocks(self) -> bool:
        """A must-have that neither passes nor is waived: the verdict is fail."""
        return self.must_have and self.status in ("fail", "not_evaluated")

    def as_record(self) -> Record:
        """The JSON record, in `unit` and degrees; numbers JSON cannot hold become null.

        An infinite utilisation therefore reads null beside the status `fail`, a missing one
        null beside `not_evaluated`.
        """
        unit = self.unit
        return {
            "id": self.id,
            "title": self.title,
            "demand": _shown(self.demand, unit),
            "limit": _shown(self.limit, unit),
            "unit": unit,
            "utilisation": _shown(self.utilisation),
            "status": self.status,
            "load_case": self.load_case,
            "cam_angle_deg": _shown(self.cam_angle, "deg"),
            "source": self.source,
            "method": self.method,
            "sense": self.sense,
            "must_have": self.must_have,
            "lift_can_help": self.lift_can_help,
            "waiver": self.waiver,
            "note": self.note,
            "error": _shown(self.error, unit),
            "margin": _shown(self.margin),
            "corner": self.corner,
            "corner_demand": _shown(self.corner_demand, unit),
            "evidence": self.evidence,
        }


def verdict(checks: Iterable[Check]) -> Verdict:
    """`pass` when there are checks and every must-have passes or is waived."""
    checks = tuple(checks)
    return "pass" if checks and not any(each.blocks for each in checks) else "fail"


def binding(checks: Iterable[Check]) -> tuple[str, ...]:
    """Ids of the must-have checks that fail the verdict, worst first.

    A missing number comes before every utilisation: its extent is unknown.
    """
    return tuple(each.id for each in in_order(checks) if each.blocks)


def in_order(checks: Iterable[Check]) -> tuple[Check, ...]:
    """Not evaluated first (must-haves before the rest), then by falling utilisation."""
    return tuple(sorted(checks, key=_place))


def _place(one: Check) -> tuple[int, float, str]:
    if one.utilisation is None:
        return 0, 0.0 if one.must_have else 1.0, one.id
    return 1, -one.utilisation, one.id


def _shown(value: float | None, unit: str = "") -> float | None:
    """A value of a record: 15 digits, so that 30 deg reads 30."""
    if value is None or not math.isfinite(value):
        return None
    return float(f"{in_unit(value, unit):.15g}")

"""Form of a check in ``6_checks.json``, and of its figure in ``signoff.json``."""

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Sense, Status
from camwright.pipeline.records.forms import (
    Condition,
    Depth,
    Identifier,
    Least0OrNull,
    Names,
    Unit,
    form,
)

_OF_STATUS = (
    Condition("status", ("pass", "waived"), {"demand": "number", "limit": "number"}),
    Condition("status", ("pass",), {"utilisation": "number"}),
    Condition("status", ("waived",), {"waiver": "string", "waived_up_to": "number"}),
    Condition("status", ("not_evaluated",), {"utilisation": "null"}),
)


@form()
class CheckFigure(TypedDict):
    """Demand of a check with its error bar against its limit."""

    id: Identifier
    """Key of the check, such as pressure_angle."""
    demand: float | None
    """Worst nominal demand; null where it is missing or infinite."""
    error: Least0OrNull
    """Half of the error bar of the demand; null where it is not known."""
    limit: float | None
    """Value the demand must keep; null where it is missing."""
    unit: Unit
    """Unit of demand, limit, error, corner_demand and waived_up_to; - for a pure number."""
    utilisation: Least0OrNull
    """Worst demand over limit, or limit over it for a least value; null with the status fail
    or waived is infinite, with not_evaluated missing."""
    status: Status
    """Result of the check."""
    not_proven: bool
    """Whether the limit lies within the error bar of a demand that is within it."""
    load_case: str
    """Load case of the demand; empty where it has none."""
    cam_angle_deg: float | None
    """Cam angle of the demand; null where it has none."""
    source: str
    """Clause, book or file behind the limit."""
    method: str
    """Calculation of the demand."""
    corner: str
    """Tolerance corner of the worst demand; empty where none was solved."""
    corner_demand: float | None
    """Demand at that corner; null where none was solved or it is infinite."""


@form(
    written=("lift_can_help", "margin", "missing", "to_be_confirmed", "relaxed", "remedy"),
    conditions=_OF_STATUS,
)
class CheckRecord(CheckFigure):
    """One check: demand against limit, in its unit and in degrees."""

    title: str
    """Quantity checked, in words."""
    sense: Sense
    """Whether the limit is the greatest or the least value of the demand."""
    must_have: bool
    """Whether it decides the verdict."""
    lift_can_help: NotRequired[bool]
    """Whether a gentler lift can pass it."""
    waiver: str | None
    """Name, date and reason of a waiver; null without one."""
    waived_up_to: float | None
    """Worst demand that the waiver accepts; null without one."""
    note: str
    """Remark, such as the missing input."""
    missing: NotRequired[Names]
    """Dotted keys, as in the case file, that the case lacks and without which the check is not
    evaluated."""
    stated: NotRequired[dict[str, float]]
    """Numbers of solvers and reductions in the formula of the check by their symbol, in the
    unit that its hand-check sheet shows."""
    remedy: NotRequired[str]
    """Smallest single change of the case that cures a failed check, in one line; empty where
    none was sought or needed."""
    margin: NotRequired[float | None]
    """1 - utilisation; negative beyond the limit."""
    evidence: bool
    """Whether it verifies solution or input, not the design: it never governs and cannot be
    waived."""
    to_be_confirmed: NotRequired[list[str]]
    """Values on which it rests and which no source confirms."""
    relaxed: NotRequired[list[str]]
    """Its limits that the case makes weaker than their defaults, in words."""
    judged_at: Literal[""] | Depth
    """Depth that judges it, where the solution is less deep; empty where it is judged."""

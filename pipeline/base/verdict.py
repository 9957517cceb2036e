"""Rules of judgement: status, utilisation, verdict, binding and governing checks.

A solved check is exact; a record has 15 digits, and its reader allows for them, see `status`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final, Literal, Protocol, TypeVar, get_args

from camwright.geometry.errors import InputError
from camwright.geometry.extrema import to_rank

Sense = Literal["at_most", "at_least"]
Status = Literal["pass", "waived", "not_evaluated", "fail"]
Verdict = Literal["pass", "incomplete", "fail"]
Screen = Literal["open", "fail"]
FailOn = Literal["must", "open", "any", "never"]
STATUSES: tuple[Status, ...] = get_args(Status)
"""Statuses of a check, from the best to the worst."""
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
"""Verdicts, from the best to the worst."""
OUTCOMES = ("pass", "incomplete", "open", "fail")
"""Verdicts and screens, from the best to the worst."""
FAIL_ON: tuple[FailOn, ...] = get_args(FailOn)
"""Checks that decide the exit code of `check`: the must-haves; also any check without data; also
any optional check that fails; none."""
CERTIFIED: Final = "certified"
"""Depth of a run with a verdict; a shallower one has a screen, ``fail`` or ``open``."""
OPEN: Screen = "open"
"""Screen without a failed check; as an exit code it counts as ``incomplete``."""
ROUNDING = 1e-9
"""Relative error of closed forms and exact integrals: no uncertainty of a demand."""


class Judged(Protocol):
    """Numbers by which a check is judged, all in one unit, SI or that of a record.

    None: missing; NaN: a demand that cannot be computed.
    """

    @property
    def demand(self) -> float | None:
        """Nominal demand."""

    @property
    def corner_demand(self) -> float | None:
        """Demand at the governing tolerance corner; None: none was solved."""

    @property
    def limit(self) -> float | None:
        """Limit of the demand; an infinite one counts as missing."""

    @property
    def error_share(self) -> float | None:
        """Half of the error bar over the demand; None: not known."""

    @property
    def sense(self) -> str:
        """``at_least``: demand >= limit passes; else demand <= limit."""

    @property
    def waived_up_to(self) -> float | None:
        """Worst demand accepted by a waiver; None: not waived."""

    @property
    def without(self) -> str:
        """Load cases without valid loads, where the demand is only a bound; "": none."""


class Ranked(Protocol):
    """Check with its status, utilisation and rank among others."""

    @property
    def id(self) -> str:
        """Key of the check."""

    @property
    def status(self) -> str:
        """One of `STATUSES`."""

    @property
    def utilisation(self) -> float | None:
        """Demand over limit, infinite included; None: not evaluated."""

    @property
    def must_have(self) -> bool:
        """Whether the check decides the verdict."""

    @property
    def evidence(self) -> bool:
        """Whether the check verifies solution or input rather than the design."""

    @property
    def judged_at(self) -> str:
        """Depth of solution that the check needs, if deeper than the present one; "": judged."""


AnyRanked = TypeVar("AnyRanked", bound=Ranked)


def worst(one: Judged) -> float | None:
    """Judged demand: the worse of the nominal and the governing tolerance corner."""
    demand, corner = one.demand, one.corner_demand
    if demand is None or math.isnan(demand) or corner is None:
        return demand
    if math.isnan(corner):
        return corner
    return min(demand, corner) if one.sense == "at_least" else max(demand, corner)


def error_of_worst(one: Judged) -> float:
    """Half of the error bar of the judged demand; its share of the demand is that at nominal."""
    return abs(worst(one) or 0.0) * (one.error_share or 0.0)


def is_bound(one: Judged) -> bool:
    """Whether the demand is a bound, as data are missing, that is within the limit and so proves
    nothing.
    """
    demand, limit = worst(one), one.limit
    if not one.without or demand is None or limit is None:
        return bool(one.without)
    return math.isnan(demand) or _holds(one, demand, limit)


def evaluated(one: Judged) -> bool:
    """Whether demand and limit are known: no NaN, no infinite limit, no inconclusive bound."""
    demand, limit = worst(one), one.limit
    if demand is None or math.isnan(demand) or limit is None or not math.isfinite(limit):
        return False
    return not is_bound(one)


def utilisation(one: Judged) -> float | None:
    """Judged demand over limit, its inverse for a least value; None if one is missing.

    At <= 1 the demand is within its limit. Infinite for a demand <= 0 against a positive least
    value, and for a positive demand against a limit of zero.
    """
    return _use_of(one, worst(one) or 0.0) if evaluated(one) else None


def upper_utilisation(one: Judged) -> float | None:
    """Utilisation at the unfavourable end of the error bar; None if demand or limit is missing."""
    return _use_of(one, _upper(one)) if evaluated(one) else None


def not_proven(one: Judged, *, digits: float = 0.0, rounding: float = ROUNDING) -> bool:
    """Whether a demand within its limit has the limit inside its error bar.

    Parameters
    ----------
    digits, rounding : float   see `status`
    """
    demand, limit = worst(one), one.limit
    if demand is None or limit is None or not evaluated(one):
        return False
    if (one.error_share or 0.0) <= rounding or not _holds(one, demand, limit, digits):
        return False
    return not _holds(one, _upper(one), limit, digits)


def status(
    one: Judged, *, digits: float = 0.0, rounding: float = ROUNDING, proven: bool = True
) -> Status:
    """`pass`, `fail`, `not_evaluated`, or `waived` where the waiver covers a failed demand.

    A waiver covers it up to the end of its error bar. A missing number is never a pass.

    Parameters
    ----------
    digits : float     relative error of the numbers: 0 of a solved check, of a record that of a
                       sum of its digits
    rounding : float   share of a demand up to which its error is that of round-off
    proven : bool      False: a record states that the demand is not proven
    """
    demand, limit = worst(one), one.limit
    if demand is None or limit is None or not evaluated(one):
        return "not_evaluated"
    within = _holds(one, demand, limit, digits)
    if within and proven and not not_proven(one, digits=digits, rounding=rounding):
        return "pass"
    up_to = one.waived_up_to
    covered = up_to is not None and _holds(one, _upper(one), up_to, digits)
    return "waived" if covered else "fail"


def _upper(one: Judged) -> float:
    """End of the error bar of the worst demand towards the limit."""
    demand, error = worst(one) or 0.0, error_of_worst(one)
    return demand - error if one.sense == "at_least" else demand + error


def _use_of(one: Judged, demand: float) -> float:
    """Utilisation of the limit by a demand: demand over limit, the inverse for a least value; 0 or
    infinite where the divisor is not positive.
    """
    limit = one.limit or 0.0
    part, whole = (limit, demand) if one.sense == "at_least" else (demand, limit)
    if whole > 0:
        return part / whole
    return 0.0 if part <= whole else math.inf


def _holds(one: Judged, demand: float, limit: float, digits: float = 0.0) -> bool:
    slack = digits * max(abs(demand), abs(limit)) if digits else 0.0
    return demand >= limit - slack if one.sense == "at_least" else demand <= limit + slack


def blocks(one: Ranked) -> bool:
    """Whether a check prevents PASS: a must-have check neither passed nor waived."""
    return one.must_have and one.status not in ("pass", "waived")


def verdict(checks: Iterable[Ranked]) -> Verdict:
    """Verdict of the must-have checks: ``pass``, ``fail`` or ``incomplete``.

    `fail` if one is beyond its limit or not proven, or without checks; else `incomplete` if one
    lacks data; else `pass`.
    """
    deciding = [each.status for each in checks if each.must_have]
    if not deciding or "fail" in deciding:
        return "fail"
    return "incomplete" if "not_evaluated" in deciding else "pass"


def screen(checks: Iterable[Ranked]) -> Screen:
    """Result below the certified depth: `fail` if a must-have check fails, else `open`."""
    failed = any(each.must_have and each.status == "fail" for each in checks)
    return "fail" if failed else OPEN


def within_depth(checks: Iterable[AnyRanked]) -> tuple[AnyRanked, ...]:
    """Checks judged at the present depth of solution."""
    return tuple(each for each in checks if not each.judged_at)


def in_order(checks: Iterable[AnyRanked]) -> tuple[AnyRanked, ...]:
    """Checks sorted: not evaluated, then must-have, then by descending utilisation."""
    return tuple(sorted(checks, key=_place))


def _place(one: Ranked) -> tuple[int, float, str]:
    """Sort key of a check: not evaluated ones first, required before optional, then by falling
    utilisation.
    """
    used = one.utilisation
    if used is None:
        return 0, 0.0 if one.must_have else 1.0, one.id
    return 1, -to_rank(used), one.id


def binding(checks: Iterable[Ranked]) -> tuple[str, ...]:
    """Ids of the must-have checks that fail or lack data, in the order of the checks.

    A check that a deeper solution judges does not bind.
    """
    return tuple(each.id for each in within_depth(checks) if blocks(each))


def governing(checks: Iterable[AnyRanked]) -> AnyRanked | None:
    """Must-have check of the design with the greatest utilisation; None if none is evaluated.

    Evidence, which no change of the design moves, and waived checks do not govern. Of equal ones
    the first by its id.
    """
    ranked = [
        one
        for one in checks
        if one.must_have and not one.evidence and one.status in ("pass", "fail")
        if one.utilisation is not None
    ]
    return min(ranked, key=_place, default=None)


def governing_id(checks: Iterable[Ranked]) -> str | None:
    """Id of the governing check."""
    one = governing(checks)
    return None if one is None else one.id


def failing(checks: Iterable[AnyRanked], fail_on: str) -> tuple[AnyRanked, ...]:
    """Checks that fail or lack data, of those that count at a level of `FAIL_ON`.

    Raises
    ------
    InputError
        If the level is unknown.
    """
    if fail_on not in FAIL_ON:
        raise InputError("--fail-on", fail_on, f"one of: {', '.join(FAIL_ON)}")
    return tuple(each for each in checks if _counts(each, fail_on))


def _counts(one: Ranked, fail_on: str) -> bool:
    """Whether a check that does not pass decides the exit code at a level of `FAIL_ON`: "must",
    required checks; "open", optional ones without data as well; "any", all; "never", none.
    """
    if fail_on == "never" or one.status in ("pass", "waived"):
        return False
    if one.must_have or fail_on == "any":
        return True
    return fail_on == "open" and one.status == "not_evaluated"


def outcome(checks: Iterable[Ranked], fail_on: str) -> Verdict:
    """Verdict at a level of `FAIL_ON`: ``fail``, else ``incomplete``, else ``pass``.

    Raises
    ------
    InputError
        If the level is unknown.
    """
    counted = {each.status for each in failing(checks, fail_on)}
    if "fail" in counted:
        return "fail"
    return "incomplete" if counted else "pass"


def exit_word(verdict: Verdict | None, screen: Screen | None) -> Verdict:
    """Verdict that decides the exit code; ``incomplete`` for an open screen."""
    return verdict or ("fail" if screen == "fail" else "incomplete")

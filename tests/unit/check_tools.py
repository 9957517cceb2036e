"""How a check is tried, and every check by its id; see `test_every_check`."""

from collections.abc import Callable
from dataclasses import dataclass

import made_trial as made
from trial_variants import with_limits

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.cycle.solution import Solution

Variant = Callable[[], Solution]
BY_ID = {declared.id: declared for declared in CHECKS}


@dataclass(frozen=True)
class Tried:
    """How one check is tried: `at` a share of its limit, without its data, with a NaN, by hand.

    hand is the demand in the unit of the check's record.
    """

    at: Callable[[float], Solution]
    missing: Variant | None
    nan: Variant | None
    hand: float
    how: str
    base: Variant = made.solution


def check(name: str, solution: Solution) -> Check:
    """The check of a solution; of a part that is not described, the check of that part's data."""
    declared = BY_ID[name]
    if declared.part and not solution.machine.describes(declared.part):
        name = f"data_{declared.part}"
    result = BY_ID[name](solution)
    assert result is not None, name
    return result


def limited(name: str, put: Callable[[float], Solution], base: Variant = made.solution):
    """`at`, for a check whose limit can be put where it is wanted (SI)."""

    def at(share: float) -> Solution:
        plain = check(name, base())
        assert plain.demand is not None
        wanted = plain.demand / share if plain.sense == "at_most" else plain.demand * share
        return put(float(wanted))

    return at


def loaded(name: str, put: Callable[[float], Solution]):
    """`at`, for a check whose limit is fixed: the demand (SI) is put where it is wanted."""

    def at(share: float) -> Solution:
        plain = check(name, made.solution())
        assert plain.limit is not None
        return put(plain.limit * share if plain.sense == "at_most" else plain.limit / share)

    return at


def counted(none: Variant, one: Variant):
    """`at`, for a count whose limit is zero: nothing passes, one fails."""
    return lambda share: none() if share < 1.0 else one()


def limit_of(field: str):
    """The solution by the value of a limit of its case."""
    return lambda value: with_limits(**{field: value})


TRIED: dict[str, Tried] = {}


def tried(name: str, *args, **more) -> None:
    assert name not in TRIED
    TRIED[name] = Tried(*args, **more)


def by_limit(
    name, field, nan, hand, how, *, factor=1.0, zero=0.0, base=made.solution, missing=None
) -> None:
    """A check whose limit is one of the case's times a factor, from a zero.

    `missing` is the solution without its data, where they may be left out.
    """

    def set_limit(value):
        plain = base()
        limits = made.changed(plain.case.limits, **{field: value * factor + zero})
        return made.changed_solution(plain, case=made.changed(plain.case, limits=limits))

    tried(name, limited(name, set_limit, base), missing, nan, hand, how, base)


def unlimited(field: str) -> Variant:
    """A solution of a case that leaves out a limit which has no default."""
    return lambda: with_limits(**{field: None})

"""How a check is tried, and every check by its id; see `test_every_check`."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import made_trial as made
from trial_variants import faced, hollow, soft, with_limits

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import ALL, PARTS, PROOF, SIGNED

Evidence = Callable[[], TrialEvidence]
FUNCTIONS = (*ALL, *PROOF, *SIGNED, *PARTS)


@dataclass(frozen=True)
class Tried:
    """How one check is tried: `at` a share of its limit, without its data, with a NaN, by hand."""

    at: Callable[[float], TrialEvidence]
    missing: Evidence | None
    nan: Evidence | None
    hand: float
    how: str
    base: Evidence = made.evidence


def check(name: str, evidence: TrialEvidence) -> Check:
    result = BY_ID[name](evidence)
    assert result is not None, name
    return result


def limited(name: str, put: Callable[[float], TrialEvidence], base: Evidence = made.evidence):
    """`at`, for a check whose limit can be put where it is wanted (in the unit of the check)."""

    def at(share: float) -> TrialEvidence:
        plain = check(name, base())
        assert plain.demand is not None
        wanted = plain.demand / share if plain.sense == "at_most" else plain.demand * share
        return put(float(wanted))

    return at


def loaded(name: str, put: Callable[[float], TrialEvidence]):
    """`at`, for a check whose limit is fixed: the demand is put where it is wanted."""

    def at(share: float) -> TrialEvidence:
        plain = check(name, made.evidence())
        assert plain.limit is not None
        return put(plain.limit * share if plain.sense == "at_most" else plain.limit / share)

    return at


def counted(none: Evidence, one: Evidence):
    """`at`, for a count whose limit is zero: nothing passes, one fails."""
    return lambda share: none() if share < 1.0 else one()


def limit_of(field: str, si: float = 1.0):
    return lambda value: with_limits(**{field: value * si})


TRIED: dict[str, Tried] = {}


def tried(name: str, *args, **more) -> None:
    assert name not in TRIED
    TRIED[name] = Tried(*args, **more)


def by_limit(name, field, si, nan, hand, how, base=made.evidence, missing=None) -> None:
    """A check whose limit is one of the case's; `missing` where its data may be left out."""

    def set_limit(value):
        return replace(base(), case=limit_of(field, si)(value).case)

    tried(name, limited(name, set_limit, base), missing, nan, hand, how, base)


def unlimited(field: str) -> Evidence:
    """A trial of a case that leaves out a limit which has no default."""
    return lambda: with_limits(**{field: None})


def _ids() -> dict[str, Callable[[TrialEvidence], Check | None]]:
    """Every function by the id of its check, whichever of the trials it applies to."""
    trials = [each() for each in (made.evidence, hollow, soft, faced)]
    results = {function: [function(trial) for trial in trials] for function in FUNCTIONS}
    return {
        next(each.id for each in applied if each is not None): function
        for function, applied in results.items()
    }


BY_ID = _ids()

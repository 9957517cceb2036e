"""How a check is tried, and every check by its id; see `test_every_check`."""

from collections.abc import Callable
from dataclasses import dataclass

import full_trial as full
from trial_variants import (
    faced,
    hollow,
    soft,
    with_limits,
)

from pipeline.checks import proof
from pipeline.checks.check import Check
from pipeline.checks.everything import ALL, PARTS, PROOF, SIGNED
from pipeline.checks.trial import TrialEvidence

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
    base: Evidence = full.evidence


def function_of(name: str):
    return BY_ID[name]


def check(name: str, evidence: TrialEvidence) -> Check:
    found = function_of(name)(evidence)
    assert found is not None, name
    return found


def limited(name: str, put: Callable[[float], TrialEvidence], base: Evidence = full.evidence):
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
        plain = check(name, full.evidence())
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


def by_limit(name, field, si, nan, hand, how, base=full.evidence, put=None) -> None:
    """A check whose limit is one of the case's."""
    wrap = put or (lambda given: given)

    def set_limit(value):
        return wrap(limit_of(field, si)(value))

    tried(
        name,
        limited(name, set_limit, base),
        lambda: wrap(with_limits(**{field: None})),
        nan,
        hand,
        how,
        base,
    )


def _ids() -> dict[str, Callable[[TrialEvidence], Check | None]]:
    """Every function by the id of its check, whichever of the trials makes it speak."""
    found = {}
    trials = (full.evidence, hollow, soft, faced)
    for function in FUNCTIONS:
        if function is proof.mesh_reaction:
            continue
        for trial in trials:
            try:
                made = function(trial())
            except AttributeError:  # a face has no pitch curve of a roller
                continue
            if made is not None:
                found[made.id] = function
                break
        else:
            found[function.__name__] = function
    return found


BY_ID = _ids()

"""No worse machine has a better verdict: tighter limits, wider tolerances, more load cases."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from camwright.pipeline.base.verdict import verdict, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.limits import LIMITS, OVERSPEED
from camwright.pipeline.checks.check import Check
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.solver import solve

EVERY_PART = Path(__file__).parents[1] / "data" / "every_part.toml"
RANK = {"pass": 0, "not_evaluated": 1, "fail": 2}
# A greater value asks for more, though the demand is bounded from above.
REQUIREMENTS = {"overspeed", "target_life", "end_mean_length"}


def tables() -> dict[str, Any]:
    """The case that describes every part; a jam index and a wear depth fail."""
    read = tomllib.loads(EVERY_PART.read_text(encoding="utf-8"))
    read["solver"]["positions"] = 36
    read["tolerances"]["samples"] = 4
    read["limits"] |= {"jam_index": 0.01, "wear_depth": "0.0001 mm"}
    return read


def judged(case: Case) -> dict[str, Check]:
    contour = case.contour(given_lift(case))
    checks = solve(case, contour, tier=Tier.PREVIEW, torques={}, corners=True).checks
    return {one.id: one for one in within_depth(checks)}


@cache
def base() -> tuple[Case, dict[str, Check]]:
    case = case_of(tables())
    return case, judged(case)


def with_limits(case: Case, random: np.random.Generator) -> Case:
    """Half of the limits tightened, each by a random factor."""
    changed = {}
    for name, row in LIMITS.items():
        value = case.limits[row]
        if value is None or random.random() < 0.5:
            continue
        share, most = random.uniform(1.0, 2.0), min(row.quantity.at_most, row.quantity.below)
        if row.sense == "at_most" and not name.endswith("_safety") and name not in REQUIREMENTS:
            tighter = value / share
        else:
            is_share = most <= 1.0 and not row.quantity.unit
            tighter = 1.0 - (1.0 - value) / share if is_share else value * share
        if row.quantity.holds(tighter):
            changed[name] = tighter
    return case.model_copy(update={"limits": case.limits.model_copy(update=changed)})


def with_tolerances(case: Case, random: np.random.Generator) -> Case:
    """Every tolerance widened, each by a random factor."""
    names = ("friction", "mass", "inertia", "phase")
    wide = {n: min(getattr(case.tolerances, n) * random.uniform(1.0, 1.5), 0.95) for n in names}
    return case.model_copy(update={"tolerances": case.tolerances.model_copy(update=wide)})


def with_load_case(case: Case, random: np.random.Generator) -> Case:
    """One more load case, at a speed up to over-speed."""
    state = case.load_cases[0]
    speed = random.uniform(0.1, 1.0) * (case.limits[OVERSPEED] or state.speed)
    more = state.model_copy(update={"name": "more", "speed": speed, "ripple_weight": 0.0})
    return case.model_copy(update={"load_cases": (*case.load_cases, more)})


def improved(change, seed: int) -> dict[str, tuple[str, str]]:
    """Status before and after of the checks that a worse machine passes better."""
    case, before = base()
    after = judged(change(case, np.random.default_rng(seed)))
    assert verdict(before.values()) == "fail"
    assert verdict(after.values()) == "fail"
    return {
        name: (one.status, after[name].status)
        for name, one in before.items()
        if RANK[after[name].status] < RANK[one.status]
    }


def test_the_case_fails_in_what_was_made_to_fail():
    assert {name for name, one in base()[1].items() if one.blocks} >= {"jam_index", "guide_wear_A"}


@pytest.mark.parametrize("change", [with_limits, with_tolerances, with_load_case])
def test_a_worse_machine_has_no_better_verdict(change):
    assert not improved(change, 1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 10))
@pytest.mark.parametrize("change", [with_limits, with_tolerances, with_load_case])
def test_no_worse_machine_has_a_better_verdict(change, seed):
    assert not improved(change, seed)

"""Rounds of synthesis and correction: one loop, each caller with its own end."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from camwright.pipeline import iteration, preview
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.smoothing import synthesis_rounds
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import redrawn
from camwright.pipeline.smoothing.synthesis_problem import Design
from camwright.pipeline.smoothing.synthesis_rounds import Round, rounds

PRESS = Path(__file__).parents[2] / "cases" / "machines" / "press.toml"


@pytest.fixture(scope="module")
def case() -> Case:
    """A case with few splines, corrected by its solutions alone and for no corners."""
    values = {"coefficients": 24, "starts": 1, "corners": False, "correction_margin": 0.0}
    stated = {f"smoothing.{name}": value for name, value in values.items()}
    stated["solver.max_trials"] = preview._PREVIEW_ROUNDS
    return with_values(read_case(PRESS).with_positions(72), stated)


def solved(case: Case, design: Design) -> Solution:
    drawn = redrawn(case, design.variables)
    contour = drawn.contour(design.lift())
    return solution(drawn, contour, Tier.PREVIEW, torques=engine_torques(case))


def test_preview_and_run_take_the_same_rounds(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both end where a round changes no limit, or after the same number of rounds."""
    taken: list[Round] = []

    def recorded(*arguments: Any, **options: Any) -> Iterator[Round]:
        for each in rounds(*arguments, **options):
            taken.append(each)
            yield each

    monkeypatch.setattr(synthesis_rounds, "rounds", recorded)
    monkeypatch.setattr(iteration, "rounds", recorded)
    trial = preview.preview_case(case, corners=False)
    previewed, taken = taken, []
    torques = engine_torques(case)
    points = iteration.trials_of(case, torques, tier=Tier.PREVIEW).points
    assert len(previewed) == len(taken) == len(points) > 1
    for one, other in zip(previewed, taken, strict=True):
        np.testing.assert_array_equal(one.design.coefficients, other.design.coefficients)
        assert one.design.variables == other.design.variables
        assert one.comparisons[-1].shifts == other.comparisons[-1].shifts
    after = trial.cycles[0].turn.torque_after
    assert after is not None and float(np.std(after)) in [each.ripple for each in points]


def test_the_caller_ends_the_rounds(case: Case) -> None:
    """Each round starts from the design before, with what its solution corrects."""
    made = rounds(problem_of(case, engine_torques(case)))
    first = next(made)
    assert (first.number, first.rises, first.conflicts) == (1, False, False)
    comparison = first.compare(solved(case, first.design))
    second = next(made)
    assert second.number == 2 and second.comparisons == [comparison]
    assert second.problem.seed is first.design.coefficients
    assert second.problem.scenarios[0].correction is not first.problem.scenarios[0].correction
    made.close()


def test_late_splines_rise_with_the_first_correction(case: Case) -> None:
    problem = replace(problem_of(case, engine_torques(case)), convergence=0.5)
    made = rounds(problem, late=True)
    first = next(made)
    assert first.rises and first.design.coefficients.size == problem.coefficients
    first.compare(solved(case, first.design))
    second = next(made)
    assert not second.rises and second.design.coefficients.size > problem.coefficients
    assert second.problem.coefficients == second.design.coefficients.size


def test_a_round_holds_no_solution(case: Case) -> None:
    made = rounds(problem_of(case, engine_torques(case)))
    each = next(made)
    one = solved(case, each.design)
    each.compare(one)
    held = weakref.ref(one)
    del one
    gc.collect()
    assert held() is None
    assert next(made).number == 2

"""The synthesis of a case with each roller of the catalogue, for a case that has no answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from camwright.geometry.errors import InputError
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.substitution import with_roller
from camwright.pipeline.case.case import Case
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.synthesis_problem import Problem


def roller_problems(
    case: Case, torques: Mapping[str, Torque], asked: Problem
) -> Iterator[tuple[str, Problem]]:
    """Name and problem of every roller that fits into the case, the smallest first.

    Parameters
    ----------
    asked : Problem   of the case; its corrections are taken over

    Raises
    ------
    InputError
        For cards beside the case that cannot be read.
    """
    folder = _folder(case)
    rollers = catalogue_of(folder).rollers
    corrections = {item.name: item.correction for item in asked.scenarios}
    for name in sorted(rollers, key=lambda name: (rollers[name].outer_diameter, rollers[name].C0)):
        try:
            problem = problem_of(with_roller(case, name, rollers[name], folder), torques)
        except InputError:  # too large for bore or guides
            continue
        scenarios = tuple(
            replace(item, correction=corrections[item.name]) for item in problem.scenarios
        )
        yield name, replace(problem, scenarios=scenarios)


def _folder(case: Case) -> Path | None:
    """Where the case lies, with the cards beside it; None for a case that is no file."""
    try:
        return case.path("")
    except InputError:
        return None

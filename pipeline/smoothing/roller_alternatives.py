"""Synthesis problems of an infeasible case with the rollers of the catalogue."""

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
    case: Case, torques: Mapping[str, Torque], original: Problem
) -> Iterator[tuple[str, Problem]]:
    """Name and problem of each roller that fits into the case, the smallest first.

    Parameters
    ----------
    original : Problem   of the case; its corrections are applied to the alternatives

    Raises
    ------
    InputError
        If cards in the folder of the case cannot be read.
    """
    folder = _folder(case)
    rollers = catalogue_of(folder).rollers
    corrections = {item.name: item.correction for item in original.scenarios}
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
    """Folder of the case file and its cards; None for a case built in Python."""
    try:
        return case.path("")
    except InputError:
        return None

"""Rounds of synthesis and correction: each solved cam corrects the next problem.

The optimiser is imported with this module.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count

from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.checks.check import Check
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.fe_correction import Comparison, compared, corrected
from camwright.pipeline.smoothing.multistart import (
    REMOVABLE,
    Explored,
    continued,
    explored,
    resolved,
)
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem


@dataclass(frozen=True, eq=False)
class Round:
    """Design of one round, to be solved and compared before the next round.

    It holds no solution: only one is in memory at a time.

    Parameters
    ----------
    number : int         from 1
    problem : Problem    of the design, with its corrections
    design : Design
    first : Explored     search of the first round, without corrections
    rises : bool         the number of splines is still to rise
    comparisons : list   of the cams of all rounds in order; that of this round is last, once made
    """

    number: int
    problem: Problem
    design: Design
    first: Explored
    rises: bool
    comparisons: list[Comparison]

    @property
    def conflicts(self) -> bool:
        """Whether the limits conflict without corrections, at lower bounds of the demands."""
        return not self.first.design.feasible

    def compare(self, solved: Solution, checks: Sequence[Check] = ()) -> Comparison:
        """Compare the solved cam of the design; see `compared`."""
        self.comparisons.append(compared(self.problem, self.design, solved, checks))
        return self.comparisons[-1]

    def corrected(self) -> Problem:
        """Problem of the next round, after the comparison."""
        return corrected(self.problem, self.design, self.comparisons)


def rounds(
    problem: Problem,
    *,
    starts: int = 1,
    late: bool = False,
    guided: Callable[[Design], Solution] | None = None,
    progress: Progress = SILENT,
) -> Iterator[Round]:
    """Endless rounds of synthesis; the caller compares each solved cam with its synthesis, which
    corrects the next, and stops.

    Parameters
    ----------
    problem : Problem     of the case
    starts : int          of the first search
    late : bool           raise the number of splines once, with the first correction or where more
                          splines may remove what exceeds a limit; else in the first search
    guided : callable     design -> its preview, with guides of finite length and Hertz contact,
                          which corrects the first design at once; None: it is not corrected
    progress : Progress   told each stage
    """
    rising = late and problem.convergence is not None
    comparisons: list[Comparison] = []
    progress.stage("trial 1: synthesis")
    first = explored(replace(problem, convergence=None) if late else problem, starts)
    design, problem = first.design, replace(problem, coefficients=first.splines)
    if guided is not None and design.feasible:
        progress.stage("trial 1: preview")
        problem = corrected(problem, design, [compared(problem, design, guided(design))])
        design = synthesise(problem)
    for number in count(1):
        if rising and (comparisons or _removable(design)):
            design, rising = resolved(problem, design)[0][-1], False
            problem = replace(problem, coefficients=design.coefficients.size)
        one = Round(number, problem, design, first, rising, comparisons)
        yield one
        progress.stage(f"trial {number + 1}: synthesis")
        problem = one.corrected()
        design = continued(problem, design) if rising else synthesise(problem)


def _removable(design: Design) -> bool:
    """Whether more splines may remove what a design exceeds the limits by."""
    given_up = design.stuck or design.ended or design.violation > REMOVABLE
    return not (design.feasible or given_up)

"""CPU seconds of a synthesis, of one from all starts, and of finite elements in the loop.

python benchmarks/synthesis.py [positions]; 0 positions leave the loop out.

The synthesis has 96 coefficients, 720 points and one load case; all starts are those of the
redesigned GX120 at its tolerance corners; both are the least of three rounds. The loop is the whole
run of the soft spring's case: starts, trials, certificate, fields, report. The budgets are told in
solutions of 1000 dense equations on the same core, so that they hold on another machine: 2 s, 3 s
and 90 s where one takes 20 ms. Beyond a budget the exit code is 1.
"""

from __future__ import annotations

import resource
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from parts import dense_solution

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.run import run_case
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.multistart import explored
from camwright.pipeline.smoothing.problem_setup import problem_of

Made = TypeVar("Made")
ROOT = Path(__file__).resolve().parent.parent
POSITIONS = 720
ROUNDS = 3
SYNTHESIS_BUDGET, STARTS_BUDGET, LOOP_BUDGET = 100.0, 150.0, 4500.0  # dense solutions


def cpu() -> float:
    """CPU seconds of this process and of those it waited for."""
    spent = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(each.ru_utime + each.ru_stime for each in spent)


def measured(work: Callable[[], Made]) -> tuple[float, float, Made]:
    """CPU seconds of a dense solution and of the work, the least of the rounds, and its result.

    Both in turn: what else runs on the machine slows both alike.
    """
    units, spent = [], []
    for _ in range(ROUNDS):
        units.append(dense_solution())
        start = cpu()
        made = work()
        spent.append(cpu() - start)
    return min(units), min(spent), made


def main() -> int:
    positions = int(sys.argv[1]) if len(sys.argv) > 1 else POSITIONS
    case = read_case(ROOT / "tests" / "data" / "soft_spring.toml")
    problem = problem_of(case, engine_torques(case))
    alone = replace(problem, coefficients=96, scenarios=problem.scenarios[:1])
    unit, seconds, design = measured(lambda: synthesise(alone))
    over = seconds > SYNTHESIS_BUDGET * unit
    print(
        f"synthesis: {seconds:.2f} s, {design.steps} steps, ripple left {design.ripple:.5f}; "
        f"{seconds / unit:.0f} dense solutions of {1e3 * unit:.1f} ms, "
        f"budget {SYNTHESIS_BUDGET:.0f}"
    )
    signed = read_case(ROOT / "cases" / "gx120-redesign.toml")
    problem = problem_of(signed, engine_torques(signed))
    unit, seconds, first = measured(lambda: explored(problem, signed.smoothing.starts))
    over = over or seconds > STARTS_BUDGET * unit
    print(
        f"all starts: {seconds:.2f} s, {first.starts.sentence}, {first.resolution.sentence}; "
        f"{seconds / unit:.0f} dense solutions, budget {STARTS_BUDGET:.0f}"
    )
    if positions:
        start = cpu()
        with tempfile.TemporaryDirectory() as folder:
            run = run_case(case, Path(folder) / "run", positions=positions, progress=Silent())
        seconds = cpu() - start
        over = over or seconds > LOOP_BUDGET * unit
        print(
            f"loop: {seconds:.1f} s, {positions} positions, {len(run.trials)} trials, verdict "
            f"{run.verdict}; {seconds / unit:.0f} dense solutions, budget {LOOP_BUDGET:.0f}"
        )
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())

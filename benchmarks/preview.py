"""CPU seconds of the preview of the GX120 case: python benchmarks/preview.py

`camwright --help` and `camwright check` as processes, warm; in this process the preview at 180
angles without its tolerance corners, per load case, and the corners. The budgets are told in
solutions of 1000 dense equations on the same core; beyond one the exit code is 1.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

from parts import ROUNDS, dense_solution, seconds

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.tolerance_corners import outcomes
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve

CASE = Path(__file__).resolve().parent.parent / "cases" / "gx120.toml"
POSITIONS = 180
BUDGETS = {"--help": 7.0, "check": 96.0, "preview per load case": 2.8, "corners": 40.0}


def process_seconds(*arguments: str) -> float:
    """CPU seconds of the command line in a process of its own, the least of some rounds."""
    spent = []
    for _ in range(ROUNDS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-m", "camwright", *arguments],
            stdout=subprocess.DEVNULL,
            env=os.environ,
            check=False,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(spent[1:])


def main() -> int:
    unit = dense_solution()
    case = read_case(CASE)
    torques = engine_torques(case)
    contour = case.contour(cam_lift(case, torques))

    def preview() -> int:
        trial = solve(
            case,
            contour,
            tier=Tier.PREVIEW,
            torques=torques,
            positions=POSITIONS,
            corners=False,
        )
        return len(trial.cycles)

    spent = {
        "--help": process_seconds("--help"),
        "check": process_seconds("check", str(CASE)),
        "preview per load case": seconds(preview) / preview(),
        "corners": seconds(lambda: outcomes(case, torques, contour)),
    }
    print(f"dense solution {1e3 * unit:.1f} ms")
    for name, value in spent.items():
        ratio = value / unit
        print(f"{name:>22} {1e3 * value:7.0f} ms, {ratio:5.1f} solutions, budget {BUDGETS[name]:g}")
    return int(any(value > BUDGETS[name] * unit for name, value in spent.items()))


if __name__ == "__main__":
    sys.exit(main())

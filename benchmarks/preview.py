"""CPU seconds of the preview of the GX120 case: python benchmarks/preview.py

`camwright --help` and `camwright check` as processes, warm; in this process the preview at 180
angles without its tolerance corners, per load case, and the corners. The budgets are told in
rounds of `mixed_work` on the same core: 0.2 s, 1.6 s, 70 ms and 0.8 s where one takes 50 ms. Beyond
one the exit code is 1.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

from parts import ROUNDS, mixed_work, seconds

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.tolerance_corners import outcomes
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve

CASE = Path(__file__).resolve().parent.parent / "cases" / "gx120.toml"
POSITIONS = 180
BUDGETS = {"--help": 4.0, "check": 32.0, "preview per load case": 1.4, "corners": 16.0}


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
    unit = mixed_work()
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
        "corners": seconds(lambda: outcomes(case, machines(case, torques), contour)),
    }
    print(f"mixed work {1e3 * unit:.1f} ms")
    for name, value in spent.items():
        ratio = value / unit
        print(f"{name:>22} {1e3 * value:7.0f} ms, {ratio:5.1f} rounds, budget {BUDGETS[name]:g}")
    return int(any(value > BUDGETS[name] * unit for name, value in spent.items()))


if __name__ == "__main__":
    sys.exit(main())

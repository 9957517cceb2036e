"""CPU seconds of loads, guides and parts of one cam turn: python benchmarks/parts.py [positions]

Loads in balance with the finite guides at nominal, least and greatest friction, the guides without
play, the elastic stem on the varying speed, and all other parts. The budget is told in solutions
of 1000 dense equations on the same core, so that it holds on another machine; beyond it the exit
code is 1.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.cycle.part_loads import part_loads
from camwright.pipeline.cycle.turn import Turn, turn
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).resolve().parent.parent
POSITIONS = 720
BUDGET = 45.0  # dense solutions, for 720 positions of it all
ROUNDS = 5


def seconds(work: Callable[[], object]) -> float:
    """CPU seconds, the least of some rounds."""
    found = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return min(found)


def main() -> int:
    positions = int(sys.argv[1]) if len(sys.argv) > 1 else POSITIONS
    case = read_case(ROOT / "cases" / "gx120.toml")
    machine, torques = machines(case)[0], engine_torques(case)
    contour = case.contour(cam_lift(case, torques))
    random = np.random.default_rng(0)
    matrix, right = random.normal(size=(1000, 1000)), random.normal(size=1000)
    unit = seconds(lambda: np.linalg.solve(matrix, right))

    def turned() -> Turn:
        return turn(machine, contour, torques[machine.load_case], positions)

    loaded = turned()
    loads = seconds(turned)
    parts = seconds(lambda: part_loads(loaded, contour, machine.contact_width))
    ratio = (loads + parts) / unit
    print(f"{positions} positions: loads and guides {loads:.3f} s, parts {parts:.3f} s")
    print(f"{ratio:.0f} dense solutions of {1e3 * unit:.1f} ms, budget {BUDGET:.0f}")
    return 0 if ratio <= BUDGET * max(positions / POSITIONS, 1.0) else 1


if __name__ == "__main__":
    sys.exit(main())

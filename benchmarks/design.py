"""CPU seconds of the design of a pedalled machine: python benchmarks/design.py

A torque of two pulses a turn at 60 rpm, for which four fifths of the time are syntheses and
exchanges of parts, with an empty cache; all processes count. The budget is in rounds of
`mixed_work`, measured before and after: 120 s where one takes 50 ms. The designs that are drafted
and solved in full have budgets of their own. Beyond one the exit code is 1.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
from parts import mixed_work

BUDGET = 2400.0  # rounds of mixed work
DRAFTED, SOLVED = 16, 26  # designs: by the synthesis alone, and with their checks


def main() -> int:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        angle = np.arange(0.0, 360.0, 10.0)
        turn = np.radians(angle)
        torque = 25.0 - 20.0 * np.cos(2.0 * turn) - 2.0 * np.cos(turn) + 3.0 * np.sin(4.0 * turn)
        rows = (f"{at:g};{value:.2f}\n" for at, value in zip(angle, torque, strict=True))
        table = folder / "pedal.csv"
        table.write_text("crank angle (deg);torque (N m)\n" + "".join(rows), encoding="utf-8")
        before = mixed_work()
        command = [sys.executable, "-m", "camwright", "design", "machine", table.name,
                   "--speed", "60 rpm", "--out", "pedal.toml"]  # fmt: skip
        cache = {"CAMWRIGHT_CACHE": str(folder / "cache")}
        subprocess.run(command, cwd=folder, env=os.environ | cache, check=True, capture_output=True)
        work = 0.5 * (before + mixed_work())
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        stored = (folder / "pedal_design" / "solved").iterdir()
        kinds = Counter(path.name.split("-")[0] for path in stored)
    seconds, solved = used.ru_utime + used.ru_stime, kinds["preview"] + kinds["nominal"]
    print(f"design  {seconds:6.1f} s CPU, one round of mixed work {1e3 * work:.1f} ms")
    print(f"rounds  {seconds / work:6.0f}, budget {BUDGET:g}")
    print(f"drafted {kinds['draft']:6d} designs, budget {DRAFTED}")
    print(f"solved  {solved:6d} designs, budget {SOLVED}")
    beyond = seconds / work > BUDGET or kinds["draft"] > DRAFTED or solved > SOLVED
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())

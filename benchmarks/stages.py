"""Seconds of a run of the GX120 case by the command line: python benchmarks/stages.py

Warm, with its three load cases, and without over-speed: the load case of the design and the
standstill, which a cam drawn from a torque always has. Time of each stage, wall-clock and CPU
time. The budgets are in rounds of `mixed_work` on one core: 20 s and 40 s of CPU, and 18 s and
30 s, where one takes 50 ms. Beyond one the exit code is 1.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from parts import mixed_work

CASE = Path(__file__).resolve().parent.parent / "cases" / "gx120.toml"
BUDGETS = {"three load cases": (400.0, 800.0), "without over-speed": (360.0, 600.0)}


def main() -> int:
    text = CASE.read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("overspeed = ")]
    texts = dict(zip(BUDGETS, (text, "\n".join(lines) + "\n"), strict=True))
    unit = mixed_work()
    print(f"mixed work {1e3 * unit:.1f} ms")
    over = False
    with tempfile.TemporaryDirectory() as name:
        for words, content in texts.items():
            case = Path(name) / "case.toml"
            case.write_text(content, encoding="utf-8")
            run(case, Path(name) / "cold")  # fills the caches
            wall, cpu = run(case, Path(name) / words)
            stages(Path(name) / words)
            ratios = wall / unit, cpu / unit
            print(
                f"{words}: {wall:.1f} s, {cpu:.1f} s of CPU; {ratios[0]:.0f} and {ratios[1]:.0f} "
                f"rounds, budgets {BUDGETS[words][0]:g} and {BUDGETS[words][1]:g}"
            )
            over = over or any(a > b for a, b in zip(ratios, BUDGETS[words], strict=True))
    return int(over)


def run(case: Path, out: Path) -> tuple[float, float]:
    """Wall-clock and CPU time of a run, s."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "-m", "camwright", "run", str(case), "--out", str(out), "--replace"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run(command, env=os.environ, check=True, **quiet)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def stages(out: Path) -> None:
    """Print the time of each stage of a run, and the size of its folder."""
    for stage, seconds in json.loads((out / "run.json").read_text())["timings_s"].items():
        print(f"{stage:>18} {seconds:8.2f} s")
    files = [path for path in out.rglob("*") if path.is_file()]
    print(f"{len(files)} files, {sum(path.stat().st_size for path in files) / 1e6:.0f} MB")


if __name__ == "__main__":
    sys.exit(main())

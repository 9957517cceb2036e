"""Cost of a study beside what it may cost: python benchmarks/study.py

Screening of 10,000 designs all in (cluster, Parquet, dataset) as a ratio to the arrays alone;
memory against 1,000 designs; previews by two processes against one. Each is a ratio of two figures
of this run; wall times are those of a machine with nothing else to do, and what other processes
took of it is printed beside them.
"""

from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import psutil

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.screening.design_screening import screen_designs

ROOT = Path(__file__).resolve().parent.parent
SECONDS, ALL_IN, MEMORY, EFFICIENCY = 20.0, 4.0, 1.10, 0.85
DESIGNS, PREVIEWS = 10_000, 240
STUDY = """
name = "benchmark"
case = "case.toml"
depth = "{depth}"
corners = false
[[factor]]
key = "spring.rate"
range = {{ low = "20 kN/m", high = "30 kN/m" }}
[[factor]]
key = "cam.prime_radius"
range = {{ low = "45 mm", high = "55 mm" }}
[sampling]
method = "sobol"
count = {count}
"""


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_bytes((ROOT / "cases" / "gx120.toml").read_bytes())
        alone = arrays(DESIGNS)
        few = studied(folder, "screening", DESIGNS // 10, jobs=2)
        many = studied(folder, "screening", DESIGNS, jobs=2)
        told(f"{DESIGNS} designs, wall", many.wall, "s", SECONDS)
        told("computing over arrays", many.cpu / alone, "", ALL_IN)
        told("memory over a tenth", many.memory / few.memory, "", MEMORY)
        studied(folder, "screening", PREVIEWS, jobs=1)  # draws the sample that both then read
        one, two = (studied(folder, "preview", PREVIEWS, jobs=jobs) for jobs in (1, 2))
        share = one.wall / (2.0 * two.wall)
        print(f"{'efficiency of two':>24} {share:8.2f}      at least {EFFICIENCY:g}")
        others = [f"{each.others:.1f}" for each in (few, many, one, two)]
        print(f"{'CPU of others':>24} {', '.join(others)} s; walls hold below 1 s")


def arrays(count: int) -> float:
    """CPU time of the arrays of a screening, s."""
    case = read_case(ROOT / "cases" / "gx120.toml")
    draw = np.random.default_rng(1)
    factors = {
        "spring.rate": draw.uniform(2e4, 3e4, count),
        "cam.prime_radius": draw.uniform(0.045, 0.055, count),
    }
    start = time.process_time()
    screen_designs(case, factors)
    return time.process_time() - start


class Cost:
    """Wall and CPU time, s; greatest memory of each process, summed, bytes; CPU of others, s."""

    def __init__(self, wall: float, cpu: float, memory: float, others: float) -> None:
        self.wall, self.cpu, self.memory, self.others = wall, cpu, memory, others


def studied(folder: Path, depth: str, count: int, jobs: int) -> Cost:
    """Cost of a study, all in."""
    name = f"{depth}_{count}_{jobs}"
    (folder / f"{name}.toml").write_text(STUDY.format(depth=depth, count=count))
    arguments = ["study", "run", f"{name}.toml", "--out", name, "--jobs", str(jobs)]
    start, busy = time.perf_counter(), cpu_of_all()
    peaks: dict[int, float] = {}
    spent: dict[int, float] = {}
    with subprocess.Popen(
        [sys.executable, "-m", "camwright", *arguments],
        cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    ) as process:  # fmt: skip
        watched, looked = psutil.Process(process.pid), 0.0
        while process.poll() is None:
            note_peak(process.pid, peaks)  # often: that of its last moments counts
            if time.perf_counter() - looked > 0.5:  # takes milliseconds of a core that it needs
                looked = time.perf_counter()
                note(watched, peaks, spent)
            time.sleep(0.02)
    wall = time.perf_counter() - start
    assert process.returncode == 0
    cpu = sum(spent.values())  # those that solve are ended, and counted by no process above them
    return Cost(wall, cpu, sum(peaks.values()), cpu_of_all() - busy - cpu)


def cpu_of_all() -> float:
    """CPU time of all processes of the machine since its start, s."""
    times = psutil.cpu_times()
    return float(sum(times) - times.idle - getattr(times, "iowait", 0.0))


def note(process: psutil.Process, peaks: dict[int, float], spent: dict[int, float]) -> None:
    """Greatest memory, bytes, and CPU time, s, of a process and those below it, by number."""
    with contextlib.suppress(psutil.Error, OSError):
        for each in (process, *process.children(recursive=True)):
            note_peak(each.pid, peaks)
            times = each.cpu_times()
            spent[each.pid] = times.user + times.system


def note_peak(number: int, peaks: dict[int, float]) -> None:
    """Greatest memory of a process so far, bytes."""
    with contextlib.suppress(OSError):
        status = Path(f"/proc/{number}/status").read_text().split("VmHWM:")
        if len(status) == 2:  # a process that has ended states none
            peaks[number] = 1024.0 * float(status[1].split()[0])


def told(name: str, value: float, unit: str, budget: float) -> None:
    print(f"{name:>24} {value:8.2f} {unit:<4} {value / budget:6.0%} of {budget:g} {unit}")


if __name__ == "__main__":
    main()

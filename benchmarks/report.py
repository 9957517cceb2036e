"""Cost of a report beside what it may cost: python benchmarks/report.py [RUN]

Of a run folder; by default of runs/gx120, which ``make run`` makes, else of a run of 72 positions
made here: seconds and memory of the
whole report, size of the page, and how soon a browser has it: the load event, the first
plot and the last that answer. Work is done on a copy. Times by the clock are those of a machine
with nothing else to do; its load is told beside them.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
from browser_fixture import chromium

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.run import run_case
from camwright.reports.page import PAGE

ROOT = Path(__file__).resolve().parent.parent
SECONDS, MEBIBYTES, MEGABYTES, OPEN_SECONDS = 40.0, 3072.0, 8.0, 2.0
WATCH = """
window.plots = {};
new MutationObserver(() => {
  const live = [...document.querySelectorAll(".live")];
  const done = live.filter((place) => place.dataset.drawn === "done");
  if (done.length) window.plots.first ??= performance.now();
  if (live.length && done.length === live.length) window.plots.last ??= performance.now();
}).observe(document, {childList: true, subtree: true, attributeFilter: ["data-drawn"]});
"""
TIMES = """() => { const page = performance.getEntriesByType("navigation")[0];
  return [page.loadEventEnd, window.plots.first, window.plots.last]; }"""


def main() -> None:
    run = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "runs" / "gx120"
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "run"
        if (run / "run.json").is_file():
            shutil.copytree(run, copy)
        else:
            case = read_case(ROOT / "cases" / "gx120.toml")
            run_case(case, copy, positions=72, progress=Silent())
        start = time.perf_counter()
        subprocess.run([sys.executable, "-m", "camwright", "report", str(copy)], check=True)
        told("report, by the clock", time.perf_counter() - start, "s", SECONDS)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        told("report, computing", used.ru_utime + used.ru_stime, "s", SECONDS)
        told("greatest process", used.ru_maxrss / 1024, "MiB", MEBIBYTES)
        told("page", (copy / PAGE).stat().st_size / 1e6, "MB", MEGABYTES)
        print(f"{'others waiting':>20} {max(os.getloadavg()[0] - 1, 0):8.1f} processes")
        if shutil.which("chromium") is not None:
            for name, seconds in opened(copy / PAGE).items():
                told(name, seconds, "s", OPEN_SECONDS)


def opened(file: Path) -> dict[str, float]:
    """Seconds from the call of a page in a fresh browser, 1440 pixels wide."""
    with chromium() as tab:
        tab.page.add_init_script(WATCH)
        tab.open(file, 1440, 900)
        tab.page.locator(".live:not([data-drawn='done'])").first.wait_for(state="detached")
        load, first, last = tab.evaluate(TIMES)
    return {"load event": load / 1e3, "first plot": first / 1e3, "last plot": last / 1e3}


def told(name: str, value: float, unit: str, budget: float) -> None:
    print(f"{name:>20} {value:8.2f} {unit:<4} {value / budget:6.0%} of {budget:g} {unit}")


if __name__ == "__main__":
    main()

"""Seconds per stage of the GX120 case: python benchmarks/stages.py [positions]"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.run import run_case
from camwright.reports.sections import report

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    positions = int(sys.argv[1]) if len(sys.argv) > 1 else 72
    case = read_case(ROOT / "cases" / "gx120.toml")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "gx120"
        run = run_case(case, out, positions=positions, progress=Silent(), report=report)
    print(f"{case.name}, {positions} positions, {len(run.trials)} trials")
    for stage, seconds in run.summary["timings_s"].items():
        print(f"{stage:>18} {seconds:8.2f} s")


if __name__ == "__main__":
    main()

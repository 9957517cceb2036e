"""CPU per design of the screening against a preview: python benchmarks/screening.py [designs]"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs

ROOT = Path(__file__).resolve().parent.parent
LINEAR = 1.1  # per design, the greater number over the smaller
FASTER = 100.0  # than a preview


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 4000
    case = read_case(ROOT / "cases" / "gx120.toml")
    draw = np.random.default_rng(1)
    factors = {
        "spring.rate": draw.uniform(15e3, 40e3, count),
        "spring.preload": draw.uniform(150.0, 600.0, count),
        "cam.prime_radius": draw.uniform(0.045, 0.07, count),
        "roller.radius": draw.uniform(0.007, 0.012, count),
    }

    def seconds(designs: int) -> float:
        start = time.process_time()
        screen_designs(case, {key: values[:designs] for key, values in factors.items()})
        return (time.process_time() - start) / designs

    seconds(2)  # imports, engine torque, tables of the guides
    few, many = seconds(count // 4), seconds(count)
    start = time.process_time()
    preview_case(case.with_positions(180), corners=False)
    preview = time.process_time() - start
    print(f"screening  {1e3 * many:7.3f} ms CPU per design of {count}")
    print(f"linear     {many / few:7.2f} times that of {count // 4}, budget {LINEAR}")
    print(f"preview    {preview / many:7.0f} times the screening, budget at least {FASTER:g}")
    if many / few > LINEAR or preview / many < FASTER:
        sys.exit(1)


if __name__ == "__main__":
    main()

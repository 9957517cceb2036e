"""CPU per design of the screening against a preview: python benchmarks/screening.py [designs]"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs

ROOT = Path(__file__).resolve().parent.parent
LINEAR = 1.1  # per design, the greater number over the smaller
WOUND = 1.25  # with springs of different winding, over none
FASTER = 50.0  # than a preview of 70 ms a load case: 4 ms a design


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

    winding = {
        "spring.design.wire_diameter": draw.uniform(3.4e-3, 3.8e-3, count),
        "spring.design.mean_diameter": draw.uniform(0.022, 0.026, count),
        "spring.design.coils": draw.uniform(4.0, 6.0, count),
        "spring.design.free_length": draw.uniform(0.055, 0.07, count),
    }
    wire = {
        "shear_modulus": 77.2e9, "density": 7850.0,
        "strength_at_1mm": 1.97e9, "strength_exponent": 0.108,
    }  # fmt: skip
    first = {key: float(values[0]) for key, values in winding.items()}
    wound_case = with_values(case, first | {f"spring.design.{key}": wire[key] for key in wire})

    def seconds(designs: int, own: Case, varied: Mapping[str, Array]) -> float:
        start = time.process_time()
        screen_designs(own, {key: values[:designs] for key, values in varied.items()})
        return (time.process_time() - start) / designs

    seconds(2, case, factors)  # imports, engine torque, tables of the guides
    few, many = seconds(count // 4, case, factors), seconds(count, case, factors)
    wound = seconds(count, wound_case, factors | winding)
    start = time.process_time()
    preview_case(case.with_positions(180), corners=False)
    preview = time.process_time() - start
    print(f"screening  {1e3 * many:7.3f} ms CPU per design of {count}")
    print(f"linear     {many / few:7.2f} times that of {count // 4}, budget {LINEAR}")
    print(f"winding    {wound / many:7.2f} times without a spring design, budget {WOUND}")
    print(f"preview    {preview / many:7.0f} times the screening, budget at least {FASTER:g}")
    if many / few > LINEAR or wound / many > WOUND or preview / many < FASTER:
        sys.exit(1)


if __name__ == "__main__":
    main()

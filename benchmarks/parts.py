"""CPU seconds of loads, guides and parts of one cam turn: python benchmarks/parts.py [positions]"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from geometry.arrays import uniform_turn
from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.case import load_case_file
from pipeline.cycle import finished, turn
from pipeline.trial import unknown_contact

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    positions = int(sys.argv[1]) if len(sys.argv) > 1 else 720
    case = load_case_file(ROOT / "cases" / "gx120.toml")
    theta = uniform_turn(positions)
    pitch = PitchCurve(Lift(theta, 0.0165 * (1 - np.cos(theta))), case.cam.pitch_base_radius)
    contour = Contour(pitch, case.roller.radius)
    for run in ("first", "again"):
        start = time.process_time()
        given = turn(case, contour, None, case.load_cases[0].name, positions)
        finished(case, contour, given, unknown_contact(given))
        print(f"{positions} positions, {run}: {time.process_time() - start:.2f} s")


if __name__ == "__main__":
    main()

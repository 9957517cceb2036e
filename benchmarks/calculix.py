"""Contact of the signed GX120 cam by CalculiX beside the certificate: python benchmarks/calculix.py

At three cam angles CalculiX solves the contact pair of ``camwright contact deck --contact`` with
two penalties; its results at an infinite penalty, since the effect of a penalty is inverse to it,
and their differences from those of the certificate are printed. Beyond 0.3 % (force: 1e-4) the exit
code is 1. Without CalculiX (Debian: calculix-ccx) nothing is done.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
from calculix_results import Measured, measured, solved_by_calculix

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.contact_deck import write_pair_deck

CASE = Path(__file__).resolve().parent.parent / "cases" / "gx120-redesign.toml"
PENALTIES = (250.0, 1000.0)
EDGES_PER_HALF_WIDTH = 12.0
LIMITS = Measured(3e-3, 3e-3, 3e-3, 1e-4)


def main() -> int:
    program = shutil.which("ccx")
    if program is None:
        print("no CalculiX: Debian has it in the package calculix-ccx")
        return 0
    cycle = preview_case(read_case(CASE), corners=False).cycles[0]
    pair, force = contact_pair(cycle.machine, cycle.contour), cycle.loads.normal_force
    worst = int(np.argmax(cycle.contact.p0))
    count, beyond = force.size, False
    for at in (worst, (worst + count // 3) % count, (worst + 2 * count // 3) % count):
        theta, load = float(cycle.theta[at]), float(force[at])
        contact = solve_pair(pair, theta, load, EDGES_PER_HALF_WIDTH)
        start, found = time.perf_counter(), []
        for penalty in PENALTIES:
            with tempfile.TemporaryDirectory() as folder:
                deck = Path(folder) / "contact.inp"
                write_pair_deck(deck, pair, contact, penalty)
                solved_by_calculix(program, deck)
                found.append(np.array(measured(deck, contact, pair.width)))
        low, high = found
        limit = high + (high - low) / (PENALTIES[1] / PENALTIES[0] - 1.0)
        solution = contact.solution
        ours = Measured(solution.p0, solution.half_width, solution.von_mises, load)
        off = limit / np.array(ours) - 1.0
        beyond |= bool((np.abs(off) > np.array(LIMITS)).any())
        print(
            f"cam angle {np.degrees(theta):6.1f} deg, {load:6.1f} N: "
            + ", ".join(
                f"{name.replace('_', ' ')} {100 * value:+.4f} %"
                for name, value in zip(Measured._fields, off, strict=True)
            )
            + f"; {time.perf_counter() - start:.0f} s",
            flush=True,
        )
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())

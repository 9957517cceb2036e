"""CPU seconds of one cam turn of a load case: python benchmarks/parts.py [positions]

Loads in balance with the finite guides at nominal, least and greatest friction, the guides without
play, the elastic stem on the varying speed, and all other parts; then the whole cycle, with meshes,
contact, stresses and columns, of a cam whose corrections are kept and of a new one. The budgets are
told in solutions of 1000 dense equations on the same core, so that they hold on another machine:
0.9 s, 1 s and 1.4 s where one takes 20 ms. Beyond a budget the exit code is 1.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base import disk_cache
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import part_loads, shaft_of
from camwright.pipeline.cycle.turn import Turn, turn
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).resolve().parent.parent
POSITIONS = 720
PARTS_BUDGET, KNOWN_BUDGET, NEW_BUDGET = 45.0, 50.0, 70.0  # dense solutions, for 720 positions
ROUNDS = 5


def seconds(work: Callable[[], object]) -> float:
    """CPU seconds, the least of some rounds."""
    found = []
    for _ in range(ROUNDS):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return min(found)


def dense_solution() -> float:
    """CPU seconds of one solution of 1000 dense equations."""
    random = np.random.default_rng(0)
    matrix, right = random.normal(size=(1000, 1000)), random.normal(size=1000)
    return seconds(lambda: np.linalg.solve(matrix, right))


@dataclass(frozen=True)
class _Curve:
    number: int
    values: Array


def mixed_work() -> float:
    """CPU seconds of a stored mix of interpreter and small arrays, of which commands are made.

    The solution of dense equations depends on the vector units alone, and changes by a third on the
    same machine where a command does not.
    """
    theta = np.linspace(0.0, 2.0 * np.pi, 361)
    matrix = np.eye(24) + 0.01 * np.random.default_rng(0).normal(size=(24, 24))

    def work() -> dict[str, float]:
        curve, figures = _Curve(0, np.sin(theta)), dict[str, float]()
        for k in range(1400):
            values = np.interp(theta + 1e-3 * k, theta, curve.values, period=2.0 * np.pi)
            spectrum = np.fft.rfft(values[:-1])
            spectrum[60:] = 0.0
            values = np.append(np.fft.irfft(spectrum), values[-1])
            solved = np.linalg.solve(matrix, values[:24])
            curve = replace(curve, number=k, values=np.where(values > 0.0, values, 0.5 * values))
            figures[f"{k}.demand"] = max(float(solved.max()), float(curve.number))
        return figures

    return seconds(work)


def main() -> int:
    positions = int(sys.argv[1]) if len(sys.argv) > 1 else POSITIONS
    case = read_case(ROOT / "cases" / "gx120.toml")
    torques = engine_torques(case)
    machine = machines(case, torques)[0]
    contour = case.contour(cam_lift(case, torques))
    pair, unit = contact_pair(machine, contour), dense_solution()

    def turned() -> Turn:
        return turn(machine, contour, positions)

    def cycled() -> object:
        one, bodies = turned(), CycleBodies.meshed(pair)
        contact = two_scale_history(pair, bodies, one.theta, one.loads.normal_force)
        return Cycle(one, contour, pair, bodies, contact).columns()

    def cycled_anew() -> object:
        with tempfile.TemporaryDirectory() as folder:
            os.environ[disk_cache.FOLDER] = folder
            return cycled()

    loaded = turned()
    loads = seconds(turned)
    parts = seconds(
        lambda: part_loads(loaded, contour, machine.contact_width, shaft_of(loaded, contour))
    )
    cycled()  # templates and tables of the process, and the corrections of this cam
    known, new = seconds(cycled), seconds(cycled_anew)
    print(f"{positions} positions: loads and guides {loads:.3f} s, parts {parts:.3f} s")
    print(f"whole cycle: {known:.3f} s of a known cam, {new:.3f} s of a new one")
    over = False
    for name, spent, budget in (
        ("loads and parts", loads + parts, PARTS_BUDGET),
        ("cycle of a known cam", known, KNOWN_BUDGET),
        ("cycle of a new cam", new, NEW_BUDGET),
    ):
        ratio = spent / unit
        print(f"{name}: {ratio:.0f} dense solutions of {1e3 * unit:.1f} ms, budget {budget:.0f}")
        over = over or ratio > budget * max(positions / POSITIONS, 1.0)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())

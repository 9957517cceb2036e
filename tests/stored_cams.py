"""Closed forms of the shipped four-stroke cases, stored before other cycles were possible.

`python tests/stored_cams.py` writes them again: a change of them is to be explained.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.sampled_problem import Search

CASES = Path(__file__).parents[1] / "cases"
STORED = Path(__file__).with_name("data") / "stored_cams.json"
SMOOTHED = ("gx120", "gx120-loads", "papers/c24_idle800", "papers/c25_half_torque",
            "papers/c25_preload")  # fmt: skip
CONSTRAINED = ("gx120-redesign", "gx120-flat-face")


def lifts(name: str) -> dict[str, float]:
    """Lift of a smoothed case at twelve cam angles, mm."""
    case = read_case(CASES / f"{name}.toml")
    theta = 0.1 + np.arange(12) * (2.0 * np.pi / 12)
    lift = cam_lift(case, engine_torques(case))(theta)
    return {f"lift {k}": float(value) for k, value in enumerate(1e3 * lift)}


def utilisations(name: str) -> dict[str, float]:
    """Ripple, costs and limits of a synthesis at nine tenths of the exact energy, J."""
    case = read_case(CASES / f"{name}.toml")
    case = with_values(case, {"limits.viscosity_ratio": 1.0})  # the default of that time
    problem = problem_of(case, engine_torques(case))
    search = Search(problem)
    state = search.state(0.9 * search.exact, problem.variables)
    energy = {f"energy {k}": float(value) for k, value in enumerate(search.exact[::16])}
    uses = {key: float(value) for key, value in sorted(state.utilisation.items())}
    return {"ripple": float(state.ripple), "cost": float(state.cost)} | energy | uses


if __name__ == "__main__":
    figures = {name: lifts(name) for name in SMOOTHED}
    figures |= {name: utilisations(name) for name in CONSTRAINED}
    STORED.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")

"""A limit of the return alone in a constrained synthesis, on a machine whose return is steeper."""

from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.preview import preview_case

CASE = Path(__file__).parents[2] / "cases" / "machines" / "compressor.toml"
RISE, BACK = 5.0, 6.0  # deg; without both the machine has 5.3 and 8.7


@pytest.fixture(scope="module")
def trials():
    """The machine with the limit of the rise on both strokes, and with one of the return."""
    case = with_values(read_case(CASE), {"limits.pressure_angle": f"{RISE:g} deg"})
    other = with_values(case, {"limits.return_pressure_angle": f"{BACK:g} deg"})
    return [preview_case(each, corners=False) for each in (case, other)]


def angles(trial):
    """Greatest pressure angles on rise and return, deg, by the formula of textbooks."""
    pitch = trial.contour.pitch
    theta = np.linspace(0.0, 2.0 * np.pi, 7201)
    lift, slope = pitch.lift(theta), pitch.lift(theta, 1)
    height = np.sqrt(pitch.prime_radius**2 - pitch.offset**2) + lift
    angle = np.degrees(np.arctan((slope - pitch.offset) / height))
    return np.abs(angle[slope >= 0.0]).max(), np.abs(angle[slope <= 0.0]).max()


def test_each_stroke_has_its_own_limit(trials):
    for trial, back in zip(trials, (RISE, BACK), strict=True):
        rise, returned = angles(trial)
        assert 0.95 * RISE < rise <= RISE
        assert 0.99 * back < returned <= back


def test_a_steeper_return_balances_more(trials):
    left = [
        next(each.demand for each in trial.checks if each.id == "torque_reduction")
        for trial in trials
    ]
    assert left[1] > left[0] + 0.01
    for trial in trials:
        (check,) = [each for each in trial.checks if each.id == "pressure_angle"]
        assert check.status == "pass"

"""Screening of cams that pull or bear the weight alone: against the preview and row by row.

The lifts have no rest, in which the sign of no force says which wall carries.
"""

from pathlib import Path

import numpy as np
import pytest
from test_screening import compared, exceeded

from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.screening.screened_checks import SCREENED

ROOT = Path(__file__).parents[2]
FILES = {
    "groove": ROOT / "cases" / "motions" / "feeder-groove.toml",
    "gravity": ROOT / "tests" / "data" / "gravity_lift.toml",
}
RANGES = {
    "groove": {
        "cam.prime_radius": (0.066, 0.07), "cam.offset": (-3e-3, 3e-3),
        "cam.groove.clearance": (12e-6, 28e-6), "cam.groove.outer_radius": (0.118, 0.132),
        "cam.groove.depth": (0.0176, 0.02), "follower.mass": (2.7, 3.3),
        "roller.radius": (0.0235, 0.0242), "limits.landing_speed": (0.01, 0.05),
    },
    "gravity": {
        "cam.prime_radius": (0.066, 0.07), "follower.mass": (0.9, 1.1),
        "roller.radius": (0.0235, 0.0242),
    },
}  # fmt: skip
LIFT = """[lift]
kind = "segments"
segment = [
    { law = "cycloidal", angle = "100 deg", stroke = "12 mm" },
    { law = "cycloidal", angle = "80 deg", stroke = "-12 mm" },
    { law = "cycloidal", angle = "90 deg", stroke = "10 mm" },
    { law = "cycloidal", angle = "90 deg", stroke = "-10 mm" },
]

"""
OF_FORM = {
    "groove": {"landing_speed", "landing_pressure", "crossover_slip", "outer_undercut",
               "groove_wall", "groove_clearance", "groove_radius"},
    "gravity": {"contact_force_margin", "jump"},
}  # fmt: skip


def case_without_rest(name):
    text = FILES[name].read_text(encoding="utf-8")
    if name == "gravity":
        return parse_case(text)
    begin, end = text.index("[lift]"), text.index("[mechanism]")
    return parse_case(text[:begin] + LIFT + text[end:])


def designs(name, count):
    case, draw = case_without_rest(name), np.random.default_rng(7)
    factors = {key: draw.uniform(*ends, count) for key, ends in RANGES[name].items()}
    if name == "gravity":
        factors["follower.mass"] *= case.follower.mass
    return case, factors


@pytest.mark.parametrize("name", RANGES)
def test_designs_agree_with_their_previews(name):
    """Within the deviations that the checks declare; `compared` holds status and screen, too.

    At the angles of the preview: the mean spin of a roller that turns the other way at each
    crossover depends on them, by 1.5e-3 between 180 and 720.
    """
    case, factors = designs(name, 2)
    worst = compared(case, factors, positions=720)
    assert {"p0", "force", "contact_pressure"} | OF_FORM[name] <= set(worst)
    assert exceeded(worst) == {}


@pytest.mark.parametrize("name", RANGES)
def test_a_row_is_the_single_design(name):
    case, factors = designs(name, 3)
    rows = screen_designs(case, factors)
    for k in range(3):
        single = screen_designs(case, {key: each[k : k + 1] for key, each in factors.items()})
        assert single.keys() == rows.keys()
        for column, values in rows.items():
            if values.dtype == object:
                assert values[k] == single[column][0], column
            else:
                wanted = pytest.approx(single[column][0], rel=1e-12, nan_ok=True)
                assert values[k] == wanted, column
    judged = {each.check for each in SCREENED if f"{each.check}.demand" in rows}
    assert OF_FORM[name] <= judged


def test_a_bound_decides_only_where_it_fails():
    """Friction of a groove without what the rollers lose at their reversals."""
    case, factors = designs("groove", 2)
    rows = screen_designs(case, factors)
    assert set(rows["mechanism_temperature.status"]) == {"not_evaluated"}

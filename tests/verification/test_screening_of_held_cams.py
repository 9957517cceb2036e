"""Screening of cams that pull or bear the weight alone: against the preview and row by row.

The lifts have no rest, in which the sign of no force says which wall carries.
"""

from pathlib import Path

import numpy as np
import pytest
from test_groove_cam import soft_roller
from test_screening import compared, exceeded

from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.screening.screened_checks import SCREENED

ROOT = Path(__file__).parents[2]
FILES = {
    "groove": ROOT / "cases" / "motions" / "feeder-groove.toml",
    "groove_arm": ROOT / "tests" / "data" / "groove_arm.toml",
    "steps": ROOT / "tests" / "data" / "stepped_groove.toml",
    "gravity": ROOT / "tests" / "data" / "gravity_lift.toml",
    "stem": ROOT / "tests" / "data" / "conjugate_feeder.toml",
    "arm": ROOT / "tests" / "data" / "conjugate_arm.toml",
    "pressed": ROOT / "tests" / "data" / "preloaded_arm.toml",
    "pressed_stem": ROOT / "tests" / "data" / "preloaded_feeder.toml",
    "yoke": ROOT / "tests" / "data" / "yoke_pump.toml",
}
RANGES = {
    "groove": {
        "cam.prime_radius": (0.066, 0.07), "cam.offset": (-3e-3, 3e-3),
        "cam.groove.clearance": (12e-6, 28e-6), "cam.groove.outer_radius": (0.118, 0.132),
        "cam.groove.depth": (0.0176, 0.02), "follower.mass": (2.7, 3.3),
        "roller.radius": (0.0235, 0.0242), "limits.landing_speed": (0.01, 0.05),
    },
    "groove_arm": {
        "cam.prime_radius": (0.061, 0.063), "follower.arm.length": (0.089, 0.091),
        "cam.groove.clearance": (12e-6, 28e-6), "cam.groove.outer_radius": (0.11, 0.116),
        "follower.pivot.swinging_mass": (1.7, 2.0), "follower.pivot.bush.friction": (0.04, 0.07),
    },
    "steps": {
        "cam.prime_radius": (0.066, 0.07), "cam.groove.clearance": (12e-6, 28e-6),
        "cam.groove.second.radius": (0.0208, 0.0225), "cam.groove.second.relief": (5e-4, 7e-4),
        "cam.groove.depth": (0.036, 0.037), "roller.radius": (0.0235, 0.0242),
        "follower.mass": (2.7, 3.3),
    },
    "gravity": {
        "cam.prime_radius": (0.066, 0.07), "follower.mass": (7.5, 8.5),
        "roller.radius": (0.0235, 0.0242),
    },
    "stem": {
        "cam.prime_radius": (0.067, 0.069), "cam.offset": (-3e-3, 3e-3),
        "cam.conjugate.distance": (0.153, 0.157), "cam.conjugate.clearance": (12e-6, 28e-6),
        "cam.conjugate.roller_radius": (0.0228, 0.024), "cam.conjugate.spacing": (0.033, 0.036),
        "follower.mass": (2.7, 3.3),
    },
    "arm": {
        "cam.prime_radius": (0.061, 0.063), "follower.arm.length": (0.089, 0.091),
        "cam.conjugate.arm_length": (0.084, 0.086), "cam.conjugate.arm_angle": (1.37, 1.39),
        "cam.conjugate.roller_radius": (0.0215, 0.0225), "follower.pivot.swinging_mass": (1.7, 2.0),
        "follower.pivot.bush.friction": (0.04, 0.07),
    },
    "pressed": {
        "cam.prime_radius": (0.061, 0.063), "follower.arm.width": (0.03, 0.034),
        "cam.conjugate.interference": (18e-6, 24e-6), "cam.conjugate.arm_length": (0.084, 0.086),
        "follower.pivot.bush.friction": (0.04, 0.07),
    },
    "pressed_stem": {
        "cam.prime_radius": (0.067, 0.069), "cam.offset": (-3e-3, 3e-3),
        "cam.conjugate.distance": (0.153, 0.157), "cam.conjugate.interference": (18e-6, 24e-6),
        "guides.a.friction": (0.04, 0.1), "guides.spacing": (0.13, 0.134),
    },
    "yoke": {
        "cam.prime_radius": (0.034, 0.036), "cam.offset": (-2e-3, 2e-3),
        "cam.yoke.clearance": (0.04e-3, 0.06e-3), "follower.mass": (1.8, 2.2),
        "follower.face.friction": (0.03, 0.07),
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
_LANDS = {"landing_speed", "landing_pressure", "crossover_slip"}
_PIVOT = {"pivot_pressure", "pivot_edge_pressure"}
OF_FORM = {
    "groove": _LANDS | {"outer_undercut", "groove_wall", "groove_clearance", "groove_radius"},
    "groove_arm": _LANDS | {"outer_undercut", "groove_wall", "groove_radius"} | _PIVOT,
    "steps": _LANDS | {"outer_undercut", "groove_wall", "groove_clearance", "fork_gap"},
    "gravity": {"contact_force_margin", "jump"},
    "stem": _LANDS | {"second_disc_gap", "cam_radius"},
    "arm": _LANDS | {"second_disc_gap"} | _PIVOT,
    "pressed": {"preload_least", "preload_pressure", "second_disc_gap"} | _PIVOT,
    "pressed_stem": {"preload_least", "preload_pressure", "second_disc_gap", "jam_index"},
    "yoke": {"landing_speed", "landing_pressure", "yoke_breadth"},
}  # fmt: skip


def case_without_rest(name):
    text = FILES[name].read_text(encoding="utf-8")
    if name in ("gravity", "yoke"):
        return parse_case(text)
    begin, end = text.index("[lift]"), text.index("[mechanism]")
    lift = LIFT
    if name in ("arm", "pressed", "groove_arm"):
        lift = LIFT.replace("12 mm", "5.5 deg").replace("10 mm", "5 deg")
    return parse_case(text[:begin] + lift + text[end:])


def designs(name, count):
    case, draw = case_without_rest(name), np.random.default_rng(7)
    factors = {key: draw.uniform(*ends, count) for key, ends in RANGES[name].items()}
    return case, factors


THOROUGH = "stem", "steps", "gravity", "pressed", "pressed_stem", "groove_arm"
"""Cams of which a slow test alone compares the previews."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] * (name in THOROUGH)) for name in RANGES],
)
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
    # elsewhere the force passes from track to track
    pressed = name in ("gravity", "pressed", "pressed_stem")
    assert (rows["headline.normal_force_min_N"] > 0.0).all() == pressed
    judged = {each.check for each in SCREENED if f"{each.check}.demand" in rows}
    assert OF_FORM[name] <= judged


def test_a_soft_roller_conforms_in_the_screening_too():
    case = soft_roller()
    worst = compared(case, {"follower.mass": np.array([case.follower.mass])}, positions=720)
    assert worst["contact_pressure"] < 1e-3 and worst["p0"] < 1e-3


def test_a_bound_decides_only_where_it_fails():
    """Friction of a groove without what the rollers lose at their reversals."""
    case, factors = designs("groove", 2)
    rows = screen_designs(case, factors)
    assert set(rows["mechanism_temperature.status"]) == {"not_evaluated"}

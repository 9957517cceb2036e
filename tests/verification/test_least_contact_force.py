"""Least contact force between the solved angles, by hand; demands of a contact about to be lost."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.lost_loads import load_ends
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial

CASES = Path(__file__).parents[1] / "data" / "strangers" / "03-forum-cycloid"
MASS, RATE, STROKE, BASE = 1.8, 15e3, 0.01, np.radians(120.0)
SPEED = 1000.0 * 2.0 * np.pi / 60.0


def force(theta: float, preload: float, mass: float = MASS) -> float:
    """Force of the cycloidal rise by hand: P + k s + m w^2 s'', N."""
    x = theta / BASE
    lift = STROKE * (x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi))
    bend = 2.0 * np.pi * STROKE / BASE**2 * np.sin(2.0 * np.pi * x)
    return preload + RATE * lift + mass * SPEED**2 * bend


def by_hand(preload: float) -> tuple[float, float]:
    """Least force, N, and its angle, deg."""
    least = minimize_scalar(
        lambda at: force(at, preload), bounds=(0.5 * BASE, BASE), method="bounded",
        options={"xatol": 1e-10},
    )  # fmt: skip
    return float(least.fun), float(np.degrees(least.x))


@cache
def trial(preload: str, *, corners: bool = False, positions: int = 72) -> Trial:
    text = (CASES / "forum.toml").read_text(encoding="utf-8")
    text = text.replace('"37.5 N"', f'"{preload} N"')
    text = text.replace("positions = 72", f"positions = {positions}")
    return preview_case(parse_case(text), corners=corners)


def check(made: Trial, name: str) -> Check:
    return next(one for one in made.checks if one.id == name)


@pytest.mark.parametrize("positions", [72, 720])
def test_the_least_force_is_that_between_the_solved_angles(positions: int) -> None:
    least, at = by_hand(37.5)
    assert (least, at) == (pytest.approx(-109.97, abs=0.01), pytest.approx(88.24, abs=0.01))
    margin = check(trial("37.5", positions=positions), "contact_force_margin")
    assert margin.demand == 0.0
    told = re.search(
        r"friction (-[\d.]+) N at ([\d.]+) deg; a preload above ([\d.]+) N", margin.note
    )
    assert told is not None
    value, angle, preload = (float(each) for each in told.groups())
    assert value == pytest.approx(least, rel=1e-4)
    assert min(angle, 300.0 - angle) == pytest.approx(at, abs=0.04)  # the return mirrors the rise
    assert 37.5 - least <= preload <= 37.5 - least + 0.02


def test_the_follower_leaves_where_the_force_by_hand_is_zero() -> None:
    (end,) = load_ends(trial("37.5").solution)
    zero = brentq(lambda at: force(at, 37.5), np.radians(61.0), np.radians(80.0))
    assert np.degrees(zero) == pytest.approx(69.6, abs=0.05)
    assert end.cam_angle == pytest.approx(zero, abs=np.radians(0.02))


def test_a_loss_between_two_solved_angles_is_seen() -> None:
    """At 146.6 N all solved angles have contact; the loads end nonetheless, and the hint holds."""
    made = trial("146.6")
    cycle = next(one for one in made.cycles if one.load_case == "running")
    assert (cycle.loads.normal_force > 0.0).all()
    assert [one.load_case for one in load_ends(made.solution)] == ["running"]
    assert check(made, "contact_force_margin").demand == 0.0
    need = 37.5 - by_hand(37.5)[0]
    assert need == pytest.approx(147.47, abs=0.005)
    assert load_ends(trial(f"{need - 0.02:.4f}").solution)
    assert not load_ends(trial(f"{need + 0.02:.4f}").solution)


def test_readers_of_the_force_agree_with_the_force_by_hand() -> None:
    made, preload = trial("200"), 200.0
    least, at = by_hand(preload)
    margin = check(made, "contact_at_overspeed")
    assert margin.demand == pytest.approx(least / preload, rel=1e-4)
    assert np.degrees(margin.cam_angle) == pytest.approx(at, abs=0.05)

    def use(theta: float) -> float:
        closing = force(theta, preload, 0.0)
        return (closing - force(theta, preload)) / closing

    worst = minimize_scalar(lambda x: -use(x), bounds=(0.5 * BASE, BASE), method="bounded")
    assert check(made, "jump").demand == pytest.approx(use(worst.x), rel=1e-5)
    jump = check(made, "jump_speed")
    assert jump.demand == pytest.approx(SPEED / np.sqrt(use(worst.x)), rel=1e-5)


@pytest.mark.parametrize("preload", ["146.6", "147.5"])
def test_a_contact_about_to_be_lost_yields_no_demand_beyond_reason(preload: str) -> None:
    """Corner and run are over the same load cases; a quotient by no force counts 1 % of it."""
    made = trial(preload, corners=True)
    most = {
        "roller_speed": 7700.0 * 2.0 * np.pi / 60.0,  # of rolling: it knows no contact force
        "guide_pv_A": 1.8e6,
        "guide_pv_B": 1.8e6,
        "guide_wear_A": 0.05e-3,
        "guide_wear_B": 0.05e-3,
        "profile_waviness": 300.0,
        "traction_demand": 10.0,
        "traction_reserve": 10.0,
    }
    for name, limit in most.items():
        worst = check(made, name).worst
        assert worst is None or not worst > limit, name
    for one in made.checks:
        assert one.worst is None or not 1e12 < abs(one.worst) < np.inf, one.id


def test_a_quotient_by_the_contact_force_fails_and_is_bounded() -> None:
    normal = np.array([100.0, 1.0, 1e-9, 0.0, np.nan])
    share = demands.over_contact_force(np.full(5, 20.0), normal, 100.0)
    np.testing.assert_array_equal(share, [0.2, 20.0, 20.0, np.inf, np.nan])

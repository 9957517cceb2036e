"""The papers' studies as cases: the case files say what `python -m validation values` runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from validation import cardoso_2024, cardoso_2025
from validation.balancing_cam import (
    FOLLOWER_2025,
    PRIME_RADIUS,
    RATIO,
    TWELVE_VALUES,
)
from validation.paper_engines import (
    EFFECTIVE_INERTIA,
    ENGINE_800,
    GX120,
    SLOW_IDLE,
)

PAPERS = Path(__file__).resolve().parents[2] / "cases" / "papers"


def case(name: str) -> Case:
    return read_case(PAPERS / f"{name}.toml")


@pytest.mark.parametrize("name", ["c25_preload", "c25_half_torque"])
def test_machine_of_2025(name: str) -> None:
    paper = case(name)
    assert paper.engine == GX120
    system = machines(paper)[0].system
    bare = Spring(rate=system.spring.rate, preload=system.spring.preload)
    assert replace(system, spring=bare) == FOLLOWER_2025
    assert Smoother.from_case(paper.smoothing, paper.period) == TWELVE_VALUES
    assert paper.mechanism.gear_ratio == RATIO
    assert paper.cam.prime_radius == PRIME_RADIUS
    assert paper.crankshaft is not None
    assert paper.crankshaft.inertia == EFFECTIVE_INERTIA


def test_preload_study_runs_one_cam_at_three_preloads() -> None:
    paper = case("c25_preload")
    torques = engine_torques(paper)
    states = machines(paper, torques)[: len(paper.load_cases)]
    preloads = [machine.spring.preload for machine in states]
    assert sorted(preloads) == list(cardoso_2025.PRELOADS)
    turns = turns_of(states, paper.contour(cam_lift(paper, torques)), 72)
    springs = {turn.machine.load_case: turn.loads.spring_force for turn in turns}
    # The cam is one; the springs differ by what they are screwed tighter or looser.
    np.testing.assert_allclose(springs["preload-242"] - springs["preload-121"], 121.0, atol=1e-9)
    np.testing.assert_allclose(springs["preload-363"] - springs["preload-242"], 121.0, atol=1e-9)


def test_half_torque_case_asks_half() -> None:
    full, half = case("c25_preload"), case("c25_half_torque")
    assert half.mechanism.compensation * RATIO == cardoso_2025.MULTIPLIERS["half"]
    assert full.mechanism.compensation * RATIO == cardoso_2025.MULTIPLIERS["full"]


def test_machine_of_2024() -> None:
    paper = case("c24_idle800")
    assert paper.engine == ENGINE_800
    assert paper.load_cases[0].speed == pytest.approx(SLOW_IDLE, rel=1e-3)  # 800 rpm, 83.8 rad/s
    assert paper.spring.rate == cardoso_2024.SPRING.rate
    assert paper.spring.preload == cardoso_2024.SPRING.preload
    assert paper.smoothing.kind == "none"

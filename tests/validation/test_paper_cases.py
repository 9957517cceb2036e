"""The papers' studies as cases: what the case files say is what `camwright validate` runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline import solver as road
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import load_case_file
from camwright.pipeline.follower.follower_forces import FollowerSystem
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.studies.papers import cardoso_2024, cardoso_2025
from camwright.pipeline.studies.papers.balancing_cam import (
    FOLLOWER_2025,
    PRIME_RADIUS,
    RATIO,
    TWELVE_VALUES,
)
from camwright.pipeline.studies.papers.paper_engines import (
    EFFECTIVE_INERTIA,
    ENGINE_800,
    GX120,
    SLOW_IDLE,
)

PAPERS = Path(__file__).resolve().parents[2] / "cases" / "papers"


def case(name: str) -> Case:
    return load_case_file(PAPERS / f"{name}.toml")


@pytest.mark.parametrize("name", ["c25_preload", "c25_half_torque"])
def test_machine_of_2025(name: str) -> None:
    found = case(name)
    assert found.engine is not None
    assert found.engine.build() == GX120
    assert FollowerSystem.from_case(found) == FOLLOWER_2025
    assert Smoother.from_case(found.smoothing) == TWELVE_VALUES
    assert found.mechanism.gear_ratio == RATIO
    assert found.cam.pitch_base_radius == PRIME_RADIUS
    assert found.crankshaft is not None
    assert found.crankshaft.inertia == EFFECTIVE_INERTIA


def test_preload_study_runs_one_cam_at_three_preloads() -> None:
    found = case("c25_preload")
    states = [found.at(state.name).spring.preload for state in found.load_cases]
    assert sorted(states) == list(cardoso_2025.PRELOADS)
    torques = road.engine_torques(found)
    contour = road.cam_contour(
        found, road.designed_lift(found, torques, Smoother.from_case(found.smoothing))
    )
    turns = road.turns_of(found, contour, torques, 72)
    springs = {given.load_case: given.loads.spring_force for given in turns}
    # The cam is one; the springs differ by what they are screwed tighter or looser.
    np.testing.assert_allclose(springs["preload-242"] - springs["preload-121"], 121.0, atol=1e-9)
    np.testing.assert_allclose(springs["preload-363"] - springs["preload-242"], 121.0, atol=1e-9)


def test_half_torque_case_asks_half() -> None:
    full, half = case("c25_preload"), case("c25_half_torque")
    assert half.mechanism.compensation * RATIO == cardoso_2025.MULTIPLIERS["half"]
    assert full.mechanism.compensation * RATIO == cardoso_2025.MULTIPLIERS["full"]


def test_machine_of_2024() -> None:
    found = case("c24_idle800")
    assert found.engine is not None
    assert found.engine.build() == ENGINE_800
    assert found.load_cases[0].speed == pytest.approx(SLOW_IDLE, rel=1e-3)  # 800 rpm, 83.8 rad/s
    assert found.spring.rate == cardoso_2024.SPRING.spring_rate
    assert found.spring.preload == cardoso_2024.SPRING.preload
    assert found.smoothing.kind == "none"

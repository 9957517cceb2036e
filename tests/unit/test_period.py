"""The period of a machine: cycles in a cam turn, refused ratios, a torque on cam angles."""

from __future__ import annotations

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.torque.period import FOUR_STROKE, Period, ratio_text
from camwright.pipeline.torque.torque import Torque, over_cam_turn, uniform_cycle

TURN = 2.0 * np.pi


@pytest.mark.parametrize(
    ("degrees", "ratio", "cycles"),
    [(720, 2, 1), (360, 1, 1), (360, 2, 2), (540, 1.5, 1), (120, 1, 3), (180, 1.5, 3),
     (360 / 7, 1 / 7, 1), (0.1 * 3600, 3, 3), (240, 2 / 3, 1)],
)  # fmt: skip
def test_a_cam_turn_holds_a_whole_number_of_cycles(
    degrees: float, ratio: float, cycles: int
) -> None:
    period = Period(np.radians(degrees), ratio)
    assert period.cycles == cycles
    assert period.cam_turn == pytest.approx(cycles * period.angle, rel=1e-12)  # round-off


@pytest.mark.parametrize(
    ("degrees", "ratio", "near"),
    [(360, 1.5, "1 or 2"), (720, 1, "2 or 4"), (720, 3, "2 or 4"), (120, 0.5, "1:3 or 2:3"),
     (360, 40, "11 or 12"), (360, 0.2, "1 or 2"), (540, 2, "3:2 or 3")],
)  # fmt: skip
def test_another_ratio_is_refused_with_the_two_nearest(
    degrees: float, ratio: float, near: str
) -> None:
    with pytest.raises(InputError, match=f"must be {near}: a cam turn holds a whole number"):
        Period(np.radians(degrees), ratio)


@pytest.mark.parametrize("wrong", [np.nan, 0.0, -1.0, np.inf])
def test_period_refuses_what_is_no_angle_and_no_ratio(wrong: float) -> None:
    with pytest.raises(InputError, match=r"torque.cycle"):
        Period(wrong, 2.0)
    with pytest.raises(InputError, match=r"mechanism.gear_ratio"):
        Period(TURN, wrong)


def test_ratio_is_written_as_a_fraction() -> None:
    assert [ratio_text(r) for r in (2.0, 1.5, 2 / 3, 0.123456789)] == [
        "2",
        "3:2",
        "2:3",
        "0.1235",
    ]


def test_torque_of_a_four_stroke_is_its_own_cam_turn() -> None:
    torque = Torque(uniform_cycle(24), {"gas": np.arange(24.0)})
    assert over_cam_turn(torque, FOUR_STROKE) is torque


def test_torque_repeats_in_every_cycle_of_the_cam_turn() -> None:
    period = Period(TURN, 3.0)
    values = np.random.default_rng(1).normal(size=24)
    torque = Torque(uniform_cycle(24, TURN), {"gas": values}, values**2, np.abs(values), span=TURN)
    turn = over_cam_turn(torque, period)
    assert turn.span == period.cam_turn
    np.testing.assert_array_equal(turn.total.reshape(3, 24), np.tile(values, (3, 1)))
    assert turn.varying_inertia is not None
    assert turn.error_bar is not None
    np.testing.assert_array_equal(turn.varying_inertia[24:48], values**2)
    np.testing.assert_array_equal(turn.error_bar[48:], np.abs(values))
    # The spline through equal cycles is that through one: round-off of its solution.
    np.testing.assert_allclose(
        turn.resampled(3 * 36).total[36:72], torque.resampled(36).total, rtol=0, atol=1e-12
    )


def test_torque_over_another_angle_than_the_cycle_is_refused() -> None:
    torque = Torque(uniform_cycle(24), {"gas": np.arange(24.0)})
    with pytest.raises(InputError, match=r"torque.cycle = 720 deg, must be 360"):
        over_cam_turn(torque, Period(TURN, 1.0))

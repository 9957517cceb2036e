import numpy as np
import pytest

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.smoothing.energy_spline import (
    basis_matrix,
    exact_start,
    fitted_energy,
    force_moment,
)

RATE, PRELOAD, RADIUS = 24.2e3, 242.0, 0.05


def torque(count=720):
    theta = uniform_turn(count)
    return 25.0 * np.sin(2 * theta) + 12.0 * np.cos(3 * theta + 0.4)


def start(angle_deg=30.0, energy_max=np.inf):
    return exact_start(
        torque(), 48, rate=RATE, preload=PRELOAD, prime_radius=RADIUS,
        pressure_angle=np.radians(angle_deg), energy_max=energy_max,
    )  # fmt: skip


def test_splines_add_up_to_one():
    theta = np.linspace(-1.0, 8.0, 77)
    np.testing.assert_allclose(basis_matrix(theta, 24) @ np.ones(24), 1.0, atol=1e-14)


def test_derivatives_match_central_differences():
    coefficients = np.random.default_rng(1).normal(size=24)
    theta, step = np.linspace(0.1, 6.0, 40), 1e-6
    for order in range(3):
        ends = [basis_matrix(theta + h, 24, order) @ coefficients for h in (step, -step)]
        exact = basis_matrix(theta, 24, order + 1) @ coefficients
        # a central difference of step 1e-6 keeps about 9 digits
        np.testing.assert_allclose((ends[0] - ends[1]) / (2 * step), exact, rtol=0,
                                   atol=1e-7 * np.abs(exact).max())  # fmt: skip


def test_the_turn_closes():
    coefficients = np.random.default_rng(2).normal(size=30)
    ends = basis_matrix(np.array([0.0, FULL_TURN]), 30) @ coefficients
    assert abs(ends[0] - ends[1]) < 1e-13


def test_fitted_energy_gives_the_torque_back():
    found = basis_matrix(uniform_turn(720), 96, 1) @ fitted_energy(torque(), 96)
    # three waves a turn on 96 splines: order 5 in a knot distance of 0.065 rad
    np.testing.assert_allclose(found, torque(), atol=1e-5 * 37)


def test_torque_with_a_mean_is_refused():
    with pytest.raises(InputError, match="mean"):
        fitted_energy(torque() + 1.0, 48)


def test_start_attains_the_pressure_angle():
    coefficients = start()
    theta = uniform_turn(1440)
    energy, slope = (basis_matrix(theta, 48, order) @ coefficients for order in (0, 1))
    tangent = np.abs(slope) / force_moment(energy, RATE, PRELOAD, RADIUS)
    assert np.degrees(np.arctan(tangent.max())) == pytest.approx(30.0, abs=1e-6)


def test_start_without_need_is_not_raised():
    coefficients, theta = start(angle_deg=80.0), uniform_turn(1440)
    lowest = theta[np.argmin(basis_matrix(theta, 48) @ coefficients)]
    between = lowest + np.linspace(-theta[1], theta[1], 10_001)
    energy = basis_matrix(between, 48) @ coefficients
    assert energy.min() == pytest.approx(0.0, abs=1e-9)
    assert energy.min() >= -1e-12


def test_start_keeps_the_travel():
    energy = basis_matrix(uniform_turn(1440), 48) @ start(energy_max=20.0)
    assert energy.max() <= 20.0 + 1e-9


def test_moment_is_concave_where_the_base_is_large():
    energy = np.linspace(0.0, 40.0, 200)
    assert (np.diff(force_moment(energy, RATE, PRELOAD, RADIUS), 2) < 0).all()
    assert not (np.diff(force_moment(energy, RATE, PRELOAD, 0.0005), 2) < 0).all()

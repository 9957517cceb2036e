"""The lift: a periodic quintic, its tables and what it refuses."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift

THETA = uniform_turn(360)


def smooth(theta):
    """A lift with four harmonics, m."""
    return 0.02 * (1 - np.cos(theta)) + 0.004 * np.sin(2 * theta) ** 2


def smooth_derivatives(theta):
    """Lift and its derivatives up to the fourth."""
    return np.array(
        [
            smooth(theta),
            0.02 * np.sin(theta) + 0.008 * np.sin(4 * theta),
            0.02 * np.cos(theta) + 0.032 * np.cos(4 * theta),
            -0.02 * np.sin(theta) - 0.128 * np.sin(4 * theta),
            -0.02 * np.cos(theta) - 0.512 * np.cos(4 * theta),
        ]
    )


LIFT = Lift(THETA, smooth(THETA))


def test_passes_through_its_samples():
    """atol: four units in the last place of the greatest lift."""
    np.testing.assert_allclose(LIFT(THETA), LIFT.values, rtol=0, atol=3e-17)


def test_derivatives_converge_to_those_of_the_sampled_function():
    """Order 6 - k for derivative k between samples: bounds are three times the measured error."""
    angle = np.linspace(0, 2 * np.pi, 1001)
    error = np.abs(LIFT.derivatives(angle, 4) - smooth_derivatives(angle)).max(axis=1)
    assert (error <= [1e-13, 1e-11, 1.5e-8, 1e-6, 1e-3]).all(), error


def test_matches_the_b_spline_of_scipy():
    knots = np.append(THETA, 2 * np.pi)
    spline = make_interp_spline(
        knots, np.append(LIFT.values, LIFT.values[0]), 5, bc_type="periodic"
    )
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, 2000)
    for order, atol in enumerate([1e-16, 1e-14, 1e-12, 1e-10, 1e-8]):
        np.testing.assert_allclose(LIFT(angle, order), spline(angle, order), rtol=0, atol=atol)


@pytest.mark.parametrize("order", range(5))
def test_is_continuous_across_the_seam_and_every_knot(order):
    """C4: the two sides of a knot differ by the round-off of a derivative, eps s / h^k."""
    rough = np.random.default_rng(2).uniform(0.0, 0.01, 60)
    lift = Lift(uniform_turn(60), rough)
    step = 2 * np.pi / 60
    knots = np.arange(60) * step
    tiny = 1e-12
    jump = lift(knots + tiny, order) - lift(knots - tiny, order)
    slope = np.abs(lift.spline(knots + tiny, order + 1)).max() * 2 * tiny
    assert np.abs(jump).max() <= 2 * slope + 100 * 2e-16 * 0.01 / step**order


def test_turns_repeat():
    angle = np.linspace(0, 2 * np.pi, 50)
    for turns in (-3, -1, 1, 5):
        np.testing.assert_allclose(LIFT(angle + turns * 2 * np.pi), LIFT(angle), rtol=0, atol=1e-15)


def test_ends_of_the_turn_are_one_angle():
    ends = [0.0, 2 * np.pi, -1e-300, np.nextafter(2 * np.pi, 0)]
    apart = np.abs(LIFT.derivatives(ends, 3)[:, :1] - LIFT.derivatives(ends, 3)).max(axis=1)
    assert (apart <= [1e-16, 1e-15, 1e-14, 1e-12]).all(), apart


def test_keeps_the_shape_of_the_angles():
    angle = np.ones((3, 4))
    assert LIFT(angle).shape == (3, 4)
    assert LIFT.derivatives(angle).shape == (4, 3, 4)
    assert LIFT(1.0).shape == ()
    np.testing.assert_array_equal(LIFT.derivatives(angle)[2], LIFT(angle, 2))


def test_hands_on_a_missing_angle():
    assert np.isnan(LIFT(np.nan))


@pytest.mark.parametrize("order", [-1, 5, 1.5])
def test_refuses_a_derivative_that_jumps(order):
    with pytest.raises(InputError, match="derivative"):
        LIFT(0.0, order)
    with pytest.raises(InputError, match="order"):
        LIFT.derivatives(0.0, order)


def test_finds_the_stroke_between_samples():
    """16 samples, the crest half a step from the nearest: samples alone miss 1.9 % of it."""
    angle = uniform_turn(16)
    lift = Lift(angle, 0.01 * (1 - np.cos(angle - np.pi / 16)))
    assert np.ptp(lift.values) < 0.0197
    assert lift.stroke == pytest.approx(0.02, rel=1e-5)
    assert lift.highest.theta == pytest.approx(np.pi * 17 / 16, abs=1e-6)


def test_kept_derivatives_are_those_of_their_own_angles():
    """More sets of angles than are kept, shapes and orders in turn."""
    for shift in (*range(20), 3):
        theta = uniform_turn(100) + 1e-3 * shift
        for order in (1, 3, 0):
            alone = [LIFT(theta, k) for k in range(order + 1)]
            rows = LIFT.derivatives(theta, order)
            np.testing.assert_array_equal(rows, alone)
            np.testing.assert_array_equal(
                LIFT.derivatives(theta.reshape(4, 25), order)[0], rows[0].reshape(4, 25)
            )
            assert not rows.flags.writeable


def test_is_read_only():
    with pytest.raises(ValueError, match="read-only"):
        LIFT.values[0] = 1.0


@pytest.mark.parametrize(
    ("theta", "values", "field"),
    [
        (THETA, smooth(THETA) - 1e-4, "lift.values"),
        (THETA, np.where(np.arange(360) == 7, np.nan, smooth(THETA)), "lift.values"),
        (THETA, smooth(THETA)[:-1], "lift.values"),
        (THETA + 0.01, smooth(THETA), "lift.theta"),
        (THETA * 0.5, smooth(THETA), "lift.theta"),
        (uniform_turn(11), np.zeros(11), "lift.theta"),
        (np.append(THETA, 2 * np.pi), smooth(np.append(THETA, 0)), "lift.theta"),
    ],
)
def test_refuses(theta, values, field):
    with pytest.raises(InputError) as caught:
        Lift(theta, values)
    assert caught.value.field == field


def test_allows_a_dip_of_round_off():
    Lift(THETA, smooth(THETA) - 0.99e-6)
    with pytest.raises(InputError):
        Lift(THETA, smooth(THETA) - 1.01e-6)


# Tables ------------------------------------------------------------------------------------


def test_takes_an_even_table_as_it_is():
    lift = Lift.from_samples(THETA, smooth(THETA))
    np.testing.assert_array_equal(lift.values, smooth(THETA))
    assert lift.closure == 0.0


def test_takes_a_table_that_repeats_its_start():
    end = np.append(THETA, 2 * np.pi)
    lift = Lift.from_samples(end, smooth(end))
    assert len(lift.theta) == 360
    assert lift.closure < 1e-15


def test_states_how_far_a_table_stays_open():
    values = np.append(smooth(THETA), smooth(0.0) + 5e-7)
    assert Lift.from_samples(np.append(THETA, 2 * np.pi), values).closure == pytest.approx(5e-7)


@pytest.mark.parametrize("start", [0.0, 0.3, -1.0, 350.0])
def test_interpolates_an_uneven_table(start):
    """Steps of 0.6 to 1.4 degrees: the spline misses the function by 1e-12 m at most."""
    steps = np.radians(1 + 0.4 * np.sin(np.arange(360)))
    theta = start + np.cumsum(steps) * 2 * np.pi / steps.sum() - steps[0]
    lift = Lift.from_samples(theta, smooth(theta))
    angle = np.linspace(0, 2 * np.pi, 1000)
    np.testing.assert_allclose(lift(angle), smooth(angle), rtol=0, atol=1e-12)
    np.testing.assert_allclose(lift(theta), smooth(theta), rtol=0, atol=1e-12)


def test_coarse_uneven_table_is_kept_at_its_own_angles():
    """30 rows about 12 degrees apart: sampled at 720 angles the spline keeps each to 1e-9 m."""
    theta = uniform_turn(30) + 0.05 * np.sin(np.arange(30))
    lift = Lift.from_samples(theta, smooth(theta))
    assert len(lift.theta) == 720
    np.testing.assert_allclose(lift(theta), smooth(theta), rtol=0, atol=1e-9)


def test_gap_limit_is_thirty_degrees():
    def table(gap):
        return np.radians(np.arange(361 - gap))

    Lift.from_samples(table(30), smooth(table(30)))
    with pytest.raises(InputError, match="gap"):
        Lift.from_samples(table(31), smooth(table(31)))


def swapped(theta):
    order = np.arange(len(theta))
    order[[10, 11]] = [11, 10]
    return theta[order]


@pytest.mark.parametrize(
    ("theta", "why"),
    [
        (swapped(THETA), "strictly increasing"),
        (np.where(np.arange(360) == 12, THETA[11], THETA), "strictly increasing"),
        (np.where(np.arange(360) == 12, np.nan, THETA), "finite"),
        (THETA * 2, "within one turn"),
        (THETA[:200], "gap"),
        (THETA[::-1], "strictly increasing"),
    ],
)
def test_refuses_a_table(theta, why):
    with pytest.raises(InputError, match=why):
        Lift.from_samples(theta, smooth(theta))


def test_refuses_a_table_that_does_not_close():
    values = np.append(smooth(THETA), smooth(0.0) + 1.01e-6)
    with pytest.raises(InputError, match="closure"):
        Lift.from_samples(np.append(THETA, 2 * np.pi), values)


def test_refuses_a_table_below_zero_or_of_other_length():
    with pytest.raises(InputError, match=r"lift.values"):
        Lift.from_samples(THETA + 0.1, smooth(THETA) - 1e-3)
    with pytest.raises(InputError, match="as many values"):
        Lift.from_samples(THETA, smooth(THETA)[1:])
    with pytest.raises(InputError, match=">= 12 angles"):
        Lift.from_samples(uniform_turn(11), np.zeros(11))
    with pytest.raises(InputError):
        Lift.from_samples([], [])

"""The smoothers: linear, zero phase, mean kept, nothing amplified."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.errors import InputError
from camwright.pipeline.case.requirements_section import Smoothing
from camwright.pipeline.smoothing.smoothers import KINDS, Smoother, smoothed
from camwright.pipeline.torque.period import FOUR_STROKE

COUNT = 720
CYCLE = FOUR_STROKE.angle
CRANK = np.arange(COUNT) * CYCLE / COUNT
ROUND_OFF = 1e-12  # of values of order one, through one FFT there and back


def torque(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=COUNT)


def every_smoother() -> list[Smoother]:
    return [
        *(Smoother(kind, strength=s) for kind in KINDS for s in (0.7, 1.0, 1.37, 3.0)),
        Smoother("moving_average", points=7),
        Smoother("moving_average", points=1),
        Smoother("harmonic", taper=0.0),
        Smoother("savitzky_golay", points=24, degree=4),
        Smoother("savitzky_golay", points=9, degree=0),
    ]


@pytest.mark.parametrize("smoother", every_smoother(), ids=repr)
def test_mean_is_kept(smoother):
    before = torque(1) + 3.0
    assert smoothed(before, smoother).mean() == pytest.approx(before.mean(), abs=ROUND_OFF)
    assert smoother.transfer(0.0) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("smoother", every_smoother(), ids=repr)
def test_linear(smoother):
    a, b = torque(1), torque(2)
    both = smoothed(2.0 * a - 3.0 * b, smoother)
    apart = 2.0 * smoothed(a, smoother) - 3.0 * smoothed(b, smoother)
    np.testing.assert_allclose(both, apart, atol=10 * ROUND_OFF)


@pytest.mark.parametrize("smoother", every_smoother(), ids=repr)
def test_zero_phase_a_mirrored_torque_gives_the_mirrored_result(smoother):
    before = torque(3)
    mirrored = smoothed(before[::-1], smoother)
    np.testing.assert_allclose(mirrored, smoothed(before, smoother)[::-1], atol=ROUND_OFF)


@pytest.mark.parametrize("smoother", every_smoother(), ids=repr)
def test_a_shifted_torque_gives_the_shifted_result(smoother):
    before = torque(4)
    shifted = smoothed(np.roll(before, 17), smoother)
    np.testing.assert_allclose(shifted, np.roll(smoothed(before, smoother), 17), atol=ROUND_OFF)


@pytest.mark.parametrize("smoother", every_smoother(), ids=repr)
def test_no_harmonic_is_amplified(smoother):
    # Between the integers too, since strength stretches the axis.
    factors = smoother.transfer(np.linspace(0.0, 720.0, 20_001))
    assert np.abs(factors).max() <= 1.0 + 1e-14


@settings(max_examples=60, deadline=None)
@given(
    kind=st.sampled_from(KINDS),
    points=st.integers(1, 60),
    strength=st.floats(0.1, 10.0),
    degree=st.integers(0, 5),
)
def test_no_harmonic_is_amplified_whatever_the_window(kind, points, strength, degree):
    smoother = Smoother(kind, points=points, degree=degree, strength=strength)
    assert np.abs(smoother.transfer(np.arange(361))).max() <= 1.0 + 1e-12


def test_none_changes_nothing():
    np.testing.assert_array_equal(smoothed(torque(5), Smoother("none")), torque(5))


@pytest.mark.parametrize(("count", "points", "spacing"), [(144, 12, 5.0), (720, 12, 1.0)])
def test_moving_average_is_the_average_of_its_samples(count, points, spacing):
    # Sampled at the filter's own spacing the band limit is idle and the sum is the filter.
    before = np.random.default_rng(0).normal(size=count)
    weights = np.r_[0.5, np.ones(points - 1), 0.5] / points
    offsets = np.arange(points + 1) - points // 2
    expected = sum(w * np.roll(before, -o) for w, o in zip(weights, offsets, strict=True))
    smoother = Smoother("moving_average", points=points, spacing=np.deg2rad(spacing))
    np.testing.assert_allclose(smoothed(before, smoother), expected, atol=ROUND_OFF)


def test_moving_average_of_an_odd_count_has_equal_weights():
    before = np.random.default_rng(0).normal(size=144)
    expected = sum(np.roll(before, o) for o in (-2, -1, 0, 1, 2)) / 5
    smoother = Smoother("moving_average", points=5, spacing=np.deg2rad(5.0))
    np.testing.assert_allclose(smoothed(before, smoother), expected, atol=ROUND_OFF)


def test_moving_average_removes_what_its_samples_cannot_carry():
    smoother = Smoother("moving_average", points=12, spacing=np.deg2rad(10.0))
    # 10 deg samples carry 36 harmonics of the cycle; the 37th would fold back.
    assert smoother.transfer(37) == 0.0
    assert smoother.transfer(72) == 0.0


def test_the_papers_window_is_sixty_degrees_of_crank():
    smoother = Smoother("moving_average", points=12, spacing=np.deg2rad(5.0))
    assert np.rad2deg(smoother.angular_width) == pytest.approx(60.0)
    # A harmonic that fits the window a whole number of times averages to nothing.
    assert smoother.transfer(12) == pytest.approx(0.0, abs=1e-15)


def test_gaussian_and_moving_average_of_one_width_agree_on_slow_torque():
    box = Smoother("moving_average", points=600, spacing=np.deg2rad(0.1))
    bell = Smoother("gaussian", width=box.angular_width)
    low = np.array([0.5, 1.0, 2.0])
    # Same variance: they part at fourth order, (w dphi)^4 / 720 at harmonic 2, w = 1.
    np.testing.assert_allclose(bell.transfer(low), box.transfer(low), atol=3e-3)
    assert abs(float(bell.transfer(2) - box.transfer(2))) < 0.01 * float(1 - box.transfer(2))


def test_savitzky_golay_leaves_a_slow_parabola_alone():
    smoother = Smoother("savitzky_golay", points=12, degree=3)
    # A cubic fit errs at fourth order: 1 - H ~ 16-fold from one octave to the next.
    errors = 1.0 - smoother.transfer(np.array([0.25, 0.5]))
    assert errors[1] / errors[0] == pytest.approx(16.0, rel=0.02)


def test_hard_and_soft_harmonic_cut():
    hard = Smoother("harmonic", harmonics=6, taper=0.0)
    np.testing.assert_array_equal(hard.transfer(np.arange(9)), [1, 1, 1, 1, 1, 1, 1, 0, 0])
    soft = Smoother("harmonic", harmonics=8, taper=0.25)
    expected = [1.0, 1.0, 0.5 + 0.5**1.5, 0.5, 0.5 - 0.5**1.5, 0.0]
    np.testing.assert_allclose(soft.transfer([5, 6, 7, 8, 9, 10]), expected, atol=1e-15)


@pytest.mark.parametrize("kind", [k for k in KINDS if k != "none"])
def test_strength_scales_the_width_and_stretches_the_filter(kind):
    one, two = Smoother(kind), Smoother(kind, strength=2.0)
    assert two.angular_width == pytest.approx(2.0 * one.angular_width)
    assert two.transfer(5) == pytest.approx(float(one.transfer(10)))
    assert f"{np.rad2deg(two.angular_width):.4g} deg" in two.width_in_words


@pytest.mark.parametrize("kind", ["moving_average", "gaussian", "harmonic", "savitzky_golay"])
def test_strength_acts_continuously(kind):
    before = torque(6)
    near = [smoothed(before, Smoother(kind, strength=s)) for s in (1.2, 1.2 + 1e-9)]
    np.testing.assert_allclose(near[0], near[1], atol=1e-6)


@pytest.mark.parametrize("kind", ["moving_average", "gaussian", "harmonic", "savitzky_golay"])
def test_more_strength_takes_more_away(kind):
    slow_and_fast = np.cos(CRANK) + np.cos(3 * CRANK)  # harmonics 2 and 6
    left = [np.std(smoothed(slow_and_fast, Smoother(kind, strength=s))) for s in (1.0, 1.5, 2.0)]
    assert left[0] >= left[1] >= left[2]
    assert left[0] > left[2]


def test_many_cycles_at_once():
    both = np.stack([torque(7), torque(8)])
    np.testing.assert_array_equal(smoothed(both, Smoother())[1], smoothed(torque(8), Smoother()))


def test_result_is_read_only():
    assert not smoothed(torque(9), Smoother()).flags.writeable


def test_from_case_takes_every_field_of_the_section():
    section = Smoothing(kind="gaussian", width="40 deg", harmonics=9.0, degree=3)
    smoother = Smoother.from_case(section, FOUR_STROKE)
    assert (smoother.kind, smoother.width) == ("gaussian", np.radians(40.0))
    assert (smoother.harmonics, smoother.degree) == (9.0, 3)
    assert Smoother.from_case(Smoothing(kind="none"), FOUR_STROKE).angular_width == 0.0


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"width": "80 deg"}, "smoothing.kind = missing, must be given with smoothing.width"),
        ({"kind": "moving_average", "width": "80 deg"}, "smoothing.points = missing, must be given"
         ": kind = moving_average does not use smoothing.width"),
        ({"kind": "gaussian", "points": 9, "spacing": "5 deg"}, "smoothing.width = missing, must"),
        ({"kind": "harmonic", "cutoff": "90 deg"}, "smoothing.harmonics = missing, must be given"),
        ({"kind": "savitzky_golay", "taper": 0.1}, "smoothing.points = missing, must be given"),
        ({"kind": "smoothing_spline", "degree": 3}, "smoothing.cutoff = missing, must be given"),
    ],
)  # fmt: skip
def test_a_stated_width_is_used_or_refused(stated, message):
    with pytest.raises(InputError, match=re.escape(message)):
        Smoothing(**stated)


@pytest.mark.parametrize("kind", KINDS[1:])
def test_several_filters_may_be_stated_and_none_of_no_kind(kind):
    every = {"points": 9, "width": "80 deg", "harmonics": 9.0, "cutoff": "90 deg"}
    assert Smoothing(kind=kind, **every).kind == kind
    assert Smoothing(kind="none", **every).kind == "none"
    assert Smoothing(kind=kind).kind == kind


def test_a_smoother_has_the_defaults_of_its_section():
    assert Smoother.from_case(Smoothing(kind=Smoother().kind), FOUR_STROKE) == Smoother()


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("kind", "magic"),
        ("points", 0),
        ("spacing", 0.0),
        ("spacing", np.nan),
        ("spacing", 2.0),
        ("width", 0.0),
        ("width", np.nan),
        ("harmonics", 0.5),
        ("harmonics", np.nan),
        ("taper", 1.0),
        ("degree", -1),
        ("strength", 0.0),
        ("strength", np.nan),
        ("strength", np.inf),
    ],
)
def test_a_value_out_of_bounds_is_named(field, value):
    with pytest.raises(InputError, match=f"smoothing.{field}"):
        Smoother(**{field: value})


def test_nan_torque_is_refused():
    with pytest.raises(InputError, match="torque"):
        smoothed(np.full(8, np.nan), Smoother())

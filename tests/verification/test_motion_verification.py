"""Motion laws: derivatives, peak factors, ends and joints."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion

STEP = 1e-30  # of the complex step: no difference is taken, so nothing cancels

# Textbook peak factors, Norton (2009): printed to four or five digits.
FACTORS = {
    "parabolic": 4.0,
    "harmonic": 4.9348,
    "cycloidal": 6.2832,
    "modified_trapezoid": 4.888,
    "modified_sine": 5.528,
    "polynomial_345": 5.7735,
    "polynomial_4567": 7.5132,
}
# Highest derivative that is continuous where the law meets a dwell; Norton (2009), ch. 2.
CONTINUITY = {
    "parabolic": 1,
    "harmonic": 1,
    "cycloidal": 2,
    "modified_trapezoid": 2,
    "modified_sine": 2,
    "polynomial_345": 2,
    "polynomial_4567": 3,
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("order", [1, 2, 3])
def test_derivatives_are_those_of_a_complex_step(name, order):
    law = LAWS[name]
    x = np.linspace(0.003, 0.997, 331)  # none of them a corner of a law
    step = law(x + 1j * STEP, order - 1).imag / STEP
    scale = np.abs(law(x, order)).max() or 1.0
    np.testing.assert_allclose(law(x, order), step, rtol=0, atol=1e-9 * scale)


@pytest.mark.parametrize("name", LAWS)
def test_greatest_acceleration_is_the_textbook_factor(name, measured):
    law = LAWS[name]
    peak = np.abs(law(np.linspace(0, 1, 200_001), 2)).max()
    digits = len(str(FACTORS[name]).split(".")[1])
    assert round(peak, digits) == FACTORS[name]
    measured(f"Peak acceleration of the law {name}, Norton", peak, FACTORS[name], rtol=1e-4)


@pytest.mark.parametrize("name", LAWS)
def test_ends_are_exact_and_rest_as_far_as_the_law_promises(name):
    law, start, end = LAWS[name], np.array(0.0), np.array(1.0)
    assert law(start) == 0.0
    assert law(end) == 1.0
    for order in range(1, CONTINUITY[name] + 1):
        assert abs(law(start, order)) <= 1e-14
        assert abs(law(end, order)) <= 1e-14
    if CONTINUITY[name] < 3:
        assert abs(law(start, CONTINUITY[name] + 1)) > 1.0


@pytest.mark.parametrize("name", LAWS)
def test_law_is_continuous_inside_as_far_as_it_promises(name):
    # the inner corners of the pieced laws; 1e-12 beside them nothing moves but by rounding
    law, corners = LAWS[name], np.array([0.125, 0.375, 0.5, 0.625, 0.875])
    for order in range((2 if name != "parabolic" else 1) + 1):
        before, behind = law(corners - 1e-13, order), law(corners + 1e-13, order)
        np.testing.assert_allclose(before, behind, rtol=0, atol=1e-10)


def test_rise_never_turns_back():
    for law in LAWS.values():
        assert (law(np.linspace(0, 1, 2001), 1) >= 0).all()


laws = st.sampled_from(sorted(LAWS))


@st.composite
def motions(draw):
    """A rise, a dwell, a return and a dwell of random laws, one to four times a turn."""
    repeat = draw(st.integers(1, 4))
    shares = np.array([draw(st.floats(0.2, 1.0)) for _ in range(4)])
    angles = shares / shares.sum() * 2 * np.pi / repeat
    stroke = draw(st.floats(1e-3, 0.02))
    return SegmentMotion(
        (
            Segment(draw(laws), angles[0], stroke),
            Segment("dwell", angles[1]),
            Segment(draw(laws), angles[2], -stroke),
            Segment("dwell", angles[3]),
        ),
        repeat,
    )


@settings(max_examples=60, deadline=None)
@given(motions())
def test_motion_joins_its_segments(motion):
    stroke = motion.segments[0].stroke
    joints = motion.joints
    angle = min(segment.angle for segment in motion.segments)
    before, behind = motion(joints - 1e-9 * angle), motion(joints)
    np.testing.assert_allclose(before, behind, rtol=0, atol=1e-7 * stroke)
    assert motion(joints[1]) == stroke
    assert motion(joints[2]) == stroke
    assert motion(joints[0]) == motion(joints[3]) == 0.0


@settings(max_examples=30, deadline=None)
@given(motions())
def test_motion_repeats_over_the_turn(motion):
    theta = uniform_turn(97)
    for order in range(4):
        here, later = motion(theta, order), motion(theta + motion.period, order)
        # round-off of the angle times the next derivative; corners are passed on either side
        scale = np.abs(here).max() or 1.0
        differs = np.abs(here - later) > 1e-9 * scale
        assert differs.sum() <= (0 if order < 2 else 8 * motion.repeat)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_motion_derivative_is_a_high_order_difference(order):
    motion = SegmentMotion(
        (
            Segment("cycloidal", 2.0, 0.01),
            Segment("polynomial_4567", 2 * np.pi - 2.0, -0.01),
        )
    )
    # eight points, order h^8; within either segment, away from the joints
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    h, theta = 0.02, np.concatenate([np.linspace(0.1, 1.9, 40), np.linspace(2.1, 6.1, 40)])
    sampled = motion(theta + h * np.arange(-4, 5)[:, None], order - 1)
    slope = weights @ sampled / h
    scale = np.abs(motion(theta, order)).max()
    np.testing.assert_allclose(motion(theta, order), slope, rtol=0, atol=1e-9 * scale)


def test_sampled_lift_follows_a_smooth_law():
    motion = SegmentMotion(
        (Segment("polynomial_4567", np.pi, 0.01), Segment("cycloidal", np.pi, -0.01))
    )
    theta = np.linspace(0, 2 * np.pi, 1001)
    np.testing.assert_allclose(motion.lift(1440)(theta), motion(theta), rtol=0, atol=1e-10)
    assert motion.lift(1440).stroke == pytest.approx(0.01, abs=1e-10)


def test_jump_of_acceleration_does_not_ring():
    stroke, angle = 0.02, np.radians(60)
    motion = SegmentMotion(
        (Segment("harmonic", angle, stroke), Segment("harmonic", angle, -stroke),
         Segment("dwell", 2 * np.pi - 2 * angle))
    )  # fmt: skip
    lift, theta = motion.lift(), np.linspace(0, 2 * np.pi, 50_000)
    bound = np.abs(motion(theta, 2)).max()
    assert np.abs(lift(theta, 2)).max() <= bound * (1 + 1e-9)
    dwell = theta[(theta > 2 * angle + 0.01) & (theta < 2 * np.pi - 0.01)]
    assert lift(dwell, 2) == pytest.approx(0, abs=1e-12)
    step = 2 * np.pi / 2880
    assert np.abs(lift(theta) - motion(theta)).max() <= 1.01 * bound * step**2 / 4


def test_harmonic_without_a_dwell_is_met_exactly():
    motion = SegmentMotion((Segment("harmonic", np.pi, 0.01), Segment("harmonic", np.pi, -0.01)))
    assert not motion.jumps
    theta = np.linspace(0, 2 * np.pi, 500)
    np.testing.assert_allclose(motion.lift()(theta), 0.005 * (1 - np.cos(theta)), atol=1e-15)

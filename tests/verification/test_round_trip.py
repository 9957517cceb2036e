"""Round trip: a follower let down on the finished contour moves by the lift it came from."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.extrema import least
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.follower_height import face_height, roller_height
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve

# Of the stroke. The search knows the contour at 20 000 points only; the cubic through them misses
# a jump of curvature by some 1e-7 of the stroke, a smooth curve by 1e-12.
TOLERANCE = 1e-6
POINTS = 20_000
THETA = np.linspace(0, 2 * np.pi, 41)[:-1] + 0.0123

laws = st.sampled_from(sorted(LAWS))


@st.composite
def lifts(draw):
    """Random laws up and down, with or without dwells, once or twice a turn."""
    repeat = draw(st.sampled_from([1, 1, 1, 2]))
    rise, high, back = (draw(st.floats(0.25, 0.4)), draw(st.floats(0.02, 0.15)),
                        draw(st.floats(0.25, 0.4)))  # fmt: skip
    shares = np.array([rise, high, back, 1.0 - rise - high - back])
    assume(shares[3] > 0.01)
    angles = shares * 2 * np.pi / repeat
    stroke = draw(st.floats(0.002, 0.008)) / repeat
    return SegmentMotion(
        (
            Segment(draw(laws), angles[0], stroke),
            Segment("dwell", angles[1]),
            Segment(draw(laws), angles[2], -stroke),
            Segment("dwell", angles[3]),
        ),
        repeat,
    ).lift(720)


@settings(max_examples=25, deadline=None)
@given(lifts(), st.floats(-0.012, 0.012), st.floats(0.004, 0.012))
def test_roller_let_down_on_the_contour_moves_by_the_lift(lift, offset, roller):
    pitch = PitchCurve(lift, 0.045, offset)
    contour = RollerContour(pitch, roller)
    assume(not contour.undercut().present and contour.second_contact().clearance > 0)
    found = roller_height(contour.polygon(POINTS), roller, offset, THETA)
    np.testing.assert_allclose(
        found - pitch.height_base, lift(THETA), rtol=0, atol=TOLERANCE * lift.stroke
    )


@settings(max_examples=25, deadline=None)
@given(lifts(), st.floats(-0.01, 0.01))
def test_face_let_down_on_the_contour_moves_by_the_lift(lift, offset):
    bend = least(lambda theta: lift(theta) + lift(theta, 2), lift.search_count).value
    base = max(0.003 - bend, 0.011)  # radius of curvature r + s + s'' of 3 mm at least
    contour = FlatFaceContour(FacePath(lift, base, offset))
    found = face_height(contour.polygon(POINTS), THETA)
    np.testing.assert_allclose(found - base, lift(THETA), rtol=0, atol=TOLERANCE * lift.stroke)


def test_undercut_contour_cannot_give_its_lift_back():
    lift = SegmentMotion(
        (
            Segment("harmonic", np.pi / 8, 0.012),
            Segment("harmonic", np.pi / 8, -0.012),
            Segment("dwell", 7 * np.pi / 4),
        )
    ).lift()
    contour = RollerContour(PitchCurve(lift, 0.015), 0.002)
    assert contour.undercut().present
    theta = np.linspace(0.3, 0.5, 101)
    # the tails beyond the cusps stand proud of the true cam: the follower misses the motion
    away = roller_height(contour.polygon(POINTS), 0.002, 0.0, theta) - 0.015 - lift(theta)
    assert np.abs(away).max() > 1e-4 * lift.stroke


def test_follower_beside_the_cam_is_refused():
    circle = 0.01 * np.array([np.cos(THETA), np.sin(THETA)])
    with pytest.raises(GeometryError, match="line of travel"):
        roller_height(circle, 0.002, 0.05, THETA)
    with pytest.raises(InputError, match="polygon"):
        face_height(circle[:, :5], THETA)

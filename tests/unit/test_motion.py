"""Segments of a lift: what is refused."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion

TURN = 2 * np.pi
RISE, RETURN = Segment("cycloidal", TURN / 4, 0.01), Segment("cycloidal", TURN / 4, -0.01)
DWELL = Segment("dwell", TURN / 2)


def test_segments_short_of_a_turn_are_refused():
    with pytest.raises(InputError, match=r"lift\.segment\.angle = 180 deg in all"):
        SegmentMotion((RISE, RETURN))


def test_segments_beyond_a_turn_are_refused():
    with pytest.raises(InputError, match="360 deg in all, the turn over"):
        SegmentMotion((RISE, RETURN, DWELL, Segment("dwell", 1e-6)))


def test_segments_fill_a_part_of_the_turn_when_repeated():
    tripled = SegmentMotion(
        (Segment("cycloidal", TURN / 6, 0.01), Segment("harmonic", TURN / 6, -0.01)), 3
    )
    assert tripled.period == pytest.approx(TURN / 3)
    assert tripled(TURN / 2) == pytest.approx(0.01)


@pytest.mark.parametrize("repeat", [0, -1, 13])
def test_repetition_has_bounds(repeat):
    with pytest.raises(InputError, match=r"lift\.repeat"):
        SegmentMotion((RISE, RETURN, DWELL), repeat)


def test_lift_that_does_not_close_is_refused():
    with pytest.raises(InputError, match="must close"):
        SegmentMotion((RISE, Segment("cycloidal", TURN / 4, -0.0099), DWELL))


def test_dwells_alone_are_no_motion():
    with pytest.raises(InputError, match="a rise and a return"):
        SegmentMotion((Segment("dwell", TURN),))
    with pytest.raises(InputError, match="at least one"):
        SegmentMotion(())


@pytest.mark.parametrize(
    ("law", "angle", "stroke", "field"),
    [
        ("cubic", 1.0, 0.01, "law"),
        ("cycloidal", 0.0, 0.01, "angle"),
        ("cycloidal", -1.0, 0.01, "angle"),
        ("cycloidal", np.nan, 0.01, "angle"),
        ("cycloidal", 7.0, 0.01, "angle"),
        ("cycloidal", 1.0, np.nan, "stroke"),
        ("cycloidal", 1.0, np.inf, "stroke"),
        ("cycloidal", 1.0, 0.0, "stroke"),
        ("dwell", 1.0, 0.01, "stroke"),
    ],
)
def test_bad_segment_is_refused(law, angle, stroke, field):
    with pytest.raises(InputError, match=rf"segment\.{field}"):
        Segment(law, angle, stroke)


def test_motion_that_starts_with_a_return_still_lifts():
    motion = SegmentMotion((RETURN, DWELL, RISE))
    assert motion(0.0) == 0.01
    assert motion(TURN / 2) == 0.0


def test_fourth_derivative_is_not_given():
    with pytest.raises(InputError, match="derivative"):
        LAWS["harmonic"](0.5, 4)

"""Walls of a groove against the circles that they must be, and against the cam under its roller."""

import numpy as np
import pytest

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.form_closure import Groove, GrooveStep
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve

COUNT = 720
THETA = uniform_turn(COUNT)
WAVE = Lift(THETA, 0.004 * (1.0 - np.cos(3.0 * THETA)))


def test_a_groove_along_a_circle_has_circular_walls():
    """An eccentric path of radius R: walls of radii R -+ (r + c/2) about its centre."""
    centre = 0.008 * np.cos(THETA) + np.sqrt(0.048**2 - (0.008 * np.sin(THETA)) ** 2)
    groove = Groove(PitchCurve(Lift(THETA, centre - 0.040), 0.040), 0.010, 0.0004)
    theta = np.linspace(0.0, FULL_TURN, 31)
    middle = 0.5 * (groove.pitch.points(0.0) + groove.pitch.points(np.pi))
    for side, radius in (("inner", 0.048 - 0.0102), ("outer", 0.048 + 0.0102)):
        away = np.hypot(*(groove.points(theta, side) - middle[:, None]))
        assert away == pytest.approx(radius, rel=1e-9)
    step = GrooveStep(0.0, 0.01, groove.half_width, groove.half_width)
    area, moment = step.section(groove.pitch)
    ring = np.pi * ((0.048 + 0.0102) ** 2 - (0.048 - 0.0102) ** 2)
    assert area == pytest.approx(ring, rel=1e-9)
    assert moment == pytest.approx(ring * middle, rel=1e-7, abs=1e-12)


def test_the_inner_wall_without_clearance_is_the_cam_under_the_roller():
    """Of a lift with concave flanks, and the outer wall mirrors it about the path."""
    pitch = PitchCurve(WAVE, 0.040, 0.003)
    groove, cam = Groove(pitch, 0.008), RollerContour(pitch, 0.008)
    assert groove.points(THETA, "inner") == pytest.approx(cam.points(THETA), abs=1e-15)
    both = groove.points(THETA, "inner") + groove.points(THETA, "outer")
    assert 0.5 * both == pytest.approx(pitch.points(THETA), abs=1e-15)
    # the area between the walls by their polygons; 720 chords miss 4e-5 of it
    x, y = groove.points(THETA, "outer")
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) - cam.area()
    step = GrooveStep(0.0, 0.01, groove.half_width, groove.half_width)
    assert step.section(pitch)[0] == pytest.approx(area, rel=5e-4)
    assert groove.second_contact("outer").clearance > 0.0

"""What limits cost: the envelope of the cam as a limit, and prices against designs solved again."""

import numpy as np
import pytest

from geometry.arrays import uniform_turn
from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.smoothing.constraints import Jet, Machine, Ratings, shape_utilisations


@pytest.mark.parametrize("offset", [0.0, 0.004])
def test_room_for_the_cam_is_that_of_its_contour(offset):
    theta = uniform_turn(360)
    lift = Lift(theta, 0.01 * (1 - np.cos(2 * theta)))
    radius = np.hypot(*Contour(PitchCurve(lift, 0.05, offset), 0.008).points(theta))
    ratings = Ratings(roller_radius=0.008, offset=offset, cam_radius=0.06)
    found = shape_utilisations(Jet(*lift.derivatives(theta, 2)), Machine(1e4, 1e2, 0.05), ratings)
    np.testing.assert_allclose(0.06 * found["cam_envelope"], radius, rtol=1e-12)

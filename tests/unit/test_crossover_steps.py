"""Landing within a step of a flight against a bracketing solver."""

import numpy as np
from scipy.optimize import brentq

from camwright.pipeline.follower.crossover import INNER, OUTER, FlightStep


def test_a_flight_lands_where_it_reaches_the_wall():
    """1000 steps that end beyond a wall, of either sense, to 1e-12 of a step."""
    draw, tried = np.random.default_rng(3), 0
    while tried < 1000:
        start, first, second = draw.uniform(0.0, 1.0), *draw.normal(0.0, 4.0, 2)
        step = FlightStep(start, draw.normal(), first, second, 1.0, (1.0, draw.uniform(0.8, 1.2)))
        for side in (INNER, OUTER):
            if step.room(1.0, side) < 0.0 < step.room(0.0, side):
                places = np.linspace(0.0, 1.0, 401)
                rooms = np.array([step.room(place, side) for place in places])
                if np.count_nonzero(np.diff(np.sign(rooms))) == 1:
                    wanted = brentq(step.room, 0.0, 1.0, args=(side,), xtol=1e-14)
                    assert abs(step.lands(side) - wanted) < 1e-12
                    tried += 1


def test_a_flight_that_is_beyond_the_wall_all_along_lands_at_its_begin():
    step = FlightStep(-1e-9, -1.0, 0.0, 0.0, 1e-3, (1e-4, 1e-4))
    assert step.lands(INNER) < 1e-12

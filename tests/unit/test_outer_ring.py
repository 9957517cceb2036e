"""The outer ring of a case's bearing: when it is the roller, and what a case may say of it."""

from dataclasses import replace

import numpy as np
import pytest
from bearing_files import read_cards
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.ring_body import BallRing, RingBody
from camwright.pipeline.contact.rolling_bearing import OuterRing
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair

RING = {
    "outer_diameter": '"32 mm"',
    "thickness": '"3.2 mm"',
    "pitch_diameter": '"20 mm"',
    "balls": "8",
}


def case(**changes):
    """The template's roller of 32 mm as a track roller's ring."""
    rows = "\n".join(f"{key} = {value}" for key, value in (RING | changes).items() if value)
    return parse_case(small_machine("ring") + f"\n[roller.bearing.ring]\n{rows}\n")


def pair_of(given, contour):
    """The contact pair of a case with one load case."""
    machine = machines(given)[0]
    return contact_pair(machine, contour)


def ring_of(given, width=0.01):
    return given.roller.ring(width, given.spring.preload)


def a_contour():
    theta = uniform_turn(360)
    return RollerContour(PitchCurve(Lift(theta, 4e-3 * (1 - np.cos(theta))), 0.06), 0.016)


def test_a_case_may_tell_of_the_ring_itself():
    given = case()
    assert given.roller.solid_reason == ""
    pair = pair_of(given, a_contour())
    assert isinstance(pair.follower, RingBody)
    assert pair.follower.ring.thickness == pytest.approx(3.2e-3)
    assert "outer ring of its bearing on balls" in given.roller.body_model
    assert parse_case(given.to_toml()) == given
    assert "None" not in repr(pair.follower)  # all of it is in the fingerprint of the contact


def test_without_a_ring_the_roller_stays_solid():
    plain = parse_case(small_machine("plain"))
    assert isinstance(pair_of(plain, a_contour()).follower, RollerBody)
    assert ring_of(plain) is None
    assert "ring and balls of the bearing are not specified" in plain.roller.body_model
    tyre = case(outer_diameter='"26 mm"', thickness='"1 mm"')
    assert isinstance(pair_of(tyre, a_contour()).follower, RollerBody)
    assert ring_of(tyre) is None
    assert "not the outer ring of the bearing" in tyre.roller.solid_reason
    assert "roller solid on its hub" in tyre.roller.body_model


def test_between_two_balls_the_pressure_is_lower_by_what_is_told():
    """`midway` against both contacts solved: to a fiftieth of the change."""
    given, contour = case(thickness='"2 mm"', pitch_diameter='"23 mm"'), a_contour()
    pair, theta = pair_of(given, contour), np.array([0.5, 2.0])
    ring = ring_of(given, pair.width)
    force = np.array([2000.0, 6000.0])
    over, between = (
        two_scale_history(moved, CycleBodies.meshed(moved), theta, force)
        for moved in (pair, replace(pair, follower=ring.between_balls))
    )
    found = ring.midway(force / pair.width, over.relative_radius)
    assert (found < -2e-3).all()
    np.testing.assert_allclose(found, between.p0 / over.p0 - 1.0, rtol=0.02)


def test_stiffer_balls_take_more_of_the_load_alone():
    """The static rating sets their stiffness; without it the preload does."""
    rated = ring_of(case())
    text = small_machine("ring").replace('C0 = "8.3 kN"', "")
    rows = "\n".join(f"{key} = {value}" for key, value in RING.items())
    unrated = ring_of(parse_case(text + f"\n[roller.bearing.ring]\n{rows}\n"))
    assert unrated.ring.ball_stiffness < rated.ring.ball_stiffness
    share = (rated.bending.ball_load[0].max(), unrated.bending.ball_load[0].max())
    assert share[0] > share[1]


def test_two_rows_share_the_load():
    """Each ball then carries half, and two of them give way less than one under all of it."""
    one, two = (ring_of(case(rows=rows)).ring.ball_stiffness for rows in ("1", "2"))
    assert two / one == pytest.approx(2.0 ** (2.0 / 3.0), rel=1e-12)  # way goes with F^(2/3)
    card = read_cards()["track_roller_32x14"]
    assert card.bearing.ring.rows == 2


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"balls": "2"}, r"ring\.balls = 2, must be >= 3"),
        ({"balls": "7.5"}, "a whole number"),
        ({"rows": "0"}, r"ring\.rows = 0, must be >= 1"),
        ({"balls": "20"}, "fewer: they overlap"),
        ({"thickness": '"0 mm"'}, r"ring\.thickness = 0 mm, must be > 0"),
        ({"thickness": "3.2"}, "a number with a unit"),
        ({"thickness": '"nan mm"'}, "finite"),
        ({"thickness": '"7 mm"'}, "leave the balls room"),
        ({"thickness": '"7 mm"', "pitch_diameter": '"14 mm"'}, "a thin ring"),
        ({"pitch_diameter": ""}, r"ring\.pitch_diameter = missing"),
        ({"colour": "1"}, r"ring\.colour = unknown key"),
        ({"fatigue_bending": '"0 MPa"'}, r"fatigue_bending = 0 MPa, must be > 0"),
    ],
)
def test_refuses_a_ring_that_cannot_be(changes, match):
    with pytest.raises(InputError, match=match):
        case(**changes)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"balls": 2}, "balls"),
        ({"balls": 20}, "balls"),
        ({"rows": 0}, "rows"),
        ({"thickness": np.nan}, "thickness"),
        ({"thickness": 7e-3}, "outer_diameter"),
        ({"thickness": 7e-3, "pitch_diameter": 14e-3}, "thickness"),
        ({"fatigue_bending": 0.0}, "fatigue_bending"),
    ],
)
def test_a_ring_that_cannot_be_is_refused_when_built_in_python_as_well(change, name):
    good = {"outer_diameter": 32e-3, "thickness": 3.2e-3, "pitch_diameter": 20e-3, "balls": 8}
    with pytest.raises(InputError) as refusal:
        OuterRing(**(good | change))
    assert refusal.value.field == f"roller.bearing.ring.{name}"


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"thickness": 0.0}, "thickness"),
        ({"footprint": np.nan}, "footprint"),
        ({"balls": ()}, "balls"),
    ],
)
def test_a_ring_on_nothing_is_refused(change, name):
    good = {"thickness": 1e-3, "balls": (0.0,), "ball_stiffness": 1e7, "footprint": 1e-4}
    with pytest.raises(InputError, match=f"ring.{name}"):
        BallRing(**(good | change))

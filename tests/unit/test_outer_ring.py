"""The outer ring of a case's bearing: when it is the roller, and what a case may say of it."""

from dataclasses import replace

import numpy as np
import pytest
from bearing_files import read_cards

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.cards.bearing_cards import as_case_table
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.outer_ring import outer_ring, roller_in_words, why_solid
from camwright.pipeline.case.template import template
from camwright.pipeline.contact.contact_pair import CycleBodies, pair_history
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.ring_body import BallRing, RingBody
from camwright.pipeline.cycle.contact_setup import contact_pair, contact_width

RING = {
    "outer_diameter": '"32 mm"',
    "thickness": '"3.2 mm"',
    "pitch_diameter": '"20 mm"',
    "balls": "8",
}


def case(**changes):
    """The template's roller of 32 mm as a track roller's ring."""
    rows = "\n".join(f"{key} = {value}" for key, value in (RING | changes).items() if value)
    return parse_case(template("ring") + f"\n[roller.bearing.ring]\n{rows}\n")


def a_contour():
    theta = uniform_turn(360)
    return RollerContour(PitchCurve(Lift(theta, 4e-3 * (1 - np.cos(theta))), 0.06), 0.016)


def test_a_case_may_tell_of_the_ring_itself():
    given = case()
    assert why_solid(given) == ""
    pair = contact_pair(given, a_contour())
    assert isinstance(pair.follower, RingBody)
    assert pair.follower.ring.thickness == pytest.approx(3.2e-3)
    assert "outer ring on balls" in roller_in_words(given)
    assert parse_case(given.to_toml()) == given
    assert "None" not in repr(pair.follower)  # all of it is in the fingerprint of the contact


def test_without_a_ring_the_roller_stays_solid():
    plain = parse_case(template("plain"))
    assert isinstance(contact_pair(plain, a_contour()).follower, RollerBody)
    assert outer_ring(plain, 0.01) is None
    assert "no ring and balls of the bearing are given" in roller_in_words(plain)
    tyre = case(outer_diameter='"26 mm"', thickness='"1 mm"')
    assert isinstance(contact_pair(tyre, a_contour()).follower, RollerBody)
    assert "not the bearing's outer ring itself" in why_solid(tyre)


def test_between_two_balls_the_pressure_is_lower_by_what_is_told():
    """`midway` against both contacts solved: to a fiftieth of the change."""
    given, contour = case(thickness='"2 mm"', pitch_diameter='"23 mm"'), a_contour()
    pair, theta = contact_pair(given, contour), np.array([0.5, 2.0])
    ring = outer_ring(given, contact_width(given))
    force = np.array([2000.0, 6000.0])
    over, between = (
        pair_history(moved, CycleBodies.meshed(moved), theta, force)
        for moved in (pair, replace(pair, follower=ring.between_balls))
    )
    found = ring.midway(force / pair.width, over.relative_radius)
    assert (found < -2e-3).all()
    np.testing.assert_allclose(found, between.p0 / over.p0 - 1.0, rtol=0.02)


def test_stiffer_balls_take_more_of_the_load_alone():
    """The static rating sets their stiffness; without it the preload does."""
    rated = outer_ring(case(), 0.01)
    text = template("ring").replace('C0 = "8.3 kN"', "")
    rows = "\n".join(f"{key} = {value}" for key, value in RING.items())
    unrated = outer_ring(parse_case(text + f"\n[roller.bearing.ring]\n{rows}\n"), 0.01)
    assert unrated.ring.ball_stiffness < rated.ring.ball_stiffness
    share = (rated.bending.ball_load[0].max(), unrated.bending.ball_load[0].max())
    assert share[0] > share[1]


def test_two_rows_share_the_load():
    """Each ball then carries half, and two of them give way less than one under all of it."""
    one, two = (outer_ring(case(rows=rows), 0.01).ring.ball_stiffness for rows in ("1", "2"))
    assert two / one == pytest.approx(2.0 ** (2.0 / 3.0), rel=1e-12)  # way goes with F^(2/3)
    card = read_cards()["track_roller_32x14"]
    assert as_case_table(card)["ring"]["rows"] == 2


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"balls": "2"}, r"ring\.balls = 2, must be >= 3"),
        ({"balls": "7.5"}, "a whole number"),
        ({"rows": "0"}, r"ring\.rows = 0, must be >= 1"),
        ({"balls": "20"}, "do not overlap"),
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
        ({"thickness": 0.0}, "thickness"),
        ({"footprint": np.nan}, "footprint"),
        ({"balls": ()}, "balls"),
    ],
)
def test_a_ring_on_nothing_is_refused(change, name):
    good = {"thickness": 1e-3, "balls": (0.0,), "ball_stiffness": 1e7, "footprint": 1e-4}
    with pytest.raises(InputError, match=f"ring.{name}"):
        BallRing(**(good | change))

"""A flat face on an eccentric circle: everything has a closed form."""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.pipeline.follower.flat_face_motion import FaceSliding, face_motion
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    turn_integral,
)
from camwright.pipeline.follower.spring import Spring

THETA = uniform_turn(720)
E, RADIUS, SPEED = 0.004, 0.015, 200.0
OVERHANG, SPACING, PRELOAD, RATE, MASS = 0.02, 0.05, 300.0, 20e3, 0.1
SPRING = Spring(rate=RATE, preload=PRELOAD)
COS, SIN = np.cos(THETA), np.sin(THETA)
FREE = PRELOAD + RATE * E * (1 - COS) + MASS * SPEED**2 * E * COS


def path(offset=0.0):
    return FacePath(Lift(THETA, E * (1 - COS)), RADIUS - E, offset)


def loads(guide=0.0, face=0.0, offset=0.0):
    system = FollowerSystem(MASS, SPRING, SPACING, OVERHANG, guide, guide, face_friction=face)
    return follower_loads(path(offset), system, SPEED, THETA)


def test_force_and_torque_without_friction():
    found = loads()
    np.testing.assert_allclose(found.normal_force, FREE, rtol=1e-9)
    np.testing.assert_allclose(found.cam_torque, FREE * E * SIN, atol=1e-9)
    np.testing.assert_array_equal(found.pressure_angle, 0.0)
    np.testing.assert_array_equal(found.tangential_force, 0.0)


@pytest.mark.parametrize("offset", [0.0, 0.003])
def test_couple_of_the_push_is_held_by_the_guides(offset):
    found = loads(offset=offset)
    np.testing.assert_allclose(found.end_moment, FREE * (E * SIN - offset), atol=1e-9)
    np.testing.assert_allclose(found.reaction_a, -found.end_moment / SPACING, atol=1e-9)
    np.testing.assert_allclose(found.reaction_a, found.reaction_b, atol=1e-9)
    np.testing.assert_allclose(found.cam_torque, FREE * E * SIN, atol=1e-9)


@pytest.mark.parametrize(("guide", "face", "offset"), [(0.1, 0.08, 0.0), (0.15, 0.05, 0.002)])
def test_free_body_with_all_friction_is_in_balance(guide, face, offset):
    """Forces along and across the stem and moments about guide A, written out anew."""
    found = loads(guide, face, offset)
    push, drag = found.normal_force, face * found.normal_force
    a, b, rub = found.reaction_a, found.reaction_b, guide * np.sign(SIN)
    along = push - rub * (np.abs(a) + np.abs(b)) - FREE
    across = drag - a + b
    reach = OVERHANG + 2 * E - found.lift
    about_a = drag * reach - push * (E * SIN - offset) - b * SPACING
    moving = np.abs(SIN) > 1e-9  # at rest friction has no sense
    assert np.abs(along[moving]).max() < 1e-9 * push.max()
    assert np.abs(across).max() < 1e-12 * push.max()
    assert np.abs(about_a).max() < 1e-12 * push.max()


def test_cam_pays_for_the_heat_of_guides_and_face():
    """Work over the turn is friction times way, guides and face apart; none without friction."""
    found = loads(0.1, 0.08)
    guides = 0.1 * (np.abs(found.reaction_a) + np.abs(found.reaction_b)) * np.abs(E * SIN)
    face = 0.08 * found.normal_force * (RADIUS - E + found.lift)
    heat = turn_integral(THETA, guides + face)
    assert turn_integral(found.theta, found.cam_torque) == pytest.approx(heat, rel=1e-10)
    assert found.friction_loss == pytest.approx(heat, rel=1e-12)
    assert found.friction_power.mean() * 2 * np.pi / SPEED == pytest.approx(heat, rel=1e-12)
    assert abs(turn_integral(loads().theta, loads().cam_torque)) < 1e-10 * turn_integral(
        THETA, np.abs(loads().cam_torque)
    )


def test_surfaces_pass_as_on_a_turning_circle():
    """The disc's centre runs e sin below the stem: its rim goes by at w (r + s) along the face.

    Entrainment is the mean of what both surfaces do past the contact: for a circle w R/2 and the
    way of its centre, w e cos.
    """
    motion = face_motion(path(), SPEED, THETA)
    np.testing.assert_allclose(motion.sliding, SPEED * (RADIUS - E * COS), rtol=1e-12)
    mean = 0.5 * (RADIUS - E * COS) + E * COS
    np.testing.assert_allclose(motion.entrainment, SPEED * mean, rtol=1e-9)
    np.testing.assert_allclose(motion.place, E * SIN, atol=1e-12)
    sliding = FaceSliding.of(motion, np.full(720, 1e9), FREE, 0.08, SPEED)
    assert sliding.loss == pytest.approx(
        turn_integral(THETA, 0.08 * FREE * (RADIUS - E * COS)), rel=1e-12
    )
    np.testing.assert_allclose(sliding.pv, 0.25 * np.pi * 1e9 * motion.sliding, rtol=1e-15)


def test_friction_rests_in_a_dwell():
    """A drag of the face leans the stem there too, but nothing moves: the push is the spring's."""
    turn = 2 * np.pi
    motion = SegmentMotion(
        (Segment("cycloidal", 0.2 * turn, 0.006), Segment("cycloidal", 0.2 * turn, -0.006),
         Segment("dwell", 0.6 * turn))
    )  # fmt: skip
    system = FollowerSystem(MASS, SPRING, SPACING, OVERHANG, 0.1, 0.1, face_friction=0.08)
    found = follower_loads(FacePath(motion.lift(), 0.02), system, SPEED, THETA)
    dwell = np.abs(THETA - 0.7 * turn) < 0.28 * turn
    np.testing.assert_allclose(found.normal_force[dwell], PRELOAD, rtol=1e-12)
    assert (found.jam_index[dwell] > 0.01).all()


def test_face_is_needed_as_wide_as_the_contact_wanders():
    contour = FlatFaceContour(path(0.001))
    contour.require_face(2 * (E + 0.001) * 1.0001)
    with pytest.raises(InputError, match=r"follower\.face\.width = 9\.999999 mm, must be > 10 mm"):
        contour.require_face(2 * (E + 0.001) * 0.9999999)


@pytest.mark.parametrize("friction", [-0.1, np.nan, np.inf])
def test_bad_friction_of_the_face_is_refused(friction):
    with pytest.raises(InputError, match=r"follower\.face_friction"):
        loads(face=friction)

"""A flat face on an eccentric circle: everything has a closed form."""

import numpy as np
import pytest

from geometry.arrays import uniform_turn
from geometry.errors import ContactError, InputError
from geometry.flat_face import FacePath, FlatFaceContour
from geometry.lift import Lift
from pipeline.follower.flat_face import flat_face_loads
from pipeline.follower.forces import FollowerSystem, turn_integral

THETA = uniform_turn(720)
E, RADIUS, SPEED, WIDTH, MODULUS = 0.004, 0.015, 200.0, 0.008, 115e9
CONTOUR = FlatFaceContour(FacePath(Lift(THETA, E * (1 - np.cos(THETA))), RADIUS - E))


def loads(friction=0.0, contour=CONTOUR, **changes):
    system = FollowerSystem(0.1, 20e3, 300.0, 0.05, 0.02, friction, friction)
    given = {"cam_speed": SPEED, "contact_width": WIDTH, "contact_modulus": MODULUS} | changes
    return flat_face_loads(contour, system, theta=THETA, **given)


def test_force_torque_and_pressure():
    found = loads()
    force = 300 + 20e3 * E * (1 - np.cos(THETA)) + 0.1 * SPEED**2 * E * np.cos(THETA)
    np.testing.assert_allclose(found.normal_force, force, rtol=1e-9)
    np.testing.assert_allclose(found.cam_torque, force * E * np.sin(THETA), atol=1e-9)
    np.testing.assert_allclose(found.relative_radius, RADIUS, rtol=1e-8)
    pressure = np.sqrt(force / WIDTH * MODULUS / (np.pi * RADIUS))
    np.testing.assert_allclose(found.peak_pressure, pressure, rtol=1e-8)
    half = np.sqrt(4 * force / WIDTH * RADIUS / (np.pi * MODULUS))
    np.testing.assert_allclose(found.half_width, half, rtol=1e-8)


def test_moment_about_the_stem_is_held_by_the_guides():
    found = loads(0.1)
    np.testing.assert_allclose(found.reaction * 0.05, found.normal_force * found.arm, rtol=1e-14)


def test_cam_pays_for_the_guides_heat():
    found = loads(0.1)
    heat = turn_integral(THETA, 2 * 0.1 * np.abs(found.reaction * found.arm))
    assert turn_integral(THETA, found.cam_torque) == pytest.approx(heat, rel=1e-6)
    assert turn_integral(THETA, loads().cam_torque) == pytest.approx(0.0, abs=1e-12)


def test_face_carries_the_contact_to_its_edges():
    found = loads()
    assert 2 * E < found.face_needed < 2 * E + 2.01 * found.half_width.max()
    with pytest.raises(InputError, match=r"face\.width"):
        CONTOUR.require_face(0.99 * found.face_needed, found.half_width.max())


def test_undercut_is_refused():
    sharp = FlatFaceContour(FacePath(Lift(THETA, 0.001 * (1 - np.cos(5 * THETA))), 0.02))
    with pytest.raises(ContactError, match="undercut"):
        loads(contour=sharp)


@pytest.mark.parametrize(
    "change",
    [{"cam_speed": -1.0}, {"cam_speed": np.nan}, {"contact_width": 0.0},
     {"contact_width": np.nan}, {"contact_modulus": 0.0}],
)  # fmt: skip
def test_bad_input_is_refused(change):
    with pytest.raises(InputError):
        loads(**change)

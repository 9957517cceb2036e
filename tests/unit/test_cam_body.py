"""Key, gear, shaft bearings and unbalance against hand calculation."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.contact.cam_body import KeyFlanks, Keyway
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    counter_hole,
    key_stress,
    rotating_force,
    shaft_loads,
    torque_reversals,
    unbalance,
)

THETA = uniform_turn(720)
ECCENTRICITY, DISC, ROLLER = 2e-3, 40e-3, 8e-3
DENSITY, WIDTH = 7850.0, 5e-3


def eccentric():
    """A disc of radius 40 mm out of centre by 2 mm: pitch curve a circle of 48 mm."""
    far = DISC + ROLLER
    d = ECCENTRICITY * np.cos(THETA) + np.sqrt(far**2 - (ECCENTRICITY * np.sin(THETA)) ** 2)
    return RollerContour(PitchCurve(Lift(THETA, d - d.min()), float(d.min())), ROLLER)


def test_key():
    flanks = KeyFlanks(width=5e-3, length=9e-3, hub_height=1.6e-3, shaft_height=2.6e-3)
    stress = key_stress(np.array([20.0, -10.0]), 17e-3, flanks)
    force = np.array([20.0, -10.0]) / 8.5e-3
    np.testing.assert_allclose(stress.hub, force / (9e-3 * 1.6e-3))
    np.testing.assert_allclose(stress.shaft, force / (9e-3 * 2.6e-3))
    np.testing.assert_allclose(stress.shear, force / (9e-3 * 5e-3))
    with pytest.raises(InputError, match="length"):
        key_stress(1.0, 17e-3, flanks._replace(length=0.0))


@pytest.mark.parametrize(
    ("changes", "flanks"),
    [
        ({}, (5e-3, 9e-3, 1.6e-3, 2.6e-3)),  # DIN 6885-1: 5 x 5, t1 3 mm, chamfer up to 0.4 mm
        ({"form": "B"}, (5e-3, 10e-3, 1.6e-3, 2.6e-3)),  # 14 mm long in a cam of 10 mm
        ({"chamfer": 0.25e-3}, (5e-3, 9e-3, 1.75e-3, 2.75e-3)),
        ({"height": 6e-3}, (5e-3, 9e-3, 1.9e-3, 2.6e-3)),  # the hub is 2.3 mm deep
        ({"length": 8e-3, "shaft_depth": 3.2e-3}, (5e-3, 3e-3, 1.4e-3, 2.8e-3)),
    ],
)
def test_flanks_of_a_key(changes, flanks):
    cam = made.case().cam
    assert replace(cam, key=replace(cam.key, **changes)).key_flanks == pytest.approx(flanks)


def test_flanks_of_a_key_need_every_datum():
    cam = made.case().cam
    assert replace(cam, key=None).key_flanks is None
    assert replace(cam, key=replace(cam.key, length=None)).key_flanks is None
    odd = replace(cam, keyway=replace(cam.keyway, width=5.5e-3))
    assert odd.key_flanks is None
    missing = {name for name, value in odd.key_data.items() if value is None}
    assert missing == {"height", "shaft_depth", "chamfer"}
    stated = replace(cam.key, height=5e-3, shaft_depth=3e-3, chamfer=3e-4)
    assert replace(odd, key=stated).key_flanks is not None


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('length = "5 mm"', r"cam\.key\.length"),
        ('shaft_depth = "0.3 mm"', r"cam\.key\.shaft_depth"),
        ('height = "3.2 mm"', r"cam\.key\.height"),
    ],
)
def test_a_key_that_cannot_be_is_refused(line, field):
    text = made.CASE_FILE.read_text().replace('length = "14 mm"', "LINE")
    more = line if "length" in line else f'length = "14 mm"\n{line}'
    with pytest.raises(InputError, match=field):
        parse_case(text.replace("LINE", more))


def test_reversals():
    found = torque_reversals(THETA, 10 * np.sin(2 * THETA + 0.3))
    assert len(found) == 4
    np.testing.assert_allclose(
        [r.theta for r in found], (np.pi * np.arange(1, 5) - 0.3) / 2, atol=1e-6
    )
    np.testing.assert_allclose([r.slope for r in found], [-20, 20, -20, 20], rtol=1e-4)


def test_drag_holds_the_flanks_together():
    assert torque_reversals(THETA, 10 * np.sin(THETA), drag=10.5) == ()
    assert len(torque_reversals(THETA, 10 * np.sin(THETA), drag=9.5)) == 2


def test_a_dwell_is_one_reversal():
    torque = np.where(np.abs(THETA - np.pi) < 1.0, 0.0, np.sign(np.pi - THETA))
    assert len(torque_reversals(THETA, torque)) == 2  # the dwell, and the turn's end
    assert torque_reversals(THETA, np.zeros(720)) == ()


SHAFT = Camshaft(bearing_spacing=0.06, cam_position=0.02, gear_position=-0.015, gear_radius=0.02)


def test_shaft_is_in_equilibrium():
    rng = np.random.default_rng(1)
    along, across, torque = rng.normal(size=(3, 50)) * 500
    found = shaft_loads(along, across, torque, SHAFT)
    total = found.cam + found.gear + found.bearing_1 + found.bearing_2
    np.testing.assert_allclose(total, 0.0, atol=1e-9)
    moment = 0.02 * found.cam - 0.015 * found.gear + 0.06 * found.bearing_2
    np.testing.assert_allclose(moment, 0.0, atol=1e-9)
    # the gear's force turns the shaft with cam torque and drag: mesh at (-r, 0)
    dragged = shaft_loads(along, across, torque, replace(SHAFT, drag=0.5))
    np.testing.assert_allclose(-SHAFT.gear_radius * dragged.gear[1], torque + 0.5, rtol=1e-12)
    np.testing.assert_allclose(-SHAFT.gear_radius * found.gear[1], torque, rtol=1e-12)
    assert (found.load_1 >= 0).all()
    assert (found.load_2 >= 0).all()


def test_gear_presses_the_wheels_apart():
    found = shaft_loads(np.zeros(2), np.zeros(2), np.array([5.0, -5.0]), SHAFT)
    assert (found.gear[0] > 0).all()  # away from the mesh at the left, whichever way it turns
    np.testing.assert_allclose(found.gear[0], 250 * np.tan(np.radians(20)))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bearing_spacing", 0.0),
        ("bearing_spacing", np.inf),
        ("gear_radius", 0.0),
        ("cam_position", np.nan),
        ("gear_position", np.inf),
        ("mesh_angle", np.nan),
        ("pressure_angle", -0.1),
        ("pressure_angle", np.radians(45.0)),
    ],
)
def test_shaft_refusals(name, value):
    with pytest.raises(InputError, match=rf"camshaft\.{name}"):
        replace(SHAFT, **{name: value})


def test_unbalance_of_an_eccentric_disc():
    """Area pi R^2, first moment e pi R^2: to 1e-9, the lift being a spline of 720 knots."""
    found = unbalance(eccentric(), 8.5e-3, None, WIDTH, DENSITY)
    full = np.pi * DISC**2
    assert found.area == pytest.approx(full - np.pi * 8.5e-3**2, rel=1e-9)
    np.testing.assert_allclose(found.moment, [ECCENTRICITY * full, 0.0], atol=1e-9 * full * DISC)
    assert found.angle == pytest.approx(0.0, abs=1e-8)
    assert found.mass == pytest.approx(DENSITY * WIDTH * found.area)
    assert found.product == pytest.approx(DENSITY * WIDTH * ECCENTRICITY * full)
    assert found.eccentricity == pytest.approx(ECCENTRICITY * full / found.area)


def test_unbalance_turns_with_the_cam():
    """Out along the follower where the heavy side is under it; m e w^2 all the way round.

    The sense is that of a positive torque, in which the shaft turns: to positive y a quarter
    turn later.
    """
    found = unbalance(eccentric(), 8.5e-3, None, WIDTH, DENSITY)
    force = rotating_force(
        found.product, found.angle, 80.0, found.angle + np.array([0.0, 0.5 * np.pi, 4.0])
    )
    turning = found.product * 80.0**2
    np.testing.assert_allclose(np.hypot(*force), turning, rtol=1e-12)
    np.testing.assert_allclose(force[:, 0], [turning, 0.0], atol=1e-9)
    np.testing.assert_allclose(force[:, 1], [0.0, turning], atol=1e-9)
    alone = shaft_loads(np.zeros(3), np.zeros(3), np.zeros(3), SHAFT, force)
    np.testing.assert_allclose(alone.load_2, turning * 0.02 / 0.06, rtol=1e-12)
    np.testing.assert_allclose(alone.load_1 + alone.load_2, turning, rtol=1e-12)


def test_keyway_is_taken_off_exactly():
    """Against a sum over a fine grid."""
    key = Keyway(width=5e-3, depth=2.3e-3, angle=2.0)
    with_key = unbalance(eccentric(), 8.5e-3, key, WIDTH, DENSITY)
    without = unbalance(eccentric(), 8.5e-3, None, WIDTH, DENSITY)
    y = (np.arange(4000) + 0.5) / 4000 * 5e-3 - 2.5e-3
    inner = np.sqrt(8.5e-3**2 - y**2)
    area = np.mean(10.8e-3 - inner) * 5e-3
    arm = np.mean(0.5 * (10.8e-3**2 - inner**2)) * 5e-3
    assert without.area - with_key.area == pytest.approx(area, rel=1e-6)
    np.testing.assert_allclose(
        without.moment - with_key.moment, arm * np.array([np.cos(2.0), np.sin(2.0)]), rtol=1e-6
    )


def test_counter_hole_removes_the_unbalance():
    contour = eccentric()
    found = unbalance(contour, 8.5e-3, None, WIDTH, DENSITY)
    wall = 3e-3
    hole = counter_hole(contour, found, 8.5e-3, wall)
    left = found.moment - np.pi * hole.radius**2 * hole.centre
    assert np.hypot(*left) < 1e-9 * np.hypot(*found.moment)
    to_contour = DISC - np.hypot(hole.centre[0] - ECCENTRICITY, hole.centre[1]) - hole.radius
    assert to_contour == pytest.approx(wall, abs=1e-5)  # as far out as allowed; chords of 0.25 deg
    assert np.hypot(*hole.centre) - hole.radius - 8.5e-3 >= wall


def test_counter_hole_refuses_what_does_not_fit():
    contour = eccentric()
    found = unbalance(contour, 8.5e-3, None, WIDTH, DENSITY)
    with pytest.raises(GeometryError, match="no counter-hole"):
        counter_hole(contour, found, 8.5e-3, 15e-3)
    with pytest.raises(InputError, match="wall"):
        counter_hole(contour, found, 8.5e-3, 0.0)
    with pytest.raises(InputError, match="density"):
        unbalance(contour, 8.5e-3, None, WIDTH, np.nan)


def tripled(*, notch=None):
    """Three lobes a turn: beyond its valleys the distance to the contour grows again."""
    rise = np.pi / 9
    lift = SegmentMotion(
        (Segment("harmonic", rise, 0.01), Segment("harmonic", rise, -0.01),
         Segment("dwell", 4 * np.pi / 9)), repeat=3,
    ).lift()  # fmt: skip
    contour = RollerContour(PitchCurve(lift, 0.025), 0.004)
    return contour, unbalance(contour, 8.5e-3, notch, WIDTH, DENSITY)


def test_balanced_cam_needs_no_hole():
    contour, found = tripled()
    with pytest.raises(GeometryError, match="no unbalance"):
        counter_hole(contour, found, 8.5e-3, 1e-3)


def test_hole_stays_within_the_contour_of_a_valley():
    # the keyway lies under the lobe at 260 deg, so the valley at 80 deg is the heavy side
    contour, found = tripled(notch=Keyway(width=5e-3, depth=2.3e-3, angle=np.radians(260.0)))
    assert np.degrees(found.angle) == pytest.approx(80.0)
    hole = counter_hole(contour, found, 8.5e-3, 1e-3)
    away = np.hypot(*(contour.polygon(1440) - hole.centre[:, None])).min()
    assert away - hole.radius == pytest.approx(1e-3, abs=1e-5)
    assert np.hypot(*hole.centre) < contour.radius_min().value


def test_a_torque_of_next_to_nothing_reverses_nothing():
    """At standstill a cam without spring has the torque of round-off: 3e-9 N m in a groove."""
    assert torque_reversals(THETA, 3e-9 * np.sin(5 * THETA)) == ()
    small = np.where(np.abs(THETA - np.pi) < 1.0, 1e-9 * np.sin(40 * THETA), np.sign(np.pi - THETA))
    assert len(torque_reversals(THETA, small)) == 2  # as of a dwell

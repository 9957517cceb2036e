"""Valve cams of Petrescu and Petrescu (2015): shape index, feasibility, machine motion.

The paper's yields (0.39, 0.428, 0.538, 0.60) do not follow from its own eq. 6.18, whose greatest
value is about 0.30; the equations are tested here, not those numbers.
"""

import numpy as np
import pytest

from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.cycle.valve_cam import (
    ElasticValve,
    ValveCam,
    follower_acceleration,
    rise_efficiency,
    shaft_speed,
)
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.spring import Spring

# r0, h (m), phi_u (deg); index mean and max, mean of sin^2 delta, delta max (deg),
# least pitch radius (mm), undercut: computed independently from eqs 6.1 to 6.18
SETS = {
    "B1": (0.013, 0.020, 60.0, 0.2136, 0.2974, 0.3800, 52.6, 9.80, False),
    "B2": (0.015, 0.010, 30.0, 0.2183, 0.2932, 0.4147, 54.5, 3.52, False),
    "B3": (0.013, 0.009, 22.5, 0.2075, 0.3010, 0.5291, 62.2, 1.85, True),
    "B4": (0.013, 0.012, 22.5, 0.1843, 0.3014, 0.6060, 67.3, 1.77, True),
}
PHI = np.linspace(0.01, 2 * np.pi - 0.01, 96)  # none of them a joint


def harmonic(stroke, angle_deg):
    angle = np.radians(angle_deg)
    return SegmentMotion(
        (Segment("harmonic", angle, stroke), Segment("harmonic", angle, -stroke),
         Segment("dwell", 2 * np.pi - 2 * angle))
    )  # fmt: skip


def cam(name, **changes):
    r0, h, angle = SETS[name][:3]
    return ValveCam(harmonic(h, angle), r0, 0.002, **changes)


@pytest.mark.parametrize("name", SETS)
def test_shape_index_to_four_digits(name):
    _, _, _, mean, highest, sin_square, angle, _, _ = SETS[name]
    found = cam(name)
    index = found.shape_index(found.rise())
    delta = found.pressure_angle(found.rise())
    assert round(index.mean(), 4) == mean
    assert round(index.max(), 4) == highest
    assert round(float(np.mean(np.sin(delta) ** 2)), 4) == sin_square
    assert round(float(np.degrees(delta.max())), 1) == angle


@pytest.mark.parametrize("name", SETS)
def test_third_and_fourth_cam_are_undercut(name):
    r0, h, angle, *_, radius, undercut = SETS[name]
    contour = RollerContour(PitchCurve(harmonic(h, angle).lift(), r0 + 0.002), 0.002)
    assert round(1e3 * contour.least_convex_pitch_radius().value, 2) == radius
    assert contour.undercut().present is undercut


@pytest.mark.parametrize("offset", [0.0, 0.004])
def test_contour_radius_is_that_of_the_contour(offset):
    found = ValveCam(harmonic(0.006, 80), 0.013, 0.002, offset)
    contour = RollerContour(PitchCurve(found.motion.lift(11520), 0.015, offset), 0.002)
    theta = np.linspace(0.05, 2.7, 50)  # off the joints
    # 1e-7: the lift's rounding of the jump of acceleration
    np.testing.assert_allclose(
        np.sqrt(found.contour_radius_square(theta)), contour.radius(theta), rtol=2e-7
    )


@pytest.mark.parametrize("module", ["B", "C"])
def test_speed_keeps_the_energy_and_acceleration_is_its_slope(module):
    found = ValveCam(harmonic(0.006, 90), 0.013, 0.002, 0.003, module, 0.2, 0.1)
    mean = shaft_speed(5000)
    assert mean == pytest.approx(5000 / 2 * 2 * np.pi / 60)
    energy = 0.5 * found.reduced_inertia(PHI) * found.speed(PHI, mean) ** 2
    np.testing.assert_allclose(energy, 0.5 * found.mean_reduced_inertia() * mean**2, rtol=1e-14)
    # eps = omega d omega/d phi; the phases are off the joints, where eps jumps
    h = 1e-5
    slope = (found.speed(PHI + h, mean) - found.speed(PHI - h, mean)) / (2 * h)
    np.testing.assert_allclose(
        found.angular_acceleration(PHI, mean), found.speed(PHI, mean) * slope,
        rtol=0, atol=1e-6 * mean**2,
    )  # fmt: skip


def test_true_efficiency_is_of_friction_alone():
    r0, h, angle = SETS["B1"][:3]
    pitch = PitchCurve(harmonic(h, angle).lift(), r0 + 0.002)
    spring = Spring(rate=5e5, preload=45e3)
    theta, system = np.arange(2880) * 2 * np.pi / 2880, (0.1, spring, 0.06, 0.02)
    smooth = follower_loads(pitch, FollowerSystem(*system, 0.0, 0.0), 0.0, theta)
    assert rise_efficiency(smooth) == pytest.approx(1.0, rel=1e-12)
    rubbed = [
        rise_efficiency(follower_loads(pitch, FollowerSystem(*system, mu, mu), 0.0, theta))
        for mu in (0.05, 0.1, 0.2)
    ]
    # the shape index, 0.21, is no bound: a cam of 53 deg still passes on most
    assert 1 > rubbed[0] > 0.89 > rubbed[1] > rubbed[2] > 0.5


def test_flat_module_is_the_bracket_of_the_paper():
    found = ValveCam(harmonic(0.006, 90), 0.013, module="C")
    s, s1, s2 = (found.motion(PHI, k) for k in range(3))
    inertia = 0.1 * ((0.013 + s) ** 2 + s1**2) + 0.1 * s1**2
    slope = 0.2 * ((0.013 + s) * s1 + s1 * s2) + 0.2 * s1 * s2
    np.testing.assert_allclose(found.reduced_inertia(PHI), inertia, rtol=1e-13)
    np.testing.assert_allclose(found.reduced_inertia_slope(PHI), slope, rtol=1e-12, atol=1e-18)


def test_acceleration_over_an_uneven_shaft():
    # eq. 15 beside differences in time of s(phi(t)), phi stepped by its own Taylor series
    found = cam("B1")
    phi, h = np.linspace(0.1, 1.9, 40), 1e-6
    omega, eps = found.speed(phi, 100.0), found.angular_acceleration(phi, 100.0)
    later, sooner = (phi + sign * omega * h + 0.5 * eps * h**2 for sign in (1, -1))
    difference = (found.motion(later) - 2 * found.motion(phi) + found.motion(sooner)) / h**2
    given = follower_acceleration(found.motion(phi, 1), found.motion(phi, 2), omega, eps)
    np.testing.assert_allclose(given, difference, rtol=0, atol=1e-4 * np.abs(given).max())


MOTION = harmonic(0.006, 90)
CLASSICAL = {"mass": 0.1, "spring_rate": 150e3, "spring_travel": 0.03}


@pytest.mark.parametrize(("stiffness", "low"), [(5e6, 0.11), (1e7, 0.06), (5e7, 0.01)])
def test_printed_dynamic_lift_beside_integration(stiffness, low):
    valve, speed = ElasticValve(stiffness=stiffness, **CLASSICAL), shaft_speed(5000)
    # the mean about the top: the follower's own oscillation is not in the closed form
    phi = np.linspace(1.3, 1.84, 400)
    true = MOTION(phi) - valve.integrated(MOTION, speed, phi)
    printed = valve.dynamic_lift(MOTION(phi), MOTION(phi, 1), speed, exact=False)
    assert 1 - np.mean(MOTION(phi) - printed) / true.mean() == pytest.approx(low, abs=0.015)


def test_quadratic_is_nearer_than_the_printed_form():
    valve = ElasticValve(mass=0.1, stiffness=1e7, spring_rate=150e3, spring_travel=0.2)
    top = 0.006
    printed, exact = (
        top - valve.dynamic_lift(top, 0.0, 0.0, exact=which) for which in (False, True)
    )
    still = top - valve.quasi_static(top)
    assert abs(exact - still) < abs(printed - still)
    assert 1 - printed / still == pytest.approx(0.33, abs=0.01)


def test_stiff_train_follows_the_cam():
    previous = np.inf
    for stiffness in (1e7, 1e9, 1e11):
        valve = ElasticValve(stiffness=stiffness, **CLASSICAL)
        missed = max(
            np.abs(valve.dynamic_lift(MOTION(PHI), MOTION(PHI, 1), 200.0, exact=which)
                   - MOTION(PHI)).max()
            for which in (True, False)
        )  # fmt: skip
        assert missed < 0.02 * previous
        previous = missed
    assert previous < 1e-6


def test_zero_speed_leaves_the_static_balance():
    valve = ElasticValve(stiffness=5e6, **CLASSICAL)
    phi = np.linspace(0.2, 1.0, 30)
    still = valve.quasi_static(MOTION(phi))
    np.testing.assert_allclose(
        valve.stiffness * (MOTION(phi) - still), valve.spring_force(still), rtol=1e-12
    )
    # at 20 rad/s the jump of acceleration, 0.012 m, swings the follower by m w^2 s'' / (K + k)
    slow = valve.integrated(MOTION, 20.0, phi)
    np.testing.assert_allclose(slow, still, rtol=0, atol=3 * 0.1 * 20.0**2 * 0.012 / 5.15e6)


def test_integration_meets_its_equation():
    valve, speed = ElasticValve(stiffness=5e6, **CLASSICAL), 260.0
    phi = np.linspace(0.5, 1.5, 2001)
    x = valve.integrated(MOTION, speed, phi)
    h = phi[1] - phi[0]
    bend = (-x[4:] + 16 * x[3:-1] - 30 * x[2:-2] + 16 * x[1:-3] - x[:-4]) / (12 * h**2)
    balance = 0.1 * speed**2 * bend + 5.15e6 * x[2:-2] - 5e6 * MOTION(phi[2:-2]) + 4500
    assert np.abs(balance).max() < 1e-3 * 5e6 * 0.006


@pytest.mark.parametrize(
    ("changes", "field"),
    [({"offset": 0.015}, "cam.offset"), ({"offset": np.nan}, "cam.offset"),
     ({"cam_mass": 0.0}, "cam_mass"), ({"tappet_mass": -1.0}, "tappet_mass")],
)  # fmt: skip
def test_bad_cam_is_refused(changes, field):
    with pytest.raises(InputError, match=field):
        cam("B1", **changes)


def test_bad_valve_is_refused():
    for name in ("mass", "stiffness", "spring_rate", "spring_travel"):
        with pytest.raises(InputError, match=name):
            ElasticValve(**({"stiffness": 1e6, **CLASSICAL} | {name: -1.0}))
    # too fast for the work equation: no real root
    with pytest.raises(ContactError):
        ElasticValve(stiffness=1e6, **CLASSICAL).dynamic_lift(0.003, 0.006, 5000.0)

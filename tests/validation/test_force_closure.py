"""Forces of force-closed followers against published values: Rothbart, and a 3-4-5 jump."""

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machine
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.spring import Spring

INCH, POUND_FORCE, POUND = 0.0254, 4.4482216152605, 0.45359237
SPEED = 1200.0 * np.pi / 30.0  # rad/s
SAMPLES = 2880


def constant_acceleration(theta):
    """Rothbart (2004), fig. 8.7: 40 deg of acceleration and 120 deg of deceleration up, in."""
    first, last, high = np.radians(40.0), np.radians(120.0), 1.25
    fast = 2.0 * high / (first + last)  # greatest slope
    up = np.where(
        theta < first,
        0.5 * fast / first * theta**2,
        high - 0.5 * fast / last * (first + last - np.clip(theta, None, first + last)) ** 2,
    )
    return np.where(theta <= first + last, up, high)


def lift_in_inches(theta):
    """160 deg up, 20 dwell, 160 down, 20 dwell."""
    down = constant_acceleration(np.clip(np.radians(340.0) - theta, 0.0, None))
    return np.where(theta <= np.pi, constant_acceleration(theta), down)


def rothbart_lift():
    """Lift of the figure at equal angles: degrees and mm.

    The knots of the spline whose control points are the lift: without the oscillation of a spline
    through the jumps of the acceleration, and exact three samples away from them.
    """
    theta = uniform_turn(SAMPLES)
    whole = lift_in_inches(theta)
    near, far = (np.roll(whole, k) + np.roll(whole, -k) for k in (1, 2))
    return np.degrees(theta), 25.4 * (66.0 * whole + 26.0 * near + far) / 120.0


@pytest.fixture(scope="module")
def rothbart(tmp_path_factory):
    """Pitch curve and machine of the figure, from a case file with a table of the lift."""
    folder = tmp_path_factory.mktemp("rothbart")
    rows = "\n".join(
        f"{a!r},{s!r}" for a, s in zip(*map(np.ndarray.tolist, rothbart_lift()), strict=True)
    )
    (folder / "lift.csv").write_text(f"cam_angle_deg,lift_mm\n{rows}\n", encoding="utf-8")
    head, rest = small_machine("rothbart").split("[engine]")
    text = head + '[lift]\nkind = "table"\nfile = "lift.csv"\n' + rest[rest.index("\n[") :]
    for old, new in (
        ("gear_ratio = 2.0", "gear_ratio = 1.0"),
        ('rate = "24.2 kN/m"', f'rate = "{51.2 * POUND_FORCE / INCH / 1e3!r} kN/m"'),
        ('preload = "400 N"', f'preload = "{14.0 * POUND_FORCE!r} N"'),
        ('mass = "250 g"', f'mass = "{2e3 * POUND!r} g"\ngravity_angle = "0 deg"\n'
         f'external_force = "{10.0 * POUND_FORCE!r} N"'),
        ('speed = "1500 rpm"', 'speed = "1200 rpm"'),
        ("torque_reduction = 0.4", "# torque_reduction = 0.4"),
        ("torque_reduction = \"what", "# torque_reduction = \"what"),
    ):  # fmt: skip
        assert old in text, old
        text = text.replace(old, new)
    (folder / "rothbart.toml").write_text(text, encoding="utf-8")
    case = read_case(folder / "rothbart.toml")
    return case.contour(given_lift(case)).pitch, machine(case, case.load_cases[0])


def force_at(rothbart, degrees):
    """Force on the cam without friction in the guides, lb."""
    pitch, drive = rothbart
    loads = follower_loads(pitch, drive.system, drive.cam_speed, np.radians(degrees))
    return loads.required_force / POUND_FORCE


def test_total_force_on_the_cam_of_rothbart(rothbart):
    """Printed, in lb: 130, 146, 7, 55, 90, 26 beside the joints of the lift.

    Half a degree inside each part; there the spring differs by its rate times the slope.
    """
    near = 51.2 * 2.0 * 1.25 / np.radians(160.0) * np.radians(0.5)
    for angle, exact, apart in (
        (0.5, 130.9, 0.05), (39.5, 146.9 - near, 0.05), (40.5, 7.03 + near, 0.01),
        (159.5, 55.03, 0.01), (170.0, 90.0, 1e-3), (350.0, 26.0, 1e-3),
    ):  # fmt: skip
        assert force_at(rothbart, [angle])[0] == pytest.approx(exact, abs=apart), angle


def test_force_on_the_cam_of_rothbart_by_hand(rothbart):
    """Spring, weight, external force and m w^2 s'' within 1e-4 away from the joints.

    The spline of the lift is s'' step^2 / 4 off, 1e-6 in.
    """
    degrees = np.array([1.0, 20.0, 39.0, 41.0, 90.0, 159.0, 161.0, 175.0, 181.0, 250.0, 345.0])
    spring = 14.0 + 51.2 * lift_in_inches(np.radians(degrees))
    first, last = np.radians(40.0), np.radians(120.0)
    fast = 2.5 / (first + last)
    bend = np.select(
        [degrees < 40.0, degrees < 160.0, degrees < 180.0, degrees < 300.0, degrees < 340.0],
        [fast / first, -fast / last, 0.0, -fast / last, fast / first],
        0.0,
    )
    inertia = 2.0 * POUND * SPEED**2 * bend * INCH / POUND_FORCE
    exact = spring + 10.0 + 2.0 + inertia
    np.testing.assert_allclose(force_at(rothbart, degrees), exact, rtol=0, atol=1e-4)


def test_jump_of_a_3_4_5_rise():
    """10 mm in 90 deg at 10 rad/s: least force -6.470994 N at 71.006 deg, preload 16.470994 N."""
    motion = SegmentMotion((
        Segment("polynomial_345", 0.5 * np.pi, 0.01), Segment("dwell", np.pi),
        Segment("polynomial_345", 0.5 * np.pi, -0.01),
    ))  # fmt: skip
    system = FollowerSystem(
        7.5, Spring(rate=100.0, preload=10.0), 0.08, 0.03, 0.0, 0.0, viscous_damping=2.74
    )
    theta = np.radians(np.linspace(60.0, 80.0, 20001))
    loads = follower_loads(PitchCurve(motion.lift(), 0.05), system, 10.0, theta)
    k = int(np.argmin(loads.required_force))
    assert loads.required_force[k] == pytest.approx(-6.470994, abs=2e-6)
    assert np.degrees(theta[k]) == pytest.approx(71.006, abs=2e-3)
    assert 10.0 - loads.required_force[k] == pytest.approx(16.470994, abs=2e-6)
    assert loads.normal_force[k] == 0.0

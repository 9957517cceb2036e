"""Preload and rate that hold a follower on its cam, against closed forms and a published value."""

import math

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.geometry.lift_parts import LiftParts
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion
from camwright.pipeline.base.external_force import ExternalForce
from camwright.pipeline.search.sizes.spring_size import (
    PRELOAD_SHARE,
    HoldingCondition,
    least_rate,
    preload_needed,
    smallest_spring,
)

DEG = math.pi / 180.0


def rise_and_return(law: str, stroke: float, angle: float) -> LiftParts:
    rest = 2.0 * math.pi - 2.0 * angle
    dwell = (Segment("dwell", rest),) if rest > 1e-9 else ()
    segments = (Segment(law, angle, stroke), Segment(law, angle, -stroke), *dwell)
    return LiftParts.of_motion(SegmentMotion(segments))


def test_jump_of_a_polynomial_cam() -> None:
    """3-4-5 rise of 10 mm in 90 deg at 10 rad/s, 7.5 kg, 2.74 N s/m, 100 N/m, 10 N: -6.470994 N."""
    whole = rise_and_return("polynomial_345", 0.010, 90 * DEG)
    state = HoldingCondition(mass=7.5, cam_speed=10.0, damping=2.74)
    needed = preload_needed(LiftParts(whole.parts[:2]), 100.0, [state])
    # by hand: minimum of k s + m w^2 s'' + c w s', sampled each 5e-6 of the rise
    x = np.linspace(0.0, 1.0, 200_001)
    b = 0.5 * math.pi
    s = 0.010 * (10 * x**3 - 15 * x**4 + 6 * x**5)
    s1 = 0.010 / b * (30 * x**2 - 60 * x**3 + 30 * x**4)
    s2 = 0.010 / b**2 * (60 * x - 180 * x**2 + 120 * x**3)
    force = 100.0 * s + 7.5 * 100.0 * s2 + 2.74 * 10.0 * s1
    # a sample is within 2e-9 N of the minimum
    assert needed.value == pytest.approx(-force.min(), abs=1e-8)
    assert needed.value == pytest.approx(16.470994, abs=1e-6)
    assert needed.theta / DEG == pytest.approx(71.006, abs=5e-4)
    # on the return the drag of the guides pulls the follower off
    assert preload_needed(whole, 100.0, [state]).value > needed.value


def test_smallest_spring_of_a_harmonic_cam() -> None:
    """P + k s >= m w^2 (s - h/2) of a harmonic cam holds everywhere if it does at full lift."""
    stroke, mass, speed = 0.02, 1.3, 150.0
    lift = rise_and_return("harmonic", stroke, math.pi)
    state = HoldingCondition(mass=mass, cam_speed=speed)
    throw = 0.5 * mass * speed**2 * stroke
    spring = smallest_spring(lift, [state])
    # the energy F^2/(2 k) with F = m w^2 h/2 falls with the rate, up to the least preload
    assert spring.preload == pytest.approx(PRELOAD_SHARE * throw, rel=1e-8)
    assert spring.rate == pytest.approx((1.0 - PRELOAD_SHARE) * throw / stroke, rel=1e-8)


@pytest.mark.parametrize("law", ["cycloidal", "harmonic", "modified_trapezoid"])
def test_no_other_rate_stores_less(law: str) -> None:
    stroke = 0.012
    lift = rise_and_return(law, stroke, 100 * DEG)
    states = [
        HoldingCondition(mass=0.8, cam_speed=100.0, share=0.2, rate_factor=0.95),
        HoldingCondition(mass=0.8, cam_speed=130.0, preload_factor=0.95, held=-5.0),
    ]
    best = smallest_spring(lift, states)
    for factor in (0.5, 0.9, 0.99, 1.01, 1.1, 2.0):
        other = smallest_spring(lift, states, rate=factor * best.rate)
        assert other.energy(stroke) > best.energy(stroke)
    # held at 20001 angles of both conditions, and touched by one of them
    theta = np.linspace(0.0, 200 * DEG, 20001)
    half = np.minimum(theta, 200 * DEG - theta) / (100 * DEG)
    rows = [stroke / (100 * DEG) ** k * LAWS[law](half, k) for k in range(3)]
    left = [
        0.95 * best.rate * rows[0] + 0.8 * 100.0**2 * rows[2] + 0.8 * best.preload,
        best.rate * rows[0] + 0.8 * 130.0**2 * rows[2] + 0.95 * best.preload - 5.0,
    ]
    assert min(each.min() for each in left) >= -1e-6 * best.preload
    if best.preload > 1.001 * best.force(stroke) * PRELOAD_SHARE:
        assert min(each.min() for each in left) == pytest.approx(0.0, abs=1e-5 * best.preload)


@pytest.mark.parametrize("samples", [1, 8, 90])
def test_a_force_of_the_machine_is_held_too(samples: int) -> None:
    """At 40 001 angles: held everywhere, touched by one condition; kinks and dwell included."""
    lift = rise_and_return("cycloidal", 0.012, 100 * DEG)
    theta = np.arange(samples) * (2.0 * math.pi / samples)
    force = ExternalForce(theta, -60.0 + 40.0 * np.sin(theta + 0.7))
    states = [
        HoldingCondition(mass=0.8, cam_speed=60.0, share=0.2, rate_factor=0.95),
        HoldingCondition(mass=0.8, cam_speed=70.0, preload_factor=0.95),
    ]
    rate = 9000.0
    needed = preload_needed(lift.finer(force.spacing), rate, states, force)
    angle = np.linspace(0.0, 2.0 * math.pi, 40_001)
    half = np.clip(np.minimum(angle, 200 * DEG - angle) / (100 * DEG), 0.0, 1.0)
    rows = [0.012 / (100 * DEG) ** k * LAWS["cycloidal"](half, k) for k in range(3)]
    pressed = np.interp(angle, theta, force.force, period=2.0 * math.pi)
    left = [
        pressed + share_left * needed.value + factor * rate * rows[0] + 0.8 * speed**2 * rows[2]
        for share_left, factor, speed in ((0.8, 0.95, 60.0), (0.95, 1.0, 70.0))
    ]
    assert min(each.min() for each in left) == pytest.approx(0.0, abs=1e-3)
    freer = preload_needed(lift, rate, states).value
    assert needed.value > freer + 20.0


def test_least_rate_beside_a_stated_preload() -> None:
    """A textbook's harmonic cam: 2.5 in in 90 deg, 200 rpm, 8 lb; in lbf and in at 100 001 angles.

    Without a preload 14.98 lbf/in. With 2 lbf, 1.3 times the speed, 3 % more mass, 5 % less rate
    and preload 29.04 lbf/in.
    """
    pound, inch, weight = 4.4482216152605, 0.0254, 8.0
    gravity = 9.80665
    theta = np.linspace(0.0, 0.5 * math.pi, 100_001)[1:]
    s, s2 = 1.25 * (1.0 - np.cos(2.0 * theta)), 5.0 * np.cos(2.0 * theta)
    lift = rise_and_return("harmonic", 2.5 * inch, 90 * DEG)
    for preload, more, speed, less, published in (
        (1e-6, 1.0, 200.0, 1.0, 14.98), (2.0, 1.03, 260.0, 0.95, 29.04)
    ):  # fmt: skip
        w, heavy = speed * 2.0 * math.pi / 60.0, more * weight
        mass = heavy / (gravity / inch)
        needed = float(np.max(-(heavy + mass * w**2 * s2 + less * preload) / (less * s)))
        state = HoldingCondition(
            mass=heavy * pound / gravity, cam_speed=w, held=heavy * pound,
            rate_factor=less, preload_factor=less,
        )  # fmt: skip
        rate = least_rate(lift, preload * pound, [state]) * inch / pound
        assert rate == pytest.approx(needed, rel=1e-6)
        assert rate == pytest.approx(published, rel=5e-4)


def test_no_rate_helps_a_preload_that_does_not_hold_the_base_circle() -> None:
    """A force of 50 N lifts the follower off where the lift is zero and the rate does nothing."""
    lift = rise_and_return("cycloidal", 0.01, 90 * DEG)
    state = HoldingCondition(mass=1.0, cam_speed=1.0, held=-50.0)
    with pytest.raises(InputError, match=r"spring\.preload = 40 N, must be >= 50 N"):
        least_rate(lift, 40.0, [state])
    assert least_rate(lift, 60.0, [state]) == 0.0


def test_a_heavy_follower_needs_no_spring() -> None:
    lift = rise_and_return("cycloidal", 0.01, 90 * DEG)
    state = HoldingCondition(mass=1.0, cam_speed=1.0, held=9.81)
    assert preload_needed(lift, 0.0, [state]).value < 0.0
    with pytest.raises(InputError, match="throws the follower off"):
        smallest_spring(lift, [state])


@pytest.mark.parametrize(
    ("name", "value"),
    [("mass", -1.0), ("cam_speed", math.nan), ("share", 1.0), ("held", math.inf),
     ("rate_factor", 0.0), ("damping", -1e-9)],
)  # fmt: skip
def test_conditions_out_of_bounds(name: str, value: float) -> None:
    stated = {"mass": 1.0, "cam_speed": 10.0} | {name: value}
    with pytest.raises(InputError, match=name):
        HoldingCondition(**stated)

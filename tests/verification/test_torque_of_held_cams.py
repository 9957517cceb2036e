"""Lift of a groove drawn from a torque, whose spring may push or pull: closed form, another
integration, mirror, forces.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from held_cams import assert_as_closed_by_a_strong_spring
from scipy.integrate import cumulative_simpson
from test_screening import compared, exceeded

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.energy import signed_deflection
from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.smoothing.required_lift import cam_lift

FILE = Path(__file__).parents[2] / "cases" / "motions" / "feeder-groove.toml"
RATE = 20e3
ONE = ((1, 0.0, 0.5),)
SEVERAL = ((1, 0.1, 0.5), (2, -0.12, 0.08), (3, 0.03, 0.05))


def text_of(waves, preload, ratio="2:1", kind="none"):
    """The feeder with a torque of harmonics, order, cosine and sine in N m, in place of its lift,
    and a spring of 20 kN/m.
    """
    rows = ", ".join(
        f'{{ order = {k}, cosine = "{a} N m", sine = "{b} N m" }}' for k, a, b in waves
    )
    text = FILE.read_text(encoding="utf-8")
    begin, end = text.index("[lift]"), text.index("# --- The mechanism")
    drawn = (
        f'[torque]\nkind = "harmonics"\nmean = "0 N m"\nharmonics = [{rows}]\n\n'
        f'[spring]\nrate = "20 kN/m"\npreload = "{preload} N"\ntravel_max = "40 mm"\n'
        f'source = "chosen"\n\n[smoothing]\nkind = "{kind}"\n\n'
    )
    text = text[:begin] + drawn + text[end:]
    return text.replace("gear_ratio = 1.0", f'gear_ratio = "{ratio}"')


@cache
def drawn(waves, preload, ratio="2:1"):
    case = parse_case(text_of(waves, preload, ratio))
    return case, cam_lift(case, engine_torques(case))


def test_a_sine_of_two_waves_a_turn_draws_an_eccentric():
    """T = T1 sin 2 theta stores T1 sin^2 theta: the spring swings by sqrt(2 T1/k) sin theta."""
    _, lift = drawn(ONE, -250.0)
    swing, middle = np.sqrt(2.0 * 2.0 * 0.5 / RATE), 250.0 / RATE
    wanted = middle + swing * np.sin(lift.theta)
    far = middle - swing * np.sin(lift.theta)
    away = min(np.abs(lift.values - each).max() for each in (wanted, far))
    assert away < 1e-7 * swing  # of the root of an energy near zero
    slope = lift.derivatives(lift.theta, 2)
    assert np.abs(np.abs(slope[1]) - swing * np.abs(np.cos(lift.theta))).max() < 1e-5 * swing


def test_several_waves_by_another_integration():
    """Energy by Simpson's rule on 200 000 steps; its root changes sign where it is least."""
    _, lift = drawn(SEVERAL, -300.0)
    theta = np.linspace(0.0, FULL_TURN, 200_001)
    torque = 2.0 * sum(a * np.cos(2 * k * theta) + b * np.sin(2 * k * theta) for k, a, b in SEVERAL)
    energy = cumulative_simpson(torque, x=theta, initial=0.0)
    energy -= energy.min()
    half = theta.size // 2
    k = int(energy[:half].argmin())
    side = np.where((theta >= theta[k]) & (theta < theta[k] + np.pi), 1.0, -1.0)
    swing = np.interp(lift.theta, theta, side * np.sqrt(2.0 * energy / RATE))
    middle = 300.0 / RATE
    away = min(np.abs(lift.values - middle - each).max() for each in (swing, -swing))
    assert away < 1e-4 * np.ptp(lift.values)


@pytest.mark.parametrize(
    ("waves", "preload", "ratio"),
    [(SEVERAL, -300.0, "2:1"), (SEVERAL, 200.0, "2:1"), (SEVERAL, -400.0, "1:1")],
)
def test_the_spring_balances_the_torque(waves, preload, ratio):
    """Forces of the follower at standstill without friction on the lift drawn; 0.1 %."""
    case, lift = drawn(waves, preload, ratio)
    contour, machine = case.contour(lift), machines(case)[0]
    theta = uniform_turn(720)
    loads = follower_loads(contour.pitch, machine.system.with_friction(0.0, 0.0), 0.0, theta)
    per = case.mechanism.gear_ratio
    torque = per * sum(
        a * np.cos(k * per * theta) + b * np.sin(k * per * theta) for k, a, b in waves
    )
    assert np.abs(loads.cam_torque - torque).max() < 1e-3 * np.abs(torque).max()
    signs = {float(each) for each in np.sign(np.round(loads.axial_force, 6))}
    assert signs >= ({-1.0, 1.0} if (preload, ratio) == (-300.0, "2:1") else {np.sign(preload)})


def test_a_spring_that_pulls_draws_the_mirror_of_one_that_pushes():
    """Force -F at the lift h - s where another one has F at s."""
    energy = 2.0 * (1.0 - np.cos(uniform_turn(360)))
    push = signed_deflection(energy, RATE, 150.0)
    top = push.max()
    pull = signed_deflection(energy, RATE, -(150.0 + RATE * top))
    assert pull == pytest.approx(top - push, abs=1e-15)


def test_a_strong_spring_draws_the_cam_that_it_closes():
    """The lift of a spring-closed cam, and its forces in the groove."""
    held = text_of(SEVERAL, 900.0)
    case = parse_case(as_spring_closed(held))
    spring_closed = cam_lift(case, engine_torques(case))
    trial = preview_case(parse_case(held), corners=False)
    assert np.array_equal(trial.lift.values, spring_closed.values)
    cycle = next(each for each in trial.cycles if each.load_case == "running")
    assert_as_closed_by_a_strong_spring(cycle, cycle.machine)


@pytest.mark.slow
def test_designs_of_other_springs_agree_with_their_previews():
    case = parse_case(text_of(SEVERAL, -300.0))
    factors = {"spring.rate": np.array([19e3, 21e3]), "spring.preload": np.array([-320.0, -290.0])}
    worst = compared(case, factors, positions=720)
    assert {"torque_reduction", "landing_speed", "contact_pressure"} <= set(worst)
    assert exceeded(worst) == {}


def synthesised(text):
    """Preview of a constrained synthesis of 24 splines from one start, without initial energy."""
    constrained = 'kind = "constrained"\n'
    more = f"{constrained}coefficients = 24\nstarts = 1\nfree = []\n"
    return preview_case(parse_case(text.replace(constrained, more)), corners=False)


STRONGER = tuple((k, 8.0 * a, 8.0 * b) for k, a, b in SEVERAL)


def as_spring_closed(text):
    begin, end = text.index("[cam.groove]"), text.index("[camshaft]")
    closed = (text[:begin] + text[end:]).replace('closure = "groove"\n', "")
    return closed.replace("crossover_slip", "# crossover_slip")


@pytest.mark.slow
def test_a_strong_spring_synthesises_the_cam_that_it_closes():
    """No constraint of either closure is active: both drafts are one, to its tolerance."""
    text = text_of(STRONGER, 900.0, kind="constrained")
    held, closed = synthesised(text), synthesised(as_spring_closed(text))
    assert held.synthesis["feasible"] and closed.synthesis["feasible"]
    away = np.abs(held.lift.values - closed.lift.values).max()
    assert away < 1e-6 * np.ptp(closed.lift.values)


@pytest.mark.slow
def test_a_synthesis_keeps_the_outer_wall_and_both_signs_of_the_force():
    """A weak spring: its hollow would undercut the outer wall, at speed the cam pulls."""
    text = text_of(STRONGER, 20.0, kind="constrained")
    slow = synthesised(text)
    checks = {each.id: each for each in slow.checks}
    assert slow.synthesis["feasible"] and checks["outer_undercut"].status == "pass"
    assert checks["outer_undercut"].demand < 0.32  # of 0.3: it binds
    fast = text.replace('preload = "20.0 N"', 'preload = "60 N"').replace('"300 rpm"', '"1500 rpm"')
    fast = fast.replace('"330 rpm"', '"1600 rpm"')
    trial = synthesised(fast.replace("[limits]", "[limits]\ntorque_reduction = 0.1"))
    running = next(each for each in trial.cycles if each.load_case == "running")
    assert trial.synthesis["feasible"] and (running.loads.axial_force < -50.0).any()
    kept = {"contact_pressure", "pressure_angle", "jam_index", "torque_reduction", "roller_static"}
    status = {each.id: each.status for each in trial.checks}
    assert {name: status[name] for name in kept} == dict.fromkeys(kept, "pass")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (text_of(ONE, -199), r"spring\.preload = -199 N, must be > 0 N, or <= -200 N"),
        (text_of(ONE, -100, "1:1"), r"spring\.preload = -100 N, must be > 0 N, or < -20"),
    ],
)
def test_a_spring_too_weak_at_zero_lift_is_refused(text, message):
    with pytest.raises(InputError, match=message):
        preview_case(parse_case(text), corners=False)


def without_spring():
    text = text_of(ONE, 300.0)
    begin, end = text.index("[spring]"), text.index("[smoothing]")
    return text[:begin] + text[end:]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (without_spring(), r"spring = missing, must be given"),
        (text_of(ONE, -300.0, kind="constrained"), r"smoothing\.kind = constrained, must be"),
        (FILE.read_text(encoding="utf-8").replace('closure = "groove"', 'closure = "spring"')
         + '[spring]\nrate = "1 kN/m"\npreload = "-5 N"\ntravel_max = "40 mm"\n',
         r"spring\.preload = -5 N, must be > 0 N|cam\.groove"),
    ],
)  # fmt: skip
def test_what_a_case_cannot_have_is_refused(text, message):
    with pytest.raises(InputError, match=message):
        parse_case(text)

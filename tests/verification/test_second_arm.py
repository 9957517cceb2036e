"""Second arm of a rocker: stress by lumps of its mass and differences of its output's travel."""

from functools import cache

import numpy as np
import pytest
from test_arm_strength import ARM, SCOPE

from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.arm_strength import arm_forces, bar_of, second_bar_of
from camwright.pipeline.preview import preview_case

ROCKER = """\
[rocker]
length = "55 mm"
angle = "-12 deg"
mass = "1.4 kg"
width = "6 mm"
depth = "10 mm"
hub = "30 mm"
notch = 2.0

"""


@cache
def case(rocker=ROCKER, scope=SCOPE):
    whole = first_case("swing", "lift").text
    follower = ARM.replace("@swing@", "with").replace("@spring@", "0 mm") + scope + rocker
    text = whole[: whole.index("[follower]")] + follower + whole[whole.index("[lubricant]") :]
    return parse_case(text).with_positions(90)


@cache
def trial():
    return preview_case(case(), corners=False)


def pushed(cam, theta, h=2e-4):
    """Acceleration of the output, m/s2, by five-point differences of the place of the end."""
    lift = cam.contour.lift

    def place(at):
        return 0.055 * np.sin(np.radians(-12.0) + lift(at) / 0.1)

    steps = ((-2, -1.0), (-1, 16.0), (0, -30.0), (1, 16.0), (2, -1.0))
    return cam.speed**2 * sum(w * place(theta + k * h) for k, w in steps) / (12.0 * h**2)


def test_fatigue_and_yield_of_the_second_arm_by_lumps():
    """`rocker_fatigue` and `rocker_yield` of a preview, within 1e-5: the differences have 1e-7."""
    solution = trial().solution
    checks = {each.id: each for each in trial().checks}
    card, worst, safety = second_bar_of(solution.numbers).material, 0.0, np.inf
    modulus, area = 6e-3 * 10e-3**2 / 6.0, 6e-3 * 10e-3
    lumps = 0.015 + 0.040 * (np.arange(4000) + 0.5) / 4000
    mass = card.density * area * 0.040 / 4000
    tensile = card.tensile_strength
    across = 0.808 * np.sqrt(area) * 1e3
    endured = 4.51 * (tensile / 1e6) ** -0.265 * min(1.0, (across / 7.62) ** -0.107)
    endured *= (1.0 - 0.08 * 2.3263479) * card.fatigue_bending
    for cam in solution.cams.values():
        theta = cam.loads.theta
        lift = cam.contour.lift
        raised = np.radians(-12.0) + lift(theta) / 0.1
        force = 1.4 * pushed(cam, theta)
        turning = cam.speed**2 * lift(theta, 2) / 0.1
        own = mass * turning * np.sum(lumps * (lumps - 0.015))
        moment = force * np.cos(raised) * 0.040 + own
        along = -force * np.sin(raised)
        fibres = 2.0 * np.stack([along / area + side * moment / modulus for side in (-1.0, 1.0)])
        worst = max(worst, float(np.abs(fibres).max()))
        high, low = fibres.max(axis=1), fibres.min(axis=1)
        used = 0.5 * (high - low) / endured + 0.5 * np.abs(high + low) / tensile
        safety = min(safety, float(1.0 / used.max()))
    assert checks["rocker_yield"].demand == pytest.approx(worst, rel=1e-5)
    assert checks["rocker_fatigue"].demand == pytest.approx(safety, rel=1e-5)


def test_the_moment_of_the_output_passes_the_pivot():
    """The first arm is not relieved of it by the inertia of its own end: at the pivot its moment is
    that of spring, friction and output, within the differences of the output's travel.
    """
    of = trial().solution
    shares = []
    for cam in of.cams.values():
        moment = bar_of(of.numbers).bending(0.0, arm_forces(cam))
        lever = 0.055 * np.cos(np.radians(-12.0) + cam.jet.lift / 0.1)
        output = 1.4 * pushed(cam, cam.loads.theta) * lever
        wanted = 0.1 * (cam.closing + cam.viscous) + output
        atol = 1e-5 * np.abs(output).max() + 1e-12 * np.abs(moment).max()
        np.testing.assert_allclose(moment, wanted, rtol=0, atol=atol)
        shares.append(np.abs(output).max() / np.abs(moment).max())
    assert max(shares) > 0.01


def test_the_force_of_the_output_passes_a_spring_on_the_first_arm():
    """At the pivot the first arm bears what moves the output, of a constant ratio r with a force F
    and a mass m: l r (F + m r s'') and the viscous force; the spring at 60 mm bears itself alone.
    """
    stated = '[rocker]\nratio = 0.5\nforce = "2 kN"\nmass = "1.4 kg"\n\n'
    held = with_values(case(rocker=stated), {"follower.arm.spring_distance": "60 mm"})
    of = preview_case(held, corners=False).solution
    for cam in of.cams.values():
        output = 2000.0 + 1.4 * 0.5 * cam.speed**2 * cam.contour.lift(cam.loads.theta, 2)
        wanted = 0.1 * (cam.viscous + 0.5 * output)
        moment = bar_of(of.numbers).bending(0.0, arm_forces(cam))
        np.testing.assert_allclose(moment, wanted, rtol=0, atol=1e-9 * wanted.max())


def test_a_second_arm_is_described_or_left_out():
    bare = case(rocker='[rocker]\nlength = "55 mm"\nmass = "1.4 kg"\n\n')
    checks = {each.id: each for each in preview_case(bare, corners=False).checks}
    assert set(checks["data_rocker"].missing) == {"rocker.width", "rocker.depth", "rocker.notch"}
    assert "rocker_fatigue" not in checks
    without = with_values(bare, {"scope.not_covered": ["pivot", "rocker"]})
    made = preview_case(without, corners=False)
    assert "second arm of the rocker" in without.scope.statement
    assert "data_rocker" not in {each.id for each in made.checks}
    thin = with_values(bare, {"rocker.width": "8 mm"})
    checks = {each.id: each for each in preview_case(thin, corners=False).checks}
    assert checks["rocker_fatigue"].missing == ("rocker.depth", "rocker.notch")
    assert checks["rocker_yield"].status == "not_evaluated"

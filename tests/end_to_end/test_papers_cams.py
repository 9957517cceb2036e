"""The papers' cams from case to contact: an eccentric circle, and valve cams that are undercut."""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.eccentric import Eccentric
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import cam_shape as checks
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.solution import Solution, is_body, turns_of
from camwright.pipeline.follower.roller_motion import roller_motion
from camwright.pipeline.smoothing.required_lift import cam_lift
from validation.slider_crank_drive import (
    EccentricDrive,
    HoldingSpring,
    Masses,
    PairFriction,
    SliderCrankDrive,
)

PAPERS = Path(__file__).resolve().parents[2] / "cases" / "papers"
POSITIONS = 72


@pytest.fixture(scope="module")
def eccentric():
    case = read_case(PAPERS / "eccentric.toml")
    contour = case.contour(cam_lift(case, {}))
    return case, contour, turns_of(machines(case), contour, POSITIONS)[0]


LINKAGE = Eccentric(0.02, 0.08)
PHI = uniform_turn(POSITIONS) - 0.5 * np.pi


def test_circle_has_its_heights_and_its_constant_curvature(eccentric):
    _, contour, turn = eccentric
    pitch = contour.pitch
    np.testing.assert_allclose(pitch.height(turn.theta), LINKAGE.height(PHI), rtol=1e-12)
    np.testing.assert_allclose(
        pitch.lift(turn.theta, 1), LINKAGE.height_rate(PHI), rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(pitch.radius_of_curvature(turn.theta), 0.08, rtol=1e-9)
    np.testing.assert_allclose(contour.radius_of_curvature(turn.theta), 0.0325, rtol=1e-9)


def test_roller_turns_at_the_published_speed(eccentric):
    case, contour, turn = eccentric
    speed = case.load_cases[0].speed
    drive = EccentricDrive(
        LINKAGE, 0.0475, PairFriction(0, 0, 0, 0), Masses(slider=1.0), HoldingSpring(59.0, 1700.0)
    )
    spin = roller_motion(contour.pitch, 0.0475, speed, turn.theta).spin
    np.testing.assert_allclose(spin, drive.rolling_way(PHI) * speed / 0.0475, rtol=1e-10)


def test_torque_and_reactions_are_those_of_the_slider_crank(eccentric):
    case, _, turn = eccentric
    rod = SliderCrankDrive(
        LINKAGE,
        PairFriction(0.0, 0.0, 0.0, 0.0),
        Masses(slider=case.follower.mass),
        HoldingSpring(case.spring.preload, case.spring.rate),
    )
    found, loads = rod.reactions(PHI, case.load_cases[0].speed), turn.loads
    scale = np.abs(found.a).max()
    np.testing.assert_allclose(loads.axial_force, -found.b[0], rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(loads.tangential_force, -found.b[1], rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(loads.normal_force, np.hypot(*found.a), rtol=0, atol=1e-10 * scale)
    torque = np.abs(found.motor).max()
    np.testing.assert_allclose(loads.cam_torque, found.motor, rtol=0, atol=1e-10 * torque)


def test_hertz_radius_is_constant_and_finite_elements_agree(eccentric):
    _, contour, turn = eccentric
    pair, few = contact_pair(turn.machine, contour), slice(None, None, 18)
    history = closed_form_history(pair, turn.theta, turn.loads.normal_force)
    radius = 1 / (1 / 0.0325 + 1 / 0.0475)
    np.testing.assert_allclose(history.relative_radius, radius, rtol=1e-9)
    solved = two_scale_history(
        pair, CycleBodies.meshed(pair), turn.theta[few], turn.loads.normal_force[few]
    )
    np.testing.assert_allclose(solved.p0, history.p0[few], rtol=2e-3)


@pytest.mark.parametrize(("name", "stands"), [("b1", True), ("b2", True), ("b3", False),
                                              ("b4", False)])  # fmt: skip
def test_third_and_fourth_valve_cam_fail_as_undercut(name, stands):
    case = read_case(PAPERS / f"petrescu_{name}.toml")
    contour = case.contour(cam_lift(case, {}))
    drawn = Solution(case, contour, machines(case), Tier.PREVIEW, None, ())
    check = checks.undercut(drawn)
    assert is_body(contour) is stands
    assert (check.demand > 0) is stands
    if not stands:
        assert check.status == "fail"
        assert check.must_have
    assert checks.pressure_angle(drawn).status == "fail"

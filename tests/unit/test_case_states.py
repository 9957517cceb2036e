"""A preload of a load case's own, and a cam cut for a share of the torque."""

import re
from pathlib import Path

import numpy as np
import pytest

from geometry.errors import InputError
from pipeline import trial as road
from pipeline.case import parse_case
from pipeline.checks.forces import contact_force_margin
from pipeline.checks.trial import TrialEvidence
from pipeline.corners import Corner, applied
from pipeline.cycle import closed_form_cycle, turn
from pipeline.smoothing.smoothers import Smoother

GX120 = (Path(__file__).resolve().parents[2] / "cases" / "gx120.toml").read_text(encoding="utf-8")
SOFT = '\n[[load_case]]\nname = "soft"\nspeed = "1500 rpm"\npreload = "121 N"\n'
TWELVE = Smoother("moving_average", points=12, spacing=float(np.radians(5.0)))


@pytest.fixture(scope="module")
def torques():
    return road.engine_torques(parse_case(GX120))


def cam(case, torques):
    return road.cam_contour(case, road.designed_lift(case, torques, TWELVE))


def test_a_load_case_with_its_own_preload_changes_the_spring_force_by_the_difference(torques):
    case = parse_case(GX120 + SOFT)
    contour = cam(case, torques)
    idle, soft = (turn(case, contour, torques["idle"], name, 72) for name in ("idle", "soft"))
    np.testing.assert_allclose(idle.loads.spring_force - soft.loads.spring_force, 121.0, atol=1e-9)
    plain = cam(parse_case(GX120), torques)
    np.testing.assert_array_equal(contour.pitch.lift.values, plain.pitch.lift.values)
    cycles = (closed_form_cycle(case, contour, soft),)
    evidence = TrialEvidence(case=case, contour=contour, cycles=cycles)
    expected = float(soft.loads.normal_force.min()) / 121.0
    assert contact_force_margin(evidence).demand == pytest.approx(expected, rel=1e-12)


def test_a_corner_of_the_preload_moves_that_of_every_load_case():
    at = applied(parse_case(GX120 + SOFT), Corner("stiff", preload=1.05))
    assert at.spring.preload == pytest.approx(1.05 * 242.0)
    assert at.at("soft").spring.preload == pytest.approx(1.05 * 121.0)
    assert at.at("idle").spring.preload == pytest.approx(1.05 * 242.0)


def test_half_the_compensation_halves_the_torque_that_the_cam_takes(torques):
    half = parse_case(GX120.replace("gear_ratio = 2.0", "compensation = 0.5\ngear_ratio = 2.0"))
    taken = []
    for case in (parse_case(GX120), half):
        loads = turn(case, cam(case, torques), torques["idle"], "idle", 720).loads
        taken.append(loads.spring_force * loads.lift_slope)
    # The lift's spline is not linear in the torque: 1e-3 of the greatest.
    np.testing.assert_allclose(2.0 * taken[1], taken[0], atol=1e-3 * np.abs(taken[0]).max())


@pytest.mark.parametrize("share", ["0.0", "1.01", "-0.5", "nan"])
def test_a_share_outside_of_zero_to_one_is_refused(share):
    text = GX120.replace("gear_ratio = 2.0", f"compensation = {share}\ngear_ratio = 2.0")
    with pytest.raises(InputError, match=r"mechanism\.compensation"):
        parse_case(text)


@pytest.mark.parametrize("preload", ['"0 N"', '"-5 N"', '"242 mm"'])
def test_a_preload_that_cannot_be_is_refused(preload):
    with pytest.raises(InputError, match=r"load_case\[1\]\.preload"):
        parse_case(GX120 + SOFT.replace('"121 N"', preload))


def test_the_constrained_synthesis_refuses_what_it_does_not_know():
    drawn = re.sub(r'kind = "moving_average"', 'kind = "constrained"', GX120)
    with pytest.raises(InputError, match=r"load_case\[1\]\.preload"):
        parse_case(drawn + SOFT)
    with pytest.raises(InputError, match=r"mechanism\.compensation"):
        parse_case(drawn.replace("gear_ratio = 2.0", "compensation = 0.5\ngear_ratio = 2.0"))

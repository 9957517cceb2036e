"""A preload of a load case's own, and a cam cut for a share of the torque."""

import re
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline import solver as road
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks import guide_bushes, jump_and_jamming, roller_bearing
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.jump_and_jamming import contact_force_margin
from camwright.pipeline.checks.tolerance_corners import Corner, applied
from camwright.pipeline.cycle.cycle import closed_form_cycle, finished
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.preview import closed_form_checks
from camwright.pipeline.smoothing.smoothers import Smoother

GX120_CASE = Path(__file__).resolve().parents[2] / "cases" / "gx120.toml"
GX120 = GX120_CASE.read_text(encoding="utf-8")
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


LOADS = (GX120_CASE.parent / "gx120-loads.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def loads():
    """Four states of one machine, at few positions."""
    given = parse_case(LOADS).with_positions(72)
    return given, road.engine_torques(given)


def test_each_load_case_has_the_torque_of_its_own_throttle(loads):
    case, found = loads
    assert [state.name for state in case.load_cases] == ["idle", "rated", "overspeed", "start"]
    assert set(found) == {"idle", "rated", "overspeed", "start"}
    # Fired work goes with the charge: three times the pressure, as many times the gas torque.
    assert 3.0 < found["rated"].std / found["idle"].std < 6.0
    assert found["idle"].std < found["overspeed"].std < found["rated"].std
    # Turned over, the engine takes work and gives none.
    assert found["start"].mean < 0.0


def test_the_cam_is_cut_for_the_idle_alone(loads):
    case, found = loads
    alone = parse_case(GX120).with_positions(72)
    lifts = [road.designed_lift(given, found, TWELVE).values for given in (case, alone)]
    np.testing.assert_array_equal(*lifts)


def test_checks_from_rest_to_overspeed_name_what_governs_and_pass_on_no_missing_number():
    """At rest nothing rolls: no film, no PV, and a bearing that lives beyond any target."""
    oil = '[lubricant]\nviscosity = "30 mPa s"\npressure_viscosity = "20 1/GPa"\n\n[cam]\n'
    rough = 'roughness = "0.4 um"\n'
    text = LOADS.replace("[cam]\n", oil + rough)
    text = text.replace("[roller]\n", f"[roller]\nfriction = 0.1\n{rough}")
    oiled = parse_case(text).with_positions(72)
    found = {check.id: check for check in closed_form_checks(oiled)}
    assert (found["film_ratio"].load_case, found["film_ratio"].status) == ("start", "fail")
    assert 0.0 < found["film_ratio"].demand < 1e-2
    for name in ("contact_pressure", "roller_static", "bush_pv_A", "jump", "roller_speed"):
        assert found[name].load_case == "overspeed", name
    assert found["torque_reduction"].load_case == "idle"
    for check in found.values():
        assert check.status != "pass" or np.isfinite(check.demand), check.id


def test_at_rest_alone_no_speed_dependent_check_is_missing(loads):
    case, _ = loads
    start = next(state for state in case.load_cases if state.name == "start")
    lift = parse_case(GX120).with_positions(72)
    contour = cam(lift, road.engine_torques(lift))
    still = case.model_copy(update={"load_cases": (start,)})
    given = turn(still, contour, None, "start", 72)
    cycles = (finished(still, contour, given, road.unknown_contact(given)),)
    trial = TrialEvidence(case=still, contour=contour, cycles=cycles)
    assert jump_and_jamming.jump(trial).demand == pytest.approx(0.0, abs=1e-10)
    assert guide_bushes.bush_pv_a(trial).demand == pytest.approx(0.0, abs=1e-3)
    assert roller_bearing.roller_speed(trial).demand == pytest.approx(0.0, abs=1e-1)
    assert roller_bearing.roller_life(trial).demand > 1e3
    assert jump_and_jamming.jump_speed(trial).demand == pytest.approx(3318.0, rel=0.01)


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('intake_pressure = "92 kPa"', 'intake_pressure = "0 kPa"', "intake_pressure"),
        ('intake_pressure = "92 kPa"', "intake_pressure = 92", "intake_pressure"),
        ("fired = false", 'fired = "no"', "fired"),
        ("fired = false", 'fired = false\ntorque = "t.csv"', "intake_pressure"),
    ],
)
def test_a_throttle_that_cannot_be_is_refused(tmp_path, old, new, field):
    assert old in LOADS
    with pytest.raises(InputError, match=rf"load_case\[\d\]\.{field}"):
        parse_case(LOADS.replace(old, new), tmp_path)


def test_a_throttle_without_a_cylinder_model_is_refused():
    lift = re.sub(
        r"(?ms)^\[engine\].*?^(?=\[mechanism\])",
        '[lift]\nkind = "eccentric"\neccentricity = "5 mm"\n\n',
        LOADS,
    )
    with pytest.raises(InputError, match=r"load_case\[1\]\.intake_pressure"):
        parse_case(lift)

"""A preload of a load case's own, and a cam cut for a share of the torque."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.extrema import sampled_least
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import CREEP, Corner, machine, machines
from camwright.pipeline.checks import guide_strength, jump_and_jamming, roller_bearing
from camwright.pipeline.checks.jump_and_jamming import contact_force_margin
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle import turn as turning
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution, solved_turns
from camwright.pipeline.cycle.turn import TurnInput, turn, turns
from camwright.pipeline.preview import preview_case
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import solve

GX120_CASE = Path(__file__).resolve().parents[2] / "cases" / "gx120.toml"
GX120 = GX120_CASE.read_text(encoding="utf-8")
SOFT = '\n[[load_case]]\nname = "soft"\nspeed = "1500 rpm"\npreload = "121 N"\n'
TWELVE = Smoother("moving_average", points=12, spacing=float(np.radians(5.0)))


@pytest.fixture(scope="module")
def torques():
    return engine_torques(parse_case(GX120))


def cam(case, torques):
    return case.contour(cam_lift(case, torques, TWELVE))


def by_name(case):
    """The machine in every load case."""
    return {each.load_case: each for each in machines(case)}


def test_a_load_case_with_its_own_preload_changes_the_spring_force_by_the_difference(torques):
    case = parse_case(GX120 + SOFT)
    contour = cam(case, torques)
    idle, soft = (turn(each, contour, 72) for each in machines(case, torques)[:2])
    np.testing.assert_allclose(idle.loads.spring_force - soft.loads.spring_force, 121.0, atol=1e-9)
    plain = cam(parse_case(GX120), torques)
    np.testing.assert_array_equal(contour.pitch.lift.values, plain.pitch.lift.values)
    solution = solved_turns(case, contour, (soft,), Tier.PREVIEW)
    least = 121.0 + case.spring.rate * contour.pitch.lift.lowest.value
    expected = float(sampled_least(solution.cycles[0].loads_between.normal_force)) / least
    assert contact_force_margin(solution).demand == pytest.approx(expected, rel=1e-12)
    pitch = contour.pitch
    raised = replace(
        contour, pitch=replace(pitch, lift=replace(pitch.lift, values=pitch.lift.values + 2e-3))
    )
    higher = turn(machines(case, torques)[1], raised, 72)
    solution = solved_turns(case, raised, (higher,), Tier.PREVIEW)
    force = float(sampled_least(solution.cycles[0].loads_between.normal_force))
    expected = force / (least + 2e-3 * case.spring.rate)
    assert contact_force_margin(solution).demand == pytest.approx(expected, rel=1e-9)


def test_there_is_a_machine_for_every_load_case_with_its_speed_and_preload():
    case = parse_case(GX120 + SOFT + '\n[[load_case]]\nname = "still"\nspeed = "0 rpm"\n')
    found = machines(case)
    names = ["idle", "soft", "still", "standstill-2", "over-speed-1", "over-speed-2"]
    assert [each.load_case for each in found] == names
    assert found[1] == machine(case, case.load_cases[1])
    idle, soft, still, rest = found[:4]
    assert (rest.speed, rest.spring.preload, rest.ripple_weight) == (0.0, 121.0, 0.0)
    assert (idle.spring, soft.spring.preload) == (case.spring, 121.0)
    assert soft.spring.rate == case.spring.rate
    assert idle.cam_speed == pytest.approx(0.5 * 1500 * np.pi / 30, rel=1e-12)
    assert (still.speed, still.crank_speed) == (0.0, CREEP)  # it creeps
    assert idle.cam is soft.cam and idle.follower is case.roller


def test_each_machine_has_the_torque_of_its_load_case():
    """None at standstill and over-speed; a machine is known by its parts alone."""
    case = parse_case(GX120 + '\n[[load_case]]\nname = "fast"\nspeed = "3000 rpm"\n')
    torques = engine_torques(case)
    found = machines(case, torques)
    assert found[0].torque is torques["idle"] and found[1].torque is torques["fast"]
    assert [each.load_case for each in found if each.torque is None] == ["standstill", "over-speed"]
    assert found == machines(case) and found[0].at_corner(Corner("a", mass=1.1)).torque is not None


def test_a_changed_case_is_solved_with_its_own_torque(torques):
    """Nothing of the torque is held by the case, of which a copy at another speed is made."""
    case = parse_case(GX120).with_positions(72)
    contour = cam(case, torques)
    idle = solve(case, contour, tier=Tier.SCREENING)
    (state,) = case.load_cases
    fast = case.model_copy(update={"load_cases": (state.model_copy(update={"speed": 300.0}),)})
    own, solved = engine_torques(fast)["idle"], solve(fast, contour, tier=Tier.SCREENING)
    torque = solved.solution.machine.torque
    np.testing.assert_array_equal(torque.total, own.total)
    assert np.abs(torque.total - idle.solution.machine.torque.total).max() > 1.0


def test_the_machine_of_a_case_by_hand():
    case = parse_case(GX120)
    found = machines(case)[0]
    cam, roller = case.cam.material, case.roller.material
    assert found.contact_width == min(case.cam.width, case.roller.width - 2 * case.roller.end.size)
    assert found.base_radius == pytest.approx(0.050 - 0.008)
    compliance = (1 - cam.nu**2) / cam.E + (1 - roller.nu**2) / roller.E
    assert found.contact_modulus == pytest.approx(1 / compliance, rel=1e-12)
    assert found.bodies == {"cam": cam, "roller": roller}
    stem, follower = found.stem, case.follower
    assert (stem.diameter, stem.elastic_modulus) == (0.010, follower.stem_material.E)
    reach = follower.overhang_at_max_lift + case.guides.spacing
    compliance = reach / (stem.elastic_modulus * np.pi / 4 * 0.010**2)
    assert found.compliances["stem"] == pytest.approx(compliance, rel=1e-12)
    assert set(found.compliances) == {"stem", "bearing"}
    series = sum(found.compliances.values())
    assert found.axial_stiffness == pytest.approx(1.0 / series, rel=1e-12)
    assert found.system.spring is found.spring
    assert found.system.face_friction == 0.0
    assert found.follower is found.roller is case.roller


def test_bounds_of_the_friction_are_those_solved_at_once(torques):
    case = parse_case(GX120)
    contour = case.contour(cam_lift(case, torques))
    states = (replace(each, torque=torques["idle"]) for each in machines(case))
    inputs = [TurnInput(each, contour) for each in states]
    for early, late in zip(turns(inputs, 72), turns(inputs, 72, bounds=False), strict=True):
        for name in ("least", "nominal", "greatest"):
            one, other = (getattr(each.friction, name).normal_force for each in (early, late))
            np.testing.assert_allclose(one, other, rtol=1e-10)


def test_a_load_case_without_bounds_of_the_friction_leaves_those_of_the_others(
    torques, monkeypatch
):
    case = parse_case(GX120)
    contour = case.contour(cam_lift(case, torques))
    states = (replace(each, torque=torques["idle"]) for each in machines(case))
    inputs = [TurnInput(each, contour) for each in states]
    refused = inputs[1].machine.cam_speed

    def refusing(strokes, *rest):
        nominal = [each.machine.system.friction_a for each in inputs]
        if any(s.cam_speed == refused and s.system.friction_a not in nominal for s in strokes):
            raise ContactError("guides: too rough")
        return guided_strokes(strokes, *rest)

    guided_strokes = turning.guided_strokes
    monkeypatch.setattr(turning, "guided_strokes", refusing)
    solved = turns(inputs, 72, bounds=False)
    with pytest.raises(ContactError, match="too rough"):
        solved[1].friction  # noqa: B018 - solved when it is read
    assert (solved[0].friction.greatest.normal_force > 0.0).any()
    assert solved[1].loads.normal_force.max() > 0.0


def test_a_corner_of_the_preload_moves_that_of_every_load_case():
    given = by_name(parse_case(GX120 + SOFT))
    at = {name: each.at_corner(Corner("stiff", preload=1.05)) for name, each in given.items()}
    assert at["idle"].spring.preload == pytest.approx(1.05 * 242.0)
    assert at["soft"].spring.preload == pytest.approx(1.05 * 121.0)
    assert given["soft"].spring.preload == 121.0


def test_a_corner_moves_what_it_names():
    """A cam proud by 0.1 mm compresses the stiffer spring by as much."""
    nominal = machines(parse_case(GX120))[0]
    corner = Corner(
        "all", friction_a=1.5, friction_b=0.5, rate=1.1, mass=1.2, inertia=0.9, profile=1e-4
    )
    at = nominal.at_corner(corner)
    assert at.spring.rate == pytest.approx(1.1 * 24.2e3)
    assert at.spring.preload == pytest.approx(242.0 + 1.1 * 24.2e3 * 1e-4)
    assert at.mass == pytest.approx(1.2 * nominal.mass)
    assert at.crankshaft.inertia == pytest.approx(0.9 * nominal.crankshaft.inertia)
    assert at.friction.nominal == pytest.approx((0.06, 0.10))
    assert (at.system.friction_a, at.system.friction_b) == at.friction.nominal
    assert (at.cam, at.follower, at.guides) == (nominal.cam, nominal.follower, nominal.guides)


def test_half_the_compensation_halves_the_torque_that_the_cam_takes(torques):
    half = parse_case(GX120.replace("gear_ratio = 2.0", "compensation = 0.5\ngear_ratio = 2.0"))
    taken = []
    for case in (parse_case(GX120), half):
        loads = turn(machines(case, torques)[0], cam(case, torques), 720).loads
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
    return given, engine_torques(given)


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
    lifts = [cam_lift(given, found, TWELVE).values for given in (case, alone)]
    np.testing.assert_array_equal(*lifts)


def test_checks_from_rest_to_overspeed_name_what_governs_and_pass_on_no_missing_number():
    """At rest nothing rolls: no film, no PV, and a bearing that lives beyond any target."""
    oil = '[lubricant]\nviscosity = "30 mPa s"\npressure_viscosity = "20 1/GPa"\n\n[cam]\n'
    rough = 'roughness = "0.4 um"\n'
    text = LOADS.replace("[cam]\n", oil + rough)
    text = text.replace("[roller]\n", f"[roller]\nfriction = 0.1\n{rough}")
    oiled = parse_case(text).with_positions(72)
    checks = {check.id: check for check in preview_case(oiled, corners=False).checks}
    assert checks["film_ratio"].load_case == "idle"
    assert checks["film_ratio"].demand > 1e-2
    assert checks["jump"].load_case == "over-speed"
    for name in ("contact_pressure", "roller_static", "guide_pv_A", "roller_speed"):
        assert checks[name].without.endswith("(over-speed)"), name
        assert checks[name].load_case != "over-speed", name
    assert checks["torque_reduction"].load_case == "idle"
    for check in checks.values():
        assert check.status != "pass" or np.isfinite(check.demand), check.id


def test_at_rest_alone_no_speed_dependent_check_is_missing(loads):
    case, _ = loads
    start = by_name(case)["start"]
    lift = parse_case(GX120).with_positions(72)
    contour = cam(lift, engine_torques(lift))
    given = turn(start, contour, 72)
    pair, unknown = contact_pair(start, contour), ContactHistory.unknown(72)
    cycles = (Cycle(given, contour, pair, None, unknown),)
    solution = Solution(case, contour, (start,), Tier.CYCLE, None, cycles)

    def demand(check):
        """In the unit of its record."""
        return check(solution).as_record()["demand"]

    assert demand(jump_and_jamming.jump) == pytest.approx(0.0, abs=1e-10)
    assert demand(guide_strength.guide_pv_a) == pytest.approx(0.0, abs=1e-3)
    assert demand(roller_bearing.roller_speed) == pytest.approx(0.0, abs=1e-1)
    assert demand(roller_bearing.roller_life) > 1e3
    assert demand(jump_and_jamming.jump_speed) == pytest.approx(3318.0, rel=0.01)


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


@pytest.mark.parametrize("name", ["torque_reduction", "speed_reduction"])
def test_a_lift_has_no_ripple_to_reduce(name):
    text = re.sub(
        r"(?ms)^\[engine\].*?^(?=\[mechanism\])",
        '[lift]\nkind = "eccentric"\neccentricity = "5 mm"\n\n',
        GX120,
    )
    parse_case(text)
    with pytest.raises(InputError, match=rf"load_case\[0\]\.{name} = 0.3, must be left out"):
        parse_case(text + f"{name} = 0.3\n")
    with pytest.raises(InputError, match=rf"load_case\[0\]\.{name} = 1, must be >= 0 and < 1"):
        parse_case(GX120 + f"{name} = 1\n")

"""Gas spring: force, energy, lift from energy, derivatives, case, synthesis and screening."""

import tomllib
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import scipy
from small_machine import small_machine
from synthesis_ratings import named

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.tables import Table
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.case_file import case_of, parse_case, read_case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import Corner, machine, machines
from camwright.pipeline.case.template import first_case
from camwright.pipeline.cycle.elastic_response import elastic_history
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.follower.spring import Spring, spring_energy, spring_force, stored_lift
from camwright.pipeline.follower.spring_kinds import ATMOSPHERE, GasSpring, rise
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.smoothing.allowables import ratings_of, travel_limits
from camwright.pipeline.smoothing.bounds import bounds_of
from camwright.pipeline.smoothing.cam_state import lift_jet, loaded
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.required_lift import required_lift, required_torque
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import stacked
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.reports import part_figures
from camwright.reports.sheet_turn import SheetTurn

ROOT = Path(__file__).resolve().parents[2]
GAS = GasSpring(pressure=30e5, area=113e-6, volume=6e-6, exponent=1.3)
SPRING = Spring(kind="gas", gas=GAS, rate=GAS.rate, preload=GAS.preload)
TABLE = """
kind = "gas"

[spring.gas]
pressure = "30 bar"
area = "113 mm^2"
volume = "6 cm^3"
"""


def gas_case(extra="", table=TABLE, folder=None):
    text = small_machine("gas").replace('rate = "24.2 kN/m"\n', "")
    old = 'preload = "400 N"                    # at the smallest cam radius\n'
    assert old in text
    return parse_case(text.replace(old, table) + extra, folder)


@cache
def case():
    return gas_case()


def test_force_is_that_of_the_compressed_gas():
    """p V^n = constant from 30 bar above the surroundings; by hand at 20 mm."""
    left = 6e-6 - 113e-6 * 0.02
    pressure = (30e5 + ATMOSPHERE) * (6e-6 / left) ** 1.3
    assert SPRING.force(np.array(0.02)) == pytest.approx(
        (pressure - ATMOSPHERE) * 113e-6, rel=1e-14
    )
    assert GAS.at(0.02).pressure == pytest.approx(pressure - ATMOSPHERE, rel=1e-14)
    assert GAS.at(0.02).temperature == pytest.approx(293.15 * (6e-6 / left) ** 0.3, rel=1e-14)
    assert SPRING.force(np.array(0.0)) == pytest.approx(30e5 * 113e-6, rel=1e-14)


def test_warm_gas_has_a_greater_pressure():
    warm = GasSpring(pressure=30e5, area=113e-6, volume=6e-6, temperature=323.15)
    absolute = (30e5 + ATMOSPHERE) * 323.15 / 293.15
    assert warm.preload == pytest.approx((absolute - ATMOSPHERE) * 113e-6, rel=1e-14)


@pytest.mark.parametrize("exponent", [1.0, 1.0 + 1e-7, 1.3, 1.4])
def test_energy_is_the_integral_of_the_force(exponent):
    gas = GasSpring(pressure=30e5, area=113e-6, volume=6e-6, exponent=exponent)
    spring = Spring(kind="gas", gas=gas, rate=gas.rate, preload=gas.preload)
    for lift in (0.001, 0.02, 0.045, gas.reach + 0.002):  # beyond the reach along the tangent
        parts = [0.0, min(lift, gas.reach), lift] if lift > gas.reach else [0.0, lift]
        exact = sum(
            scipy.integrate.quad(lambda s: float(spring.force(np.array(s))), a, b, epsrel=1e-12)[0]
            for a, b in pairwise(parts)
        )
        # the integral of an exponent near 1 cancels to eps over the exponent less 1
        assert spring.energy(lift) == pytest.approx(exact, rel=1e-7 if exponent > 1.2 else 1e-6)


def test_derivatives_of_the_rise_are_those_of_the_force():
    lift = np.array([0.003, 0.02, 0.045])
    law = rise(GAS, lift)
    step = 1e-30
    by_complex = rise(GAS, lift + 1j * step)
    assert np.imag(by_complex.work) / step == pytest.approx(law.travel, rel=1e-12)
    assert np.imag(by_complex.travel) / step == pytest.approx(law.slope, rel=1e-12)
    assert np.imag(by_complex.slope) / step == pytest.approx(law.travel_d2, rel=1e-12)


def test_lift_stores_its_energy():
    lift = np.linspace(0.0, 0.05, 41)
    energy = spring_energy(SPRING.preload, SPRING.rate, lift, GAS)
    again = stored_lift(energy, SPRING.rate, SPRING.preload, GAS)
    np.testing.assert_allclose(again, lift, rtol=1e-12, atol=1e-15)


def test_jet_has_exact_derivatives():
    """Lift and derivatives along E(theta), and by E, P and k, against differences."""
    problem = problem_of(case(), engine_torques(case()))
    variables = problem.variables
    assert variables.shape is case().spring.gas
    theta = np.linspace(0.3, 0.3 + 4e-3, 5)
    energy = (
        6.0 + 3.0 * np.sin(theta),
        3.0 * np.cos(theta),
        -3.0 * np.sin(theta),
        -3.0 * np.cos(theta),
    )
    jet, h = lift_jet(energy, variables), 1e-3
    assert jet.slope[2] == pytest.approx(
        (8 * (jet.lift[3] - jet.lift[1]) - (jet.lift[4] - jet.lift[0])) / (12 * h), rel=1e-9
    )
    assert jet.lift_d2[2] == pytest.approx(
        (8 * (jet.slope[3] - jet.slope[1]) - (jet.slope[4] - jet.slope[0])) / (12 * h), rel=1e-9
    )
    assert jet.jerk[2] == pytest.approx(
        (8 * (jet.lift_d2[3] - jet.lift_d2[1]) - (jet.lift_d2[4] - jet.lift_d2[0])) / (12 * h),
        rel=1e-9,
    )
    by_complex = lift_jet((energy[0] + 1e-30j, *energy[1:]), variables)
    up, down = (lift_jet((energy[0] + side, *energy[1:]), variables) for side in (1e-4, -1e-4))
    for name in jet._fields:
        slope = (getattr(up, name) - getattr(down, name)) / 2e-4
        assert np.imag(getattr(by_complex, name)) / 1e-30 == pytest.approx(slope, rel=1e-6), name


def test_lift_of_a_case_delivers_the_torque():
    torque = engine_torques(case())["idle"]
    smoother = Smoother.from_case(case().smoothing, case().period)
    lift = required_lift(case(), torque, smoother)
    wanted = case().mechanism.gear_ratio * required_torque(case(), torque, smoother)
    theta = uniform_turn(wanted.size)
    given = case().spring.force(lift(theta)) * lift(theta, 1)
    assert given == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())


def test_synthesis_has_the_forces_of_the_follower():
    problem = problem_of(case(), engine_torques(case()))
    search = Search(problem)
    theta, idle = search.turn.theta, problem.scenarios[0]
    jet = lift_jet(search.turn.energy(search.exact), problem.variables)
    drive = machine(case(), case().load_cases[0])
    pitch = PitchCurve(Lift(theta, jet.lift), case().cam.prime_radius)
    loads = follower_loads(pitch, drive.system, drive.cam_speed, theta)
    stack = stacked([idle], theta)
    cam = loaded(jet, float(jet.lift.max()), problem.variables, problem.ratings, stack)
    wide = float(loads.spring_force.max())
    assert cam.spring_force[0] == pytest.approx(loads.spring_force, abs=1e-12 * wide)


def test_preview_and_screening_agree():
    trial = preview_case(case(), corners=False)
    checks = {each.id: each for each in trial.checks}
    assert checks["friction_balance"].demand < 1e-6
    columns = screen_designs(case(), {"follower.mass": np.array([0.25, 0.3])}, positions=144)
    for name, apart in (("torque_reduction", 1e-3), ("jump", 3e-3)):
        demand = columns[f"{name}.demand"][0]
        # the preview refines between its samples, the screening has vertices of its own
        error = checks[name].error_share or 0.0
        assert demand == pytest.approx(checks[name].demand, rel=apart + error), name


def test_stiff_follower_has_the_force_of_the_rigid_one():
    """The bent force acts on the elastic mass: at low speed the contact force is the spring's."""
    drive = machine(case(), case().load_cases[0])
    lift = Lift(uniform_turn(72), 0.01 * (1.0 - np.cos(uniform_turn(72))))
    at = lift(uniform_turn(361))
    history = elastic_history(drive, lift, at, np.full(361, 0.01), flights=False)
    # the stem shortens by F/K: the force of the shortened spring
    stem, rate = drive.axial_stiffness, drive.spring.rate
    exact = drive.spring.force(at) / (1.0 + rate / stem)
    assert history.response.contact_force == pytest.approx(exact, rel=1e-5)


def test_corner_scales_preload_and_rise():
    drive = machine(case(), case().load_cases[0])
    there = drive.at_corner(Corner("high", rate=1.1, preload=0.9)).spring
    lift = np.array([0.0, 0.01, 0.03])
    here = drive.spring
    exact = 0.9 * here.preload + 1.1 * (here.force(lift) - here.preload)
    np.testing.assert_allclose(there.force(lift), exact, rtol=1e-13)
    assert spring_force(1.0, 2.0, lift) == pytest.approx(1.0 + 2.0 * lift)


def test_other_values_of_the_gas_set_rate_and_preload():
    """In place of its table in a study; rate and preload by themselves are refused."""
    other = replaced(case(), {"spring.gas.volume": 7e-6}).spring
    assert other.rate == GasSpring(pressure=30e5, area=113e-6, volume=7e-6).rate
    with pytest.raises(InputError, match=r"spring.preload = 400.0, must be left out"):
        replaced(case(), {"spring.preload": 400.0})
    columns = screen_designs(case(), {"spring.gas.volume": np.array([6e-6, 7e-6])}, positions=72)
    assert columns["jump.demand"][0] != columns["jump.demand"][1]
    refused = screen_designs(case(), {"spring.preload": np.array([300.0, 400.0])}, positions=72)
    assert all("spring.preload" in words for words in refused["message"])


def test_resolved_case_reads_back():
    text = case().to_toml()
    table = tomllib.loads(text)["spring"]
    assert "rate" not in table and "preload" not in table
    again = case_of(tomllib.loads(text))
    assert again.spring == case().spring
    assert again.to_toml() == text


@pytest.mark.parametrize(
    ("table", "refusal"),
    [
        (
            TABLE.replace('kind = "gas"', 'kind = "gas"\npreload = "400 N"'),
            "spring.preload = 400 N",
        ),
        (TABLE.replace('"gas"', '"air"'), "spring.kind = air"),
        ('kind = "gas"\n', "spring"),
        (TABLE.replace('"6 cm^3"', '"0 cm^3"'), "spring.gas.volume = 0 cm^3"),
        (TABLE + 'colour = "red"\n', "spring.gas.colour = unknown key"),
    ],
)
def test_bad_tables_are_refused_in_one_line(table, refusal):
    with pytest.raises(InputError) as caught:
        gas_case(table=table)
    assert refusal in str(caught.value)
    assert "\n" not in str(caught.value)


def test_preload_of_a_load_case_and_freed_springs_are_refused():
    with pytest.raises(InputError, match=r"load_case\[0\].preload"):
        gas_case('preload = "300 N"\n')


@pytest.mark.parametrize("name", sorted(known_cards(None)["gas_springs"]))
def test_card_of_a_gas_spring_has_its_rod_and_its_rise_of_force(name):
    """Rod x stroke of its name; at a constant temperature the force rises by half over the stroke.

    Force and limits of the resolved case are those of the card; the case states the pressure.
    """
    rod, stroke = (1e-3 * float(each) for each in name.removeprefix("nitrogen_").split("x"))
    table = f'kind = "gas"\n\n[spring.gas]\ncard = "{name}"\npressure = "90 bar"\n'
    gas = gas_case(table=table).spring.gas
    assert gas.area == pytest.approx(np.pi / 4.0 * rod**2, rel=3e-4)  # four digits
    assert gas.stroke == pytest.approx(stroke, rel=1e-12)
    assert gas.volume / (gas.volume - gas.area * stroke) == pytest.approx(1.5, rel=3e-3)
    assert gas.preload == pytest.approx(90e5 * gas.area, rel=1e-12)
    assert (gas.pressure_limit, gas.temperature_limit, gas.speed_limit) == (250e5, 353.15, 1.6)
    assert not gas.source.confirmed


def test_a_users_card_of_a_gas_spring(tmp_path):
    card = '[gas_springs.own]\narea = "100 mm^2"\nvolume = "6 cm^3"\nsource = "data sheet"\n'
    (tmp_path / "cards.toml").write_text(card, encoding="utf-8")
    table = 'kind = "gas"\n\n[spring.gas]\ncard = "own"\npressure = "30 bar"\nvolume = "7 cm^3"\n'
    gas = gas_case(table=table, folder=tmp_path).spring.gas
    assert (gas.area, gas.volume, gas.stroke) == (pytest.approx(1e-4), pytest.approx(7e-6), None)
    with pytest.raises(InputError, match=r"spring.gas.card = none, must be one of: nitrogen_15x25"):
        gas_case(table=table.replace('"own"', '"none"'))
    with pytest.raises(InputError, match=r"spring.gas.pressure = missing, must be given"):
        gas_case(table='kind = "gas"\n\n[spring.gas]\ncard = "nitrogen_15x25"\n')


LIMITS = """
temperature = "320 K"
pressure_limit = "60 bar"
temperature_limit = "353 K"
speed_limit = "1 m/s"
stroke = "20 mm"
source = "made up"
stroke_rate_limit = "4000 1/min"
cold_temperature = "5 degC"
loss = 0.03
conductance = "0.2 W/K"
"""


def test_limits_of_the_maker():
    """Checks and travel limits of the synthesis against p V^n integrated in steps."""
    limited = gas_case(table=TABLE + LIMITS)
    trial = preview_case(limited, corners=False)
    checks = {each.id: each for each in trial.checks}
    highest = trial.lift.highest.value
    absolute = (30e5 + ATMOSPHERE) * 320.0 / 293.15
    volume = np.linspace(6e-6, 6e-6 - 113e-6 * highest, 20001)
    pressure = absolute * np.exp(scipy.integrate.trapezoid(-1.3 / volume, volume))  # dp/p = -n dV/V
    hard = 1.05 * (pressure - ATMOSPHERE)
    assert checks["gas_pressure"].demand == pytest.approx(hard, rel=1e-6)
    assert checks["gas_stroke"].demand == pytest.approx(highest, rel=1e-9)
    speed = max(float(np.abs(c.loads.velocity).max()) for c in trial.cycles)
    assert checks["gas_speed"].demand == pytest.approx(speed, rel=1e-12)
    assert checks["gas_temperature"].demand == pytest.approx(46.85)
    peaks = scipy.signal.find_peaks(np.tile(trial.lift(uniform_turn(720)), 2))[0].size // 2
    cam_speed = highest_speed(machines(limited)) / limited.mechanism.gear_ratio
    assert checks["gas_stroke_rate"].demand == pytest.approx(peaks * cam_speed / (2.0 * np.pi))
    tolerance = checks["gas_force_lost"]
    cold = absolute * 0.97 * 278.15 / 320.0 - ATMOSPHERE  # the ideal gas, less 3 % of it
    lost = 1.0 - cold / (absolute - ATMOSPHERE)
    assert (tolerance.demand, tolerance.limit) == pytest.approx((lost, 0.05))
    along = absolute * np.exp(-1.3 * np.log(volume / volume[0]))
    work = scipy.integrate.trapezoid(along - ATMOSPHERE, -volume)
    fastest = max(each.speed for each in limited.load_cases) / limited.mechanism.gear_ratio
    warmer = 2.0 * 0.05 * work * peaks * fastest / (2.0 * np.pi) / 0.2
    assert checks["gas_heating"].demand == pytest.approx(20.0 + warmer, rel=1e-4)
    slow = limited.load_cases[0].model_copy(
        update={"name": "slow", "speed": 0.25 * limited.load_cases[0].speed, "duty": 0.6}
    )
    states = (limited.load_cases[0].model_copy(update={"duty": 0.4}), slow)
    by_duty = preview_case(limited.model_copy(update={"load_cases": states}), corners=False)
    heating = next(each for each in by_duty.checks if each.id == "gas_heating")
    mean = 0.4 + 0.6 * 0.25
    assert heating.demand == pytest.approx(20.0 + mean * warmer, rel=1e-4)
    ends = {"gas left": volume[-1] / 113e-6}
    state = machines(limited)[0]
    ends["stem"] = 0.2 - (state.overhang_at_max_lift + state.guides.spacing)
    ends["stem"] -= 0.5 * state.guides.b.length + highest
    assert checks["gas_gap"].status == "not_evaluated"
    assert checks["gas_gap"].missing == ("follower.stem_length",)
    long = limited.model_copy(
        update={"follower": limited.follower.model_copy(update={"stem_length": 0.2})}
    )
    (own,) = [c for c in preview_case(long, corners=False).checks if c.id == "gas_gap"]
    assert own.demand == pytest.approx(min(ends.values()), rel=1e-6)
    assert checks["data_gas_spring"].missing == ("spring.travel_max",)
    assert not any(name.startswith("spring_") and name != "spring_travel" for name in checks)
    allowed = travel_limits(limited)
    assert allowed["gas_stroke"] == 0.02
    at_limit = limited.spring.force(np.array(allowed["gas_pressure"])) / 113e-6
    assert 1.05 * at_limit == pytest.approx(60e5, rel=1e-9)


def test_the_synthesis_keeps_the_speed_of_the_seal_whatever_the_guides():
    """The lift per cam angle at the speed limit, at the fastest cam; guides in or out of scope."""
    limited = gas_case(table=TABLE + LIMITS)
    fastest = highest_speed(machines(limited)) / limited.mechanism.gear_ratio
    scope = limited.scope.model_copy(update={"not_covered": ("guides",)})
    for case in (limited, limited.model_copy(update={"scope": scope})):
        ratings = ratings_of(case)
        assert named(ratings).gas_slope == pytest.approx(1.0 / fastest, rel=1e-12)
        bound = bounds_of(ratings)["gas_speed"]
        assert (bound.value, bound.unit) == (pytest.approx(1e3 / fastest), "mm")
    assert named(ratings_of(gas_case())).gas_slope is None


def test_screening_judges_the_limits_of_the_maker():
    """Of many designs, as the preview of one."""
    limited = gas_case(table=TABLE + LIMITS)
    masses = {"follower.mass": np.array([0.25, 0.3])}
    columns = screen_designs(limited, masses)
    checks = {each.id: each for each in preview_case(limited, corners=False).checks}
    limits = "pressure", "stroke", "speed", "temperature", "stroke_rate", "heating", "force_lost"
    for name in (f"gas_{each}" for each in limits):
        demand = in_unit(checks[name].demand, checks[name].unit)
        # the preview refines between its samples, the screening has vertices of its own
        rel = 1e-5 + (checks[name].error_share or 0.0)
        assert columns[f"{name}.demand"] == pytest.approx([demand] * 2, rel=rel), name
        assert set(columns[f"{name}.status"]) == {checks[name].status}, name
    small = {"spring.gas.volume": np.array([6e-6, 4.2e-6])}
    columns = screen_designs(limited, small, positions=72)
    assert columns["gas_pressure.demand"][1] > 1.05 * columns["gas_pressure.demand"][0]
    without = screen_designs(case(), masses, positions=72)
    assert set(without["gas_pressure.status"]) == {"not_evaluated"}
    assert "torsion_stress.status" not in without


def test_figure_of_the_force_over_the_travel():
    """Of a gas spring without a limit, of a coil spring with its force at solid length."""
    lift = 0.015 * (1.0 - np.cos(np.linspace(0.0, np.pi, 40)))
    columns = Table({"lift_mm": 1e3 * lift, "spring_force_N": SPRING.force(lift)})
    turn = SheetTurn(
        columns, (columns,), columns, columns, None, (), {"spring": {"kind": "gas"}}, {}
    )
    figure = part_figures._spring_force(turn)
    (panel,) = figure.panels
    exact = SPRING.force(1e-3 * panel.curves[0].x)
    # linear between the angles of the turn
    assert panel.curves[0].y == pytest.approx(exact, rel=0.02)
    assert panel.limits == ()
    linear = Table({"lift_mm": 1e3 * lift, "spring_force_N": 100.0 + 5e3 * lift})
    design = {"free_length": "60 mm", "wire_diameter": "3 mm", "coils": 6}
    turn = replace(turn, columns=linear, case={"spring": {"design": design}})
    (limit,) = part_figures._spring_force(turn).panels[0].limits
    assert limit.value == pytest.approx(5.0 * (60.0 - 3.0 * (6 + 2)), rel=1e-12)


@pytest.mark.slow
def test_synthesis_on_a_gas_spring_keeps_every_limit():
    """The first case on a gas spring, with weight and an external force: no check fails."""
    text = first_case("gas").text
    table = TABLE.replace("30 bar", "50 bar").replace("113", "314").replace("6 cm", "12.56 cm")
    spring = '[spring]\ntravel_max = "18 mm"' + table + LIMITS.replace("60 bar", "150 bar")
    head, rest = text.split("[spring]")
    load = 'gravity_angle = "0 deg"\nexternal_force = "100 N"\nmass = "1.1 kg"'
    text = head + spring + rest[rest.index("\n[cam]") :].replace('mass = "1.1 kg"', load)
    text = text.replace('"1 m/s"', '"2 m/s"').replace('"0.2 W/K"', '"4 W/K"')
    text = text.replace('"5 degC"', '"315 K"').replace("loss = 0.03", "loss = 0.01")
    limited = parse_case(text)
    trial = preview_case(limited, corners=False)
    failed = [each.id for each in trial.checks if each.must_have and each.status == "fail"]
    assert failed == []
    assert trial.synthesis["converged"]


def test_checks_without_a_data_sheet_are_not_evaluated_by_name():
    checks = {each.id: each for each in preview_case(case(), corners=False).checks}
    assert checks["gas_pressure"].status == "not_evaluated"
    assert checks["gas_pressure"].missing == ("spring.gas.pressure_limit",)
    assert "data_spring" not in checks


def test_a_nitrogen_spring_in_a_fast_machine_fails_by_its_strokes():
    """825 strokes a minute at the over-speed, where the card allows 100."""
    case = read_case(ROOT / "tests" / "data" / "refused" / "gas_spring_duty.toml")
    checks = {each.id: each for each in preview_case(case, corners=False).checks}
    assert checks["gas_stroke_rate"].status == "fail"
    assert in_unit(checks["gas_stroke_rate"].demand, "1/min") == pytest.approx(825.0)

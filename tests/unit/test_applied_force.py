"""External force and weight on the follower: the force law, case keys, work, lift, elasticity."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from elastic_jump import energy_error
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.external_force import STANDARD_GRAVITY, ExternalForce
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.external_load import closing_preload, dead_load, external_force
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machine
from camwright.pipeline.follower.elastic_follower import (
    ElasticFollower,
    collocation_response,
    harmonic_response,
)
from camwright.pipeline.follower.follower_flight import bounce
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.smoothing.cam_state import lift_jet, loaded
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.required_lift import required_lift, required_torque
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import stacked
from camwright.pipeline.smoothing.smoothers import Smoother

SPRING = Spring(rate=20e3, preload=200.0)
THETA = uniform_turn(720)
WAVE = ExternalForce(THETA, 30.0 + 60.0 * np.sin(THETA))
STROKES = "\n".join(f"{angle},{300.0 if 100 <= angle < 160 else 0.0}" for angle in range(360))


@cache
def pitch():
    motion = SegmentMotion((
        Segment("cycloidal", np.radians(120.0), 0.01), Segment("dwell", np.radians(40.0)),
        Segment("polynomial_345", np.radians(140.0), -0.01), Segment("dwell", np.radians(60.0)),
    ))  # fmt: skip
    return PitchCurve(motion.lift(), 0.04)


def follower(**changes):
    return replace(FollowerSystem(0.5, SPRING, 0.08, 0.03, 0.05, 0.1), **changes)


def with_keys(text):
    """The small machine with more keys of its follower."""
    return small_machine("applied").replace('mass = "250 g"', f'mass = "250 g"\n{text}')


@cache
def stamped(tmp):
    """Machine with a force over the cam angle, hanging at 30 deg from the vertical."""
    (tmp / "force.csv").write_text(f"cam_angle_deg,force_N\n{STROKES}\n", encoding="utf-8")
    text = with_keys('external_force_file = "force.csv"\ngravity_angle = "30 deg"')
    (tmp / "case.toml").write_text(text, encoding="utf-8")
    return read_case(tmp / "case.toml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("applied")


@pytest.fixture(scope="module")
def trial(folder):
    return preview_case(stamped(folder), corners=False)


def test_force_is_linear_between_samples_and_periodic():
    force = ExternalForce(np.radians([30.0, 90.0, 300.0]), np.array([1.0, 7.0, -3.0]))
    assert force.at(np.radians([60.0, 90.0, 345.0, -15.0])) == pytest.approx([4, 7, -1, -1])
    assert force.mean == pytest.approx((60 * 4.0 + 210 * 2.0 + 90 * -1.0) / 360.0, rel=1e-14)
    assert force.plus(2.0).mean == pytest.approx(force.mean + 2.0, rel=1e-14)
    assert not ExternalForce.constant(5.0).varies


@pytest.mark.parametrize(
    ("theta", "force"), [([0.0, 0.0], [1, 2]), ([0.0, 7.0], [1, 2]), ([], []), ([0.0], [np.nan])]
)
def test_bad_forces_are_refused(theta, force):
    with pytest.raises(InputError, match="external_force"):
        ExternalForce(np.array(theta), np.array(force, dtype=float))


def test_applied_force_adds_to_the_axial_force():
    plain = follower_loads(pitch(), follower(), 20.0, THETA)
    pressed = follower(external=WAVE, gravity_along_axis=9.0)
    loads = follower_loads(pitch(), pressed, 20.0, THETA)
    added = 0.5 * 9.0 + WAVE.at(THETA)
    assert loads.applied_force == pytest.approx(added, rel=1e-15)
    assert loads.required_force - plain.required_force == pytest.approx(added, abs=1e-12)
    touching = loads.normal_force > 0.0
    assert touching.all()
    ratio = loads.axial_force / plain.axial_force
    assert ratio == pytest.approx(loads.required_force / plain.required_force, rel=1e-13)


def test_cam_torque_does_the_work_of_the_external_force():
    """Over a turn the cam torque does the work of the force and of friction."""
    smooth = follower(friction_a=0.0, friction_b=0.0, external=WAVE, gravity_along_axis=9.0)
    loads = follower_loads(pitch(), smooth, 20.0, THETA)
    exact = np.sum(60.0 * np.sin(THETA) * loads.lift_slope) * THETA[1]
    assert loads.applied_work == pytest.approx(exact, rel=1e-12)
    assert np.sum(loads.cam_torque) * THETA[1] == pytest.approx(exact, rel=1e-9)
    constant = replace(smooth, external=ExternalForce.constant(80.0))
    assert follower_loads(pitch(), constant, 20.0, THETA).applied_work == pytest.approx(0, abs=1e-9)


def test_elastic_follower_under_a_constant_load_is_one_of_more_preload():
    lift, speed = pitch().lift(THETA), 30.0
    loaded = ElasticFollower(0.5, 2e6, 20e3, 200.0, 40.0, load=ExternalForce.constant(-35.0))
    same = ElasticFollower(0.5, 2e6, 20e3, 165.0, 40.0)
    one, two = (harmonic_response(lift, speed, each) for each in (loaded, same))
    assert one.contact_force == pytest.approx(two.contact_force, abs=1e-6)


def test_elastic_follower_under_a_varying_load():
    """Harmonic balance, collocation and integration in time agree; the energy closes."""
    count, corners = 361, uniform_turn(12)
    load = ExternalForce(corners, 30.0 + 60.0 * np.sin(corners))
    theta, f = uniform_turn(count), ElasticFollower(0.5, 5e4, 20e3, 200.0, 60.0, load=load)
    lift = pitch().lift(theta)
    by_harmonics = harmonic_response(lift, 30.0, f)
    again = collocation_response(lift, np.full(count, 30.0), f)
    assert again.contact_force == pytest.approx(by_harmonics.contact_force, abs=1e-6)
    start = float(by_harmonics.position[0]), float(by_harmonics.velocity[0])
    motion = bounce(pitch().lift, 30.0, f, 0.25, start)
    # the spectrum of the load ends at the 180th harmonic, 1e-3 of its amplitude at its kinks
    early = theta < 0.5 * np.pi
    inside = np.interp(theta[early], motion.theta, motion.contact_force)
    assert inside == pytest.approx(by_harmonics.contact_force[early], abs=0.1)
    assert energy_error(motion) < 1e-8


def test_keys_of_a_case():
    case = parse_case(with_keys('external_force = "40 N"\ngravity_angle = "60 deg"'))
    assert external_force(case).force == 40.0
    assert dead_load(case) == pytest.approx(40.0 + 0.25 * 0.5 * STANDARD_GRAVITY, rel=1e-14)
    assert closing_preload(case) == 400.0 + dead_load(case)
    plain = parse_case(with_keys(""))
    assert dead_load(plain) == 0.0
    assert "external_force" not in plain.to_toml()


@pytest.mark.parametrize(
    ("keys", "refusal"),
    [
        ('external_force = "40 mm"', "follower.external_force = 40 mm"),
        ('gravity_angle = "200 deg"', "gravity_angle = 200 deg, must be >= 0 and <= 180 deg"),
        ('external_force = "40 N"\nexternal_force_file = "f.csv"', "left out with follower.ext"),
    ],
)
def test_bad_keys_are_refused(keys, refusal):
    with pytest.raises(InputError) as caught:
        parse_case(with_keys(keys))
    assert refusal in str(caught.value)


@pytest.mark.parametrize(
    ("header", "force", "refusal"),
    [
        ("cam_angle_deg,force", lambda k: k % 9, "one column of force with its unit"),
        ("angle,force_N", lambda k: k % 9, "one column of cam angle with its unit"),
        ("crank_angle_deg,force_N", lambda k: k % 9, "one column of cam angle with its unit"),
        ("cam_angle_deg,force_N", lambda k: 0, "0 N at every angle"),
        ("cam_angle_deg,force_N", lambda k: k, "not closed, 36 N between both ends"),
        ("cam_angle_deg,force_N", lambda k: (-1) ** k, "must be more rows"),
        ("cam_angle_rad,force_N", lambda k: k % 9, "(the angles look like degrees)"),
    ],
)
def test_bad_file_is_refused_in_one_line_when_the_case_is_read(tmp_path, header, force, refusal):
    rows = "\n".join(f"{10 * k},{force(k)}" for k in range(37))
    (tmp_path / "force.csv").write_text(f"{header}\n{rows}\n", encoding="utf-8")
    case = with_keys('external_force_file = "force.csv"')
    (tmp_path / "case.toml").write_text(case, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_case(tmp_path / "case.toml")
    assert refusal in str(caught.value)
    assert "\n" not in str(caught.value)


def test_follower_that_hangs_off_the_cam_stores_no_work():
    case = parse_case(with_keys('external_force = "-500 N"'))
    with pytest.raises(InputError, match=r"spring.preload = 400 N, must be > 500 N, as weight"):
        closing_preload(case)


def test_lift_stores_the_work_with_the_dead_load(trial):
    """(P + k s + F) s' is the required torque, F the weight and the mean of the force."""
    case = trial.case
    torque = engine_torques(case)["idle"]
    smoother = Smoother.from_case(case.smoothing, case.period)
    lift = required_lift(case, torque, smoother)
    wanted = case.mechanism.gear_ratio * required_torque(case, torque, smoother)
    theta = uniform_turn(wanted.size)
    held = case.spring.force(lift(theta)) + dead_load(case)
    wide = float(np.abs(wanted).max())
    assert held * lift(theta, 1) == pytest.approx(wanted, abs=1e-6 * wide)
    assert dead_load(case) == pytest.approx(
        300.0 * 60 / 360 + 0.25 * np.cos(np.radians(30.0)) * STANDARD_GRAVITY, rel=1e-12
    )


def test_preview_balances_the_work_and_tells_it(trial):
    checks = {each.id: each for each in trial.checks}
    balance = checks["friction_balance"]
    assert balance.demand < 1e-6  # as without the force: the forces are solved to 1e-10
    assert "the external force" in balance.note
    cycle = trial.cycles[0]
    applied = next(v for c, v in cycle.columns().items() if c.name == "applied_force")
    assert applied == pytest.approx(cycle.machine.system.load.at(cycle.theta), rel=1e-15)


def test_screening_has_the_same_forces(folder, trial):
    case, checks = stamped(folder), {each.id: each for each in trial.checks}
    columns = screen_designs(case, {"follower.mass": np.array([0.25, 0.4])}, positions=72)
    for name, apart in (("torque_reduction", 1e-3), ("jump", 3e-3), ("jump_speed", 3e-3)):
        check = checks[name]
        demand = columns[f"{name}.demand"][0]
        assert demand == pytest.approx(in_unit(check.demand, check.unit), rel=apart), name


def test_synthesis_has_the_same_forces_and_exact_derivatives(folder):
    """Forces of the search are those of the follower; complex steps against differences."""
    case = stamped(folder)
    problem = problem_of(case, engine_torques(case))
    search = Search(problem)
    theta, idle = search.turn.theta, problem.scenarios[0]
    energy = search.turn.energy(search.exact)
    jet = lift_jet(energy, problem.variables)
    design_lift = Lift(theta, jet.lift)
    drive = machine(case, case.load_cases[0])
    loads = follower_loads(
        PitchCurve(design_lift, case.cam.prime_radius), drive.system, drive.cam_speed, theta
    )
    stack = stacked([idle], theta)
    force = loaded(jet, float(jet.lift.max()), problem.variables, problem.ratings, stack)
    wide = float(np.abs(loads.axial_force).max())
    assert force.closing[0] == pytest.approx(loads.closing_force, abs=1e-9 * wide)
    touching = loads.required_force > 0.0
    assert touching.sum() > 600
    # the spline through the lift is not the lift of the spline of the energy
    assert force.axial[0][touching] == pytest.approx(loads.axial_force[touching], abs=1e-4 * wide)
    step = 1e-30
    by_complex = lift_jet((energy[0] + 1j * step, *energy[1:]), problem.variables)
    finite = 1e-6 * float(energy[0].max())
    up, down = (
        lift_jet((energy[0] + side * finite, *energy[1:]), problem.variables) for side in (1, -1)
    )
    for name in ("lift", "slope", "lift_d2", "jerk"):
        slope = (getattr(up, name) - getattr(down, name)) / (2.0 * finite)
        exact = np.imag(getattr(by_complex, name)) / step
        assert exact == pytest.approx(slope, abs=1e-6 * np.abs(slope).max()), name


def test_mass_of_a_corner_has_its_weight(folder):
    case = stamped(folder)
    drive = machine(case, case.load_cases[0])
    heavy = replace(drive, mass=2.0 * drive.mass)
    weight = drive.mass * drive.gravity_along_axis
    assert heavy.system.dead_load - drive.system.dead_load == pytest.approx(weight, rel=1e-12)

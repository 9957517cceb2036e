"""Sweep over the speed: its limits without the spring's mass, its grid, its tolerances."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks import jump_and_jamming, part_data, spring_strength
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.elastic_response import elastic_follower
from camwright.pipeline.cycle.solution import solution
from camwright.pipeline.cycle.speed_sweep import highest_speed, speed_sweep
from camwright.pipeline.follower.elastic_follower import harmonic_response

SOFT_SPRING = Path(__file__).parents[1] / "data" / "soft_spring.toml"
RPM = np.pi / 30.0
THETA = uniform_turn(720)
LIFT = Lift(THETA, 0.01 * (1.0 - np.cos(THETA)) + 1.5e-4 * (1.0 - np.cos(6.0 * THETA)))


def solved_case(overspeed=3600.0 * RPM, rate_tolerance=1e-12, lift=LIFT, **design):
    case = read_case(SOFT_SPRING)
    spring = replace(
        case.spring,
        design=replace(case.spring.design, **design),
        rate_tolerance=rate_tolerance,
    )
    limits = case.limits.model_copy(update={"overspeed": overspeed})
    case = case.model_copy(update={"spring": spring, "limits": limits})
    contour = case.contour(lift)
    return solution(case, contour, Tier.PREVIEW, torques={}, positions=180)


@pytest.fixture(scope="module")
def solved():
    return solved_case()


def massless(machine):
    return replace(machine, spring=replace(machine.spring, design=None), spring_mass=0.0)


def test_without_mass_of_the_coils_it_is_the_turn_of_the_load_case(solved):
    """Normal force and torque as in the solved cycle; the elastic stem by harmonic balance."""
    for cycle in solved.cycles:
        machine = massless(cycle.machine)
        sweep = speed_sweep(machine, solved.contour, cycle.loads.rubbing, [machine.crank_speed])
        assert sweep.crank_speed[-1] == pytest.approx(machine.crank_speed)
        loads = cycle.loads
        assert sweep.contact_force_min[-1] == pytest.approx(loads.normal_force.min(), rel=2e-3)
        assert sweep.contact_force_max[-1] == pytest.approx(loads.normal_force.max(), rel=2e-3)
        assert sweep.torque_max[-1] == pytest.approx(loads.cam_torque.max(), rel=2e-3)
        assert sweep.torque_min[-1] == pytest.approx(loads.cam_torque.min(), rel=2e-3)
        response = harmonic_response(LIFT.values, machine.cam_speed, elastic_follower(machine))
        least = response.contact_force.min()
        assert sweep.elastic_force_min[-1] == pytest.approx(least, rel=1e-6)
        assert not sweep.surge_force.any()


def test_heavy_coils_of_no_stiffness_to_speak_of_weigh_a_third(solved):
    """Slow: m + m_s/3 moves with the follower."""
    machine = replace(solved.machine, spring_mass=0.0)
    rubbing = solved.cycles[0].loads.rubbing
    heavier = replace(machine, mass=machine.mass + machine.spring.design.active_mass / 3.0)
    slow = [400.0 * RPM]
    waves = speed_sweep(machine, solved.contour, rubbing, slow)
    lumped = speed_sweep(massless(heavier), solved.contour, rubbing, slow)
    light = speed_sweep(massless(machine), solved.contour, rubbing, slow)
    added = lumped.contact_force_max[-1] - light.contact_force_max[-1]
    assert waves.contact_force_max[-1] == pytest.approx(
        lumped.contact_force_max[-1], abs=0.05 * abs(added)
    )


def test_the_sweep_ends_at_over_speed_or_at_the_fastest_load_case(solved):
    assert highest_speed(solved.machines) == pytest.approx(3600.0 * RPM)
    (sweep,) = solved.speed_sweeps
    assert (sweep.crank_speed[0], sweep.crank_speed[-1]) == (0.0, pytest.approx(3600.0 * RPM))
    assert (np.diff(sweep.crank_speed) > 0.0).all()
    (open_ended,) = solved_case(overspeed=None).speed_sweeps
    assert open_ended.crank_speed[-1] == pytest.approx(3600.0 * RPM)  # of a load case
    (faster,) = solved_case(overspeed=4200.0 * RPM).speed_sweeps
    assert faster.crank_speed[-1] == pytest.approx(4200.0 * RPM)
    assert faster.contact_force_min.min() <= sweep.contact_force_min.min() + 1e-3


@pytest.mark.parametrize("damping", [1e-4, 0.5])
def test_any_damping_is_swept_at_a_bounded_number_of_speeds(damping):
    (sweep,) = solved_case(damping_ratio=damping).speed_sweeps
    assert sweep.crank_speed.size < 5000
    assert np.isfinite(sweep.contact_force_min).all()


def test_less_damping_unloads_the_contact_further():
    least = [
        jump_and_jamming.contact_over_speed(solved_case(damping_ratio=damping)).demand
        for damping in (0.002, 0.05)
    ]
    assert least == sorted(least)
    assert least[0] < -2.0


def test_a_damping_that_is_not_stated_widens_the_error_bar():
    """Down to 0.002: a contact kept at 1 % of damping is not proven then."""
    limit = 0.2
    small = replace(LIFT, values=0.01 * (1.0 - np.cos(THETA)) + 4e-5 * (1.0 - np.cos(6.0 * THETA)))
    demands = {}
    for damping in (None, 0.002, 0.01):
        solved = solved_case(lift=small, damping_ratio=damping)
        demands[damping] = (
            jump_and_jamming.contact_over_speed(solved),
            spring_strength.spring_stress(solved),
            spring_strength.spring_fatigue(solved),
        )
    for open_one, low, stated in zip(*demands.values(), strict=True):
        assert open_one.demand == pytest.approx(stated.demand, rel=1e-9)
        worse = 1.0 if open_one.sense == "at_most" else -1.0
        reach = open_one.demand + worse * open_one.error
        assert reach == pytest.approx(low.demand, rel=1e-6), open_one.id
    contact, low, stated = (each[0] for each in demands.values())
    assert contact.limit == limit < stated.demand
    assert low.demand < limit
    assert (contact.not_proven, contact.status, stated.status) == (True, "fail", "pass")


def test_a_wider_tolerance_of_the_rate_never_relieves_the_spring():
    """A resonance just above over-speed comes into the range of a softer spring."""
    stress, safety = [], []
    for tolerance in (1e-12, 0.05, 0.1):
        solved = solved_case(overspeed=3380.0 * RPM, rate_tolerance=tolerance)
        slow = tuple(each for each in solved.machines if each.load_case == "idle")
        solved = replace(solved, machines=slow)
        stress.append(spring_strength.spring_stress(solved).demand)
        safety.append(spring_strength.spring_fatigue(solved).demand)
    assert stress == sorted(stress)
    assert safety == sorted(safety, reverse=True)
    assert stress[1] > 1.2 * stress[0]


def test_spring_without_its_design_is_a_row_of_its_own(solved):
    machines = tuple(massless(each) for each in solved.machines)
    cycles = tuple(
        replace(each, turn=replace(each.turn, machine=massless(each.machine)))
        for each in solved.cycles
    )
    bare = replace(solved, machines=machines, cycles=cycles)
    assert jump_and_jamming.contact_over_speed(bare) is None
    row = part_data.data_spring(bare)
    assert (row.status, row.blocks) == ("not_evaluated", True)
    assert bare.hardest_spring is None
    assert np.isfinite(jump_and_jamming.elastic_contact(bare).demand)

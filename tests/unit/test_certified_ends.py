"""Angles, moments and record of the certificate of bodies with ends."""

import json
from dataclasses import replace

import numpy as np
import pytest

import camwright as cw
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.finite_length.length_certificate import length_certificate
from camwright.pipeline.cycle.certificate_angles import length_loads
from camwright.pipeline.results.run_records import length_record


@pytest.fixture(scope="module")
def trial():
    cam = cw.synthesize(read_case("tests/data/every_part.toml"))
    return cw.solve(cam.case, cam.contour, tier=cw.Tier.PREVIEW, positions=72, corners=False)


def test_the_greatest_signed_pressure_is_certified_at_its_moment(trial):
    cycles = trial.solution.cycles
    first, named = length_loads(cycles, [np.radians(55.0)])
    worst = max(cycles, key=lambda cycle: np.nanmax(cycle.signed_pressure))
    k = int(np.nanargmax(worst.signed_pressure))
    assert (first.load_case, first.theta) == (worst.load_case, worst.theta[k])
    assert first.force == worst.loads.normal_force[k]
    assert abs(first.moment) == pytest.approx(worst.length.moment[k])
    assert first.pair.curvature == pytest.approx(1 / worst.contact.relative_radius[k])
    assert named.load_case == cycles[0].load_case
    assert named.theta == pytest.approx(np.radians(55.0), abs=np.radians(2.5))


def test_an_angle_is_certified_once(trial):
    cycles = trial.solution.cycles[:1]
    k = int(np.nanargmax(cycles[0].signed_pressure))
    assert len(length_loads(cycles, [cycles[0].theta[k]] * 2)) == 1


def test_without_ends_there_is_nothing_to_certify(trial):
    cycle = trial.solution.cycles[0]
    machine = replace(cycle.machine, cam=replace(cycle.machine.cam, end=None))
    bare = replace(cycle, turn=replace(cycle.turn, machine=machine))
    assert length_loads([bare], [1.0]) == ()


@pytest.mark.slow
def test_record_of_both_tiers(trial):
    loads = length_loads(trial.solution.cycles, [])
    (record,) = length_record(length_certificate(loads, 1e-4, 2.0))
    assert json.loads(json.dumps(record)) == record
    assert record["load_case"] == loads[0].load_case
    assert record["moment_Nmm"] == pytest.approx(1e3 * loads[0].moment)
    half_space, blocks = record["half_space"], record["finite_elements"]
    for name, difference in record["difference"].items():
        assert difference == pytest.approx(half_space[name] - blocks[name])
    assert half_space["mean_length_mm"] == pytest.approx(0.1)
    assert blocks["unknowns"] > half_space["unknowns"]
    assert length_record(None) == []


@pytest.mark.slow
def test_a_certified_solution_has_its_ends():
    case = read_case("tests/data/every_part.toml")
    solver = case.solver.model_copy(update={"end_elements": 2, "end_angles": (np.radians(55.0),)})
    cam = cw.synthesize(case.model_copy(update={"solver": solver}))
    solved = cw.solve(cam.case, cam.contour, positions=36, corners=False).solution
    assert len(solved.length_certificate.points) == 2
    assert solved.length_certificate.mean_length == pytest.approx(1e-4)

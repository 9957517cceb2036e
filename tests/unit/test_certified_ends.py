"""Angles, moments and record of the certificate of bodies with ends."""

import json
from dataclasses import replace

import numpy as np
import pytest

import camwright as cw
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks.contact_strength import edge_pressure
from camwright.pipeline.checks.registry import checks_of
from camwright.pipeline.contact.finite_length.length_certificate import begun_ends
from camwright.pipeline.cycle.certificate_angles import length_loads
from camwright.pipeline.cycle.length_records import length_record


@pytest.fixture(scope="module")
def trial():
    cam = cw.synthesize(read_case("tests/data/every_part.toml"))
    return cw.solve(cam.case, cam.contour, tier=cw.Tier.PREVIEW, positions=72, corners=False)


def test_the_greatest_signed_pressure_is_certified_at_its_moment(trial):
    cycles = trial.solution.cycles
    first, *others, named = length_loads(cycles, [np.radians(55.0)])
    assert {one.load_case for one in others} <= {each.load_case for each in cycles}
    assert first.load_case not in {one.load_case for one in others}
    worst = max(cycles, key=lambda cycle: np.nanmax(cycle.signed_pressure))
    k = int(np.nanargmax(worst.signed_pressure))
    assert (first.load_case, first.theta) == (worst.load_case, worst.theta[k])
    assert first.force == worst.loads.normal_force[k]
    assert abs(first.moment) == pytest.approx(worst.length.moment[k])
    assert first.pair.curvature == pytest.approx(1 / worst.contact.relative_radius[k])
    assert first.factor == pytest.approx(worst.length.factor[k], rel=1e-6)
    assert named.load_case == cycles[0].load_case
    assert named.theta == pytest.approx(np.radians(55.0), abs=np.radians(2.5))


def test_a_load_case_that_locks_is_not_certified(trial):
    cycles = list(trial.solution.cycles)
    (first, *_) = length_loads(cycles, [])
    number = next(n for n, cycle in enumerate(cycles) if cycle.load_case == first.load_case)
    turn = cycles[number].turn
    index = turn.loads.driving_jam.copy()
    index[np.argmax(turn.loads.lift_slope)] = 1.0
    jammed = replace(turn, loads=replace(turn.loads, driving_jam=index))
    cycles[number] = replace(cycles[number], turn=jammed)
    assert cycles[number].end is not None
    assert first.load_case not in {load.load_case for load in length_loads(cycles, [])}
    alone = length_loads(cycles[number : number + 1], [])
    assert [load.theta for load in alone] == [first.theta]


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
    certificate = begun_ends(loads[:1], 1e-4, 2.0).certificate()
    (record,) = length_record(certificate, ("cam", "roller"))
    assert json.loads(json.dumps(record)) == record
    assert record["load_case"] == loads[0].load_case
    assert record["moment_Nmm"] == pytest.approx(1e3 * loads[0].moment)
    half_space, blocks = record["half_space"], record["finite_elements"]
    for name, difference in record["difference"].items():
        assert difference == pytest.approx(half_space[name] - blocks[name])
    assert half_space["mean_length_mm"] == pytest.approx(0.1)
    assert blocks["unknowns"] > half_space["unknowns"]
    line = record["finite_elements"]["axial"]
    assert len(line["y_mm"]) == len(line["factor"])
    assert max(line["factor"]) == pytest.approx(blocks["greatest"], rel=1e-6)
    stress = record["finite_elements"]["stress"]
    assert set(stress) == {"cam", "roller"}
    assert 0.4 < stress["cam"]["centre"]["von_mises"] < 0.7
    assert record["ratio"] == pytest.approx(record["signed_factor"] / record["cycle_factor"])
    assert length_record(None, ()) == []


def with_ends(**keys):
    """The case of every part on coarse finite elements, certified at one angle besides."""
    case = read_case("tests/data/every_part.toml")
    solver = case.solver.model_copy(update={"end_elements": 2, "certificate_positions": 1} | keys)
    return cw.synthesize(case.model_copy(update={"solver": solver}))


def test_a_certified_run_signs_the_pressure_of_finite_elements():
    cam = with_ends()
    solved = cw.solve(cam.case, cam.contour, positions=36, corners=False)
    solution = solved.solution
    certificate, cycles = solution.length_certificate, solution.cycles
    first, (correction,) = certificate.points[0], certificate.corrections
    case = next(c for c in cycles if c.load_case == first.load.load_case)
    worst = int(np.nanargmax(case.signed_pressure))
    assert case.theta[worst] == first.load.theta
    signed = first.finite_elements.signed
    assert case.length.factor[worst] == pytest.approx(
        signed.values[-1] * correction.signed / first.ratio, rel=1e-6
    )
    assert correction.signed >= first.ratio
    assert (case.length.error == correction.signed_error).all()
    check = next(one for one in solved.checks if one.id == "edge_pressure")
    assert check.demand == pytest.approx(case.signed_pressure[worst])
    sentence = case.length.sentence(worst)
    assert f"times {correction.signed:.4g}, the greatest ratio of finite elements" in sentence
    assert sentence in check.note
    uncorrected = [replace(cycle, ends=None) for cycle in cycles]
    off = replace(solution, cycles=tuple(uncorrected), length_certificate=None)
    (other,) = checks_of(off, [edge_pressure])
    stated = float(uncorrected[cycles.index(case)].length.error[worst])
    assert f"error bar {100 * stated:.2g} % as stated, finite elements not solved" in other.note
    assert check.error_share - correction.signed_error == pytest.approx(
        other.error_share - stated, rel=1e-6
    )
    assert check.demand == pytest.approx(other.demand * correction.signed, rel=1e-9)

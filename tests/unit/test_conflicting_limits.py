"""Work of a synthesis: it is bounded where limits conflict and where a search falls to and fro.

The violations compared with are those of a search that goes on, by penalties of 200 and 2000, until
its trust region is 1e-7.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing import trust_region
from camwright.pipeline.smoothing.constrained_synthesis import approached, started
from camwright.pipeline.smoothing.multistart import explored
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.synthesis_problem import coarsened
from camwright.pipeline.smoothing.trust_region import PENALTY, descended

CASES = Path(__file__).parents[2] / "cases"
OFFSET_PUMP = (
    "machines/hand-pump.toml",
    {
        "cam.offset": "-10.5 mm",
        "cam.profile_tolerance": "11.9672 um",
        "camshaft.diameter": "31.728 mm",
        "follower.mass": "1.07624 kg",
        "guides.b.length": "43.275 mm",
        "roller.width": "9.716 mm",
        "solver.positions": 240,
    },
)
FAST_TWO_STROKE = (
    "machines/two-stroke.toml",
    {
        "cam.offset": "4.361 mm",
        "cam.width": "15.1791 mm",
        "crankshaft.inertia": "0.00277 kg m^2",
        "follower.mass": "1.79421 kg",
        "guides.b.length": "26.841 mm",
        "limits.overspeed": "2794.72 rpm",
        "load_case[0].speed": "2445.38 rpm",
        "roller.width": "11.417 mm",
        "solver.positions": 72,
    },
)
ACROSS_A_VALLEY = (
    "machines/hand-pump.toml",
    {
        "cam.offset": "-5.8354 mm",
        "cam.profile_tolerance": "16.6194 um",
        "cam.width": "17.2678 mm",
        "guides.b.length": "36.5461 mm",
        "limits.overspeed": "68.6006 rpm",
        "limits.torque_reduction": 0.2656,
        "load_case[0].speed": "52.1364 rpm",
        "solver.positions": 127,
        "spring.preload": "445.164 N",
    },
)
ROUGH = (
    "machines/compressor.toml",
    {
        "cam.offset": "11.0199 mm",
        "cam.prime_radius": "57.023 mm",
        "follower.mass": "1.64193 kg",
        "solver.positions": 127,
    },
)
WIDE_SPEEDS_OF_A_FACE = (
    "gx120-flat-face.toml",
    {
        "cam.width": "16.9977 mm",
        "follower.overhang_at_max_lift": "33 mm",
        "limits.overspeed": "9074.74 rpm",
        "load_case[0].speed": "511.8 rpm",
        "load_case[1].speed": "8249.76 rpm",
        "solver.positions": 127,
        "spring.rate": "152.73 kN/m",
    },
)


def problem(name, values):
    case = with_values(read_case(CASES / name), values)
    return problem_of(case, engine_torques(case))


@pytest.fixture
def programs(monkeypatch):
    """Sizes of the convex programs that were solved."""
    sizes, solve = [], trust_region.solved

    def counted(*arguments):
        sizes.append(arguments[3].size)
        return solve(*arguments)

    monkeypatch.setattr(trust_region, "solved", counted)
    return sizes


@pytest.mark.parametrize(
    ("variant", "least"),
    [
        pytest.param(OFFSET_PUMP, 0.3693, id="offset"),
        pytest.param(FAST_TWO_STROKE, 0.02009, id="offset and two lobes", marks=pytest.mark.slow),
        pytest.param(WIDE_SPEEDS_OF_A_FACE, 1.8049, id="flat face", marks=pytest.mark.slow),
    ],
)
def test_a_search_that_is_stuck_outside_the_limits_ends(variant, least, programs):
    """In place of 103, 142 and 131 programs; the violation is that of a search to its end."""
    state = approached(coarsened(problem(*variant)))
    assert len(programs) < 50
    assert state.violation == pytest.approx(least, rel=0.01)


def test_a_side_is_kept_where_a_program_meets_its_row_to_the_tolerance_of_the_solver():
    """Else the slope may be 1e-9 of its greatest on the other side, whose loads are others."""
    search = started(coarsened(problem(*OFFSET_PUMP)))
    state = search.state(search.start, search.problem.variables)
    slope = search.turn.energy(state.coefficients)[1]
    points = np.flatnonzero(np.abs(slope) > 0.0)
    (rows,) = search.kept_sides(state, points)
    assert points.size > 200 and (rows.level < 0.0).all()
    kept = []
    for number, point in enumerate(points):
        step, entries = np.zeros(search.size), rows.entries[number]
        step[rows.columns[number]] = (1e-8 - rows.level[number]) * entries / (entries @ entries)
        after = search.turn.energy(search.after(state, step)[0])[1][point]
        kept.append(after * slope[point] > 0.0 or abs(slope[point]) < 2e-8 * np.abs(slope).max())
    assert all(kept)


def test_limits_that_conflict_are_not_sought_on_more_splines(programs):
    """The violation, summed over all limits, is within 1 % of the least known."""
    found = explored(problem(*OFFSET_PUMP), 1)
    assert len(programs) < 80 and max(programs) == 64
    assert found.design.stuck and not found.design.feasible
    assert found.design.violation == pytest.approx(0.3693, rel=0.01)
    assert found.design.ripple_gain is None
    assert not found.resolution.settled and found.resolution.coarser is None
    assert "limits conflict" in found.resolution.sentence


def test_a_limit_dearer_than_the_first_penalty_is_kept_all_the_same():
    """Its violation is no conflict: the linear models lower it, and the penalty is raised."""
    given = problem(*OFFSET_PUMP)
    kept = replace(given, left_out=frozenset({"contact_pressure", "torque_reduction"}))
    end = descended(started(coarsened(kept)), ripple_weight=500.0)
    assert end.penalty > PENALTY and not end.stuck
    assert end.state.violation < 1e-5


def test_a_search_does_not_fall_to_and_fro_across_a_valley(programs):
    """Ripple and loss trade: 15 programs where steps that are not shortened take 40."""
    design = explored(replace(problem(*ACROSS_A_VALLEY), convergence=None), 1).design
    assert len(programs) < 25
    assert design.converged and design.feasible
    assert design.objective == pytest.approx(0.25896, rel=3e-4)


def test_the_effort_ends_a_rough_search_within_the_limits(programs):
    """Near the ripple of the search to its end, 0.7807."""
    limited = replace(problem(*ROUGH), convergence=None, effort=12)
    design = explored(limited, 1).design
    assert design.ended and design.feasible and not design.converged
    assert design.ripple == pytest.approx(0.7807, rel=0.002)
    assert design.lagrangian is None and design.ripple_gain

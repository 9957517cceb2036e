"""Three meshes of every figure and the benchmarks: limits, NaN, missing, by hand."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
import scipy
from made_check import made_check
from synthesis_ratings import rated
from trial_variants import with_benchmark, with_certificate

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.checks import guide_strength
from camwright.pipeline.checks import solution_verification as verification
from camwright.pipeline.checks.contact_strength import contact_pressure
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.contact import contact_benchmarks
from camwright.pipeline.contact.elasticity.mesh_convergence import converged
from camwright.pipeline.smoothing import trust_region
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables, Scenario
from camwright.pipeline.smoothing.synthesis_problem import Problem

MESHED = {
    "p0": verification.mesh_p0,
    "half_width": verification.mesh_half_width,
    "von_mises": verification.mesh_von_mises,
    "tau_max": verification.mesh_tau_max,
}


@pytest.mark.parametrize("field", MESHED)
@pytest.mark.parametrize(
    ("gci", "status"), [(0.0297, "pass"), (0.0303, "fail"), (np.nan, "not_evaluated")]
)
def test_each_figure_has_its_own_error_bar(field, gci, status):
    check = MESHED[field](with_certificate(**{field: made.converged(gci)}))
    assert check.status == status
    assert check.must_have
    assert check.cam_angle == pytest.approx(1.5)


@pytest.mark.parametrize("field", MESHED)
def test_without_a_certificate_nothing_is_claimed(field):
    assert MESHED[field](made.solution(certificate=())).status == "not_evaluated"


@pytest.mark.parametrize("check", [verification.benchmark_nafems, verification.benchmark_hertz])
@pytest.mark.parametrize(
    ("off", "status"), [(-0.0297, "pass"), (0.0303, "fail"), (np.nan, "not_evaluated")]
)
def test_benchmarks_at_their_limit(check, off, status):
    name = check.id.removeprefix("benchmark_")
    assert check(with_benchmark(name, off)).status == status
    missing = check(made.solution(benchmarks=None))
    assert (missing.status, missing.must_have) == ("not_evaluated", True)


def test_gci_by_hand():
    """Second order on halved meshes: f = 1 + h^2; GCI = 1.25 e/(r^p - 1), Roache (1998)."""
    figure = converged([1.16, 1.04, 1.01], 2.0)
    assert figure.order == pytest.approx(2.0)
    assert figure.gci == pytest.approx(1.25 * (0.03 / 1.01) / 3.0)


def test_error_bar_of_the_pressure_joins_tiers_and_meshes():
    solution = made.solution()
    (check,) = with_error_bars(solution, [contact_pressure(solution)])
    # 0.4 % of the meshes and 0.4 % between the tiers at one angle.
    assert check.error == pytest.approx(0.008 * check.demand, rel=1e-3)
    (bare,) = with_error_bars(made.solution(certificate=()), [contact_pressure(solution)])
    assert bare.error is None
    spread = verification.certificate_spread(solution).as_record()
    assert spread["demand"] == pytest.approx(0.4)


def test_error_bar_of_the_pressure_is_unknown_where_one_angle_is():
    solution = with_certificate(p0_cycle=np.nan)
    (check,) = with_error_bars(solution, [contact_pressure(solution)])
    assert check.error is None


def test_benchmarks_are_solved_here(monkeypatch, tmp_path):
    """Both within 1 % of the known answers; the second time from what was kept."""
    monkeypatch.setenv("CAMWRIGHT_CACHE", str(tmp_path))
    monkeypatch.delenv("CAMWRIGHT_NO_CACHE", raising=False)
    solved = contact_benchmarks.benchmarks(0.008)
    assert all(abs(solved[f"{n}_{f}"]) < 0.01 for n in ("nafems", "hertz") for f in ("p0",))
    assert max(solved["nafems_residual"], solved["hertz_residual"]) < 1e-8
    monkeypatch.setattr(contact_benchmarks, "_solved", lambda _: pytest.fail("solved again"))
    assert contact_benchmarks.benchmarks(0.008) == solved


def test_error_bar_of_a_guide_is_that_of_its_reaction():
    solution = made.solution()
    guide = replace(guide_strength.guide_pv_a(solution), demand=2.0)
    mesh = made_check("mesh_reaction", 0.005, 0.03, unit="%")
    # Half a per cent of the mesh, and what rounding leaves.
    assert with_error_bars(solution, [guide, mesh])[0].error == pytest.approx(0.01)
    assert with_error_bars(solution, [guide])[0].error is None


@pytest.mark.parametrize(("steps", "status"), [(60, "pass"), (1, "fail")])
def test_another_method_gains_what_the_check_tells(monkeypatch, steps, status):
    """Sequential quadratic programs of SciPy go on from the design; limits at their reserve."""
    monkeypatch.setattr(trust_region, "_STEPS_MAX", steps)
    theta = uniform_turn(90)
    torque = 12.0 * np.sin(2 * theta) + 6.0 * np.cos(3 * theta + 0.4) + 3.0 * np.sin(5 * theta)
    load = Scenario("one", 78.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12)
    ratings = rated(roller_radius=0.008, travel=0.045, pressure_angle=0.5, normal_force=1000.0)
    given = Problem(
        (load,), ratings, DesignVariables(24.2e3, 242.0, 0.05), coefficients=24, points=90,
        jerk_weight=0.0, seed=np.full(24, 8.0),
    )  # fmt: skip
    design = synthesise(given)
    search = Search(given, design.lagrangian.extra)

    def state(x):
        return search.state(design.coefficients + search.scale * x, design.variables)

    def left(x):
        uses = state(x).pointwise
        return np.concatenate([1.0 - 1e-3 - use.max(axis=0) for use in uses.values()])

    other = scipy.optimize.minimize(
        lambda x: state(x).ripple, np.zeros(24), method="SLSQP",
        constraints=[{"type": "ineq", "fun": left}], options={"maxiter": 15, "ftol": 1e-9},
    )  # fmt: skip
    assert left(other.x).min() > -1e-5
    gained = design.ripple - other.fun
    judged = verification.synthesis_converged(made.solution(synthesis_gain=design.gain))
    assert judged.status == status
    assert (gained <= judged.limit) == (status == "pass")

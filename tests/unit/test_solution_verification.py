"""Three meshes of every figure and the benchmarks: limits, NaN, missing, by hand."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
from made_check import made_check
from trial_variants import with_benchmark, with_certificate

from camwright.pipeline.checks import guide_strength
from camwright.pipeline.checks import solution_verification as verification
from camwright.pipeline.checks.contact_strength import contact_pressure
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.contact import contact_benchmarks
from camwright.pipeline.contact.elasticity.mesh_convergence import converged

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

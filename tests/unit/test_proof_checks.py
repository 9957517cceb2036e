"""Three meshes of every figure and the benchmarks: limits, NaN, missing, by hand."""

import made_trial as made
import numpy as np
import pytest
from trial_variants import with_benchmark, with_certificate

from camwright.pipeline.checks import proof
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.contact_strength import contact_pressure
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.checks.solution_verification import certificate_spread
from camwright.pipeline.contact import contact_benchmarks
from camwright.pipeline.contact.elasticity.mesh_convergence import converged

MESHED = {
    "p0": proof.mesh_p0,
    "half_width": proof.mesh_half_width,
    "von_mises": proof.mesh_von_mises,
    "tau_max": proof.mesh_tau_max,
}


@pytest.mark.parametrize("field", MESHED)
@pytest.mark.parametrize(
    ("gci", "status"), [(0.0297, "pass"), (0.0303, "fail"), (np.nan, "not_evaluated")]
)
def test_each_figure_has_its_own_error_bar(field, gci, status):
    check = MESHED[field](with_certificate(**{field: made.converged(gci)}))
    assert check.status == status
    assert check.must_have
    assert check.cam_angle_deg == pytest.approx(np.rad2deg(1.5))


@pytest.mark.parametrize("field", MESHED)
def test_without_a_certificate_nothing_is_claimed(field):
    assert MESHED[field](made.evidence(certificate=())).status == "not_evaluated"


@pytest.mark.parametrize("check", [proof.benchmark_nafems, proof.benchmark_hertz])
@pytest.mark.parametrize(
    ("off", "status"), [(-0.0297, "pass"), (0.0303, "fail"), (np.nan, "not_evaluated")]
)
def test_benchmarks_at_their_limit(check, off, status):
    name = check(made.evidence()).id.removeprefix("benchmark_")
    assert check(with_benchmark(name, off)).status == status
    missing = check(made.evidence(benchmarks=None))
    assert (missing.status, missing.must_have) == ("not_evaluated", True)


def test_gci_by_hand():
    """Second order on halved meshes: f = 1 + h^2; GCI = 1.25 e/(r^p - 1), Roache (1998)."""
    figure = converged([1.16, 1.04, 1.01], 2.0)
    assert figure.order == pytest.approx(2.0)
    assert figure.gci == pytest.approx(1.25 * (0.03 / 1.01) / 3.0)


def test_error_bar_of_the_pressure_joins_tiers_and_meshes():
    given = made.evidence()
    (check,) = with_error_bars(given, [contact_pressure(given)])
    # 0.4 % of the meshes and 0.4 % between the tiers at one angle.
    assert check.error == pytest.approx(0.008 * check.demand, rel=1e-3)
    (bare,) = with_error_bars(made.evidence(certificate=()), [contact_pressure(given)])
    assert bare.error is None
    assert certificate_spread(given).demand == pytest.approx(0.4)


def test_error_bar_of_the_pressure_is_unknown_where_one_angle_is():
    trial = with_certificate(p0_cycle=np.nan)
    (check,) = with_error_bars(trial, [contact_pressure(trial)])
    assert check.error is None


def test_benchmarks_are_solved_here(monkeypatch, tmp_path):
    """Both within 1 % of the known answers; the second time from what was kept."""
    monkeypatch.setenv("CAMWRIGHT_CACHE", str(tmp_path))
    monkeypatch.delenv("CAMWRIGHT_NO_CACHE", raising=False)
    found = contact_benchmarks.benchmarks(0.008)
    assert all(abs(found[f"{n}_{f}"]) < 0.01 for n in ("nafems", "hertz") for f in ("p0",))
    assert max(found["nafems_residual"], found["hertz_residual"]) < 1e-8
    monkeypatch.setattr(contact_benchmarks, "_solved", lambda _: pytest.fail("solved again"))
    assert contact_benchmarks.benchmarks(0.008) == found


def test_error_bar_of_a_guide_is_that_of_its_reaction():
    given = made.evidence()
    guide = Check("bush_pv_A", "x", 2.0, 3.0)
    mesh = Check("mesh_reaction", "y", 0.5, 3.0)
    assert with_error_bars(given, [guide, mesh])[0].error == pytest.approx(0.01)
    assert with_error_bars(given, [guide])[0].error is None

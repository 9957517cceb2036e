"""Three meshes of every figure and the benchmarks: limits, NaN, missing, by hand."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
import scipy
from made_check import made_check
from synthesis_ratings import rated
from synthesis_scenarios import loaded_with
from trial_variants import with_benchmark, with_certificate

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.checks import guide_strength
from camwright.pipeline.checks import solution_verification as verification
from camwright.pipeline.checks.contact_strength import contact_pressure
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.contact import contact_benchmarks
from camwright.pipeline.contact.elasticity.mesh_convergence import converged, converged_on_two
from camwright.pipeline.results.run_records import certificate_record
from camwright.pipeline.smoothing import trust_region
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import Problem
from camwright.reports import verification_tables

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


SCATTER = [1.0, 1.002, 0.999]
SETTLING = [1.16, 1.04, 1.01]


@pytest.mark.parametrize(
    ("field", "words"),
    [("p0", "peak pressure"), ("half_width", "half-width"), ("von_mises", "von Mises stress"),
     ("tau_max", "maximum shear stress")],
)  # fmt: skip
def test_the_greatest_index_and_deviation_name_their_quantity(field, words):
    point = {field: made.converged(0.02), f"{field}_cycle": 1.03}
    solution = with_certificate(**({"p0_cycle": 1.0} | point))
    for check, demand in (
        (verification.certificate_gci, 0.02), (verification.certificate_spread, 0.03),
    ):  # fmt: skip
        judged = check(solution)
        assert judged.demand == pytest.approx(demand)
        assert judged.method.startswith(f"{words}, the greatest of the certified quantities")
        assert "pressure" not in judged.title.lower()
    record = certificate_record(solution.certificate[1])
    assert (record["spread_of"], record["gci_of"]) == (field, field)
    assert record["gci_percent"] == pytest.approx(2.0)
    unknown = with_certificate(**{field: made.converged(np.nan), f"{field}_cycle": np.nan})
    assert verification.certificate_gci(unknown).status == "not_evaluated"
    assert verification.certificate_spread(unknown).status == "not_evaluated"


def test_a_scatter_is_called_a_scatter():
    settled, scattered = converged(SETTLING, 2.0), converged(SCATTER, 2.0)
    cases = (
        (scattered, "scatter, no order observed"),
        (settled, "observed order 2.00"),
        (converged([1.4, 1.2, 1.06], 2.0), "observed order 0.51, safety factor 3"),
        (converged_on_two([1.04, 1.01], 2.0, [settled]), "assumed order 2.00, safety factor 3"),
        (
            converged_on_two([1.04, 1.01], 2.0, [settled, scattered]),
            "scatter, no order observed at the worst angles",
        ),
    )
    for figure, words in cases:
        solution = with_certificate(tau_max=replace(figure, gci=0.02))
        assert verification.mesh_tau_max(solution).method.endswith(f"; {words}")
        assert verification.certificate_gci(solution).method.endswith(f"; {words}")


def test_rows_of_the_page_have_deviation_and_order_of_their_own_quantity():
    first, second = made.CERTIFICATE
    point = replace(second, p0=converged(SETTLING, 2.0), p0_cycle=1.003, tau_max_cycle=1.007,
                    tau_max=converged(SCATTER, 2.0))  # fmt: skip
    records = [certificate_record(first), certificate_record(point)]
    pressure = verification_tables.certificate(records)
    of_pressure = dict(zip(pressure.head, pressure.rows[1], strict=True))
    # 1.0 at zero size by hand: 1.01 - 0.03/3.
    assert (of_pressure["Deviation, %"], of_pressure["Order"]) == ("0.3", "2")
    others = verification_tables.certified(records)
    rows = [dict(zip(others.head, row, strict=True)) for row in others.rows]
    assert [row["Quantity"].split(",")[0] for row in rows[3:]] == [
        "half-width a", "maximum shear stress", "maximum von Mises stress",
    ]  # fmt: skip
    # Scatter is not extrapolated: of the finest value, three times the spread over it.
    shear = rows[4]
    assert (shear["Order"], shear["Deviation, %"], shear["GCI, %"]) == ("scatter", "0.80", "0.90")
    assert (rows[3]["Order"], rows[3]["Deviation, %"]) == ("2", "0")


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
    load = loaded_with("one", 78.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12)
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

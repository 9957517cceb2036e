"""The complementarity problem: against every possible active set, and at its edges."""

from itertools import product

import numpy as np
import pytest

from camwright.geometry.errors import ContactError
from camwright.pipeline.contact.elasticity import active_set


def problem(seed, size=6):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(size, size))
    return root @ root.T + 0.1 * np.eye(size), rng.normal(size=size), rng.uniform(0.5, 2, size)


def by_trying_all_sets(compliance, gap, weights, resultants):
    """The one set of pressures whose signs and gaps are right, with the rigid motion."""
    size, columns = gap.size, np.reshape(weights, (gap.size, -1))
    few = columns.shape[1]
    for chosen in product([False, True], repeat=size):
        active = np.array(chosen)
        count = int(active.sum())
        if count < few:
            continue
        system = np.zeros((count + few, count + few))
        system[:count, :count] = compliance[np.ix_(active, active)]
        system[:count, count:] = -columns[active]
        system[count:, :count] = columns[active].T
        unknowns = np.linalg.solve(system, np.append(-gap[active], resultants))
        pressure = np.zeros(size)
        pressure[active] = unknowns[:count]
        gaps = compliance @ pressure + gap - columns @ unknowns[count:]
        if pressure.min() >= -1e-12 and gaps[~active].min(initial=0.0) >= -1e-12:
            return pressure, unknowns[count:]
    raise AssertionError("no set fits")


@pytest.mark.parametrize("seed", range(12))
def test_answer_is_the_one_that_trying_every_set_gives(seed):
    compliance, gap, integrals = problem(seed)
    expected, (approach,) = by_trying_all_sets(compliance, gap, integrals, 0.7)
    solution = active_set.solve(compliance, gap, integrals, [0.7])
    np.testing.assert_allclose(solution.pressure[0], expected, atol=1e-10 * expected.max())
    np.testing.assert_allclose(solution.approach, approach, rtol=1e-9, atol=1e-11)
    assert solution.equilibrium[0] < 1e-12


@pytest.mark.parametrize("sweeps", [60, 0])
@pytest.mark.parametrize("seed", range(8))
def test_a_prescribed_moment_tilts_as_trying_every_set_gives(seed, sweeps, monkeypatch):
    monkeypatch.setattr(active_set, "_SWEEPS", sweeps)
    compliance, gap, integrals = problem(seed)
    levers = integrals * np.linspace(-1.0, 1.0, gap.size)
    moment = 0.7 * np.linspace(-0.8, 0.8, 8)[seed]
    both = np.column_stack([integrals, levers])
    expected, (approach, tilt) = by_trying_all_sets(compliance, gap, both, [0.7, moment])
    solution = active_set.solve(compliance, gap, integrals, [0.7], levers=levers, moment=[moment])
    np.testing.assert_allclose(solution.pressure[0], expected, atol=1e-9 * expected.max())
    np.testing.assert_allclose(
        [solution.approach[0], solution.tilt[0]], [approach, tilt], rtol=1e-8
    )
    assert solution.equilibrium[0] < 1e-12


def test_a_force_beyond_the_last_lever_has_no_contact():
    compliance, gap, integrals = problem(0)
    levers = integrals * np.linspace(-1.0, 1.0, gap.size)
    with pytest.raises(ContactError, match="tip over"):
        active_set.solve(compliance, gap, integrals, [0.7], levers=levers, moment=[0.71])


@pytest.mark.parametrize("seed", range(6))
def test_guess_does_not_change_the_answer(seed):
    compliance, gap, integrals = problem(seed)
    pressure = active_set.solve(compliance, gap, integrals, [0.7]).pressure
    for guess in ([True] + 5 * [False], [False] * 6, [True, False] * 3):
        other = active_set.solve(compliance, gap, integrals, [0.7], guess=guess).pressure
        np.testing.assert_allclose(other, pressure, atol=1e-11 * pressure.max())


def test_problems_solved_together_are_those_solved_alone():
    compliance, _, integrals = problem(0)
    gap = np.stack([problem(seed)[1] for seed in range(8)])
    force = np.geomspace(1e-6, 1e3, 8)
    together = active_set.solve(compliance, gap, integrals, force).pressure
    assert len({tuple(row) for row in together > 0}) > 1  # several active sets
    for k in range(8):
        alone = active_set.solve(compliance, gap[k], integrals, force[k : k + 1])
        np.testing.assert_allclose(together[k], alone.pressure[0], atol=1e-11 * together[k].max())


@pytest.mark.parametrize("seed", range(6))
def test_the_method_that_cannot_cycle_agrees(seed):
    compliance, gap, integrals = problem(seed)
    weight = integrals / integrals.sum()
    expected, _ = by_trying_all_sets(compliance, gap, weight, 1.0)
    pressure, _ = active_set._primal(compliance, gap, weight[:, None], np.ones(1))
    np.testing.assert_allclose(pressure, expected, atol=1e-10 * expected.max())


def test_a_set_met_twice_goes_to_the_method_that_cannot_cycle(monkeypatch):
    # No sweep allowed: every problem is a straggler.
    monkeypatch.setattr(active_set, "_SWEEPS", 0)
    compliance, gap, integrals = problem(0)
    expected, _ = by_trying_all_sets(compliance, gap, integrals, 0.7)
    solution = active_set.solve(compliance, gap, integrals, [0.7])
    np.testing.assert_allclose(solution.pressure[0], expected, atol=1e-10 * expected.max())


def test_units_do_not_matter():
    compliance, gap, integrals = problem(4)
    base = active_set.solve(compliance, gap, integrals, [0.7])
    # Metres and pascals of a steel contact instead of numbers around one.
    length, pressure = 1e-4, 1e9
    scaled = active_set.solve(
        compliance * length / pressure, gap * length, integrals, [0.7 * pressure]
    )
    np.testing.assert_allclose(scaled.pressure, base.pressure * pressure, rtol=1e-10)
    np.testing.assert_allclose(scaled.approach, base.approach * length, rtol=1e-10)


def test_contact_at_every_knot_leaves_no_gap_and_no_violation():
    compliance, _, integrals = problem(3)
    pressure = np.linspace(1.0, 2.0, 6)
    gap = -compliance @ pressure
    solution = active_set.solve(compliance, gap, integrals, [integrals @ pressure])
    np.testing.assert_allclose(solution.pressure[0], pressure, rtol=1e-9)
    assert solution.complementarity[0] < 1e-9


def test_residual_is_that_of_signs_and_products():
    compliance, gap, integrals = problem(2)
    solution = active_set.solve(compliance, gap, integrals, [0.7])
    gaps = compliance @ solution.pressure[0] + gap - solution.approach[0] * integrals
    np.testing.assert_allclose(solution.gap[0], gaps, atol=1e-12 * abs(gaps).max())
    assert (solution.pressure >= 0).all()
    assert abs(solution.pressure * solution.gap).max() < 1e-10
    assert solution.complementarity[0] < 1e-10


def test_a_compliance_without_an_inverse_is_refused():
    with pytest.raises(ContactError):
        active_set.solve(np.ones((3, 3)), np.zeros(3), np.ones(3), [1.0])


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_not_a_number_is_no_answer():
    compliance, gap, integrals = problem(1)
    with pytest.raises(ContactError):
        active_set.solve(compliance, gap * np.nan, integrals, [1.0])

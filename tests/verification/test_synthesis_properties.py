"""What holds of every synthesis: closure, the least ripple of all smoothers, limits in between."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from synthesis_ratings import rated
from synthesis_scenarios import changed, loaded_with

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.energy import lift_from_torque
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing import multistart
from camwright.pipeline.smoothing.cam_state import lift_jet
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.energy_spline import Grid, exact_start, fitted_energy
from camwright.pipeline.smoothing.multistart import explored
from camwright.pipeline.smoothing.objective import objective_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.smoothers import KINDS, Smoother, smoothed
from camwright.pipeline.smoothing.synthesis_problem import Problem, coarsened

DATA = Path(__file__).parents[1] / "data"
RATE, PRELOAD, BASE = 24.2e3, 242.0, 0.05
POINTS, COUNT = 90, 24
LIMITS = rated(
    roller_radius=0.008, travel=0.045, pressure_angle=np.pi / 6, jam_index=0.5,
    curvature_ratio=1.5, undercut_factor=0.3, contact_force_margin=0.2, jump=0.8,
    normal_force=1000.0, overspeed=150.0, jump_speed=200.0,
)  # fmt: skip


def engine(seed, waves=9):
    """Torque of zero mean with random waves up to an order, 5 to 25 N m of each at the crank."""
    random, theta = np.random.default_rng(seed), uniform_turn(POINTS)
    order = np.arange(1, waves)
    size = random.uniform(2.0, 20.0, order.size) / order
    phase = random.uniform(0.0, 2 * np.pi, order.size)
    return np.sum(size[:, None] * np.cos(order[:, None] * theta + phase[:, None]), axis=0)


def problem(torque, reduction=None, **changes):
    load = loaded_with(
        "one", 78.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12, torque_reduction=reduction
    )  # fmt: skip
    plain = {"coefficients": COUNT, "points": POINTS, "jerk_weight": 1e-7}
    return Problem((load,), LIMITS, DesignVariables(RATE, PRELOAD, BASE), **(plain | changes))


@settings(max_examples=12, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.integers(2, 12))
def test_any_torque_of_zero_mean_closes(seed, waves):
    """Against the differential equation of the follower, integrated around the turn."""
    torque, theta = engine(seed, waves), uniform_turn(POINTS)
    rise = 4.0
    lift = lift_from_torque(theta, torque, RATE, PRELOAD, rise)
    spectrum, order = np.fft.rfft(torque), np.arange(POINTS // 2 + 1)

    def at(psi):
        whole = np.exp(1j * order * psi) * spectrum
        return float((2.0 * whole.sum() - whole[0]).real) / POINTS

    x0 = float(lift.values[0])
    ends = solve_ivp(
        lambda psi, x: [at(psi) / (PRELOAD + RATE * x[0])], (0.0, 2 * np.pi), [x0],
        method="DOP853", rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    assert lift.closure <= 1e-9
    assert abs(ends.y[0, -1] - x0) <= 1e-9
    np.testing.assert_allclose(lift(ends.t), ends.y[0], atol=1e-6)  # of the lift's own spline


@settings(max_examples=6, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.floats(0.5, 3.0))
def test_start_scales_with_the_torque(seed, factor):
    """k, P and T times one factor: E grows with it and the lift is the same."""
    torque = engine(seed)
    spring = {"prime_radius": BASE, "pressure_angle": np.pi / 6, "energy_max": np.inf}
    once = exact_start(torque, COUNT, rate=RATE, preload=PRELOAD, **spring)
    more = exact_start(
        factor * torque, COUNT, rate=factor * RATE, preload=factor * PRELOAD, **spring
    )
    np.testing.assert_allclose(more, factor * once, rtol=1e-6, atol=1e-9)


def others(search, asked):
    """Ripple of every smoother that is made to keep the limits: wider, raised, scaled down."""
    for kind in KINDS:
        for strength in (0.7, 1.5, 2.5) if kind != "none" else (1.0,):
            target = smoothed(asked, Smoother(kind, strength=strength))
            energy = fitted_energy(2.0 * (target - target.mean()), COUNT)
            for share in (1.0, 0.7, 0.4):
                for rise in (0.0, 4.0, 9.0):
                    state = search.state(share * energy + rise, search.problem.variables)
                    if all(value <= 1.0 for value in state.utilisation.values()):
                        yield kind, state.ripple


@pytest.mark.parametrize("seed", [1, 2, 6])  # of the others no smoother keeps the limits
def test_no_smoother_within_the_limits_leaves_less(seed):
    asked = engine(seed)
    given_problem = problem(asked)
    ours = synthesise(given_problem)
    assert ours.feasible
    theirs = list(others(Search(given_problem), asked))
    assert len({kind for kind, _ in theirs}) >= 3
    best = min(ripple for _, ripple in theirs)
    # ours keeps a reserve of 1e-3 of each limit and holds them between the points
    assert ours.ripple <= best + 2e-3
    assert ours.ripple < np.median([ripple for _, ripple in theirs])


@pytest.fixture(scope="module")
def soft():
    case = read_case(DATA / "soft_spring.toml")
    return coarsened(problem_of(case, engine_torques(case)))


def test_every_limit_holds_between_the_points(soft):
    design = synthesise(soft)
    assert design.feasible
    search = Search(soft)
    random = np.random.default_rng(1).uniform(0.0, 2 * np.pi, 10 * soft.points)
    for theta in (uniform_turn(10 * soft.points), np.sort(random)):
        grid = Grid.at(theta, design.coefficients.size)
        found = search.utilisations(design.coefficients, design.variables, grid)
        assert len(found) >= 18
        for name, value in found.items():
            if value.size > 1:  # a mean over random angles is none over the turn
                assert value.max() <= 1.0, name
                assert value.max() <= design.utilisation[name] + 1e-4, name
    binding = [name for name, value in design.utilisation.items() if value > 0.998]
    assert len(binding) >= 2  # the limits that bind are attained, not kept clear of


FREED = {
    "rate": (18e3, 30e3), "preload": (180.0, 320.0), "prime_radius": (0.045, 0.06),
    "phase": (-0.3, 0.3),
}  # fmt: skip


@pytest.fixture(scope="module")
def held():
    return synthesise(problem(engine(3)))


@pytest.mark.parametrize("name", [*FREED, "all"])
def test_what_is_freed_lowers_the_ripple_within_its_range(held, name):
    asked = engine(3)
    freed = FREED if name == "all" else {name: FREED[name]}
    found = synthesise(problem(asked, freed=freed))
    assert found.feasible
    for each, (low, high) in freed.items():
        value = getattr(found.variables, each)
        assert low * (1 - 1e-9) - 1e-9 <= value <= high * (1 + 1e-9)
    assert found.ripple < held.ripple
    assert np.isfinite(found.lift().values).all()


def test_initial_energy_that_is_not_free_is_zero(held):
    low = synthesise(problem(engine(3), energy=(0.0, 0.0)))
    assert low.ripple > held.ripple
    assert low.lift().values.min() == pytest.approx(0.0, abs=1e-6)
    assert held.lift().values.min() > 1e-3


def test_phase_turns_the_cam_and_nothing_else(held):
    turned = replace(held, variables=replace(held.variables, phase=2 * np.pi / 48))
    np.testing.assert_allclose(
        turned.lift(1440).values, np.roll(held.lift(1440).values, 30), atol=1e-12
    )


def test_worst_corner_keeps_what_the_nominal_does_not():
    asked = engine(2)
    nominal = problem(asked)
    one = nominal.scenarios[0]
    corners = tuple(
        changed(one, name=str((rate, mu)), rate_factor=rate, friction_a=mu, friction_b=mu)
        for rate in (0.95, 1.05)
        for mu in (0.05, 0.2)
    )
    robust = replace(nominal, scenarios=(one, *corners))
    judge, turn = Search(robust), Search(robust).turn
    lone, all_of_them = synthesise(nominal), synthesise(robust)

    def worst_of(design):
        use = judge.utilisations(design.coefficients, design.variables, turn)
        return max(float(np.max(each)) for each in use.values())

    worst = [worst_of(design) for design in (lone, all_of_them)]
    assert worst[0] > 1.0 >= worst[1]
    ripples = [judge.state(d.coefficients, d.variables).ripple for d in (lone, all_of_them)]
    assert ripples[1] == pytest.approx(all_of_them.ripple, rel=1e-9)
    assert all_of_them.ripple > lone.ripple  # the worst of five is no better than one


def test_random_starts_agree():
    design, starts, _ = explored(problem(engine(2)), 4)
    assert design.feasible and starts.agree, starts.sentence
    assert len(starts.ripples) == 4


@pytest.mark.slow
def test_twenty_random_starts_agree_on_the_soft_spring(monkeypatch):
    monkeypatch.setattr(multistart, "_SEED", 7)  # other starts than a run's
    case = read_case(DATA / "soft_spring.toml")
    _, starts, _ = explored(problem_of(case, engine_torques(case)), 20)
    assert len(starts.ripples) == 20
    assert starts.agree, starts.sentence


def test_ripple_of_the_speed_is_lowered_as_that_of_the_torque_is():
    """Short waves hardly show in the speed; the descent must not lose itself in them."""
    asked = engine(3)
    by_speed = problem(asked, objective=objective_of({"speed": 1.0}))
    found, other = synthesise(by_speed), synthesise(problem(asked))
    assert found.feasible and found.converged and found.gain >= 0.0
    search = Search(by_speed)
    assert found.ripple < search.state(other.coefficients, other.variables).ripple
    assert Search(problem(asked)).state(found.coefficients, found.variables).ripple > other.ripple


def test_reduction_of_the_torque_holds_while_the_speed_is_lowered():
    asked = engine(3)
    least = synthesise(problem(asked)).ripple
    by_speed = objective_of({"speed": 1.0})
    given_problem = problem(asked, 1.0 - 1.05 * least, objective=by_speed)
    design = synthesise(given_problem)
    assert design.feasible
    by_torque = Search(problem(asked)).state(design.coefficients, design.variables)
    assert by_torque.ripple <= 1.05 * least


def test_lift_of_a_lowest_cam_has_no_kink(soft):
    """The energy is zero at one angle, between the points: the acceleration goes on there."""
    design = synthesise(replace(soft, energy=(0.0, 0.0)))
    theta = uniform_turn(20_000)
    energy = Grid.at(theta, design.coefficients.size).energy(design.coefficients)
    assert 0.0 <= energy[0].min() < 1e-6
    lift = design.lift(1440).derivatives(theta, 2)[2]
    exact = lift_jet(energy, design.variables).lift_d2
    np.testing.assert_allclose(lift, exact, atol=2e-3 * np.ptp(exact))

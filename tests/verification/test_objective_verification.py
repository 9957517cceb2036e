"""Terms of the objective of a synthesis against the solved cycles of the same cam."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy
from synthesis_ratings import rated
from synthesis_scenarios import changed, loaded_with

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.verdict import screen
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.solution import solution
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.smoothing.cam_state import Mean, lift_jet, loaded
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.gradients import (
    FREED,
    Point,
    differentiated,
    second_derivatives,
)
from camwright.pipeline.smoothing.objective import (
    COSTS,
    KEYS,
    costs,
    harmonics,
    objective_of,
    residuals,
    residuals_slope,
)
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Correction, DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Problem, coarsened
from camwright.pipeline.studies.batch.dataset import HEADLINE
from camwright.pipeline.studies.batch.factor_axes import axis_of
from camwright.pipeline.studies.batch.sampling import designs_of
from camwright.pipeline.studies.batch.study_file import read_study

DATA = Path(__file__).parents[1] / "data"
CASES = Path(__file__).parents[2] / "cases"
STUDIES = Path(__file__).parents[2] / "studies"
POSITIONS = 240
EVERY_COST = objective_of({each.key: 1.0 for each in COSTS})


@pytest.fixture(scope="module")
def case():
    """The case of the soft spring with drag in the roller bearing."""
    soft = read_case(DATA / "soft_spring.toml")
    bearing = replace(soft.roller.bearing, drag_torque=0.02, friction=0.003)
    return soft.model_copy(update={"roller_given": replace(soft.roller, bearing=bearing)})


@pytest.fixture(scope="module")
def solved(case):
    """Cycles of a random cam in the load cases."""
    random, theta = np.random.default_rng(3), uniform_turn(720)
    waves = sum(
        random.normal() / k**3 * np.cos(k * theta + random.uniform(0, 6)) for k in range(1, 6)
    )
    lift = Lift(theta, 0.002 + 0.02 * (waves - waves.min()) / np.ptp(waves))
    contour = RollerContour(PitchCurve(lift, case.cam.prime_radius), case.roller.radius)
    torques = engine_torques(case)
    return solution(case, contour, Tier.PREVIEW, torques=torques, positions=POSITIONS)


def cost_by_scenario(case, solved, objective=EVERY_COST):
    """Costs of the solved cam in each load case, guides as its cycles solve them."""
    problem = problem_of(case, engine_torques(case))
    pitch, found = solved.contour.pitch, {}
    jet = Jet(*pitch.lift.derivatives(uniform_turn(POSITIONS), 3))
    for cycle, item in zip(solved.cycles, problem.scenarios, strict=True):
        guides = cycle.guides
        correction = replace(
            Correction.none(POSITIONS),
            rubbing_a=np.abs(guides.rubbing_load_a / guides.statics_a),
            rubbing_b=np.abs(guides.rubbing_load_b / guides.statics_b),
        )
        scenario = replace(item, correction=correction)
        found[item.name] = costs(
            objective,
            problem.scale,
            item.weight,
            loaded(jet, pitch.lift.highest.value, problem.variables, problem.ratings, scenario),
            problem.variables,
        )
    return found


def greatest(value):
    return float(np.max(value.value if isinstance(value, Mean) else value))


def total_cost(of_scenarios):
    """Sum of the greatest cost of each term over scenarios and cam angles."""
    every = list(of_scenarios)
    keys = dict.fromkeys(key for each in every for key in each)
    return sum(max(greatest(each[key]) for each in every if key in each) for key in keys)


def energy_swing(case):
    """Range of the integral of the engine torque over the crank angle, by trapezia, J."""
    torque = engine_torques(case)["idle"].without_mean()
    work = scipy.integrate.cumulative_trapezoid(torque.total, torque.theta)
    return float(np.ptp(work))


def peak_force(case):
    """Greatest engine torque at the cam over the prime radius, N."""
    torque = engine_torques(case)["idle"].without_mean().total
    return 2.0 * float(np.abs(torque).max()) / case.cam.prime_radius


@pytest.mark.parametrize("count", [24, 25])
def test_slope_of_the_residuals_matches_differences(count):
    random = np.random.default_rng(count)
    torque, left = random.normal(size=(2, count))
    item = loaded_with("made", 80.0, torque, 0.2, 0.05, 0.03, 0.1, 0.1)
    objective = objective_of({"torque": 0.7, "speed": 1.3, "harmonic": 0.4}, (1, 3))
    step = 1e-6
    ends = [
        [np.linalg.norm(residuals(objective, item, left + side * step * each)) for side in (1, -1)]
        for each in np.eye(count)
    ]
    differences = [(up - down) / (2.0 * step) for up, down in ends]
    # central differences: round-off 1e-16/1e-6, and the step squared
    np.testing.assert_allclose(
        residuals_slope(objective, item, left), differences, rtol=0, atol=1e-9
    )
    assert not residuals_slope(objective, item, np.zeros(count)).any()


def test_loss_is_that_of_the_power_balance_of_the_cycle(case, solved):
    """Mean cam torque: spring and inertia give back what they take. Bearing by its own spin."""
    idle = solved.cycles[0]
    friction = FULL_TURN * float(np.mean(idle.loads.cam_torque))
    assert friction == pytest.approx(idle.loads.friction_loss, rel=1e-6)
    arm = 0.003 * case.roller.hub_radius
    drag = 0.02 + arm * idle.loads.normal_force
    spin = np.abs(idle.parts.roller_spin) / idle.cam_speed
    rolling = FULL_TURN * float(np.mean(drag * spin))
    assert rolling > 0.05 * friction
    ours = cost_by_scenario(case, solved)["idle"]["loss"]
    # the engine torque is resampled to 720 angles
    assert greatest(ours) == pytest.approx((friction + rolling) / energy_swing(case), rel=2e-3)


def test_energy_and_forces_are_those_of_the_cycles(case, solved):
    ours = cost_by_scenario(case, solved)
    for cycle in solved.cycles:
        loads, of_case = cycle.loads, ours[cycle.load_case]
        stored = float(np.max(loads.spring_force)) ** 2 / (2.0 * case.spring.rate)
        assert greatest(of_case["spring_energy"]) == pytest.approx(
            stored / energy_swing(case), rel=2e-3
        )
        still = float(np.mean(loads.spring_force / np.cos(loads.pressure_angle)))
        assert greatest(of_case["rest_force"]) == pytest.approx(still / peak_force(case), rel=2e-3)
        most = float(np.max(loads.normal_force))
        assert greatest(of_case["peak_force"]) == pytest.approx(most / peak_force(case), rel=2e-3)


def test_loss_counts_where_the_ripple_counts_and_the_rest_everywhere(case, solved):
    ours = cost_by_scenario(case, solved)
    assert [name for name, of_case in ours.items() if greatest(of_case["loss"]) > 0] == ["idle"]
    assert all({"spring_energy", "rest_force", "peak_force"} <= set(each) for each in ours.values())
    worst = max(greatest(each["peak_force"]) for each in ours.values())
    objective = objective_of({"loss": 2.0, "peak_force": 0.5})
    total = total_cost(cost_by_scenario(case, solved, objective).values())
    assert total == pytest.approx(2.0 * greatest(ours["idle"]["loss"]) + 0.5 * worst, rel=1e-12)


def test_harmonics_are_those_of_the_spectrum_of_the_solved_torque(case, solved):
    before, after = solved.cycles[0].turn.torque_before, solved.cycles[0].turn.torque_after
    item = replace(problem_of(case, engine_torques(case)).scenarios[0], torque=before)
    amplitude = 2.0 * np.abs(np.fft.rfft(after)) / after.size
    for orders in ((1,), (2, 4), (3, 7, 20)):
        rms = np.sqrt(0.5 * sum(amplitude[k] ** 2 for k in orders))
        ours = np.linalg.norm(harmonics(orders).columns(item, after))
        assert ours == pytest.approx(rms / np.std(before), rel=1e-12)
    every = np.linalg.norm(harmonics(range(1, POSITIONS // 2)).columns(item, after))
    left = np.std(after) / np.std(before)
    # all of them are the ripple, but for the one that 240 angles do not resolve
    assert every == pytest.approx(left, rel=1e-4)
    assert harmonics((POSITIONS,)).columns(item, after).size == 0
    both = objective_of({"torque": 1.0, "harmonic": 3.0}, orders=(2,))
    alone = np.linalg.norm(harmonics((2,)).columns(item, after))
    norm = np.linalg.norm(residuals(both, item, after))
    assert norm == pytest.approx(np.hypot(left, np.sqrt(3.0) * alone), rel=1e-12)


def small(friction, weights, **changes):
    """A torque of two waves on a coarse turn."""
    theta = uniform_turn(120)
    torque = 8.0 * np.sin(2 * theta) + 4.0 * np.cos(3 * theta)
    running = loaded_with(
        "idle", 78.5, torque, 0.2, 0.08, 0.038, friction, friction, viscous_damping=3.0 * friction,
    )  # fmt: skip
    limits = rated(
        roller_radius=0.008, pressure_angle=np.pi / 6, travel=0.01,
        drag=Drag(0.0, 0.1, 2e-3, 2e-3, 5e-3),
    )  # fmt: skip
    return Problem(
        (running,), limits, DesignVariables(24.2e3, 242.0, 0.05), coefficients=24, points=120,
        objective=objective_of(weights), **changes,
    )  # fmt: skip


def costs_of(problem):
    """Costs of the first scenario of a problem, as a function that is differentiated."""
    item = replace(problem.scenarios[0], correction=Correction.none(problem.points))

    def function(jet, top, variables):
        loads = loaded(jet, top, variables, problem.ratings, item)
        return costs(problem.objective, problem.scale, item.weight, loads, variables)

    return function


def cost_of(problem, design):
    search = Search(problem)
    jet = lift_jet(search.turn.energy(design.coefficients), design.variables)
    top = search.highest(design.coefficients, design.variables)
    return total_cost([costs_of(problem)(jet, top, design.variables)])


def test_gradient_of_each_cost_matches_differences():
    problem = small(0.06, {each.key: 1.3 for each in COSTS})
    function, variables, top = costs_of(problem), problem.variables, 0.02
    search = Search(problem)
    energy = search.turn.energy(search.exact + 2.0)
    exact = differentiated(function, Point(energy, top, variables), freed=True)
    assert set(exact) == {each.key for each in COSTS}
    random, h = np.random.default_rng(2), 1e-6
    change = [random.normal(size=each.size) * np.abs(each).max() for each in energy]
    shift = {name: random.normal() * getattr(variables, name) for name in FREED}

    def beside(side):
        parts = tuple(each + side * h * way for each, way in zip(energy, change, strict=True))
        at = {name: getattr(variables, name) + side * h * way for name, way in shift.items()}
        other = replace(variables, **at)
        return function(lift_jet(parts, other), top * (1.0 + side * h), other)

    up, down = beside(1), beside(-1)
    for name, gradient in exact.items():
        local = np.sum(gradient.local * np.stack(change), axis=0)
        shared = np.array([top, *shift.values()]) @ gradient.shared
        if gradient.mean is not None:
            ours, differences = np.mean(local + shared), up[name].value - down[name].value
        else:
            ours, differences = local + shared, up[name] - down[name]
        differences = differences / (2.0 * h)
        assert np.abs(differences).max() > 0
        # the sign of the motion turns at a few points
        near = np.abs(ours - differences) < 1e-6 * np.abs(differences).max()
        assert np.mean(near) > 0.95, name


def test_friction_is_no_free_damping():
    """Of the signed machine: friction lowers the ripple within the same limits, not the objective.

    The default weight of the loss is 1; 0.41 would just take away what friction of 0.12 saves.
    """
    signed = read_case(CASES / "gx120-redesign.toml")
    smoothing = {"corners": False, "jerk_weight": 1e-5}
    signed = signed.model_copy(update={"smoothing": signed.smoothing.model_copy(update=smoothing)})
    coarse, figures = coarsened(problem_of(signed, engine_torques(signed))), {}
    for friction in (0.0, 0.12):
        guides = {"friction_a": friction, "friction_b": friction}
        scenarios = tuple(changed(item, **guides) for item in coarse.scenarios)
        problem = replace(coarse, scenarios=scenarios)
        design = synthesise(problem)
        assert design.feasible
        figures[friction] = design.ripple, design.ripple + cost_of(problem, design)
    assert figures[0.12][0] < figures[0.0][0]
    assert figures[0.12][1] > figures[0.0][1]


def test_at_equal_torque_ripple_the_loss_is_less():
    """Against the cam of least ripple, its energy scaled down to the same ripple."""
    alone = small(0.12, {"torque": 1.0})
    least = synthesise(alone)
    allowed = 1.02 * least.ripple
    search = Search(alone)
    level = least.coefficients.min()

    def scaled(share):
        return level + share * (least.coefficients - level)

    def excess(share):
        return search.state(scaled(share), least.variables).ripple - allowed

    share = scipy.optimize.brentq(excess, 0.5, 1.0)
    reference = cost_of(
        replace(alone, objective=objective_of({"loss": 1.0})),
        replace(least, coefficients=scaled(share)),
    )
    charged = small(0.12, {"torque": 1.0, "loss": 20.0})
    running = replace(charged.scenarios[0], torque_reduction=1.0 - allowed)
    charged = replace(charged, scenarios=(running,))
    design = synthesise(charged)
    assert design.feasible
    assert Search(alone).state(design.coefficients, design.variables).ripple <= allowed
    assert cost_of(charged, design) / 20.0 < 0.998 * reference


@pytest.mark.parametrize("key", ["spring_energy", "peak_force"])
def test_a_charged_maximum_is_less(key):
    """A large weight of the greatest energy or force leaves less of it than a small one."""
    figures = []
    for weight in (0.1, 5.0):
        charged = small(0.12, {"torque": 1.0, key: weight})
        design = synthesise(charged)
        assert design.feasible
        figures.append((design.ripple, cost_of(charged, design) / weight))
    (ripple, most), (charged_ripple, charged_most) = figures
    assert charged_most < most
    assert charged_ripple > ripple


def least_loss(reduction):
    """Problem and cam of least loss within a ceiling of the ripple."""
    problem = small(0.12, {"loss": 1.0}, jerk_weight=1e-7)
    running = replace(problem.scenarios[0], torque_reduction=reduction)
    problem = replace(problem, scenarios=(running,))
    return problem, synthesise(problem)


def test_front_of_least_loss_uses_its_ceilings_and_has_their_prices_as_slopes():
    """Of a convex front each chord lies between the multipliers of the ceilings at its ends."""
    ceilings, losses, prices = np.array([0.95, 0.9, 0.85, 0.8]), [], []
    for ceiling in ceilings:
        problem, design = least_loss(1.0 - ceiling)
        assert design.feasible
        assert design.converged
        left = Search(small(0.12, {"torque": 1.0})).state(design.coefficients, design.variables)
        assert left.ripple == pytest.approx(ceiling * (1.0 - RESERVE), rel=1e-5)  # as FEASIBLE
        losses.append(cost_of(problem, design))
        prices.append(sum(of_ceiling for *_, of_ceiling in design.lagrangian.ripples))
    slopes = -np.diff(losses) / np.diff(ceilings * (1.0 - RESERVE))
    assert np.all(slopes > prices[:-1])
    assert np.all(slopes < prices[1:])


@pytest.mark.slow
def test_front_of_the_shipped_study_has_less_loss_the_more_ripple_it_allows():
    """Every design passes its screen, and none is dominated."""
    study = read_study(STUDIES / "front_loss.toml")
    case = read_case(STUDIES / study.cases[0])
    designs = designs_of([axis_of(each, case) for each in study.factors], study.sampling)
    columns, points = designs.si(), []
    for row in range(designs.count):
        values = {key: column[row].item() for key, column in columns.items()}
        trial = preview_case(with_values(case, values), corners=False)
        record = headline(trial.solution)
        points.append([record[each.column.removeprefix(HEADLINE)] for each in study.objectives])
        assert screen(trial.checks) == "open"
    left, loss = np.array(points).T
    assert np.all(np.diff(columns["limits.torque_reduction"]) > 0)
    assert np.all(np.diff(left) < 0)
    # the searches converge to 2e-6 of the ripple; the steps of the front are a thousand times that
    assert np.all(np.diff(loss) > 0.02)


def test_objective_of_a_case_has_the_terms_of_its_weights(case):
    def terms(**weights):
        smoothing = case.smoothing.model_copy(update=weights)
        problem = problem_of(case.model_copy(update={"smoothing": smoothing}), engine_torques(case))
        return {each.term.key: each.weight for each in problem.objective}

    assert terms() == {"torque": 1.0, "loss": 1.0}
    assert terms(loss_weight=0.0, harmonic_weight=2.0, harmonic_orders=(0.5, 2.0)) == {
        "torque": 1.0, "harmonic": 2.0,
    }  # fmt: skip
    assert set(terms(**{f"{key}_weight": 1.0 for key in KEYS}, harmonic_orders=(1.0,))) == set(KEYS)


def test_size_has_the_derivatives_of_its_closed_form():
    """F_s^2/2k = E + P^2/2k, and the force at standstill F_s sqrt(1 + (E'/(F_s r))^2)."""
    problem = replace(small(0.06, {"size": 1.0}), ratings=rated(roller_radius=0.008))
    function, scale = costs_of(problem), problem.scale
    search = Search(problem)
    at = Point(search.turn.energy(search.exact + 2.0), 0.02, problem.variables)

    def closed(level, slope, rate, preload, radius):
        force = np.sqrt(preload**2 + 2.0 * rate * level)
        lift = (force - preload) / rate
        rest = np.sqrt(force**2 + (slope / (radius + lift)) ** 2)
        energy = level + preload**2 / (2.0 * rate)
        return 0.5 * (energy / scale.energy + rest / scale.force)

    variables = problem.variables
    arguments = [*at.energy[:2], variables.rate, variables.preload, variables.prime_radius]
    places = [0, 1, 5, 6, 7]  # among E, E', E'', E''', maximum lift, k, P, r0

    def slopes(values):
        stepped = (
            closed(*(each + 1e-30j * (k == j) for k, each in enumerate(values)))
            for j in range(len(values))
        )
        return np.array([np.imag(each) / 1e-30 for each in stepped])

    made = differentiated(function, at, freed=True)["size"]
    np.testing.assert_allclose(made.terms, closed(*arguments), rtol=1e-12)
    ours = np.concatenate([made.local, made.shared])
    np.testing.assert_allclose(ours[places], slopes(arguments), rtol=1e-10, atol=1e-14)
    assert not np.delete(ours, places, axis=0).any()
    second = second_derivatives(function, at, True, {"size": np.ones(made.terms.shape)})
    for k, place in enumerate(places):
        step = 1e-5 * np.abs(arguments[k]).max()
        up, down = (
            slopes([each + side * step * (j == k) for j, each in enumerate(arguments)])
            for side in (1, -1)
        )
        expected = (up - down) / (2.0 * step)
        # both are central differences of complex steps: their truncation is the step squared
        size = np.abs(expected).max(axis=1, keepdims=True) + 1e-300
        np.testing.assert_allclose(second[place, places] / size, expected / size, rtol=0, atol=1e-6)

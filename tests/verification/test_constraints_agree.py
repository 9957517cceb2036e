"""A check and its constraint see the same demand; every constraint has its true gradient."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arm_problems import arm_case
from synthesis_problems import OF_ROLLER, REFINED, nominal, thinned
from synthesis_ratings import named, rated
from synthesis_scenarios import changed, loaded_with

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.cam_shape import concave_radius
from camwright.pipeline.checks.contact_strength import (
    load_cycles,
    pressure_allowables,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE, PRESSURE
from camwright.pipeline.checks.key_strength import KeywayRoot
from camwright.pipeline.checks.registry import CHECKS, DECLARED, checks_of
from camwright.pipeline.checks.roller_bearing import Grease
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.follower.roller_parts import Fork
from camwright.pipeline.smoothing.allowables import (
    limits_of,
    ratings_of,
    scaled_limits,
    travel_limits,
)
from camwright.pipeline.smoothing.cam_state import Mean, loaded
from camwright.pipeline.smoothing.cone_program import ConeSolution
from camwright.pipeline.smoothing.constraints import (
    CONSTRAINTS,
    shape_utilisations,
    utilisations_of,
)
from camwright.pipeline.smoothing.energy_spline import Grid
from camwright.pipeline.smoothing.fe_correction import corrections_of
from camwright.pipeline.smoothing.lagrangian import Lagrangian, lagrangian_curvature
from camwright.pipeline.smoothing.linear_model import Model
from camwright.pipeline.smoothing.objective import KEYS, objective_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import (
    HIGHEST_PEAK,
    INITIAL_ENERGY,
    LEAST_ENERGY,
    Search,
)
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import Problem

DATA = Path(__file__).parents[1] / "data"
POSITIONS = 120
SHAPE = "spring_travel", "curvature_ratio", "undercut"
LOAD = ("contact_force_margin", "jump", "jump_speed", "jam_index_friction_max", "roller_static",
        "roller_load_share", "guide_pressure_A", "guide_pressure_B")  # fmt: skip
"""Limits that the synthesis states anew, a least value, the travel, and one of a group: the others
are value and bound of the measure of their check, see `test_part_constraints_agree`."""
UNDER_TRACTION = ("shakedown_traction", "edge_shakedown")


@pytest.fixture(scope="module")
def case():
    """The case of the soft spring with every limit a synthesis knows."""
    soft = read_case(DATA / "soft_spring.toml")
    cam, roller, guides = soft.cam, soft.roller, soft.guides
    limits = {
        "tool_radius": 0.04, "cam_radius": 0.1, "curvature_rate": 9e3, "target_life": 3.6e6,
        "overspeed": 420.0,
    }  # fmt: skip
    line = {"endurance_slope": 14.15, "endurance_intercept": 66.22}
    steel = replace(cam.material, **line)
    strong = replace(roller.pin.material, tensile_strength=600e6)
    parts = {
        "limits": soft.limits.model_copy(update=limits),
        "cam": replace(cam, material=steel),
        "roller_given": replace(
            roller,
            material=replace(roller.material, **line),
            friction=0.1,
            bearing=replace(roller.bearing, radial_limit=4000.0, static_radial_limit=5000.0),
            pin=replace(roller.pin, material=strong),
            fork=Fork(cheek_width=6e-3, material=strong),
        ),
        "guides": replace(
            guides, a=replace(guides.a, friction_max=0.12), b=replace(guides.b, friction_max=0.1)
        ),
    }
    return soft.model_copy(update=parts)


@pytest.fixture(scope="module", params=range(2))
def judged(case, request):
    """The solution of a random cam, all its checks, and the synthesis of its case."""
    random, theta = np.random.default_rng(request.param), uniform_turn(720)
    waves = sum(
        random.normal() / k**3 * np.cos(k * theta + random.uniform(0, 6)) for k in range(1, 7)
    )
    lift = Lift(theta, 0.002 + 0.024 * (waves - waves.min()) / np.ptp(waves))
    contour = RollerContour(PitchCurve(lift, case.cam.prime_radius), case.roller.radius)
    torques = engine_torques(case)
    solved = solution(case, contour, Tier.PREVIEW, torques=torques, positions=POSITIONS)
    checks = {check.id: check for check in checks_of(solved)}
    return solved, checks, problem_of(case, torques)


def jet(contour, theta):
    return Jet(*contour.pitch.lift.derivatives(theta, 3))


def variables_of(case):
    return DesignVariables(case.spring.rate, case.spring.preload, case.cam.prime_radius)


def worst_loads(case, judged, ratings, theta=None):
    """Greatest of each load limit over the load cases, on the grid of the cycles or at angles."""
    solved, _, problem = judged
    grid = theta is None
    theta = uniform_turn(POSITIONS) if grid else theta
    top = solved.contour.pitch.lift.highest.value
    moving, variables, worst = jet(solved.contour, theta), variables_of(case), {}
    corrections = corrections_of(solved)
    for state in problem.scenarios:
        corrected = corrections[state.name]
        scenario = replace(state, correction=corrected if grid else corrected.at(theta))
        loads = utilisations_of(loaded(moving, top, variables, ratings, scenario))
        for name, value in loads.items():
            use = float(np.max(value.value if isinstance(value, Mean) else value))
            worst[name] = max(worst.get(name, -np.inf), use)
    return worst


def strain(check, roller_radius):
    """What the constraint is at the demand and the limit of its check."""
    demand, limit, name = check.demand, check.limit, check.id
    if name == "undercut":
        return (1 - demand) / (1 - limit)
    if name == "concave_radius":
        return (limit - roller_radius) / (demand - roller_radius)
    if name == "contact_force_margin":
        return 1 + limit - demand
    if name == "jump_speed":
        return check.utilisation**2  # forces grow with the square of the speed
    return check.utilisation


@pytest.mark.parametrize("name", SHAPE)
def test_shape_limit_is_that_of_its_check(case, judged, name):
    contour, check = judged[0].contour, judged[1][name]
    place = np.array([check.cam_angle])
    ratings = rated(ratings_of(case), travel=travel_limits(case)["spring_travel"])
    shape = shape_utilisations(jet(contour, place), variables_of(case), ratings)
    assert shape[name][0] == pytest.approx(strain(check, contour.roller_radius), rel=1e-9)


@pytest.mark.parametrize("name", ["spring_travel", "spring_stress", "spring_fatigue",
                                  "spring_solid", "spring_coil_gap"])  # fmt: skip
def test_travel_of_each_check_of_the_spring_brings_it_to_its_limit(case, judged, name):
    solved, limits = judged[0], travel_limits(case)
    pitch = solved.contour.pitch
    lift = pitch.lift
    stretched = replace(lift, values=lift.values * (limits[name] / lift.highest.value))
    wider = replace(solved.contour, pitch=replace(pitch, lift=stretched))
    declared = [each for each in CHECKS if each.id == name]
    solved = replace(solved, contour=wider)
    tolerance = 1e-9
    if name in ("spring_stress", "spring_fatigue"):
        # The synthesis bounds them without surge: at rest; the greatest force is sampled, and the
        # least one is that of the lowest lift, above zero here, not the preload.
        still = solved.case.limits.model_copy(update={"overspeed": None})
        at_rest = tuple(replace(each, speed=0.0, limits=still) for each in solved.machines)
        solved, tolerance = replace(solved, machines=at_rest), 1e-5
        if name == "spring_fatigue":
            lowest = solved.machines[0].spring.rate * solved.contour.pitch.lift.lowest.value
            tolerance = lowest / solved.machines[0].spring.preload
    (check,) = checks_of(solved, declared)
    assert check.utilisation == pytest.approx(1.0, rel=tolerance)
    assert named(ratings_of(case)).travel == min(limits.values())


def test_hollow_is_that_of_its_check(case):
    theta = uniform_turn(720)
    lift = Lift(theta, 0.012 * (1 - np.cos(3 * theta)))
    contour = RollerContour(PitchCurve(lift, case.cam.prime_radius), case.roller.radius)
    check = concave_radius(Solution(case, contour, machines(case), Tier.PREVIEW, None, ()))
    place = np.array([check.cam_angle])
    shape = shape_utilisations(jet(contour, place), variables_of(case), ratings_of(case))
    ours = strain(check, case.roller.radius)
    assert shape["concave_radius"][0] == pytest.approx(ours, rel=1e-9)


@pytest.mark.parametrize("name", LOAD)
def test_load_limit_is_that_of_its_check(case, judged, name):
    ratings, forces = ratings_of(case), limits_of(case)[NORMAL_FORCE]
    assert named(ratings).normal_force == min(forces.values())
    assert forces[ratings.by[NORMAL_FORCE]] == named(ratings).normal_force
    ratings = rated(ratings, normal_force=forces.get(name, named(ratings).normal_force))
    own = "roller_static" if name in forces else name
    check, refined = judged[1][name], name in REFINED
    theta = np.array([check.cam_angle]) if refined else None
    worst = worst_loads(case, judged, ratings, theta)
    # A refined check is a parabola through angles an eighth apart, with friction linear between.
    tolerance = 1e-5 if refined else 1e-9
    assert worst[own] == pytest.approx(strain(check, named(ratings).roller_radius), rel=tolerance)


def test_pressure_limit_is_that_of_each_check(case, judged):
    solved, checks, problem = judged
    contour, theta = solved.contour, uniform_turn(POSITIONS)
    top = contour.pitch.lift.highest.value
    estimated = pressure_allowables(solved.machine, load_cycles(solved.machines, contour))
    limits = limits_of(case)[PRESSURE] | estimated
    assert set(limits) == {
        "contact_pressure", "shakedown", "edge_pressure", "shakedown_traction", "edge_shakedown",
        "contact_pressure_at_life",
    }  # fmt: skip
    assert named(ratings_of(case)).pressure == min(limits.values())
    assert limits[ratings_of(case).by[PRESSURE]] == min(limits.values())
    bend = contour.roller_radius * contour.pitch.curvature(theta)
    corrections = corrections_of(solved)
    # Where ends and tilt count, the limit follows from the solved cam.
    along = {
        name: value for name, value in scaled_limits(solved)[PRESSURE].items() if name in limits
    }
    assert set(along) == {"edge_pressure", "edge_shakedown", "contact_pressure_at_life"}
    for name, limit in (limits | along).items():
        ratings, most = rated(ratings_of(case), pressure=limit), 0.0
        for scenario in problem.scenarios:
            use = utilisations_of(
                loaded(
                    jet(contour, theta),
                    top,
                    variables_of(case),
                    ratings,
                    replace(scenario, correction=corrections[scenario.name]),
                )
            )["contact_pressure"]
            # r kappa + N/F = r kappa + (1 - r kappa) (p0/p)^2
            most = max(most, float(np.max((use - bend) / (1 - bend))))
        if name in UNDER_TRACTION and name not in along:
            # The synthesis assumes full sliding, the greatest traction of a roller.
            assert checks[name].utilisation < np.sqrt(most), name
        else:
            assert np.sqrt(most) == pytest.approx(checks[name].utilisation, rel=1e-9), name


RANGES = {
    "rate": (1e4, 4e4), "preload": (100.0, 400.0), "prime_radius": (0.03, 0.07),
    "phase": (-0.5, 0.5),
}  # fmt: skip
EVERY = rated(
    roller_radius=0.008, offset=0.003, travel=0.045, pressure_angle=np.pi / 6, jam_index=0.5,
    curvature_ratio=1.5, undercut_factor=0.3, hollow_radius=0.03, curvature_rate=9e3,
    outer_undercut=0.7,
    cam_radius=0.08, pressure=1e9, contact_width=0.01, contact_modulus=1.2e11,
    contact_force_margin=0.2, overspeed=200.0, jump=1.0, jump_speed=250.0, normal_force=900.0,
    life_force_cubed=1e9, roller_spin=600.0, guide_pressure=(5e6, 5e6), guide_pv=(1e6, 1e6),
    guide_area=(2e-4, 2e-4), guide_edge_load=(5e4, 5e4), guide_power=(20.0, 20.0),
    guide_wear_pv=(9e5, 9e5), guide_slope=(0.02, 0.02), gas_slope=0.025, guide_length=(0.02, 0.02),
    guide_gap=1e-3, guide_mouth=0.02, held_radius=0.02, minimum_wall=1.75,
    friction=0.1, drag=Drag(1e-5, 0.1, 1e-3, 2e-3, 5e-3),
    waves=(2e-6, 5e-3), waviness=0.2, cam_torque=20.0, tooth_torque=25.0, shaft_drag=0.5,
    keyway_safety=1.5, keyway=KeywayRoot(4e6, 2e4, 0.012, 2e-4, 0.048, 4e-9),
    modified=(3000.0, 60.0, 1.2e-5, 0.0105), modified_rate=1e3, roller_spin_least=50.0,
    grease=Grease(7.2e6, 3000.0, 0.03, 343.15),
)  # fmt: skip


def scenario(count=180):
    theta = uniform_turn(count)
    torque = 12.0 * np.sin(2 * theta) + 6.0 * np.cos(3 * theta + 0.4) + 3.0 * np.sin(5 * theta)
    return loaded_with(
        "one", 80.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12,
        viscous_damping=5.0, friction_worst=(0.2, 0.2),
    )  # fmt: skip


def sharing(scenarios, duty):
    """The scenarios as load cases of a duty, nominal and at a corner; without one as they are."""
    if duty is None:
        return scenarios
    running = tuple(replace(one, duty=q) for one, q in zip(scenarios, duty, strict=True))
    return *running, *(replace(one, corner=1, preload_factor=1.2) for one in running)


@pytest.mark.parametrize("duty", [None, (0.3, 0.7)])
@pytest.mark.parametrize("free", [(), tuple(RANGES)])
def test_gradients_match_differences(free, duty):
    both = scenario(), changed(scenario(), rate_factor=1.1, cam_speed=150.0, weight=0.0)
    given = Problem(
        sharing(both, duty),
        EVERY,
        DesignVariables(24.2e3, 242.0, 0.05), freed={name: RANGES[name] for name in free},
        energy=(0.0, 0.0), coefficients=24, points=180, jerk_weight=1e-2,
        objective=objective_of({"torque": 1.0, "speed": 0.5}),
    )  # fmt: skip
    seen = of_true_gradient(given)
    assert seen == {each.check for each in OF_ROLLER} | {LEAST_ENERGY, INITIAL_ENERGY}


def of_true_gradient(given):
    """Names of the limits of a problem, whose changes are differences of fourth order: 1e-8."""
    search = Search(given, extra=np.array([0.31, 2.17]))
    state = search.state(search.start + 2.0, given.variables)
    step, h = np.random.default_rng(5).normal(size=24 + len(given.freed)), 1e-4
    step[24:] *= 1e-2  # the rest moves as much for a hundredth of k, P and r0

    summit = search.summit(state)
    every = {name: np.ones(value.shape, dtype=bool) for name, value in state.pointwise.items()}
    means = {name: np.ones(value.shape, dtype=bool) for name, value in state.means.items()}
    beside = [search.state(*search.after(state, side * h * step)) for side in (1, -1, 2, -2)]

    def differences(values):
        up, down, further_up, further_down = map(values, beside)
        return (8.0 * (up - down) - (further_up - further_down)) / (12.0 * h)

    seen = set()
    for limit in (*search.rows(state, summit, every), *search.means(state, summit, means)[0]):
        name, at = limit.name, limit.scenario
        exact = limit.change(step)
        change = differences(
            (lambda each, name=name, at=at: each.means[name][at])
            if limit.mean
            else (lambda each, name=name, at=(at, limit.point): each.pointwise[name][at])
        )
        smooth = np.abs(change - exact) < 1e-8 * max(np.abs(exact).max(), 1e-3)
        # |s'|, |alpha| and the sign of the motion turn at a few points
        assert smooth.mean() > 0.95, name
        seen.add(name)
    for limit in search.model(state).limits:
        if limit.name in (LEAST_ENERGY, INITIAL_ENERGY):
            sign = -1.0 if limit.name == LEAST_ENERGY else 1.0
            level = differences(
                lambda each, at=limit.point: search.turn.energy(each.coefficients)[0][at]
            )
            change = sign * level / search.scale
            np.testing.assert_allclose(limit.change(step), change, atol=1e-8)
            seen.add(limit.name)
    return seen


ARMS = (
    ("roller", "bush", "torsion_pivot"), ("roller", "needle_bearing", "link"),
    ("flat", "bush", "link"), ("flat", "needle_bearing", "coil"),
    ("curved", "bush", "link"), ("curved", "needle_bearing", "torsion_pivot"),
)  # fmt: skip
QUICK_ARMS = ARMS[1:3]
OF_BEARING = {
    "bush": {"pivot_pressure", "pivot_pv", "pivot_speed", "pivot_temperature", "pivot_wear"},
    "needle_bearing": {"pivot_static", "pivot_life"},
}  # fmt: skip


@pytest.mark.parametrize(
    "arm",
    [pytest.param(each, id=" ".join(each), marks=() if each in QUICK_ARMS else pytest.mark.slow)
     for each in ARMS],
)  # fmt: skip
def test_gradients_of_arms_match_differences(arm):
    """Of every limit of roller or face, arm and pivot, but those of the other bearing."""
    case = arm_case(*arm)
    given = thinned(nominal(problem_of(case, engine_torques(case))), 24, 180)
    described = named(EVERY)
    ratings = rated(
        given.ratings, held_radius=case.cam.held_radius, gas_slope=0.03, return_pressure_angle=0.7,
        outer_undercut=0.7, keyway=described.keyway,
        grease=described.grease if arm[0] == "roller" else None,
    )  # fmt: skip
    seen = of_true_gradient(replace(given, ratings=ratings, freed={"prime_radius": (0.03, 0.09)}))
    kinds = {"", *ratings.kinds}
    of_arm = {
        each.check for each in CONSTRAINTS
        if each.needs in kinds and DECLARED[each.check].part != "guides"
    }  # fmt: skip
    (others,) = (names for bearing, names in OF_BEARING.items() if bearing != arm[1])
    assert of_arm - others <= seen, of_arm - others - seen


def test_models_keep_the_other_peaks_of_the_lift_below_the_highest():
    """Three peaks less than 1 % apart: differences of their energies, and their changes by a step.

    The peaks of the differences lie up to 1e-4 rad aside, where splines of order 1 differ by 1e-4.
    """
    given = Problem(
        (scenario(),), EVERY, DesignVariables(24.2e3, 242.0, 0.05), coefficients=24, points=180
    )
    search, theta = Search(given), uniform_turn(24)
    energy = 5.0 + 2.0 * np.cos(3.0 * theta) + 0.02 * np.cos(theta) + 0.01 * np.sin(theta)
    state = search.state(energy, given.variables)
    (peaks,) = (each for each in search.model(state).limits if each.name == HIGHEST_PEAK)
    assert peaks.level.shape == (2,) and not peaks.elastic
    assert np.all(peaks.level < 0.0)
    step, h = np.random.default_rng(4).normal(size=24), 1e-6

    def apart(side):
        fine = Grid.at(uniform_turn(36000), 24)
        level = fine.energy(search.after(state, side * h * step)[0])[0]
        tops = np.sort(level[(level >= np.roll(level, 1)) & (level > np.roll(level, -1))])
        return (tops[:2] - tops[2]) / search.scale

    order = np.argsort(peaks.level)
    assert peaks.level[order] == pytest.approx(apart(0.0), abs=1e-6)
    changes = (apart(1.0) - apart(-1.0)) / (2.0 * h)
    assert peaks.change(step)[order] == pytest.approx(changes, abs=2e-4)


@pytest.mark.parametrize("free", [(), tuple(RANGES)])
@pytest.mark.parametrize("term", ["torque", "speed", "harmonic", "jerk"])
def test_gradient_of_each_term_of_the_objective(free, term):
    objective = () if term == "jerk" else objective_of({term: 1.0}, orders=(2, 3))
    given = Problem(
        (scenario(),), EVERY, DesignVariables(24.2e3, 242.0, 0.05),
        freed={name: RANGES[name] for name in free}, coefficients=24, points=180,
        objective=objective, jerk_weight=float(term == "jerk"),
    )  # fmt: skip
    search = Search(given)
    state = search.state(search.start + 2.0, given.variables)
    step, h = np.random.default_rng(7).normal(size=24 + len(free)), 1e-5
    step[24:] *= 1e-2
    up, down = (search.state(*search.after(state, side * h * step)) for side in (1, -1))
    model = search.model(state)
    if term == "jerk":
        slope, differences = model.slope @ step, (up.jerk - down.jerk) / (2 * h)
    else:
        norm = model.norms[0]
        slope = norm.level @ norm.slopes @ step / np.linalg.norm(norm.level)
        differences = (up.ripple - down.ripple) / (2 * h)
    assert abs(slope) > 0
    assert slope == pytest.approx(differences, rel=1e-6)


@pytest.mark.parametrize("duty", [None, (0.3, 0.7)])
@pytest.mark.parametrize("free", [(), tuple(RANGES)])
def test_second_derivatives_of_the_lagrangian_match_its_differences(free, duty, monkeypatch):
    """Of every limit and ripple at once; the norms' own part of the curvature added.

    The second derivative of the maximum lift is left out: the differences take it as linear.
    """
    fast = changed(scenario(), rate_factor=1.1, cam_speed=150.0, weight=0.7)
    both = replace(scenario(), torque_reduction=0.5), replace(fast, torque_reduction=0.4)
    given = Problem(
        sharing(both, duty),
        EVERY, DesignVariables(24.2e3, 242.0, 0.05), freed={name: RANGES[name] for name in free},
        coefficients=24, points=180,
        objective=objective_of(dict.fromkeys(KEYS, 0.5), (3, 5)),
    )  # fmt: skip
    search = Search(given, extra=np.array([0.31, 2.17]))
    state = search.state(search.start + 2.0, given.variables)
    summit, random = search.summit(state), np.random.default_rng(3)
    some = {name: random.random(value.shape) < 0.01 for name, value in state.pointwise.items()}
    for rows in some.values():
        rows[:, search.grid.theta.size :] = False  # without the curvature of a reversal's path
    means = {name: np.ones(value.shape, dtype=bool) for name, value in state.means.items()}
    averages, slopes = search.means(state, summit, means)
    limits = [*search.rows(state, summit, some), *averages]
    norms = search.norms(state, summit, np.arange(2))
    model = Model(summit, norms, limits, slopes, np.zeros((0, 0)), np.zeros(0))
    prices = [random.random(limit.level.size) for limit in limits]
    none = np.zeros(0)
    program = ConeSolution(none, 0.0, {}, prices, [(0.6, 0.0), (0.0, 0.3)] * 2, 0.0, none)
    exact = lagrangian_curvature(search, state, model, model, program)
    again = lagrangian_curvature(search, state, model._replace(means={}), model, program)
    np.testing.assert_allclose(exact, again, rtol=0, atol=1e-12 * np.abs(exact).max())
    lagrangian = Lagrangian.of(search, state, model, program)
    step, h = random.normal(size=search.size), 1e-4
    step[24:] *= 1e-2

    rise = float(search.shared_columns(state, summit)[0] @ step)

    def along(side):
        coefficients, variables = search.after(state, side * h * step)
        monkeypatch.setattr(Search, "highest", lambda *_: summit.lift + side * h * rise)
        return replace(lagrangian, coefficients=coefficients, variables=variables).at(given)

    differences = (along(1) - 2 * along(0) + along(-1)) / h**2
    own = 0.0
    for norm, (weight, ceiling) in zip(norms, program.norms, strict=True):
        item, slope = given.scenarios[norm.number].weight, norm.slopes @ step
        size = np.linalg.norm(norm.level)
        bend = slope @ slope / size - (norm.level @ slope) ** 2 / size**3
        own += (weight * item + ceiling) * bend
    assert step @ exact @ step + own == pytest.approx(differences, rel=1e-6)

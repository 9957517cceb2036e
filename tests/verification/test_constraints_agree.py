"""A check and its constraint see the same demand; every constraint has its true gradient."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline import solver as road
from camwright.pipeline.case.case_file import load_case_file
from camwright.pipeline.checks import spring_strength
from camwright.pipeline.checks.cam_shape import concave_radius, spring_travel
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import DESIGN, PARTS, SIGNED, checked_by
from camwright.pipeline.contact.contact_pair import closed_form_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import finished
from camwright.pipeline.smoothing.allowables import (
    force_limits,
    pressure_limits,
    ratings_of,
    travel_limits,
)
from camwright.pipeline.smoothing.constraints import (
    Jet,
    Mean,
    load_utilisations,
    shape_utilisations,
)
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import INITIAL_ENERGY, LEAST_ENERGY, Search
from camwright.pipeline.smoothing.scenario import Correction, Machine, Ratings, Scenario
from camwright.pipeline.smoothing.synthesis_problem import Problem

CASES = Path(__file__).parents[2] / "cases"
POSITIONS = 120
SHAPE = ("spring_travel", "pressure_angle", "curvature_ratio", "undercut", "concave_radius",
         "curvature_rate", "cam_envelope")  # fmt: skip
LOAD = ("contact_force_margin", "contact_at_overspeed", "jump", "jump_speed", "jam_index",
        "jam_at_worst_friction", "roller_static", "roller_radial", "roller_pin", "roller_life",
        "roller_speed",
        "bush_pressure_A", "bush_pressure_B", "bush_pv_A", "bush_pv_B")  # fmt: skip


def section(given, **changes):
    return given.model_copy(update=changes)


@pytest.fixture(scope="module")
def asking():
    """The redesigned case with every limit a synthesis knows."""
    case = load_case_file(CASES / "gx120-signed.toml")
    steel = section(
        case.material(case.cam.material), endurance_slope=14.15, endurance_intercept=66.22
    )
    return section(
        case,
        limits=section(
            case.limits, tool_radius=0.04, cam_radius=0.1, curvature_rate=300.0,
            target_life=3.6e6, overspeed=420.0,
        ),
        roller_given=section(
            case.roller, friction=0.1,
            bearing=section(case.roller.bearing, radial_limit=4000.0),
        ),
        guides=section(
            case.guides,
            a=section(case.guides.a, friction_max=0.12),
            b=section(case.guides.b, friction_max=0.1),
        ),
        materials=case.materials | {case.cam.material: steel},
    )  # fmt: skip


@pytest.fixture(scope="module", params=range(2))
def judged(asking, request):
    """A random cam with its cycles and all its checks."""
    random, theta = np.random.default_rng(request.param), uniform_turn(720)
    waves = sum(
        random.normal() / k**3 * np.cos(k * theta + random.uniform(0, 6)) for k in range(1, 7)
    )
    lift = Lift(theta, 0.002 + 0.024 * (waves - waves.min()) / np.ptp(waves))
    contour = RollerContour(PitchCurve(lift, asking.cam.pitch_base_radius), asking.roller.radius)
    torques = road.engine_torques(asking)
    pair = contact_pair(asking, contour)
    cycles = tuple(
        finished(asking, contour, turn,
                 closed_form_history(pair, turn.theta, turn.loads.normal_force))
        for turn in road.turns_of(asking, contour, torques, POSITIONS)
    )  # fmt: skip
    found = checked_by(TrialEvidence(asking, contour, cycles), (*DESIGN, *SIGNED, *PARTS))
    return contour, cycles, {check.id: check for check in found}, problem_of(asking, torques)


def jet(contour, theta):
    return Jet(*contour.pitch.lift.derivatives(theta, 3))


def machine_of(case):
    return Machine(case.spring.rate, case.spring.preload, case.cam.pitch_base_radius)


def corrected(scenario, cycle):
    """The scenario with what the guides of its cycle answered over point supports."""
    guides, one = cycle.guides, np.ones(POSITIONS)
    worst = cycle.parts.friction.greatest
    found = Correction(
        one,
        np.abs(guides.reaction_a / guides.statics_a), np.abs(guides.reaction_b / guides.statics_b),
        np.abs(guides.rubbing_load_a / guides.statics_a),
        np.abs(guides.rubbing_load_b / guides.statics_b),
        worst.jam_index / worst.jam_index_statics,
    )  # fmt: skip
    return replace(scenario, correction=found)


def worst_loads(asking, judged, ratings):
    """The greatest of each load limit over the load cases on the grid of the cycles."""
    contour, cycles, _, problem = judged
    theta, top = uniform_turn(POSITIONS), contour.pitch.lift.highest.value
    worst = {}
    for cycle, given in zip(cycles, problem.scenarios, strict=True):
        scenario = corrected(given, cycle)
        found = load_utilisations(jet(contour, theta), top, machine_of(asking), ratings, scenario)
        for name, value in found.items():
            use = float(np.max(value.value if isinstance(value, Mean) else value))
            worst[name] = max(worst.get(name, -np.inf), use)
    return worst


def strain(check, roller_radius):
    """What the constraint is at the demand and the limit of its check."""
    demand, limit, name = check.demand, check.limit, check.id
    if name == "undercut":
        return (1 - demand) / (1 - limit)
    if name == "concave_radius":
        return (limit - 1e3 * roller_radius) / (demand - 1e3 * roller_radius)
    if name in ("contact_force_margin", "contact_at_overspeed"):
        return 1 + limit - demand
    if name == "jump_speed":
        return check.utilisation**2  # forces grow with the square of the speed
    if name == "roller_life":
        return check.utilisation ** (1 / 3)  # hours fall with the cube of the load
    return check.utilisation


@pytest.mark.parametrize("name", [name for name in SHAPE if name != "concave_radius"])
def test_shape_limit_is_that_of_its_check(asking, judged, name):
    contour, _, checks, _ = judged
    check = checks[name]
    place = np.array([np.radians(check.cam_angle_deg)])
    ratings = replace(ratings_of(asking), travel=travel_limits(asking)["spring_travel"])
    found = shape_utilisations(jet(contour, place), machine_of(asking), ratings)
    assert found[name][0] == pytest.approx(strain(check, contour.roller_radius), rel=1e-9)


@pytest.mark.parametrize("name", ["spring_travel", "spring_stress", "spring_fatigue",
                                  "spring_solid"])  # fmt: skip
def test_travel_of_each_check_of_the_spring_brings_it_to_its_limit(asking, judged, name):
    contour, cycles = judged[0], judged[1]
    limits = travel_limits(asking)
    lift = contour.pitch.lift
    stretched = replace(lift, values=lift.values * (limits[name] / lift.highest.value))
    wider = replace(contour, pitch=replace(contour.pitch, lift=stretched))
    found = checked_by(
        TrialEvidence(asking, wider, cycles), (spring_travel, *spring_strength.CHECKS)
    )
    check = next(each for each in found if each.id == name)
    assert check.utilisation == pytest.approx(1.0, rel=1e-9)
    assert ratings_of(asking).travel == min(limits.values())


def test_hollow_is_that_of_its_check(asking):
    theta = uniform_turn(720)
    lift = Lift(theta, 0.012 * (1 - np.cos(3 * theta)))
    contour = RollerContour(PitchCurve(lift, asking.cam.pitch_base_radius), asking.roller.radius)
    check = concave_radius(TrialEvidence(asking, contour, ()))
    place = np.array([np.radians(check.cam_angle_deg)])
    found = shape_utilisations(jet(contour, place), machine_of(asking), ratings_of(asking))
    ours = strain(check, asking.roller.radius)
    assert found["concave_radius"][0] == pytest.approx(ours, rel=1e-9)


@pytest.mark.parametrize("name", LOAD)
def test_load_limit_is_that_of_its_check(asking, judged, name):
    ratings, forces = ratings_of(asking), force_limits(asking)
    assert ratings.normal_force == min(forces.values())
    assert forces[ratings.normal_force_by] == ratings.normal_force
    ratings = replace(ratings, normal_force=forces.get(name, ratings.normal_force))
    worst = worst_loads(asking, judged, ratings)
    own = "roller_static" if name in forces else name
    assert worst[own] == pytest.approx(strain(judged[2][name], ratings.roller_radius), rel=1e-9)


def test_pressure_limit_is_that_of_each_check(asking, judged):
    contour, cycles, checks, problem = judged
    theta, top = uniform_turn(POSITIONS), contour.pitch.lift.highest.value
    limits = pressure_limits(asking)
    assert set(limits) == {
        "contact_pressure", "shakedown", "edge_pressure", "shakedown_traction",
        "contact_pressure_at_life",
    }  # fmt: skip
    assert ratings_of(asking).pressure == min(limits.values())
    assert limits[ratings_of(asking).pressure_by] == min(limits.values())
    bend = contour.roller_radius * contour.pitch.curvature(theta)
    for name, limit in limits.items():
        ratings, most = replace(ratings_of(asking), pressure=limit), 0.0
        for cycle, scenario in zip(cycles, problem.scenarios, strict=True):
            found = load_utilisations(
                jet(contour, theta), top, machine_of(asking), ratings, corrected(scenario, cycle)
            )["contact_pressure"]
            # r kappa + N/F = r kappa + (1 - r kappa) (p0/p)^2
            most = max(most, float(np.max((found - bend) / (1 - bend))))
        assert np.sqrt(most) == pytest.approx(checks[name].utilisation, rel=1e-9), name


def test_no_constraint_goes_without_its_check(asking, judged):
    ratings = ratings_of(asking)
    shape = shape_utilisations(jet(judged[0], np.zeros(1)), machine_of(asking), ratings)
    assert set(shape) == set(SHAPE)
    others = {"roller_radial", "roller_pin"}  # of the same force
    assert set(worst_loads(asking, judged, ratings)) == {*LOAD, "contact_pressure"} - others


RANGES = {
    "rate": (1e4, 4e4), "preload": (100.0, 400.0), "prime_radius": (0.03, 0.07),
    "phase": (-0.5, 0.5),
}  # fmt: skip
EVERY = Ratings(
    roller_radius=0.008, offset=0.003, travel=0.045, pressure_angle=np.pi / 6, jam_index=0.5,
    curvature_ratio=1.5, undercut_factor=0.3, hollow_radius=0.03, curvature_rate=300.0,
    cam_radius=0.08, pressure=1e9, contact_width=0.01, contact_modulus=1.2e11,
    contact_force_margin=0.2, overspeed=200.0, jump=1.0, jump_speed=250.0, normal_force=900.0,
    life_force_cubed=1e9, roller_spin=600.0, bush_pressure=(5e6, 5e6), bush_pv=(1e6, 1e6),
    bush_area=(2e-4, 2e-4),
)  # fmt: skip


def scenario(count=180):
    theta = uniform_turn(count)
    torque = 12.0 * np.sin(2 * theta) + 6.0 * np.cos(3 * theta + 0.4) + 3.0 * np.sin(5 * theta)
    return Scenario(
        "one", 80.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12,
        viscous_damping=5.0, friction_worst=(0.2, 0.2),
    )  # fmt: skip


@pytest.mark.parametrize("free", [(), tuple(RANGES)])
def test_gradients_match_differences(free):
    given = Problem(
        (scenario(), replace(scenario(), rate_factor=1.1, cam_speed=150.0, weight=0.0)), EVERY,
        Machine(24.2e3, 242.0, 0.05), freed={name: RANGES[name] for name in free},
        energy=(0.0, 0.0), coefficients=24, points=180, speed_weight=0.5, jerk_weight=1e-2,
    )  # fmt: skip
    search = Search(given, extra=np.array([0.31, 2.17]))
    state = search.state(search.start + 2.0, given.machine)
    size, h = 24 + len(free), 1e-5
    step = np.random.default_rng(5).normal(size=size)
    step[24:] *= 1e-2  # the rest moves as much for a hundredth of k, P and r0

    def beside(side):
        return search.model(search.state(*search.moved(state, side * h * step))).limits

    seen = set()
    for limit, up, down in zip(search.model(state).limits, beside(1), beside(-1), strict=True):
        exact = limit.at(step) - limit.level
        differences = (up.level - down.level) / (2 * h)
        assert np.abs(exact).max() > 0, limit.name
        smooth = np.abs(differences - exact) < 1e-6 * np.abs(exact).max()
        # |s'|, |alpha| and the sign of the motion turn at a few points
        assert smooth.mean() > 0.95, limit.name
        seen.add(limit.name)
    shape = set(SHAPE) | {LEAST_ENERGY, INITIAL_ENERGY, "contact_pressure"}
    assert seen == shape | set(LOAD) - {"roller_radial", "roller_pin"}


@pytest.mark.parametrize("free", [(), tuple(RANGES)])
@pytest.mark.parametrize("term", ["torque", "speed", "jerk"])
def test_gradient_of_each_term_of_the_objective(free, term):
    weights = {"torque_weight": 0.0, "speed_weight": 0.0, "jerk_weight": 0.0}
    given = Problem(
        (scenario(),), EVERY, Machine(24.2e3, 242.0, 0.05),
        freed={name: RANGES[name] for name in free}, coefficients=24, points=180,
        **(weights | {f"{term}_weight": 1.0}),
    )  # fmt: skip
    search = Search(given)
    state = search.state(search.start + 2.0, given.machine)
    step, h = np.random.default_rng(7).normal(size=24 + len(free)), 1e-5
    step[24:] *= 1e-2
    up, down = (search.state(*search.moved(state, side * h * step)) for side in (1, -1))
    model = search.model(state)
    if term == "jerk":
        slope, differences = model.slope @ step, (up.jerk - down.jerk) / (2 * h)
    else:
        norm = model.norms[0]
        slope = norm.level @ norm.slopes @ step / np.linalg.norm(norm.level)
        differences = (up.ripple - down.ripple) / (2 * h)
    assert abs(slope) > 0
    assert slope == pytest.approx(differences, rel=1e-6)

"""A constraint of a synthesis sees what its check sees, on a case that describes every part.

Those are compared that state the inequality anew, in another form or without a measure, and one of
each reduction by the measure itself: the others are its value and bound, see `test_measures`, on
the fields that `test_fields_agree` compares.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from clamped_case import read_clamped
from scipy.optimize import brentq
from synthesis_problems import OF_ROLLER, REFINED
from synthesis_ratings import named, rated

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.registry import CHECKS, DECLARED, checks_of
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.part_loads import edge_pressure_of
from camwright.pipeline.cycle.solution import solution
from camwright.pipeline.cycle.speed_sweep import ANGLES
from camwright.pipeline.follower.bearing_life import rated_viscosity
from camwright.pipeline.preview import preview_case
from camwright.pipeline.smoothing.allowables import (
    corrected_ratings,
    edge_load,
    limits_of,
    ratings_of,
    scaled_limits,
    surge_of,
    travel_limits,
)
from camwright.pipeline.smoothing.bounds import bounds_of
from camwright.pipeline.smoothing.cam_state import Mean, ScenarioCam, loaded, unloaded
from camwright.pipeline.smoothing.constraints import (
    CONSTRAINTS,
    SHAPE,
    shape_utilisations,
    utilisations_of,
)
from camwright.pipeline.smoothing.fe_correction import SETTLED, corrections_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import DesignVariables, stacked
from camwright.pipeline.smoothing.synthesis_problem import RESERVE

CASE = Path(__file__).parents[2] / "cases" / "gx120-redesign.toml"
POSITIONS = 120
KELVIN = 273.15
MARGINS = (
    "contact_force_margin", "contact_at_overspeed", "contact_over_speed", "elastic_contact",
)  # fmt: skip
HEAT = [f"{name}_{side}" for side in "AB" for name in ("guide_temperature", "guide_expansion")]
APART = ("contact_pressure", "spring_travel", "concave_radius", "gas_speed")
"""Of several checks or of another spring, with tests of their own."""
BY_MEASURE = (
    "undercut", "roller_static", "contact_force_margin", "guide_pv_A", "guide_wear_A",
    "roller_life", "guide_pressure_A", "guide_pressure_B",
)  # fmt: skip
"""One of each reduction; of the pressure of a guide both, whose limit is in its correction."""


def states_anew(name):
    """Whether the synthesis has the inequality of a check in another form than by its measure."""
    how = DECLARED[name].measured
    return how is None or how.kept is None or how.kept.use is not None


EACH = [
    name for name in dict.fromkeys((*HEAT, *(each.check for each in OF_ROLLER)))
    if name not in APART and (name in BY_MEASURE or states_anew(name))
]  # fmt: skip


@pytest.fixture(scope="module")
def case():
    """The redesign, with every limit that a synthesis knows, and grease at a low load."""
    drawn = read_clamped(CASE)
    smoothing = drawn.smoothing.model_copy(update={"corners": False})
    limits = drawn.limits.model_copy(update={"curvature_rate": 9e3})
    greased = replace(
        drawn.roller.bearing, lubrication="grease_relubricated",
        relubrication_interval=9000.0 * 3600.0,
        grease_life=None, temperature=KELVIN + 70.0,
        C=3.0 * drawn.roller.bearing.C,
    )  # fmt: skip
    parts = {
        "smoothing": smoothing, "limits": limits,
        "roller_given": replace(drawn.roller, bearing=greased),
    }  # fmt: skip
    return drawn.model_copy(update=parts)


def random_cam(case, seed):
    random, theta = np.random.default_rng(seed), uniform_turn(720)
    waves = sum(
        random.normal() / k**3 * np.cos(k * theta + random.uniform(0, 6)) for k in range(1, 7)
    )
    lift = Lift(theta, 0.002 + 0.009 * (waves - waves.min()) / np.ptp(waves))
    return RollerContour(
        PitchCurve(lift, case.cam.prime_radius, case.cam.offset), case.roller.radius
    )


@pytest.fixture(scope="module", params=range(2))
def solved(case, request):
    """A random cam in every load case."""
    cam, torques = random_cam(case, request.param), engine_torques(case)
    return solution(case, cam, Tier.PREVIEW, torques=torques, positions=POSITIONS)


@pytest.fixture(scope="module")
def checks(solved):
    return {check.id: check for check in checks_of(solved)}


@pytest.fixture(scope="module")
def problem(case):
    return problem_of(case, engine_torques(case))


@pytest.fixture(scope="module")
def corrections(solved):
    return corrections_of(solved)


def uses(solved, problem, corrections, ratings, theta):
    """Greatest utilisation of each constraint at cam angles."""
    pitch, case = solved.contour.pitch, solved.case
    jet, top = Jet(*pitch.lift.derivatives(theta, 3)), pitch.lift.highest.value
    variables = DesignVariables(case.spring.rate, case.spring.preload, case.cam.prime_radius)
    worst = {
        name: float(np.max(value))
        for name, value in shape_utilisations(jet, variables, ratings).items()
    }
    for state in problem.scenarios:
        scenario = replace(state, correction=corrections[state.name].at(theta))
        loads = utilisations_of(loaded(jet, top, variables, ratings, scenario))
        for name, value in loads.items():
            use = float(np.max(value.value if isinstance(value, Mean) else value))
            worst[name] = max(worst.get(name, -np.inf), use)
    return worst


def own(case, machine, name):
    """Constraint that keeps a check, and ratings with the limit of that check alone."""
    ratings = ratings_of(case)
    if name == demands.NORMAL_FORCE:
        return name, rated(ratings, normal_force=limits_of(case)[demands.NORMAL_FORCE][name])
    side = name[-1]
    if name in HEAT:
        limits = limits_of(case)
        both = [limits[f"guide_temperature_{each}"][name[:-1] + each] for each in "AB"]
        return f"guide_temperature_{side}", rated(ratings, guide_power=tuple(both))
    return name, rated(ratings, held_radius=case.cam.held_radius)


def in_check(case, checks, solved, name, use):
    """Utilisation of a constraint in the terms of its check: demand over limit, or the like.

    Returns both, the constraint's first.
    """
    check, machine = checks[name], solved.machine
    if name in MARGINS:
        return use, 1.0 + check.limit - check.demand
    if name == "undercut":
        return use, (1.0 - check.demand) / (1.0 - check.limit)
    if name == "jump_speed":
        return use, check.utilisation**2  # forces grow with the square of the speed
    if name in ("roller_life", "roller_modified_life"):
        return use**3, check.utilisation
    if name == "bearing_lubrication":
        bearing = machine.roller.bearing
        speed = named(ratings_of(case)).roller_spin_least * 30.0 / np.pi / use
        return bearing.viscosity / rated_viscosity(speed, bearing.ring.pitch_diameter), check.demand
    if name == "grease_life":
        # the worst load case: log10 of the life falls by 2.5 per P/C, at no less than 0.05
        bearing, solved_lives = machine.roller.bearing, []
        for cycle in solved.cycles:
            load, size = greased_load(machine, cycle)
            solved_lives.append((greased(*size, max(load / bearing.C, 0.05)), load, size))
        worst, load, size = min(solved_lives)
        assert check.demand == pytest.approx(3600.0 * worst, rel=1e-9)
        return greased(*size, load / use / bearing.C), check.limit / 3600.0
    if name == "guide_gap":
        mouth = machine.overhang_at_max_lift - 0.5 * machine.guides.a.length
        pitch = solved.contour.pitch
        top = pitch.height_base + pitch.lift.highest.value + mouth
        space = top - solved.contour.radius_max().value
        fork = machine.roller.fork.cheek_length + machine.roller.fork.bridge_length
        assert check.demand == pytest.approx(min(space, mouth - fork), rel=1e-12)
        return 1e-3 - (use - 1.0) * machine.roller.radius, space
    if name in HEAT:
        ambient, side = machine.guides.ambient_temperature - KELVIN, name[-1]
        guide = dict(machine.guides.both)[side]
        allowed = limits_of(case)[f"guide_temperature_{side}"][name]
        resistance = (checks[f"guide_temperature_{side}"].demand - ambient) / use / allowed
        if name.startswith("guide_temperature"):
            return ambient + use * (check.limit - ambient), check.demand
        cold = guide_closure(case, guide, 20.0)
        warm = guide_closure(case, guide, ambient + use * allowed * resistance)
        assert cold < check.limit
        return warm, check.demand
    if name.startswith("guide_edge"):
        guide, side = dict(machine.guides.both)[name[-1]], name[-1]
        hot = checks[f"guide_temperature_{side}"].demand + KELVIN
        load = use * edge_load(machine, guide, hot)
        return float(edge_pressure_of(machine, guide)(np.array([load]))[0]), check.demand
    return use, check.utilisation


DUTY = (0.3, 0.7)


@pytest.fixture(scope="module")
def sharing(case):
    """Solution, checks and stacked scenarios of a random cam whose load cases have a duty."""
    states = tuple(
        each.model_copy(update={"duty": share})
        for each, share in zip(case.load_cases, DUTY, strict=True)
    )
    shared = case.model_copy(update={"load_cases": states})
    cam, torques = random_cam(shared, 0), engine_torques(shared)
    solved = solution(shared, cam, Tier.PREVIEW, torques=torques, positions=POSITIONS)
    corrections = corrections_of(solved)
    scenarios = [
        replace(each, correction=corrections[each.name])
        for each in problem_of(shared, engine_torques(shared)).scenarios
    ]
    return solved, {each.id: each for each in checks_of(solved)}, scenarios


@pytest.mark.parametrize(
    "name",
    ["roller_life", "roller_modified_life", "grease_life", "guide_wear_A", "guide_wear_B"],
)
def test_a_life_by_the_duty_is_that_of_its_check(sharing, name):
    solved, checks, scenarios = sharing
    theta, case, check = uniform_turn(POSITIONS), solved.case, checks[name]
    pitch = solved.contour.pitch
    jet, top = Jet(*pitch.lift.derivatives(theta, 3)), pitch.lift.highest.value
    variables = DesignVariables(case.spring.rate, case.spring.preload, case.cam.prime_radius)
    stack = stacked(scenarios, theta)
    use, *others = utilisations_of(loaded(jet, top, variables, ratings_of(case), stack))[name].value
    if name == "grease_life":
        # the factor on the rating at which the shares of the life add to 1
        bearing, lives, heavy = solved.machine.roller.bearing, [], []
        for cycle in solved.cycles[:2]:
            load, size = greased_load(solved.machine, cycle)
            shares = load / bearing.C, load / use / bearing.C
            lives.append([greased(*size, max(share, 0.05)) for share in shares])
            heavy.append(load / (0.2 * bearing.C))
        assert others == pytest.approx(heavy, rel=1e-8)
        spent, at_limit = (np.dot(DUTY, 1.0 / np.array(each)) for each in zip(*lives, strict=True))
        assert 3600.0 / spent == pytest.approx(check.demand, rel=1e-8)
        assert at_limit * check.limit / 3600.0 == pytest.approx(1.0, rel=1e-8)
        return
    assert not others
    power = 1.0 if name.startswith("guide_wear") else 3.0
    assert use**power == pytest.approx(check.utilisation, rel=1e-8)


@pytest.mark.slow
def test_a_synthesised_cam_spends_the_life_of_the_roller_by_the_duty():
    """Its check, in both load cases, is at the utilisation of the constraint, which binds."""
    case = with_values(read_clamped(CASE), {"limits.roller_life": "1250 h"})
    states = tuple(
        each.model_copy(update={"duty": share})
        for each, share in zip(case.load_cases, (0.6, 0.4), strict=True)
    )
    smoothing = case.smoothing.model_copy(update={"corners": False, "coefficients": 48})
    shared = case.model_copy(update={"load_cases": states, "smoothing": smoothing})
    trial = preview_case(shared, corners=False)
    check = next(each for each in trial.checks if each.id == "roller_life")
    use = trial.synthesis["utilisation"]["roller_life"]
    assert trial.synthesis["feasible"]
    assert use == pytest.approx(1.0 - RESERVE, abs=1e-5)
    # that of the solved surge and lift, at 0.5 % of which the trials settle
    assert check.utilisation == pytest.approx(use**3, rel=SETTLED)
    assert "39% idle, 61% governed" in check.note
    assert any(price["limit"] == "roller_life" for price in trial.synthesis["prices"])


def ring_of(machine):
    return machine.roller.bearing.ring


def greased_load(machine, cycle):
    """Equivalent load, N; mean speed, rpm, outer diameter, mm, and temperature, degC."""
    force, turning = cycle.loads.normal_force, np.abs(cycle.parts.roller_spin)
    load = (np.sum(force**3 * turning) / np.sum(turning)) ** (1.0 / 3.0)
    warm = machine.roller.bearing.temperature - KELVIN
    return load, (float(turning.mean()) * 30.0 / np.pi, 1e3 * ring_of(machine).outer_diameter, warm)


def greased(speed, diameter, celsius, share):
    """Life of grease by the formula of JTEKT, h."""
    factor, warm = max(speed * diameter, 125e3), max(celsius, 50.0)
    light = 6.10 - 4.40e-6 * factor - (0.021 - 1.80e-8 * factor) * warm
    return 10.0 ** (light - 2.50 * (share - 0.05))


def guide_closure(case, guide, celsius):
    """Loss of clearance by Lame's thick ring held axially, m."""
    bush, stem = guide.material, case.follower.stem_material
    square, nu = (1.0 + 2.0 * guide.wall / guide.diameter) ** 2, bush.nu
    share = max(
        (square - 1.0) * (1.0 + nu) / (1.0 + (1.0 - 2.0 * nu) * square),
        (square - 1.0) * (1.0 + nu) / ((1.0 + nu) + (1.0 - nu) * square),
    )
    free = bush.expansion * (celsius - 20.0) + bush.moisture_growth
    return guide.diameter * (share * free + stem.expansion * (celsius - 20.0))


@pytest.mark.parametrize("name", EACH)
def test_a_constraint_is_that_of_its_check(case, solved, checks, problem, corrections, name):
    kept, ratings = own(case, solved.machine, name)
    refined = name in REFINED
    at_peak = refined or name in {each.check for each in SHAPE}
    at_peak &= checks[name].cam_angle is not None
    swept = name in ("contact_over_speed", "elastic_contact")
    theta = uniform_turn(ANGLES if swept else POSITIONS)
    if at_peak:
        theta = np.array([checks[name].cam_angle])
    use = uses(solved, problem, corrections, ratings, theta)[kept]
    ours, judged = in_check(case, checks, solved, name, use)
    # Closed forms with the ratios of the solved cycle are the solved values to round-off; the sweep
    # interpolates friction over axial force, the constraint its ratio to that of point supports.
    tolerance = 1e-4 if swept else 1e-8
    if refined:  # a parabola through angles of 0.375 deg, with friction linear between
        tolerance = 1e-5
    if name == "keyway_root":  # wall at minimum lift, and at the least contour radius
        tolerance = 1e-6
    if name == "guide_gap":  # the greatest radius lies between the angles
        tolerance = 1e-4
    assert ours == pytest.approx(judged, rel=tolerance)


def test_every_must_have_that_the_lift_can_help_is_kept_or_named():
    """What no constraint keeps, and why."""
    reasons = {
        # recomputed from the contour as delivered: a closed quintic spline has none
        "acceleration_step": "smooth spline", "self_intersection": "undercut",
        # a term of the objective, and the temperature that follows from it: neither is kept
        **dict.fromkeys(
            ("friction_power", "contact_temperature", "bulk_temperature", "mechanism_temperature",
             "gas_heating"),
            "loss_weight",
        ),
        "second_contact": "undercut", "tool_gouge": "concave_radius",
        # of the drive, where a case sets it: kept by the iteration of the smoothers alone
        "drive_torque": "iteration",
        # of the slopes of the torque where it reverses, and no torque has one where a reversal ends
        "gear_impact": "backlash",
        "machine_shaft_gap": "cam_radius",
        # limits of the contact pressure, of the lift and of the normal force
        **dict.fromkeys(
            ("contact_pressure_at_life", "edge_pressure", "edge_shakedown",
             "shakedown_traction", "hardened_case", "case_shear"), "contact_pressure"
        ),
        **dict.fromkeys(
            ("spring_stress", "spring_fatigue", "spring_solid", "spring_coil_gap",
             "spring_buckling", "spring_relaxation", "gas_pressure", "gas_stroke",
             "torsion_stress", "torsion_fatigue", "extension_stress", "extension_hook_bending",
             "extension_hook_torsion", "extension_fatigue", "link_reach"),
            "spring_travel",
        ),
        **dict.fromkeys(
            ("roller_pin_fatigue", "case_depth", "shaft_fatigue", "shaft_yield",
             "shaft_deflection", "shaft_slope", "shaft_bearing_static", "shaft_bearing_life",
             "arm_fatigue_pivot", "arm_fatigue_roller", "rocker_fatigue", "rocker_yield",
             "pivot_edge_pressure"),
            "roller_static",
        ),
        # a bound of the power that heats the bush, as of the guides
        "pivot_expansion": "pivot_temperature",
        # of the arm as drawn beside the cam
        **dict.fromkeys(("arm_gap", "arm_cam_gap"), "cam_radius"),
    }  # fmt: skip
    groups = {one.id for one in CHECKS if one.measured and one.measured.kept
              and one.measured.kept.group}  # fmt: skip
    kept = {*HEAT, *groups, *(each.check for each in CONSTRAINTS)}
    open_ones = {
        each.id for each in CHECKS
        if each.must_have and each.lift_can_help and not each.evidence and each.id not in kept
        and each.closed_by in ("", "force", "plate")  # a synthesis is closed by force
    }  # fmt: skip
    assert open_ones == set(reasons)
    assert kept <= set(DECLARED)


def test_surge_shortens_the_lift_to_the_limit_of_the_spring(case, solved):
    """At the greatest lift the check is at its limit; forces and surge are linear in the lift."""
    limits = travel_limits(case, surge_of(solved))
    pitch = solved.contour.pitch
    assert limits["spring_stress"] < travel_limits(case)["spring_stress"]
    for name in ("spring_stress", "spring_fatigue"):
        share = limits[name] / pitch.lift.highest.value
        stretched = replace(pitch.lift, values=pitch.lift.values * share)
        wider = replace(solved.contour, pitch=replace(pitch, lift=stretched))
        (check,) = checks_of(replace(solved, contour=wider), [DECLARED[name]])
        # the speeds of the sweep depend a little on the size of the harmonics
        assert check.utilisation == pytest.approx(1.0, rel=1e-3), name


def test_limits_scaled_from_a_solved_cam_are_those_of_its_checks(case, solved, checks):
    scaled = scaled_limits(solved)
    forces, pressures = scaled[demands.NORMAL_FORCE], scaled[demands.PRESSURE]
    most = max(float(cycle.loads.normal_force.max()) for cycle in solved.cycles)
    assert set(forces) >= {"roller_pin_fatigue", "shaft_fatigue", "shaft_bearing_life"}
    assert most / forces["shaft_fatigue"] == pytest.approx(checks["shaft_fatigue"].utilisation)
    life = checks["shaft_bearing_life"].utilisation
    assert (most / forces["shaft_bearing_life"]) ** 3 == pytest.approx(life)
    depth = checks["case_depth"].utilisation
    assert (most / forces["case_depth"]) ** 0.5 == pytest.approx(depth)
    peak = max(float(cycle.surface.p0.max()) for cycle in solved.cycles)
    assert peak / pressures["hardened_case"] == pytest.approx(checks["hardened_case"].utilisation)
    corrected = corrected_ratings(ratings_of(case), solved)
    assert named(corrected).normal_force == min(
        (limits_of(case)[demands.NORMAL_FORCE] | forces).values()
    )
    weak = rated(ratings_of(case), normal_force=1.0)
    assert named(corrected_ratings(weak, solved)).normal_force == named(corrected).normal_force


def greatest(each, states, ratings):
    """Greatest utilisation of a constraint, with its limit in these ratings."""
    limit, most = each.value(ratings), -np.inf
    for state in states:
        cam = state
        if isinstance(state, ScenarioCam):
            top, variables = float(np.real(state.highest)), state.variables
            cam = loaded(state.jet, top, variables, ratings, state.scenario)
        use = None if limit is None else each.utilisation(cam, limit)
        if use is not None:
            most = max(most, float(np.max(use.value if isinstance(use, Mean) else use)))
    return most


_OF_THE_CAM = "contact_pressure", "concave_radius", "outer_undercut"
PRICED = [each for each in OF_ROLLER if each.name not in _OF_THE_CAM]
"""Without two whose slope depends on the cam, see `shadow_prices` and `test_prices_verification`,
and that of a groove, which this cam does not run in."""


@pytest.mark.parametrize("each", PRICED, ids=lambda each: each.name)
def test_the_slope_of_a_bound_is_that_of_the_utilisation_where_it_binds(
    case, solved, problem, corrections, each
):
    """The bound is moved to the cam, then by a millionth; the slope prices a limit."""
    theta = uniform_turn(POSITIONS)
    pitch = solved.contour.pitch
    jet, top = Jet(*pitch.lift.derivatives(theta, 3)), pitch.lift.highest.value
    variables = DesignVariables(case.spring.rate, case.spring.preload, case.cam.prime_radius)
    ratings = rated(
        ratings_of(case), held_radius=case.cam.held_radius, gas_slope=0.03,
        return_pressure_angle=np.radians(20.0),
    )  # fmt: skip
    states = [unloaded(jet, variables, ratings)]
    if each not in SHAPE:
        states = [
            loaded(jet, top, variables, ratings, replace(one, correction=corrections[one.name]))
            for one in problem.scenarios
        ]
    bound = bounds_of(ratings)[each.name]

    def with_bound(factor):
        if bound.relaxed is not None:
            return bound.relaxed(ratings, factor)
        return ratings.times(each.key, factor)

    bound_si = each.value(ratings)

    def excess(log_factor):
        return greatest(each, states, with_bound(np.exp(log_factor))) - 1.0

    most = 0.999 / bound_si if each.check == "undercut" else 1e4  # its factor is below 1
    at = np.exp(brentq(excess, np.log(1e-3), np.log(most), xtol=1e-14))
    step = 1e-6
    ends = [greatest(each, states, with_bound(at * (1.0 + side * step))) for side in (1, -1)]
    fall = (ends[1] - ends[0]) / (2.0 * step * at * bound.value)
    slope = bounds_of(with_bound(at))[each.name].slope
    assert slope == pytest.approx(fall, rel=1e-4)

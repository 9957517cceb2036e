"""Problems of constrained synthesis for comparisons: two measured machines, seeded variants."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from clamped_case import read_clamped
from synthesis_ratings import named, rated
from synthesis_scenarios import changed, figures, loaded_with

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.checks.roller_bearing import Grease
from camwright.pipeline.smoothing.constraints import CONSTRAINTS
from camwright.pipeline.smoothing.objective import TORQUE, Weighted
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import Correction, DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import Problem

ROOT = Path(__file__).parents[1]
REFINED = {"contact_force_margin", "contact_at_overspeed", "jump", "jump_speed"}
"""Checks of the contact force between the solved angles, compared at the place of the check."""


def of_an_arm(constraint):
    """Whether a constraint is of the arm of a follower or its pivot."""
    return DECLARED[constraint.check].part in ("arm", "pivot")


OF_ROLLER = tuple(
    each for each in CONSTRAINTS
    if "face" not in each.needs and each.needs not in ("preload", "rollers")
    and not of_an_arm(each)
)  # fmt: skip
"""Constraints of a cam under a roller on a stem."""
KEPT = frozenset({
    "spring_travel", "pressure_angle", "curvature_ratio", "undercut", "concave_radius",
    "cam_radius", "contact_pressure", "contact_force_margin", "contact_at_overspeed", "jump",
    "jump_speed", "jam_index", "jam_index_friction_max", "roller_static", "roller_speed",
    "roller_life", "guide_pressure_A", "guide_pressure_B", "guide_pv_A", "guide_pv_B",
})  # fmt: skip
"""Constraints of the measured machines beside the torque reduction.

The curvature rate was one too, without a limit in either case.
"""
COMMON = {
    "roller_radius": 0.0175, "travel": 0.045, "hollow_radius": 0.0275, "pressure": 1.610e9 / 1.3,
    "contact_width": 0.0147, "contact_modulus": 210e9 / (2 * (1 - 0.3**2)), "normal_force": 3400.0,
    "force_safety": 1.5, "dynamic_rating": 8500.0, "roller_spin": 9800.0 * np.pi / 30,
    "guide_pressure": (14e6, 14e6), "guide_pv": (1.8e6, 1.8e6), "guide_area": (0.00064, 0.00064),
    "curvature_ratio": 1.5, "undercut_factor": 0.3, "contact_force_margin": 0.2, "jump": 1.0,
    "jam_index": 0.5,
}  # fmt: skip
FOLLOWER = {
    "mass": 0.25, "guide_spacing": 0.132, "overhang": 0.0445, "friction_a": 0.06,
    "friction_b": 0.06, "friction_worst": (0.12, 0.12),
}  # fmt: skip
JUMP_MARGIN = 1.3


def life_force_cubed(hours):
    """Limit of the mean of N^3 |n|, N^3 rad/s, for a rating of 8500 N."""
    return 8500.0**3 * 2e6 * np.pi / (3600.0 * hours)


MEASURED = {
    "v08": {
        "ripple": 0.20698,
        "ratings": {"pressure_angle": np.radians(33.35), "cam_radius": 0.08757,
                        "life_force_cubed": life_force_cubed(800.2)},
        "spring": DesignVariables(56.67e3, 102.6, 0.06459),
        "speeds": {"idle": 2809.0, "overspeed": 3090.0},
        "weights": {"idle": 1.0, "overspeed": 1.0},
        "torque_reduction": 0.306,
    },
    "v10": {
        "ripple": 0.41784,
        "ratings": {"pressure_angle": np.radians(34.29), "cam_radius": 0.1027,
                        "life_force_cubed": life_force_cubed(63.16)},
        "spring": DesignVariables(47.14e3, 390.3, 0.0548),
        "speeds": {"idle": 1994.0, "overspeed": 4283.0},
        "weights": {"idle": 1.0, "overspeed": 0.0},
        "torque_reduction": 0.472,
    },
}  # fmt: skip
"""Least ripple, limits and machine of `tests/data/v08.toml` and `v10.toml`, crank speeds in rpm."""


def measured(name):
    """Problem of a measured machine: its torque from the case file, all else as stated here."""
    about = MEASURED[name]
    torques = engine_torques(read_case(ROOT / "tests" / "data" / f"{name}.toml"))
    scenarios = []
    for each, speed in about["speeds"].items():
        values = torques[each].without_mean().resampled(720).total
        scenarios.append(loaded_with(
            each, speed * np.pi / 60, values - values.mean(), weight=about["weights"][each],
            torque_reduction=about["torque_reduction"] if about["weights"][each] else None,
            **FOLLOWER,
        ))  # fmt: skip
    overspeed = about["speeds"]["overspeed"] * np.pi / 60
    return Problem(
        scenarios=tuple(scenarios),
        ratings=rated(
            **COMMON, **about["ratings"], overspeed=overspeed, jump_speed=JUMP_MARGIN * overspeed
        ),
        variables=about["spring"],
        left_out=frozenset(each.check for each in CONSTRAINTS) - KEPT,
    )


def constrained(path):
    """Problem of a case with all its constraints; the torque ripple alone is the objective."""
    case = read_clamped(ROOT / path)
    problem = problem_of(case, engine_torques(case))
    return replace(problem, coefficients=96, objective=(Weighted(TORQUE, 1.0),))


def signed():
    """Problem of the signed case."""
    return constrained("cases/gx120-redesign.toml")


def described(problem):
    """The problem with what the signed case lacks: grease, wall of a free cam, curvature rate.

    The grease has three times the rating of the bearing, as its estimate ends at P/C = 0.2.
    """
    given = named(problem.ratings)
    rating, diameter = 3.0 * given.dynamic_rating, 2.0 * given.roller_radius
    grease = Grease(9000.0 * 3600.0, rating, diameter, 343.15)
    held = problem.ratings.keyway.held_radius
    ratings = rated(problem.ratings, grease=grease, held_radius=held, curvature_rate=9e3)
    return replace(problem, ratings=ratings)


def with_corrections(problem, seed):
    """The problem with smooth corrections of every kind, damping, and two load cases by their duty.

    The speeds of the least force and the mean spin are of the order of the signed case.
    """
    random, turn = np.random.default_rng(seed), uniform_turn(64)

    def about(mean, spread):
        order, shift = random.integers(1, 5), random.uniform(0.0, 2.0 * np.pi)
        return mean + spread * np.sin(order * turn + shift)

    ratios = ("contact", "guide_a", "guide_b", "rubbing_a", "rubbing_b", "jam", "edge_a", "edge_b",
              "hot_a", "hot_b")  # fmt: skip
    forces = ("surge", "swept_surge", "elastic")  # N
    single = {"swept_speed": 180.0, "elastic_speed": 190.0, "rolling": 1.6, "least_lift": 8e-4,
              "lever": 1e-3}  # fmt: skip
    correction = Correction(
        **{name: about(1.1, 0.2) for name in ratios},
        **{name: about(0.0, 30.0) for name in forces},
        **{name: np.full(turn.size, value) for name, value in single.items()},
        **{name: about(1.1, 0.2) for name in ("pressure_weight", "force_weight")},
        **{name: about(1.1, 0.2) for name in ("bush_rubbing", "bush_bearing")},
        **{name: about(1.1, 0.2) for name in ("worn_a", "worn_b", "jam_tilted")},
    )
    scenarios = tuple(
        changed(item, correction=correction, viscous_damping=3.0) for item in problem.scenarios
    )
    return of_duty(replace(problem, scenarios=scenarios), idle=0.3, governed=0.7)


def of_duty(problem, **shares):
    """The problem with shares of its load cases in the operation; the others take no time."""
    scenarios = tuple(
        replace(item, duty=shares.get(item.name.split(",")[0], 0.0)) for item in problem.scenarios
    )
    return replace(problem, scenarios=scenarios)


def nominal(problem):
    """The problem without the tolerance corners of its load cases."""
    scenarios = tuple(item for item in problem.scenarios if "," not in item.name)
    return replace(problem, scenarios=scenarios)


def thinned(problem, coefficients, points):
    """The problem at every so many cam angles, with fewer splines."""
    step = problem.points // points
    scenarios = tuple(replace(s, torque=s.torque[::step]) for s in problem.scenarios)
    scenarios = tuple(replace(s, torque=s.torque - s.torque.mean()) for s in scenarios)
    return replace(problem, scenarios=scenarios, coefficients=coefficients, points=points)


def requiring(scenarios, reduction):
    """The scenarios with the same reduction of the torque ripple wherever it counts."""
    return tuple(
        replace(item, torque_reduction=reduction if item.weight > 0 else None) for item in scenarios
    )


def variant(problem, seed):
    """Seeded machine and limits about those of a problem; some have no cam within the limits."""
    random = np.random.default_rng(seed)

    def factor(spread):
        return float(np.exp(random.uniform(-spread, spread)))

    spring, speed, given = problem.variables, factor(0.15), named(problem.ratings)
    ratings = rated(
        problem.ratings,
        pressure_angle=given.pressure_angle * factor(0.12),
        cam_radius=given.cam_radius * factor(0.12),
        life_force_cubed=given.life_force_cubed * factor(0.5),
        pressure=given.pressure * factor(0.25),
        normal_force=given.normal_force * factor(0.5),
        roller_spin=given.roller_spin * factor(0.4),
        guide_pv=tuple(each * factor(0.8) for each in given.guide_pv),
        overspeed=given.overspeed * speed,
        jump_speed=given.jump_speed * speed * factor(0.3),
        roller_radius=given.roller_radius * factor(0.08),
        travel=given.travel * factor(0.15),
    )
    return replace(
        problem,
        ratings=ratings,
        variables=replace(
            spring, preload=spring.preload * factor(0.3), rate=spring.rate * factor(0.3)
        ),
        jerk_weight=problem.jerk_weight * float(10 ** random.uniform(-5, 0)),
        scenarios=requiring(
            [changed(s, cam_speed=figures(s).cam_speed * speed) for s in problem.scenarios],
            float(random.uniform(0.3, 0.6)),
        ),
    )

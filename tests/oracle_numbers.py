"""Numbers of a synthesis that its oracle takes from the product: limits, ratings, load cases."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
from synthesis_ratings import named, rated
from synthesis_scenarios import figures

LIMIT_NUMBERS = (
    "travel", "pressure_angle", "curvature_ratio", "undercut_factor", "hollow_radius",
    "curvature_rate", "cam_radius", "pressure", "contact_force_margin", "overspeed", "jump",
    "jump_speed", "jam_index", "normal_force", "roller_spin", "life_force_cubed",
    "guide_pressure_a", "guide_pressure_b", "guide_pv_a", "guide_pv_b", "torque_reduction",
    "minimum_wall", "guide_slope_a", "guide_slope_b", "gas_slope", "guide_gap", "guide_edge_load_a",
    "guide_edge_load_b", "guide_power_a", "guide_power_b", "guide_wear_pv_a", "guide_wear_pv_b",
    "friction", "waviness", "cam_torque", "tooth_torque", "keyway_safety",
    "grease_rating", "modified_rate", "roller_spin_least", "outer_undercut",
)  # fmt: skip
MACHINE_NUMBERS = (
    "roller_radius", "contact_width", "contact_modulus", "guide_area_a", "guide_area_b",
    "gear_ratio", "rate", "preload", "prime_radius", "held_radius", "guide_mouth",
    "guide_length_a", "guide_length_b", "shaft_drag", "drag_inertia", "drag_torque",
    "drag_bearing_friction", "drag_pin_radius", "wave_amplitude", "wave_length",
    "keyway_by_torque", "keyway_by_force", "keyway_held_radius", "keyway_thick",
    "keyway_per_stress", "grease_life", "grease_diameter", "grease_temperature",
    "modified_rating", "modified_cleanliness_load", "modified_viscosity", "modified_circle",
)  # fmt: skip
FACTORS = (
    "mass_factor", "friction_factor", "friction_worst_factor", "spacing_factor", "overhang_factor",
)  # fmt: skip
"""Factors on the value of each scenario."""
NUMBERS = LIMIT_NUMBERS + MACHINE_NUMBERS + FACTORS
"""Limits and machine numbers; the optimum is differentiated by each."""

SCENARIO = (
    "cam_speed", "mass", "spring_mass", "guide_spacing", "overhang", "friction_a", "friction_b",
    "viscous_damping", "rate_factor", "preload_factor", "worst_a", "worst_b", "nominal", "swept",
    "in_operation",
)  # fmt: skip
CORRECTION = (
    "contact", "pressure_weight", "force_weight", "guide_a", "guide_b", "rubbing_a", "rubbing_b",
    "jam", "edge_a", "edge_b", "hot_a", "hot_b", "surge", "swept_surge", "elastic", "swept_speed",
    "elastic_speed", "rolling", "least_lift", "worn_a", "worn_b", "jam_tilted",
)  # fmt: skip
"""Results of finite elements, surge and heat on the last cam, constants of a synthesis."""
FREE = ("rate", "preload", "prime_radius")
_PARTS = {
    "drag": ("inertia", "torque", "bearing_friction", "pin_radius"),
    "keyway": ("by_torque", "by_force", "held_radius", "thick", "per_stress"),
    "grease": ("life", "diameter", "temperature"),
}  # fmt: skip


def numbers_of(problem):
    """Values of `NUMBERS` of a problem, SI; None: no such limit."""
    ratings, variables = problem.ratings, problem.variables
    known = vars(named(ratings)) | dict.fromkeys(FACTORS, 1.0)
    for part, names in _PARTS.items():
        known |= {f"{part}_{name}": getattr(getattr(ratings, part), name, None) for name in names}
    known |= {name: getattr(variables, name) for name in FREE}
    known["gear_ratio"] = problem.gear_ratio
    known["torque_reduction"] = required_reduction(problem)
    if (known["hollow_radius"] or 0.0) <= (known["roller_radius"] or 0.0):
        known["hollow_radius"] = None  # the roller cannot roll in a smaller hollow
    if any(figures(item).worst_a is None for item in problem.scenarios):
        known["friction_worst_factor"] = None
    return {name: known[name] for name in NUMBERS}


def with_number(problem, name, value):
    """The problem with another value of a limit of `NUMBERS`."""
    part, _, of_part = name.partition("_")
    changed = {name: value}
    if of_part in _PARTS.get(part, ()):
        changed = {part: getattr(problem.ratings, part)._replace(**{of_part: value})}
    return replace(problem, ratings=rated(problem.ratings, **changed))


def required_reduction(problem):
    """Reduction of the torque ripple, the same wherever the ripple counts; None: none is."""
    (required,) = {item.torque_reduction for item in problem.scenarios if item.weight > 0}
    assert all(item.torque_reduction is None for item in problem.scenarios if item.weight == 0)
    return required


def vector(numbers):
    """Numbers in the order of `NUMBERS`, NaN for those of no limit."""
    return ca.DM([np.nan if numbers[name] is None else numbers[name] for name in NUMBERS])


def scenario_numbers(item, theta):
    """Values of `SCENARIO`; corrections at cam angles theta (n,), (len(CORRECTION), n)."""
    own = vars(figures(item))
    in_operation = 1.0 if item.duty is None else float(item.duty > 0.0)
    of_guides = ("worst_a", "worst_b", "friction_a", "friction_b", "guide_spacing", "overhang")
    own |= {name: own[name] or 0.0 for name in of_guides}
    own["friction_a"] = item.numbers.get("follower.pivot.friction") or own["friction_a"]
    own["in_operation"] = in_operation
    numbers = [float(own[name]) for name in SCENARIO]
    turn = np.linspace(0, 2 * np.pi, item.correction.contact.size, endpoint=False)
    fix = np.stack([
        np.interp(theta, turn, getattr(item.correction, name), period=2 * np.pi)
        for name in CORRECTION
    ])  # fmt: skip
    return ca.DM(numbers), ca.DM(fix)

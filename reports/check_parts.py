"""Part of the mechanism that a check judges."""

from __future__ import annotations

from collections.abc import Mapping

from camwright.pipeline.base.files import Json

EVIDENCE = "Evidence"
_PREFIXES = {
    "Torque": ("torque_", "speed_reduction"),
    "Cam": (
        "data_cam", "pressure_angle", "curvature_", "undercut", "self_intersection",
        "second_contact", "concave_radius", "tool_gouge", "minimum_wall", "cam_radius", "profile_",
        "chord_error", "phase_tolerance", "acceleration_step", "closure", "bore_", "synthesis_",
        "hardened_case", "case_", "keyway_root",
    ),
    "Contact": (
        "contact_pressure", "first_yield", "shakedown", "edge_", "traction_", "film_ratio",
        "surface_fatigue", "dang_van", "pressure_by_", "endurance_rules", "hertz_difference",
    ),
    "Follower": (
        "data_follower", "contact_force_margin", "jump", "contact_at_overspeed",
        "contact_over_speed", "elastic_contact", "anti_rotation", "follower_mass",
    ),
    "Roller": ("data_roller", "data_pin", "data_fork", "roller_", "bearing_", "grease_", "cheek_"),
    "Flat face": ("data_face", "face_"),
    "Guides": ("data_guides", "guide_", "jam_"),
    "Spring": ("data_spring", "data_gas", "data_torsion", "spring_", "gas_", "torsion_"),
    "Camshaft": (
        "data_camshaft", "data_key", "data_gear", "cam_unbalance", "cam_slip", "key_", "shaft_",
        "gear_", "pinion_",
    ),
}  # fmt: skip
PARTS = (*_PREFIXES, EVIDENCE)
"""Parts in the order of the flow of force; evidence last."""


def part_of(check: Mapping[str, Json]) -> str:
    """Part that a check judges, one of `PARTS`."""
    if check["evidence"]:
        return EVIDENCE
    name = str(check["id"])
    fits = ((len(prefix), part) for part, prefixes in _PREFIXES.items() for prefix in prefixes
            if name.startswith(prefix))  # fmt: skip
    return max(fits, default=(0, EVIDENCE))[1]

"""Groups of case keys on whose values checks rest, besides their limits.

Dotted names in a case, with wildcards in the last word, a material by the part made of it. A length
that the designer chooses is not listed: the drawing fixes it, not a source.
"""

from __future__ import annotations

from typing import Literal

from camwright.pipeline.follower.spring_kinds import SHAPES

SPRING = (
    *("spring.rate", "spring.preload", "spring.link.*", "spring.rocker.*"),
    *(f"{each.table}.*" for each in SHAPES.values()),
)
MOTION = (*SPRING, "follower.mass", "limits.overspeed")
LOADS = (
    *MOTION,
    *("guides.a.friction*", "guides.a.material.E", "guides.a.material.nu"),
    *("guides.b.friction*", "guides.b.material.E", "guides.b.material.nu"),
    *("follower.stem_material.E", "follower.stem_material.nu"),
    *("follower.pivot.bush.friction*", "follower.pivot.needle_bearing.friction*"),
    *("follower.pivot.swinging_mass", "follower.pivot.mass_*"),
)
_BODIES = ("cam.material", "roller.material", "follower.face.material")
CAM_FATIGUE = ("cam.material.fatigue_torsion", "cam.material.fatigue_bending")
KEY = (
    *LOADS,
    *("cam.key.application_factor", "cam.key.material.yield_strength", "limits.key_reversal"),
    *("cam.material.*yield_strength", "camshaft.material.*yield_strength"),
)
BENCH = ("camshaft.counterweight.residual",)
SHAFT = (*LOADS, "camshaft.drag", "camshaft.rotor_mass", "cam.material.density", *BENCH)
SURGE = ("spring.design.shear_modulus", "spring.design.density", "spring.design.damping_ratio")
TRACTION = (
    *LOADS,
    *("roller.friction", "roller.inertia", "roller.material.density"),
    *("roller.bearing.drag_torque", "roller.bearing.friction"),
)
WIRE = ("spring.design.strength_at_1mm", "spring.design.strength_exponent")
RATE = ("spring.design.shear_modulus",)


def bodies(*keys: str) -> tuple[str, ...]:
    """Keys of a property in the materials of cam and follower."""
    return tuple(f"{body}.{key}" for body in _BODIES for key in keys)


CONTACT = (*LOADS, *bodies("E", "nu"))
AXES = ("limits.axis_parallelism", "limits.cam_run_out")
TILT = (*AXES, "camshaft.material.E")
LENGTH = (
    *CONTACT,
    *("cam.end.*", "roller.end.*", "follower.face.end.*"),
    *("cam.crown.*", "roller.crown.*", "follower.face.crown.*"),
    *("guides.a.clearance", "guides.b.clearance", "roller.axial_offset"),
    *(*AXES, "limits.roller_clearance"),
    *("camshaft.drag", "camshaft.material.E", "cam.material.density", *BENCH),
)


def of_guide(side: Literal["A", "B", "pivot"], *keys: str) -> tuple[str, ...]:
    """Keys of properties of guide A or B, or of the bush of a pivot."""
    table = "follower.pivot.bush" if side == "pivot" else f"guides.{side.lower()}"
    return tuple(f"{table}.{key}" for key in keys)


def heat(side: Literal["A", "B", "pivot"]) -> tuple[str, ...]:
    """Keys that decide the temperature of guide A or B, or of the bush of a pivot."""
    path = of_guide(side, "material.conductivity", "thermal_resistance", "housing_resistance")
    around = "follower.pivot" if side == "pivot" else "guides"
    return (*path, f"{around}.ambient_temperature")

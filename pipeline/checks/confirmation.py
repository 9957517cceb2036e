"""Values on which each check rests, and those of them that no source confirms.

A value is confirmed by its source, or by an entry ``[[confirmed]]`` of the case; a tolerance
tighter than its default by such an entry alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.consistency import tightened_tolerances
from camwright.pipeline.case.section import suggestion
from camwright.pipeline.case.toml_text import Tables
from camwright.pipeline.case.value_sources import OF_A_CHECK, confirms, source_of, values_at
from camwright.pipeline.checks.check import Check

_SPRING = ("spring.rate", "spring.preload", "spring.gas.*", "spring.torsion.*")
_MOTION = (*_SPRING, "follower.mass", "limits.overspeed")
_LOADS = (
    *_MOTION,
    *("guides.a.friction*", "guides.a.material.E", "guides.a.material.nu"),
    *("guides.b.friction*", "guides.b.material.E", "guides.b.material.nu"),
    *("follower.stem_material.E", "follower.stem_material.nu"),
)
_BODIES = ("cam.material", "roller.material", "follower.face.material")
_CAM_FATIGUE = ("cam.material.fatigue_torsion", "cam.material.fatigue_bending")
_HEAT = (
    *("guide.material.conductivity", "guide.thermal_resistance", "guide.housing_resistance"),
    "guides.ambient_temperature",
)
_KEY = (
    *_LOADS,
    *("cam.key.application_factor", "cam.key.material.yield_strength", "limits.key_reversal"),
    *("cam.material.*yield_strength", "camshaft.material.*yield_strength"),
)
_BENCH = ("camshaft.counterweight.residual",)
_SHAFT = (*_LOADS, "camshaft.drag", "camshaft.rotor_mass", "cam.material.density", *_BENCH)
_SURGE = ("spring.design.shear_modulus", "spring.design.density", "spring.design.damping_ratio")
_TRACTION = (
    *_LOADS,
    *("roller.friction", "roller.inertia", "roller.material.density"),
    *("roller.bearing.drag_torque", "roller.bearing.friction"),
)
_WIRE = ("spring.design.strength_at_1mm", "spring.design.strength_exponent")
_RATE = ("spring.design.shear_modulus",)


def _bodies(*keys: str) -> tuple[str, ...]:
    """Keys of the materials of cam and follower."""
    return tuple(f"{body}.{key}" for body in _BODIES for key in keys)


_CONTACT = (*_LOADS, *_bodies("E", "nu"))
_LENGTH = (
    *_CONTACT,
    *("cam.end.*", "roller.end.*", "follower.face.end.*"),
    *("cam.crown.*", "roller.crown.*", "follower.face.crown.*"),
    *("guides.a.clearance", "guides.b.clearance", "roller.axial_offset"),
)


def _guides(name: str, *keys: str) -> dict[str, tuple[str, ...]]:
    """A check of each guide."""
    return {
        f"{name}_{side.upper()}": (
            *_LOADS,
            *(key.replace("guide.", f"guides.{side}.") for key in keys),
        )
        for side in ("a", "b")
    }


RESTS_ON: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "torque_reduction": _LOADS,
        "speed_reduction": (*_LOADS, "crankshaft.inertia", "crankshaft.mechanism_inertia"),
        "closure": (),
        "acceleration_step": (),
        "pressure_angle": (),
        "curvature_ratio": (),
        "undercut": (),
        "self_intersection": (),
        "second_contact": (),
        "concave_radius": (),
        "curvature_rate": (),
        "minimum_wall": (),
        "spring_travel": ("spring.travel_max",),
        "contact_force_margin": _LOADS,
        "jump": _MOTION,
        "jam_index": _LOADS,
        "jam_index_friction_max": _LOADS,
        "jump_speed": _MOTION,
        "contact_at_overspeed": _LOADS,
        "elastic_contact": (
            *_LOADS, "follower.stiffness", "follower.damping_ratio", "roller.material.E",
            "roller.material.nu", "roller.bearing.ring.*",
        ),
        "contact_pressure": (*_CONTACT, *_bodies("*endurance_pressure")),
        "first_yield": (*_CONTACT, *_bodies("yield_strength")),
        "shakedown": (*_CONTACT, *_bodies("yield_strength")),
        "contact_pressure_at_life": (
            *_LENGTH, *_bodies("*endurance_slope", "*endurance_intercept"),
            "limits.contact_safety",
        ),
        "edge_pressure": (*_LENGTH, *_bodies("*endurance_pressure"), "limits.contact_safety"),
        "shakedown_traction": (
            *_CONTACT, *_bodies("yield_strength"), "roller.friction", "follower.face.friction",
        ),
        "traction_demand": _TRACTION,
        "traction_reserve": _TRACTION,
        "film_ratio": (
            *_CONTACT, "lubricant.*viscosity", "cam.roughness", "roller.roughness",
            "follower.face.roughness",
        ),
        "surface_fatigue": (*_CONTACT, *_CAM_FATIGUE),
        "dang_van": (*_CONTACT, *_CAM_FATIGUE),
        "hardened_case": (
            *_CONTACT, "cam.material.yield_strength", "cam.material.core_yield_strength",
            "cam.material.case_depth",
        ),
        "case_depth": (*_LENGTH, "cam.material.case_depth"),
        "case_shear": (
            *_CONTACT, *_TRACTION, "cam.material.case_depth", "cam.material.fatigue_torsion",
            "cam.material.core_fatigue_torsion",
        ),
        "endurance_rules": _bodies("*endurance_pressure", "hardness*"),
        "edge_shakedown": (
            *_LENGTH, *_TRACTION, *_bodies("yield_strength"), "follower.face.friction",
        ),
        "roller_overlap": ("roller.axial_offset",),
        "pressure_by_hardness": (*_CONTACT, "cam.material.hardness*"),
        "pressure_by_gear_limits": (*_CONTACT, "cam.material.hardness*"),
        "roller_static": (*_LOADS, "roller.bearing.C0"),
        "roller_life": (
            *_LOADS, *_SURGE, "roller.bearing.C", "roller.bearing.fatigue_load_limit",
            "roller.bearing.viscosity",
        ),
        "roller_modified_life": (
            *_LOADS, *_SURGE, "roller.bearing.C", "roller.bearing.C0",
            "roller.bearing.fatigue_load_limit", "roller.bearing.viscosity",
            "roller.bearing.*pitch_diameter", "limits.roller_reliability",
        ),
        "roller_load_share": (*_LOADS, "roller.bearing.C"),
        "grease_life": (
            *_LOADS, "roller.bearing.C", "roller.bearing.temperature",
            "roller.bearing.grease_life", "roller.bearing.relubrication_interval",
            "limits.target_life",
        ),
        "roller_speed": ("roller.bearing.speed_limit", "limits.overspeed"),
        "roller_radial": (*_LOADS, "roller.bearing.radial_limit"),
        "roller_static_radial": (*_LOADS, "roller.bearing.static_radial_limit"),
        **_guides(
            "guide_pressure", "guide.pressure_limit*", "guide.material.yield_strength",
            "guide.material.strength_at", *_HEAT,
        ),
        **_guides("guide_pv", "guide.pv_limit"),
        **_guides(
            "guide_edge_pressure", "guide.material.yield_strength", "guide.material.strength_at",
            *_HEAT,
        ),
        **_guides("guide_temperature", "guide.material.temperature_limit", *_HEAT),
        **_guides(
            "guide_expansion", "guide.material.expansion", "guide.material.swelling",
            "follower.stem_material.expansion", *_HEAT,
        ),
        **_guides("guide_speed", "guide.speed_limit"),
        "anti_rotation": (),
        **_guides("guide_wear", "guide.wear_rate", "limits.target_life"),
        "guide_length": (),
        "gas_pressure": (*_SPRING,),
        "torsion_stress": (*_SPRING,),
        "torsion_fatigue": (*_SPRING,),
        "gas_stroke": ("spring.gas.stroke",),
        "gas_speed": (*_MOTION, "spring.gas.speed_limit"),
        "gas_temperature": ("spring.gas.*temperature*",),
        "spring_stress": (*_SPRING, *_SURGE, *_WIRE, "limits.overspeed"),
        "spring_fatigue": (*_SPRING, *_SURGE, *_WIRE, "limits.overspeed"),
        "spring_solid": (*_SPRING, *_RATE),
        "spring_buckling": (),
        "spring_rate": ("spring.rate", *_RATE),
        "spring_surge": (*_SURGE, "limits.overspeed"),
        "spring_coil_gap": (*_SPRING, *_RATE),
        "spring_solid_stress": (*_SPRING, *_RATE, *_WIRE),
        "spring_relaxation": (
            *_SPRING, *_RATE, "spring.design.relaxation", "spring.design.temperature",
        ),
        "contact_over_speed": (*_LOADS, *_SURGE),
        "roller_pin": (*_LOADS, "roller.pin.material.yield_strength"),
        "roller_pin_shear": (*_LOADS, "roller.pin.material.yield_strength"),
        "roller_pin_fatigue": (
            *_LOADS, "roller.pin.material.tensile_strength", "roller.pin.material.fatigue_bending",
        ),
        "roller_pin_pressure": (
            *_LOADS, "roller.pin.material.tensile_strength", "roller.fork.material.*_strength",
        ),
        "cheek_pressure": (
            *_LOADS, "roller.pin.material.tensile_strength", "roller.fork.material.*_strength",
            "roller.fork.pressure_limit",
        ),
        "follower_mass": (
            "follower.mass", "follower.stem_material.density", "roller.material.density",
            "roller.pin.material.density", "roller.fork.material.density",
            "spring.design.density",
        ),
        "roller_ring_fatigue": (
            *_LOADS, "roller.material.E", "roller.material.nu", "roller.bearing.C0",
            "roller.bearing.ring.*",
        ),
        "key_pressure": _KEY,
        "key_pressure_shaft": _KEY,
        "keyway_root": (
            *_KEY, *_CONTACT, "cam.material.fatigue_bending", "cam.material.tensile_strength",
            "limits.shaft_reliability",
        ),
        "cam_slip": (*_KEY, "camshaft.slip_torque"),
        "bore_pressure": (
            *_LOADS, "cam.material.tensile_strength", "camshaft.material.tensile_strength",
        ),
        "key_shear": _KEY,
        "torque_reversals": _LOADS,
        "cam_unbalance": (
            "cam.material.density", "camshaft.rotor_mass", "limits.overspeed", *_BENCH,
        ),
        "shaft_fatigue": (
            *_SHAFT, "camshaft.material.tensile_strength", "camshaft.material.fatigue_bending",
            "camshaft.*notch_*", "limits.shaft_reliability",
        ),
        "shaft_yield": (*_SHAFT, "camshaft.material.*yield_strength", "camshaft.*notch_*"),
        "shaft_deflection": (*_SHAFT, "camshaft.material.E"),
        "shaft_slope": (*_SHAFT, "camshaft.material.E"),
        "shaft_bearing_static": (*_SHAFT, "camshaft.bearing_static_rating"),
        "shaft_bearing_life": (*_SHAFT, "camshaft.bearing_rating"),
        "gear_bending": (
            *_LOADS, "camshaft.gear.bending_limit", "camshaft.gear.application_factor",
            "camshaft.drag",
        ),
        "pinion_bending": (
            *_LOADS, "camshaft.gear.pinion_bending_limit", "camshaft.gear.bending_limit",
            "camshaft.gear.application_factor", "camshaft.drag",
        ),
        "gear_contact": (
            *_LOADS, "camshaft.gear.*contact_limit", "camshaft.gear.application_factor",
            "camshaft.drag", "camshaft.gear.material.E", "camshaft.gear.material.nu",
        ),
        "face_width": (),
        "face_pv": (*_CONTACT, "follower.face.pv_limit"),
        "bearing_lubrication": ("roller.bearing.viscosity", "roller.bearing.*pitch_diameter"),
        "guide_gap": (),
        "cam_radius": (),
        "profile_waviness": (*_LOADS, "cam.waviness_length", "cam.profile_tolerance"),
        "chord_error": (),
        "tool_gouge": (),
        "phase_tolerance": _LOADS,
        "bore_stress": (
            *_CONTACT, "cam.material.yield_strength", "cam.material.core_yield_strength",
        ),
        **{f"data_{name}": () for name in (
            "cam", "follower", "roller", "face", "roller_bearing", "pin", "fork", "spring",
            "gas_spring", "torsion_spring", "guides", "camshaft", "camshaft_bearings", "key",
            "gear",
        )},
    }
)  # fmt: skip
"""Values besides its own limit on which a check of the design rests, by its id: dotted names in a
case, with wildcards in the last word, a material by the part made of it. A length that the
designer chooses is not listed: the drawing fixes it, not a source."""


def with_values_to_confirm(checks: Iterable[Check], case: Case) -> tuple[Check, ...]:
    """The checks with the values on which they rest and which nothing confirms.

    The source that a check declares for its limit counts as a value, ``checks.ID``, where it is
    recalled. A check judged at the tolerance corners rests on every tolerance that is tighter than
    its default, whatever its source. A check without data rests on none.

    Raises
    ------
    InputError
        If the case confirms the source of an unknown check.
    """
    tables, tight = case.tables(), tuple(tightened_tolerances(case))
    confirmed = {each.value for each in case.confirmed}
    for value in confirmed:
        if value.startswith(OF_A_CHECK) and value.removeprefix(OF_A_CHECK) not in RESTS_ON:
            known = [f"{OF_A_CHECK}{name}" for name in RESTS_ON]
            limit = f"the source of a known check{suggestion(value, known)}"
            raise InputError("confirmed.value", value, limit)
    return tuple(
        replace(
            one,
            unconfirmed=tuple(
                value
                for value in dict.fromkeys(_open_values(one, tables, tight))
                if value not in confirmed
            ),
        )
        for one in checks
    )


def _open_values(one: Check, tables: Tables, tight: tuple[str, ...]) -> Iterator[str]:
    """Values on which a check rests and whose source does not confirm them."""
    if not one.evaluated or one.evidence:
        return
    declared, limit = one.declaration.source, one.declaration.limit
    if limit is None and declared and not confirms(declared):
        yield f"{OF_A_CHECK}{one.id}"
    own = () if limit is None else (f"limits.{limit.id}",)
    for path in (*own, *RESTS_ON[one.id]):
        for value in values_at(tables, path):
            if value in tight or not confirms(source_of(tables, value)):
                yield value
    if one.declaration.moved_by_tolerance:
        yield from tight

"""Ratings of a synthesis by keyword: limits and numbers by short names, rows by their id."""

from dataclasses import replace
from types import SimpleNamespace

from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.smoothing.scenario import Ratings

BOUNDS = {
    "outer_undercut": "outer_undercut",
    "travel": "spring_travel", "hollow_radius": "concave_radius", "pressure": "contact_pressure",
    "normal_force": "roller_static", "life_force_cubed": "roller_life", "gas_slope": "gas_speed",
    "roller_spin": "roller_speed", "friction": "traction_demand", "cam_torque": "key_pressure",
    "tooth_torque": "gear_bending", "modified_rate": "roller_modified_life",
    "roller_spin_least": "bearing_lubrication", "jump_speed": "jump_speed",
    "guide_gap": "guide_gap", "face_width": "face_width", "face_pv": "face_pv",
    "grease_rating": "grease_life",
    **{f"{name}_{side.lower()}": f"{check}_{side}" for side in "AB" for name, check in (
        ("guide_pressure", "guide_pressure"), ("guide_pv", "guide_pv"),
        ("guide_wear_pv", "guide_wear"), ("guide_edge_load", "guide_edge_pressure"),
        ("guide_power", "guide_temperature"), ("guide_slope", "guide_speed"))},
}  # fmt: skip
"""Key of a limit of a part by its short name."""
NUMBERS = {
    "roller_radius": "roller.radius", "offset": "cam.offset", "contact_width": "contact.width",
    "contact_modulus": "contact.modulus", "overspeed": "cam.fastest",
    "force_safety": "limits.roller_static_safety", "dynamic_rating": "roller.bearing.C",
    "held_radius": "cam.held_radius", "guide_mouth": "guides.a.mouth",
    "shaft_drag": "camshaft.drag", "wave_height": "cam.waviness",
    "wave_length": "cam.waviness_length", "width": "follower.face.width",
    "face_friction": "follower.face.friction", "modified_rating": "roller.bearing.C",
    "modified_cleanliness_load": "roller.bearing.cleanliness_load",
    "modified_viscosity": "roller.bearing.viscosity",
    "modified_circle": "roller.bearing.pitch_diameter",
    **{f"{name}_{side}": f"guides.{side}.{key}" for side in "ab" for name, key in (
        ("guide_area", "area"), ("guide_length", "length"))},
}  # fmt: skip
"""Dotted key of a number of the machine by its short name."""
MODIFIED = tuple(f"modified_{name}" for name in (
    "rating", "cleanliness_load", "viscosity", "circle"))  # fmt: skip
PARTS = ("drag", "keyway", "grease")
BARE = Numbers({
    "cam.offset": 0.0, "contact.width": 1.0, "contact.modulus": 1.0, "camshaft.drag": 0.0,
    "guides.a.area": 1.0, "guides.b.area": 1.0, "guides.a.length": 1.0, "guides.b.length": 1.0,
    "guides.a.mouth": 0.0,
})  # fmt: skip


def rated(start=None, **values):
    """The ratings with these values, of a pair both; start: those to change. None: no limit.

    face: width, friction, limit of the PV value; waves: amplitude, length; modified: C, e_C P_u,
    viscosity, pitch diameter.
    """
    start = Ratings(BARE) if start is None else start
    parts = {name: values.pop(name) for name in PARTS if name in values}
    if parts.get("grease") is not None:
        values["grease_rating"] = parts["grease"].rating
    if "face" in values:
        width, friction, pv = values.pop("face")
        values |= {"width": width, "face_width": width, "face_friction": friction, "face_pv": pv}
    if "wave_amplitude" in values:
        values["wave_height"] = 2.0 * values.pop("wave_amplitude")
    if "waves" in values:
        amplitude, length = values.pop("waves")
        values |= {"wave_height": 2.0 * amplitude, "wave_length": length}
    if "modified" in values:
        values |= dict(zip(MODIFIED, values.pop("modified"), strict=True))
    for name in [name for name, value in values.items() if isinstance(value, tuple)]:
        values |= dict(zip((f"{name}_a", f"{name}_b"), values.pop(name), strict=True))
    numbers = {NUMBERS[name]: values.pop(name) for name in list(values) if name in NUMBERS}
    bounds = {BOUNDS.get(name) or LIMITS[name].id: value for name, value in values.items()}
    known = {**start.bounds, **bounds}
    return replace(
        start,
        numbers=start.numbers | numbers,
        bounds={key: value for key, value in known.items() if value is not None},
        **parts,
    )


def named(ratings):
    """Limits and numbers of ratings by short name, of guides as pairs too; None: no limit."""
    known = {name: getattr(ratings, name) for name in PARTS}
    known |= dict.fromkeys(LIMITS) | dict(ratings.bounds)
    known |= {name: ratings.bounds.get(key) for name, key in BOUNDS.items()}
    known |= {name: ratings.numbers.get(key) for name, key in NUMBERS.items()}
    pairs = {name[:-2] for name in known if name.endswith("_a")}
    known |= {name: (known[f"{name}_a"], known[f"{name}_b"]) for name in pairs}
    height = known["wave_height"]
    known["wave_amplitude"] = None if height is None else 0.5 * height
    return SimpleNamespace(**known)

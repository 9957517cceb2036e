"""Scenarios of a synthesis by keyword: fields of `Scenario`, and numbers by short names."""

from dataclasses import replace
from types import SimpleNamespace

from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.smoothing.scenario import Scenario

NUMBERS = {
    "cam_speed": "cam.speed", "mass": "follower.mass", "guide_spacing": "guides.spacing",
    "overhang": "follower.overhang_at_max_lift", "friction_a": "guides.a.friction",
    "friction_b": "guides.b.friction", "viscous_damping": "follower.viscous_damping",
    "worst_a": "guides.a.friction_greatest", "worst_b": "guides.b.friction_greatest",
}  # fmt: skip
"""Dotted key of a number of the machine in a load case by its short name."""


def loaded_with(
    name, cam_speed, torque, mass, guide_spacing, overhang, friction_a, friction_b, **values
):
    """Scenario with these numbers, SI, and fields."""
    numbers = {
        "cam_speed": cam_speed, "mass": mass, "guide_spacing": guide_spacing, "overhang": overhang,
        "friction_a": friction_a, "friction_b": friction_b, "viscous_damping": 0.0,
        "friction_worst": None,
    }  # fmt: skip
    return changed(Scenario(name, torque, Numbers({})), **(numbers | values))


def changed(item, **values):
    """The scenario with other numbers and fields; friction_worst: of both guides, None: unknown."""
    if "friction_worst" in values:
        worst = values.pop("friction_worst") or (None, None)
        values |= dict(zip(("worst_a", "worst_b"), worst, strict=True))
    numbers = {NUMBERS[name]: values.pop(name) for name in list(values) if name in NUMBERS}
    return replace(item.at(numbers), **values)


def figures(item):
    """Fields and numbers of a scenario by short names; None of guides that an arm does not have."""
    guided = "guides.a.friction" in item.numbers.changed
    known = {name: item.numbers.get(key) if guided or not key.startswith("guides.") else None
             for name, key in NUMBERS.items()}  # fmt: skip
    return SimpleNamespace(**(vars(item) | known))

"""Constraints of the parts: guides, roller bearing, spring over its speeds, cam seat, gear.

As in `constraints`. What finite elements, the surge or the heat of a solved cam add is in the
`Correction` of its scenario, held while the search runs.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.case.limits import (
    CONTACT_FORCE_MARGIN,
    KEYWAY_SAFETY,
)
from camwright.pipeline.checks import (
    camshaft_strength,
    demands,
    flat_face_sliding,
    guide_strength,
    guide_wear,
    key_strength,
    manufacture,
    roller_bearing,
    spring_strength,
    surface_durability,
)
from camwright.pipeline.checks.roller_bearing import STANDSTILL
from camwright.pipeline.cycle.loaded_cam import LoadedCam, not_negative
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.roller_motion import (
    BALL_LIFE_EXPONENT,
    wear,
)
from camwright.pipeline.smoothing.cam_state import (
    Constraint,
    Mean,
    ScenarioCam,
    Total,
    duty_shares,
    kept,
    kept_loads,
    where_applies,
)
from camwright.pipeline.smoothing.scenario import Rating

Side = Literal["A", "B"]


def _guide_edge_pressure(side: Side) -> Constraint[ScenarioCam]:
    """Line load over that at the yield strength of the bush at its temperature."""
    place = "AB".index(side)

    def utilisation(at: ScenarioCam, limit: float) -> Array:
        return magnitude(at.edge[place]) / (at.ratings.guide_length[place] * limit)

    return Constraint(
        f"guide_edge_pressure_{side}", Rating("guide_edge_load", "N/mm", place), utilisation
    )


def _swept_force(at: ScenarioCam, limit: float) -> Array | None:
    """At the speed with the least force of the solved cam, with its surge; first the fastest."""
    fastest, scenario = at.ratings.fastest, at.scenario
    if fastest is None:
        return None
    fix = scenario.correction
    speed = np.where(fix.swept_speed > 0.0, fix.swept_speed, fastest)
    push = at.closing + fix.swept_surge
    push = push + (scenario.mass - scenario.spring_mass) * speed**2 * at.jet.bend
    push = push + scenario.viscous_damping * speed * at.jet.slope
    normal = push / at.share * at.motion.gain
    return where_applies(scenario.swept, 1.0 + limit - normal / at.least_spring)


def _elastic_contact(at: ScenarioCam, limit: float) -> Array | None:
    """As `_swept_force`, without friction, with the change by the elastic stem."""
    fastest, scenario = at.ratings.fastest, at.scenario
    if fastest is None:
        return None
    fix = scenario.correction
    speed = np.where(fix.elastic_speed > 0.0, fix.elastic_speed, fastest)
    inertia = (scenario.mass - scenario.spring_mass) * speed**2 * at.jet.bend
    push = demands.force_left(at.closing + fix.elastic, inertia, at.least_spring)
    return where_applies(scenario.swept, 1.0 + limit - push)


def _keyway_root(at: ScenarioCam, limit: float) -> Array | None:
    keyway = at.ratings.keyway
    if keyway is None:
        return None
    wall = at.motion.radius_at(at.fix.least_lift) - keyway.held_radius
    wall = np.where(np.real(wall) < keyway.thick, wall, keyway.thick)
    return keyway.used_by(magnitude(at.torque), magnitude(at.normal), wall) * limit


def _grease_life(at: ScenarioCam, limit: float) -> Mean | None:
    """Equivalent load over that at the life of the grease, both at the mean speed.

    With a duty the factor on the rating at which the grease lasts, and in each load case the load
    over the greatest one of the estimate.
    """
    grease = at.ratings.grease
    if grease is None:
        return None
    turns = np.real(at.spin_mean) >= STANDSTILL
    speed = np.where(turns, at.spin_mean, STANDSTILL)
    worn = wear(not_negative(at.normal), at.spin) / (limit**BALL_LIFE_EXPONENT * speed)
    shares, root = duty_shares(at.scenario), 1.0 / BALL_LIFE_EXPONENT
    if shares is None:
        share = grease.load_share(speed)
        lasts = turns & np.isfinite(share)
        return Mean(lasts * worn / np.where(lasts, share, 1.0) ** BALL_LIFE_EXPONENT, root)
    share = grease.load_share(speed, unbounded=True)
    known = turns & np.isfinite(share)
    left = np.broadcast_to(np.where(known, share, 1.0), worn.shape)
    count, running = shares.shape[1], shares.any(axis=0)
    counted = shares * np.ravel(known)

    def of(means: Array) -> Array:
        load, allowed = not_negative(means[..., :count]) ** root, means[..., count:]
        factors = [bearing_life.grease_load_factor(load, allowed, each) for each in counted]
        return np.concatenate(
            [np.stack(factors, axis=-1), load[..., running] / bearing_life.HEAVY_GREASE], axis=-1
        )

    members = np.concatenate([shares > 0.0, np.eye(count, dtype=bool)[running]])
    terms = np.concatenate([np.atleast_2d(known * worn), np.atleast_2d(left)])
    return Mean(terms, total=Total(of, members))


PART_SHAPE: tuple[Constraint[LoadedCam], ...] = (
    kept(guide_strength.guide_speed_a, Rating("guide_slope", "mm", 0)),
    kept(guide_strength.guide_speed_b, Rating("guide_slope", "mm", 1)),
    kept(spring_strength.gas_speed, Rating("gas_slope", "mm")),
)
"""Limits of the parts on the shape of the cam."""

PARTS: tuple[Constraint[ScenarioCam], ...] = (
    kept_loads(manufacture.guide_gap, Rating("guide_gap", "mm")),
    _guide_edge_pressure("A"),
    _guide_edge_pressure("B"),
    kept_loads(
        guide_strength.guide_temperature_a, Rating("guide_power", "W", 0, by="guide_power_by")
    ),
    kept_loads(
        guide_strength.guide_temperature_b, Rating("guide_power", "W", 1, by="guide_power_by")
    ),
    kept_loads(guide_wear.guide_wear_a, Rating("guide_wear_pv", "MPa m/s", 0)),
    kept_loads(guide_wear.guide_wear_b, Rating("guide_wear_pv", "MPa m/s", 1)),
    kept_loads(surface_durability.traction_demand, Rating("friction", "-")),
    kept_loads(manufacture.profile_waviness),
    Constraint("contact_over_speed", CONTACT_FORCE_MARGIN, _swept_force),
    Constraint("elastic_contact", CONTACT_FORCE_MARGIN, _elastic_contact),
    kept_loads(key_strength.key_pressure, Rating("cam_torque", "N m", by="cam_torque_by")),
    kept_loads(camshaft_strength.gear_bending, Rating("tooth_torque", "N m", by="tooth_torque_by")),
    Constraint("keyway_root", KEYWAY_SAFETY, _keyway_root),
    Constraint(
        "grease_life",
        Rating("grease", "N", "rating"),
        _grease_life,
        needs="roller",
    ),
    kept_loads(roller_bearing.roller_modified_life, Rating("modified_rate", "rad/s")),
    kept_loads(roller_bearing.bearing_lubrication, Rating("roller_spin_least", "rpm", power=-1.0)),
    kept_loads(flat_face_sliding.face_width, Rating("face", "mm", "width")),
    kept_loads(flat_face_sliding.face_pv, Rating("face", "MPa m/s", "pv")),
)
"""Limits of the parts on the loads of the cam in one scenario."""

"""Constraints of checks without a pointwise measure: guide edges, speed sweep, keyway, grease,
preload of both discs.

As in `constraints`. What finite elements, the surge or the heat of a solved cam add is in the
`Correction` of its scenario, held while the search runs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.checks import (
    demands,
    form_closure,
    guide_strength,
    jump_and_jamming,
    key_strength,
    roller_bearing,
)
from camwright.pipeline.checks.check import ClosedBy, Declaration, Kept
from camwright.pipeline.checks.contact_strength import line_pressure
from camwright.pipeline.checks.guide_strength import Side, table_of
from camwright.pipeline.checks.roller_bearing import FIRST_ROLLER, STANDSTILL
from camwright.pipeline.cycle.loaded_cam import not_negative
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.roller_motion import BALL_LIFE_EXPONENT, wear
from camwright.pipeline.smoothing.cam_state import (
    Constraint,
    Mean,
    ScenarioCam,
    Total,
    duty_shares,
    where_applies,
)


def _of(
    declared: Declaration,
    utilisation: Callable[[ScenarioCam, float], Array | Mean | None],
    unit: str = "",
    needs: ClosedBy = "",
) -> Constraint[ScenarioCam]:
    """Constraint of a check without a measure, at its row; unit: of a limit that a part sets;
    needs: closure, see `Ratings.kinds`, in place of the kind of follower of the check.
    """
    row, rule = None if unit else declared.limit, Kept(unit=unit)
    key = declared.id if row is None else row.id
    return Constraint(declared.id, key, utilisation, row, rule, needs or declared.needs)


def _edge_use(side: Side, at: ScenarioCam, limit: float) -> Array:
    """Line load over that at the yield strength of the bush at its temperature."""
    return magnitude(at.edge["AB".index(side)]) / (at.numbers[f"{table_of(side)}.length"] * limit)


def _swept_force(at: ScenarioCam, limit: float) -> Array:
    """Utilisation of the least contact force in the speed range: 1 plus `limit` less the contact
    force over the least spring force; 1 where the force is `limit` times that.

    The force is that at the cam speed where the solved cam has its least, with its surge there;
    before there is a solved cam, that at the greatest speed without surge.
    """
    fastest, fix, scenario = at.numbers["cam.fastest"], at.fix, at.scenario
    speed = np.where(fix.swept_speed > 0.0, fix.swept_speed, fastest)
    push = at.closing + fix.swept_surge
    push = push + at.inertia_at(speed) - scenario.spring_mass * speed**2 * at.jet.lift_d2
    push = push + at.numbers["follower.viscous_damping"] * speed * at.jet.slope
    normal = push / at.share * at.motion.gain
    return where_applies(scenario.swept, 1.0 + limit - normal / at.least_spring)


def _elastic_contact(at: ScenarioCam, limit: float) -> Array:
    """Utilisation of the least contact force in the speed range with an elastic stem, without
    friction; `limit` as in `_swept_force`.

    The force is that at the cam speed where the solved cam has its least with an elastic stem;
    before there is a solved cam, that at the greatest speed of a rigid stem.
    """
    fastest, fix, scenario = at.numbers["cam.fastest"], at.fix, at.scenario
    speed = np.where(fix.elastic_speed > 0.0, fix.elastic_speed, fastest)
    inertia = (at.numbers["follower.mass"] - scenario.spring_mass) * speed**2 * at.jet.lift_d2
    push = demands.force_left(at.closing + fix.elastic, inertia, at.least_spring)
    return where_applies(scenario.swept, 1.0 + limit - push)


def _keyway_root(at: ScenarioCam, limit: float) -> Array | None:
    """Utilisation (..., n) of the fatigue strength at the root of the keyway in the cam, by torque,
    normal force and the wall over the keyway; None without a keyway that closed forms judge.

    Parameters
    ----------
    limit : float   required safety factor
    """
    keyway = at.ratings.keyway
    if keyway is None:
        return None
    wall = at.motion.radius_at(at.fix.least_lift) - keyway.held_radius
    wall = np.where(np.real(wall) < keyway.thick, wall, keyway.thick)
    return keyway.used_by(magnitude(at.torque), magnitude(at.normal), wall) * limit


def _grease_life(at: ScenarioCam, limit: float) -> Mean | None:
    """Utilisation of the grease life of the roller bearing at its mean speed: equivalent load over
    the load at which the grease lasts for the target; None without grease.

    Where the load cases have a duty, two utilisations: the factor on the load rating with which the
    grease lasts over all load cases together, and in each of them the load over the greatest for
    which the life can be estimated.

    Parameters
    ----------
    limit : float   dynamic load rating, N
    """
    grease = at.ratings.grease
    if grease is None:
        return None
    turns = np.real(at.spin_mean) >= STANDSTILL
    speed = np.where(turns, at.spin_mean, STANDSTILL)
    worn = wear(not_negative(FIRST_ROLLER.force_on(at)), at.spin) / (
        limit**BALL_LIFE_EXPONENT * speed
    )
    shares, root = duty_shares(at.scenario), 1.0 / BALL_LIFE_EXPONENT
    if shares is None:
        share = grease.load_share(speed)
        lasts = turns & np.isfinite(share)
        return Mean(lasts * worn / np.where(lasts, share, 1.0) ** BALL_LIFE_EXPONENT, root)
    share = grease.load_share(speed, unbounded=True)
    finite = turns & np.isfinite(share)
    left = np.broadcast_to(np.where(finite, share, 1.0), worn.shape)
    count, running = shares.shape[1], shares.any(axis=0)
    counted = shares * np.ravel(finite)

    def of(means: Array) -> Array:
        load, allowed = not_negative(means[..., :count]) ** root, means[..., count:]
        factors = [bearing_life.grease_load_factor(load, allowed, each) for each in counted]
        return np.concatenate(
            [np.stack(factors, axis=-1), load[..., running] / bearing_life.HEAVY_GREASE], axis=-1
        )

    members = np.concatenate([shares > 0.0, np.eye(count, dtype=bool)[running]])
    terms = np.concatenate([np.atleast_2d(finite * worn), np.atleast_2d(left)])
    return Mean(terms, total=Total(of, members))


def _preload_least(at: ScenarioCam, limit: float) -> Array | None:
    """Utilisation of the least force on the disc that bears less: 1 plus `limit` less that force
    over the preload, less the profile tolerance over the interference; None without a preload.
    """
    squeeze = at.squeeze
    if squeeze is None:
        return None
    lost = at.numbers["cam.profile_tolerance"] / squeeze.interference
    first, second = squeeze.forces(at.axial)
    least = np.where(np.real(first) < np.real(second), first, second)
    return np.asarray(1.0 + limit + lost - least / squeeze.preload)


def _preload_pressure(at: ScenarioCam, limit: float) -> Array | None:
    """Pressure on the disc that is pressed harder, with an interference greater by the profile
    tolerance, as `line_pressure`; None without a preload.
    """
    other = at.on_other_track
    if other is None:
        return None
    more = at.numbers["cam.profile_tolerance"] + at.numbers[form_closure.INTERFERENCE]
    numbers = at.numbers | {form_closure.INTERFERENCE: more}
    # under the axial force of the nominal interference
    return line_pressure(replace(at, numbers=numbers, facing=other), limit)


PARTS: tuple[Constraint[ScenarioCam], ...] = (
    _of(guide_strength.guide_edge_pressure_a, partial(_edge_use, "A"), "N/mm"),
    _of(guide_strength.guide_edge_pressure_b, partial(_edge_use, "B"), "N/mm"),
    _of(jump_and_jamming.contact_over_speed, _swept_force),
    _of(jump_and_jamming.elastic_contact, _elastic_contact),
    _of(key_strength.keyway_root, _keyway_root),
    _of(roller_bearing.grease_life, _grease_life, "N"),
    _of(form_closure.preload_least, _preload_least, "-", "preload"),
    _of(form_closure.preload_pressure, _preload_pressure, "MPa", "preload"),
)
"""Limits of the parts on the loads of the cam in one scenario."""

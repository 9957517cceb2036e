"""Demand and limit of the checks of forces, guides and torque, of many designs at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.case.limits import (
    CONTACT_FORCE_MARGIN,
    JAM_INDEX,
    JUMP,
    JUMP_SPEED,
    OVERSPEED,
    WAVINESS,
)
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.guide_strength import pv_limit
from camwright.pipeline.screening.design_arrays import Designs, Judged, Turns

Side = Literal["a", "b"]


def _least_spring_force(turns: Turns) -> Array:
    """Spring force at minimum lift (m, 1), N."""
    return sampled_least(turns.loads.spring_force)[:, None]


def contact_force_margin(designs: Designs) -> Judged:
    least = designs.least(lambda turns: turns.loads.normal_force / _least_spring_force(turns))
    return np.maximum(least, 0.0), designs.limit(CONTACT_FORCE_MARGIN)


def jump(designs: Designs) -> Judged:
    worst = designs.worst(
        lambda turns: demands.greatest_unloading(
            turns.loads.inertia_force, turns.loads.closing_force
        ),
    )
    return worst, designs.limit(JUMP)


def jump_speed(designs: Designs) -> Judged:
    """From the greatest quotient of unloading inertia and spring force, at the crank speed."""
    speeds = []
    for turns in designs.turns:
        use = demands.greatest_unloading(turns.loads.inertia_force, turns.loads.closing_force)
        greatest = np.maximum(sampled_greatest(use), 0.0)
        with np.errstate(divide="ignore"):
            speeds.append(turns.crank_speed[:, 0] / np.sqrt(greatest))
    over = np.where(np.isnan(designs.limit(OVERSPEED)), np.nan, designs.fastest)
    return np.min(speeds, axis=0), designs.limit(JUMP_SPEED) * over


def contact_at_overspeed(designs: Designs) -> Judged:
    over = np.where(np.isnan(designs.limit(OVERSPEED)), np.nan, designs.fastest)[:, None]

    def force(turns: Turns) -> Array:
        inertia = (over / turns.crank_speed) ** 2 * turns.loads.inertia_force
        return demands.force_left(turns.loads.closing_force, inertia, _least_spring_force(turns))

    return designs.least(force), designs.limit(CONTACT_FORCE_MARGIN)


def jam_index(designs: Designs) -> Judged:
    worst = designs.worst(
        lambda turns: demands.jam_outward(turns.loads.lift_slope, turns.loads.jam_index)
    )
    return worst, designs.limit(JAM_INDEX)


def jam_index_friction_max(designs: Designs) -> Judged:
    return designs.worst(lambda turns: turns.jam_index_max), designs.limit(JAM_INDEX)


def _area(designs: Designs, side: Side) -> Array:
    """Projected area of a guide (m, 1), m^2."""
    return designs.value(f"guides.{side}.length") * designs.value(f"guides.{side}.diameter")


def guide_pressure(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        area = _area(designs, side)

        def pressure(turns: Turns) -> Array:
            load = turns.guides.bearing_a if side == "a" else turns.guides.bearing_b
            return demands.guide_pressure(load, area)

        return designs.worst(pressure), designs.value(f"guides.{side}.pressure_limit")[:, 0]

    return judged


def guide_pv(side: Side) -> Callable[[Designs], Judged]:
    def pv(designs: Designs, turns: Turns) -> Array:
        load = turns.guides.rubbing_a if side == "a" else turns.guides.rubbing_b
        means = demands.guide_pv(load, turns.loads.velocity, _area(designs, side)).mean(axis=-1)
        return np.asarray(means)

    def judged(designs: Designs) -> Judged:
        guides = designs.machine.guides
        worst = np.max([pv(designs, turns) for turns in designs.turns], axis=0)
        return worst, pv_limit(guides.a if side == "a" else guides.b)

    return judged


def guide_speed(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        worst = designs.worst(lambda turns: np.abs(turns.loads.velocity))
        return worst, designs.value(f"guides.{side}.speed_limit")[:, 0]

    return judged


def profile_waviness(designs: Designs) -> Judged:
    band, length = designs.value("cam.profile_tolerance"), designs.value("cam.waviness_length")
    along = designs.at_loads(designs.shape.contact_path)

    def share(turns: Turns) -> Array:
        speed = turns.cam_speed * along
        added = demands.waviness_force(designs.value("follower.mass"), 0.5 * band, speed, length)
        held = _least_spring_force(turns)
        return demands.over_contact_force(added, turns.loads.normal_force, held)

    worst = np.max([share(turns).max(axis=-1) for turns in designs.turns], axis=0)
    return worst, designs.limit(WAVINESS)


def torque_after(designs: Designs, turns: Turns) -> Array:
    """Crank torque of engine and cam (m, n), N m."""
    before = np.zeros(1) if turns.state.torque is None else turns.state.torque
    return np.asarray(before - turns.loads.cam_torque / designs.case.mechanism.gear_ratio)


def torque_reduction(designs: Designs) -> Judged | None:
    shares = [
        (demands.ripple_reduction(turns.state.torque, torque_after(designs, turns)), required)
        for turns in designs.turns
        if turns.state.torque is not None and (required := turns.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)

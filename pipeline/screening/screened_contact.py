"""Demand and limit of the checks of contact, roller bearing and flat face, of many designs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import (
    Limit,
)
from camwright.pipeline.checks.contact_strength import LeastLimit, LoadCycles, pressure_limits
from camwright.pipeline.contact.hertz import half_width_square
from camwright.pipeline.follower.flat_face_motion import sliding_pv
from camwright.pipeline.screening.design_arrays import Designs, Judged
from camwright.pipeline.screening.design_lengths import has_many_shapes
from camwright.pipeline.screening.screened_cam import ScreenedCam


def _pressure(_: Designs, cam: ScreenedCam) -> Array:
    return cam.p0


def signed_pressure(_: Designs, cam: ScreenedCam) -> Array:
    """Contact pressure (m, n), Pa, with ends and tilt."""
    return cam.p0_signed


def crown_is_bound(designs: Designs) -> bool:
    """Whether the pressure in the middle of a crowned line is at least that of plane strain."""
    return designs.machine.is_crowned and has_many_shapes(designs)


def contact(
    name: str, safety: Limit, pressure: Callable[[Designs, ScreenedCam], Array] = _pressure
) -> Callable[[Designs], Judged]:
    """Contact pressure (m, n) against the least limit of cam and roller."""

    def judged(designs: Designs) -> Judged:
        limits = pressure_limits(designs.machine, LoadCycles(0.0, 0.0))
        demand = designs.worst(lambda cam: pressure(designs, cam))
        return demand, _least_limit(designs, limits[name], safety, demand)

    return judged


def _least_limit(designs: Designs, least: LeastLimit, safety: Limit, demand: Array) -> Array:
    """Limit (m,) at the safety of each design; missing where a body lacks it, unless exceeded."""
    if least.value is None:
        return np.full(designs.count, np.nan)
    limit = least.value * designs.machine.limits[safety] / designs.limit(safety)
    return np.where(demand > limit, limit, np.nan) if least.missing else limit


def face_width(designs: Designs) -> Judged:
    width = designs.contact_width
    arm = np.abs(designs.motion.arm)

    def needed(cam: ScreenedCam) -> Array:
        load = np.maximum(cam.normal, 0.0) / width
        radius, modulus = designs.relative_radius, designs.machine.contact_modulus
        return 2.0 * (arm + np.sqrt(half_width_square(load, radius, modulus)))

    return designs.worst(needed), designs.value("follower.face.width")[:, 0]


def face_pv(designs: Designs) -> Judged:
    height = designs.motion.height
    worst = designs.worst(lambda cam: sliding_pv(cam.p0, cam.speed * height))
    return worst, designs.value("follower.face.pv_limit")[:, 0]

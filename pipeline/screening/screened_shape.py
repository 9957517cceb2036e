"""Demand and limit of the checks of the cam shape, of many designs at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.case.limits import (
    GUIDE_GAP,
    GUIDE_LENGTH,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
)
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.screening.design_arrays import Designs, Judged, Screened


def pressure_angle(designs: Designs) -> Judged:
    allowed, on_return = designs.limit(PRESSURE_ANGLE), designs.limit(RETURN_PRESSURE_ANGLE)
    either = sampled_greatest(np.abs(designs.whole.motion.pressure_angle))
    if np.isnan(on_return).all():
        return either, allowed
    offset, slope = designs.value("cam.offset"), designs.jets[1]
    rise, back = (
        sampled_greatest(np.arctan2(np.abs(of_stroke - offset), designs.whole.motion.height))
        for of_stroke in (np.maximum(slope, 0.0), np.minimum(slope, 0.0))
    )
    steeper = back / on_return > rise / allowed  # false for NaN: no limit of the return
    demand = np.where(np.isnan(on_return), either, np.where(steeper, back, rise))
    return demand, np.where(steeper, on_return, allowed)


def by_measure(declared: Declaration) -> Screened:
    """Screening of a check that is declared by a measure.

    Raises
    ------
    InputError
        If the check states no deviation of the screening.
    """
    how, measure = declared.measured, declared.measure
    if how is None or measure is None or how.deviation is None:
        raise InputError(declared.id, "not declared", "screened, see `Measured`")

    def demand(designs: Designs) -> Array:
        extreme = sampled_least if how.worst == "least" else sampled_greatest
        if how.reduce == "top":
            worst = measure(designs.top)
        else:
            worst = extreme(measure(designs.whole))[:, None]
        value = np.asarray(how.value(worst, designs.numbers))
        return np.broadcast_to(value, (designs.count, 1))[:, 0]

    def judged(designs: Designs) -> Judged:
        allowed = how.allowed(designs.numbers).value
        limit = np.asarray(np.nan if allowed is None else allowed, dtype=float)
        known = np.where(applies(designs), demand(designs), np.nan)
        return known, np.broadcast_to(limit, (designs.count, 1))[:, 0]

    def applies(designs: Designs) -> NDArray[np.bool_]:
        return np.broadcast_to(how.applies(demand(designs)), designs.count)

    return Screened(declared.id, judged, how.deviation, applies)


def guide_gap(designs: Designs) -> Judged:
    overhang, length = (
        designs.value("follower.overhang_at_max_lift"),
        designs.value("guides.a.length"),
    )
    mouth = (overhang - 0.5 * length)[:, 0]
    base = designs.whole.motion.height[:, 0] - designs.jets[0][:, 0]
    highest = base + designs.highest + mouth
    over_cam = highest - sampled_greatest(designs.whole.motion.contour_radius)
    extent = designs.of_kind("roller.radius", "follower.face.thickness")[:, 0]
    gap = np.minimum(over_cam, mouth - extent)
    return gap, designs.limit(GUIDE_GAP)


def guide_length(designs: Designs) -> Judged:
    lengths = designs.value("guides.a.length") + designs.value("guides.b.length")
    spread = (designs.value("guides.spacing") + 0.5 * lengths)[:, 0]
    overhang = designs.value("follower.overhang_at_max_lift")[:, 0] + designs.highest
    return spread / overhang, designs.limit(GUIDE_LENGTH)

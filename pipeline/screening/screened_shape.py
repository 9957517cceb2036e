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
from camwright.pipeline.checks.check import Declaration, Measured
from camwright.pipeline.checks.extremes import BY_DUTY, Measure
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
        if any(designs.numbers.get(key) is None for key in how.needed):
            return np.full(designs.count, np.nan)
        value = _demand(measure, how, designs)
        for key in how.needed:
            value = np.where(np.isnan(np.asarray(designs.numbers[key])), np.nan, value)
        return np.broadcast_to(value, (designs.count, 1))[:, 0]

    def judged(designs: Designs) -> Judged:
        allowed = how.allowed(designs.numbers).value
        limit = np.asarray(np.nan if allowed is None else allowed, dtype=float)
        known = np.where(applies(designs), demand(designs), np.nan)
        return known, np.broadcast_to(limit, (designs.count, 1))[:, 0]

    def applies(designs: Designs) -> NDArray[np.bool_]:
        return np.broadcast_to(how.applies(demand(designs)), designs.count)

    return Screened(declared.id, judged, how.deviation, applies)


def _demand(measure: Measure, how: Measured, designs: Designs) -> Array:
    """Demand (m, 1) by the worst value of a measure, as `worst_measure`; NaN without a turn."""
    numbers = designs.numbers
    extreme = sampled_least if how.worst == "least" else sampled_greatest
    if how.reduce in ("case", "top"):
        return np.asarray(how.value(measure(designs.top), numbers))
    if how.reduce == "contour":
        return np.asarray(how.value(extreme(measure(designs.whole))[:, None], numbers))
    if how.reduce in BY_DUTY:
        return _by_duty(measure, how, designs)
    averaged = how.reduce == "mean"
    each = [np.mean(m, axis=-1) if averaged else extreme(m) for m in map(measure, designs.cams)]
    worst = np.min(each, axis=0) if how.worst == "least" else np.max(each, axis=0)
    return np.asarray(how.value(worst[:, None], numbers))


def _by_duty(measure: Measure, how: Measured, designs: Designs) -> Array:
    """As `over_duty`: sum of mean wear or damage of the load cases by their duty."""
    life, numbers = how.reduce == "life", designs.numbers
    running = [cam for cam in designs.cams if cam.state.duty != 0.0]
    if not running:
        return np.full((designs.count, 1), np.nan)
    values = [
        np.asarray(how.value(np.mean(measure(cam), axis=-1)[:, None], numbers)) for cam in running
    ]
    duties = [cam.state.duty for cam in running]
    if any(duty is None for duty in duties):
        return np.asarray(np.min(values, axis=0) if life else np.max(values, axis=0))
    shares = [
        (duty or 0.0) * (1.0 / each if life else each)
        for duty, each in zip(duties, values, strict=True)
    ]
    whole = np.sum(shares, axis=0)
    return np.asarray(1.0 / whole if life else whole)


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

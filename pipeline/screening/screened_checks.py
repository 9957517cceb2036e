"""Checks that screening judges, with demand and limit of many designs at once.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Bounded, Declaration, Measured
from camwright.pipeline.checks.extremes import BY_DUTY, Measure
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.screening.design_arrays import Designs, Judged, Screened
from camwright.pipeline.screening.design_lengths import has_many_shapes
from camwright.pipeline.screening.screened_cam import ScreenedCam


def _by_measure(declared: Declaration, measure: Measure, how: Measured) -> Screened | None:
    """Screening of a check that is declared by a measure; None where it states no deviation."""
    if how.deviation is None:
        return None

    def judged(designs: Designs) -> Judged:
        numbers, shape = designs.numbers, (designs.count, 1)
        allowed, _, if_exceeded = how.allowed(numbers)
        demand, limit = _demand(measure, how, designs), np.nan if allowed is None else allowed
        demand, limit = np.broadcast_to(demand, shape), np.broadcast_to(limit, shape)
        limit = np.where(demand > limit, limit, np.nan) if if_exceeded else limit
        if own := how.limits_of_strokes(numbers):
            demands = [_demand(each.measure, how, designs) for each in how.strokes]
            demand, limit = _of_strokes(demand, limit, demands, own)
        return demand[:, 0], np.asarray(limit, dtype=float)[:, 0]

    return Screened(declared.id, judged, how.deviation, how.applies, _BOUNDED[how.bounded])


_BOUNDED: Mapping[Bounded, Callable[[Designs], bool]] = {
    "": lambda _: False,
    "crown": lambda designs: designs.machine.is_crowned and has_many_shapes(designs),
    "line": has_many_shapes,
    "surge": lambda designs: designs.case.spring.design is not None,
}


def _of_strokes(
    either: Array, limit: Array, demands: Sequence[Array], limits: Sequence[Value]
) -> tuple[Array, Array]:
    """Demand and limit (m, 1) of the stroke that governs; of either without limits of each."""
    known = np.all([~np.isnan(each) & np.ones(limit.shape, dtype=bool) for each in limits], axis=0)
    demand, own = np.broadcast_arrays(demands[0], limits[0], either)[:2]
    for other, allowed in zip(demands[1:], limits[1:], strict=True):
        steeper = other / allowed > demand / own
        demand, own = np.where(steeper, other, demand), np.where(steeper, allowed, own)
    return np.where(known, demand, either), np.where(known, own, limit)


def _demand(measure: Measure, how: Measured, designs: Designs) -> Array:
    """Demand (m, 1) by the worst value of a measure, as `worst_measure`; NaN: not known."""
    numbers = designs.numbers
    lacking = np.zeros((designs.count, 1), dtype=bool)
    for key in how.needed:
        stated = numbers.get(key)
        lacking = lacking | np.isnan(np.nan if stated is None else stated)
    return (
        np.full(lacking.shape, np.nan)
        if lacking.all()
        else np.where(lacking, np.nan, _known(measure, how, designs))
    )


def _known(measure: Measure, how: Measured, designs: Designs) -> Array:
    numbers = designs.numbers
    extreme = sampled_least if how.worst == "least" else sampled_greatest
    if how.reduce in ("case", "top"):
        return np.asarray(how.value(measure(designs.top), numbers))
    if how.reduce == "contour":
        cams = designs.whole_to(how.order)
        return np.asarray(how.value(extreme(measure(cams))[:, None], numbers))
    if how.reduce in BY_DUTY:
        return _by_duty(measure, how, designs)

    def of_turn(values: Array) -> Array:
        if how.reduce == "mean":
            return np.asarray(np.mean(values, axis=-1))
        return extreme(values) if how.smooth else np.asarray(np.max(values, axis=-1))

    each = [of_turn(measure(cam)) for cam in designs.cams]
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


def torque_after(designs: Designs, cam: ScreenedCam) -> Array:
    """Crank torque of engine and cam (m, n), N m."""
    before = np.zeros(1) if cam.state.torque is None else cam.state.torque
    return np.asarray(before - cam.torque / designs.case.mechanism.gear_ratio)


def _torque_reduction(designs: Designs) -> Judged | None:
    shares = [
        (demands.ripple_reduction(cam.state.torque, torque_after(designs, cam)), required)
        for cam in designs.cams
        if cam.state.torque is not None and (required := cam.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)


def _screened(declared: Declaration) -> Screened | None:
    """Screening of a check; None where there is none."""
    if declared.id == TORQUE_REDUCTION.id:
        return Screened(declared.id, _torque_reduction, 0.001)
    how, measure = declared.measured, declared.measure
    return None if how is None or measure is None else _by_measure(declared, measure, how)


SCREENED = tuple(made for each in CHECKS if (made := _screened(each)) is not None)
"""Checks that screening judges, in the order of the calculation."""

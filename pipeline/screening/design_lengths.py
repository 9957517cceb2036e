"""Pressure along the line of contact of many designs: ends, crown, tilt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import (
    AXIS_PARALLELISM,
    CAM_RUN_OUT,
    END_MEAN_LENGTH,
    ROLLER_CLEARANCE,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.length_history import (
    ContactLoads,
    FactorRange,
    factor_range,
    moment_compliance,
    raised_load,
    worst_of,
)
from camwright.pipeline.cycle.line_tilt import LineTilt, line_tilt
from camwright.pipeline.cycle.numbers import Numbers

# Keys that the contact of finite length depends on, and the number of its different shapes up to
# which each is solved.
_KEYS = (
    *("cam.prime_radius", "cam.width", "roller.radius", "roller.width", "roller.crown.radius"),
    *("cam.crown.radius", "follower.face.depth"),
)
_STRAIGHT = ("cam.width", "roller.width", "follower.face.depth")
_SHAPES = 16


class DesignValues(Protocol):
    """Values of many designs by key, (m, 1); see `Designs`."""

    @property
    def count(self) -> int: ...
    @property
    def columns(self) -> Mapping[str, Array]: ...
    @property
    def machine(self) -> Machine: ...
    def value(self, key: str) -> Array: ...
    @property
    def numbers(self) -> Numbers: ...


def factors_of(
    designs: DesignValues, force: Array, radius: Array, rubbing: tuple[Array, Array], shaft: Array
) -> FactorRange | None:
    """Axial pressure factors (m, n) of the designs; 1 without contact, NaN for no closed contour.

    None where the case lacks an end, or the designs have too many shapes of contact, see
    `has_many_shapes`.

    Parameters
    ----------
    force, radius : array (m, n)   normal force, N; relative radius, m
    rubbing : two arrays (m, n)    normal loads of guides A and B, N
    shaft : array (m, n)           slope of the camshaft at the cam, rad, as of `LineTilt`
    """
    varied, shapes, member = _shapes(designs)
    if not designs.machine.finite_pairs or len(shapes) > _SHAPES:
        return None
    tilt = _tilt(designs, shaft)
    greatest, forced, yields, couple = (
        np.broadcast_to(each, force.shape)
        for each in (tilt.greatest, tilt.forced, _yields(designs), _held_couple(designs, rubbing))
    )
    one, still = np.ones(force.shape), np.zeros(force.shape)
    whole = FactorRange(one, one.copy(), one.copy(), still, np.zeros(force.shape, dtype=bool))
    for number, shape in enumerate(shapes):
        machine = _of_shape(designs.machine, dict(zip(varied, shape[1:].tolist(), strict=True)))
        at = (member == number)[:, None] & (force > 0) & np.isfinite(radius)
        if not at.any():
            continue
        held = couple[at] + force[at] * machine.stem_offset
        raised = raised_load(force[at])
        turned = greatest[at], forced[at], yields[at]
        known = ContactLoads(1.0 / radius[at], force[at], *turned, held, raised)
        mean = machine.limits[END_MEAN_LENGTH]
        worst = worst_of([factor_range(pair, mean, known) for pair in machine.finite_pairs])
        for whole_values, values in zip(whole, worst, strict=True):
            whole_values[at] = values
    return whole


def has_many_shapes(designs: DesignValues) -> bool:
    """Whether plane-strain pressure serves as lower bound along the line of contact.

    It does where the line has ends, but of too many shapes for a table each: without a moment the
    greatest pressure, and that in the middle of a crowned line, are above plane strain.
    """
    return bool(designs.machine.finite_pairs) and len(_shapes(designs)[1]) > _SHAPES


def _shapes(designs: DesignValues) -> tuple[list[str], Array, NDArray[np.intp]]:
    """Keys that vary, shapes of contact by their values after a zero, shape of each design (m,)."""
    keys = _KEYS if designs.machine.is_crowned else _STRAIGHT
    varied = [key for key in keys if key in designs.columns]
    rows = np.concatenate([np.zeros((designs.count, 1)), *(designs.value(k) for k in varied)], 1)
    shapes, member = np.unique(rows, axis=0, return_inverse=True)
    return varied, shapes, member.ravel()


def _of_shape(machine: Machine, values: Mapping[str, float]) -> Machine:
    """The machine with some values of cam, roller and face, by their keys."""
    cam, follower = machine.cam.with_values(values), machine.follower.with_values(values)
    return replace(machine, cam=cam, follower=follower)


def _tilt(designs: DesignValues, shaft: Array) -> LineTilt:
    """Tilt of the line of contact (m, n); see `TurnOfLine.tilt`."""
    machine = designs.machine
    follower, radius = machine.follower, machine.follower.contact_radius
    sizes = designs.value("roller.radius") if radius is not None else 0.0
    ends = 0.0 if follower.end is None else 2.0 * follower.end.size
    width = None if follower.slides else designs.value(follower.width_key) - ends
    return line_tilt(
        shaft,
        parallelism=designs.value(f"limits.{AXIS_PARALLELISM.id}"),
        run_out=designs.value(f"limits.{CAM_RUN_OUT.id}"),
        base_radius=designs.value("cam.prime_radius") - sizes,
        clearance=designs.value(f"limits.{ROLLER_CLEARANCE.id}"),
        bearing_length=width,
        guides=machine.guides.tilt_at(_spacing(designs)),
    )


def _yields(designs: DesignValues) -> Array:
    """Slope of stem and camshaft under the moment of the contact (m, 1), rad/(N m)."""
    overhang = designs.value("follower.overhang_at_max_lift")
    return np.asarray(moment_compliance(designs.machine, overhang, _spacing(designs)))


def _held_couple(designs: DesignValues, rubbing: tuple[Array, Array]) -> Array:
    """Couple (m, n), N m, that friction of the guides can hold."""
    load_a, load_b = rubbing
    on_a, on_b = (designs.numbers[f"guides.{side}.friction_greatest"] for side in "ab")
    held = np.minimum(on_a * load_a, on_b * load_b)
    return np.asarray(held * _spacing(designs))


def _spacing(designs: DesignValues) -> Array:
    return designs.value("guides.spacing")

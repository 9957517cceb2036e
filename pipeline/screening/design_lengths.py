"""Pressure along the line of contact of many designs: ends, crown, tilt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.pipeline.case.limits import (
    AXIS_PARALLELISM,
    CAM_RUN_OUT,
    END_MEAN_LENGTH,
    ROLLER_CLEARANCE,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.finite_length.factor_table import GREATEST_MOMENT
from camwright.pipeline.cycle.length_history import (
    ContactLoads,
    factor_range,
    lines_pressed,
    raised_load,
    worst_of,
)
from camwright.pipeline.cycle.line_tilt import (
    LineTilt,
    follower_moment,
    line_tilt,
    rigid_moment,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.follower_tilt import (
    FollowerTilt,
    TiltingLoads,
    couple_of_second,
)

# Keys that the contact of finite length depends on, and the number of its different shapes up to
# which each is solved.
_KEYS = (
    *("cam.prime_radius", "cam.width", "roller.radius", "roller.width", "roller.crown.radius"),
    *("cam.crown.radius", "follower.face.depth", "follower.face.radius"),
)
_STRAIGHT = ("cam.width", "roller.width", "follower.face.depth")
_SHAPES = 16
# Cam angles at which the factors are solved first, and share of the greatest pressure within which
# others are; angles on either side of them that the vertex of the greatest one reads.
_FIRST_ANGLES, _NEAR_GREATEST, _BESIDE_GREATEST = 24, 0.02, 2
# Moment over the width of the contact that counts as force on supports and seat of a pin; share of
# its greatest load there within which others are solved.
_ON_PIN, _NEAR_ON_PIN = (2.0, 6.0), 0.05


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
    @property
    def stem_offset(self) -> Array: ...
    @property
    def tilting(self) -> FollowerTilt: ...


class LineFactors(NamedTuple):
    """Axial pressure factors (m, n) in the middle of the line, and the greatest along it.

    arm: greatest distance of the resultant force from the middle of the line, m
    """

    centre: Array
    greatest: Array
    arm: Array


class FollowerTurning(NamedTuple):
    """What turns the followers of designs across the plane of the cam, arrays (m, n).

    shaft: slope of the camshaft at the cam, rad, as of `LineTilt`; shaft_compliance: of it per
    moment there, rad/(N m); base_radius: of the base circle of the disc, m; held: couple that the
    follower holds without a tilt, N m; twist: of an arm under a contact beside its middle, or of a
    stem by `beside`, rad; beside: couple of a second roller on the pin about the first, N m
    """

    shaft: Array
    shaft_compliance: Value
    base_radius: Value
    held: Array
    twist: Array
    beside: Array


def turning_of(
    designs: DesignValues,
    shaft: Array,
    shaft_compliance: Value,
    base_radius: Value,
    force: Array,
    rubbing: tuple[Array, Array],
    pivot: Array,
    beyond: Value,
) -> FollowerTurning:
    """What turns the followers of designs.

    Parameters
    ----------
    shaft : array (m, n)                 slope of the camshaft at the cam, rad
    shaft_compliance : float or (m, n)   of it per moment there, rad/(N m)
    base_radius : float or (m, n)        of the base circle of the disc, m
    force, pivot : array (m, n)          normal force, and load of an arm on its pivot, N
    rubbing : two arrays (m, n)          normal loads of guides A and B, N
    beyond : float or (m, n)             distance of the roller that carries from the first on a
                                         pin, m
    """
    on_a, on_b = (designs.numbers[f"guides.{side}.friction_greatest"] for side in "ab")
    loads = TiltingLoads(force, rubbing, (on_a, on_b), pivot, _spacing(designs))
    follower = designs.tilting
    on_arm = designs.machine.arm is not None
    twist = follower.turned(loads, designs.stem_offset + (beyond if on_arm else 0.0))
    beside = couple_of_second(force, beyond)
    held = follower.held(loads)
    turning = FollowerTurning(shaft, shaft_compliance, base_radius, held, twist, beside)
    if on_arm:
        return turning
    return turning._replace(twist=twist + turning.beside * _tilt_compliance(designs, turning))


def factors_of(
    designs: DesignValues,
    plane: Array,
    force: Array,
    radius: Array,
    turning: FollowerTurning,
) -> LineFactors | None:
    """Axial pressure factors of the designs; 1 without contact, NaN for no closed contour.

    None where the case lacks an end, or the designs have more shapes of contact than are solved,
    see `has_many_shapes`. With a crown each angle is solved. Without one, solved are some angles
    first and those near the greatest pressure, moment and load of the pin, which alone count over
    the turn; the others are interpolated linearly.

    Parameters
    ----------
    plane : array (m, n)           contact pressure of plane strain, Pa
    force, radius : array (m, n)   normal force, N; relative radius, m
    turning : FollowerTurning
    """
    varied, shapes, member = _shapes(designs)
    if not designs.machine.finite_pairs or len(shapes) > _SHAPES:
        return None
    tilt = _tilt(designs, turning)
    greatest, forced, compliance, couple = (
        np.broadcast_to(each, force.shape)
        for each in (tilt.greatest, tilt.forced, _tilt_compliance(designs, turning), turning.held)
    )
    whole = LineFactors(np.ones(force.shape), np.ones(force.shape), np.zeros(force.shape))
    contact = lines_pressed(designs.machine, force, radius)
    raised, aside = np.ones(force.shape), force * designs.stem_offset
    if contact.any():
        raised[contact] = raised_load(force[contact])

    def solve(chosen: NDArray[np.bool_]) -> None:
        """Fill in the factors at the chosen designs and angles (m, n), one shape of contact after
        another.
        """
        for number, shape in enumerate(shapes):
            machine = _of_shape(designs.machine, dict(zip(varied, shape[1:].tolist(), strict=True)))
            at = (member == number)[:, None] & chosen
            if not at.any():
                continue
            held = couple[at] + aside[at] + turning.beside[at]
            turned = greatest[at], forced[at], compliance[at]
            loads = ContactLoads(1.0 / radius[at], force[at], *turned, held, raised[at])
            mean = machine.limits[END_MEAN_LENGTH]
            worst = worst_of([factor_range(pair, mean, loads) for pair in machine.finite_pairs])
            whole.centre[at] = worst.centre
            whole.greatest[at] = np.maximum(worst.level, worst.tilted)
            whole.arm[at] = worst.moment / force[at]

    if designs.machine.is_crowned:
        solve(contact)
        return whole
    first = np.zeros(force.shape, dtype=bool)
    first[:, :: max(1, force.shape[1] // _FIRST_ANGLES)] = True
    solve(first & contact)
    near = np.zeros(force.shape, dtype=bool)
    for values, load in ((whole.greatest, plane), (whole.arm, force)):
        between, bound = _between(values, first, contact)
        values[...] = between
        of_contact = np.where(contact, load, 0.0)
        known = np.max(np.where(first, of_contact * between, 0.0), axis=1, keepdims=True)
        near |= (known > 0.0) & (of_contact * bound >= (1.0 - _NEAR_GREATEST) * known)
    moment = follower_moment(np.where(contact, force * whole.arm, 0.0), forced, couple, aside)
    for share in _ON_PIN if designs.machine.describes("pin") else ():
        load = np.where(contact, force + share * moment / designs.numbers["contact.width"], 0.0)
        near |= load >= (1.0 - _NEAR_ON_PIN) * load.max(axis=1, keepdims=True)
    steps = range(-_BESIDE_GREATEST, _BESIDE_GREATEST + 1)
    near = np.any([np.roll(near, step, axis=1) for step in steps], axis=0)
    solve(near & contact & ~first)
    return whole


def _between(
    factors: Array, first: NDArray[np.bool_], contact: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Factors (m, n), linear between those at the first angles, and upper bounds (m, n) for where
    to solve again: the greater of both neighbours; beside an angle without contact the greatest of
    the design.

    first : (m, n), angles solved, the same in each design; contact : (m, n), where there is
    contact.
    """
    columns, count = np.flatnonzero(first[0]), factors.shape[1]
    at = np.arange(count)
    left = np.searchsorted(columns, at, side="right") - 1
    right = (left + 1) % columns.size
    share = (at - columns[left]) / ((columns[right] - columns[left] - 1) % count + 1)
    before, after = factors[:, columns[left]], factors[:, columns[right]]
    both = contact[:, columns[left]] & contact[:, columns[right]]
    most = factors[:, columns].max(axis=1, keepdims=True)
    bound = np.where(both, np.maximum(before, after), most)
    return before + share * (after - before), bound


def moment_on_follower(
    designs: DesignValues,
    force: Array,
    turning: FollowerTurning,
    factors: LineFactors | None,
) -> Array:
    """Moment (m, n) of the contact about the middle of the follower, N m; see `factors_of`.

    factors : LineFactors   None: the case lacks an end; an upper bound
    """
    forced, held = _tilt(designs, turning).forced, turning.held
    if factors is None:
        most = GREATEST_MOMENT * force * designs.numbers["contact.width"]
        line = rigid_moment(forced, _tilt_compliance(designs, turning), held, most)
    else:
        line = np.maximum(force, 0.0) * factors.arm
    return follower_moment(line, forced, held, force * designs.stem_offset)


def forced_part(designs: DesignValues, turning: FollowerTurning, moment: Array) -> Array:
    """Part (m, n) of the moment about the follower that bends the stem, N m."""
    return np.where(_tilt(designs, turning).forced > 0.0, moment, 0.0)


def has_many_shapes(designs: DesignValues) -> bool:
    """Whether plane-strain pressure serves as lower bound along the line of contact.

    It does where the line has ends, but of too many shapes for a table each: without a moment the
    greatest pressure, and that in the middle of a crowned line, are above plane strain.
    """
    return bool(designs.machine.finite_pairs) and len(_shapes(designs)[1]) > _SHAPES


def _shapes(designs: DesignValues) -> tuple[list[str], Array, NDArray[np.intp]]:
    """Different shapes of contact: keys that vary among the designs (k); one row (s, 1 + k) per
    shape, a zero and the values of the keys, SI; number of the row of each design (m,).
    """
    keys = _KEYS if designs.machine.is_crowned else _STRAIGHT
    varied = [key for key in keys if key in designs.columns]
    rows = np.concatenate([np.zeros((designs.count, 1)), *(designs.value(k) for k in varied)], 1)
    shapes, member = np.unique(rows, axis=0, return_inverse=True)
    return varied, shapes, member.ravel()


def _of_shape(machine: Machine, values: Mapping[str, float]) -> Machine:
    """The machine with some values of cam, roller and face, by their keys."""
    cam, follower = machine.cam.with_values(values), machine.follower.with_values(values)
    return replace(machine, cam=cam, follower=follower)


def _tilt(designs: DesignValues, turning: FollowerTurning) -> LineTilt:
    """Tilt of the line of contact (m, n), rad; see `TurnOfLine.tilt`."""
    machine = designs.machine
    follower = machine.follower
    ends = 0.0 if follower.end is None else 2.0 * follower.end.size
    width = None if follower.slides else designs.value(follower.width_key) - ends
    return line_tilt(
        turning.shaft,
        parallelism=designs.value(f"limits.{AXIS_PARALLELISM.id}"),
        run_out=designs.value(f"limits.{CAM_RUN_OUT.id}"),
        base_radius=turning.base_radius,
        clearance=designs.value(f"limits.{ROLLER_CLEARANCE.id}"),
        bearing_length=width,
        guides=designs.tilting.within(_spacing(designs)),
        twist=turning.twist,
        words=designs.tilting.words,
    )


def _tilt_compliance(designs: DesignValues, turning: FollowerTurning) -> Array:
    """Slope of stem and camshaft under the moment of the contact (m, 1) or (m, n), rad/(N m)."""
    overhang = designs.value("follower.overhang_at_max_lift")
    return np.asarray(
        designs.tilting.compliance(overhang, _spacing(designs)) + turning.shaft_compliance
    )


def _spacing(designs: DesignValues) -> Array:
    return designs.value("guides.spacing")

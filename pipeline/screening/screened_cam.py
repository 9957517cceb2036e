"""Loaded cams of many designs: guides by tables, contact ends by factors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.follower_path import Motion
from camwright.geometry.second_track import SecondMotion
from camwright.pipeline.contact.conforming_line import concave_line
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.flash_temperature import bulk_rise
from camwright.pipeline.contact.hertz import half_width_square, peak_pressure_square
from camwright.pipeline.contact.oil_film import LineFilm, lambda_ratio, minimum_film
from camwright.pipeline.contact.traction import Drag, rolling_slip
from camwright.pipeline.cycle.contact_heat import flash_rise
from camwright.pipeline.cycle.loaded_cam import CarriedCam, OfGuides, carried, face_of, roller_of
from camwright.pipeline.cycle.part_loads import BushLoad, beside_middle
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import (
    JAM_FLOOR,
    REST,
    LoadEnds,
    PressedGuides,
    SideLoads,
    driving,
    ends_of,
    share_left,
    wall_of,
)
from camwright.pipeline.follower.friction_coupling import balanced
from camwright.pipeline.follower.guide_table import GuideLoads, SupportOfMany, loads_under_couple
from camwright.pipeline.follower.pivot_forces import ArmPivot, PivotBalance, Pressed, Pull
from camwright.pipeline.screening.design_lengths import (
    DesignValues,
    FollowerTurning,
    LineFactors,
    factors_of,
    forced_part,
    has_many_shapes,
    moment_on_follower,
    turning_of,
)


class ScreenedState(NamedTuple):
    """A load case of many designs: crank speed, rad/s, and preload, N, (m, 1).

    torque (m or 1, k): of the engine less its mean, crank N m, at cam angles that can be closer
    than those of the loads, see `Designs`; None without one. required: reduction of its
    ripple, (m,) or (); None: none is required. duty: share of the operating time; None: not known.
    steady: whether it is a load case of the case, in which parts warm up; power: mean power of the
    machine (m or 1, 1), W, NaN where it is not known; None: it is not fired.
    """

    speed: Array
    preload: Array
    torque: Array | None
    required: Array | None
    duty: float | None
    steady: bool = False
    power: Array | None = None


class PressedStem(NamedTuple):
    """Stem whose rollers are preloaded in its guides (m, n): axial force, N, side loads of both
    rollers, the guides under them, their rubbing loads over the sum of both forces, and the jam
    index of the track that drives.
    """

    axial: Array
    loads: SideLoads
    supports: SupportOfMany
    rubbing: OfGuides
    driving_jam: Array


class Block(DesignValues, Protocol):
    """Quantities common to the load cases of many designs; see `Designs`."""

    @property
    def motion(self) -> Motion: ...
    @property
    def stroke(self) -> Array: ...
    @property
    def supports(self) -> SupportOfMany: ...
    @property
    def relative_radius(self) -> Array: ...
    def relative_radius_of(self, motion: Motion) -> Array: ...
    @property
    def second(self) -> SecondMotion | None: ...
    @property
    def squeeze(self) -> Squeezed | None: ...
    def both_tracks(self, first: Motion) -> tuple[Motion, Motion]: ...
    def supports_of(self, motion: Motion, reach: Value) -> SupportOfMany: ...
    def supports_under(self, side: Array, arm: Array, reach: Value) -> SupportOfMany: ...
    @property
    def least_radius(self) -> Array: ...
    def thrown(self, speed: Value) -> tuple[tuple[Array, ...], Array]: ...


@dataclass(frozen=True, eq=False, kw_only=True)
class ScreenedCam(CarriedCam):
    """Loaded cams of many designs in a load case; arrays (m, n).

    The loads are clipped as `Loads`: no axial force where the follower has left the cam, and a
    finite one where it locks.
    """

    block: Block
    state: ScreenedState
    crank_speed: Array
    figures: dict[tuple[object, ...], Array] = field(default_factory=dict, repr=False)

    @property
    def first(self) -> Motion:
        return self.block.motion

    @property
    def second(self) -> SecondMotion | None:
        return self.block.second

    @property
    def squeeze(self) -> Squeezed | None:
        return self.block.squeeze

    @cached_property
    def supports(self) -> SupportOfMany:
        """Guides of the stem under the roller or face that carries."""
        if self.block.second is None:
            return self.block.supports
        if self._pressed is not None:
            return self._pressed.supports
        return self.block.supports_of(self.motion, self.reach)

    @cached_property
    def _pressed(self) -> PressedStem | None:
        """Stem in its guides under a preload of both rollers; None of other followers."""
        if isinstance(self.facing, ScreenedCam):
            return self.facing._pressed
        return self._pressed_at(self._friction("friction"))

    @cached_property
    def _pressed_worst(self) -> PressedStem | None:
        """`_pressed` at maximum friction."""
        return self._pressed_at(self._friction("friction_greatest"))

    def _friction(self, name: str) -> OfGuides:
        """Coefficients of friction of both guides by their key."""
        return OfGuides(*(np.asarray(self.numbers[f"guides.{side}.{name}"]) for side in "ab"))

    def _pressed_at(self, friction: OfGuides) -> PressedStem | None:
        """`_pressed` at coefficients of friction; NaN where the axial force does not settle.

        As in `_settled` the rubbing loads are those of the table at the force before.
        """
        block, second = self.block, self.block.second
        squeeze = block.squeeze if self.pulls else None
        if squeeze is None or second is None or not np.any(second.reach):
            return None
        first, other = block.both_tracks(block.motion)
        sides, reach = (first.side, other.side), np.asarray(second.reach)
        direction, required = np.sign(self.slope), np.asarray(self.required)
        axial, settled = required.copy(), np.zeros(required.shape, dtype=bool)
        for _ in range(_FRICTION_ROUNDS):
            loads = SideLoads.of(sides, reach, squeeze.forces(axial))
            far = np.divide(loads.far, loads.size, out=0.0 * loads.size, where=loads.size > 0.0)
            side = loads.side / loads.force
            supports = block.supports_under(side, np.zeros_like(side), reach * far)
            on_a, on_b = supports.rubbing(loads.force)
            rubs = friction.a * on_a + friction.b * on_b
            jams = rubs * np.abs(first.side), rubs * np.abs(other.side)
            if settled.all():
                break
            now = PressedGuides(squeeze, jams)(required, direction)
            change = np.where(settled, 0.0, now - axial)
            axial = axial + change
            settled |= np.abs(change) <= _FRICTION_SETTLED * loads.force
        factor = np.where(settled, supports.factor, np.nan)
        rubbing = OfGuides(on_a * factor, on_b * factor)
        return PressedStem(axial, loads, supports, rubbing, driving(jams, direction))

    @cached_property
    def wall(self) -> Array:
        pressed = self._pressed
        if pressed is None or self.facing is not None:
            return super().wall
        return wall_of(pressed.axial, held=True)

    @cached_property
    def relative_radius(self) -> Array:
        """Relative radius R (m, n), m, on the track that carries; NaN if one is undercut."""
        if not self.pulls:
            return self.block.relative_radius
        return self.block.relative_radius_of(self.motion)

    @property
    def least_radius(self) -> Array:
        return self.block.least_radius

    @cached_property
    def slope(self) -> Array:
        """Slope of the lift, m/rad; zero in a dwell."""
        slope = self.jet.slope
        return np.where(np.abs(slope) > REST * self.block.stroke, slope, 0.0)

    @property
    def spin_mean(self) -> Array:
        """Mean speed of the roller over the turn (m, 1), rad/s."""
        return np.mean(self.turning, axis=-1, keepdims=True)

    @cached_property
    def turning(self) -> Array:
        force = self.required if self.pivot is None else self.axial
        return self._turning_by(force, lambda wall: carried(self.first, self.second, wall))

    @cached_property
    def _free(self) -> Array:
        """Axial force without guide friction towards the track that carries, >= 0, N."""
        return np.asarray(np.maximum(self.required * self.wall, 0.0))

    @cached_property
    def share(self) -> Array:
        return share_left(self.direction, self.jam, self.motion.lock)

    @cached_property
    def axial(self) -> Array:
        if self.facing is not None:
            return self.facing.axial
        if self._pressed is not None:
            return self._pressed.axial
        if self.pivoted is not None:
            return self.pivoted.axial
        return self._free * self.wall / self.share

    @property
    def stem_force(self) -> Array:
        """Force on the stem towards the track that carries (m, n), N, of a preload that of both."""
        return self.axial * self.wall if self._pressed is None else self._pressed.loads.force

    def _balanced(self, pivot: ArmPivot, required: Array, pull: Pull) -> PivotBalance:
        if self.pulls:
            return super()._balanced(pivot, required, pull)
        return pivot.clipped(required, Pressed.of(self.motion), pull, self.direction, JAM_FLOOR)

    @cached_property
    def rubbing_share(self) -> OfGuides:
        if self._pressed is not None:
            return self._pressed.rubbing
        return self._settled(self._friction("friction"))

    @cached_property
    def jam_worst(self) -> Array:
        """Jam index (m, n) at the greatest friction of guides or pivot, -."""
        if self.pivoted_worst is not None:
            return self.pivoted_worst.jam_index
        most, pressed = self._friction("friction_greatest"), self._pressed_worst
        rubbing = self._settled(most) if pressed is None else pressed.rubbing
        return most.a * rubbing.a + most.b * rubbing.b

    @cached_property
    def hot(self) -> OfGuides | None:
        pressed, greatest = self._pressed_worst, self._friction("friction_greatest")
        if pressed is None:
            forces = super().hot
        else:
            pairs = zip(greatest, pressed.rubbing, strict=True)
            forces = OfGuides(*(most * share * pressed.loads.force for most, share in pairs))
        if forces is None or (across := self._across) is None:
            return forces
        on_a, on_b = greatest.a * across.rubbing_a, greatest.b * across.rubbing_b
        return OfGuides(np.hypot(forces.a, on_a), np.hypot(forces.b, on_b))

    def _settled(self, friction: OfGuides) -> OfGuides:
        """Summed normal loads of guides A and B over the axial force, of m designs at n cam angles
        (m, n), with the friction of the guides.

        The axial force is that without friction over the share that the friction leaves of it, and
        the load ratios are those of the table at that force. They change little with it, so that a
        few rounds do, but for some near the lock.

        Parameters
        ----------
        friction : OfGuides   friction coefficients of guides A and B, each broadcast to (m, n)
        """
        supports, shape = self.supports, self._free.shape
        load = np.broadcast_to(supports.load, shape).ravel()
        rubs = tuple(
            np.broadcast_to(one * share * supports.factor, shape).ravel()
            for one, share in zip(friction, supports.shares, strict=True)
        )
        free = self._free.ravel()
        direction = np.broadcast_to(self.direction, shape).ravel()

        rubbed = np.flatnonzero((free * load > 0.0) & (direction != 0.0))

        def following(axial: Array, of: NDArray[np.intp]) -> Array:
            """Axial force with the friction at an axial force, N, at places of `rubbed`."""
            at = rubbed[of]
            ratios = supports.table.rubbing(axial * load[at], supports.place.of(at))
            jam = ratios[0] * rubs[0][at] + ratios[1] * rubs[1][at]
            return np.asarray(free[at] / share_left(direction[at], jam))

        least, outward, axial = free[rubbed], direction[rubbed] > 0.0, free.copy()
        axial[rubbed], _ = balanced(
            following,
            np.where(outward, least, 0.0),
            np.where(outward, least / JAM_FLOOR, least),
            least,
            _FRICTION_SETTLED * least,
        )
        on_a, on_b = supports.rubbing(axial.reshape(shape))
        return OfGuides(on_a * supports.factor, on_b * supports.factor)

    @cached_property
    def guides(self) -> GuideLoads:
        """Loads of the guides by their tables, N."""
        return self.supports.loads(self.stem_force)

    @cached_property
    def _across(self) -> GuideLoads | None:
        """Loads of the guides (m, n), N, across the cam's plane, under the couple of the line of
        contact and of a second roller on the stem; None without one.
        """
        block = self.block
        couple = forced_part(block, self._turning, self.follower_moment) + self._turning.beside
        couple = couple * np.cos(self.motion.pressure_angle)
        if not couple.any():
            return None
        spacing = np.broadcast_to(self.numbers["guides.spacing"], couple.shape)
        return loads_under_couple(block.machine.stem, block.machine.guides, couple, spacing)

    @property
    def _in_plane(self) -> OfGuides:
        """Pushes on both sides of guides A and B (m, n), N, in the cam's plane."""
        return OfGuides(self.guides.rubbing_a, self.guides.rubbing_b)

    @cached_property
    def rubbing(self) -> OfGuides:
        plane, across = self._in_plane, self._across
        if across is None:
            return plane
        return OfGuides(np.hypot(plane.a, across.rubbing_a), np.hypot(plane.b, across.rubbing_b))

    @cached_property
    def jam_tilted(self) -> Array:
        return self.friction_over(self._in_plane)

    @cached_property
    def bearing(self) -> OfGuides:
        """With the couple of the line of contact on the stem."""
        guides, across = self.guides, self._across
        if across is None:
            return OfGuides(guides.bearing_a, guides.bearing_b)
        return OfGuides(
            np.hypot(guides.bearing_a, across.bearing_a),
            np.hypot(guides.bearing_b, across.bearing_b),
        )

    @cached_property
    def follower_moment(self) -> Array:
        """With too many shapes of contact that of a level line, see `has_many_shapes`."""
        if has_many_shapes(self.block):
            return super().follower_moment
        return moment_on_follower(self.block, self.normal, self._turning, self._factors)

    @cached_property
    def bush_load(self) -> BushLoad | None:
        """Load of the bush of a pivot (m, n); None without one."""
        numbers, held = self.numbers, self.pivoted
        case = numbers.known_case
        pivot, pair = case.follower.pivot, case.cam.conjugate
        if held is None or pivot is None or pivot.bush is None:
            return None
        offset = numbers["follower.arm.plane_offset"]
        spacing = None if pair is None else numbers["cam.conjugate.spacing"]
        beside = beside_middle(offset, spacing, [self.normal] if pair is None else self.forces)
        couple = self.follower_moment + beside + self._turning.beside
        bush = numbers.of_part(pivot.bush, "follower.pivot.bush")
        normal = self.motion.pressure_angle - self.turned
        load = np.stack([held.along + 0.0 * couple, held.across + 0.0 * couple])
        return BushLoad.under(bush, load, np.asarray(normal), couple)

    @cached_property
    def bush_rubbing(self) -> Value:
        return 1.0 if self.bush_load is None else self._over_load(self.bush_load.rubbing)

    @cached_property
    def bush_bearing(self) -> Value:
        return 1.0 if self.bush_load is None else self._over_load(self.bush_load.bearing)

    def _over_load(self, push: Array) -> Array:
        """Push on the bush of a pivot over its load (m, n); 1 without load."""
        load = self.pivot_load
        return np.divide(push, load, out=np.ones_like(push), where=load != 0.0)

    @cached_property
    def _turning(self) -> FollowerTurning:
        pivot = np.zeros(self.normal.shape) if self.pivoted is None else self.pivot_load
        return turning_of(
            *(self.block, self.shaft_tilt, self.shaft_compliance, self.base_radius),
            *(self.normal, self._in_plane, pivot, np.abs(self.beyond)),
        )

    @cached_property
    def ends(self) -> LoadEnds:
        """First angles at which followers leave the cam or lock; see `Loads.ends`."""
        pressed = self._pressed
        driven = self.direction * self.jam if pressed is None else pressed.driving_jam
        index = driven + self.motion.lock
        return ends_of((self.normal <= 0.0) & (not self.pulls), index >= 1.0)

    @cached_property
    def friction_power(self) -> Array:
        """Mean friction power (m, 1), W; the micro-slip of a roller left out."""
        return np.asarray(np.mean(self.friction_work, axis=-1, keepdims=True) * self.speed)

    @cached_property
    def friction_loss(self) -> Array:
        """Friction loss of guides and face over a cam turn (m,), J."""
        rubbed = self.jam * self.stem_force if self.pivoted is None else self.pivoted.friction
        work = rubbed * np.abs(self.slope) + self.axial * self.motion.sliding
        work = work + self.motion.lock * self.axial * self.slope
        return FULL_TURN * np.mean(work + self.viscous * self.slope, axis=-1)

    @cached_property
    def p0_line(self) -> Array:
        """Contact pressure of plane strain, Pa, of a conforming contact on a concave wall; NaN
        where the contour bounds no body.
        """
        load = np.asarray(self.normal / self.numbers["contact.width"])
        modulus, radius = self.numbers["contact.modulus"], self.relative_radius
        pressure = np.sqrt(peak_pressure_square(load, 1.0 / radius, modulus))
        closed, machine = np.isfinite(radius), self.block.machine
        if machine.follower.slides or not (self.pulls and closed.any()):
            return pressure
        roller = np.broadcast_to(self.contact_radius, load.shape)
        cards = machine.follower.material, machine.cam.material
        bodies = (Elastic(card.E, card.nu) for card in cards)
        full, line = concave_line(load[closed], radius[closed], roller[closed], *bodies)
        if line is not None:
            solved = pressure[closed]
            solved[full] = line.p0
            pressure[closed] = solved
        return pressure

    @cached_property
    def _factors(self) -> LineFactors | None:
        loads = self.normal, self.relative_radius, self._turning
        return factors_of(self.block, self.p0_line, *loads)

    @property
    def thrown(self) -> tuple[tuple[Array, ...], Array]:
        return self.block.thrown(self.speed)

    @cached_property
    def p0(self) -> Array:
        """Contact pressure in the middle of the line, Pa.

        With too many shapes of contact that of plane strain, see `has_many_shapes`.
        """
        if not self.block.machine.is_crowned:
            return self.p0_line
        return self._unsolved if self._factors is None else self.p0_line * self._factors.centre

    @cached_property
    def p0_signed(self) -> Array:
        """Contact pressure with ends and tilt, Pa; NaN where the case lacks an end."""
        factors = self._factors
        if factors is None:
            return self._unsolved
        return self.p0_line * factors.greatest

    @cached_property
    def flash(self) -> Array | None:
        """Flash temperature rise of a flat face (m, n), K; NaN where the contour bounds no body.

        None without friction or thermal data.
        """
        machine, motion = self.block.machine, face_of(self.motion)
        if self.numbers.get("follower.face.friction") is None:
            return None
        force = np.maximum(self.normal, 0.0)
        sliding = np.broadcast_to(self.speed * motion.slip, force.shape)
        friction = self.numbers["follower.face.friction"]
        heat = friction * force * sliding / self.numbers["contact.width"]
        half = np.where((heat > 0) & ~np.isnan(self.half_width), self.half_width, 1.0)
        rise = flash_rise(machine, heat, sliding, self.speed * motion.along_face, half)
        lost = np.isnan(self.relative_radius)
        return None if rise is None else np.where(lost, np.nan, rise)

    @property
    def film_ratio(self) -> Array:
        """Film under a flat face over roughness (m, n), at the bulk temperature by `flash`.

        0 where a roughness or the oil is not known, NaN without contact.
        """
        machine, motion = self.block.machine, face_of(self.motion)
        oil, rough = machine.lubricant, machine.cam.roughness
        other, rise = machine.follower.roughness, self.flash
        ratio = np.zeros(self.normal.shape)
        if oil is None or rough is None or other is None or rise is None:
            return ratio
        load = np.maximum(self.normal, 0.0) / self.numbers["contact.width"]
        passing = self.speed * (0.5 * motion.slip + motion.along_face)
        for k, radius in enumerate(self.relative_radius):
            ratio[k] = np.nan
            if np.isfinite(radius).all():
                groups = LineFilm.of(
                    load[k],
                    radius,
                    machine.contact_modulus,
                    passing[k],
                    oil.warmer(float(bulk_rise(rise[k]))),
                )
                ratio[k] = lambda_ratio(minimum_film(groups), rough, other)
        return ratio

    @property
    def half_width(self) -> Array:
        load = np.maximum(self.normal, 0.0) / self.numbers["contact.width"]
        modulus = self.numbers["contact.modulus"]
        return np.sqrt(half_width_square(load, self.relative_radius, modulus))

    @cached_property
    def roller_slip(self) -> Array:
        """Greatest slip of a roller that carries (m,), m/s; NaN where it is not known."""
        drag, shape, greatest = self.drag, self.normal.shape, list[list[float]]()
        if drag is None or self.numbers.known_case.facing.friction is None:
            return np.full(shape[0], np.nan)
        for track, force, carries in self._rollers:
            size = roller_of(track).size
            rate = self.speed**2 * roller_of(track).slide_slope / size
            parts = force, self.speed * track.rolling, rate, np.abs(size), self.speed
            rows = (np.broadcast_to(each, shape) for each in (*parts, self.rotor_inertia))
            slips = [_slip_of(drag, *row) for row in zip(*rows, strict=True)]
            greatest.append([float(np.max(np.abs(each), where=at, initial=0.0))
                             for each, at in zip(slips, carries, strict=True)])  # fmt: skip
        return np.max(greatest, axis=0)

    @property
    def forces(self) -> Sequence[Array]:
        """Normal force (m, n) on each roller of its own, N."""
        return [force for _, force, _ in self._rollers]

    @cached_property
    def _rollers(self) -> Sequence[tuple[Motion, Array, NDArray[np.bool_]]]:
        """Motion, normal force, N, and where it carries, of each roller of a cam that pulls; both
        of preloaded discs do.
        """
        every = np.ones(self.normal.shape, dtype=bool)
        if self.block.second is None:
            return [(self.motion, self.normal, every)]
        tracks, on = self.block.both_tracks(self.block.motion), (self.wall > 0.0, self.wall < 0.0)
        squeeze = self.block.squeeze
        if squeeze is None:
            forces = [np.where(at, self.normal, 0.0) for at in on]
        else:
            along, on = squeeze.forces(self.axial), (every, every)
            forces = [one * track.gain for one, track in zip(along, tracks, strict=True)]
        return list(zip(tracks, forces, on, strict=True))

    @property
    def _unsolved(self) -> Array:
        """Pressure along a line that is not solved: its lower bound, or NaN."""
        return self.p0_line if has_many_shapes(self.block) else np.full_like(self.p0_line, np.nan)


def _slip_of(
    drag: Drag,
    force: Array,
    spin: Array,
    rate: Array,
    radius: Array,
    speed: Array,
    inertia: Array,
) -> Array:
    """Slip of a roller over a turn (n,), m/s, NaN where force or spin are not known, by values
    (n,); speed of the cam and inertia are those of every angle.
    """
    if not np.isfinite([force, spin, rate]).all():
        return np.full(force.shape, np.nan)
    own, period = replace(drag, inertia=float(inertia[0])), FULL_TURN / float(speed[0])
    return rolling_slip(force, spin, rate, drag=own, radius=float(radius.max()), period=period)[2]


_FRICTION_ROUNDS, _FRICTION_SETTLED = 30, 1e-6  # of the guide friction

"""Lift, contour, loads and contact of many designs, arrays (designs, cam angles)."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.periodic_spline import knot_derivatives, knot_integrals
from camwright.pipeline.base.external_force import ExternalForce
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import WoundSprings, wound_spring
from camwright.pipeline.case.limits import OVERSPEED, TORQUE_REDUCTION, AnyLimit
from camwright.pipeline.case.load_case_torque import engine_torque
from camwright.pipeline.case.machine import CREEP, Machine, machine
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.checks import demands
from camwright.pipeline.contact.hertz import peak_pressure_square
from camwright.pipeline.follower.follower_forces import (
    REST,
    FollowerMotion,
    Loads,
    Push,
    loads_of,
    share_left,
)
from camwright.pipeline.follower.guide_friction import friction_limits
from camwright.pipeline.follower.guide_table import GuideLoads, SupportOfMany
from camwright.pipeline.follower.spring import spring_force, stored_lift
from camwright.pipeline.follower.spring_kinds import SpringShape
from camwright.pipeline.screening.cam_shapes import (
    CamShape,
    Columns,
    FaceShape,
    RollerShape,
    Values,
)
from camwright.pipeline.screening.design_lengths import factors_of, has_many_shapes

Judged = tuple[Array, Array | float | None]
"""Demand (m,) and limit (m,) of a check, SI; NaN and None are missing."""


@dataclass(frozen=True, eq=False)
class FollowerOfDesigns:
    """Mass, spring and guides of many designs, each (m, 1).

    rubbing: loads of guides A and B over axial force and side-load factor, (m, n); None: of point
    supports.
    """

    mass: Array
    preload: Array
    rate: Array
    guide_spacing: Array
    overhang_at_max_lift: Array
    friction_a: Array
    friction_b: Array
    viscous_damping: Array
    gravity_along_axis: float
    external: ExternalForce
    shape: SpringShape | None
    face_friction: Array
    rubbing: tuple[Array, Array] | None = None

    def spring_force(self, lift: Array) -> Array:
        """Force (m, n) of the springs at a lift (m, n), N."""
        return spring_force(self.preload, self.rate, lift, self.shape)

    def applied_force(self, theta: Array) -> Array:
        """Weight and external force (m, n) at cam angles (n,), N."""
        return np.asarray(self.mass * self.gravity_along_axis + self.external.at(theta))

    @property
    def closing_preload(self) -> Array:
        """Preload, weight and mean external force (m, 1), N."""
        return self.preload + (self.mass * self.gravity_along_axis + self.external.mean)

    def rubbing_factors(self, push: Push, overhang: Array, theta: Array) -> tuple[Array, Array]:  # noqa: ARG002
        """Rubbing load of guides A and B over axial force and side-load factor."""
        return push.rubbing_on_points(overhang) if self.rubbing is None else self.rubbing


class State(NamedTuple):
    """A load case of many designs: crank speed, rad/s, and preload, N, (m, 1).

    torque (m or 1, n): of the engine less its mean, crank N m, at the cam angles of the loads; None
    without one. required: reduction of its ripple, (m,) or (); None: none is required. duty:
    share of the operating time; None: not known.
    """

    speed: Array
    preload: Array
    torque: Array | None
    required: Array | None
    duty: float | None


@dataclass(frozen=True, eq=False)
class Turns:
    """Loads of a load case of many designs, arrays (m, 1) and (m, n).

    guides: their loads, N; jam_index_max: at the maximum friction on the rise; p0_line: of plane
    strain; p0: in the middle of a crowned line; p0_signed: with ends and tilt, NaN where they are
    not known.
    """

    state: State
    crank_speed: Array
    cam_speed: Array
    loads: Loads
    guides: GuideLoads
    jam_index_max: Array
    p0_line: Array
    p0: Array
    p0_signed: Array


@dataclass(frozen=True, eq=False)
class Source:
    """What the lifts of a group of designs follow from.

    torque (1 or m, N): smoothed engine torque, crank N m; energy (N,): stored over the turn, J,
    of a synthesised lift; lift (N,): of the case file, m. Two are None.
    """

    torque: Array | None = None
    energy: Array | None = None
    lift: Array | None = None


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs of one structure with what follows from them; arrays (m, 1) and (m, n).

    Parameters
    ----------
    case : Case          with the values that all designs share
    columns : mapping    by key of an array path, SI, each (m, 1)
    source : Source      of the lift
    torques : mapping    engine torque by number of the load case, less its mean, (m or 1, N)
    count : int          designs m
    step : int           every `step`-th sample of the lift is a cam angle of the loads
    """

    case: Case
    columns: Columns
    source: Source
    torques: Mapping[int, Array]
    count: int
    step: int

    def value(self, key: str) -> Array:
        """Values of a key (m, 1), SI; NaN where the case leaves it out."""
        return self._values(key)

    @cached_property
    def _values(self) -> Values:
        return Values(self.case, self.columns, self.count)

    def limit(self, row: AnyLimit) -> Array:
        """Values of a limit (m,), SI; NaN where there is none."""
        return self.value(f"limits.{row.id}")[:, 0]

    @cached_property
    def machine(self) -> Machine:
        """Machine of the shared values in the design load case."""
        return machine(self.case, self.case.load_cases[0])

    @cached_property
    def lift(self) -> Array:
        """Lift at equal cam angles (m or 1, N), m."""
        source = self.source
        if source.lift is not None:
            return source.lift[None, :]
        rate, preload = self.follower.rate, self.follower.closing_preload
        if source.energy is not None:
            energy = source.energy[None, :]
        elif source.torque is not None:
            share = self.case.mechanism.gear_ratio * self.value("mechanism.compensation")
            stored = knot_integrals(source.torque)
            stored = stored - sampled_least(stored)[:, None]
            energy = share * np.maximum(stored, 0.0)
        return stored_lift(energy, rate, preload, self.follower.shape)

    @cached_property
    def jets(self) -> Array:
        """Lift and two derivatives (3, m, N), m/rad^k."""
        jets = knot_derivatives(self.lift, 2)
        return np.broadcast_to(jets, (3, self.count, jets.shape[-1]))

    @cached_property
    def highest(self) -> Array:
        """Maximum lift (m,), m."""
        return sampled_greatest(self.jets[0])

    @cached_property
    def shape(self) -> CamShape:
        """Contour and contact under the follower of the designs."""
        kind = RollerShape if self.case.follower.face is None else FaceShape
        return kind(self.jets, self._values)

    @cached_property
    def theta(self) -> Array:
        """Cam angles of the loads (n,), rad."""
        return uniform_turn(self.jets.shape[-1] // self.step)

    def at_loads(self, values: Array) -> Array:
        """Values (m, N) at the cam angles of the loads (m, n)."""
        return values[..., :: self.step]

    @cached_property
    def motion(self) -> FollowerMotion:
        """Motion at the cam angles of the loads."""
        lift, slope, bend = (self.at_loads(each) for each in self.jets)
        stroke = (self.highest - sampled_least(self.jets[0]))[:, None]
        shape = self.shape
        side, arm = self.at_loads(shape.side), self.at_loads(shape.arm)
        return FollowerMotion(
            lift=lift,
            slope=np.where(np.abs(slope) > REST * stroke, slope, 0.0),
            bend=bend,
            highest=self.highest[:, None],
            pressure_angle=self.at_loads(shape.pressure_angle),
            height=self.at_loads(shape.height),
            push=Push(side, arm, self.value("guides.spacing")),
        )

    @cached_property
    def follower(self) -> FollowerOfDesigns:
        """Mass, spring and guides at the preload of the case."""
        return FollowerOfDesigns(
            mass=self.value("follower.mass"),
            preload=self.value("spring.preload"),
            rate=self.value("spring.rate"),
            guide_spacing=self.value("guides.spacing"),
            overhang_at_max_lift=self.value("follower.overhang_at_max_lift"),
            friction_a=self.value("guides.a.friction"),
            friction_b=self.value("guides.b.friction"),
            viscous_damping=self.value("follower.viscous_damping"),
            gravity_along_axis=self.machine.gravity_along_axis,
            external=self.machine.external,
            shape=self.case.spring.shape,
            face_friction=np.nan_to_num(self.value("follower.face.friction")),
        )

    @cached_property
    def wound_spring(self) -> WoundSprings | None:
        """Springs as wound; None where the case has no spring design."""
        return wound_spring(self.case, lambda key: self.value(key)[:, 0])

    @cached_property
    def states(self) -> tuple[State, ...]:
        """Load cases of the designs, then standstill and over-speed at each preload."""
        base, stated = self.value("spring.preload"), self.case.load_cases
        states: list[State] = []
        preloads: list[Array] = []
        for k, each in enumerate(stated):
            own = self.value(f"load_case[{k}].preload")
            preload = np.where(np.isnan(own), base, own)
            if not any(np.array_equal(preload, known) for known in preloads):
                preloads.append(preload)
            torque = self.torques.get(k)
            torque = None if torque is None else self.at_loads(torque)
            speed = self.value(f"load_case[{k}].speed")
            states.append(State(speed, preload, torque, self._required(each), each.duty))
        over = self.value(f"limits.{OVERSPEED.id}")
        idle = None if stated[0].duty is None else 0.0
        for speed in (np.zeros_like(over), over):
            if np.isnan(speed).all():
                continue
            states += [State(speed, preload, None, None, idle) for preload in preloads]
        return tuple(states)

    def _required(self, state: LoadCase) -> Array | None:
        """Reduction of the torque ripple required in a load case."""
        if state.torque_reduction is None and state.ripple_weight > 0:
            return self.limit(TORQUE_REDUCTION)
        return np.asarray(state.torque_reduction) if state.torque_reduction else None

    def worst(self, measure: Callable[[Turns], Array]) -> Array:
        """Greatest over load cases and cam angles (m,) of a measure (m, n)."""
        return np.max([sampled_greatest(measure(turns)) for turns in self.turns], axis=0)

    def least(self, measure: Callable[[Turns], Array]) -> Array:
        """Least over load cases and cam angles (m,) of a measure (m, n)."""
        return np.min([sampled_least(measure(turns)) for turns in self.turns], axis=0)

    def in_load_cases(self, kept: Sequence[bool]) -> Designs:
        """The designs in some of their load cases; figures without loads are not computed again."""
        part = copy.copy(self)
        chosen = tuple(turns for turns, keep in zip(self.turns, kept, strict=True) if keep)
        part.__dict__["turns"] = chosen  # as the cached property would
        return part

    @cached_property
    def turns(self) -> tuple[Turns, ...]:
        """Loads in each load case."""
        return tuple(self._turns(state) for state in self.states)

    def _turns(self, state: State) -> Turns:
        crank = np.maximum(state.speed, CREEP)
        speed = crank / self.case.mechanism.gear_ratio
        system = replace(self.follower, preload=state.preload)
        motion, theta = self.motion, self.theta
        free = loads_of(motion, system, speed, theta)
        # without guide friction: the share that friction leaves is taken out
        force = free.axial_force * share_left(motion.slope, free.jam_index)
        system = replace(system, rubbing=self._settled(force, system))
        loads = loads_of(motion, system, speed, theta)
        guides = self._supports.loads(loads.axial_force)
        rubbing = guides.rubbing_a, guides.rubbing_b
        p0_line, p0, signed = self._pressures(loads.normal_force, rubbing)
        return Turns(
            state=state,
            crank_speed=crank,
            cam_speed=speed,
            loads=loads,
            guides=guides,
            jam_index_max=self._jam_index_max(force, system),
            p0_line=p0_line,
            p0=p0,
            p0_signed=signed,
        )

    @cached_property
    def _supports(self) -> SupportOfMany:
        """Guides of the designs."""
        motion, known = self.motion, self.machine
        overhang = self.follower.overhang_at_max_lift + (motion.highest - motion.lift)
        return SupportOfMany.of(known.stem, known.guides, motion.push, np.asarray(overhang))

    def _settled(self, force: Array, system: FollowerOfDesigns) -> tuple[Array, Array]:
        """Rubbing load of the guides over axial force and side-load factor at equilibrium (m, n).

        Fixed point of the axial force, whose friction depends on the guides' loads; the change of
        their ratios with the force is small.

        Parameters
        ----------
        force : array (m, n)   axial force without guide friction, N
        """
        slope, supports = self.motion.slope, self._supports
        shape, load = force.shape, np.broadcast_to(supports.load, force.shape).ravel()
        rubs = tuple(
            np.broadcast_to(friction * share * supports.factor, shape).ravel()
            for friction, share in zip(
                (system.friction_a, system.friction_b), supports.shares, strict=True
            )
        )
        free, direction = force.ravel(), np.broadcast_to(np.sign(slope), shape).ravel()
        axial, left = free.copy(), np.flatnonzero((free * load > 0.0) & (direction != 0.0))
        for _ in range(_ROUNDS):
            if not left.size:
                break
            now, place = axial[left], supports.place.of(left)
            ratios = supports.table.rubbing(now * load[left], place)
            jam = ratios[0] * rubs[0][left] + ratios[1] * rubs[1][left]
            axial[left] = free[left] / share_left(direction[left], jam)
            left = left[np.abs(axial[left] - now) > _SETTLED * now]
        return supports.rubbing(axial.reshape(shape))

    def _jam_index_max(self, force: Array, system: FollowerOfDesigns) -> Array:
        """Jam index on the rise at the maximum friction (m, n)."""
        most = replace(
            system, friction_a=self.greatest_friction("a"), friction_b=self.greatest_friction("b")
        )
        rubbing_a, rubbing_b = self._settled(force, most)
        index = most.friction_a * rubbing_a + most.friction_b * rubbing_b
        return demands.jam_outward(self.motion.slope, index * self._supports.factor)

    def greatest_friction(self, side: Literal["a", "b"]) -> Array:
        """Maximum friction coefficient of a guide (m, 1)."""
        nominal = self.value(f"guides.{side}.friction")
        stated = self.value(f"guides.{side}.friction_max")
        return friction_limits(nominal, None, stated, self.case.tolerances.friction)[1]

    @cached_property
    def contact_width(self) -> Array:
        """Width of the line contact (m, 1), m: the overlap of the flats of cam and follower."""
        cam = self.value("cam.width") - 2.0 * np.nan_to_num(self.value("cam.end.size"))
        other, offset = self.shape.line_width, np.nan_to_num(self.value("roller.axial_offset"))
        return np.asarray(np.minimum(np.minimum(cam, other), 0.5 * (cam + other) - offset))

    @cached_property
    def relative_radius(self) -> Array:
        """Relative radius R of cam and follower (m, n), m; NaN if undercut."""
        radius = self.at_loads(self.shape.relative_radius)
        return np.where(self.shape.least_factor[:, None] > 0.0, radius, np.nan)

    def _pressures(self, force: Array, rubbing: tuple[Array, Array]) -> tuple[Array, ...]:
        """Greatest pressure of plane strain, in the middle of the line, and signed (m, n), Pa.

        NaN where the contour bounds no body; signed where the case lacks an end. With too many
        shapes of contact that of plane strain, see `has_many_shapes`.
        """
        load, radius = np.maximum(force, 0.0), self.relative_radius
        modulus, width = self.machine.contact_modulus, self.contact_width
        line = np.sqrt(peak_pressure_square(load / width, 1.0 / radius, modulus))
        factors = factors_of(self, load, radius, rubbing)
        crowned, unknown = self.machine.is_crowned, np.full(line.shape, np.nan)
        if factors is None:
            if has_many_shapes(self):
                return line, line, line
            return line, unknown if crowned else line, unknown
        signed = line * np.maximum(factors.level, factors.tilted)
        return line, line * factors.centre if crowned else line, signed

    @cached_property
    def fastest(self) -> Array:
        """Crank speed (m,) of over-speed, at least of the fastest load case, rad/s."""
        speeds = np.stack([np.maximum(each.speed, CREEP)[:, 0] for each in self.states])
        return np.asarray(np.nanmax(speeds, axis=0))


@dataclass(frozen=True, eq=False)
class TorqueOfSpeed:
    """Engine torque of a load case less its mean over the crank speed.

    speeds (k,), rad/s; torques (k, N), crank N m: one a speed, or at Chebyshev nodes between the
    least and the greatest of more than `_NODES` speeds.
    """

    speeds: Array
    torques: Array
    interpolated: bool

    @classmethod
    def of(cls, case: Case, number: int, speeds: Array | None) -> TorqueOfSpeed:
        """Torque of a load case at the speeds (m,) of designs; None: at that of the case."""
        state = case.load_cases[number]
        wanted = np.array([state.speed]) if speeds is None else np.unique(speeds)
        wanted = wanted[(wanted > 0.0) & np.isfinite(wanted)] if speeds is not None else wanted
        if interpolated := wanted.size > _NODES:
            place = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
            wanted = wanted.min() + 0.5 * np.ptp(wanted) * (1.0 + place)
        torques = [
            engine_torque(case, state.model_copy(update={"speed": float(speed)}))
            for speed in wanted
        ]
        totals = np.stack([each.without_mean().total for each in torques])
        return cls(wanted, totals, interpolated)

    def at(self, speeds: Array | None) -> Array:
        """Torque (m, N) at speeds (m,); (1, N) at that of the case, None."""
        if speeds is None:
            return self.torques
        if not self.interpolated:
            return self.torques[np.searchsorted(self.speeds, speeds)]
        middle, half = self.speeds.mean(), self.speeds[0] - self.speeds.mean()
        basis = chebvander((self.speeds - middle) / half, _NODES - 1)
        weights = chebvander((speeds - middle) / half, _NODES - 1) @ np.linalg.inv(basis)
        return np.asarray(weights @ self.torques)


_NODES = 9
_ROUNDS, _SETTLED = 30, 1e-6  # of the guide friction

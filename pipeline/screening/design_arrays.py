"""Lift, contour, loads and contact of many designs, arrays (designs, cam angles)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value, uniform_turn
from camwright.geometry.energy import lift_of_spring, signed_deflection
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.follower_path import Motion
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.periodic_spline import knot_derivatives, knot_integrals
from camwright.geometry.pitch_curve import magnitude
from camwright.geometry.second_track import SecondMotion
from camwright.pipeline.base.kept_results import KeptResult
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import replaced, value_of
from camwright.pipeline.case.limits import OVERSPEED, TORQUE_REDUCTION, AnyLimit
from camwright.pipeline.case.load_case_torque import engine_torque
from camwright.pipeline.case.machine import CREEP, Machine, machine, machines
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.checks.arm_strength import bar_of
from camwright.pipeline.checks.torque_balance import NO_MEAN
from camwright.pipeline.cycle.crossover_history import WallImpact, impacts
from camwright.pipeline.cycle.loaded_cam import (
    DiscCam,
    LoadedCam,
    carried,
    face_of,
    motion_of,
    pivot_of,
    roller_of,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.camshaft_loads import keyway_cut, rotating_force
from camwright.pipeline.follower.disc_preload import Compliances, Squeezed, squeezed
from camwright.pipeline.follower.follower_forces import Push
from camwright.pipeline.follower.follower_tilt import FollowerTilt, arm_tilt
from camwright.pipeline.follower.guide_table import SupportOfMany
from camwright.pipeline.follower.spring import stored_lift
from camwright.pipeline.screening.screened_cam import ScreenedCam, ScreenedState


def _moment(ring: Array) -> Array:
    """First moment of the area within closed curves of complex points (m, N), (m, 1), m3."""
    beside = np.roll(ring, -1, axis=-1)
    swept = np.imag(np.conj(ring) * beside)
    return np.asarray(np.sum((ring + beside) * swept, axis=-1, keepdims=True) / 6.0)


def _in_cam_axes(motion: Motion) -> Array:
    """Contact points of a motion over the turn as complex numbers in the axes of the cam, m."""
    along, across = motion.contact_point
    theta = uniform_turn(along.shape[-1])
    return np.asarray((along + 1j * across) * np.exp(1j * (theta + motion.travel)))


Judged = tuple[Array, Array | float | None]
"""Demand (m,) and limit (m,) of a check, SI; NaN and None are missing."""


@dataclass(frozen=True, eq=False)
class LiftOrigin:
    """Source of the lifts of a group of designs: torque, stored energy, or stated lift.

    torque (1 or m, N): smoothed engine torque, crank N m; energy (N,): stored over the turn, J,
    of a synthesised lift; lift (N,) or (m, N): of all designs or of each, m. Two are None.
    """

    torque: Array | None = None
    energy: Array | None = None
    lift: Array | None = None


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs of one structure with their derived quantities; arrays (m, 1) and (m, n).

    Parameters
    ----------
    case : Case          with the values that all designs share
    columns : mapping    by key of an array path, SI, each (m, 1)
    source : LiftOrigin      of the lift
    torques : mapping    engine torque by number of the load case, less its mean, (m or 1, N)
    count : int          designs m
    step : int           every `step`-th sample of the lift is a cam angle of the loads
    torque_step : int    the same of the engine torque, a divisor of `step`; None: as of the loads
    throughputs : mapping   mean torque of the power of the machine by number of the load case,
                            crank N m, (m or 1, 1)
    results : dict       by name, computed on first use
    """

    case: Case
    columns: Mapping[str, Array]
    source: LiftOrigin
    torques: Mapping[int, Array]
    count: int
    step: int
    torque_step: int | None = None
    throughputs: Mapping[int, Array] = field(default_factory=dict)
    results: dict[str, object] = field(default_factory=dict, init=False)

    def value(self, key: str) -> Array:
        """Values at a dotted key of the m designs (m, 1), SI; NaN where the case omits it."""
        if key in self.columns:
            return self.columns[key]
        if key in self.of_springs:
            return self.of_springs[key]
        stated = value_of(self.case, key)
        return np.full((self.count, 1), np.nan if stated is None else float(stated))

    @KeptResult
    def of_springs(self) -> Mapping[str, Array]:
        """Rate, N/m, and preload, N, on the follower (m, 1), by key, of springs whose links or arms
        differ between the designs; {} where the force rise is that of the case.
        """
        shape = Numbers(self.columns, self.case).spring_shape
        if shape is None or shape is self.case.spring.shape:
            return {}
        of_each = {"spring.rate": shape.rate, "spring.preload": shape.preload}
        shaped = (self.count, 1)
        return {key: np.array(np.broadcast_to(each, shaped)) for key, each in of_each.items()}

    @KeptResult
    def tilting(self) -> FollowerTilt:
        """Compliance and clearance by which the followers tilt across the plane of the cam."""
        machine, numbers = self.machine, self.numbers
        if machine.arm is None:
            return machine.tilting
        pivot, arm = machine.pivot, numbers.of_part(machine.arm)
        bush = None if pivot is None else pivot.bush
        if bush is not None:
            bush = numbers.of_part(bush, "follower.pivot.bush")
        return arm_tilt(arm, bar_of(numbers), bush) or machine.tilting

    @KeptResult
    def numbers(self) -> Numbers:
        """Numbers of the designs outside any load case."""
        cam = self.case.cam
        known: dict[str, Value | None] = {
            "cam.held_radius": self.value("cam.bore_radius") + (cam.held_radius - cam.bore_radius),
            "spring.preload": self.states[0].preload,
            "spring.preload_least": np.min([each.preload for each in self.states], axis=0),
            "contact.width": self.contact_width,
            "contact.modulus": self.machine.contact_modulus,
            "cam.fastest": self.fastest[:, None] / self.case.mechanism.gear_ratio,
        }
        numbers = Numbers({**self.columns, **self.of_springs, **known}, self.case)
        if self.case.cam.second is None and not self.machine.spring.absent:
            return numbers
        first = motion_of(Jet(*self.jets), numbers)
        second = self.second_of(first) if self.case.cam.conjugate is not None else None
        discs = (first,) if second is None else (first, second.motion)
        widest = np.max([sampled_greatest(each.contour_radius) for each in discs], axis=0)
        radii: dict[str, Value | None] = {"cam.greatest_radius": widest[:, None]}
        if second is not None:
            roller = roller_of(second.motion)
            radii["cam.second_base_radius"] = roller.prime_radius[:, :1] - roller.size
        return numbers | radii

    def limit(self, row: AnyLimit) -> Array:
        """Values of a limit (m,), SI; NaN without one."""
        return self.value(f"limits.{row.id}")[:, 0]

    @KeptResult
    def machine(self) -> Machine:
        """Machine of the shared values in the design load case."""
        return machine(self.case, self.case.load_cases[0])

    @KeptResult
    def lift(self) -> Array:
        """Lift at equal cam angles, m, (designs m, N), or (1, N) where all share it: as stated, or
        by the energy that the spring stores against its force, dead weight included.
        """
        source = self.source
        if source.lift is not None:
            return np.atleast_2d(source.lift)
        machine, mass = self.machine, self.value("follower.mass")
        dead_load = mass * machine.gravity_along_axis + machine.external.mean
        if (pivot := pivot_of(self.numbers)) is not None:
            dead_load = pivot.applied(machine.external.mean, pivot.direction(0.0))
        rate, preload = self.value("spring.rate"), self.value("spring.preload") + dead_load
        if self.case.cam.pulls and not (preload > 0.0).all():
            return self._lift_of_pulling_springs(rate, preload)
        if source.energy is not None:
            energy = source.energy[None, :]
        elif source.torque is not None:
            stored = knot_integrals(source.torque)
            stored = stored - sampled_least(stored)[:, None]
            energy = self._torque_share * np.maximum(stored, 0.0)
        return stored_lift(energy, rate, preload, self.numbers.spring_shape)

    @property
    def _torque_share(self) -> Array:
        """Torque on the cam over the part of the crank torque that it is to balance (m, 1)."""
        return self.case.mechanism.gear_ratio * self.value("mechanism.compensation")

    def _lift_of_pulling_springs(self, rate: Array, preload: Array) -> Array:
        """Lift (m, N) of designs of which a spring may pull, see `signed_deflection`; (m, 1)."""
        if self.source.torque is None:
            raise InputError("smoothing.kind", "constrained", "a filter with a spring that pulls")
        theta = uniform_turn(self.source.torque.shape[-1])
        rows = np.broadcast_to(self._torque_share * self.source.torque, (self.count, theta.size))
        springs = zip(rate[:, 0].tolist(), preload[:, 0].tolist(), strict=True)
        stored = (partial(signed_deflection, spring_rate=k, preload=force) for k, force in springs)
        lifts = (lift_of_spring(theta, *each) for each in zip(rows, stored, strict=True))
        return np.stack([each.values for each in lifts])

    @KeptResult
    def jets(self) -> Array:
        """Lift and two derivatives (3, m, N), m/rad^k."""
        jets = knot_derivatives(self.lift, 2)
        return np.broadcast_to(jets, (3, self.count, jets.shape[-1]))

    @KeptResult
    def highest(self) -> Array:
        """Maximum lift (m,), m."""
        return sampled_greatest(self.jets[0])

    @KeptResult
    def lowest(self) -> Array:
        """Minimum lift (m,), m."""
        return sampled_least(self.jets[0])

    @KeptResult
    def whole(self) -> LoadedCam:
        """The unloaded cams at the samples of the lift."""
        return LoadedCam(Jet(*self.jets), self.numbers, self.highest[:, None])

    def whole_to(self, order: int) -> LoadedCam:
        """Unloaded cams at every sample of the lift, with lift derivatives up to order 2 or 3; see
        `whole`.
        """
        if order == 2:
            return self.whole
        jerk = np.broadcast_to(knot_derivatives(self.lift, order)[order], self.jets.shape[1:])
        return replace(self.whole, jet=self.whole.jet._replace(jerk=jerk))

    def discs_to(self, order: int) -> tuple[LoadedCam, ...]:
        """As `whole_to`, of each disc, as that of a second roller."""
        first = self.whole_to(order)
        if self.case.cam.conjugate is None:
            return (first,)
        motion = roller_of(first.motion)
        second = self.second_of(motion)
        if second is None:
            return (first,)
        other = roller_of(second.motion)
        return first, DiscCam(other.jet, self.numbers, first.highest, track=other)

    @property
    def top(self) -> LoadedCam:
        """The unloaded cams at their maximum lift, (m, 1); with the greatest preload of the load
        cases.
        """
        lift = self.highest[:, None]
        preload = np.max([cam.state.preload for cam in self.cams], axis=0)
        numbers = self.numbers | {"spring.preload_greatest": preload}
        return LoadedCam(Jet(lift, np.zeros_like(lift), np.zeros_like(lift)), numbers, lift)

    def second_of(self, motion: Motion) -> SecondMotion | None:
        """Motion of the second roller or face by that of the first (m, n); None without one."""
        cam, numbers = self.case.cam, Numbers(self.columns, self.case)
        second = cam.second
        stated = cam.conjugate if cam.groove is None else cam.groove.second
        if stated is not None:
            second = numbers.of_part(stated).roller
        return None if second is None else second.motion(motion, self.highest[:, None])

    @KeptResult
    def second(self) -> SecondMotion | None:
        """That at the cam angles of the loads."""
        return self.second_of(self.motion)

    def both_tracks(self, first: Motion) -> tuple[Motion, Motion]:
        """Motion (m, n) on each track of cams that pull, by that of the first roller or face."""
        second, one = self.second_of(first), np.ones(first.jet.lift.shape)
        return carried(first, second, one), carried(first, second, -one)

    @KeptResult
    def tracks(self) -> tuple[Motion, ...]:
        """Motion of the unloaded cams at the samples of the lift on each of their tracks."""
        first = self.whole.motion
        return self.both_tracks(first) if self.case.cam.pulls else (first,)

    @KeptResult
    def least_factor(self) -> Array:
        """Minimum undercut factor (m,), of any track."""
        sharpest = [sampled_greatest(each.sharpness) for each in self.tracks]
        return np.asarray(1.0 - np.max(sharpest, axis=0))

    @KeptResult
    def least_radius(self) -> Array:
        """Minimum radius of the contour (m, 1), m, of two discs the lesser."""
        radii = [sampled_least(each.contour_radius) for each in self.tracks]
        return np.asarray(np.min(radii, axis=0))[:, None]

    @property
    def least_convex_radius(self) -> Array:
        """Minimum convex radius of the path of the reference point (m,), m."""
        return np.asarray(1.0 / sampled_greatest(self.whole.motion.path_curvature))

    @KeptResult
    def theta(self) -> Array:
        """Cam angles of the loads (n,), rad."""
        return uniform_turn(self.jets.shape[-1] // self.step)

    def at_loads(self, values: Array) -> Array:
        """Values (m, N) at the cam angles of the loads (m, n)."""
        return values[..., :: self.step]

    @KeptResult
    def motion(self) -> Motion:
        """Motion of the unloaded cams at the cam angles of the loads."""
        return motion_of(self.whole.jet.at(self.at_loads), self.numbers)

    @property
    def contact_travel(self) -> Array:
        """Minimum width of a face, twice the travel of its contact from its middle (m,), m."""
        travel = face_of(self.whole.motion).on_face
        return np.asarray(2.0 * np.maximum(sampled_greatest(travel), -sampled_least(travel)))

    @KeptResult
    def stroke(self) -> Array:
        """Maximum less minimum lift (m, 1), m."""
        return (self.highest - self.lowest)[:, None]

    @KeptResult
    def states(self) -> tuple[ScreenedState, ...]:
        """Load cases of the designs, then standstill and over-speed at each distinct preload; the
        preload of a load case is its own or, where it states none, that of the spring.
        """
        base, stated = self.value("spring.preload"), self.case.load_cases
        states: list[ScreenedState] = []
        preloads: list[Array] = []
        for k, each in enumerate(stated):
            own = self.value(f"load_case[{k}].preload")
            preload = np.where(np.isnan(own), base, own)
            if not any(np.array_equal(preload, known) for known in preloads):
                preloads.append(preload)
            torque = self.torques.get(k)
            torque = None if torque is None else torque[..., :: self.torque_step or self.step]
            speed = self.value(f"load_case[{k}].speed")
            states.append(
                ScreenedState(
                    speed,
                    preload,
                    torque,
                    self._required(each),
                    each.duty,
                    steady=True,
                    power=self._power(k, each, speed),
                )
            )
        over = self.value(f"limits.{OVERSPEED.id}")
        idle = None if stated[0].duty is None else 0.0
        for speed in (np.zeros_like(over), over):
            if np.isnan(speed).all():
                continue
            states += [ScreenedState(speed, preload, None, None, idle) for preload in preloads]
        return tuple(states)

    def _required(self, state: LoadCase) -> Array | None:
        """Reduction of the torque ripple required in a load case."""
        if state.torque_reduction is None and state.ripple_weight > 0:
            return self.limit(TORQUE_REDUCTION)
        return np.asarray(state.torque_reduction) if state.torque_reduction else None

    def _power(self, number: int, state: LoadCase, speed: Array) -> Array | None:
        """Mean power of the machine in load case `number` (m or 1, 1), W: as stated, else mean
        torque times crank speed.

        None where the machine is not fired or stands still, and without torque; NaN where the mean
        torque is lost in rounding.

        Parameters
        ----------
        speed : array (m, 1)   of the crank in this load case, rad/s
        """
        throughput, torque = self.throughputs.get(number), self.torques.get(number)
        if not (state.fired and state.speed > 0.0):
            return None
        if state.power is not None:
            return np.full((1, 1), state.power)
        if throughput is None or torque is None:
            return None
        has_mean = throughput > NO_MEAN * np.abs(torque).max(axis=-1, keepdims=True)
        return np.where(has_mean, throughput * np.maximum(speed, CREEP), np.nan)

    def worst(self, measure: Callable[[ScreenedCam], Array]) -> Array:
        """Greatest over load cases and cam angles (m,) of a measure (m, n)."""
        return np.max([sampled_greatest(measure(cam)) for cam in self.cams], axis=0)

    def in_load_cases(self, kept: Sequence[bool]) -> Designs:
        """The designs with those load cases alone that `kept` (k,) marks; what does not depend on
        loads is taken over.
        """
        part = replace(self)
        chosen = tuple(cam for cam, keep in zip(self.cams, kept, strict=True) if keep)
        part.results.update(self.results | {"cams": chosen})
        return part

    @KeptResult
    def cams(self) -> tuple[ScreenedCam, ...]:
        """Loaded cams in each load case."""
        return tuple(self._loaded(state) for state in self.states)

    def _loaded(self, state: ScreenedState) -> ScreenedCam:
        crank = np.maximum(state.speed, CREEP)
        own = {
            "cam.speed": crank / self.case.mechanism.gear_ratio,
            "spring.preload": state.preload,
        }
        return ScreenedCam(
            self.motion.jet,
            self.numbers | own,
            self.highest[:, None],
            self.lowest[:, None],
            external=self.machine.external.at(self.theta),
            gravity=self.machine.gravity_along_axis,
            block=self,
            state=state,
            crank_speed=crank,
        )

    @KeptResult
    def supports(self) -> SupportOfMany:
        """Guides and overhang of the stem of each design over the turn, for the loads of the
        guides.
        """
        return self.supports_of(self.motion, 0.0)

    def supports_of(self, motion: Motion, reach: Value) -> SupportOfMany:
        """As `supports`, of the roller or face of a motion, farther from the guides by `reach`."""
        return self.supports_under(motion.side, motion.arm, reach)

    def supports_under(self, side: Array, arm: Array, reach: Value) -> SupportOfMany:
        """As `supports`, of a side load and its lever arm, m, over a force on the stem."""
        known, lift = self.machine, self.motion.jet.lift
        overhang = self.value("follower.overhang_at_max_lift") + (self.highest[:, None] - lift)
        overhang = overhang + reach
        push = Push(side, arm, self.value("guides.spacing"))
        return SupportOfMany.of(known.stem, known.guides, push, np.asarray(overhang))

    @property
    def unbalance(self) -> tuple[Array, Array]:
        """Unbalance of the cams, kg m, and its direction, rad, both (m, 1), of both discs of a pair
        in one plane; zero with a counter-hole.
        """
        first, *others = self.unbalances
        if not others:
            return first
        product = sum(size * np.exp(1j * angle) for size, angle in self.unbalances)
        return np.abs(product), np.angle(product)

    @KeptResult
    def unbalances(self) -> tuple[tuple[Array, Array], ...]:
        """Unbalance of each disc, kg m, and its direction, rad, both (m, 1)."""
        cam = self.machine.cam
        moments = self._moments_of_plates if cam.groove is None else (self._moment_of_groove,)
        if cam.counter_hole is not None:
            return ((np.zeros((self.count, 1)), np.zeros((self.count, 1))),) * len(moments)
        if cam.keyway is not None:
            cut = keyway_cut(self.value("cam.bore_radius"), cam.keyway.width, cam.keyway.depth)
            moments = tuple(each - cut.moment * np.exp(1j * cam.keyway.angle) for each in moments)
        products = (cam.material.density * self.value("cam.width") * each for each in moments)
        return tuple((np.abs(each), np.angle(each)) for each in products)

    @property
    def _moments_of_plates(self) -> tuple[Array, ...]:
        """First moment of the plane of each disc of the cams about their axis (m, 1), m3."""
        first = self.whole.motion
        second = self.second_of(first) if self.case.cam.conjugate is not None else None
        moment = _moment(_in_cam_axes(first))
        if second is None:
            return (moment,)
        ahead = second.turned + first.travel - second.motion.travel
        return moment, _moment(_in_cam_axes(second.motion) * np.exp(1j * ahead))

    @property
    def _moment_of_groove(self) -> Array:
        """That of a round disc less its groove, over the width of the disc; see
        `Groove.section`.
        """
        path, radius = roller_of(self.whole.motion), self.value("roller.radius")
        inner, outer = (
            replace(self.whole, numbers=self.numbers | {"roller.radius": size}).motion
            for size in (radius, -radius)
        )
        points = [_in_cam_axes(each) for each in (inner, outer)]
        centre, normal = 0.5 * (points[0] + points[1]), (points[1] - points[0]) / (2.0 * radius)
        half = radius + 0.5 * self.value("cam.groove.clearance")
        step = FULL_TURN / centre.shape[-1]
        strip = (
            2.0 * half * path.path_speed * (centre + half**2 / 3.0 * path.path_curvature * normal)
        )
        share = self.value("cam.groove.depth") / self.value("cam.width")
        return np.asarray(-share * step * np.sum(strip, axis=-1, keepdims=True))

    @KeptResult
    def flights(self) -> tuple[tuple[WallImpact, ...], ...]:
        """Landings of each design between its tracks, of all load cases; none of one track."""
        if not self.case.cam.clearance > 0.0:
            return ((),) * self.count
        theta = uniform_turn(self.lift.shape[-1])
        return tuple(
            tuple(one for state in machines(case) for one in impacts(state, contour))
            for k, case in enumerate(self.cases)
            for contour in (case.contour(Lift(theta, self.lift[k % len(self.lift)])),)
        )

    @KeptResult
    def cases(self) -> tuple[Case, ...]:
        """Case of each design."""
        numbers = (
            {key: float(each[k, 0]) for key, each in self.columns.items()}
            for k in range(self.count)
        )
        return tuple(replaced(self.case, each) for each in numbers)

    @KeptResult
    def compliances(self) -> Compliances:
        """Compliances of both rollers (m, 1), m/N."""
        each = [machine(case, case.load_cases[0]).roller_compliances for case in self.cases]
        return Compliances(*(np.array(values)[:, None] for values in zip(*each, strict=True)))

    @KeptResult
    def squeeze(self) -> Squeezed | None:
        """Preload of both discs (m, n) with their interference; None without one."""
        return self.squeezed()

    def squeezed(self, narrower: Value = 0.0) -> Squeezed | None:
        """Preload of both discs (m, n) with an interference larger by a length (m, 1), m; None
        without an interference.
        """
        if self.second is None or self.case.cam.clearance > 0.0:
            return None
        interference = self.value("cam.conjugate.interference") + narrower
        second = self.second
        return squeezed(interference, self.compliances, self.motion, second.touch, second.leverage)

    def thrown(self, speed: Value) -> tuple[tuple[Array, ...], Array]:
        """Centrifugal forces on each disc and the counterweight (2, m, n), N, at cam speeds (m, 1),
        rad/s.
        """
        shaft = self.machine.camshaft
        forces = tuple(rotating_force(*each, speed, self.theta) for each in self.unbalances)
        if shaft is None or shaft.counterweight is None:
            return forces, np.zeros_like(forces[0])
        against = shaft.counterweight.against(*self.unbalance)
        return forces, rotating_force(*against, speed, self.theta)

    @KeptResult
    def contact_width(self) -> Array:
        """Width of the line contact (m, 1), m: the overlap of the flats of cam and follower."""
        cam, other, offset = self._flats
        return np.asarray(np.minimum(np.minimum(cam, other), 0.5 * (cam + other) - offset))

    @KeptResult
    def stem_offset(self) -> Array:
        """Distance of the middle of the line contact from the stem (m, 1), m."""
        cam, other, offset = self._flats
        low, high = (
            np.maximum(-0.5 * cam, offset - 0.5 * other),
            np.minimum(0.5 * cam, offset + 0.5 * other),
        )
        return np.asarray(np.abs(0.5 * (low + high) - offset))

    @property
    def _flats(self) -> tuple[Array, Array, Array]:
        """Widths of the flats of cam and of follower, then axial offset of the follower: three
        arrays (m, 1), m.
        """
        cam = self.value("cam.width") - 2.0 * np.nan_to_num(self.value("cam.end.size"))
        part = self.machine.follower
        width = self.value(part.width_key)
        other = width - 2.0 * np.nan_to_num(self.value(f"{part.table}.end.size"))
        return cam, other, np.nan_to_num(self.value("roller.axial_offset"))

    @KeptResult
    def relative_radius(self) -> Array:
        """Relative radius R of cam and follower (m, n), m; NaN if undercut."""
        return self.relative_radius_of(self.motion)

    def relative_radius_of(self, motion: Motion) -> Array:
        """R (m, n), m, of the motion on a track; NaN if one is undercut."""
        radius = magnitude(np.asarray(motion.size)) * (1.0 - motion.sharpness)
        return np.where(self.least_factor[:, None] > 0.0, radius, np.nan)

    @KeptResult
    def fastest(self) -> Array:
        """Crank speed (m,) of over-speed, at least of the fastest load case, rad/s."""
        speeds = np.stack([np.maximum(each.speed, CREEP)[:, 0] for each in self.states])
        return np.asarray(np.nanmax(speeds, axis=0))


@dataclass(frozen=True, eq=False)
class TorqueOfSpeed:
    """Engine torque of a load case about its mean, as a function of crank speed.

    speeds (k,), rad/s; torques (k, N), crank N m: one a speed, or at Chebyshev nodes between the
    least and the greatest of more than `_SPEED_NODES` speeds; throughputs (k, 1): mean torque of
    the power of the machine there, crank N m.
    """

    speeds: Array
    torques: Array
    throughputs: Array
    interpolated: bool

    @classmethod
    def of(cls, case: Case, number: int, speeds: Array | None) -> TorqueOfSpeed:
        """Torque of load case `number` at the crank speeds (m,), rad/s, of the designs; None: at
        the speed of the case. Solved at each different speed, or at `_SPEED_NODES` Chebyshev nodes
        where there are more.
        """
        state = case.load_cases[number]
        wanted = np.array([state.speed]) if speeds is None else np.unique(speeds)
        wanted = wanted[(wanted > 0.0) & np.isfinite(wanted)] if speeds is not None else wanted
        if interpolated := wanted.size > _SPEED_NODES:
            place = np.cos(np.pi * (np.arange(_SPEED_NODES) + 0.5) / _SPEED_NODES)
            wanted = wanted.min() + 0.5 * np.ptp(wanted) * (1.0 + place)
        torques = [
            engine_torque(case, state.model_copy(update={"speed": float(speed)}))
            for speed in wanted
        ]
        totals = np.stack([each.without_mean().total for each in torques])
        throughputs = np.array([[each.throughput] for each in torques])
        return cls(wanted, totals, throughputs, interpolated)

    def at(self, speeds: Array | None) -> Array:
        """Torque (m, N) at speeds (m,); for None (1, N) at the case's speed."""
        return self._at(speeds, self.torques)

    def throughput_at(self, speeds: Array | None) -> Array:
        """Mean torque of the power of the machine (m, 1), as `at`."""
        return self._at(speeds, self.throughputs)

    def _at(self, speeds: Array | None, values: Array) -> Array:
        """Rows of `values` (k, N) at the speeds (m,): of equal speed, or by the Chebyshev
        polynomial.
        """
        if speeds is None:
            return values
        if not self.interpolated:
            return values[np.searchsorted(self.speeds, speeds)]
        middle, half = self.speeds.mean(), self.speeds[0] - self.speeds.mean()
        basis = chebvander((self.speeds - middle) / half, _SPEED_NODES - 1)
        weights = chebvander((speeds - middle) / half, _SPEED_NODES - 1) @ np.linalg.inv(basis)
        return np.asarray(weights @ values)


_SPEED_NODES = 9  # Chebyshev nodes of the torque over the crank speed


def _to_all(*_: object) -> NDArray[np.bool_]:
    return np.array(True)


def never(_: Designs) -> bool:
    return False


class Screened(NamedTuple):
    """Check that the screening evaluates, with its measure.

    deviation: from the demand of the preview, over the greater of demand and limit, as
    `tests/verification/test_screening.py` measures it; applies: demand (m,), designs -> to which;
    is_bound: whether the demand is a lower bound, by which it can only fail.
    """

    check: str
    judged: Callable[[Designs], Judged | None]
    deviation: float
    applies: Callable[[Array, Designs], NDArray[np.bool_]] = _to_all
    is_bound: Callable[[Designs], bool] = never

"""Loaded cams of a solution: unloaded contour, solved forces, solved cycle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.contour import Contour
from camwright.geometry.follower_path import Motion
from camwright.geometry.lift import Jet
from camwright.geometry.second_track import SecondFollower, discs_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import BodyContact, LoadedCam, OfGuides, on_wall
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import Loads


def numbers_of(case: Case, machines: Sequence[Machine]) -> Numbers:
    """Numbers of the machines, one per load case, tolerance corner included.

    Those of the first, the greatest cam speed, the extreme preloads; see `in_load_case`.
    """
    shared = {
        "cam.held_radius": machines[0].cam.held_radius,
        "contact.width": machines[0].contact_width,
        "contact.modulus": machines[0].contact_modulus,
        "cam.fastest": highest_speed(machines) / machines[0].gear_ratio,
        "spring.preload_greatest": max(each.spring.preload for each in machines),
        "spring.preload_least": min(each.spring.preload for each in machines),
    }
    return in_load_case(Numbers(shared, case), machines[0])


def numbers_of_discs(case: Case, machines: Sequence[Machine], contour: Contour) -> Numbers:
    """`numbers_of`, of a cam without a spring or with two tracks with its greatest radius and the
    base radius of a second disc.
    """
    numbers, machine = numbers_of(case, machines), machines[0]
    if machine.cam.second is None and not machine.spring.absent:
        return numbers
    discs = [each.contour for each in discs_of(contour, machine.cam.second)]
    radii = {"cam.greatest_radius": max(each.radius_max().value for each in discs)}
    if len(discs) > 1:
        radii["cam.second_base_radius"] = discs[1].radius_min().value
    return numbers | radii


def in_load_case(numbers: Numbers, machine: Machine) -> Numbers:
    """Numbers with those of the machine in its load case added."""
    spring = {"spring.preload": machine.spring.preload, "spring.rate": machine.spring.rate}
    return numbers | numbers_in(machine) | spring


def numbers_in(machine: Machine) -> dict[str, float | None]:
    """Numbers of a machine in its load case by dotted key, SI, without those of the spring."""
    nominal, greatest = machine.friction.nominal, machine.friction.greatest
    friction = {
        f"{key}{which}": value
        for which, values in (("", nominal), ("_greatest", greatest))
        for key, value in zip(machine.friction_keys, values, strict=True)
    }
    if machine.pivot is not None and machine.pivot.swinging_mass is not None:
        friction["follower.pivot.swinging_mass"] = machine.pivot.swinging_mass
    return {
        "cam.speed": machine.cam_speed,
        "follower.mass": machine.mass,
        "follower.viscous_damping": machine.viscous_damping,
        "follower.overhang_at_max_lift": machine.overhang_at_max_lift,
        "guides.spacing": machine.guides.spacing,
        **friction,
    }


@dataclass(frozen=True, eq=False, kw_only=True)
class ContourCam(LoadedCam):
    """Unloaded cam of a contour, tolerance corner included."""

    contour: Contour

    @cached_property
    def motion(self) -> Motion:
        return self._of_first

    @property
    def _of_first(self) -> Motion:
        """Motion of the first roller or face."""
        friction = self.numbers.get("follower.face.friction")
        return self.contour.motion(self.jet, 0.0 if friction is None else friction)

    def on_track(self, second: SecondFollower | None, theta: Array, wall: Array) -> Motion:
        """Motion of the roller or face that carries.

        Parameters
        ----------
        second : SecondFollower   of two rollers or faces; None of one
        theta : array (n,)        cam angles, rad
        wall : array (n,)         1 where the first track carries, -1 where the other does
        """
        unloaded = self._of_first
        if second is None:
            return on_wall(unloaded, wall) if self.pulls else unloaded
        friction = self.numbers.get("follower.face.friction")
        rubs = 0.0 if friction is None else friction
        return second.track(self.contour.pitch).carried(unloaded, theta, wall < 0.0, rubs)

    @property
    def least_radius(self) -> float:
        case = self.numbers.case
        discs = discs_of(self.contour, None if case is None else case.cam.second)
        return min(float(each.contour.radius_min().value) for each in discs)

    @classmethod
    def at(cls, contour: Contour, numbers: Numbers, theta: Array, order: int) -> ContourCam:
        """Unloaded cam at cam angles (...), rad; order: of the derivatives of its lift."""
        lift = contour.lift
        return cls(lift.jet(theta, order), numbers, lift.highest.value, contour=contour)

    @classmethod
    def at_top(cls, contour: Contour, numbers: Numbers) -> ContourCam:
        """At maximum lift (1,)."""
        top = contour.lift.highest.value
        jet = Jet(np.array([top]), np.zeros(1), np.zeros(1))
        return cls(jet, numbers, top, contour=contour)


@dataclass(frozen=True, eq=False, kw_only=True)
class ForcesCam(ContourCam):
    """Cam under the solved forces of a load case; arrays (n,).

    The loads are clipped by `Loads`: no axial force where the follower has left the cam, and a
    finite one where it locks. Guides and contact, which are solved at fewer angles, are those of
    point supports and half-planes.

    Parameters
    ----------
    loads : Loads
    least_spring : float   spring force at minimum lift, N
    """

    loads: Loads
    least_spring_force: float

    @classmethod
    def between(cls, cycle: Cycle, numbers: Numbers) -> ForcesCam:
        """At the angles of `Cycle.loads_between`."""
        return cls(
            *_jet(cycle, numbers, loads := cycle.loads_between),
            external=cycle.machine.external.at(loads.theta),
            contour=cycle.contour,
            loads=loads,
            least_spring_force=cycle.least_spring_force,
        )

    @cached_property
    def motion(self) -> Motion:
        return self.on_track(self.loads.second, self.loads.theta, self.wall)

    @property
    def reach(self) -> Value:
        second = self.loads.second
        if second is None:
            return 0.0
        return np.asarray(second.track(self.contour.pitch).reach * (self.wall < 0.0))

    @property
    def wall(self) -> Array:
        return self.loads.wall

    @cached_property
    def turning(self) -> Array:
        second, theta = self.loads.second, self.loads.theta
        return self._turning_by(
            self.loads.signed_force, lambda wall: self.on_track(second, theta, wall)
        )

    @property
    def slope(self) -> Array:
        """Slope of the lift, m/rad; zero in a dwell."""
        return self.loads.lift_slope

    @property
    def velocity(self) -> Array:
        return self.loads.velocity

    @property
    def spring_force(self) -> Array:
        return self.loads.spring_force

    @property
    def least_spring(self) -> Array:
        return np.asarray(self.least_spring_force)

    @property
    def closing(self) -> Array:
        return self.loads.closing_force

    @property
    def inertia(self) -> Array:
        return self.loads.inertia_force

    @property
    def viscous(self) -> Array:
        return self.loads.viscous_force

    @property
    def jam(self) -> Array:
        return self.loads.jam_index

    @cached_property
    def share(self) -> Array:
        return self.loads.share

    @property
    def axial(self) -> Array:
        return self.loads.axial_force

    @property
    def on_bodies(self) -> tuple[BodyContact, ...]:
        loads = self.loads
        if loads.second is None or not loads.second.own_disc:
            return super().on_bodies
        track, (first, second) = loads.second.track(self.contour.pitch), loads.track_forces
        push, pull = self._of_first, track.motion(loads.theta)
        return (
            BodyContact.of(push, first / push.gain),
            BodyContact.of(pull, second / pull.gain, track.turned(loads.theta)),
        )

    @property
    def pivot_load(self) -> Array:
        return np.hypot(*self.loads.pivot_load)

    @property
    def normal(self) -> Array:
        return self.loads.normal_force

    @property
    def torque(self) -> Array:
        return self.loads.cam_torque


@dataclass(frozen=True, eq=False, kw_only=True)
class SolvedCam(ForcesCam):
    """Cam of a solved cycle: guides of finite length, contact by its tier, spring surge."""

    cycle: Cycle

    @classmethod
    def of(cls, cycle: Cycle, numbers: Numbers) -> Self:
        """At the solved angles; numbers: of the solution."""
        return cls(
            *_jet(cycle, numbers, cycle.loads),
            external=cycle.machine.external.at(cycle.loads.theta),
            contour=cycle.contour,
            loads=cycle.loads,
            least_spring_force=cycle.least_spring_force,
            cycle=cycle,
        )

    @cached_property
    def shaft_tilt(self) -> Array:
        return self.cycle.shaft_tilt

    @property
    def shaft_tilts(self) -> tuple[Array, ...]:
        return self.cycle.on_each_disc(lambda each: each.shaft_tilt)

    @property
    def squeeze(self) -> Squeezed | None:
        preload, second = self.cycle.machine.disc_preload, self.loads.second
        if preload is None or second is None:
            return None
        return preload.at(second.track(self.contour.pitch), self.loads.theta)

    @property
    def on_other_track(self) -> Self | None:
        other = self.cycle.on_other_track
        return None if other is None else type(self).of(other, self.numbers)

    @property
    def jam_worst(self) -> Array:
        return self.cycle.parts.friction.greatest.jam_index

    @property
    def spin_mean(self) -> Array:
        return np.asarray(np.mean(self.turning))

    @property
    def surged(self) -> Array:
        return self.cycle.surged_force

    @property
    def rubbing(self) -> OfGuides:
        return OfGuides(*self.cycle.guide_rubbing)

    @cached_property
    def jam_tilted(self) -> Array:
        guides = self.cycle.guides
        return self.friction_over(OfGuides(guides.rubbing_load_a, guides.rubbing_load_b))

    @property
    def bearing(self) -> OfGuides:
        return OfGuides(*self.cycle.guide_pushes)

    @cached_property
    def follower_moment(self) -> Array:
        return self.cycle.follower_moment

    @property
    def heat(self) -> OfGuides:
        return OfGuides(self.cycle.parts.heat_max_a, self.cycle.parts.heat_max_b)

    @property
    def pivot_heat(self) -> Array:
        worst = self.cycle.parts.friction.greatest
        heat = worst.pivot_friction * self.bush_rubbing * np.abs(worst.velocity)
        return np.where(worst.bounded, np.nan, heat)

    @cached_property
    def bush_rubbing(self) -> Array:
        return self._over_load(self.cycle.parts.pivot_rubbing)

    @cached_property
    def bush_bearing(self) -> Array:
        return self._over_load(self.cycle.parts.pivot_bearing)

    def _over_load(self, push: Array | None) -> Array:
        """Push on the bush of a pivot over its load (n,); 1 without a bush or load."""
        load = self.pivot_load
        push = load if push is None else push
        return np.divide(push, load, out=np.ones_like(load), where=load != 0.0)

    @property
    def p0(self) -> Array:
        return self.cycle.surface.p0

    @property
    def p0_signed(self) -> Array:
        """NaN without the ends."""
        return self.cycle.signed_pressure

    @property
    def half_width(self) -> Array:
        return self.cycle.contact.half_width


def _jet(cycle: Cycle, numbers: Numbers, loads: Loads) -> tuple[Jet, Numbers, float]:
    """Lift at the angles of the loads, numbers of the load case, maximum lift, m."""
    lift = cycle.contour.lift
    return lift.jet(loads.theta, 2), in_load_case(numbers, cycle.machine), lift.highest.value

"""Speed sweep from standstill to over-speed: surge, contact forces, cam torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value, distinct, firsts, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import first_greatest, first_greatest_of_rows, first_least
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.limits import OVERSPEED
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import (
    Carried,
    PressedGuides,
    Rubbing,
    follower_loads,
    in_guides,
    jam_index,
    share_left,
)
from camwright.pipeline.follower.pivot_forces import Pressed, Pull
from camwright.pipeline.follower.spring import (
    DynamicStiffness,
    HelicalSpring,
    Spring,
    dynamic_stiffness,
    end_travel,
    lever,
)
from camwright.pipeline.follower.spring_kinds import SpringShape
from camwright.pipeline.follower.wound_wire import natural_frequency

ANGLES = 720
UNIFORM = 61  # speeds at equal distances
SIGNIFICANT = 0.01  # force of a harmonic at resonance over the preload
# Speeds about a resonance, in widths: the damping ratio times its speed.
_ABOUT = np.array([-2.0, -1.0, -0.4, 0.0, 0.4, 1.0, 2.0])
_RESONANCE_WIDTH = 0.2  # at most, so that every speed is positive
_REFINED_SPEEDS = 17  # between the neighbours of a worst speed
_MODES = 100  # beyond, the damping merges the resonances
_MET = 600  # resonances resolved, the strongest


@dataclass(frozen=True, eq=False)
class SpeedSweep:
    """Extremes over one turn at constant speeds from standstill; arrays (m,), SI.

    contact_force_* are of the normal force of the rigid follower with inertia, viscous drag, guide
    friction and the surge of the spring, negative where the contact is lost; elastic_force_min is
    of the axial force on the elastic stem without friction, surge included; *_angle are the cam
    angles of the minima; surge_force is the greatest magnitude at the moving end. preload is that
    of the load cases swept; *_error are the sampling errors of the minima, N.
    """

    preload: float
    crank_speed: Array
    contact_force_min: Array
    contact_force_max: Array
    contact_angle: Array
    contact_error: Array
    elastic_force_min: Array
    elastic_angle: Array
    elastic_error: Array
    surge_force: Array
    torque_min: Array
    torque_max: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in _arrays(type(self))})

    def columns(self) -> dict[Column, Array]:
        """Columns of ``5_speed_sweep.csv``."""
        preload = np.full(self.crank_speed.size, self.preload)
        return {
            Column("preload", "N", "Preload of the spring"): preload,
            Column("crank_speed", "rpm", "Crank speed"): self.crank_speed,
            Column(
                "contact_force_min", "N", "Least normal force over the turn, surge included"
            ): self.contact_force_min,
            Column(
                "contact_force_max", "N", "Greatest normal force over the turn, surge included"
            ): self.contact_force_max,
            Column("contact_angle", "deg", "Cam angle of the least normal force"): (
                self.contact_angle
            ),
            Column(
                "elastic_force_min", "N", "Least contact force with an elastic stem and surge"
            ): self.elastic_force_min,
            Column("surge_force", "N", "Greatest change of the spring force by surge"): (
                self.surge_force
            ),
            Column("torque_min", "N m", "Least cam torque over the turn"): self.torque_min,
            Column("torque_max", "N m", "Greatest cam torque over the turn"): self.torque_max,
        }


@dataclass(frozen=True, eq=False)
class SpringSweep:
    """Least and greatest force (2, m), N, at both ends of the hardest spring over the speed.

    crank_speed (m,), rad/s: at which a spring of the nominal rate meets the same harmonics.
    """

    crank_speed: Array
    least: Array
    greatest: Array

    def __post_init__(self) -> None:
        freeze(self, crank_speed=self.crank_speed, least=self.least, greatest=self.greatest)


def highest_speed(machines: Sequence[Machine]) -> float:
    """Highest crank speed of the sweep, rad/s: over-speed, at least the fastest load case."""
    fastest = max(machine.crank_speed for machine in machines)
    return max(machines[0].limits[OVERSPEED] or fastest, fastest)


def speed_sweep(
    machine: Machine, contour: Contour, rubbing: Rubbing, speeds: Sequence[float]
) -> SpeedSweep:
    """Extremes over the turn at speeds from standstill to the greatest of some speeds.

    Parameters
    ----------
    rubbing : Rubbing    of the guides, from a solved load case
    speeds : of float    crank speeds that the sweep contains, rad/s
    """
    follower = _Follower.of(machine, contour.pitch, rubbing)
    ratio = machine.gear_ratio
    grid = follower.resonant.grid(machine, np.asarray(speeds) / ratio)
    swept = follower.extremes(grid)
    worst = {
        first_least(swept["contact_force_min"]),
        first_least(swept["elastic_force_min"]),
        first_greatest(swept["surge_force"]),
    }
    finer = _between(grid, worst)
    more = follower.extremes(finer)
    both = np.concatenate([grid, finer])
    order = np.argsort(both)
    return SpeedSweep(
        preload=machine.spring.preload,
        crank_speed=ratio * both[order],
        **{name: np.concatenate([swept[name], more[name]])[order] for name in swept},
    )


class SweptForces(NamedTuple):
    """Contact forces over a turn at one speed, (n,), N, at n equal cam angles.

    surge: change of the spring force by its surge; elastic: axial contact force with an elastic
    stem, without friction, less that of a rigid follower without surge.
    """

    surge: Array
    elastic: Array


def swept_forces(
    machine: Machine, contour: Contour, rubbing: Rubbing, cam_speed: float
) -> SweptForces:
    """Changes of the contact forces over a turn (n,), N, at one cam speed, rad/s, by surge and by
    an elastic stem.
    """
    follower = _Follower.of(machine, contour.pitch, rubbing)
    speed = np.array([cam_speed])
    moving = follower.resonant.stiffness(speed).moving
    surge = follower.resonant.on_follower(follower.resonant.surge(moving))
    rigid = follower.closing + cam_speed**2 * follower.inertia
    return SweptForces(
        np.broadcast_to(surge[0], ANGLES), follower.elastic(speed[:, None], moving)[0] - rigid
    )


def spring_sweep(
    machine: Machine,
    design: HelicalSpring,
    pitch: FollowerPath,
    preload: float,
    speeds: Sequence[float],
) -> SpringSweep:
    """Forces at both ends of the hardest spring, standstill to the greatest of some speeds.

    The forces are those of the highest rate and preload in tolerance; the sweep extends to the
    speed at which the softest spring meets the same harmonics as at the greatest one.

    Parameters
    ----------
    preload : float      greatest of the load cases, N
    speeds : of float    crank speeds that the sweep contains, rad/s
    """
    spring, spread = machine.spring, machine.spring.rate_tolerance
    at_rest = preload / spring.lever_at_rest
    work = design.at_work(at_rest, 0.0, spring.preload_tolerance, spread)
    hard = replace(spring.own, rate=work.rate, preload=work.preload)
    # The resonances of the hardest spring lie this much above those of the nominal and softest one.
    nominal, softest = np.sqrt(1.0 + spread), np.sqrt((1.0 + spread) / (1.0 - spread))
    resonant = _Resonant.of(hard, design, pitch, spring.shape)
    cam_speeds = softest * np.asarray(speeds) / machine.gear_ratio
    grid = resonant.grid(machine, cam_speeds)
    least, greatest = resonant.end_forces(grid)
    finer = _between(grid, {first_greatest(np.max(greatest - least, axis=0))})
    more = resonant.end_forces(finer)
    swept = machine.gear_ratio * np.concatenate([grid, finer]) / nominal
    return SpringSweep(
        np.minimum(swept, np.max(speeds)),
        np.concatenate([least, more[0]], axis=1),
        np.concatenate([greatest, more[1]], axis=1),
    )


@dataclass(frozen=True, eq=False)
class _Resonant:
    """Harmonics of the travel of a spring, m, which drive it; None: without mass.

    lever: force on the follower over that of the spring, (n,) or 1
    """

    travel: Array
    lever: Value
    spectrum: NDArray[np.complex128]
    spring: Spring
    design: HelicalSpring | None

    @classmethod
    def of(
        cls,
        own: Spring,
        design: HelicalSpring | None,
        pitch: FollowerPath,
        shape: SpringShape | None,
    ) -> _Resonant:
        """Spring on the lift of a path, with the harmonics of its travel; design : None: without
        mass.
        """
        lift = pitch.lift(uniform_turn(ANGLES))
        travel = np.asarray(end_travel(shape, lift))
        return cls(travel, lever(shape, lift), np.fft.rfft(travel), own, design)

    @property
    def order(self) -> Array:
        return np.arange(self.spectrum.size, dtype=float)

    @property
    def amplitude(self) -> Array:
        """Amplitudes of the harmonics, m, from the first."""
        return 2.0 / ANGLES * np.abs(self.spectrum[1:])

    @property
    def first(self) -> float:
        """First natural frequency of the spring, rad/s."""
        if self.design is None:
            return np.inf
        return 2.0 * np.pi * natural_frequency(self.spring.rate, self.design.active_mass)

    def stiffness(self, cam_speed: Array) -> DynamicStiffness:
        """Dynamic stiffness of the coils less the rate at moving and fixed end, N/m, (m,
        harmonics), at cam speeds (m,), rad/s.

        Without mass zero, (m, 1).
        """
        if self.design is None:
            return DynamicStiffness(self.spring.rate, np.zeros((cam_speed.size, 1), dtype=complex))
        drive = cam_speed[:, None] * self.order
        frequency = self.first / (2.0 * np.pi)
        return dynamic_stiffness(drive, self.spring.rate, frequency, self.design.damping)

    def surge(self, stiffness: NDArray[np.complex128]) -> Array:
        """Force of the surge (m, n) of a dynamic stiffness less the rate, N; zero as (m, 1)."""
        if not stiffness.any():
            return np.zeros((len(stiffness), 1))
        return np.fft.irfft(stiffness * self.spectrum, ANGLES)

    def on_follower(self, surge: Array) -> Array:
        """Force of the surge (m, n) on the follower, N."""
        return surge if np.ndim(self.lever) == 0 or surge.shape[1] == 1 else surge * self.lever

    def end_forces(self, cam_speed: Array) -> tuple[Array, Array]:
        """Least and greatest force over the turn at the moving and the fixed end (2, m), N, each,
        at cam speeds (m,), rad/s.
        """
        static = self.spring.force(self.travel)
        ends = self.stiffness(cam_speed)
        forces = [static + self.surge(each) for each in (ends.moving, ends.fixed)]
        least, greatest = (
            np.stack([extreme(end, axis=1) for end in forces]) for extreme in (np.min, np.max)
        )
        return least, greatest

    def grid(self, machine: Machine, known: Array) -> Array:
        """Cam speeds (m,), rad/s, ascending, from standstill to the greatest known one: equally
        spaced, the known ones, and about every resonance of the spring and of the elastic follower.

        Parameters
        ----------
        known : array (k,)   cam speeds that are included, rad/s
        """
        top = float(known.max())
        speeds = [np.linspace(0.0, top, UNIFORM), known]
        enough = SIGNIFICANT * self.spring.preload
        if self.design is not None:
            damping = self.design.damping
            peak = self.spring.rate * self.amplitude / damping
            modes = self.first * np.arange(1.0, _MODES + 1.0)
            speeds.append(_about(_met(modes, peak, enough, top), damping))
        total = machine.axial_stiffness + self.spring.rate
        damping = max(machine.damping_ratio, 1e-3)
        peak = total * self.amplitude / (2.0 * damping)
        frequencies = np.array([machine.follower_frequency])
        speeds.append(_about(_met(frequencies, peak, enough, top), damping))
        return distinct(np.clip(np.concatenate(speeds), 0.0, top))


@dataclass(frozen=True, eq=False)
class _Follower:
    """Follower on its cam: forces (n,) that depend on the speed by powers alone.

    spectrum: of the lift, m; closing: spring, weight and external force; beside: less that of the
    linear spring of the rate at zero lift; inertia, viscous: per square and per first power of the
    cam speed; gain: normal force over axial force without friction; arm: cam torque over that
    force, m; with a pivot or a preload, whose friction is no share of that force, over the axial
    force. pulls: on an arm, at rest and per square of the speed; squeeze: of discs without
    clearance; guided: guides of their stem.
    """

    machine: Machine
    resonant: _Resonant
    spectrum: NDArray[np.complex128]
    theta: Array
    closing: Array
    beside: Array
    inertia: Array
    viscous: Array
    gain: Array
    arm: Array
    pulled: tuple[Array, Array] | None
    pressed: Pressed
    second: Pressed | None
    direction: Array
    pulls: tuple[Pull, Pull, Pull] | None
    squeeze: Squeezed | None
    guided: PressedGuides | None

    @classmethod
    def of(cls, machine: Machine, pitch: FollowerPath, rubbing: Rubbing) -> _Follower:
        """Forces of a follower on its path over the turn, those of inertia and damping at a cam
        speed of 1 rad/s.
        """
        theta = uniform_turn(ANGLES)
        system = replace(machine.system, rubbing=rubbing)
        loads = follower_loads(pitch, system, 1.0, theta)
        share, one, pulled, second = loads.share, np.ones(theta.size), None, None
        carrying = Carried.at(pitch, system, theta, one)
        slide, angle = carrying.slide, loads.pressure_angle
        guided = in_guides(pitch, system, theta)
        if system.held:
            jams = (jam_index(pitch, system, theta, wall) for wall in (one, -one))
            share, pulling = (
                share_left(loads.lift_slope * wall, jam, slide.lock)
                for wall, jam in zip((1.0, -1.0), jams, strict=True)
            )
            if guided is not None:
                share = pulling = np.ones(theta.size)
            second = Carried.at(pitch, system, theta, -one)
            normal = pulling * second.slide.lever * np.cos(second.pressure_angle)
            pulled = 1.0 / normal, (loads.lift_slope + second.slide.torque) / pulling
            angle = carrying.pressure_angle
        pulls, pivot = None, system.pivot
        if pivot is not None:
            external, slope = system.external.at(theta), loads.lift_slope
            resting = pivot.pull(loads.spring_force, external, loads.travel, 0.0, 0.0)
            still = np.zeros(theta.size)
            unloaded = pivot.output and pivot.output.unloaded
            thrown = replace(pivot, gravity_angle=None, output=unloaded).pull(
                still, still, loads.travel, slope, loads.acceleration
            )
            share = np.ones(theta.size)
            pulls = resting, thrown, pivot.of_spring(share, loads.travel)
        spring = machine.spring
        return cls(
            machine=machine,
            resonant=_Resonant.of(spring.own, spring.design, pitch, spring.shape),
            spectrum=np.fft.rfft(pitch.lift(theta)),
            theta=theta,
            closing=loads.closing_force,
            beside=loads.applied_force + _bent(machine.spring, loads.lift),
            # The coils have their own inertia in the surge.
            inertia=loads.inertia_force - machine.spring_mass * loads.acceleration,
            viscous=loads.viscous_force,
            gain=1.0 / (share * slide.lever * np.cos(angle)),
            arm=(loads.lift_slope + slide.torque) / share,
            pulled=pulled,
            second=None if second is None else Pressed.of(second.slide),
            pressed=Pressed.of(slide),
            direction=np.sign(loads.lift_slope),
            pulls=pulls,
            squeeze=system.squeezed(pitch, theta),
            guided=guided,
        )

    def _rubbed(self, push: Array, speed: Array, surge: Array) -> Array:
        """Axial force (m, n), N, from the one without friction: with the friction of a pivot, or of
        guides under a preload; unchanged without them.

        Parameters
        ----------
        push : array (m, n)    axial force without friction, surge included, N
        speed : array (m, 1)   of the cam, rad/s
        surge : array (m, n)   force of the surge on the follower, N
        """
        pivot = self.machine.system.pivot
        if self.guided is not None:
            return self.guided(push, self.direction)
        if pivot is None or self.pulls is None:
            return push
        still, thrown, sprung = self.pulls
        along = still.along + speed**2 * thrown.along + surge * sprung.along
        pull = Pull(along, still.across + speed**2 * thrown.across + surge * sprung.across)
        if self.second is not None:
            tracks, squeeze = (self.pressed, self.second), self.squeeze
            if squeeze is not None:
                return pivot.squeezed(push, tracks, squeeze, pull, self.direction)[0].axial
            return pivot.between(push, tracks, pull, self.direction)[0].axial
        return pivot.balanced(push, self.pressed, pull, self.direction).axial

    def extremes(self, cam_speed: Array) -> dict[str, Array]:
        """Arrays (m,) of `SpeedSweep` by name at cam speeds (m,), rad/s."""
        moving = self.resonant.stiffness(cam_speed).moving
        surge = self.resonant.on_follower(self.resonant.surge(moving))
        speed = cam_speed[:, None]
        push = speed**2 * self.inertia
        push += self.closing
        if self.viscous.any():
            push += speed * self.viscous
        push += surge
        push = self._rubbed(push, speed, surge)
        if self.pulled is None:
            normal = push * self.gain
            torque = np.maximum(push, 0.0, out=push)
            torque *= self.arm
        else:  # a track for either sign
            gain, arm = self.pulled
            first, second = (push, push) if self.squeeze is None else self.squeeze.forces(push)
            normal = np.abs(np.where(push < 0.0, second * gain, first * self.gain))
            torque = push * np.where(push < 0.0, arm, self.arm)
        elastic = self.elastic(speed, moving)
        if self.machine.system.held:
            elastic = np.abs(elastic)
        lowest, soft = first_greatest_of_rows(-normal), first_greatest_of_rows(-elastic)
        return {
            "contact_force_min": normal.min(axis=1),
            "contact_force_max": np.maximum(normal.max(axis=1), 0.0),
            "contact_angle": self.theta[lowest],
            "contact_error": _sampling_error(normal, lowest),
            "elastic_force_min": elastic.min(axis=1),
            "elastic_angle": self.theta[soft],
            "elastic_error": _sampling_error(elastic, soft),
            "surge_force": np.maximum(surge.max(axis=1), -surge.min(axis=1)),
            "torque_min": torque.min(axis=1),
            "torque_max": torque.max(axis=1),
        }

    def elastic(self, speed: Array, moving: NDArray[np.complex128]) -> Array:
        """Axial contact force (m, n), N, of the mass on its elastic stem, by harmonics; the spring
        with its surge.

        Parameters
        ----------
        speed : array (m, 1)            of the cam, rad/s
        moving : array (m, harmonics)   dynamic stiffness of the coils at the moving end less the
            rate, N/m
        """
        machine, spectrum = self.machine, self.spectrum
        stem, rate = machine.axial_stiffness, machine.spring.rate
        mass = machine.mass_without_spring
        damping = 2.0 * machine.damping_ratio * np.sqrt(mass * (stem + rate))
        w = speed * self.resonant.order
        # the waves of a linked spring act by its mean lever
        behind = rate + np.mean(self.resonant.lever) ** 2 * moving - mass * w**2
        joint = stem + 1.0j * damping * w
        force = behind * spectrum
        force[:, 0] += ANGLES * machine.spring.preload
        force += np.fft.rfft(self.beside)
        force *= joint
        joint += behind
        force /= joint
        return np.fft.irfft(force, ANGLES)


def _bent(spring: Spring, lift: Array) -> Array:
    """Force (n,) of a spring less that of the linear one of its rate at zero lift, N."""
    if spring.shape is None:
        return np.zeros_like(lift)
    return spring.force(lift) - (spring.preload + spring.rate * lift)


def _met(modes: Array, peak: Array, enough: float, top: float) -> Array:
    """Cam speeds up to `top`, rad/s, at which a harmonic of the lift meets a natural frequency; the
    strongest `_MET` of them.

    Parameters
    ----------
    modes : array (k,)   natural frequencies, rad/s
    peak : array (h,)    force of each harmonic at resonance, from the first, N
    enough : float       least force of a resonance, N
    """
    order = np.arange(1.0, peak.size + 1.0)[peak >= enough]
    met = modes / order[:, None]
    inside = met <= top
    force = np.broadcast_to(peak[peak >= enough][:, None], met.shape)[inside]
    return np.asarray(met[inside][np.argsort(-force, kind="stable")[:_MET]])


def _about(speeds: Array, damping: float) -> Array:
    """Speeds about the resonances, none closer to another than a fifth of the width."""
    width = min(damping, _RESONANCE_WIDTH)
    every = np.sort((speeds[:, None] * (1.0 + width * _ABOUT)).ravel())
    return every[firsts(np.round(np.log(every) / (0.2 * width)))]


def _between(grid: Array, worst: set[int]) -> Array:
    """Further speeds between each of the worst of a grid (numbers `worst`) and its neighbours, in
    the unit of the grid.
    """
    last = grid.size - 1
    finer = [
        np.linspace(grid[max(k - 1, 0)], grid[min(k + 1, last)], _REFINED_SPEEDS + 2)[1:-1]
        for k in worst
    ]
    beside = distinct(np.concatenate(finer))
    return beside[grid.take(np.searchsorted(grid, beside), mode="clip") != beside]


def _sampling_error(values: Array, at: NDArray[np.intp]) -> Array:
    """Distance of the vertex of the parabola through the least sample, of number `at` (m,), and its
    neighbours from that sample, (m,), for values (m, n).
    """
    row, count = np.arange(at.size), values.shape[1]
    before, here, after = (values[row, (at + step) % count] for step in (-1, 0, 1))
    second = before - 2.0 * here + after
    return np.divide(
        (after - before) ** 2, 8.0 * second, out=np.zeros_like(second), where=second > 0.0
    )


def _arrays(kind: type[SpeedSweep]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind) if field.name != "preload")

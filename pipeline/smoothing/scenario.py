"""Design variables, ratings, scenarios and finite-element corrections of a synthesis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, readonly, uniform_turn
from camwright.pipeline.case.limits import AnyLimit


@dataclass(frozen=True)
class DesignVariables:
    """Design variables: spring rate, N/m; preload, N; prime radius, m; phase, rad.

    The phase is the angle by which the cam leads the spline of its energy on the shaft.
    """

    rate: float
    preload: float
    prime_radius: float
    phase: float = 0.0


@dataclass(frozen=True)
class Ratings:
    """Limits and fixed dimensions of a synthesis, SI; a limit of None is not kept.

    Parameters
    ----------
    limits : mapping           value by row of the table of limits; a row left out is not kept
    travel : float             maximum lift allowed by the spring, m
    hollow_radius : float      minimum concave radius of the contour, m
    pressure : float           least of the limits on the contact pressure, Pa; pressure_by is the
                               check it comes from
    contact_width : float      m
    contact_modulus : float    E*, Pa
    crown_radius : float       of the roller, m; None: straight
    overspeed : float          cam speed at which the contact force margin is kept, rad/s
    jump_speed : float         cam speed below which the follower does not jump, rad/s
    normal_force : float       least of the limits on the normal force, N; normal_force_by is the
                               check it comes from, force_safety its factor on the static rating
    dynamic_rating : float     C of the roller bearing, N
    bearing_drag : float       torque of the roller bearing without load, N m
    bearing_friction_arm : float   its torque per normal force, m
    life_force_cubed : float   limit of the mean of N^3 |n| over the turn, N^3 rad/s
    roller_spin : float        rad/s
    guide_pressure, guide_pv, guide_area : pairs   of guides A and B, Pa, Pa m/s, m^2; pressures as
                               stated, where the check takes them at the temperature of the guide
    """

    roller_radius: float
    offset: float = 0.0
    limits: Mapping[AnyLimit, float] = field(default_factory=dict)
    travel: float | None = None
    hollow_radius: float | None = None
    pressure: float | None = None
    pressure_by: str = "contact_pressure"
    contact_width: float = 1.0
    contact_modulus: float = 1.0
    crown_radius: float | None = None
    overspeed: float | None = None
    jump_speed: float | None = None
    normal_force: float | None = None
    normal_force_by: str = "roller_static"
    force_safety: float = 1.0
    dynamic_rating: float | None = None
    bearing_drag: float = 0.0
    bearing_friction_arm: float = 0.0
    life_force_cubed: float | None = None
    roller_spin: float | None = None
    guide_pressure: tuple[float | None, float | None] = (None, None)
    guide_pv: tuple[float | None, float | None] = (None, None)
    guide_area: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Correction:
    """Finite-element result over closed form at n equally spaced cam angles, each (n,).

    Of the contact pressure, the bearing loads and the normal loads of guides A and B, and the jam
    index at maximum friction. Point supports have neither length nor opposite pushes: without the
    correction the synthesis sees a lower bound of the guide pressure.
    """

    contact: Array
    guide_a: Array
    guide_b: Array
    rubbing_a: Array
    rubbing_b: Array
    jam: Array

    @classmethod
    def none(cls, count: int) -> Correction:
        one = readonly(np.ones(count))
        return cls(one, one, one, one, one, one)

    def towards(self, other: Correction, share: float) -> Correction:
        """Linear interpolation to another correction, at the angles of that one."""
        if share == 1.0:
            return other
        own = self.at(uniform_turn(other.contact.size))
        return Correction(
            *(
                (1.0 - share) * getattr(own, each.name) + share * getattr(other, each.name)
                for each in fields(self)
            )
        )

    def at(self, theta: Array) -> Correction:
        """Corrections at cam angles theta (m,), rad, interpolated linearly."""
        own = np.arange(self.contact.size) * (FULL_TURN / self.contact.size)
        return Correction(
            *(
                np.interp(theta, own, getattr(self, each.name), period=FULL_TURN)
                for each in fields(self)
            )
        )


@dataclass(frozen=True, eq=False)
class Scenario:
    """One load case, or one tolerance corner of it.

    Parameters
    ----------
    cam_speed : float        rad/s
    torque : array (n,)      engine torque at n equal cam angles, of zero mean, crank N m
    weight : float           of its ripple in the objective; 0: limits only
    torque_reduction : float   required of its torque ripple; None: none is required
    mass, viscous_damping, guide_spacing, overhang : float   of the follower, SI
    friction_a, friction_b : float
    friction_worst : two floats   maximum friction of guides A and B; None: not known
    rate_factor, preload_factor : float   spring of the scenario over the nominal spring
    correction : Correction
    """

    name: str
    cam_speed: float
    torque: Array
    mass: float
    guide_spacing: float
    overhang: float
    friction_a: float
    friction_b: float
    viscous_damping: float = 0.0
    rate_factor: float = 1.0
    preload_factor: float = 1.0
    weight: float = 1.0
    torque_reduction: float | None = None
    friction_worst: tuple[float, float] | None = None
    correction: Correction = field(default_factory=lambda: Correction.none(8))

    def torque_at(self, phase: float) -> tuple[Array, Array]:
        """Engine torque, N m, and its derivative, N m/rad, advanced by `phase`, rad of cam."""
        spectrum = np.fft.rfft(self.torque)
        order = 1j * np.arange(spectrum.size)
        if self.torque.size % 2 == 0:
            order[-1] = 0.0  # the last harmonic of an even count has no phase of its own
        turned, count = spectrum * np.exp(order * phase), self.torque.size
        return np.fft.irfft(turned, n=count), np.fft.irfft(order * turned, n=count)

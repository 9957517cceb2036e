"""Variables, ratings, load cases and finite-element corrections of a synthesis."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, readonly, uniform_turn


@dataclass(frozen=True)
class DesignVariables:
    """What a synthesis may free: spring rate N/m, preload N, prime radius m, phase rad.

    The phase is how far the cam is turned ahead on its shaft against the spline of its energy.
    """

    rate: float
    preload: float
    prime_radius: float
    phase: float = 0.0


@dataclass(frozen=True)
class Ratings:
    """Limits and fixed sizes, SI; None leaves a limit out. See `pipeline.checks`.

    curvature_rate is of the contour, 1/(m rad). pressure is the least of the limits on p0 and
    pressure_by the check it comes from, likewise normal_force; overspeed and jump_speed are the
    cam speeds, rad/s, at which a force must be left and none may be missing. force_safety is what
    the roller's rating was divided by to give normal_force, dynamic_rating that of its life, N.
    """

    roller_radius: float
    offset: float = 0.0
    travel: float | None = None
    pressure_angle: float | None = None
    jam_index: float | None = None
    curvature_ratio: float | None = None
    undercut_factor: float | None = None
    hollow_radius: float | None = None
    curvature_rate: float | None = None
    cam_radius: float | None = None
    pressure: float | None = None
    pressure_by: str = "contact_pressure"
    contact_width: float = 1.0
    contact_modulus: float = 1.0
    contact_force_margin: float | None = None
    overspeed: float | None = None
    jump: float | None = None
    jump_speed: float | None = None
    normal_force: float | None = None
    normal_force_by: str = "roller_static"
    force_safety: float = 1.0
    dynamic_rating: float | None = None
    life_force_cubed: float | None = None
    roller_spin: float | None = None
    guide_pressure: tuple[float | None, float | None] = (None, None)
    guide_pv: tuple[float | None, float | None] = (None, None)
    guide_area: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Correction:
    """What finite elements answer over closed forms at the cam angles of a turn, each (n,).

    Of the contact pressure, of the reactions and the rubbing loads of guides A and B, and of the
    jam index at the greatest friction.
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
        """A share of the way to another one, at its angles."""
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
        """The same at other angles, straight lines between."""
        own = np.arange(self.contact.size) * (FULL_TURN / self.contact.size)
        return Correction(
            *(
                np.interp(theta, own, getattr(self, each.name), period=FULL_TURN)
                for each in fields(self)
            )
        )


@dataclass(frozen=True, eq=False)
class Scenario:
    """One load case, or one corner of its tolerances.

    Parameters
    ----------
    cam_speed : float        rad/s
    torque : array (n,)      engine torque at n equal cam angles, of zero mean, crank N m
    weight : float           of its ripple among those of the others; 0: limits only
    mass, viscous_damping, guide_spacing, overhang : float   of the follower, SI
    friction_a, friction_b : float
    friction_worst : two floats   greatest of guides A and B, for their jamming; None: not known
    rate_factor, preload_factor : float   the spring as mounted over the spring as drawn
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
    friction_worst: tuple[float, float] | None = None
    correction: Correction = field(default_factory=lambda: Correction.none(8))

    def torque_at(self, phase: float) -> tuple[Array, Array]:
        """Torque of the engine, N m, and its slope per radian, `phase` (rad of cam) further on."""
        spectrum = np.fft.rfft(self.torque)
        order = 1j * np.arange(spectrum.size)
        if self.torque.size % 2 == 0:
            order[-1] = 0.0  # the last harmonic of an even count has no phase of its own
        turned, count = spectrum * np.exp(order * phase), self.torque.size
        return np.fft.irfft(turned, n=count), np.fft.irfft(order * turned, n=count)

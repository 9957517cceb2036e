"""Valve cams by their machine motion: uneven shaft speed, elastic follower, shape index.

Petrescu and Petrescu (2015) print equations 6.1 to 6.20 of the roller follower; their systems 1 to
15 are lost in the text at hand. What stands here of those is standard mechanics in the paper's
words and is marked *reconstructed*; equations 11 and 15 are certain.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.motion_laws import Motion
from camwright.pipeline.follower.follower_forces import Loads

_SEARCH = 7200


@dataclass(frozen=True)
class ValveCam:
    """A cam with a translating follower, flat (module C) or with a roller (module B).

    Parameters
    ----------
    motion : Motion              s(phi), closed form
    base_radius : float          r0 of the cam's base circle, m, > 0
    roller_radius : float        rb, m, > 0 for module B; unused for C
    offset : float               e, m
    module : "B" or "C"
    cam_mass : float             m_c, kg, > 0
    tappet_mass : float          m_T, kg, >= 0

    References
    ----------
    Petrescu, Petrescu, Independent J. Management & Production 6 (2015), no. 3.
    """

    motion: Motion
    base_radius: float
    roller_radius: float = 0.0
    offset: float = 0.0
    module: Literal["B", "C"] = "B"
    cam_mass: float = 0.2
    tappet_mass: float = 0.1

    def __post_init__(self) -> None:
        least = {"base_radius": 0.0, "cam_mass": 0.0}
        if self.module == "B":
            least["roller_radius"] = 0.0
        for name, bound in least.items():
            if not bound < getattr(self, name) < np.inf:
                raise InputError(f"valve_cam.{name}", getattr(self, name), f"> {bound:g}")
        if not 0.0 <= self.tappet_mass < np.inf:
            raise InputError("valve_cam.tappet_mass", self.tappet_mass, ">= 0 kg")
        prime = self.base_radius + self.roller_radius
        if not abs(self.offset) < prime:
            raise InputError("cam.offset", self.offset, f"below the prime radius of {prime:g} m")

    @property
    def height_base(self) -> float:
        """s0, of the roller's centre at zero lift, m."""
        prime = self.base_radius + self.roller_radius
        return float(np.sqrt(prime**2 - self.offset**2))

    def pressure_angle(self, phi: ArrayLike) -> Array:
        """delta of the roller, rad (eqs 6.2 to 6.4); a flat follower has none."""
        if self.module == "C":
            return np.zeros(np.shape(phi))
        return np.arctan2(self.motion(phi, 1) - self.offset, self.height_base + self.motion(phi))

    def contour_radius_square(self, phi: ArrayLike, derivative: int = 0) -> Array:
        """r_A^2 of the contact on the cam (eq. 6.6), m^2, or its first derivative, m^2/rad.

        For a flat follower (r0 + s)^2 + s'^2.
        """
        s, s1, s2 = (self.motion(phi, k) for k in range(3))
        if self.module == "C":
            height = self.base_radius + s
            if derivative == 0:
                return np.asarray(height**2 + s1**2)
            return np.asarray(2.0 * s1 * (height + s2))
        d, side, inset = self.height_base + s, s1 - self.offset, self.roller_radius
        # r_B cos(delta + tau) = projected / root
        root, projected = np.hypot(d, side), d**2 - self.offset * side
        if derivative == 0:
            square = self.offset**2 + d**2 + inset**2 - 2.0 * inset * projected / root
            return np.asarray(square, dtype=float)
        projected_1 = 2.0 * d * s1 - self.offset * s2
        root_1 = (d * s1 + side * s2) / root
        turned = projected_1 / root - projected * root_1 / root**2
        return np.asarray(2.0 * d * s1 - 2.0 * inset * turned)

    def shape_index(self, phi: ArrayLike) -> Array:
        """(s'/r_A)^2 cos^4 delta (eq. 6.18), which the paper calls a momentary yield.

        It is no efficiency: force and velocity are both projected, which counts the projection
        twice, and a cam without friction transmits all power. It never passes about 0.30 for
        the published cams, and it rewards pressure angles far beyond 30 deg.
        """
        slope, cos = self.motion(phi, 1), np.cos(self.pressure_angle(phi))
        return np.asarray(slope**2 / self.contour_radius_square(phi) * cos**4, dtype=float)

    def rise(self, count: int = 20_000) -> Array:
        """Middles of `count` equal parts of the first segment, rad."""
        step = self.motion.segments[0].angle / count
        return np.asarray((np.arange(count) + 0.5) * step, dtype=float)

    def reduced_inertia(self, phi: ArrayLike) -> Array:
        """J*, kg m^2: half m_c r_A^2 of the cam and m_T s'^2 (eqs 8-10, reconstructed)."""
        cam = 0.5 * self.cam_mass * self.contour_radius_square(phi)
        return np.asarray(cam + self.tappet_mass * self.motion(phi, 1) ** 2)

    def reduced_inertia_slope(self, phi: ArrayLike) -> Array:
        """dJ*/dphi, kg m^2/rad (reconstructed)."""
        cam = 0.5 * self.cam_mass * self.contour_radius_square(phi, 1)
        tappet = 2.0 * self.tappet_mass * self.motion(phi, 1) * self.motion(phi, 2)
        return np.asarray(cam + tappet)

    def mean_reduced_inertia(self) -> float:
        """J*_m, half the sum of the extremes of the turn (eq. 1, reconstructed), kg m^2."""
        values = self.reduced_inertia(uniform_turn(_SEARCH))
        return float(0.5 * (values.max() + values.min()))

    def speed(self, phi: ArrayLike, mean_speed: float, dynamic: ArrayLike = 1.0) -> Array:
        """omega = D omega_m sqrt(J*_m / J*), rad/s (eqs 2 and 3, reconstructed).

        mean_speed : float          omega_m, rad/s; pi n / 60 for a crank at n rpm (eq. 11)
        dynamic : array (...)       D, x'/s' of an elastic follower; 1: kinematic
        """
        ratio = self.mean_reduced_inertia() / self.reduced_inertia(phi)
        return np.asarray(np.asarray(dynamic) * mean_speed * np.sqrt(ratio))

    def angular_acceleration(
        self,
        phi: ArrayLike,
        mean_speed: float,
        dynamic: ArrayLike = 1.0,
        dynamic_slope: ArrayLike = 0.0,
    ) -> Array:
        """epsilon = omega^2 (D'/D - J*'/(2 J*)), rad/s^2 (eq. 5, reconstructed)."""
        square = self.speed(phi, mean_speed, dynamic) ** 2
        inertia = self.reduced_inertia_slope(phi) / (2.0 * self.reduced_inertia(phi))
        return np.asarray(square * (np.asarray(dynamic_slope) / np.asarray(dynamic) - inertia))


def rise_efficiency(loads: Loads) -> float:
    """Share of the cam's work on the rise that reaches spring and mass: guides rub, else 1.

    The true efficiency, beside the shape index. The rise is where the lift grows.
    """
    up = loads.lift_slope > 0.0
    useful = (loads.spring_force + loads.inertia_force) * loads.lift_slope
    return float(np.sum(useful[up]) / np.sum(loads.cam_torque[up]))


def shaft_speed(crank_rpm: float) -> float:
    """omega_m = pi n / 60 of a camshaft at half the crank's speed (eq. 11, certain), rad/s."""
    return float(np.pi * crank_rpm / 60.0)


def follower_acceleration(slope: ArrayLike, bend: ArrayLike, speed: Array, turning: Array) -> Array:
    """x'' omega^2 + x' epsilon, m/s^2 (eq. 15): of any motion over an uneven shaft."""
    return np.asarray(np.asarray(bend) * speed**2 + np.asarray(slope) * turning)


@dataclass(frozen=True)
class ElasticValve:
    """A follower driven through a stiffness and held by a spring (eqs 6 and 12).

    m_T omega^2 x'' + (K + k) x = K s - k x0, with x the place of the follower.

    Parameters
    ----------
    mass : float            m_T, kg, > 0
    stiffness : float       K of the train, N/m, > 0; the paper does not print it
    spring_rate : float     k, N/m, >= 0
    spring_travel : float   x0, compression at zero lift, m, >= 0
    """

    mass: float
    stiffness: float
    spring_rate: float
    spring_travel: float

    def __post_init__(self) -> None:
        for name in ("mass", "stiffness"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"valve.{name}", getattr(self, name), "> 0")
        for name in ("spring_rate", "spring_travel"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"valve.{name}", getattr(self, name), ">= 0")

    @property
    def _sum(self) -> float:
        return self.stiffness + self.spring_rate

    @property
    def _rest(self) -> float:
        """k x0 / (K + k), m: what the preload alone takes."""
        return self.spring_rate * self.spring_travel / self._sum

    def drive_force(self, s: ArrayLike, x: ArrayLike) -> Array:
        """F_m = K (s - x), N (eq. 6)."""
        return self.stiffness * (np.asarray(s) - np.asarray(x))

    def spring_force(self, x: ArrayLike) -> Array:
        """F_r = k (x + x0), N (eq. 6)."""
        return self.spring_rate * (np.asarray(x) + self.spring_travel)

    def quasi_static(self, s: ArrayLike) -> Array:
        """(K s - k x0)/(K + k), m: the limit of eq. 12 at zero speed."""
        return (self.stiffness * np.asarray(s) - self.spring_rate * self.spring_travel) / self._sum

    def dynamic_lift(
        self, s: ArrayLike, slope: ArrayLike, speed: ArrayLike, *, exact: bool = True
    ) -> Array:
        """x by the work over the lift (eqs 13 and 14, reconstructed), m.

        Eq. 12 times x' is integrated from x = 0 at s = 0, with x' = K s'/(K + k) in what drives.
        `exact` solves the quadratic in s - x; otherwise its square is dropped, as printed, which
        leaves the deflection a tenth low, for strong preloads a third.

        Parameters
        ----------
        s, slope : array (...)   m and m/rad
        speed : array (...)      omega, rad/s
        """
        s, total = np.asarray(s, dtype=float), self._sum
        x1 = self.stiffness / total * np.asarray(slope)
        preload = self.spring_rate * self.spring_travel
        work = (
            (self.spring_rate**2 + 2.0 * self.spring_rate * self.stiffness) * s**2
            + 2.0 * preload * total * s
            + total * self.mass * np.asarray(speed) ** 2 * x1**2
        ) / total**2
        reach = s + self._rest
        if exact:
            square = reach**2 - work
            if not (square >= 0.0).all():
                raise ContactError("valve: the follower does not come as far as energy asks")
            return np.asarray(s - work / (reach + np.sqrt(square)))
        return s - work / (2.0 * reach)

    def integrated(self, motion: Motion, speed: float, phi: ArrayLike) -> Array:
        """x of eq. 12 at constant speed, m, from rest under the preload; (n,) at rising angles.

        Raises
        ------
        ContactError
            If the integration fails.
        """
        at = np.asarray(phi, dtype=float)
        if not (np.diff(at) > 0.0).all() or not 0.0 <= at[0] <= at[-1] <= FULL_TURN:
            raise InputError("phi", "not rising within a turn", "rising within 0 and 2 pi rad")
        inertia = self.mass * speed**2

        def rate(angle: float, state: Array) -> list[float]:
            push = self.stiffness * float(motion(angle)) - self.spring_rate * self.spring_travel
            return [state[1], (push - self._sum * state[0]) / inertia]

        period = FULL_TURN / np.sqrt(self._sum / inertia)
        solution = solve_ivp(
            rate, (0.0, float(at[-1])), [-self._rest, 0.0], method="DOP853", t_eval=at,
            rtol=1e-9, atol=1e-13, max_step=min(period / 8.0, 0.02),
        )  # fmt: skip
        if not solution.success:
            raise ContactError(f"valve: the motion cannot be integrated: {solution.message}")
        return np.asarray(solution.y[0])

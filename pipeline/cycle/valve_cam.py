"""Valve cam: machine motion with uneven shaft speed, elastic follower, shape index.

Equation numbers refer to Petrescu and Petrescu (2015): equations 6.1 to 6.20 of the roller follower
as printed; of systems 1 to 15 only 11 and 15 are available, the others are standard mechanics and
marked *reconstructed*.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.motion_laws import SegmentMotion
from camwright.pipeline.follower.follower_forces import Loads

_SEARCH_ANGLES = 7200  # of the turn, for the extremes of the reduced inertia


@dataclass(frozen=True)
class ValveCam:
    """Cam with a translating follower, flat (module C) or with a roller (module B).

    Parameters
    ----------
    motion : SegmentMotion              s(phi), closed form
    base_radius : float          r0 of the base circle, m, > 0
    roller_radius : float        rb, m, > 0 for module B; unused for C
    offset : float               e, m
    module : "B" or "C"
    cam_mass : float             m_c, kg, > 0
    tappet_mass : float          m_T, kg, >= 0

    References
    ----------
    Petrescu, Petrescu, Independent J. Management & Production 6 (2015), no. 3.
    """

    motion: SegmentMotion
    base_radius: float
    roller_radius: float = 0.0
    offset: float = 0.0
    module: Literal["B", "C"] = "B"
    cam_mass: float = 0.2
    tappet_mass: float = 0.1

    def __post_init__(self) -> None:
        """Refuse sizes and masses out of bounds, and an offset beyond the prime radius."""
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
        """Height s0 of the roller centre at zero lift, m."""
        prime = self.base_radius + self.roller_radius
        return float(np.sqrt(prime**2 - self.offset**2))

    def pressure_angle(self, phi: ArrayLike) -> Array:
        """Pressure angle delta (...), rad (eqs 6.2 to 6.4); zero for a flat follower."""
        if self.module == "C":
            return np.zeros(np.shape(phi))
        return np.arctan2(self.motion(phi, 1) - self.offset, self.height_base + self.motion(phi))

    def contour_radius_square(self, phi: ArrayLike, derivative: int = 0) -> Array:
        """Square r_A^2 of the contact radius (eq. 6.6), m^2, at cam angles phi (...), rad, or with
        `derivative` 1 its derivative, m^2/rad.

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
        """Shape index (s'/r_A)^2 cos^4 delta (eq. 6.18), in the source a momentary yield.

        Not an efficiency: force and velocity are both projected, and a cam without friction
        transmits all power. Its maximum is about 0.30 for the published cams, at pressure angles
        far beyond 30 deg.
        """
        slope, cos = self.motion(phi, 1), np.cos(self.pressure_angle(phi))
        return np.asarray(slope**2 / self.contour_radius_square(phi) * cos**4, dtype=float)

    def rise(self, count: int = 20_000) -> Array:
        """Midpoints (count,) of equal parts of the first segment, rad."""
        step = self.motion.segments[0].angle / count
        return np.asarray((np.arange(count) + 0.5) * step, dtype=float)

    def reduced_inertia(self, phi: ArrayLike) -> Array:
        """Reduced inertia J* (...), m_c r_A^2 / 2 + m_T s'^2, kg m^2 (eqs 8-10, reconstructed)."""
        cam = 0.5 * self.cam_mass * self.contour_radius_square(phi)
        return np.asarray(cam + self.tappet_mass * self.motion(phi, 1) ** 2)

    def reduced_inertia_slope(self, phi: ArrayLike) -> Array:
        """dJ*/dphi, kg m^2/rad (reconstructed)."""
        cam = 0.5 * self.cam_mass * self.contour_radius_square(phi, 1)
        tappet = 2.0 * self.tappet_mass * self.motion(phi, 1) * self.motion(phi, 2)
        return np.asarray(cam + tappet)

    def mean_reduced_inertia(self) -> float:
        """Mean J*_m of the extremes over the turn, kg m^2 (eq. 1, reconstructed)."""
        values = self.reduced_inertia(uniform_turn(_SEARCH_ANGLES))
        return float(0.5 * (values.max() + values.min()))

    def speed(self, phi: ArrayLike, mean_speed: float, dynamic: ArrayLike = 1.0) -> Array:
        """Cam speed D omega_m sqrt(J*_m / J*) (...), rad/s (eqs 2 and 3, reconstructed).

        Parameters
        ----------
        mean_speed : float      omega_m, rad/s
        dynamic : array (...)   D, x'/s' of an elastic follower; 1: rigid
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
        """Angular acceleration omega^2 (D'/D - J*'/(2 J*)), rad/s^2 (eq. 5, reconstructed)."""
        square = self.speed(phi, mean_speed, dynamic) ** 2
        inertia = self.reduced_inertia_slope(phi) / (2.0 * self.reduced_inertia(phi))
        return np.asarray(square * (np.asarray(dynamic_slope) / np.asarray(dynamic) - inertia))


def rise_efficiency(loads: Loads) -> float:
    """Efficiency of the rise: work on spring and mass over cam work; 1 without friction."""
    up = loads.lift_slope > 0.0
    useful = (loads.spring_force + loads.inertia_force) * loads.lift_slope
    return float(np.sum(useful[up]) / np.sum(loads.cam_torque[up]))


def shaft_speed(crank_rpm: float) -> float:
    """Camshaft speed omega_m = pi n / 60, rad/s, at crank speed n, rpm (eq. 11)."""
    return float(np.pi * crank_rpm / 60.0)


def follower_acceleration(
    slope: ArrayLike, lift_d2: ArrayLike, speed: Array, turning: Array
) -> Array:
    """Follower acceleration x'' omega^2 + x' epsilon, m/s^2 (eq. 15)."""
    return np.asarray(np.asarray(lift_d2) * speed**2 + np.asarray(slope) * turning)


@dataclass(frozen=True)
class ElasticValve:
    """Follower on an elastic valve train with a spring (eqs 6 and 12).

    m_T omega^2 x'' + (K + k) x = K s - k x0, with the displacement x of the follower.

    Parameters
    ----------
    mass : float            m_T, kg, > 0
    stiffness : float       K of the valve train, N/m, > 0
    spring_rate : float     k, N/m, >= 0
    spring_travel : float   x0, compression at zero lift, m, >= 0
    """

    mass: float
    stiffness: float
    spring_rate: float
    spring_travel: float

    def __post_init__(self) -> None:
        """Refuse a mass or stiffness that is not positive, and a negative spring."""
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
        """Compression of the train by the preload, k x0 / (K + k), m."""
        return self.spring_rate * self.spring_travel / self._sum

    def spring_force(self, x: ArrayLike) -> Array:
        """Spring force F_r = k (x + x0), N (eq. 6)."""
        return self.spring_rate * (np.asarray(x) + self.spring_travel)

    def quasi_static(self, s: ArrayLike) -> Array:
        """Displacement (K s - k x0)/(K + k), m: limit of eq. 12 at zero speed."""
        return (self.stiffness * np.asarray(s) - self.spring_rate * self.spring_travel) / self._sum

    def dynamic_lift(
        self, s: ArrayLike, slope: ArrayLike, speed: ArrayLike, *, exact: bool = True
    ) -> Array:
        """Displacement x by the work over the lift, m (eqs 13 and 14, reconstructed).

        Eq. 12 times x' is integrated from x = 0 at s = 0, with x' = K s'/(K + k) in the driving
        term. `exact` solves the quadratic equation in s - x; otherwise its square is neglected, as
        printed: a deflection too small by a tenth, at high preload by a third.

        Parameters
        ----------
        s, slope : array (...)   m and m/rad
        speed : array (...)      omega, rad/s

        Raises
        ------
        ContactError
            If the exact equation has no real solution.
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
                raise ContactError("valve: no real displacement of the follower by energy")
            return np.asarray(s - work / (reach + np.sqrt(square)))
        return s - work / (2.0 * reach)

    def integrated(self, motion: SegmentMotion, speed: float, phi: ArrayLike) -> Array:
        """Displacement (n,) by eq. 12 at constant speed, m, from rest on the compressed train.

        Parameters
        ----------
        motion : SegmentMotion   lift s(phi), m
        speed : float            of the cam, rad/s
        phi : array (n,)         cam angles, rad, increasing within 0 and 2 pi

        Raises
        ------
        InputError
            If the angles do not increase.
        ContactError
            If the integration fails.
        """
        at = np.asarray(phi, dtype=float)
        if not (np.diff(at) > 0.0).all() or not 0.0 <= at[0] <= at[-1] <= FULL_TURN:
            raise InputError("phi", "not increasing", "increasing within 0 and 2 pi rad")
        inertia = self.mass * speed**2

        def rate(angle: float, state: Array) -> list[float]:
            push = self.stiffness * float(motion(angle)) - self.spring_rate * self.spring_travel
            return [state[1], (push - self._sum * state[0]) / inertia]

        period = FULL_TURN / np.sqrt(self._sum / inertia)
        solution = scipy.integrate.solve_ivp(
            rate, (0.0, float(at[-1])), [-self._rest, 0.0], method="DOP853", t_eval=at,
            rtol=1e-9, atol=1e-13, max_step=min(period / 8.0, 0.02),
        )  # fmt: skip
        if not solution.success:
            raise ContactError(f"valve: integration failed: {solution.message}")
        return np.asarray(solution.y[0])

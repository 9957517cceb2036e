"""Tangential line contact: stick zone, traction, creepage, slip of a driven roller.

Equal materials: pressure and traction are uncoupled. `ratio` is the tangential force over friction
coefficient times normal force; `x` is in half-widths, from the leading to the trailing edge;
tractions are over friction coefficient times peak pressure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, Value, Values, finite, freeze, positive, readonly
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_in_plane, von_mises

_TABLE_SHARES = 21  # traction coefficients of a table, from none to full sliding
_LEAST_STICK = 1e-9
# Places of the greatest stress: reach beside and below the contact in half-widths, cells to the
# reach and, of each zoom, to a cell.
_GRID_REACH, _CELLS, _NEARBY, _TABLE_ZOOMS = 1.25, 25, 5, 4
_TURNS_MAX, _SPIN_HALVINGS = 50, 60  # turns that settle, then halvings of the range of the spin
_SPEED_CONVERGED = 1e-9  # relative speed of a periodic roller


def stick_half_width(ratio: ArrayLike) -> Array:
    """Half-width of the stick zone over that of the contact: 1 at no, 0 at full traction.

    References
    ----------
    Carter (1926); Johnson, Contact Mechanics (1985), sec. 8.3.
    """
    return np.sqrt(1 - _ratio(ratio))


def rolling_increase(poisson: float, friction: float, ratio: Array) -> tuple[Array, Array]:
    """Increase of maximum in-plane shear and von Mises stress by Carter's traction.

    Parameters
    ----------
    poisson : float
    friction : float      coefficient, > 0
    ratio : array (...)   tangential force over friction times normal force, in [0, 1]

    Returns
    -------
    shear, mises : array (...)   maxima over those without traction

    References
    ----------
    The traction is an ellipse less a smaller one: `hertz.subsurface_stress` of both.
    """
    shares, shear, mises = _increase(float(poisson), float(friction))
    return np.interp(ratio, shares, shear), np.interp(ratio, shares, mises)


@lru_cache(maxsize=16)
def _increase(poisson: float, friction: float) -> tuple[Array, Array, Array]:
    """Shares of the friction (m,), and at each the maximum in-plane shear and the maximum von Mises
    stress over those without traction.
    """
    shares = np.linspace(0.0, 1.0, _TABLE_SHARES)
    stick = np.maximum(stick_half_width(shares), _LEAST_STICK)[:, None]

    def stress(x: Array, depth: Array) -> Array:
        small = _sliding_stress((x - (stick - 1.0)) / stick, depth / stick)
        along = _sliding_stress(x, depth) - stick * small
        return hertz.subsurface_stress(x, depth) + friction * along

    shear = _greatest(lambda *place: shear_in_plane(stress(*place)))
    mises = _greatest(lambda *place: von_mises(stress(*place), poisson))
    return readonly(shares), readonly(shear / shear[0]), readonly(mises / mises[0])


def _sliding_stress(x: Array, depth: Array) -> Array:
    """Stress (3, ...) under a traction of the shape of the pressure of Hertz, over its peak."""
    return hertz.subsurface_stress(x, depth, 1.0) - hertz.subsurface_stress(x, depth)


def _greatest(measure: Callable[[Array, Array], Array]) -> Array:
    """Maxima (m,) of m stress measures over the solid under the contact, by search on ever finer
    grids.

    measure: function of x and depth, both (m, n) in half-widths, that returns (m, n)
    """
    half = _GRID_REACH / _CELLS
    sides = np.linspace(-_GRID_REACH, _GRID_REACH, 2 * _CELLS + 1)
    x, depth = (each.ravel()[None] for each in np.meshgrid(sides, sides[_CELLS:]))
    nearby = np.meshgrid(*[np.linspace(-1.0, 1.0, 2 * _NEARBY + 1)] * 2)
    for zoom in range(_TABLE_ZOOMS):
        values = measure(x, depth)
        worst = values.argmax(axis=1)[:, None]
        x, depth = (np.take_along_axis(np.broadcast_to(each, values.shape), worst, axis=1)
                    for each in (x, depth))  # fmt: skip
        step = half / _NEARBY**zoom
        x, depth = (at + step * each.ravel() for at, each in zip((x, depth), nearby, strict=True))
        depth = np.maximum(depth, 0.0)
    return np.asarray(measure(x, depth).max(axis=1))


def creepage(
    ratio: ArrayLike, friction: float, half_width: ArrayLike, relative_radius: ArrayLike
) -> Array:
    """Creep speed over rolling speed (...) of steady rolling below full slip.

    Parameters
    ----------
    ratio : array (...)              in [0, 1]
    friction : float                 coefficient, > 0
    half_width : array (...)         m
    relative_radius : array (...)    m

    References
    ----------
    Carter (1926); Johnson, Contact Mechanics (1985), sec. 8.3.
    """
    radius = positive("relative_radius", relative_radius, "m")
    slope = friction * np.asarray(half_width, dtype=float) / radius
    return slope * (1 - stick_half_width(ratio))


def ring_inertia(radius: Value, hub_radius: float, width: Value, density: float) -> Value:
    """Moment of inertia of a solid ring about its axis, kg m2: upper bound for a bearing ring."""
    return 0.5 * np.pi * density * width * (radius**4 - hub_radius**4)


@dataclass(frozen=True)
class Drag:
    """Inertia and bearing drag of a roller, and its friction coefficient on the cam.

    inertia kg m2; torque N m, load-free drag of bearing and seals; bearing_friction times normal
    force times pin_radius (m), load-dependent drag; friction of roller on cam, > 0.
    """

    inertia: float
    friction: float
    torque: float = 0.0
    bearing_friction: float = 0.0
    pin_radius: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a drag that is negative, and a friction coefficient that is not positive."""
        for name in ("inertia", "torque", "bearing_friction", "pin_radius"):
            if not 0 <= getattr(self, name) < np.inf:
                raise InputError(f"drag.{name}", getattr(self, name), ">= 0")
        if not 0 < self.friction < np.inf:
            raise InputError("drag.friction", self.friction, "> 0")

    def bearing_torque(self, normal_force: Values) -> Values:
        """Drag torque (n,) of the bearing, N m."""
        return self.torque + self.bearing_friction * self.pin_radius * normal_force


@dataclass(frozen=True, eq=False)
class RollingContact:
    """Roller driven by the cam over one turn, arrays (n,).

    demand N, tangential force of rolling without slip; force N, transmitted tangential force, at
    most friction times normal force; slip m/s, rolling speed less surface speed of the roller;
    creepage, micro-slip over rolling speed while sticking, slip over rolling speed while sliding;
    skidding, 1 or 0; utilisation, |demand| over friction times normal force, infinite without
    contact force; loss J, of slip and creep in one turn.
    """

    demand: Array
    force: Array
    slip: Array
    creepage: Array
    skidding: Array
    utilisation: Array
    loss: float

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in _OF_ANGLES})

    def where(self, carries: NDArray[np.bool_], other: RollingContact) -> RollingContact:
        """Contact of the roller that carries (n,): of another one where that does."""
        pairs = {name: (getattr(other, name), getattr(self, name)) for name in _OF_ANGLES}
        arrays = {name: np.where(carries, *pair) for name, pair in pairs.items()}
        return RollingContact(**arrays, loss=self.loss + other.loss)


_OF_ANGLES = ("demand", "force", "slip", "creepage", "skidding", "utilisation")


def rolling_demand(
    inertia: Value, bearing: Values, spin: Values, spin_acceleration: Values, radius: Value
) -> Values:
    """Tangential force of rolling without slip (...), N: inertia and bearing drag of the roller."""
    return (inertia * spin_acceleration + np.sign(np.real(spin)) * bearing) / radius


def rolling_contact(
    normal_force: ArrayLike,
    spin: ArrayLike,
    spin_acceleration: ArrayLike,
    rolling_speed: ArrayLike,
    half_width: ArrayLike,
    relative_radius: ArrayLike,
    *,
    drag: Drag,
    radius: float,
    period: float,
) -> RollingContact:
    """Periodic rolling, creep and skidding of the roller over one turn.

    The demand is that of the spin acceleration at each position. Where it exceeds friction times
    normal force the contact slips under that force until the roller has regained the rolling
    speed, by one implicit step per position (Moreau): the impulse that restores rolling, limited by
    friction.

    Parameters
    ----------
    normal_force : array (n,)      N, at positions equally spaced in time
    spin : array (n,)              rad/s of rolling without slip
    spin_acceleration : array (n,)  rad/s2 of it
    rolling_speed : array (n,)     surface speed through the contact, m/s
    half_width, relative_radius : array (n,)   m
    drag : Drag
    radius : float                 of the roller, m
    period : float                 s, of one turn

    Returns
    -------
    RollingContact

    Raises
    ------
    InputError
        If a value is not finite, or the radius or the period not positive.
    ContactError
        If no spin of the roller recurs after a turn.

    References
    ----------
    Carter (1926) for the creepage; Moreau (1988) for the steps.
    """
    demand, tangential, slip = rolling_slip(
        normal_force, spin, spin_acceleration, drag=drag, radius=radius, period=period
    )
    limit = drag.friction * np.maximum(normal_force, 0.0)
    speed, step = np.abs(finite("rolling_speed", rolling_speed)), period / limit.size
    sliding = slip != 0.0
    share = np.divide(np.abs(tangential), limit, out=np.zeros_like(limit), where=limit > 0)
    creep = creepage(np.clip(share, 0, 1), drag.friction, half_width, relative_radius)
    gross = np.divide(np.abs(slip), speed, out=np.zeros_like(slip), where=speed > 0)
    creep = np.where(sliding & (limit > 0), gross, np.where(limit > 0, creep, 0.0))
    idle = np.where(np.abs(demand) > 0, np.inf, 0.0)
    return RollingContact(
        demand=demand,
        force=tangential,
        slip=slip,
        creepage=creep,
        skidding=(sliding & (limit > 0)).astype(float),
        utilisation=np.divide(np.abs(demand), limit, out=idle, where=limit > 0),
        loss=float(np.sum(np.abs(tangential) * creep * speed) * step),
    )


def rolling_slip(
    normal_force: ArrayLike,
    spin: ArrayLike,
    spin_acceleration: ArrayLike,
    *,
    drag: Drag,
    radius: float,
    period: float,
) -> tuple[Array, Array, Array]:
    """Tangential force that rolling without slip needs and that which is transmitted (n,), N, and
    slip of the roller (n,), m/s; see `rolling_contact`.
    """
    positive("roller.radius", radius, "m")
    positive("period", period, "s")
    force = np.maximum(finite("normal_force", normal_force), 0.0)
    rolling, limit = finite("spin", spin), drag.friction * force
    rate, resisting = finite("spin_acceleration", spin_acceleration), drag.bearing_torque(force)
    demand = rolling_demand(drag.inertia, resisting, rolling, rate, radius)
    step = period / force.size
    tangential, turning = _steps(rolling, demand, limit, resisting, drag.inertia, radius, step)
    slip = radius * (rolling - turning)
    sliding = np.abs(slip) > _SPEED_CONVERGED * radius * np.abs(rolling).max(initial=1e-300)
    return demand, tangential, np.where(sliding, slip, 0.0)


def _steps(
    rolling: Array,
    demand: Array,
    limit: Array,
    resisting: Array,
    inertia: float,
    radius: float,
    step: float,
) -> tuple[Array, Array]:
    """Tangential force (n,), N, and spin of the roller (n,), rad/s, over the periodic turn; see
    `rolling_contact`.

    Parameters
    ----------
    rolling : array (n,)     spin of rolling without slip, rad/s
    demand : array (n,)      tangential force of rolling without slip, N
    limit : array (n,)       friction coefficient times normal force, N
    resisting : array (n,)   drag torque of the bearing, N m
    inertia : float          of the roller, kg m2
    radius : float           of the roller, m
    step : float             time between positions, s

    Raises
    ------
    ContactError
        If no spin recurs after a turn.
    """
    tangential, turning = np.zeros(rolling.size), np.array(rolling)
    columns = (rolling, demand, limit, resisting, np.sign(rolling))
    rows = list(zip(*(each.tolist() for each in columns), strict=True))
    settled = _SPEED_CONVERGED * max(float(np.abs(rolling).max()), 1e-300)

    def turned(omega: float) -> float:
        """Spin after a turn from one, rad/s; the turn is written."""
        before = float(rolling[-1])
        for k, (target, rolled, most, drag, way) in enumerate(rows):
            if omega == before and target * before >= 0.0:  # not where another wall turns it back
                needed = rolled
            else:
                needed = (inertia * (target - omega) / step + way * drag) / radius
            pull = min(max(needed, -most), most)
            if abs(needed) <= most:
                omega = target
            elif inertia == 0:
                omega = 0.0
            else:
                omega = _braked(omega + pull * radius * step / inertia, drag * step / inertia)
            tangential[k], turning[k], before = pull, omega, target
        return omega

    omega = float(rolling[-1])
    for _ in range(_TURNS_MAX):
        start, omega = omega, turned(omega)
        if abs(omega - start) <= settled:
            return tangential, turning
    # a heavy roller with little friction takes many turns; a greater spin leaves a greater one
    low, high = min(float(rolling.min()), 0.0), max(float(rolling.max()), 0.0)
    for _ in range(_SPIN_HALVINGS):
        start = 0.5 * (low + high)
        omega = turned(start)
        if abs(omega - start) <= settled:
            return tangential, turning
        low, high = (start, high) if omega > start else (low, start)
    raise ContactError(
        f"roller: its spin changes by {abs(omega - start):.3g} rad/s over a turn, must recur"
    )


def _braked(omega: float, loss: float) -> float:
    """Spin after a loss by drag, which cannot reverse it, rad/s."""
    return float(np.sign(omega) * max(abs(omega) - loss, 0.0))


def _ratio(ratio: ArrayLike) -> Array:
    """Tangential force over friction limit as array (...); InputError outside [0, 1]."""
    values = finite("ratio", ratio)
    if ((values < 0) | (values > 1)).any():
        worst = float(values.flat[np.argmax(np.abs(values - 0.5))])
        raise InputError("tangential force over friction limit", worst, "in [0, 1]")
    return values

"""Stored energy over the turn as a periodic quintic B-spline; exact start of a search.

Of a cam with equal lobes the splines are those of one lobe: the unknowns of all lobes are the same,
and the lobes repeat to round-off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, finite, positive, readonly, uniform_turn
from camwright.geometry.energy import MEAN_TOLERANCE, stored_energy
from camwright.geometry.errors import InputError
from camwright.pipeline.follower.spring import spring_force, stored_lift
from camwright.pipeline.follower.spring_kinds import SpringShape

DEGREE = 5
LEAST_COEFFICIENTS = 12
_FIT_ANGLES = 1440
_REFINEMENTS = 3
ORDERS = 4  # E, E', E'', E'''
_REVERSAL_SIDE = 1e-200  # J/rad, E' beside a reversal: its sign alone counts
_REVERSAL_STEPS = 3
_LEAST_CURVATURE = 1e-3  # of the greatest E'': of a reversal that is followed


@lru_cache(maxsize=1)
def _pieces() -> Array:
    """Polynomials (6, 6) of the cardinal quintic B-spline, one row for each of its six knot
    intervals: coefficients of rising powers of the place within the interval, 0 to 1.
    """
    spline = scipy.interpolate.BSpline.basis_element(np.arange(DEGREE + 2), extrapolate=False)
    powers = scipy.interpolate.PPoly.from_spline((spline.t, spline.c, spline.k)).c[::-1]
    inside = powers[:, DEGREE:-DEGREE] if powers.shape[1] > DEGREE + 1 else powers
    return readonly(inside.T)


def basis_matrix(
    theta: ArrayLike, count: int, derivative: int = 0, lobes: int = 1
) -> scipy.sparse.csr_array:
    """Sparse matrix (n, count) of periodic quintic B-splines or a derivative, at cam angles.

    Parameters
    ----------
    theta : array (n,)   cam angle, rad
    count : int          splines of one lobe, >= 12
    derivative : int     0 to 4, per rad
    lobes : int          equal lobes of the turn

    Raises
    ------
    InputError
        If there are too few splines or the derivative is not continuous.

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. IX.
    """
    values, columns = basis_rows(theta, count, derivative, lobes)
    rows = np.repeat(np.arange(len(columns)), DEGREE + 1)
    return scipy.sparse.csr_array(
        (values.ravel(), (rows, columns.ravel())), shape=(len(columns), count)
    )


def basis_rows(
    theta: ArrayLike, count: int, derivative: int = 0, lobes: int = 1
) -> tuple[Array, NDArray[np.intp]]:
    """Values of the six B-splines that are not zero at each cam angle (n, 6), and their indices
    (n, 6): the entries and columns of `basis_matrix`, whose parameters it has.
    """
    if derivative not in range(DEGREE):
        raise InputError("derivative", derivative, "0, 1, 2, 3 or 4")
    values, columns = _rows(theta, count, (derivative,), lobes)
    return values[0], columns


def _rows(
    theta: ArrayLike, count: int, derivatives: Sequence[int], lobes: int
) -> tuple[Array, NDArray[np.intp]]:
    """Derivatives (d, n, 6), by the cam angle, of the six B-splines that are not zero at each cam
    angle, and their indices (n, 6).

    Parameters
    ----------
    theta : array (n,)       cam angles, rad
    count : int              splines of a lobe
    derivatives : sequence   the d orders, 0 to 5
    lobes : int              equal lobes of the turn

    Raises
    ------
    InputError
        If there are too few splines, or an angle is not finite.
    """
    if not count >= LEAST_COEFFICIENTS:
        raise InputError("smoothing.coefficients", count, f">= {LEAST_COEFFICIENTS}")
    angle = np.mod(lobes * finite("theta", theta), FULL_TURN)
    part = FULL_TURN / count
    interval = np.minimum((angle / part).astype(np.intp), count - 1)
    step = (angle / part - interval)[:, None]
    powers = [step**power for power in range(DEGREE + 1 - min(derivatives))]
    values = np.zeros((len(derivatives), angle.size, DEGREE + 1))
    for k, derivative in enumerate(derivatives):
        for power in range(derivative, DEGREE + 1):
            front = np.prod(np.arange(power - derivative + 1, power + 1))
            values[k] += front * powers[power - derivative] * _pieces()[:, power]
        values[k] /= (part / lobes) ** derivative
    return values, np.mod(interval[:, None] - np.arange(DEGREE + 1), count)


@dataclass(frozen=True, eq=False)
class Grid:
    """B-splines and derivatives at cam angles (m,), rad: columns (m, 6), entries (order, m, 6).

    side (m,): sign of E' at a reversal, where E' is zero, else 0; see `reversals`. None: at none.
    """

    theta: Array
    columns: NDArray[np.intp]
    entries: Array
    side: Array | None = None

    @classmethod
    def at(cls, theta: Array, count: int, lobes: int = 1) -> Grid:
        """Grid of `count` splines a lobe at cam angles theta (m,), rad."""
        entries, columns = _rows(theta, count, range(ORDERS), lobes)
        return cls(theta, columns, entries)

    def energy(self, coefficients: Array) -> tuple[Array, ...]:
        """Stored energy and its derivatives by the cam angle, E, E', E'', E''', J/rad^k, each (m,),
        from the coefficients (count,), J, of its splines.

        Where the follower reverses, E' has the sign of the side from which the angle is approached.
        """
        local = coefficients[self.columns]
        parts = [np.sum(entry * local, axis=1) for entry in self.entries]
        if self.side is not None:
            parts[1] = parts[1] + _REVERSAL_SIDE * self.side
        return tuple(parts)

    def joined(self, other: Grid) -> Grid:
        """Grid of the angles of both."""
        sides = (np.zeros(each.theta.size) if each.side is None else each.side
                 for each in (self, other))  # fmt: skip
        return Grid(
            np.concatenate([self.theta, other.theta]),
            np.concatenate([self.columns, other.columns]),
            np.concatenate([self.entries, other.entries], axis=1),
            np.concatenate([*sides]),
        )

    def chained(self, local: Array) -> Array:
        """Derivatives (m, 6) by the coefficients from those (4, m) by E, E', E'', E'''."""
        return np.asarray(np.einsum("km,kmj->mj", local, self.entries))


def reversals(turn: Grid, coefficients: Array, lobes: int) -> Grid:
    """Splines at the cam angles where the follower reverses (E' = 0), r angles by Newton's method,
    each twice, as approached from either side (2 r,).

    The angles move with the coefficients: E' stays zero, so that the entries are total derivatives,
    B^(k) - E^(k+1)/E'' B', with B a spline. Reversals of next to no curvature, as in a dwell, are
    left out.

    Parameters
    ----------
    turn : Grid                     equally spaced cam angles of the turn
    coefficients : array (count,)   of the energy of a lobe, J
    lobes : int                     equal lobes of the turn
    """
    slope, energy_d2 = turn.energy(coefficients)[1:3]
    k = np.flatnonzero((slope > 0.0) != (np.roll(slope, -1) > 0.0))
    step, count = FULL_TURN / turn.theta.size, coefficients.size
    after = slope[(k + 1) % slope.size]
    theta = turn.theta[k] + step * slope[k] / (slope[k] - after)
    for _ in range(_REVERSAL_STEPS):  # Newton on E' = 0
        _, slopes, bends, _ = Grid.at(theta, count, lobes).energy(coefficients)
        newton = np.divide(slopes, bends, out=np.zeros(k.size), where=bends != 0.0)
        theta = np.clip(theta - newton, turn.theta[k], turn.theta[k] + step)
    entries, columns = _rows(theta, count, range(ORDERS + 1), lobes)
    local = coefficients[columns]
    orders = np.sum(entries * local, axis=2)
    sharp = np.abs(orders[2]) > _LEAST_CURVATURE * np.abs(energy_d2).max(initial=0.0)
    theta, columns, entries, orders = (
        theta[sharp], columns[sharp], entries[:, sharp], orders[:, sharp],
    )  # fmt: skip
    moving = entries[:ORDERS] - (orders[1:] / orders[2])[:, :, None] * entries[1]
    moving[1] = 0.0
    side = np.where(orders[2] > 0.0, -1.0, 1.0)
    return Grid(
        np.repeat(theta, 2),
        np.repeat(columns, 2, axis=0),
        np.repeat(moving, 2, axis=1),
        np.ravel(np.column_stack([side, -side])),
    )


def fitted_energy(cam_torque: ArrayLike, count: int, lobes: int = 1) -> Array:
    """Coefficients (count,), J, of the energy whose derivative fits the torque; its minimum is 0.

    Parameters
    ----------
    cam_torque : array (n,)   N m at n equal cam angles, of zero mean
    count : int               splines of one lobe, >= 12
    lobes : int               equal lobes of the turn, in which the torque repeats

    Raises
    ------
    InputError
        If the torque has a mean: the energy would not close over the turn.
    """
    torque = finite("cam_torque", cam_torque)
    if not abs(torque.mean()) <= MEAN_TOLERANCE * float(np.abs(torque).max()):
        raise InputError(
            "cam_torque.mean", float(torque.mean()), "0 N m, or the cam does not close"
        )
    theta = uniform_turn(torque.size)
    energy, _ = stored_energy(theta, torque)
    level, slope = (basis_matrix(theta, count, order, lobes) for order in (0, 1))
    # the slope leaves the constant undetermined: a small weight on the energy fixes it
    weight = 1e-6
    normal = (slope.T @ slope + weight * (level.T @ level)).tocsc()
    coefficients = scipy.sparse.linalg.spsolve(
        normal, slope.T @ torque + weight * (level.T @ energy)
    )
    return readonly(coefficients - lowest(coefficients))


def spline_of(values: Array, count: int) -> Array:
    """Coefficients (count,) of the splines through values (n,) at n equal angles of a lobe, by
    least squares.
    """
    level = basis_matrix(uniform_turn(values.size), count)
    return readonly(scipy.sparse.linalg.spsolve((level.T @ level).tocsc(), level.T @ values))


def of_constant_breadth(coefficients: Array) -> Array:
    """Coefficients (count,), m, of a lift whose sum with that half a turn later is constant, the
    nearest to those of another lift, with a minimum of zero; an even number, odd lobes.
    """
    odd = odd_part(coefficients)
    return readonly(odd - lowest(odd))


def odd_part(coefficients: Array) -> Array:
    """Coefficients (count,) of the part of a lift that changes its sign after half a turn."""
    return 0.5 * (coefficients - np.roll(coefficients, coefficients.size // 2))


def breadth_changes(count: int) -> Array:
    """Rows (count/2 - 1, count) that are zero of the coefficients of a lift of constant breadth:
    its sum with that half a turn later is that of opposite coefficients, each the same.
    """
    half = count // 2
    opposite = np.tile(np.eye(half), 2)
    return np.asarray(opposite[1:] - opposite[:1])


def lowest(coefficients: Array) -> float:
    """Minimum of the stored energy over the turn, J, on a grid finer than the knots, refined by
    Newton's method between its angles.

    The angle of one lobe is scaled to a turn, which does not change the minimum.

    Parameters
    ----------
    coefficients : array (count,)   of the splines of a lobe, J
    """
    theta = uniform_turn(max(_FIT_ANGLES, 16 * coefficients.size))
    values = basis_matrix(theta, coefficients.size) @ coefficients
    near = theta[(values <= np.roll(values, 1)) & (values <= np.roll(values, -1))]
    for _ in range(_REFINEMENTS):  # Newton on E' = 0
        slope, energy_d2 = (
            basis_matrix(near, coefficients.size, order) @ coefficients for order in (1, 2)
        )
        shift = np.divide(slope, energy_d2, out=np.zeros_like(slope), where=energy_d2 > 0.0)
        near = near - np.clip(shift, -theta[1], theta[1])
    between = basis_matrix(near, coefficients.size) @ coefficients
    return float(min(values.min(), between.min(initial=np.inf)))


def force_moment(
    energy: ArrayLike,
    rate: float,
    preload: float,
    prime_radius: float,
    shape: SpringShape | None = None,
) -> Array:
    """Spring force times radius, F_s r, N m; concave in the energy where r0 >= P / k.

    Parameters
    ----------
    energy : array (...)    E, J, >= 0
    rate, preload : float   k, N/m; P, N
    prime_radius : float     r0 of the pitch curve, m
    shape : SpringShape      None: a linear spring
    """
    if shape is not None:
        lift = stored_lift(energy, rate, preload, shape)
        return np.asarray(spring_force(preload, rate, lift, shape) * (prime_radius + lift))
    square = preload**2 + 2.0 * rate * np.asarray(energy, dtype=float)
    return np.asarray((prime_radius - preload / rate) * np.sqrt(square) + square / rate)


def exact_start(
    cam_torque: ArrayLike,
    count: int,
    *,
    rate: float,
    preload: float,
    prime_radius: float,
    pressure_angle: float,
    energy_max: float,
    slope_max: float | None = None,
    shape: SpringShape | None = None,
    lobes: int = 1,
) -> Array:
    """Coefficients of the energy that balances the torque, raised to keep the pressure angle.

    Of a flat face, until its width holds.

    Parameters
    ----------
    cam_torque : array (n,)   N m at n equal cam angles, of zero mean
    count : int               splines of one lobe
    rate, preload : float     of the spring, N/m and N, > 0
    prime_radius : float       of the pitch curve, m, > 0
    pressure_angle : float    limit, rad
    energy_max : float        maximum stored energy beyond the preload, J; may be infinite
    slope_max : float         lift per radian at the edge of a flat face, m; None: a roller
    shape : SpringShape       None: a linear spring
    lobes : int               equal lobes of the turn, in which the torque repeats

    Returns
    -------
    array (count,)   J; where `energy_max` is less than the rise requires, the energy with its
                     maximum at `energy_max`

    Raises
    ------
    InputError
        If a value is not positive, or the torque has a mean.
    """
    for name, value in (("spring.rate", rate), ("spring.preload", preload),
                        ("cam.prime_radius", prime_radius),
                        ("limits.pressure_angle", pressure_angle)):  # fmt: skip
        positive(name, value)
    coefficients = fitted_energy(cam_torque, count, lobes)
    theta = uniform_turn(_FIT_ANGLES)
    energy = basis_matrix(theta, count, 0, lobes) @ coefficients
    slope = np.abs(basis_matrix(theta, count, 1, lobes) @ coefficients)

    def excess(rise: float) -> float:
        level = np.maximum(energy + rise, 0.0)
        if slope_max is not None:
            force = np.sqrt(preload**2 + 2.0 * rate * level)
            if shape is not None:
                lift = stored_lift(level, rate, preload, shape)
                force = spring_force(preload, rate, lift, shape)
            steepest = slope_max * force
        else:
            steepest = np.tan(pressure_angle) * force_moment(
                level, rate, preload, prime_radius, shape
            )
        return float((slope - steepest).max())

    highest = float(energy.max())
    if highest > energy_max:
        return readonly(coefficients * (energy_max / highest))
    rise = 0.0
    if excess(0.0) > 0:
        top = max(highest, 1e-9)
        while excess(top) > 0:
            top *= 2.0
        rise = float(scipy.optimize.brentq(excess, 0.0, top, xtol=1e-12))
    return readonly(coefficients + min(rise, energy_max - highest))

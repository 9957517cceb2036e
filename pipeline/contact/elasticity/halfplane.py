"""Half-plane under piecewise-linear pressure, in closed form.

Reference for the finite-element compliance, and far field of the contact patch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(6)


def point_force_displacement(x: ArrayLike, depth: ArrayLike, poisson: float) -> Array:
    """Displacement (2, ...) of a half-plane under a unit normal force per unit length.

    Components along the surface and into the solid, in units of force over plane-strain modulus E /
    (1 - nu^2). The arbitrary rigid motion is chosen so that the point on the axis at depth 1 has no
    displacement.

    Parameters
    ----------
    x, depth : array (...)   place from the force, along the surface and into the solid; any unit

    References
    ----------
    Timoshenko and Goodier, Theory of Elasticity (1970), art. 36.
    """
    x, z = np.asarray(x, dtype=float), np.asarray(depth, dtype=float)
    r, angle = np.hypot(x, z), np.arctan2(x, z)
    nu = poisson / (1 - poisson)  # the plane-stress constant that gives plane strain
    log = np.log(r)
    radial = -2 / np.pi * np.cos(angle) * log - (1 - nu) / np.pi * angle * np.sin(angle)
    transverse = (
        2 / np.pi * np.sin(angle) * log
        + (1 + nu) / np.pi * np.sin(angle)
        - (1 - nu) / np.pi * angle * np.cos(angle)
    )
    return np.stack(
        [
            radial * np.sin(angle) + transverse * np.cos(angle),
            radial * np.cos(angle) - transverse * np.sin(angle),
        ]
    )


def point_force_stress(x: ArrayLike, depth: ArrayLike) -> Array:
    """Stress (3, ...) xx, zz, xz, 1/m, of a half-plane under a normal force of 1 N/m.

    References
    ----------
    Flamant's solution; Johnson, Contact Mechanics (1985), eq. 2.17.
    """
    x, z = np.asarray(x, dtype=float), np.asarray(depth, dtype=float)
    factor = -2 / np.pi * z / (x**2 + z**2) ** 2
    return np.stack([factor * x**2, factor * z**2, factor * x * z])


def settlement(xi: ArrayLike, knots: ArrayLike) -> Array:
    """Surface settlement (n, ...) at xi from unit linear pressure shapes on `knots` (n + 2,).

    In units of pressure times length over E / (1 - nu^2); arbitrary rigid motion as in
    `point_force_displacement` up to a constant.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 5.9 (overlapping triangles), integrated here from
    the kernel -(2/pi) ln|x|.
    """
    x = np.asarray(xi, dtype=float)
    k = np.asarray(knots, dtype=float)

    def twice_integrated_log(t: Array) -> Array:
        """Second antiderivative of -(2/pi) ln|t| (up to a linear function)."""
        square = t**2
        return -(1 / np.pi) * (square * np.log(np.where(square > 0, np.abs(t), 1.0)) - 1.5 * square)

    values = twice_integrated_log(x - k.reshape((-1,) + (1,) * x.ndim))
    left, right = np.diff(k)[:-1], np.diff(k)[1:]
    shape = (-1,) + (1,) * x.ndim
    left, right = left.reshape(shape), right.reshape(shape)
    return (values[:-2] - values[1:-1]) / left + (values[2:] - values[1:-1]) / right

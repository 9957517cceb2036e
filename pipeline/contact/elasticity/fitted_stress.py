"""Stress near a point of an elastic body, by Kolosov potentials fitted to nodal displacements.

The displacements of quadratic elements are more accurate than the stresses of each element. They
are fitted by polynomials that meet equilibrium and compatibility of plane strain without body
forces: complex potentials. The stress then follows by differentiation.

References
----------
Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity (1953), sec. 32;
Zhang and Naga, SIAM J. Sci. Comput. 26 (2005) 1192: gradients by fitted polynomials.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array

Complex = NDArray[np.complex128]

_POTENTIAL_DEGREE = 6  # of the potentials
_POWERS = np.arange(_POTENTIAL_DEGREE + 1)
_UNKNOWNS = 4 * _POTENTIAL_DEGREE + 2
"""Phi has no constant, which moves the body as that of psi does."""
# Search of a maximum: points along either side of a square, and the squares one in another.
_SIDE, _SEARCH_SQUARES = 21, (0.5, 0.05, 0.005)
_CENTRED = 0.1  # distance of the maximum from the middle of the fit, in reaches
_UPDATES = 4  # of the middle of the fit


@dataclass(frozen=True, eq=False)
class FittedStress:
    """Complex (Kolosov) potentials about a point, with stress and displacement.

    place (2,) m; reach, radius of the nodes of the fit, m; phi, psi (7,) coefficients of the powers
    of distance over reach, Pa.
    """

    place: Array
    reach: float
    phi: Complex
    psi: Complex

    def __call__(self, points: ArrayLike) -> Array:
        """Stress (3, ...): xx, yy, xy at points (2, ...), Pa."""
        x, y = np.asarray(points, dtype=float)
        z = (x - self.place[0] + 1j * (y - self.place[1])) / self.reach
        middle = 2.0 * _slope(self.phi, z).real
        across = np.conj(z) * _slope(_derivative(self.phi), z) + _slope(self.psi, z)
        return np.stack([middle - across.real, middle + across.real, across.imag])


def fitted_stress(
    points: Array, displacement: Array, elastic: tuple[float, float], place: Array, reach: float
) -> FittedStress | None:
    """Potentials fitted by least squares to the displacements of the nodes about a point; None with
    fewer than 26 nodes within reach.

    Parameters
    ----------
    points, displacement : array (2, n)   nodes and their displacements, m
    elastic : tuple                       modulus, Pa, and Poisson's ratio of the body
    place : array (2,)                    middle of the fit, m
    reach : float                         radius of the nodes that are fitted, m
    """
    arm = points - place[:, None]
    near = np.flatnonzero(np.hypot(*arm) <= reach)
    if near.size < _UNKNOWNS:  # of two components each: twice as many equations
        return None
    modulus, poisson = elastic
    z = (arm[0, near] + 1j * arm[1, near]) / reach
    powers = z[:, None] ** _POWERS
    slopes = np.zeros_like(powers)
    slopes[:, 1:] = _POWERS[1:] * powers[:, :-1]
    kappa = 3.0 - 4.0 * poisson
    # 2 G (u + i v) = kappa phi - z conj(phi') - conj(psi), by real and imaginary coefficients
    by_phi = [
        kappa * unit * powers[:, 1:] - z[:, None] * np.conj(unit * slopes[:, 1:])
        for unit in (1.0, 1j)
    ]
    by_psi = [-np.conj(unit * powers) for unit in (1.0, 1j)]
    columns = np.hstack([*by_phi, *by_psi])
    shear = modulus / (2.0 * (1.0 + poisson))
    wanted = 2.0 * shear / reach * (displacement[0, near] + 1j * displacement[1, near])
    matrix = np.vstack([columns.real, columns.imag])
    solution = np.linalg.lstsq(matrix, np.r_[wanted.real, wanted.imag], rcond=None)[0]
    d = _POTENTIAL_DEGREE
    phi = solution[:d] + 1j * solution[d : 2 * d]
    psi = solution[2 * d : 3 * d + 1] + 1j * solution[3 * d + 1 :]
    return FittedStress(place, reach, np.r_[0.0, phi], psi)


def greatest_fitted(
    fit_about: Callable[[Array], FittedStress | None],
    measure: Callable[[Array], Array],
    start: Array,
) -> tuple[float, Array] | None:
    """Maximum of a stress measure, Pa, and its point (2,), m, near a start (2,), m.

    The fit is repeated about its maximum until that is within a tenth of the reach from its middle.
    None where four fits do not bring it there, or a fit has too few nodes.

    Parameters
    ----------
    fit_about : function   fit about a place (2,), m; None with too few nodes
    measure : function     of a stress (3, ...), Pa
    """
    place = np.asarray(start, dtype=float)
    for _ in range(_UPDATES):
        fit = fit_about(place)
        if fit is None:
            return None
        value, top = _maximum(fit, measure)
        beyond = float(np.hypot(*(top - place))) / fit.reach
        if beyond <= _CENTRED:
            return value, top
        place = top
    return None


def _maximum(fit: FittedStress, measure: Callable[[Array], Array]) -> tuple[float, Array]:
    """Maximum of a stress measure within half the reach of a fit, and its place (2,), m."""
    line = np.linspace(-1.0, 1.0, _SIDE)
    square = np.stack(np.meshgrid(line, line)).reshape(2, -1)
    place, value = fit.place, 0.0
    for size in _SEARCH_SQUARES:
        points = place[:, None] + size * fit.reach * square
        values = measure(fit(points))
        best = int(np.argmax(values))
        place, value = points[:, best], float(values[best])
    return value, place


def _derivative(coefficients: Complex) -> Complex:
    """Coefficients of the derivative, of the same number."""
    return np.append(_POWERS[1:] * coefficients[1:], 0.0)


def _slope(coefficients: Complex, z: Complex) -> Complex:
    """Derivative of a polynomial at z (...)."""
    return np.asarray(np.polynomial.polynomial.polyval(z, _derivative(coefficients)))

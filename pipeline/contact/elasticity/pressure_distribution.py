"""Piecewise-linear and elliptic contact pressures; their peak, centre and half-width."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, freeze, readonly
from camwright.geometry.errors import ContactError

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(6)
# Share of the contact over which the peak is averaged.
_MIDDLE = 0.5


@dataclass(frozen=True, eq=False)
class PressureShapes:
    """Continuous piecewise-linear pressures on `knots` (k + 2,), m.

    The outermost knots carry no pressure unless `open_ends`: k shapes, or k + 2.
    """

    knots: Array
    open_ends: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "knots", readonly(self.knots))

    @property
    def centres(self) -> Array:
        """Knots (n,) that carry a pressure, m."""
        return self.knots if self.open_ends else self.knots[1:-1]

    @property
    def integrals(self) -> Array:
        """Integral (n,) of each linear shape over the coordinate, m; half shapes at the ends count
        where `open_ends`.
        """
        widths = np.diff(self.knots) / 2
        total = np.concatenate([[0.0], widths]) + np.concatenate([widths, [0.0]])
        return np.asarray(total if self.open_ends else total[1:-1])

    def values(self, xi: ArrayLike) -> Array:
        """Values of the linear shapes, 1 at their own knot, (n, ...), at coordinates xi (...), m;
        zero outside the knots.
        """
        x = np.asarray(xi, dtype=float)
        cell = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, self.knots.size - 2)
        share = (x - self.knots[cell]) / (self.knots[cell + 1] - self.knots[cell])
        inside = (share >= -1e-12) & (share <= 1 + 1e-12)
        out = np.zeros((self.knots.size, *x.shape))
        grid = np.indices(x.shape)
        out[(cell, *grid)] = np.where(inside, 1 - share, 0.0)
        out[(cell + 1, *grid)] += np.where(inside, share, 0.0)
        return out if self.open_ends else out[1:-1]

    def integrated(self, function_values: Array, xi: Array, weights: Array) -> Array:
        """Integral (n,) of each shape times a function with values at quadrature points."""
        return self.values(xi) @ (weights * function_values)

    @cached_property
    def sampled(self) -> tuple[Array, Array, Array]:
        """Quadrature points and weights (q,), m, and the shapes (n, q) at the points."""
        xi, weights = self.quadrature()
        return readonly(xi), readonly(weights), readonly(self.values(xi))

    def quadrature(self, breaks: ArrayLike = ()) -> tuple[Array, Array]:
        """Gauss points and weights (q,), m, six on each piece between knots and `breaks`, m; breaks
        outside the knots are left out.
        """
        low, high = self.knots[0], self.knots[-1]
        inner = np.asarray(breaks, dtype=float).ravel()
        ends = np.unique(np.concatenate([self.knots, inner[(inner > low) & (inner < high)]]))
        # Pieces shorter than round-off are dropped: they would divide by zero.
        ends = ends[np.concatenate([[True], np.diff(ends) > 1e-13 * (high - low)])]
        half = np.diff(ends)[:, None] / 2
        xi = (ends[:-1, None] + half) + half * _GAUSS_POINTS
        return xi.ravel(), (half * _GAUSS_WEIGHTS).ravel()


@dataclass(frozen=True, eq=False)
class EllipticShapes:
    """Piecewise-linear functions on `knots` (n,), m, times the ellipse between the outer two.

    They represent a Hertz pressure exactly for any spacing of the knots; piecewise-linear shapes
    overshoot at its edges.
    """

    knots: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "knots", readonly(self.knots))

    @classmethod
    def within(cls, knots: Array, ends: Array) -> EllipticShapes:
        """Shapes on the knots more than half a step inside two ends (2,), m, and on the ends."""
        apart = 0.5 * float(np.diff(knots).max())
        inner = knots[(knots > ends[0] + apart) & (knots < ends[1] - apart)]
        return cls(np.concatenate([ends[:1], inner, ends[1:]]))

    @property
    def centres(self) -> Array:
        """Knots (n,), m."""
        return self.knots

    @property
    def integrals(self) -> Array:
        """Integral (n,) of each shape, m."""
        xi, weights = self.quadrature()
        return self.values(xi) @ weights

    def values(self, xi: ArrayLike) -> Array:
        """Values of the shapes, linear functions times the ellipse, (n, ...), at coordinates xi
        (...), m; zero outside the outer knots.
        """
        x = np.asarray(xi, dtype=float)
        middle, half_width = self._ellipse
        ellipse = np.sqrt(np.maximum(1 - ((x - middle) / half_width) ** 2, 0.0))
        return PressureShapes(self.knots, open_ends=True).values(x) * ellipse

    def integrated(self, function_values: Array, xi: Array, weights: Array) -> Array:
        """Integral (n,) of each shape times a function with values at quadrature points."""
        return self.values(xi) @ (weights * function_values)

    @cached_property
    def sampled(self) -> tuple[Array, Array, Array]:
        """Quadrature points and weights (q,), m, and the shapes (n, q) at the points."""
        xi, weights = self.quadrature()
        return readonly(xi), readonly(weights), readonly(self.values(xi))

    def quadrature(self, breaks: ArrayLike = ()) -> tuple[Array, Array]:
        """Points and weights (q,), m, of Gauss quadrature in the angle of the ellipse, six on each
        piece between knots and `breaks`, m.
        """
        middle, half_width = self._ellipse
        share = (np.concatenate([self.knots, np.ravel(breaks)]) - middle) / half_width
        turned = np.arcsin(np.clip(share, -1.0, 1.0))
        angle, weights = PressureShapes(np.unique(turned), open_ends=True).quadrature()
        return middle + half_width * np.sin(angle), half_width * np.cos(angle) * weights

    @property
    def _ellipse(self) -> tuple[float, float]:
        low, high = float(self.knots[0]), float(self.knots[-1])
        return (low + high) / 2, (high - low) / 2


@dataclass(frozen=True, eq=False)
class Ellipses:
    """Elliptic pressures: peak (Pa), centre (m) and half-width (m), arrays (count,)."""

    p0: Array
    centre: Array
    half_width: Array

    def __post_init__(self) -> None:
        freeze(self, p0=self.p0, centre=self.centre, half_width=self.half_width)


def fitted_ellipses(shapes: PressureShapes | EllipticShapes, pressure: Array) -> Ellipses:
    """Peak, centre and half-width of ellipses fitted to contact pressures (count, n).

    The fitted ellipse has the second moment of the pressure, which sets the half-width, and its
    weighted mean over the middle half, which sets the peak. Integrals of a Galerkin pressure
    converge faster than its nodal values, which oscillate next to the edge: with eight knots on
    the half-width, for any position of the edge between two knots, the half-width is within
    0.45 % and the peak within 0.15 % of Hertz. Both errors decrease with the square of the
    spacing.

    Raises
    ------
    ContactError
        If fewer than four knots carry a pressure.
    """
    carrying = (pressure > 0).sum(axis=1)
    if (carrying < 4).any():
        raise ContactError(f"{int(carrying.min())} pressure knots in contact, must be >= 4")
    xi, weights, values = shapes.sampled
    weighted = (pressure @ values) * weights
    force = weighted.sum(axis=1)
    centre = weighted @ xi / force
    arm = xi - centre[:, None]
    square = arm**2
    half_width = 2 * np.sqrt(np.einsum("kq,kq->k", weighted, square) / force)
    y2 = square / half_width[:, None] ** 2
    bell = np.maximum(1 - y2 / _MIDDLE**2, 0.0) ** 2
    ellipse = np.sqrt(np.maximum(1 - y2, 0.0))
    p0 = np.einsum("kq,kq->k", bell, weighted) / ((bell * ellipse) @ weights)
    return Ellipses(p0, centre, half_width)

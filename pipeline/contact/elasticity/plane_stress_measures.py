"""Shear and von Mises stress of plane strain; maxima of fields at scattered points."""

from __future__ import annotations

from math import perm

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from camwright.geometry.arrays import Array


def shear_in_plane(stress: ArrayLike) -> Array:
    """Maximum in-plane shear stress (...), of plane-strain stress xx, yy, xy (3, ...)."""
    xx, yy, xy = np.asarray(stress, dtype=float)
    return np.asarray(np.hypot((xx - yy) / 2, xy))


def shear_any_plane(field: ArrayLike, poisson: float) -> Array:
    """Maximum shear stress on any plane (...), of plane-strain stress (3, ...)."""
    xx, yy, xy = np.asarray(field, dtype=float)
    middle, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    out = poisson * (xx + yy)
    high, low = np.maximum(middle + radius, out), np.minimum(middle - radius, out)
    return np.asarray((high - low) / 2)


def von_mises(stress: ArrayLike, poisson: float) -> Array:
    """Von Mises stress (...), with ``sigma_zz = nu (sigma_xx + sigma_yy)``."""
    xx, yy, xy = np.asarray(stress, dtype=float)
    zz = poisson * (xx + yy)
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(squares / 2 + 3 * xy**2))


_POWERS = np.array([(i, j) for i in range(5) for j in range(5 - i)])


class PeakFinder:
    """Maximum of fields on scattered points, interpolated between the points.

    A polynomial of fourth degree is fitted about the largest value, over a neighbourhood wide
    enough to average the scatter of recovered stresses. A maximum in the outer half of the
    neighbourhood is rejected in favour of the largest value.

    Parameters
    ----------
    points : array (2, m)   second component is the depth, >= 0; in half-widths
    reach : float           radius of the neighbourhood, in half-widths
    """

    def __init__(self, points: ArrayLike, reach: float = 0.45) -> None:
        self._reach = reach
        self._points = np.asarray(points, dtype=float)
        self._tree = cKDTree(self._points.T)

    def __call__(self, values: ArrayLike) -> tuple[Array, Array]:
        """Maxima (k,) and their places (2, k) of fields (m, k)."""
        fields = np.asarray(values, dtype=float)
        nodes = fields.argmax(axis=0)
        top, place = fields.max(axis=0), self._points[:, nodes]
        for node in np.unique(nodes):
            centre = self._points[:, node]
            near = self._tree.query_ball_point(centre, self._reach)
            if len(near) < 2 * len(_POWERS):
                continue
            columns = np.flatnonzero(nodes == node)
            arms = (self._points[:, near] - centre[:, None]) / self._reach
            fit = np.linalg.pinv(_terms(arms).T) @ fields[np.ix_(near, columns)]
            height, step, trusted = _summit(fit)
            summit = centre[:, None] + self._reach * step
            trusted &= summit[1] >= 0
            top[columns[trusted]] = height[trusted]
            place[:, columns[trusted]] = summit[:, trusted]
        return top, place


def _terms(at: Array, by_x: int = 0, by_y: int = 0) -> Array:
    """Terms (15, ...) of the polynomial, differentiated, at places (2, ...)."""
    rows = []
    for i, j in _POWERS:
        if i < by_x or j < by_y:
            rows.append(np.zeros_like(at[0]))
            continue
        factor = perm(int(i), by_x) * perm(int(j), by_y)
        rows.append(factor * at[0] ** (i - by_x) * at[1] ** (j - by_y))
    return np.stack(rows)


def _summit(fit: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Value (k,), place (2, k) and existence (k,) of the maxima of polynomials (15, k)."""

    def of(by_x: int, by_y: int) -> Array:
        return np.asarray((fit * _terms(at, by_x, by_y)).sum(axis=0))

    at = np.zeros((2, fit.shape[1]))
    trusted = np.ones(fit.shape[1], dtype=bool)
    for _ in range(8):
        xx, xy, yy = of(2, 0), of(1, 1), of(0, 2)
        determinant = xx * yy - xy**2
        trusted &= (determinant > 0) & (xx < 0)
        safe = np.where(trusted, determinant, 1.0)
        x, y = of(1, 0), of(0, 1)
        step = np.stack([yy * x - xy * y, xx * y - xy * x]) / safe
        at = at - np.where(trusted, step, 0.0)
        trusted &= (np.abs(at) < 0.5).all(axis=0)
        at = np.where(trusted, at, 0.0)
    return of(0, 0), at, trusted

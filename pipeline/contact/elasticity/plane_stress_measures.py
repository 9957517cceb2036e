"""Stress measures of plane strain: shear, von Mises; maxima of fields at scattered points."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array

Index = NDArray[np.int64]


def shear_in_plane(stress: ArrayLike) -> Array:
    """Maximum in-plane shear stress (...), of plane-strain stress xx, yy, xy (3, ...)."""
    return _circle(stress)[1]


def shear_any_plane(field: ArrayLike, poisson: float) -> Array:
    """Maximum shear stress on any plane (...), of plane-strain stress (3, ...)."""
    return _shear_any_plane(*_circle(field), poisson)


def von_mises(stress: ArrayLike, poisson: float) -> Array:
    """Von Mises stress (...), with ``sigma_zz = nu (sigma_xx + sigma_yy)``."""
    return _von_mises(*_circle(stress), poisson)


def all_measures(stress: ArrayLike, poisson: float) -> tuple[Array, Array, Array]:
    """In-plane shear, shear on any plane and von Mises stress (...) of a stress (3, ...)."""
    middle, radius = _circle(stress)
    return (
        radius,
        _shear_any_plane(middle, radius, poisson),
        _von_mises(middle, radius, poisson),
    )


def _circle(stress: ArrayLike) -> tuple[Array, Array]:
    """Middle and radius (...) of Mohr's circle in the plane."""
    xx, yy, xy = np.asarray(stress, dtype=float)
    return (xx + yy) / 2, np.sqrt(((xx - yy) / 2) ** 2 + xy**2)


def _shear_any_plane(middle: Array, radius: Array, poisson: float) -> Array:
    out = 2 * poisson * middle
    return np.asarray((np.maximum(middle + radius, out) - np.minimum(middle - radius, out)) / 2)


def _von_mises(middle: Array, radius: Array, poisson: float) -> Array:
    return np.asarray(np.sqrt(3 * radius**2 + ((1 - 2 * poisson) * middle) ** 2))


_POWERS = np.array([(i, j) for i in range(5) for j in range(5 - i)])
# Spacing of the coarse points, in half-widths, and the share of the largest value on them above
# which the maximum may lie nearby.
_COARSE_CELL, _LIKELY_SHARE = 0.125, 0.85
_SUMMIT_STEP_END = 1e-6  # last step of Newton's method to a maximum, in cells


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
        """Keep the points; the fit of a neighbourhood is prepared on its first use."""
        self._reach = reach
        self._points = np.asarray(points, dtype=float)
        self._near: dict[int, Index] = {}
        self._inverse: dict[int, Array] = {}

    def __call__(self, values: ArrayLike) -> tuple[Array, Array]:
        """Maxima (k,) and their places (2, k) of fields (m, k)."""
        fields = np.asarray(values, dtype=float)
        return self._fitted(fields, np.arange(fields.shape[0]), fields.argmax(axis=0))

    def where_likely(
        self, values_at: Callable[[Index], tuple[Array, ...]]
    ) -> tuple[tuple[Array, Array], ...]:
        """Maxima (k,) and their places (2, k) of several fields, which are evaluated only near
        their likely places.

        First on a twentieth of the points, then about the largest values there.

        Parameters
        ----------
        values_at : function   of point numbers (p,); the fields there, each (p, k)
        """
        coarse, nearest = self._coarse
        likely, chosen = np.zeros(coarse.size, dtype=bool), np.zeros(nearest.size, dtype=bool)
        for field in values_at(coarse):
            likely |= (field >= _LIKELY_SHARE * field.max(axis=0)).any(axis=1)
            for node in np.unique(coarse[field.argmax(axis=0)]):
                chosen[self._within(self._points[:, node], self._reach + _COARSE_CELL)] = True
        chosen |= likely[nearest]
        while True:
            nodes = np.flatnonzero(chosen)
            fields = values_at(nodes)
            tops = [nodes[field.argmax(axis=0)] for field in fields]
            for top in np.unique(np.concatenate(tops)):
                chosen[self._neighbours(int(top))] = True
            if np.count_nonzero(chosen) == nodes.size:
                pairs = zip(fields, tops, strict=True)
                return tuple(self._fitted(field, nodes, top) for field, top in pairs)

    @cached_property
    def _coarse(self) -> tuple[Index, Index]:
        """Numbers of the coarse points (c,), one in each square of 1/8 half-width, and for each
        point the index among them of the nearest one (m,).
        """
        cells = np.floor(self._points / _COARSE_CELL)
        _, first = np.unique(cells, axis=1, return_index=True)
        coarse = np.sort(first)
        _, nearest = scipy.spatial.cKDTree(self._points[:, coarse].T).query(self._points.T)
        return coarse, np.asarray(nearest, dtype=np.int64)

    def _within(self, centre: Array, radius: float) -> Index:
        """Numbers of the points within a radius."""
        square = ((self._points - centre[:, None]) ** 2).sum(axis=0)
        return np.flatnonzero(square <= radius**2)

    def _neighbours(self, node: int) -> Index:
        """Numbers of the points of the fit about a point."""
        if node not in self._near:
            self._near[node] = self._within(self._points[:, node], self._reach)
        return self._near[node]

    def _fit(self, node: int) -> Array:
        """Matrix (15, p) from the values at the p neighbours of a point to the coefficients of the
        polynomial fitted about it, in distances over the reach; `node`: number of the point.
        """
        if node not in self._inverse:
            arms = self._points[:, self._neighbours(node)] - self._points[:, [node]]
            self._inverse[node] = np.asarray(
                np.linalg.pinv(_terms(arms / self._reach).T), dtype=float
            )
        return self._inverse[node]

    def _fitted(self, fields: Array, nodes: Index, tops: Index) -> tuple[Array, Array]:
        """Maxima (k,) and their places (2, k) of fields (p, k): of a polynomial fitted about the
        greatest value, or this value where the polynomial has no maximum nearby.

        Parameters
        ----------
        fields : array (p, k)   values at the points
        nodes : array (p,)      numbers of the points, ascending
        tops : array (k,)       number of the point of the greatest value of each field
        """
        columns = np.arange(tops.size)
        top, place = fields[np.searchsorted(nodes, tops), columns], self._points[:, tops]
        fits, fitted = np.empty((len(_POWERS), tops.size)), np.zeros(tops.size, dtype=bool)
        for node in np.unique(tops):
            near = self._neighbours(int(node))
            if near.size < 2 * len(_POWERS):
                continue
            here = columns[tops == node]
            rows = np.searchsorted(nodes, near)
            fits[:, here] = self._fit(int(node)) @ fields[np.ix_(rows, here)]
            fitted[here] = True
        height, step, trusted = _summit(fits[:, fitted])
        summit = place[:, fitted] + self._reach * step
        trusted &= summit[1] >= 0
        chosen = np.flatnonzero(fitted)[trusted]
        top[chosen], place[:, chosen] = height[trusted], summit[:, trusted]
        return top, place


def _terms(at: Array) -> Array:
    """Terms (15, ...) of the polynomial at places (2, ...)."""
    x, y = (one ** np.arange(5).reshape(-1, *(1,) * one.ndim) for one in at)
    return np.asarray(x[_POWERS[:, 0]] * y[_POWERS[:, 1]])


@lru_cache(maxsize=1)
def _derivatives() -> Array:
    """Matrices (5, 15, 15) from the coefficients of a polynomial to those of its derivatives by x,
    y, xx, xy and yy.
    """
    row = {(int(i), int(j)): k for k, (i, j) in enumerate(_POWERS)}
    by_x, by_y = np.zeros((2, len(_POWERS), len(_POWERS)))
    for (i, j), k in row.items():
        if i > 0:
            by_x[row[i - 1, j], k] = i
        if j > 0:
            by_y[row[i, j - 1], k] = j
    return np.stack([by_x, by_y, by_x @ by_x, by_x @ by_y, by_y @ by_y])


def _summit(fit: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Maxima of polynomials with coefficients (15, k): value (k,), place (2, k), and whether there
    is one within 0.5 of the origin in x and y (k,); by Newton's method. Without one: the value at
    the origin.
    """
    slopes = _derivatives() @ fit
    at = np.zeros((2, fit.shape[1]))
    trusted = np.ones(fit.shape[1], dtype=bool)
    for _ in range(8):
        x, y, xx, xy, yy = np.einsum("dtk,tk->dk", slopes, _terms(at))
        determinant = xx * yy - xy**2
        trusted &= (determinant > 0) & (xx < 0)
        safe = np.where(trusted, determinant, 1.0)
        step = np.stack([yy * x - xy * y, xx * y - xy * x]) / safe
        at = at - np.where(trusted, step, 0.0)
        trusted &= (np.abs(at) < 0.5).all(axis=0)
        at = np.where(trusted, at, 0.0)
    trusted &= (np.abs(step) < _SUMMIT_STEP_END).all(axis=0)
    at = np.where(trusted, at, 0.0)
    return np.asarray((fit * _terms(at)).sum(axis=0)), at, trusted

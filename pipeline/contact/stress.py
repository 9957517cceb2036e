"""Scalar measures of plane-strain stress."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from geometry.arrays import Array


def shear_in_plane(stress: ArrayLike) -> Array:
    """Maximum shear in the plane, from (xx, yy, xy) stacked first."""
    xx, yy, xy = np.asarray(stress, dtype=float)
    return np.hypot((xx - yy) / 2, xy)


def von_mises(stress: ArrayLike, poisson: float) -> Array:
    """Von Mises stress in plane strain, ``sigma_zz = nu (sigma_xx + sigma_yy)``."""
    xx, yy, xy = np.asarray(stress, dtype=float)
    zz = poisson * (xx + yy)
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(squares / 2 + 3 * xy**2)


class PeakFinder:
    """Maximum of fields known at scattered points, found between them.

    A quadric through the points around the largest value gives the peak and its place; the
    answer never leaves the neighbourhood it was fitted to.

    Parameters
    ----------
    points : array (2, m)   second component is the depth, >= 0
    """

    _NEIGHBOURS = 14

    def __init__(self, points: ArrayLike) -> None:
        self._points = np.asarray(points, dtype=float)
        tree = cKDTree(self._points.T)
        found: Any = tree.query(self._points.T, self._NEIGHBOURS)
        distance, self._near = found
        self._reach = distance[:, self._NEIGHBOURS // 2]

    def _fits(self, nodes: Array) -> Array:
        """Operators (k, 6, neighbours) from values about `nodes` (k,) to a quadric's terms."""
        found, where = np.unique(nodes, return_inverse=True)
        arms = self._points[:, self._near[found]] - self._points[:, found, None]
        x, y = arms / self._reach[found, None]
        terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=-1)
        return np.linalg.pinv(terms)[where]

    def __call__(self, values: ArrayLike) -> tuple[Array, Array]:
        """Peak values (k,) and their places (2, k) of fields (m, k)."""
        fields = np.asarray(values, dtype=float)
        column = np.arange(fields.shape[1])
        node = np.asarray(fields.argmax(axis=0))
        largest = fields[node, column]
        around = fields[self._near[node], column[:, None]]
        c = np.einsum("kij,kj->ki", self._fits(node), around)
        hessian = np.stack([2 * c[:, 3], c[:, 4], c[:, 4], 2 * c[:, 5]], axis=1).reshape(-1, 2, 2)
        determinant = np.linalg.det(hessian)
        peaked = (determinant > 0) & (hessian[:, 0, 0] < 0)
        safe = np.where(peaked[:, None, None], hessian, -np.eye(2))
        step = np.linalg.solve(safe, -c[:, 1:3, None])[:, :, 0]
        place = self._points[:, node] + (step * self._reach[node, None]).T
        trusted = peaked & (np.abs(step) < 1).all(axis=1) & (place[1] >= 0)
        top = c[:, 0] + 0.5 * (c[:, 1:3] * step).sum(axis=1)
        return (
            np.where(trusted, top, largest),
            np.where(trusted, place, self._points[:, node]),
        )

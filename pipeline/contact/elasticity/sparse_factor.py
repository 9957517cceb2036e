"""Factorisation of sparse symmetric positive definite matrices: CHOLMOD, Pardiso or SuperLU.

By CHOLMOD (package cvxopt) or Pardiso (pypardiso) where installed, else by SuperLU (SciPy);
``CAMWRIGHT_SOLVER=scipy`` selects SuperLU. Solutions agree to round-off.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError

Index = NDArray[np.int64]

_POSITIVE_DEFINITE = 2  # matrix type of Pardiso: real symmetric positive definite
_SIDES_AT_ONCE = 4  # right-hand sides of SuperLU that stay in the cache of the processor


def back_end() -> str:
    """Name of the factorisation library: ``cholmod``, ``pardiso`` or ``scipy``."""
    if os.environ.get("CAMWRIGHT_SOLVER") != "scipy":
        for name, module in (("cholmod", "cvxopt.cholmod"), ("pardiso", "pypardiso")):
            with suppress(ImportError):
                importlib.import_module(module)
                return name
    return "scipy"


def factorised(matrix: scipy.sparse.sparray) -> Callable[[Array], Array]:
    """Solver of a sparse symmetric positive definite matrix (n, n), factorised once, for right-hand
    sides (n, k).
    """
    chosen = back_end()
    if chosen == "cholmod":
        return _by_cholmod(scipy.sparse.csc_array(matrix))
    if chosen == "pardiso":
        return _by_pardiso(matrix)
    return partial(_solved, _symmetric_lu(matrix, "MMD_AT_PLUS_A"))


def _symmetric_lu(matrix: scipy.sparse.sparray, ordering: str) -> scipy.sparse.linalg.SuperLU:
    """Factors of a symmetric positive definite matrix.

    Diagonal pivots are safe for such a matrix and several times faster than pivoting with COLAMD.
    """
    return scipy.sparse.linalg.splu(
        scipy.sparse.csc_matrix(matrix),
        permc_spec=ordering,
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _solved(factor: scipy.sparse.linalg.SuperLU, right: Array) -> Array:
    """Solutions (n, k) for right-hand sides (n, k), a few at a time: many take thrice as long."""
    solution = np.array(right, dtype=float, order="F")
    for first in range(0, solution.shape[1], _SIDES_AT_ONCE):
        few = slice(first, first + _SIDES_AT_ONCE)
        solution[:, few] = factor.solve(solution[:, few])
    return solution


def _by_cholmod(matrix: scipy.sparse.csc_array) -> Callable[[Array], Array]:
    """Solver of a symmetric positive definite matrix by CHOLMOD, for right-hand sides (n,) or (n,
    k).
    """
    from cvxopt import cholmod, spmatrix
    from cvxopt import matrix as dense

    lower = scipy.sparse.coo_array(scipy.sparse.tril(matrix))
    rows, columns = lower.coords
    held = spmatrix(
        dense(lower.data), dense(rows.astype(np.int64)), dense(columns.astype(np.int64))
    )
    factor = cholmod.symbolic(held)
    cholmod.numeric(held, factor)

    def solve(right: Array) -> Array:
        values = dense(np.asfortranarray(right, dtype=float))
        cholmod.solve(factor, values)
        return np.array(values).reshape(right.shape, order="F")

    return solve


def _by_pardiso(matrix: scipy.sparse.sparray) -> Callable[[Array], Array]:
    """Solver of a symmetric positive definite matrix by PARDISO, for right-hand sides (n,) or (n,
    k).
    """
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver(mtype=_POSITIVE_DEFINITE)
    upper = scipy.sparse.csr_matrix(scipy.sparse.triu(matrix, format="csr"))
    upper.sort_indices()
    solver.factorize(upper)

    def solve(right: Array) -> Array:
        return np.asarray(solver.solve(upper, np.asarray(right, dtype=float))).reshape(right.shape)

    return solve


class Condensed:
    """Schur complement of a matrix on its loaded unknowns.

    The chosen unknowns are eliminated last: the last rows of the triangular factors are the
    factors of the condensed matrix, and each solution costs dense algebra of k unknowns.

    Parameters
    ----------
    matrix : sparse (n, n)   symmetric positive definite
    pairs : array (2, m)     x and y unknowns of each node with two, for the elimination order
    last : array (k,)        the chosen unknowns
    """

    def __init__(self, matrix: scipy.sparse.sparray, pairs: ArrayLike, last: ArrayLike) -> None:
        self._last = np.asarray(last, dtype=int)
        order = _elimination_order(matrix, np.asarray(pairs, dtype=int), self._last)
        permuted = scipy.sparse.csc_matrix(matrix)[order][:, order].tocsc()
        factor = _symmetric_lu(permuted, "NATURAL")
        if not np.array_equal(factor.perm_r, factor.perm_c):
            raise ContactError("stiffness matrix: not positive definite")
        self._order, self._factor = order, factor
        size, few = order.size, self._last.size
        # SuperLU may exchange columns that are not coupled: restore their order.
        place = factor.perm_c[size - few :]
        shuffle = np.argsort(place)
        rows = np.sort(place)
        self._shuffle = shuffle
        self._lower = factor.L[:, rows][rows].toarray()
        self._upper = factor.U[:, rows][rows].toarray()

    def solve_last(self, right: ArrayLike) -> Array:
        """Values (k, m) of the chosen unknowns under loads (k, m) on them."""
        loads = np.asarray(right, dtype=float)[self._shuffle]
        half = scipy.linalg.solve_triangular(self._lower, loads, lower=True, unit_diagonal=True)
        solution = np.empty_like(loads)
        solution[self._shuffle] = scipy.linalg.solve_triangular(self._upper, half)
        return solution

    def solve(self, right: ArrayLike) -> Array:
        """Values (n, m) of all unknowns under loads (n, m)."""
        loads = np.asarray(right, dtype=float)
        solution = np.empty_like(loads)
        solution[self._order] = _solved(self._factor, loads[self._order])
        return solution


def _elimination_order(matrix: scipy.sparse.sparray, pairs: Index, last: Index) -> Index:
    """Elimination order (n,) of the unknowns: minimum degree on the nodes, the chosen unknowns
    last.

    Parameters
    ----------
    matrix : sparse (n, n)   symmetric
    pairs : array (2, m)     x and y unknowns of each node with two
    last : array (k,)        the chosen unknowns
    """
    size = matrix.shape[0]
    chosen = np.zeros(size, dtype=bool)
    chosen[last] = True
    inner = pairs[:, ~chosen[pairs].any(axis=0)]
    rest = np.ones(size, dtype=bool)
    rest[inner] = False
    rest[last] = False
    block = scipy.sparse.csc_matrix(matrix)[inner[0]][:, inner[0]].tocsc()
    # perm_c[j] is the place of column j.
    sequence = np.argsort(_symmetric_lu(block, "MMD_AT_PLUS_A").perm_c)
    return np.concatenate([inner[:, sequence].T.ravel(), np.flatnonzero(rest), last])

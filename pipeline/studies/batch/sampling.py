"""Sampling of designs: factor values by grid, list or points of the unit cube."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.studies.batch.factor_axes import Axis, Levels
from camwright.pipeline.studies.batch.study_file import DESIGNS_MAX, Correlation, Sampling

_KEPT_MOST = 1_000_000  # values of a sample that the disk cache keeps
_EDGE = 2.0**-53  # a share of 0 or 1 has no normal value
VALUES_MAX = 100_000_000
"""Maximum number of designs times factors: 0.8 GB of samples."""


@dataclass(frozen=True, eq=False)
class SampledDesigns:
    """Factor values of the designs of one case.

    Parameters
    ----------
    axes : tuple       of the factors, in the order of the study file
    columns : mapping  values (n,) by key: array in the unit of the axis, else names
    count : int        n
    """

    axes: tuple[Axis, ...]
    columns: Mapping[str, Array | Levels]
    count: int

    @property
    def units(self) -> dict[str, str | None]:
        """Unit of each factor by key; None: names."""
        return {axis.key: axis.unit for axis in self.axes}

    def si(self) -> dict[str, Array | Levels]:
        """Values (n,) by key, SI; integers and names as in the study file."""
        return {axis.key: _plain(axis, self.columns[axis.key]) for axis in self.axes}


def _plain(axis: Axis, values: Array | Levels) -> Array | Levels:
    """Values of an axis in SI as they enter a case: integers stay integers, names texts."""
    if not isinstance(values, np.ndarray):
        return values
    if axis.levels and all(isinstance(each, int) for each in axis.levels):
        return tuple(int(each) for each in values.tolist())
    return axis.si(values)


def designs_of(
    axes: Sequence[Axis], sampling: Sampling, correlations: Sequence[Correlation] = ()
) -> SampledDesigns:
    """Values of the factors of all designs of a study, reproducible by its seed.

    Parameters
    ----------
    axes : sequence           one per factor
    sampling : Sampling       method, number of designs, seed
    correlations : sequence   of pairs of factors

    Raises
    ------
    InputError
        If the method does not fit a factor, the lists differ in length, there are too many designs,
        or the correlations contradict one another.
    """
    if sampling.method in ("grid", "list"):
        picked = _picked([axis.factorial for axis in axes], sampling.method)
        columns = {
            axis.key: _column(axis, [axis.levels[k] for k in places.tolist()])
            for axis, places in zip(axes, picked, strict=True)
        }
        return SampledDesigns(tuple(axes), columns, len(picked[0]))
    count = (sampling.count or 0) * (len(axes) + 2 if sampling.method == "sobol_indices" else 1)
    _require_size(f"{count} designs of {len(axes)} factors", count, len(axes))
    shares = _correlated(unit_cube(len(axes), sampling), axes, correlations)
    columns = {}
    for axis, share in zip(axes, shares.T, strict=True):
        if axis.levels:
            places = np.minimum((share * len(axis.levels)).astype(int), len(axis.levels) - 1)
            columns[axis.key] = _column(axis, [axis.levels[k] for k in places])
        else:
            columns[axis.key] = axis.at(np.clip(share, _EDGE, 1.0 - _EDGE))
    return SampledDesigns(tuple(axes), columns, len(shares))


def unit_cube(dimensions: int, sampling: Sampling) -> Array:
    """Points in the unit cube (n, dimensions), by the method and seed of the sampling.

    References
    ----------
    Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, for the rows of ``sobol_indices``.
    """
    count = sampling.count or 0
    if sampling.method == "random":
        return np.random.default_rng(sampling.seed).random((count, dimensions))
    if sampling.method == "sobol_indices":
        from SALib.sample import sobol

        problem = {
            "num_vars": dimensions,
            "names": [str(k) for k in range(dimensions)],
            "bounds": [[0.0, 1.0]] * dimensions,
        }
        whole = 1 << (count - 1).bit_length()
        if whole != count:
            raise InputError("sampling.count", count, f"a power of two, such as {whole}")
        return np.asarray(sobol.sample(problem, count, calc_second_order=False, seed=sampling.seed))
    drawn = dimensions, sampling.method, count, sampling.seed
    if count * dimensions > _KEPT_MOST:
        return _spread(*drawn)
    recipe = (sys.modules[__name__],)
    return disk_cache.kept("cube", drawn, lambda: {"points": _spread(*drawn)}, recipe)["points"]


def _spread(dimensions: int, method: str, count: int, seed: int) -> Array:
    """Points (n, dimensions) in the unit cube of a latin hypercube or, for any other `method`, of a
    scrambled Sobol sequence.
    """
    from scipy.stats import qmc  # as long to import as ten designs to preview

    if method == "latin_hypercube":
        points = qmc.LatinHypercube(dimensions, rng=np.random.default_rng(seed))
        return np.asarray(points.random(count))
    sequence = qmc.Sobol(dimensions, rng=np.random.default_rng(seed))
    # whole powers of two are balanced; the first `count` of them
    return np.asarray(sequence.random_base2((count - 1).bit_length()))[:count]


def _require_size(words: str, designs: int, factors: int) -> None:
    """Refuse more designs or values than a study holds."""
    if designs > DESIGNS_MAX or designs * factors > VALUES_MAX:
        limit = f"<= {DESIGNS_MAX} designs, and <= {VALUES_MAX} values of factors"
        raise InputError("sampling", words[:80], limit)


def _picked(levels: Sequence[Levels], method: str) -> list[NDArray[np.intp]]:
    """Index of the level of each factor in every design: a list of arrays (n,), one per factor.

    Parameters
    ----------
    levels : sequence   levels of each factor
    method : str        "list": design k has the k-th level of every factor; else a grid of all
                        combinations, whose last factor varies fastest
    """
    counts = [len(each) for each in levels]
    if method == "list":
        if len(set(counts)) != 1:
            raise InputError("factor.list", str(counts)[:80], "lists of one length")
        return [np.arange(counts[0])] * len(counts)
    total = math.prod(counts)
    _require_size(f"grid of {' x '.join(map(str, counts))} designs", total, len(counts))
    inner = [math.prod(counts[k + 1 :]) for k in range(len(counts))]
    return [np.arange(total) // step % n for step, n in zip(inner, counts, strict=True)]


def _column(axis: Axis, values: Sequence[str | bool | int | float]) -> Array | Levels:
    return tuple(values) if axis.unit is None else np.array(values, dtype=float)


def _correlated(shares: Array, axes: Sequence[Axis], correlations: Sequence[Correlation]) -> Array:
    """Uniform samples with correlations imposed by a Gaussian copula: a correlation is that of the
    normal scores.

    Parameters
    ----------
    shares : array (n, d)     independent samples, 0 to 1, of d factors
    axes : sequence           the factors
    correlations : sequence   pairs of factors with a coefficient

    Raises
    ------
    InputError
        If the correlations contradict one another.

    References
    ----------
    Nelsen, An Introduction to Copulas (2006), sec. 2.3.
    """
    if not correlations:
        return shares
    from scipy.special import ndtr, ndtri

    place = {axis.key: k for k, axis in enumerate(axes)}
    matrix = np.eye(len(axes))
    for each in correlations:
        one, other = (place[key] for key in each.between)
        matrix[one, other] = matrix[other, one] = each.value
    try:
        root = np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        words = ", ".join(f"{each.value:g}" for each in correlations)
        raise InputError("correlation.value", words, "a positive definite matrix") from None
    normal = ndtri(np.clip(shares, _EDGE, 1.0 - _EDGE))
    return np.asarray(ndtr(normal @ root.T))

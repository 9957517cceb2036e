"""Sensitivity of a study's outputs to its factors: main effects, Sobol indices.

Main effects come from any sample, by means over levels of a factor. Sobol indices need the sample
of Saltelli: blocks of `factors` + 2 designs, the first of matrix A, the last of B, the others of A
with one column of B.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.studies.batch.answers_yield import CONFIDENCE

EFFECT_LEVELS = 8
"""Maximum number of levels whose means are the main effect."""
RESAMPLES, SEED = 200, 1  # SALib takes a seed of 0 for none
_ROWS_OF_LEVEL = 8


@dataclass(frozen=True)
class MainEffect:
    """Mean of an output by level of one factor, with the factor's share of the variance.

    levels: value or range of the factor, ascending, (k,); means, errors: mean of the output and
    its standard error (k,); share: first-order share of the variance, with its interval.
    """

    levels: tuple[str | tuple[float, float], ...]
    counts: tuple[int, ...]
    means: tuple[float, ...]
    errors: tuple[float, ...]
    share: float
    share_interval: tuple[float, float]

    @property
    def swing(self) -> float:
        """Difference of the greatest and the least mean."""
        return max(self.means) - min(self.means)


@dataclass(frozen=True)
class SobolIndex:
    """First-order and total Sobol index of one factor with confidence intervals."""

    first: float
    first_interval: tuple[float, float]
    total: float
    total_interval: tuple[float, float]


def main_effect(values: NDArray[np.generic], output: Array) -> MainEffect | None:
    """Main effect of one factor on an output, from a sample of independent designs.

    Parameters
    ----------
    values : array (n,)   the factor, numbers or text
    output : array (n,)   the output; designs without a number are left out

    Returns
    -------
    MainEffect or None   None if the factor or the output does not vary

    Notes
    -----
    Levels are the distinct values, or ranges that hold equally many designs: up to 8 for the
    means, up to 2 n^(1/3) for the share of the variance, each of 8 designs at least. The share is
    the correlation ratio without its bias (epsilon squared); its interval follows from the
    influence function and, for a share near 0, from the variance of F.

    References
    ----------
    Kelley, Proc. Natl. Acad. Sci. 21 (1935), 554; Saltelli et al., Global Sensitivity Analysis
    (2008), sec. 1.2.
    """
    known = np.isfinite(output)
    values, output = values[known], output[known]
    n = output.size
    if n < 2 * _ROWS_OF_LEVEL or np.ptp(output) == 0.0:
        return None
    codes, levels = _levels(values, EFFECT_LEVELS)
    if len(levels) < 2:
        return None
    counts, means, spread = _by_level(codes, output)
    fine, _ = _levels(values, max(EFFECT_LEVELS, round(2.0 * n ** (1 / 3))))
    share, error = _variance_share(fine, output)
    reach = float(ndtri(0.5 + 0.5 * CONFIDENCE)) * error
    errors = np.sqrt(spread / np.maximum(counts - 1, 1) / counts)
    return MainEffect(
        levels, tuple(map(int, counts)), tuple(means.tolist()), tuple(errors.tolist()),
        share, (max(share - reach, 0.0), min(share + reach, 1.0)),
    )  # fmt: skip


def sobol_indices(output: Array, factors: int) -> tuple[SobolIndex, ...] | None:
    """Sobol indices of every factor from a Saltelli sample, by SALib.

    Parameters
    ----------
    output : array (blocks * (factors + 2),)   in the order of the sample
    factors : int                              number of factors

    Returns
    -------
    tuple of SobolIndex or None   None if fewer than 8 blocks are whole or the output is constant

    Raises
    ------
    InputError
        If the number of designs is not a multiple of factors + 2.

    Notes
    -----
    A block with a design without a number is left out whole.

    References
    ----------
    Saltelli et al., Comput. Phys. Commun. 181 (2010), 259; intervals by bootstrap.
    """
    if factors < 1 or output.size % (factors + 2):
        raise InputError("designs", output.size, f"a multiple of {factors + 2}")
    blocks = output.reshape(-1, factors + 2)
    blocks = blocks[np.isfinite(blocks).all(axis=1)]
    if len(blocks) < _ROWS_OF_LEVEL or np.ptp(blocks) == 0.0:
        return None
    from SALib.analyze import sobol

    problem = {"num_vars": factors, "names": [str(k) for k in range(factors)],
               "bounds": [[0.0, 1.0]] * factors}  # fmt: skip
    indices = sobol.analyze(
        problem, blocks.ravel(), calc_second_order=False, num_resamples=RESAMPLES,
        conf_level=CONFIDENCE, seed=SEED,
    )  # fmt: skip
    columns = [np.asarray(indices[name]).tolist() for name in ("S1", "S1_conf", "ST", "ST_conf")]
    return tuple(
        SobolIndex(first, (first - a, first + a), total, (total - b, total + b))
        for first, a, total, b in zip(*columns, strict=True)
    )


def independent(count: int, factors: int) -> NDArray[np.int64]:
    """Row numbers of a Saltelli sample that are independent: those of its matrices A and B."""
    block = factors + 2
    starts = np.arange(0, count, block)
    return np.sort(np.concatenate([starts, starts + block - 1]))


def _levels(
    values: NDArray[np.generic], most: int
) -> tuple[NDArray[np.int64], tuple[str | tuple[float, float], ...]]:
    """Levels of a factor: index of the level of each design (n,), and the levels, each a text or
    the least and greatest of its values.

    Numbers with many distinct values for the size of the sample are divided into at most `most`
    levels of equally many designs.

    Parameters
    ----------
    values : array (n,)   numbers or texts
    most : int            number of levels
    """
    distinct, codes = np.unique(values, return_inverse=True)
    if not np.issubdtype(values.dtype, np.number):
        return codes, tuple(str(value) for value in distinct)
    wanted = min(most, values.size // _ROWS_OF_LEVEL)
    if len(distinct) > max(wanted, EFFECT_LEVELS):
        ends = np.quantile(values.astype(float), np.linspace(0.0, 1.0, wanted + 1)[1:-1])
        _, codes = np.unique(np.searchsorted(ends, values, side="left"), return_inverse=True)
    numbers = values.astype(float)
    low = np.full(codes.max() + 1, np.inf)
    high = -low
    np.minimum.at(low, codes, numbers)
    np.maximum.at(high, codes, numbers)
    return codes, tuple(zip(low.tolist(), high.tolist(), strict=True))


def _by_level(codes: NDArray[np.int64], output: Array) -> tuple[Array, Array, Array]:
    """Number of designs, mean output, and sum of squares about the mean, in each of k levels, (k,)
    each.

    Parameters
    ----------
    codes : array (n,)    index of the level of each design
    output : array (n,)   of each design
    """
    counts = np.bincount(codes).astype(float)
    means = np.bincount(codes, output) / counts
    spread = np.bincount(codes, (output - means[codes]) ** 2)
    return counts, means, np.asarray(spread, dtype=float)


def _variance_share(codes: NDArray[np.int64], output: Array) -> tuple[float, float]:
    """Share of the variance of an output that lies between the levels of a factor, without the bias
    of small samples, and its standard error; 0 and 1 where no level has two designs.

    Parameters
    ----------
    codes : array (n,)    index of the level of each design
    output : array (n,)   of each design
    """
    output = (output - output.mean()) / output.std()
    counts, means, spread = _by_level(codes, output)
    n, k = output.size, counts.size
    if n <= k:
        return 0.0, 1.0
    within = float(spread.sum()) / (n - k)
    share = max(1.0 - within * (n - 1) / n, 0.0)
    between = means[codes]
    influence = 2.0 * (output - between) * between + between**2 - share * output**2
    return share, float(np.sqrt(influence.var() / n + 2.0 * (k - 1) / n**2))

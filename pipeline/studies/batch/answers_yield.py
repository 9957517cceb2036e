"""Yield of a study: share of passing designs with confidence interval."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import InputError

CONFIDENCE = 0.95
"""Level of every interval of a study."""
PASSES, FAILS, UNKNOWN = 0, 1, 2
"""State of a design by its verdict or its screen."""


def states_of(verdict: NDArray[np.str_], screen: NDArray[np.str_]) -> tuple[NDArray[np.uint8], str]:
    """State (n,) of each design: `PASSES`, `FAILS` or `UNKNOWN`, and the column that decides it,
    "verdict" or "screen".

    The verdict decides if every design has one or no result; else the screen, of every design. A
    design without a result is neither: yield and stop rule leave it out.
    """
    if (
        np.isin(verdict, ("pass", "incomplete", "fail")).any()
        and not ((verdict == "") & (screen != "error")).any()
    ):
        by, column, passing, failing = "verdict", verdict, ["pass"], ["fail", "incomplete"]
    else:
        by, column, passing, failing = "screen", screen, ["open"], ["fail"]
    state = np.full(len(column), UNKNOWN, dtype=np.uint8)
    state[np.isin(column, passing)] = PASSES
    state[np.isin(column, failing)] = FAILS
    return state, by


@dataclass(frozen=True)
class Yield:
    """Number of passing designs among `count` independent ones."""

    passed: int
    count: int

    def __post_init__(self) -> None:
        if not 0 <= self.passed <= self.count:
            raise InputError("yield.passed", self.passed, f">= 0 and <= {self.count}")

    @property
    def value(self) -> float | None:
        """Share of passing designs; None without designs."""
        return self.passed / self.count if self.count else None

    def interval(self, confidence: float = CONFIDENCE) -> tuple[float, float]:
        """Exact (Clopper-Pearson) confidence interval of the share.

        Parameters
        ----------
        confidence : float   level, > 0 and < 1

        Returns
        -------
        lower, upper : float   0 to 1; (0, 1) without designs

        References
        ----------
        Clopper and Pearson, Biometrika 26 (1934), 404.
        """
        if not 0.0 < confidence < 1.0:
            raise InputError("confidence", confidence, "> 0 and < 1")
        from scipy.special import betaincinv  # not before the workers of a study start

        tail, failed = 0.5 * (1.0 - confidence), self.count - self.passed
        lower = float(betaincinv(self.passed, failed + 1, tail)) if self.passed else 0.0
        upper = float(betaincinv(self.passed + 1, failed, 1.0 - tail)) if failed else 1.0
        return lower, upper

    @property
    def width(self) -> float:
        """Width of the interval; 1 without designs."""
        lower, upper = self.interval()
        return upper - lower

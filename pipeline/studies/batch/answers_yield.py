"""Yield: share of designs that pass, with its confidence interval."""

from __future__ import annotations

from dataclasses import dataclass

from scipy.special import betaincinv

from camwright.geometry.errors import InputError

CONFIDENCE = 0.95
"""Level of every interval of a study."""


@dataclass(frozen=True)
class Yield:
    """Number of designs that pass among `count` independent ones."""

    passed: int
    count: int

    def __post_init__(self) -> None:
        if not 0 <= self.passed <= self.count:
            raise InputError("yield.passed", self.passed, f">= 0 and <= {self.count}")

    @property
    def value(self) -> float | None:
        """Share of designs that pass; None without designs."""
        return self.passed / self.count if self.count else None

    def interval(self, confidence: float = CONFIDENCE) -> tuple[float, float]:
        """Exact interval of the share: it covers the true one at least at this level.

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
        tail, failed = 0.5 * (1.0 - confidence), self.count - self.passed
        lower = float(betaincinv(self.passed, failed + 1, tail)) if self.passed else 0.0
        upper = float(betaincinv(self.passed + 1, failed, 1.0 - tail)) if failed else 1.0
        return lower, upper

    @property
    def width(self) -> float:
        """Width of the interval; 1 without designs."""
        lower, upper = self.interval()
        return upper - lower

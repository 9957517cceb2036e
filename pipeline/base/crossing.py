"""Least value that passes: along rising values, then between the last two."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")

_HALVINGS = 60  # more than a float resolves


def _never(_failing: float, _passing: float) -> bool:
    return False


def _mean(failing: float, passing: float) -> float:
    return 0.5 * (failing + passing)


def first_passing(
    passing: Callable[[float], T | None],
    failing: float,
    values: Iterable[float],
    halvings: int = _HALVINGS,
    *,
    near: Callable[[float, float], bool] = _never,
    middle: Callable[[float, float], float] = _mean,
) -> T | None:
    """Result at the first value that passes, and at the nearest to the one that fails before it.

    Where a value passes beyond one that passes, the result is at the least that does, as far as the
    halvings tell; else at one that passes next to one that fails.

    Parameters
    ----------
    passing : function   value -> its result, None if it fails
    failing : float      value that fails; it is not tried
    values : iterable    away from `failing`, tried in turn
    halvings : int       of the range between a value that fails and one that passes, at most
    near : function      (failing, passing) -> whether they are near enough
    middle : function    (failing, passing) -> the value between them that is tried next

    Returns
    -------
    T   None if no value passes
    """
    for value in values:
        result = passing(value)
        if result is not None:
            break
        failing = value
    else:
        return None
    for _ in range(halvings):
        if near(failing, value):
            break
        between = middle(failing, value)
        nearer = passing(between)
        if nearer is None:
            failing = between
        else:
            value, result = between, nearer
    return result

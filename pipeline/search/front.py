"""Pareto front of two objectives, both minimised."""

from __future__ import annotations

from collections.abc import Sequence


def front(
    figures: Sequence[tuple[float, float]], alike: float = 0.0, gain: float = 0.0
) -> list[int]:
    """Indices of the points of the front, by increasing first objective; both objectives are the
    better the smaller they are.

    Parameters
    ----------
    figures : sequence of (float, float)   objectives; of equal points the first
    alike : float                          relative difference of first objectives up to which the
                                           point with the smaller second one replaces the other
    gain : float                           minimum decrease of the second objective between points
    """
    chosen: list[int] = []
    for k in sorted(range(len(figures)), key=lambda k: (*figures[k], k)):
        size, left = figures[k]
        if chosen and not left < figures[chosen[-1]][1] - gain:
            continue
        if chosen and size <= figures[chosen[-1]][0] * (1.0 + alike):
            chosen.pop()
        chosen.append(k)
    return chosen


def thinned(places: Sequence[int], figures: Sequence[tuple[float, float]], most: int) -> list[int]:
    """At most `most` points of a Pareto front, as indices into `figures`: its two ends, and the
    others less those whose loss costs the front the least area.

    Parameters
    ----------
    places : sequence    indices of the points of the front, by increasing first objective
    figures : sequence   both objectives of every point
    most : int           number of points to be kept, at least the two ends
    """
    kept = list(places)
    while len(kept) > max(most, 2):
        areas = [
            (figures[right][0] - figures[here][0]) * (figures[left][1] - figures[here][1])
            for left, here, right in zip(kept, kept[1:], kept[2:], strict=False)
        ]
        del kept[1 + areas.index(min(areas))]
    return kept

"""The points that no other beats in both respects."""

from __future__ import annotations

from collections.abc import Sequence


def front(
    figures: Sequence[tuple[float, float]], alike: float = 0.0, gain: float = 0.0
) -> list[int]:
    """Indices of the points none of the others is as good as, by the first figure.

    Parameters
    ----------
    figures : sequence of (float, float)   both the better the smaller; of equal ones the first
    alike : float   share by which first figures may differ and still be one; the better stays
    gain : float    what the second figure must fall by for a point to be worth telling
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
    """At most so many points of a front: those that add least to its area go, the ends stay."""
    kept = list(places)
    while len(kept) > max(most, 2):
        areas = [
            (figures[right][0] - figures[here][0]) * (figures[left][1] - figures[here][1])
            for left, here, right in zip(kept, kept[1:], kept[2:], strict=False)
        ]
        del kept[1 + areas.index(min(areas))]
    return kept

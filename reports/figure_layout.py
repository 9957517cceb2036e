"""Vertical axis of a panel and places of the labels of its limits, equal in all drawings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.figures import LimitLine, Panel

FAR_LIMIT = 1.6
"""A limit within this multiple of the curves' range from them extends the vertical axis."""
WORDS_HEIGHT = 0.09
"""Height of the label of a limit, as a share of the panel."""


def vertical_span(panel: Panel, named: bool) -> tuple[float, float]:
    """Lower and upper limit of the vertical axis of a panel: its own span if stated, else around
    curves, ribbons and near limits.

    Parameters
    ----------
    named : bool   whether the marks have names, which need room at the top
    """
    if panel.span is not None:
        return panel.span
    values = np.concatenate([curve.reached for curve in panel.curves] or [np.zeros(1)])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low > 0 and (low < 0.5 * high or panel.from_zero):
        low = 0.0
    size = max(high - low, 1e-12 + 1e-3 * max(abs(low), abs(high)))
    for line in panel.limits:
        if low - FAR_LIMIT * size < line.value < high + FAR_LIMIT * size:
            low, high = min(low, line.value), max(high, line.value)
    size = max(high - low, size)
    named = named or any(curve.notes for curve in panel.curves)
    return low - (0.06 * size if low != 0.0 else 0.0), high + (0.16 if named else 0.07) * size


@dataclass(frozen=True)
class PlacedLimits:
    """Limits on a pair of axes.

    `inside` are limits within the axes, each with whether its label is above the line; `beyond` are
    words on those outside, at the upper edge (True) and at the lower one.
    """

    inside: tuple[tuple[LimitLine, bool], ...]
    beyond: tuple[tuple[str, bool], ...]


def placed_limits(panel: Panel, low: float, high: float) -> PlacedLimits:
    """Limits of a panel on axes from `low` to `high`, in the unit of the panel, with the sides on
    which their labels stand without overlap.
    """
    inside = [line for line in panel.limits if low <= line.value <= high]
    beyond = []
    for upwards, way in ((True, "above"), (False, "below")):
        words = [line.words(panel.unit) for line in panel.limits
                 if (line.value > high if upwards else line.value < low)]  # fmt: skip
        if words:
            beyond.append((f"{'; '.join(words)} ({way} this axis)", upwards))
    taken = [0.0 for _, upwards in beyond if not upwards]  # the upper edge is kept free for words
    heights = [(line.value - low) / (high - low) for line in inside]
    wanted = [h < 0.12 or (each.value >= 0 and h < 0.78)
              for h, each in zip(heights, inside, strict=True)]  # fmt: skip
    upper, clear = _sides(heights, wanted, taken, sign=-1.0)
    if not clear:
        upper, _ = _sides(heights, wanted, taken, sign=1.0)
    return PlacedLimits(tuple(zip(inside, upper, strict=True)), tuple(beyond))


def _sides(
    heights: Sequence[float], wanted: Sequence[bool], taken: Sequence[float], sign: float
) -> tuple[list[bool], bool]:
    """Whether each label stands above its line, and whether all labels are clear of one another.

    Labels with only one possible place are placed first, of the others the lowest (sign 1) or
    highest (-1). Heights are shares of the height of the axes.

    Parameters
    ----------
    heights : sequence   of the lines
    wanted : sequence    whether each label is preferred above its line
    taken : sequence     lower edges of other words
    sign : float         1 or -1
    """
    slots = [{True: height, False: height - WORDS_HEIGHT} for height in heights]
    taken, above = list(taken), list(wanted)

    def order(k: int) -> tuple[int, float]:
        return sum(_free(slot, ()) for slot in slots[k].values()), sign * heights[k]

    clear = True
    for k in sorted(range(len(heights)), key=order):
        if not _free(slots[k][above[k]], taken):
            above[k] = above[k] != _free(slots[k][not above[k]], taken)
        clear &= all(abs(slots[k][above[k]] - other) >= WORDS_HEIGHT - 1e-9 for other in taken)
        taken.append(slots[k][above[k]])
    return above, clear


def _free(bottom: float, taken: Sequence[float]) -> bool:
    """Whether a label at this height is within the axes and clear of the others."""
    within = -1e-9 <= bottom <= 1.0 - 2 * WORDS_HEIGHT
    return within and all(abs(bottom - other) >= WORDS_HEIGHT - 1e-9 for other in taken)

"""First value that passes, and front of two objectives, against enumeration."""

from __future__ import annotations

from itertools import accumulate, islice, pairwise, repeat
from operator import mul

import pytest
from hypothesis import given
from hypothesis import strategies as st

from camwright.pipeline.base.crossing import first_passing
from camwright.pipeline.search.front import front

HALVINGS = 12
LADDER = tuple(float(step) for step in range(1, 9))
FIGURES = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), max_size=8)


@given(st.floats(0.01, 9.0))
def test_a_monotone_limit_is_met_within_the_last_halving(limit: float) -> None:
    tried: list[float] = []

    def passing(value: float) -> float | None:
        tried.append(value)
        return value if value >= limit else None

    least = first_passing(passing, 0.0, LADDER, HALVINGS)
    if limit > LADDER[-1]:
        assert least is None and tried == list(LADDER)
        return
    assert least is not None
    assert limit <= least <= limit + 2.0**-HALVINGS
    assert len(tried) == -(-limit // 1.0) + HALVINGS


@given(st.sets(st.integers(1, 64)))
def test_what_passes_lies_next_to_what_fails(passing: set[int]) -> None:
    """Not monotone: of whole numbers the one found passes, and the one before it does not."""
    values = [8, 16, 32, 64]
    least = first_passing(lambda n: n if n in passing else None, 0, values, 6, middle=_whole)
    reached = [value for value in values if value in passing]
    assert (least is None) == (not reached)
    if least is not None:
        below = [value for value in (0, *values) if value < reached[0]][-1]
        assert least in passing and below < least <= reached[0]
        assert least - 1 not in passing or least - 1 == below


def _whole(failing: float, passing: float) -> int:
    return int(failing + passing) // 2 or 1


def test_the_search_ends_where_the_values_are_near_and_goes_down_as_well() -> None:
    near = first_passing(lambda v: v if v > 1.0 else None, 0.0, (4.0,), near=lambda a, b: b - a < 1)
    assert near == 1.5
    most = first_passing(lambda v: v if v < 1.0 else None, 4.0, (0.0,), 40)
    assert most == pytest.approx(1.0, abs=1e-11) and most < 1.0


def test_growing_values_are_those_of_a_loop() -> None:
    high, loop = 0.0371, []
    for _ in range(16):
        high = 1.1 * high
        loop.append(high)
    assert list(islice(accumulate(repeat(1.1, 16), mul, initial=0.0371), 1, None)) == loop


@given(FIGURES)
def test_a_front_is_what_no_other_dominates(figures: list[tuple[int, int]]) -> None:
    chosen = front(figures)
    undominated = [
        (size, left)
        for size, left in set(figures)
        if not any(a <= size and b <= left for a, b in set(figures) - {(size, left)})
    ]
    assert [figures[k] for k in chosen] == sorted(undominated)
    assert all(figures.index(figures[k]) == k for k in chosen)


@given(FIGURES, st.floats(0.0, 1.0), st.integers(0, 3))
def test_a_thinner_front_is_rising_in_size_and_falls_by_the_gain(
    figures: list[tuple[int, int]], alike: float, gain: int
) -> None:
    thin = [figures[k] for k in front(figures, alike, gain)]
    assert set(thin) <= {figures[k] for k in front(figures)}
    for (small, much), (large, little) in pairwise(thin):
        assert large > small * (1.0 + alike) and little < much - gain

"""Groups of equal patterns, distinct values, median."""

import numpy as np
import pytest

from camwright.geometry.arrays import alike, distinct, median


@pytest.mark.parametrize("rows", [1, 8, 53])
def test_columns_alike_are_those_of_the_same_bytes(rows):
    marks = np.random.default_rng(rows).random((rows, 60)) > 0.97
    groups = alike(marks)
    assert sorted(np.concatenate(groups).tolist()) == list(range(60))
    by_bytes = {marks[:, k].tobytes(): [] for k in range(60)}
    for k in range(60):
        by_bytes[marks[:, k].tobytes()].append(k)
    assert sorted(map(list, groups)) == sorted(by_bytes.values())


def test_columns_without_rows_are_alike_and_no_columns_have_no_group():
    assert [list(group) for group in alike(np.zeros((0, 3), dtype=bool))] == [[0, 1, 2]]
    assert alike(np.zeros((4, 0), dtype=bool)) == []


@pytest.mark.parametrize("size", [1, 2, 7, 8])
def test_distinct_values_and_median_are_those_of_numpy(size):
    values = np.random.default_rng(size).integers(0, 5, size) / 3.0
    np.testing.assert_array_equal(distinct(values), np.unique(values))
    np.testing.assert_array_equal(distinct(values.reshape(-1, 1)), np.unique(values))
    assert median(values) == np.median(values)
    assert distinct([]).size == 0

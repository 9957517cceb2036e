"""Read-only arrays and checks of input values."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.errors import InputError

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Array = NDArray[np.float64]

Values = TypeVar("Values", NDArray[np.float64], NDArray[np.complex128])
Sealed = TypeVar("Sealed", NDArray[np.float64], NDArray[np.intp])
Value = float | NDArray[np.float64]
"""Real values, or complex ones while a derivative is taken by a complex step."""

FULL_TURN = 2.0 * np.pi


def readonly(values: ArrayLike) -> Array:
    """Read-only float array of `values`; one that is read-only and owns its memory is shared."""
    if (
        type(values) is np.ndarray
        and values.base is None
        and values.dtype == np.float64
        and not values.flags.writeable
    ):
        return values
    array = np.array(values, dtype=float)
    array.setflags(write=False)
    return array


def sealed(values: Sealed) -> Sealed:
    """Array made read-only in place, without a copy; the caller keeps no other reference to it."""
    values.setflags(write=False)
    return values


def finite(field: str, values: ArrayLike) -> Array:
    """`values` as a read-only array of finite floats; `field`: their name in the message.

    Raises
    ------
    InputError
        If a value is NaN or infinite.
    """
    array = readonly(values)
    known = np.isfinite(array)
    if not known.all():
        raise InputError(field, float(array[~known].flat[0]), "finite")
    return array


def positive(field: str, values: ArrayLike, unit: str = "") -> Array:
    """`values` as a read-only array of finite floats above zero; `field`: their name in the
    message.

    Raises
    ------
    InputError
        If a value is not positive; NaN included.
    """
    array = finite(field, values)
    bad = ~(array > 0)
    if bad.any():
        raise InputError(field, float(array[bad].flat[0]), f"> 0 {unit}".rstrip())
    return array


def uniform_turn(count: int) -> Array:
    """`count` equally spaced angles over [0, 2 pi), rad."""
    return readonly(np.arange(count) * (FULL_TURN / count))


def greatest_of(first: Array, *others: Array) -> Array:
    """Greatest (...) of arrays by their real parts; NaN where any is."""
    most = first
    for other in others:
        most = np.where(np.isnan(most) | (np.real(most) >= np.real(other)), most, other)
    return most


def distinct(values: ArrayLike) -> Array:
    """Distinct values in ascending order; the input holds no NaN.

    As `numpy.unique`, which imports the masked arrays for it, 20 ms.
    """
    ordered = np.sort(np.asarray(values, dtype=float), axis=None)
    return ordered[firsts(ordered)]


def firsts(ordered: Array) -> NDArray[np.bool_]:
    """Mask (n,) of ascending values: true at the first value of each run of equal ones."""
    first = np.ones(ordered.shape, dtype=bool)
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    return first


def median(values: Array) -> float:
    """Median of values (n,), n >= 1; none is NaN. `numpy.median` imports the masked arrays."""
    ordered, half = np.sort(values), values.size // 2
    return float(0.5 * (ordered[(values.size - 1) // 2] + ordered[half]))


def rotation(angle: float) -> Array:
    """Rotation matrix (2, 2) of a counter-clockwise `angle`, rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def freeze(instance: DataclassInstance, **arrays: ArrayLike) -> None:
    """Set read-only array fields of a frozen dataclass from its ``__post_init__``."""
    for name, values in arrays.items():
        object.__setattr__(instance, name, readonly(values))


def alike(marks: ArrayLike) -> list[NDArray[np.intp]]:
    """Groups of equal columns of a boolean array (k, n): the column numbers, one array per
    different column.
    """
    packed = np.packbits(np.asarray(marks, dtype=bool), axis=0)
    if not packed.size:
        return [np.arange(packed.shape[1])] if packed.shape[1] else []
    order = np.lexsort(packed[::-1])
    ends = (packed[:, order[1:]] != packed[:, order[:-1]]).any(axis=0)
    return np.split(order, np.flatnonzero(ends) + 1)

"""Differences of the files of a run from the same files computed again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import Json, read_json, read_npz
from camwright.pipeline.base.tables import CAM_ANGLE, Table, read_table
from camwright.pipeline.results.workshop_files import WORKSHOP

SAME = 1e-6
"""Relative difference, of the greatest value of a column, that rounding may make."""
_ROUND_OFF = 1e-9
_RESIDUAL = "residual"
_UNREADABLE = (OSError, ValueError, KeyError)


def file_differences(
    stored: Path, again: Path, names: Sequence[str], share: float, exact: bool
) -> Iterator[str]:
    """Differences of files by relative name, one line a file.

    Parameters
    ----------
    again : Path    folder of the files computed again, all of which exist
    share : float   difference of a number that is none, relative to the greatest of its column
    exact : bool    whether a file that is no table, record or array must be the same bytes; else it
                    is not compared
    """
    for name in names:
        file, other = stored / name, again / name
        if not file.is_file():
            yield f"{name}: is missing"
        elif file.read_bytes() != other.read_bytes():
            words = _compared(file, other, share, exact)
            if words:
                yield f"{name}: {words}"


def _compared(file: Path, other: Path, share: float, exact: bool) -> str:
    """The first difference of two files in words; "" without one."""
    try:
        if file.suffix == ".csv" and file.parent.name != WORKSHOP:  # those may have empty columns
            return _tables(file, other, share)
        if file.suffix == ".json":
            return next(record_differences(read_json(file), read_json(other), share), "")
        if file.suffix == ".npz":
            return _arrays(file, other, share)
    except (ResultError, *_UNREADABLE) as error:
        return f"cannot be read ({error})"
    return "is not the file that the case gives" if exact else ""


def _tables(file: Path, other: Path, share: float) -> str:
    """The first difference of two tables."""
    one, two = read_table(file), read_table(other)
    if one.keys() != two.keys() or len(one) != len(two):
        return f"has {len(one)} rows of {len(one.keys())} columns, not the {len(two)} of the case"
    if one.load_cases != two.load_cases:
        return f"has the load cases {', '.join(one.load_cases)}"
    for header, values in two.numbers.items():
        k = _worst(one[header], values, _RESIDUAL in header, share)
        if k is not None:
            at = f"{header}{_place(two, k)}"
            return f"{at} = {_shown(one[header][k])}, recomputed {_shown(values[k])}"
    return ""


def _place(table: Table, row: int) -> str:
    angle = table.get(CAM_ANGLE.header)
    state = "" if table.rows_of is None else f", {table.rows_of[row]}"
    return f" in row {row + 1}" if angle is None else f" at {angle[row]:.4g} deg{state}"


def _arrays(file: Path, other: Path, share: float) -> str:
    one, two = read_npz(file), read_npz(other)
    if sorted(one) != sorted(two):
        return f"holds {', '.join(sorted(one))}, not {', '.join(sorted(two))}"
    for name in two:
        if one[name].shape != two[name].shape or one[name].dtype != two[name].dtype:
            return f"{name} is of another shape or type"
        if two[name].dtype.kind not in "fiu":
            if not np.array_equal(one[name], two[name]):
                return f"{name} differs"
            continue
        values, others = one[name].ravel().astype(float), two[name].ravel().astype(float)
        k = _worst(values, others, _RESIDUAL in name, share)
        if k is not None:
            return f"{name}[{k}] = {_shown(values[k])}, recomputed {_shown(others[k])}"
    return ""


def _worst(one: np.ndarray, two: np.ndarray, residual: bool, share: float) -> int | None:
    """Place of the greatest difference beyond the share; None without any."""
    if not two.size:
        return None
    finite = np.isfinite(two)
    if (np.isfinite(one) != finite).any():
        return int(np.argmax(np.isfinite(one) != finite))
    apart = np.where(finite, np.abs(np.where(finite, one, 0.0) - np.where(finite, two, 0.0)), 0.0)
    greatest = float(np.max(np.abs(two[finite]), initial=0.0))
    k = int(np.argmax(apart))
    return k if apart[k] > _allowed(greatest, residual, share) else None


def record_differences(
    one: Json, two: Json, share: float, place: str = "", left_out: Sequence[str] = ()
) -> Iterator[str]:
    """Differences of two JSON values in words.

    Parameters
    ----------
    share : float         relative difference of two numbers that is none
    left_out : sequence   keys that are not compared, anywhere
    """
    if isinstance(one, Mapping) and isinstance(two, Mapping):
        for key in {**two, **one}:
            inside = f"{place}.{key}" if place else str(key)
            if key in left_out:
                continue
            if key not in one or key not in two:
                yield f"{inside} is {'missing' if key in two else 'none of the case'}"
            else:
                yield from record_differences(one[key], two[key], share, inside, left_out)
    elif isinstance(one, list | tuple) and isinstance(two, list | tuple):
        if len(one) != len(two):
            yield f"{place} has {len(one)} entries, recomputed {len(two)}"
            return
        for k, (a, b) in enumerate(zip(one, two, strict=True)):
            yield from record_differences(a, b, share, f"{place}[{k}]", left_out)
    elif isinstance(one, float) and isinstance(two, int | float) and not isinstance(two, bool):
        if not abs(one - two) <= _allowed(abs(two), _RESIDUAL in place, share):
            yield f"{place} = {_shown(one)}, recomputed {_shown(two)}"
    elif one != two:
        yield f"{place} = {_shown(one)}, recomputed {_shown(two)}"


def _allowed(greatest: float, residual: bool, share: float) -> float:
    """Difference that is none; a residual is itself a rounding error."""
    return SAME if residual else share * greatest + _ROUND_OFF


def _shown(value: object) -> str:
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    text = " ".join(str(value).split())
    return text if len(text) <= 60 else f"{text[:57]}..."

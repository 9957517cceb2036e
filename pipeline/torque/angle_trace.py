"""One quantity against shaft angle over one cycle, from a CSV file."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze, median, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.torque.period import FOUR_STROKE
from camwright.pipeline.torque.trace_file import (
    QUANTITY_UNITS,
    angle_column,
    trace_text,
    value_column,
)

ROWS_MIN = 12
GAP_MAX = radians(20.0)
GAP_OVER_MEDIAN_MAX = 5.0
VALUE_MAX = 1e12  # SI, above any engine's values; sums of squares stay finite
SEAM_MAX = 5.0  # step over the end of the period over the steepest other step
END_TOLERANCE = 0.25  # of the median spacing, between the last sample and the end of the period


@dataclass(frozen=True, eq=False)
class Trace:
    """Samples of one quantity over one period of the shaft angle.

    Parameters
    ----------
    source : str               name of the file
    quantity : str             "torque", "pressure" or "speed"
    column : str               header of the value column
    angle : array (n,)         rad, strictly increasing over less than one period, n >= 12
    values : array (n,)        N m, Pa or rad/s
    period : float             rad
    closure : float            difference of the values at both ends of the period where the file
                               has both, else step from the last to the first row where it is
                               steeper than any other by more than `SEAM_MAX`
    """

    source: str
    quantity: str
    column: str
    angle: Array
    values: Array
    period: float = FOUR_STROKE.angle
    closure: float = 0.0

    def __post_init__(self) -> None:
        """Refuse values that are not finite or absurdly large; the arrays become read-only."""
        freeze(self, angle=self.angle, values=_bounded(self.source, self.column, self.values))

    @property
    def spacing(self) -> Array:
        """Angle from each sample to the next, the last to the first of the next period, rad."""
        return np.diff(np.append(self.angle, self.angle[0] + self.period))

    @property
    def _curve(self) -> scipy.interpolate.Akima1DInterpolator:
        """Interpolant over the period, with a few samples of its neighbours at either end; Akima's,
        modified.
        """
        pad = min(self.angle.size, 6)
        ahead, behind = self.angle[:pad] + self.period, self.angle[-pad:] - self.period
        angle = np.concatenate([behind, self.angle, ahead])
        values = np.concatenate([self.values[-pad:], self.values, self.values[:pad]])
        return scipy.interpolate.Akima1DInterpolator(angle, values, method="makima")

    def __call__(self, angle: ArrayLike) -> Array:
        """Value at crank angles (rad, any shape), periodic, through every sample.

        A modified Akima spline: a cubic whose slopes follow from the five nearest samples. Unlike
        the C2 cubic it does not oscillate after a noisy sample, a step or an uneven spacing; unlike
        the monotone cubic (pchip) it does not cut off a peak between two samples.
        """
        wrapped = self.angle[0] + np.mod(np.asarray(angle) - self.angle[0], self.period)
        return readonly(self._curve(wrapped))

    @property
    def key(self) -> tuple[bytes, bytes, float]:
        """Inputs that determine the interpolated values, as a key of the disk cache."""
        return self.angle.tobytes(), self.values.tobytes(), self.period

    def kept_uniform(self, count: int) -> Array:
        """Uniform samples, see `uniform`, cached on disk: the interpolant's import takes 0.2 s."""
        inputs, modules = (*self.key, count), (sys.modules[__name__],)
        kept = disk_cache.kept("trace", inputs, lambda: {"values": self.uniform(count)}, modules)
        return kept["values"]

    def uniform(self, count: int) -> Array:
        """Values at `count` equally spaced angles from 0, the end of the period excluded.

        If the samples are at least twice as dense, each value is the mean over its interval:
        noise is not aliased.
        """
        step = self.period / count
        angle = np.arange(count) * step
        if median(self.spacing) > 0.5 * step:
            return self(angle)
        ends = np.append(angle - 0.5 * step, self.period - 0.5 * step)
        turns, rest = np.divmod(ends - self.angle[0], self.period)
        sums = self._curve.antiderivative()
        start = sums(self.angle[0])
        whole = sums(self.angle[0] + self.period) - start
        return np.asarray(np.diff(turns * whole + sums(self.angle[0] + rest) - start) / step)


def read_trace(
    path: str | Path,
    quantity: str = "torque",
    *,
    column: str | None = None,
    period: float = FOUR_STROKE.angle,
    part: Literal["crank", "cam"] = "crank",
) -> Trace:
    """Trace of one quantity over one period of crank or cam, from a CSV file.

    The first line that is not a comment (`#`) names the columns and their units, in any usual
    form: `crank_angle_deg`, `crank angle [deg]`, `angle (rad)`, `torque_Nm`, `torque [kN m]`.
    Columns are separated by semicolons, tabs or commas; the decimal sign is a point, or a comma
    where it does not separate columns. The units may stand in a second line, and the names in a
    comment above the rows. Angles increase strictly; if both ends of the period are present, the
    mean of their values is kept.

    Parameters
    ----------
    path : path
    quantity : str            "torque", "force", "pressure", "lift" or "speed"
    column : str, optional    header of the value column, or its beginning; needed if several
                              columns are of the quantity
    period : float            rad
    part : str                whose angle: "crank", the shaft of any machine, or "cam"

    Raises
    ------
    InputError
        With file, line, value and limit: if the file is missing, a folder, empty, binary or over
        64 MiB; a unit is missing or unknown; a cell is no finite number; angles repeat, fall or
        have gaps over 20 deg or 5 times the median spacing; the span is not the period; there
        are fewer than 12 rows.
    """
    if quantity not in QUANTITY_UNITS:
        raise InputError("quantity", quantity, "one of " + ", ".join(QUANTITY_UNITS))
    unit = {"lift": "mm", "pressure": "bar"}.get(quantity, next(iter(QUANTITY_UNITS[quantity])))
    text = trace_text(Path(path), f"angle_deg,{quantity}_{unit}")
    name, header, lines = text.name, text.header, text.line_numbers
    angle_at, angle_factor = angle_column(name, header, part)
    value_at, value_factor = value_column(name, header, quantity, column)
    table = text.numbers((angle_at, value_at))
    angle = table[:, 0] * angle_factor
    guard_order(name, lines, table[:, 0], header[angle_at])
    guard_span(name, angle, angle_factor, period)
    with np.errstate(over="ignore"):  # refused below
        values = table[:, 1] * value_factor
    return one_period(name, quantity, header[value_at], lines, angle, values, period)


def one_period(
    name: str,
    quantity: str,
    column: str,
    lines: Sequence[int],
    angle: Array,
    values: Array,
    period: float = FOUR_STROKE.angle,
    gap_max: float = GAP_MAX,
) -> Trace:
    """Trace of one column of a file over one period, its angles having been checked for order and
    span.

    Parameters
    ----------
    name : str              of the file
    quantity : str          "torque", "pressure" or "speed"
    column : str            header of the column
    lines : sequence (n,)   line of each row in the file
    angle : array (n,)      rad; a row at the end of the period is averaged with the first
    values : array (n,)     SI
    period : float          rad
    gap_max : float         rad, maximum gap between rows

    Raises
    ------
    InputError
        If a gap is wider, or above 5 times the median spacing.
    """
    written = values = _bounded(name, column, values)
    angle, values = without_end(angle, values, period)
    closed = values.size < written.size
    closure = float(abs(written[-1] - written[0])) if closed else _seam(angle, values, period)
    trace = Trace(name, quantity, column, angle, values, period, closure)
    _guard_gaps(trace, lines, gap_max)
    return trace


def _bounded(name: str, column: str, values: Array) -> Array:
    """The values of a column, SI, if they are finite and not absurdly large."""
    field = f"{name}, {column}"
    wild = np.abs(finite(field, values)) > VALUE_MAX
    if wild.any():
        raise InputError(field, float(values[wild][0]), f"within {VALUE_MAX:g} of zero in SI units")
    return values


def without_end(angle: Array, values: Array, period: float) -> tuple[Array, Array]:
    """Angles (n,), rad, and values (n, ...) of one period; a row that repeats the start at its end
    is averaged into the first row.
    """
    if period - (angle[-1] - angle[0]) > END_TOLERANCE * median(np.diff(angle)):
        return angle, values
    mean = 0.5 * (values[:1] + values[-1:])
    return angle[:-1], np.concatenate([mean, values[1:-1]])


def _seam(angle: Array, values: Array, period: float) -> float:
    """Step from the last to the first value of a period that does not continue the others, or 0."""
    across, gap = float(abs(values[0] - values[-1])), float(angle[0] + period - angle[-1])
    steepest = float(np.abs(np.diff(values) / np.diff(angle)).max())
    return across if across > SEAM_MAX * steepest * gap else 0.0


def guard_order(name: str, lines: Sequence[int], angle: Array, header: str) -> None:
    """Refuse a file with too few rows, or with angles that do not increase.

    Parameters
    ----------
    name : str              of the file
    lines : sequence (n,)   line of each row in the file
    angle : array (n,)      in the unit of the file
    header : str            of the column of angles
    """
    if angle.size < ROWS_MIN:
        raise InputError(name, f"{angle.size} rows", f"{ROWS_MIN} rows or more")
    steps = np.diff(angle)
    if (steps > 0.0).all():
        return
    at = int(np.flatnonzero(~(steps > 0.0))[0]) + 1
    fault = "repeats an angle" if angle[at] in angle[:at] else f"falls after {angle[at - 1]:g}"
    value = f"{angle[at]:g} ({fault})"
    raise InputError(f"{name} line {lines[at]}, {header}", value, "above the row before")


def guard_span(
    name: str, angle: Array, factor: float, period: float, gap_max: float = GAP_MAX
) -> None:
    """Refuse a trace whose angles do not span one period; the message hints at a wrong unit or
    number of cycles.

    Parameters
    ----------
    name : str           of the file
    angle : array (n,)   rad
    factor : float       from the unit of the file to rad
    period : float       rad
    gap_max : float      maximum gap between rows, so between last row and end of the period, rad
    """
    spacing = median(np.diff(angle))
    span = float(angle[-1] - angle[0])
    excess = span - period
    if excess <= END_TOLERANCE * spacing and -excess <= _gap_limit(spacing, gap_max):
        return
    written = span / factor
    in_degrees = factor != 1.0 and abs(written / period - 1.0) < 0.1
    in_radians = factor == 1.0 and abs(written / np.degrees(period) - 1.0) < 0.1
    hint = ""
    if in_degrees:
        hint = " (the angles look like radians)"
    elif in_radians:
        hint = " (the angles look like degrees)"
    elif abs(2.0 * span / period - 1.0) < 0.1:
        hint = " (this is half a cycle)"
    elif round(span / period) > 1 and abs(span / (period * round(span / period)) - 1.0) < 0.1:
        hint = f" (this is {round(span / period)} cycles)"
    value = f"{np.degrees(span):.6g} deg from first to last row{hint}"
    raise InputError(f"{name} span", value, f"one cycle of {np.degrees(period):g} deg")


def _gap_limit(spacing: float, gap_max: float) -> float:
    """Maximum gap at a median spacing, rad; above the default it is `gap_max`."""
    if gap_max > GAP_MAX:
        return float(gap_max) * (1.0 + 1e-9)
    return min(float(gap_max), GAP_OVER_MEDIAN_MAX * spacing) * (1.0 + 1e-9)


def _guard_gaps(trace: Trace, lines: Sequence[int], gap_max: float) -> None:
    """Refuse a trace with a gap between rows too wide to interpolate.

    Parameters
    ----------
    trace : Trace           of one period
    lines : sequence (n,)   line of each row in the file
    gap_max : float         maximum gap, rad
    """
    limit = _gap_limit(median(trace.spacing), gap_max)
    widest = int(np.argmax(trace.spacing))
    if trace.spacing[widest] > limit:
        gap, start = trace.spacing[widest], trace.angle[widest]
        field = f"{trace.source} line {lines[widest]}, gap after {np.degrees(start):g} deg"
        raise InputError(
            field, f"{np.degrees(gap):.4g} deg", f"at most {np.degrees(limit):.4g} deg"
        )

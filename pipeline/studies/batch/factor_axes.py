"""Factors of a study as axes: unit, levels or distribution, values in SI."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import In
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case, includes
from camwright.pipeline.case.case_values import quantity_of, steps_of, value_of
from camwright.pipeline.studies.batch.study_file import (
    Factor,
    GridSampling,
    Normal,
    Range,
    Triangular,
    Value,
)

_WITH_UNIT = re.compile(
    r"\s*([+-]?(?:[0-9]+(?:_[0-9]+)*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)\s*(\S.*?)\s*"
)
_NO_FACTORS = ("schema_version", "name", "title", "notes", "sources", "confirmed")
_OF_THE_STUDY = ("solver.positions", "solver.max_trials")
SIGMAS = 3.0
"""Standard deviations in a tolerance of a normal distribution."""
Levels = tuple[str | bool | int | float, ...]


@dataclass(frozen=True, eq=False)
class Axis:
    """Factor ready for sampling: unit, levels or distribution.

    Parameters
    ----------
    key : str
    unit : str       of its values; "": pure number; None: names, or true and false
    levels : tuple   discrete values, numbers in `unit`; empty: continuous
    law : str        distribution of a continuous factor
    low, high : float   its ends in `unit`; mean - std and mean + std of a normal one
    """

    key: str
    unit: str | None
    levels: Levels = ()
    law: Literal["uniform", "normal", "triangular"] = "uniform"
    low: float = 0.0
    high: float = 0.0
    _affine: tuple[float, float] = field(default=(0.0, 1.0))

    @property
    def factorial(self) -> Levels:
        """Levels of a grid or list.

        Raises
        ------
        InputError
            If the factor is continuous.
        """
        if not self.levels:
            limit = "list or grid, with sampling.method = grid or list"
            raise InputError(f"factor {self.key}", self.law, limit)
        return self.levels

    def at(self, share: Array) -> Array:
        """Values (n,) of a continuous factor, in its unit, at cumulative probabilities (n,) between
        0 and 1: the inverse of its distribution.
        """
        if self.law == "normal":
            from scipy.special import ndtri

            middle, std = 0.5 * (self.low + self.high), 0.5 * (self.high - self.low)
            return np.asarray(middle + std * ndtri(share))
        width = self.high - self.low
        if self.law == "triangular":
            rising = np.sqrt(0.5 * share)
            falling = 1.0 - np.sqrt(0.5 * (1.0 - share))
            return np.asarray(self.low + width * np.where(share < 0.5, rising, falling))
        return self.low + width * share

    def si(self, values: Array) -> Array:
        """Values (n,) of the factor from its unit to SI; a level is converted as a case file would
        read it, to the last digit.
        """
        if not self.unit:
            return values
        if self.levels:
            texts = {level: f"{float(level)!r} {self.unit}" for level in self.levels}
            known = {level: units.parse(text, self.unit, "") for level, text in texts.items()}
            return np.array([known[level] for level in values.tolist()])
        offset, scale = self._affine
        return offset + scale * values


def axis_of(factor: Factor, case: Case) -> Axis:
    """Axis of a factor, its values or distribution in one unit; a missing mean is taken from the
    case.

    Parameters
    ----------
    factor : Factor   of the study file
    case : Case       the first base case

    Raises
    ------
    InputError
        If the key is unknown or of no value of the case, a value has another dimension, or the ends
        do not rise.
    """
    key, spread = factor.key, factor.spread
    quantity = quantity_of(key)
    _require_value_at(case, key)
    if isinstance(spread, tuple):
        return _of_levels(key, quantity, spread)
    if not isinstance(quantity, In):
        raise InputError(f"factor {key}", "no number", "a list of values")
    if isinstance(spread, (GridSampling, Range)):
        reading = _Reading(key, quantity, spread.low)
        low, high = reading.number(spread.low), reading.number(spread.high)
        if not low < high:
            raise InputError(f"factor {key}.high", str(spread.high), f"> {spread.low}")
        if isinstance(spread, Range):
            return Axis(key, reading.unit, (), "uniform", low, high, reading.affine)
        steps = np.linspace(low, high, spread.count)
        return Axis(key, reading.unit, tuple(float(f"{v:.12g}") for v in steps.tolist()))
    mean = _mean(key, quantity, case) if spread.mean is None else spread.mean
    reading = _Reading(key, quantity, mean)
    middle = reading.number(mean)
    if isinstance(spread, Normal):
        stated = spread.tolerance if spread.std is None else spread.std
        half = reading.width(stated, middle) / (1.0 if spread.tolerance is None else SIGMAS)
        return Axis(key, reading.unit, (), "normal", middle - half, middle + half, reading.affine)
    half = reading.width(spread.tolerance, middle)
    law: Literal["uniform", "triangular"]
    law = "triangular" if isinstance(spread, Triangular) else "uniform"
    return Axis(key, reading.unit, (), law, middle - half, middle + half, reading.affine)


def _require_value_at(case: Case, key: str) -> None:
    """Refuse a key that does not name a single value of the design: one of a section that no factor
    may vary or of the study itself, an included file, a table, an entry beyond the end of a list.

    A key that the case leaves out is accepted, as its value may be optional.
    """
    if key.partition(".")[0] in _NO_FACTORS or key in _OF_THE_STUDY:
        limit = f"none of {', '.join((*_NO_FACTORS, *_OF_THE_STUDY))}"
        raise InputError("factor.key", key, limit)
    if key in {name for name, _ in includes(case)}:
        raise InputError("factor.key", key, "a value; an included file is that of the case")
    node: object = case.tables()
    for step in steps_of(key):
        if isinstance(step, int):
            if not (isinstance(node, list) and step < len(node)):
                raise InputError("factor.key", key, "in a table that the case has")
            node = node[step]
        else:
            node = node.get(step) if isinstance(node, dict) else None
    if isinstance(node, (dict, list)):
        raise InputError("factor.key", key, "a value, not a table")


def _of_levels(key: str, quantity: object, values: Sequence[Value]) -> Axis:
    """Axis of a factor with a list of values: numbers in the unit of the first one, pure numbers,
    or texts.

    Parameters
    ----------
    key : str           dotted, of the case file
    quantity : object   unit and bounds of the key, `In`; other: the key has no unit
    values : sequence   as stated in the study file
    """
    if isinstance(quantity, In):
        reading = _Reading(key, quantity, values[0])
        return Axis(key, reading.unit, tuple(reading.number(each) for each in values))
    if all(isinstance(each, (int, float)) and not isinstance(each, bool) for each in values):
        return Axis(key, "", tuple(values))
    return Axis(key, None, tuple(values))


def _mean(key: str, quantity: In, case: Case) -> Value:
    """Value of the case at a key, a number or text with the unit of the quantity, as mean of a
    distribution that states none; InputError where the case has no number there.
    """
    value = value_of(case, key)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"factor {key}.mean", "missing", "given, as the case has no such number")
    if not quantity.unit:
        return value
    return f"{in_unit(value, quantity.unit)!r} {quantity.unit}"


class _Reading:
    """Numbers of one factor in the unit of its first value."""

    def __init__(self, key: str, quantity: In, first: Value | None) -> None:
        """Take the unit of the first value; `affine`: offset and factor from this unit to SI.

        Parameters
        ----------
        key : str       of the factor
        quantity : In   of the key
        first : Value   number, or text with a unit
        """
        self._field, self._quantity = f"factor {key}", quantity
        self.unit, self.affine = "", (0.0, 1.0)
        if quantity.unit:
            units.parse(first, quantity.unit, self._field)
            match = _WITH_UNIT.fullmatch(str(first))
            self.unit = quantity.unit if match is None else match[2]
            zero, one = (units.parse(f"{n} {self.unit}", self.unit, "") for n in (0, 1))
            self.affine = zero, one - zero

    def number(self, value: Value | None) -> float:
        """Value, a number or text with any unit of the quantity, as a number in the unit of the
        factor.

        It is not compared with the bounds of the key, which refuse a design, not the study.
        """
        if not self._quantity.unit:
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise InputError(self._field, str(value), "a number without a unit")
            return float(value)
        si = units.parse(value, self._quantity.unit, self._field)
        match = _WITH_UNIT.fullmatch(str(value))
        if match is not None and match[2] == self.unit:
            return float(match[1])
        offset, scale = self.affine
        return (si - offset) / scale

    def width(self, value: Value | None, mean: float) -> float:
        """Tolerance or standard deviation as a number in the unit of the factor, > 0.

        Parameters
        ----------
        value : Value   number, text with a unit, or ``"5 %"``, a share of the mean
        mean : float    in the unit of the factor
        """
        match = _WITH_UNIT.fullmatch(value) if isinstance(value, str) else None
        if match is not None and match[2] == "%":
            width = abs(mean) * float(match[1]) / 100.0
        else:
            width = self._difference(value)
        if not (np.isfinite(width) and width > 0.0):
            raise InputError(f"{self._field}: tolerance", str(value), "> 0")
        return width

    def _difference(self, value: Value | None) -> float:
        """Difference of two values of the factor as a number in its unit, without the offset of a
        temperature scale: 5 degC is 5 K.
        """
        match = _WITH_UNIT.fullmatch(str(value))
        if match is None or not self._quantity.unit:
            return self.number(value)
        wanted, name = self._quantity.unit, self._field
        end, zero = (units.parse(each, wanted, name) for each in (value, f"0 {match[2]}"))
        return (end - zero) / self.affine[1]

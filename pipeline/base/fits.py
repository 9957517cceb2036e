"""Sizes with tolerance class and limit deviations: ISO 286 and DIN 6885."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

from camwright.geometry.arrays import positive
from camwright.pipeline.base.files import Json
from camwright.pipeline.base.units import in_unit

BoreFit = Literal["H6", "H7", "H8"]
"""Tolerance class of a bore; its lower deviation is zero."""
KeywayFit = Literal["JS9", "P9"]
"""Tolerance class of the width of a keyway: light or tight fit of DIN 6885."""

_MICROMETRE, _MILLIMETRE = 1e-6, 1e-3
_UP_TO = (3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500)  # mm, ranges of ISO 286-1
_GRADES = {
    "6": (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    "7": (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    "8": (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    "9": (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
}
"""Width of the standard tolerance grades, um (recalled, verify)."""
_P = (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68)
"""Upper deviation of holes of class P9 below zero, um (recalled, verify)."""
_KEYWAY_DEPTHS = ((6.5, 0.1), (33.0, 0.2), (100.0, 0.3))
"""Upper deviation of the depth of a keyway, mm, by its greatest width (recalled, verify)."""


class Deviations(NamedTuple):
    """Lower and upper limit deviation of a size, m."""

    lower: float
    upper: float


@dataclass(frozen=True)
class Size:
    """Nominal size, m, with tolerance class and limit deviations; None beyond the tables."""

    nominal: float
    fit: str = ""
    deviations: Deviations | None = None

    @property
    def number(self) -> str:
        """Nominal size in mm with the tolerance class, such as ``17 H7``."""
        return f"{in_unit(self.nominal, 'mm'):.6g} {self.fit}".rstrip()

    @property
    def bounds(self) -> tuple[str, ...]:
        """Upper and lower limit deviation as text, mm; one text where they are opposite, such as
        "±0.02"; empty where they are not known.
        """
        if self.deviations is None:
            return ()
        lower, upper = (in_unit(each, "mm") for each in self.deviations)
        if lower == -upper:
            return (f"\u00b1{upper:.4g}",)
        return tuple(f"{each:+.4g}" if each else "0" for each in (upper, lower))

    @property
    def words(self) -> str:
        """Size with class and deviations, such as ``17 H7 (+0.018/0)``, mm."""
        return f"{self.number} ({'/'.join(self.bounds)})" if self.bounds else self.number

    def as_record(self) -> dict[str, Json]:
        """The size for a JSON record, mm."""
        lower, upper = self.deviations or (None, None)
        return {
            "nominal_mm": in_unit(self.nominal, "mm"),
            "class": self.fit,
            "lower_mm": None if lower is None else in_unit(lower, "mm"),
            "upper_mm": None if upper is None else in_unit(upper, "mm"),
        }


def size_of(record: Mapping[str, Any]) -> Size:
    """Size from its record, see `Size.as_record`; KeyError or TypeError for another value."""
    lower, upper = record["lower_mm"], record["upper_mm"]
    known = None
    if lower is not None:
        known = Deviations(lower * _MILLIMETRE, upper * _MILLIMETRE)
    return Size(record["nominal_mm"] * _MILLIMETRE, str(record["class"]), known)


def size_deviations(size: float, fit: BoreFit | KeywayFit) -> Deviations | None:
    """Limit deviations, m, of an inner size, bore or keyway width, by its tolerance class; None
    beyond the 500 mm of the tables.

    Parameters
    ----------
    size : float   nominal size, m
    fit : str      tolerance class, such as "H7", "JS9" or "P9"

    Raises
    ------
    InputError
        If the size is not positive.

    References
    ----------
    ISO 286-1, tables 1 to 3.
    """
    positive("size", size, "m")
    row = bisect_left(_UP_TO, size / _MILLIMETRE * (1.0 - 1e-12))
    if row == len(_UP_TO):
        return None
    width = _GRADES[fit[-1]][row]
    if fit == "JS9":
        return Deviations(-0.5 * width * _MICROMETRE, 0.5 * width * _MICROMETRE)
    low = -(_P[row] + width) if fit == "P9" else 0
    return Deviations(low * _MICROMETRE, (low + width) * _MICROMETRE)


def keyway_depth_deviations(width: float) -> Deviations | None:
    """Limit deviations, m, of the depth of a keyway in a hub, by the width of the keyway, m; None
    beyond 100 mm.

    Raises
    ------
    InputError
        If the width is not positive.

    References
    ----------
    DIN 6885-1, table 1.
    """
    positive("width", width, "m")
    for widest, upper in _KEYWAY_DEPTHS:
        if width <= widest * _MILLIMETRE:
            return Deviations(0.0, upper * _MILLIMETRE)
    return None

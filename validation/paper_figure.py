"""Figure of a paper: curves with units, caption, published values beside the computed ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil, isnan, log10
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from validation.published_figures import Basis, Target

Look = Literal["line", "dashed", "dotted", "thin", "points", "band", "fill", "bar"]
Kind = Literal["lines", "outline", "bars"]
CRANK, SPEED, TORQUE = "crank angle, deg", "crank speed, rad/s", "crank torque, N m"
"""Axes of most figures."""
MUTED = -1
"""Series of a curve in the background."""
PUBLISHED = -2
"""Series of published points."""


@dataclass(frozen=True, eq=False)
class PaperCurve:
    """One curve of a panel.

    Parameters
    ----------
    label : str           in the legend; empty: none
    x, y : array (n,)     in the units of the panel
    series : int          colour, equal for the same thing in all panels of a figure
    upper : array (n,)    look `band`: the region from `y` to `upper`; look `bar`: from `y`
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    series: int = 0
    look: Look = "line"
    upper: ArrayLike | None = None

    def record(self) -> dict[str, Any]:
        """The curve with lists of numbers to 1e-7 of the greatest; NaN, a gap, as null."""
        held = {"x": self.x, "y": self.y, **({} if self.upper is None else {"upper": self.upper})}
        numbers = {name: _numbers(self, name, values) for name, values in held.items()}
        if len({len(values) for values in numbers.values()}) != 1:
            raise InputError(f"curve {self.label}", "lengths differ", "as many values of x and y")
        return {"label": self.label, "series": self.series, "look": self.look, **numbers}


def _numbers(curve: PaperCurve, name: str, values: ArrayLike) -> list[float | None]:
    array = np.asarray(values, dtype=float)
    if array.ndim != 1 or not np.isfinite(array).any() or np.isinf(array).any():
        raise InputError(f"curve {curve.label}.{name}", array.shape, "one dimension with a value")
    places = 7 - ceil(log10(float(np.nanmax(np.abs(array))) or 1.0))
    return [None if isnan(value) else value for value in np.round(array, places).tolist()]


@dataclass(frozen=True, eq=False)
class PaperPanel:
    """One pair of axes: quantities with units, curves, a note on the figure.

    `rows`: names of the bars of a panel of kind `bars`, from the top. `window`: limits of an
    outline (left, right, low, high); empty: all of it, at the scale of the others.
    """

    x: str
    y: str
    curves: tuple[PaperCurve, ...]
    title: str = ""
    note: str = ""
    kind: Kind = "lines"
    rows: tuple[str, ...] = ()
    window: tuple[float, ...] = ()

    def record(self) -> dict[str, Any]:
        return {
            "title": self.title, "x": self.x, "y": self.y, "kind": self.kind, "note": self.note,
            "rows": list(self.rows), "window": list(self.window),
            "curves": [curve.record() for curve in self.curves],
        }  # fmt: skip


@dataclass(frozen=True)
class Beside:
    """A published value beside the computed one.

    `row` is the row of ``values.json``, empty for a value that is none; `basis` what the computed
    value rests on. Numbers have their difference; a share of the published value is meaningful
    for a `ratio_scale` alone, such as a ripple, not for a speed of which the ripple is a few
    percent.
    """

    quantity: str
    published: float | str
    computed: float | str
    unit: str
    basis: Basis
    row: str = ""
    ratio_scale: bool = True

    def record(self) -> dict[str, Any]:
        difference = share = None
        if not isinstance(self.published, str) and not isinstance(self.computed, str):
            difference = float(self.computed) - float(self.published)
            if self.ratio_scale and self.published:
                share = 100.0 * difference / abs(float(self.published))
        return {
            "row": self.row, "basis": self.basis, "quantity": self.quantity, "unit": self.unit,
            "published": self.published, "computed": self.computed, "difference": difference,
            "difference_percent": share,
        }  # fmt: skip


@dataclass(frozen=True, eq=False)
class PaperFigure:
    """A figure of a paper, drawn from computed data.

    Parameters
    ----------
    name : str        of the figure on the command line
    numbers : str     of the figures in the paper
    caption : str     what is shown, and from which data
    columns : int     panels side by side
    table : sequence of mapping   one row each, names with units: of computed values alone
    """

    name: str
    paper: str
    numbers: str
    title: str
    caption: str
    panels: tuple[PaperPanel, ...]
    values: tuple[Beside, ...] = ()
    columns: int = 1
    table: tuple[Mapping[str, float | str | None], ...] = ()

    def record(self) -> dict[str, Any]:
        """The figure as an entry of ``papers.json``."""
        return {
            "name": self.name, "paper": self.paper, "numbers": self.numbers, "title": self.title,
            "caption": self.caption, "columns": self.columns,
            "panels": [panel.record() for panel in self.panels],
            "values": [value.record() for value in self.values],
            "table": [dict(row) for row in self.table],
        }  # fmt: skip


def beside(
    targets: Mapping[str, Target],
    row: str,
    computed: float | str,
    *,
    ratio_scale: bool = True,
    place: int | None = None,
    note: str = "",
    basis: Basis | None = None,
) -> Beside:
    """A published value by its row, beside the computed one; `place`: of a row of several.

    `basis` is that of the row unless the value is computed in another way.
    """
    target = targets[row]
    published = target.value if place is None else target.value[place]
    words = ", ".join(filter(None, (target.quantity, target.condition, note)))
    units = target.unit.split(", ")
    unit = units[place] if place is not None and len(units) > 1 else target.unit
    rests = basis or target.basis
    return Beside(words, published, computed, unit, rests, row, ratio_scale)


def closed(values: Array) -> Array:
    """Values (n,) over a turn with the first one repeated at the end, (n + 1,)."""
    return np.append(values, values[:1])


def closed_angle(count: int, period: float) -> Array:
    """Angles (count + 1,) of such values, deg, from 0 to `period`."""
    return np.linspace(0.0, period, count + 1)


def outline(points: Array) -> tuple[Array, Array]:
    """Closed outline, mm, of points (2, n), m."""
    x, y = 1e3 * points
    return closed(x), closed(y)


def records(figures: Iterable[PaperFigure]) -> list[dict[str, Any]]:
    """Records of figures in their order."""
    return [figure.record() for figure in figures]

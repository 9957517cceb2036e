"""Columns by header for those who compute with them: data frame, figure, extremes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.display import Displayed, html_table, panels_of
from camwright.geometry.errors import InputError, ResultError

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

Cells = NDArray[np.float64] | NDArray[np.str_]
RANGE = ("column", "least", "greatest")
"""Head of the table of a result with columns."""


class Columned(Displayed):
    """A result with columns of one length by header, each in the unit of its header.

    `keys` and ``[header]`` make ``dict(result)``; `columns` is such a dict.
    """

    @property
    def columns(self) -> dict[str, Cells]:
        """Read-only columns (n,) by header; text in that of the load cases."""
        raise NotImplementedError

    def keys(self) -> tuple[str, ...]:
        """Headers of the columns."""
        return tuple(self.columns)

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a data frame of pandas, with the headers of the CSV files.

        Raises
        ------
        ResultError
            If pandas is not installed.
        """
        return data_frame(self.columns)

    def plot(self, *headers: str) -> tuple[Axes, ...]:
        """Curves of columns over the first column of numbers, one panel each, by load case.

        Parameters
        ----------
        headers : str   one or more of `keys`; without one the first after the angles

        Returns
        -------
        tuple   axes of the panels, in a figure of pyplot

        Raises
        ------
        InputError
            If there is no such column of numbers.
        """
        return curves(self.columns, headers)

    def ranges(self) -> list[tuple[str, str, str]]:
        """Header, least and greatest value of each column in words; see `RANGE`."""
        return [(header, *_range(cells)) for header, cells in self.columns.items()]

    def _repr_html_(self) -> str:
        return html_table(repr(self), RANGE, self.ranges())


def data_frame(columns: Mapping[str, object]) -> pd.DataFrame:
    """A data frame of pandas; ResultError where pandas is not installed."""
    try:
        import pandas as pd
    except ImportError:
        raise ResultError(
            "a data frame needs the package pandas: pip install 'camwright[notebook]'"
        ) from None
    return pd.DataFrame(dict(columns))


def curves(columns: Mapping[str, NDArray[Any]], headers: Sequence[str]) -> tuple[Axes, ...]:
    """Curves of columns over the first column of numbers; see `Columned.plot`."""
    numbers = [header for header, cells in columns.items() if cells.dtype.kind == "f"]
    angles = [header for header in numbers if header.endswith("angle_deg")]
    others = [header for header in numbers if header not in (numbers[0], *angles)]
    chosen = list(headers) or others[:1] or numbers[:1]
    if not chosen:
        raise InputError("columns", "without numbers", "of numbers to be drawn")
    for header in chosen:
        if header not in numbers:
            raise InputError("header", header, f"one of {', '.join(numbers)}")
    owners = next((cells for cells in columns.values() if cells.dtype.kind == "U"), None)
    names = [""] if owners is None else list(dict.fromkeys(owners.tolist()))
    panels = panels_of(len(chosen))
    for axes, header in zip(panels, chosen, strict=True):
        for name in names:
            rows = slice(None) if owners is None else owners == name
            axes.plot(columns[numbers[0]][rows], columns[header][rows], label=name)
        axes.set_ylabel(header)
        axes.grid(alpha=0.3)
    if len(names) > 1:
        panels[0].legend(fontsize="small")
    panels[-1].set_xlabel(numbers[0])
    return panels


def _range(cells: Cells) -> tuple[str, str]:
    """Least and greatest value of a column, first and last text; "" where none is known."""
    if cells.dtype.kind != "f":
        names = cells.tolist()
        return (str(names[0]), str(names[-1])) if names else ("", "")
    known = cells[~np.isnan(cells.astype(float))].astype(float)
    return (f"{known.min():.6g}", f"{known.max():.6g}") if known.size else ("", "")

"""Columns of a table as a data frame, as curves, and their extremes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import InputError
from camwright.geometry.figures import SERIES, Curve, DrawnAxes, Panel, over, plotted
from camwright.pipeline.base.extras import require_extra

if TYPE_CHECKING:
    import pandas as pd

Cells = NDArray[np.float64] | NDArray[np.str_]


def data_frame(columns: Mapping[str, object]) -> pd.DataFrame:
    """Columns as a pandas data frame; ResultError where pandas is not installed."""
    require_extra("notebook", "a data frame")
    import pandas as pd

    return pd.DataFrame(dict(columns))


def curves(columns: Mapping[str, NDArray[Any]], headers: Sequence[str]) -> DrawnAxes:
    """Curves of columns of a table over its first column of numbers, a panel each and a curve per
    load case; see `Table.plot`.

    Parameters
    ----------
    columns : mapping    values (n,) by header: numbers, and one of texts, the load case
    headers : sequence   of the columns drawn; empty: the first that is no angle

    Raises
    ------
    InputError
        If a header is none of a column of numbers, or there are no numbers.
    """
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
    rows = [slice(None) if owners is None else owners == name for name in names]
    panels = [
        Panel(header, "", tuple(
            Curve(columns[numbers[0]][row], columns[header][row], name, colour)
            for name, row, colour in zip(names, rows, cycle(SERIES), strict=False)
        ))
        for header in chosen
    ]  # fmt: skip
    return plotted(over("columns", "", "", numbers[0], "", panels, dots=False))

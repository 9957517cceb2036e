"""Columns of a table as a data frame, as curves, and their extremes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.display import panels_of
from camwright.geometry.errors import InputError
from camwright.pipeline.base.extras import require_extra

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

Cells = NDArray[np.float64] | NDArray[np.str_]


def data_frame(columns: Mapping[str, object]) -> pd.DataFrame:
    """Columns as a pandas data frame; ResultError where pandas is not installed."""
    require_extra("notebook", "a data frame")
    import pandas as pd

    return pd.DataFrame(dict(columns))


def curves(columns: Mapping[str, NDArray[Any]], headers: Sequence[str]) -> tuple[Axes, ...]:
    """Curves of columns over the first column of numbers; see `Table.plot`."""
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

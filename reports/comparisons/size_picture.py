"""Chart of cam size: pressure angle and curvature over the base radius."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.size_document import SizeDocument
from camwright.reports.figure_svg import COLOURS, png, shipped, style
from camwright.reports.figures import SERIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_WIDTH, _HEIGHT = 6.4, 2.5
_HEADROOM = 1.9
"""Greatest value of a panel over the greater of limit and value at the sized radius."""


@shipped()
def draw(document: SizeDocument, out: Path) -> Path:
    """Write the chart of a sizing, pressure angle and curvature over base radius, PNG or SVG."""
    with style(out.stem):
        canvas = _chart(document)
        if out.suffix == ".png":
            return write_atomic(out, png(canvas))
        drawing = io.StringIO()
        canvas.savefig(drawing, format="svg", facecolor=COLOURS["card"], metadata={"Date": None})
        return write_atomic(out, drawing.getvalue())


def _chart(document: SizeDocument) -> Canvas:
    from matplotlib.figure import Figure as Canvas

    chart = document["chart"]
    panels, size = chart["panels"], chart["base_radius_mm"]
    canvas = Canvas(figsize=(_WIDTH, 0.5 + _HEIGHT * len(panels)), layout="constrained")
    stacked = canvas.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, panel in zip(stacked, panels, strict=True):
        unit, here = panel["unit"], []
        for k, curve in enumerate(panel["curves"]):
            x, y = np.array(curve["x"]), np.array(curve["y"])
            axes.plot(
                x, y, color=COLOURS[SERIES[k % len(SERIES)]], label=curve["label"],
                linestyle=(0, (4, 3.4)) if curve["dashed"] else "-", zorder=3,
            )  # fmt: skip
            here.append(float(np.interp(size, x, y)))
        axes.plot([size], here[:1], "o", color=COLOURS["ink"], markersize=4, zorder=4)
        for label, limit in panel["limits"].items():
            axes.axhline(limit, color=COLOURS["fail"], linewidth=0.9, linestyle=(0, (6, 2)))
            axes.text(
                1.0, limit, f"{label} {limit:.4g} {unit}".strip(), color=COLOURS["fail"],
                fontsize=7.2, transform=axes.get_yaxis_transform(), ha="right", va="bottom",
            )  # fmt: skip
            here.append(limit)
        axes.axvline(size, color=COLOURS["ink"], linewidth=0.7, linestyle=(0, (1, 2)))
        axes.set_ylim(min(0.0, *here), _HEADROOM * max(here))
        axes.set_ylabel(f"{panel['quantity']}, {unit}" if unit else panel["quantity"])
        axes.grid(visible=True, axis="y")
        axes.spines[["top", "right"]].set_visible(False)
        if len(panel["curves"]) > 1:
            axes.legend(frameon=False, ncols=4, loc="lower left", bbox_to_anchor=(0, 1))
    stacked[-1].set_xlabel(f"base radius, mm (sized: {size:.6g} mm)")
    stacked[-1].set_xlim(
        float(panels[0]["curves"][0]["x"][0]), float(panels[0]["curves"][0]["x"][-1])
    )
    return canvas

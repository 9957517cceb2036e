"""Picture of a least crown: axial pressure at the governing state, and drop over the length."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.crown_document import CrownDocument
from camwright.reports.figure_svg import COLOURS, png, shipped, style
from camwright.reports.figures import SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SIZE = (6.4, 5.2)


@shipped()
def draw(document: CrownDocument, out: Path) -> Path:
    """Write the PNG of a least crown: axial pressure at the governing state, and drop."""
    from matplotlib.figure import Figure as Canvas

    with style(out.stem):
        canvas = Canvas(figsize=_SIZE, layout="constrained")
        pressure, drop = canvas.subplots(2, 1, sharex=True)
        _pressure(pressure, document)
        _drop(drop, document)
        return write_atomic(out, png(canvas))


def _pressure(axes: Axes, document: CrownDocument) -> None:
    for line in document["lines"]:
        crowned = line["crown"] == "crowned"
        axes.plot(
            line["y_mm"], line["pressure_over_plane_strain"],
            color=COLOURS[SERIES[0 if crowned else 1]],
            linestyle="-" if line["tilted"] else (0, (4, 3.4)),
            label=f"{line['crown']}, {'tilted' if line['tilted'] else 'aligned'}",
        )  # fmt: skip
    limit = document["ratio_limit"]
    axes.axhline(limit, color=COLOURS["fail"], linewidth=0.9, linestyle=(0, (6, 2)))
    top = max(limit, document["ratio"], document["ratio_straight"])
    axes.set_ylim(0.0, 1.3 * top)
    axes.set_ylabel("pressure over plane strain")
    axes.legend(frameon=False, ncols=2, loc="lower center", fontsize=7.2)
    state = document["governing"]
    axes.set_title(f"{state['load_case']}, cam angle {state['cam_angle_deg']:.4g} deg")


def _drop(axes: Axes, document: CrownDocument) -> None:
    table = document["drop_table"]
    for name, label, line in (
        ("drop_um", "middle", "-"),
        ("drop_min_um", "least", (0, (1, 2))),
        ("drop_max_um", "heaviest", (0, (4, 3.4))),
    ):
        if name in table:
            values = [*reversed(table[name]), *table[name]]
            y = [*(-each for each in reversed(table["y_mm"])), *table["y_mm"]]
            axes.plot(y, values, color=COLOURS[SERIES[0]], linestyle=line, label=label)
    axes.invert_yaxis()
    axes.set_ylabel("drop, um")
    axes.set_xlabel("y, mm")
    axes.legend(frameon=False)

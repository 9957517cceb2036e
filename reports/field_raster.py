"""Raster pictures of fields: axes, pressure curve above, fallback without OpenGL."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.geometry.figures import SERIES
from camwright.pipeline.base.files import read_npz
from camwright.pipeline.base.tables import Table
from camwright.reports.figure_svg import COLOURS, png, shipped, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PRESSURE = "5_pressure.npz"
_ABOVE, _GAP = 1.25, 0.1  # inches
_SECOND = 0.46  # inches, of an axis in mm beside the first one
_NEAR = 1e-6  # deg
_ELLIPSE = np.linspace(-1.0, 1.0, 201)


@dataclass(frozen=True, eq=False)
class Above:
    """Curves above a raster: label, positions (n,), values (n,); the first one is filled."""

    title: str
    curves: tuple[tuple[str, Array, Array], ...]


def over_the_contact(path: Path, cycle: Table, angle: float, half_width: float) -> Above | None:
    """Contact pressure by finite elements and by Hertz, MPa, at a cam angle, as curves over the
    position in half-widths.

    Of several load cases that of the highest pressure; None if the run has no record of the
    pressure at this angle.

    Parameters
    ----------
    path : path          record of the contact pressure
    cycle : Table        5_cycle.csv, the same rows as the record
    angle : float        deg
    half_width : float   unit of the positions, mm
    """
    try:
        entry = read_npz(path)
        rows = np.flatnonzero(np.abs(entry["cam_angle_deg"] - angle) < _NEAR)
        along, pressure = (
            entry[name][rows] for name in ("distance_from_contact_mm", "contact_pressure_MPa")
        )
    except (ResultError, KeyError, IndexError, TypeError):
        return None
    if not rows.size or not np.isfinite(pressure).any():
        return None
    chosen = int(np.nanargmax(np.nanmax(pressure, axis=1)))
    curves: tuple[tuple[str, Array, Array], ...] = (
        ("finite elements", along[chosen] / half_width, pressure[chosen]),
    )
    row = int(rows[chosen])
    if "p0_hertz_MPa" in cycle and "half_width_hertz_mm" in cycle:
        places = _ELLIPSE * cycle["half_width_hertz_mm"][row] / half_width
        hertz = cycle["p0_hertz_MPa"][row] * np.sqrt(1 - _ELLIPSE**2)
        curves += (("Hertz", places, hertz),)
    return Above("pressure, MPa", curves)


def framed(
    image: Array, extent: tuple[float, float, float, float], labels: tuple[str, str], title: str,
    colour_map: str, clim: tuple[float, float], log: bool, bar: tuple[float, str] | None,
    notes: tuple[tuple[str, float], ...] = (), above: Above | None = None,
    unit: float | None = None,
) -> bytes:  # fmt: skip
    """PNG of a raster in axes with colour bar, scale bar and curves above.

    Parameters
    ----------
    image : array              (rows, columns, 3)
    extent : tuple             left, right, bottom and top of the axes
    labels : tuple             of the x and of the y axis
    title, clim : str, tuple   words and range of the colours
    colour_map : str           name of a colour map of matplotlib
    log : bool                 whether the colours are logarithmic
    bar : tuple or None        length in units of the axes and words of the scale bar
    notes : tuple              words, each at a share of the height
    above : Above or None      curves over the same horizontal axis
    unit : float or None       length of one on both axes, mm, for second axes in mm; None: without
                               them
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    with style("picture"):
        width = 6.4
        tall = (extent[3] - extent[2]) / (extent[1] - extent[0])
        more = 0.0 if unit is None else _SECOND
        left, bottom = 0.62 + more, 0.46 + more
        inner = width - left - 1.05
        height = inner * tall + bottom + 0.16 + (0.0 if above is None else _ABOVE + _GAP)
        canvas = Figure(figsize=(width, height))
        ax = canvas.add_axes((left / width, bottom / height, inner / width, inner * tall / height))
        ax.imshow(image, extent=extent, interpolation="antialiased", aspect="equal")
        ax.set_xlabel(labels[0], labelpad=2)
        ax.set_ylabel(labels[1], labelpad=2)
        if unit is not None:
            _in_millimetres(ax, unit, -_SECOND / inner, -_SECOND / (inner * tall))
        colour_axes = canvas.add_axes(
            ((left + inner + 0.14) / width, bottom / height, 0.14 / width, inner * tall / height)
        )
        norm = LogNorm(*clim) if log else Normalize(*clim)
        colour_bar = canvas.colorbar(ScalarMappable(norm, colour_map), cax=colour_axes)
        colour_bar.set_label(title)
        colour_bar.outline.set_linewidth(0.6)
        if log:
            colour_bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            colour_bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
            colour_bar.ax.yaxis.set_minor_locator(NullLocator())
        for words, height_share in notes:
            ax.annotate(words, (0.02, height_share), xycoords="axes fraction", color="white",
                        va="top" if height_share > 0.5 else "bottom", fontsize=9)  # fmt: skip
        if bar is not None:
            _scale_bar(ax, extent, bar)
        if above is not None:
            low = bottom + inner * tall + _GAP
            place = (left / width, low / height, inner / width, _ABOVE / height)
            _draw_above(canvas.add_axes(place), (extent[0], extent[1]), above)
        return png(canvas, 190)


def _in_millimetres(ax: Axes, unit: float, left: float, bottom: float) -> None:
    """Second axes in mm below and beside the first ones.

    Parameters
    ----------
    unit : float           length of one on the first axes, mm
    left, bottom : float   place of the second axes, shares of width and height of the first ones
    """
    scales = (lambda length: unit * length, lambda length: length / unit)
    below = ax.secondary_xaxis(bottom, functions=scales)
    below.set_xlabel("mm", labelpad=1)
    beside = ax.secondary_yaxis(left, functions=scales)
    beside.set_ylabel("mm", labelpad=1)


def _draw_above(ax: Axes, span: tuple[float, float], above: Above) -> None:
    """Draw the curves above a raster, the first one filled to zero.

    Parameters
    ----------
    span : tuple   left and right end of the raster's horizontal axis
    """
    for number, (label, places, values) in enumerate(above.curves):
        colour = COLOURS[SERIES[number]]
        ax.plot(places, values, color=colour, dashes=(4, 3) if number else (), label=label)
        if not number:
            ax.fill_between(places, values, color=colour, alpha=0.22, linewidth=0)
    ax.set(xlim=span, ylabel=above.title)
    ax.set_ylim(bottom=0.0)
    ax.tick_params(labelbottom=False)
    ax.grid(visible=True)
    ax.legend(loc="upper right", frameon=False)


def _scale_bar(ax: Axes, extent: tuple[float, float, float, float], bar: tuple[float, str]) -> None:
    """Draw a scale bar with its words at the lower left of the axes.

    Parameters
    ----------
    extent : tuple   left, right, bottom and top of the axes
    bar : tuple      length in units of the axes, words
    """
    length, words = bar
    x0 = extent[0] + 0.04 * (extent[1] - extent[0])
    y0 = extent[2] + 0.05 * (extent[3] - extent[2])
    ax.plot([x0, x0 + length], [y0, y0], color="black", linewidth=2.2, solid_capstyle="butt")
    ax.annotate(
        words, (x0, y0), xytext=(0, 4), textcoords="offset points", va="bottom", ha="left",
        color="black", fontsize=8,
        bbox={"facecolor": "white", "alpha": 0.85, "linewidth": 0, "pad": 1.2},
    )  # fmt: skip
    ax.set_xlim(extent[0], extent[1])
    ax.set_ylim(extent[2], extent[3])


@shipped()
def triangles_picture(
    points: Array, triangles: NDArray[np.int64], values: Array,
    window: tuple[float, float, float, float], clim: tuple[float, float], log: bool,
    colour_map: str,
) -> Array:  # fmt: skip
    """Raster (rows, columns, 3) of a field on triangles, drawn by matplotlib.

    Parameters
    ----------
    points : array (2, n)
    triangles : array (3, m)   indices of points
    values : array (n,)        of the field at the points, clipped to `clim`
    window : tuple             xmin, xmax, ymin, ymax of the picture, in the unit of the points
    clim : tuple               range of the colours
    log : bool                 whether the colours are logarithmic
    colour_map : str           name of a colour map of matplotlib
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import LogNorm, Normalize
    from matplotlib.figure import Figure
    from matplotlib.tri import Triangulation

    tall = (window[3] - window[2]) / (window[1] - window[0])
    canvas = Figure(figsize=(6.0, 6.0 * tall), dpi=200, facecolor="white")
    agg = FigureCanvasAgg(canvas)
    ax = canvas.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.axis("off")
    norm = LogNorm(*clim) if log else Normalize(*clim)
    shown = np.clip(values, *clim)
    mesh = Triangulation(points[0], points[1], triangles.T)
    ax.tripcolor(mesh, shown, norm=norm, cmap=colour_map, shading="gouraud")
    ax.set_xlim(window[0], window[1])
    ax.set_ylim(window[2], window[3])
    agg.draw()
    return np.asarray(agg.buffer_rgba())[..., :3]

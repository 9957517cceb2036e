"""Pressure in both guides: over the turn, around the bore, in the slice of maximum pressure."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.reports.figure_svg import COLOURS, png, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

FILE = "5_guides.npz"
COLOUR_MAP = "viridis"
_FIELDS = (
    "position_mm", "line_load_N_per_mm", "worst_row", "slice_position_mm", "bore_angle_deg",
    "bore_pressure_MPa",
)  # fmt: skip
_DECADES = 3.0
_ROWS = 201
_LOBE = 0.75  # of the bore's radius, in the cross-section


@dataclass(frozen=True, eq=False)
class GuidePressure:
    """Pressure in one guide.

    along (k,) position from the middle of the guide, mm, away from the roller; angle (n,) deg and
    line (n, k) line load on the stem, N/mm, over the turn of a load case; round (m,) deg from the
    line of action and pressure (s, m) in the bore, MPa, at slices (s,), mm, at `worst_angle`, deg,
    of load case `worst_case`.
    """

    name: str
    along: Array
    angle: Array
    line: Array
    slices: Array
    round: Array
    pressure: Array
    worst_angle: float
    worst_case: str

    @property
    def peak(self) -> float:
        """Maximum pressure, MPa; NaN if no slice has a solution."""
        return float(np.nanmax(self.pressure)) if np.isfinite(self.pressure).any() else np.nan

    @property
    def slice(self) -> int:
        """Index of the slice of maximum pressure."""
        return int(np.argmax(np.nan_to_num(self.pressure).max(axis=1)))


def read_guides(path: Path, load_case: str) -> tuple[GuidePressure, GuidePressure]:
    """Guides A and B: line load of one load case, pressure at the worst angle of all load cases.

    Raises
    ------
    ResultError
        If the file cannot be read or lacks the load case.
    """
    try:
        with np.load(path, allow_pickle=False) as entry:
            cases, angle = entry["load_case"], entry["cam_angle_deg"]
            guides = {side: {n: entry[f"guide_{side}_{n}"] for n in _FIELDS} for side in "AB"}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise ResultError(f"{path}: {error}") from None
    rows = cases == load_case
    if not rows.any():
        raise ResultError(f"{path}: load case {load_case} is missing")
    a, b = (
        GuidePressure(
            side, one["position_mm"], angle[rows], one["line_load_N_per_mm"][rows],
            one["slice_position_mm"], one["bore_angle_deg"], one["bore_pressure_MPa"],
            float(angle[int(one["worst_row"])]), str(cases[int(one["worst_row"])]),
        ) for side, one in guides.items()
    )  # fmt: skip
    return a, b


def drawn(guides: tuple[GuidePressure, GuidePressure]) -> bytes:
    """PNG of both guides."""
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    with style("guide-pressure"):
        canvas = Figure(figsize=(7.6, 5.4), layout="constrained")
        grid = canvas.add_gridspec(2, 3, width_ratios=(1.25, 1.25, 0.8))
        for number, guide in enumerate(guides):
            _over_the_turn(canvas, canvas.add_subplot(grid[number, 0]), guide)
            norm = Normalize(0.0, guide.peak if guide.peak > 0 else 1.0)
            _unrolled(canvas, canvas.add_subplot(grid[number, 1]), guide, norm)
            polar = PolarAxes(canvas, grid[number, 2])
            canvas.add_subplot(polar)
            _across(polar, guide, norm)
        return png(canvas)


def _over_the_turn(canvas: Figure, ax: Axes, guide: GuidePressure) -> None:
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import FuncFormatter, NullLocator

    fine = np.linspace(guide.along[0], guide.along[-1], _ROWS)
    push = np.stack([np.interp(fine, guide.along, np.abs(line)) for line in guide.line], axis=1)
    top = float(push.max()) or 1.0
    shown = ax.pcolormesh(
        guide.angle, fine, np.maximum(push, top * 10**-_DECADES), cmap=COLOUR_MAP,
        shading="nearest", norm=LogNorm(top * 10**-_DECADES, top), rasterized=True,
    )  # fmt: skip
    ax.axvline(guide.worst_angle, color="white", linewidth=0.9, dashes=(3, 3))
    ax.set(xlabel="cam angle, deg", ylabel="along the guide, mm", xlim=(0, 360),
           xticks=np.arange(0, 361, 90))  # fmt: skip
    ax.set_title(f"guide {guide.name}: line load over the turn", fontsize=8.5, loc="left")
    bar = canvas.colorbar(shown, ax=ax, label="N/mm (logarithmic)", pad=0.01)
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())


def _unrolled(canvas: Figure, ax: Axes, guide: GuidePressure, norm: Normalize) -> None:
    """Pressure on the unrolled bore, cut on the unloaded side, around the loaded area."""
    pressure = np.nan_to_num(guide.pressure)
    angle = guide.round
    if angle[int(np.argmax(pressure[guide.slice]))] ** 2 > 90.0**2:
        half = angle.size // 2
        angle, pressure = angle + 180.0, np.roll(pressure[:, :-1], half, axis=1)
        pressure = np.hstack([pressure, pressure[:, :1]])
    shown = ax.pcolormesh(
        angle,
        guide.slices,
        pressure,
        cmap=COLOUR_MAP,
        norm=norm,
        shading="nearest",
        rasterized=True,
    )
    ax.set(xlabel="angle around the bore, deg", xlim=_pressed(angle, pressure.max(axis=0)),
           ylim=_pressed(guide.slices, pressure.max(axis=1)))  # fmt: skip
    ax.set_title(f"pressure at cam angle {guide.worst_angle:g}°", fontsize=8.5, loc="left")
    canvas.colorbar(shown, ax=ax, label="MPa", pad=0.01)


def _pressed(places: Array, pressure: Array) -> tuple[float, float]:
    """Loaded interval, extended by a tenth of its length on either side."""
    on = places[pressure > 0]
    if not on.size:
        return float(places[0]), float(places[-1])
    more = max(0.1 * float(np.ptp(on)), 0.02 * float(np.ptp(places)))
    return max(float(on[0]) - more, float(places[0])), min(float(on[-1]) + more, float(places[-1]))


def _across(polar: PolarAxes, guide: GuidePressure, norm: Normalize) -> None:
    """Pressure in the slice of maximum pressure, drawn outwards from the bore."""
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection

    polar.set_theta_zero_location("N")
    angle, pressure = np.radians(guide.round), np.nan_to_num(guide.pressure[guide.slice])
    reach = 1.0 + _LOBE * pressure / norm.vmax
    pieces = [
        [(angle[k], 1.0), (angle[k], reach[k]), (angle[k + 1], reach[k + 1]), (angle[k + 1], 1.0)]
        for k in range(angle.size - 1) if pressure[k] + pressure[k + 1] > 0
    ]  # fmt: skip
    shades = colormaps[COLOUR_MAP](
        norm([p for p in (pressure[:-1] + pressure[1:]) / 2 if p > 0])
    )  # fmt: skip
    polar.add_collection(
        PolyCollection(pieces, facecolors=shades, edgecolors="face", linewidths=0.2)
    )
    round_ = np.linspace(0, 2 * np.pi, 181)
    polar.fill(round_, np.ones_like(round_), color=COLOURS["steel"])
    polar.plot(round_, np.ones_like(round_), color=COLOURS["ink"], linewidth=0.9)
    polar.set_ylim(0, 1.0 + 1.05 * _LOBE)
    polar.set_yticks([])
    polar.set_xticks(np.radians([0, 90, 180, 270]), ["0°", "90°", "180°", "-90°"])
    polar.tick_params(pad=-4)
    polar.spines["polar"].set_visible(False)
    polar.grid(visible=False)
    polar.set_title(f"slice at {guide.slices[guide.slice]:.3g} mm", fontsize=8.5)
    polar.text(0.0, 0.0, f"{guide.peak:.3g}\nMPa", ha="center", va="center", fontsize=9)

"""Figures of the pressure in guides or pivot and along the line of contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import read_npz
from camwright.reports.figure_svg import COLOURS, png, style
from camwright.reports.report_tables import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

FILE, PIVOT, AXIAL = "5_guides.npz", "5_pivot.npz", "5_length.npz"
COLOUR_MAP = "viridis"
_FIELDS = (
    "position_mm", "line_load_N_per_mm", "worst_row", "slice_position_mm", "bore_angle_deg",
    "bore_pressure_MPa",
)  # fmt: skip
_PLACES = ("centre", "end1_mean", "end2_mean")
_SAME_ANGLE = 1e-6  # deg
_DECADES = 3.0
_ROWS = 201
_LOBE = 0.75  # of the bore's radius, in the cross-section


@dataclass(frozen=True, eq=False)
class BushPressure:
    """Line load of one guide, or in the bush of a pivot, over the turn, and bore pressure at its
    worst angle.

    name: the part in words; along (k,) position from the middle, mm, in a guide away from the
    roller, in a pivot towards the end that is pressed; angle (n,) deg and
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


def read_guides(path: Path, load_case: str) -> tuple[BushPressure, BushPressure]:
    """Pressure in guides A and B: line load over the turn of one load case; pressure in the bore at
    the cam angle of its maximum over all load cases.

    Parameters
    ----------
    path : path   ``5_guides.npz`` of a run

    Raises
    ------
    ResultError
        If the file cannot be read or lacks the load case.
    """
    a, b = _read(path, load_case, {"guide A": "guide_A_", "guide B": "guide_B_"})
    return a, b


def read_pivot(path: Path, load_case: str) -> BushPressure:
    """Pressure in the bush of a pivot: line load over the turn of one load case; pressure in the
    bore at the cam angle of its maximum over all load cases.

    Parameters
    ----------
    path : path   ``5_pivot.npz`` of a run

    Raises
    ------
    ResultError
        If the file cannot be read or lacks the load case.
    """
    (bush,) = _read(path, load_case, {"pivot bush": ""})
    return bush


def _read(path: Path, load_case: str, prefixes: Mapping[str, str]) -> list[BushPressure]:
    """Pressure in bushes by their names; see `read_guides`.

    Parameters
    ----------
    prefixes : mapping   name -> what the names of its fields in the file begin with
    """
    entry = read_npz(path)
    if "position_mm" in entry:  # of a pivot: one place for line load and slices
        entry = {"slice_position_mm": entry["position_mm"], **entry}
    try:
        cases, angle = entry["load_case"], entry["cam_angle_deg"]
        bushes = {
            name: {n: entry[prefix + n] for n in _FIELDS} for name, prefix in prefixes.items()
        }
    except KeyError as error:
        raise ResultError(f"{path}: {error}") from None
    rows = cases == load_case
    if not rows.any():
        raise ResultError(f"{path}: load case {load_case} is missing")
    return [_bush(name, fields, rows, angle, cases) for name, fields in bushes.items()]


def _bush(
    name: str, fields: Mapping[str, Array], rows: Array, angle: Array, cases: Array
) -> BushPressure:
    """From the fields of a file, its rows of a load case, and angle, deg, and case of each row."""
    worst = int(fields["worst_row"])
    return BushPressure(
        name, fields["position_mm"], angle[rows], fields["line_load_N_per_mm"][rows],
        fields["slice_position_mm"], fields["bore_angle_deg"], fields["bore_pressure_MPa"],
        float(angle[worst]), str(cases[worst]),
    )  # fmt: skip


def drawn(bushes: Sequence[BushPressure]) -> bytes:
    """PNG of the pressure in guides or the bush of a pivot, a row each: line load over the turn,
    bore unrolled, worst slice.
    """
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    with style("guide-pressure"):
        canvas = Figure(figsize=(7.6, 2.7 * len(bushes)), layout="constrained")
        grid = canvas.add_gridspec(len(bushes), 3, width_ratios=(1.25, 1.25, 0.8))
        for number, guide in enumerate(bushes):
            _over_the_turn(canvas, canvas.add_subplot(grid[number, 0]), guide)
            norm = Normalize(0.0, guide.peak if guide.peak > 0 else 1.0)
            _unrolled(canvas, canvas.add_subplot(grid[number, 1]), guide, norm)
            polar = PolarAxes(canvas, grid[number, 2])
            canvas.add_subplot(polar)
            _across(polar, guide, norm)
        return png(canvas)


def _over_the_turn(canvas: Figure, ax: Axes, guide: BushPressure) -> None:
    """Map of the magnitude of the line load, N/mm, logarithmic, over cam angle and position along
    the guide, with the worst angle.
    """
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
    ax.set(xlabel="cam angle, deg", ylabel=f"along the {guide.name}, mm", xlim=(0, 360),
           xticks=np.arange(0, 361, 90))  # fmt: skip
    ax.set_title(f"{guide.name}: line load over the turn", fontsize=8.5, loc="left")
    bar = canvas.colorbar(shown, ax=ax, label="N/mm (logarithmic)", pad=0.01)
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())


def _unrolled(canvas: Figure, ax: Axes, guide: BushPressure, norm: Normalize) -> None:
    """Map of the bore pressure over angle and position along the guide, cut open on the unloaded
    side and limited to the loaded area.
    """
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
    """First and last of the places under pressure, each moved outwards by a tenth of their
    distance, at least by 0.02 of the whole range, but not beyond it; the whole range without
    pressure.

    Parameters
    ----------
    places, pressure : array (n,)   positions, ascending, and the pressure at each
    """
    on = places[pressure > 0]
    if not on.size:
        return float(places[0]), float(places[-1])
    more = max(0.1 * float(np.ptp(on)), 0.02 * float(np.ptp(places)))
    return max(float(on[0]) - more, float(places[0])), min(float(on[-1]) + more, float(places[-1]))


def _across(polar: PolarAxes, guide: BushPressure, norm: Normalize) -> None:
    """Polar plot of the pressure in the slice of maximum pressure, drawn outwards from the bore."""
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


# --- line of contact


@dataclass(frozen=True, eq=False)
class AxialPressure:
    """Pressure along the line of contact, MPa, means over cells between edges (k + 1,), mm.

    angle (n,) deg and whole (n, k) over the turn of a load case, at the greatest moment; level and
    tilted (k,) without tilt and at that moment, at `worst_angle`, deg, of load case `worst_case`;
    mean_length : float   of the cells at the ends, mm
    """

    edges: Array
    angle: Array
    whole: Array
    level: Array
    tilted: Array
    worst_angle: float
    worst_case: str
    mean_length: float

    @property
    def has_means(self) -> bool:
        """Whether the cells at the ends are means at a corner."""
        return bool(np.isclose(self.edges[1] - self.edges[0], self.mean_length))

    @property
    def peak(self) -> float:
        """Maximum at the worst angle, MPa."""
        return float(max(self.level.max(), self.tilted.max()))


def read_axial(path: Path, load_case: str, worst: tuple[str, float] | None) -> AxialPressure:
    """Axial pressure over the turn of one load case, and at one cam angle of any load case.

    Parameters
    ----------
    path : path             ``5_length.npz`` of a run
    worst : tuple or None   load case and cam angle, deg, of the one angle: the nearest one of that
                            load case with a known pressure is taken; None or without such an angle:
                            that of the maximum over the turn of `load_case`

    Raises
    ------
    ResultError
        If the file cannot be read, lacks the load case or has no known pressure of it.
    """
    entry = read_npz(path)
    try:
        cases, angle, edges = entry["load_case"], entry["cam_angle_deg"], entry["axial_edge_mm"]
        level, tilted = entry["level_pressure_MPa"], entry["tilted_pressure_MPa"]
        mean_length = float(entry["mean_length_mm"])
    except (KeyError, TypeError, ValueError) as error:
        raise ResultError(f"{path}: {error}") from None
    rows = np.flatnonzero(cases == load_case)
    if not rows.size:
        raise ResultError(f"{path}: load case {load_case} is missing")
    most = np.maximum(level, tilted).max(axis=1)  # NaN where the follower may leave the cam
    if not np.isfinite(most[rows]).any():
        raise ResultError(f"the contact force of load case {load_case} is not known at any angle")
    row = int(rows[np.nanargmax(most[rows])])
    near = np.flatnonzero(np.isfinite(most) & (cases == worst[0])) if worst else rows[:0]
    if worst is not None and near.size:
        row = int(near[np.argmin(np.abs((angle[near] - worst[1] + 180.0) % 360.0 - 180.0))])
    return AxialPressure(
        edges, angle[rows], tilted[rows], level[row], tilted[row], float(angle[row]),
        str(cases[row]), mean_length,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class CertifiedPressure:
    """Axial pressure by finite elements, MPa: middle and both ends, with error bars.

    along, line (m,): positions, mm, and pressure there.
    """

    centre: float
    ends: tuple[float, float]
    errors: tuple[float, float, float]
    along: Array
    line: Array

    def _is_mirrored(self, axial: AxialPressure) -> bool:
        """Whether the moment has the other sign than that of the half-spaces.

        The bodies are symmetric.
        """
        return bool((self.ends[1] - self.ends[0]) * (axial.tilted[-1] - axial.tilted[0]) < 0)

    def over(self, axial: AxialPressure) -> tuple[Array, Array, Array]:
        """Positions of both ends and the middle in axial order, mm, with pressures and error bars,
        MPa, each (3,); mirrored where the loaded end is on the other side in `axial`.
        """
        places = np.array([0.5 * (axial.edges[0] + axial.edges[1]), 0.0,
                           0.5 * (axial.edges[-1] + axial.edges[-2])])  # fmt: skip
        values = np.array([self.ends[0], self.centre, self.ends[1]])
        bars = np.array([self.errors[1], self.errors[0], self.errors[2]])
        return places, *((values[::-1], bars[::-1]) if self._is_mirrored(axial) else (values, bars))

    def curve(self, axial: AxialPressure) -> tuple[Array, Array]:
        """Positions along the line, mm, and pressure there, MPa, without the cells at the ends that
        are means; mirrored as in `over`.
        """
        line = self.line[::-1] if self._is_mirrored(axial) else self.line
        reach = axial.edges[-1] - (axial.mean_length if axial.has_means else 0.0)
        inside = np.abs(self.along) < reach
        return self.along[inside], line[inside]


def shown_place(check: Record | None, records: Sequence[Record]) -> tuple[str, float] | None:
    """Load case and cam angle, deg, at which the axial pressure is shown; None if not known.

    The certified angle of the greatest end pressure, in the load case of the check if that has one;
    without certified angles that of the check.

    Parameters
    ----------
    check : mapping or None   record of the check ``edge_pressure``
    records : sequence        `length_certificate` of the trial
    """
    worst = str(check["load_case"]) if check is not None else ""
    of_worst = [record for record in records if record["load_case"] == worst]
    if records:
        most = max(
            of_worst or records,
            key=lambda each: float(each["signed_factor"]) * float(each["plane_strain_p0_MPa"]),
        )
        return str(most["load_case"]), float(most["cam_angle_deg"])
    if check is not None and worst and check["cam_angle_deg"] is not None:
        return worst, float(check["cam_angle_deg"])
    return None


def _at_place(records: Sequence[Record], axial: AxialPressure) -> list[Record]:
    """Of the certified contacts those at the shown angle of `axial`."""
    return [
        record
        for record in records
        if abs(float(record["cam_angle_deg"]) - axial.worst_angle) < _SAME_ANGLE
        and record["load_case"] == axial.worst_case
    ]


def bears_less(records: Sequence[Record], axial: AxialPressure) -> bool:
    """Whether the certified contact at the shown angle is on that of preloaded discs which bears
    less.
    """
    return any(record.get("bears_less", False) for record in _at_place(records, axial)[:1])


def certified_pressure(
    records: Sequence[Record], axial: AxialPressure, plane: float | None
) -> CertifiedPressure | None:
    """Axial pressure by finite elements at the shown angle of `axial`; None if not certified there
    or if `plane` is not known.

    Parameters
    ----------
    records : sequence      `length_certificate` of the trial, factors over plane strain
    plane : float or None   maximum pressure of plane strain at the shown angle, MPa
    """
    if plane is None:
        return None
    for record in _at_place(records, axial):
        tier = record["finite_elements"]
        centre, end1, end2 = (plane * float(tier[name]) for name in _PLACES)
        bars = [
            abs(value) * 1e-2 * float(tier[f"{name}_gci_percent"])
            for name, value in zip(_PLACES, (centre, end1, end2), strict=True)
        ]
        axial_line = tier["axial"]
        along, line = (np.array(axial_line[name], dtype=float) for name in ("y_mm", "factor"))
        return CertifiedPressure(
            centre, (end1, end2), (bars[0], bars[1], bars[2]), along, plane * line
        )
    return None


def drawn_axial(
    axial: AxialPressure,
    limit: float | None,
    centre: float | None,
    certified: CertifiedPressure | None = None,
) -> bytes:
    """PNG of the axial pressure at the worst angle, and over line and cam angle.

    Parameters
    ----------
    limit : float    allowable pressure, MPa; None: without one
    centre : float   maximum pressure of plane strain at the worst angle, MPa; None: not known
    certified        by finite elements at the worst angle; None: not certified there
    """
    from matplotlib.figure import Figure

    with style("axial-pressure"):
        canvas = Figure(figsize=(7.6, 3.3), layout="constrained")
        grid = canvas.add_gridspec(1, 2, width_ratios=(1.0, 1.05))
        _along_the_line(canvas.add_subplot(grid[0, 0]), axial, limit, centre, certified)
        _over_line_and_turn(canvas, canvas.add_subplot(grid[0, 1]), axial)
        return png(canvas)


def _along_the_line(
    ax: Axes,
    axial: AxialPressure,
    limit: float | None,
    centre: float | None,
    certified: CertifiedPressure | None,
) -> None:
    """Draw the pressure along the line of contact at the shown angle, without tilt and at the
    greatest moment.

    Parameters
    ----------
    limit : float or None                   of the edge pressure, MPa; drawn if below twice the
                                            other pressures
    centre : float or None                  maximum pressure of plane strain at this angle, MPa
    certified : CertifiedPressure or None   pressure by finite elements there
    """
    middles, whole = 0.5 * (axial.edges[1:] + axial.edges[:-1]), slice(None)
    if axial.has_means:
        whole = slice(1, -1)
    for label, values, colour, dashes in (
        ("without tilt", axial.level, "blue", "-"),
        ("at the greatest moment", axial.tilted, "vermillion", "--"),
    ):
        ax.plot(middles[whole], values[whole], dashes, color=COLOURS[colour], label=label)
        if axial.has_means:
            ax.hlines(values[[0, -1]], axial.edges[[0, -2]], axial.edges[[1, -1]],
                      color=COLOURS[colour], linewidth=2.4)  # fmt: skip
    reach = float(axial.edges[-1])
    top = axial.peak
    if centre is not None:
        ax.axhline(centre, color=COLOURS["muted"], linewidth=0.9, linestyle=":",
                   label="plane strain")  # fmt: skip
        top = max(top, centre)
    if certified is not None:
        places, values, bars = certified.over(axial)
        along, line = certified.curve(axial)
        ax.plot(along, line, "-.", color=COLOURS["ink"], linewidth=0.9, label="finite elements")
        ax.errorbar(places, values, bars, fmt="o", markersize=3.0, color=COLOURS["ink"],
                    capsize=2.5, elinewidth=0.9)  # fmt: skip
        top = max(top, float((values + bars).max()), float(line.max()))
    if limit is not None and limit < 2.0 * top:
        ax.axhline(limit, color=COLOURS["ink"], linewidth=0.9, label=f"limit {limit:.4g} MPa")
        top = max(top, limit)
    for side in (-1.0, 1.0):
        if axial.has_means:
            ax.axvspan(side * reach, side * (reach - axial.mean_length), zorder=0, linewidth=0,
                       color=COLOURS["steel"])  # fmt: skip
    ax.set(xlabel="axial position, mm", ylabel="contact pressure, MPa", ylim=(0.0, 1.38 * top),
           xlim=(-1.03 * reach, 1.03 * reach))  # fmt: skip
    ax.set_title(f"cam angle {axial.worst_angle:g}°", fontsize=8.5, loc="left")
    ax.legend(fontsize=7, ncols=2, loc="upper center", frameon=False)


def _over_line_and_turn(canvas: Figure, ax: Axes, axial: AxialPressure) -> None:
    """Draw a map of the pressure at the greatest moment, MPa, over cam angle and axial position."""
    step = float(axial.angle[1] - axial.angle[0]) if axial.angle.size > 1 else 360.0
    turn = np.append(axial.angle, axial.angle[-1] + step) - 0.5 * step
    shown = ax.pcolormesh(turn, axial.edges, axial.whole.T, cmap=COLOUR_MAP, vmin=0.0,
                          rasterized=True)  # fmt: skip
    ax.set(xlabel="cam angle, deg", ylabel="axial position, mm", xlim=(0, 360),
           xticks=np.arange(0, 361, 90))  # fmt: skip
    ax.set_title("at the greatest moment, over the turn", fontsize=8.5, loc="left")
    canvas.colorbar(shown, ax=ax, label="MPa", pad=0.01)

"""The stress under the contact in a film: read from the patch series, drawn over half-widths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from scipy import sparse

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.reports.figure_svg import COLOURS
from camwright.reports.film_raster import Pixels, Window, interpolation, painted
from camwright.reports.scene_turn import TurnView

INDEX = Path("fields") / "patch_cycle.pvd"
PRESSURE = "5_pressure.npz"
COLOUR_MAP = "viridis"
_MISES = "von_mises_MPa"
_REACH = 1.58
_LEFT, _RIGHT, _DEEP, _HIGH = -2.0, 2.0, -1.7, 1.3
_PRESSURE_HEIGHT = 1.1  # of the turn's greatest pressure, in half-widths of the picture
_BLUE, _INK = np.array((0, 114, 178)), np.array((27, 31, 36))


@dataclass(frozen=True, eq=False)
class PatchSeries:
    """Stress (f, m), MPa, at places (2, m) along and above the surface in half-widths.

    pressure (f, k), MPa, at places along (f, k) in half-widths.
    """

    places: Array
    stress: Array
    along: Array
    pressure: Array

    @property
    def stress_max(self) -> float:
        return float(np.nanmax(self.stress, initial=1.0))

    def picture(self, k: int, size: tuple[int, int], norm: Any) -> Pixels:
        """Picture `k` (height, width, 3), 0 to 255: stress below, pressure above the surface."""
        width, height = size
        panel: Pixels = np.full((height, width, 3), 255.0, dtype=np.float32)
        weights, inside = self._weights(size)
        values = (weights @ self.stress[k]).reshape(height, width)
        painted(panel, colour_table()[(255.999 * norm(values)).astype(np.int64)], inside)
        window = _window(size)
        x, y = window.points
        top = np.interp(x[0], self.along[k], self.pressure[k], left=0.0, right=0.0)
        top *= _PRESSURE_HEIGHT / float(np.nanmax(self.pressure))
        under = np.clip((top - y) / window.pixel + 0.5, 0, 1) * (y > 0)
        painted(panel, _BLUE, 0.28 * under)
        painted(panel, _BLUE, np.clip(1.3 - np.abs(top - y) / window.pixel, 0, 1) * (top > 0))
        painted(panel, _INK, np.clip(1.0 - np.abs(y) / window.pixel, 0, 1))
        return panel

    def frame(self, ax: Axes) -> None:
        """Axes round the picture."""
        ax.set(xlim=(_LEFT, _RIGHT), ylim=(_DEEP, _HIGH), xlabel="along the contact, x / a",
               ylabel="depth, z / a", xticks=np.arange(-2, 3), yticks=(-1, 0, 1))  # fmt: skip
        ax.set_title(
            "The contact: pressure (blue, of its greatest) and stress in the cam",
            fontsize=8.5, loc="left", color=COLOURS["ink"],
        )  # fmt: skip

    @cached_property
    def _kept(self) -> dict[tuple[int, int], tuple[sparse.csr_array, Array]]:
        return {}

    def _weights(self, size: tuple[int, int]) -> tuple[sparse.csr_array, Array]:
        if size not in self._kept:
            window = _window(size)
            found = interpolation(self.places, window.points.reshape(2, -1))
            # The mesh ends in whole elements, a little beyond; a half disc is easier on the eye.
            away = np.hypot(*window.points)
            inside = np.clip((_REACH - away) / window.pixel + 0.5, 0, 1) * (window.points[1] < 0)
            self._kept[size] = (found, inside)
        return self._kept[size]


@cache
def colour_table() -> Pixels:
    """The colours (256, 3), 0 to 255, from the least value to the greatest."""
    colours = mpl.colormaps[COLOUR_MAP](np.linspace(0.0, 1.0, 256))
    return (255.0 * colours[:, :3]).astype(np.float32)


def _window(size: tuple[int, int]) -> Window:
    """The window of the picture in half-widths; height follows from the scale across."""
    return Window(_LEFT, _DEEP, (_RIGHT - _LEFT) / size[0], *size)


def read_patches(
    folder: Path, trial: Path, view: TurnView, cycle: Mapping[str, Array]
) -> PatchSeries:
    """The patch at every angle of the view.

    Raises
    ------
    ResultError
        If a file is missing, or the series has no step at an angle of the view.
    """
    import meshio

    steps = _steps(folder / INDEX)
    try:
        chosen = [steps[round(float(angle), 6)] for angle in view.angle]
    except KeyError as error:
        raise ResultError(f"{folder / INDEX}: no step at {error.args[0]} deg") from None
    places, stress = None, []
    for name in chosen:
        try:
            mesh = meshio.read(folder / INDEX.parent / name)
        except (OSError, SystemExit, meshio.ReadError) as error:
            raise ResultError(f"{name}: {error}") from None
        if places is None:
            places = _own_places(mesh)
        stress.append(np.asarray(mesh.point_data[_MISES], dtype=float))
    if places is None:
        raise ResultError(f"{folder / INDEX}: holds no step")
    along, pressure = _pressures(trial / PRESSURE, view, cycle)
    return PatchSeries(places, np.stack(stress), along, pressure)


def _steps(index: Path) -> dict[float, str]:
    try:
        sets = ET.parse(index).getroot().findall("Collection/DataSet")  # noqa: S314 - our own file
    except (OSError, ET.ParseError) as error:
        raise ResultError(f"{index}: {error}") from None
    return {round(float(s.get("timestep", "nan")), 6): str(s.get("file")) for s in sets}


def _own_places(mesh: Any) -> Array:
    """Places (2, m) along and above the surface of the contact, in half-widths."""
    note = {name: float(np.ravel(value)[0]) for name, value in mesh.field_data.items()}
    try:
        point = np.array([note["contact_x_mm"], note["contact_y_mm"]])
        normal = np.array([note["normal_x"], note["normal_y"]])
        size = note["half_width_hertz_mm"]
    except KeyError as error:
        raise ResultError(f"patch series: states no {error.args[0]}; run the case again") from None
    arm = (mesh.points[:, :2] - point).T
    return np.stack([normal[1] * arm[0] - normal[0] * arm[1], normal @ arm]) / size


def _pressures(path: Path, view: TurnView, cycle: Mapping[str, Array]) -> tuple[Array, Array]:
    try:
        with np.load(path, allow_pickle=False) as entry:
            rows = np.flatnonzero(entry["load_case"] == view.load_case)[view.position]
            along, pressure = entry["xi_mm"][rows], entry["pressure_MPa"][rows]
    except (OSError, ValueError, KeyError, EOFError, IndexError) as error:
        raise ResultError(f"{path}: {error}") from None
    size = cycle["half_width_hertz_mm"][view.position][:, None]
    return np.divide(along, size, out=np.zeros_like(along), where=size > 0), pressure

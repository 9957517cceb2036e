"""The map of a turn as a picture: greatest stress under the contour, unrolled."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from geometry.arrays import Array
from geometry.errors import ResultError
from reports.plots import FIGURE_WIDTH, style

FILE = "5_envelope.npz"
MAPS = (("von_mises_MPa", "von Mises"), ("shear_range_MPa", "range of shear along the surface"))
_ROWS = 200


def read_envelope(path: Path, load_case: str) -> dict[str, Array]:
    """Arrays of one load case from ``5_envelope.npz``, by their names without the load case.

    Raises
    ------
    ResultError
        If the file cannot be read or lacks the load case.
    """
    try:
        with np.load(path, allow_pickle=False) as entry:
            found = {
                name.removeprefix(f"{load_case}."): entry[name]
                for name in entry.files
                if name.startswith(f"{load_case}.")
            }
    except (OSError, ValueError, EOFError) as error:
        raise ResultError(f"{path}: {error}") from None
    missing = {"cam_angle_deg", "depth_mm", *(name for name, _ in MAPS)} - set(found)
    if missing:
        raise ResultError(f"{path}: no {', '.join(sorted(missing))} for load case {load_case}")
    return found


def unrolled(values: Array, depth: Array, levels: Array) -> Array:
    """Values (n, k) at depths (n, k) of each station, at common levels (m,): (m, n).

    Not a number below what a station knows.
    """
    rows = [np.interp(levels, at, of, right=np.nan) for of, at in zip(values, depth, strict=True)]
    return np.stack(rows, axis=1)


def drawn(envelope: dict[str, Array]) -> bytes:
    """PNG of the maps above one another: cam angle across, depth downwards."""
    angle, depth = envelope["cam_angle_deg"], envelope["depth_mm"]
    levels = np.linspace(0.0, float(np.nanmax(depth)), _ROWS)
    with style("envelope"):
        canvas = Figure(figsize=(FIGURE_WIDTH, 3.6), layout="constrained")
        for ax, (name, title) in zip(canvas.subplots(2, sharex=True), MAPS, strict=True):
            shown = ax.pcolormesh(
                angle, levels, unrolled(envelope[name], depth, levels), cmap="viridis",
                shading="nearest", vmin=0.0, rasterized=True,
            )  # fmt: skip
            ax.invert_yaxis()
            ax.set_ylabel("depth, mm")
            ax.set_title(title, fontsize=9, loc="left")
            canvas.colorbar(shown, ax=ax, label="MPa", pad=0.01)
        ax.set_xlabel("cam angle, deg")
        ax.set_xticks(np.arange(0, 361, 45))
        stream = io.BytesIO()
        canvas.savefig(
            stream, format="png", dpi=150, facecolor="white", metadata={"Software": None}
        )
    return stream.getvalue()


def worst(envelope: dict[str, Array], name: str) -> tuple[float, float, float]:
    """Greatest value of a map, MPa, with its cam angle in deg and depth in mm."""
    values = envelope[name]
    station, level = np.unravel_index(int(np.nanargmax(values)), values.shape)
    return (
        float(values[station, level]),
        float(envelope["cam_angle_deg"][station]),
        float(envelope["depth_mm"][station, level]),
    )

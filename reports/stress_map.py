"""Maps of the maximum subsurface stress over the turn: unrolled, and along the contour."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import read_npz
from camwright.reports.figure_svg import COLOURS, FIGURE_WIDTH, png, style

FILE = "5_envelope.npz"
MAPS = (("von_mises_MPa", "von Mises"), ("shear_range_MPa", "orthogonal shear range"))
_ROWS = 200
_STATIONS = 480  # of the band, finer than its pixels; each takes memory in the drawing


def read_envelope(path: Path, load_case: str) -> dict[str, Array]:
    """Arrays of one load case of ``5_envelope.npz`` by name.

    Raises
    ------
    ResultError
        If the file cannot be read, lacks the load case or has no known stress of it.
    """
    prefix = f"{load_case}."
    arrays = {
        name.removeprefix(prefix): values
        for name, values in read_npz(path).items()
        if name.startswith(prefix)
    }
    missing = {"cam_angle_deg", "depth_mm", *(name for name, _ in MAPS)} - set(arrays)
    if missing:
        raise ResultError(f"{path}: no {', '.join(sorted(missing))} for load case {load_case}")
    if not all(np.isfinite(arrays[name]).any() for name in ("depth_mm", *dict(MAPS))):
        raise ResultError(f"the contact force of load case {load_case} is not known at any angle")
    return arrays


def unrolled(values: Array, depth: Array, levels: Array) -> Array:
    """Values (n, k) at depths (n, k) of n stations, interpolated to the common depths `levels`
    (m,): (m, n).

    NaN below the deepest value of a station.
    """
    rows = [np.interp(levels, at, of, right=np.nan) for of, at in zip(values, depth, strict=True)]
    return np.stack(rows, axis=1)


def drawn(envelope: dict[str, Array]) -> bytes:
    """PNG of the maps of maximum stress over cam angle and depth, MPa.

    Parameters
    ----------
    envelope : dict   arrays of one load case, see `read_envelope`
    """
    from matplotlib.figure import Figure

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
        return png(canvas)


def around(envelope: dict[str, Array], angle: Array, contour: Array, normal: Array) -> bytes:
    """PNG of the von Mises stress as a band along the contour, with the depth exaggerated.

    Parameters
    ----------
    envelope : dict          arrays of one load case, see `read_envelope`
    angle : array (n,)       cam angles of the contour, deg
    contour : array (2, n)   mm
    normal : array (2, n)    outward unit normals of the contour
    """
    from matplotlib.figure import Figure

    at = envelope["cam_angle_deg"]
    place, up = (_between(at, angle, part) for part in (contour, normal))
    depth, values = envelope["depth_mm"], envelope["von_mises_MPa"]
    radius = np.hypot(*place)
    scale = _enlarged(0.25 * float(radius.min()) / float(np.nanmax(depth)))
    # Where the follower may leave the cam there is no stress, nor a depth at which it is known.
    band = place[:, :, None] - up[:, :, None] * scale * np.nan_to_num(depth)
    thinned = slice(None, None, max(1, at.size // _STATIONS))
    closed, shown = (
        np.concatenate([v[..., thinned, :], v[..., :1, :]], axis=-2) for v in (band, values)
    )
    peak, peak_angle, peak_depth = worst(envelope, "von_mises_MPa")
    station = int(np.argmin(np.abs(at - peak_angle)))
    with style("envelope-around"):
        canvas = Figure(figsize=(FIGURE_WIDTH, 4.7), layout="constrained")
        ax = canvas.add_subplot()
        mesh = ax.pcolormesh(
            *closed, shown, cmap="viridis", shading="gouraud", vmin=0.0, rasterized=True
        )
        ax.plot(*closed[:, :, 0], color=COLOURS["ink"], linewidth=0.8)
        for mark in range(0, 360, 45):
            here = int(np.argmin(np.abs(at - mark)))
            x, y = place[:, here] + 0.09 * radius.max() * up[:, here]
            ax.text(x, y, f"{mark}°", ha="center", va="center", fontsize=8, color=COLOURS["muted"])
        x, y = place[:, station] - scale * peak_depth * up[:, station]
        ax.annotate(
            f"{peak:.4g} MPa\nat {peak_angle:g}°, depth {peak_depth:.2g} mm",
            (x, y), (0.0, 0.0), ha="center", va="center",
            arrowprops={"arrowstyle": "-", "color": COLOURS["ink"], "linewidth": 0.8},
        )  # fmt: skip
        far = 0.15 * radius.max()
        span = [(part.min() - far, part.max() + far) for part in place]
        ax.set(aspect="equal", xlabel="x, mm", ylabel="y, mm", xlim=span[0], ylim=span[1])
        ax.set_title(f"depths enlarged {scale:g} times", fontsize=8.5, loc="left")
        canvas.colorbar(mesh, ax=ax, label="maximum von Mises stress of the turn, MPa", pad=0.01)
        return png(canvas)


def _between(at: Array, angle: Array, values: Array) -> Array:
    """Values (2, n) at angles (n,), deg, interpolated to other angles of the turn: (2, m)."""
    return np.stack([np.interp(at, angle, part, period=360.0) for part in values])


def _enlarged(wanted: float) -> float:
    """Largest of 1, 2 or 5 times a power of ten that is not above a value."""
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= wanted) * power)


def worst(envelope: dict[str, Array], name: str) -> tuple[float, float, float]:
    """Maximum of a map, MPa, its cam angle, deg, and depth, mm."""
    values = envelope[name]
    station, level = np.unravel_index(int(np.nanargmax(values)), values.shape)
    return (
        float(values[station, level]),
        float(envelope["cam_angle_deg"][station]),
        float(envelope["depth_mm"][station, level]),
    )

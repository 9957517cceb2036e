"""Pictures of a film: what stays is drawn once, what moves is laid over it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from PIL import Image, ImageDraw, ImageFont

from camwright.geometry.arrays import Array
from camwright.reports.figure_svg import COLOURS, style
from camwright.reports.film_patch import COLOUR_MAP, PatchSeries, colour_table, read_patches
from camwright.reports.film_raster import (
    BodyRaster,
    CamRaster,
    Layer,
    Pixels,
    Window,
    paint_box,
    paint_disc,
    painted,
)
from camwright.reports.page import shortened
from camwright.reports.report_data import Material
from camwright.reports.scene_turn import TurnView

SIZE = (1280, 720)
FLOOR_SHARE, TOP_SHARE = 0.5e-3, 0.2
"""The bodies' colours run between these shares of the turn's greatest von Mises stress."""

_BODY = (20, 84, 548, 624)  # left, top, width, height of the bodies' panel, pixels
_BODY_BAR = (584, 110, 14, 560)
_PATCH = (742, 64, 400, 300)
_PATCH_BAR = (1158, 64, 14, 300)
_TRACE = (742, 440, 506, 216)
_STAMP = (20, 42)
_STEEL, _DARK, _SHAFT = (np.array(c) for c in ((196, 204, 213), (89, 97, 107), (223, 228, 234)))
_INK, _MARK, _PRESSURE = (np.array(c) for c in ((27, 31, 36), (213, 94, 0), (0, 114, 178)))


@dataclass(frozen=True, eq=False)
class Stage:
    """All that the pictures of a turn share.

    columns are those of the cycle at the view's load case; guide is the lower and upper end of
    guide A over the cam's axis and the stem's diameter, mm, or None where the case gives none.
    """

    view: TurnView
    patches: PatchSeries
    columns: Mapping[str, Array]
    title: str
    speed: str
    gear_ratio: float
    guide: tuple[float, float, float] | None

    @classmethod
    def of(cls, material: Material, view: TurnView) -> Stage:
        """The stage of a run.

        Raises
        ------
        ResultError
            If the patch series of the run is missing or of other angles.
        """
        cycle = material.run.final.cycle.where("load_case", view.load_case).columns
        patches = read_patches(material.folder, material.run.final.path, view, cycle)
        turn = material.turn
        known = [turn.length("guides", "a", "length"), turn.length("follower", "stem_diameter"),
                 turn.length("follower", "overhang_at_max_lift")]  # fmt: skip
        guide = None
        if all(value is not None for value in known):
            length, stem, overhang = (float(value or 0.0) for value in known)
            middle = float(view.lab_origin()[1].max()) + overhang
            guide = (middle - 0.5 * length, middle + 0.5 * length, stem)
        cases = {str(c.get("name")): c for c in material.case.get("load_case", ())}
        ratio = float(cycle["crank_angle_deg"][1] / cycle["cam_angle_deg"][1])
        title = str(material.case.get("title") or material.run.summary["case"])
        return cls(
            view, patches, cycle, shortened(title, 90),
            str(cases.get(view.load_case, {}).get("speed", "")), ratio, guide,
        )  # fmt: skip

    @property
    def size(self) -> tuple[int, int]:
        return SIZE

    def picture(self, k: int) -> Pixels:
        """Picture of the view's angle `k` (height, width, 3), bytes."""
        frame = self._still.copy()
        _set(frame, _BODY, self._bodies(k))
        _set(frame, _PATCH, self.patches.picture(k, _PATCH[2:], self._patch_norm))
        image = Image.fromarray(np.clip(frame + 0.5, 0, 255).astype(np.uint8))
        self._write(ImageDraw.Draw(image), k)
        return np.asarray(image)

    @cached_property
    def _norm(self) -> LogNorm:
        top = float(self.view.cam_stress.max(initial=1.0))
        return LogNorm(FLOOR_SHARE * top, TOP_SHARE * top, clip=True)

    @cached_property
    def _patch_norm(self) -> Normalize:
        return Normalize(0.0, self.patches.stress_max, clip=True)

    @cached_property
    def _window(self) -> Window:
        """All that moves stays in sight; the axis of the cam is (0, 0)."""
        reach = float(np.hypot(*self.view.cam[:, :, 0]).max())
        body = float(np.hypot(*self.view.follower).max())
        top = float(self.view.lab_origin()[1].max()) + 2.5 * body
        top = top if self.guide is None else self.guide[1] + 0.3 * body
        _, _, width, height = _BODY
        pixel = 1.03 * max((top + reach) / height, 2 * reach / width)
        lower = 0.5 * (top - reach) - 0.5 * pixel * height
        return Window(-0.5 * pixel * width, lower, pixel, width, height)

    @cached_property
    def _cam(self) -> CamRaster:
        return CamRaster(self.view.cam, self._window)

    @cached_property
    def _follower(self) -> BodyRaster:
        return BodyRaster(self.view.follower, self.view.triangles, self._window)

    @cached_property
    def _spin(self) -> Array:
        """How far the roller has rolled (f,), rad, as seen from its contact."""
        return self.view.arc() / float(np.hypot(*self.view.follower).max())

    @cached_property
    def _lab(self) -> Array:
        return self.view.lab_origin()

    def _bodies(self, k: int) -> Pixels:
        view, window = self.view, self._window
        panel: Pixels = np.full((window.height, window.width, 3), 255.0, dtype=np.float32)
        origin, turn = self._lab[:, k], float(view.to_lab[k] + view.turn[k])
        self._draw_guided(panel, origin)
        self._lay(panel, self._cam(float(view.to_lab[k]), view.cam_stress[k]))
        self._lay(panel, self._follower(origin, turn, view.follower_stress[k]))
        if view.is_roller:
            hole = float(np.hypot(*view.follower).min())
            paint_disc(panel, window, origin, hole, _SHAFT)
            facing = turn + 0.5 * np.pi + self._spin[k]
            arm = 0.72 * hole * np.array([np.cos(facing), np.sin(facing)])
            paint_disc(panel, window, origin + arm, 0.2 * hole, _INK)
        return panel

    def _lay(self, panel: Pixels, layer: Layer) -> None:
        painted(panel[layer.part], _looked_up(self._norm(layer.values).data), layer.cover)
        painted(panel[layer.part], _INK, layer.outline)

    def _draw_guided(self, panel: Pixels, origin: Array) -> None:
        """Stem and guide A; grooves on the stem show that it moves."""
        if self.guide is None:
            return
        low, high, stem = self.guide
        window, x, y = self._window, float(origin[0]), float(origin[1])
        half, far = 0.5 * stem, window.lower + window.pixel * (window.height + 2)
        edge = half + window.pixel
        paint_box(panel, window, (x - edge, y), (x + edge, far), _DARK)
        paint_box(panel, window, (x - half, y), (x + half, far), _SHAFT)
        for groove in np.arange(y + 2 * stem, far, stem):
            paint_box(panel, window, (x - half, groove), (x + half, groove + 0.12 * stem), _STEEL)
        for side in (-1.0, 1.0):
            left, right = sorted((x + side * half, x + side * (half + 0.7 * stem)))
            paint_box(panel, window, (left, low), (right, high), _DARK)

    def _write(self, draw: ImageDraw.ImageDraw, k: int) -> None:
        """Stamp of angle and values; cursor in the trace."""
        row = int(self.view.position[k])
        angle = float(self.view.angle[k])
        draw.text(_STAMP, f"cam {angle:5.1f}°", font=_font(26), fill=COLOURS["ink"])
        told = [f"crank {angle * self.gear_ratio:5.1f}°"] + [
            f"{words} {float(self.columns[name][row]):.4g} {unit}"
            for words, name, unit in (
                ("p0", "p0_fe_MPa", "MPa"), ("force", "normal_force_N", "N"),
                ("half-width", "half_width_fe_mm", "mm"), ("lift", "lift_mm", "mm"),
            ) if name in self.columns
        ]  # fmt: skip
        beside = (_STAMP[0] + 158, _STAMP[1] + 11)
        draw.text(beside, " · ".join(told), font=_font(13), fill=COLOURS["ink"])
        left, top, width, height = _TRACE
        x = left + width * angle / 360.0
        draw.line([(x, top), (x, top + height)], fill=COLOURS["vermillion"], width=2)
        y = top + height * (1 - float(self.columns["p0_fe_MPa"][row]) / self._trace_top)
        draw.ellipse([x - 5, y - 5, x + 5, y + 5], fill=COLOURS["vermillion"], outline="white")

    @cached_property
    def _trace_top(self) -> float:
        return 1.1 * float(np.nanmax(self.columns["p0_fe_MPa"]))

    @cached_property
    def _still(self) -> Pixels:
        """Title, axes and colour bars."""
        with style("film"):
            canvas = Figure(figsize=(SIZE[0] / 100, SIZE[1] / 100), dpi=100, facecolor="white")
            words = f"{self.title} · {self.view.load_case}" + (
                f", {self.speed}" if self.speed else ""
            )
            canvas.text(20 / SIZE[0], 1 - 24 / SIZE[1], words, fontsize=12, weight="bold",
                        va="center", color=COLOURS["ink"])  # fmt: skip
            self._bar(canvas, _BODY_BAR, self._norm, "von Mises stress, MPa (logarithmic)")
            self._bar(canvas, _PATCH_BAR, self._patch_norm, "von Mises stress, MPa")
            self.patches.frame(canvas.add_axes(_place(_PATCH)))
            self._trace(canvas)
            agg = FigureCanvasAgg(canvas)
            agg.draw()
            return np.asarray(agg.buffer_rgba())[..., :3].astype(np.float32)

    def _bar(self, canvas: Figure, where: tuple[int, int, int, int], norm: Any, words: str) -> None:
        ax = canvas.add_axes(_place(where))
        bar = canvas.colorbar(ScalarMappable(norm, COLOUR_MAP), cax=ax)
        bar.set_label(words)
        bar.outline.set_linewidth(0.6)
        if isinstance(norm, LogNorm):
            bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
            bar.ax.yaxis.set_minor_locator(NullLocator())

    def _trace(self, canvas: Figure) -> None:
        ax = canvas.add_axes(_place(_TRACE))
        angle = np.append(self.columns["cam_angle_deg"], 360.0)
        for name, words, dashed in (("p0_fe_MPa", "finite elements", False),
                                    ("p0_hertz_MPa", "Hertz", True)):  # fmt: skip
            values = self.columns[name]
            ax.plot(angle, np.append(values, values[0]), label=words,
                    dashes=(4, 3) if dashed else (),
                    color=COLOURS["orange" if dashed else "blue"])  # fmt: skip
        ax.set(xlim=(0, 360), ylim=(0, self._trace_top), xlabel="cam angle, deg",
               ylabel="peak pressure p0, MPa", xticks=np.arange(0, 361, 45))  # fmt: skip
        ax.grid(visible=True)
        ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), frameon=False, ncols=2)


def _place(where: tuple[int, int, int, int]) -> tuple[float, float, float, float]:
    left, top, width, height = where
    return left / SIZE[0], 1 - (top + height) / SIZE[1], width / SIZE[0], height / SIZE[1]


def _set(frame: Pixels, where: tuple[int, int, int, int], panel: Pixels) -> None:
    left, top, width, height = where
    frame[top : top + height, left : left + width] = panel


def _looked_up(shares: Array) -> Pixels:
    """Colours (..., 3), 0 to 255, of shares of the range."""
    return colour_table()[(255.999 * np.asarray(shares)).astype(np.int64)]


def _font(size: int) -> ImageFont.FreeTypeFont:
    return ImageFont.truetype(Path(findfont("DejaVu Sans")), size)

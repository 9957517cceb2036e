"""A film of the turn: cam, follower and their stress, the patch under the contact, its pressure.

Camera and colours stay as they are over the whole turn, so that pictures can be compared.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from camwright.geometry.errors import ResultError
from camwright.reports.figure_svg import COLOURS
from camwright.reports.film_frames import Stage
from camwright.reports.film_patch import colour_table
from camwright.reports.report_data import FIGURES, Material
from camwright.reports.scene_turn import read_turn_view

MP4, GIF = "turn.mp4", "turn.gif"
SECONDS = 12.0
RATE_MAX = 30
GIF_PICTURES = 120
GIF_SHRINK = 2
MISSING = "a film needs the package imageio-ffmpeg: pip install 'camwright[film]'"


def write(material: Material) -> Sequence[Path]:
    """Write ``figures/turn.mp4`` and ``figures/turn.gif``, each whole or not at all.

    Raises
    ------
    ResultError
        If imageio-ffmpeg is not installed, the run has no view of its turn, or a file cannot be
        written.
    """
    if importlib.util.find_spec("imageio_ffmpeg") is None:
        raise ResultError(MISSING)
    view = read_turn_view(material.folder)
    stage = Stage.of(material, view)
    count = view.angle.size
    rate = int(np.clip(round(count / SECONDS), 4, RATE_MAX))
    every = -(-count // GIF_PICTURES)
    folder = material.folder / FIGURES
    kept = []
    with _aside(folder / MP4) as mp4, _encoder(mp4, stage.size, rate) as send:
        for k in range(count):
            picture = stage.picture(k)
            send(picture)
            if k % every == 0:
                kept.append(Image.fromarray(picture).reduce(GIF_SHRINK))
            material.tell(k + 1, count)
    with _aside(folder / GIF) as gif:
        _write_gif(gif, kept, 1000 * every / rate)
    return [folder / MP4, folder / GIF]


@contextmanager
def _aside(path: Path) -> Iterator[Path]:
    """A name beside `path` to write to, which takes its place when all went well."""
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def _encoder(path: Path, size: tuple[int, int], rate: int) -> Iterator[Callable[[Any], None]]:
    """What takes pictures (height, width, 3) of bytes into an H.264 film that plays anywhere."""
    import imageio_ffmpeg

    writer = imageio_ffmpeg.write_frames(
        str(path), size, fps=rate, codec="libx264", pix_fmt_out="yuv420p", macro_block_size=2,
        quality=None, ffmpeg_log_level="error",
        output_params=["-crf", "18", "-preset", "veryfast", "-movflags", "+faststart"],
    )  # fmt: skip
    writer.send(None)
    try:
        yield lambda picture: writer.send(np.ascontiguousarray(picture))
    finally:
        writer.close()


def _write_gif(path: Path, pictures: Sequence[Image.Image], duration: float) -> None:
    """Pictures in one palette, `duration` ms each, again and again."""
    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette().tobytes())
    drawn = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    drawn[0].save(
        path, format="GIF", save_all=True, append_images=drawn[1:], duration=round(duration),
        loop=0, disposal=1,
    )  # fmt: skip


def _palette() -> Any:
    """The 256 colours of the film (256, 3): its scale, greys, the line colours on white."""
    white = np.full(3, 255.0)

    def ramp(name: str, count: int) -> Any:
        ink = np.array([int(COLOURS[name][k : k + 2], 16) for k in (1, 3, 5)], dtype=float)
        return white + (ink - white) * np.linspace(0.0, 1.0, count)[:, None]

    scale = colour_table()[np.linspace(0, 255, 176).astype(int)]
    lines = [ramp("ink", 40), ramp("blue", 20), ramp("vermillion", 10), ramp("orange", 10)]
    return np.concatenate([scale, *lines]).round().astype(np.uint8)

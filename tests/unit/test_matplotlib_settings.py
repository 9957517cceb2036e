"""Drawings with the settings of matplotlib itself: a matplotlibrc of the user changes none."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from camwright import reports
from camwright.geometry.figures import Curve, Figure, Panel, over
from camwright.reports.field_raster import triangles_picture
from camwright.reports.figure_svg import png_of, svg_of

OF_A_USER = {
    "text.usetex": True, "font.size": 20.0, "lines.linewidth": 7.0, "axes.grid": True,
    "savefig.dpi": 30.0, "figure.dpi": 30.0, "svg.fonttype": "path", "image.cmap": "gray",
    "axes.prop_cycle": mpl.cycler(color=["red"]), "savefig.transparent": True,
}  # fmt: skip


def drawings(figure: Figure) -> tuple[object, ...]:
    corners = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    raster = triangles_picture(
        corners, np.array([[0], [1], [2]]), np.arange(3.0), (0.0, 1.0, 0.0, 1.0), (0.0, 2.0),
        log=False, colour_map="viridis",
    )  # fmt: skip
    return svg_of(figure), png_of(figure), raster.tobytes()


POINTS = np.array([1.0, 2.0])
FIGURE = over(
    "sweep", "Sweep", "", "speed", "rpm", (Panel("force", "N", (Curve(POINTS, POINTS, "least"),)),)
)


def test_settings_of_the_user_change_no_drawing() -> None:
    before = drawings(FIGURE)
    with mpl.rc_context(OF_A_USER):
        assert drawings(FIGURE) == before
        assert mpl.rcParams["font.size"] == 20.0  # left as it was


@pytest.mark.parametrize("content", [b"font.size: 20\nno such key: 1\n", b"\xff\xfe no text"])
@pytest.mark.slow
def test_a_matplotlibrc_that_cannot_be_read_ends_no_drawing(tmp_path: Path, content: bytes) -> None:
    """In a new process, since matplotlib reads it as it is imported."""
    (tmp_path / "matplotlibrc").write_bytes(content)
    script = (
        "from camwright.reports.figure_svg import shipped\n"
        "with shipped():\n"
        "    import matplotlib\n"
        "    print(matplotlib.rcParams['font.size'])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout == "10.0\n"


def test_every_module_that_draws_has_the_shipped_settings() -> None:
    """None imports matplotlib as it is imported; each draws within `shipped` or `style`."""
    for file in Path(reports.__file__).parent.rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        assert not re.search(r"^(from|import) matplotlib", text, re.MULTILINE), file
        if re.search(r"^ +(canvas|figure)[^=\n]* = (Figure|Canvas)\(", text, re.MULTILINE):
            assert re.search(r"@shipped\(\)|with style\(", text), file

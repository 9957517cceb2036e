"""The plots of the sheet, drawn once: as SVG for the page, as PNG beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from markupsafe import Markup

from camwright.pipeline.base.files import write_atomic
from camwright.reports.analysis_sheet import figures
from camwright.reports.figure_svg import svg_and_png
from camwright.reports.figures import Figure
from camwright.reports.limits_strip import strip_figures
from camwright.reports.part_figures import part_figures
from camwright.reports.report_data import FIGURES, Material

GROUPS = (
    ("Torque", ("torque", "torque-components", "crank-speed")),
    ("Shape", ("outline", "pressure-angle", "face", "lift", "radii")),
    ("Limits", ("limits",)),
    ("Contact", ("pressure", "half-width", "stress")),
    ("Forces and guides", ("normal-force", "forces", "guides", "jamming", "speed")),
    ("Parts", ("bushes", "elastic", "roller", "film", "parts")),
)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure of the sheet with its drawings."""

    figure: Figure
    svg: Markup
    png: bytes


@lru_cache(maxsize=1)
def drawn_groups(material: Material) -> Sequence[tuple[str, Sequence[Drawn]]]:
    """The figures that a run has columns for, by group, in reading order."""
    turn, limits = material.turn, material.run.final.limits
    made = (
        *figures(turn),
        *strip_figures(
            None if limits is None else limits.columns,
            turn.gear_ratio,
            strokes=turn.gear_ratio == 2.0 and turn.torque is not None,
        ),
        *part_figures(turn),
    )
    by_id = {figure.id: figure for figure in made}
    groups = (
        (title, tuple(_drawn(by_id[name]) for name in names if name in by_id))
        for title, names in GROUPS
    )
    return tuple((title, drawn) for title, drawn in groups if drawn)


def write(material: Material) -> list[Path]:
    """Write ``figures/ID.png`` for every figure of the sheet."""
    return [
        write_atomic(material.folder / FIGURES / f"{one.figure.id}.png", one.png)
        for _, drawn in drawn_groups(material)
        for one in drawn
    ]


def _drawn(figure: Figure) -> Drawn:
    svg, png = svg_and_png(figure)
    return Drawn(figure, Markup(svg), png)  # noqa: S704 - matplotlib's, its texts escaped

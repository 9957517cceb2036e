"""Published values and figures, recomputed.

In the order of the calculation:

| module                    | responsibility                                 | symbol, unit   |
| ------------------------- | ---------------------------------------------- | -------------- |
| `published_figures`       | targets, outcomes, verdicts                    |                |
| `paper_figure`            | figure of a paper: curves, caption, values     |                |
| `paper_engines`           | engines of the papers in the cylinder model    | N m            |
| `balancing_cam`           | balancing cam under an engine torque           | N m; rad/s     |
| `follower_contours`       | roller and flat faces for the same torque      | m; N; Pa       |
| `speed_reconstruction`    | crank speed from published statistics          | rad/s          |
| `validation_figures`      | curves behind the rows of `validate`           |                |
| `cardoso_2024`            | engine at 800 rpm, cam without losses          |                |
| `cardoso_2025`            | engine at idle and its balancing cam           |                |
| `petrescu_2015`           | valve cams of modules B and C                  |                |
| `slider_crank_drive`      | slider-crank and eccentric cam: forces, losses | N; J           |
| `mechanism_sizes`         | friction energy over the sizes                 | J              |
| `slider_crank_2024`       | slider-crank and eccentric cam                 |                |
| `friction_identification` | friction from measured decays                  | N m; N m s/rad |
| `mechanism_comparison`    | command `compare-mechanisms`                   |                |
| `modelled_runs`           | ten runs at a pick-up, from voltage to speed   | V; rad/s       |
| `figures_2025_engine`     | engine, pick-up and ten runs of three states   | N m; rad/s     |
| `figures_2025_cam`        | smoothing, outlines, friction, preloads        | N m; rad/s; mm |
| `figures_2024_cam`        | engine at 800 rpm with and without the cam     | N m; rad/s; mm |
| `figures_2015_valve`      | valve cams: outlines, shape index, dynamics    | mm; m/s2       |
| `figures_2024_mechanisms` | slider-crank and eccentric cam                 | N; J           |
| `machine_gallery`         | command `gallery`: machines and their cams     | N m; mm; rpm   |

A paper is a module with a function `study(targets) -> PaperResult`, named in `PAPERS`. Values
without an outcome are not decidable. Basis and tolerance of each stand in ``targets.json``. The
figures of a paper are modules with a function `figures(targets)`, named in `FIGURES`. Imported by
`commands.comparison_commands` alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.studies.papers.paper_figure import records
from camwright.pipeline.studies.papers.published_figures import (
    PaperResult,
    citations,
    counts,
    row_record,
    targets,
)

PAPERS: Mapping[str, str] = {
    "C25": "camwright.pipeline.studies.papers.cardoso_2025",
    "C24": "camwright.pipeline.studies.papers.cardoso_2024",
    "P15": "camwright.pipeline.studies.papers.petrescu_2015",
    "E24": "camwright.pipeline.studies.papers.slider_crank_2024",
}
FIGURES: Mapping[str, tuple[str, ...]] = {
    "C25": ("figures_2025_engine", "figures_2025_cam"),
    "C24": ("figures_2024_cam",),
    "P15": ("figures_2015_valve",),
    "E24": ("figures_2024_mechanisms",),
}


def figures(name: str = "", progress: Progress = SILENT) -> dict[str, Any]:
    """Contents of ``papers.json``: figures of a paper (C25), one figure (c25-cam), or all.

    Raises
    ------
    InputError
        If there is no such paper or figure.
    """
    paper = name.split("-")[0].upper()
    if name and paper not in FIGURES:
        raise InputError("NAME", name, f"a paper ({', '.join(FIGURES)}) or one of its figures")
    modules = [(key, m) for key, group in FIGURES.items() if paper in ("", key) for m in group]
    drawn: list[dict[str, Any]] = []
    progress.stage("figures of the papers")
    for count, (key, module) in enumerate(modules, start=1):
        drawn += records(import_module(f"{__name__}.{module}").figures(targets(key)))
        progress.advance(count, len(modules))
    if "-" in name:
        known = [one["name"] for one in drawn]
        if name.lower() not in known:
            raise InputError("NAME", name, f"one of {', '.join(known)}")
        drawn = [one for one in drawn if one["name"] == name.lower()]
    shown = {one["paper"] for one in drawn}
    cited = {key: paper for key, paper in citations().items() if key in shown}
    return {"papers": cited, "figures": drawn}


def validate(progress: Progress = SILENT) -> dict[str, Any]:
    """Contents of ``validation.json``: published and computed values with verdicts."""
    results: dict[str, PaperResult] = {}
    progress.stage("papers")
    for paper, module in PAPERS.items():
        results[paper] = import_module(module).study(targets(paper))
        progress.advance(len(results), len(PAPERS))
    rows = []
    for target in targets().values():
        result = results.get(target.paper)
        rows.append(row_record(target, result.outcomes.get(target.id) if result else None))
    return {
        "papers": citations(),
        "counts": counts(rows),
        "rows": rows,
        "figures": [dict(one) for result in results.values() for one in result.figures],
        "studies": {paper: dict(result.studies) for paper, result in results.items()},
    }

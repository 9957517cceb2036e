"""Values and figures of all papers.

A paper is a module with a function `study(targets) -> PaperResult`, named in `PAPERS`. Values
without an outcome are not decidable. Basis and tolerance of each stand in ``targets.json``. The
figures of a paper are modules with a function `figures(targets)`, named in `FIGURES`.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base.progress import SILENT, Progress
from validation.paper_figure import records
from validation.published_figures import (
    PaperResult,
    citations,
    counts,
    row_record,
    targets,
)

PAPERS: Mapping[str, str] = {
    "C25": "validation.cardoso_2025",
    "C24": "validation.cardoso_2024",
    "P15": "validation.petrescu_2015",
    "E24": "validation.slider_crank_2024",
}
FIGURES: Mapping[str, tuple[str, ...]] = {
    "C25": ("figures_2025_engine", "figures_2025_cam"),
    "C24": ("figures_2024_cam",),
    "P15": ("figures_2015_valve",),
    "E24": ("figures_2024_mechanisms",),
}


def figures(name: str = "", progress: Progress = SILENT) -> dict[str, Any]:
    """Contents of ``figures.json``: figures of a paper (C25), one figure (c25-cam), or all.

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
        drawn += records(import_module(f"validation.{module}").figures(targets(key)))
        progress.advance(count, len(modules))
    if "-" in name:
        known = [one["name"] for one in drawn]
        if name.lower() not in known:
            raise InputError("NAME", name, f"one of {', '.join(known)}")
        drawn = [one for one in drawn if one["name"] == name.lower()]
    shown = {one["paper"] for one in drawn}
    cited = {key: paper for key, paper in citations().items() if key in shown}
    return {"papers": cited, "figures": drawn}


def values(progress: Progress = SILENT) -> dict[str, Any]:
    """Contents of ``values.json``: published and computed values with verdicts."""
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

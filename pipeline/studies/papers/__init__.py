"""Published values, recomputed: one module per paper.

In the order of the calculation:

| module                    | responsibility                                 | symbol, unit   |
| ------------------------- | ---------------------------------------------- | -------------- |
| `published_figures`       | targets, outcomes, verdicts                    |                |
| `paper_engines`           | engines of the papers in the cylinder model    | N m            |
| `balancing_cam`           | balancing cam under an engine torque           | N m; rad/s     |
| `speed_reconstruction`    | crank speed from published statistics          | rad/s          |
| `cardoso_2024`            | engine at 800 rpm, cam without losses          |                |
| `cardoso_2025`            | engine at idle and its balancing cam           |                |
| `petrescu_2015`           | valve cams of modules B and C                  |                |
| `slider_crank_drive`      | slider-crank and eccentric cam: forces, losses | N; J           |
| `mechanism_sizes`         | friction energy over the sizes                 | J              |
| `slider_crank_2024`       | slider-crank and eccentric cam                 |                |
| `friction_identification` | friction from measured decays                  | N m; N m s/rad |
| `mechanism_comparison`    | command `compare-mechanisms`                   |                |

A paper is a module with a function `study(targets) -> PaperResult`, named in `PAPERS`. Values
without an outcome are not decidable. Basis and tolerance of each stand in ``targets.json``.
Imported by `commands.comparison_commands` alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from camwright.pipeline.base.progress import SILENT, Progress
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
        "studies": {paper: dict(result.studies) for paper, result in results.items()},
    }

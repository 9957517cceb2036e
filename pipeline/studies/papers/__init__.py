"""The published studies, run again: one module per paper, each row with its verdict.

A further paper is a further module with a function `study(targets) -> PaperResult`, named in
`PAPERS`. Rows without an outcome are not decidable: not computed by this version.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from importlib import import_module
from typing import Any

from camwright.pipeline.studies.papers.published_figures import (
    PaperResult,
    citations,
    row_record,
    targets,
)

PAPERS: Mapping[str, str] = {
    "C25": "camwright.pipeline.studies.papers.cardoso_2025",
    "C24": "camwright.pipeline.studies.papers.cardoso_2024",
    "P15": "camwright.pipeline.studies.papers.petrescu_2015",
    "E24": "camwright.pipeline.studies.papers.slider_crank_2024",
}


def validate() -> dict[str, Any]:
    """Contents of ``validation.json``: every published figure with what is obtained for it."""
    results: dict[str, PaperResult] = {
        paper: import_module(module).study(targets(paper)) for paper, module in PAPERS.items()
    }
    rows = []
    for target in targets().values():
        result = results.get(target.paper)
        rows.append(row_record(target, result.outcomes.get(target.id) if result else None))
    return {
        "papers": citations(),
        "counts": dict(Counter(row["verdict"] for row in rows)),
        "rows": rows,
        "studies": {paper: dict(result.studies) for paper, result in results.items()},
    }

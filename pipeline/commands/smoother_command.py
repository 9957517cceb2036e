"""Command `design smoother`: smoothers ranked on a case."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    PASSED,
    CaseArgument,
    progress_shown,
    stdout,
)


def smoother(
    case: CaseArgument,
    *,
    out: Annotated[
        Path | None, Words("Folder for table, figure and page; default: none.", "DIR")
    ] = None,
) -> int:
    """Rank the smoothers of the lift on a case by closed forms.

    The recommended one first; then residual torque, contact pressure and failing checks of each.

    Example: camwright design smoother pump.toml --out smoothers
    """
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.case.load_case_torque import engine_torques
    from camwright.pipeline.search.smoothers import (
        RANK,
        common_missing,
        compared,
        lines,
        ranked,
        recommendation,
    )
    from camwright.reports.comparisons import smoother_page

    design = read_case(case)
    with progress_shown() as progress:
        results = ranked(list(compared(design, engine_torques(design), progress)))
    for line in lines(results):
        stdout.print(line, markup=False)
    if out is not None:
        lifts = {
            one.smoother if one.smoother == "constrained" else one.words: one.lift.values
            for one in results
            if one.lift is not None
        }
        rows = [
            {"rank": k, "smoother": one.smoother, "words": one.words, **one.record}
            for k, one in enumerate(results, start=1)
        ]
        page = smoother_page.write(
            out,
            f"{design.name}: smoothers compared",
            rows,
            lifts,
            lead=f"{recommendation(results[0])}. {RANK}.",
            common=common_missing(results),
        )
        stdout.print(f"page: {page}", markup=False)
    return PASSED

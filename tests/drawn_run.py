"""A run with its pages, drawn as the command does, but in one process."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from camwright.pipeline.case.case import Case
from camwright.pipeline.results.run_reader import Run
from camwright.pipeline.run import CaseRun
from camwright.reports.sections import report


def drawn_run(case: Case, out: Path, **options: Any) -> Run:
    with CaseRun(case, out, **options) as run:
        run.solve()
        run.write()
        run.certify()
        report(run.draft())
        return run.finish()

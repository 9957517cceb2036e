"""A run with its pages, drawn as the command does, but in one process and with few remedies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from camwright.pipeline.case.case import Case
from camwright.pipeline.results.run_reader import Run
from camwright.pipeline.run import CaseRun
from camwright.pipeline.search.remedies import remedy_search
from camwright.reports.sections import report

SOUGHT = 2
"""Failed checks whose remedy is sought, one a process; `test_remedies_hold` seeks all of them."""


@contextmanager
def few_remedies() -> Iterator[None]:
    """Context in which a run seeks the remedies of its `SOUGHT` worst checks alone."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("IN_A_RUN", "LEAST_IN_A_RUN"):
            patch.setattr(remedy_search, name, SOUGHT)
        yield


def drawn_run(case: Case, out: Path, **options: Any) -> Run:
    with few_remedies(), CaseRun(case, out, **options) as run:
        run.solve()
        run.write()
        run.certify()
        report(run.draft())
        return run.finish()

"""Data of a report: a finished run, read once for all sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from camwright.geometry.errors import ResultError
from camwright.geometry.figures import SERIES
from camwright.pipeline.base.files import parse_toml
from camwright.pipeline.base.worker_processes import PendingCall
from camwright.pipeline.results.run_reader import Run, TrialRecord, read_run
from camwright.reports.report_tables import Record, shortened
from camwright.reports.sheet_turn import SheetTurn
from camwright.reports.verdict_text import governing_load_case

FIGURES = "figures"
"""Folder of the pictures in a run folder."""
_ENTRIES = {
    "project": "Project",
    "part_number": "Part number",
    "revision": "Revision",
    "author": "Author",
    "date": "Date",
    "material": "Material",
}


@dataclass(frozen=True, eq=False)
class ReportMaterial:
    """Run, report folder and drawn load case of a report.

    Compared by identity, so that drawings can be cached by it. `ahead` are drawings begun before
    the run was complete, by the key of what they show.
    """

    folder: Path
    run: Run
    case: Record
    turn: SheetTurn
    ahead: Mapping[str, PendingCall] = field(default_factory=dict)


def read_material(folder: Path, ahead: Mapping[str, PendingCall] | None = None) -> ReportMaterial:
    """Report data of a run folder, into which the report is written.

    Raises
    ------
    ResultError
        If the folder does not hold a finished run.
    """
    run = read_run(folder)
    case = parse_toml(run.case_text, str(run.path / "case.toml"))
    return ReportMaterial(Path(folder), run, case, governing_turn(run, case), ahead or {})


def governing_turn(run: Run, case: Record) -> SheetTurn:
    """Turn of the governing load case of the final trial, among those in which the follower stays
    on the cam and does not lock; among all load cases if there are none of those.

    Raises
    ------
    ResultError
        If the cycle of the run has no rows.
    """
    final = run.final
    names = final.cycle.load_cases
    if not names:
        raise ResultError(f"{final.path}: the cycle has no rows")
    by_name = {name: final.cycle.of_load_case(name) for name in names}
    ended = {each["load_case"] for each in run.summary.get("load_ends", ())}
    whole = [name for name in names if name not in ended]
    drawn = governing_load_case(final.checks, whole or names)
    return SheetTurn(
        by_name[drawn], tuple(by_name.values()), final.lift, final.contour, run.torque,
        final.checks, case, final.record["balance"], drawn, run.speed, final.limits,
        run.summary["trial_points"], run.summary["ripple_map"], final.sweep,
        final.record.get("fatigue") or {}, _compared(run),
    )  # fmt: skip


def _compared(run: Run) -> tuple[TrialRecord, ...]:
    """Trials that the figures compare, one a colour: first, latest, and last the final one."""
    final = run.final
    others = [trial for trial in run.trials if trial is not final]
    return (*others[:1], *others[1:][-(len(SERIES) - 2) :], final)


def title_block(case: Record) -> Sequence[tuple[str, str]]:
    """Entries of the title block by name; "" for a field to fill by hand."""
    stated = case.get("document", {})
    return [(words, shortened(str(stated.get(key, "")), 60)) for key, words in _ENTRIES.items()]

"""Comparisons: smoothers, mechanisms, the papers' published figures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.pipeline.commands.terminal import PASSED, CaseArgument, show_json, stdout

_COMPARED = (
    ("residual_std_Nm", "N m std left"),
    ("pressure_angle_max_deg", "deg"),
    ("lift_max_mm", "mm lift"),
    ("normal_force_max_N", "N"),
    ("p0_max_MPa", "MPa"),
)


def compare(
    case: CaseArgument,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Write table, figure and page.")
    ] = None,
) -> int:
    """Every smoother on the same case, by closed forms: ripple left, forces, verdict."""
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.case.load_case_torque import engine_torques
    from camwright.pipeline.studies.smoother_comparison import compared
    from camwright.reports import smoother_page

    design = read_case(case)
    found = list(compared(design, engine_torques(design)))
    rows = [{"smoother": one.smoother, "words": one.words, **one.record} for one in found]
    for row in rows:
        shown = [f"{row[n]:.4g} {u}" for n, u in _COMPARED if row.get(n) is not None]
        line = f"{row['smoother']} ({row['words']}): {', '.join(shown)}; {row['verdict']}"
        stdout.print(line, markup=False)
    if out is not None:
        lifts = {
            one.smoother if one.smoother == "constrained" else one.words: one.lift.values
            for one in found
            if one.lift is not None
        }
        page = smoother_page.write(out, f"{design.name}: smoothers compared", rows, lifts)
        stdout.print(f"page: {page}", markup=False)
    return PASSED


def validate(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Where the page is to lie.")
    ] = Path(),
) -> int:
    """Run the papers' studies again; write validation.html and validation.json."""
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.studies.papers import validate as studies
    from camwright.reports.validation_page import page

    document = studies()
    write_atomic(out / "validation.json", json_text(document) + "\n")
    write_atomic(out / "validation.html", page(document))
    counts = ", ".join(f"{name} {number}" for name, number in document["counts"].items())
    stdout.print(f"{len(document['rows'])} published figures: {counts}", markup=False)
    stdout.print(f"page: {out / 'validation.html'}", markup=False)
    return PASSED


def compare_mechanisms(
    case: Annotated[Path, typer.Argument(metavar="CASE", help="Case of a comparison (TOML).")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Where the figures are to lie.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The figures as JSON.")] = False,
) -> int:
    """Slider-crank against eccentric cam: friction by pair, slip, inertia, workspaces."""
    from camwright.pipeline.studies.papers.mechanism_comparison import compared, lines
    from camwright.reports import mechanism_figures

    document = compared(case)
    if as_json:
        show_json(document)
    else:
        for line in lines(document):
            stdout.print(line, markup=False)
    folder = Path(f"{document['case']}_figures") if out is None else out
    drawn = mechanism_figures.draw(document, folder)
    if not as_json:
        stdout.print(f"figures: {', '.join(path.name for path in drawn)} in {folder}", markup=False)
    return PASSED

"""Commands `compare`, `validate`, `papers`, `gallery` and `compare-mechanisms`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.pipeline.commands.terminal import (
    PASSED,
    CaseArgument,
    progress_shown,
    show_json,
    stdout,
)


def compare(
    case: CaseArgument,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for table, figure and page.")
    ] = None,
) -> int:
    """Rank the smoothers on a case by closed forms.

    The recommended one first; then residual torque, contact pressure and failing checks of each.
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


def validate(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder for page and record.")
    ] = Path(),
) -> int:
    """Recompute the published values of the papers, counted by basis.

    Writes validation.html and validation.json.
    """
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.studies.papers import validate as studies
    from camwright.pipeline.studies.papers.published_figures import count_lines
    from camwright.reports.papers.validation_page import page

    with progress_shown() as progress:
        document = studies(progress)
    write_atomic(out / "validation.json", json_text(document) + "\n")
    write_atomic(out / "validation.html", page(document))
    stdout.print(f"{len(document['rows'])} published values by basis:", markup=False)
    for line in count_lines(document["counts"]):
        stdout.print(f"  {line}", markup=False)
    stdout.print(f"page: {out / 'validation.html'}", markup=False)
    return PASSED


def papers(
    name: Annotated[
        str,
        typer.Argument(
            metavar="[NAME]", help="A paper (C25, C24, P15, E24) or a figure (c25-cam)."
        ),
    ] = "",
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder for page and record.")
    ] = Path(),
) -> int:
    """Draw the figures of the papers beside their published values.

    Writes papers.html and papers.json.
    """
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.studies.papers import figures
    from camwright.reports.papers.papers_page import page

    with progress_shown() as progress:
        document = figures(name, progress)
        progress.stage("page")
        text = page(document)
    write_atomic(out / "papers.json", json_text(document, indent=None) + "\n")
    write_atomic(out / "papers.html", text)
    names = ", ".join(one["name"] for one in document["figures"])
    stdout.print(f"figures: {names}", markup=False)
    stdout.print(f"page: {out / 'papers.html'}", markup=False)
    return PASSED


def gallery(
    cases: Annotated[list[Path], typer.Argument(metavar="CASE...", help="Case files (TOML).")],
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder for page and record.")
    ] = Path(),
) -> int:
    """Show machines on one page: torque with and without the cam, outline, lift, speed.

    Each case is previewed. Writes gallery.html and gallery.json.
    """
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.studies.papers.machine_gallery import gallery as document_of
    from camwright.reports.papers.gallery_page import page

    with progress_shown() as progress:
        document = document_of(cases, progress)
        progress.stage("page")
        text = page(document)
    write_atomic(out / "gallery.json", json_text(document, indent=None) + "\n")
    write_atomic(out / "gallery.html", text)
    for one in document["machines"]:
        before, after = (one["values"][f"torque_std_{name}_cam_Nm"] for name in ("without", "with"))
        words = f"{one['name']}: torque ripple {before:.3g} to {after:.3g} N m"
        stdout.print(words, markup=False)
    stdout.print(f"page: {out / 'gallery.html'}", markup=False)
    return PASSED


def compare_mechanisms(
    case: Annotated[Path, typer.Argument(metavar="CASE", help="Comparison case (TOML).")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for the figures.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> int:
    """Compare a slider-crank with eccentric cams.

    Friction loss by pair, slip, reduced inertia and workspaces.
    """
    from camwright.pipeline.studies.papers.mechanism_comparison import compared, lines
    from camwright.reports.comparisons import mechanism_figures

    with progress_shown() as progress:
        progress.stage("mechanisms")
        document = compared(case)
        progress.stage("figures")
        folder = Path(f"{document['case']}_figures") if out is None else out
        drawn = mechanism_figures.draw(document, folder)
    if as_json:
        show_json(document)
    else:
        for line in lines(document):
            stdout.print(line, markup=False)
        stdout.print(f"figures: {', '.join(path.name for path in drawn)} in {folder}", markup=False)
    return PASSED

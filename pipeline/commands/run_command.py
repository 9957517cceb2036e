"""Commands `run`, `report` and `init`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.commands.terminal import (
    FAILED,
    PASSED,
    CaseArgument,
    DirArgument,
    NoCacheOption,
    page_of,
    progress_shown,
    show,
    stdout,
    use_cache,
)

TEMPLATE_SUFFIX = ".toml"
FIELDS = ("none", "worst", "default", "all")
"""Values of `field_output.Shown`, which is imported with the solver alone."""


def run(
    case: CaseArgument,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Run folder to write.")],
    positions: Annotated[
        int | None, typer.Option(help="Positions per cam turn; default: of the case.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(help="Number of processes; default: number of cores, at most 4.")
    ] = None,
    depth: Annotated[
        str,
        typer.Option(
            "--depth",
            help="screening, preview (closed forms), cycle (finite elements) or certified; the "
            "last alone has a verdict.",
        ),
    ] = "certified",
    no_report: Annotated[
        bool, typer.Option("--no-report", help="Write no page and no figures.")
    ] = False,
    png: Annotated[
        bool, typer.Option("--png", help="Write the figures as PNG files as well.")
    ] = False,
    resume: Annotated[bool, typer.Option("--resume", help="Resume an interrupted run.")] = False,
    replace: Annotated[
        bool,
        typer.Option(
            "--replace",
            help="Replace an earlier run of a case of this name, with its inspections, decks and "
            "changed files; files of the user are never deleted.",
        ),
    ] = False,
    fields: Annotated[
        str,
        typer.Option(
            metavar="none|worst|default|all",
            help="Cam angles of the stress field; default: the worst, the certified, every 15 deg.",
        ),
    ] = "default",
    no_cache: NoCacheOption = False,
) -> int:
    """Run a case and write its run folder."""
    from camwright.pipeline.base.progress import process_began
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.contact.tiers import Tier

    use_cache(not no_cache)
    tier = Tier.of(depth, "--depth")
    if jobs is not None and not 1 <= jobs <= 256:
        raise InputError("--jobs", jobs, ">= 1 and <= 256")
    if fields not in FIELDS:
        raise InputError("--fields", fields, f"one of {', '.join(FIELDS)}")
    design = read_case(case)
    if positions is not None:
        design = design.with_positions(positions)
    if not (resume and _finished(out, design.sha256, depth)):
        from camwright.pipeline.results.field_output import Shown
        from camwright.pipeline.run import CaseRun
        from camwright.pipeline.screening.live_preview import live_of, write_live
        from camwright.reports import sections

        drawings = None if no_report else sections.Ahead(sections.chosen(png=png))
        with (
            progress_shown() as progress,
            CaseRun(
                design,
                out,
                depth=tier,
                jobs=jobs,
                resume=resume,
                replace=replace,
                fields=Shown(fields),
                progress=progress,
                began=process_began(),
            ) as made,
        ):
            made.solve()
            made.write()
            live = None
            if drawings is not None and tier is Tier.CERTIFIED:
                folder = made.draft()
                live = made.workers.submit(live_of, folder)
                drawings.begin(folder, made.workers)
            made.certify()
            if live is not None:
                write_live(folder, live.result())
            if drawings is not None:
                drawings.write(made.draft())
            made.finish()
    from camwright.pipeline.results.run_reader import read_run, read_summary, read_verdict
    from camwright.pipeline.results.verdict_summary import Places, trial_lines

    seconds = read_summary(out)["timings_s"]["total"]
    for line in trial_lines(read_run(out)):
        stdout.print(line, markup=False)
    show(read_verdict(out), Places(str(out), str(case), page_of(out), seconds))
    return PASSED


def _finished(out: Path, sha256: str, depth: str) -> bool:
    """Whether a folder holds the finished run of this case, depth and these versions."""
    from camwright.pipeline.results.folder_exchange import complete_exchange
    from camwright.pipeline.results.run_folder import versions
    from camwright.pipeline.results.run_reader import read_summary
    from camwright.pipeline.results.signoff import require_recorded

    complete_exchange(out)
    if not (out / "run.json").is_file():
        return False
    require_recorded(out)
    summary = read_summary(out)
    same = summary["input_sha256"] == sha256 and summary["depth"] == depth
    return bool(same and summary["versions"] == versions())


def report(
    folder: DirArgument,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write 8_report.pdf as well.")] = False,
    png: Annotated[
        bool, typer.Option("--png", help="Write the figures as PNG files as well.")
    ] = False,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", metavar="PART", help="Write this part only; may be repeated."),
    ] = None,
    show: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
    check: Annotated[
        list[str] | None,
        typer.Option(
            "--check",
            metavar="CHECK",
            help="Print the hand-check sheet of this check, and write nothing; may be repeated.",
        ),
    ] = None,
) -> int:
    """Write the report of a finished run; nothing is solved.

    Exit code 4: the run is not as recorded; nothing is written. 1: a hand-check sheet disagrees
    with its check.
    """
    if check:
        return _sheets(folder, check)
    from camwright.reports import sections
    from camwright.reports.page import PAGE

    names = [part.name for part in sections.chosen(only or (), png=png)]
    names += ["pdf"] if pdf else []
    with progress_shown() as shown:
        made = sections.report(folder, sections.chosen(names), progress=shown)
    for name, files in made.items():
        stdout.print(f"{name}: {_listed(files)}", markup=False)
    if show:
        _open(folder / PAGE)
    return PASSED


def _sheets(folder: Path, names: Sequence[str]) -> int:
    """Print the hand-check sheets of checks."""
    from camwright.pipeline.hand_check.hand_sheet import SheetRun
    from camwright.pipeline.hand_check.sheet_lines import sheet_lines
    from camwright.pipeline.results.signoff import require_recorded

    require_recorded(folder)
    run = SheetRun(folder)
    sheets = [run.sheet(name) for name in names]
    for sheet in sheets:
        for line in sheet_lines(sheet):
            stdout.print(line, markup=False)
    return PASSED if all(sheet.agrees for sheet in sheets) else FAILED


def _listed(files: Sequence[Path]) -> str:
    """File of a part; of several files their number and folder."""
    if len(files) == 1:
        return str(files[0])
    return f"{len(files)} files in {files[0].parent}" if files else "no data in this run"


def _open(page: Path) -> None:
    import webbrowser

    if not page.is_file():
        raise ResultError(f"{page}: missing; `camwright report` writes it")
    webbrowser.open(page.resolve().as_uri())


def init(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the new case.")],
    kind: Annotated[
        str,
        typer.Option(
            metavar="cylinder|table|pressure|speed|voltage|torque|harmonics|compressor|pump|press|"
            "lift|eccentric",
            help="Source of the cam: an engine as a cylinder model, or measured as torque, "
            "cylinder pressure, tooth times or pick-up voltage; another machine by its torque; "
            "a lift; an eccentric.",
        ),
    ] = "cylinder",
) -> int:
    """Write NAME.toml, a commented case that passes, and the data file that it reads."""
    from camwright.pipeline.case.template import first_case

    name = name.removesuffix(TEMPLATE_SUFFIX)
    first = first_case(name, kind)
    texts = {Path(f"{name}{TEMPLATE_SUFFIX}"): first.text}
    if first.data_name:  # written first: a case is never without its data
        texts = {Path(first.data_name): first.data} | texts
    for path in texts:
        if os.path.lexists(path):
            raise ResultError(f"{path}: exists already, not overwritten")
    for path, text in texts.items():
        with path.open("x", encoding="utf-8", newline="") as file:
            file.write(text)
    *_, case = texts
    stdout.print(f"wrote {', '.join(str(path) for path in texts)}", markup=False)
    stdout.print(f"next: camwright run {case} --out runs/{name}", markup=False)
    return PASSED

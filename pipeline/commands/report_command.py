"""Command `report`: page, figures, PDF and hand-check sheets of a finished run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import ResultError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    FAILED,
    PASSED,
    PngOption,
    RunArgument,
    progress_shown,
    stdout,
)


def report(
    folder: RunArgument,
    *,
    pdf: Annotated[bool, Words("Write 8_report.pdf as well.")] = False,
    png: PngOption = False,
    only: Annotated[list[str] | None, Words("Write this part alone.", "PART")] = None,
    show: Annotated[bool, Words("Open the page in the browser.", typed="--open")] = False,
    check: Annotated[
        list[str] | None,
        Words("Print the hand-check sheet of this check, and write nothing.", "CHECK"),
    ] = None,
) -> int:
    """Write page and figures of a finished run again, from its files; nothing is solved.

    A run that is not as recorded is not read: exit code 4. A hand-check sheet that disagrees with
    its check: 1.

    Example: camwright report runs/pump --check pressure_angle
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
    """Print the hand-check sheets of these checks; exit code 1 if one disagrees with its check."""
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
    """Open a page in the browser; ResultError without one."""
    import webbrowser

    if not page.is_file():
        raise ResultError(f"{page}: missing; `camwright report` writes it")
    webbrowser.open(page.resolve().as_uri())

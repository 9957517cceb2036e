"""Command `inspect`: a measured cam against its drawing."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import (
    EXIT_CODE,
    DirArgument,
    progress_shown,
    show_json,
    stdout,
)


def inspect(
    folder: DirArgument,
    measured: Annotated[
        Path, typer.Argument(metavar="MEASURED", help="Measured surface points or lift (CSV).")
    ],
    tolerance: Annotated[
        str | None,
        typer.Option(help="Width of the tolerance zone, um; default: of the inspection sheet."),
    ] = None,
    keep_phase: Annotated[
        bool, typer.Option("--keep-phase", help="Keep the measured angle to the keyway in the run.")
    ] = False,
    jobs: Annotated[
        int | None, typer.Option(help="Number of processes of the certificate.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder to write; default: inspection/ of DIR."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the record as JSON.")] = False,
) -> int:
    """Check a measured cam against its drawing.

    Fits the measured points, or the surface below a measured lift, to the contour, solves the
    measured cam and checks it. Exit code 0: PASS, 1: FAIL, 2: error, 3: INCOMPLETE (data are
    missing), 4: the run is not as recorded.
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.results.drawn_cam import drawn_cam
    from camwright.pipeline.results.folder_exchange import amended, settle_recorded
    from camwright.pipeline.studies import cam_inspection
    from camwright.reports.comparisons.inspection_pictures import draw

    width = None if tolerance is None else units.parse(tolerance, "um", "--tolerance")
    if width is not None and not width > 0:
        raise InputError("--tolerance", tolerance, "> 0 um")
    settle_recorded(folder)
    case, contour = drawn_cam(folder)
    points = cam_inspection.read_measured(measured, contour)
    band = case.workshop_order.tolerance if width is None else width
    target = folder / cam_inspection.FOLDER if out is None else out
    writing = amended(folder) if out is None else nullcontext(folder)
    with progress_shown() as progress, writing as place:
        part = cam_inspection.inspect_part(
            case, contour, points, keep_phase=keep_phase, jobs=jobs, progress=progress
        )
        progress.stage("pictures")
        files = place / target.relative_to(folder) if out is None else out
        record = cam_inspection.write_inspection(folder, part, band, files)
        picture = draw(folder, units.in_unit(band, "um"), files)
    if as_json:
        show_json(record)
    else:
        for line in cam_inspection.lines(record):
            stdout.print(line, markup=False)
        stdout.print(f"deviations: {target / picture.name}", markup=False)
    return EXIT_CODE[record["verdict"]]

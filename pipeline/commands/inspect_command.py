"""A measured cam against its drawing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import (
    FAILED,
    PASSED,
    DirArgument,
    progress_shown,
    show_json,
    stdout,
)


def inspect(
    folder: DirArgument,
    measured: Annotated[
        Path, typer.Argument(metavar="MEASURED", help="Measured surface points (CSV).")
    ],
    tolerance: Annotated[
        str | None,
        typer.Option(help="Full width of the band of the form; that of the inspection sheet."),
    ] = None,
    keep_phase: Annotated[
        bool, typer.Option("--keep-phase", help="Angles are the keyway's: run it turned.")
    ] = False,
    jobs: Annotated[int | None, typer.Option(help="Processes for the certificate.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The record as JSON.")] = False,
) -> int:
    """Fit a measured cam to its drawing and judge the real part: exit 0 passed, 1 failed."""
    from camwright.pipeline.base import units
    from camwright.pipeline.results.run_folder import drawn_cam
    from camwright.pipeline.studies import cam_inspection
    from camwright.reports.inspection_pictures import draw

    band_given = None if tolerance is None else units.parse(tolerance, "um", "--tolerance")
    if band_given is not None and not band_given > 0:
        raise InputError("--tolerance", tolerance, "> 0 um")
    points = cam_inspection.read_measured(measured)
    case, contour = drawn_cam(folder)
    band = case.workshop_order.tolerance if band_given is None else band_given
    with progress_shown() as progress:
        part = cam_inspection.inspect_part(
            case, contour, points, keep_phase=keep_phase, jobs=jobs, progress=progress
        )
    record = cam_inspection.write_inspection(folder, part, band)
    picture = draw(folder, units.in_unit(band, "um"))
    if as_json:
        show_json(record)
    else:
        for line in cam_inspection.lines(record):
            stdout.print(line, markup=False)
        stdout.print(f"deviations: {picture}", markup=False)
    return PASSED if record["verdict"] == "pass" else FAILED

"""Command `inspect`: a measured cam against its drawing."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    EXIT_CODE,
    JobsOption,
    JsonOption,
    RunArgument,
    progress_shown,
    show_json,
    stdout,
)


def inspect(
    folder: RunArgument,
    measured: Annotated[Path, Words("Measured surface points or lift (CSV).", "CSV")],
    *,
    tolerance: Annotated[
        str | None,
        Words("Width of the tolerance zone, um; default: of the inspection sheet.", "WIDTH"),
    ] = None,
    track: Annotated[
        str | None,
        Words(
            "Measured wall of a groove, inner or outer, or disc of a pair, first or second;"
            " default: the first of these.",
            "TRACK",
        ),
    ] = None,
    keep_phase: Annotated[bool, Words("Keep the measured angle to the keyway in the run.")] = False,
    jobs: JobsOption = None,
    out: Annotated[
        Path | None, Words("Folder to write; default: inspection/ of the run.", "DIR")
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Check a measured cam against the drawing of its run.

    Fits the measured points, or the surface below a measured lift, to the contour, solves the
    measured cam and checks it.

    Example: camwright inspect runs/pump measured.csv --tolerance "20 um"
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.results.drawn_cam import drawn_cam
    from camwright.pipeline.results.folder_exchange import amended, settle_recorded
    from camwright.pipeline.results.workshop_files import measured_surface
    from camwright.pipeline.studies import cam_inspection
    from camwright.reports.comparisons.inspection_pictures import draw

    width = None if tolerance is None else units.parse_or_bare(tolerance, "um", "--tolerance")
    if width is not None and not width > 0:
        raise InputError("--tolerance", tolerance, "> 0 um")
    settle_recorded(folder)
    case, contour = drawn_cam(folder)
    surface = measured_surface(case, contour, track)
    points = cam_inspection.read_measured(measured, surface)
    band = case.workshop_order.tolerance if width is None else width
    target = folder / cam_inspection.FOLDER if out is None else out
    writing = amended(folder) if out is None else nullcontext(folder)
    with progress_shown() as progress, writing as place:
        part = cam_inspection.inspect_part(
            case,
            contour,
            points,
            track=track,
            keep_phase=keep_phase,
            jobs=jobs,
            progress=progress,
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

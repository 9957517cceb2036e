"""Command `size`: base radius, offset, roller, face and spring that a case leaves open."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.commands.terminal import (
    EXIT_CODE,
    CaseArgument,
    progress_shown,
    show_json,
    stdout,
)

_PICTURES = (".png", ".svg")


def size(
    case: CaseArgument,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free",
            metavar="KEY",
            help="A key whose value in CASE is not kept but found; may be repeated.",
        ),
    ] = None,
    least_radius: Annotated[
        str,
        typer.Option("--least-radius", help="Least convex radius of the contour, mm."),
    ] = "0 mm",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="SIZED.toml", help="Write the complete case.")
    ] = None,
    chart: Annotated[
        Path | None,
        typer.Option(
            "--chart",
            metavar="FILE",
            help="Chart as .png or .svg; default with --out: beside it, .png.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the record as JSON.")] = False,
) -> int:
    """Size a cam: smallest base radius, its offset, roller, face and spring within the limits.

    CASE may leave out cam.prime_radius, cam.offset, roller.radius, follower.face.width, spring.rate
    and spring.preload; those left out are found, the others kept. Exit code 0: the checks that they
    decide pass in the preview, 1: no size passes, 2: error, 3: data are missing.
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.search.sizes.size_record import size_lines, size_record
    from camwright.pipeline.search.sizes.sizing import size as sizes
    from camwright.reports.figure_svg import write_figure

    if chart is not None and chart.suffix not in _PICTURES:
        raise InputError("--chart", str(chart), f"a file that ends in {' or '.join(_PICTURES)}")
    if out is not None and out.exists():
        raise ResultError(f"{out}: exists already, not overwritten")
    least = units.parse(least_radius, "mm", "--least-radius")
    if not least >= 0.0:
        raise InputError("--least-radius", least_radius, ">= 0 mm")
    with progress_shown() as progress:
        sizing = sizes(case, free or (), least_radius=least, progress=progress)
    record = size_record(sizing)
    if as_json:
        show_json(record)
    else:
        for line in size_lines(sizing):
            stdout.print(line, markup=False)
    picture = chart or (None if out is None else out.with_suffix(".png"))
    if out is not None:
        sizing.opened.write(sizing.text, out)
    if picture is not None:
        write_figure(sizing.figure, picture)
    if not as_json:
        for words, path in (("case", out), ("chart", picture)):
            if path is not None:
                stdout.print(f"{words}: {path}", markup=False)
        if out is not None:
            stdout.print(f"next: camwright run {out} --out runs/{out.stem}", markup=False)
    return EXIT_CODE[sizing.verdict]

"""Command `design sizes`: base radius, offset, roller, face and spring that a case leaves open."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    EXIT_CODE,
    CaseArgument,
    JsonOption,
    progress_shown,
    show_json,
    stdout,
)

_PICTURES = (".png", ".svg")


def sizes(
    case: CaseArgument,
    *,
    free: Annotated[
        list[str] | None, Words("A key whose value in CASE is not kept but found.", "KEY")
    ] = None,
    least_radius: Annotated[
        str, Words("Least convex radius of the contour, mm; default: 0 mm.", "RADIUS")
    ] = "0 mm",
    out: Annotated[Path | None, Words("Complete case to write.", "CASE")] = None,
    chart: Annotated[
        Path | None, Words("Chart as .png or .svg; default with --out: beside it, .png.")
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Find base radius, offset, roller, face and spring that a case leaves open.

    CASE may leave out cam.prime_radius, cam.offset, roller.radius, follower.face.width, spring.rate
    and spring.preload, of an arm follower.arm.centre_distance and of a pair of discs
    cam.conjugate.distance or arm_angle, and roller_radius; those left out are found, as small as
    the limits allow, the others kept. The exit code is that of the checks that they decide, in the
    preview.

    Example: camwright design sizes feed.toml --free cam.prime_radius --out feed_sized.toml
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.search.sizes.size_record import size_lines, size_record
    from camwright.pipeline.search.sizes.sizing import size
    from camwright.reports.figure_svg import write_figure

    if chart is not None and chart.suffix not in _PICTURES:
        raise InputError("--chart", str(chart), f"a file that ends in {' or '.join(_PICTURES)}")
    if out is not None and out.exists():
        raise ResultError(f"{out}: exists already, not overwritten")
    least = units.parse_or_bare(least_radius, "mm", "--least-radius")
    if not least >= 0.0:
        raise InputError("--least-radius", least_radius, ">= 0 mm")
    with progress_shown() as progress:
        sizing = size(case, free or (), least_radius=least, progress=progress)
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

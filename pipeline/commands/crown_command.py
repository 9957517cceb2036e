"""Command `crown`: the crown that keeps the axial pressure of a case within a ratio."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.commands.terminal import (
    PASSED,
    CaseArgument,
    progress_shown,
    show_json,
    stdout,
)

_OPTIONS = ("ratio", "on", "kind", "tolerance")


def crown(
    case: CaseArgument,
    ratio: Annotated[
        float,
        typer.Option(help="Greatest axial pressure over the greatest of plane strain."),
    ] = 1.1,
    on: Annotated[
        str | None, typer.Option(help="Body to crown: cam, roller or face; default: the follower.")
    ] = None,
    kind: Annotated[
        str,
        typer.Option(
            help="johns-gohar, lundberg, circular, or table: relief of the ends, straight between."
        ),
    ] = "johns-gohar",
    tolerance: Annotated[
        str, typer.Option(help="Tolerance of the drop at the ends, um, for the sensitivity.")
    ] = "2 um",
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Write case text, drop table, record and picture."
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the record as JSON.")] = False,
) -> int:
    """Find the crown in the middle of those that keep the axial pressure within a ratio.

    Over all load cases and cam angles, aligned and at the greatest tilt of each. The crown is
    printed as TOML to be pasted into CASE, with its cost at the centre and in life, and with the
    pressure at other tilts and at the tolerance of the drop. An impossible ratio is refused with
    the least that can be reached.
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.search.crown import crown_design
    from camwright.pipeline.search.crown.crown_record import crown_lines, crown_record
    from camwright.reports.figure_svg import png_of

    if out is not None and out.exists() and any(out.iterdir()):
        raise ResultError(f"{out}: exists already and is not empty, not overwritten")
    deviation = units.parse(tolerance, "um", "--tolerance")
    try:
        with progress_shown() as progress:
            design = crown_design.crown(
                read_case(case), ratio, on=on, kind=kind.replace("-", "_"), tolerance=deviation,
                progress=progress,
            )  # fmt: skip
    except InputError as error:
        if error.field not in _OPTIONS:
            raise
        limit = error.limit.replace("_", "-") if error.field == "kind" else error.limit
        value = kind if error.field == "kind" else error.value
        raise InputError(f"--{error.field}", value, limit) from None
    record = crown_record(design)
    if as_json:
        show_json(record)
    else:
        for line in crown_lines(design):
            stdout.print(line, markup=False)
        stdout.print(f"\n{design.text}", markup=False)
    if out is not None:
        write_atomic(out / crown_design.CASE_TEXT, design.text)
        write_atomic(out / crown_design.DROP_TABLE, design.drop_table)
        write_atomic(out / "crown.json", json_text(record) + "\n")
        picture = write_atomic(out / "crown.png", png_of(design.figure))
        if not as_json:
            stdout.print(f"case text, drop table, record: {out}\npicture: {picture}", markup=False)
    return PASSED

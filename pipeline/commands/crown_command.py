"""Command `design crown`: the crown that keeps the axial pressure of a case within a ratio."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import ResultError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    FAILED,
    PASSED,
    CaseArgument,
    JsonOption,
    progress_shown,
    say,
    show_json,
    stdout,
)


@dataclass(frozen=True)
class CrownOptions:
    """Options of a crown, as of `cw.crown`."""

    ratio: float = 1.1
    """Greatest axial pressure over the greatest of plane strain; default: 1.1."""
    on: str | None = None
    """Body to crown: cam, roller or face; default: the follower."""
    kind: str = "johns_gohar"
    """johns_gohar, lundberg, circular, or table: relief of the ends, straight between; default:
    johns_gohar."""
    tolerance: str = "2 um"
    """Tolerance of the drop at the ends, for the sensitivity; default: 2 um."""


def crown(
    case: CaseArgument,
    *,
    options: CrownOptions,
    out: Annotated[
        Path | None, Words("Folder for case text, drop table, record and picture.", "DIR")
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Find the crown in the middle of those that keep the axial pressure within a ratio.

    Over all load cases and cam angles, aligned and at the greatest tilt of each. The crown is
    printed as TOML to be pasted into CASE, with its cost at the centre and in life, and with the
    pressure at other tilts and at the tolerance of the drop. Where no crown keeps the ratio, the
    least that can be reached is named, with exit code 1.

    Example: camwright design crown pump.toml --ratio 1.3 --kind circular --out pump_crown
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.base.files import json_text, write_atomic
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.search.crown import crown_design
    from camwright.pipeline.search.crown.crown_record import crown_lines, crown_record
    from camwright.pipeline.search.crown.least_crown import NoCrownError
    from camwright.reports.figure_svg import png_of

    if out is not None and out.exists() and any(out.iterdir()):
        raise ResultError(f"{out}: exists already and is not empty, not overwritten")
    deviation = units.parse(options.tolerance, "um", "tolerance")
    try:
        with progress_shown() as progress:
            design = crown_design.crown(
                read_case(case), options.ratio, on=options.on, kind=options.kind.replace("-", "_"),
                tolerance=deviation, progress=progress,
            )  # fmt: skip
    except NoCrownError as error:
        say(str(error))
        return FAILED
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

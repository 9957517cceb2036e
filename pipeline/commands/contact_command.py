"""Commands `contact cylinders` and `contact deck`: a contact here, or for another solver."""

from __future__ import annotations

import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    PASSED,
    JsonOption,
    NoCacheOption,
    RunArgument,
    progress_shown,
    show_json,
    stdout,
    use_cache,
)
from camwright.pipeline.studies.finite_length_document import LengthOptions
from camwright.pipeline.studies.two_cylinders_document import ContactOptions, lines, solved


def cylinders(
    *,
    options: ContactOptions,
    lengths: LengthOptions,
    approach: Annotated[bool, Words("Compute the approach of the centres.")] = False,
    field: Annotated[
        Path | None,
        Words(
            "Write the stress of both bodies; with lengths, the pressure on the contact.",
            "FILE.vtu",
        ),
    ] = None,
    as_json: JsonOption = False,
    no_cache: NoCacheOption = False,
) -> int:
    """Solve the line contact of two cylinders.

    By Hertz and by finite elements with an error bar; with lengths, the pressure along the line
    over that of plane strain, too. Quantities may have a unit, such as "12.5 mm", "210 GPa",
    "80 kN/m".

    Example: camwright contact cylinders --r1 20 --r2 "60 mm" --e1 "210 GPa" --nu1 0.3
    --line-load "200 N/mm"
    """
    use_cache(not no_cache)
    with progress_shown() as progress:
        progress.stage("contact")
        document = solved(replace(options, lengths=lengths), with_approach=approach, field=field)
    if as_json:
        show_json(document)
    else:
        for line in lines(document):
            stdout.print(line, markup=False)
    return PASSED


def deck(
    folder: RunArgument,
    *,
    angle: Annotated[str, Words("Cam angle, deg.", "ANGLE")],
    load_case: Annotated[
        str | None, Words("Name of the load case; default: the first.", "NAME")
    ] = None,
    contact: Annotated[bool, Words("Write a contact pair, which CalculiX solves itself.")] = False,
    out: Annotated[
        Path | None, Words("File of the deck; default: in exports/ of the run.", "FILE.inp")
    ] = None,
) -> int:
    """Write both bodies at one cam angle as an input deck.

    With the contact pressure of the run as nodal forces, for CalculiX and Abaqus; with --contact
    as a contact pair of which CalculiX finds the pressure.

    Example: camwright contact deck runs/pump --angle 75
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.results import contact_deck as decks
    from camwright.pipeline.results.folder_exchange import amended, settle_recorded

    text = units.with_unit(angle, "deg")
    theta = units.parse(text, "deg", "--angle")
    if not 0.0 <= theta <= math.tau:
        raise InputError("--angle", units.rounded(text), ">= 0 and <= 360 deg, one cam turn")
    kind = "contact" if contact else "loads"
    default = folder / "exports" / f"{kind}_{units.in_unit(theta, 'deg'):07.3f}.inp"
    target = default if out is None else out
    settle_recorded(folder)
    with amended(folder) if out is None else nullcontext(folder) as place:
        path = place / target.relative_to(folder) if out is None else out
        path.parent.mkdir(parents=True, exist_ok=True)
        solved = decks.deck(folder, theta, path, load_case, contact=contact)
    p0 = units.shown(solved.solution.p0, "MPa", 5)
    stdout.print(f"deck: {target} (peak pressure {p0})", markup=False)
    return PASSED

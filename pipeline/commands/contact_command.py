"""Commands `contact` (two cylinders) and `deck` (contact of a run for another solver)."""

from __future__ import annotations

import math
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import (
    PASSED,
    DirArgument,
    NoCacheOption,
    progress_shown,
    show_json,
    stdout,
    use_cache,
)


def contact(
    r1: Annotated[str, typer.Option(help="Radius of body 1, mm; inf: flat, negative: concave.")],
    r2: Annotated[str, typer.Option(help="Radius of body 2, mm.")],
    e1: Annotated[str, typer.Option(help='Young\'s modulus of body 1, such as "210 GPa".')],
    nu1: Annotated[float, typer.Option(help="Poisson ratio of body 1.")],
    e2: Annotated[
        str | None, typer.Option(help="Young's modulus of body 2; default: of body 1.")
    ] = None,
    nu2: Annotated[
        float | None, typer.Option(help="Poisson ratio of body 2; default: of body 1.")
    ] = None,
    line_load: Annotated[str | None, typer.Option(help="Line load, N/mm.")] = None,
    load: Annotated[str | None, typer.Option(help="Normal force, N; needs --width.")] = None,
    width: Annotated[str | None, typer.Option(help="Width of the contact, mm.")] = None,
    friction: Annotated[float, typer.Option(help="Friction coefficient of full sliding.")] = 0.0,
    approach: Annotated[
        bool, typer.Option("--approach", help="Compute the approach of the centres.")
    ] = False,
    depth1: Annotated[
        str | None, typer.Option(help="Depth of the reference point in body 1, mm.")
    ] = None,
    depth2: Annotated[
        str | None, typer.Option(help="Depth of the reference point in body 2, mm.")
    ] = None,
    length1: Annotated[str | None, typer.Option(help="Length of body 1, mm.")] = None,
    length2: Annotated[str | None, typer.Option(help="Length of body 2, mm.")] = None,
    end1: Annotated[
        str | None, typer.Option(help="Ends of body 1: sharp, chamfer:0.3, radius:0.3 (mm).")
    ] = None,
    end2: Annotated[str | None, typer.Option(help="Ends of body 2.")] = None,
    crown: Annotated[
        str | None,
        typer.Option(
            help='johns-gohar:"200 N/mm", lundberg:"200 N/mm", iso16281, circular:500 or a '
            "CSV file of y_mm and drop_um."
        ),
    ] = None,
    tilt: Annotated[
        str | None, typer.Option(help="Tilt of the bases, mrad; closes the gap at y > 0.")
    ] = None,
    moment: Annotated[
        str | None, typer.Option(help="Moment about the middle, N mm, instead of the tilt.")
    ] = None,
    mean_length: Annotated[
        str | None, typer.Option(help="Length of the mean pressure at the ends, mm; 0.1.")
    ] = None,
    field: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.vtu",
            help="Write the stress of both bodies; with lengths, the pressure on the contact.",
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
    no_cache: NoCacheOption = False,
) -> int:
    """Solve the line contact of two cylinders.

    By Hertz and by finite elements with an error bar; with lengths, the pressure along the line
    over that of plane strain, too. Quantities may have a unit, such as "12.5 mm", "210 GPa",
    "80 kN/m".
    """
    from camwright.pipeline.studies.finite_length_document import LengthOptions
    from camwright.pipeline.studies.two_cylinders_document import ContactOptions, lines, solved

    use_cache(not no_cache)
    lengths = LengthOptions(length1, length2, end1, end2, crown, tilt, moment, mean_length)
    options = ContactOptions(
        r1, r2, e1, e2, nu1, nu2, line_load, load, width, friction, depth1, depth2, lengths
    )
    with progress_shown() as progress:
        progress.stage("contact")
        document = solved(options, with_approach=approach, field=field)
    if as_json:
        show_json(document)
    else:
        for line in lines(document):
            stdout.print(line, markup=False)
    return PASSED


def deck(
    folder: DirArgument,
    angle: Annotated[str, typer.Option(help="Cam angle, deg.")],
    load_case: Annotated[
        str | None, typer.Option("--load-case", help="Name of the load case; default: the first.")
    ] = None,
    contact: Annotated[
        bool, typer.Option("--contact", help="Write a contact pair, which CalculiX solves itself.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.inp", help="File of the deck.")
    ] = None,
) -> int:
    """Write both bodies at one cam angle as an input deck.

    With the contact pressure of the run as nodal forces, for CalculiX and Abaqus; with --contact
    as a contact pair of which CalculiX finds the pressure. Exit code 4: the run is not as recorded.
    """
    from camwright.pipeline.base import units
    from camwright.pipeline.results import contact_deck as decks
    from camwright.pipeline.results.folder_exchange import amended, settle_recorded

    text = angle if any(c.isalpha() or c == "°" for c in angle) else f"{angle} deg"
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

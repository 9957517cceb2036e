"""One contact by itself: two cylinders, or a run's at one angle for another code."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.pipeline.commands.terminal import (
    PASSED,
    DirArgument,
    NoCacheOption,
    show_json,
    stdout,
    use_cache,
)


def contact(
    r1: Annotated[str, typer.Option(help="Radius of body 1, mm; inf: flat, negative: hollow.")],
    r2: Annotated[str, typer.Option(help="Radius of body 2, likewise.")],
    e1: Annotated[str, typer.Option(help="Young's modulus of body 1, MPa.")],
    nu1: Annotated[float, typer.Option(help="Poisson ratio of body 1.")],
    e2: Annotated[str | None, typer.Option(help="Of body 2; that of body 1 by default.")] = None,
    nu2: Annotated[float | None, typer.Option(help="Of body 2; likewise.")] = None,
    line_load: Annotated[str | None, typer.Option(help="Load over width, N/mm.")] = None,
    load: Annotated[str | None, typer.Option(help="Load, N, with --width.")] = None,
    width: Annotated[str | None, typer.Option(help="Width of the contact, mm.")] = None,
    friction: Annotated[float, typer.Option(help="Of full sliding, over the pressure.")] = 0.0,
    approach: Annotated[bool, typer.Option("--approach", help="Of the centres as well.")] = False,
    depth1: Annotated[str | None, typer.Option(help="Approach of this depth, mm.")] = None,
    depth2: Annotated[str | None, typer.Option(help="Likewise, in body 2.")] = None,
    field: Annotated[
        Path | None, typer.Option(metavar="FILE.vtu", help="Write the stress of body 1.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The figures as JSON.")] = False,
    no_cache: NoCacheOption = False,
) -> int:
    """Two cylinders in line contact: Hertz beside finite elements with an error bar.

    Every quantity may carry a unit, such as "12.5 mm", "210 GPa", "80 kN/m".
    """
    from camwright.pipeline.studies.two_cylinders_document import Asked, lines, solved

    use_cache(not no_cache)
    options = Asked(r1, r2, e1, e2, nu1, nu2, line_load, load, width, friction, depth1, depth2)
    document = solved(options, with_approach=approach, field=field)
    if as_json:
        show_json(document)
    else:
        for line in lines(document):
            stdout.print(line, markup=False)
    return PASSED


def deck(
    folder: DirArgument,
    angle: Annotated[str, typer.Option(help="Cam angle, degrees unless it has a unit.")],
    load_case: Annotated[
        str | None, typer.Option("--load-case", help="The first by default.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.inp", help="Where the deck is to lie.")
    ] = None,
) -> int:
    """Write the contact at one angle as a CalculiX/Abaqus deck, to be solved by another code."""
    from camwright.pipeline.base import units
    from camwright.pipeline.results import contact_deck as decks

    text = angle if any(c.isalpha() or c == "°" for c in angle) else f"{angle} deg"
    theta = units.parse(text, "deg", "--angle")
    path = (
        folder / "exports" / f"contact_{units.in_unit(theta, 'deg'):07.3f}.inp"
        if out is None
        else out
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    solved = decks.deck(folder, theta, path, load_case)
    p0 = units.shown(solved.solution.p0, "MPa", 5)
    stdout.print(f"deck: {path} (peak pressure {p0})", markup=False)
    return PASSED

"""The parts of a report by name: what each writes, and which a report has unless told otherwise."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from camwright.geometry.errors import InputError, ResultError
from camwright.reports import figure_svg, page, pdf, picture_list, scene_page
from camwright.reports.report_data import FIGURES, Material, read_material


@dataclass(frozen=True)
class Part:
    """A part of a report.

    `write` writes its files into the run folder and names them; `asked` says that it is made
    only when asked for, as what takes long or needs a program that not everybody has.
    """

    name: str
    words: str
    write: Callable[[Material], Sequence[Path]]
    asked: bool = False


PARTS = (
    Part("figures", "the plots as PNG", figure_svg.write),
    Part("fields", "pictures of the stress at the worst angle",
         partial(picture_list.write_pictures, picture_list.stress_pictures)),
    Part("bushes", "picture of the pressure in the guides",
         partial(picture_list.write_pictures, picture_list.bush_pictures)),
    Part("envelope", "map of the greatest stress under the contour",
         partial(picture_list.write_pictures, picture_list.envelope_pictures)),
    Part("page", page.PAGE, page.write),
    Part("scene", f"{scene_page.FILE}, the cam in space", scene_page.write),
    Part("pdf", pdf.PDF, pdf.write, asked=True),
)  # fmt: skip


def chosen(names: Iterable[str] = ()) -> tuple[Part, ...]:
    """The parts of these names in the order they are made; without names, all but those to ask for.

    Raises
    ------
    InputError
        If a part is not known.
    """
    wanted, known = list(names), [part.name for part in PARTS]
    for name in wanted:
        if name not in known:
            listed = ", ".join(f"{part.name} ({part.words})" for part in PARTS)
            raise InputError("--only", name, f"one of {listed}")
    return tuple(part for part in PARTS if part.name in wanted or not (wanted or part.asked))


def build(folder: Path, parts: Iterable[Part] | None = None) -> dict[str, Sequence[Path]]:
    """Draw parts of a report again from the run folder alone; nothing is solved.

    Returns
    -------
    dict    the files written, by the name of the part

    Raises
    ------
    ResultError
        If the folder does not hold a finished run, or a file cannot be written.
    """
    material = read_material(Path(folder))
    try:
        (material.folder / FIGURES).mkdir(exist_ok=True)
        return {part.name: part.write(material) for part in (chosen() if parts is None else parts)}
    except OSError as error:
        raise ResultError(f"{folder}: {error.strerror or error}") from None

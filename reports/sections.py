"""Parts of a report by name, with the files that each writes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatch
from functools import partial
from pathlib import Path

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.spreadsheets import SUFFIX
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.pipeline.results.folder_exchange import amended, is_being_written, settle_recorded
from camwright.reports import (
    documents,
    figure_svg,
    motion_svg,
    page,
    picture_list,
    scene_page,
)
from camwright.reports.report_data import FIGURES, ReportMaterial, read_material


@dataclass(frozen=True)
class ReportPart:
    """Part of a report: name, files, writer.

    `write` writes the files of the part into the run folder and returns them; `files` is the
    pattern of their names. A part `on_request` is written only if its name is stated; those
    `as_png` are the pictures as files.
    """

    name: str
    words: str
    write: Callable[[ReportMaterial], Sequence[Path]]
    files: str
    on_request: bool = False
    as_png: bool = False


def _pictures(
    name: str, words: str, write: Callable[[ReportMaterial], Sequence[Path]]
) -> ReportPart:
    return ReportPart(
        name, f"{words} as PNG", write, f"{FIGURES}/*.png", on_request=True, as_png=True
    )


PARTS = (
    _pictures("figures", "figures", figure_svg.write),
    _pictures(
        "fields",
        "pictures of the stress fields",
        partial(picture_list.write_pictures, picture_list.stress_pictures),
    ),
    _pictures(
        "length",
        "picture of the pressure along the line of contact",
        partial(picture_list.write_pictures, picture_list.axial_pictures),
    ),
    _pictures(
        "guides",
        "picture of the guide pressure",
        partial(picture_list.write_pictures, picture_list.guide_pictures),
    ),
    _pictures(
        "pivot",
        "picture of the pressure in the bush of the pivot",
        partial(picture_list.write_pictures, picture_list.pivot_pictures),
    ),
    _pictures(
        "envelope",
        "maps of the maximum stress below the contour",
        partial(picture_list.write_pictures, picture_list.envelope_pictures),
    ),
    ReportPart(
        "scene", f"{scene_page.FILE}, interactive 3-D view", scene_page.write, scene_page.FILE
    ),
    ReportPart(
        "motion", f"{motion_svg.FILE}, one turn animated", motion_svg.write, motion_svg.FILE
    ),
    ReportPart(
        "sheet",
        f"{documents.SIGNOFF}, one page to sign",
        documents.write_signoff,
        documents.SIGNOFF,
    ),
    ReportPart(
        "drawing",
        f"{documents.DRAWING}, dimensioned drawing",
        documents.write_drawing,
        documents.DRAWING,
    ),
    ReportPart("tables", "tables as spreadsheets", documents.write_tables, f"*{SUFFIX}"),
    ReportPart("pdf", documents.PDF, documents.write_report, documents.PDF, on_request=True),
    ReportPart("page", page.PAGE, page.write, page.PAGE),  # last: it links to the others
)


def chosen(names: Iterable[str] = (), *, png: bool = False) -> tuple[ReportPart, ...]:
    """Parts of given names, in order; without names all that are not on request.

    Parameters
    ----------
    png : bool   the pictures as PNG files as well

    Raises
    ------
    InputError
        If a name is unknown.
    """
    selected, known = list(names), [part.name for part in PARTS]
    for name in selected:
        if name not in known:
            listed = ", ".join(f"{part.name} ({part.words})" for part in PARTS)
            raise InputError("--only", name, f"one of {listed}")
    return tuple(
        part
        for part in PARTS
        if part.name in selected or (png and part.as_png) or not (selected or part.on_request)
    )


@dataclass
class Ahead:
    """Report whose drawings begin in worker processes while the certificate is solved.

    A figure that the certificate changes, such as by another governing load case, is drawn again.
    """

    parts: Sequence[ReportPart]
    _begun: dict[str, PendingCall] = field(default_factory=dict)

    def begin(self, folder: Path, workers: Crew) -> None:
        """Begin the drawings of a run folder; nothing with a single process."""
        if workers.workers > 1:
            material = read_material(folder)
            self._begun |= picture_list.begun(material, workers)
            self._begun |= figure_svg.begun(material, workers)
            self._begun |= documents.begun(material, workers)

    def write(self, folder: Path) -> dict[str, Sequence[Path]]:
        """Write the parts; see `draw`."""
        return draw(folder, self.parts, self._begun)


def report(
    folder: Path, parts: Iterable[ReportPart] | None = None, progress: Progress = SILENT
) -> dict[str, Sequence[Path]]:
    """Write parts of the report of a run, all or none; nothing is solved.

    Of a finished run, or of one that `run_case` is writing.

    Returns
    -------
    dict    files by name of the part

    Raises
    ------
    AlteredError
        If the results of the run are not as recorded; nothing is written.
    ResultError
        If the folder does not hold a finished run, or a signed one, or if a file cannot be written.
    """
    folder = Path(folder)
    if not is_being_written(folder):
        settle_recorded(folder)
    return draw(folder, parts, progress=progress)


def draw(
    folder: Path,
    parts: Iterable[ReportPart] | None = None,
    ahead: Mapping[str, PendingCall] | None = None,
    progress: Progress = SILENT,
) -> dict[str, Sequence[Path]]:
    """Write parts of the report of a run, whose record may not be complete yet; returns the files
    by name of the part, see `report`.

    Parameters
    ----------
    parts : iterable or None   None: all that are not on request
    ahead : mapping            drawings begun before the run was complete

    Raises
    ------
    ResultError
        If the folder does not hold a run or a file cannot be written.
    """
    written: dict[str, Sequence[Path]] = {}
    try:
        selected = chosen() if parts is None else tuple(parts)
        with amended(folder) as place:
            material = replace(read_material(folder, ahead), folder=place)
            progress.stage("report")
            for k, part in enumerate(selected, 1):
                files = part.write(material)
                written[part.name] = [folder / file.relative_to(place) for file in files]
                progress.advance(k, len(selected))
        return written
    except OSError as error:
        raise ResultError(f"{folder}: {error.strerror or error}") from None


def redraw(folder: Path, names: Collection[str]) -> None:
    """Write again the parts of a report that contain files of given names; see `report`.

    Parts that are written only on request come last, as they are added to a run that has its page
    already.
    """
    wanted = [part for part in PARTS if any(fnmatch(name, part.files) for name in names)]
    for late in (False, True):
        if parts := [part for part in wanted if part.on_request is late]:
            draw(folder, parts)

"""PDF/A documents set by typst."""

from __future__ import annotations

import dataclasses
import json
import re
import shutil
import tempfile
import unicodedata
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import Json
from camwright.reports.drawing import drawing_svg
from camwright.reports.drawing.drawing_shapes import Drawing
from camwright.reports.figure_svg import COLOURS, Drawn
from camwright.reports.painting.matplotlib_import import import_matplotlib
from camwright.reports.picture_list import Picture
from camwright.reports.report_tables import isolated, plain

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Value: TypeAlias = "str | float | Sequence[Value] | DataclassInstance | None"

_TEMPLATES = Path(__file__).parent / "templates"
_LONG = 20  # characters of a word that may be broken
_LONG_WORD = re.compile(rf"(?<!\S)(?![0-9a-f]{{64}}\b)\S{{{_LONG},}}")  # except SHA-256
_MARKED = re.compile(r"[^./_,;-]*[./_,;-]+|[^./_,;-]+")
_BREAK = "\u200b"


def typeset(template: str, document: DataclassInstance) -> bytes:
    """PDF of a document by a template; equal documents give equal bytes.

    All text is passed as data, never as source, and typst can read no file but the templates and
    the pictures of the document. Fonts are those of the matplotlib package; system fonts are used
    only for characters that DejaVu Sans lacks.

    Parameters
    ----------
    template : str         file of the typst template
    document : dataclass   whose fields and properties the template reads

    Raises
    ------
    ResultError
        If typst cannot set the document.
    """
    import typst

    def compiled(words: str, folder: Path) -> bytes:
        return typst.compile(
            folder / template, root=folder, font_paths=[_fonts()],
            ignore_system_fonts=_drawable(words) == words, sys_inputs={"report": words},
            format="pdf", pdf_standards=["a-2a", "ua-1"], timestamp=0,
        )  # fmt: skip

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for source in _TEMPLATES.glob("*.typ"):
            shutil.copy(source, folder)
        record = {**_fields(document, folder), "colours": COLOURS}
        words = json.dumps(record, ensure_ascii=False, allow_nan=False)
        reason = ""
        for text in (words, _drawable(words)):  # PDF/A excludes private-use characters
            try:
                return compiled(text, folder)
            except typst.TypstError as error:
                reason = str(error)
        raise ResultError(f"typst: {reason}")


def _fields(value: DataclassInstance, folder: Path) -> Mapping[str, Json]:
    """Fields and properties of a part of the document as JSON, with pictures written to `folder`
    and drawings as SVG.
    """
    if isinstance(value, Drawn):
        figure = value.figure
        words = {"title": figure.title, "caption": figure.caption, "alt": figure.alt}
        return {name: _broken(text) for name, text in words.items()} | {"svg": plain(value.svg)}
    if isinstance(value, Drawing):
        width, height = value.size
        svg = drawing_svg.svg_of(value, COLOURS, "DejaVu Sans")
        return {"svg": plain(svg), "alt": _broken(value.alt), "width": width, "height": height}
    if isinstance(value, Picture):
        file = f"{value.name}.png" if value.png else ""
        if file:
            (folder / file).write_bytes(value.png)
        words = {"title": value.title, "caption": value.caption, "alt": value.alt}
        words["note"] = value.note
        return {name: _broken(text) for name, text in words.items()} | {"file": file}
    kind = type(value)
    names = [field.name for field in dataclasses.fields(value)]
    names += [name for name, member in vars(kind).items() if isinstance(member, property)]
    record = {name: _json(getattr(value, name), folder) for name in names}
    return {**record, "kind": getattr(kind, "kind", "")}


def _json(value: Value, folder: Path) -> Json:
    """Value as JSON: text with break opportunities, sequences and nested parts likewise; pictures
    are written to `folder`.
    """
    if isinstance(value, str):
        return _broken(value)
    if value is None or isinstance(value, (int, float)):
        return value
    if isinstance(value, Sequence):
        return [_json(item, folder) for item in value]
    return _fields(value, folder)


def _broken(text: str) -> str:
    """Text on one line, with break opportunities in long words, bidirectionally isolated."""
    line = re.sub(r"[ \t\r\n]+", " ", plain(text))
    return isolated(_LONG_WORD.sub(_parted, line))


def _parted(word: re.Match[str]) -> str:
    """A long word with break opportunities: behind its marks, else anywhere."""
    parts = _MARKED.findall(word.group())
    return _BREAK.join(part if len(part) < _LONG else _BREAK.join(part) for part in parts)


def _fonts() -> Path:
    """Folder of the fonts of the matplotlib package."""
    import_matplotlib()
    from matplotlib import get_data_path

    return Path(get_data_path()) / "fonts" / "ttf"


def _drawable(text: str) -> str:
    """Text with U+FFFD for the characters that DejaVu Sans lacks."""
    from matplotlib.ft2font import FT2Font

    known = FT2Font(_fonts() / "DejaVuSans.ttf").get_charmap()
    invisible = ("Cc", "Cf")
    return "".join(
        c
        if ord(c) in known or unicodedata.category(c) in invisible
        else "\N{REPLACEMENT CHARACTER}"
        for c in text
    )

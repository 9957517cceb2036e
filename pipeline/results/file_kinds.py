"""Files of a run: how each is compared when the run is computed again, and from what it follows."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import NamedTuple

from camwright.pipeline.results import signoff


class Kind(StrEnum):
    """How two files are compared."""

    TEXT = "byte by byte"
    TABLE = "numbers by column"
    RECORD = "entries"
    ARRAYS = "arrays"
    FIELD = "arrays of a field"
    GEOMETRY = "text and coordinates"
    SOLID = "entities of a solid"
    PAGE = "text, numbers and pictures"
    BOOK = "sheets"
    DOCUMENT = "bytes of a document"
    PICTURE = "pixels"


class Origin(StrEnum):
    """From what a file follows."""

    SOLVED = "case and lift"
    DRAWN = "the other files of the run"
    SEARCH = "the search for the lift, which is not repeated"
    ELSEWHERE = "what the run does not hold"
    RECORD = "the whole run"


class FileClass(NamedTuple):
    """A class of files: pattern of the name, with ``N`` for the number of the final trial."""

    pattern: str
    kind: Kind
    origin: Origin


_INNER = r"[^/]+"
CLASSES = (
    FileClass(r"case\.toml", Kind.TEXT, Origin.SOLVED),
    FileClass(rf"inputs/{_INNER}", Kind.TEXT, Origin.SOLVED),
    FileClass(r"1_(torque|speed)\.csv", Kind.TABLE, Origin.SOLVED),
    FileClass(r"corners\.json", Kind.RECORD, Origin.SOLVED),
    FileClass(r"trial_N/2_limits\.csv", Kind.TABLE, Origin.SEARCH),
    FileClass(r"trial_N/(2_lift|2_spline|3_contour|5_cycle|5_speed_sweep)\.csv",
              Kind.TABLE, Origin.SOLVED),
    FileClass(r"trial_N/4_mesh\.msh", Kind.GEOMETRY, Origin.SOLVED),
    FileClass(r"trial_N/5_(pressure|guides|length|envelope)\.npz", Kind.ARRAYS, Origin.SOLVED),
    FileClass(r"trial_N/(6_checks|trial)\.json", Kind.RECORD, Origin.RECORD),
    FileClass(rf"trial_(?!N/)\d+/{_INNER}", Kind.TEXT, Origin.SEARCH),
    FileClass(r"fields/(stress\.vtkhdf|ends\.vtu)", Kind.FIELD, Origin.SOLVED),
    FileClass(r"fields/turn\.npz", Kind.ARRAYS, Origin.SOLVED),
    FileClass(r"fields/view_stress\.py", Kind.TEXT, Origin.SOLVED),
    FileClass(r"workshop/(contour|cutter|inspection|crown_(cam|roller|face))\.csv",
              Kind.TABLE, Origin.SOLVED),
    FileClass(r"workshop/dimensions\.json", Kind.RECORD, Origin.SOLVED),
    FileClass(r"workshop/contour\.dxf", Kind.GEOMETRY, Origin.SOLVED),
    FileClass(r"workshop/cam\.step", Kind.SOLID, Origin.SOLVED),
    FileClass(r"8_report\.html|scene\.html", Kind.PAGE, Origin.DRAWN),
    FileClass(r"8_signoff\.pdf|8_report\.pdf|workshop/drawing\.pdf", Kind.DOCUMENT, Origin.DRAWN),
    FileClass(r"(workshop/(contour|inspection)|trial_N/5_cycle)\.xlsx", Kind.BOOK, Origin.DRAWN),
    FileClass(rf"figures/{_INNER}\.png", Kind.PICTURE, Origin.DRAWN),
    FileClass(rf"(inspection|exports)/{_INNER}", Kind.TEXT, Origin.ELSEWHERE),
    FileClass(r"run\.json", Kind.RECORD, Origin.RECORD),
    FileClass(re.escape(signoff.NAME), Kind.RECORD, Origin.RECORD),
    FileClass(re.escape(signoff.SIGNATURES), Kind.RECORD, Origin.RECORD),
)  # fmt: skip
"""Classes of the files of a run; every file that a command writes into one has exactly one."""


def classes_of(name: str, final_trial: int) -> tuple[FileClass, ...]:
    """Classes of the file of a relative name; one, or none of a file that no command writes."""
    return tuple(
        each for each in CLASSES if re.fullmatch(each.pattern.replace("N", str(final_trial)), name)
    )

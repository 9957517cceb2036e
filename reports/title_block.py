"""Title block of sign-off sheet and drawing, from the section ``[document]`` of a case."""

from __future__ import annotations

from collections.abc import Sequence

from camwright.reports.report_tables import Record, shortened

_ENTRIES = {
    "project": "Project",
    "part_number": "Part number",
    "revision": "Revision",
    "author": "Author",
    "date": "Date",
    "material": "Material",
}


def title_block(case: Record) -> Sequence[tuple[str, str]]:
    """Names and values of the entries; "" is a field to fill by hand."""
    stated = case.get("document", {})
    return [(words, shortened(str(stated.get(key, "")), 60)) for key, words in _ENTRIES.items()]

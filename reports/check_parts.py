"""Part of the mechanism that a check judges."""

from __future__ import annotations

from collections.abc import Mapping

from camwright.pipeline.base.files import Json
from camwright.pipeline.results.check_text import PAGES, page_of

EVIDENCE = "Evidence"
PARTS = (*filter(None, PAGES), EVIDENCE)
"""Parts in the order of the flow of force; evidence last."""


def part_of(check: Mapping[str, Json]) -> str:
    """Part of the mechanism that a check judges, one of `PARTS`."""
    return EVIDENCE if check["evidence"] else page_of(str(check["id"])) or EVIDENCE

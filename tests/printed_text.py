"""Glyphs of a PDF with their boxes, read by pdfminer; and where text lies on text."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from pdfminer.high_level import extract_pages
from pdfminer.layout import LTChar, LTContainer, LTPage
from scipy.spatial import cKDTree

POINT = 25.4 / 72.0  # mm


def pages(content: bytes | Path) -> list[LTPage]:
    """Pages of a PDF."""
    read = content.read_bytes() if isinstance(content, Path) else content
    return list(extract_pages(io.BytesIO(read), laparams=None))  # in the order of the file


def glyphs(page: LTContainer) -> list[LTChar]:
    """All visible characters of a page, in the order in which it draws them."""
    every = []
    for item in page:
        if isinstance(item, LTChar):
            every += [item] if item.get_text().strip("\u200b\xa0 ") else []
        elif isinstance(item, LTContainer):
            every += glyphs(item)
    return every


def words_on(page: LTContainer) -> str:
    """Text of a page without spaces and places to break a word."""
    return "".join(glyph.get_text() for glyph in glyphs(page)).replace("\u200b", "")


def covered(page: LTContainer) -> list[str]:
    """Pairs of glyphs whose cores overlap: the middle of the width, the lower half of the height.

    Neighbours of one word touch by their advance at most, lines of a paragraph by ascenders and
    descenders; a core is within its own.
    """
    every = glyphs(page)
    if not every:
        return []
    box = np.array([[g.x0, g.y0, g.x1, g.y1] for g in every])
    size = box[:, 2:] - box[:, :2]
    low, high = box[:, :2] + 0.25 * size, box[:, 2:] - 0.25 * size
    middle = 0.5 * (low + high)
    pairs = cKDTree(middle).query_pairs(
        float(np.hypot(*(high - low).T).max()), output_type="ndarray"
    )
    if not pairs.size:
        return []
    one, two = pairs.T
    deep = np.minimum(high[one], high[two]) - np.maximum(low[one], low[two])
    hit = (deep > 0.05).all(axis=1)
    return [f"{every[i].get_text()}{every[k].get_text()} at {middle[i].round()}"
            for i, k in pairs[hit]]  # fmt: skip

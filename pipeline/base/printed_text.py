"""Text safe for a terminal: no control characters, no overrides of writing direction."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable

_JOINING = "\n\t\u200c\u200d\u200e\u200f"  # line ends, joiners, marks of direction


def is_printed(character: str) -> bool:
    """Whether a character is printable, a line end, or a joiner or mark of a script."""
    return character.isprintable() or character in _JOINING


def with_escapes(text: str, escape: Callable[[str], str] = ascii) -> str:
    r"""Text with unprintable characters replaced by escapes such as ``\x1b``.

    Control characters move the cursor, colour the text or retitle the window of a terminal;
    overrides of the direction make a text read as another; lone surrogates, of a file name that is
    no UTF-8, cannot be written. Spaces of any width stay.

    Parameters
    ----------
    escape : callable   a character -> its escape in quotes, such as `json.dumps`
    """
    if text.isprintable():
        return text
    hidden = [c for c in set(text) if not is_printed(c) and unicodedata.category(c) != "Zs"]
    return text.translate({ord(c): escape(c)[1:-1] for c in hidden})

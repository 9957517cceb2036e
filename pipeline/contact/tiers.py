"""Depth of a solution: screening, preview, cycle or certified."""

from __future__ import annotations

from enum import IntEnum

from camwright.geometry.errors import InputError
from camwright.pipeline.records.forms import DEPTHS, Depth


class Tier(IntEnum):
    """Depth of a solution; each tier judges more checks than the one before.

    SCREENING: closed forms without tolerance corners, surge and temperature of the guides; of many
    designs at once by `screen_designs`. PREVIEW: closed forms, with them. CYCLE: contact by finite
    elements over the turn. CERTIFIED: the same with its certificate; it alone has a verdict.
    """

    SCREENING = 1
    PREVIEW = 2
    CYCLE = 3
    CERTIFIED = 4

    @property
    def word(self) -> Depth:
        """Name in records and on the command line, such as ``preview``."""
        return DEPTHS[self - 1]

    @classmethod
    def of(cls, word: str, field: str) -> Tier:
        """Tier of a word.

        Parameters
        ----------
        field : str   that states the word, for the message

        Raises
        ------
        InputError
            If no tier has this word.
        """
        for tier in cls:
            if tier.word == word:
                return tier
        raise InputError(field, word, f"one of: {', '.join(tier.word for tier in cls)}")

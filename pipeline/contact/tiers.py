"""Tiers of a solution, by what they cost."""

from __future__ import annotations

from enum import IntEnum


class Tier(IntEnum):
    """Depth of a solution: a preview is by closed forms, a sign-off by finite elements."""

    PREVIEW = 1
    FINITE_ELEMENTS = 2

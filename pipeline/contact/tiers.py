"""Tiers of a solution, by cost."""

from __future__ import annotations

from enum import IntEnum


class Tier(IntEnum):
    """Tier of a solution: preview by closed forms, sign-off by finite elements."""

    PREVIEW = 1
    FINITE_ELEMENTS = 2

"""Remedy of a failed check: the change in one line, with its side effects."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from camwright.pipeline.search.change import Change

WIDTH = 87
"""Columns of the line of a remedy: 100 less the indent and the word before it."""


@dataclass(frozen=True)
class Remedy:
    """Smallest single change of a case that turns a failed check to pass.

    Parameters
    ----------
    check : str       id of the check
    change : Change   empty: none comes near
    figure : str      rating of the card, or what the check needs, in words
    effects : tuple   what else changes, the gravest first
    cures : bool      the check passes with the change; False: it is the closest one
    """

    check: str
    change: Change
    figure: str = ""
    effects: tuple[str, ...] = ()
    cures: bool = True

    @property
    def text(self) -> str:
        """Change and side effects in at most `WIDTH` columns; effects as far as they fit."""
        change = str(self.change)
        change += f" ({self.figure})" if self.figure and change else ""
        if not self.cures:
            closest = f"; closest: {change}" if change else ""
            change = f"no single change cures it{closest}"
        return joined((change, *self.effects))


def joined(parts: Iterable[str]) -> str:
    """Parts joined in one line, as many as fit `WIDTH` columns; at least the first."""
    line, *rest = parts
    for part in rest:
        if len(line) + 2 + len(part) <= WIDTH:
            line += f"; {part}"
    return line

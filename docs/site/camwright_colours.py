"""Colours of code on the site: at least 4.5 to 1 on the background of either theme."""

from __future__ import annotations

from typing import ClassVar

from pygments.style import Style
from pygments.token import Comment, Generic, Keyword, Name, Number, Operator, String


def _styles(comment: str, word: str, text: str, number: str, name: str) -> dict:
    return {
        Comment: comment,
        Generic.Prompt: comment,
        Keyword: f"bold {word}",
        Name.Builtin: word,
        Name.Function: name,
        Name.Class: name,
        Name.Tag: name,
        Name.Attribute: name,
        Operator.Word: f"bold {word}",
        String: text,
        Number: number,
    }


class Light(Style):
    """On #f8f9fb."""

    background_color = "#f8f9fb"
    styles: ClassVar[dict] = _styles("#59616b", "#7a2f8a", "#00694d", "#9a3d00", "#005a8d")


class Dark(Style):
    """On #1c2026."""

    background_color = "#1c2026"
    styles: ClassVar[dict] = _styles("#a0a8b2", "#dba6e8", "#5fd3ab", "#ffb07a", "#7cc4f5")

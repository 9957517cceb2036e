"""Colours of the page: legible on their grounds, in the light theme and in the dark one.

WCAG 2.2: text at 4.5 to 1 (success criterion 1.4.3, level AA), what is drawn at 3 to 1 (1.4.11).
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from camwright.geometry.figures import SERIES
from camwright.reports import figure_svg, page

TEMPLATES = Path(page.__file__).parent / "templates"
CSS = (TEMPLATES / "report.css").read_text(encoding="utf-8")
TEXT, DRAWN = 4.5, 3.0
GROUNDS = ("page", "card")
ON_GROUNDS = ("ink", "muted", "link", "fail", "ok")
CURVES = (*SERIES, "ink", "muted", "fail")
PAIRS = [
    *((text, ground, TEXT) for text in ON_GROUNDS for ground in GROUNDS),
    ("ok", "ok-soft", TEXT), ("fail", "fail-soft", TEXT), ("warn", "warn-soft", TEXT),
    ("muted", "shade", TEXT), ("fail", "shade", TEXT),
    *((curve, ground, DRAWN) for curve in CURVES for ground in ("card", "shade")),
    ("ok", "grid", DRAWN), ("warn", "grid", DRAWN), ("fail", "grid", DRAWN), ("ink", "grid", DRAWN),
]  # fmt: skip


def themes() -> dict[str, dict[str, str]]:
    """Colours by name of both themes; the dark one takes over what it does not name."""
    light, dark = (
        dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", block))
        for block in re.findall(r":root \{(.*?)\}", CSS, re.DOTALL)
    )
    return {"light": light, "dark": light | dark}


def luminance(code: str) -> float:
    """Relative luminance of an sRGB colour, WCAG 2.2."""
    parts = [int(code[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def test_the_measure_is_that_of_the_guidelines() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)  # their own example


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize(("front", "ground", "least"), PAIRS)
def test_colours_stand_off_their_grounds(theme: str, front: str, ground: str, least: float) -> None:
    colours = themes()[theme]
    assert contrast(colours[front], colours[ground]) >= least


def test_both_themes_name_the_same_colours_and_the_drawings_know_them() -> None:
    light, dark = themes().values()
    assert set(light) == set(dark) >= set(figure_svg.COLOURS)
    assert {name: light[name] for name in figure_svg.COLOURS} == figure_svg.COLOURS

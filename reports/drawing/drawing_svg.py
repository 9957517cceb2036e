"""SVG of a line drawing; mm become user units, y points up."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.drawing.drawing_shapes import Arrow, Drawing, DrawnOutline, ShapeGroup, Text

_DASHES = {"dashed": (4.0, 2.5), "dashdot": (9.0, 2.0, 1.5, 2.0)}  # widths of the line


def svg_of(drawing: Drawing, colours: Mapping[str, str], font: str, attributes: str = "") -> str:
    """SVG text of a line drawing of the mechanism or the cam.

    Parameters
    ----------
    colours : mapping   a CSS colour by the name that the pens use
    font : str          font families
    attributes : str    of the root element, escaped
    """
    left, _, _, top = drawing.box
    box = " ".join(map(decimal, (left, -top, *drawing.size)))
    used = sorted(
        {s.colour for group in drawing.groups for s in group.shapes if isinstance(s, Arrow)}
    )
    heads = "".join(_head(name, colours[name]) for name in used)
    body = "\n".join(_group(group, colours) for group in drawing.groups)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" '
        f'font-family="{escape(font)}"{attributes and " " + attributes}>\n'
        f"<defs>{heads}</defs>\n{body}\n</svg>\n"
    )


def _head(name: str, colour: str) -> str:
    """Arrow head as a marker, sized by the width of the line."""
    return (
        f'<marker id="head-{name}" viewBox="0 0 3.4 3" refX="0" refY="1.5" markerWidth="3.4" '
        f'markerHeight="3" orient="auto"><path d="M0 0L3.4 1.5L0 3Z" fill="{colour}"/></marker>'
    )


def _group(group: ShapeGroup, colours: Mapping[str, str]) -> str:
    """SVG group of shapes with its pose as a transform; the stretch is applied to the shapes
    themselves.
    """
    pose = group.pose
    place = ""
    if pose.turn or any(pose.shift):
        x, y = pose.shift
        place = f' transform="{transform(pose.turn, x, y)}"'
    shapes = "\n".join(_shape(shape, pose.stretch, colours) for shape in group.shapes)
    return f'<g data-part="{group.name}"{place}>\n{shapes}\n</g>'


def transform(turn: float, x: float, y: float) -> str:
    """SVG transform of a pose; rotation in rad counter-clockwise, mm."""
    return f"translate({decimal(x)} {decimal(-y)}) rotate({decimal(-np.degrees(turn))})"


def _shape(shape: DrawnOutline | Arrow | Text, stretch: float, colours: Mapping[str, str]) -> str:
    if isinstance(shape, DrawnOutline):
        return _outline(shape, stretch, colours)
    return _arrow(shape, colours) if isinstance(shape, Arrow) else _text(shape, colours)


def _outline(shape: DrawnOutline, stretch: float, colours: Mapping[str, str]) -> str:
    """SVG path of an outline with its holes, in the colours that its pen names.

    Parameters
    ----------
    stretch : float     factor of the y coordinates
    colours : mapping   colour code by name
    """
    pen = shape.pen
    fill = colours[pen.fill] if pen.fill else "none"
    style = f'fill="{fill}"'
    if len(shape.lines) > 1 and shape.closed:
        style += ' fill-rule="evenodd"'
    if pen.stroke:
        style += f' stroke="{colours[pen.stroke]}" stroke-width="{decimal(pen.width)}"'
        style += ' stroke-linejoin="round"'
        if pen.dash in _DASHES:
            dashes = " ".join(decimal(part * max(pen.width, 0.3)) for part in _DASHES[pen.dash])
            style += f' stroke-dasharray="{dashes}"'
        elif not shape.closed:
            style += ' stroke-linecap="round"'
    path = "".join(line_path(line, stretch, shape.closed) for line in shape.lines)
    return f'<path d="{path}" {style}/>'


def line_path(points: Array, stretch: float, closed: bool) -> str:
    """Path data of a line (2, n), mm, stretched along y."""
    pairs = [f"{decimal(x)} {decimal(-stretch * y)}" for x, y in points.T]
    return f"M{'L'.join(pairs)}{'Z' if closed else ''}"


def _arrow(arrow: Arrow, colours: Mapping[str, str]) -> str:
    """SVG line up to the head, which the marker adds; hidden where the head is longer than the
    arrow.
    """
    tail, tip = np.array(arrow.tail), np.array(arrow.tip)
    length = float(np.hypot(*(tip - tail)))
    shown = length > arrow.head
    neck = tip - (tip - tail) * (arrow.head / length) if shown else tip
    hidden = "" if shown else ' visibility="hidden"'
    return (
        f'<line data-arrow="{arrow.name}" x1="{decimal(tail[0])}" y1="{decimal(-tail[1])}" '
        f'x2="{decimal(neck[0])}" y2="{decimal(-neck[1])}" stroke="{colours[arrow.colour]}" '
        f'stroke-width="{decimal(arrow.width)}" marker-end="url(#head-{arrow.colour})"{hidden}/>'
    )


def _text(text: Text, colours: Mapping[str, str]) -> str:
    """SVG text on its baseline; a changing value has its name as an attribute."""
    x, y = text.place
    weight = ' font-weight="bold"' if text.bold else ""
    name = f' data-value="{text.name}"' if text.name else ""
    return (
        f'<text{name} x="{decimal(x)}" y="{decimal(-y)}" font-size="{decimal(text.height)}" '
        f'text-anchor="{text.align}" fill="{colours[text.colour]}"{weight}>'
        f"{escape(text.words)}</text>"
    )


def decimal(value: float) -> str:
    """A number with at most three decimals."""
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text

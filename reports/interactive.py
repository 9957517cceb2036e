"""Figures as data for Plotly, which draws them in the page.

The library is part of the page, which therefore needs no network. Colours are names; the script of
the page replaces them by those of its theme.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.geometry.figures import AxisMark, Curve, Figure, HorizontalAxis, Look, Panel
from camwright.pipeline.base.files import Json
from camwright.reports.figure_layout import placed_limits, vertical_span
from camwright.reports.outline_figures import (
    X_AXIS,
    Y_AXIS,
    ContoursFigure,
    OutlineCurve,
    OutlineFigure,
    SheetFigure,
)

Spec = dict[str, Json]

_HERE = Path(__file__).parent
_SCRIPTS = (
    _HERE / "vendor" / "plotly-basic.min.js", _HERE / "templates" / "report.js",
    _HERE / "templates" / "report_controls.js", _HERE / "templates" / "live_preview.js",
)  # fmt: skip
_PANEL_PIXELS, _TOP_PIXELS, _LEGEND_PIXELS, _BOTTOM_PIXELS, _GAP_PIXELS = 165, 54, 24, 46, 14
_DIGITS, _BAND_DIGITS, _STROKE_PIXELS = 6, 3, 14
_DASHES = {"solid": "solid", "dashed": "dash", "dashdot": "dashdot"}
_LIMIT: Spec = {"color": "fail", "width": 1.2, "dash": "dash"}
_OWN_AXES = 10
"""Number of the first horizontal axis that a panel has for itself."""
_LOOKS: dict[Look, tuple[str, float, str, float, str]] = {
    "line": ("lines", 1.8, "solid", 5, "circle"),
    "dashed": ("lines", 1.8, "dash", 5, "circle"),
    "dotted": ("lines", 1.8, "dot", 5, "circle"),
    "thin": ("lines", 0.7, "solid", 5, "circle"),
    "fill": ("lines", 1.5, "solid", 5, "circle"),
    "band": ("lines", 0.0, "solid", 5, "circle"),
    "marked": ("lines+markers", 1.8, "solid", 5, "circle"),
    "spot": ("lines+markers", 1.8, "solid", 9, "circle"),
    "points": ("markers", 0.0, "solid", 3, "circle"),
    "given": ("markers", 0.0, "solid", 7, "diamond"),
}
"""Mode, width and dash of the line, size and symbol of the points by look."""
_MARKERS = {"dot": "circle", "cross": "cross-thin-open"}
_HOVER_ANGLE, _HOVER_CAM = " %{x:.1f}°", " · cam %{customdata:.1f}°"


@dataclass(frozen=True)
class Bundle:
    """Scripts of a page, their hashes for its content security policy, data of its figures."""

    scripts: tuple[Markup, ...]
    hashes: tuple[str, ...]
    data: Markup


def bundle(figures: Iterable[SheetFigure]) -> Bundle:
    """Scripts and data of figures."""
    specs = {figure.id: specification(figure) for figure in figures}
    return Bundle(
        *scripts(_SCRIPTS),
        Markup(script_safe_json(specs)),  # noqa: S704 - no "<" is left in it
    )


def scripts(sources: Iterable[Path]) -> tuple[tuple[Markup, ...], tuple[str, ...]]:
    """Scripts escaped for inclusion in a page, and their hashes."""
    safe = [
        source.read_text(encoding="utf-8")
        .replace("</script", "<\\/script")
        .replace("<!--", "<\\!--")
        for source in sources
    ]
    return tuple(Markup(source) for source in safe), tuple(map(_hash, safe))  # noqa: S704


def specification(figure: SheetFigure) -> Spec:
    """Traces and layout of a figure for Plotly, colours by name.

    A figure over the turn has one `x`, the angle of the machine's shaft, and one `cam` for all its
    traces, deg.
    """
    if isinstance(figure, (OutlineFigure, ContoursFigure)):
        return _outline(figure)
    return _panels(figure)


def script_safe_json(value: Json) -> str:
    """JSON for a script element, with <, > and & escaped."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _hash(source: str) -> str:
    digest = hashlib.sha256(source.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


class _Drawn(NamedTuple):
    """Traces, axes, shapes and annotations of the panels."""

    traces: list[Spec]
    axes: dict[str, Spec]
    shapes: list[Spec]
    notes: list[Spec]


def _panels(figure: Figure) -> Spec:
    """Plotly data and layout of a figure: panels one below the other; those without an axis of
    their own have one in common.
    """
    lines, axis, last = _Lines.of(figure), figure.axis, len(figure.panels)
    drawn = _Drawn([], {}, [], [])
    for number, domain in enumerate(lines.domains):
        _panel(figure, number, domain, drawn)
    for mark in axis.marks:
        _mark(mark, drawn)
    horizontal = _horizontal(axis, "y" if last == 1 else f"y{last}")
    drawn.axes["xaxis"] = horizontal
    spec: Spec = {"at": {"name": axis.quantity, "unit": axis.unit}}
    if axis.second is not None:
        shared = figure.panels[0].curves[0].x
        spec = {"x": _numbers(shared), "cam": _numbers(shared / axis.second.ratio)}
        name = axis.quantity.removesuffix(" angle")
        horizontal["unifiedhovertitle"] = {"text": name + _HOVER_ANGLE}
        drawn.axes["xaxis2"] = {
            "range": [0, axis.span[1] / axis.second.ratio], "dtick": axis.second.step,
            "title": {"text": axis.second.words}, "fixedrange": True, "overlaying": "x",
            "side": "top", "anchor": "y",
        }  # fmt: skip
        drawn.traces.append({"x": [0], "y": [None], "xaxis": "x2", "yaxis": "y", "type": "scatter",
                             "showlegend": False, "hoverinfo": "skip"})  # fmt: skip
    return spec | {"data": drawn.traces, "layout": {
        "height": lines.height, "shapes": drawn.shapes, "annotations": drawn.notes, **drawn.axes,
        "margin": {"l": 68, "r": 14, "t": lines.top, "b": _BOTTOM_PIXELS},
        "barmode": "group", "bargap": 0.2,
    }}  # fmt: skip


def _panel(figure: Figure, number: int, domain: tuple[float, float], drawn: _Drawn) -> None:
    """Add the traces, axes, limits and legend of a panel to the Plotly data of a figure.

    Parameters
    ----------
    number : int     of the panel in the figure, from the top
    domain : tuple   lower and upper end of its axes, shares of the figure's height
    drawn : _Drawn   data of the figure, extended in place
    """
    panel, end = figure.panels[number], "" if number == 0 else str(number + 1)
    axis, legend, top = figure.axis_of(panel), figure.legends[number], domain[1]
    across, up = "x" if panel.axis is None else f"x{number + _OWN_AXES}", f"y{end}"
    vertical: Spec = {"domain": list(domain), "fixedrange": True,
                      "title": {"text": html.escape(panel.words), "standoff": 8}}  # fmt: skip
    if panel.axis is not None:
        drawn.axes[f"xaxis{across[1:]}"] = _horizontal(axis, up)
        vertical["anchor"] = across
    if panel.kind == "bars":
        rows = len(panel.rows)
        vertical |= {"range": [rows - 0.45, -0.55], "tickvals": list(range(rows)),
                     "ticktext": list(map(html.escape, panel.rows))}  # fmt: skip
        for line in panel.limits:
            drawn.shapes.append({
                "type": "line", "xref": across, "x0": line.value, "x1": line.value, "y0": domain[0],
                "yref": "paper", "y1": top, "line": _LIMIT,
            })  # fmt: skip
            drawn.notes.append(_words(line.words(axis.unit), "fail", across, line.value)
                               | {"yref": "paper", "y": top, "yanchor": "bottom"})  # fmt: skip
    else:
        low, high = vertical_span(panel, axis.named)
        vertical["range"] = [low, high]
        below_names = axis.named and number == 0
        shapes, notes = _limits(panel, up, low, high, below_names=below_names)
        drawn.shapes.extend(shapes)
        drawn.notes.extend(notes)
    if panel.kind == "outline":
        vertical["scaleanchor"] = across
    drawn.axes[f"yaxis{end}"] = vertical
    if panel.title or panel.note:
        drawn.notes.append({
            "text": f"<b>{html.escape(panel.title)}</b> {html.escape(panel.note)}".strip(),
            "showarrow": False, "xref": "paper", "x": 0, "xanchor": "left", "yref": "paper",
            "y": top, "yanchor": "bottom",
        })  # fmt: skip
    common: Spec = {"xaxis": across, "yaxis": up}
    entry: Spec = {"showlegend": legend} | ({"legend": f"legend{end}"} if legend else {})
    if legend and number:
        drawn.axes[f"legend{end}"] = {"orientation": "h", "x": 0, "y": top, "yanchor": "bottom",
                                      "traceorder": "normal"}  # fmt: skip
    for curve in panel.curves:
        x = _numbers(curve.x)
        if axis.second is None:
            common |= {"x": x, "customdata": x}
        drawn.traces.extend(common | edge for edge in _ribbon(curve))
        # one curve of the figure shows the second axis
        first = axis.second and not any("hovertemplate" in trace for trace in drawn.traces)
        trace = _curve(curve, panel, axis, _HOVER_CAM if first else "")
        drawn.traces.append(common | trace | entry)
        if panel.kind != "bars":
            drawn.notes.extend(
                _words(note, "muted", across, at)
                | {"yref": up, "y": value, "yshift": 4, "yanchor": "bottom"}
                for note, at, value in zip(curve.notes, x, _numbers(curve.y), strict=False)
                if value is not None
            )


def _words(text: str, colour: str, axis: str, x: Json) -> Spec:
    """A text at a place of a horizontal axis."""
    return {"text": html.escape(text), "showarrow": False, "xref": axis, "x": x,
            "font": {"color": colour, "size": 10}}  # fmt: skip


def _horizontal(axis: HorizontalAxis, anchor: str) -> Spec:
    """A horizontal axis below the panel of a vertical one."""
    spec: Spec = {"range": list(axis.span), "fixedrange": True, "anchor": anchor,
                  "title": {"text": html.escape(axis.words)}}  # fmt: skip
    step = 1 if axis.counted else axis.step
    return spec if step is None else spec | {"dtick": step}


@dataclass(frozen=True)
class _Lines:
    """Height and top margin of a figure, pixels, and the vertical domain of each panel, 0 to 1."""

    height: int
    top: int
    domains: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, figure: Figure) -> _Lines:
        """Layout of the panels of a figure from top to bottom, with room for titles, legends and
        axes.
        """
        headings = [
            _LEGEND_PIXELS * (legend + bool(panel.title or panel.note))
            for legend, panel in zip(figure.legends, figure.panels, strict=True)
        ]
        feet = [_GAP_PIXELS if p.axis is None else _BOTTOM_PIXELS for p in figure.panels]
        gaps = [foot + heading for foot, heading in zip(feet, headings[1:], strict=False)]
        heights = [_PANEL_PIXELS * panel.height for panel in figure.panels]
        whole = sum(heights) + sum(gaps)
        edge, domains = whole, []
        for height, gap in zip(heights, [*gaps, 0], strict=True):
            domains.append((max(edge - height, 0.0) / whole, edge / whole))
            edge -= height + gap
        top = (_TOP_PIXELS if figure.axis.second else _GAP_PIXELS) + headings[0]
        return cls(round(whole) + top + _BOTTOM_PIXELS, top, tuple(domains))


def _limits(
    panel: Panel, axis: str, low: float, high: float, *, below_names: bool
) -> tuple[list[Spec], list[Spec]]:
    """Plotly shapes and annotations of the limits of a panel: lines, and labels beside them.

    The label of a limit outside the axis stands at its edge.

    Parameters
    ----------
    axis : str           id of the panel's y axis, such as ``y2``
    low, high : float    ends of this axis, in the unit of the panel
    below_names : bool   whether a label at the upper edge goes below the names of marks
    """
    placed = placed_limits(panel, low, high)
    shapes: list[Spec] = [
        {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "yref": axis, "y0": line.value,
         "y1": line.value, "line": _LIMIT}
        for line, _ in placed.inside
    ]  # fmt: skip
    # a limit outside the axes is written at the edge; the upper one may have names of marks
    words = [(line.words(panel.unit), line.value, above, 0) for line, above in placed.inside]
    for text, above in placed.beyond:
        shift = -_STROKE_PIXELS if above and below_names else 0
        words.append((text, high if above else low, not above, shift))
    notes: list[Spec] = [
        {"xref": "paper", "x": 1, "xanchor": "right", "yref": axis, "showarrow": False,
         "font": {"color": "fail", "size": 10}, "bgcolor": "card", "borderpad": 1, "y": value,
         "yanchor": "bottom" if above else "top", "text": html.escape(text), "yshift": shift}
        for text, value, above, shift in words
    ]  # fmt: skip
    return shapes, notes


def _mark(mark: AxisMark, drawn: _Drawn) -> None:
    """Add a mark of the horizontal axis to `drawn`: a shade or a dotted line over all panels, with
    its name at the top.
    """
    common: Spec = {"xref": "x", "x0": mark.start, "yref": "paper", "y0": 0, "y1": 1}
    name: Spec = {"yref": "paper", "y": 1, "yanchor": "top"}
    if mark.end is not None:
        if mark.shaded:
            drawn.shapes.append(common | {"type": "rect", "x1": mark.end, "fillcolor": "shade",
                                          "line": {"width": 0}, "layer": "below"})  # fmt: skip
        middle = 0.5 * (mark.start + mark.end)
        drawn.notes.append(_words(mark.name, "muted", "x", middle) | name)
        return
    dotted: Spec = {"color": "muted" if mark.name else "ink", "width": 1, "dash": "dot"}
    drawn.shapes.append(common | {"type": "line", "x1": mark.start, "line": dotted})
    if mark.name:
        aside: Spec = {"xanchor": "right", "textangle": -90, "bgcolor": "card"}
        drawn.notes.append(_words(mark.name, "muted", "x", mark.start) | name | aside)


def _curve(curve: Curve, panel: Panel, axis: HorizontalAxis, hover: str) -> Spec:
    """Plotly trace of a curve without its axes and x; `hover`: further words of the text at the
    pointer.
    """
    flat = panel.kind == "bars"
    along, quantity, unit = (
        ("x", axis.quantity, axis.unit) if flat else ("y", panel.quantity, panel.unit)
    )
    name, unit = html.escape(curve.label or quantity), html.escape(unit)
    spec: Spec = {
        "name": name, "y": _numbers(curve.y), "meta": unit,
        "hovertemplate": f"%{{{along}:.5g}} {unit}{hover}<extra>{name}</extra>",
    }  # fmt: skip
    if curve.look == "bar":
        bar: Spec = {"type": "bar", "marker": {"color": curve.colour}}
        if not flat:
            return spec | bar
        start, length = map(_numbers, curve.bars(axis.span[1]))
        return spec | bar | {"orientation": "h", "base": start, "x": length}
    mode, width, dash, size, symbol = _LOOKS[curve.look]
    fill: Spec = {"fill": "toself", "fillcolor": "steel"} if curve.look == "fill" else {}
    return spec | fill | {
        "type": "scatter", "mode": mode,
        "line": {"color": curve.colour, "width": width, "dash": dash},
        "marker": {"color": curve.colour, "size": size, "symbol": symbol},
    }  # fmt: skip


def _ribbon(curve: Curve) -> list[Spec]:
    """Plotly traces of lower and upper edge of the ribbon of a curve, the area between filled;
    empty without one.
    """
    if curve.upper is None or curve.look == "bar":
        return []
    edge: Spec = {"type": "scatter", "mode": "lines", "showlegend": False, "hoverinfo": "skip",
                  "line": {"width": 0, "color": curve.colour}}  # fmt: skip
    lower = curve.y if curve.lower is None else curve.lower
    below, above = (edge | {"y": _numbers(each, _BAND_DIGITS)} for each in (lower, curve.upper))
    return [below, above | {"fill": "tonexty", "fillcolor": curve.colour}]


def _outline(figure: OutlineFigure | ContoursFigure) -> Spec:
    reach = [-figure.reach, figure.reach]
    notes: list[Spec] = [
        {"text": text.words, "x": text.place[0], "y": text.place[1], "textangle": -text.turn,
         "showarrow": False, "yanchor": "bottom", "font": {"color": "ink", "size": 10}}
        for text in figure.texts
    ]  # fmt: skip
    return {"data": [_outline_curve(curve) for curve in figure.curves], "layout": {
        "height": 560, "shapes": [], "annotations": notes, "hovermode": "closest",
        "xaxis": {"title": {"text": X_AXIS}, "fixedrange": True, "range": reach,
                  "zeroline": False},
        "yaxis": {"title": {"text": Y_AXIS}, "fixedrange": True, "range": reach,
                  "scaleanchor": "x", "zeroline": False},
    }}  # fmt: skip


def _outline_curve(curve: OutlineCurve) -> Spec:
    """Plotly trace of a curve of an outline, points (2, n), mm, whose hover text has the cam angle,
    deg, where it is known.
    """
    x, y = curve.points
    hover: Spec = {"hoverinfo": "skip"}
    if curve.angle is not None:
        hover = {"customdata": _numbers(curve.angle),
                 "hovertemplate": "%{x:.4f}, %{y:.4f} mm (cam %{customdata:.1f}°)"}  # fmt: skip
    fill: Spec = {"fill": "toself", "fillcolor": curve.fill} if curve.fill else {}
    marker: Spec = {"mode": "lines"}
    if curve.marker:
        marker = {"mode": "markers", "marker": {"symbol": _MARKERS[curve.marker], "size": 6,
                                                "color": curve.colour}}  # fmt: skip
    return {
        "type": "scatter", "x": _numbers(x), "y": _numbers(y), "meta": "mm",
        "name": html.escape(curve.label), "showlegend": bool(curve.label),
        "line": {"color": curve.colour, "width": 1.3 * curve.width, "dash": _DASHES[curve.dash]},
        **hover, **fill, **marker,
    }  # fmt: skip


def _numbers(values: Array, digits: int = _DIGITS) -> list[float | None]:
    return [float(f"{v:.{digits}g}") if np.isfinite(v) else None for v in values.tolist()]

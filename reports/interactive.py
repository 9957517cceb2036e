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

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import Json
from camwright.reports.figures import (
    CAM_AXIS,
    CAM_STEP,
    X_AXIS,
    Y_AXIS,
    AngleFigure,
    ContoursFigure,
    Curve,
    Figure,
    LineFigure,
    OutlineCurve,
    OutlineFigure,
    Panel,
    closed,
    placed_limits,
    vertical_span,
)

Spec = dict[str, Json]

_HERE = Path(__file__).parent
_SCRIPTS = (
    _HERE / "vendor" / "plotly-basic.min.js", _HERE / "templates" / "report.js",
    _HERE / "templates" / "report_controls.js",
)  # fmt: skip
_PANEL_PIXELS, _TOP_PIXELS, _LEGEND_PIXELS, _BOTTOM_PIXELS, _GAP_PIXELS = 165, 54, 24, 46, 14
_DIGITS, _BAND_DIGITS, _STROKE_PIXELS = 6, 3, 14
_DASHES = {"solid": "solid", "dashed": "dash", "dashdot": "dashdot"}
_MARKERS = {"dot": "circle", "cross": "cross-thin-open"}
_HOVER_ANGLE, _HOVER_CAM = " %{x:.1f}°", " · cam %{customdata:.1f}°"


@dataclass(frozen=True)
class Bundle:
    """Scripts of a page, their hashes for its content security policy, data of its figures."""

    scripts: tuple[Markup, ...]
    hashes: tuple[str, ...]
    data: Markup


def bundle(figures: Iterable[Figure]) -> Bundle:
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


def specification(figure: Figure) -> Spec:
    """Traces and layout of a figure for Plotly, colours by name.

    A figure over the turn has one `x`, the angle of the machine's shaft, and one `cam` for all its
    traces, deg.
    """
    if isinstance(figure, (OutlineFigure, ContoursFigure)):
        return _outline(figure)
    return _angles(figure) if isinstance(figure, AngleFigure) else _sweep(figure)


def script_safe_json(value: Json) -> str:
    """JSON for a script element, with <, > and & escaped."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _hash(source: str) -> str:
    digest = hashlib.sha256(source.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _angles(figure: AngleFigure) -> Spec:
    lines = _Lines.of(figure)
    crank, cam = _numbers(figure.closed_crank), _numbers(figure.closed_crank / figure.gear_ratio)
    shapes, notes = _shades(figure), _mark_names(figure)
    traces: list[Spec] = []
    axes: dict[str, Spec] = {}
    for number, panel in enumerate(figure.panels):
        end = "" if number == 0 else str(number + 1)
        axis, (bottom, top) = f"y{end}", lines.domains[number]
        low, high = vertical_span(panel, bool(figure.marks))
        axes[f"yaxis{end}"] = {
            "domain": [bottom, top], "fixedrange": True, "range": [low, high],
            "title": {"text": html.escape(panel.title), "standoff": 8},
        }  # fmt: skip
        if figure.legends[number] and number:
            axes[f"legend{end}"] = {"orientation": "h", "x": 0, "y": top, "yanchor": "bottom",
                                    "traceorder": "normal"}  # fmt: skip
        legend = {"legend": f"legend{end}"} if figure.legends[number] else {}
        for curve in panel.curves:
            common = {"type": "scatter", "mode": "lines", "xaxis": "x", "yaxis": axis}
            traces += [common | band for band in _band(curve)]
            # one curve of the figure shows the cam angle
            hover = _HOVER_CAM if not any("hovertemplate" in trace for trace in traces) else ""
            traces.append(
                common | _curve(curve, panel, hover) | legend
                | {"showlegend": figure.legends[number]}
            )  # fmt: skip
        below_names = bool(figure.marks) and number == 0
        lines_of, notes_of = _limits(panel, axis, low, high, below_names=below_names)
        shapes, notes = shapes + lines_of, notes + notes_of
    traces.append({"x": [0], "y": [None], "xaxis": "x2", "yaxis": "y", "type": "scatter",
                   "showlegend": False, "hoverinfo": "skip"})  # fmt: skip
    last = len(figure.panels)
    return {"data": traces, "x": crank, "cam": cam, "layout": {
        "height": lines.height, "shapes": shapes, "annotations": notes, **axes,
        "margin": {"l": 68, "r": 14, "t": lines.top, "b": _BOTTOM_PIXELS},
        "xaxis": {"range": [0, figure.period], "dtick": figure.shaft_step, "fixedrange": True,
                  "title": {"text": figure.shaft_axis},
                  "unifiedhovertitle": {"text": figure.shaft + _HOVER_ANGLE},
                  "anchor": "y" if last == 1 else f"y{last}"},
        "xaxis2": {"range": [0, 360], "dtick": CAM_STEP, "title": {"text": CAM_AXIS},
                   "fixedrange": True, "overlaying": "x", "side": "top", "anchor": "y"},
    }}  # fmt: skip


def _sweep(figure: LineFigure) -> Spec:
    lines, x = _Lines.of(figure), _numbers(figure.x)
    shapes: list[Spec] = []
    notes: list[Spec] = []
    traces: list[Spec] = []
    axes: dict[str, Spec] = {}
    for number, panel in enumerate(figure.panels):
        end = "" if number == 0 else str(number + 1)
        axis, (bottom, top) = f"y{end}", lines.domains[number]
        low, high = vertical_span(panel, bool(figure.marks))
        axes[f"yaxis{end}"] = {
            "domain": [bottom, top], "fixedrange": True, "range": [low, high],
            "title": {"text": html.escape(panel.title), "standoff": 8},
        }  # fmt: skip
        if figure.legends[number] and number:
            axes[f"legend{end}"] = {"orientation": "h", "x": 0, "y": top, "yanchor": "bottom",
                                    "traceorder": "normal"}  # fmt: skip
        legend = {"legend": f"legend{end}"} if figure.legends[number] else {}
        for curve in panel.curves:
            kind = (
                {"type": "bar"}
                if figure.bars
                else {
                    "type": "scatter",
                    "mode": "lines+markers" if figure.dotted(curve) else "lines",
                }
            )
            trace: Spec = kind | legend | {"x": x, "xaxis": "x", "yaxis": axis, "customdata": x,
                     "marker": {"size": 5 if figure.dots else 9, "color": curve.colour},
                     "showlegend": figure.legends[number]}  # fmt: skip
            drawn = _curve(curve, panel, "") | {"y": _numbers(curve.values)}
            traces.append(
                trace | {k: v for k, v in drawn.items() if k != "line" or not figure.bars}
            )
            notes += [
                {"xref": "x", "x": at, "yref": axis, "y": value, "yshift": 4, "yanchor": "bottom",
                 "showarrow": False, "text": html.escape(note),
                 "font": {"color": "muted", "size": 10}}
                for note, at, value in zip(curve.notes, x, _numbers(curve.values), strict=False)
                if value is not None
            ]  # fmt: skip
        below_names = bool(figure.marks) and number == 0
        lines_of, notes_of = _limits(panel, axis, low, high, below_names=below_names)
        shapes, notes = shapes + lines_of, notes + notes_of
    shapes += [
        {"xref": "x", "yref": "paper", "y0": 0, "y1": 1, "type": "line", "x0": at, "x1": at,
         "line": {"color": "muted", "width": 1, "dash": "dot"}}
        for at, _ in figure.marks
    ]  # fmt: skip
    notes += [
        {"xref": "x", "x": at, "yref": "paper", "y": 1, "xanchor": "right", "yanchor": "top",
         "textangle": -90, "showarrow": False, "text": html.escape(name),
         "font": {"color": "muted", "size": 10}, "bgcolor": "card"}
        for at, name in figure.marks
    ]  # fmt: skip
    last = len(figure.panels)
    horizontal: Spec = {"range": list(figure.span), "fixedrange": True,
                        "title": {"text": html.escape(figure.axis)},
                        "anchor": "y" if last == 1 else f"y{last}"}  # fmt: skip
    if figure.whole:
        horizontal["dtick"] = 1
    return {"data": traces, "at": {"name": figure.quantity, "unit": figure.unit}, "layout": {
        "height": lines.height, "shapes": shapes, "annotations": notes, **axes,
        "margin": {"l": 68, "r": 14, "t": lines.top, "b": _BOTTOM_PIXELS}, "xaxis": horizontal,
        "barmode": "group", "bargap": 0.2,
    }}  # fmt: skip


@dataclass(frozen=True)
class _Lines:
    """Height and top margin of a figure, pixels, and the vertical domain of each panel, 0 to 1."""

    height: int
    top: int
    domains: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, figure: AngleFigure | LineFigure) -> _Lines:
        gaps = [_GAP_PIXELS + _LEGEND_PIXELS * legend for legend in figure.legends[1:]]
        heights = [_PANEL_PIXELS * panel.height for panel in figure.panels]
        whole = sum(heights) + sum(gaps)
        edge, domains = whole, []
        for height, gap in zip(heights, [*gaps, 0], strict=True):
            domains.append((max(edge - height, 0.0) / whole, edge / whole))
            edge -= height + gap
        axis = _TOP_PIXELS if isinstance(figure, AngleFigure) else _GAP_PIXELS
        top = axis + (_LEGEND_PIXELS if figure.legends[0] else 0)
        return cls(round(whole) + top + _BOTTOM_PIXELS, top, tuple(domains))


def _limits(
    panel: Panel, axis: str, low: float, high: float, *, below_names: bool
) -> tuple[list[Spec], list[Spec]]:
    """Lines and labels of the limits of a panel."""
    placed = placed_limits(panel, low, high)
    shapes: list[Spec] = [
        {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "yref": axis, "y0": line.value,
         "y1": line.value, "line": {"color": "fail", "width": 1.2, "dash": "dash"}}
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


def _mark_names(figure: AngleFigure) -> list[Spec]:
    """Names of the marks at the top of the first panel."""
    return [
        {"xref": "x", "x": 0.5 * (mark.start + mark.end), "yref": "paper", "y": 1, "yanchor": "top",
         "showarrow": False, "text": html.escape(mark.name), "font": {"color": "muted", "size": 10}}
        for mark in figure.marks
    ]  # fmt: skip


def _curve(curve: Curve, panel: Panel, hover: str) -> Spec:
    name, unit = html.escape(curve.label or panel.quantity), html.escape(panel.unit)
    return {
        "name": name, "y": _numbers(closed(curve.values)), "meta": unit,
        "line": {"color": curve.colour, "width": 1.8, "dash": "dash" if curve.dashed else "solid"},
        "hovertemplate": f"%{{y:.5g}} {unit}{hover}<extra>{name}</extra>",
    }  # fmt: skip


def _band(curve: Curve) -> list[Spec]:
    """Lower and upper edge of the ribbon of a curve."""
    if curve.band is None:
        return []
    edge: Spec = {"showlegend": False, "hoverinfo": "skip",
                  "line": {"width": 0, "color": curve.colour}}  # fmt: skip
    below, above = (edge | {"y": _numbers(closed(values), _BAND_DIGITS)} for values in curve.band)
    return [below, above | {"fill": "tonexty", "fillcolor": curve.colour}]


def _shades(figure: AngleFigure) -> list[Spec]:
    """Shaded marks and the dotted line of the worst angle."""
    common: Spec = {"xref": "x", "yref": "paper", "y0": 0, "y1": 1}
    shapes = [
        common | {"type": "rect", "x0": mark.start, "x1": mark.end, "fillcolor": "shade",
                  "line": {"width": 0}, "layer": "below"}
        for mark in figure.marks if mark.shaded
    ]  # fmt: skip
    if figure.mark is not None:
        dotted: Spec = {"color": "ink", "width": 1, "dash": "dot"}
        shapes.append(common | {"type": "line", "x0": figure.mark, "x1": figure.mark,
                                "line": dotted})  # fmt: skip
    return shapes


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

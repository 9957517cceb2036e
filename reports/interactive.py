"""The sheet's figures for an interactive library: plain values that Plotly draws in the page.

The library is bundled into the page, so that it opens without a network. Colours stay names here;
the page fills in those of its light or dark theme.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.reports.figures import (
    STROKES,
    AngleFigure,
    Curve,
    Figure,
    OutlineFigure,
    Panel,
    placed_limits,
    vertical_span,
)

_HERE = Path(__file__).parent
_SCRIPTS = (_HERE / "vendor" / "plotly-basic.min.js", _HERE / "templates" / "report.js")
_PANEL_PIXELS, _TOP_PIXELS, _LEGEND_PIXELS, _BOTTOM_PIXELS, _GAP_PIXELS = 165, 54, 24, 46, 14
_DIGITS, _STROKE_PIXELS = 6, 14
_HOVER_TITLE, _HOVER_CAM = "crank %{x:.1f}°", " · cam %{customdata:.1f}°"


@dataclass(frozen=True)
class Bundle:
    """What an interactive page carries: scripts, their hashes for its policy, the figures' data."""

    scripts: tuple[Markup, ...]
    hashes: tuple[str, ...]
    data: Markup


def bundle(figures: Iterable[Figure]) -> Bundle:
    """Scripts and data of some figures."""
    specs = {figure.id: specification(figure) for figure in figures}
    return Bundle(
        *scripts(_SCRIPTS),
        Markup(script_safe_json(specs)),  # noqa: S704 - no "<" is left in it
    )


def scripts(sources: Iterable[Path]) -> tuple[tuple[Markup, ...], tuple[str, ...]]:
    """Scripts that may stand in a page, the library's and our own, and their hashes."""
    safe = [
        source.read_text(encoding="utf-8")
        .replace("</script", "<\\/script")
        .replace("<!--", "<\\!--")
        for source in sources
    ]
    return tuple(Markup(source) for source in safe), tuple(map(_hash, safe))  # noqa: S704


def specification(figure: Figure) -> dict[str, Any]:
    """Traces and layout of a figure in Plotly's terms, colours by name."""
    return _angles(figure) if isinstance(figure, AngleFigure) else _outline(figure)


def script_safe_json(value: object) -> str:
    """JSON that may stand in a script element: nothing in it can end the element."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _hash(source: str) -> str:
    digest = hashlib.sha256(source.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _angles(figure: AngleFigure) -> dict[str, Any]:
    turn = 360.0 * figure.gear_ratio
    crank = np.append(figure.crank, turn + figure.crank[0])
    cam = _numbers(crank / figure.gear_ratio)
    lines = _Lines.of(figure)
    traces: list[dict[str, Any]] = []
    layout: dict[str, Any] = {
        "height": lines.height,
        "margin": {"l": 68, "r": 14, "t": lines.top, "b": _BOTTOM_PIXELS},
        "xaxis": {"range": [0, turn], "dtick": 90, "title": {"text": "crank angle, deg"},
                  "unifiedhovertitle": {"text": _HOVER_TITLE}, "fixedrange": True,
                  "anchor": _axis("y", len(figure.panels) - 1)},
        "xaxis2": {"range": [0, 360], "dtick": 45, "title": {"text": "cam angle, deg"},
                   "fixedrange": True, "overlaying": "x", "side": "top", "anchor": "y"},
        "shapes": _shades(figure, turn), "annotations": _stroke_names(figure),
    }  # fmt: skip
    for number, panel in enumerate(figure.panels):
        bottom, top = lines.domains[number]
        low, high = vertical_span(panel, figure.strokes)
        axis, legend = _axis("y", number), "legend" if number == 0 else f"legend{number + 1}"
        layout["yaxis" if number == 0 else f"yaxis{number + 1}"] = {
            "domain": [bottom, top], "fixedrange": True, "range": [low, high],
            "title": {"text": _title(panel), "standoff": 8},
        }  # fmt: skip
        named = panel.legend_entries > 1 and (number == 0 or not figure.one_legend)
        if named and number:
            layout[legend] = {"orientation": "h", "x": 0, "y": top, "yanchor": "bottom",
                              "traceorder": "normal"}  # fmt: skip
        for curve in panel.curves:
            traces += _band(curve, crank, axis)
            trace = _curve(curve, panel, crank, cam, axis)
            traces.append(trace | {"showlegend": named, **({"legend": legend} if named else {})})
        shapes, notes = _limits(panel, axis, low, high)
        layout["shapes"] += shapes
        layout["annotations"] += notes
    told = next((trace for trace in traces if "hovertemplate" in trace), None)
    if told is not None:  # once is enough for all curves
        told["hovertemplate"] = told["hovertemplate"].replace("<extra>", f"{_HOVER_CAM}<extra>")
    traces.append({"x": [0], "y": [None], "xaxis": "x2", "yaxis": "y", "type": "scatter",
                   "showlegend": False, "hoverinfo": "skip"})  # fmt: skip
    return {"data": traces, "layout": layout, "words": figure.title}


@dataclass(frozen=True)
class _Lines:
    """Pixels of a figure: its height, the margin at its top, and each panel's share of the rest."""

    height: int
    top: int
    domains: tuple[tuple[float, float], ...]

    @classmethod
    def of(cls, figure: AngleFigure) -> _Lines:
        panels = figure.panels
        own = [p.legend_entries > 1 and not figure.one_legend for p in panels]
        gaps = [_GAP_PIXELS + _LEGEND_PIXELS * with_legend for with_legend in own[1:]]
        heights = [_PANEL_PIXELS * panel.height for panel in panels]
        whole = sum(heights) + sum(gaps)
        edge, domains = whole, []
        for height, gap in zip(heights, [*gaps, 0], strict=True):
            domains.append((max(edge - height, 0.0) / whole, edge / whole))
            edge -= height + gap
        top = _TOP_PIXELS + (_LEGEND_PIXELS if panels[0].legend_entries > 1 else 0)
        return cls(round(whole) + top + _BOTTOM_PIXELS, top, tuple(domains))


def _limits(
    panel: Panel, axis: str, low: float, high: float
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Lines of a panel's limits, and the words beside them, as in the static drawing."""
    placed = placed_limits(panel, low, high)
    shapes = [
        {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "yref": axis, "y0": line.value,
         "y1": line.value, "line": {"color": "fail", "width": 1.2, "dash": "dash"}}
        for line, _ in placed.inside
    ]  # fmt: skip
    told = [(line.words(panel.unit), line.value, above) for line, above in placed.inside]
    if placed.beyond:
        told.append((placed.beyond, high if placed.above else low, not placed.above))
    common = {"xref": "paper", "x": 1, "xanchor": "right", "yref": axis, "showarrow": False,
              "font": {"color": "fail", "size": 10}, "bgcolor": "card", "borderpad": 1}  # fmt: skip
    notes = [
        common | {"y": value, "yanchor": "bottom" if above else "top", "text": html.escape(words)}
        for words, value, above in told
    ]
    if placed.beyond and placed.above:
        notes[-1]["yshift"] = -_STROKE_PIXELS  # below the names of the strokes
    return shapes, notes


def _stroke_names(figure: AngleFigure) -> list[dict[str, Any]]:
    """Names of the engine's strokes along the top of the first panel."""
    if not figure.strokes:
        return []
    return [
        {"xref": "x", "x": 90 + 180 * number, "yref": "paper", "y": 1, "yanchor": "top",
         "showarrow": False, "text": name, "font": {"color": "muted", "size": 10}}
        for number, name in enumerate(STROKES)
    ]  # fmt: skip


def _curve(
    curve: Curve, panel: Panel, crank: Array, cam: list[float | None], axis: str
) -> dict[str, Any]:
    name = html.escape(curve.label or panel.quantity)
    unit = html.escape(panel.unit)
    return {
        "type": "scatter", "mode": "lines", "name": name, "xaxis": "x", "yaxis": axis,
        "x": _numbers(crank), "y": _numbers(np.append(curve.values, curve.values[0])),
        "customdata": cam,
        "line": {"color": curve.colour, "width": 1.8, "dash": "dash" if curve.dashed else "solid"},
        "hovertemplate": f"%{{y:.5g}} {unit}<extra>{name}</extra>",
        "meta": unit,
    }  # fmt: skip


def _band(curve: Curve, crank: Array, axis: str) -> list[dict[str, Any]]:
    if curve.band is None:
        return []
    edges = [_numbers(np.append(edge, edge[0])) for edge in curve.band]
    common = {
        "type": "scatter",
        "mode": "lines",
        "x": _numbers(crank),
        "xaxis": "x",
        "yaxis": axis,
        "showlegend": False,
        "hoverinfo": "skip",
        "line": {"width": 0, "color": curve.colour},
    }
    filled = {"fill": "tonexty", "fillcolor": curve.colour}
    return [common | {"y": edges[0]}, common | {"y": edges[1], **filled}]


def _shades(figure: AngleFigure, turn: float) -> list[dict[str, Any]]:
    shapes: list[dict[str, Any]] = []
    if figure.strokes:
        shapes += [
            {"type": "rect", "xref": "x", "x0": start, "x1": start + 180, "yref": "paper", "y0": 0,
             "y1": 1, "fillcolor": "shade", "line": {"width": 0}, "layer": "below"}
            for start in (180, 540)
        ]  # fmt: skip
    if figure.worst is not None:
        at = figure.worst % turn
        shapes.append({"type": "line", "xref": "x", "x0": at, "x1": at, "yref": "paper", "y0": 0,
                       "y1": 1, "line": {"color": "ink", "width": 1, "dash": "dot"}})  # fmt: skip
    return shapes


def _outline(figure: OutlineFigure) -> dict[str, Any]:
    angle = np.linspace(0.0, 360.0, figure.contour.shape[1] + 1)
    traces = []
    for name, points, colour in (("cam contour", figure.contour, "blue"),
                                 ("pitch curve", figure.pitch, "muted")):  # fmt: skip
        if points is None:
            continue
        closed = np.append(points, points[:, :1], axis=1)
        traces.append({
            "type": "scatter", "mode": "lines", "name": name, "x": _numbers(closed[0]),
            "y": _numbers(closed[1]), "customdata": _numbers(angle), "meta": "mm",
            "line": {"color": colour, "width": 1.8, "dash": "solid"},
            "hovertemplate": "%{x:.4f}, %{y:.4f} mm (cam %{customdata:.1f}°)",
        })  # fmt: skip
    if figure.counter_hole is not None:
        x, y, radius, drilled = figure.counter_hole
        turned = np.radians(angle)
        traces.append({
            "type": "scatter", "mode": "lines", "hoverinfo": "skip", "meta": "mm",
            "name": "counter-hole" if drilled else "counter-hole, proposed",
            "x": _numbers(x + radius * np.cos(turned)), "y": _numbers(y + radius * np.sin(turned)),
            "line": {"color": "blue", "width": 1.2, "dash": "solid" if drilled else "dash"},
        })  # fmt: skip
    if figure.follower is not None:
        name = html.escape(f"{figure.follower_name} {figure.worst_label}")
        traces.append({
            "type": "scatter", "mode": "lines", "name": name, "hoverinfo": "skip", "meta": "mm",
            "x": _numbers(figure.follower[0]), "y": _numbers(figure.follower[1]),
            "line": {"color": "vermillion", "width": 1.4, "dash": "solid"},
        })  # fmt: skip
    layout = {
        "height": 560, "shapes": [], "annotations": [], "hovermode": "closest",
        "xaxis": {"title": {"text": "x, mm"}, "fixedrange": True},
        "yaxis": {"title": {"text": "y, mm"}, "scaleanchor": "x", "fixedrange": True},
    }  # fmt: skip
    return {"data": traces, "layout": layout, "words": figure.title}


def _title(panel: Panel) -> str:
    return html.escape(f"{panel.quantity}, {panel.unit}" if panel.unit else panel.quantity)


def _axis(letter: str, number: int) -> str:
    return letter if number == 0 else f"{letter}{number + 1}"


def _numbers(values: Array) -> list[float | None]:
    return [float(f"{v:.{_DIGITS}g}") if np.isfinite(v) else None for v in values.tolist()]

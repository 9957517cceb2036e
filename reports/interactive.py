"""The sheet's figures for an interactive library: plain values that Plotly draws in the page.

The library is bundled into the page, so that it opens without a network. Colours stay names here;
the page fills in those of its light or dark theme.
"""

from __future__ import annotations

import base64
import hashlib
import html
import importlib.resources
import importlib.util
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from geometry.arrays import Array
from reports.figures import AngleFigure, Curve, Figure, OutlineFigure, Panel

_PANEL_PIXELS, _FRAME_PIXELS = 165, 120
_GAP = 0.05
_DIGITS = 6


@dataclass(frozen=True)
class Bundle:
    """What an interactive page carries: scripts, their hashes for its policy, the figures' data."""

    scripts: tuple[Markup, ...]
    hashes: tuple[str, ...]
    data: Markup


def bundle(figures: Iterable[Figure]) -> Bundle | None:
    """Scripts and data of some figures; None where the library is not installed."""
    library = _library()
    if library is None:
        return None
    own = Path(__file__).parent / "templates" / "report.js"
    sources = [library.read_text(encoding="utf-8"), own.read_text(encoding="utf-8")]
    safe = [
        source.replace("</script", "<\\/script").replace("<!--", "<\\!--") for source in sources
    ]
    specs = {figure.id: specification(figure) for figure in figures}
    return Bundle(
        tuple(Markup(source) for source in safe),  # noqa: S704 - the library's and our own
        tuple(_hash(source) for source in safe),
        Markup(script_safe_json(specs)),  # noqa: S704 - no "<" is left in it
    )


def specification(figure: Figure) -> dict[str, Any]:
    """Traces and layout of a figure in Plotly's terms, colours by name."""
    return _angles(figure) if isinstance(figure, AngleFigure) else _outline(figure)


def script_safe_json(value: object) -> str:
    """JSON that may stand in a script element: nothing in it can end the element."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _library() -> Path | None:
    if importlib.util.find_spec("plotly") is None:
        return None
    file = Path(str(importlib.resources.files("plotly"))) / "package_data" / "plotly.min.js"
    return file if file.is_file() else None


def _hash(source: str) -> str:
    digest = hashlib.sha256(source.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _angles(figure: AngleFigure) -> dict[str, Any]:
    turn = 360.0 * figure.gear_ratio
    crank = np.append(figure.crank, turn + figure.crank[0])
    cam = _numbers(crank / figure.gear_ratio)
    traces: list[dict[str, Any]] = []
    layout: dict[str, Any] = {
        "height": _FRAME_PIXELS + _PANEL_PIXELS * len(figure.panels),
        "xaxis": {"range": [0, turn], "dtick": 90, "title": {"text": "crank angle, deg"},
                  "fixedrange": True, "anchor": _axis("y", len(figure.panels) - 1)},
        "xaxis2": {"range": [0, 360], "dtick": 45, "title": {"text": "cam angle, deg"},
                   "fixedrange": True, "overlaying": "x", "side": "top", "anchor": "y"},
        "shapes": _shades(figure, turn), "annotations": [],
    }  # fmt: skip
    top, share = 1.0, (1.0 - _GAP * (len(figure.panels) - 1)) / sum(p.height for p in figure.panels)
    for number, panel in enumerate(figure.panels):
        bottom = max(top - share * panel.height, 0.0)
        layout["yaxis" if number == 0 else f"yaxis{number + 1}"] = {
            "domain": [bottom, top], "fixedrange": True, "title": {"text": _title(panel)},
            **({} if panel.span is None else {"range": list(panel.span)}),
        }  # fmt: skip
        top = bottom - _GAP
        axis = _axis("y", number)
        for curve in panel.curves:
            traces += _band(curve, crank, axis)
            traces.append(_curve(curve, panel, crank, cam, axis, number))
        layout["shapes"] += [
            {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "yref": axis, "y0": line.value,
             "y1": line.value, "line": {"color": "fail", "width": 1.2, "dash": "dash"}}
            for line in panel.limits if _near(line.value, panel)
        ]  # fmt: skip
        layout["annotations"] += [
            {"xref": "paper", "x": 1, "xanchor": "right", "yref": axis, "y": line.value,
             "yanchor": "bottom", "showarrow": False, "font": {"color": "fail", "size": 10},
             "text": html.escape(f"{line.label} {line.value:.4g} {panel.unit}")}
            for line in panel.limits if _near(line.value, panel)
        ]  # fmt: skip
    traces.append({"x": [0], "y": [None], "xaxis": "x2", "yaxis": "y", "type": "scatter",
                   "showlegend": False, "hoverinfo": "skip"})  # fmt: skip
    return {"data": traces, "layout": layout, "words": figure.title}


def _curve(
    curve: Curve, panel: Panel, crank: Array, cam: list[float | None], axis: str, number: int
) -> dict[str, Any]:
    name = html.escape(curve.label or panel.quantity)
    unit = html.escape(panel.unit)
    return {
        "type": "scatter", "mode": "lines", "name": name, "xaxis": "x", "yaxis": axis,
        "x": _numbers(crank), "y": _numbers(np.append(curve.values, curve.values[0])),
        "customdata": cam, "legendgroup": name, "showlegend": bool(curve.label) and number == 0,
        "line": {"color": curve.colour, "width": 1.8, "dash": "dash" if curve.dashed else "solid"},
        "hovertemplate": f"%{{y:.5g}} {unit} (cam %{{customdata:.1f}}°)",
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
        closed = np.append(points, points[:, :1], axis=1)
        traces.append({
            "type": "scatter", "mode": "lines", "name": name, "x": _numbers(closed[0]),
            "y": _numbers(closed[1]), "customdata": _numbers(angle), "meta": "mm",
            "line": {"color": colour, "width": 1.8, "dash": "solid"},
            "hovertemplate": "%{x:.4f}, %{y:.4f} mm (cam %{customdata:.1f}°)",
        })  # fmt: skip
    if figure.roller_radius is not None:
        turn = np.linspace(0.0, 2 * np.pi, 121)
        centre = figure.pitch[:, figure.worst]
        ring = centre[:, None] + figure.roller_radius * np.array([np.cos(turn), np.sin(turn)])
        traces.append({
            "type": "scatter", "mode": "lines", "name": html.escape(f"roller {figure.worst_label}"),
            "x": _numbers(ring[0]), "y": _numbers(ring[1]), "hoverinfo": "skip", "meta": "mm",
            "line": {"color": "vermillion", "width": 1.4, "dash": "solid"},
        })  # fmt: skip
    layout = {
        "height": 560, "shapes": [], "annotations": [], "hovermode": "closest",
        "xaxis": {"title": {"text": "x, mm"}, "fixedrange": True},
        "yaxis": {"title": {"text": "y, mm"}, "scaleanchor": "x", "fixedrange": True},
    }  # fmt: skip
    return {"data": traces, "layout": layout, "words": figure.title}


def _near(value: float, panel: Panel) -> bool:
    """Whether a limit lies within sight of the curves, as in the static drawing."""
    if panel.span is not None:
        return panel.span[0] <= value <= panel.span[1]
    values = np.concatenate([curve.values for curve in panel.curves] or [np.zeros(1)])
    values = values[np.isfinite(values)]
    if not values.size:
        return False
    size = max(float(np.ptp(values)), 1e-9)
    return bool(values.min() - 1.6 * size < value < values.max() + 1.6 * size)


def _title(panel: Panel) -> str:
    return html.escape(f"{panel.quantity}, {panel.unit}" if panel.unit else panel.quantity)


def _axis(letter: str, number: int) -> str:
    return letter if number == 0 else f"{letter}{number + 1}"


def _numbers(values: Array) -> list[float | None]:
    return [float(f"{v:.{_DIGITS}g}") if np.isfinite(v) else None for v in values.tolist()]

"""``motion.svg``: the mechanism over one turn, animated, with contact force and pressure.

Animated by SVG itself, without a script but for its pause; who prefers reduced motion sees the
worst angle at rest.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.figures import Figure, closed
from camwright.pipeline.base.files import write_atomic
from camwright.reports.analysis_sheet import groups
from camwright.reports.arrangement_data import arrangement_at, mechanism_of, motion_of
from camwright.reports.drawing.arrangement import DrawnMotion, arrows, drawing
from camwright.reports.drawing.drawing_shapes import (
    Arrow,
    DrawnOutline,
    Pose,
    ShapeGroup,
)
from camwright.reports.drawing.drawing_svg import decimal, line_path, svg_of
from camwright.reports.figure_svg import COLOURS, DARK
from camwright.reports.report_data import ReportMaterial
from camwright.reports.report_tables import number, quantity, shortened
from camwright.reports.sheet_turn import SheetTurn, lowest

FILE = "motion.svg"
TURN_S = 8.0
"""Time of a turn, s."""
FRAMES = 90
"""Most cam angles between which the motion is linear."""
_PAGE_WIDTH, _PAGE_HEIGHT, _HEAD, _FOOT = 960.0, 620.0, 58.0, 40.0
_SPLIT, _PANEL_GAP, _PAGE_EDGE = 400.0, 22.0, 24.0  # of the drawing beside the panels
_AXIS_LEFT, _AXIS_TOP, _AXIS_BOTTOM = 64.0, 46.0, 34.0  # about a panel
_CURVE_POINTS_MOST = 360  # of a curve
_TICKS = 5
_STANDSTILL = 0.1  # rpm, at most
_FORCES = (("contact", "normal_force_N", "vermillion"), ("spring", "spring_force_N", "green"))
_PRESSURE = "pressure"  # figure of the sheet
_FONT = "system-ui, -apple-system, Segoe UI, Roboto, Helvetica Neue, Arial, sans-serif"
_NAMES = {name: f"var(--{name})" for name in COLOURS}
_PAUSE = """\
const root = document.documentElement, button = document.getElementById("pause");
function turn() {
  const rests = root.animationsPaused();
  if (rests) root.unpauseAnimations(); else root.pauseAnimations();
  button.setAttribute("aria-pressed", String(!rests));
}
button.addEventListener("click", turn);
button.addEventListener("keydown", (event) => {
  if (event.key === " " || event.key === "Enter") { event.preventDefault(); turn(); }
});"""


@dataclass(frozen=True, eq=False)
class _MotionCurve:
    """Values over the turn in the unit of its panel; colour by name."""

    label: str
    values: Array
    colour: str


@dataclass(frozen=True, eq=False)
class _MotionPanel:
    """Curves over the cam angle, with a limit, NaN without."""

    title: str
    unit: str
    curves: Sequence[_MotionCurve]
    limit: float
    limit_name: str = ""

    @property
    def finite_curves(self) -> Sequence[_MotionCurve]:
        """Curves that are finite at every angle."""
        return [each for each in self.curves if np.isfinite(each.values).all()]

    @property
    def span(self) -> tuple[float, float]:
        """Lower and upper end of the axis, rounded outwards to ticks, with zero and the limit
        within.
        """
        every = [curve.values for curve in self.curves]
        ends = [0.0, *(float(v.min()) for v in every), *(float(v.max()) for v in every)]
        if np.isfinite(self.limit):
            ends.append(self.limit)
        step = _step(max(ends) - min(ends))
        low, high = float(np.floor(min(ends) / step)), float(np.ceil(max(ends) / step))
        return low * step, max(high, low + 1.0) * step

    @property
    def ticks(self) -> Array:
        """Values of the grid."""
        low, high = self.span
        step = _step(high - low)
        return np.asarray(np.arange(round(low / step), round(high / step) + 1) * step, dtype=float)


def _step(span: float) -> float:
    """Step of the ticks of an axis of length `span`: 1, 2 or 5 times a power of ten, at most
    `_TICKS` steps.
    """
    if not span > 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(span / _TICKS))
    return float(min(s * power for s in (1.0, 2.0, 5.0, 10.0) if s * power * _TICKS >= span))


def write(material: ReportMaterial) -> list[Path]:
    """Write ``motion.svg``.

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    return [write_atomic(material.folder / FILE, text(material))]


def text(material: ReportMaterial) -> str:
    """The animated drawing as SVG."""
    turn = material.turn
    motion = motion_of(turn)
    title = shortened(str(material.case.get("title") or material.run.summary["case"]), 74)
    speed = turn.columns.get("cam_speed_rad_per_s")
    words = f"Load case {turn.load_case}"
    if speed is not None and np.isfinite(speed).all():
        rpm = float(np.mean(speed)) * turn.gear_ratio * 30.0 / np.pi
        words += f", {turn.words.shaft} {number(rpm, 4)} rpm" if rpm > _STANDSTILL else ""
    words += f"; one turn in {TURN_S:g} s"
    still = arrangement_at(turn)
    alt = (
        f"One turn of the cam of {title}: the mechanism to scale, beside it contact force and "
        f"contact pressure over the cam angle. At the worst angle: {still.alt}"
    )
    panels = _panels(turn)
    return "\n".join(
        [
            '<svg xmlns="http://www.w3.org/2000/svg" '
            f'viewBox="0 0 {_PAGE_WIDTH:g} {_PAGE_HEIGHT:g}" font-family="{_FONT}" role="img" '
            'aria-labelledby="motion-title motion-text">',
            f'<title id="motion-title">{escape(title)}: motion</title>',
            f'<desc id="motion-text">{escape(alt)}</desc>',
            f"<style>{_style()}</style>",
            f'<rect width="{_PAGE_WIDTH:g}" height="{_PAGE_HEIGHT:g}" fill="var(--card)"/>',
            _text(title, _PAGE_EDGE, 30.0, 19.0, weight=650),
            _text(shortened(words, 100), _PAGE_EDGE, 50.0, 13.0, "muted"),
            *(_panel(panel, k, len(panels)) for k, panel in enumerate(panels)),
            f'<g class="still">{_placed(svg_of(still, _NAMES, _FONT, _place()), "still")}',
            *(_marks(panel, k, len(panels), turn.worst) for k, panel in enumerate(panels)),
            "</g>",
            f'<g class="moving">{_moving(turn, motion)}',
            *(_moving_marks(panel, k, len(panels)) for k, panel in enumerate(panels)),
            _button(),
            "</g>",
            f"<script>{_PAUSE}</script>",
            "</svg>\n",
        ]
    )


def _style() -> str:
    def theme(colours: Mapping[str, str]) -> str:
        return "".join(f"--{name}:{code};" for name, code in colours.items())

    return (
        f":root{{background:var(--card);{theme(COLOURS)}}}"
        f"@media (prefers-color-scheme:dark){{:root{{{theme(DARK)}}}}}"
        ".still{display:none}"
        "@media (prefers-reduced-motion:reduce){.still{display:inline}.moving{display:none}}"
        "@media print{.still{display:inline}.moving{display:none}}"
        "#pause{cursor:pointer}#pause:focus{outline:none}"
        "#pause:focus-visible rect{stroke:var(--link);stroke-width:2}"
        '#pause[aria-pressed="true"] .on,#pause:not([aria-pressed="true"]) .off{display:none}'
    )


def _text(
    words: str, x: float, y: float, size: float, colour: str = "ink", *, anchor: str = "start",
    weight: int = 400,
) -> str:  # fmt: skip
    return (
        f'<text x="{decimal(x)}" y="{decimal(y)}" font-size="{decimal(size)}" '
        f'font-weight="{weight}" text-anchor="{anchor}" fill="var(--{colour})">'
        f"{escape(words)}</text>"
    )


# --- panels


def _panels(turn: SheetTurn) -> list[_MotionPanel]:
    """Panels of the forces and of the contact pressure over the turn.

    A curve that is not finite at every angle, as where the follower may leave the cam, is left out,
    and so is a panel without curves.
    """
    forces = [
        _MotionCurve(label, turn.columns[name], colour)
        for label, name, colour in _FORCES
        if turn.sprung or label != "spring"
    ]
    panels = [_MotionPanel("Force", "N", forces, np.nan)]
    for figure in (each for _, group in groups(turn) for each in group):
        if figure.id == _PRESSURE and isinstance(figure, Figure):
            drawn = figure.panels[0]
            values = drawn.curves[0].y[: turn.crank.size]  # the sheet ends with the first again
            curve = _MotionCurve(f"p0, {drawn.curves[0].label}", values, "blue")
            limits = lowest(*drawn.limits)
            name = limits[0].label if limits else ""
            limit = limits[0].value if limits else np.nan
            panels.append(_MotionPanel("Contact pressure", drawn.unit, [curve], limit, name))
    panels = [replace(each, curves=each.finite_curves) for each in panels]
    return [each for each in panels if each.curves]


def _box(panel_number: int, count: int) -> tuple[float, float, float, float]:
    """Left, top, width and height of the axes of the panel `panel_number` of `count`, pixels."""
    height = (_PAGE_HEIGHT - _HEAD - _FOOT) / count
    left = _SPLIT + _PANEL_GAP + _AXIS_LEFT
    return (
        left,
        _HEAD + panel_number * height + _AXIS_TOP,
        _PAGE_WIDTH - _PAGE_EDGE - left,
        height - _AXIS_TOP - _AXIS_BOTTOM,
    )


def _panel(panel: _MotionPanel, panel_number: int, count: int) -> str:
    """SVG of axes, legend, limit and curves of a panel.

    Parameters
    ----------
    panel_number, count : int   of the panel from the top, of all panels
    """
    left, top, width, height = _box(panel_number, count)
    lines = [_text(f"{panel.title}, {panel.unit}", left, top - 26.0, 13.5, weight=650)]
    for value in panel.ticks:
        y = _height_of(panel, panel_number, count, value)
        colour = "muted" if value == 0.0 else "grid"
        lines.append(_line((left, y), (left + width, y), colour, 0.8))
        lines.append(_text(number(float(value), 4), left - 8.0, y + 4.0, 11.5, "muted",
                          anchor="end"))  # fmt: skip
    for degrees in range(0, 361, 90):
        x = left + width * degrees / 360.0
        lines.append(_line((x, top), (x, top + height), "grid", 0.8))
        name = "cam angle " if degrees == 180 and panel_number == count - 1 else ""
        low = top + height + 17.0
        lines.append(_text(f"{name}{degrees}°", x, low, 11.5, "muted", anchor="middle"))
    across = left
    for curve in panel.curves:
        words = f"{curve.label}, at most {quantity(float(curve.values.max()), panel.unit, 4)}"
        lines.append(_line((across, top - 10.0), (across + 16.0, top - 10.0), curve.colour, 2.4))
        lines.append(_text(words, across + 22.0, top - 6.0, 12.0, "muted"))
        across += 44.0 + 6.4 * len(words)
    if np.isfinite(panel.limit):
        y = _height_of(panel, panel_number, count, panel.limit)
        lines.append(_line((left, y), (left + width, y), "fail", 1.2, "5 4"))
        lines.append(_text(f"{panel.limit_name} {quantity(panel.limit, panel.unit, 4)}",
                          left + width, y - 5.0, 11.5, "fail", anchor="end"))  # fmt: skip
    for curve in panel.curves:
        stride = -(-curve.values.size // _CURVE_POINTS_MOST)
        values = closed(curve.values[::stride])
        heights = [_height_of(panel, panel_number, count, float(v)) for v in values]
        along = zip(left + width * np.linspace(0.0, 1.0, values.size), heights, strict=True)
        path = "L".join(f"{decimal(a)} {decimal(b)}" for a, b in along)
        lines.append(f'<path d="M{path}" fill="none" stroke="var(--{curve.colour})" '
                    'stroke-width="2" stroke-linejoin="round"/>')  # fmt: skip
    return "\n".join(lines)


def _height_of(panel: _MotionPanel, panel_number: int, count: int, value: float) -> float:
    """Vertical position of a value in its panel, pixels from above."""
    _, top, _, height = _box(panel_number, count)
    low, high = panel.span
    return top + height * (high - value) / (high - low)


def _line(
    start: tuple[float, float], end: tuple[float, float], colour: str, width: float, dash: str = ""
) -> str:
    """SVG line between two points (x, y), pixels, in a colour by name; `dash`: lengths of dashes
    and gaps.
    """
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    ends = zip(("x1", "y1", "x2", "y2"), (*start, *end), strict=True)
    places = " ".join(f'{name}="{decimal(value)}"' for name, value in ends)
    return f'<line {places} stroke="var(--{colour})" stroke-width="{width:g}"{dashed}/>'


def _frames(size: int) -> Array:
    """Rows of the turn drawn as frames, at most `FRAMES`, the first again at the end; `size`: rows
    of the turn.
    """
    count = min(FRAMES, size)
    return np.append(np.arange(count) * size // count, 0)


def _marks(panel: _MotionPanel, panel_number: int, count: int, row: int) -> str:
    """SVG of the cursor and of a dot on each curve of a panel at a row of the turn, for the still
    picture.

    Parameters
    ----------
    panel_number, count : int   of the panel from the top, of all panels
    row : int                   of the turn
    """
    left, top, width, height = _box(panel_number, count)
    x = left + width * row / panel.curves[0].values.size
    dots = (_dot(x, _height_of(panel, panel_number, count, float(c.values[row])), c.colour)
            for c in panel.curves)  # fmt: skip
    return "\n".join([_line((x, top), (x, top + height), "ink", 1.2), *dots])


def _moving_marks(panel: _MotionPanel, panel_number: int, count: int) -> str:
    """SVG of a cursor that runs over the turn in a panel, with a dot on each curve, animated.

    Parameters
    ----------
    panel_number, count : int   of the panel from the top, of all panels
    """
    left, top, width, height = _box(panel_number, count)
    marks = [_line((left, top), (left, top + height), "ink", 1.2)]
    for curve in panel.curves:
        heights = [
            _height_of(panel, panel_number, count, float(curve.values[k]))
            for k in _frames(curve.values.size)
        ]
        marks.append(_dot(left, heights[0], curve.colour, _animate("cy", map(decimal, heights))))
    run = _transform("translate", ("0 0", f"{decimal(width)} 0"))
    return f"<g>{run}{''.join(marks)}</g>"


def _dot(x: float, y: float, colour: str, inside: str = "") -> str:
    return (
        f'<circle cx="{decimal(x)}" cy="{decimal(y)}" r="5" fill="var(--{colour})" '
        f'stroke="var(--card)" stroke-width="1.5">{inside}</circle>'
    )


def _button() -> str:
    """Pause, by click, space and enter."""
    x, y = _PAGE_WIDTH - _PAGE_EDGE - 76.0, 18.0
    return (
        '<g id="pause" role="button" tabindex="0" aria-pressed="false" aria-label="Pause">'
        f'<rect x="{x:g}" y="{y:g}" width="76" height="28" rx="4" fill="var(--card)" '
        'stroke="var(--muted)"/>'
        f'<g class="on">{_text("Pause", x + 38.0, y + 18.5, 13.0, "link", anchor="middle")}</g>'
        f'<g class="off">{_text("Go on", x + 38.0, y + 18.5, 13.0, "link", anchor="middle")}</g>'
        "</g>"
    )


# --- mechanism


def _place() -> str:
    """Attributes of the drawing of the mechanism: left of the panels."""
    size = _SPLIT - _PAGE_EDGE, _PAGE_HEIGHT - _HEAD - 14.0
    return f'x="{_PAGE_EDGE:g}" y="{_HEAD:g}" width="{size[0]:g}" height="{size[1]:g}"'


def _placed(svg: str, name: str) -> str:
    """A drawing with names of its own for its arrow heads."""
    for before in ('id="', "url(#"):
        svg = svg.replace(f"{before}head-", f"{before}{name}-head-")
    return svg


def _moving(turn: SheetTurn, motion: DrawnMotion) -> str:
    """SVG of the mechanism in motion; each force is stated by its greatest value of the turn."""
    mechanism = mechanism_of(turn)
    rows = [int(k) for k in _frames(motion.theta.size)]
    drawn = [drawing(mechanism, motion, row) for row in rows]
    svg = svg_of(drawn[0], _NAMES, _FONT, _place())
    for k, group in enumerate(drawn[0].groups):
        poses = [each.groups[k].pose for each in drawn]
        if any(pose != poses[0] for pose in poses):
            svg = _with_motion(svg, group, poses)
    turned = [{arrow.name: arrow for arrow in arrows(mechanism, motion, row)} for row in rows]
    for name in mechanism.shown_forces:
        svg = _with_arrow(svg, name, [each[name] for each in turned])
    for name in mechanism.shown_forces:
        most = quantity(float(np.abs(motion.forces[name]).max()), "N", 4)
        svg = _with_words(svg, name, f"\N{LESS-THAN OR EQUAL TO} {most}")
    return _placed(_with_words(svg, "angle", ""), "moving")


def _with_words(svg: str, name: str, words: str) -> str:
    """The drawing with other words at a value that moves."""
    return re.sub(rf'(<text data-value="{name}"[^>]*>)[^<]*', lambda m: m[1] + escape(words), svg)


def _with_motion(svg: str, group: ShapeGroup, poses: Sequence[Pose]) -> str:
    """The drawing `svg` with one of its groups animated.

    Parameters
    ----------
    group : ShapeGroup   of the drawing
    poses : sequence     turn, shift and stretch of the group, one for each frame
    """
    turns = np.degrees(np.unwrap([pose.turn for pose in poses]))
    shifts = [f"{decimal(pose.shift[0])} {decimal(-pose.shift[1])}" for pose in poses]
    inside = _transform("translate", shifts)
    if np.ptp(turns) > 0.0:
        inside += _transform("rotate", [decimal(-float(t)) for t in turns], added=True)
    start = svg.index(f'<g data-part="{group.name}"')
    body = svg.index(">", start) + 1
    end = svg.index("</g>", body)
    shapes = svg[body:end]
    if any(pose.stretch != poses[0].stretch for pose in poses):
        outlines = [shape for shape in group.shapes if isinstance(shape, DrawnOutline)]
        paths = iter(_animate("d", (_path(each, p.stretch) for p in poses)) for each in outlines)
        shapes = re.sub(r"(<path [^>]*?)/>", lambda m: f"{m[1]}>{next(paths)}</path>", shapes)
    return f"{svg[:body]}{inside}{shapes}{svg[end:]}"


def _path(shape: DrawnOutline, stretch: float) -> str:
    return "".join(line_path(line, stretch, shape.closed) for line in shape.lines)


def _with_arrow(svg: str, name: str, at: Sequence[Arrow]) -> str:
    """The drawing `svg` with one of its arrows animated; hidden in frames where the arrow is no
    longer than its head.

    Parameters
    ----------
    name : str      of the arrow in the drawing
    at : sequence   the arrow, one for each frame
    """
    ends: dict[str, list[str]] = {key: [] for key in ("x1", "y1", "x2", "y2")}
    seen = []
    for arrow in at:
        tail, tip = np.array(arrow.tail), np.array(arrow.tip)
        length = float(np.hypot(*(tip - tail)))
        is_seen = length > arrow.head
        neck = tip - (tip - tail) * (arrow.head / length) if is_seen else tip
        for key, value in zip(ends, (tail[0], -tail[1], neck[0], -neck[1]), strict=True):
            ends[key].append(decimal(float(value)))
        seen.append("visible" if is_seen else "hidden")
    inside = "".join(_animate(key, values) for key, values in ends.items())
    inside += _animate("visibility", seen, stepped=True)
    return re.sub(rf'(<line data-arrow="{name}"[^>]*?)/>', lambda m: f"{m[1]}>{inside}</line>", svg)


def _animate(attribute: str, values: Iterable[str], *, stepped: bool = False) -> str:
    mode = ' calcMode="discrete"' if stepped else ""
    return f'<animate attributeName="{attribute}" values="{";".join(values)}"{mode} {_TIMING}/>'


def _transform(kind: str, values: Iterable[str], *, added: bool = False) -> str:
    more = ' additive="sum"' if added else ""
    return (
        f'<animateTransform attributeName="transform" type="{kind}" values="{";".join(values)}"'
        f"{more} {_TIMING}/>"
    )


_TIMING = f'dur="{TURN_S:g}s" repeatCount="indefinite"'

"""Dimensioned views of the cam: front view, section, bore detail; mm on paper."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.cutouts import radius_at
from camwright.pipeline.base.fits import Size
from camwright.reports.drawing.drawing_shapes import (
    GLYPH,
    HEAD,
    Arrow,
    Drawing,
    DrawnOutline,
    Pen,
    Shape,
    ShapeGroup,
    Text,
    bore_outline,
    circle,
    hatching,
    rectangle,
    segment,
)

WIDTH, HEIGHT = 236.0, 272.0
"""Size of the views on paper, mm."""
_FRONT = 186.0  # mm, square of the front view
_LABELS = 9.0  # mm around the contour, for its angles
_SECTION = WIDTH - _FRONT - 14.0  # mm, greatest width of the section
_DETAIL = 40.0  # mm, greatest size of the detail
_TEXT, _SMALL = 3.5, 2.5  # mm, heights of ISO 3098
_EDGE, _THIN = 0.5, 0.25  # mm, lines of ISO 128
_ARROW = 0.75  # mm, so that a head is 2.55 mm long; the line before it is thin
_STEPS = (1.0, 2.0, 5.0)  # of scales, ISO 5455
_TRACK = 46.0  # mm, greatest width of the section of the track
_GROOVE = 34.0  # mm, greatest width of the section of a groove
_CROWN_HEIGHT = 0.06  # greatest drop drawn, over the width of the flat
_CROWNS = {
    "lundberg": "Lundberg", "johns_gohar": "Johns-Gohar", "iso16281": "ISO/TS 16281",
    "table": "by table",
}  # fmt: skip
_ARC = 17  # points of the radius of an end
_EVERY = 30  # deg, between the labelled angles
_PROFILE_AT, _ROUGH_AT = 105.0, 75.0  # deg, of the leaders: between two labels


@dataclass(frozen=True, eq=False)
class Track:
    """Axial section of the running surface; mm.

    flat : float              width without the ends
    end                       kind and size of both ends; None: not stated
    crown : tuple of arrays   axial coordinates and drops; None: straight
    """

    flat: float
    end: tuple[str, float] | None
    crown: tuple[Array, Array] | None

    @property
    def width(self) -> float:
        """Width with the ends, mm."""
        return self.flat + 2.0 * (0.0 if self.end is None else self.end[1])

    @property
    def end_words(self) -> str:
        """Ends as on a drawing: sharp, chamfer or radius with its size, or not stated."""
        if self.end is None:
            return "edges: not stated"
        kind, size = self.end
        if kind == "sharp":
            return "both edges sharp, burr-free"
        return f"both edges {size:.4g} × 45°" if kind == "chamfer" else f"both edges R {size:.4g}"

    @property
    def stretch(self) -> float:
        """Factor by which the drop of the crown is drawn over the width; 1: straight."""
        if self.crown is None:
            return 1.0
        share = _CROWN_HEIGHT * self.flat / float(np.abs(self.crown[1]).max())
        return standard_scale(share, 1.0)

    def line(self) -> Array:
        """Surface (2, n) over the axial coordinate, drop stretched, from end to end."""
        y, low = (np.array([-0.5, 0.5]) * self.flat, np.zeros(2)) if self.crown is None else (
            self.crown[0], -self.stretch * self.crown[1])  # fmt: skip
        left, right = self._end(float(low[0])), self._end(float(low[-1]))
        return np.hstack([left[:, ::-1] * [[-1.0], [1.0]], [y, low], right])

    def _end(self, low: float) -> Array:
        """Points (2, m) of the right end from the flat outwards, axial and radial coordinate, mm,
        at height `low` of the flat's edge.
        """
        half, (kind, size) = 0.5 * self.flat, self.end or ("sharp", 0.0)
        if kind != "radius":
            return np.array([[half, half + size], [low, low - size]])
        turn = np.linspace(0.0, 0.5 * np.pi, _ARC)
        return np.array([half + size * np.sin(turn), low - size * (1.0 - np.cos(turn))])


class StepView(NamedTuple):
    """Step of a groove, mm: inner and outer wall (2, n), their distances from the path of the
    roller, depth of its floor below the face.
    """

    inner: Array
    outer: Array
    inside: float
    outside: float
    depth: float

    @property
    def width(self) -> float:
        """Across the path."""
        return self.inside + self.outside


@dataclass(frozen=True, eq=False)
class GrooveView:
    """Groove in the face of a disc, with the contour as an inner wall; mm.

    steps          from the face down
    fillet, radius of the floor; of the disc
    """

    steps: tuple[StepView, ...]
    fillet: float
    radius: float

    @property
    def width(self) -> float:
        """At the face."""
        return self.steps[0].width


@dataclass(frozen=True, eq=False)
class DrawnCam:
    """Data of the cam to draw; lengths in mm, angles in rad.

    contour : array (2, n)   angle zero along x
    keyway                   width, depth beyond the bore and angle of its middle; None: none
    counter_hole             centre x, y and radius; None: none
    bore, keyway_width, keyway_depth : Size   with their tolerances
    roughness : str          of the contour; "": a field to fill by hand
    """

    contour: Array
    keyway: tuple[float, float, float] | None
    counter_hole: tuple[float, float, float] | None
    thickness: float
    bore: Size
    keyway_width: Size | None
    keyway_depth: Size | None
    root_radius: float | None
    profile_tolerance: str
    datum: str
    roughness: str
    track: Track
    groove: GrooveView | None = None

    @property
    def edge(self) -> Array:
        """Outermost outline (2, n), mm: contour, or circle of the disc with a groove."""
        return self.contour if self.groove is None else circle(self.groove.radius)

    @property
    def bore_radius(self) -> float:
        """Radius of the bore, mm."""
        return 0.5e3 * self.bore.nominal

    @property
    def hole(self) -> Array:
        """Bore with keyway (2, n)."""
        return bore_outline(self.bore_radius, self.keyway)

    @property
    def scale(self) -> float:
        """Scale of front view and section."""
        reach = float(np.abs(self.edge).max())
        return min(standard_scale(0.5 * _FRONT - _LABELS, reach),
                   standard_scale(_SECTION, self.thickness))  # fmt: skip

    @property
    def track_scale(self) -> float:
        """Scale of the detail of the surface in contact."""
        if self.groove is not None:
            return standard_scale(_GROOVE, self.groove.width)
        return standard_scale(_TRACK, self.track.width)

    @property
    def detail_scale(self) -> float:
        """Scale of the detail of the bore."""
        depth = 0.0 if self.keyway is None else self.keyway[1]
        return standard_scale(_DETAIL, 2.0 * self.bore_radius + depth)


def standard_scale(room: float, size: float) -> float:
    """Greatest scale of ISO 5455 at which a size fits into a space."""
    power = 10.0 ** np.floor(np.log10(room / size))
    steps = (*_STEPS, 10.0)
    return float(max(step * power for step in steps if step * power * size <= room * (1 + 1e-9)))


def scale_words(scale: float) -> str:
    """Scale as text, ``2:1`` or ``1:5``."""
    return f"{scale:.6g}:1" if scale >= 1.0 else f"1:{1.0 / scale:.6g}"


def views(part: DrawnCam) -> Drawing:
    """Dimensioned drawing of the cam: front view, section beside it, details of bore and running
    surface below.
    """
    middle = (0.5 * _FRONT, HEIGHT - 0.5 * _FRONT - 12.0)
    track = _track if part.groove is None else _groove
    groups = (
        ShapeGroup("front", tuple(_front(part, *middle))),
        ShapeGroup("section", tuple(_section(part, _FRONT + 8.0, middle[1]))),
        ShapeGroup("detail", tuple(_detail(part, 62.0, 36.0))),
        ShapeGroup("track", tuple(track(part, 186.0, 46.0))),
    )
    words = (
        "Cam in front view, section and details of its bore and of the section of its surface; "
        f"scale {scale_words(part.scale)}."
    )
    return Drawing("Cam", words, groups, (0.0, 0.0, WIDTH, HEIGHT))


def _thin(*lines: Array, dash: str = "solid") -> DrawnOutline:
    return DrawnOutline(lines, Pen("ink", _THIN, dash=dash), closed=False)


def _arrow(tail: tuple[float, float], tip: tuple[float, float]) -> Iterator[Shape]:
    """Thin line of a dimension or leader with a head at its tip."""
    back = np.array(tail) - np.array(tip)
    neck = np.array(tip) + 1.05 * HEAD * _ARROW * back / np.hypot(*back)
    start = (float(neck[0]), float(neck[1]))
    yield _thin(segment(tail, start))
    yield Arrow("dimension", start, tip, "ink", _ARROW)


def _from_polar(radius: float, degrees: float, x: float, y: float) -> tuple[float, float]:
    turn = np.radians(degrees)
    return float(x + radius * np.cos(turn)), float(y + radius * np.sin(turn))


def _front(part: DrawnCam, x: float, y: float) -> Iterator[Shape]:
    """Shapes of the front view about (x, y), mm on paper: contour, bore, counter-hole, angles,
    centre lines, plane of the section, sense of rotation, tolerance, roughness.
    """
    scale, centre = part.scale, np.array([[x], [y]])
    edge = Pen("ink", _EDGE)
    contour = scale * part.contour + centre
    yield DrawnOutline((contour,), edge)
    if part.groove is not None:
        walls = [wall for step in part.groove.steps for wall in step[:2]]
        for each in (*(wall for wall in walls if wall is not part.contour), part.edge):
            yield DrawnOutline((scale * each + centre,), edge)
    yield DrawnOutline((scale * part.hole + centre,), edge)
    if part.counter_hole is not None:
        hole_x, hole_y, radius = (scale * each for each in part.counter_hole)
        yield DrawnOutline((circle(radius, (x + hole_x, y + hole_y)),), edge)
    radii = scale * np.array([radius_at(part.edge, np.radians(k)) for k in range(0, 360, 5)])
    for degrees in range(0, 360, _EVERY):
        out = float(radii[degrees // 5])
        ends = (_from_polar(out + gap, degrees, x, y) for gap in (0.8, 3.0))
        yield _thin(segment(*ends))
        at = _from_polar(out + 6.5, degrees, x, y)
        yield Text(f"{degrees}°", (at[0], at[1] - 0.9), _SMALL, align="middle")
    reach = float(radii[0])
    yield _thin(segment((x, y), (x + reach, y)), dash="dashdot")
    low, high = float(radii[270 // 5]), float(radii[90 // 5])
    yield _thin(segment((x, y - low), (x, y + high)), dash="dashdot")
    yield _thin(segment((x - float(radii[180 // 5]), y), (x, y)), dash="dashdot")
    for sign, end in ((1.0, high), (-1.0, -low)):  # the plane of the section
        mark = y + end + sign * 9.0
        yield DrawnOutline(
            (segment((x, mark), (x, mark + sign * 4.0)),), Pen("ink", 0.7), closed=False
        )
        yield Text("C", (x - 4.0, mark + 2.0 * sign - 1.2), _TEXT, align="middle", bold=True)
    yield from _turning(part, x, y, scale)
    yield from _tolerance_frame(part, contour, x, y)
    yield from _roughness(part, contour, x, y)


def _turning(part: DrawnCam, x: float, y: float, scale: float) -> Iterator[Shape]:
    """Arrow in the direction of turning, clockwise, between bore and contour of the front view.

    Parameters
    ----------
    x, y : float    centre of the view, mm on paper
    scale : float   of the view, mm on paper per mm
    """
    held = part.bore_radius + (0.0 if part.keyway is None else part.keyway[1])
    least = float(np.hypot(*part.contour).min())
    radius = scale * (0.45 * held + 0.55 * least)
    turn = np.radians(np.linspace(130.0, 57.0, 40))
    yield _thin(np.array([[x], [y]]) + radius * np.stack([np.cos(turn), np.sin(turn)]))
    ends = (_from_polar(radius, degrees, x, y) for degrees in (57.0, 50.0))
    yield from _arrow(*ends)


def _tolerance_frame(part: DrawnCam, contour: Array, x: float, y: float) -> Iterator[Shape]:
    """Frame of the tolerance of a line profile with its datum, ISO 1101, on a leader to the contour
    (2, n) drawn about (x, y), mm on paper.
    """
    touch = _on_contour(contour, _PROFILE_AT, x, y)
    low, left, height = HEIGHT - 11.0, 10.0, 7.0
    widths = (8.0, 4.0 + GLYPH * _TEXT * len(part.profile_tolerance),
              4.0 + GLYPH * _TEXT * len(part.datum))  # fmt: skip
    edges = left + np.concatenate([[0.0], np.cumsum(widths)])
    for start, stop in pairwise(edges.tolist()):
        yield DrawnOutline((rectangle(start, low, stop, low + height),), Pen("ink", _THIN))
    around = np.linspace(0.0, np.pi, 25)
    arc = np.array([[edges[0] + 4.0], [low + 2.4]]) + 2.6 * np.stack(
        [np.cos(around), np.sin(around)]
    )
    yield _thin(arc)
    for words, start, stop in ((part.profile_tolerance, *edges[1:3]), (part.datum, *edges[2:4])):
        yield Text(words, (float(0.5 * (start + stop)), low + 2.2), _TEXT, align="middle")
    knee = (float(edges[3]) + 8.0, low + 0.5 * height)
    yield _thin(segment((float(edges[3]), knee[1]), knee))
    yield from _arrow(knee, touch)


def _roughness(part: DrawnCam, contour: Array, x: float, y: float) -> Iterator[Shape]:
    """Sign for the surface texture of the contour, ISO 21920-1: material removed; on a leader to
    the contour (2, n) drawn about (x, y), mm on paper.
    """
    touch = _on_contour(contour, _ROUGH_AT, x, y)
    left, low = x + 34.0, HEIGHT - 12.0
    yield from _arrow((left, low), touch)
    words = f"Rq {part.roughness}" if part.roughness else "Rq ________"
    yield _thin(segment((left, low), (left + 6.0, low)))
    foot = left + 8.0
    yield _thin(
        np.array([[foot - 2.0, foot, foot + 3.6], [low + 3.5, low, low + 7.0]]),
        segment((foot - 2.0, low + 3.5), (foot + 1.8, low + 3.5)),
        segment((foot + 3.6, low + 7.0), (foot + 8.0 + GLYPH * _TEXT * len(words), low + 7.0)),
    )
    yield _thin(segment((left, low), (foot, low)))
    yield Text(words, (foot + 5.0, low + 2.4), _TEXT)


def _section(part: DrawnCam, left: float, y: float) -> Iterator[Shape]:
    """Shapes of section C-C through the shaft axis, hatched, its left face at x = `left` and the
    axis at height y, mm on paper.
    """
    scale = part.scale
    high, low = (scale * radius_at(part.edge, turn) for turn in (0.5 * np.pi, 1.5 * np.pi))
    up, down = (scale * radius_at(part.hole, turn) for turn in (0.5 * np.pi, 1.5 * np.pi))
    right = left + scale * part.thickness
    for bottom, top in ((y + up, y + high), (y - low, y - down)):
        box = (left, bottom, right, top)
        if part.groove is None:
            yield _thin(*hatching(box, 2.5))
            yield DrawnOutline((rectangle(*box),), Pen("ink", _EDGE))
        else:
            yield from _cut(part, part.groove, box, y)
    yield DrawnOutline((rectangle(left, y - down, right, y + up),), Pen("ink", _EDGE))
    yield _thin(segment((left - 3.0, y), (right + 3.0, y)), dash="dashdot")
    below = y - low  # the detail, whose circle is about the whole edge, is above
    yield from _dimension((left, right), below, below - 9.0, f"{part.thickness:.6g}", above=True)
    shown, edge, depth, width = 0.5 * (left + right), high, 0.0, scale * part.thickness
    if part.groove is not None:
        step, depth = part.groove.steps[0], scale * part.groove.steps[-1].depth
        near, far = (scale * radius_at(wall, 0.5 * np.pi) for wall in (step.inner, step.outer))
        shown, edge, width = right - 0.5 * depth, 0.5 * (near + far), far - near
    around = 0.5 * float(np.hypot(width, depth)) + 3.0
    yield _thin(circle(around, (shown, y + edge)))
    aside = np.sqrt(0.5) * around + 1.0
    yield Text("D", (shown + aside, y + edge + aside), _TEXT, bold=True)
    yield Text("C–C", (0.5 * (left + right), below - 17.0), _TEXT, align="middle", bold=True)


def _cut(
    part: DrawnCam, groove: GrooveView, box: tuple[float, float, float, float], y: float
) -> Iterator[Shape]:
    """Half of the section of a disc with its groove, which is open to the right, hatched.

    Parameters
    ----------
    box : tuple   left, bottom, right and top of the half, mm on paper
    y : float     height of the axis, below or above the box, mm on paper
    """
    scale, (left, bottom, right, top) = part.scale, box
    turn = 0.5 * np.pi if bottom > y else 1.5 * np.pi
    sign = 1.0 if bottom > y else -1.0
    down: list[tuple[float, float]] = []
    up: list[tuple[float, float]] = []
    floor = right
    for step in groove.steps:
        near, far = (y + sign * scale * radius_at(wall, turn) for wall in (step.inner, step.outer))
        face, floor = floor, right - scale * step.depth
        down += (face, near), (floor, near)
        up += (face, far), (floor, far)
        for low, high in ((bottom, near), (far, top)) if sign > 0 else ((bottom, far), (near, top)):
            yield _thin(*hatching((floor, low, face, high), 2.5))
    yield _thin(*hatching((left, bottom, floor, top), 2.5))
    inside, outside = (bottom, top) if sign > 0 else (top, bottom)
    corners = [(left, inside), (right, inside), *down, *reversed(up), (right, outside),
               (left, outside)]  # fmt: skip
    yield DrawnOutline((np.array(corners).T,), Pen("ink", _EDGE))


def _detail(part: DrawnCam, x: float, y: float) -> Iterator[Shape]:
    """Bore with its keyway turned upwards and dimensioned, at its own scale, its centre at (x, y),
    mm on paper.
    """
    scale, radius = part.detail_scale, part.detail_scale * part.bore_radius
    upright = None if part.keyway is None else (*part.keyway[:2], 0.5 * np.pi)
    hole = scale * bore_outline(part.bore_radius, upright)
    yield DrawnOutline((hole + np.array([[x], [y]]),), Pen("ink", _EDGE))
    top = y + float(hole[1].max())
    yield _thin(segment((x - radius - 3.0, y), (x + radius + 3.0, y)),
                segment((x, y - radius - 3.0), (x, top + 3.0)), dash="dashdot")  # fmt: skip
    yield from _dimension((x - radius, x + radius), y, y - radius - 8.0, f"⌀{_words(part.bore)}",
                          flag="A")  # fmt: skip
    title = f"Bore ({scale_words(scale)})"
    yield Text(title, (x - 58.0, top + 4.0), _TEXT, bold=True)
    if upright is None or part.keyway is None:
        return
    width, depth = part.keyway_width, part.keyway_depth
    half = 0.5 * scale * part.keyway[0]
    if width is not None:
        yield from _dimension((x - half, x + half), top, top + 8.0, _words(width), flag="B")
    if depth is not None:
        beside = x + radius + 10.0
        yield _thin(segment((x + half + 0.8, top), (beside + 2.0, top)),
                    segment((x + 0.8, y - radius), (beside + 2.0, y - radius)))  # fmt: skip
        middle = 0.5 * (top + y - radius)
        yield from _arrow((beside, middle), (beside, top))
        yield from _arrow((beside, middle), (beside, y - radius))
        yield Text(_words(depth), (beside + 2.5, middle + 1.5), _TEXT)
    lines = [f"middle of the keyway at {np.degrees(part.keyway[2]) % 360.0:.6g}°"]
    if part.root_radius is not None:
        lines.append(f"radius at its floor ≥ {part.root_radius:.4g}")
    for k, line in enumerate(lines):
        yield Text(line, (x + radius + 12.5, middle - 5.0 - 4.5 * k), _SMALL)


def crown_words(kind: str) -> str:
    """Kind of a crown in words, for a drawing."""
    return _CROWNS.get(kind, kind)


def _track(part: DrawnCam, x: float, y: float) -> Iterator[Shape]:
    """Axial section of the surface in contact, with flat width and ends dimensioned and the drop of
    a crown stretched.

    Parameters
    ----------
    x, y : float   middle of the surface, mm on paper
    """
    track, scale = part.track, part.track_scale
    line = scale * track.line() + np.array([[x], [y]])
    left, right, low = float(line[0, 0]), float(line[0, -1]), y - 16.0
    torn = np.linspace(right, left, 25)
    tear = np.stack([torn, low + 0.8 * np.sin(6.0 * np.pi * (torn - left) / (right - left))])
    bottom = float(line[1].min())
    yield _thin(*hatching((left, low + 1.0, right, bottom), 2.5))
    body = np.hstack([line[:, :1], line, line[:, -1:]])
    body[1, [0, -1]] = tear[1, [-1, 0]]
    yield DrawnOutline((body,), Pen("ink", _EDGE), closed=False)
    yield _thin(tear)
    yield _thin(segment((x, low - 2.0), (x, y + 3.0)), dash="dashdot")
    half = 0.5 * scale * track.flat
    yield from _dimension((x - half, x + half), y, y + 9.0, f"{track.flat:.6g}", above=True)
    corner = x + 0.25 * scale * (track.flat + track.width)
    foot = (right + 7.0, low - 10.0)
    yield from _arrow(foot, (corner, float(np.interp(corner, *line))))
    yield _thin(segment((x - 36.0, foot[1]), foot))
    yield Text(track.end_words, (x - 36.0, foot[1] + 1.2), _TEXT)
    title = f"D ({scale_words(scale)})"
    yield Text(title, (x - 36.0, y + 15.0), _TEXT, bold=True)
    if track.crown is not None:
        words = f"crown drawn {track.stretch:.6g}:1 over the width; drop as listed"
        yield Text(words, (x - 36.0, foot[1] - 5.0), _SMALL)


def _groove(part: DrawnCam, x: float, y: float) -> Iterator[Shape]:
    """Section of the groove across its path, open upwards: width and depth of each step, fillets;
    nothing without a groove.

    Parameters
    ----------
    x, y : float   middle of the groove, face of the disc, mm on paper
    """
    groove, scale = part.groove, part.track_scale
    if groove is None:
        return
    fillet, deepest = scale * groove.fillet, groove.steps[-1]
    floor, half = y - scale * deepest.depth, 0.5 * scale * groove.width
    rim, below = 0.35 * half, floor - 0.5 * half
    outer = rim + scale * max(max(step.inside, step.outside) for step in groove.steps)
    turn = np.linspace(0.0, 0.5 * np.pi, _ARC)
    arc = fillet * np.stack([np.sin(turn), -np.cos(turn)]) + np.array([[-fillet], [fillet]])
    corner = arc + np.array([[x + scale * deepest.outside], [floor]])
    mirrored = arc[:, ::-1] * [[-1.0], [1.0]]
    mirrored = mirrored + np.array([[x - scale * deepest.inside], [floor]])
    down: list[tuple[float, float]] = []
    up: list[tuple[float, float]] = []
    face = y
    for step in groove.steps:
        ends = x - scale * step.inside, x + scale * step.outside
        foot = y - scale * step.depth
        for box in ((x - outer, foot, ends[0], face), (ends[1], foot, x + outer, face)):
            yield _thin(*hatching(box, 2.5))
        down += (ends[0], face), (ends[0], foot)
        up += (ends[1], face), (ends[1], foot)
        face = foot
    yield _thin(*hatching((x - outer, below, x + outer, floor), 2.5))
    outline = np.hstack([
        np.array([(x - outer, y), *down[:-1]]).T, mirrored, corner,
        np.array([*reversed(up[:-1]), (x + outer, y), (x + outer, below), (x - outer, below)]).T,
    ])  # fmt: skip
    yield DrawnOutline((outline,), Pen("ink", _EDGE))
    yield _thin(segment((x, below - 2.0), (x, y + 3.0)), dash="dashdot")
    for k, step in enumerate(groove.steps):
        ends = x - scale * step.inside, x + scale * step.outside
        beside, foot = x - outer - 7.0 - 9.0 * k, y - scale * step.depth
        line = y + 8.0 + 7.0 * k
        yield from _dimension(ends, y if k == 0 else foot, line, f"{step.width:.7g}", above=True)
        yield _thin(segment((x - outer, y), (beside - 2.0, y)),
                    segment((ends[0], foot), (beside - 2.0, foot)))  # fmt: skip
        middle = 0.5 * (y + foot)
        yield from _arrow((beside, middle), (beside, y))
        yield from _arrow((beside, middle), (beside, foot))
        words = f"{step.depth:.6g}"
        yield Text(words, (beside - 2.0, middle - 1.2), _TEXT, align="end")
    note = (x + outer + 5.0, below - 7.0)
    touch = corner[:, _ARC // 2]
    yield from _arrow(note, (float(touch[0]), float(touch[1])))
    yield _thin(segment((x - outer, note[1]), note))
    words = f"fillets R {groove.fillet:.4g}" if groove.fillet else "corners sharp"
    yield Text(words, (x - outer, note[1] + 1.2), _TEXT)
    title = f"D ({scale_words(scale)})"
    raised = 8.0 + 7.0 * len(groove.steps)
    yield Text(title, (x - outer - 12.0, y + raised), _TEXT, bold=True)


def _dimension(
    ends: tuple[float, float],
    edge: float,
    line: float,
    words: str,
    flag: str = "",
    above: bool = False,
) -> Iterator[Shape]:
    """Horizontal dimension: extension lines, arrows from outside, text; mm on paper.

    Parameters
    ----------
    ends : tuple   the two x between which it measures
    edge : float   height at which the extension lines begin
    line : float   height of the dimension line
    words : str    text of the dimension
    flag : str     letter of a datum of this size, in a frame behind the text, ISO 5459; "": none
    above : bool   text above the dimension line; else behind it
    """
    low, high = ends
    beyond = 2.0 if line > edge else -2.0
    yield _thin(segment((low, edge), (low, line + beyond)), segment((high, edge),
                (high, line + beyond)))  # fmt: skip
    yield from _arrow((low - 6.0, line), (low, line))
    yield from _arrow((high + 6.0, line), (high, line))
    width = GLYPH * _TEXT * len(words)
    stop = high + (6.0 if above else 8.0 + width)
    yield _thin(segment((low, line), (stop, line)))
    if above:
        yield Text(words, (0.5 * (low + high), line + 1.2), _TEXT, align="middle")
    else:
        yield Text(words, (high + 7.5, line + 1.2), _TEXT)
    if flag:
        yield DrawnOutline(
            (rectangle(stop, line - 3.0, stop + 6.0, line + 3.0),), Pen("ink", _THIN)
        )
        yield Text(flag, (stop + 3.0, line - 1.3), _TEXT, align="middle", bold=True)


def _words(size: Size) -> str:
    """Size with its tolerance, deviations behind it."""
    return " ".join((size.number, *(["/".join(size.bounds)] if size.bounds else [])))


def _on_contour(contour: Array, degrees: float, x: float, y: float) -> tuple[float, float]:
    """Outermost point of a contour on paper in a direction from its axis."""
    centred = contour - np.array([[x], [y]])
    return _from_polar(radius_at(centred, np.radians(degrees)), degrees, x, y)

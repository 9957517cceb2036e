"""Charts and turning cams of the documentation site as SVG, in the colours of its theme."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour

STEPS = 72
"""Positions of a turning cam; the browser moves its parts in straight lines between them."""
_WIDTH, _HEIGHT = 440.0, 230.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 58.0, 14.0, 30.0, 44.0
_TICKS = 5


class Curve(NamedTuple):
    """A curve of a chart: its name in the legend, "" for none, and its points."""

    name: str
    x: Array
    y: Array


class Chart(NamedTuple):
    """A chart: words for a screen reader, labels of the axes, curves, dashed limits by name."""

    words: str
    across: str
    up: str
    curves: Sequence[Curve]
    limits: Sequence[tuple[str, float]] = ()


def chart(one: Chart) -> str:
    """A chart as an SVG."""
    across = np.concatenate([curve.x for curve in one.curves])
    up = np.concatenate([*(curve.y for curve in one.curves), [value for _, value in one.limits]])
    x_ticks, y_ticks = _ticks(across), _ticks(up)
    left, right = float(across.min()), float(across.max())
    low, high = min(up.min(), y_ticks[0]), max(up.max(), y_ticks[-1])

    def place(x: Array, y: Array) -> tuple[Array, Array]:
        wide, tall = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
        return (
            _LEFT + wide * (np.asarray(x) - left) / (right - left),
            _TOP + tall * (high - np.asarray(y)) / (high - low),
        )

    parts = []
    for value, text in zip(y_ticks, _numbers(y_ticks), strict=True):
        (x0, x1), (y, _) = place(np.array([left, right]), np.array([value, value]))
        parts.append(f'<path class="grid" d="M{x0:.1f} {y:.1f}H{x1:.1f}"/>')
        parts.append(f'<text class="end" x="{x0 - 6:.1f}" y="{y + 4:.1f}">{text}</text>')
    for value, text in zip(x_ticks, _numbers(x_ticks), strict=True):
        (x,), (y,) = place(np.array([value]), np.array([low]))
        parts.append(f'<text class="middle" x="{x:.1f}" y="{y + 17:.1f}">{text}</text>')
    for name, value in one.limits:
        (x0, x1), (y, _) = place(np.array([left, right]), np.array([value, value]))
        parts.append(f'<path class="limit" d="M{x0:.1f} {y:.1f}H{x1:.1f}"/>')
        parts.append(f'<text class="end" x="{x1:.1f}" y="{y - 5:.1f}">{escape(name)}</text>')
    beside = _LEFT
    for number, curve in enumerate(one.curves):
        parts.append(f'<path class="curve c{number}" d="{_line(*place(curve.x, curve.y))}"/>')
        if curve.name:
            parts.append(
                f'<path class="curve c{number}" d="M{beside:.1f} 12h18"/>'
                f'<text x="{beside + 24:.1f}" y="16">{escape(curve.name)}</text>'
            )
            beside += 40.0 + 6.6 * len(curve.name)
    middle = 0.5 * (_TOP + _HEIGHT - _BOTTOM)
    parts.append(
        f'<text class="middle" x="{0.5 * (_LEFT + _WIDTH - _RIGHT):.1f}" y="{_HEIGHT - 6:.1f}">'
        f"{escape(one.across)}</text>"
        f'<text class="middle" transform="translate(13 {middle:.1f}) rotate(-90)">'
        f"{escape(one.up)}</text>"
    )
    return (
        f'<svg class="chart" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" '
        f'aria-label="{escape(one.words)}">{"".join(parts)}</svg>'
    )


def _ticks(values: Array) -> Array:
    """Round numbers over the range of values."""
    low, high = float(np.min(values)), float(np.max(values))
    if not high > low:
        low, high = low - 0.5 * max(abs(low), 1.0), high + 0.5 * max(abs(high), 1.0)
    if low > 0.0 and low < 0.4 * high:
        low = 0.0
    raw = (high - low) / _TICKS
    power = 10.0 ** np.floor(np.log10(raw))
    step = next(power * each for each in (1.0, 2.0, 2.5, 5.0, 10.0) if power * each >= raw)
    if high > 300.0 and np.isclose(high, 360.0):
        step = 90.0
    return np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1.0) * step


def _numbers(ticks: Array) -> list[str]:
    return [f"{value + 0.0:g}".replace("-", "−") for value in np.round(ticks, 12)]


def _line(x: Array, y: Array) -> str:
    """A path through points."""
    points = [f"{a:.1f} {b:.1f}" for a, b in zip(x, y, strict=True)]
    return f"M{'L'.join(points)}"


class TurningCam(NamedTuple):
    """Cam and follower over the turn, mm.

    outline : array (2, n)   contour in the frame of the cam, angle zero along x
    axis : float             x of the follower axis
    height : array (STEPS,)  of roller centre or face over the cam axis
    roller : float           radius of the roller; 0: a flat face
    bore : float             radius of the bore; 0: not stated
    """

    outline: Array
    axis: float
    height: Array
    roller: float
    bore: float

    @classmethod
    def of(cls, contour: Contour, bore: float = 0.0, points: int = 360) -> TurningCam:
        """The cam of a contour, m."""
        theta = uniform_turn(STEPS)
        roller = 1.0 / contour.follower_curvature if contour.rolls else 0.0
        touched, normal = contour.points(theta), contour.normal(theta)
        across, along = (
            np.array([np.sin(theta), -np.cos(theta)]),
            np.array([np.cos(theta), np.sin(theta)]),
        )
        centre = touched + roller * normal
        axis = float(np.median(np.sum(centre * across, axis=0))) if contour.rolls else 0.0
        height = np.sum(centre * along, axis=0)
        return cls(1e3 * contour.points(uniform_turn(points)), 1e3 * axis, 1e3 * height,
                   1e3 * roller, 1e3 * bore)  # fmt: skip


def closed_line(points: Array) -> str:
    """Closed path through points (2, n), y upward."""
    x, y = points
    return f"M{'L'.join(f'{a:.2f} {-b:.2f}' for a, b in zip(x, y, strict=True))}Z"


def path_of(cam: TurningCam) -> str:
    """Contour and bore of a cam as one path."""
    path = closed_line(cam.outline)
    if cam.bore:
        b = cam.bore
        path += f"M{b:.4g} 0A{b:.4g} {b:.4g} 0 1 0 {-b:.4g} 0A{b:.4g} {b:.4g} 0 1 0 {b:.4g} 0Z"
    return path


def turning_cam(cam: TurningCam, name: str, words: str) -> str:
    """A turning cam as an SVG; CSS turns it where motion is not to be reduced.

    Parameters
    ----------
    name : str    letters, digits and hyphens, one of its own on the page
    words : str   what a screen reader says
    """
    reach = float(np.hypot(*cam.outline).max())
    lowest, highest = float(cam.height.min()), float(cam.height.max())
    stroke = highest - lowest
    wheel = cam.roller or 0.12 * reach
    stem, guide = 0.2 * reach, 0.34 * reach
    bottom = highest + (wheel if cam.roller else 0.14 * reach) + 0.12 * reach
    seat, top = bottom + guide, bottom + guide + stroke + 0.62 * reach
    collar = top - stroke - 0.42 * reach  # of the lower spring seat on the stem, at zero lift
    edge = max(reach, abs(cam.axis) + 1.3 * stem, cam.roller + abs(cam.axis))
    box = (-1.04 * edge, -top - 0.1 * reach, 2.08 * edge, top + 1.14 * reach)
    lifted = cam.height - lowest
    raised = _keyframes(f"translateY({-value:.4g}px)" for value in lifted)
    length = top - 0.06 * reach - collar
    shares = (length - lifted) / length
    pressed = _keyframes(f"scaleY({value:.4g})" for value in shares)
    style = (
        f"@keyframes lift-{name}{{{raised}}}@keyframes press-{name}{{{pressed}}}"
        f"#{name} .lifted{{animation-name:lift-{name}}}"
        f"#{name} .pressed{{animation-name:press-{name}}}"
    )
    mark = 0.5 * (max(cam.bore, 0.08 * reach) + float(np.hypot(*cam.outline[:, 0])))
    end = collar + 0.25 * reach
    foot = lowest if cam.roller else lowest + 0.14 * reach
    follower = [
        f'<rect class="steel" x="{cam.axis - 0.5 * stem:.4g}" y="{-end:.4g}" '
        f'width="{stem:.4g}" height="{end - foot:.4g}"/>',
        f'<rect class="steel" x="{cam.axis - 1.2 * stem:.4g}" y="{-collar:.4g}" '
        f'width="{2.4 * stem:.4g}" height="{0.07 * reach:.4g}"/>',
    ]
    if cam.roller:
        follower += [
            f'<circle class="roller" cx="{cam.axis:.4g}" cy="{-lowest:.4g}" r="{cam.roller:.4g}"/>',
            f'<circle class="pin" cx="{cam.axis:.4g}" cy="{-lowest:.4g}" '
            f'r="{0.3 * cam.roller:.4g}"/>',
        ]
    else:
        follower.append(
            f'<rect class="roller" x="{-0.72 * reach:.4g}" y="{-foot:.4g}" '
            f'width="{1.44 * reach:.4g}" height="{0.14 * reach:.4g}"/>'
        )
    guides = "".join(
        f'<rect class="fixed" x="{cam.axis + side:.4g}" y="{-seat:.4g}" width="{0.75 * stem:.4g}" '
        f'height="{guide:.4g}"/>'
        for side in (-1.25 * stem, 0.5 * stem)
    )
    coils = 7
    wire = [
        (cam.axis + (1.0 if k % 2 else -1.0) * 0.95 * stem, -length * k / (2.0 * coils))
        for k in range(2 * coils + 1)
    ]
    spring = "L".join(f"{a:.4g} {b:.4g}" for a, b in ((u, v + length) for u, v in wire))
    hang = -(top - 0.06 * reach)
    return (
        f'<svg class="turning-cam" id="{name}" viewBox="{" ".join(f"{v:.4g}" for v in box)}" '
        f'role="img" aria-label="{escape(words)}"><style>{style}</style>'
        f'<path class="axis" d="M{cam.axis:.4g} {1.05 * reach:.4g}V{-top - 0.06 * reach:.4g}"/>'
        f'<g class="turned" transform="rotate(-90)"><path class="cam-body" d="{path_of(cam)}"/>'
        f'<circle class="mark" cx="{mark:.4g}" cy="0" r="{0.045 * reach:.4g}"/></g>'
        f'<circle class="hub" r="{0.03 * reach:.4g}"/>'
        f'<g transform="translate(0 {hang:.4g})"><g class="pressed" '
        f'transform="scale(1 {shares[0]:.4g})"><path class="wire" d="M{spring}"/></g></g>'
        f'<g class="lifted" transform="translate(0 {-lifted[0]:.4g})">{"".join(follower)}</g>'
        f'{guides}<rect class="fixed" x="{cam.axis - 1.6 * stem:.4g}" y="{-top:.4g}" '
        f'width="{3.2 * stem:.4g}" height="{0.06 * reach:.4g}"/></svg>'
    )


def _keyframes(transforms: Iterable[str]) -> str:
    """Rules of a whole turn, the first one again at its end."""
    whole = [*transforms]
    steps = enumerate([*whole, whole[0]])
    return "".join(f"{100.0 * k / len(whole):.4g}%{{transform:{each}}}" for k, each in steps)

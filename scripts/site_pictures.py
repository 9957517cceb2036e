"""Charts and turning cams of the documentation site as SVG, in the colours of its theme."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import NamedTuple

import numpy as np

from camwright.geometry.arm_path import ArmContour
from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.figures import (
    SERIES,
    Curve,
    Figure,
    HorizontalAxis,
    LimitLine,
    Panel,
    closed,
)
from camwright.geometry.form_closure import groove_wall
from camwright.reports.figure_svg import FIGURE_WIDTH, svg_of, themed

STEPS = 72
"""Positions of a turning cam; the browser moves its parts in straight lines between them."""


def chart(figure: Figure, width: float = FIGURE_WIDTH) -> str:
    """A figure as SVG with its text alternative; `width` in inches."""
    svg = themed(svg_of(figure, width=width), figure.id)
    return f'{svg}<span id="{figure.id}-alt" hidden>{escape(figure.alt)}</span>'


def over_cam(
    figure_id: str, title: str, quantity: str, unit: str, curves: Iterable[tuple[str, Array]],
    limits: tuple[LimitLine, ...] = (),
) -> Figure:  # fmt: skip
    """Figure of values (n,) at equal cam angles over one turn, by their names."""
    listed = tuple(
        Curve(np.linspace(0.0, 360.0, values.size + 1), closed(values), name, SERIES[k])
        for k, (name, values) in enumerate(curves)
    )
    axis = HorizontalAxis("cam angle", "deg", (0.0, 360.0), 90.0)
    return Figure(figure_id, title, "", (Panel(quantity, unit, listed, limits),), axis)


class TurningCam(NamedTuple):
    """Cam and follower over the turn, mm.

    outline : array (2, n)   contour in the frame of the cam, angle zero along x
    axis : float             x of the follower axis
    height : array (STEPS,)  of roller centre or face over the cam axis
    roller : float           radius of the roller; 0: a flat face
    bore : float             radius of the bore; 0: not stated
    wall : array (2, n)      outer wall of a groove around the contour; None: a spring closes it
    disc : float             radius of the disc with a groove
    """

    outline: Array
    axis: float
    height: Array
    roller: float
    bore: float
    wall: Array | None = None
    disc: float = 0.0

    @property
    def reach(self) -> float:
        """Greatest radius of the cam."""
        return self.disc if self.wall is not None else float(np.hypot(*self.outline).max())

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

    def in_groove(self, contour: Contour, disc: float) -> TurningCam:
        """The same in a disc of a radius, m, with a groove around the contour."""
        track = contour.require_roller()
        wall = groove_wall(track, "outer", track.roller_radius)
        points = 1e3 * wall.points(uniform_turn(self.outline.shape[1]))
        return self._replace(wall=points, disc=1e3 * disc)


def circle_path(radius: float) -> str:
    """Circle about the origin as a path."""
    r = f"{radius:.4g}"
    return f"M{r} 0A{r} {r} 0 1 0 -{r} 0A{r} {r} 0 1 0 {r} 0Z"


def closed_line(points: Array) -> str:
    """Closed path through points (2, n), y upward."""
    x, y = points
    return f"M{'L'.join(f'{a:.2f} {-b:.2f}' for a, b in zip(x, y, strict=True))}Z"


def path_of(cam: TurningCam) -> str:
    """Contour and bore of a cam, with groove and disc around it, as one path."""
    path = closed_line(cam.outline)
    if cam.wall is not None:
        path = circle_path(cam.disc) + closed_line(cam.wall) + path
    return path + circle_path(cam.bore) if cam.bore else path


def turning_cam(cam: TurningCam, name: str, words: str) -> str:
    """A turning cam as an SVG; CSS turns it where motion is not to be reduced.

    Parameters
    ----------
    name : str    letters, digits and hyphens, one of its own on the page
    words : str   what a screen reader says
    """
    reach = cam.reach
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
    ]
    if cam.wall is None:  # the lower seat of the spring
        follower.append(
            f'<rect class="steel" x="{cam.axis - 1.2 * stem:.4g}" y="{-collar:.4g}" '
            f'width="{2.4 * stem:.4g}" height="{0.07 * reach:.4g}"/>'
        )
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
    pressed_by = (
        f'<g transform="translate(0 {hang:.4g})"><g class="pressed" '
        f'transform="scale(1 {shares[0]:.4g})"><path class="wire" d="M{spring}"/></g></g>'
    )
    above = (
        f'<rect class="fixed" x="{cam.axis - 1.6 * stem:.4g}" y="{-top:.4g}" '
        f'width="{3.2 * stem:.4g}" height="{0.06 * reach:.4g}"/>'
    )
    if cam.wall is not None:
        pressed_by = above = ""
    return (
        f'<svg class="turning-cam" id="{name}" viewBox="{" ".join(f"{v:.4g}" for v in box)}" '
        f'role="img" aria-label="{escape(words)}"><style>{style}</style>'
        f'<path class="axis" d="M{cam.axis:.4g} {1.05 * reach:.4g}V{-top - 0.06 * reach:.4g}"/>'
        f'<g class="turned" transform="rotate(-90)"><path class="cam-body" d="{path_of(cam)}"/>'
        f'<circle class="mark" cx="{mark:.4g}" cy="0" r="{0.045 * reach:.4g}"/></g>'
        f'<circle class="hub" r="{0.03 * reach:.4g}"/>'
        f"{pressed_by}"
        f'<g class="lifted" transform="translate(0 {-lifted[0]:.4g})">{"".join(follower)}</g>'
        f"{guides}{above}</svg>"
    )


def swinging_cam(contour: ArmContour, bore: float, name: str, words: str) -> str:
    """A turning cam under an arm, its pivot above, as an SVG; see `turning_cam`.

    Parameters
    ----------
    bore : float    radius of the bore, m; 0: not stated
    """
    cam, arm = TurningCam.of(contour, bore), contour.pitch.arm
    reach, roller = float(np.hypot(*cam.outline).max()), 1e3 * contour.follower_radius
    pivot, length = 1e3 * float(arm.centre_distance), 1e3 * float(arm.length)
    angle = contour.pitch.start + contour.lift(uniform_turn(STEPS)) / float(arm.length)
    turns = np.degrees(arm.sense * angle)
    beside = length * np.abs(np.sin(angle)).max() + roller
    edge, top = max(reach, float(beside)), pivot + 0.25 * reach
    box = (-1.04 * edge, -top - 0.1 * reach, 2.08 * edge, top + 1.14 * reach)
    style = (
        f"@keyframes lift-{name}{{{_keyframes(f'rotate({each:.4g}deg)' for each in turns)}}}"
        f"#{name} .lifted{{animation-name:lift-{name}}}"
    )
    mark = 0.5 * (max(cam.bore, 0.08 * reach) + float(np.hypot(*cam.outline[:, 0])))
    bar, pin = 0.14 * reach, 0.3 * roller
    return (
        f'<svg class="turning-cam" id="{name}" viewBox="{" ".join(f"{v:.4g}" for v in box)}" '
        f'role="img" aria-label="{escape(words)}"><style>{style}</style>'
        f'<path class="axis" d="M0 {1.05 * reach:.4g}V{-top:.4g}"/>'
        f'<g class="turned" transform="rotate(-90)"><path class="cam-body" d="{path_of(cam)}"/>'
        f'<circle class="mark" cx="{mark:.4g}" cy="0" r="{0.045 * reach:.4g}"/></g>'
        f'<circle class="hub" r="{0.03 * reach:.4g}"/>'
        f'<g transform="translate(0 {-pivot:.4g})">'
        f'<g class="lifted" transform="rotate({turns[0]:.4g})">'
        f'<rect class="steel" x="{-0.5 * bar:.4g}" y="0" width="{bar:.4g}" height="{length:.4g}"/>'
        f'<circle class="roller" cy="{length:.4g}" r="{roller:.4g}"/>'
        f'<circle class="pin" cy="{length:.4g}" r="{pin:.4g}"/>'
        f'<circle class="steel" r="{0.8 * bar:.4g}"/></g>'
        f'<circle class="fixed" r="{0.4 * bar:.4g}"/></g></svg>'
    )


def _keyframes(transforms: Iterable[str]) -> str:
    """Rules of a whole turn, the first one again at its end."""
    whole = [*transforms]
    steps = enumerate([*whole, whole[0]])
    return "".join(f"{100.0 * k / len(whole):.4g}%{{transform:{each}}}" for k, each in steps)

"""Triangulated solids of the 3-D scene: rings, boxes, rods."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import Json

_ROUND = 48
_STEPS_OF_TURN, _WIRE_POINTS = 24, 8  # of a wound wire


@dataclass(frozen=True, eq=False)
class Solid:
    """Triangulated solid: points (3, n), triangles (3, m) of their indices."""

    points: Array
    triangles: NDArray[np.int64]

    def upright(self, height: float) -> Solid:
        """Solid turned from the z to the y axis, its middle at `height`."""
        x, y, z = self.points
        return Solid(np.stack([x, z + height, -y]), self.triangles)

    def shifted(self, across: float) -> Solid:
        """The solid shifted along x."""
        return Solid(self.points + np.array([[across], [0.0], [0.0]]), self.triangles)

    def raised(self, height: float) -> Solid:
        """The solid shifted along y."""
        return Solid(self.points + np.array([[0.0], [height], [0.0]]), self.triangles)

    def deeper(self, along: float) -> Solid:
        """The solid shifted along z."""
        return Solid(self.points + np.array([[0.0], [0.0], [along]]), self.triangles)

    def as_record(self, digits: int) -> dict[str, Json]:
        """Coordinates x, y, z and corners i, j, k, as Plotly names them."""
        points = [[float(f"{v:.{digits}g}") for v in part] for part in self.points.tolist()]
        return dict(zip("xyzijk", [*points, *self.triangles.tolist()], strict=True))


def ring(outline: Array, width: float) -> Solid:
    """Extrusion of a closed outline (2, n), mm, along z from -`width`/2 to `width`/2, without end
    faces.
    """
    count = outline.shape[1]
    low, high = (np.vstack([outline, np.full(count, side * width / 2)]) for side in (-1, 1))
    here = np.arange(count)
    there = (here + 1) % count
    first = np.stack([here, there, there + count])
    second = np.stack([here, there + count, here + count])
    return Solid(np.hstack([low, high]), np.hstack([first, second]))


def tube(outer: Array, inner: Array, height: float) -> Solid:
    """Flat ring between two closed outlines (2, n), mm, in the plane z = `height`."""
    count = outer.shape[1]
    points = np.vstack([np.hstack([outer, inner]), np.full(2 * count, height)])
    here = np.arange(count)
    there = (here + 1) % count
    first = np.stack([here, there, there + count])
    second = np.stack([here, there + count, here + count])
    return Solid(points, np.hstack([first, second]))


def sector(angles: Array, radii: tuple[float, float], width: float) -> Solid:
    """Sector of a ring with end faces, centred at z = 0, mm.

    Parameters
    ----------
    angles : array (n,)   from one side to the other, rad
    radii : tuple         inner and outer, mm
    width : float         along z, mm
    """
    count, (inner, outer) = angles.size, radii
    arc = np.stack([np.cos(angles), np.sin(angles)])
    outline = np.hstack([outer * arc, inner * arc[:, ::-1]])
    points = np.hstack([outer * arc, inner * arc])
    here = np.arange(count - 1)
    first = np.stack([here, here + 1, here + 1 + count])
    second = np.stack([here, here + 1 + count, here + count])
    ends = [
        Solid(np.vstack([points, np.full(2 * count, 0.5 * side * width)]),
              np.hstack([first, second]))
        for side in (-1, 1)
    ]  # fmt: skip
    return joined([ring(outline, width), *ends])


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Solid:
    """Rectangular box between its least and greatest corner, mm."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1])
                        for z in (low[2], high[2])])  # fmt: skip
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    halves = [half for a, b, c, d in sides for half in ((a, b, c), (a, c, d))]
    return Solid(corners.T, np.array(halves).T)


def joined(solids: Sequence[Solid]) -> Solid:
    """Union of several solids as one."""
    starts = np.cumsum([0, *(solid.points.shape[1] for solid in solids)])
    triangles = [solid.triangles + start for solid, start in zip(solids, starts, strict=False)]
    return Solid(np.hstack([solid.points for solid in solids]), np.hstack(triangles))


@dataclass(frozen=True, eq=False)
class Lattice:
    """Points (i, j, k, 3) of a structured block of hexahedra."""

    points: Array

    def surface(self) -> tuple[Solid, NDArray[np.int64], NDArray[np.int64]]:
        """Faces of the block, beginning with k = 0.

        Returns
        -------
        solid, nodes, cells   the solid; number of the node of each of its points, and of the cell
                              behind each of its triangles, i slowest and k fastest
        """
        shape = self.points.shape[:3]
        nodes = np.arange(np.prod(shape)).reshape(shape)
        cells = np.arange(np.prod([n - 1 for n in shape])).reshape([n - 1 for n in shape])
        numbers, triangles, behind = [], [], []
        start = 0
        for axis in (2, 1, 0):
            for end in (0, -1):
                face, cell = nodes.take(end, axis), cells.take(end, axis).ravel()
                here = start + np.arange(face.size).reshape(face.shape)
                a, b, c, d = here[:-1, :-1], here[1:, :-1], here[1:, 1:], here[:-1, 1:]
                halves = (
                    np.stack([part.ravel() for part in half]) for half in ((a, b, c), (a, c, d))
                )
                triangles += list(halves)
                behind += [cell, cell]
                numbers.append(face.ravel())
                start += face.size
        chosen = np.concatenate(numbers)
        points = self.points.reshape(-1, 3)[chosen].T
        return Solid(points, np.hstack(triangles)), chosen, np.concatenate(behind)


def rod(diameter: float, start: float, end: float) -> Solid:
    """Circular rod along y from `start` to `end`, mm, without end faces."""
    return ring(0.5 * diameter * unit_circle(), end - start).upright((start + end) / 2)


def pin(radius: float, half: float) -> Solid:
    """Circular pin along z through the origin, with end faces."""
    outline = radius * unit_circle()
    ends = [tube(outline, 0.0 * outline, side * half) for side in (-1, 1)]
    return joined([ring(outline, 2 * half), *ends])


def helix(diameter: float, wire: float, turns: float, length: float) -> Solid:
    """Surface of a round wire wound about the y axis, mm.

    Parameters
    ----------
    diameter : float   of the coils, to the middle of the wire
    wire : float       diameter of the wire
    turns : float      number of coils
    length : float     along y, from zero
    """
    winding = 2.0 * np.pi * np.linspace(0.0, turns, max(int(turns * _STEPS_OF_TURN), 8))
    out = np.stack([np.cos(winding), 0.0 * winding, np.sin(winding)])
    up = np.array([[0.0], [1.0], [0.0]])
    middle = 0.5 * diameter * out + up * np.linspace(0.0, length, winding.size)
    section = 0.5 * wire * unit_circle()[:, :: _ROUND // _WIRE_POINTS]
    wall = np.stack([middle + out * x + up * y for x, y in section.T], axis=1)
    rows, points = np.arange(winding.size - 1)[:, None], section.shape[1]
    here = rows * points + np.arange(points)
    beside = rows * points + (np.arange(points) + 1) % points
    order = wall.transpose(0, 2, 1).reshape(3, -1)
    first = np.stack([here, beside, beside + points]).reshape(3, -1)
    second = np.stack([here, beside + points, here + points]).reshape(3, -1)
    return Solid(order, np.hstack([first, second]))


def fork(radius: float, hub: float, width: float, stem: float, top: float) -> Solid:
    """Fork with the pin of a roller on a stem along y, about the roller centre, mm.

    Parameters
    ----------
    radius, hub : float   of roller and pin
    width : float         of the roller
    stem : float          diameter of the stem
    top : float           height of the end of the stem
    """
    plate, bridge, half = 0.25 * width, radius + 0.15 * stem, 0.5 * min(stem, radius)
    inside, outside = width / 2 + 0.1 * width, width / 2 + 0.1 * width + plate
    plates = [
        box((-half, -half, min(side * inside, side * outside)),
            (half, bridge + plate, max(side * inside, side * outside)))
        for side in (-1.0, 1.0)
    ]  # fmt: skip
    joint = box((-half, bridge, -outside), (half, bridge + plate, outside))
    axle = pin(hub, 1.1 * outside)
    return joined([*plates, joint, axle, rod(stem, bridge + plate, top)])


def unit_circle() -> Array:
    """Circle (2, n) of radius 1 about the origin."""
    angle = np.linspace(0.0, 2 * np.pi, _ROUND, endpoint=False)
    return np.stack([np.cos(angle), np.sin(angle)])

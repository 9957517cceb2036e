"""Triangulation of the region within outlines, by gmsh."""

from __future__ import annotations

import ctypes
import signal
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import GeometryError, MeshError, in_millimetres
from camwright.meshes.element_size import MILLIMETRE, SizeField
from camwright.meshes.outline import Facets, crossing

Index = NDArray[np.int64]

# every option that can change a mesh, so that it depends on no configuration file, environment or
# earlier use of the library
_OPTIONS = {
    "General.Terminal": 0,
    "General.NumThreads": 1,
    "Mesh.Binary": 0,
    "Mesh.MshFileVersion": 4.1,
    "Mesh.SaveAll": 0,
    "Mesh.Algorithm": 6,  # frontal-Delaunay: the best angles of those tried
    "Mesh.AlgorithmSwitchOnFailure": 0,
    "Mesh.ElementOrder": 1,
    "Mesh.MaxNumThreads1D": 1,
    "Mesh.MaxNumThreads2D": 1,
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFactor": 1,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeMax": 1e22,
    "Mesh.MeshSizeMin": 0,
    "Mesh.RandomFactor": 1e-9,
    "Mesh.RandomSeed": 1,
    "Mesh.Renumber": 0,  # outline nodes keep their numbers
    "Mesh.RecombineAll": 0,
    "Mesh.Smoothing": 1,
}

TRIANGLES_MAX = 60_000
"""Maximum number of triangles of a body; twice as many need more than 6 GB to be solved."""

_STATE_BYTES = 1024  # more than a `struct sigaction` of C, of which 152 bytes are used by Linux


@contextmanager
def signals_kept() -> Iterator[None]:
    """Context manager that restores the signal handlers of this process after gmsh has started.

    gmsh on starting sets SIGTERM, SIGHUP, SIGPIPE and those of faults back to the default, by which
    the process would end without a word or clean-up. Python reads and sets its own handlers alone,
    and in the main thread alone: so by C. A signal that comes meanwhile waits.
    """
    action = ctypes.CDLL(None).sigaction
    kept = {}
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
    for number in range(1, signal.NSIG):
        state = ctypes.create_string_buffer(_STATE_BYTES)
        if action(number, None, state) == 0:
            kept[number] = state
    try:
        yield
    finally:
        for number, state in kept.items():
            action(number, state, None)
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)


@contextmanager
def session() -> Iterator[ModuleType]:
    """Context manager: gmsh with an empty model and the options of this module.

    If gmsh is already initialized, its options and current model are restored afterwards;
    otherwise it is finalized.
    """
    import gmsh

    running = bool(gmsh.isInitialized())
    if not running:
        with signals_kept():
            gmsh.initialize(readConfigFiles=False, interruptible=False)
    kept_options = {option: gmsh.option.getNumber(option) for option in _OPTIONS}
    kept_model = gmsh.model.getCurrent()
    own_model = f"camwright {len(gmsh.model.list())}"
    try:
        for option, value in _OPTIONS.items():
            gmsh.option.setNumber(option, value)
        gmsh.model.add(own_model)
        yield gmsh
    finally:
        if running:
            gmsh.model.setCurrent(own_model)
            gmsh.model.remove()
            for option, value in kept_options.items():
                gmsh.option.setNumber(option, value)
            if kept_model in gmsh.model.list():
                gmsh.model.setCurrent(kept_model)
        else:
            gmsh.finalize()


@dataclass(frozen=True, eq=False)
class Triangulation:
    """Quadratic triangles: points (2, n), m; triangles (6, m); boundaries by name, (3, k)."""

    points: Array
    triangles: Index
    boundaries: Mapping[str, Index]


def triangulate(
    loops: Sequence[Sequence[Facets]], size: SizeField, *, grid_bits: int = 12
) -> Triangulation:
    """Quadratic triangles of the region on the left of the `loops`, the outer one first.

    Corners are numbered first, those on the outline in its order, then mid-side nodes. gmsh gets
    outline and sizes rounded to a grid, so that their round-off does not change the triangles; the
    corners on the outline remain exact.

    Parameters
    ----------
    grid_bits : int   the step of the grid is at most 2^-grid_bits of the shortest edge of the
                      outline

    Raises
    ------
    GeometryError
        If the outline crosses itself.
    MeshError
        If the sizes make more than `TRIANGLES_MAX`, or gmsh cannot fill the region.
    """
    corners, rings = _ring_nodes(loops)
    _require_few(corners, rings, size.far_size)
    following = np.hstack([np.roll(ring, -1) for ring in rings])
    crossed = crossing(corners, corners[:, following])
    if crossed is not None:  # gmsh would not terminate
        x, y = crossed / MILLIMETRE
        where = f"({x:.3f}, {y:.3f}) mm"
        raise GeometryError(f"outline = crosses itself at {where}, must be free of crossings")
    step = _grid_step(corners, rings, grid_bits)
    try:
        with session() as gmsh:
            rounded = np.rint(corners / step) * step
            points, triangles = _fill(gmsh, rounded, rings, size.on_grid(step))
            points[:, : corners.shape[1]] = corners  # exact
    except MeshError:
        raise
    except Exception as error:
        raise MeshError(f"gmsh failed on the outline: {_one_line(error)}") from error
    named = _named_edges(loops, rings)
    return _quadratic(points, triangles, named)


def _require_few(corners: Array, rings: Sequence[Index], edge: float) -> None:
    """Refuse a region of more equilateral triangles of an edge, m, than can be solved."""
    x, y = corners
    area = sum(0.5 * float(x[r] @ np.roll(y[r], -1) - y[r] @ np.roll(x[r], -1)) for r in rings)
    count = area / (0.25 * np.sqrt(3.0) * edge**2)
    if count > TRIANGLES_MAX:
        shown, most = in_millimetres(edge, np.sqrt(count / TRIANGLES_MAX) * edge)
        about = float(f"{count:.2g}")
        raise MeshError(
            f"mesh = about {about:.0f} triangles of {shown}, which its thinnest wall or sharpest "
            f"curve needs, must be <= {TRIANGLES_MAX}, of {most} each"
        )


def _ring_nodes(loops: Sequence[Sequence[Facets]]) -> tuple[Array, list[Index]]:
    """Distinct outline points (2, n), m, and their numbers in order for every loop."""
    rings, blocks, first = [], [], 0
    for loop in loops:
        ring = np.hstack([piece.ends[:, :-1] for piece in loop])
        rings.append(np.arange(first, first + ring.shape[1]))
        blocks.append(ring)
        first += ring.shape[1]
    return np.hstack(blocks), rings


def _fill(
    gmsh: ModuleType, corners: Array, rings: Sequence[Index], size: SizeField
) -> tuple[Array, Index]:
    """Linear triangles between closed rings of corners: points (2, n) m, triangles (3, m)."""
    model = gmsh.model
    scaled = np.vstack([corners / MILLIMETRE, np.zeros(corners.shape[1])])
    curves = []
    for ring in rings:
        first = scaled[:, ring[0]]
        vertex = model.addDiscreteEntity(0)
        model.setCoordinates(vertex, *first)
        curve = model.addDiscreteEntity(1, -1, [vertex, vertex])
        model.mesh.addNodes(0, vertex, [ring[0] + 1], first)
        model.mesh.addNodes(1, curve, ring[1:] + 1, scaled[:, ring[1:]].T.ravel())
        model.mesh.addElementsByType(vertex, 15, [], [ring[0] + 1])
        ends = np.column_stack([ring, np.roll(ring, -1)]) + 1
        model.mesh.addElementsByType(curve, 1, [], ends.ravel())
        curves.append(curve)
    model.geo.addPlaneSurface([model.geo.addCurveLoop([curve]) for curve in curves])
    model.geo.synchronize()
    _impose(gmsh, size)
    model.mesh.generate(2)
    tags, coordinates, _ = model.mesh.getNodes()
    _, connectivity = model.mesh.getElementsByType(2)
    order = np.argsort(tags)
    known, fixed = tags[order].astype(np.int64), corners.shape[1]
    if not connectivity.size or not np.array_equal(known[:fixed], np.arange(1, fixed + 1)):
        raise MeshError("mesh of gmsh = empty or without nodes of the outline, must fill it")
    points = coordinates.reshape(-1, 3)[order, :2].T * MILLIMETRE
    triangles = np.searchsorted(known, connectivity.astype(np.int64)).reshape(-1, 3).T
    return points, _counter_clockwise(points, triangles)


def _grid_step(corners: Array, rings: Sequence[Index], bits: int) -> float:
    """Step, m, of the grid on which gmsh, which decides by the last bit, sees no round-off.

    A power of two, at most 2^-bits of the shortest edge, so that the shape of the elements is kept.
    """
    edges = [corners[:, np.roll(ring, -1)] - corners[:, ring] for ring in rings]
    shortest = min(float(np.hypot(*edge).min()) for edge in edges)
    return float(2.0 ** (int(np.frexp(shortest)[1]) - 1 - bits))


def _impose(gmsh: ModuleType, size: SizeField) -> None:
    """Set `size` as the only element size."""
    fields = gmsh.model.mesh.field
    gmsh.option.setNumber("Mesh.MeshSizeMax", size.far_size / MILLIMETRE)
    tags = []
    for formula in size.formulas():
        tags.append(fields.add("MathEval"))
        fields.setString(tags[-1], "F", formula)
    if tags:
        least = fields.add("Min")
        fields.setNumbers(least, "FieldsList", tags)
        fields.setAsBackgroundMesh(least)


def _counter_clockwise(points: Array, triangles: Index) -> Index:
    """`triangles` (3, m), all counter-clockwise."""
    a, b, c = (points[:, triangles[k]] for k in range(3))
    clockwise = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0
    oriented = triangles.copy()
    oriented[1:, clockwise] = triangles[:0:-1, clockwise]
    return oriented


def _named_edges(
    loops: Sequence[Sequence[Facets]], rings: Sequence[Index]
) -> list[tuple[str, Index, Array]]:
    """Name, edges (2, k) as node numbers and edge middles (2, k), m, of every piece."""
    named = []
    for loop, ring in zip(loops, rings, strict=True):
        ends = np.vstack([ring, np.roll(ring, -1)])
        start = 0
        for piece in loop:
            stop = start + piece.middles.shape[1]
            named.append((piece.name, ends[:, start:stop], piece.middles))
            start = stop
    return named


def _quadratic(
    points: Array, triangles: Index, named: Sequence[tuple[str, Index, Array]]
) -> Triangulation:
    """Quadratic triangles from linear ones, mid-side nodes of outline edges on the curve.

    Parameters
    ----------
    points : array (2, n)      corners, m
    triangles : array (3, m)   corner numbers, counter-clockwise
    named : sequence           of each piece of outline: name, corner numbers (2, k) of the ends of
        its edges, points (2, k), m, of the curve at their middles

    Raises
    ------
    MeshError
        If an edge of the outline is not an edge of a triangle.
    """
    count = points.shape[1]
    sides = np.stack([triangles, np.roll(triangles, -1, axis=0)])  # 01, 12, 20
    keys = sides.min(axis=0) * count + sides.max(axis=0)
    edges, number = np.unique(keys, return_inverse=True)
    number = number.reshape(keys.shape)
    low, high = np.divmod(edges, count)
    middles = 0.5 * (points[:, low] + points[:, high])
    boundaries: dict[str, list[Index]] = {}
    for name, ends, on_curve in named:
        key = ends.min(axis=0) * count + ends.max(axis=0)
        place = np.minimum(np.searchsorted(edges, key), edges.size - 1)
        if not np.array_equal(edges[place], key):
            raise MeshError(f"facets of '{name}' = changed by gmsh, must be those of the outline")
        middles[:, place] = on_curve
        boundaries.setdefault(name, []).append(np.vstack([ends, count + place]))
    return Triangulation(
        np.hstack([points, middles]),
        np.vstack([triangles, count + number]),
        {name: np.hstack(parts) for name, parts in boundaries.items()},
    )


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())

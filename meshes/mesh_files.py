"""Mesh and field files: MSH of gmsh, VTU of VTK; lengths in mm."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import MeshError, ResultError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.element_size import MILLIMETRE
from camwright.meshes.gmsh_mesher import Index, session
from camwright.meshes.vtu import HEXAHEDRON, QUADRANGLE, QUADRATIC_TRIANGLE, VtuGrid, vtu

UNITS = "units_mm_N_MPa"
"""Field data that names the units of every VTU file."""

_LINE3, _TRIANGLE6 = 8, 9  # element types of gmsh

Fields = Mapping[str, ArrayLike]


def write_msh(path: str | Path, meshes: Mapping[str, BodyMesh]) -> None:
    """gmsh file of bodies, format 4.1, second order.

    Physical groups: the body's name for its triangles, such as ``cam``, and ``body_boundary`` for
    its facets, such as ``cam_contour``.

    Raises
    ------
    ResultError
        If the file cannot be written; one already there is left as it was.
    """
    with replacing(path) as temporary, session() as gmsh:
        first = 1
        for name, mesh in meshes.items():
            _add_body(gmsh, name, mesh, first)
            first += mesh.points.shape[1]
        gmsh.write(str(temporary))
        if not temporary.read_bytes().endswith(b"$EndElements\n"):  # gmsh ignores a full disk
            raise OSError("incomplete file")


def _add_body(gmsh: ModuleType, name: str, mesh: BodyMesh, first: int) -> None:
    """Add a body to gmsh's current model with its physical groups, its nodes numbered
    from `first`.
    """
    model = gmsh.model
    coordinates = np.vstack([mesh.points / MILLIMETRE, np.zeros(mesh.points.shape[1])])
    free = np.ones(mesh.points.shape[1], dtype=bool)

    def classify(dimension: int, entity: int, nodes: Index) -> None:
        model.mesh.addNodes(dimension, entity, nodes + first, coordinates[:, nodes].T.ravel())

    curves = []
    for boundary, facets in mesh.boundaries.items():
        curve = model.addDiscreteEntity(1)
        nodes = np.unique(facets)
        classify(1, curve, nodes[free[nodes]])
        free[nodes] = False
        model.mesh.addElementsByType(curve, _LINE3, [], (facets + first).T.ravel())
        model.addPhysicalGroup(1, [curve], name=f"{name}_{boundary}")
        curves.append(curve)
    surface = model.addDiscreteEntity(2, -1, curves)
    classify(2, surface, np.flatnonzero(free))
    model.mesh.addElementsByType(surface, _TRIANGLE6, [], (mesh.triangles + first).T.ravel())
    model.addPhysicalGroup(2, [surface], name=name)


def write_vtu(
    path: str | Path,
    bodies: Mapping[str, BodyMesh],
    point_data: Mapping[str, Fields] | None = None,
    field_data: Mapping[str, float] | None = None,
) -> None:
    """VTU file of bodies with fields, as quadratic triangles.

    Parameters
    ----------
    path
    bodies : mapping                meshes by name
    point_data : mapping            body name -> field name, unit included -> (n,) or (c, n) at the
                                    nodes; the same fields in each body. A vector (2, n) gets a
                                    third component 0.
    field_data : mapping            numbers of the file as a whole, besides its units

    With several bodies, cell and point data ``body`` number them from 0.

    Raises
    ------
    MeshError
        If a field does not fit its mesh.
    ResultError
        If the file cannot be written; one already there is left as it was.
    """
    data = point_data or {name: {} for name in bodies}
    if data.keys() != bodies.keys():
        raise MeshError(f"fields of bodies {sorted(data)}, must be of {sorted(bodies)}")
    starts = np.cumsum([0, *(mesh.points.shape[1] for mesh in bodies.values())])
    points = np.hstack([mesh.points for mesh in bodies.values()]) / MILLIMETRE
    shifted = [m.triangles.T + s for m, s in zip(bodies.values(), starts, strict=False)]
    fields = _joined(bodies, data)
    cell_data = {}
    if len(bodies) > 1:
        fields["body"] = np.repeat(np.arange(len(bodies)), np.diff(starts))
        cell_data["body"] = np.repeat(np.arange(len(bodies)), [len(s) for s in shifted])
    grid = VtuGrid(
        _in_space(points),
        np.vstack(shifted),
        QUADRATIC_TRIANGLE,
        fields,
        cell_data,
        {UNITS: 1.0, **(field_data or {})},
    )
    _write_grid(path, grid)


def _in_space(points: Array) -> Array:
    return np.column_stack([points.T, np.zeros(points.shape[1])])


def _write_grid(path: str | Path, grid: VtuGrid) -> None:
    with replacing(path) as temporary:
        temporary.write_bytes(vtu(grid))


def _joined(bodies: Mapping[str, BodyMesh], data: Mapping[str, Fields]) -> dict[str, Array]:
    """Fields of all bodies one after the other by name, (n,) or (n, c), nodes first; a vector of
    two components gets a third one, 0.
    """
    names = list(next(iter(data.values())))
    parts: dict[str, list[Array]] = {name: [] for name in names}
    for body, mesh in bodies.items():
        if set(data[body]) != set(names):
            raise MeshError(f"fields of '{body}' = {sorted(data[body])}, must be {sorted(names)}")
        for name in names:
            values = np.asarray(data[body][name], dtype=float)
            if values.ndim not in (1, 2) or values.shape[-1] != mesh.points.shape[1]:
                raise MeshError(
                    f"field '{name}' = {values.shape}, "
                    f"must be (n,) or (c, n) with n = {mesh.points.shape[1]} nodes"
                )
            if values.shape[0] == 2 and values.ndim == 2:
                values = np.vstack([values, np.zeros(values.shape[1])])
            parts[name].append(values.T)
    return {name: np.concatenate(values) for name, values in parts.items()}


def write_rectangles(path: str | Path, x: Array, y: Array, cell_data: Mapping[str, Array]) -> None:
    """VTU file of rectangles in the plane z = 0 with values of each.

    Parameters
    ----------
    x, y : array (k + 1,), (m + 1,)   edges, m
    cell_data : mapping               name, unit included -> (m, k)

    Raises
    ------
    ResultError
        If the file cannot be written; one already there is left as it was.
    """
    along, across = np.meshgrid(y / MILLIMETRE, x / MILLIMETRE, indexing="ij")
    points = np.stack([across.ravel(), along.ravel(), np.zeros(across.size)], axis=1)
    first = np.arange(across.size).reshape(across.shape)[:-1, :-1].ravel()
    cells = np.stack([first, first + 1, first + x.size + 1, first + x.size], axis=1)
    values = {name: np.ascontiguousarray(field).ravel() for name, field in cell_data.items()}
    grid = VtuGrid(points, cells, QUADRANGLE, {}, values, {UNITS: 1.0})
    with replacing(path) as temporary:
        temporary.write_bytes(vtu(grid))


def write_hexahedra(
    path: str | Path,
    points: Array,
    cells: Index,
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array],
    field_data: Mapping[str, float],
) -> None:
    """VTU file of hexahedra with fields.

    Parameters
    ----------
    points : array (n, 3)                   m
    cells : array (m, 8)                    corners, in the order of VTK
    point_data, cell_data : mapping         name, unit included -> (n, ...) or (m, ...)
    field_data : mapping                    numbers of the file as a whole, besides its units

    Raises
    ------
    ResultError
        If the file cannot be written; one already there is left as it was.
    """
    grid = VtuGrid(
        points / MILLIMETRE,
        cells,
        HEXAHEDRON,
        {name: np.ascontiguousarray(values) for name, values in point_data.items()},
        {name: np.ascontiguousarray(values) for name, values in cell_data.items()},
        {UNITS: 1.0, **field_data},
    )
    _write_grid(path, grid)


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Context manager: temporary file beside `path` that replaces it on success; on an error `path`
    stays as it was.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        temporary.touch()
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise ResultError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)

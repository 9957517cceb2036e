"""VTKHDF file of fields over the turn: a block per body, a step per cam angle.

Written by h5py: the writer of VTK 9.7 stamps the time of writing into the file and rounds the
times to single precision. Meshes of three-node triangles in a plane; lengths in mm.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import ParseError

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.meshes.gmsh_mesher import Index
from camwright.meshes.mesh_files import UNITS, replacing
from camwright.pipeline.base.files import DEFLATE_RATIO

if TYPE_CHECKING:
    import h5py

ZONE = "_contact"
"""Suffix of the name of a body for the mesh below its contact."""

HIDDEN = "vtkGhostType"
"""Cell data by which VTK leaves out hidden cells."""

_HIDDEN_CELL, _TRIANGLE = 32, 5  # flag and cell type of VTK
_VERSION = (2, 2)
# VTK 9.7 does not read the newest file format.
_FORMAT = ("earliest", "v110")
_BITS = 8  # dropped from the 23 of the mantissa: relative error of point data at most 8e-6
_COMPRESSION = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
_UNREADABLE = (OSError, KeyError, ValueError, IndexError, TypeError, RuntimeError, AttributeError)

Notes = Mapping[str, ArrayLike | Sequence[str]]


@dataclass(frozen=True, eq=False)
class MeshBlock:
    """Mesh of a block: triangles (3, t) on `nodes` nodes.

    points (2, nodes), mm, are those of every step; None: they move.
    """

    triangles: Index
    nodes: int
    points: Array | None = None


@dataclass(frozen=True, eq=False)
class FieldStep:
    """Fields of a block at one step: points (2, n), mm, triangles (3, t), hidden (t,), data."""

    points: Array
    triangles: Index
    hidden: NDArray[np.bool_]
    data: Mapping[str, Array]


class FieldFile:
    """VTKHDF file being written.

    Parameters
    ----------
    times : (s,)        cam angles, deg, ascending
    blocks : mapping    meshes by name
    fields : mapping    name, unit included -> number of components at each node
    notes : mapping     name -> (s,) numbers or words
    """

    def __init__(
        self, file: h5py.File, times: ArrayLike, blocks: Mapping[str, MeshBlock],
        fields: Mapping[str, int], notes: Notes,
    ) -> None:  # fmt: skip
        """Create the groups of an empty file: a block per mesh with room for the fields at each
        time, and the notes of each step. For the parameters see the class.
        """
        self._times = np.asarray(times, dtype=float)
        self._blocks = blocks
        root = _group(file, "VTKHDF", "MultiBlockDataSet")
        assembly = root.create_group("Assembly", track_order=True)
        self._groups = {}
        for index, (name, block) in enumerate(blocks.items()):
            group = self._groups[name] = _group(root, name, "UnstructuredGrid")
            group.attrs["Index"] = index
            assembly.create_group(name, track_order=True)[name] = _soft_link(f"/VTKHDF/{name}")
            self._open(group, block, fields)
        self._note(root, notes)

    def _open(self, group: h5py.Group, block: MeshBlock, fields: Mapping[str, int]) -> None:
        """Create the datasets of a block: its mesh, its steps, and room for the data of each step.

        Parameters
        ----------
        group : Group       of the block
        block : MeshBlock   its mesh
        fields : mapping    name -> number of components at each node
        """
        count, cells, steps = block.nodes, block.triangles.shape[1], self._times.size
        group["NumberOfPoints"] = np.array([count])
        group["NumberOfCells"] = np.array([cells])
        group["NumberOfConnectivityIds"] = np.array([3 * cells])
        for name, values in (
            ("Connectivity", block.triangles.T.ravel().astype("<i8")),
            ("Offsets", np.arange(0, 3 * cells + 1, 3, dtype="<i8")),
            ("Types", np.full(cells, _TRIANGLE, dtype="u1")),
        ):
            group.create_dataset(name, data=values, **_COMPRESSION)
        if block.points is None:
            self._room(group, "Points", count, 3)
        else:
            points = _in_space(block.points.T).astype("<f4")
            group.create_dataset("Points", data=points, **_COMPRESSION)
        nothing, every = np.zeros(steps, dtype="<i8"), np.arange(steps, dtype="<i8")
        time = self._steps(group)
        time["PartOffsets"] = time["CellOffsets"] = time["ConnectivityIdOffsets"] = nothing
        time["NumberOfParts"] = np.ones(steps, dtype="<i8")
        time["PointOffsets"] = nothing if block.points is not None else count * every
        at_points, at_cells = group.create_group("PointData"), group.create_group("CellData")
        for name, components in fields.items():
            self._room(at_points, name, count, components)
            time[f"PointDataOffsets/{name}"] = count * every
        self._room(at_cells, HIDDEN, cells, 1, "u1")
        time[f"CellDataOffsets/{HIDDEN}"] = cells * every

    def _room(
        self, group: h5py.Group, name: str, rows: int, components: int, kind: str = "<f4"
    ) -> None:
        """Empty data of all steps, compressed in one piece per step."""
        tail = () if components == 1 else (components,)
        group.create_dataset(
            name, (rows * self._times.size, *tail), kind, chunks=(rows, *tail), **_COMPRESSION
        )

    def _steps(self, group: h5py.Group) -> h5py.Group:
        """Group of the steps, with their times."""
        time = group.create_group("Steps")
        time.attrs["NSteps"] = self._times.size
        time["Values"] = self._times
        return time

    def _note(self, root: h5py.Group, notes: Notes) -> None:
        """Write numbers and words of each step as field data of the file; VTK 9.7 reads those of
        the file, not those of a block.
        """
        time, steps = self._steps(root), self._times.size
        constant: Notes = {UNITS: np.ones(steps)}
        for name, values in (*constant.items(), *notes.items()):
            root[f"FieldData/{name}"] = _plain(values)
            time[f"FieldDataOffsets/{name}"] = np.arange(steps, dtype="<i8")
            time[f"FieldDataSizes/{name}"] = np.ones((steps, 2), dtype="<i8")

    def write(
        self, name: str, first: int, data: Mapping[str, Array], hidden: NDArray[np.bool_],
        points: Array | None = None,
    ) -> None:  # fmt: skip
        """Write the fields of a block at k consecutive steps.

        Parameters
        ----------
        name : str                     of the block
        first : int                    index of the first step
        data : mapping                 field -> (k, nodes) or (k, nodes, components)
        hidden : array (k, t)          cells that are left out
        points : array (k, nodes, 2)   mm; None where they do not move
        """
        group = self._groups[name]
        if points is not None:
            _fill(group["Points"], first, _in_space(points))
        for field, values in data.items():
            _fill(group[f"PointData/{field}"], first, _rounded(values))
        _fill(group[f"CellData/{HIDDEN}"], first, _HIDDEN_CELL * hidden.astype("u1"))


@contextmanager
def field_file(
    path: Path, times: ArrayLike, blocks: Mapping[str, MeshBlock], fields: Mapping[str, int],
    notes: Notes,
) -> Iterator[FieldFile]:  # fmt: skip
    """Context manager: VTKHDF file at `path`; equal input gives equal bytes.

    Raises
    ------
    ResultError
        If the file cannot be written; one already there is left as it was.
    """
    import h5py

    with replacing(path) as temporary, h5py.File(temporary, "w", libver=_FORMAT) as file:
        yield FieldFile(file, times, blocks, fields, notes)


@dataclass(frozen=True, eq=False)
class Series:
    """Steps of a file: cam angles (s,), deg, and notes by name, (s,)."""

    path: Path
    times: Array
    notes: Mapping[str, NDArray[Any]]

    def step(self, number: int) -> dict[str, FieldStep]:
        """Blocks at one step, by name.

        Raises
        ------
        ResultError
            If the file is unreadable or not one of these series.
        """
        with _opened(self.path) as root:
            return {name: _step(root[name], number) for name in _names(root)}


def read_series(path: Path) -> Series:
    """Steps and notes of a VTKHDF file.

    Raises
    ------
    ResultError
        If the file is absent, unreadable or not one of these series.
    """
    with _opened(path) as root:
        notes = {name: values[()] for name, values in root["FieldData"].items()}
        return Series(path, root["Steps/Values"][()], notes)


@dataclass(frozen=True, eq=False)
class EndField:
    """Half x >= 0 of both bodies at the certified ends of contact.

    points (n, 3), mm; cells (m, 8) of points; body (m,): 0 cam, 1 follower; von_mises (n,) and
    contact pressure (m,), MPa; cam angle, deg; force, N; moment, N mm.
    """

    points: Array
    cells: Index
    body: Index
    von_mises: Array
    pressure: Array
    cam_angle: float
    force: float
    moment: float


def read_end_field(path: Path) -> EndField:
    """Field of ``fields/ends.vtu``.

    Raises
    ------
    ResultError
        If the file cannot be read.
    """
    import meshio

    try:
        grid = meshio.vtu.read(path)
        body, pressure = (grid.cell_data[name][0] for name in ("body", "contact_pressure_MPa"))
        return EndField(
            np.asarray(grid.points, dtype=float),
            np.asarray(grid.cells[0].data, dtype=np.intp),
            np.asarray(body, dtype=np.intp),
            np.asarray(grid.point_data["von_mises_MPa"], dtype=float),
            np.asarray(pressure, dtype=float),
            *(
                float(grid.field_data[name][0])
                for name in ("cam_angle_deg", "force_N", "moment_Nmm")
            ),
        )
    except (*_UNREADABLE, meshio.ReadError, ParseError, zlib.error) as error:
        raise ResultError(f"{path}: {error}") from None


@contextmanager
def _opened(path: Path) -> Iterator[h5py.Group]:
    """Context manager: root group of a VTKHDF file for reading; ResultError where it is no field
    file of a run.
    """
    import h5py

    if not path.is_file():
        raise ResultError(f"{path.name}: no such file")
    try:
        with h5py.File(path, "r") as file:
            _require_own_data(file, path.stat().st_size)
            yield file["VTKHDF"]
    except _UNREADABLE as error:
        raise ResultError(f"{path.name}: not a field file of a run ({error})") from None


def _require_own_data(file: h5py.File, length: int) -> None:
    """Refuse, by ValueError, an HDF5 file with data in another file, or with more data than one of
    `length` bytes can hold.
    """
    import h5py

    def outside(name: str, link: object) -> str | None:
        return f"{name} lies in another file" if isinstance(link, h5py.ExternalLink) else None

    def unbounded(name: str, entry: object) -> str | None:
        if not isinstance(entry, h5py.Dataset):
            return None
        if entry.external or entry.is_virtual:
            return f"{name} lies in another file"
        chunk = math.prod(entry.chunks) * entry.dtype.itemsize if entry.chunks else 0
        if max(entry.nbytes, chunk) > DEFLATE_RATIO * length:
            return f"{name} claims {entry.nbytes} bytes, more than it can hold"
        return None

    reason = file.visititems_links(outside) or file.visititems(unbounded)
    if reason:
        raise ValueError(reason)


def _names(root: h5py.Group) -> list[str]:
    """Names of the blocks in their order."""
    names = [name for name in root if "Index" in root[name].attrs]
    return sorted(names, key=lambda name: int(root[name].attrs["Index"]))


def _step(group: h5py.Group, number: int) -> FieldStep:
    """Points (2, nodes), mm, triangles (3, t), hidden triangles and fields of a block at the step
    of index `number`.
    """
    count, cells = int(group["NumberOfPoints"][0]), int(group["NumberOfCells"][0])
    start = int(group["Steps/PointOffsets"][number])
    rows = slice(number * count, (number + 1) * count)
    hidden = group[f"CellData/{HIDDEN}"][number * cells : (number + 1) * cells]
    return FieldStep(
        group["Points"][start : start + count].T[:2].astype(float),
        group["Connectivity"][()].reshape(-1, 3).T,
        (hidden & _HIDDEN_CELL) > 0,
        {name: values[rows].astype(float) for name, values in group["PointData"].items()},
    )


def _group(parent: h5py.Group, name: str, kind: str) -> h5py.Group:
    """New group of a VTKHDF file with version and kind of data set."""
    group = parent.create_group(name, track_order=True)
    group.attrs["Version"] = np.array(_VERSION)
    group.attrs["Type"] = np.bytes_(kind)
    return group


def _soft_link(target: str) -> h5py.SoftLink:
    import h5py

    return h5py.SoftLink(target)


def _plain(values: ArrayLike | Sequence[str]) -> NDArray[Any]:
    """Values as an array that VTK reads; words become ASCII of any length."""
    import h5py

    array = np.asarray(values)
    if array.dtype.kind != "U":
        return array
    words = [word.encode("ascii", "backslashreplace") for word in array.tolist()]
    return np.array(words, dtype=h5py.string_dtype("ascii"))


def _rounded(values: Array) -> NDArray[np.float32]:
    """Values in single precision without their last bits, which are noise that compresses badly."""
    bits = values.astype("<f4").view("<u4")
    return ((bits + (1 << _BITS - 1)) & ~np.uint32((1 << _BITS) - 1)).view("<f4")


def _fill(room: h5py.Dataset, first: int, values: NDArray[Any]) -> None:
    """Write (k, rows, ...) behind `first` pieces of as many rows."""
    steps, rows = values.shape[:2]
    flat = values.astype(room.dtype, copy=False).reshape(steps * rows, *values.shape[2:])
    room[first * rows : (first + steps) * rows] = flat


def _in_space(points: Array) -> Array:
    """Points (..., 2) as (..., 3)."""
    return np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1)

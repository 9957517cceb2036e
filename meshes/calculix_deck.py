"""Input decks for CalculiX and Abaqus: bodies, supports and nodal forces in mm, N and MPa."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import MeshError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.element_size import MILLIMETRE
from camwright.meshes.mesh_files import replacing

_MEGAPASCAL = 1e6
_PER_LINE = 12
_FORMAT = ".12e"  # CalculiX reads no more than twenty characters of a number
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")


@dataclass(frozen=True, eq=False)
class DeckBody:
    """Body of an input deck in plane strain.

    Parameters
    ----------
    mesh : BodyMesh
    modulus : float            Young's modulus, Pa
    poisson : float            Poisson's ratio
    held : str                 boundary of zero displacement; "": none
    forces : array (2, n)      nodal forces over the whole width, N
    placed : tuple             (node, component, displacement in m) of single nodes, against rigid
                               displacements of a body in equilibrium
    """

    mesh: BodyMesh
    modulus: float
    poisson: float
    held: str
    forces: Array
    placed: tuple[tuple[int, int, float], ...] = ()

    def __post_init__(self) -> None:
        freeze(self, forces=self.forces)
        shape = (2, self.mesh.points.shape[1])
        if self.forces.shape != shape:
            raise MeshError(f"forces = {self.forces.shape}, must be {shape}")


def write_deck(
    path: str | Path, bodies: Mapping[str, DeckBody], width: float, heading: Iterable[str] = ()
) -> None:
    """Input deck of quadratic plane-strain triangles (CPE6) with loads and one static step.

    Nodes and elements are numbered consecutively over the bodies. Sets are named after the body,
    node sets of its boundaries like ``cam_contour``.

    Parameters
    ----------
    path
    bodies : mapping    name -> DeckBody
    width : float       m
    heading             lines of the deck's heading

    Raises
    ------
    MeshError
        If a name is no valid set name of both programs.
    ResultError
        If the file cannot be written.
    """
    for name in bodies:
        if not _NAME.fullmatch(name):
            raise MeshError(f"body '{name}', must be letters, digits and underscores")
    lines = ["*HEADING", *(f"** {' '.join(line.split())}" for line in heading)]
    lines.append("** units: mm, N, MPa; plane strain")
    supports, forces = ["*BOUNDARY"], ["*CLOAD"]
    first, element = 1, 1
    for name, body in bodies.items():
        lines += _body_lines(name, body, width, first, element)
        if body.held:
            supports.append(f"{name}_{body.held}, 1, 2")
        for node, component, displacement in body.placed:
            place = f"{first + node}, {component + 1}, {component + 1}"
            supports.append(f"{place}, {displacement / MILLIMETRE:{_FORMAT}}")
        for component, node in zip(*np.nonzero(body.forces), strict=True):
            force = float(body.forces[component, node])
            forces.append(f"{first + node}, {component + 1}, {force:{_FORMAT}}")
        first += body.mesh.points.shape[1]
        element += body.mesh.triangles.shape[1]
    lines += ["*STEP", "*STATIC", *supports, *forces]
    lines += ["*NODE FILE, OUTPUT=2D", "U", "*EL FILE, OUTPUT=2D", "S", "*END STEP"]
    with replacing(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")


def _body_lines(name: str, body: DeckBody, width: float, first: int, element: int) -> list[str]:
    mesh = body.mesh
    points = (mesh.points / MILLIMETRE).T.tolist()
    lines = ["*NODE, NSET=" + name]
    lines += [f"{first + k}, {x:{_FORMAT}}, {y:{_FORMAT}}, 0." for k, (x, y) in enumerate(points)]
    lines.append(f"*ELEMENT, TYPE=CPE6, ELSET={name}")
    for k, nodes in enumerate((mesh.triangles.T + first).tolist()):
        lines.append(f"{element + k}, " + ", ".join(map(str, nodes)))
    for boundary in mesh.boundaries:
        lines.append(f"*NSET, NSET={name}_{boundary}")
        nodes = (np.unique(mesh.boundary_nodes(boundary)) + first).tolist()
        lines += [
            ", ".join(map(str, nodes[k : k + _PER_LINE])) for k in range(0, len(nodes), _PER_LINE)
        ]
    lines += [
        f"*MATERIAL, NAME={name}",
        "*ELASTIC",
        f"{body.modulus / _MEGAPASCAL!r}, {body.poisson!r}",
        f"*SOLID SECTION, ELSET={name}, MATERIAL={name}",
        f"{width / MILLIMETRE!r}",
    ]
    return lines

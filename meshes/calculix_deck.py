"""Input decks for CalculiX and Abaqus in mm, N and MPa: bodies under forces, or in contact."""

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
from camwright.meshes.gmsh_mesher import Index
from camwright.meshes.mesh_files import replacing

_MEGAPASCAL = 1e6
_PER_LINE = 12
_FORMAT = ".12e"  # CalculiX reads no more than twenty characters of a number
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")


@dataclass(frozen=True, eq=False)
class MeshedBody:
    """Body of an input deck in plane strain: mesh, Young's modulus, Pa, Poisson's ratio."""

    mesh: BodyMesh
    modulus: float
    poisson: float


@dataclass(frozen=True, eq=False)
class DeckBody(MeshedBody):
    """Body of an input deck with nodal forces and fixed nodes.

    Parameters
    ----------
    held : str                 boundary of zero displacement; "": none
    forces : array (2, n)      nodal forces over the whole width, N
    placed : tuple             (node, component, displacement in m) of single nodes, against rigid
                               displacements of a body in equilibrium
    """

    held: str
    forces: Array
    placed: tuple[tuple[int, int, float], ...] = ()

    def __post_init__(self) -> None:
        """Refuse forces whose shape is not (2, nodes) of the mesh, and make them read-only."""
        freeze(self, forces=self.forces)
        shape = (2, self.mesh.points.shape[1])
        if self.forces.shape != shape:
            raise MeshError(f"forces = {self.forces.shape}, must be {shape}")


@dataclass(frozen=True, eq=False)
class TouchingBody(MeshedBody):
    """Body of a contact pair in an input deck: mesh, material, contact surface.

    Parameters
    ----------
    surface : str              boundary that touches the other body
    facets : array (k,)        numbers of its facets near the contact
    held : str                 boundary held to the ground or axle; "": on springs
    ways : array (m, 2, n)     weights of the mean nodal displacement that each spring holds
    stiffness : array (m,)     of the springs over the whole width, N/m
    """

    surface: str
    facets: Index
    held: str
    ways: Array
    stiffness: Array


@dataclass(frozen=True)
class Pressing:
    """Boundary conditions and load that press a follower onto a cam held at its bore.

    Parameters
    ----------
    normal : two floats   outward normal of the cam; the axle of the follower moves along it alone
    force : float         against the normal on the axle, N
    overlap : float       by which the first step moves the axle, so that the bodies touch, m
    penalty : float       pressure per overlap of the surfaces, Pa/m
    """

    normal: tuple[float, float]
    force: float
    overlap: float
    penalty: float


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
    lines = _heading_lines(bodies, heading)
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
    _write(path, lines)


def write_contact_pair(
    path: str | Path,
    cam: tuple[str, TouchingBody],
    follower: tuple[str, TouchingBody],
    pressing: Pressing,
    width: float,
    heading: Iterable[str] = (),
) -> None:
    """Input deck for CalculiX of two bodies in contact, surface to surface with a penalty.

    The cam is held; the follower is held or sprung to an axle that the second step loads. Nothing
    of another solution of the contact enters: the first step closes the gap by a displacement.

    Parameters
    ----------
    cam, follower : pairs   name and body; the facets of the follower are the dependent ones
    width : float           m
    heading                 lines of the deck's heading

    Raises
    ------
    MeshError
        If a name is no valid set name.
    ResultError
        If the file cannot be written.
    """
    bodies = dict([cam, follower])
    lines = _heading_lines(bodies, heading)
    lines.append(f"** penalty: {pressing.penalty * 1e-9:.6e} MPa/mm; its effect falls as 1/penalty")
    first, element, starts = 1, 1, []
    for name, body in bodies.items():
        lines += _body_lines(name, body, width, first, element)
        lines.append(f"*SURFACE, NAME={name}_touching, TYPE=ELEMENT")
        lines += [f"{element + at}, S{face}" for at, face in _faces(body)]
        starts.append(first)
        first += body.mesh.points.shape[1]
        element += body.mesh.triangles.shape[1]
    axle, held = first, f"{cam[0]}_{cam[1].held}, 1, 2"
    lines += ["*NODE, NSET=axle", f"{axle}, 0., 0., 0."]
    ends = [f"{axle}, 3, 3"]
    if follower[1].held:
        lines += _tied(follower[1], starts[1], axle)
    else:
        count = follower[1].stiffness.size
        lines += _sprung(follower[1], starts[1], axle, element)
        ends += [f"{axle + 1 + k}, 2, 3" for k in range(count)]
    across = (-pressing.normal[1], pressing.normal[0])
    fixed = int(np.argmax(np.abs(across)))  # component of the axle that the other one determines
    moved = 1 - fixed
    lines += _equation([(axle, fixed, across[fixed]), (axle, moved, across[moved])])
    lines += [
        "*SURFACE INTERACTION, NAME=touching",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{pressing.penalty * 1e-9:{_FORMAT}}",
        "*CONTACT PAIR, INTERACTION=touching, TYPE=SURFACE TO SURFACE",
        f"{follower[0]}_touching, {cam[0]}_touching",
    ]
    closing = -pressing.overlap / MILLIMETRE * pressing.normal[moved]
    # work of the force along the normal by the one free component of the axle
    force = -pressing.force / pressing.normal[moved]
    lines += ["*STEP", "*STATIC", "1., 1.", "*BOUNDARY", held, *ends]
    lines += [f"{axle}, {moved + 1}, {moved + 1}, {closing:{_FORMAT}}", "*END STEP"]
    lines += ["*STEP, INC=200", "*STATIC", "0.5, 1.", "*BOUNDARY, OP=NEW", held, *ends]
    lines += ["*CLOAD", f"{axle}, {moved + 1}, {force:{_FORMAT}}"]
    lines += ["*NODE FILE, OUTPUT=2D", "U", "*EL FILE, OUTPUT=2D", "S"]
    lines += ["*CONTACT FILE", "CDIS, CSTR"]
    lines += [f"*NODE PRINT, NSET={cam[0]}_{cam[1].held}, TOTALS=ONLY", "RF"]
    lines += ["*NODE PRINT, NSET=axle", "U", "*END STEP"]
    _write(path, lines)


def _faces(body: TouchingBody) -> list[tuple[int, int]]:
    """Number of the element from 0 and of its side from 1, for each facet of the body that may
    touch, in their order.
    """
    sides = body.mesh.triangles[[[0, 1], [1, 2], [2, 0]]]  # (3, 2, elements)
    known = {
        frozenset((int(start), int(end))): (at, side + 1)
        for side in range(3)
        for at, (start, end) in enumerate(sides[side].T)
    }
    ends = body.mesh.facet_triples(body.surface)[:2, body.facets]
    return [known[frozenset((int(start), int(end)))] for start, end in ends.T]


def _tied(body: TouchingBody, start: int, axle: int) -> list[str]:
    """Lines of equations by which the body's held nodes move with the axle; `start`: number of its
    first node, `axle`: of the axle's node.
    """
    lines = []
    for node in np.unique(body.mesh.boundary_nodes(body.held)).tolist():
        for component in range(2):
            lines += _equation([(start + node, component, 1.0), (axle, component, -1.0)])
    return lines


def _sprung(body: TouchingBody, start: int, axle: int, element: int) -> list[str]:
    """Lines of the springs between weighted means of nodal displacements (`ways`) and the axle,
    each spring on a node of its own behind `axle`.

    start: number of the body's first node; element: number of the first spring
    """
    lines = []
    for k, (way, stiffness) in enumerate(zip(body.ways, body.stiffness.tolist(), strict=True)):
        end = axle + 1 + k
        lines += ["*NODE", f"{end}, 0., 0., 0."]
        lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=spring_{k + 1}", f"{element + k}, {end}"]
        lines += [f"*SPRING, ELSET=spring_{k + 1}", "1", f"{stiffness * MILLIMETRE:{_FORMAT}}"]
        terms = [(end, 0, -1.0)]
        for component in range(2):
            nodes = np.flatnonzero(way[component])
            terms += [(start + int(at), component, float(way[component, at])) for at in nodes]
            terms.append((axle, component, -float(way[component].sum())))
        lines += _equation(terms)
    return lines


def _equation(terms: Iterable[tuple[int, int, float]]) -> list[str]:
    """Sum of nodal displacements, node, component and factor, that is zero; the first depends."""
    written = [f"{at}, {part + 1}, {factor:{_FORMAT}}" for at, part, factor in terms if factor]
    rows = [", ".join(written[k : k + 4]) for k in range(0, len(written), 4)]
    return ["*EQUATION", str(len(written)), *rows]


def _heading_lines(names: Iterable[str], heading: Iterable[str]) -> list[str]:
    """First lines of a deck: heading and units; a name of a body that is no valid set name is
    refused.
    """
    for name in names:
        if not _NAME.fullmatch(name):
            raise MeshError(f"body '{name}', must be letters, digits and underscores")
    lines = ["*HEADING", *(f"** {' '.join(line.split())}" for line in heading)]
    return [*lines, "** units: mm, N, MPa; plane strain"]


def _write(path: str | Path, lines: Iterable[str]) -> None:
    with replacing(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")


def _body_lines(name: str, body: MeshedBody, width: float, first: int, element: int) -> list[str]:
    """Lines of a body: nodes, elements, a node set of each boundary, section of a given width, m,
    material; numbers begin with `first` for nodes and `element` for elements.
    """
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

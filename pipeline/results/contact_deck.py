"""Contact at one cam angle as an input deck for CalculiX or Abaqus.

Either with the contact pressure of this program as nodal forces, which another program can confirm
as far as elasticity goes, or with a contact pair that it solves by itself.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.errors import InputError
from camwright.meshes.calculix_deck import (
    DeckBody,
    Pressing,
    TouchingBody,
    write_contact_pair,
    write_deck,
)
from camwright.pipeline.base.tables import Table
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.certificate import SolvedPair, solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import ElasticBody
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.full_contact import ContactSide
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.drawn_cam import drawn_cam

PENALTY = 250.0
"""Penalty of a deck over E*/a: takes some 0.1 % off the pressure."""
_FIRST_OVERLAP = 0.3  # over that of a rigid indenter of half the Hertz half-width and its radius
_CONTACT_REACH = 3.0  # Hertz half-widths from the contact within which the surfaces may touch


def force_at(cycle: Table, load_case: str, theta: float) -> float:
    """Normal force on the cam, N, in a load case at a cam angle, interpolated linearly.

    Parameters
    ----------
    cycle : Table     ``5_cycle.csv`` of a run
    load_case : str   its name
    theta : float     rad

    Raises
    ------
    InputError
        If the load case is unknown, or the follower is not loaded at the angle.
    """
    rows = cycle.of_load_case(load_case)
    if not len(rows):
        raise InputError("--load-case", load_case, f"one of {', '.join(cycle.load_cases)}")
    angle = np.degrees(theta % FULL_TURN)
    force = float(np.interp(angle, rows["cam_angle_deg"], rows["normal_force_N"], period=360.0))
    if not force > 0:
        raise InputError("--angle", f"{angle:g} deg", "where the follower is loaded")
    return force


def nodal_forces(pair: ContactPair, solved: SolvedPair) -> tuple[Array, Array]:
    """Nodal forces (2, nodes), N, of the contact pressure on cam and follower."""
    on_cam, on_follower = (
        pair.width * side.body.surface_forces(displacement, side.surface)
        for side, displacement in zip(solved.sides, solved.solution.displacements, strict=True)
    )
    return on_cam, on_follower


def write_contact_deck(path: Path, pair: ContactPair, solved: SolvedPair) -> None:
    """Write an input deck of both bodies at one cam angle, loaded by nodal forces of the contact
    pressure.

    A body on springs, such as a ring on balls, is loaded by the spring forces as well, and not
    held.

    Parameters
    ----------
    path : Path           of the deck
    pair : ContactPair    cam and follower
    solved : SolvedPair   their contact at one angle
    """
    other, forces = pair.follower, nodal_forces(pair, solved)
    load = force_of(pair, solved)
    bodies = {
        name: _deck_body(side.body, held, force, displacement, pair.width)
        for name, side, held, force, displacement in zip(
            ("cam", other.name),
            solved.sides,
            ("bore", other.held),
            forces,
            solved.solution.displacements,
            strict=True,
        )
    }
    supports = f"the bore and the {other.name}'s {other.held} are held"
    if not other.held:
        supports = f"the bore is held; the {other.name}'s balls push as they do under the load"
    write_deck(
        path,
        bodies,
        pair.width,
        (
            f"contact at cam angle {np.degrees(solved.theta):.6f} deg, normal force {load:.6f} N",
            "the contact pressure acts as consistent nodal forces along the contact normal",
            supports,
        ),
    )


def _deck_body(
    body: ElasticBody, held: str, forces: Array, displacement: Array, width: float
) -> DeckBody:
    """Body of a deck with its nodal forces, on its support; a body on springs has their forces too
    and, in place of a support, three displacements that fix its place.

    Parameters
    ----------
    body : ElasticBody                mesh, constants, springs
    held : str                        boundary that is held
    forces : array (2, nodes)         N, over the width
    displacement : array (2, nodes)   m, as solved
    width : float                     of contact, m
    """
    if body.springs is None:
        return DeckBody(body.mesh, body.modulus, body.poisson, held, forces)
    whole = forces + width * body.springs.forces(displacement[:, :, None])[:, :, 0]
    # Three displacements of two distant nodes are fixed; all forces balance, so none acts there.
    x = body.mesh.points[0]
    left, right = int(np.argmin(x)), int(np.argmax(x))
    placed = tuple(
        (node, component, float(displacement[component, node]))
        for node, component in ((left, 0), (left, 1), (right, 1))
    )
    return DeckBody(body.mesh, body.modulus, body.poisson, "", whole, placed)


def write_pair_deck(
    path: Path, pair: ContactPair, solved: SolvedPair, penalty: float = PENALTY
) -> None:
    """Write an input deck for CalculiX of both bodies at one cam angle, pressed together; the
    contact pressure is for it to find, own results stand as comments.

    Parameters
    ----------
    path : Path           of the deck
    pair : ContactPair    cam and follower
    solved : SolvedPair   their contact at one angle
    penalty : float       pressure per overlap of the surfaces, over E*/a of the Hertz contact; the
                          error of the pressure is inverse to it
    """
    other, solution, half = pair.follower, solved.solution, solved.half_width_hertz
    force = force_of(pair, solved)
    radius = float(pair.relative_radius(solved.theta))
    cam, follower = (
        _touching(side, solved.frame, held, half, pair.width)
        for side, held in zip(solved.sides, ("bore", other.held), strict=True)
    )
    figures = (
        ("peak pressure", solution.p0, "MPa"),
        ("half-width", solution.half_width, "um"),
        ("von Mises in the cam", solution.von_mises, "MPa"),
        ("at the depth", solution.von_mises_depth, "um"),
    )
    stated = ", ".join(
        f"{words} {in_unit(value, unit):.6g} {unit}" for words, value, unit in figures
    )
    write_contact_pair(
        path,
        ("cam", cam),
        (other.name, follower),
        Pressing(
            (float(solved.frame.normal[0]), float(solved.frame.normal[1])),
            force,
            _FIRST_OVERLAP * half**2 / (2.0 * radius),
            penalty * pair.contact_modulus / half,
        ),
        pair.width,
        (
            f"contact at cam angle {np.degrees(solved.theta):.6f} deg, normal force {force:.6f} N",
            "CalculiX finds the contact pressure: surface to surface, without friction",
            f"for comparison, of Camwright: {stated}",
        ),
    )


def force_of(pair: ContactPair, solved: SolvedPair) -> float:
    """Normal force of a solved contact, N: its nodal forces along the contact normal."""
    return float(np.abs(nodal_forces(pair, solved)[1].sum(axis=1) @ solved.frame.normal))


def _touching(
    side: ContactSide, frame: ContactFrame, held: str, half_width: float, width: float
) -> TouchingBody:
    """Body of a deck with a contact pair: mesh, support, springs, and the facets of its surface
    near the contact.

    Parameters
    ----------
    side : ContactSide     body with its surface
    frame : ContactFrame   place and direction of the contact
    held : str             boundary that is held
    half_width : float     of Hertz, m
    width : float          of contact, m
    """
    body, mesh = side.body, side.body.mesh
    middles = mesh.points[:, mesh.facet_triples(side.surface)[2]]
    near = np.hypot(frame.along(middles), frame.above(middles)) <= _CONTACT_REACH * half_width
    springs = body.springs
    return TouchingBody(
        mesh,
        body.modulus,
        body.poisson,
        surface=side.surface,
        facets=np.flatnonzero(near),
        held=held,
        ways=np.zeros((0, *mesh.points.shape)) if springs is None else springs.ways,
        stiffness=np.zeros(0) if springs is None else width * springs.stiffness,
    )


def deck(
    run: Path, theta: float, path: Path, load_case: str | None = None, *, contact: bool = False
) -> SolvedPair:
    """Solve the contact of a finished run at a cam angle, and write its input deck.

    Parameters
    ----------
    run : Path        folder of the run
    theta : float     cam angle, rad
    path : Path       of the deck
    load_case : str   None: the first
    contact : bool    whether the deck has a contact pair; without, the pressure as nodal forces

    Raises
    ------
    InputError
        If the load case is unknown, or the follower is not loaded at the angle.
    """
    cycle = run_reader.read_run(run).final.cycle
    case, contour = drawn_cam(run)
    name = case.load_cases[0].name if load_case is None else load_case
    force = force_at(cycle, name, theta)
    pair = contact_pair(machines(case)[0], contour)
    solved = solve_pair(pair, theta % FULL_TURN, force)
    (write_pair_deck if contact else write_contact_deck)(path, pair, solved)
    return solved

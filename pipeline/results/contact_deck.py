"""Contact at one cam angle as an input deck for another finite-element program."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.errors import InputError
from camwright.meshes.calculix_deck import DeckBody, write_deck
from camwright.pipeline.base.tables import Table
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.certificate import SolvedPair, solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import ElasticBody
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.drawn_cam import drawn_cam


def force_at(cycle: Table, load_case: str, theta: float) -> float:
    """Normal force, N, of a load case at a cam angle, rad, by linear interpolation of the cycle.

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
    """Write both bodies at one angle with the nodal forces of the contact pressure.

    A body on springs, such as a ring on balls, is loaded by the spring forces instead.
    """
    other, forces = pair.follower, nodal_forces(pair, solved)
    load = float(np.abs(forces[1].sum(axis=1) @ solved.frame.normal))
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


def deck(run: Path, theta: float, path: Path, load_case: str | None = None) -> SolvedPair:
    """Solve the contact of a run at a cam angle, rad, and write it as a deck.

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
    write_contact_deck(path, pair, solved)
    return solved

"""One trip down the road: from a smoother, or a given lift, to checks."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.energy import lift_from_torque
from camwright.geometry.errors import GeometryError, ResultError
from camwright.geometry.lift import Lift
from camwright.meshes.mesh_files import write_msh
from camwright.meshes.mesh_quality import Quality, gate, quality
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.given_lift import contour_of, given_lift
from camwright.pipeline.case.load_case_torque import engine_torque, has_torque
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import all_checks, design_checks
from camwright.pipeline.contact.certificate import EDGES, contact_meshes
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import (
    TWO_SCALE,
    ContactPair,
    CycleBodies,
    closed_form_history,
    pair_history,
)
from camwright.pipeline.cycle import cycle as cycles
from camwright.pipeline.cycle.crank_speed import rubbing_of, speed_ripple
from camwright.pipeline.cycle.turn import Turn, turn
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.results.trial import ContactMesh, Trial
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed

# Positions solved together: what an interruption may cost, and the grain of the progress bar.
CHUNK = 90
# A look ahead needs no more angles than this.
_OUTLOOK_POSITIONS = 360


def engine_torques(case: Case) -> dict[str, Torque]:
    """Engine torque of each load case by name; empty for a case that starts at the lift.

    An engine that stands has only the torque its load case names, or that of being started.
    """
    if case.engine is None:
        return {}
    return {
        state.name: engine_torque(case, state)
        for state in case.load_cases
        if has_torque(case, state)
    }


def designed_lift(case: Case, torques: Mapping[str, Torque], smoother: Smoother | None) -> Lift:
    """The lift that balances the first load case's torque, or the one the case gives.

    Of the torque it takes the share `mechanism.compensation`.
    """
    if case.lift is not None:
        return given_lift(case)
    if smoother is None:
        raise ResultError("a cam that balances torque needs a smoother")
    asked = asked_torque(case, torques[case.load_cases[0].name], smoother)
    target = case.mechanism.gear_ratio * asked
    return lift_from_torque(
        uniform_turn(target.size), target, case.spring.rate, case.spring.preload
    )


def asked_torque(case: Case, torque: Torque, smoother: Smoother) -> Array:
    """What of a crank torque the cam is asked to take, about its mean, N m."""
    share = smoothed(torque.without_mean().total, smoother)
    return np.asarray(case.mechanism.compensation * share)


def cam_contour(case: Case, lift: Lift) -> Contour:
    """The cam that moves the follower so."""
    return contour_of(case, lift)


def is_body(contour: Contour) -> bool:
    """Whether the contour encloses a body: no undercut, no crossing."""
    return not contour.undercut().present and not contour.self_intersections()


def meshed(pair: ContactPair, turns: tuple[Turn, ...]) -> ContactMesh | None:
    """Meshes at the angle of greatest Hertz pressure over all turns; None without a load.

    Raises
    ------
    MeshError
        If the mesh does not pass the quality gate.
    """
    worst = None
    for given in turns:
        history = closed_form_history(pair, given.theta, given.loads.normal_force)
        k = int(np.argmax(history.p0))
        if history.p0[k] > 0 and (worst is None or history.p0[k] > worst[0]):
            worst = (history.p0[k], float(given.theta[k]), float(history.half_width[k]))
    if worst is None:
        return None
    _, theta, half_width = worst
    bodies = contact_meshes(pair, theta, half_width, EDGES[1])
    contact = pair.contour.points(theta)
    found = [gate(quality(body, contact, half_width), edges_min=EDGES[1]) for body in bodies]
    both = Quality(
        min_angle_deg=min(q.min_angle_deg for q in found),
        min_scaled_jacobian=min(q.min_scaled_jacobian for q in found),
        edges_across_half_width=min(q.edges_across_half_width for q in found),
        elements=sum(q.elements for q in found),
        nodes=sum(q.nodes for q in found),
    )
    return ContactMesh(theta, half_width, *bodies, pair.follower.name, both)


def write_mesh(path: Path, mesh: ContactMesh) -> None:
    """``4_mesh.msh``: both bodies in the cam's frame."""
    write_msh(path, {"cam": mesh.cam, mesh.name: mesh.follower})


def contact_chunks(
    pair: ContactPair, bodies: CycleBodies, given: Turn, known: Mapping[int, Mapping[str, Array]]
) -> Iterator[tuple[int, Mapping[str, Array]]]:
    """Contact of a turn piece by piece, those already `known` handed through."""
    for index, start in enumerate(range(0, given.theta.size, CHUNK)):
        if index in known:
            yield index, known[index]
            continue
        part = slice(start, start + CHUNK)
        history = pair_history(pair, bodies, given.theta[part], given.loads.normal_force[part])
        yield index, _as_arrays(history)


def chunk_count(given: Turn) -> int:
    """Number of pieces `contact_chunks` gives."""
    return -(-given.theta.size // CHUNK)


def chunk_key(pair: ContactPair, given: Turn) -> str:
    """Fingerprint of all that decides the contact of a turn."""
    digest = hashlib.sha256(pair.contour.pitch.lift.values.tobytes())
    digest.update(given.loads.normal_force.tobytes())
    digest.update(repr((pair.width, pair.bore_radius, pair.cam, pair.follower)).encode())
    if pair.counter_hole is not None:
        digest.update(np.array([*pair.counter_hole.centre, pair.counter_hole.radius]).tobytes())
    return digest.hexdigest()


def joined(chunks: Mapping[int, Mapping[str, Array]]) -> ContactHistory:
    """One history from its pieces."""
    parts = [chunks[k] for k in sorted(chunks)]
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    refused = int(np.isnan(whole["p0"]).sum())
    note = (
        f"; no answer at {refused} angles, where the half-width is more than a tenth of the "
        "relative radius and the surfaces are not locally flat"
    )
    return ContactHistory(**whole, method=TWO_SCALE + (note if refused else ""))


def unknown_contact(given: Turn) -> ContactHistory:
    """The contact of a contour that is no body: not a number anywhere, so that no check passes."""
    names = [f.name for f in fields(ContactHistory) if f.name != "method"]
    unknown = dict.fromkeys(names, np.full(given.theta.size, np.nan))
    unknown |= dict.fromkeys(("pressure", "pressure_xi"), np.full((given.theta.size, 1), np.nan))
    return ContactHistory(**unknown, method="none: the contour is no body")


def _as_arrays(history: ContactHistory) -> dict[str, Array]:
    return {f.name: getattr(history, f.name) for f in fields(history) if f.name != "method"}


def checked(
    case: Case,
    trial: Trial,
    torques: Mapping[str, Torque],
    benchmarks: Mapping[str, float] | None = None,
    searching: bool = False,
) -> Trial:
    """The trial with its checks, certificate and benchmarks included as far as there are any.

    Of a trial of a search they are not asked for yet; of an answer they are, and missing, fail it.
    """
    evidence = TrialEvidence(
        case=case,
        contour=trial.contour,
        cycles=trial.cycles,
        mesh_quality=None if trial.mesh is None else trial.mesh.quality,
        certificate=trial.certificate,
        benchmarks=benchmarks,
        speed_ripple=speed_ripple(case, torques, trial.contour.pitch, rubbing_of(trial.cycles)),
        searching=searching,
    )
    return replace(trial, checks=all_checks(evidence))


def foreseen(case: Case, torques: Mapping[str, Torque], smoother: Smoother) -> tuple[Check, ...]:
    """Checks of the design that a smoother leads to, by closed forms.

    Raises
    ------
    GeometryError
        If there is no such cam.
    """
    contour = cam_contour(case, designed_lift(case, torques, smoother))
    if not is_body(contour):
        raise GeometryError("the contour is undercut")
    turns = turns_of(case, contour, torques, _OUTLOOK_POSITIONS, ahead=True)
    found = tuple(cycles.closed_form_cycle(case, contour, given) for given in turns)
    return design_checks(TrialEvidence(case=case, contour=contour, cycles=found))


def turns_of(
    case: Case,
    contour: Contour,
    torques: Mapping[str, Torque],
    positions: int,
    ahead: bool = False,
) -> tuple[Turn, ...]:
    """Loads of every load case; a look ahead takes them less finely."""
    return tuple(
        turn(case, contour, torques.get(state.name), state.name, positions, ahead)
        for state in case.load_cases
    )

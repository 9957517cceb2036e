"""Whether the numbers behind the other checks can be leaned on."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camwright.meshes.mesh_quality import (
    FACET_SHARE,
    LEAST_ANGLE_DEG,
    LEAST_SCALED_JACOBIAN,
    Quality,
)
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, Worst, greatest
from camwright.pipeline.contact.certificate import EDGES

if TYPE_CHECKING:
    from camwright.pipeline.contact.contact_history import CertificatePoint

VERIFICATION = "ASME V&V 10-2019, solution verification"
RESIDUALS = f"equilibrium and contact law hold; {VERIFICATION}"
CERTIFIED = f"{VERIFICATION}; ASME V&V 20-2009 (GCI)"


class Bound(NamedTuple):
    """A limit in the unit of its check, and its source."""

    value: float
    source: str


# Bounds on the tool's own numbers: no case may loosen them.
CONTACT_EQUILIBRIUM = Bound(1e-6, RESIDUALS)  # of the load
HERTZ_PERCENT = Bound(3.0, "Johnson (1985) sec. 4.2(c); 2 to 3 % in use")
SPREAD_PERCENT = Bound(1.0, CERTIFIED)
MESH_ANGLE_DEG = Bound(LEAST_ANGLE_DEG, VERIFICATION)
MESH_JACOBIAN = Bound(LEAST_SCALED_JACOBIAN, VERIFICATION)
MESH_EDGES = Bound(FACET_SHARE * EDGES[1], VERIFICATION)


def guide_equilibrium_force(evidence: TrialEvidence) -> Check:
    """Guide reactions and side force add up to nothing, and so do the forces along the stem."""
    return _residual(
        "guide_equilibrium_force",
        "Force equilibrium of the guides",
        greatest(
            evidence,
            lambda cycle: np.maximum(np.abs(cycle.guides.force_residual), cycle.friction_residual),
        ),
        _equilibrium(evidence),
        "greatest sum of guide and side forces over the side force, beam on elastic supports; or"
        " of push, spring, inertia and the guides' friction over the push",
    )


def guide_equilibrium_moment(evidence: TrialEvidence) -> Check:
    """The moments of guide reactions and side force add up to nothing."""
    return _residual(
        "guide_equilibrium_moment",
        "Moment equilibrium of the guides",
        greatest(evidence, lambda cycle: np.abs(cycle.guides.moment_residual)),
        _equilibrium(evidence),
        "greatest sum of moments over that of the side force, beam on elastic supports",
    )


def contact_equilibrium(evidence: TrialEvidence) -> Check:
    """The contact pressure carries the normal force."""
    return _residual(
        "contact_equilibrium",
        "Force equilibrium of the contact",
        greatest(evidence, lambda cycle: np.abs(cycle.contact.residual_equilibrium)),
        CONTACT_EQUILIBRIUM,
        "greatest relative difference of the integrated pressure from the load",
    )


def contact_complementarity(evidence: TrialEvidence) -> Check:
    """No pull in the contact, no overlap outside it."""
    return _residual(
        "contact_complementarity",
        "Contact law",
        greatest(evidence, lambda cycle: np.abs(cycle.contact.residual_complementarity)),
        Bound(evidence.case.limits.complementarity, evidence.source("complementarity", RESIDUALS)),
        "greatest relative tension, overlap or gap under pressure",
    )


def hertz_difference(evidence: TrialEvidence) -> Check:
    """Finite elements beside the closed form; a difference asks for a reason, not for a fix."""

    worst = greatest(evidence, lambda cycle: 100.0 * np.abs(cycle.contact.p0_difference))
    return Check(
        id="hertz_difference",
        title="Contact pressure by finite elements against Hertz",
        demand=worst.value,
        limit=HERTZ_PERCENT.value,
        unit="%",
        source=HERTZ_PERCENT.source,
        method="greatest |p0 by finite elements / p0 by Hertz - 1| over the turn",
        must_have=False,
        evidence=True,
        **worst.place,
    )


def certificate_spread(evidence: TrialEvidence) -> Check:
    """The turn's contact beside that on the certificate's meshes."""
    return _certified(
        evidence,
        "certificate_spread",
        "Contact of the turn against its certificate",
        lambda point: point.spread_percent,
        SPREAD_PERCENT,
        "p0 of the turn against both bodies meshed and solved at the certificate's angles",
    )


def certificate_gci(evidence: TrialEvidence) -> Check:
    """Error bar of the contact pressure from three meshes."""
    return _certified(
        evidence,
        "certificate_gci",
        "Mesh uncertainty of the contact pressure",
        lambda point: point.gci_percent,
        Bound(
            100.0 * evidence.case.limits.mesh_uncertainty,
            evidence.source("mesh_uncertainty", CERTIFIED),
        ),
        "grid convergence index of p0 on three meshes, observed order, safety factor 1.25",
    )


def mesh_angle(evidence: TrialEvidence) -> Check:
    """Sharpest corner of a triangle."""
    return _mesh(
        evidence,
        "mesh_angle",
        "Least angle of an element",
        lambda mesh: mesh.min_angle_deg,
        MESH_ANGLE_DEG,
        "deg",
    )


def mesh_jacobian(evidence: TrialEvidence) -> Check:
    """Most distorted element, curved edges included."""
    return _mesh(
        evidence,
        "mesh_jacobian",
        "Least scaled Jacobian",
        lambda mesh: mesh.min_scaled_jacobian,
        MESH_JACOBIAN,
        "-",
    )


def mesh_edges(evidence: TrialEvidence) -> Check:
    """Edges that resolve the contact's half-width."""
    return _mesh(
        evidence,
        "mesh_edges",
        "Edges across the contact half-width",
        lambda mesh: mesh.edges_across_half_width,
        MESH_EDGES,
        "-",
    )


def _equilibrium(evidence: TrialEvidence) -> Bound:
    return Bound(evidence.case.limits.equilibrium, evidence.source("equilibrium", RESIDUALS))


def _residual(name: str, title: str, worst: Worst, bound: Bound, method: str) -> Check:
    return Check(
        id=name,
        title=title,
        demand=worst.value,
        limit=bound.value,
        unit="-",
        source=bound.source,
        method=method,
        evidence=True,
        **worst.place,
    )


def _certified(
    evidence: TrialEvidence,
    name: str,
    title: str,
    percent: Callable[[CertificatePoint], float],
    bound: Bound,
    method: str,
) -> Check:
    points = evidence.certificate
    values = np.array([percent(point) for point in points])
    worst = int(np.argmax(values)) if points else None
    return Check(
        id=name,
        title=title,
        demand=None if worst is None else float(values[worst]),
        limit=bound.value,
        unit="%",
        cam_angle_deg=None if worst is None else float(np.rad2deg(points[worst].theta)),
        source=bound.source,
        method=method,
        must_have=bool(points) or not evidence.searching,
        evidence=True,
        note="" if points else "this trial carries no certificate",
    )


def _mesh(
    evidence: TrialEvidence,
    name: str,
    title: str,
    figure: Callable[[Quality], float],
    bound: Bound,
    unit: str,
) -> Check:
    quality = evidence.mesh_quality
    return Check(
        id=name,
        title=title,
        demand=None if quality is None else figure(quality),
        limit=bound.value,
        unit=unit,
        sense="at_least",
        source=bound.source,
        method="worst over all elements of cam and roller",
        must_have=quality is not None or not evidence.searching,
        evidence=True,
        note="" if quality is not None else "this trial carries no mesh",
    )


CHECKS = (
    guide_equilibrium_force,
    guide_equilibrium_moment,
    contact_equilibrium,
    contact_complementarity,
    hertz_difference,
    certificate_spread,
    certificate_gci,
    mesh_angle,
    mesh_jacobian,
    mesh_edges,
)

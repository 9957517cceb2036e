"""Whether the numbers behind the other checks can be leaned on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geometry.arrays import Array
from pipeline.checks.check import Check
from pipeline.checks.trial import TrialEvidence, Worst, greatest

if TYPE_CHECKING:
    from pipeline.cycle import Cycle

CONTACT_EQUILIBRIUM = 1e-6
SPREAD_PERCENT = 1.0
HERTZ_PERCENT = 3.0
LEAST_ANGLE_DEG = 20.0
LEAST_SCALED_JACOBIAN = 0.3
LEAST_EDGES = 7.92  # 8, less the hair by which a curved facet is longer than asked

VERIFICATION = "ASME V&V 10-2019, solution verification"


def guide_equilibrium_force(evidence: TrialEvidence) -> Check:
    """Guide reactions and side force add up to nothing, and so do the forces along the stem."""
    return _residual(
        evidence,
        "guide_equilibrium_force",
        "Force equilibrium of the guides",
        greatest(
            evidence,
            lambda cycle: np.maximum(np.abs(cycle.guides.force_residual), cycle.friction_residual),
        ),
        evidence.limit("equilibrium", 1e-9),
        "greatest sum of guide and side forces over the side force, beam on elastic supports; or"
        " of push, spring, inertia and the guides' friction over the push",
    )


def guide_equilibrium_moment(evidence: TrialEvidence) -> Check:
    """The moments of guide reactions and side force add up to nothing."""
    return _residual(
        evidence,
        "guide_equilibrium_moment",
        "Moment equilibrium of the guides",
        greatest(evidence, lambda cycle: np.abs(cycle.guides.moment_residual)),
        evidence.limit("equilibrium", 1e-9),
        "greatest sum of moments over that of the side force, beam on elastic supports",
    )


def contact_equilibrium(evidence: TrialEvidence) -> Check:
    """The contact pressure carries the normal force."""
    return _residual(
        evidence,
        "contact_equilibrium",
        "Force equilibrium of the contact",
        greatest(evidence, lambda cycle: np.abs(cycle.contact.residual_equilibrium)),
        evidence.limit("contact_equilibrium", CONTACT_EQUILIBRIUM),
        "greatest relative difference of the integrated pressure from the load",
    )


def contact_complementarity(evidence: TrialEvidence) -> Check:
    """No pull in the contact, no overlap outside it."""
    return _residual(
        evidence,
        "contact_complementarity",
        "Contact law",
        greatest(evidence, lambda cycle: np.abs(cycle.contact.residual_complementarity)),
        evidence.limit("complementarity", 1e-9),
        "greatest relative tension, overlap or gap under pressure",
    )


def hertz_difference(evidence: TrialEvidence) -> Check:
    """Finite elements beside the closed form; a difference asks for a reason, not for a fix."""

    def percent(cycle: Cycle) -> Array:
        hertz, found = np.asarray(cycle.contact.p0_hertz), np.asarray(cycle.contact.p0)
        idle = hertz == 0
        return 100.0 * np.abs(np.where(idle, 0.0, found / np.where(idle, 1.0, hertz) - 1.0))

    worst = greatest(evidence, percent)
    return Check(
        id="hertz_difference",
        title="Contact pressure by finite elements against Hertz",
        demand=worst.value,
        limit=evidence.limit("hertz_difference", HERTZ_PERCENT),
        unit="%",
        source=evidence.source("hertz_difference", "Johnson (1985) sec. 4.2(c); 2 to 3 % in use"),
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
        "spread_percent",
        evidence.limit("certificate_spread", SPREAD_PERCENT),
        "p0 of the turn against both bodies meshed and solved at the certificate's angles",
    )


def certificate_gci(evidence: TrialEvidence) -> Check:
    """Error bar of the contact pressure from three meshes."""
    share = evidence.limit("mesh_uncertainty", 0.03)
    return _certified(
        evidence,
        "certificate_gci",
        "Mesh uncertainty of the contact pressure",
        "gci_percent",
        None if share is None else 100.0 * share,
        "grid convergence index of p0 on three meshes, observed order, safety factor 1.25",
    )


def mesh_angle(evidence: TrialEvidence) -> Check:
    """Sharpest corner of a triangle."""
    return _mesh(
        evidence, "mesh_angle", "Least angle of an element", "min_angle_deg", LEAST_ANGLE_DEG, "deg"
    )


def mesh_jacobian(evidence: TrialEvidence) -> Check:
    """Most distorted element, curved edges included."""
    return _mesh(
        evidence,
        "mesh_jacobian",
        "Least scaled Jacobian",
        "min_scaled_jacobian",
        LEAST_SCALED_JACOBIAN,
        "-",
    )


def mesh_edges(evidence: TrialEvidence) -> Check:
    """Edges that resolve the contact's half-width."""
    return _mesh(
        evidence,
        "mesh_edges",
        "Edges across the contact half-width",
        "edges_across_half_width",
        LEAST_EDGES,
        "-",
    )


def _residual(
    evidence: TrialEvidence,
    name: str,
    title: str,
    worst: Worst,
    limit: float | None,
    method: str,
) -> Check:
    return Check(
        id=name,
        title=title,
        demand=worst.value,
        limit=limit,
        unit="-",
        source=evidence.source(name, f"equilibrium and contact law hold; {VERIFICATION}"),
        method=method,
        evidence=True,
        **worst.place,
    )


def _certified(
    evidence: TrialEvidence, name: str, title: str, field: str, limit: float | None, method: str
) -> Check:
    points = evidence.certificate
    values = np.array([abs(float(getattr(point, field))) for point in points])
    worst = int(np.argmax(values)) if points else None
    return Check(
        id=name,
        title=title,
        demand=None if worst is None else float(values[worst]),
        limit=limit,
        unit="%",
        cam_angle_deg=None if worst is None else float(np.rad2deg(points[worst].theta)),
        source=evidence.source(name, f"{VERIFICATION}; ASME V&V 20-2009 (GCI)"),
        method=method,
        must_have=bool(points) or not evidence.searching,
        evidence=True,
        note="" if points else "this trial carries no certificate",
    )


def _mesh(
    evidence: TrialEvidence, name: str, title: str, field: str, least: float, unit: str
) -> Check:
    quality = evidence.mesh_quality
    return Check(
        id=name,
        title=title,
        demand=None if quality is None else float(getattr(quality, field)),
        limit=evidence.limit(name, least),
        unit=unit,
        sense="at_least",
        source=evidence.source(name, VERIFICATION),
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

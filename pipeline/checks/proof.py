"""Evidence a sign-off asks for: every figure on three meshes, benchmarks, the two tiers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence, converged
from camwright.pipeline.follower.guide_reactions import KNOTS, GuidePair, guide_reactions
from camwright.pipeline.follower.stem_beam import Stem

if TYPE_CHECKING:
    from camwright.pipeline.contact.contact_history import CertificatePoint

GCI = "grid convergence index, ASME V&V 20-2009, sec. 2-4; <= 3 %"
BENCHMARK = 0.03
KNOTS_TRIED = (7, 13, 25)  # twice as many each time, the ends counted once


def mesh_p0(evidence: TrialEvidence) -> Check:
    """Error bar of the peak pressure."""
    return _of_certificate(evidence, "p0", "peak pressure", lambda point: point.p0)


def mesh_half_width(evidence: TrialEvidence) -> Check:
    """Error bar of the contact's half-width."""
    return _of_certificate(evidence, "half_width", "half-width", lambda point: point.half_width)


def mesh_von_mises(evidence: TrialEvidence) -> Check:
    """Error bar of the von Mises stress below the surface."""
    return _of_certificate(evidence, "von_mises", "von Mises stress", lambda point: point.von_mises)


def mesh_tau_max(evidence: TrialEvidence) -> Check:
    """Error bar of the greatest shear below the surface."""
    return _of_certificate(evidence, "tau_max", "greatest shear", lambda point: point.tau_max)


def mesh_reaction(evidence: TrialEvidence) -> Check | None:
    """Error bar of the guide reaction from three divisions of the guides."""
    if evidence.parts is None:
        return None
    cycle = max(evidence.cycles, key=lambda c: float(np.max(np.abs(c.guides.reaction_a))))
    k = int(np.argmax(np.abs(cycle.guides.reaction_a)))
    load, reach = cycle.loads.tangential_force[[k]], cycle.loads.overhang[[k]]
    stem, guides = Stem.from_case(evidence.case), GuidePair.from_case(evidence.case)
    values = [
        float(guide_reactions(load, reach, stem, guides, knots=n).reaction_a[0])
        for n in KNOTS_TRIED
    ]
    figure = converged(values, 2.0)
    return Check(
        id="mesh_reaction",
        title="Mesh uncertainty of the reaction in guide A",
        demand=100.0 * figure.gci,
        limit=100.0 * evidence.case.limits.mesh_uncertainty,
        unit="%",
        load_case=cycle.load_case,
        cam_angle_deg=float(np.rad2deg(cycle.theta[k])),
        source=evidence.source("mesh_uncertainty", GCI),
        evidence=True,
        method=f"beam in guides of {', '.join(map(str, KNOTS_TRIED))} knots; {_order(figure)};"
        f" the turn has {KNOTS}",
    )


def benchmark_nafems(evidence: TrialEvidence) -> Check:
    """A published contact, solved in this environment."""
    return _benchmark(
        evidence, "nafems", "NAFEMS R0094 case 1, cylinder on block", "NAFEMS R0094 (Konter 2006)"
    )


def benchmark_hertz(evidence: TrialEvidence) -> Check:
    """Hertz's contact of the case's roller, or its base circle, solved in this environment."""
    body = "roller" if evidence.rolls else "base circle"
    title = f"Hertz contact of the {body} on a block"
    return _benchmark(evidence, "hertz", title, "Johnson (1985) sec. 4.2(c)")


def _of_certificate(
    evidence: TrialEvidence,
    name: str,
    words: str,
    figure: Callable[[CertificatePoint], Convergence],
) -> Check:
    points = evidence.certificate
    worst = max(points, key=lambda point: _gci(figure(point)), default=None)
    return Check(
        id=f"mesh_{name}",
        title=f"Mesh uncertainty of the {words}",
        demand=None if worst is None else 100.0 * figure(worst).gci,
        limit=100.0 * evidence.case.limits.mesh_uncertainty,
        unit="%",
        cam_angle_deg=None if worst is None else float(np.rad2deg(worst.theta)),
        source=evidence.source("mesh_uncertainty", GCI),
        method="three meshes of both bodies at every certified angle"
        + ("" if worst is None else f"; {_order(figure(worst))}"),
        must_have=bool(points) or not evidence.searching,
        evidence=True,
        note="" if points else "this trial carries no certificate",
    )


def _gci(figure: Convergence) -> float:
    """The error bar, a NaN beyond all others."""
    return np.inf if np.isnan(figure.gci) else figure.gci


def _order(figure: Convergence) -> str:
    if figure.order is None:
        return "no order observed, the meshes scatter: their spread with a factor of 3"
    return f"observed order {figure.order:.2f}"


def _benchmark(evidence: TrialEvidence, name: str, title: str, source: str) -> Check:
    found = evidence.benchmarks
    values = [] if found is None else [found[f"{name}_p0"], found[f"{name}_half_width"]]
    return Check(
        id=f"benchmark_{name}",
        title=title,
        demand=100.0 * float(np.max(np.abs(values))) if values else None,
        limit=100.0 * BENCHMARK,
        unit="%",
        source=f"{source}; 2 to 3 % in use",
        method="greater difference of p0 and half-width from the known answer, solved by the"
        " libraries of this run",
        must_have=found is not None or not evidence.searching,
        evidence=True,
        note="" if found is not None else "no benchmark was solved beside this trial",
    )


CHECKS = (
    mesh_p0,
    mesh_half_width,
    mesh_von_mises,
    mesh_tau_max,
    mesh_reaction,
    benchmark_nafems,
    benchmark_hertz,
)

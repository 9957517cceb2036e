"""Error bars of the demands: what samples, meshes and the two tiers of the contact leave open."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from pipeline.checks.check import Check
from pipeline.checks.trial import TrialEvidence

# A closed form refined between samples, or an exact integral: what rounding leaves.
ROUNDING = 1e-9
OF_THE_CONTACT = {
    "contact_pressure",
    "contact_pressure_at_life",
    "edge_pressure",
    "first_yield",
    "shakedown",
    "shakedown_traction",
    "surface_fatigue",
    "hardened_case",
}
"""Demands proportional to the contact's pressure."""


def with_error_bars(trial: TrialEvidence, checks: Iterable[Check]) -> tuple[Check, ...]:
    """The checks with the share of error their demands carry.

    A demand of the contact carries the certificate's greatest difference and grid convergence
    index besides what lies between samples; without a certificate its error is not known.
    """
    contact = contact_error(trial)
    return tuple(replace(check, error_share=_share(check, contact)) for check in checks)


def contact_error(trial: TrialEvidence) -> float | None:
    """Greatest difference between turn and certificate plus its error bar, as a share."""
    points = trial.certificate
    if not points:
        return None
    return max(abs(p.spread_percent) + abs(p.gci_percent) for p in points) / 100.0


def _share(check: Check, contact: float | None) -> float | None:
    sampled = ROUNDING if check.error_share is None else max(check.error_share, ROUNDING)
    if check.id not in OF_THE_CONTACT:
        return sampled
    return None if contact is None else sampled + contact

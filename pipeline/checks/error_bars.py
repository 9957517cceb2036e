"""Error bars of the demands: what samples, meshes and the two tiers of the contact leave open."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence

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
    "dang_van",
    "pressure_by_hardness",
    "pressure_by_gear_limits",
}
"""Demands proportional to the contact's pressure."""
OF_THE_GUIDES = {
    f"bush_{name}_{side}" for name in ("pressure", "pv", "peak") for side in ("A", "B")
}
"""Demands proportional to a guide's reaction, as the beam's meshes leave it."""
NOT_MESHED_TWICE = {"bore_stress"}
"""Demands of elements of one size only: nobody knows their error."""


def with_error_bars(trial: TrialEvidence, checks: Iterable[Check]) -> tuple[Check, ...]:
    """The checks with the share of error their demands carry.

    A demand on a guide carries the mesh uncertainty of its reaction. One of the contact carries
    the certificate's greatest difference and grid convergence
    index besides what lies between samples; without a certificate its error is not known.
    """
    checks = tuple(checks)
    contact = contact_error(trial)
    beam = [check.demand for check in checks if check.id == "mesh_reaction"]
    guides = None if beam in ([], [None]) else float(beam[0] or 0.0) / 100.0
    return tuple(replace(check, error_share=_share(check, contact, guides)) for check in checks)


def contact_error(trial: TrialEvidence) -> float | None:
    """Greatest difference between turn and certificate plus its error bar, as a share.

    None without a certificate, NaN where a certified figure is not known.
    """
    points = trial.certificate
    if not points:
        return None
    return float(np.max([p.spread_percent + p.gci_percent for p in points])) / 100.0


def _share(check: Check, contact: float | None, guides: float | None) -> float | None:
    sampled = ROUNDING if check.error_share is None else max(check.error_share, ROUNDING)
    if check.id in NOT_MESHED_TWICE:
        return None
    if check.id in OF_THE_CONTACT:
        return None if contact is None else sampled + contact
    if check.id in OF_THE_GUIDES:
        return None if guides is None else sampled + guides
    return sampled

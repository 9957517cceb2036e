"""Error bars of the demands: samples, meshes, and the two tiers of the contact."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.cycle.solution import Solution

# A closed form refined between samples, or an exact integral: what rounding leaves.
ROUNDING = 1e-9
GUIDE_ERROR = "mesh_reaction"


def with_error_bars(solution: Solution, checks: Iterable[Check]) -> tuple[Check, ...]:
    """The checks with the share of error of their demands.

    A demand on a guide has the discretisation uncertainty of its reaction. One of the contact has
    the certificate's greatest difference and grid convergence index besides what lies between
    samples; without a certificate its error is not known.
    """
    checks = tuple(checks)
    contact = contact_error(solution)
    beam = [each.demand for each in checks if each.id == GUIDE_ERROR]
    guides = None if beam in ([], [None]) else float(beam[0] or 0.0)
    return tuple(replace(each, error_share=_share(each, contact, guides)) for each in checks)


def contact_error(solution: Solution) -> float | None:
    """Greatest difference between turn and certificate plus its error bar, as a share.

    None without a certificate, NaN where a certified figure is not known.
    """
    points = solution.certificate
    if not points:
        return None
    return float(np.max([p.spread + p.gci for p in points]))


def _share(one: Check, contact: float | None, guides: float | None) -> float | None:
    sampled = ROUNDING if one.error_share is None else max(one.error_share, ROUNDING)
    kind = one.declaration.error
    if kind == "unknown":
        return None
    if kind == "contact":
        return None if contact is None else sampled + contact
    if kind == "guides":
        return None if guides is None else sampled + guides
    return sampled

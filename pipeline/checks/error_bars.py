"""Relative error bars of the demands: sampling, meshes, contact tiers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from camwright.geometry.extrema import TIE, first_greatest
from camwright.pipeline.base.verdict import ROUNDING
from camwright.pipeline.checks.check import Check, Error
from camwright.pipeline.checks.extremes import tracks_of
from camwright.pipeline.checks.solution_verification import mesh_reaction
from camwright.pipeline.cycle.solution import Solution

GUIDE_EDGE_ERROR = 0.06
"""Relative error of loaded length and greatest line load of a guide of 25 knots.

Greatest shortfall of either against 193 knots over 300 random guides of nylon and bronze; an excess
is on the safe side.
"""


def with_error_bars(solution: Solution, checks: Iterable[Check]) -> tuple[Check, ...]:
    """Checks with the relative errors of their demands.

    A demand on a guide has the discretisation uncertainty of the guide reaction, and one on its
    edges `GUIDE_EDGE_ERROR` besides. One on the contact has the greatest sum of difference and grid
    convergence index of its certified quantity, the sampling error, and that of the pressure in the
    middle of a crowned line over plane strain; one on the line of contact that of its factor
    instead; one on the pin of a pivot or on the bore the change with a finer mesh. Without a
    certificate the error of the contact is not known.
    """
    checks = tuple(checks)
    beam = [each.demand for each in checks if each.id == mesh_reaction.id]
    centre = centre_error(solution) if solution.certificate else 0.0
    guides = None if beam in ([], [None]) else float(beam[0] or 0.0)

    def share(one: Check) -> float | None:
        """Relative error of the demand of a check; None where it is not known."""
        plane = contact_error(solution, one.declaration.certified_by or None)
        contact = None if plane is None else plane + centre
        meshes: dict[Error, float | None] = {
            "contact": contact,
            "ends": None if plane is None else plane + length_error(solution),
            "guides": guides,
            "guide_edges": None if guides is None else guides + GUIDE_EDGE_ERROR,
            "pivot": pivot_error(solution),
            "bore": solution.bore_error,
        }
        return _share(one, meshes)

    shares = [share(each) for each in checks]
    return tuple(
        each if each.error_share == error_share else replace(each, error_share=error_share)
        for each, error_share in zip(checks, shares, strict=True)
    )


def contact_error(solution: Solution, figure: str | None = None) -> float | None:
    """Greatest relative error of the contact: difference of cycle and certificate plus the grid
    convergence index of the certificate.

    Of one certified quantity, or of all. None without a certificate, NaN where a certified value
    is not known.
    """
    points = solution.certificate
    if not points:
        return None
    return float(
        np.max(
            [
                point.difference(name) + convergence.gci
                for point in points
                for name, (convergence, _) in point.figures.items()
                if figure in (None, name)
            ]
        )
    )


def centre_error(solution: Solution) -> float:
    """Greatest relative error of mid-line over plane-strain pressure."""
    errors = [cycle.length.centre_error for cycle in tracks_of(solution.cycles) if cycle.length]
    return max(errors, default=0.0)


def length_error(solution: Solution) -> float:
    """Relative error of the pressure along the line over that of plane strain, at the greatest
    pressure over the load cases.

    0 where it is not known.
    """
    error, most = 0.0, 0.0
    for cycle in tracks_of(solution.cycles):
        if cycle.length is not None:
            index = first_greatest(cycle.signed_pressure)
            if not cycle.signed_pressure[index] <= most * (1.0 + TIE):
                error, most = float(cycle.length.error[index]), cycle.signed_pressure[index]
    return error


def pivot_error(solution: Solution) -> float:
    """Greatest relative discretisation error of the pin in the bush of a pivot over the load cases;
    0 where it is not by finite elements.
    """
    solved = (cycle.pivot for cycle in solution.cycles)
    return max((each.error for each in solved if each is not None), default=0.0)


def _share(one: Check, meshes: Mapping[Error, float | None]) -> float | None:
    """Relative error of a demand: of sampling and of the meshes (`meshes`: by kind of error) from
    which it comes; None where that is not known.
    """
    kind = one.declaration.error
    sampled = ROUNDING if one.error_share is None else max(one.error_share, ROUNDING)
    of_mesh = 0.0 if kind == "sampling" else meshes.get(kind)
    return None if of_mesh is None else sampled + of_mesh

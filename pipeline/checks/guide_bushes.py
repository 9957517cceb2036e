"""Limits of the two bushes that guide the stem."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, Worst, cited, greatest, worst_case
from camwright.pipeline.follower.guide_friction import NYLON_PV

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Guide
    from camwright.pipeline.cycle.cycle import Cycle


def bush_pressure_a(evidence: TrialEvidence) -> Check:
    """Greatest mean pressure in guide A."""
    return _pressure(evidence, "A", evidence.case.guides.a)


def bush_pressure_b(evidence: TrialEvidence) -> Check:
    """Greatest mean pressure in guide B."""
    return _pressure(evidence, "B", evidence.case.guides.b)


def bush_pv_a(evidence: TrialEvidence) -> Check:
    """Pressure times sliding speed in guide A, mean over the turn."""
    return _pv(evidence, "A", evidence.case.guides.a)


def bush_pv_b(evidence: TrialEvidence) -> Check:
    """Pressure times sliding speed in guide B, mean over the turn."""
    return _pv(evidence, "B", evidence.case.guides.b)


def _pressure(evidence: TrialEvidence, side: str, guide: Guide) -> Check:
    worst = greatest(
        evidence, lambda cycle: demands.bush_pressure(_reaction(cycle, side), _area(guide))
    )
    limit = guide.pressure_limit
    return Check(
        id=f"bush_pressure_{side}",
        title=f"Bearing pressure in guide {side}",
        demand=1e-6 * worst.value,
        limit=None if limit is None else 1e-6 * limit,
        unit="MPa",
        source=guide.source or f"{guide.material} bush",
        method="greatest reaction by finite elements over diameter x length",
        lift_can_help=True,
        note="; ".join(
            ([] if limit is not None else [f"no pressure limit is given for guide {side}"])
            + _explained(evidence, side, guide, worst)
        ),
        **worst.place,
    )


def _explained(evidence: TrialEvidence, side: str, guide: Guide, worst: Worst) -> list[str]:
    """What of the pressure at its worst is of point supports, of length and of clearance."""
    cycle = next(each for each in evidence.cycles if each.load_case == worst.load_case)
    if cycle.parts is None:
        return []
    share, guides = cycle.parts.shares.reaction_a, cycle.guides
    on_points = guides.statics_a if side == "A" else guides.statics_b
    k = int(np.argmax(np.abs(_reaction(cycle, side))))
    unit = 1e-6 * np.sign(_reaction(cycle, side)[k]) / _area(guide)
    points, length, clearance = (
        unit * each[k] for each in (on_points, share.by_length, share.by_clearance)
    )
    shares = f"{length:+.2g} by length, {clearance:+.2g} by clearance"
    return [f"{points:.3g} MPa on point supports, {shares}"]


def mean_pv(cycle: Cycle, side: str, guide: Guide) -> float:
    """Pressure times sliding speed in guide A or B, mean over the turn, Pa m/s."""
    guides = cycle.guides
    load = guides.rubbing_load_a if side == "A" else guides.rubbing_load_b
    return float(np.mean(demands.bush_pv(load, cycle.loads.velocity, _area(guide))))


def _pv_of_reaction(cycle: Cycle, side: str, guide: Guide) -> float:
    """The same by the reaction, in which pushes of opposite sides cancel though both rub."""
    pv = demands.bush_pv(np.abs(_reaction(cycle, side)), cycle.loads.velocity, _area(guide))
    return float(np.mean(pv))


def _pv(evidence: TrialEvidence, side: str, guide: Guide) -> Check:
    worst = worst_case(evidence, lambda cycle: mean_pv(cycle, side, guide))
    limit = pv_limit(guide)
    alone = worst_case(evidence, lambda cycle: _pv_of_reaction(cycle, side, guide))
    return Check(
        id=f"bush_pv_{side}",
        title=f"Pressure times speed in guide {side}",
        demand=1e-6 * worst.value,
        limit=None if limit is None else 1e-6 * limit,
        unit="MPa m/s",
        source=_pv_source(guide),
        method="mean |R v| over the turn by finite elements over diameter x length;"
        " R sums the pushes of both sides of the bore",
        lift_can_help=True,
        note="; ".join(
            ([] if limit is not None else [f"no PV limit is given for guide {side}"])
            + _lubrication_asked(guide, worst.value)
            + [f"{1e-6 * alone.value:.3g} by what is left of both sides, the reaction"]
        ),
        **worst.place,
    )


def pv_limit(guide: Guide) -> float | None:
    """The limit given, or else that of nylon in the state of lubrication given, Pa m/s."""
    state = _graded_state(guide)
    return guide.pv_limit if state is None else NYLON_PV[state]


def _pv_source(guide: Guide) -> str:
    state = _graded_state(guide)
    if state is not None:
        words = state.replace("_", " ")
        graded = f"nylon, {words}: Mott, table 16-1, and a bush maker's graded limits: verify"
        return cited(graded, guide.source)
    return guide.source or f"{guide.material} bush"


def _graded_state(guide: Guide) -> str | None:
    """The lubrication whose graded limit holds; None where the guide has one of its own."""
    graded = guide.pv_limit is None and _is_nylon(guide)
    return guide.lubrication if graded else None


def _lubrication_asked(guide: Guide, demand: float) -> list[str]:
    """The least lubrication in which nylon carries a PV (Pa m/s); nothing of another material."""
    if not _is_nylon(guide):
        return []
    states = [state.replace("_", " ") for state, limit in NYLON_PV.items() if demand <= limit]
    return [f"nylon carries it {states[0]}" if states else "nylon carries it in no lubrication"]


def _is_nylon(guide: Guide) -> bool:
    return "nylon" in guide.material.lower()


def _reaction(cycle: Cycle, side: str) -> Array:
    return cycle.guides.reaction_a if side == "A" else cycle.guides.reaction_b


def _area(guide: Guide) -> float:
    return guide.diameter * guide.length


def guide_length(evidence: TrialEvidence) -> Check:
    """Distance of the guides beside the greatest overhang."""
    case = evidence.case
    overhang = case.follower.overhang_at_max_lift + evidence.contour.pitch.lift.highest.value
    spread = case.guides.spacing + 0.5 * (case.guides.a.length + case.guides.b.length)
    return Check(
        id="guide_length",
        title="Guided length over the greatest overhang",
        demand=spread / overhang,
        limit=case.limits.guide_length,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "guide_length", "bearing length at least twice the overhang, Rothbart (2004) ch. 6"
        ),
        method="outer ends of the two guides over the overhang at the least lift",
        must_have=False,
        lift_can_help=True,
    )


CHECKS = (bush_pressure_a, bush_pressure_b, bush_pv_a, bush_pv_b)
SIGNED = (guide_length,)
"""What a sign-off asks for besides; a look ahead does without."""

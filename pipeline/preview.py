"""The checks of a case by closed forms, before anything is solved: a look ahead, never a sign-off.

Torque, lift, contour, loads and guides are those of a run's first trial; the contact is Hertz's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from pipeline import trial as road
from pipeline.ahead import foreseen_cycle
from pipeline.case import Case
from pipeline.checks import rolling
from pipeline.checks.check import Check
from pipeline.checks.everything import DESIGN, PARTS, SIGNED, checked_by
from pipeline.checks.trial import TrialEvidence
from pipeline.checks.verdict import in_order
from pipeline.cycle import Cycle, Turn, finished
from pipeline.smoothing.constrained import synthesise
from pipeline.smoothing.design import Design
from pipeline.smoothing.loop import redrawn
from pipeline.smoothing.problem import problem_of
from pipeline.smoothing.smoothers import Smoother
from pipeline.speed import rubbing_of, speed_ripple

MARK = "closed forms only: "


@dataclass(frozen=True, eq=False)
class LookAhead:
    """What closed forms foresee: the case as drawn, the synthesis if one drew it, the turns."""

    case: Case
    design: Design | None
    contour: road.Contour
    cycles: tuple[Cycle, ...]
    checks: tuple[Check, ...]


def closed_form_checks(case: Case) -> tuple[Check, ...]:
    """Checks of the first trial by closed forms, with a must-have that says so.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    return look_ahead(case).checks


def look_ahead(case: Case) -> LookAhead:
    """The first trial by closed forms, with all that its checks rest upon.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    torques, design = road.engine_torques(case), None
    if case.smoothing.kind == "constrained":
        design = synthesise(problem_of(case, torques))
        case, lift = redrawn(case, design), design.lift()
    else:
        smoother = None if case.engine is None else Smoother.from_case(case.smoothing)
        lift = road.designed_lift(case, torques, smoother)
    contour = road.cam_contour(case, lift)
    sound = road.is_body(contour)
    turns = road.turns_of(case, contour, torques, case.solver.positions)
    cycles = tuple(_cycle(case, contour, given, sound) for given in turns)
    speed = speed_ripple(case, torques, contour.pitch, rubbing_of(cycles))
    evidence = TrialEvidence(case=case, contour=contour, cycles=cycles, speed_ripple=speed)
    found = checked_by(evidence, (*DESIGN, *rolling.CHECKS, *SIGNED, *PARTS))
    marked = (replace(check, method=MARK + check.method) for check in found)
    return LookAhead(case, design, contour, cycles, in_order((_unsigned(), *marked)))


def _cycle(case: Case, contour: road.Contour, given: Turn, sound: bool) -> Cycle:
    if not sound:
        return finished(case, contour, given, road.unknown_contact(given))
    return foreseen_cycle(case, contour, given)


def _unsigned() -> Check:
    return Check(
        id="signed_off",
        title="Finite elements, certificate and error bars",
        demand=None,
        limit=1.0,
        unit="-",
        sense="at_least",
        source="a sign-off asks for a run",
        method="none: a case file has been checked, not a run",
        note="camwright run solves the case; this is a look ahead",
    )

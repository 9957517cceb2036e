"""The checks of a case by closed forms, before anything is solved: a look ahead, never a sign-off.

Torque, lift, contour, loads and guides are those of a run; the contact is Hertz's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from camwright.geometry.lift import Lift
from camwright.pipeline import solver as road
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks import surface_durability
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import DESIGN, PARTS, SIGNED, checked_by
from camwright.pipeline.checks.verdict import in_order
from camwright.pipeline.cycle.ahead import foreseen_cycle
from camwright.pipeline.cycle.crank_speed import rubbing_of, speed_ripple
from camwright.pipeline.cycle.cycle import Cycle, finished
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.smoothing import fe_correction
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem

MARK = "closed forms only: "
_ROUNDS = 4  # of synthesis and correction


@dataclass(frozen=True, eq=False)
class LookAhead:
    """What closed forms foresee: the case as drawn, the turns, the checks.

    design and the problem it answers are those of the synthesis; None where none drew the lift.
    """

    case: Case
    contour: road.Contour
    cycles: tuple[Cycle, ...]
    checks: tuple[Check, ...]
    design: Design | None = None
    problem: Problem | None = None


def closed_form_checks(case: Case) -> tuple[Check, ...]:
    """Checks of a case by closed forms, with a must-have that says so.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    return look_ahead(case).checks


def look_ahead(case: Case) -> LookAhead:
    """What a run of the case is about to find, by closed forms, with all its checks rest upon.

    A synthesis is corrected by what length and clearance of the guides make of it, in as many
    rounds as that moves a limit in use, as the trials of a run are by finite elements.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    torques = road.engine_torques(case)
    if case.smoothing.kind != "constrained":
        smoother = None if case.engine is None else Smoother.from_case(case.smoothing)
        return _seen(case, torques, road.designed_lift(case, torques, smoother))
    problem: Problem = problem_of(case, torques)
    earlier: fe_correction.Moved | None = None
    for _ in range(_ROUNDS):
        design = synthesise(problem)
        seen = _seen(fe_correction.redrawn(case, design), torques, design.lift())
        seen = replace(seen, design=design, problem=problem)
        corrections = fe_correction.corrections_of(seen.cycles)
        moved = fe_correction.moved(design, problem, corrections)
        if not design.feasible or fe_correction.settled(moved, seen.checks):
            break
        problem = fe_correction.refined_problem(problem, design, corrections, moved.swing(earlier))
        earlier = moved
    return seen


def _seen(case: Case, torques: Mapping[str, Torque], lift: Lift) -> LookAhead:
    contour = road.cam_contour(case, lift)
    sound = road.is_body(contour)
    turns = road.turns_of(case, contour, torques, case.solver.positions)
    cycles = tuple(_cycle(case, contour, given, sound) for given in turns)
    speed = speed_ripple(case, torques, contour.pitch, rubbing_of(cycles))
    evidence = TrialEvidence(case=case, contour=contour, cycles=cycles, speed_ripple=speed)
    found = checked_by(evidence, (*DESIGN, *surface_durability.CHECKS, *SIGNED, *PARTS))
    marked = (replace(check, method=MARK + check.method) for check in found)
    return LookAhead(case, contour, cycles, in_order((_unsigned(), *marked)))


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

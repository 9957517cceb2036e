"""Figures of a judged case: of its synthesis alone, and of its preview."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import Verdict, in_order, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import KEYWAY_SAFETY, TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.key_strength import keyway_root
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.cycle.cam_balance import design_mass
from camwright.pipeline.cycle.hub_history import hub_fatigue
from camwright.pipeline.records.judgement_record import DraftJudgement, PreviewJudgement, Shortfall
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.smoothing.constrained_synthesis import approached, synthesise
from camwright.pipeline.smoothing.constraints import check_of
from camwright.pipeline.smoothing.multistart import continued
from camwright.pipeline.smoothing.objective import TORQUE, Weighted
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import redrawn
from camwright.pipeline.smoothing.synthesis_problem import FEASIBLE, Design, Problem, coarsened
from camwright.pipeline.torque.torque import Torque

if TYPE_CHECKING:
    from camwright.pipeline.records.trial_contents import SynthesisRecord

_BINDING_USE = 0.99  # utilisation
# Of the safety of the keyway root: least over the limit, for tolerance corners and error bar.
_ROOT_SPARE = 1.06
_COARSE_PROGRESS = 1e-3  # of the engine's ripple: progress at which a coarse search goes on


class CaseJudgement(Protocol):
    """A case with its judgements, each made when it is first read."""

    @property
    def nominal(self) -> Trial:
        """The case with its nominal checks."""
        ...

    @property
    def trial(self) -> Trial:
        """The case with its checks at the tolerance corners of the judgement."""
        ...

    def check(self, name: str, *, everywhere: bool = False) -> Check | None:
        """One check, at every tolerance corner if `everywhere`; None where it does not apply."""
        ...


def preview_figures(judged: CaseJudgement) -> PreviewJudgement:
    """Figures of the preview of a changed case by which searches compare designs: ripple, size,
    mass, loads, verdict, and the checks that fail or lack data.

    The checks are judged as deep as `decided` does.

    Raises
    ------
    InputError
        If the case has no engine.
    """
    trial, shortfalls = decided(judged)
    drawn, contour, turn = trial.case, trial.contour, trial.cycles[0].turn
    rest, torque = turn.torque_after, turn.torque_before
    if rest is None or torque is None:
        raise InputError("engine", "missing", "specified: a redesign balances its torque")
    record = trial.synthesis
    feasible = record is not None and record["feasible"]
    blocking = (check for check in in_order(within_depth(trial.checks)) if check.blocks)
    left = [check.id for check in blocking if check.status == "not_evaluated"]
    before, after = float(np.std(torque)), float(np.std(rest))
    figures = headline(trial.solution)
    return {
        "feasible": feasible,
        "verdict": verdict_of(feasible, shortfalls, left),
        "ripple_before_Nm": before,
        "ripple_left_Nm": after,
        "torque_reduction": 1.0 - after / before,
        "cam_radius_mm": in_unit(trial.solution.greatest_radius, "mm"),
        "mass_g": in_unit(design_mass(drawn, contour), "g"),
        "prime_radius_mm": in_unit(drawn.cam.prime_radius, "mm"),
        "preload_N": drawn.spring.preload,
        "spring_rate_N_per_mm": in_unit(drawn.spring.rate, "N/mm"),
        "lift_max_mm": in_unit(float(trial.lift.highest.value), "mm"),
        "pressure_angle_max_deg": in_unit(trial.solution.pressure_angle_max, "deg"),
        "normal_force_max_N": figures["normal_force_max_N"],
        "p0_max_MPa": figures["p0_max_MPa"],
        "failing": [each["check"] for each in shortfalls],
        "shortfalls": shortfalls,
        "open": left,
        "binding": exceeded_limits(record) or _binding(record),
    }


def decided(judged: CaseJudgement) -> tuple[Trial, list[Shortfall]]:
    """Trial of a changed case, as deep as it was judged, and the blocking checks that fail.

    What costs most is judged last, and only where nothing before it fails: the nominal checks;
    those whose limits an infeasible synthesis exceeds, at the tolerance corners; of a feasible one
    the keyway root by finite elements, if its bound does not prove it, and every check at the
    corners.
    """
    trial = judged.nominal
    shortfalls = _shortfalls(trial.checks)
    if shortfalls:
        return trial, shortfalls
    names = {check_of(name) for name in exceeded_limits(trial.synthesis)} & DECLARED.keys()
    if names:
        checks = (judged.check(name, everywhere=True) for name in sorted(names))
        return trial, _shortfalls([check for check in checks if check is not None])
    shortfalls = _root_shortfall(trial)
    if shortfalls:
        return trial, shortfalls
    return judged.trial, _shortfalls(judged.trial.checks)


def exceeded_limits(record: SynthesisRecord | None) -> list[str]:
    """Limits that an infeasible synthesis exceeds, the worst first."""
    if record is None or record["feasible"]:
        return []
    return [name for name, used in record["utilisation"].items() if used > 1.0]


def _binding(record: SynthesisRecord | None) -> list[str]:
    return [] if record is None else [price["limit"] for price in record["prices"]]


def verdict_of(feasible: bool, shortfalls: Collection[Shortfall], left: Collection[str]) -> Verdict:
    """Verdict of a preview, without the certificate of a sign-off.

    Parameters
    ----------
    feasible : bool           the synthesis keeps its limits
    shortfalls : collection   blocking checks that fail
    left : collection         ids of those that lack data
    """
    if shortfalls or not feasible:
        return "fail"
    return "incomplete" if left else "pass"


def draft_figures(case: Case, torques: Mapping[str, Torque], *, fine: bool) -> DraftJudgement:
    """Figures of a case by its constrained synthesis alone, without corrections for the guides and
    without checks.

    The limit of the ripple is compared with its minimum afterwards: as a constraint it would hide
    the ripple of an infeasible case. Where other terms of the objective, such as the jerk, leave
    more ripple than the limit, the least ripple decides.

    Parameters
    ----------
    case : Case         to be judged
    torques : mapping   engine torque by load case
    fine : bool         with the splines and cam angles of the case; else with those of a start,
                        whose fewer splines leave more ripple
    """
    every = problem_of(case, torques)
    problem = replace(every, left_out=frozenset({TORQUE_REDUCTION.id}))
    coarse = coarsened(problem)
    design = (
        continued(problem, approached(coarse))
        if fine
        else synthesise(coarse, worth=_COARSE_PROGRESS)
    )
    if every.ceiling is not None and design.ripple > every.ceiling:
        design = _least_ripple(every if fine else coarsened(every), design, every.ceiling)
    drawn, lift = redrawn(case, design.variables), design.lift()
    contour = drawn.contour(lift)
    uses = dict(design.utilisation)
    if every.ceiling is not None:
        uses[TORQUE_REDUCTION.id] = design.ripple / every.ceiling
    limit = max(uses, key=lambda name: uses[name])
    beyond = uses[limit] > 1.0 + FEASIBLE
    return {
        "feasible": not beyond,
        "ripple_left_share": design.ripple,
        "cam_radius_mm": in_unit(float(contour.radius_max().value), "mm"),
        "mass_g": in_unit(design_mass(case, contour), "g"),
        "limit": limit if beyond else "",
        "utilisation": uses[limit] if beyond else 0.0,
        "prime_radius_mm": in_unit(drawn.cam.prime_radius, "mm"),
        "preload_N": drawn.spring.preload,
        "lift_max_mm": in_unit(float(lift.highest.value), "mm"),
        "binding": sorted(
            (name for name in uses if uses[name] > _BINDING_USE), key=lambda n: -uses[n]
        ),
    }


def _least_ripple(problem: Problem, design: Design, ceiling: float) -> Design:
    """Design of the least ripple, without the other terms of the objective; where that keeps the
    limit of the ripple, the design of the least objective within it.

    Parameters
    ----------
    problem : Problem   with the limit of the ripple
    design : Design     of the least objective without it; returned where that is the ripple alone
    ceiling : float     greatest allowed ripple, over that of the engine
    """
    alone = replace(problem, objective=(Weighted(TORQUE, 1.0),), jerk_weight=Problem.jerk_weight)
    if (alone.objective, alone.jerk_weight) == (problem.objective, problem.jerk_weight):
        return design
    left_out = frozenset({TORQUE_REDUCTION.id})
    least = continued(replace(alone, left_out=left_out), design)
    within = least if least.ripple > ceiling else continued(problem, least)
    return within if within.feasible else least


def _shortfalls(checks: Sequence[Check]) -> list[Shortfall]:
    """Of the blocking checks that fail, in their order."""
    blocking = (check for check in in_order(within_depth(checks)) if check.blocks)
    return [_shortfall(check) for check in blocking if check.status == "fail"]


def _shortfall(check: Check) -> Shortfall:
    record = check.as_record()
    return {
        "check": record["id"],
        "title": record["title"],
        "demand": record["demand"],
        "limit": record["limit"],
        "unit": record["unit"],
        "utilisation": record["utilisation"],
    }


def _root_shortfall(trial: Trial) -> list[Shortfall]:
    """Failure of the keyway root by finite elements, where the closed form of the preview does not
    decide; empty where it holds with a reserve or is decided.
    """
    numbers = trial.solution.numbers
    left = [check for check in trial.checks if check.id == keyway_root.id and check.judged_at]
    solved = hub_fatigue(trial.contour, trial.cycles, numbers) if left else None
    least = _ROOT_SPARE * float(numbers.limit(KEYWAY_SAFETY))
    if solved is None or solved.governing.safety >= least:
        return []
    return [
        _shortfall(replace(check, demand=solved.governing.safety, limit=least)) for check in left
    ]

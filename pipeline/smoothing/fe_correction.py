"""The synthesis and the finite elements, in turn: what the one answers corrects the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import NamedTuple, NotRequired, TypedDict

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.check import Check
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.smoothing.infeasibility import ConflictRecord
from camwright.pipeline.smoothing.multistart import Starts, StartsRecord
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Correction
from camwright.pipeline.smoothing.shadow_prices import PriceRecord, prices
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem

SETTLED = 0.01  # utilisation that finite elements may still move, of the limit
_LOADED = 0.05  # of the greatest: below it a ratio of two small numbers says nothing
_RUBBING = 1e-6  # the same of friction, which also acts where the guides carry little
_USED = 0.5  # of a limit: one that is used less may move as it likes


def corrections_of(cycles: Sequence[Cycle]) -> dict[str, Correction]:
    """Finite elements over closed forms at every angle of each load case, 1 where unloaded."""
    return {cycle.load_case: _correction(cycle) for cycle in cycles}


def _correction(cycle: Cycle) -> Correction:
    guides, contact = cycle.guides, cycle.contact
    worst = cycle.parts.friction.greatest
    return Correction(
        contact=_ratio(contact.p0, contact.p0_hertz),
        guide_a=_ratio(guides.reaction_a, guides.statics_a),
        guide_b=_ratio(guides.reaction_b, guides.statics_b),
        rubbing_a=_ratio(guides.rubbing_load_a, guides.statics_a, _RUBBING),
        rubbing_b=_ratio(guides.rubbing_load_b, guides.statics_b, _RUBBING),
        jam=_ratio(worst.jam_index, worst.jam_index_statics),
    )


def _ratio(found: Array, closed: Array, least: float = _LOADED) -> Array:
    found, closed = np.abs(found), np.abs(closed)
    loaded = np.isfinite(found) & (closed > least * closed.max())
    return np.where(loaded, found, 1.0) / np.where(loaded, closed, 1.0)


def with_corrections(problem: Problem, corrections: Mapping[str, Correction]) -> Problem:
    """The problem with what finite elements answered; a corner takes that of its load case."""

    def named(name: str) -> Correction | None:
        return corrections.get(name.split(",")[0])

    scenarios = tuple(
        replace(item, correction=named(item.name) or item.correction) for item in problem.scenarios
    )
    return replace(problem, scenarios=scenarios)


class SynthesisRecord(TypedDict):
    """JSON record of a synthesis; ``infeasible`` where its limits conflict."""

    feasible: bool
    converged: bool
    steps: int
    ripple_left: float
    initial_energy_J: float
    spring_rate_N_per_mm: float
    preload_N: float
    prime_radius_mm: float
    phase_deg: float
    reserve: float
    starts: StartsRecord | None
    corrections: dict[str, dict[str, list[float]]]
    utilisation: dict[str, float]
    prices: list[PriceRecord]
    infeasible: NotRequired[ConflictRecord]


class Moved(NamedTuple):
    """The limit that finite elements moved most, of those above one half: from and to."""

    limit: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """How far, of the limit."""
        return abs(self.after - self.before)

    def swing(self, earlier: Moved | None) -> float:
        """Share of new corrections to take over, where the trial before moved the other way.

        A sequence that goes back and forth by a constant factor has its limit there (Aitken).
        """
        if earlier is None or earlier.limit != self.limit or earlier.share == 0.0:
            return 1.0
        ratio = (self.after - self.before) / (earlier.after - earlier.before)
        return 1.0 / (1.0 - ratio) if -1.0 <= ratio < 0.0 else 1.0

    @property
    def sentence(self) -> str:
        if not self.limit:
            return "finite elements move no limit that is used by half"
        way = f"from {self.before:.4g} to {self.after:.4g} of its limit"
        return f"finite elements move {self.limit} {way}"


def moved(design: Design, problem: Problem, corrections: Mapping[str, Correction]) -> Moved:
    """How far new corrections move the utilisation of any limit that is above one half."""
    states = [
        Search(replace(each, seed=design.coefficients)).state(design.coefficients, design.variables)
        for each in (problem, with_corrections(problem, corrections))
    ]
    before, after = (state.utilisation for state in states)
    found = [Moved(name, before[name], after[name]) for name in before]
    used = [each for each in found if max(each.before, each.after) > _USED]
    return max(used, key=lambda each: each.share, default=Moved("", 0.0, 0.0))


def settled(moved: Moved, checks: Sequence[Check]) -> bool:
    """Whether finite elements and synthesis agree, to 1 %; where a limit fails by the lift,
    as well as the synthesis's own reserve can tell.
    """
    fails = any(check.blocks and check.lift_can_help for check in checks)
    return moved.share < (RESERVE if fails else SETTLED)


def refined_problem(
    problem: Problem, design: Design, corrections: Mapping[str, Correction], share: float = 1.0
) -> Problem:
    """What to solve next: the limits as finite elements see them, from the design at hand.

    Parameters
    ----------
    corrections : mapping   by load case
    share : float           of the way from the corrections so far to these
    """
    after = with_corrections(problem, corrections)
    scenarios = tuple(
        replace(new, correction=old.correction.towards(new.correction, share))
        for old, new in zip(problem.scenarios, after.scenarios, strict=True)
    )
    return replace(after, scenarios=scenarios, seed=design.coefficients, variables=design.variables)


def corrections_record(problem: Problem) -> dict[str, dict[str, list[float]]]:
    """Least and greatest of what finite elements answered over closed forms, by load case."""
    return {
        item.name: {
            each.name: [float(getattr(item.correction, each.name).min()),
                        float(getattr(item.correction, each.name).max())]
            for each in fields(item.correction)
        }
        for item in problem.scenarios
    }  # fmt: skip


def redrawn(case: Case, design: Design) -> Case:
    """The case with the spring and prime radius of the design."""
    variables = design.variables
    spring = replace(case.spring, rate=float(variables.rate), preload=float(variables.preload))
    cam = replace(case.cam, prime_radius=float(variables.prime_radius))
    return case.model_copy(update={"spring": spring, "cam": cam})


def design_record(
    design: Design, problem: Problem, starts: Starts | None = None
) -> SynthesisRecord:
    """What ``trial.json`` keeps of a synthesis.

    Parameters
    ----------
    problem : Problem   the design answers, with the corrections it was given
    starts : Starts     how far several starts agree; None where one goes on from a trial before
    """
    least = float(design.lift().lowest.value)
    variables = design.variables
    energy = variables.preload * least + 0.5 * variables.rate * least**2
    return {
        "feasible": design.feasible,
        "converged": design.converged,
        "steps": design.steps,
        "ripple_left": design.ripple,
        "initial_energy_J": energy,
        "spring_rate_N_per_mm": in_unit(variables.rate, "N/mm"),
        "preload_N": variables.preload,
        "prime_radius_mm": in_unit(variables.prime_radius, "mm"),
        "phase_deg": in_unit(variables.phase, "deg"),
        "reserve": RESERVE,
        "starts": None if starts is None else starts.as_record(),
        "corrections": corrections_record(problem),
        "utilisation": dict(sorted(design.utilisation.items(), key=lambda item: -item[1])),
        "prices": prices(design, problem) if design.feasible else [],
    }

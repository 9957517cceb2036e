"""Correction of the synthesis, which uses closed forms, by the finite elements of its cam."""

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

SETTLED = 0.01  # of a limit: maximum change of a utilisation at convergence
_LOADED = 0.05  # of the maximum: least load of a meaningful ratio
_RUBBING = 1e-6  # the same for friction, which also acts at low guide loads
_USED = 0.5  # utilisation below which a limit does not count


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


class LimitShift(NamedTuple):
    """Change of a utilisation by finite elements, of the limit that changes most."""

    limit: str
    before: float
    after: float

    @property
    def size(self) -> float:
        """Absolute change, of the limit."""
        return abs(self.after - self.before)

    def relaxation(self, earlier: LimitShift | None) -> float:
        """Relaxation factor of the new corrections, below 1 where the shifts alternate.

        A sequence that alternates by a constant factor converges there (Aitken).
        """
        if earlier is None or earlier.limit != self.limit or earlier.size == 0.0:
            return 1.0
        ratio = (self.after - self.before) / (earlier.after - earlier.before)
        return 1.0 / (1.0 - ratio) if -1.0 <= ratio < 0.0 else 1.0

    @property
    def sentence(self) -> str:
        """The change in words."""
        if not self.limit:
            return "finite elements change no utilisation above one half"
        values = f"from {self.before:.4g} to {self.after:.4g} of its limit"
        return f"finite elements change {self.limit} {values}"


def corrected(
    problem: Problem, design: Design, cycles: Sequence[Cycle], earlier: LimitShift | None
) -> tuple[LimitShift, Problem]:
    """Shift of the utilisations by the solved cycles, and the corrected problem.

    The corrected problem starts from the design.

    Parameters
    ----------
    cycles : sequence        of the design, one a load case
    earlier : LimitShift     of the round before; None in the first
    """
    corrections = {cycle.load_case: _correction(cycle) for cycle in cycles}
    after = _with_corrections(problem, corrections)
    shift = _shift(design, problem, after)
    share = shift.relaxation(earlier)
    scenarios = tuple(
        replace(new, correction=old.correction.towards(new.correction, share))
        for old, new in zip(problem.scenarios, after.scenarios, strict=True)
    )
    relaxed = replace(
        after, scenarios=scenarios, seed=design.coefficients, variables=design.variables
    )
    return shift, relaxed


def settled(shift: LimitShift, checks: Sequence[Check]) -> bool:
    """Whether finite elements and synthesis agree.

    To 1 % of each limit; to the reserve of the synthesis where a check fails that a gentler lift
    can pass.
    """
    fails = any(c.must_have and c.lift_can_help and c.status == "fail" for c in checks)
    return shift.size < (RESERVE if fails else SETTLED)


def _correction(cycle: Cycle) -> Correction:
    guides, contact = cycle.guides, cycle.contact
    worst = cycle.parts.friction.greatest
    return Correction(
        contact=_ratio(contact.p0, contact.p0_hertz),
        guide_a=_ratio(guides.bearing_load_a, guides.statics_a),
        guide_b=_ratio(guides.bearing_load_b, guides.statics_b),
        rubbing_a=_ratio(guides.rubbing_load_a, guides.statics_a, _RUBBING),
        rubbing_b=_ratio(guides.rubbing_load_b, guides.statics_b, _RUBBING),
        jam=_ratio(worst.jam_index, worst.jam_index_statics),
    )


def _ratio(solved: Array, closed: Array, least: float = _LOADED) -> Array:
    """Solved over closed-form result (n,), 1 where unloaded."""
    solved, closed = np.abs(solved), np.abs(closed)
    loaded = np.isfinite(solved) & (closed > least * closed.max())
    return np.where(loaded, solved, 1.0) / np.where(loaded, closed, 1.0)


def _with_corrections(problem: Problem, corrections: Mapping[str, Correction]) -> Problem:
    """The problem with new corrections; a tolerance corner takes that of its load case."""
    scenarios = tuple(
        replace(each, correction=corrections.get(each.name.split(",")[0], each.correction))
        for each in problem.scenarios
    )
    return replace(problem, scenarios=scenarios)


def _shift(design: Design, before: Problem, after: Problem) -> LimitShift:
    """Greatest change of a utilisation above one half between two problems."""
    utilisations = [
        Search(replace(each, seed=design.coefficients))
        .state(design.coefficients, design.variables)
        .utilisation
        for each in (before, after)
    ]
    shifts = [LimitShift(name, use, utilisations[1][name]) for name, use in utilisations[0].items()]
    used = [each for each in shifts if max(each.before, each.after) > _USED]
    return max(used, key=lambda each: each.size, default=LimitShift("", 0.0, 0.0))


def _corrections_record(problem: Problem) -> dict[str, dict[str, list[float]]]:
    """Least and greatest correction by load case."""
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
    """Record of a synthesis in ``trial.json``.

    Parameters
    ----------
    problem : Problem   of the design, with its corrections
    starts : Starts     of the first trial; None for a design started from the trial before
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
        "corrections": _corrections_record(problem),
        "utilisation": dict(sorted(design.utilisation.items(), key=lambda item: -item[1])),
        "prices": prices(design, problem) if design.feasible else [],
    }

"""Search over the catalogue, ordered by bounds and by solved points.

For each roller the best spring and bush by the synthesis alone, without a limit on the cam radius,
then under decreasing limits. The choices depend on the case alone, not on the processes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from camwright.pipeline.base.units import from_unit
from camwright.pipeline.case.cards.catalogue import (
    Catalogue,
    better_bush,
    better_roller,
    better_spring,
    undominated,
)
from camwright.pipeline.case.cards.substitution import AS_GIVEN, Choice, travel_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import JUMP, TORQUE_REDUCTION
from camwright.pipeline.follower.spring import HelicalSpring, spring_energy
from camwright.pipeline.records.judgement_record import (
    DraftJudgement,
    RefusedJudgement,
    is_refused,
)
from camwright.pipeline.records.redesign_document import PrunedRecord
from camwright.pipeline.search.judge import Judge
from camwright.pipeline.search.parts import ripple_bounds
from camwright.pipeline.smoothing.scenario import Scenario
from camwright.pipeline.smoothing.synthesis_problem import Problem

RUNGS, RUNG = 12, 0.93  # limits of the cam radius per roller, and their ratio to the last cam

Tried = tuple[Choice, DraftJudgement | RefusedJudgement]


@dataclass(frozen=True)
class Pair:
    """Spring and bush for a roller, with a lower bound of the residual ripple."""

    spring: str
    bush: str
    bound: float


@dataclass(frozen=True)
class RollerSearch:
    """Search of the choices of a roller: judgements by the synthesis alone, in their order.

    Parameters
    ----------
    judge : Judge
    roller : str   its name
    tried : list   choices with their judgements
    """

    judge: Judge
    roller: str
    tried: list[Tried] = field(default_factory=list)

    def searched(self, least: Mapping[str, float], bushes: Sequence[str]) -> list[Tried]:
        """All choices of spring and bush for the roller, with their judgements.

        First without a limit on the cam radius, then under limits ever further below the radius of
        the best cam so far. A smaller limit never reduces the ripple: that of a pair bounds it
        under the next limit.

        Parameters
        ----------
        least : mapping      lower bound of the ripple by spring
        bushes : sequence    best pv rating first
        """
        pairs, best = self._unbounded(least, bushes)
        for _ in range(1, RUNGS):
            if best is None:
                break
            pairs, best = self._within(pairs, RUNG * from_unit(best["cam_radius_mm"], "mm"))
        return self.tried

    def _unbounded(
        self, least: Mapping[str, float], bushes: Sequence[str]
    ) -> tuple[list[Pair], DraftJudgement | None]:
        """Judge springs and bushes with the roller without a limit on the cam radius: all springs
        with the first bush, then the other bushes with the best spring.

        Gives the feasible pairs with a lower bound of their ripple, and the judgement of the least
        ripple, None without a feasible one.

        Parameters
        ----------
        least : mapping     lower bound of the ripple, over that of the engine, by spring
        bushes : sequence   names, the first one to be tried with all springs
        """
        pairs: list[Pair] = []
        good: list[DraftJudgement] = []
        ripples: dict[str, float] = {}

        def judge(spring: str, bush: str) -> float:
            record = self._judged(spring, bush)
            if record is not None and record["feasible"]:
                pairs.append(Pair(spring, bush, max(record["ripple_left_share"], least[spring])))
                good.append(record)
            return 1.0 if record is None else record["ripple_left_share"]

        for spring in sorted(least, key=lambda name: (least[name], name)):
            ripples[spring] = judge(spring, bushes[0])
        best = min(ripples, key=lambda name: (ripples[name], name))
        for bush in bushes[1:]:
            judge(best, bush)
        return pairs, min(good, key=lambda record: record["ripple_left_share"], default=None)

    def _within(
        self, pairs: Sequence[Pair], room: float
    ) -> tuple[list[Pair], DraftJudgement | None]:
        """Judge pairs under a limit on the cam radius, by increasing bound of their ripple, until
        the bound is not below the best ripple.

        Gives the pairs still possible under a smaller limit, and the judgement of the least ripple,
        None without a feasible one.

        Parameters
        ----------
        pairs : sequence   springs and bushes with bounds
        room : float       greatest cam radius, m
        """
        best: DraftJudgement | None = None
        after: list[Pair] = []
        for pair in sorted(pairs, key=lambda p: (p.bound, p.spring, p.bush)):
            if best is not None and pair.bound >= best["ripple_left_share"]:
                after.append(pair)
                continue
            record = self._judged(pair.spring, pair.bush, room)
            if record is not None and record["feasible"]:
                after.append(replace(pair, bound=max(record["ripple_left_share"], pair.bound)))
                if best is None or record["ripple_left_share"] < best["ripple_left_share"]:
                    best = record
        return after, best

    def _judged(self, spring: str, bush: str, room: float | None = None) -> DraftJudgement | None:
        """Judgement, by the synthesis alone, of a spring and a bush with the roller; None where the
        case is refused.

        Parameters
        ----------
        spring, bush : str   names in the catalogue
        room : float         greatest cam radius, m; None: not limited
        """
        choice = Choice(self.roller, spring, bush, room)
        record = self.judge.drafted(choice, fine=True)
        self.tried.append((choice, record))
        return None if is_refused(record) else record


@dataclass(frozen=True)
class Selection:
    """Parts of the catalogues that a redesign tries.

    Parameters
    ----------
    springs : mapping   of each roller, its springs with the lower bounds of their ripple
    bushes : tuple      best pv rating first
    pruned : tuple      parts excluded without solution
    as_given : tuple    lines on the kinds of part of which the case has none to be exchanged
    """

    springs: Mapping[str, Mapping[str, float]]
    bushes: tuple[str, ...]
    pruned: tuple[PrunedRecord, ...]
    as_given: tuple[str, ...] = ()


def selection(case: Case, parts: Catalogue, problem: Problem, *, by_mass: bool) -> Selection:
    """Parts of the catalogues that a redesign of a case tries: those not dominated by another,
    rollers with the springs whose energy can reach the required torque reduction; and what is left
    out, with the reason.

    The case keeps a face, a spring that is not a coil spring on the line of travel, and the needle
    bearing of a pivot: the catalogues have none in their place.

    Parameters
    ----------
    case : Case         to be redesigned
    parts : Catalogue   rollers, springs, bushes
    problem : Problem   of the original case: torque and load cases
    by_mass : bool      whether mass is the second objective
    """
    as_given, pruned = list[str](), list[PrunedRecord]()
    forces, names = {AS_GIVEN: np.inf}, [AS_GIVEN]
    if case.facing.parts:
        rollers = undominated(parts.rollers, better_roller)
        pruned += _left_out(parts.rollers, rollers, "dominated by another roller of its size")
        forces = {name: ripple_bounds.bearable_force(card, case) for name, card in rollers.items()}
    else:
        as_given.append("face as given: the catalogues have rollers")
    if case.bushes:
        bushes = undominated(parts.bushes, better_bush)
        why = "dominated by another bush in friction and load"
        pruned += _left_out(parts.bushes, bushes, why)
        best_first = sorted(bushes, key=lambda name: (-bushes[name].pv, name))
        names = [*(names if _bushes_known(case) else ()), *best_first]
    else:
        as_given.append(
            "bearing of the pivot as given: it has no bush, and the catalogues no needles"
        )
    springs = None
    if case.spring.shape is None:
        lengths = {name: (each, travel_of(each, case)) for name, each in parts.springs.items()}
        usable = {name: pair for name, pair in lengths.items() if pair[1] > 0.0}
        springs = undominated(usable, lambda a, b: better_spring(a, b, by_mass=by_mass))
        why = "no travel within its limits at the preload of the case"
        pruned += _left_out(lengths, usable, why)
        pruned += _left_out(usable, springs, "dominated by another spring of its rate in travel")
    else:
        as_given.append("spring as given: the catalogues have coil springs along the travel")
    least = _Least(case, problem, springs)
    tried: dict[str, dict[str, float]] = {}
    for name, force in forces.items():
        bounds = least.by_spring(force)
        bound = {name: each for name, each in bounds.items() if each <= least.allowed}
        if bound:
            tried[name] = bound
        else:
            most, required = 1.0 - min(bounds.values(), default=1.0), 1.0 - least.allowed
            words = (
                f"roller load limit {force:.0f} N: too low for the required torque reduction, "
                f"at most {most:.2f} of {required:.2f}"
            )
            pruned.append({"part": name, "why": words, "limit": TORQUE_REDUCTION.id})
    return Selection(tried, tuple(names), tuple(pruned), tuple(as_given))


@dataclass(frozen=True, eq=False)
class _Least:
    """Lower bounds of the ripple of springs with a roller, from their energy; None: of that of the
    case alone, without a bound.
    """

    case: Case
    problem: Problem
    springs: dict[str, tuple[HelicalSpring, float]] | None

    @property
    def design(self) -> Scenario:
        """Scenario whose ripple counts most."""
        return max(self.problem.scenarios, key=lambda item: item.weight)

    @property
    def allowed(self) -> float:
        """Greatest residual ripple of the required torque reduction."""
        return 1.0 - (self.design.torque_reduction or 0.0)

    def by_spring(self, force: float) -> dict[str, float]:
        """Lower bound of the residual ripple over the ripple of the engine, by spring, where the
        force on the roller is limited.

        By the energy that the spring can store within its travel and the force.

        Parameters
        ----------
        force : float   greatest roller load, N
        """
        if self.springs is None:
            return {AS_GIVEN: 0.0}
        case, problem, design = self.case, self.problem, self.design
        bound = ripple_bounds.RippleBound(design.torque, problem.gear_ratio)
        relief = ripple_bounds.relief_of(problem.scenarios, problem.ratings.bounds.get(JUMP.id))
        preload, bounds = case.spring.preload, {}
        for name, (spring, travel) in self.springs.items():
            held = float(spring_energy(preload, spring.rate, travel))
            borne = ripple_bounds.bearable_energy(force, spring.rate, preload, relief)
            bounds[name] = max(0.0, bound(min(held, borne)) - ripple_bounds.RESERVE)
        return bounds


def _bushes_known(case: Case) -> bool:
    bushes = case.bushes.values()
    return all(each.pressure_limit is not None and each.pv_limit is not None for each in bushes)


def _left_out(parts: Iterable[str], kept: Iterable[str], why: str) -> list[PrunedRecord]:
    known = set(kept)
    return [{"part": name, "why": why, "limit": ""} for name in parts if name not in known]

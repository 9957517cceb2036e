"""Search over the catalogue, ordered by bounds and by solved points.

For each roller the best spring and bush by the synthesis alone, without a limit on the cam radius,
then under decreasing limits. The choices depend on the case alone, not on the processes.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

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
from camwright.pipeline.search.parts import ripple_bounds
from camwright.pipeline.search.parts.design_point import Rough
from camwright.pipeline.smoothing.scenario import Scenario
from camwright.pipeline.smoothing.synthesis_problem import Problem

RUNGS, RUNG = 12, 0.93  # limits of the cam radius per roller, and their ratio to the last cam

Branch = Generator[Choice, Rough, None]


@dataclass(frozen=True)
class Pruned:
    """Part excluded without solution, with reason and limit; "": by no limit."""

    part: str
    why: str
    limit: str = ""


@dataclass(frozen=True)
class Pair:
    """Spring and bush for a roller, with a lower bound of the residual ripple."""

    spring: str
    bush: str
    bound: float


Found = tuple[list[Pair], Rough | None]
"""Feasible pairs with their residual ripple as bound, and the best point of them."""


def branch(roller: str, least: Mapping[str, float], bushes: Sequence[str]) -> Branch:
    """Generator of a roller's choices; the solved point of each is sent back.

    First without a limit on the cam radius, then under limits below the best cam so far. A smaller
    limit never reduces the ripple: the ripple of a pair is its bound under the next limit.

    Parameters
    ----------
    least : mapping      lower bound of the ripple by spring
    bushes : sequence    best pv rating first
    """
    pairs, best = yield from _unbounded(roller, least, bushes)
    for _ in range(1, RUNGS):
        if best is None:
            return
        pairs, best = yield from _within(roller, pairs, RUNG * best.cam_radius)


def _unbounded(
    roller: str, least: Mapping[str, float], bushes: Sequence[str]
) -> Generator[Choice, Rough, Found]:
    """All springs with the first bush, then the other bushes with the best spring."""
    pairs: list[Pair] = []
    points: list[Rough] = []
    ripples: dict[str, float] = {}
    for spring in sorted(least, key=lambda name: (least[name], name)):
        point = yield Choice(roller, spring, bushes[0])
        ripples[spring] = point.ripple
        if point.feasible:
            pairs.append(Pair(spring, bushes[0], max(point.ripple, least[spring])))
            points.append(point)
    best = min(ripples, key=lambda name: (ripples[name], name))
    for bush in bushes[1:]:
        point = yield Choice(roller, best, bush)
        if point.feasible:
            pairs.append(Pair(best, bush, max(point.ripple, least[best])))
            points.append(point)
    return pairs, min(points, key=lambda point: point.ripple, default=None)


def _within(roller: str, pairs: Sequence[Pair], room: float) -> Generator[Choice, Rough, Found]:
    """Pairs by increasing bound until a bound is not below the best ripple."""
    best: Rough | None = None
    after: list[Pair] = []
    for pair in sorted(pairs, key=lambda p: (p.bound, p.spring, p.bush)):
        if best is not None and pair.bound >= best.ripple:
            after.append(pair)
            continue
        point = yield Choice(roller, pair.spring, pair.bush, room)
        if point.feasible:
            after.append(replace(pair, bound=max(point.ripple, pair.bound)))
            if best is None or point.ripple < best.ripple:
                best = point
    return after, best


def branches(
    case: Case, parts: Catalogue, problem: Problem, *, by_mass: bool
) -> tuple[dict[str, Branch], list[Pruned]]:
    """Search branches by roller, and excluded parts with reasons.

    Parameters
    ----------
    problem : Problem   of the original case: torque and load cases
    by_mass : bool      whether mass is the second objective
    """
    rollers = undominated(parts.rollers, better_roller)
    bushes = undominated(parts.bushes, better_bush)
    travels = {name: (spring, travel_of(spring, case)) for name, spring in parts.springs.items()}
    usable = {name: pair for name, pair in travels.items() if pair[1] > 0.0}
    springs = undominated(usable, lambda a, b: better_spring(a, b, by_mass=by_mass))
    pruned = [
        *_left_out(parts.rollers, rollers, "dominated by another roller of its size"),
        *_left_out(parts.bushes, bushes, "dominated by another bush in friction and load"),
        *_left_out(travels, usable, "no travel within its limits at the preload of the case"),
        *_left_out(usable, springs, "dominated by another spring of its rate in travel"),
    ]
    names = sorted(bushes, key=lambda name: (-bushes[name].pv, name))
    names = [AS_GIVEN, *names] if _bushes_known(case) else names
    least = _Least(case, problem, springs)
    running: dict[str, Branch] = {}
    for name, card in rollers.items():
        force = ripple_bounds.bearable_force(card, case)
        bounds = least.by_spring(force)
        bound = {name: each for name, each in bounds.items() if each <= least.allowed}
        if bound:
            running[name] = branch(name, bound, names)
        else:
            most, required = 1.0 - min(bounds.values(), default=1.0), 1.0 - least.allowed
            words = (
                f"roller load limit {force:.0f} N: too low for the required torque reduction, "
                f"at most {most:.2f} of {required:.2f}"
            )
            pruned.append(Pruned(name, words, TORQUE_REDUCTION.id))
    return running, pruned


@dataclass(frozen=True, eq=False)
class _Least:
    """Lower bounds of the ripple of springs with a roller, from their energy."""

    case: Case
    problem: Problem
    springs: dict[str, tuple[HelicalSpring, float]]

    @property
    def design(self) -> Scenario:
        """Scenario whose ripple counts most."""
        return max(self.problem.scenarios, key=lambda item: item.weight)

    @property
    def allowed(self) -> float:
        """Greatest residual ripple of the required torque reduction."""
        return 1.0 - (self.design.torque_reduction or 0.0)

    def by_spring(self, force: float) -> dict[str, float]:
        """Bounds by spring for a roller load limit (N)."""
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
    guides = (case.guides.a, case.guides.b)
    return all(g.pressure_limit is not None and g.pv_limit is not None for g in guides)


def _left_out(parts: Iterable[str], kept: Iterable[str], why: str) -> list[Pruned]:
    known = set(kept)
    return [Pruned(name, why) for name in parts if name not in known]

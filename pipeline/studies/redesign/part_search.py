"""Which parts to try next, by bounds and by what has been solved.

Rough points, on a coarse turn, find the way through the catalogue: for each roller the best spring
and bushes without a bound on the cam's size, then again in ever less room. What is tried depends
on the case alone, never on the number of processes or on which of them is first.
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
from camwright.pipeline.follower.spring import HelicalSpring
from camwright.pipeline.smoothing.synthesis_problem import Problem
from camwright.pipeline.studies.redesign import ripple_bounds
from camwright.pipeline.studies.redesign.design_point import Rough

RUNGS, RUNG = 6, 0.93  # rooms tried for a roller, each this much smaller than the cam before

Branch = Generator[Choice, Rough, None]


@dataclass(frozen=True)
class Pruned:
    """A part left out before anything was solved with it, and why."""

    part: str
    why: str


@dataclass(frozen=True)
class Pair:
    """Spring and bush for a roller, and the least ripple they can leave as far as is known."""

    spring: str
    bush: str
    bound: float


Found = tuple[list[Pair], Rough | None]
"""Pairs that keep the limits, with what they left as their bound, and the best point of them."""


def branch(roller: str, least: Mapping[str, float], bushes: Sequence[str]) -> Branch:
    """Choices to try with a roller, one at a time; is sent what came of each.

    First without a bound on the cam's size, then in rooms that are each a little smaller than
    the best cam before. Less room never leaves less ripple, so what a pair left in one room is
    its bound in the next.

    Parameters
    ----------
    least : mapping      bound on the ripple by spring
    bushes : sequence    the likeliest first
    """
    pairs, best = yield from _unbounded(roller, least, bushes)
    for _ in range(1, RUNGS):
        if best is None:
            return
        pairs, best = yield from _within(roller, pairs, RUNG * best.cam_radius)


def _unbounded(
    roller: str, least: Mapping[str, float], bushes: Sequence[str]
) -> Generator[Choice, Rough, Found]:
    """Every spring with the likeliest bush, then the other bushes with the best spring."""
    pairs: list[Pair] = []
    points: list[Rough] = []
    ripples: dict[str, float] = {}
    for spring in sorted(least, key=lambda name: (least[name], name)):
        found = yield Choice(roller, spring, bushes[0])
        ripples[spring] = found.ripple
        if found.feasible:
            pairs.append(Pair(spring, bushes[0], max(found.ripple, least[spring])))
            points.append(found)
    likeliest = min(ripples, key=lambda name: (ripples[name], name))
    for bush in bushes[1:]:
        found = yield Choice(roller, likeliest, bush)
        if found.feasible:
            pairs.append(Pair(likeliest, bush, max(found.ripple, least[likeliest])))
            points.append(found)
    return pairs, min(points, key=lambda point: point.ripple, default=None)


def _within(roller: str, pairs: Sequence[Pair], room: float) -> Generator[Choice, Rough, Found]:
    """Pairs in the order of their bounds until a bound is no better than the best found."""
    best: Rough | None = None
    after: list[Pair] = []
    for pair in sorted(pairs, key=lambda p: (p.bound, p.spring, p.bush)):
        if best is not None and pair.bound >= best.ripple:
            after.append(pair)
            continue
        found = yield Choice(roller, pair.spring, pair.bush, room)
        if found.feasible:
            after.append(replace(pair, bound=max(found.ripple, pair.bound)))
            if best is None or found.ripple < best.ripple:
                best = found
    return after, best


def branches(
    case: Case, parts: Catalogue, problem: Problem, *, by_mass: bool
) -> tuple[dict[str, Branch], list[Pruned]]:
    """A branch for each roller worth trying, and the parts that are not, with the reasons.

    Parameters
    ----------
    problem : Problem   of the case as given: its torque and load cases
    by_mass : bool      whether a lighter spring is worth trying beside a longer one
    """
    rollers = undominated(parts.rollers, better_roller)
    bushes = undominated(parts.bushes, better_bush)
    travels = {name: (spring, travel_of(spring, case)) for name, spring in parts.springs.items()}
    usable = {name: pair for name, pair in travels.items() if pair[1] > 0.0}
    springs = undominated(usable, lambda a, b: better_spring(a, b, by_mass=by_mass))
    pruned = [
        *_left_out(parts.rollers, rollers, "another roller of its size is rated no lower"),
        *_left_out(parts.bushes, bushes, "another bush rubs no more and bears no less"),
        *_left_out(travels, usable, "a spring that keeps no limit at the case's preload"),
        *_left_out(usable, springs, "another spring of its rate has no less travel"),
    ]
    names = sorted(bushes, key=lambda name: (-bushes[name].pv, name))
    names = [AS_GIVEN, *names] if _bushes_known(case) else names
    least = _Least(case, problem, springs)
    found: dict[str, Branch] = {}
    for name, card in rollers.items():
        force = ripple_bounds.bearable_force(card, case)
        bound = least.by_spring(force)
        if bound:
            found[name] = branch(name, bound, names)
        else:
            words = f"a roller that bears {force:.0f} N: too little for the reduction asked for"
            pruned.append(Pruned(name, words))
    return found, pruned


@dataclass(frozen=True, eq=False)
class _Least:
    """The least ripple of springs behind a roller, from what they can hold."""

    case: Case
    problem: Problem
    springs: dict[str, tuple[HelicalSpring, float]]

    def by_spring(self, force: float) -> dict[str, float]:
        """Bounds for a roller that bears a force (N); springs that cannot do are left out."""
        case, problem = self.case, self.problem
        torque = max(problem.scenarios, key=lambda item: item.weight).torque
        bound = ripple_bounds.RippleBound(torque, problem.gear_ratio)
        relief = ripple_bounds.relief_of(problem.scenarios, problem.ratings.limits.get(JUMP))
        allowed = 1.0 - case.limits[TORQUE_REDUCTION] + ripple_bounds.IN_HAND
        preload, found = case.spring.preload, {}
        for name, (spring, travel) in self.springs.items():
            held = preload * travel + 0.5 * spring.rate * travel**2
            borne = ripple_bounds.bearable_energy(force, spring.rate, preload, relief)
            least = bound(min(held, borne))
            if least <= allowed:
                found[name] = max(0.0, least - ripple_bounds.IN_HAND)
        return found


def _bushes_known(case: Case) -> bool:
    guides = (case.guides.a, case.guides.b)
    return all(g.pressure_limit is not None and g.pv_limit is not None for g in guides)


def _left_out(given: Iterable[str], kept: Iterable[str], why: str) -> list[Pruned]:
    known = set(kept)
    return [Pruned(name, why) for name in given if name not in known]

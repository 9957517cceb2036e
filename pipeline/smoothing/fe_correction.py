"""Correction of a synthesis, made by closed forms, by the finite elements of its cam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import Array
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import within_depth
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check, depends_on_lift
from camwright.pipeline.checks.demands import NORMAL_FORCE, PRESSURE
from camwright.pipeline.checks.guide_strength import GUIDES, Side, hottest
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.speed_sweep import SpeedSweep, SweptForces, swept_forces
from camwright.pipeline.follower.follower_forces import Loads, levers
from camwright.pipeline.follower.spring import spring_energy
from camwright.pipeline.records.trial_contents import SynthesisRecord
from camwright.pipeline.smoothing.allowables import (
    LOADED_SHARE,
    corrected_ratings,
    softening,
    weights_of,
)
from camwright.pipeline.smoothing.multistart import NEGLIGIBLE, Explored
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Correction, Ratings
from camwright.pipeline.smoothing.shadow_prices import prices
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem

SETTLED = 5e-3  # of a limit: maximum change of a utilisation at convergence
SETTLED_RIPPLE = 2e-3  # of the residual ripple: maximum change by a further trial at convergence
_GUIDED_SHARE = 1e-6
"""Least load of the guides over its maximum for a ratio: little is needed to rub and to tilt."""
_COUNTED_USE = 0.5  # utilisation below which a limit does not count
_JUDGED_MOST = 3.0  # utilisation at a tolerance corner over that of the synthesis
_LATEST_SHARE = 0.25  # least share of the latest corrections in those of the next trial
_SUM = 1e3  # weight of the sum of the shares in their least squares


class LimitShift(NamedTuple):
    """Change of one limit's utilisation by finite elements."""

    limit: str
    before: float
    after: float

    @property
    def change(self) -> float:
        """Change, of the limit."""
        return self.after - self.before

    @property
    def sentence(self) -> str:
        """The change in words."""
        values = f"from {self.before:.4g} to {self.after:.4g} of its limit"
        return f"finite elements change {self.limit} {values}"


@dataclass(frozen=True, eq=False)
class Comparison:
    """Finite elements of a cam against the closed forms of its synthesis.

    Parameters
    ----------
    applied : tuple of Correction       in the synthesis, by scenario
    corrections : tuple of Correction   by scenario, of this cam alone
    judged : mapping                    see `Problem`, of this cam
    ratings : Ratings                   with the limits that follow from this cam
    shifts : tuple of LimitShift        of each limit
    ripple_shift : float                change of ripple and costs by a further trial, relative, to
                                        first order: that of the Lagrangian
    converged : bool                    of the synthesis; else the shift of the ripple is not known
    """

    applied: tuple[Correction, ...]
    corrections: tuple[Correction, ...]
    ratings: Ratings
    shifts: tuple[LimitShift, ...]
    ripple_shift: float
    converged: bool = True
    judged: Mapping[str, float] = field(default_factory=dict)

    @property
    def used(self) -> tuple[LimitShift, ...]:
        """Shifts of the limits used by at least one half, the greatest first."""
        used = (each for each in self.shifts if max(each.before, each.after) > _COUNTED_USE)
        return tuple(sorted(used, key=lambda each: -abs(each.change)))

    @property
    def sentence(self) -> str:
        """The greatest change in words."""
        if not self.used:
            return "finite elements change no utilisation above one half"
        return self.used[0].sentence

    @property
    def excess(self) -> float:
        """Greatest excess of a utilisation of the solved cam over its limit; 0 within all."""
        return max(0.0, *(each.after - 1.0 for each in self.used))

    @property
    def agree(self) -> bool:
        """Whether finite elements change the ripple by 0.2 % at most and no limit by 0.5 %."""
        within = self.converged and abs(self.ripple_shift) < SETTLED_RIPPLE
        return within and all(abs(each.change) < SETTLED for each in self.used)

    @property
    def settled(self) -> bool:
        """Whether no further trial can help: they agree, and exceed no limit by the difference."""
        return self.agree and all(
            each.after <= 1.0 or abs(each.change) < RESERVE for each in self.used
        )


class Rank(NamedTuple):
    """Rank of a trial, least is best: infinite violations, greatest finite violation, ripple."""

    infinite: int
    violation: float
    ripple: float


def solved_ripple(cycles: Sequence[Cycle]) -> float:
    """Greatest weighted torque ripple over the engine's, of one solved cycle per load case."""
    ripples = [
        cycle.machine.ripple_weight * float(np.std(after) / np.std(before))
        for cycle in cycles
        for before, after in ((cycle.turn.torque_before, cycle.turn.torque_after),)
        if before is not None and after is not None and cycle.machine.ripple_weight > 0
    ]
    return max(ripples, default=0.0)


def rank(checks: Sequence[Check], ripple: float) -> Rank:
    """Rank of a trial by the must-have checks that depend on the lift, then by its ripple.

    Of trials without a violation that of the least ripple is the best. A check that a deeper
    solution judges does not count.

    Parameters
    ----------
    ripple : float   see `solved_ripple`
    """
    uses = [
        np.inf if one.utilisation is None else one.utilisation
        for one in within_depth(checks)
        if one.must_have and one.status == "fail" and depends_on_lift(one)
    ]
    # A check fails by its error bar too: its violation is at least the reserve.
    over = [max(use - 1.0, RESERVE) for use in uses if np.isfinite(use)]
    return Rank(len(uses) - len(over), max(over, default=0.0), ripple)


def compared(
    problem: Problem, design: Design, solved: Solution, checks: Sequence[Check] = ()
) -> Comparison:
    """Comparison of a cam solved by finite elements with its synthesis by closed forms: new
    corrections, and by how much they change each utilisation and the objective.

    Parameters
    ----------
    problem : Problem   of which the cam is the optimum
    design : Design     the synthesis
    solved : Solution   its cam
    checks : sequence   of the solved cam, judged at the tolerance corners; none: the synthesis is
                        not corrected for corners and error bars
    """
    ratings = corrected_ratings(problem.ratings, solved)
    weights = weights_of(solved, ratings)
    ratings = replace(ratings, by={**ratings.by, **weights.by})
    by_load_case = {
        name: replace(
            each,
            pressure_weight=weights.values[PRESSURE][name],
            force_weight=weights.values[NORMAL_FORCE][name],
        )
        for name, each in corrections_of(solved).items()
    }
    applied = tuple(each.correction for each in problem.scenarios)
    # A tolerance corner takes the correction of its load case.
    corrections = tuple(
        by_load_case.get(each.name.split(",")[0], each.correction) for each in problem.scenarios
    )
    after = replace(_with_corrections(problem, corrections), ratings=ratings, judged={})
    uses = [_utilisation(each, design) for each in (problem, after)]
    judged = judged_over(uses[1], checks, problem.judged if design.feasible else None)
    if judged:
        after = replace(after, judged=judged)
        uses[1] = _utilisation(after, design)
    shifts = tuple(LimitShift(name, use, uses[1][name]) for name, use in uses[0].items())
    ripple_shift = np.inf
    if design.lagrangian is not None:
        now, then = (design.lagrangian.at(each) for each in (problem, after))
        ripple_shift = (then - now) / max(design.objective, NEGLIGIBLE)
    return Comparison(applied, corrections, ratings, shifts, ripple_shift, design.converged, judged)


def judged_over(
    uses: Mapping[str, float], checks: Sequence[Check], known: Mapping[str, float] | None
) -> dict[str, float]:
    """Utilisation by which a run judges a check, over that of the corrected synthesis, by check; 1
    to `_JUDGED_MOST`.

    The run judges at the worst tolerance corner and the end of the error bar. A ratio that has
    grown since the last correction is extrapolated: multiplied by its growth. Of checks that must
    be met, those that fail and those with a known ratio.

    Parameters
    ----------
    uses : mapping            utilisation of the corrected synthesis by limit
    checks : sequence         of the solved cam
    known : mapping or None   ratios of the last correction; None, where the limits conflict: all
                              checks get one
    """
    ratios = {}
    for one in checks:
        use, corrected_use = one.upper_utilisation, uses.get(one.id)
        if use is None or corrected_use is None or not one.must_have:
            continue
        if known is not None and one.id not in known and one.status != "fail":
            continue
        if one.id == TORQUE_REDUCTION.id:  # the synthesis limits what is left, at its nominal
            nominal = replace(one, corner="", corner_demand=None)
            use, corrected_use = (1.0 - float(each.worst or 0.0) for each in (one, nominal))
        if not (corrected_use > 0.0 and np.isfinite(use / corrected_use)):
            continue
        ratio = use / corrected_use
        growth = max(ratio / known[one.id], 1.0) if known and one.id in known else 1.0
        ratios[one.id] = float(np.clip(ratio * growth, 1.0, _JUDGED_MOST))
    return ratios


def corrected(problem: Problem, design: Design, cams: Sequence[Comparison]) -> Problem:
    """Problem of the next trial, with mixed corrections, started from the design of the last.

    The corrections are the convex combination of those of all cams for which the change of the
    utilisations of the design over the turn, by the corrections of a cam against those applied in
    its synthesis, is least: where several limits alternate, their changes cancel. This is
    Anderson's mixing without extrapolation.

    Parameters
    ----------
    problem : Problem   of the last trial
    design : Design     its optimum
    cams : sequence     of all trials in order, that of the design last

    References
    ----------
    Walker and Ni, SIAM J. Numer. Anal. 49 (2011) 1715: Anderson acceleration.
    """
    changes = [
        _over_turn(problem, design, cam.corrections) - _over_turn(problem, design, cam.applied)
        for cam in cams
    ]
    weights = shares(np.stack(changes, axis=1))
    scenarios = tuple(
        replace(each, correction=_mixed([cam.corrections[k] for cam in cams], weights))
        for k, each in enumerate(problem.scenarios)
    )
    return replace(
        problem,
        scenarios=scenarios,
        ratings=cams[-1].ratings,
        judged=cams[-1].judged,
        seed=design.coefficients,
        variables=design.variables,
    )


def shares(changes: Array) -> Array:
    """Weights (m,), of sum 1, with which the corrections of m solved cams enter the next trial.

    Least squares of the weighted changes, with weights >= 0; the latest corrections have at least
    `_LATEST_SHARE`.

    Parameters
    ----------
    changes : array (n, m)   change of n utilisations of one cam by the corrections of each solved
                             cam, against those with which that cam was found
    """
    changes = np.asarray(changes, dtype=float)
    scale = float(np.abs(changes).max(initial=0.0))
    latest = np.eye(changes.shape[1])[-1:]
    if scale == 0.0:
        return np.asarray(latest[0])
    matrix = np.vstack([changes / scale, np.full(changes.shape[1], _SUM)])
    solution, _ = scipy.optimize.nnls(matrix, np.append(np.zeros(len(changes)), _SUM))
    weights = np.asarray(solution / np.sum(solution), dtype=float)
    if weights[-1] < _LATEST_SHARE:  # else a trial could be solved twice
        weights[:-1] *= (1.0 - _LATEST_SHARE) / (1.0 - weights[-1])
        weights[-1] = _LATEST_SHARE
    return weights


def _mixed(corrections: Sequence[Correction], weights: Array) -> Correction:
    """Weighted mean of corrections, at the equal cam angles of the last one with weight.

    Parameters
    ----------
    corrections : sequence, m   ratios of finite elements to closed forms
    weights : array (m,)        of each, summing to 1
    """
    mean, total = corrections[0], float(weights[0])
    for one, weight in zip(corrections[1:], weights[1:], strict=True):
        total += float(weight)
        mean = mean.towards(one, float(weight) / total if total > 0.0 else 1.0)
    return mean


def corrections_of(solved: Solution) -> dict[str, Correction]:
    """Corrections of the closed forms by load case, from a solved cam: loads and pressures of the
    finite elements over those of the closed forms, surge of the spring over the speed range, and
    strength left in warm guides.
    """
    swept = {sweep.preload: _at_least_force(solved, sweep) for sweep in solved.speed_sweeps}
    guides = zip(GUIDES, solved.machine.guides.both, strict=True)
    left = [
        softening(solved.machine, guide, _temperature(solved, side)) for side, (_, guide) in guides
    ]
    corrections = {}
    for cycle in solved.cycles:
        correction = swept.get(cycle.machine.spring.preload, Correction.none(cycle.theta.size))
        corrections[cycle.load_case] = _of_cycle(cycle, correction.at(cycle.theta), left)
    return corrections


def _temperature(solved: Solution, side: Side) -> float:
    """Temperature of a guide at the greatest friction, K; 20 degC where it is not known."""
    temperature = hottest(solved, side).value
    return ROOM if np.isnan(temperature) else temperature


def _at_least_force(solved: Solution, sweep: SpeedSweep) -> Correction:
    """Correction of the spring force alone, N, by surge with a rigid and with an elastic stem, each
    at the speed of a sweep with the least contact force.

    Parameters
    ----------
    solved : Solution    with the cam
    sweep : SpeedSweep   contact forces over the speed range, at the preload of a load case
    """
    cycle = next(each for each in solved.cycles if each.machine.spring.preload == sweep.preload)

    def at(force: Array) -> tuple[float, SweptForces]:
        speed = float(sweep.crank_speed[int(np.argmin(force))]) / cycle.machine.gear_ratio
        return speed, swept_forces(cycle.machine, solved.contour, cycle.loads.rubbing, speed)

    rigid_speed, rigid = at(sweep.contact_force_min)
    elastic_speed, elastic = at(sweep.elastic_force_min)
    none = Correction.none(rigid.surge.size)
    return replace(
        none,
        swept_surge=rigid.surge,
        elastic=elastic.elastic,
        swept_speed=rigid_speed * none.contact,
        elastic_speed=elastic_speed * none.contact,
    )


def _of_cycle(cycle: Cycle, swept: Correction, left: Sequence[tuple[float, float]]) -> Correction:
    """Correction of a load case: results of its cycle over closed forms (n,), and the surge at its
    speed.

    Parameters
    ----------
    swept : Correction   of the speed range
    left : pairs         shares of pressure limit and line load of the guides; see `softening`
    """
    guides, contact, machine = cycle.guides, cycle.surface, cycle.machine
    load, parts = np.hypot(*cycle.loads.pivot_load), cycle.parts
    of_bush = [
        np.ones_like(load) if push is None else _ratio(push, load)
        for push in (parts.pivot_rubbing, parts.pivot_bearing)
    ]
    worst, friction = cycle.parts.friction.greatest, machine.guide_friction.greatest
    (line_a, line_b), (push_a, push_b) = cycle.guide_lines, cycle.guide_pushes
    plane, worn = (guides.rubbing_load_a, guides.rubbing_load_b), cycle.guide_rubbing
    (mu_a, mu_b), (hot_a, hot_b) = machine.guide_friction.nominal, cycle.hot_friction
    surge, spacing = cycle.parts.surge_force, machine.guides.spacing
    of_guides = _Statics.of(cycle.loads, spacing, (guides.statics_a, guides.statics_b))
    hot = _Statics.of(worst, spacing, (worst.reaction_a, worst.reaction_b))
    path, _ = cycle.contour.pitch.speed_and_curvature(cycle.theta)
    return replace(
        swept,
        contact=_ratio(contact.p0, contact.p0_hertz),
        lever=_lever(cycle),
        guide_a=of_guides.correction(0, push_a / left[0][0]),
        guide_b=of_guides.correction(1, push_b / left[1][0]),
        rubbing_a=of_guides.correction(0, guides.rubbing_load_a),
        rubbing_b=of_guides.correction(1, guides.rubbing_load_b),
        worn_a=of_guides.correction(0, worn[0]),
        worn_b=of_guides.correction(1, worn[1]),
        jam_tilted=_ratio(mu_a * worn[0] + mu_b * worn[1], mu_a * plane[0] + mu_b * plane[1]),
        jam=_ratio(worst.jam_index, worst.jam_index_statics),
        edge_a=of_guides.correction(0, line_a * machine.guides.a.length / left[0][1]),
        edge_b=of_guides.correction(1, line_b * machine.guides.b.length / left[1][1]),
        hot_a=hot.correction(0, _over(hot_a, friction[0])),
        hot_b=hot.correction(1, _over(hot_b, friction[1])),
        bush_rubbing=of_bush[0],
        bush_bearing=of_bush[1],
        surge=np.zeros(cycle.theta.size) if surge is None else surge,
        rolling=np.full(cycle.theta.size, machine.follower.turns(path)),
        least_lift=np.full(cycle.theta.size, cycle.contour.pitch.lift.lowest.value),
    )


class _Statics(NamedTuple):
    """Loads of point supports A and B, (n,), N: by side force and couple at once; by each alone."""

    both: tuple[Array, Array]
    whole: tuple[Array, Array]

    @classmethod
    def of(cls, loads: Loads, spacing: float, both: tuple[Array, Array]) -> _Statics:
        """Magnitudes of the loads of point supports at the guides, N, each (n,): with side force
        and couple at once, and the sum of those by each alone.

        Parameters
        ----------
        loads : Loads            of the follower
        spacing : float          of the guides, m
        both : tuple of arrays   load of A and of B by side force and couple at once, N
        """
        side, couple = np.abs(loads.tangential_force), np.abs(loads.end_moment) / spacing
        lever_a, lever_b = levers(loads.overhang, spacing)
        on_a, on_b = (np.abs(each) for each in both)
        return cls((on_a, on_b), (side * lever_a + couple, side * lever_b + couple))

    def correction(self, place: int, solved: Array) -> Array:
        """Correction (n,) with which `Reaction` is the solved load; 1 where unloaded."""
        load = self.whole[place]
        return _ratio(np.abs(solved) + load - self.both[place], load, _GUIDED_SHARE)


def _lever(cycle: Cycle) -> Array:
    """Moment of the contact about the middle of the follower over its force (n,), m; 0 where
    unloaded.
    """
    force, moment = cycle.loads.normal_force, cycle.follower_moment
    loaded = np.isfinite(moment) & (force > _GUIDED_SHARE * force.max())
    return np.where(loaded, moment, 0.0) / np.where(loaded, force, 1.0)


def _over(force: Array, friction: float) -> Array:
    """Normal load of a friction force (n,), N; 0 without friction."""
    return force / friction if friction > 0.0 else np.zeros_like(force)


def _ratio(solved: Array, closed: Array, least: float = LOADED_SHARE) -> Array:
    """Solved over closed-form result (n,), 1 where unloaded."""
    solved, closed = np.abs(solved), np.abs(closed)
    loaded = np.isfinite(solved) & (closed > least * closed.max())
    return np.where(loaded, solved, 1.0) / np.where(loaded, closed, 1.0)


def _utilisation(problem: Problem, design: Design) -> Mapping[str, float]:
    """Utilisation of each limit of a problem by a design."""
    search = Search(replace(problem, seed=design.coefficients))
    return search.state(design.coefficients, design.variables).utilisation


def _over_turn(problem: Problem, design: Design, corrections: Sequence[Correction]) -> Array:
    """Utilisations of all limits over the turn, (n,), each of the weight of one value."""
    search = _search(problem, design, corrections)
    uses = search.utilisations(design.coefficients, design.variables, search.turn)
    return np.concatenate([use / np.sqrt(use.size) for _, use in sorted(uses.items())])


def _search(problem: Problem, design: Design, corrections: Sequence[Correction]) -> Search:
    return Search(replace(_with_corrections(problem, corrections), seed=design.coefficients))


def _with_corrections(problem: Problem, corrections: Sequence[Correction]) -> Problem:
    scenarios = tuple(
        replace(each, correction=correction)
        for each, correction in zip(problem.scenarios, corrections, strict=True)
    )
    return replace(problem, scenarios=scenarios)


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


def design_record(
    design: Design,
    problem: Problem,
    first: Explored | None = None,
) -> SynthesisRecord:
    """Record of a synthesis in ``trial.json``.

    Parameters
    ----------
    problem : Problem   of the design, with its corrections
    first : Explored    of the first trial; None for a design started from the trial before
    """
    least = float(design.lift().lowest.value)
    variables = design.variables
    record: SynthesisRecord = {
        "feasible": design.feasible,
        "converged": design.converged,
        "steps": design.steps,
        "ripple_left": design.ripple,
        "initial_energy_J": max(
            0.0, float(spring_energy(variables.closing, variables.rate, least, variables.shape))
        ),
        "spring_rate_N_per_mm": in_unit(variables.rate, "N/mm"),
        "preload_N": variables.preload,
        "prime_radius_mm": in_unit(variables.prime_radius, "mm"),
        "phase_deg": in_unit(variables.phase, "deg"),
        "reserve": RESERVE,
        "starts": None if first is None else first.starts.as_record(),
        "resolution": None if first is None else first.resolution.as_record(),
        "corrections": _corrections_record(problem),
        "utilisation": dict(sorted(design.utilisation.items(), key=lambda item: -item[1])),
        "prices": prices(design, problem) if design.feasible else [],
    }
    if design.ended:
        record["ended"] = True
    return record

"""Trust-region descent by sequential convex programs, from a start to a local optimum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.smoothing.cone_program import ConeSolution, Reach, solved
from camwright.pipeline.smoothing.lagrangian import lagrangian_curvature
from camwright.pipeline.smoothing.linear_model import Model, State
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import CONVERGED, FEASIBLE, RESERVE

PENALTY, _PENALTY_MAX = 20.0, 2e3
# Of a search of bounded effort: 1 % of a limit that is worth more costs twice the engine's ripple.
_PENALTY_BOUNDED = 2e2
_HOPELESS_GAIN = 0.01  # foreseen gain over the excess, where a cam within the limits is not reached
_CREEPING_GAIN = 1e-3  # the same, at which a search that is stuck has its end
_INSIDE = 0.9  # of the trust region
_PENALTY_RISE = 10.0  # of the penalty outside a limit
_RAISING_GAIN = 1e-4  # foreseen gain at `PENALTY`, outside a limit, at which the penalty is raised
_STEPS_MAX = 60
_TRUST, _TRUST_LEAST = 0.3, 1e-7
_PROVING_TRUST = 0.03  # least trust region in which a foreseen gain proves convergence
_TRUST_GROWTH, _TRUST_GROWTH_OUTSIDE = 4.0, 2.0
"""Growth of the trust region after a good step, within and outside the limits."""
_SMALLER, _SMALLEST = 0.35, 0.1  # of the trust region of a refused step
_REFUSALS = 2  # of a step; after more the functions are rough
_ADDITIONS = 4
_CORRECTED = 0.9  # of the foreseen gain: below, the step is corrected
_BENT = 0.5  # of the foreseen gain: below, the step is shortened
_SETTLING = 10  # steps in which most searches outside the limits converge; then they may be stuck
# Of the violation: greatest decrease in the linear models of a search that is stuck, and of one
# that a greater penalty would not move.
_STUCK_DECREASE, _STUCK_AT_PENALTY = 0.01, 0.003
_VIOLATED = 1e-6
_PATIENCE = 4  # steps over which the gain of a draft is judged


class Descent(NamedTuple):
    """Result of a descent: state, last model and program, number of steps.

    gain: decrease of the merit that another step foresees; penalty: of a unit of violation. stuck:
    whether no cam near the end exceeds the limits by notably less. ended: whether the effort of the
    problem ended the search.
    """

    state: State
    model: Model | None
    program: ConeSolution | None
    steps: int
    gain: float
    penalty: float
    stuck: bool = False
    ended: bool = False


def descended(
    search: Search,
    ripple_weight: float,
    earlier: Descent | None = None,
    enough: float | None = None,
    worth: float = 0.0,
) -> Descent:
    """Local optimum of a synthesis problem from its start.

    Outside the limits the search ends, `stuck`, where a step foresees next to no gain and the least
    violation of the linear models is that of the cam, or wider steps were refused: a greater
    penalty would gain nothing, and limits that jump make it creep. A search without a seed and of
    unbounded effort has some steps before. One of bounded effort ends likewise where the penalty is
    to rise, if the least is nearer still.

    Parameters
    ----------
    search : Search         problem with its start and its cam angles
    ripple_weight : float   of the ripple in the merit; 0: any cam within the limits
    earlier : Descent       end of a search with fewer extra angles, to go on from
    enough : float          ripple over that of the engine at which any cam within the limits is an
                            end, as is one far from both at which little gain is foreseen; None: the
                            least is wanted
    worth : float           least decrease of the merit over `_PATIENCE` steps within the limits:
                            means of loads that jump at the reversals of an offset follower are
                            rough functions of the cam, on which the search creeps

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 14.4: sequential programming with an
    exact penalty, second derivatives of the Lagrangian and a trust region.
    Byrd, Nocedal, Waltz, Optim. Methods Softw. 23 (2008) 197: a penalty steered by the least
    violation of the linear models.
    """
    start = search.start, search.problem.variables
    model: Model | None = None
    program: ConeSolution | None = None
    if earlier is not None:
        start = earlier.state.coefficients, earlier.state.variables
        model, program = earlier.model, earlier.program
    state, trust = search.state(*start), _TRUST
    penalty = PENALTY if earlier is None else earlier.penalty
    merits: list[float] = []
    tries, effort = 0, search.problem.effort or np.inf
    most = _PENALTY_MAX if search.problem.effort is None else _PENALTY_BOUNDED
    for step in range(1, _STEPS_MAX + 1):
        before, priced = model, program
        merits.append(state.merit(penalty, ripple_weight))
        slow = step > _PATIENCE and merits[-1 - _PATIENCE] - merits[-1] < worth
        if slow and _within(state):
            return Descent(state, before, priced, step, worth, penalty)
        if enough is not None and state.ripple <= enough and _within(state):
            return Descent(state, before, priced, step, np.inf, penalty)
        if tries >= effort:
            return Descent(state, None, None, step, np.inf, penalty, ended=True)
        model = search.model(state)
        if before is not None and priced is not None:
            hessian = lagrangian_curvature(search, state, model, before, priced)
            model = model._replace(curvature=_convex(model.curvature + hessian))
        proven, gain, tested, widest, refused = False, np.inf, False, trust, 0
        while True:
            program, there, model = _program(search, state, model, trust, penalty, ripple_weight)
            tries += 1
            if program is None:
                trust *= 0.3
                if trust < _TRUST_LEAST:
                    return Descent(state, before, priced, step, gain, penalty)
                continue
            size = _size(search, program.step)
            now = state.merit(penalty, ripple_weight)
            predicted = now - program.objective - state.jerk
            # Outside a limit the merit is next to the penalty alone.
            outside = not _within(state)
            scale = penalty / PENALTY if outside else 1.0
            raised = outside and penalty < most
            least = (_RAISING_GAIN if raised else CONVERGED) * scale
            if trust >= _PROVING_TRUST or gain == np.inf:
                gain = predicted / scale
            if enough is not None and _inside(search, program.step, trust):
                missing = penalty * state.violation
                missing += ripple_weight * max(0.0, state.ripple - enough)
                if predicted <= _HOPELESS_GAIN * missing:
                    return Descent(state, model, program, step, gain, penalty)
            creeping = predicted <= _CREEPING_GAIN * penalty * state.violation
            # Beyond a limit, not beyond its reserve alone.
            beyond = any(value > 1.0 for value in state.utilisation.values())
            conflict = ripple_weight > 0.0 and beyond
            # A search from the end of another has no long way to go, one of bounded effort no time.
            settled = step > _SETTLING or search.problem.seed is not None or effort < np.inf
            if settled and conflict and creeping and not tested:
                tested = True
                if trust < _PROVING_TRUST or _stuck(search, state, model, _STUCK_DECREASE):
                    return Descent(state, model, program, step, gain, penalty, stuck=True)
            actual = now - there.merit(penalty, ripple_weight)
            if predicted > least and actual < _CORRECTED * predicted:
                other = _program(
                    search,
                    state,
                    _corrected(search, model, program, there),
                    trust,
                    penalty,
                    ripple_weight,
                )
                tries += 1
                if other[0] is not None:
                    decrease = now - other[1].merit(penalty, ripple_weight)
                    if decrease > actual:
                        (_, there, _), actual = other, decrease
            if not outside and least < actual < _BENT * predicted:
                nearer = _nearer(search, state, program.step, there, penalty, ripple_weight)
                there, actual = nearer, now - nearer.merit(penalty, ripple_weight)
            # Narrower steps than the first were refused before those that prove convergence.
            if predicted <= least or (proven and trust < min(widest, _PROVING_TRUST)):
                if trust < _PROVING_TRUST and not proven:
                    trust, proven = _PROVING_TRUST, True
                    continue
                if raised:
                    if conflict and not tested and search.problem.effort is not None:
                        tested = True
                        if _stuck(search, state, model, _STUCK_AT_PENALTY):
                            return Descent(state, model, program, step, gain, penalty, stuck=True)
                    penalty *= _PENALTY_RISE
                    trust, widest = max(trust, 0.1), 0.0
                    model = model._replace(
                        curvature=_PENALTY_RISE * model.curvature
                    )  # as the multipliers
                    continue
                end = there if actual > 0 else state
                return Descent(end, model, program, step, gain, penalty)
            share = actual / predicted
            if share > 0.05:
                state = there
                wider = _TRUST_GROWTH_OUTSIDE if outside else _TRUST_GROWTH
                trust = min(trust * (wider if share > 0.7 else 1.0 if share > 0.25 else 0.5), 1.0)
                break
            refused += 1
            trust *= _SMALLER if refused <= _REFUSALS else _SMALLEST
            # A trust region that does not limit the step gives the same again.
            while trust > size:
                trust *= _SMALLER
            if trust < _TRUST_LEAST:
                return Descent(state, model, program, step, gain, penalty)
    return Descent(state, model, program, _STEPS_MAX, gain, penalty)


def _nearer(
    search: Search, state: State, step: Array, there: State, penalty: float, ripple_weight: float
) -> State:
    """State of least merit among the end of a step, its middle, and the minimum of the parabola
    through the merits at start, middle and end.

    Where the curvature of the model is too small, steps overshoot to and fro across a valley.

    Parameters
    ----------
    search : Search         the sampled problem
    state, there : State    before and after the step
    step : array (size,)    in the scaled unknowns
    penalty : float         of a unit of violation in the merit
    ripple_weight : float   of ripple and costs in the merit
    """
    middle = search.state(*search.after(state, 0.5 * step))
    merits = [each.merit(penalty, ripple_weight) for each in (state, middle, there)]
    slope, second = (
        4.0 * merits[1] - 3.0 * merits[0] - merits[2],
        merits[0] - 2.0 * merits[1] + merits[2],
    )
    tried = [there, middle]
    if second > 0.0 and 0.0 < (share := -0.25 * slope / second) < 1.0:
        tried.append(search.state(*search.after(state, share * step)))
    return min(tried, key=lambda each: each.merit(penalty, ripple_weight))


def _stuck(search: Search, state: State, model: Model, share: float) -> bool:
    """Whether the linear models near a state decrease its violation by less than a share."""
    linear = model._replace(
        curvature=np.zeros_like(model.curvature), slope=np.zeros_like(model.slope)
    )
    program, _, _ = _program(search, state, linear, _TRUST, penalty=1.0, ripple_weight=0.0)
    return program is not None and program.objective >= (1.0 - share) * state.violation


def _corrected(search: Search, model: Model, program: ConeSolution, there: State) -> Model:
    """Linear model with its limits corrected to second order: their levels are the utilisations
    after the step, less the linear change along it.

    Parameters
    ----------
    search : Search          the sampled problem
    model : Model            at the start of the step
    program : ConeSolution   with the step
    there : State            after the step
    """
    limits = []
    for each in model.limits:
        sampled = (each.point < there.grid.theta.size).all()  # reversals may end
        if each.mean:
            value = there.means[each.name][each.scenario]
        elif each.name in there.pointwise and sampled:
            value = there.pointwise[each.name][each.scenario, each.point]
        else:
            limits.append(each)
            continue
        level = search.level(each.name, value) - each.change(program.unknowns)
        limits.append(replace(each, level=level))
    return model._replace(limits=limits)


def _inside(search: Search, step: Array, trust: float) -> bool:
    """Whether a step ends inside a wide trust region, which then does not limit its gain."""
    return trust >= _TRUST and _size(search, step) < _INSIDE * trust


def _size(search: Search, step: Array) -> float:
    """Least trust region that does not limit a step."""
    curved = search.root_hessian @ step[: len(search.root_hessian)]
    return max(float(np.abs(step).max()), float(np.linalg.norm(curved)))


def _within(state: State) -> bool:
    return all(value <= 1.0 - RESERVE + FEASIBLE for value in state.utilisation.values())


def _convex(curvature: Array) -> Array:
    """Nearest positive semidefinite matrix."""
    values, vectors = np.linalg.eigh(0.5 * (curvature + curvature.T))
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)


def _program(
    search: Search, state: State, model: Model, trust: float, penalty: float, ripple_weight: float
) -> tuple[ConeSolution | None, State, Model]:
    """Step of a descent within a trust region: solution of the cone program (None: not solved),
    state after its step, and model with the rows that were added.

    Rows outside the model that the state after the step violates more than those in it are added,
    and the program is solved again.

    Parameters
    ----------
    search : Search         the sampled problem
    state : State           before the step
    model : Model           linear model there
    trust : float           size of the trust region, in scaled unknowns
    penalty : float         of a unit of violation
    ripple_weight : float   of ripple and costs in the objective
    """
    # The box alone does not bound short waves, which a speed ripple does not contain.
    reach = Reach(search.root_hessian, trust, search.still)
    box = search.box(state, trust)
    for left in reversed(range(_ADDITIONS)):
        program = solved(
            model.norms, model.limits,
            model.curvature, model.slope, box, penalty, ripple_weight, reach, model.idle,
        )  # fmt: skip
        if program is None:
            return None, state, model
        there = search.state(*search.after(state, program.step))
        rows = _missing(search, state, model, program, there)
        ripples = _missing_ripples(model, program, there)
        worse = there.merit(penalty, ripple_weight) > state.merit(penalty, ripple_weight)
        # A new reversal has loads that no model at this state foresees.
        new = search.new_reversals(state, there) if worse else np.zeros(0, dtype=np.intp)
        if not left or (not rows and not ripples.size and not new.size):
            break
        sides = search.kept_sides(state, new)
        model = model._replace(
            limits=[*model.limits, *search.rows(state, model.summit, rows), *sides],
            norms=[*model.norms, *search.norms(state, model.summit, ripples, model.idle)],
        )
    return program, there, model


def _missing(
    search: Search, state: State, model: Model, program: ConeSolution, there: State
) -> Mapping[str, NDArray[np.bool_]]:
    """Rows to be added to a linear model, by limit (s, n): where the state after the step exceeds a
    limit by more than at any row in the model; of each cam angle the worst scenario.

    Parameters
    ----------
    search : Search          the sampled problem
    state, there : State     before and after the step
    model : Model            with the rows so far
    program : ConeSolution   with the excess it allows, by limit
    """
    missing = {}
    for name, value in there.pointwise.items():
        level = search.level(name, value)[:, : state.grid.theta.size]  # reversals may begin
        allowed = program.slack.get(name, 0.0) + _VIOLATED
        if level.max() <= allowed:
            continue
        modelled = np.zeros(level.shape, dtype=bool)
        for each in model.limits:
            if each.name == name and not each.mean:
                here = each.point < level.shape[1]  # reversals may end
                modelled[each.scenario[here], each.point[here]] = True
        worst = max(allowed, float(level[modelled].max(initial=-np.inf)) + _VIOLATED)
        rows = ~modelled & (level > worst)
        if rows.any():
            missing[name] = rows & (level >= level.max(axis=0))
    return missing


def _missing_ripples(model: Model, program: ConeSolution, there: State) -> NDArray[np.intp]:
    """Indices, among the weighted scenarios, of those whose ripple is to be added to a linear
    model: that of the greatest ripple after the step, and that furthest above its ceiling, each
    only where it is above what the program foresees and the scenarios in the model have.

    Parameters
    ----------
    model : Model            with the ripples so far
    program : ConeSolution   with its ripple and the excess it allows over a ceiling
    there : State            after the step
    """
    modelled = [norm.number for norm in model.norms]
    allowed = (program.ripple, program.slack.get(TORQUE_REDUCTION.id, 0.0))
    missing = []
    for values, least in zip((there.ripples, there.excess), allowed, strict=True):
        greatest = max(least, float(values[modelled].max(initial=-np.inf))) + _VIOLATED
        if values.size and values.max() > greatest:
            missing.append(int(values.argmax()))
    return np.unique(missing).astype(np.intp)

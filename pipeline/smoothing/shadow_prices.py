"""Shadow prices: change of the torque ripple per unit of a bound or machine number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import replaced, value_of
from camwright.pipeline.checks.check import Kind
from camwright.pipeline.checks.demands import PRESSURE
from camwright.pipeline.checks.flat_face_sliding import face_pv
from camwright.pipeline.records.run_summary import MachinePriceRecord, PriceRecord
from camwright.pipeline.smoothing.bounds import Bound, bounds_of
from camwright.pipeline.smoothing.constraints import utilisations_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Ratings
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem
from camwright.pipeline.torque.torque import Torque

BINDING = 2e-3  # of a limit: a constraint this near to its reserve is active
FLOOR = 1e-4  # of the engine's ripple, by 1 % of a value: the optima are converged to 1e-6
_PRICE_STEP = 1e-4  # of a number of the machine, for its difference quotient
_BY_SQUARE = (PRESSURE, face_pv.id)
_WEIGHTED = 1e-3  # of the ripple: least other terms of an objective that is no ripple alone


@dataclass(frozen=True)
class MachineNumber:
    """Number of the machine whose price is computed.

    Parameters
    ----------
    key : str          in the case file
    words : str
    unit : str         "-": a pure number
    keys : tuple       numbers that increase with it; value: the first less those of `less`
    less : tuple       keys
    free : str         free variable of the synthesis that it is; "": none
    needs : str        kind of follower; "": any
    """

    key: str
    words: str
    unit: str
    keys: tuple[str, ...]
    less: tuple[str, ...] = ()
    free: str = ""
    needs: Kind = ""

    def value(self, case: Case) -> float:
        """Value in a case, SI."""
        return _number(case, self.keys[0]) - sum(_number(case, key) for key in self.less)

    def increased(self, case: Case, step: float) -> Case:
        """Case with the number greater by a step, SI."""
        return replaced(case, {key: _number(case, key) + step for key in self.keys})


def _number(case: Case, key: str) -> float:
    value: float = value_of(case, key)
    return value


def _own(key: str, words: str, unit: str, free: str = "") -> MachineNumber:
    """A number that the case states directly."""
    return MachineNumber(key, words, unit, (key,), free=free)


_PRIME, _ROLLER = "cam.prime_radius", "roller.radius"
_WIDTH, _DEPTH = "follower.face.width", "follower.face.depth"
NUMBERS = (
    _own("follower.mass", "follower mass", "g"),
    _own("spring.rate", "spring rate", "N/mm", "rate"),
    _own("spring.preload", "preload", "N", "preload"),
    MachineNumber(
        "cam.base_radius", "base radius", "mm", (_PRIME,), (_ROLLER,), "prime_radius", "roller"
    ),
    MachineNumber(_ROLLER, "roller radius", "mm", (_ROLLER, _PRIME), needs="roller"),
    MachineNumber(_PRIME, "base radius", "mm", (_PRIME,), free="prime_radius", needs="face"),
    MachineNumber(_WIDTH, "width of the face", "mm", (_WIDTH,), needs="face"),
    MachineNumber(_DEPTH, "depth of the face", "mm", (_DEPTH,), needs="face"),
    _own("guides.spacing", "spacing of the guides", "mm"),
    _own("follower.overhang_at_max_lift", "overhang at maximum lift", "mm"),
    _own("guides.a.friction", "friction of guide A", "-"),
    _own("guides.b.friction", "friction of guide B", "-"),
    _own("tolerances.phase", "phase tolerance between engine and cam", "deg"),
)
"""Numbers of the machine with a price."""
PHASE = "phase"


def machine_prices(
    design: Design, problem: Problem, case: Case, torques: Mapping[str, Torque]
) -> list[MachinePriceRecord]:
    """Shadow prices of machine numbers, greatest first; none for an unconverged design.

    The price is the decrease of the crank-torque ripple (std, N m) per unit more of the number, to
    first order and at a new optimum: the derivative of the Lagrangian at the optimum, by a
    difference quotient. With costs or a jerk weight it is that of their sum, the objective. A
    greater roller keeps the base radius. The finite-element corrections are constant, as are limits
    that follow from the solved cam; a number that is free in the synthesis has no price, nor is one
    below `FLOOR` listed.

    The phase of the cam on the shaft is last, with a price of zero, unless it is free: the lift of
    a new optimum shifts with the torque and an external force, and no limit depends on the angle on
    the shaft (the wall at bore and keyway is limited at every angle as at the keyway).

    Parameters
    ----------
    design : Design     of the problem
    problem : Problem   with its finite-element corrections
    case : Case         of the problem
    torques : mapping   engine torque by load case

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 9.1; the envelope theorem.
    """
    lagrangian = design.lagrangian
    if lagrangian is None or not (design.converged and design.feasible):
        return []
    before, of = _before(problem), objective(design, problem)
    freed = {name: getattr(design.variables, name) for name in problem.freed}
    stated = problem_of(case, torques).ratings

    def level(changed: Case) -> float:
        """Lagrangian and jerk term of a changed case at the optimum and its free variables."""
        other = problem_like(problem, changed, torques)
        ratings = _with_solved_limits(other.ratings, stated, problem.ratings)
        variables = replace(other.variables, **freed)
        other = replace(other, ratings=ratings, variables=variables)
        jerk = Search(other).state(design.coefficients, other.variables).jerk
        return lagrangian.at(other, other.variables) + jerk

    at_optimum = level(case)
    records: list[MachinePriceRecord] = []
    for number in NUMBERS:
        derived = {f"spring.{name}" for name in case.spring.derived}
        if number.needs not in {"", *problem.ratings.kinds} or number.key in derived:
            continue
        value = number.value(case)
        if number.free in problem.freed or value <= 0.0:
            continue
        changed, share = _changed(number, case)
        per_percent = before * (at_optimum - level(changed)) / (100.0 * share)
        if abs(per_percent) < FLOOR * before:
            continue
        shown = in_unit(value, number.unit)
        bound = Bound(number.words, shown, number.unit, 1.0)
        price = 100.0 * per_percent / shown
        records.append(
            {
                "parameter": number.key,
                "words": number.words,
                "value": shown,
                "unit": number.unit,
                "ripple_per_unit_Nm": price,
                "ripple_per_percent_Nm": per_percent,
                "of": of,
                "sentence": _sentence(bound, price, of),
            }
        )
    records.sort(key=lambda record: -abs(record["ripple_per_percent_Nm"]))
    return records if PHASE in problem.freed else [*records, _of_phase(design, of)]


def _of_phase(design: Design, of: str) -> MachinePriceRecord:
    words = "phase of the cam on the shaft"
    return {
        "parameter": PHASE,
        "words": words,
        "value": in_unit(float(design.variables.phase), "deg"),
        "unit": "deg",
        "ripple_per_unit_Nm": 0.0,
        "ripple_per_percent_Nm": 0.0,
        "of": of,
        "sentence": f"{words}: no price, as the lift shifts with the torque and no limit"
        " depends on the angle on the shaft",
    }


def _changed(number: MachineNumber, case: Case) -> tuple[Case, float]:
    """Case with a number of the machine increased by the share `_PRICE_STEP` of itself, and the
    share; the number is decreased, and the share negative, where the case does not allow the
    increase.
    """
    step = _PRICE_STEP * number.value(case)
    try:
        return number.increased(case, step), _PRICE_STEP
    except InputError:
        return number.increased(case, -step), -_PRICE_STEP


def _with_solved_limits(ratings: Ratings, stated: Ratings, solved: Ratings) -> Ratings:
    """Ratings with the limits that a solved cam has changed from those stated in its case."""
    limits = solved.bounds.items()
    changed = {key: value for key, value in limits if value != stated.bounds.get(key)}
    return replace(ratings, bounds={**ratings.bounds, **changed})


def problem_like(problem: Problem, case: Case, torques: Mapping[str, Torque]) -> Problem:
    """Problem of a changed case with the finite-element corrections of another problem."""
    other = problem_of(case, torques)
    scenarios = tuple(
        replace(each, correction=scenario.correction)
        for each, scenario in zip(other.scenarios, problem.scenarios, strict=True)
    )
    return replace(
        other, scenarios=scenarios, coefficients=problem.coefficients, points=problem.points
    )


def objective(design: Design, problem: Problem) -> str:
    """Objective to whose decrease the prices refer, in words."""
    state = Search(problem).state(design.coefficients, design.variables)
    return "objective" if state.cost + state.jerk > _WEIGHTED * state.ripple else "ripple"


def prices(design: Design, problem: Problem) -> list[PriceRecord]:
    """Shadow prices of the active limits, greatest first; none for an unconverged design.

    The price is the decrease of the crank-torque ripple (std, N m) per unit of the limit, to first
    order: multiplier times engine ripple, N m, in which the objective is measured, times the slope
    of the utilisation by the limit. With costs or a jerk weight it is that of their sum, the
    objective.

    Of the utilisation of the contact pressure, r kappa + N/F_lim, only the second part depends on
    the limit, by its square; its mean over the active angles is taken, as of the PV value of a
    face. A limit on a mean over the turn has no active angles.

    Parameters
    ----------
    design : Design     with its multipliers
    problem : Problem   of the design

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 9.1: multipliers as sensitivities.
    """
    if not (design.converged and design.feasible):
        return []
    bounds = bounds_of(problem.ratings)
    before, of = _before(problem), objective(design, problem)
    records: list[PriceRecord] = []
    for name, multiplier in design.multipliers.items():
        if multiplier < 100.0 * FLOOR:
            continue
        bound = bounds.get(name, Bound(name.replace("_", " "), 1.0, "-", 1.0))
        slope = bound.slope
        if name in _BY_SQUARE:
            slope *= 2.0 * _load_share(design, problem, name)
        price = multiplier * before * slope
        records.append(
            {
                "limit": name,
                "words": bound.words,
                "value": bound.value,
                "unit": bound.unit,
                "ripple_per_unit_Nm": price,
                "ripple_per_percent_Nm": multiplier * before / 100.0,
                "binds_at_deg": _ranges_record(*design.strip[name]) if name in design.strip else [],
                "of": of,
                "sentence": _sentence(bound, price, of),
            }
        )
    return sorted(records, key=lambda record: -record["ripple_per_percent_Nm"])


def limits_in_use(design: Design) -> tuple[Array, dict[str, Array]]:
    """Ascending cam angles (n,), rad, and the utilisation (n,) of each limit at them by check, the
    check of greatest utilisation first.

    A limit on a mean over the turn has the same utilisation at every angle.
    """
    theta = next(iter(design.strip.values()))[0]
    angles = np.mod(theta + float(design.variables.phase), FULL_TURN)
    order = np.argsort(angles, kind="stable")
    names = sorted(design.strip, key=lambda name: -float(np.max(design.strip[name][1])))
    uses = {name: np.asarray(design.strip[name][1])[order] for name in names}
    return angles[order], uses


def _before(problem: Problem) -> float:
    """Ripple of the engine, N m."""
    return max(float(np.std(item.torque)) for item in problem.scenarios if item.weight > 0)


def _load_share(design: Design, problem: Problem, name: str) -> float:
    """Share of the load, N / F_lim, in the utilisation of the contact pressure, the rest being that
    of the curvature on the track that carries in the worst scenario: mean over the cam angles at
    which the limit binds; 1 where it never binds.

    Parameters
    ----------
    name : str   of the limit in `Design.strip`
    """
    theta, use = design.strip[name]
    binds = _binding(use)
    if not binds.any():
        return 1.0
    grid = problem.grid(theta[binds])
    cam = Search(problem).loads_at(design.coefficients, design.variables, grid)
    uses = np.atleast_2d(np.asarray(utilisations_of(cam, {name})[name]))
    sharpness = np.broadcast_to(cam.motion.sharpness, uses.shape)
    worst = uses.argmax(axis=0), np.arange(binds.sum())
    return float(np.mean(np.asarray(use)[binds] - sharpness[worst]))


def _sentence(known: Bound, price: float, of: str) -> str:
    """Sentence on how much a change of a bound by one unit in its relaxing direction takes off the
    objective.

    Parameters
    ----------
    known : Bound   in its drawing unit
    price : float   decrease of the objective, N m, per unit of the bound; negative: a lower bound
                    decreases it
    of : str        words for the objective
    """
    shown = "" if known.unit == "-" else f" {known.unit}"
    if price < 0.0:
        one = f"one{shown} less" if shown else "one less"
    else:
        one = f"one more{shown}" if shown else "one unit more"
    off = f"takes {abs(price):.3g} N m off the {of}"
    return f"{known.words} of {known.value:.4g}{shown}: {one} {off}"


def _binding(use: Array) -> NDArray[np.bool_]:
    return np.asarray(np.asarray(use) >= 1.0 - RESERVE - BINDING)


def _ranges_record(theta: Array, use: Array) -> list[tuple[float, float]]:
    """First and last cam angle, deg, of each range in which a limit binds; none for a limit on a
    mean over the turn.

    Parameters
    ----------
    theta : array (n,)   ascending cam angles, rad
    use : array (n,)     utilisation at them
    """
    tight = _binding(use)
    if not tight.any() or np.ptp(use) == 0.0:
        return []
    degrees = np.degrees(theta)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], tight.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(round(float(degrees[a]), 3), round(float(degrees[b]), 3)) for a, b in pairs]

"""When no cam keeps all limits: which of them conflict, and what would make room."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pipeline.checks.function import TORQUE_REDUCTION
from pipeline.smoothing.constrained import synthesise
from pipeline.smoothing.design import Design, Problem, coarsened

_FACTOR_MAX = 4.0
_BISECTIONS = 5
_IN_HAND = 1.02  # a relaxation is given with this much beyond the least one found


@dataclass(frozen=True)
class Relaxation:
    """One change that makes room: from and to in `unit`; cost is the factor of the change."""

    what: str
    given: float
    asked: float
    unit: str
    factor: float

    @property
    def sentence(self) -> str:
        unit = f" {self.unit}" if self.unit != "-" else ""
        return f"{self.what}: {self.asked:.4g}{unit} instead of {self.given:.4g}{unit}"


@dataclass(frozen=True)
class Infeasibility:
    """Limits of which every smaller set can be kept, and single changes that free them."""

    conflict: tuple[str, ...]
    relaxations: tuple[Relaxation, ...]

    def as_record(self) -> dict[str, Any]:
        return {
            "conflict": list(self.conflict),
            "relaxations": [
                {"what": r.what, "from": r.given, "to": r.asked, "unit": r.unit,
                 "factor": r.factor, "sentence": r.sentence}
                for r in self.relaxations
            ],
        }  # fmt: skip

    @property
    def sentence(self) -> str:
        """One line for the statement of a run."""
        names = ", ".join(self.conflict) or "the limits taken together"
        ways = "; or ".join(item.sentence for item in self.relaxations[:3])
        return f"no cam keeps together: {names}" + (f"; what would do: {ways}" if ways else "")


Change = Callable[[Problem, float], Problem]


def infeasibility(problem: Problem) -> Infeasibility:
    """Smallest set of conflicting limits, and relaxations that are found feasible.

    The set is what a deletion filter leaves: each limit in turn is dropped and stays out where
    the others still conflict. Each relaxation is the least factor, by bisection, at which a cam
    is found; the cheapest comes first.

    Parameters
    ----------
    problem : Problem   of which no feasible design was found

    References
    ----------
    Chinneck and Dravnieks, ORSA J. Computing 3 (1991) 157: the deletion filter.
    """
    coarse = coarsened(problem)
    asked = synthesise(coarse, ripple_weight=0.0)
    candidates = sorted(asked.utilisation, key=lambda name: asked.utilisation[name])
    out = coarse.left_out
    conflict = []
    for name in candidates:
        if _possible(replace(coarse, left_out=out | {name})):
            conflict.append(name)
        else:
            out = out | {name}
    # The candidates came from the least used: the most used is named first.
    found = [_least(coarse, *row) for row in _changes(coarse, conflict)]
    kept = [item for item in found if item is not None]
    if TORQUE_REDUCTION in conflict:
        kept += _less_reduction(coarse)
    return Infeasibility(
        tuple(reversed(conflict)), tuple(sorted(kept, key=lambda item: item.factor))
    )


def _possible(problem: Problem) -> bool:
    return synthesise(problem, ripple_weight=0.0).feasible


def _changes(problem: Problem, conflict: list[str]) -> list[tuple[str, float, str, int, Change]]:
    """What may be changed: words, value as shown, unit, direction, change."""
    ratings, machine = problem.ratings, problem.machine

    def rated(name: str) -> Change:
        return lambda given, factor: replace(
            given,
            ratings=replace(given.ratings, **{name: getattr(given.ratings, name) * factor}),
        )

    def built(name: str) -> Change:
        return lambda given, factor: replace(
            given, machine=replace(given.machine, **{name: getattr(given.machine, name) * factor})
        )

    rows: list[tuple[str, float, str, int, Change]] = []
    for limit, name, words, scale, unit in (
        ("roller_static", "normal_force", "a roller rated for a normal force of", 1.0, "N"),
        ("pressure_angle", "pressure_angle", "a pressure angle up to", 180.0 / np.pi, "deg"),
        ("spring_travel", "travel", "a spring travel of", 1e3, "mm"),
        ("contact_pressure", "pressure", "a contact pressure up to", 1e-6, "MPa"),
    ):
        value = getattr(ratings, name)
        if limit in conflict and value is not None:
            rows.append((words, value * scale, unit, 1, rated(name)))
    rows.append(("a spring rate of", 1e-3 * machine.rate, "N/mm", -1, built("rate")))
    rows.append(("a preload of", machine.preload, "N", -1, built("preload")))
    base = 1e3 * machine.base_radius
    rows.append(("a pitch base radius of", base, "mm", 1, built("base_radius")))
    return rows


def _least(
    problem: Problem,
    words: str,
    given: float,
    unit: str,
    direction: int,
    change: Change,
) -> Relaxation | None:
    """The least factor that leaves room for a cam, a little in hand; None up to four."""
    low, high = 1.0, _FACTOR_MAX
    if not _possible(change(problem, high**direction)):
        return None
    for _ in range(_BISECTIONS):
        middle = float(np.sqrt(low * high))
        if _possible(change(problem, middle**direction)):
            high = middle
        else:
            low = middle
    factor = high * _IN_HAND
    return Relaxation(words, given, given * factor**direction, unit, factor)


def _less_reduction(problem: Problem) -> list[Relaxation]:
    """The reduction that the other limits leave room for."""
    floor = problem.torque_reduction
    best: Design = synthesise(replace(problem, left_out=problem.left_out | {TORQUE_REDUCTION}))
    if floor is None or not best.feasible:
        return []
    asked = 1.0 - best.ripple * _IN_HAND
    return [Relaxation("a torque reduction of", floor, asked, "-", (1.0 - asked) / (1.0 - floor))]

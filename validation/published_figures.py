"""Published values, computed values and the verdict on each."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

Verdict = Literal["reproduced", "not reproduced", "not decidable"]
Basis = Literal["independent", "tuned", "fitted", "imposed", "arithmetic"]
"""Origin of a computed value.

`tuned`: by parameters of a model or a choice adjusted to such values; `fitted`: by unknowns solved
for from values of the paper; `imposed`: an input; `arithmetic`: from other printed values. The
independent ones alone test the physics.
"""
NOT_COMPUTED = "not computed by this version"


@dataclass(frozen=True)
class Tolerance:
    """Tolerance of a published value.

    Parameters
    ----------
    of : str      `value`: a share of the published value; `unit`: in its unit; `swing`: a share of
                  a swing, and an angle; `ratio`: of the greatest to the least; `words`: equality;
                  `none`: not judged
    size : float
    swing : float              in the unit of the value
    angle_deg, angle_size_deg : float or None   published angle and its tolerance
    """

    of: Literal["value", "unit", "swing", "ratio", "words", "none"]
    size: float = 0.0
    swing: float = 0.0
    angle_deg: float | None = None
    angle_size_deg: float = 0.0

    def words(self, unit: str) -> str:
        """The tolerance as text, `unit` that of the value."""
        angle = "" if self.angle_deg is None else f" and {self.angle_size_deg:g} deg"
        return {
            "value": f"{100 * self.size:g} % of the value",
            "unit": f"{self.size:g} {_points(unit)}",
            "swing": f"{100 * self.size:g} % of the swing of {self.swing:g} {unit}{angle}",
            "ratio": f"ratio of {self.size:g}",
            "words": "equal",
            "none": "none",
        }[self.of]


@dataclass(frozen=True)
class Target:
    """A published value: number, numbers, or a statement in words; basis and tolerance of its test.

    Parameters
    ----------
    group : str     values of one figure of the page
    basis_reason, tolerance_reason : str   one line each
    """

    id: str
    paper: str
    group: str
    quantity: str
    value: Any
    unit: str
    condition: str
    kind: str  # simulated or measured in the paper
    basis: Basis
    basis_reason: str
    tolerance: Tolerance
    tolerance_reason: str


@dataclass(frozen=True)
class FigureOutcome:
    """Computed value of a target, verdict and reason."""

    obtained: Any
    verdict: Verdict
    reason: str


@dataclass(frozen=True)
class PaperResult:
    """Outcomes of one paper by target id, further studies, and records of a figure a group."""

    outcomes: Mapping[str, FigureOutcome]
    studies: Mapping[str, Any] = field(default_factory=dict)
    figures: Sequence[Mapping[str, Any]] = ()


def judged(
    target: Target,
    obtained: Any,
    reason: str,
    *,
    published: Any = None,
    angle_deg: float | None = None,
) -> FigureOutcome:
    """Outcome by the tolerance of a target; NaN is not reproduced.

    Parameters
    ----------
    obtained : number, numbers or words
    reason : str         how it is obtained
    published : Any      in place of the value as printed, such as the number that words state
    angle_deg : float    crank angle of the obtained value, of a tolerance with an angle
    """
    value, tolerance = target.value if published is None else published, target.tolerance
    if tolerance.of == "words":
        near, words = obtained == value, "" if obtained == value else "another"
    elif tolerance.of == "ratio":
        ratio = max(obtained) / min(obtained)
        near, words = ratio <= tolerance.size, f"ratio of {ratio:.3g}"
    else:
        scale = {"value": np.abs(value), "unit": 1.0, "swing": tolerance.swing}[tolerance.of]
        off = float(np.max(np.abs(np.asarray(obtained) - np.asarray(value)) / scale))
        near = off <= tolerance.size
        words = {
            "value": f"{_percent(off)} off",
            "unit": f"{off:.2g} {_points(target.unit)} off",
            "swing": f"{_percent(off)} of the swing off",
        }[tolerance.of]
        if tolerance.angle_deg is not None:
            turn = abs(angle_deg - tolerance.angle_deg) if angle_deg is not None else np.nan
            near = near and bool(turn <= tolerance.angle_size_deg)
            words = f"{words[:-4]} and {turn:.0f} deg off"
    verdict: Verdict = "reproduced" if near else "not reproduced"
    return FigureOutcome(obtained, verdict, ": ".join(filter(None, (words, reason))))


def _points(unit: str) -> str:
    """Unit of a difference."""
    return "percentage points" if unit == "%" else unit


def _percent(share: float) -> str:
    return "less than 0.01 %" if share < 1e-4 else f"{100 * share:.3g} %"


@cache
def _document() -> Mapping[str, Any]:
    text = Path(__file__).with_name("targets.json").read_text(encoding="utf-8")
    document: Mapping[str, Any] = json.loads(text)
    return document


def targets(paper: str | None = None) -> dict[str, Target]:
    """Published values by id, of one paper or of all."""
    rows = (
        Target(**{**row, "tolerance": Tolerance(**row["tolerance"])})
        for row in _document()["targets"]
    )
    return {row.id: row for row in rows if paper in (None, row.paper)}


def citations() -> dict[str, Mapping[str, Any]]:
    """Citation and DOI of each paper."""
    return dict(_document()["papers"])


def row_record(target: Target, outcome: FigureOutcome | None) -> dict[str, Any]:
    """One row of ``values.json``."""
    judgement = outcome or FigureOutcome(None, "not decidable", NOT_COMPUTED)
    return {
        "id": target.id,
        "paper": target.paper,
        "group": target.group,
        "quantity": target.quantity,
        "condition": target.condition,
        "kind": target.kind,
        "unit": target.unit,
        "published": target.value,
        "obtained": judgement.obtained,
        "difference": _difference(target.value, judgement.obtained),
        "basis": target.basis,
        "basis_reason": target.basis_reason,
        "tolerance": target.tolerance.words(target.unit),
        "tolerance_reason": target.tolerance_reason,
        "verdict": judgement.verdict,
        "reason": judgement.reason,
    }


def counts(rows: Iterable[Mapping[str, Any]]) -> dict[str, dict[str, int]]:
    """Number of rows of ``values.json`` by basis and verdict."""
    number = Counter((row["basis"], row["verdict"]) for row in rows)
    return {
        basis: {verdict: number[basis, verdict] for verdict in get_args(Verdict)}
        for basis in get_args(Basis)
    }


def count_lines(counted: Mapping[str, Mapping[str, int]]) -> Sequence[str]:
    """Counts as one line a basis."""
    return [
        f"{basis}: " + ", ".join(f"{verdict} {number}" for verdict, number in verdicts.items())
        for basis, verdicts in counted.items()
    ]


def _difference(published: Any, obtained: Any) -> Any:
    """Computed less published value where both are numbers, by entry; else null."""
    if isinstance(published, list) and isinstance(obtained, list):
        return [_difference(p, o) for p, o in zip(published, obtained, strict=True)]
    numbers = (int, float)
    both = isinstance(published, numbers) and isinstance(obtained, numbers)
    return float(obtained) - float(published) if both else None

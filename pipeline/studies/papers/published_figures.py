"""Published values, computed values and the verdict on each."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any, Literal

Verdict = Literal["reproduced", "not reproduced", "not decidable"]
NOT_COMPUTED = "not computed by this version"


@dataclass(frozen=True)
class Target:
    """A published value: number, numbers, or a statement in words."""

    id: str
    paper: str
    quantity: str
    value: Any
    unit: str
    condition: str
    kind: str  # simulated or measured in the paper


@dataclass(frozen=True)
class Outcome:
    """Computed value of a target, verdict and reason."""

    obtained: Any
    verdict: Verdict
    reason: str


@dataclass(frozen=True)
class PaperResult:
    """Outcomes of one paper by target id, and further studies."""

    outcomes: Mapping[str, Outcome]
    studies: Mapping[str, Any] = field(default_factory=dict)


def within(obtained: float, published: float, tolerance: float, reason: str) -> Outcome:
    """Outcome by a tolerance relative to the published value."""
    near = abs(obtained - published) <= tolerance * abs(published)
    how = f"within {100 * tolerance:g} %" if near else f"more than {100 * tolerance:g} % away"
    verdict: Verdict = "reproduced" if near else "not reproduced"
    return Outcome(obtained, verdict, f"{how}: {reason}")


@cache
def _document() -> Mapping[str, Any]:
    text = files(__package__).joinpath("targets.json").read_text(encoding="utf-8")
    document: Mapping[str, Any] = json.loads(text)
    return document


def targets(paper: str | None = None) -> dict[str, Target]:
    """Published values by id, of one paper or of all."""
    rows = (Target(**row) for row in _document()["targets"])
    return {row.id: row for row in rows if paper in (None, row.paper)}


def citations() -> dict[str, Mapping[str, Any]]:
    """Citation and DOI of each paper."""
    return dict(_document()["papers"])


def row_record(target: Target, outcome: Outcome | None) -> dict[str, Any]:
    """One row of ``validation.json``."""
    judged = outcome or Outcome(None, "not decidable", NOT_COMPUTED)
    return {
        "id": target.id,
        "paper": target.paper,
        "quantity": target.quantity,
        "condition": target.condition,
        "kind": target.kind,
        "unit": target.unit,
        "published": target.value,
        "obtained": judged.obtained,
        "difference": _difference(target.value, judged.obtained),
        "verdict": judged.verdict,
        "reason": judged.reason,
    }


def _difference(published: Any, obtained: Any) -> Any:
    """Computed less published value where both are numbers, by entry; else null."""
    if isinstance(published, list) and isinstance(obtained, list):
        return [_difference(p, o) for p, o in zip(published, obtained, strict=True)]
    numbers = (int, float)
    both = isinstance(published, numbers) and isinstance(obtained, numbers)
    return float(obtained) - float(published) if both else None

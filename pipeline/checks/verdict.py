"""From many checks to one word."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from camwright.pipeline.checks.check import Check

Verdict = Literal["pass", "fail"]


def verdict(checks: Iterable[Check]) -> Verdict:
    """`pass` when there are checks and every must-have passes or is waived."""
    checks = tuple(checks)
    return "pass" if checks and not any(check.blocks for check in checks) else "fail"


def binding(checks: Iterable[Check]) -> tuple[str, ...]:
    """Ids of the must-have checks that fail the verdict, worst first.

    A missing number comes before every utilisation: nobody knows how bad it is.
    """
    return tuple(check.id for check in in_order(checks) if check.blocks)


def in_order(checks: Iterable[Check]) -> tuple[Check, ...]:
    """Not evaluated first (must-haves before the rest), then by falling utilisation."""
    return tuple(sorted(checks, key=_place))


def _place(check: Check) -> tuple[int, float, str]:
    if check.utilisation is None:
        return 0, 0.0 if check.must_have else 1.0, check.id
    return 1, -check.utilisation, check.id

"""Side effects of a change: checks that fail after it, figures that it changes, checks cured."""

from __future__ import annotations

from camwright.pipeline.search.judge import Headline, Judgement
from camwright.pipeline.search.remedies.lever_steps import without_exponent

_SLIGHT = 0.01  # relative change of a figure up to which the remedy leaves it out


def effects(name: str, before: Judgement, after: Judgement) -> tuple[str, ...]:
    """Side effects of a change, the gravest first: checks that fail now, figures, checks cured.

    Parameters
    ----------
    name : str   check that the change cures
    """
    failing = newly_failing(before, after)
    cured = [
        each
        for each in _failing(before)
        if each != name and each in after.checks and after.checks[each].status == "pass"
    ]
    words = [f"fails {', '.join(failing)}"] if failing else []
    words += _figures(before.headline, after.headline)
    if cured:
        words.append(f"also cures {cured[0] if len(cured) == 1 else f'{len(cured)} others'}")
    return tuple(words)


def newly_failing(before: Judgement, after: Judgement) -> list[str]:
    """Ids of the must-have checks that fail only after a change."""
    known = _failing(before)
    return [each for each in _failing(after) if each not in known]


def _failing(judgement: Judgement) -> list[str]:
    return [one.id for one in judgement.checks.values() if one.must_have and one.status == "fail"]


def _figures(before: Headline, after: Headline) -> list[str]:
    """Figures of the headline that change."""
    words = []
    for label, unit, old, new in (
        ("ripple", "N m", before.ripple, after.ripple),
        ("p0", "MPa", before.pressure, after.pressure),
        ("cam radius", "mm", before.radius, after.radius),
    ):
        if old is not None and new is not None and abs(new - old) > _SLIGHT * abs(old):
            digits = 4 if unit == "MPa" else 3
            number = without_exponent(old, unit, digits).removesuffix(f" {unit}")
            words.append(f"{label} {number} -> {without_exponent(new, unit, digits)}")
    heavier = after.mass - before.mass
    if abs(heavier) > _SLIGHT * before.mass:
        words.append(
            f"{'adds' if heavier > 0 else 'saves'} {without_exponent(abs(heavier), 'g', 3)}"
        )
    return words

"""Side effects of a change: checks that fail after it, figures that it changes, checks cured."""

from __future__ import annotations

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.cycle.cam_balance import design_mass
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.search.judge import Judgement
from camwright.pipeline.search.remedies.lever_steps import without_exponent

_SLIGHT = 0.01  # relative change of a figure up to which the remedy leaves it out


def effects(name: str, before: Judgement, after: Judgement) -> tuple[str, ...]:
    """Side effects of a change in words, the gravest first: checks that fail now, figures that it
    changes, other checks that it cures.

    Parameters
    ----------
    name : str                  id of the check that the change cures
    before, after : Judgement   of the case without and with the change
    """
    failing = newly_failing(before, after)
    cured = [
        each
        for each in _failing(before)
        if each != name and each in after.checks and after.checks[each].status == "pass"
    ]
    words = [f"fails {', '.join(failing)}"] if failing else []
    words += _changed(before, after)
    if cured:
        words.append(f"also cures {cured[0] if len(cured) == 1 else f'{len(cured)} others'}")
    return tuple(words)


def newly_failing(before: Judgement, after: Judgement) -> list[str]:
    """Ids of the must-have checks that fail only after a change."""
    known = _failing(before)
    return [each for each in _failing(after) if each not in known]


def _failing(judgement: Judgement) -> list[str]:
    return [one.id for one in judgement.checks.values() if one.must_have and one.status == "fail"]


def _changed(before: Judgement, after: Judgement) -> list[str]:
    """Words on each figure of the design, and its mass, that differ between two judgements by more
    than a share `_SLIGHT`: old -> new.
    """
    words = []
    for (label, unit, old), (*_, new) in zip(_figures(before), _figures(after), strict=True):
        if old is not None and new is not None and abs(new - old) > _SLIGHT * abs(old):
            digits = 4 if unit == "MPa" else 3
            numbers = (without_exponent(each, "", digits) for each in (old, new))
            words.append(f"{label} {' -> '.join(numbers)} {unit}")
    mass, other = (design_mass(each.solved.case, each.solved.contour) for each in (before, after))
    heavier = other - mass
    if abs(heavier) > _SLIGHT * mass:
        words.append(
            f"{'adds' if heavier > 0 else 'saves'} {without_exponent(abs(heavier), 'g', 3)}"
        )
    return words


def _figures(judgement: Judgement) -> tuple[tuple[str, str, float | None], ...]:
    """Figures with label and unit."""
    figures = headline(judgement.solved)
    return (
        ("ripple", "N m", figures["torque_std_after_Nm"]),
        ("p0", "MPa", figures["p0_max_MPa"]),
        ("cam radius", "mm", in_unit(judgement.solved.greatest_radius, "mm")),
    )

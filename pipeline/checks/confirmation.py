"""Values on which each check rests, and which of them no source confirms.

A value is confirmed by its source, or by an entry ``[[confirmed]]`` of the case; a tolerance
tighter than its default, and a value beyond its usual range, by such an entry alone.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from functools import cache

from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import text_of
from camwright.pipeline.case.consistency import tightened_tolerances
from camwright.pipeline.case.limits import LIMITS, is_weaker
from camwright.pipeline.case.plausibility import beyond_ranges
from camwright.pipeline.case.section import suggestion
from camwright.pipeline.case.value_sources import OF_A_CHECK, source_of, values_at
from camwright.pipeline.checks.check import Check

_LIMIT = "limits."


def with_values_to_confirm(
    checks: Iterable[Check], case: Case, known: Collection[str]
) -> tuple[Check, ...]:
    """Checks with the unconfirmed values on which they rest.

    Limits of a check that are weaker than their defaults are named with it, evaluated or not.
    The source that a check declares for its limit counts as a value, ``checks.ID``, where it is
    not confirmed. A check judged at the tolerance corners rests on every tolerance that is tighter
    than its default, whatever its source. A check without data rests on none, and none rests on
    the stand-ins for a part that the follower does not have, such as the guides of an arm.

    Parameters
    ----------
    known : collection   ids of all checks of the design

    Raises
    ------
    InputError
        If the case confirms the source of an unknown check.
    """
    weaker = _weaker_limits(case)
    tables, tight = case.tables(), tuple(tightened_tolerances(case))
    unusual = {*tight, *(each.title for each in beyond_ranges(case))}
    confirmed = {each.value for each in case.confirmed}
    for value in confirmed:
        if value.startswith(OF_A_CHECK) and value.removeprefix(OF_A_CHECK) not in known:
            names = [f"{OF_A_CHECK}{name}" for name in known]
            limit = f"the source of a known check{suggestion(value, names)}"
            raise InputError("confirmed.value", value, limit)

    @cache
    def open_at(path: str) -> tuple[str, ...]:
        return tuple(
            value
            for value in values_at(tables, path)
            if value in unusual
            or not (case.scope.lacks(value) or source_of(tables, value).confirmed)
        )

    return tuple(
        replace(
            one,
            unconfirmed=tuple(
                value
                for value in dict.fromkeys(_open_values(one, open_at, tight))
                if value not in confirmed
            ),
            relaxed=tuple(weaker[key] for key in _limits_of(one) if key in weaker),
        )
        for one in checks
    )


def _limits_of(one: Check) -> Iterator[str]:
    """Keys of the limits by which a check judges."""
    limit = one.declaration.limit
    names = () if limit is None else (_LIMIT + limit.id,)
    yield from dict.fromkeys((*names, *(v for v in one.declaration.values if v.startswith(_LIMIT))))


def _weaker_limits(case: Case) -> dict[str, str]:
    """Limits of a case that are weaker than their defaults: value and default in words, by dotted
    key.
    """
    words = {}
    for name, limit in LIMITS.items():
        if not is_weaker(limit, case.limits[limit]):
            continue
        key, default = _LIMIT + name, limit.default
        usual = "" if default is None else f", default {shown(default, limit.quantity.unit)}"
        words[key] = f"{key} = {text_of(case, key)}{usual}"
    return words


def _open_values(
    one: Check, open_at: Callable[[str], tuple[str, ...]], tight: tuple[str, ...]
) -> Iterator[str]:
    """Values on which a check rests and whose source does not confirm them.

    Parameters
    ----------
    open_at : function   such values of the case at a path
    tight : tuple        tolerances that are tighter than their defaults
    """
    if not one.evaluated or one.evidence:
        return
    declared, limit = one.declaration.source, one.declaration.limit
    if limit is None and declared and not declared.confirmed:
        yield f"{OF_A_CHECK}{one.id}"
    limit_name = () if limit is None else (f"limits.{limit.id}",)
    for path in (*limit_name, *one.declaration.values):
        yield from open_at(path)
    if one.declaration.moved_by_tolerance:
        yield from tight

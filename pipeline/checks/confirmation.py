"""Values on which each check rests, and those of them that no source confirms.

A value is confirmed by its source, or by an entry ``[[confirmed]]`` of the case; a tolerance
tighter than its default by such an entry alone.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from functools import cache

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.consistency import tightened_tolerances
from camwright.pipeline.case.section import suggestion
from camwright.pipeline.case.value_sources import OF_A_CHECK, confirms, source_of, values_at
from camwright.pipeline.checks.check import Check


def with_values_to_confirm(
    checks: Iterable[Check], case: Case, known: Collection[str]
) -> tuple[Check, ...]:
    """The checks with the values on which they rest and which nothing confirms.

    The source that a check declares for its limit counts as a value, ``checks.ID``, where it is
    recalled. A check judged at the tolerance corners rests on every tolerance that is tighter than
    its default, whatever its source. A check without data rests on none.

    Parameters
    ----------
    known : collection   ids of all checks of the design

    Raises
    ------
    InputError
        If the case confirms the source of an unknown check.
    """
    tables, tight = case.tables(), tuple(tightened_tolerances(case))
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
            if value in tight or not confirms(source_of(tables, value))
        )

    return tuple(
        replace(
            one,
            unconfirmed=tuple(
                value
                for value in dict.fromkeys(_open_values(one, open_at, tight))
                if value not in confirmed
            ),
        )
        for one in checks
    )


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
    if limit is None and declared and not confirms(declared):
        yield f"{OF_A_CHECK}{one.id}"
    own = () if limit is None else (f"limits.{limit.id}",)
    for path in (*own, *one.declaration.values):
        yield from open_at(path)
    if one.declaration.moved_by_tolerance:
        yield from tight

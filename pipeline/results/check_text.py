"""Declaration of a check in words: formula, limit, method, sources, keys."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from functools import cache
from typing import NamedTuple, get_args

from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.cards.card_filling import KINDS, known_cards
from camwright.pipeline.case.cards.provenance import numbers_of, source_in_card
from camwright.pipeline.case.cards.shaft_seats import seat_source
from camwright.pipeline.case.cards.spring_catalogue import wire_sources
from camwright.pipeline.case.keys import DIGITS, NAME, Key
from camwright.pipeline.case.limits import LIMITS, AnyLimit
from camwright.pipeline.case.plausibility import usual_sources
from camwright.pipeline.checks.check import Declaration, Page
from camwright.pipeline.checks.registry import CHECKS, DECLARED
from camwright.pipeline.results.check_report import sentence


class CheckText(NamedTuple):
    """Sentences on a check, and the dotted keys on which it rests.

    A key such as ``cam.material.E`` is that of the material which the part names. load_end: what
    a follower that leaves the cam or locks does to the check; "": nothing.
    """

    title: str
    formula: str
    calculation: str
    limit: str
    load_cases: str
    decision: str
    load_end: str
    depth: str
    rests_on: tuple[str, ...]


_LOAD_END = {
    "": "",
    "contact": "If the follower leaves the cam in a load case, the others alone are judged and can"
    " only make it fail.",
    "loads": "If the follower leaves the cam or locks in a load case, the others alone are judged"
    " and can only make it fail.",
}
"""Words by what a check rests on, see `Declaration.rests_on`."""

_NEEDS = {"arm": "an arm", "round": "a roller or curved face", "swung_face": "a face on an arm"}
"""Words of what a check needs."""

_CLOSED = {
    "": "",
    "form": "; with a second track only",
    "force": "; not with a second track",
    "plate": "; not in a groove",
    "groove": "; in a groove only",
    "rollers": "; of two rollers in a groove only",
    "conjugate": "; of a conjugate pair only",
    "preload": "; of preloaded discs only",
    "yoke": "; in a yoke only",
}
"""Words by what keeps the follower on the cam, see `Declaration.closed_by`."""


def check_text(one: Declaration) -> CheckText:
    """Sentences that describe a check, from its declaration: formula, calculation, limit, load
    cases, decision, depth, sources.
    """
    needs = f"; {_NEEDS.get(one.needs, f'a {one.needs}')} only" if one.needs else ""
    part = f"; part `{one.part}`" if one.part else ""
    depth = f"Evaluated at the depth {one.tier.word} and deeper."
    if one.fails_from < one.tier:
        word = one.fails_from.word
        depth += f" At the depth {word} its utilisation is a lower bound: it can only fail."
    decides = "Decides the verdict" if one.must_have else "Does not decide the verdict"
    if one.evidence:
        decides += "; evidence, which never governs"
    return CheckText(
        title=one.title.format(follower="follower"),
        formula=f"{sentence(one.formula)} Unit: {one.unit}{needs}{_CLOSED[one.closed_by]}{part}.",
        calculation=f"{one.method.rstrip('.')}.",
        limit=f"{_limit(one)}.",
        load_cases=f"{one.load_cases}.",
        decision=f"{decides}. {sentence(one.reason)}",
        load_end=_LOAD_END[one.rests_on],
        depth=depth,
        rests_on=tuple(dict.fromkeys(one.values)),
    )


PAGES: tuple[Page, ...] = get_args(Page)
"""Parts of the mechanism that a check may judge, in the order of the flow of force; "": none."""


def page_of(name: str) -> Page:
    """Part of the mechanism that a check judges, by its id; "" for evidence or unknown ids."""
    one = DECLARED.get(name)
    return "" if one is None else one.page


def default_of(row: AnyLimit) -> str:
    """Default of a limit with its unit; "" without one."""
    return "" if row.default is None else shown(row.default, row.quantity.unit, DIGITS)


def _limit(one: Declaration) -> str:
    """Where the limit of a check comes from, in words: key of the case with its default, and
    source.
    """
    if one.limit is None:
        return str(one.source)
    value = default_of(one.limit)
    stated = f", default {value}" if value else ", without a default"
    return f"`limits.{one.limit.id}`{stated}; {one.limit.source}"


def checks_with(key: Key) -> tuple[str, ...]:
    """Ids of the checks that use a key as limit, in their formula or otherwise."""
    return tuple(
        one.id
        for one in DECLARED.values()
        if (one.limit is not None and key.path == f"limits.{one.limit.id}")
        or any(fnmatchcase(key.path, _of_card(rest)) for rest in one.values)
        or _named(key.path, one.formula)
    )


@cache
def _of_card(rest: str) -> str:
    """A key on which a check rests as that of the material card, where it is one."""
    before, name, last = rest.rpartition("material.")
    return f"materials.{NAME}.{last}" if name and before else rest


def _named(path: str, formula: str) -> bool:
    name = re.sub(r"^guides\.[ab]\.", "guides.*.", path)
    if "." not in path or name not in formula:
        return False
    return re.search(rf"(?<![\w.]){re.escape(name)}(?![\w])", formula) is not None


def program_sources() -> Iterator[tuple[str, Source]]:
    """Name and source of each value built into the program, card values included."""
    for key, row in LIMITS.items():
        yield f"limits.{key}", row.source
    for one in CHECKS:
        if one.limit is None and one.source:
            yield f"checks.{one.id}", one.source
    cards = known_cards(None)
    for kind in KINDS:
        for name, card in cards[kind].items():
            place = f"{kind}.{name}"
            for key in numbers_of(card):
                yield f"{place}.{key}", source_in_card(card, key, f"cards.{place}")
    yield from wire_sources()
    yield "shaft_seats", seat_source()
    yield from usual_sources()


def open_sources() -> dict[str, list[str]]:
    """Names of the built-in values to be confirmed, by the text of their source."""
    by_text: dict[str, list[str]] = {}
    for name, source in program_sources():
        if not source.confirmed:
            by_text.setdefault(source.text, []).append(name)
    return by_text

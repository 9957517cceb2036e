"""Verdict of a run in sentences."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import cast

from camwright.pipeline.base.verdict import CERTIFIED, OUTCOMES, in_order, within_depth
from camwright.pipeline.base.verdict import governing as governing_of
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.forms import Depth
from camwright.pipeline.results.check_records import (
    judgement,
    of_records,
    records_of,
    relaxed_limits,
    to_be_confirmed,
)
from camwright.pipeline.results.check_report import not_proven, reason_without_data
from camwright.pipeline.results.verdict_summary import (
    WORST,
    failure_words,
    failures,
    governs_first,
)
from camwright.reports.report_tables import (
    Record,
    check_rows,
    isolated,
    printed,
    words,
)

Check = Record


@dataclass(frozen=True)
class Verdict:
    """Verdict of a run, or its screen below the certified depth.

    `outcome` is ``pass``, ``incomplete`` or ``fail``, of a screen ``open`` or ``fail``; `line` the
    verdict with its reasons, the numbers of waived checks and of values to be confirmed; `confirm`
    names these values, `relaxed` the limits that are weaker than their defaults. `sentence` counts
    the checks by status, `governing` describes the required check of the design of highest
    utilisation, "" where it is the first of `worst`; `binding` are titles of required checks that
    fail. `unproven`, `missing` and `waived` are lines on required checks whose error bar lies
    across the limit, that lack data, and that are waived. `stopped` are the clauses of the reason
    for which the trials ended, `scope` the parts not covered, `label` what is stated; `ends` where
    the follower leaves the cam or locks; `worst` are the worst failed required checks in words,
    each with its remedy, "" without one.
    """

    outcome: str
    line: str
    confirm: tuple[str, ...]
    relaxed: tuple[str, ...]
    scope: str
    sentence: str
    governing: str
    binding: tuple[str, ...]
    stopped: tuple[str, ...]
    unproven: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    waived: tuple[str, ...] = ()
    label: str = "Verdict"
    ends: str = ""
    worst: tuple[tuple[str, str], ...] = ()

    @property
    def word(self) -> str:
        return self.outcome.upper()

    @property
    def brief(self) -> str:
        """The verdict in a word; for a pass with the values it rests on."""
        return self.line if self.outcome == "pass" else self.word

    @property
    def lines(self) -> list[tuple[str, str]]:
        """(label, text) of the lines below the sentence."""
        lines = (
            ("Loads", f"the follower {self.ends}: not evaluated there." if self.ends else ""),
            ("Governing", self.governing),
        )
        return [line for line in lines if line[1]]

    @property
    def lists(self) -> list[tuple[str, Sequence[str]]]:
        """(label, items) of the lists below the lines."""
        lists = (
            ("Limits relaxed", self.relaxed),
            ("Binding", self.binding),
            ("Missing data", self.missing),
            ("Not proven", self.unproven),
            ("Waived", self.waived),
            ("Reasons to end the trials", self.stopped),
        )
        return [each for each in lists if each[1]]


def verdict(
    recorded: str,
    checks: Sequence[Check],
    binding: Sequence[str],
    stopped: str,
    scope: str = "",
    depth: Depth = CERTIFIED,
    load_ends: str = "",
) -> Verdict:
    """Verdict in sentences; its outcome is the worse of the recorded one and that of the checks.

    Parameters
    ----------
    recorded : str       verdict of the run, or its screen
    checks : sequence    records of the final trial
    binding : sequence   ids of the binding checks
    stopped : str        reason for which the trials ended
    scope : str          parts that the sign-off does not cover, in a sentence
    depth : str          of the run: below certified it has a screen, no verdict
    load_ends : str      where the follower leaves the cam or locks, in words
    """
    deciding = [each for each in in_order(of_records(checks)) if each.must_have]
    required = records_of(deciding)
    missing = records_of(each for each in within_depth(deciding) if each.status == "not_evaluated")
    titles = {str(c["id"]): isolated(str(c["title"])) for c in checks}
    unknown = {str(c["id"]): titles[str(c["id"])] for c in missing}
    clauses = (clause for clause in stopped.split("; ") if clause)
    records = cast("Sequence[CheckRecord]", checks)
    judged = judgement(checks, depth)
    by_checks = str(judged["verdict"] or judged["screen"])
    outcome = max(recorded, by_checks, key=OUTCOMES.index)
    return Verdict(
        outcome=outcome,
        line=str(judged["verdict_line"]) if outcome == by_checks else outcome.upper(),
        confirm=tuple(to_be_confirmed(checks)),
        relaxed=tuple(relaxed_limits(checks)),
        scope=scope,
        sentence=_sentence(checks, required, missing),
        governing="" if governs_first(records) else governing(checks),
        ends=load_ends,
        binding=tuple(titles.get(n, words(n)) for n in map(str, binding) if n not in unknown),
        stopped=tuple(clause for clause in clauses if not _names_all(clause, unknown.values())),
        unproven=tuple(
            f"{isolated(str(c['title']))}: {not_proven(c)}" for c in required if c["not_proven"]
        ),
        missing=tuple(_stated(c) for c in missing),
        waived=tuple(
            f"{isolated(row.title)}: demand {row.demand}, accepted {isolated(row.waiver)}"
            for row in check_rows(required)
            if row.status.id == "waived"
        ),
        label="Verdict" if depth == CERTIFIED else "Screen, no verdict",
        worst=tuple(
            (isolated(printed(failure_words(c))), isolated(printed(str(c.get("remedy") or ""))))
            for c in failures(records)[:WORST]
        ),
    )


def _stated(check: Check) -> str:
    """A check without data, and what to state."""
    return f"{isolated(str(check['title']))}: {isolated(reason_without_data(check))}"


def _names_all(clause: str, titles: Collection[str]) -> bool:
    """Whether a clause repeats all of several titles."""
    return len(titles) > 1 and all(title in clause for title in titles)


def _sentence(checks: Sequence[Check], required: Sequence[Check], missing: Sequence[Check]) -> str:
    """Sentences on the numbers of required and optional checks by outcome.

    Parameters
    ----------
    checks : sequence     all checks
    required : sequence   those that must hold
    missing : sequence    required ones that lack data
    """
    if not checks:
        return "There are no checks. The verdict is FAIL without evidence."
    held = sum(c["status"] == "pass" for c in required)
    parts = [f"{held} of {_count(required, 'required check')} {_verb(held, 'passes', 'pass')}"]
    failed = sum(c["status"] == "fail" for c in required)
    if failed:
        parts.append(f"{failed} {_verb(failed, 'fails', 'fail')}")
    if missing:
        parts.append(f"{len(missing)} {_verb(len(missing), 'lacks', 'lack')} data")
    deeper = sum(bool(c["judged_at"]) for c in required)
    if deeper:
        parts.append(f"{deeper} {_verb(deeper, 'needs', 'need')} a deeper solution")
    waived = sum(c["status"] == "waived" for c in required)
    if waived:
        parts.append(f"{waived} {_verb(waived, 'is', 'are')} waived")
    optional = [c for c in checks if not c["must_have"]]
    exceeded = sum(c["status"] == "fail" for c in optional)
    unknown = sum(c["status"] == "not_evaluated" for c in optional)
    sentence = ", ".join(parts) + "."
    if exceeded or unknown:
        counts = [f"{exceeded} {_verb(exceeded, 'fails', 'fail')}"] if exceeded else []
        counts += [f"{unknown} {_verb(unknown, 'lacks', 'lack')} data"] if unknown else []
        sentence += f" Of {_count(optional, 'optional check')}: {', '.join(counts)}."
    return sentence


def governing(checks: Sequence[Check]) -> str:
    """Sentence on the governing check with demand, limit and place, see `verdict.governing`; ""
    without one.
    """
    first = governing_of(of_records(checks))
    if first is None:
        return ""
    row = check_rows([first.record])[0]
    place = f", load case {isolated(row.load_case)}" if row.load_case else ""
    angle = f", cam angle {row.where}" if row.where else ""
    corner = f", at the tolerance corner {row.corner}" if row.corner else ""
    return (
        f"{isolated(row.title)}{place}{angle}: demand {row.demand}{corner}, limit {row.limit},"
        f" utilisation {row.utilisation}."
    )


def governing_load_case(checks: Sequence[Check], names: Sequence[str]) -> str:
    """Load case of the governing check made in a load case; else the first load case."""
    made = [check for check in checks if check["load_case"] in names]
    first = governing_of(of_records(made))
    return names[0] if first is None else str(first.record["load_case"])


def _count(items: Sequence[Check], one: str) -> str:
    return f"{len(items)} {one}{'' if len(items) == 1 else 's'}"


def _verb(count: int, one: str, many: str) -> str:
    return one if count == 1 else many

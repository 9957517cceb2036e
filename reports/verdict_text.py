"""The verdict in sentences, from the checks of the final trial."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from camwright.reports.report_tables import (
    Record,
    check_rows,
    isolated,
    sorted_checks,
    utilisation,
    words,
)

Check = Record


@dataclass(frozen=True)
class Verdict:
    """Verdict of a run.

    `sentence` counts the checks by status, `governing` describes the required check of highest
    utilisation, `binding` and `missing` are titles of required checks that fail and that are not
    evaluated, `stopped` are the clauses of the reason for which the trials ended.
    """

    passed: bool
    sentence: str
    governing: str
    binding: tuple[str, ...]
    stopped: tuple[str, ...]
    missing: tuple[str, ...] = ()

    @property
    def word(self) -> str:
        return "PASS" if self.passed else "FAIL"

    @property
    def lines(self) -> list[tuple[str, str]]:
        """(label, text) of the lines below the sentence."""
        missing = f"{'; '.join(self.missing)}. The note of each check names the missing input."
        lines = (
            ("Governing", self.governing),
            ("Binding", f"{'; '.join(self.binding)}." if self.binding else ""),
            ("Not evaluated", missing if self.missing else ""),
            ("Stopping criterion", self.stopped[0] if self.stopped else ""),
        )
        return [line for line in lines if line[1]]

    @property
    def reasons(self) -> tuple[str, ...]:
        """Further clauses of the stopping criterion."""
        return self.stopped[1:]


def verdict(
    recorded: str, checks: Sequence[Check], binding: Sequence[str], stopped: str
) -> Verdict:
    """Verdict in sentences.

    Parameters
    ----------
    recorded : str         verdict of the run, "pass" or "fail"
    checks : sequence      records of the final trial
    binding : sequence     ids of the binding checks
    stopped : str          reason for which the trials ended

    The verdict is pass only if it is recorded so, there is a check, and no required check fails or
    is not evaluated.
    """
    required = [c for c in checks if c["must_have"]]
    failed = [c for c in required if c["status"] == "fail"]
    missing = [c for c in required if c["status"] == "not_evaluated"]
    passed = recorded == "pass" and bool(checks) and not failed and not missing
    titles = {str(c["id"]): isolated(str(c["title"])) for c in checks}
    unknown = {str(c["id"]): titles[str(c["id"])] for c in missing}
    clauses = (clause for clause in stopped.split("; ") if clause)
    return Verdict(
        passed,
        _sentence(checks, required, failed, missing),
        governing(checks),
        tuple(titles.get(n, words(n)) for n in map(str, binding) if n not in unknown),
        tuple(clause for clause in clauses if not _names_all(clause, unknown.values())),
        tuple(unknown.values()),
    )


def _names_all(clause: str, titles: Collection[str]) -> bool:
    """Whether a clause repeats all of several titles."""
    return len(titles) > 1 and all(title in clause for title in titles)


def _sentence(
    checks: Sequence[Check], required: Sequence[Check], failed: Sequence[Check],
    missing: Sequence[Check],
) -> str:  # fmt: skip
    if not checks:
        return "There are no checks. The verdict is fail without evidence."
    held = sum(c["status"] == "pass" for c in required)
    parts = [f"{held} of {_count(required, 'required check')} {_verb(held, 'passes', 'pass')}"]
    if failed:
        parts.append(f"{len(failed)} {_verb(len(failed), 'fails', 'fail')}")
    if missing:
        parts.append(f"{len(missing)} not evaluated (counted as failed)")
    waived = [c for c in required if c["status"] == "waived"]
    if waived:
        parts.append(f"{len(waived)} {_verb(len(waived), 'is', 'are')} waived")
    optional = [c for c in checks if not c["must_have"]]
    exceeded = sum(c["status"] == "fail" for c in optional)
    unknown = sum(c["status"] == "not_evaluated" for c in optional)
    sentence = ", ".join(parts) + "."
    if exceeded or unknown:
        counts = [f"{exceeded} {_verb(exceeded, 'fails', 'fail')}"] if exceeded else []
        counts += [f"{unknown} not evaluated"] if unknown else []
        sentence += f" Of {_count(optional, 'optional check')}: {', '.join(counts)}."
    return sentence


def governing(checks: Sequence[Check]) -> str:
    """The required check of highest utilisation in a sentence; empty if none is evaluated."""
    required = [c for c in sorted_checks(checks) if c["must_have"]]
    open_ones = [c for c in required if c["status"] in ("fail", "pass")]
    known = [c for c in open_ones if utilisation(c) is not None]
    if not known:
        return ""
    row = check_rows([max(known, key=lambda c: utilisation(c) or 0.0)])[0]
    place = f", load case {isolated(row.load_case)}" if row.load_case else ""
    angle = f", cam angle {row.where}" if row.where else ""
    return (
        f"{isolated(row.title)}{place}{angle}: demand {row.demand}, limit {row.limit},"
        f" utilisation {row.utilisation}."
    )


def governing_load_case(checks: Sequence[Check], names: Sequence[str]) -> str:
    """Load case of the governing check; the first one if it has none."""
    for check in sorted_checks(checks):
        if check["status"] in ("fail", "pass") and check["load_case"] in names:
            return str(check["load_case"])
    return names[0]


def _count(items: Sequence[Check], one: str) -> str:
    return f"{len(items)} {one}{'' if len(items) == 1 else 's'}"


def _verb(count: int, one: str, many: str) -> str:
    return one if count == 1 else many

"""Records of checks: contents, status by the numbers, verdict, screen, governing check.

No solver and no case parser is imported.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypedDict, TypeVar

from camwright.geometry.display import Displayed, html_table, in_brief, panels_of
from camwright.geometry.extrema import to_rank
from camwright.pipeline.base.columns import data_frame

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

STATUSES = ("pass", "waived", "not_evaluated", "fail")
"""Statuses of a check, from the best to the worst."""
VERDICTS = ("pass", "incomplete", "fail")
"""Verdicts, from the best to the worst."""
CERTIFIED = "certified"
"""Depth of a run with a verdict; a shallower one has a screen, ``fail`` or ``open``."""
OPEN = "open"
"""Screen without a failed check; as an exit code it counts as ``incomplete``."""
_DIGITS = 1e-12
"""Relative error of a sum of numbers with the 15 digits of a record."""
_ROUNDING = 1.001e-9
"""Share of a demand up to which its error is that of rounding, no uncertainty."""


class CheckRecordOfAnyCheck(TypedDict):
    """A record of ``6_checks.json``, in `unit` and degrees; null: missing, or infinite."""

    id: str
    title: str
    demand: float | None
    limit: float | None
    unit: str
    utilisation: float | None
    status: str
    load_case: str
    cam_angle_deg: float | None
    source: str
    method: str
    sense: str
    must_have: bool
    waiver: str | None
    waived_up_to: float | None
    not_proven: bool
    note: str
    error: float | None
    corner: str | None
    corner_demand: float | None
    evidence: bool
    judged_at: str


class CheckRecord(CheckRecordOfAnyCheck, total=False):
    """A record of ``6_checks.json``.

    to_be_confirmed: names of the recalled values on which it rests; relaxed: its limits that are
    weaker than their defaults; missing: dotted keys that the
    case lacks and without which it is not evaluated; remedy: smallest change that cures it, "" if
    none is known; stated: numbers of solvers and reductions in its formula by their symbol. Records
    of earlier versions lack them.
    """

    to_be_confirmed: list[str]
    relaxed: list[str]
    missing: list[str]
    remedy: str
    stated: dict[str, float]


AnyCheck = Mapping[str, object]
"""A `CheckRecord`, also where it is read as plain JSON."""


class Recorded(Protocol):
    """A check with a record."""

    def as_record(self) -> AnyCheck: ...


Item = TypeVar("Item", bound=AnyCheck | Recorded)


class CheckList(Displayed, tuple[Item, ...]):
    """Checks or their records in order, displayed as a table."""

    __slots__ = ()

    @property
    def records(self) -> list[AnyCheck]:
        """Record of each check."""
        return [each if isinstance(each, Mapping) else each.as_record() for each in self]

    @property
    def facts(self) -> Mapping[str, object]:
        """Number of checks by status, the worst first."""
        counts = Counter(str(record["status"]) for record in self.records)
        return {"checks": len(self)} | {
            status: counts[status] for status in reversed(STATUSES) if counts[status]
        }

    def to_pandas(self) -> pd.DataFrame:
        """A row per check, in the units of the column ``unit``; see `Table.to_pandas`."""
        return data_frame({key: [record.get(key) for record in self.records] for key in _SHOWN})

    def plot(self, most: int = 12) -> tuple[Axes, ...]:
        """Bars of the greatest utilisations with their values; drawn to twice the limit.

        Parameters
        ----------
        most : int   number of bars, at most
        """
        used = [(utilisation_of(record), record) for record in self.records]
        ranked = sorted(
            ((value, record) for value, record in used if value is not None),
            key=lambda each: -each[0],
        )[:most]
        (axes,) = panels_of(1, (7.0, 0.3 * len(ranked) + 0.4))
        colours = [_COLOURS[str(record["status"])] for _, record in ranked]
        titles = [str(record["title"]) for _, record in ranked]
        drawn = [min(value, _LONGEST) for value, _ in ranked]
        bars = axes.barh(range(len(ranked)), drawn, color=colours)
        axes.bar_label(bars, [f" {value:.3g}" for value, _ in ranked], fontsize="small")
        axes.set_yticks(range(len(ranked)), titles, fontsize="small")
        axes.invert_yaxis()
        axes.axvline(1.0, color="black", linewidth=0.8)
        axes.set_xlabel("utilisation")
        return (axes,)

    def _repr_html_(self) -> str:
        return html_table(repr(self), _SHOWN[:8], map(_row_in_words, self.records))


class WithChecks(Displayed):
    """A result with checks: its data frame and its figure are those of the checks."""

    checks: tuple[Any, ...]

    def to_pandas(self) -> pd.DataFrame:
        """A row per check; see `CheckList.to_pandas`."""
        return CheckList(self.checks).to_pandas()

    def plot(self, most: int = 12) -> tuple[Axes, ...]:
        """Bars of the greatest utilisations; see `CheckList.plot`."""
        return CheckList(self.checks).plot(most)

    def _repr_html_(self) -> str:
        worst = [each for each in CheckList(self.checks).records if each["status"] == "fail"]
        facts = super()._repr_html_()
        failing = html_table("failing checks", _SHOWN[:8], map(_row_in_words, worst))
        return facts + failing if worst else facts


_SHOWN = (
    "id", "title", "demand", "limit", "unit", "utilisation", "status", "must_have", "load_case",
    "cam_angle_deg", "corner", "corner_demand", "error", "not_proven", "missing", "note", "remedy",
)  # fmt: skip
"""Columns of a data frame of checks; the first eight in a notebook."""
_LONGEST = 2.0
"""Utilisation to which a bar is drawn."""
_COLOURS = {"pass": "tab:green", "waived": "tab:olive", "fail": "tab:red"}


def _row_in_words(record: AnyCheck) -> list[str]:
    values = (record.get(key) for key in _SHOWN[:8])
    return ["" if value is None else in_brief(value) for value in values]


def binding_of(checks: Iterable[CheckRecord]) -> tuple[str, ...]:
    """Ids of the must-have checks that fail or lack data, without those of a deeper solution."""
    return tuple(
        check["id"]
        for check in within_depth(checks)
        if check["must_have"] and check["status"] not in ("pass", "waived")
    )


def governing_of(checks: Iterable[AnyCheck]) -> AnyCheck | None:
    """Must-have check of the design of the greatest utilisation; None if none is evaluated.

    Evidence, which no change of the design moves, and waived checks do not govern. Of equal ones
    the first by its id.
    """
    ranked = [
        (-to_rank(used), str(check["id"]), check)
        for check in checks
        if _governs(check) and (used := utilisation_of(check)) is not None
    ]
    return min(ranked, key=lambda each: each[:2])[2] if ranked else None


def _governs(check: AnyCheck) -> bool:
    """Whether a check is ranked as governing: a must-have of the design that passes or fails."""
    ranked = check["must_have"] and not check["evidence"]
    return bool(ranked and check["status"] in ("pass", "fail"))


def governing_id(checks: Iterable[AnyCheck]) -> str | None:
    """Id of the governing check; see `governing_of`."""
    governing = governing_of(checks)
    return None if governing is None else str(governing["id"])


def utilisation_of(check: AnyCheck) -> float | None:
    """Utilisation of a record; null with status ``fail`` is infinite, as JSON has no infinity."""
    value = _number(check["utilisation"])
    return math.inf if value is None and check["status"] == "fail" else value


def within_depth(checks: Iterable[CheckRecord]) -> tuple[CheckRecord, ...]:
    """The records without those that a deeper solution judges."""
    return tuple(check for check in checks if not check["judged_at"])


def judgement(checks: Iterable[AnyCheck], depth: str) -> dict[str, str | None]:
    """Depth, verdict, screen and both in one line.

    A certified run has a verdict, see `verdict_of`, and no screen. A shallower one has no verdict;
    its screen is ``fail`` if a must-have check fails, else ``open``.
    """
    checks = tuple(checks)
    line = verdict_line(checks) if depth == CERTIFIED else screen_line(checks, depth)
    certified = depth == CERTIFIED
    return {
        "depth": depth,
        "verdict": verdict_of(checks) if certified else None,
        "screen": None if certified else screen_of(checks),
        "verdict_line": line,
    }


def screen_of(checks: Iterable[AnyCheck]) -> str:
    """Screen of the must-have checks, as `checks.check.screen` has it."""
    failing = any(check["must_have"] and check["status"] == "fail" for check in checks)
    return "fail" if failing else OPEN


def exit_word(judged: Mapping[str, Any]) -> str:
    """Verdict that decides the exit code; ``incomplete`` for an open screen."""
    word = judged["verdict"] or judged["screen"]
    return "incomplete" if word == OPEN else str(word)


def verdict_of(checks: Iterable[AnyCheck]) -> str:
    """Verdict of the must-have checks, as `checks.check.verdict` has it.

    ``fail`` if one is beyond its limit or not proven, or without any; else ``incomplete`` if one
    lacks data; else ``pass``.
    """
    deciding = [check["status"] for check in checks if check["must_have"]]
    if not deciding or "fail" in deciding:
        return "fail"
    return "incomplete" if "not_evaluated" in deciding else "pass"


def verdict_line(records: Iterable[AnyCheck]) -> str:
    """Verdict of the must-have checks in one line.

    Such as ``PASS, 1 limit relaxed, 2 waived, 3 values to be confirmed`` or ``INCOMPLETE: 1 check
    without data``. A relaxed limit and a value to be confirmed count once, however many checks rest
    on them.
    """
    deciding = [record for record in records if record["must_have"]]
    if not deciding:
        return "FAIL: no check decides"
    verdict, stated = verdict_of(deciding), _counts(deciding)
    if verdict == "pass":
        return f"PASS, {stated}" if stated else "PASS"
    return f"{verdict.upper()}: {stated}"


def screen_line(records: Iterable[AnyCheck], depth: str) -> str:
    """Screen of the must-have checks in one line, such as ``OPEN at the depth preview: ...``."""
    deciding = [record for record in records if record["must_have"]]
    within = [record for record in deciding if not record["judged_at"]]
    deeper = len(deciding) - len(within)
    later = f"{_counted(deeper, 'check', 'checks')} judged deeper" if deeper else ""
    parts = ", ".join(part for part in (_counts(within), later) if part)
    return f"{screen_of(deciding).upper()} at the depth {depth}: {parts or 'no check fails'}"


def _counts(deciding: Sequence[AnyCheck]) -> str:
    """Counts of the must-have checks that do not simply pass, in words."""
    failed = [record for record in deciding if record["status"] == "fail"]
    unproven = sum(bool(record["not_proven"]) for record in failed)
    statuses = Counter(str(record["status"]) for record in deciding)
    waived, values = statuses["waived"], len(to_be_confirmed(deciding))
    parts = (
        _counted(len(relaxed_limits(deciding)), "limit relaxed", "limits relaxed"),
        _counted(len(failed) - unproven, "check beyond its limit", "checks beyond their limit"),
        _counted(unproven, "check not proven", "checks not proven"),
        _counted(statuses["not_evaluated"], "check without data", "checks without data"),
        f"{waived} waived" if waived else "",
        _counted(values, "value to be confirmed", "values to be confirmed"),
    )
    return ", ".join(part for part in parts if part)


def _counted(number: int, one: str, many: str) -> str:
    """A number with its noun; empty for zero."""
    return f"{number} {one if number == 1 else many}" if number else ""


def to_be_confirmed(records: Iterable[AnyCheck]) -> list[str]:
    """Names of the recalled values on which the must-have checks rest, each once."""
    return _listed(records, "to_be_confirmed")


def relaxed_limits(records: Iterable[AnyCheck]) -> list[str]:
    """Limits of the must-have checks that are weaker than their defaults, in words, each once."""
    return _listed(records, "relaxed")


def _listed(records: Iterable[AnyCheck], field: str) -> list[str]:
    listed = (record.get(field) for record in records if record["must_have"])
    names = (str(name) for each in listed if isinstance(each, list) for name in each)
    return list(dict.fromkeys(names))


class Judged(NamedTuple):
    """Worst demand of a record and half of its error bar, in the unit of the record."""

    demand: float
    error: float

    def towards(self, sense: str) -> float:
        """End of the error bar towards the limit."""
        return self.demand - self.error if sense == "at_least" else self.demand + self.error


def judged(record: AnyCheck) -> Judged | None:
    """Demand by which a record is judged: the worse of nominal and tolerance corner.

    None where a number is missing; a named corner without a number is one. The error bar is the
    same share of the demand at the corner as at the nominal.
    """
    demand, corner = _number(record["demand"]), _number(record["corner_demand"])
    if demand is None or (record["corner"] and corner is None):
        return None
    worse = min if record["sense"] == "at_least" else max
    worst = demand if corner is None else worse(demand, corner)
    error = _number(record["error"]) or 0.0
    share = error / abs(demand) if demand else 0.0
    return Judged(worst, abs(worst) * share if share > _ROUNDING else 0.0)


def status_of(record: AnyCheck) -> str:
    """Status of a record by its numbers: worst demand, error bar, limit and value of the waiver.

    A missing number is never better than ``not_evaluated``.
    """
    one, limit, sense = judged(record), _number(record["limit"]), str(record["sense"])
    if one is None or limit is None:
        return "not_evaluated"
    upper = one.towards(sense)
    if not record["not_proven"] and _within(upper, limit, sense):
        return "pass"
    accepted = _number(record["waived_up_to"]) if record["waiver"] else None
    covered = accepted is not None and _within(upper, accepted, sense)
    return "waived" if covered else "fail"


def _within(demand: float, limit: float, sense: str) -> bool:
    """Whether a demand keeps a limit, up to the digits of a record."""
    slack = _DIGITS * max(abs(demand), abs(limit))
    return demand >= limit - slack if sense == "at_least" else demand <= limit + slack


def _number(value: object) -> float | None:
    """A finite number of a record."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    return float(value)

"""JSON records of checks: contents, table, verdict in words.

No solver and no case parser is imported.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np

from camwright.geometry.display import Displayed, html_table, in_brief
from camwright.geometry.figures import (
    Curve,
    DrawnAxes,
    Figure,
    HorizontalAxis,
    LimitLine,
    Panel,
    plotted,
)
from camwright.pipeline.base.columns import data_frame
from camwright.pipeline.base.verdict import (
    CERTIFIED,
    STATUSES,
    Status,
    error_of_worst,
    screen,
    status,
    verdict,
    worst,
)
from camwright.pipeline.records.forms import Depth
from camwright.pipeline.records.run_summary import StatedVerdict

if TYPE_CHECKING:
    import pandas as pd

_RECORD_DIGITS = 1e-12
"""Relative error of a sum of numbers with the 15 digits of a record."""
_RECORD_ROUNDING = 1.001e-9
"""Share of a demand up to which its error is that of rounding, no uncertainty."""


AnyCheck = Mapping[str, object]
"""A `CheckRecord`, also where it is read as plain JSON."""


class Recorded(Protocol):
    """Interface of a check with its JSON record."""

    def as_record(self) -> AnyCheck: ...


Item = TypeVar("Item", bound=AnyCheck | Recorded)


AnyRecord = TypeVar("AnyRecord", bound=AnyCheck)


@dataclass(frozen=True)
class RecordedCheck(Generic[AnyRecord]):
    """Check read from its record, for `base.verdict`; status and utilisation as stated.

    Its numbers are in the unit of the record.
    """

    record: AnyRecord

    @property
    def id(self) -> str:
        return str(self.record["id"])

    @property
    def status(self) -> str:
        return str(self.record["status"])

    @property
    def utilisation(self) -> float | None:
        """As stated; null of an evaluated check is infinite, as JSON has no infinity."""
        value = _number(self.record["utilisation"])
        return math.inf if value is None and self.status in ("fail", "waived") else value

    @property
    def must_have(self) -> bool:
        return bool(self.record["must_have"])

    @property
    def evidence(self) -> bool:
        return bool(self.record["evidence"])

    @property
    def judged_at(self) -> str:
        return str(self.record["judged_at"])

    @property
    def demand(self) -> float | None:
        return _number(self.record["demand"])

    @property
    def corner_demand(self) -> float | None:
        """NaN where a corner is named without a number."""
        corner = _number(self.record["corner_demand"])
        return math.nan if corner is None and self.record["corner"] else corner

    @property
    def worst(self) -> float | None:
        """Judged demand; None where a number is missing."""
        demand = worst(self)
        return None if demand is None or math.isnan(demand) else demand

    @property
    def limit(self) -> float | None:
        return _number(self.record["limit"])

    @property
    def error_share(self) -> float:
        error, demand = _number(self.record["error"]), self.demand
        return error / abs(demand) if error and demand else 0.0

    @property
    def error(self) -> float:
        """Half of the error bar of the judged demand; 0 where it is round-off alone."""
        return error_of_worst(self) if self.error_share > _RECORD_ROUNDING else 0.0

    @property
    def sense(self) -> str:
        return str(self.record["sense"])

    @property
    def waived_up_to(self) -> float | None:
        return _number(self.record["waived_up_to"]) if self.record["waiver"] else None

    @property
    def without(self) -> str:
        """Empty: a bound within its limit is recorded without its demand."""
        return ""

    @property
    def status_by_numbers(self) -> Status:
        """Status by worst demand, error bar, limit and value of the waiver, to their digits."""
        proven = not self.record["not_proven"]
        return status(self, digits=_RECORD_DIGITS, rounding=_RECORD_ROUNDING, proven=proven)


def of_records(records: Iterable[AnyRecord]) -> tuple[RecordedCheck[AnyRecord], ...]:
    """Checks of `base.verdict` from their records."""
    return tuple(RecordedCheck(record) for record in records)


def records_of(checks: Iterable[RecordedCheck[AnyRecord]]) -> tuple[AnyRecord, ...]:
    """Records of the checks given by `of_records`."""
    return tuple(each.record for each in checks)


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

    def plot(self, most: int = 12) -> DrawnAxes:
        """Bars of the greatest utilisations; see `figure`."""
        return plotted(self.figure(most))

    def figure(self, most: int = 12) -> Figure:
        """Bars of the greatest utilisations with their values, on an axis to twice the limit.

        Parameters
        ----------
        most : int   number of bars, at most
        """
        used = [(each.utilisation, each.record) for each in of_records(self.records)]
        ranked = sorted(
            ((value, record) for value, record in used if value is not None),
            key=lambda each: -each[0],
        )[:most]
        titles = tuple(str(record["title"]) for _, record in ranked)
        used_by = np.array([value for value, _ in ranked])
        statuses = np.array([record["status"] for _, record in ranked])
        rows = [(status, np.flatnonzero(statuses == status)) for status in _COLOURS]
        bars = tuple(
            Curve(used_by[row], row.astype(float), status, _COLOURS[status], "bar", notes=titles)
            for status, row in rows if row.size
        )  # fmt: skip
        axis = HorizontalAxis("utilisation", "", (0.0, _LONGEST_BAR))
        panel = Panel("", "", bars, (LimitLine(1.0, "limit"),), kind="bars")
        return Figure("utilisation", "Utilisation", "", (panel,), axis)

    def _repr_html_(self) -> str:
        return html_table(repr(self), _SHOWN[:8], map(_row_in_words, self.records))


class WithChecks(Displayed):
    """Base of results with checks: data frame and figure of the checks."""

    checks: tuple[Any, ...]

    def to_pandas(self) -> pd.DataFrame:
        """A row per check; see `CheckList.to_pandas`."""
        return CheckList(self.checks).to_pandas()

    def plot(self, most: int = 12) -> DrawnAxes:
        """Bars of the greatest utilisations; see `CheckList.plot`."""
        return CheckList(self.checks).plot(most)

    def _repr_html_(self) -> str:
        """HTML of the facts with a table of the failing checks, for notebooks."""
        worst = [each for each in CheckList(self.checks).records if each["status"] == "fail"]
        facts = super()._repr_html_()
        failing = html_table("failing checks", _SHOWN[:8], map(_row_in_words, worst))
        return facts + failing if worst else facts


_SHOWN = (
    "id", "title", "demand", "limit", "unit", "utilisation", "status", "must_have", "load_case",
    "cam_angle_deg", "corner", "corner_demand", "error", "not_proven", "missing", "note", "remedy",
)  # fmt: skip
"""Columns of a data frame of checks; the first eight in a notebook."""
_LONGEST_BAR = 2.0
"""Utilisation to which a bar is drawn."""
_COLOURS = {"pass": "ok", "waived": "warn", "fail": "fail"}


def _row_in_words(record: AnyCheck) -> list[str]:
    values = (record.get(key) for key in _SHOWN[:8])
    return ["" if value is None else in_brief(value) for value in values]


def judgement(checks: Iterable[AnyCheck], depth: Depth) -> StatedVerdict:
    """Verdict or screen of the checks of a run, with its depth and a line of text.

    A certified run has a verdict and no screen, a shallower one a screen and no verdict.
    """
    checks = tuple(checks)
    line = verdict_line(checks) if depth == CERTIFIED else screen_line(checks, depth)
    certified = depth == CERTIFIED
    return {
        "depth": depth,
        "verdict": verdict(of_records(checks)) if certified else None,
        "screen": None if certified else screen(of_records(checks)),
        "verdict_line": line,
    }


def verdict_line(records: Iterable[AnyCheck]) -> str:
    """Verdict of the must-have checks in one line.

    Such as ``PASS, 1 limit relaxed, 2 waived, 3 values to be confirmed`` or ``INCOMPLETE: 1 check
    without data``. A relaxed limit and a value to be confirmed count once, however many checks rest
    on them.
    """
    deciding = [record for record in records if record["must_have"]]
    if not deciding:
        return "FAIL: no check decides"
    judged, stated = verdict(of_records(deciding)), _counts(deciding)
    if judged == "pass":
        return f"PASS, {stated}" if stated else "PASS"
    return f"{judged.upper()}: {stated}"


def screen_line(records: Iterable[AnyCheck], depth: str) -> str:
    """Screen of the must-have checks in one line, such as ``OPEN at the depth preview: ...``."""
    deciding = [record for record in records if record["must_have"]]
    within = [record for record in deciding if not record["judged_at"]]
    deeper = len(deciding) - len(within)
    later = f"{_counted(deeper, 'check', 'checks')} judged deeper" if deeper else ""
    parts = ", ".join(part for part in (_counts(within), later) if part)
    judged = screen(of_records(deciding))
    return f"{judged.upper()} at the depth {depth}: {parts or 'no check fails'}"


def _counts(deciding: Sequence[AnyCheck]) -> str:
    """Text with the numbers of required checks that do not simply pass: failed, not proven, without
    data, waived, with a relaxed limit or values to be confirmed; "" without any.
    """
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
    """Names of the unconfirmed values on which the must-have checks rest, each once."""
    return _listed(records, "to_be_confirmed")


def relaxed_limits(records: Iterable[AnyCheck]) -> list[str]:
    """Limits of the must-have checks weaker than their defaults, in words, each once."""
    return _listed(records, "relaxed")


def _listed(records: Iterable[AnyCheck], field: str) -> list[str]:
    listed = (record.get(field) for record in records if record["must_have"])
    names = (str(name) for each in listed if isinstance(each, list) for name in each)
    return list(dict.fromkeys(names))


def _number(value: object) -> float | None:
    """A finite number of a record."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    return float(value)

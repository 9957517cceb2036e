"""Comparison of checks with a baseline run: changes beyond the error bars."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from camwright.pipeline.records.check_document import ChangeKind, CheckChange
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_report import number

# Relative error bar of a demand without one: digits beyond it are not printed.
UNKNOWN_ERROR = 1e-6


def changes(before: Iterable[CheckRecord], now: Iterable[CheckRecord]) -> list[CheckChange]:
    """Checks of a run that differ from those of a baseline run: in status, limit, or demand beyond
    both error bars.

    A check on one side only is `new` or `gone`. Relative evidence, such as residuals and mesh
    uncertainties, is an error itself: it differs where its status does.

    Parameters
    ----------
    before, now : iterable   check records of the baseline and of the run
    """
    old, new = ({record["id"]: record for record in side} for side in (before, now))
    entries = []
    for name in dict.fromkeys([*new, *old]):
        if name not in old:
            entries.append(_one_sided(new[name], "new"))
        elif name not in new:
            entries.append(_one_sided(old[name], "gone"))
        else:
            entries.append(_change(old[name], new[name]))
    return [entry for entry in entries if entry["kinds"]]


def lines(entries: Iterable[CheckChange]) -> list[str]:
    """Changes of the checks, one line each."""
    return [
        f"{entry['id']}: {', '.join(entry['kinds'])}; demand {number(entry['demand_before'])} ->"
        f" {number(entry['demand'])} {entry['unit']} (error bars {number(entry['error_bars'])}),"
        f" {entry['status_before'] or 'absent'} -> {entry['status'] or 'absent'}"
        for entry in entries
    ] or ["nothing changed beyond the error bars"]


def _one_sided(record: CheckRecord, kind: Literal["new", "gone"]) -> CheckChange:
    demand, status = record["demand"], record["status"]
    return {
        "id": record["id"],
        "kinds": [kind],
        "unit": record["unit"],
        "demand_before": demand if kind == "gone" else None,
        "demand": demand if kind == "new" else None,
        "error_bars": _error(record),
        "status_before": status if kind == "gone" else None,
        "status": status if kind == "new" else None,
    }


def _change(old: CheckRecord, new: CheckRecord) -> CheckChange:
    bars, limit = _error(old) + _error(new), new["limit"] or 0.0
    differs: dict[ChangeKind, bool] = {
        "status": old["status"] != new["status"],
        "demand": not _is_error(new) and _apart(old["demand"], new["demand"], bars),
        "limit": _apart(old["limit"], new["limit"], UNKNOWN_ERROR * abs(limit)),
    }
    return {
        "id": new["id"],
        "kinds": [kind for kind, changed in differs.items() if changed],
        "unit": new["unit"],
        "demand_before": old["demand"],
        "demand": new["demand"],
        "error_bars": bars,
        "status_before": old["status"],
        "status": new["status"],
    }


def _is_error(record: CheckRecord) -> bool:
    """Whether a demand is itself the relative error of a number."""
    return record["evidence"] and record["unit"] in ("-", "%")


def _error(record: CheckRecord) -> float:
    """Half-width of the error bar of a demand, in the unit of the check: as recorded, else
    `UNKNOWN_ERROR` of the demand; 0 without a demand.
    """
    if record["demand"] is None:
        return 0.0
    known = record["error"]
    return known if known is not None else UNKNOWN_ERROR * abs(record["demand"])


def _apart(old: float | None, new: float | None, bars: float) -> bool:
    if old is None or new is None:
        return old is not new
    return abs(new - old) > bars

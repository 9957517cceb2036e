"""What changed in the checks against an earlier run, beyond the error bars."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

Record = Mapping[str, Any]

# Demands without an error bar of their own are compared as far as they are printed.
UNKNOWN_ERROR = 1e-6


def changes(before: Iterable[Record], now: Iterable[Record]) -> list[dict[str, Any]]:
    """One entry per check that differs: by status, by demand beyond both error bars, by limit.

    A check on one side only is `new` or `gone`. Of the evidence, shares such as residuals and
    mesh uncertainties are errors themselves: they differ where their status does.
    """
    old, new = ({record["id"]: record for record in side} for side in (before, now))
    found = [_change(old.get(name), new.get(name)) for name in dict.fromkeys([*new, *old])]
    return [entry for entry in found if entry["kinds"]]


def lines(found: Iterable[Mapping[str, Any]]) -> list[str]:
    """One line a change."""
    return [
        f"{entry['id']}: {', '.join(entry['kinds'])}; demand {_text(entry['demand_before'])} ->"
        f" {_text(entry['demand'])} {entry['unit']} (error bars {_text(entry['error_bars'])}),"
        f" {entry['status_before'] or 'absent'} -> {entry['status'] or 'absent'}"
        for entry in found
    ] or ["nothing changed beyond the error bars"]


def _change(old: Record | None, new: Record | None) -> dict[str, Any]:
    kinds = []
    bars = _error(old) + _error(new)
    if old is None or new is None:
        kinds.append("new" if old is None else "gone")
    else:
        if old["status"] != new["status"]:
            kinds.append("status")
        if not _is_error(new) and _apart(old["demand"], new["demand"], bars):
            kinds.append("demand")
        if _apart(old["limit"], new["limit"], UNKNOWN_ERROR * abs(new["limit"] or 0.0)):
            kinds.append("limit")
    either = new or old or {}
    return {
        "id": either["id"],
        "kinds": kinds,
        "unit": either["unit"],
        "demand_before": None if old is None else old["demand"],
        "demand": None if new is None else new["demand"],
        "error_bars": bars,
        "status_before": None if old is None else old["status"],
        "status": None if new is None else new["status"],
    }


def _is_error(record: Record) -> bool:
    """Whether a demand is itself the error of a number: told where its verdict changes."""
    return bool(record["evidence"]) and record["unit"] in ("-", "%")


def _error(record: Record | None) -> float:
    if record is None or record["demand"] is None:
        return 0.0
    known = record["error"]
    return float(known if known is not None else UNKNOWN_ERROR * abs(record["demand"]))


def _apart(old: float | None, new: float | None, bars: float) -> bool:
    if old is None or new is None:
        return old is not new
    return abs(new - old) > bars


def _text(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"

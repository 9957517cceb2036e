"""Hand-check sheet as plain lines of text."""

from __future__ import annotations

from camwright.pipeline.base import formula
from camwright.pipeline.base.units import used
from camwright.pipeline.hand_check.hand_sheet import Sheet
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_records import RecordedCheck
from camwright.pipeline.results.check_report import (
    corner,
    number,
    place,
    status,
    unit_text,
    with_error,
)

STATED = "one number of a solver or a count, stated with its error bar; its use is evaluated"
"""Words on a demand that is one stated number."""


def demand_words(record: CheckRecord) -> str:
    """Demand of a check in words, with error bar and place."""
    at = place(record)
    shown = f"{with_error(record['demand'], record['error'])}{unit_text(record['unit'])}"
    return f"{shown} at {at}" if at else shown


def limit_words(sheet: Sheet) -> str:
    """Limit of a check in words: number, formula with symbols and then with numbers, source."""
    record = sheet.record
    sense = ">=" if record["sense"] == "at_least" else "<="
    shown = f"{sense} {number(record['limit'])}{unit_text(record['unit'])}"
    formed = "" if sheet.limit in ("", number(record["limit"])) else f" = {sheet.limit}"
    if (bound := sheet.bound) is not None and bound.expression.kind not in ("name", "number"):
        formed += f" = {formula.written(bound.expression, formula.TEXT, sheet.known)}"
    return f"{shown}{formed}: {record['source']}"


def outcome_words(sheet: Sheet) -> str:
    """Whether the demand by the formula agrees with that of the run, in words, or why it is stated
    and not evaluated.
    """
    if not sheet.agrees:
        return f"DISAGREES with the {sheet.differs_in} of the check"
    if not sheet.steps:
        return f"not evaluated: {sheet.reason}"
    return STATED if sheet.is_stated else "agrees"


def use_words(sheet: Sheet) -> str:
    """Utilisation of a check as a quotient of demand and limit, and in percent."""
    used_words = used(RecordedCheck(sheet.record).utilisation)
    if sheet.use is None:
        return f"{used_words} used"
    unit = unit_text(sheet.record["unit"])
    one, other = (f"{number(each)}{unit}" for each in sheet.use)
    return f"{one} / {other} = {used_words} used"


def sheet_lines(sheet: Sheet) -> list[str]:
    """Lines of a sheet: formula, symbols, steps, result, limit with source."""
    record = sheet.record
    rows = [("formula", sheet.text)]
    rows += [(each.symbol, f"{each.shown}  [{each.source}]") for each in sheet.quantities]
    for step in sheet.steps:
        symbols, numbers = (
            formula.written(step.expression, formula.TEXT, known) for known in (None, sheet.known)
        )
        equal = "" if numbers == step.shown else f" = {step.shown}"
        rows.append((step.name or "demand", f"{symbols} = {numbers}{equal}"))
    rows.append(("check", demand_words(record)))
    rows.append(("", outcome_words(sheet)))
    rows.append(("limit", limit_words(sheet)))
    if worst := corner(record):
        rows.append(("corner", f"{worst}{unit_text(record['unit'])}"))
    rows.append(("result", f"{status(record)}, {use_words(sheet)}"))
    width = max(len(name) for name, _ in rows) + 2
    title = f"{record['id']}: {record['title']}"
    return [title, *(f"  {name:<{width}}{text}" for name, text in rows)]

"""Hand-check sheet as lines of text."""

from __future__ import annotations

from camwright.pipeline.base import formula
from camwright.pipeline.base.units import used
from camwright.pipeline.hand_check.hand_sheet import Sheet
from camwright.pipeline.results.check_records import utilisation_of
from camwright.pipeline.results.check_report import (
    corner,
    number,
    place,
    status,
    unit_text,
    with_error,
)

STATED = (
    "result of a solver or of a rule in words: stated with its error bar, not evaluated once more"
)
"""Words on a demand without an evaluation."""


def sheet_lines(sheet: Sheet) -> list[str]:
    """A sheet in lines: formula, symbols, steps, result, limit with its source."""
    record = sheet.record
    unit = unit_text(record["unit"])
    sense = ">=" if record["sense"] == "at_least" else "<="
    shown = f"{with_error(record['demand'], record['error'])}{unit}"
    rows = [("formula", sheet.text)]
    rows += [(each.symbol, f"{each.shown}  [{each.source}]") for each in sheet.quantities]
    for step in sheet.steps:
        symbols, numbers = (
            formula.written(step.expression, formula.TEXT, known) for known in (None, sheet.known)
        )
        equal = "" if numbers == step.shown else f" = {step.shown}"
        rows.append((step.name or "demand", f"{symbols} = {numbers}{equal}"))
    at = place(record)
    rows.append(("check", f"{shown}{f' at {at}' if at else ''}"))
    if sheet.is_stated:
        rows.append(("", STATED))
    else:
        rows.append(("", "agrees" if sheet.agrees else "DISAGREES with the demand of the check"))
    rows.append(("limit", f"{sense} {number(record['limit'])}{unit}: {record['source']}"))
    if worst := corner(record):
        rows.append(("corner", f"{worst}{unit}"))
    rows.append(("result", f"{status(record)}, {used(utilisation_of(record))} used"))
    width = max(len(name) for name, _ in rows) + 2
    return [
        f"{record['id']}: {record['title']}",
        *(f"  {name:<{width}}{text}" for name, text in rows),
    ]

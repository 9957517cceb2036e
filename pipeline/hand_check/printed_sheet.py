"""Hand-check sheet typeset for page and PDF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from camwright.pipeline.base import formula
from camwright.pipeline.base.formula import PRINT, Printed
from camwright.pipeline.base.units import used
from camwright.pipeline.hand_check.hand_sheet import Sheet
from camwright.pipeline.hand_check.sheet_lines import (
    demand_words,
    limit_words,
    outcome_words,
    use_words,
)
from camwright.pipeline.results.check_records import RecordedCheck

Math = tuple[Printed, ...]
_EQUAL = (Printed("sign", "="),)


@dataclass(frozen=True)
class PrintedSymbol:
    """Symbol of a formula, value with unit, and its place in the run."""

    name: str
    symbol: Math
    shown: str
    source: str


@dataclass(frozen=True)
class PrintedSheet:
    """Hand-check sheet typeset for page and PDF.

    Parameters
    ----------
    text : str           formula of the declaration, with the meaning of its symbols
    symbols, steps : sequence   steps: with symbols, with numbers, and the result
    demand, outcome, limit, use : str   in words; outcome: whether the sheet agrees, and the use
    governing : bool     one of the checks of the greatest utilisation
    """

    id: str
    title: str
    text: str
    symbols: Sequence[PrintedSymbol]
    steps: Sequence[Math]
    demand: str
    outcome: str
    limit: str
    use: str
    governing: bool


def printed(sheet: Sheet, *, governing: bool) -> PrintedSheet:
    """Hand-check sheet of a check with its formulas typeset, for page and PDF."""
    record = sheet.record
    return PrintedSheet(
        record["id"],
        record["title"],
        sheet.text,
        [
            PrintedSymbol(each.symbol, PRINT.name(each.symbol), each.shown, each.source)
            for each in sheet.quantities
        ],
        [_step(sheet, k) for k in range(len(sheet.steps))],
        demand_words(record),
        f"{outcome_words(sheet)}; {use_words(sheet)}",
        limit_words(sheet),
        used(RecordedCheck(record).utilisation),
        governing,
    )


def _step(sheet: Sheet, k: int) -> Math:
    """Step k, counted from 0, of a sheet, typeset: name = symbols = numbers = result with its unit.

    Without the name of a step that has none, and without the result where the numbers are it.
    """
    step = sheet.steps[k]
    symbols, numbers = (formula.written(step.expression, PRINT, of) for of in (None, sheet.known))
    begins = (*PRINT.name(step.name), *_EQUAL) if step.name else ()
    result = PRINT.number(step.shown)
    return (
        *begins,
        *symbols,
        *_EQUAL,
        *numbers,
        *(() if numbers == result else (*_EQUAL, *result)),
    )

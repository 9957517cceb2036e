"""Live preview of the page: numbers of the design to drag, and the surfaces that follow them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import Json, read_json
from camwright.pipeline.base.verdict import in_order
from camwright.pipeline.results.check_records import of_records
from camwright.pipeline.results.run_reader import LIVE
from camwright.reports.interactive import script_safe_json
from camwright.reports.report_data import ReportMaterial
from camwright.reports.report_tables import Record, number, quantity

FOLLOWED = 12
"""Checks that the page shows: those of the greatest utilisation."""
STEPS = 200
"""Steps of a slider from end to end."""


@dataclass(frozen=True)
class LiveSlider:
    """A number of the design: id, name, unit; value in the run, least and greatest, as text."""

    id: str
    name: str
    unit: str
    value: str
    low: str
    high: str


@dataclass(frozen=True)
class LiveRow:
    """A quantity that follows: id, name, unit; limit of a check as text, "" of a key figure."""

    id: str
    title: str
    unit: str
    limit: str


@dataclass(frozen=True, eq=False)
class LiveView:
    """Contents of the section of the live preview.

    lift : str        lift of the designs, in words
    fit : str         how the surfaces are fitted, in words
    left_out : sequence   checks that are not followed, with the reason
    data : Markup     for the script of the page
    """

    sliders: Sequence[LiveSlider]
    figures: Sequence[LiveRow]
    checks: Sequence[LiveRow]
    lift: str
    fit: str
    left_out: Sequence[str]
    data: Markup


def live_view(material: ReportMaterial) -> LiveView | None:
    """Live preview of a run; None where it has no surfaces.

    Raises
    ------
    ResultError
        If ``8_live.json`` is not of its form.
    """
    file = material.run.path / LIVE
    if not file.is_file():
        return None
    try:
        return _view(material, read_json(file))
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise ResultError(f"{file}: {type(error).__name__}: {error}") from None


def _view(material: ReportMaterial, record: Record) -> LiveView:
    """Contents of the section from the record ``8_live.json``: sliders, key figures, the `FOLLOWED`
    checks of greatest utilisation, checks left out with the reason.
    """
    ordered = [each.id for each in in_order(of_records(material.run.final.checks))]
    title_of = {str(each["id"]): str(each["title"]) for each in material.run.final.checks}
    by_id = {each["id"]: each for each in record["quantities"] if each["limit"] is not None}
    followed = [by_id[name] for name in ordered if name in by_id][:FOLLOWED]
    figures = [each for each in record["quantities"] if each["limit"] is None]
    last = ordered.index(followed[-1]["id"]) if followed else len(ordered)
    return LiveView(
        [_slider(k, each) for k, each in enumerate(record["factors"])],
        [_row(each) for each in figures], [_row(each) for each in followed],
        _LIFT[record["lift"]], _fit_words(record),
        [f"{title_of[name]}: {why}" for name, why in record["left_out"].items()
         if name in ordered[:last]],
        Markup(script_safe_json(_data(record, [*figures, *followed]))),  # noqa: S704 - escaped
    )  # fmt: skip


_LIFT = {
    "run": "Every design keeps the lift of the run, as the cam was ground; a run finds a lift "
    "for each.",
    "case": "The lift is that of the case, times its stroke.",
}


def _slider(place: int, factor: Record) -> LiveSlider:
    unit, (_, value) = factor["unit"], next(iter(factor["keys"].items()))
    ends = (number(value * factor[end], 4) for end in ("low", "high"))
    return LiveSlider(f"live-{place}", factor["name"], unit, number(value, 6), *ends)


def _row(each: Record) -> LiveRow:
    """Row of the live preview for a quantity of its record; a limit that changes with the design
    has no text.
    """
    limit = each["limit"]
    constant = limit is not None and len(limit["coefficients"]) == 1
    words = quantity(limit["coefficients"][0], each["unit"], 4) if constant else ""
    return LiveRow(each["id"], each["title"], "" if each["unit"] == "-" else each["unit"], words)


def _fit_words(record: Record) -> str:
    """Sentences on the fitted polynomials: number of designs they go through, how their error is
    measured, refused designs.
    """
    words = (
        f"Polynomials through {record['settings']} screened designs within the ranges; the error "
        f"of each figure, ±, is the greatest at {record['held_out']} further ones, with that of "
        "the screening from the preview: nominal machine, closed forms, no tolerance corner."
    )
    if record["refused"]:
        words += f" The case refuses {record['refused']} of them: there nothing holds."
    return words


def _data(record: Record, quantities: Sequence[Record]) -> Json:
    """What the script of the page reads."""
    return {
        "case": record["case"], "lift": record["lift"], "steps": STEPS,
        "factors": record["factors"], "powers": record["powers"], "states": record["states"],
        "contact": record["contact"], "quantities": list(quantities),
    }  # fmt: skip

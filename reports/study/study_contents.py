"""Contents of a study's page: yield, failures, effects, front, inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from camwright.reports.report_content import Pairs, ReportSection, SectionBlock, Tabular
from camwright.reports.report_tables import (
    DASH,
    HEADLINES,
    Record,
    ReportTable,
    Tile,
    number,
    plain,
    quantity,
    shortened,
    words,
)

FACTOR, HEADLINE = "factor.", "headline."
UTILISATION, PASS = "utilisation", "pass"
STATES = {"screen": ("open", "fail", "no result"), "verdict": ("pass", "not pass", "no result")}
"""Words for the states 0 to 2 of a design, by the column that judges it."""
_GOALS = {"min": "minimum", "max": "maximum"}
_FAILURES = 25


@dataclass(frozen=True)
class YieldShare:
    """Yield in large type, with the sentences beside it and its interval."""

    name: str
    word: str
    sentence: str
    lines: Sequence[str]
    value: float | None
    interval: Sequence[float] | None

    @property
    def alt(self) -> str:
        """The drawn interval in words."""
        return f"{self.name} {self.word}"


@dataclass(frozen=True)
class FailureRow:
    """Row of a check that fails or lacks data: shares of the designs."""

    title: str
    fails: float
    open: float
    values: Sequence[str]


@dataclass(frozen=True)
class TornadoBar:
    """Bar of a tornado chart; positions as shares of its width."""

    factor: str
    levels: str
    left: float
    right: float
    low: float
    high: float
    swing: str
    alt: str


@dataclass(frozen=True)
class Index:
    """Sensitivity index with its confidence interval, clipped to 0 to 1."""

    shown: float
    low: float
    high: float
    words: str


@dataclass(frozen=True)
class IndexRow:
    """Sensitivity indices of one factor."""

    factor: str
    first: Index
    total: Index | None


@dataclass(frozen=True)
class Effect:
    """Effects of all factors on one output."""

    name: str
    title: str
    span: str
    mean: float
    tornado: Sequence[TornadoBar]
    indices_title: str
    indices: Sequence[IndexRow]

    @property
    def has_total(self) -> bool:
        """Whether total indices are known."""
        return any(row.total for row in self.indices)


@dataclass(frozen=True)
class DesignRow:
    """Row of a design, with the page of its run if kept."""

    cells: Sequence[str]
    link: str


@dataclass(frozen=True)
class DesignTable:
    """Designs in a table."""

    label: str
    head: Sequence[str]
    rows: Sequence[DesignRow]


@dataclass(frozen=True)
class Page:
    """Contents of a study's page."""

    title: str
    kicker: str
    facts: Sequence[tuple[str, str]]
    share: YieldShare
    tiles: Sequence[Tile]
    states: Sequence[str]
    failures: Sequence[FailureRow]
    silent: str
    thinned: str
    effects_lead: str
    effects: Sequence[Effect]
    front_lead: str
    front: DesignTable | None
    worst: DesignTable | None
    sections: Sequence[ReportSection]


def titled(name: str, unit: str = "") -> tuple[str, str]:
    """Label and unit of a dataset column for tables and axes of a study's page; `unit`: of the
    column where its label states none.
    """
    if name == UTILISATION:
        return "Utilisation of the governing check", ""
    if name == PASS:
        return "Share of designs that pass", ""
    if name.startswith(HEADLINE):
        key = name.removeprefix(HEADLINE)
        label, known = HEADLINES.get(key, (words(key), unit))
        return plain(label), known or unit
    if name.startswith(FACTOR):
        return plain(name.removeprefix(FACTOR)), plain(unit)
    check, _, figure = name.partition(".")
    return plain(f"{words(check)}, {words(figure)}" if figure else words(check)), plain(unit)


def page_of(
    title: str,
    facts: Sequence[tuple[str, str]],
    answers: Record,
    links: Mapping[int, str],
    drawn: int,
) -> Page:
    """Contents of a study's page.

    Parameters
    ----------
    title : str
    facts : sequence    pairs (name, text) that identify the study
    answers : mapping   ``answers.json`` of the study
    links : mapping     page of a design's run, by number of the design
    drawn : int         number of designs on the page
    """
    counts = answers["designs"]
    failures, silent = _failures(answers["failures"])
    front = answers["front"]
    count = _counted(counts["count"])
    thinned = f"The page holds {_counted(drawn)} of the {count} designs, evenly spaced, with all " \
        "that are kept or on the front; the tables above and below are of all." \
        if drawn < counts["count"] else ""  # fmt: skip
    return Page(
        plain(title), f"Study, judged by its {counts['by']}", facts, _share(answers),
        _tiles(answers), STATES[counts["by"]], failures, silent, thinned,
        _effects_lead(answers), [made for each in answers["outputs"] if (made := _effect(each))],
        _front_lead(front, counts["by"]), _front(front, links),
        _worst(answers, links), _sections(answers),
    )  # fmt: skip


def _share(answers: Record) -> YieldShare:
    """Share of the designs that pass with its confidence interval, in words; without an interval
    where the designs are no sample.
    """
    share, by = answers["yield"], answers["designs"]["by"]
    value, interval = share["value"], share["interval"]
    passing = (
        "have no failing must-have check among those evaluated at their depth (screen: open)"
        if by == "screen" else "have the verdict PASS"
    )  # fmt: skip
    name = "Yield" if interval else "Share of the designs"
    if value is None:
        return YieldShare(name, DASH, "No design has a result.", (), None, None)
    sentence = f"{_counted(share['passed'])} of {_counted(share['count'])} designs {passing}."
    lines = []
    if interval:
        low, high = (_percent(end) for end in interval)
        level = _percent(share["confidence"])
        lines.append(
            f"{level} confidence interval {low} to {high} ({share['method']}) of the yield under "
            "the distributions of the study file."
        )
    else:
        lines.append("The designs are chosen, not sampled: the share is no yield.")
    if by == "screen":
        lines.append("A screen is no verdict: checks that the depth cannot judge are left out.")
    if share["without_result"]:
        lines.append(
            f"{_counted(share['without_result'])} designs without a result are left out; "
            f"counted as failing, the share is {_percent(share['passed'] / _whole(share))}."
        )
    if share["dependent"]:
        lines.append(
            f"{_counted(share['dependent'])} designs of the Sobol indices depend on others of the "
            "sample and are left out."
        )
    return YieldShare(name, _percent(value), sentence, lines, value, interval)


def _whole(share: Record) -> int:
    return int(share["count"]) + int(share["without_result"])


def _percent(value: float) -> str:
    """A share, 0 to 1, as text in per cent; not rounded to 0 or 100 unless it is exactly so."""
    shown = f"{100.0 * value:.1f}"
    if shown == "100.0" and value < 1.0:
        shown = "> 99.9"
    if shown == "0.0" and value > 0.0:
        shown = "< 0.1"
    return f"{shown.removesuffix('.0')}\N{NO-BREAK SPACE}%"


def _counted(count: int | None) -> str:
    """A number of designs."""
    return DASH if count is None else f"{count:,}"


def _tiles(answers: Record) -> list[Tile]:
    """Tiles of the page: numbers of designs by outcome, most frequent failure, size of
    the front.
    """
    counts = answers["designs"]
    passing, failing, _ = STATES[counts["by"]]
    depths = ", ".join(f"{_counted(n)} at {words(name)}" for name, n in counts["depth"].items())
    tiles = [
        Tile("Designs", _counted(counts["count"]), depths),
        Tile(f"{counts['by'].capitalize()}: {passing}", _counted(counts["pass"]), ""),
        Tile(f"{counts['by'].capitalize()}: {failing}", _counted(counts["fail"]), ""),
        Tile("Without result", _counted(counts["without_result"]), "refused, timed out or lost"),
    ]
    frequent = next((row for row in answers["failures"] if row["fail"]), None)
    if frequent:
        share = _percent(frequent["fail"] / max(frequent["of"], 1))
        tiles.append(Tile("Most frequent failure", share, frequent["title"]))
    if answers["front"]:
        tiles.append(Tile("Pareto front", _counted(len(answers["front"]["designs"])), "designs"))
    return tiles


def _failures(rows: Sequence[Record]) -> tuple[list[FailureRow], str]:
    """Rows of the first `_FAILURES` checks that fail or lack data in some designs, and a sentence
    on the others.
    """
    absent = [row["title"] for row in rows if not row["fail"] and row["not_evaluated"] >= row["of"]]
    partly = [row for row in rows if row["title"] not in absent]
    made = []
    for row in partly[:_FAILURES]:
        whole = max(row["of"], 1)
        infinite = row["utilisation_max"] is None and row["design"] is not None
        made.append(FailureRow(
            row["title"] if row["must_have"] else f"{row['title']} (optional)",
            min(row["fail"] / whole, 1.0), min(row["not_evaluated"] / whole, 1.0),
            (_counted(row["fail"]), _counted(row["alone"]), _counted(row["not_evaluated"]),
             "∞" if infinite else number(row["utilisation_max"], 3), number(row["design"])),
        ))  # fmt: skip
    silent = ["Checks that pass in every design are not listed."]
    if len(partly) > len(made):
        silent.insert(0, f"{len(partly) - len(made)} further checks are in answers.json.")
    if absent:
        silent.append(f"Not evaluated in any design ({len(absent)}): {'; '.join(absent)}.")
    return made, " ".join(silent)


def _effects_lead(answers: Record) -> str:
    method = (
        "Sobol indices by the sample of Saltelli (SALib), with 95 % intervals by bootstrap: first "
        "order, the share of the variance by the factor alone; total, with all interactions."
        if any(output["sobol"] for output in answers["outputs"])
        else "Factors of a list vary together: an effect may be that of any of them."
        if answers["sampling"] == "list"
        else "First-order shares of the variance are estimated from the sample by levels of each "
        "factor, with 95 % intervals; total indices need the sampling method sobol_indices."
    )
    return (
        "Main effect: mean of the output by level of a factor, over the distribution of all "
        f"others. {method}"
    )


def _effect(output: Record) -> Effect | None:
    """Effects of all factors on one output: bars between the means at the levels of each factor, by
    swing, and its sensitivity indices; None without effects.
    """
    if not output["effects"]:
        return None
    label, unit = titled(output["name"], output["unit"])
    rows = sorted(output["effects"], key=lambda row: -row["swing"])
    least = min(min(row["means"]) for row in rows)
    greatest = max(max(row["means"]) for row in rows)
    width = (greatest - least) or 1.0

    def place(value: float) -> float:
        return min(max((value - least) / width, 0.0), 1.0)

    tornado = []
    for row in rows:
        ends, levels = (min(row["means"]), max(row["means"])), row["levels"]
        first, last = row["means"][0], row["means"][-1]
        span = " … ".join(
            level if isinstance(level, str) else number(level[end], 3)
            for level, end in ((levels[0], 0), (levels[-1], 1))
        )
        tornado.append(TornadoBar(
            row["factor"], span, place(ends[0]), place(ends[1]), place(first), place(last),
            number(row["swing"], 3),
            f"{row['factor']}: mean from {number(ends[0], 3)} to {quantity(ends[1], unit, 3)}",
        ))  # fmt: skip
    if output["sobol"]:
        title = "Sobol indices"
        indices = [
            IndexRow(row["factor"], _index(row, "first"), _index(row, "total"))
            for row in sorted(output["sobol"], key=lambda row: -row["total"])
        ]
    else:
        title = "First-order share of the variance"
        ranked = sorted(output["effects"], key=lambda row: -row["share"])
        indices = [IndexRow(row["factor"], _index(row, "share"), None) for row in ranked]
    span = f"{number(least, 4)} to {quantity(greatest, unit, 4)}"
    whole = f"{label}, {unit}" if unit else label
    return Effect(
        output["name"], whole, span, place(output["mean"]), tornado, title, indices
    )  # fmt: skip


def _index(row: Record, name: str) -> Index:
    """Sensitivity index of a factor, clipped to 0 to 1, with its confidence interval.

    Parameters
    ----------
    row : mapping   indices of the factor and their intervals
    name : str      of the index: ``first``, ``total`` or ``share``
    """
    low, high = row[f"{name}_interval"]
    value = row[name]
    shown, left, right = (min(max(v, 0.0), 1.0) for v in (value, low, high))
    reach = f"±\N{NO-BREAK SPACE}{0.5 * (high - low):.2f}"
    return Index(shown, left, right, f"{value:.2f} {reach}".replace("-", "−"))


def _front_lead(front: Record | None, by: str) -> str:
    """Sentence on the objectives of the Pareto front and on the designs it is taken from.

    Parameters
    ----------
    by : str   by what the designs are judged: screen or verdict
    """
    if front is None:
        return "The study file does not state two objectives."
    names = [f"{titled(o['column'])[0]} ({_GOALS[o['goal']]})" for o in front["objectives"]]
    if not front["designs"]:
        return f"{' against '.join(names)}: no design passes by its {by}."
    return f"{' against '.join(names)}, over the designs that pass by their {by}."


def _front(front: Record | None, links: Mapping[int, str]) -> DesignTable | None:
    """Table of the designs on the Pareto front with their objectives and factors; None without a
    front.
    """
    if front is None or not front["designs"]:
        return None
    objectives = [", ".join(filter(None, titled(o["column"], o["unit"])))
                  for o in front["objectives"]]  # fmt: skip
    factors = list(front["designs"][0]["factors"])
    rows = [
        DesignRow([number(p["design"]), *map(number, p["values"]), *_judged(p, factors)],
                  links.get(p["design"], ""))
        for p in front["designs"]
    ]  # fmt: skip
    head = ["Design", *objectives, "Depth", "Judged", "Governing check", *factors]
    return DesignTable("Designs of the front", head, rows)


def _judged(point: Record, factors: Sequence[str]) -> list[str]:
    return [
        point["depth"], point["verdict"] or f"screen {point['screen']}",
        words(point["governing"]) or DASH, *(number(point["factors"][key]) for key in factors),
    ]  # fmt: skip


def _worst(answers: Record, links: Mapping[int, str]) -> DesignTable | None:
    """Table of one row: the design of greatest utilisation; None where no design has one."""
    worst = answers["worst"]
    if worst is None:
        return None
    factors = list(worst["factors"])
    size = "∞" if worst["utilisation"] is None else number(worst["utilisation"], 4)
    row = DesignRow([number(worst["design"]), size, *_judged(worst, factors)],
                    links.get(worst["design"], ""))  # fmt: skip
    head = ["Design", "Utilisation", "Depth", "Judged", "Governing check", *factors]
    return DesignTable("Worst design", head, [row])


def _sections(answers: Record) -> list[ReportSection]:
    """Sections below the drawings: extremes of the outputs; factors, and messages of designs
    without a result.
    """
    blocks = []
    spread = [
        [titled(o["name"], o["unit"])[0], titled(o["name"], o["unit"])[1] or DASH,
         number(o["least"]["value"]), number(o["least"]["design"]), number(o["median"]),
         number(o["mean"]), number(o["std"], 3), number(o["greatest"]["value"]),
         number(o["greatest"]["design"]), number(o["count"])]
        for o in answers["outputs"] if o["count"] and o["name"] != PASS
    ]  # fmt: skip
    head = ("Output", "Unit", "Least", "at design", "Median", "Mean", "Standard deviation",
            "Greatest", "at design", "Designs")  # fmt: skip
    extremes = ReportSection(
        "extremes",
        "Extremes of the outputs",
        [SectionBlock(Tabular(ReportTable("Extremes", head, spread, 2)))],
    )
    factors = [
        (f["key"], ", ".join(f["values"]) if "values" in f
         else f"{number(f['least'])} to {quantity(f['greatest'], f['unit'])}")
        for f in answers["factors"]
    ]  # fmt: skip
    blocks.append(SectionBlock(Pairs("Factors", factors), "Factors"))
    counts = answers["designs"]
    if counts["messages"]:
        rows = [[shortened(m["message"], 300), _counted(m["count"]), number(m["design"])]
                for m in counts["messages"]]  # fmt: skip
        left = counts["messages_left_out"]
        lead = f"{left} further messages are in the dataset." if left else ""
        blocks.append(SectionBlock(
            Tabular(ReportTable("Messages", ("Message", "Designs", "First"), rows)),
            "Designs without a result", lead,
        ))  # fmt: skip
    return [extremes, ReportSection("inputs", "Factors and messages", blocks)]

"""Contents of a report by section, for page and PDF: text, tables, figures."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from camwright.geometry.errors import CamError
from camwright.pipeline.base.files import Json
from camwright.pipeline.base.verdict import CERTIFIED
from camwright.pipeline.hand_check.hand_sheet import SheetRun
from camwright.pipeline.hand_check.printed_sheet import PrintedSheet, printed
from camwright.pipeline.results.model_limits import MODEL_LIMITS
from camwright.pipeline.results.run_reader import TrialRecord, load_end_words, results_sha256
from camwright.reports import report_tables, verification_tables
from camwright.reports.analysis_sheet import TRIALS
from camwright.reports.check_parts import PARTS
from camwright.reports.figure_svg import Drawn, drawn_groups
from camwright.reports.report_data import ReportMaterial
from camwright.reports.report_tables import (
    DASH,
    STATUS,
    CheckRow,
    InputTable,
    Record,
    ReportTable,
    Status,
    Tile,
    isolated,
    shortened,
)
from camwright.reports.sheet_turn import SheetTurn
from camwright.reports.verdict_text import Verdict, governing_load_case, verdict

if TYPE_CHECKING:
    from camwright.reports.picture_list import Picture

_RUNNING = ("report", "total")
"""Times that are not known yet when the page is written: a page follows from the other files."""
SHORT = 140
"""Maximum number of characters of a title or name on one line."""
TRIALS_HEAD = (
    "Trial", "Smoothing", "Strength", "Width, shaft angle", "Ripple left", "Reason", "Verdict",
    "Required checks not passed",
)  # fmt: skip
WORST_NAMED = 6
"""Failed checks of a trial that its row names."""
MISSING = (
    "A required check without data leaves the verdict INCOMPLETE at best. Describe the part in the "
    "case, or leave it out of the sign-off in [scope]."
)
BAR_WORDS = (
    "The utilisation is that of the worst tolerance corner, the demand that of the nominal design. "
    "The tick on each bar marks the limit; ± is the numerical uncertainty, omitted below the last "
    "digit shown."
)
EVIDENCE = (
    "Evidence: verification of the solution and of the input, which no change of the design "
    "moves. A required one decides the verdict when it fails; none governs."
)
CHECKS_HEAD = ("Check", "Status", "Demand", "Limit", "Utilisation", "Where")


@dataclass(frozen=True)
class Checks:
    """Block: table of checks with utilisation bars, on the page filtered by status and part."""

    kind: ClassVar[str] = "checks"
    head: Sequence[str]
    rows: Sequence[CheckRow]
    label: str
    filtered: bool = False

    @property
    def parts(self) -> list[str]:
        """Parts of the rows, in the order of the force flow."""
        judged = {row.part for row in self.rows}
        return [part for part in PARTS if part in judged]

    @property
    def statuses(self) -> list[Status]:
        """Statuses of the rows, in their order."""
        return list({row.status.id: Status(row.status.id, STATUS[row.status.id])
                     for row in self.rows}.values())  # fmt: skip


@dataclass(frozen=True)
class Tabular:
    """Block: a table."""

    kind: ClassVar[str] = "table"
    table: ReportTable


@dataclass(frozen=True)
class Pairs:
    """Block: names and values in one or two columns; `code`: monospaced values."""

    kind: ClassVar[str] = "pairs"
    label: str
    rows: Sequence[tuple[str, str]]
    columns: int = 1
    code: bool = False


@dataclass(frozen=True, eq=False)
class Figures:
    """Block: figures of the analysis sheet."""

    kind: ClassVar[str] = "figures"
    figures: Sequence[Drawn]


@dataclass(frozen=True, eq=False)
class Pictures:
    """Block: pictures of fields."""

    kind: ClassVar[str] = "pictures"
    pictures: Sequence[Picture]


@dataclass(frozen=True)
class Inputs:
    """Block: sections of the case file."""

    kind: ClassVar[str] = "inputs"
    tables: Sequence[InputTable]


@dataclass(frozen=True)
class Points:
    """Block: list of statements."""

    kind: ClassVar[str] = "points"
    points: Sequence[str]


@dataclass(frozen=True)
class Sheets:
    """Block: hand-check sheets, all on the page, governing ones in the PDF."""

    kind: ClassVar[str] = "sheets"
    sheets: Sequence[PrintedSheet]


@dataclass(frozen=True)
class Note:
    """Block: paragraph in small type."""

    kind: ClassVar[str] = "note"
    text: str


@dataclass(frozen=True)
class Signatures:
    """Block: fields for signatures."""

    kind: ClassVar[str] = "signatures"
    roles: Sequence[str] = ("Prepared", "Checked", "Approved")
    lines: Sequence[str] = ("Name", "Date", "Signature")


Content = (
    Checks | Tabular | Pairs | Figures | Pictures | Inputs | Points | Note | Sheets | Signatures
)


@dataclass(frozen=True, eq=False)
class SectionBlock:
    """Part of a section: title, introduction, block; `narrow` ones stand side by side."""

    content: Content | None
    title: str = ""
    lead: str = ""
    narrow: bool = False


@dataclass(frozen=True, eq=False)
class ReportSection:
    """Section of a report; `brief`: title in the table of contents."""

    id: str
    title: str
    blocks: Sequence[SectionBlock]
    lead: str = ""
    brief: str = ""


@dataclass(frozen=True, eq=False)
class Report:
    """Contents of a report."""

    title: str
    facts: Sequence[tuple[str, str]]
    verdict: Verdict
    tiles: Sequence[Tile]
    sections: Sequence[ReportSection]
    footer: str
    kicker: str = "Cam sign-off"

    @property
    def short_title(self) -> str:
        """The title, cut to one line."""
        return shortened(self.title, SHORT)


def report_content(material: ReportMaterial) -> Report:
    """Contents of the report of a run."""
    # study pages share these tables, without matplotlib
    from camwright.reports.picture_list import pictures

    run = material.run
    final = run.final
    return Report(
        str(material.case.get("title") or run.summary["case"]), _facts(material),
        verdict_of(material),
        report_tables.tiles(run.summary["headline"]),
        (
            _sheet(material), _numbers(material),
            ReportSection(
                "fields", "Stress fields",
                (SectionBlock(Pictures(pictures(material))),),
                brief="Stress fields",
            ),
            _trials(material), _evidence(material),
            ReportSection(
                "inputs", "Inputs and sources",
                (SectionBlock(Inputs(report_tables.input_tables(material.case))),),
                "Resolved case, defaults included.", "Inputs",
            ),
            ReportSection(
                "assumptions", "Assumptions and limitations",
                (SectionBlock(Points([each.statement for each in MODEL_LIMITS])),),
                brief="Assumptions",
            ),
            _checks(material), _sheets(material), _versions(material),
        ),
        f"Camwright · {shortened(str(run.summary['case']), 60)}",
        "Cam sign-off" if final.depth == CERTIFIED else f"Cam, {final.depth} without sign-off",
    )  # fmt: skip


def verdict_of(material: ReportMaterial) -> Verdict:
    """Verdict of a run in sentences."""
    run, final = material.run, material.run.final
    return verdict(
        str(run.verdict or run.screen), final.checks, final.binding,
        titled(str(run.summary["statement"]), final.checks),
        str(run.summary["scope"]["statement"]), final.depth,
        load_end_words(run.summary.get("load_ends", ())),
    )  # fmt: skip


def titled(text: str, checks: Sequence[Record]) -> str:
    """Statement with check ids replaced by titles."""
    titles = {str(check["id"]): f"\u201c{isolated(check['title'])}\u201d" for check in checks}
    return re.sub(r"\b\w+\b", lambda word: titles.get(word.group(), word.group()), text)


def _facts(material: ReportMaterial) -> list[tuple[str, str]]:
    """Identification of the run as pairs (name, value)."""
    summary, count = material.run.summary, len(material.run.trials)
    versions = summary["versions"]
    code = [str(versions.get("camwright", "")), str(versions.get("source", ""))[:8]]
    return [
        ("Case", shortened(str(material.case.get("name") or summary["case"]), SHORT)),
        ("Governing load case", shortened(_governing_load_case(material), SHORT)),
        ("Trials", str(count)),
        ("Input", str(summary["input_sha256"])[:12]),
        ("Camwright", " · ".join(filter(None, code))),
    ]


def _checks(material: ReportMaterial) -> ReportSection:
    """Section with all checks in one table: failed, without data, waived, passed."""
    rows = report_tables.check_rows(material.run.final.checks)
    order = ("fail", "not_evaluated", "waived", "pass")
    rows.sort(key=lambda row: (bool(row.judged_at), order.index(row.status.id),
                               row.evidence, not row.must_have))  # fmt: skip
    return ReportSection(
        "checks",
        "All checks",
        [SectionBlock(Checks(CHECKS_HEAD, rows, "All checks", filtered=True))],
        f"Failed, without data, waived, passed; by decreasing utilisation. {BAR_WORDS} {MISSING} "
        f"{EVIDENCE}",
        "All checks",
    )


def failed_checks(material: ReportMaterial) -> ReportSection:
    """Section of the failed checks, required ones first, without the checks that only a deeper
    solution judges.
    """
    rows = [row for row in report_tables.check_rows(material.run.final.checks) if not row.judged_at]
    groups = (
        ("", [row for row in rows if row.status.id == "fail" and row.must_have]),
        ("Optional and evidence", [row for row in rows if row.status.id == "fail"
                                   and not row.must_have]),
    )  # fmt: skip
    blocks = [
        SectionBlock(Checks(CHECKS_HEAD, part, f"Failed checks: {title or 'required'}"), title)
        for title, part in groups
        if part
    ]
    lead = BAR_WORDS if groups[0][1] else "No required check fails."
    return ReportSection("failed", "Failed checks", blocks, lead)


def _numbers(material: ReportMaterial) -> ReportSection:
    """Section of the key figures of the final trial and of the shaft's speed ripple."""
    summary = material.run.summary
    headline = report_tables.headline_rows(summary["headline"])
    blocks = [SectionBlock(Pairs("Key figures", headline, 2))]
    machine = material.turn.words
    speed = verification_tables.crank_speed(summary["speed"], machine)
    blocks += _tables((speed, f"{machine.title} speed", ""))
    lead = f"Over one turn of the final trial. {_beyond_hertz(material)}".rstrip()
    return ReportSection("numbers", "Key figures", blocks, lead)


def _beyond_hertz(material: ReportMaterial) -> str:
    """What finite elements add to Hertz theory in the final trial, one sentence."""
    return verification_tables.hertz_difference(material.run.final.record["hertz_difference"])


def _governing_load_case(material: ReportMaterial) -> str:
    final = material.run.final
    return governing_load_case(final.checks, final.cycle.load_cases)


def _sheet(material: ReportMaterial) -> ReportSection:
    """Section of the analysis sheet: its figures for the drawn load case, by group, without those
    that compare trials.
    """
    turn = material.turn
    count, others = len(turn.others), ""
    if count > 1:
        whole = turn.load_case == _governing_load_case(material)
        words = "the governing one" if whole else "in which the follower stays on the cam"
        others = f", {words}; ribbons: range of all {count} load cases"
    return ReportSection(
        "sheet", "Cam analysis sheet",
        [SectionBlock(Figures(drawn), title) for title, drawn in drawn_groups(material)
         if title != TRIALS],
        f"Load case {isolated(turn.load_case)}{others}. Dotted line: cam angle of the maximum "
        f"contact pressure. Red dashed lines: limits. {_beyond_hertz(material)}".rstrip(),
    )  # fmt: skip


def _trials(material: ReportMaterial) -> ReportSection:
    """Section that compares the trials, with shadow prices of the limits and prices of the
    machine's numbers.
    """
    run = material.run
    rows = [_trial(*each) for each in zip(run.trials, run.ripples, strict=True)]
    table = ReportTable("Trials", TRIALS_HEAD, rows, 2, 3)
    prices = verification_tables.prices(run.summary["prices"])
    shaft = material.turn.words.shaft
    lead = (
        f"First-order change of the torque ripple at the {shaft}, with losses and jerk where "
        "they are weighted, when a limit is relaxed. Limits not listed are inactive."
    )
    machine = verification_tables.machine_prices(run.summary["machine_prices"])
    machine_lead = (
        f"First-order change of the torque ripple at the {shaft}, with losses and jerk where "
        "they are weighted, when a number of the machine is greater and the lift synthesised "
        "anew: the greatest change would help most. A greater roller keeps the base radius. The "
        "phase of the cam on the shaft has no price: the lift shifts with the torque."
    )
    return ReportSection(
        "trials", "Trials and shadow prices",
        [
            SectionBlock(Tabular(table)),
            *(SectionBlock(Figures(each), "Trials compared")
              for title, each in drawn_groups(material) if title == TRIALS),
            *_tables(
                (prices, "Shadow prices of the limits", lead),
                (machine, "Prices of the numbers of the machine", machine_lead),
            ),
        ],
        "Each trial recomputes all stages from its own lift; "
        f"trial {run.final.number} is the result. Ripple left: standard deviation of the {shaft} "
        "torque with the cam in the design load case.",
        "Trials",
    )  # fmt: skip


def _trial(trial: TrialRecord, ripple: float | None) -> list[str | Status]:
    """Row of a trial in the table of trials; ripple: standard deviation of the torque with the cam,
    N m, see `Run.ripples`.
    """
    record = trial.record
    rows = [row for row in report_tables.check_rows(trial.checks) if row.id in trial.binding]
    width = record["smoothing_width_deg"]
    failing = [f"{row.title} ({row.utilisation})" for row in rows if row.status.id == "fail"]
    unknown = sum(row.status.id == "not_evaluated" for row in rows)
    more = len(failing) - WORST_NAMED
    held = [*failing[:WORST_NAMED], *([f"{more} more fail"] if more > 0 else []),
            *([f"{unknown} without data"] if unknown else [])]  # fmt: skip
    word = str(trial.verdict or trial.screen)
    return [
        str(trial.number), str(record["smoothing_description"]),
        report_tables.number(record["smoothing_strength"], 3),
        report_tables.quantity(width, "deg") if width is not None else DASH,
        report_tables.quantity(ripple, "N m", 3),
        titled(str(record["why"]), trial.checks), Status(word, word.upper()),
        "; ".join(held) or "none",
    ]  # fmt: skip


def _evidence(material: ReportMaterial) -> ReportSection:
    """Section of the numerical evidence: certificate, ends, consistency of the inputs, benchmarks,
    residuals, mesh, times.
    """
    summary, final = material.run.summary, material.run.final
    points = final.record["certificate"]
    method = str(final.record["contact_method"])
    certificate = verification_tables.certificate(points)
    consistency, contradicted = verification_tables.consistency(summary["consistency"])
    benchmarks = verification_tables.benchmarks(summary["benchmarks"])
    mesh = {k: v for k, v in (final.record["mesh"] or {}).items() if k != "sha256"}
    times = [
        (k, report_tables.quantity(v, "s", 3))
        for k, v in summary["timings_s"].items()
        if k not in _RUNNING
    ]
    blocks = [
        SectionBlock(
            Tabular(certificate), "Certificate points",
            "The contact is solved again at these cam angles, with both bodies meshed: at the two "
            "of the greatest pressure on three successively finer meshes, at the others on the two "
            "coarser ones, with the least order observed there. Edges are counted across the "
            "half-width a. Order: of convergence; scatter where none is observed. GCI: grid "
            "convergence index of the finest mesh. Deviation: of the cycle from the extrapolated.",
        ) if certificate.rows else SectionBlock(
            None, "Certificate points", "The final trial has no certificate points."
        ),
        *_tables(
            (verification_tables.certified(points), "Half-width and stresses", ""),
            *verification_tables.of_ends(final.record),
            (
                verification_tables.corners(final.checks), "Tolerance corners",
                "Checks whose demand within the tolerances exceeds the nominal one.",
            ),
            (
                consistency, "Consistency of the inputs",
                "Some inputs contradict each other or are not usual." if contradicted else
                "Each input beside the value that the other inputs imply.",
            ),
            (
                verification_tables.valve_train(summary.get("valve_train")),
                "Machine motion of the valve cam",
                "Equations of Petrescu and Petrescu (2015). Of their systems 1 to 15 only 11 and "
                "15 are published; replacements of the others are marked reconstructed. Their "
                "yield is a shape index, not an efficiency; the efficiency is listed as well.",
            ),
        ),
    ]  # fmt: skip
    measured = verification_tables.measurement(summary.get("measurement"))
    if measured:
        words = (
            "The error bar holds the torque at all crank angles at once with 95 % probability; it "
            "is that of noise and scatter of the cycles, of pitch errors of the wheel and of what "
            "the filter cuts off, with the inertia taken as exact."
        )
        notes = verification_tables.measurement_notes(summary.get("measurement"))
        barred = any("error bar" in title for title, _ in measured)
        blocks.append(SectionBlock(
            Pairs("Measurement", measured), "Measurement",
            " ".join((*((words,) if barred else ()), *notes)), narrow=True,
        ))  # fmt: skip
    if benchmarks:
        blocks.append(SectionBlock(
            Pairs("Benchmarks", benchmarks), "Benchmarks",
            "Relative difference to the reference solution, in the environment of this run.",
            narrow=True,
        ))  # fmt: skip
    blocks += [
        SectionBlock(
            Pairs("Residuals", residuals(material.turn)),
            "Residuals",
            "Maximum over the turn, relative.",
            narrow=True,
        ),
        SectionBlock(Pairs("Mesh", report_tables.named_rows(mesh)), "Mesh", narrow=True)
        if mesh
        else SectionBlock(None, "Mesh", "No mesh quality is recorded.", narrow=True),
        SectionBlock(Pairs("Solver time", times), "Solver time", narrow=True),
    ]
    lead = f"Contact model: {method}. {_beyond_hertz(material)}".rstrip() if method else ""
    lead = f"{lead} {verification_tables.ends_refused(final.record)}".strip()
    return ReportSection("evidence", "Evidence", blocks, lead)


def _sheets(material: ReportMaterial) -> ReportSection:
    """Section of the hand-check sheets, governing ones first; a note with the reason where the run
    has none.
    """
    title = "Hand-check sheets"
    try:
        run = SheetRun(material.run.path, material.run)
        governing = run.governing()
        made = [printed(run.sheet(name), governing=name in governing) for name in run.records]
    except CamError as error:
        note = SectionBlock(Note(f"The sheets are not available: {error}"))
        return ReportSection("hand", title, (note,), brief=title)
    made.sort(key=lambda each: not each.governing)  # stable
    return ReportSection(
        "hand", title, (SectionBlock(Sheets(made)),),
        "The formula of each check, evaluated once more on the numbers of the run. A result of a "
        "solver enters as a stated number.",
        title,
    )  # fmt: skip


def _versions(material: ReportMaterial) -> ReportSection:
    """Section of versions, hashes and fields for signatures."""
    summary = material.run.summary
    kept = (
        f" run.json lists the SHA-256 of {len(summary['files'])} results, whose hash stands above, "
        "signoff.json of all files of this run; camwright check compares them, with "
        "--verify-record the signatures, with --recompute the checks."
    )
    versions = [(str(k), str(v)) for k, v in summary["versions"].items()]
    return ReportSection(
        "versions",
        "Versions and hashes",
        (
            SectionBlock(Pairs("Versions", versions, 2)),
            SectionBlock(Pairs("SHA-256", _hashes(material), code=True), "SHA-256"),
            SectionBlock(Note(f"Record schema {summary['schema']}.{kept}")),
            SectionBlock(Signatures()),
        ),
        brief="Versions",
    )


def _hashes(material: ReportMaterial) -> list[tuple[str, str]]:
    """Pairs (name, SHA-256) of input, results, source and meshes, as far as known."""
    summary, mesh = material.run.summary, material.run.final.record["mesh"]
    meshes = None if mesh is None else mesh.get("sha256")
    digests: dict[str, Json] = {"input": summary["input_sha256"]}
    digests["results"] = results_sha256(summary["files"])
    digests["source"] = summary["versions"].get("source")
    if isinstance(meshes, Mapping):
        digests |= {f"mesh of the {body}": digest for body, digest in meshes.items()}
    return [(name, str(digest)) for name, digest in digests.items() if digest]


def residuals(turn: SheetTurn) -> list[tuple[str, str]]:
    """Greatest relative residual of each equilibrium equation over the turn."""
    names = {
        "residual_equilibrium": "contact pressure and load",
        "residual_complementarity": "contact pressure times gap",
        "residual_guide_force": "transverse forces on the follower",
        "residual_guide_moment": "moments on the follower",
        "residual_friction": "forces along the stem with guide friction",
    }
    return [
        (words, report_tables.number(float(np.max(np.abs(turn.columns[name]))), 2))
        for name, words in names.items()
        if name in turn.columns
    ]


def _tables(*parts: tuple[ReportTable, str, str]) -> list[SectionBlock]:
    """Blocks of the tables that have rows, with title and introduction."""
    return [SectionBlock(Tabular(table), title, lead) for table, title, lead in parts if table.rows]

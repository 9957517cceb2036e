"""What a report says, section by section; the page and the PDF are drawn from it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from camwright.pipeline.results.run_reader import TrialRecord
from camwright.reports import report_tables, verification_tables
from camwright.reports.figure_svg import Drawn, drawn_groups
from camwright.reports.picture_list import PICTURES, Picture
from camwright.reports.report_data import Material
from camwright.reports.report_tables import (
    DASH,
    CheckRow,
    InputTable,
    Status,
    Table,
    Tile,
    isolated,
    shortened,
)
from camwright.reports.sheet_turn import Turn
from camwright.reports.verdict_text import Verdict, verdict

SHORT = 140
"""Characters of a title or name that is to stay on one line."""
TRIALS_HEAD = (
    "Trial", "Smoothing", "Strength", "Width, crank", "Why", "Verdict",
    "Required checks that do not hold",
)  # fmt: skip
CHECKS_HEAD = ("Check", "Status", "Demand", "Limit", "Utilisation", "Where")
ASSUMPTIONS = (
    "The contact is two-dimensional and in plane strain: every slice across the width carries the "
    "same load. Edge stress at its ends, tilt and crowning are not in the numbers.",
    "Both bodies are linear elastic. Where the shakedown or yield check fails, the true stresses "
    "differ from those shown.",
    "Surfaces are smooth, dry and free of traction where the contact is solved. Film, mixed "
    "friction and the stress of traction are closed forms beside it, where the case gives oil, "
    "roughness and friction; they do not feed back. A flat face drags on the follower by the "
    "friction given.",
    "The roller is solid on its hub, unless the case tells of its outer ring and balls. The "
    "ratings of its bearing are taken as the maker states them.",
    "Loads are those of a constant cam speed; the ripple of the engine's speed acts on the elastic "
    "stem alone, where the case gives the crankshaft's inertia.",
    "The camshaft, its bearings and the drive between crank and cam are rigid and without play.",
    "The loads are those of a rigid follower. One mass on an elastic stem, with impacts after a "
    "loss of contact, and the surge of the spring are solved beside them and do not feed back.",
    "Guide friction is of Coulomb's kind with constant coefficients and changes sign with the "
    "direction of motion; it is in balance with guides of finite length and clearance.",
    "Stress at the keyway's corners and at the edge of the bore depends on fillets the case does "
    "not give, and is excluded from every check.",
    "The pressure of Hertz's theory takes both bodies for half-planes; bodies of finite size "
    "differ a little, which is part of the difference shown.",
)


@dataclass(frozen=True)
class Checks:
    """Checks as a table of their own, with bars of utilisation."""

    kind: ClassVar[str] = "checks"
    head: Sequence[str]
    rows: Sequence[CheckRow]
    label: str


@dataclass(frozen=True)
class Tabular:
    """A table."""

    kind: ClassVar[str] = "table"
    table: Table


@dataclass(frozen=True)
class Pairs:
    """Names with their values, in one or two columns; `code` is text for machines."""

    kind: ClassVar[str] = "pairs"
    label: str
    rows: Sequence[tuple[str, str]]
    columns: int = 1
    code: bool = False


@dataclass(frozen=True, eq=False)
class Figures:
    """Plots over the turn, and the outline."""

    kind: ClassVar[str] = "figures"
    figures: Sequence[Drawn]


@dataclass(frozen=True, eq=False)
class Pictures:
    """Rasters of fields."""

    kind: ClassVar[str] = "pictures"
    pictures: Sequence[Picture]


@dataclass(frozen=True)
class Inputs:
    """Sections of the case."""

    kind: ClassVar[str] = "inputs"
    tables: Sequence[InputTable]


@dataclass(frozen=True)
class Points:
    """Statements in a list."""

    kind: ClassVar[str] = "points"
    points: Sequence[str]


@dataclass(frozen=True)
class Note:
    """A remark in small type."""

    kind: ClassVar[str] = "note"
    text: str


@dataclass(frozen=True)
class Signatures:
    """Places to sign."""

    kind: ClassVar[str] = "signatures"
    roles: Sequence[str] = ("Prepared", "Checked", "Approved")
    lines: Sequence[str] = ("Name", "Date", "Signature")


Content = Checks | Tabular | Pairs | Figures | Pictures | Inputs | Points | Note | Signatures


@dataclass(frozen=True, eq=False)
class Block:
    """A part of a section: title and lead, either may be empty, then what is shown.

    Blocks that are `narrow` may stand side by side.
    """

    content: Content | None
    title: str = ""
    lead: str = ""
    narrow: bool = False


@dataclass(frozen=True, eq=False)
class Section:
    """A section of a report; `brief` is its title in the list of contents."""

    id: str
    title: str
    blocks: Sequence[Block]
    lead: str = ""
    brief: str = ""


@dataclass(frozen=True, eq=False)
class Report:
    """All that a report says."""

    title: str
    facts: Sequence[tuple[str, str]]
    verdict: Verdict
    tiles: Sequence[Tile]
    sections: Sequence[Section]
    footer: str
    kicker: str = "Cam sign-off"

    @property
    def short_title(self) -> str:
        """The title on a line of its own."""
        return shortened(self.title, SHORT)


def report_content(material: Material) -> Report:
    """The report of a run."""
    run = material.run
    final = run.final
    statement = titled(str(run.summary.get("statement") or ""), final.checks)
    return Report(
        str(material.case.get("title") or run.summary["case"]), _facts(material),
        verdict(run.verdict, final.checks, final.binding, statement),
        report_tables.tiles(run.summary["headline"]),
        (
            _checks(material), _numbers(material), _sheet(material),
            Section(
                "fields", "Stress field at the worst angle",
                (Block(Pictures([picture for draw in PICTURES for picture in draw(material)])),),
                brief="Stress field",
            ),
            _trials(material), _evidence(material),
            Section(
                "inputs", "Inputs and where they come from",
                (Block(Inputs(report_tables.input_tables(material.case))),),
                "The case as resolved, defaults included.", "Inputs",
            ),
            Section(
                "assumptions", "Assumptions and limitations", (Block(Points(ASSUMPTIONS)),),
                brief="Assumptions",
            ),
            _versions(material),
        ),
        f"Camwright · {shortened(str(run.summary['case']), 60)}",
    )  # fmt: skip


def titled(text: str, checks: Sequence[Mapping[str, Any]]) -> str:
    """A statement with the checks it names by their ids named by their titles."""
    titles = {str(check["id"]): f"\u201c{isolated(check['title'])}\u201d" for check in checks}
    return re.sub(r"\b\w+\b", lambda word: titles.get(word.group(), word.group()), text)


def _facts(material: Material) -> list[tuple[str, str]]:
    """What tells this run from any other, for the head of the page."""
    summary, count = material.run.summary, len(material.run.trials)
    versions = summary["versions"]
    code = [str(versions.get("camwright", "")), str(versions.get("source", ""))[:8]]
    return [
        ("Case", shortened(str(material.case.get("name") or summary["case"]), SHORT)),
        ("Load case drawn", shortened(material.turn.load_case, SHORT)),
        ("Trials", str(count)),
        ("Input", str(summary["input_sha256"])[:12]),
        ("Camwright", " · ".join(filter(None, code))),
    ]


def _checks(material: Material) -> Section:
    """Required checks, then optional ones: first what could not be evaluated, then what fails.

    Of the optional ones, what could not be evaluated comes last.
    """
    rows = report_tables.check_rows(material.run.final.checks)
    required = [row for row in rows if row.must_have]
    pressing = {"not_evaluated": 0, "fail": 1}  # nobody knows how bad an unknown is
    required.sort(key=lambda row: pressing.get(row.status.id, 2))
    optional = [row for row in rows if not row.must_have]
    optional.sort(key=lambda row: row.status.id == "not_evaluated")
    return Section(
        "checks", "Checks",
        [
            Block(Checks(CHECKS_HEAD, part, f"{title} checks"), title)
            for title, part in (("Required", required), ("Optional", optional)) if part
        ],
        "What is required and could not be evaluated comes first, then what fails, then what "
        "holds, each by utilisation. The tick on each bar is the limit; ± is the numerical "
        "uncertainty, left out where it is below the digits shown.",
    )  # fmt: skip


def _numbers(material: Material) -> Section:
    summary = material.run.summary
    headline = report_tables.headline_rows(summary["headline"])
    blocks = [Block(Pairs("Headline numbers", headline, 2))]
    speed = verification_tables.crank_speed(summary.get("speed"))
    blocks += _tables((speed, "Crank speed", ""))
    return Section(
        "numbers", "Headline numbers", blocks, "Over one turn of the final trial.", "Numbers"
    )


def _sheet(material: Material) -> Section:
    turn = material.turn
    count = len(turn.others)
    governs = f", which governs; pale ribbons span all {count} load cases" if count > 1 else ""
    return Section(
        "sheet", "Cam analysis sheet",
        [Block(Figures(drawn), title) for title, drawn in drawn_groups(material)],
        f"Load case {isolated(turn.load_case)}{governs}. The dotted vertical line marks the angle "
        "of the greatest contact pressure; red dashes are limits.",
    )  # fmt: skip


def _trials(material: Material) -> Section:
    run = material.run
    table = Table("Trials", TRIALS_HEAD, [_trial(trial) for trial in run.trials], 2, 2)
    prices = verification_tables.prices(
        run.summary.get("prices") or run.final.record.get("prices")
    )  # fmt: skip
    lead = (
        "By how much the ripple of the crank's torque would change if a limit gave way, to first "
        "order; limits not named here cost nothing."
    )
    return Section(
        "trials", "Trials and prices",
        [Block(Tabular(table)), *_tables((prices, "What the limits cost", lead))],
        "Each trial recomputes every stage from its own lift; the last one is the answer.",
        "Trials",
    )  # fmt: skip


def _trial(trial: TrialRecord) -> list[str | Status]:
    """One row of the trials table."""
    record = trial.record
    rows = [row for row in report_tables.check_rows(trial.checks) if row.id in trial.binding]
    width = record.get("angular_width_deg")
    failing = [f"{row.title} ({row.utilisation})" for row in rows if row.status.id == "fail"]
    unknown = sum(row.status.id == "not_evaluated" for row in rows)
    held = [*failing, *([f"{unknown} not evaluated"] if unknown else [])]
    word = "pass" if trial.verdict == "pass" else "fail"
    return [
        str(trial.number), str(record.get("smoothing") or record.get("smoother") or DASH),
        report_tables.number(record.get("strength"), 3),
        report_tables.quantity(width, "deg") if width is not None else DASH,
        titled(str(record.get("why") or ""), trial.checks), Status(word, word),
        "; ".join(held) or "none",
    ]  # fmt: skip


def _evidence(material: Material) -> Section:
    summary, final = material.run.summary, material.run.final
    points = final.record.get("certificate") or ()
    method = str(final.record.get("contact_method") or "")
    certificate = verification_tables.certificate(points)
    consistency, contradicted = verification_tables.consistency(summary.get("consistency"))
    benchmarks = verification_tables.benchmarks(summary.get("benchmarks"))
    mesh = {k: v for k, v in (final.record.get("mesh") or {}).items() if k != "sha256"}
    times = [(k, report_tables.quantity(v, "s", 3)) for k, v in summary["timings_s"].items()]
    blocks = [
        Block(
            Tabular(certificate), "Certificate points",
            "The contact solved again, both bodies meshed for the one angle, on three "
            "successively finer meshes. Edges are counted across the half-width a. The order is "
            "the one observed, left out where values scatter instead of converging; GCI is the "
            "grid convergence index of the finest mesh; the spread is the cycle's pressure "
            "against the extrapolated one.",
        ) if certificate.rows else Block(
            None, "Certificate points", "This trial has no certificate points."
        ),
        *_tables(
            (verification_tables.certified(points), "Other quantities at these angles", ""),
            (
                verification_tables.corners(final.checks), "Tolerance corners",
                "Where a check asks for more within the tolerances of the case than at its "
                "nominal values.",
            ),
            (
                consistency, "Whether the inputs agree",
                "Some inputs contradict what the others imply." if contradicted else
                "Each quantity as given, beside what the other inputs imply of it.",
            ),
            (
                verification_tables.valve_train(summary.get("valve_train")),
                "Machine motion of the valve cam",
                "As Petrescu and Petrescu (2015) study it. Their systems 1 to 15 are lost but for "
                "11 and 15: what stands in for the others is marked reconstructed. Their yield is "
                "a shape index, no efficiency; the true one stands beside it.",
            ),
        ),
    ]  # fmt: skip
    if benchmarks:
        blocks.append(Block(
            Pairs("Benchmarks", benchmarks), "Benchmarks",
            "Solved in the environment of this run, off the known answer by", narrow=True,
        ))  # fmt: skip
    blocks += [
        Block(Pairs("Residuals", residuals(material.turn)), "Residuals",
              "Relative, greatest over the turn.", narrow=True),
        Block(Pairs("Mesh", report_tables.named_rows(mesh)), "Mesh", narrow=True) if mesh else
        Block(None, "Mesh", "No mesh quality is recorded.", narrow=True),
        Block(Pairs("Solver time", times), "Solver time", narrow=True),
    ]  # fmt: skip
    lead = f"Contact at every angle: {method}." if method else ""
    return Section("evidence", "Evidence", blocks, lead)


def _versions(material: Material) -> Section:
    summary = material.run.summary
    hashed = len(summary.get("files") or ())
    kept = (
        f" run.json holds the hashes of {hashed} files of this run, signoff.json those of all; "
        "camwright check --verify-record compares them." if hashed else ""
    )  # fmt: skip
    versions = [(str(k), str(v)) for k, v in summary["versions"].items()]
    return Section(
        "versions", "Versions and hashes",
        (
            Block(Pairs("Versions", versions, 2)),
            Block(Pairs("SHA-256", _hashes(material), code=True), "SHA-256"),
            Block(Note(f"Record schema {summary['schema']}.{kept}")), Block(Signatures()),
        ), brief="Versions",
    )  # fmt: skip


def _hashes(material: Material) -> list[tuple[str, str]]:
    """SHA-256 of what went in and of what was solved on."""
    summary, mesh = material.run.summary, material.run.final.record.get("mesh") or {}
    meshes = mesh.get("sha256") if isinstance(mesh.get("sha256"), Mapping) else {}
    found = {"input": summary["input_sha256"], "source": summary["versions"].get("source")}
    found |= {f"mesh of the {body}": digest for body, digest in (meshes or {}).items()}
    return [(name, str(digest)) for name, digest in found.items() if digest]


def residuals(turn: Turn) -> list[tuple[str, str]]:
    """Greatest relative residual of each balance over the turn drawn."""
    names = {
        "residual_equilibrium": "contact pressures against the load",
        "residual_complementarity": "pressure times gap",
        "residual_guide_force": "forces on the follower",
        "residual_guide_moment": "moments on the follower",
        "residual_friction": "forces along the stem, friction of the guides among them",
    }
    return [
        (words, report_tables.number(float(np.max(np.abs(turn.columns[name]))), 2))
        for name, words in names.items()
        if name in turn.columns
    ]


def _tables(*parts: tuple[Table, str, str]) -> list[Block]:
    """Blocks of those tables that have rows, with title and lead."""
    return [Block(Tabular(table), title, lead) for table, title, lead in parts if table.rows]

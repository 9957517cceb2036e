"""One self-contained page from a run folder; nothing is solved again."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.results.run_reader import TrialRecord
from camwright.reports import interactive, report_tables, verification_tables
from camwright.reports.figure_svg import drawn_groups
from camwright.reports.picture_list import PICTURES
from camwright.reports.report_data import Material
from camwright.reports.sheet_turn import Turn
from camwright.reports.verdict_text import verdict

PAGE = "8_report.html"
LONG = 700
UNPRINTABLE = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
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


def write(material: Material) -> list[Path]:
    """Write ``8_report.html``."""
    return [write_atomic(material.folder / PAGE, text(material))]


def text(material: Material, *, live: bool = True) -> bytes:
    """The page in UTF-8; its plots answer to the pointer when `live`."""
    figures = [drawn.figure for _, group in drawn_groups(material) for drawn in group]
    shown = context(material) | {"live": interactive.bundle(figures) if live else None}
    page: str = environment().get_template("report.html").render(shown)
    return page.encode("utf-8", "replace")


def titled(text: str, checks: Sequence[Mapping[str, Any]]) -> str:
    """A statement with the checks it names by their ids named by their titles."""
    titles = {str(check["id"]): f"\u201c{check['title']}\u201d" for check in checks}
    return re.sub(r"\b\w+\b", lambda word: titles.get(word.group(), word.group()), text)


def context(material: Material) -> dict[str, Any]:
    """Everything the template prints."""
    run, case, turn = material.run, material.case, material.turn
    summary, final = run.summary, run.final
    headline, mesh = summary["headline"], final.record.get("mesh") or {}
    statement = titled(str(summary.get("statement") or ""), final.checks)
    return {
        "case": case,
        "name": str(case.get("name") or summary["case"]),
        "title": str(case.get("title") or summary["case"]),
        "verdict": verdict(run.verdict, final.checks, final.binding, statement),
        "tiles": report_tables.tiles(headline),
        "headline": report_tables.headline_rows(headline),
        "facts": _facts(material),
        "checks": _grouped(report_tables.check_rows(final.checks)),
        "groups": drawn_groups(material),
        "load_case": turn.load_case,
        "load_cases": len(turn.others),
        "trials": [_trial(trial) for trial in run.trials],
        "prices": verification_tables.prices(summary.get("prices") or final.record.get("prices")),
        "pictures": [picture for draw in PICTURES for picture in draw(material)],
        "certificate_head": report_tables.CERTIFICATE_HEAD,
        "certificate": report_tables.certificate_rows(final.record.get("certificate") or ()),
        "figures_head": report_tables.FIGURES_HEAD,
        "certified": report_tables.certified_rows(final.record.get("certificate") or ()),
        "benchmarks": verification_tables.benchmarks(summary.get("benchmarks")),
        "corners": verification_tables.corners(final.checks),
        "consistency": verification_tables.consistency(summary.get("consistency")),
        "crank_speed": verification_tables.crank_speed(summary.get("speed")),
        "valve_train": verification_tables.valve_train(summary.get("valve_train")),
        "mesh": report_tables.named_rows({k: v for k, v in mesh.items() if k != "sha256"}),
        "method": str(final.record.get("contact_method") or ""),
        "residuals": residuals(turn),
        "inputs": report_tables.input_tables(case),
        "assumptions": ASSUMPTIONS,
        "versions": [(str(k), str(v)) for k, v in summary["versions"].items()],
        "timings": [
            (k, report_tables.quantity(v, "s", 3)) for k, v in summary["timings_s"].items()
        ],
        "hashes": _hashes(summary, mesh),
        "hashed": len(summary.get("files") or ()),
        "schema": summary["schema"],
    }  # fmt: skip


def _facts(material: Material) -> list[tuple[str, str]]:
    """What tells this run from any other, for the head of the page."""
    summary, count = material.run.summary, len(material.run.trials)
    versions = summary["versions"]
    code = [str(versions.get("camwright", "")), str(versions.get("source", ""))[:8]]
    return [
        ("Case", str(material.case.get("name") or summary["case"])),
        ("Load case drawn", material.turn.load_case),
        ("Trials", str(count)),
        ("Input", str(summary["input_sha256"])[:12]),
        ("Camwright", " · ".join(filter(None, code))),
    ]


def _grouped(
    rows: Sequence[report_tables.CheckRow],
) -> list[tuple[str, list[report_tables.CheckRow]]]:
    """Required checks, then optional ones: first what could not be evaluated, then what fails.

    Of the optional ones, what could not be evaluated comes last.
    """
    required = [row for row in rows if row.must_have]
    pressing = {"not_evaluated": 0, "fail": 1}  # nobody knows how bad an unknown is
    required.sort(key=lambda row: pressing.get(row.status, 2))
    optional = [row for row in rows if not row.must_have]
    optional.sort(key=lambda row: row.status == "not_evaluated")
    return [
        (title, part) for title, part in (("Required", required), ("Optional", optional)) if part
    ]


def _hashes(summary: Mapping[str, Any], mesh: Mapping[str, Any]) -> list[tuple[str, str]]:
    """SHA-256 of what went in and of what was solved on."""
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


def _trial(trial: TrialRecord) -> dict[str, Any]:
    """One row of the trials table."""
    record = trial.record
    rows = [row for row in report_tables.check_rows(trial.checks) if row.id in trial.binding]
    width = record.get("angular_width_deg")
    return {
        "number": trial.number,
        "smoothing": str(record.get("smoothing") or record.get("smoother") or report_tables.DASH),
        "width": report_tables.quantity(width, "deg") if width is not None else report_tables.DASH,
        "strength": report_tables.number(record.get("strength"), 3),
        "why": titled(str(record.get("why") or ""), trial.checks),
        "passed": trial.verdict == "pass",
        "failing": [(row.title, row.utilisation) for row in rows if row.status == "fail"],
        "unknown": sum(row.status == "not_evaluated" for row in rows),
    }  # fmt: skip


def environment() -> Environment:
    """The templates, what they print escaped."""
    made = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates"), autoescape=True,
        undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    made.filters["plain"] = plain
    made.filters["cut"] = partial(shortened, length=140)
    made.globals["LONG"] = LONG
    return made


def plain(text: object) -> str:
    """Text without the control characters that HTML cannot hold; everything else stays."""
    return UNPRINTABLE.sub("\ufffd", str(text))


def shortened(text: str, length: int) -> str:
    """One line of at most `length` characters."""
    line = " ".join(plain(text).split())
    return line if len(line) <= length else line[: length - 1] + "…"

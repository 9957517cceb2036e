"""One self-contained page from a run folder; nothing is solved again."""

from __future__ import annotations

import html
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from geometry.errors import ResultError
from pipeline.results import Run, TrialRecord, load_run
from reports import browser, interactive, tables
from reports.figures import Figure
from reports.output import write_whole
from reports.pictures import Picture, drawn_pictures
from reports.plots import svg_and_png
from reports.sheet import Turn, figures
from reports.verdict import governing_load_case, verdict

PAGE = "8_report.html"
LONG = 700
UNPRINTABLE = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
GROUPS = (
    ("Torque", ("torque", "torque-components", "crank-speed")),
    ("Shape", ("outline", "pressure-angle", "lift", "radii")),
    ("Contact", ("pressure", "half-width", "stress")),
    ("Forces and guides", ("normal-force", "forces", "guides", "jamming", "speed")),
    ("Parts", ("bushes", "elastic", "parts")),
)
ASSUMPTIONS = (
    "The contact is two-dimensional and in plane strain: every slice across the width carries the "
    "same load. Edge stress at the ends of the roller, tilt and crowning are not in the numbers.",
    "Both bodies are linear elastic. Where the shakedown or yield check fails, the true stresses "
    "differ from those shown.",
    "Surfaces are smooth and dry of film: roughness, lubrication and traction on the contact are "
    "left out. The roller turns freely.",
    "Cam speed is constant over the turn; the engine's own speed ripple does not act on the "
    "follower.",
    "The camshaft, its bearings and the drive between crank and cam are rigid and without play.",
    "Follower and roller move as one rigid mass. Spring surge, vibration and impacts after a loss "
    "of contact are left out.",
    "Guide friction is of Coulomb's kind with constant coefficients and changes sign with the "
    "direction of motion.",
    "Stress at the keyway's corners and at the edge of the bore depends on fillets the case does "
    "not give, and is excluded from every check.",
    "The pressure of Hertz's theory takes both bodies for half-planes; a roller of finite size "
    "differs a little, which is part of the difference shown.",
)


@dataclass(frozen=True)
class Drawn:
    """A sheet figure with its SVG."""

    figure: Figure
    svg: Markup


def build(folder: Path) -> Path:
    """Rebuild ``8_report.html`` and ``figures/*.png`` from the run folder alone.

    Returns
    -------
    page : Path

    Raises
    ------
    ResultError
        If the folder does not hold a finished run, or the page cannot be written.
    """
    folder = Path(folder)
    run = load_run(folder)
    case = _case(run)
    turn = the_turn(run, case)
    try:
        (folder / "figures").mkdir(exist_ok=True)
        groups = _drawn(turn, folder / "figures")
        pictures = drawn_pictures(turn, run.final.path, folder)
        text = _environment().get_template("report.html").render(
            context(run, case, turn, groups, pictures)
            | {"live": interactive.bundle(d.figure for _, drawn in groups for d in drawn)}
        )  # fmt: skip
        write_whole(folder / PAGE, text.encode("utf-8", "replace"))
    except OSError as error:
        raise ResultError(f"{folder}: {error.strerror or error}") from None
    return folder / PAGE


def printed(page: Path, name: str) -> Path:
    """Print the page to A4 beside it, with page numbers, by a headless Chromium.

    Raises
    ------
    ResultError
        If no Chromium is there, or the file cannot be written.
    """
    pdf = page.with_suffix(".pdf")
    browser.print_pdf(page, pdf, html.escape(f"Camwright · {shortened(name, 60)}"))
    return pdf


def the_turn(run: Run, case: Mapping[str, Any]) -> Turn:
    """What the sheet draws: the load case that governs, in the final trial."""
    final = run.final
    names = [str(name) for name in dict.fromkeys(final.cycle["load_case"].tolist())]
    if not names:
        raise ResultError(f"{final.path}: the cycle has no rows")
    by_name = {name: _numbers(final.cycle.where("load_case", name).columns) for name in names}
    drawn = governing_load_case(final.checks, names)
    return Turn(
        by_name[drawn], tuple(by_name.values()), final.lift.columns, final.contour.columns,
        None if run.torque is None else run.torque.columns, final.checks, case, drawn,
        None if run.speed is None else run.speed.columns,
    )  # fmt: skip


def _numbers(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: values for name, values in columns.items() if values.dtype.kind == "f"}


def _case(run: Run) -> dict[str, Any]:
    try:
        return tomllib.loads(run.case_text)
    except tomllib.TOMLDecodeError as error:
        raise ResultError(f"{run.path / 'case.toml'}: {error}") from None


def titled(text: str, checks: Sequence[Mapping[str, Any]]) -> str:
    """A statement with the checks it names by their ids named by their titles."""
    titles = {str(check["id"]): f"\u201c{check['title']}\u201d" for check in checks}
    return re.sub(r"\b\w+\b", lambda word: titles.get(word.group(), word.group()), text)


def context(
    run: Run, case: Mapping[str, Any], turn: Turn, groups: list[tuple[str, list[Drawn]]],
    pictures: list[Picture],
) -> dict[str, Any]:  # fmt: skip
    """Everything the template prints."""
    summary, final = run.summary, run.final
    headline = summary["headline"]
    statement = titled(str(summary.get("statement") or ""), final.checks)
    return {
        "case": case,
        "name": str(case.get("name") or summary["case"]),
        "title": str(case.get("title") or summary["case"]),
        "verdict": verdict(run.verdict, final.checks, final.binding, statement),
        "tiles": tables.tiles(headline),
        "headline": tables.headline_rows(headline),
        "checks": tables.check_rows(final.checks),
        "groups": groups,
        "load_case": turn.load_case,
        "load_cases": len(turn.others),
        "trials": [_trial(trial) for trial in run.trials],
        "pictures": pictures,
        "certificate_head": tables.CERTIFICATE_HEAD,
        "certificate": tables.certificate_rows(final.record.get("certificate") or ()),
        "figures_head": tables.FIGURES_HEAD,
        "certified": tables.certified_rows(final.record.get("certificate") or ()),
        "mesh": tables.named_rows(final.record.get("mesh") or {}),
        "method": str(final.record.get("contact_method") or ""),
        "residuals": residuals(turn),
        "inputs": tables.input_tables(case),
        "assumptions": ASSUMPTIONS,
        "versions": [(str(k), str(v)) for k, v in summary["versions"].items()],
        "timings": [(k, tables.quantity(v, "s", 3)) for k, v in summary["timings_s"].items()],
        "sha": str(summary["input_sha256"]),
        "schema": summary["schema"],
    }  # fmt: skip


def residuals(turn: Turn) -> list[tuple[str, str]]:
    """Greatest relative residual of each balance over the turn drawn."""
    names = {
        "residual_equilibrium": "contact pressures against the load",
        "residual_complementarity": "pressure times gap",
        "residual_guide_force": "forces on the follower",
        "residual_guide_moment": "moments on the follower",
    }
    return [
        (words, tables.number(float(np.max(np.abs(turn.columns[name]))), 2))
        for name, words in names.items()
        if name in turn.columns
    ]


def _trial(trial: TrialRecord) -> dict[str, Any]:
    """One row of the trials table."""
    record = trial.record
    failing = [
        row for row in tables.check_rows(trial.checks) if row.id in trial.binding
    ]  # fmt: skip
    width = record.get("angular_width_deg")
    return {
        "number": trial.number,
        "smoothing": str(record.get("smoothing") or record.get("smoother") or tables.DASH),
        "width": tables.quantity(width, "deg") if width is not None else tables.DASH,
        "strength": tables.number(record.get("strength"), 3),
        "why": str(record.get("why") or ""),
        "passed": trial.verdict == "pass",
        "failing": [(row.title, row.utilisation) for row in failing],
    }  # fmt: skip


def _drawn(turn: Turn, folder: Path) -> list[tuple[str, list[Drawn]]]:
    """Figures by group, drawn to `folder` and as SVG."""
    by_id = {figure.id: figure for figure in figures(turn)}
    groups = []
    for title, ids in GROUPS:
        drawn = [
            Drawn(by_id[i], Markup(svg_and_png(by_id[i], folder / f"{i}.png")))  # noqa: S704
            for i in ids
            if i in by_id
        ]
        if drawn:
            groups.append((title, drawn))
    return groups


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates"), autoescape=True,
        undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters["plain"] = plain
    environment.filters["cut"] = partial(shortened, length=140)
    environment.globals["LONG"] = LONG
    return environment


def plain(text: object) -> str:
    """Text without the control characters that HTML cannot hold; everything else stays."""
    return re.sub(
        r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", "\ufffd", str(text)
    )


def shortened(text: str, length: int) -> str:
    """One line of at most `length` characters."""
    line = " ".join(plain(text).split())
    return line if len(line) <= length else line[: length - 1] + "…"

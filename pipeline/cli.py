"""The command `camwright`: arguments in, exit code out. Nothing imports this module.

Heavy modules are imported by the command that needs them, so that ``--version`` answers at once.
"""

from __future__ import annotations

import json
import math
import os
import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from rich.console import Console

from geometry.errors import CamError, InputError, ResultError
from pipeline.progress import Bars, Lines, Progress

if TYPE_CHECKING:
    from pipeline.results import Run

# The work is parallel by processes; set before numpy is imported, it also fixes the sums' order.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

PASSED, FAILED, ERROR, INTERRUPTED = 0, 1, 2, 130
TEMPLATE_SUFFIX = ".toml"

app = typer.Typer(
    name="camwright",
    help="From engine torque to a balancing cam with a verdict.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
_out = Console(highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 180)
_err = Console(stderr=True, highlight=False, soft_wrap=True)

CaseArgument = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML).")]
DirArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Run folder.")]
NoCacheOption = Annotated[
    bool, typer.Option("--no-cache", help="Neither read nor write what is kept between runs.")
]


_COMPARED = (
    ("residual_std_Nm", "N m std left"),
    ("pressure_angle_max_deg", "deg"),
    ("lift_max_mm", "mm lift"),
    ("normal_force_max_N", "N"),
    ("p0_max_MPa", "MPa"),
)


def main() -> NoReturn:
    """Entry point: every error becomes one line and an exit code."""
    arguments = [argument for argument in sys.argv[1:] if argument != "--debug"]
    signal.signal(signal.SIGTERM, _as_interrupt)
    try:
        code = app(args=arguments, standalone_mode=False)
    except typer.Exit as leaving:
        code = leaving.exit_code
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:
        if "--debug" in sys.argv:
            raise
        _say(_describe(error))
        code = ERROR
    if code == INTERRUPTED:  # however the parser hands an interrupt on
        running = arguments[:1] == ["run"]
        _say("interrupted" + ("; the same command with --resume goes on" if running else ""))
    sys.exit(code if isinstance(code, int) else PASSED)


def _describe(error: Exception) -> str:
    usage = getattr(error, "format_message", None)  # the parser's own; its class has no fixed home
    if usage is not None:
        return _one_line(f"{usage()} (--help shows the usage)")
    if isinstance(error, CamError):
        return _one_line(str(error))
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return _one_line(f"{place}{error.strerror or error}")
    kind = type(error).__name__
    return f"unexpected {kind}: {_one_line(str(error))} (--debug shows where)"


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _say(text: str) -> None:
    print(f"camwright: {text}", file=sys.stderr)  # noqa: T201 - rich would read markup in it


def _as_interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _version(wanted: bool) -> None:
    if wanted:
        import importlib.metadata

        _out.print(f"camwright {importlib.metadata.version('camwright')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001 - the callback acts
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show and leave.")
    ] = False,
    debug: Annotated[  # noqa: ARG001 - `main` acts
        bool, typer.Option("--debug", help="Show where an unexpected error arose.")
    ] = False,
) -> None:
    """From engine torque to a balancing cam with a verdict."""
    if context.invoked_subcommand is None:
        _out.print(context.get_help(), markup=False)


@app.command()
def run(
    case: CaseArgument,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where the run is to lie.")],
    positions: Annotated[
        int | None, typer.Option(help="Positions per cam turn, instead of the case's.")
    ] = None,
    jobs: Annotated[int | None, typer.Option(help="Processes; all cores by default.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on after an interruption.")] = False,
    replace: Annotated[
        bool, typer.Option("--replace", help="Write over an earlier run of a case of this name.")
    ] = False,
    no_cache: NoCacheOption = False,
) -> int:
    """Run a case: torque, lift, contour, mesh, contact, checks, report."""
    from pipeline.case import load_case_file

    _use_cache(not no_cache)
    if jobs is not None and not 1 <= jobs <= 256:
        raise InputError("--jobs", jobs, ">= 1 and <= 256")
    design = load_case_file(case)
    if positions is not None:
        design = design.with_positions(positions)
    if not (resume and _finished(out, design.sha256)):
        from pipeline.run import run_case
        from pipeline.run_folder import set_aside

        old = set_aside(out, design) if replace else nullcontext()
        with old, _progress() as progress:
            run_case(design, out, positions=positions, jobs=jobs, resume=resume, progress=progress)
    from pipeline.results import read_verdict

    _show(read_verdict(out), out)
    return PASSED


@app.command()
def check(
    target: Annotated[Path, typer.Argument(metavar="DIR|CASE", help="Run folder or case file.")],
    as_json: Annotated[bool, typer.Option("--json", help="The checks as JSON.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write JUnit XML for CI.")
    ] = None,
    baseline: Annotated[
        Path | None, typer.Option("--baseline", metavar="DIR", help="Compare with an earlier run.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option("--only", help='Ids or patterns such as "bush_*".')
    ] = None,
    fail_on: Annotated[
        str, typer.Option("--fail-on", help="must, open (also not evaluated), any, never.")
    ] = "must",
    verify_record: Annotated[
        bool, typer.Option("--verify-record", help="Compare the files with signoff.json.")
    ] = False,
) -> int:
    """Verdict of a finished run, from its folder alone: exit 0 passed, 1 failed, 2 error.

    Of a case file: its checks by closed forms, a look ahead that never passes.
    """
    from pipeline.check_command import failing, selected
    from pipeline.check_command import junit as junit_text

    if verify_record and not _as_signed(target):
        return FAILED
    is_case = target.is_file()
    document = _checked_case(target) if is_case else _checked_run(target)
    document["checks"] = list(selected(document["checks"], only or ()))
    failed = failing(document["checks"], fail_on)
    if baseline is not None:
        from pipeline.baseline import changes

        document["changes"] = changes(_comparable(baseline, only or ()), document["checks"])
    if junit is not None:
        from pipeline.run_folder import write_atomic

        write_atomic(junit, junit_text(document["checks"], document["case"], fail_on))
    if as_json:
        print(json.dumps(document, indent=2, ensure_ascii=False))  # noqa: T201 - not to be wrapped
    else:
        _show(document, None if is_case else target)
    return FAILED if failed else PASSED


def _comparable(folder: Path, only: Iterable[str]) -> list[dict[str, Any]]:
    """Checks of an earlier run, those that a pattern names."""
    from pipeline.check_command import fits
    from pipeline.results import read_verdict

    return [record for record in read_verdict(folder)["checks"] if fits(record, only)]


def _as_signed(folder: Path) -> bool:
    """Whether the files are those that were signed off; names each that is not."""
    from pipeline import signoff

    changed = signoff.changes(folder)
    for line in changed:
        _say(f"{folder / line}")
    return not changed


def _checked_run(folder: Path) -> dict[str, Any]:
    from pipeline.results import read_verdict, verify_run
    from pipeline.signoff import LIMITATIONS, SINGULARITIES

    verify_run(folder)
    spoken = {"limitations": list(LIMITATIONS), "singularities": list(SINGULARITIES)}
    return read_verdict(folder) | spoken


def _checked_case(path: Path) -> dict[str, Any]:
    from pipeline.case import load_case_file
    from pipeline.checks.verdict import binding
    from pipeline.preview import closed_form_checks

    case = load_case_file(path)
    checks = closed_form_checks(case)
    return {
        "case": case.name,
        "input_sha256": case.sha256,
        "verdict": "fail",
        "binding": list(binding(checks)),
        "look_ahead": True,
        "checks": [one.as_record() for one in checks],
    }


@app.command()
def compare(
    case: CaseArgument,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Write table, figure and page.")
    ] = None,
) -> int:
    """Every smoother on the same case, by closed forms: ripple left, forces, verdict."""
    from pipeline.case import load_case_file
    from pipeline.smoothing.comparison import compared
    from pipeline.trial import engine_torques
    from reports import smoothers

    design = load_case_file(case)
    found = list(compared(design, engine_torques(design)))
    rows = [{"smoother": one.smoother, "words": one.words, **one.record} for one in found]
    for row in rows:
        shown = [f"{row[n]:.4g} {u}" for n, u in _COMPARED if row.get(n) is not None]
        line = f"{row['smoother']} ({row['words']}): {', '.join(shown)}; {row['verdict']}"
        _out.print(line, markup=False)
    if out is not None:
        lifts = {
            one.smoother if one.smoother == "constrained" else one.words: one.lift.values
            for one in found
            if one.lift is not None
        }
        page = smoothers.write(out, f"{design.name}: smoothers compared", rows, lifts)
        _out.print(f"page: {page}", markup=False)
    return PASSED


@app.command()
def contact(
    r1: Annotated[str, typer.Option(help="Radius of body 1, mm; inf: flat, negative: hollow.")],
    r2: Annotated[str, typer.Option(help="Radius of body 2, likewise.")],
    e1: Annotated[str, typer.Option(help="Young's modulus of body 1, MPa.")],
    nu1: Annotated[float, typer.Option(help="Poisson ratio of body 1.")],
    e2: Annotated[str | None, typer.Option(help="Of body 2; that of body 1 by default.")] = None,
    nu2: Annotated[float | None, typer.Option(help="Of body 2; likewise.")] = None,
    line_load: Annotated[str | None, typer.Option(help="Load over width, N/mm.")] = None,
    load: Annotated[str | None, typer.Option(help="Load, N, with --width.")] = None,
    width: Annotated[str | None, typer.Option(help="Width of the contact, mm.")] = None,
    friction: Annotated[float, typer.Option(help="Of full sliding, over the pressure.")] = 0.0,
    approach: Annotated[bool, typer.Option("--approach", help="Of the centres as well.")] = False,
    depth1: Annotated[str | None, typer.Option(help="Approach of this depth, mm.")] = None,
    depth2: Annotated[str | None, typer.Option(help="Likewise, in body 2.")] = None,
    field: Annotated[
        Path | None, typer.Option(metavar="FILE.vtu", help="Write the stress of body 1.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The figures as JSON.")] = False,
    no_cache: NoCacheOption = False,
) -> int:
    """Two cylinders in line contact: Hertz beside finite elements with an error bar.

    Every quantity may carry a unit, such as "12.5 mm", "210 GPa", "80 kN/m".
    """
    from pipeline.contact_command import Asked, lines, solved

    _use_cache(not no_cache)
    asked = Asked(r1, r2, e1, e2, nu1, nu2, line_load, load, width, friction, depth1, depth2)
    document = solved(asked, with_approach=approach, field=field)
    if as_json:
        print(json.dumps(document, indent=2, ensure_ascii=False))  # noqa: T201 - not to be wrapped
    else:
        for line in lines(document):
            _out.print(line, markup=False)
    return PASSED


@app.command()
def report(
    folder: DirArgument,
    pdf: Annotated[bool, typer.Option("--pdf", help="Print it as 8_report.pdf as well.")] = False,
    show: Annotated[bool, typer.Option("--open", help="Show the page when it is there.")] = False,
) -> int:
    """Write the report of a finished run again; nothing is solved."""
    from reports import page

    found = _load(folder)
    made = page.build(folder)
    _out.print(f"report: {made}", markup=False)
    if pdf:
        _out.print(f"pdf: {page.printed(made, str(found.summary['case']))}", markup=False)
    if show:
        import webbrowser

        webbrowser.open(made.resolve().as_uri())
    return PASSED


@app.command()
def validate(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Where the page is to lie.")
    ] = Path(),
) -> int:
    """Run the papers' studies again; write validation.html and validation.json."""
    from pipeline.results import json_text
    from pipeline.run_folder import write_atomic
    from pipeline.validation import validate as studies
    from reports.validation_page import page

    document = studies()
    write_atomic(out / "validation.json", json_text(document) + "\n")
    write_atomic(out / "validation.html", page(document))
    counts = ", ".join(f"{name} {number}" for name, number in document["counts"].items())
    _out.print(f"{len(document['rows'])} published figures: {counts}", markup=False)
    _out.print(f"page: {out / 'validation.html'}", markup=False)
    return PASSED


@app.command("compare-mechanisms")
def compare_mechanisms(
    case: Annotated[Path, typer.Argument(metavar="CASE", help="Case of a comparison (TOML).")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Where the figures are to lie.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The figures as JSON.")] = False,
) -> int:
    """Slider-crank against eccentric cam: friction by pair, slip, inertia, workspaces."""
    from pipeline.mechanism.comparison import compared, lines
    from reports import mechanisms

    document = compared(case)
    if as_json:
        print(json.dumps(document, indent=2, ensure_ascii=False))  # noqa: T201 - not to be wrapped
    else:
        for line in lines(document):
            _out.print(line, markup=False)
    folder = Path(f"{document['case']}_figures") if out is None else out
    drawn = mechanisms.draw(document, folder)
    if not as_json:
        _out.print(f"figures: {', '.join(path.name for path in drawn)} in {folder}", markup=False)
    return PASSED


@app.command()
def inspect(
    folder: DirArgument,
    measured: Annotated[
        Path, typer.Argument(metavar="MEASURED", help="Measured surface points (CSV).")
    ],
    tolerance: Annotated[
        str, typer.Option(help="Full width of the tolerance band of the form.")
    ] = "20 um",
    keep_phase: Annotated[
        bool, typer.Option("--keep-phase", help="Angles are the keyway's: run it turned.")
    ] = False,
    jobs: Annotated[int | None, typer.Option(help="Processes for the certificate.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The record as JSON.")] = False,
) -> int:
    """Fit a measured cam to its drawing and judge the real part: exit 0 passed, 1 failed."""
    from pipeline import inspection, units
    from reports.inspection import draw

    band = units.parse(tolerance, "um", "--tolerance")
    if not band > 0:
        raise InputError("--tolerance", tolerance, "> 0 um")
    points = inspection.read_measured(measured)
    case, contour = inspection.nominal(folder)
    with _progress() as progress:
        part = inspection.inspect_part(
            case, contour, points, keep_phase=keep_phase, jobs=jobs, tell=progress.stage
        )
    record = inspection.write_inspection(folder, case, part, band)
    picture = draw(folder, 1e6 * band)
    if as_json:
        print(json.dumps(record, indent=2, ensure_ascii=False))  # noqa: T201 - not to be wrapped
    else:
        for line in inspection.lines(record):
            _out.print(line, markup=False)
        _out.print(f"deviations: {picture}", markup=False)
    return PASSED if record["verdict"] == "pass" else FAILED


@app.command()
def deck(
    folder: DirArgument,
    angle: Annotated[str, typer.Option(help="Cam angle, degrees unless it has a unit.")],
    load_case: Annotated[
        str | None, typer.Option("--load-case", help="The first by default.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.inp", help="Where the deck is to lie.")
    ] = None,
) -> int:
    """Write the contact at one angle as a CalculiX/Abaqus deck, to be solved by another code."""
    from pipeline import deck as decks
    from pipeline import units

    text = angle if any(c.isalpha() or c == "°" for c in angle) else f"{angle} deg"
    theta = units.parse(text, "deg", "--angle")
    path = folder / "exports" / f"contact_{math.degrees(theta):07.3f}.inp" if out is None else out
    path.parent.mkdir(parents=True, exist_ok=True)
    solved = decks.deck(folder, theta, path, load_case)
    p0 = solved.solution.p0 / 1e6
    _out.print(f"deck: {path} (peak pressure {p0:.5g} MPa)", markup=False)
    return PASSED


@app.command()
def init(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the new case.")],
) -> int:
    """Write NAME.toml, a commented case file that runs."""
    from pipeline.case_template import template

    name = name.removesuffix(TEMPLATE_SUFFIX)
    text = template(name)
    path = Path(f"{name}{TEMPLATE_SUFFIX}")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise ResultError(f"{path}: exists already and is left as it is") from None
    _out.print(f"wrote {path}; next: camwright run {path} --out runs/{name}", markup=False)
    return PASSED


def _use_cache(wanted: bool) -> None:
    from pipeline import cache

    if not wanted:
        cache.switch_off()


def _load(folder: Path) -> Run:
    from pipeline.results import load_run

    return load_run(folder)


def _finished(out: Path, sha256: str) -> bool:
    """Whether `out` already holds this run, by the same versions: nothing is left to resume."""
    from pipeline.results import read_summary
    from pipeline.run_folder import versions

    if not (out / "run.json").is_file():
        return False
    summary = read_summary(out)
    return bool(summary["input_sha256"] == sha256 and summary["versions"] == versions())


@contextmanager
def _progress() -> Iterator[Progress]:
    """Bars on a terminal, plain lines where nobody watches; both on the error stream."""
    if _err.is_terminal:
        with Bars(_err) as bars:
            yield bars
    else:
        yield Lines(lambda text: print(text, file=sys.stderr, flush=True))  # noqa: T201


def _show(document: dict[str, Any], folder: Path | None) -> None:
    """Checks by utilisation, what else is to be known, then the verdict and the report's place."""
    from pipeline.check_command import consistency_line, remarks, table

    _out.print(table(document["checks"]))
    for line in remarks(document["checks"]):
        _out.print(line, markup=False)
    if "changes" in document:
        from pipeline.baseline import lines

        for line in lines(document["changes"]):
            _out.print(f"baseline: {line}", markup=False)
    if folder is None:
        _out.print(f"verdict: {document['verdict']}, a look ahead by closed forms", markup=False)
    else:
        count = document["trials"]
        trials = f"{count} trial{'s' if count > 1 else ''}"
        _out.print(f"verdict: {document['verdict']} after {trials}", markup=False)
        if document["statement"]:
            _out.print(document["statement"], markup=False)
    if document["binding"]:
        _out.print(f"binding: {', '.join(document['binding'])}", markup=False)
    for finding in document.get("consistency", ()):
        _out.print(consistency_line(finding), markup=False)
    if folder is not None:
        _out.print(f"report: {folder / '8_report.html'}", markup=False)


if __name__ == "__main__":
    main()

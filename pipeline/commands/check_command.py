"""Command `check`: verdict of a run, or preview of a case."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from camwright.pipeline.commands.terminal import EXIT_CODE, FAILED, say, show, show_json

if TYPE_CHECKING:
    from camwright.pipeline.results.run_reader import CheckRecord


def check(
    target: Annotated[Path, typer.Argument(metavar="DIR|CASE", help="Run folder or case file.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the checks as JSON.")] = False,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write the checks as JUnit XML.")
    ] = None,
    baseline: Annotated[
        Path | None,
        typer.Option(
            "--baseline", metavar="DIR", help="Compare with the checks of an earlier run."
        ),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option("--only", help='Check ids or patterns such as "guide_*".')
    ] = None,
    fail_on: Annotated[
        str,
        typer.Option(
            "--fail-on",
            help="Checks that decide the exit code: must (required), open (also optional ones "
            "without data), any (also optional ones that fail), never.",
        ),
    ] = "must",
    verify_record: Annotated[
        bool,
        typer.Option("--verify-record", help="Compare the files of the run with signoff.json."),
    ] = False,
) -> int:
    """Print the verdict of a run, or the screen of a preview of a case.

    Exit code 0: PASS, 1: FAIL, 2: error, 3: INCOMPLETE (data are missing) or OPEN: a preview, or a
    run below the certified depth, never passes.
    """
    from camwright.pipeline.results.check_report import junit as junit_text
    from camwright.pipeline.results.check_report import outcome, selected
    from camwright.pipeline.results.run_reader import VERDICTS, exit_word

    if verify_record and not _as_signed(target):
        return FAILED
    is_case = target.is_file()
    document = _checked_case(target) if is_case else _checked_run(target)
    document["checks"] = list(selected(document["checks"], only or ()))
    decided = outcome(document["checks"], fail_on)
    if not only and fail_on != "never":
        decided = max(decided, exit_word(document), key=VERDICTS.index)
    if baseline is not None:
        from camwright.pipeline.results.baseline_comparison import changes

        document["changes"] = changes(_comparable(baseline, only or ()), document["checks"])
    if junit is not None:
        from camwright.pipeline.base.files import write_atomic

        words = {"verdict": document["verdict_line"], "scope": document["scope"]["statement"]}
        text = junit_text(document["checks"], document["case"], fail_on, words)
        write_atomic(junit, text)
    if as_json:
        show_json(document)
    else:
        show(document, None if is_case else target)
    return EXIT_CODE[decided]


def _comparable(folder: Path, only: Iterable[str]) -> list[CheckRecord]:
    """Checks of a baseline run that fit a pattern."""
    from camwright.pipeline.results.check_report import fits
    from camwright.pipeline.results.run_reader import read_verdict

    checks: list[CheckRecord] = read_verdict(folder)["checks"]
    return [record for record in checks if fits(record, only)]


def _as_signed(folder: Path) -> bool:
    """Whether the files of a run are those of its sign-off; prints each changed file."""
    from camwright.pipeline.results import signoff

    changed = signoff.changes(folder)
    for line in changed:
        say(f"{folder / line}")
    return not changed


def _checked_run(folder: Path) -> dict[str, Any]:
    from camwright.pipeline.results.model_limits import limitations
    from camwright.pipeline.results.run_reader import read_verdict, verify_run

    verify_run(folder)
    return read_verdict(folder) | limitations()


def _checked_case(path: Path) -> dict[str, Any]:
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.preview import preview_case
    from camwright.pipeline.results.run_reader import judgement, to_be_confirmed

    case = read_case(path)
    trial = preview_case(case)
    checks: list[Any] = [one.as_record() for one in trial.checks]
    return {
        "case": case.name,
        "input_sha256": case.sha256,
        **judgement(checks, trial.depth.word),
        "to_be_confirmed": to_be_confirmed(checks),
        "binding": list(trial.binding),
        "scope": case.scope.as_record(),
        "checks": checks,
    }

"""Shared parts of the commands: exit codes, options, streams, progress, verdict text."""

from __future__ import annotations

import json
import sys
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from camwright.pipeline.base.printed_text import with_escapes
from camwright.pipeline.base.progress import Bars, Lines, Progress
from camwright.pipeline.commands.arguments import Words

if TYPE_CHECKING:
    from camwright.pipeline.results.verdict_summary import Places

EXIT_CODES: Mapping[int, str] = {
    0: "passes or done",
    1: "fails, or none passes",
    2: "error",
    3: "data missing or screen open",
    4: "not as recorded",
    130: "interrupted",
}
"""Exit codes of all commands; after a signal 128 and its number."""
PASSED, FAILED, ERROR, INCOMPLETE, ALTERED, INTERRUPTED = EXIT_CODES
EXIT_CODE = {"pass": PASSED, "incomplete": INCOMPLETE, "fail": FAILED}
"""Exit code by verdict."""

WIDTH = 100
"""Columns of a line in a file or pipe; a path that is longer stays whole."""


class _Console(Console):
    """Console of which no text steers the terminal, whoever wrote it."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterator[Segment]:
        for text, style, control in super().render(renderable, options):
            yield Segment(text if control else with_escapes(text), style, control)


class _Output(_Console):
    """Console that wraps a text between words in a file; a terminal wraps it itself."""

    def print(self, *objects: Any, **options: Any) -> None:
        """Print; where the output is no terminal, texts are broken into lines of
        `WIDTH` columns.
        """
        if self.is_terminal:
            super().print(*objects, **options)
            return
        super().print(*(_wrapped(o) if isinstance(o, str) else o for o in objects), **options)


def _wrapped(text: str) -> str:
    return "\n".join(
        textwrap.fill(
            line,
            WIDTH,
            subsequent_indent=" " * (len(line) - len(line.lstrip(" ")) + 2),
            break_long_words=False,
            break_on_hyphens=False,
            replace_whitespace=False,
        )
        for line in text.split("\n")
    )


_ON_TERMINAL = sys.stdout is not None and sys.stdout.isatty()  # None: closed
stdout = _Output(highlight=False, soft_wrap=True, width=None if _ON_TERMINAL else WIDTH)
stderr = _Console(stderr=True, highlight=False, soft_wrap=True)

CaseArgument = Annotated[Path, Words("Case file (TOML).", "CASE")]
RunArgument = Annotated[Path, Words("Run folder.", "RUN")]
JobsOption = Annotated[
    int | None,
    Words("Number of processes; default: number of cores, at most 4.", bounds=(1, 256)),
]
JsonOption = Annotated[bool, Words("Print the record as JSON.", typed="--json")]
NoCacheOption = Annotated[bool, Words("Do not use the disk cache.")]
PngOption = Annotated[bool, Words("Write the figures as PNG files as well.")]
ResumeOption = Annotated[bool, Words("Resume an interrupted run; finished results are reused.")]


def say(text: str) -> None:
    """Print a message on the error stream."""
    tell(f"camwright: {text}")


def tell(text: str) -> None:
    """Print text on the error stream at once."""
    _print(text, sys.stderr)


def show_text(text: str) -> None:
    """Print text on the output stream, unwrapped."""
    _print(text, sys.stdout)


def show_json(document: object) -> None:
    """Print a document as JSON on the output stream.

    Characters that steer a terminal, which stand in strings alone, are escaped as JSON has it.
    """
    show_text(with_escapes(json.dumps(document, indent=2, ensure_ascii=False), json.dumps))


def _print(text: str, stream: TextIO) -> None:
    print(with_escapes(text), file=stream, flush=True)  # rich would parse and wrap it


def use_cache(enabled: bool) -> None:
    """Switch off the disk cache unless enabled."""
    from camwright.pipeline.base import disk_cache

    if not enabled:
        disk_cache.switch_off()


@contextmanager
def progress_shown() -> Iterator[Progress]:
    """Progress bars on a terminal, a line a stage elsewhere; on the error stream."""
    if stderr.is_terminal:
        with Bars(stderr) as bars:
            yield bars
    else:
        yield Lines(tell)


def page_of(folder: Path) -> str:
    """Path of the page of a run folder; "" without one."""
    page = folder / "8_report.html"
    return str(page) if page.is_file() else ""


def show(document: dict[str, Any], places: Places) -> None:
    """Print the verdict summary of a run or previewed case in at most 15 lines."""
    from camwright.pipeline.results.verdict_summary import summary_lines

    for line in summary_lines(document, places):
        stdout.print(line, markup=False)


def show_failures(document: dict[str, Any], places: Places) -> None:
    """Print the summary of a run or case: failed checks, missing data, changes against a baseline,
    verdict, scope, path of the report, next step.

    Parameters
    ----------
    document : dict   as of `camwright check --json`
    places : Places   names of case, run and page, for the text
    """
    from camwright.pipeline.base.verdict import within_depth
    from camwright.pipeline.results import verdict_summary
    from camwright.pipeline.results.check_records import of_records, records_of

    checks = records_of(within_depth(of_records(document["checks"])))
    show_lines(verdict_summary.load_end_line(document))
    show_lines(verdict_summary.failure_lines(checks))
    show_lines(verdict_summary.missing_lines(checks, places.case))
    show_lines(_changes(document))
    show_lines(
        (
            verdict_summary.verdict_words(document),
            *verdict_summary.headline_line(document),
            *verdict_summary.measured_line(document),
            *verdict_summary.governing_line(checks),
            *verdict_summary.advisory_lines(checks),
            *filter(None, (document["scope"]["statement"],)),
            *verdict_summary.place_line(document, places),
            *verdict_summary.next_lines(document, places),
        )
    )


def show_all(document: dict[str, Any], places: Places) -> None:
    """Print the whole result of a run or case: table of checks and of evidence by utilisation,
    remarks, verdict, scope, path of the report, next step.

    Parameters
    ----------
    document : dict   as of `camwright check --json`
    places : Places   names of case, run and page, for the text
    """
    from camwright.pipeline.base.verdict import within_depth
    from camwright.pipeline.results.check_records import of_records, records_of
    from camwright.pipeline.results.check_report import (
        binding_lines,
        consistency_line,
        deeper_lines,
        remarks,
        table,
    )
    from camwright.pipeline.results.verdict_summary import (
        load_end_line,
        measured_line,
        next_lines,
        place_line,
        verdict_words,
    )

    checks = records_of(within_depth(of_records(document["checks"])))
    show_lines(load_end_line(document))
    stdout.print(table(check for check in checks if not check["evidence"]))
    evidence = [check for check in checks if check["evidence"]]
    if evidence:
        stdout.print("evidence, which never governs:", markup=False)
        stdout.print(table(evidence))
    show_lines((*remarks(checks), *deeper_lines(document["checks"])))
    show_lines(_changes(document))
    stdout.print(verdict_words(document), markup=False)
    if document.get("statement"):
        stdout.print(document["statement"], markup=False)
    if document["to_be_confirmed"]:
        values = "; ".join(document["to_be_confirmed"])
        stdout.print(f"values to be confirmed: {values}", markup=False)
    if document["scope"]["statement"]:
        stdout.print(document["scope"]["statement"], markup=False)
    show_lines(measured_line(document))
    show_lines(binding_lines(document["checks"], document["binding"]))
    show_lines(consistency_line(finding) for finding in document.get("consistency", ()))
    show_lines(place_line(document, places))
    show_lines(next_lines(document, places))


def _changes(document: dict[str, Any]) -> list[str]:
    """Lines on what changed against a baseline run, from the document of a run; empty where the run
    was compared with none.
    """
    if "changes" not in document:
        return []
    from camwright.pipeline.results.baseline_comparison import lines

    return [f"baseline: {line}" for line in lines(document["changes"])]


def show_lines(lines: Iterable[str]) -> None:
    """Print lines on the output stream at once."""
    for line in lines:
        stdout.print(line, markup=False)

"""Shared by the commands: exit codes, output streams, progress, text of a verdict."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from camwright.pipeline.base.progress import Bars, Lines, Progress

PASSED, FAILED, ERROR, INCOMPLETE, INTERRUPTED = 0, 1, 2, 3, 130
EXIT_CODE = {"pass": PASSED, "incomplete": INCOMPLETE, "fail": FAILED}
"""Exit code by verdict."""

stdout = Console(highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 180)
stderr = Console(stderr=True, highlight=False, soft_wrap=True)

CaseArgument = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML).")]
DirArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Run folder.")]
NoCacheOption = Annotated[bool, typer.Option("--no-cache", help="Do not use the disk cache.")]


def say(text: str) -> None:
    """Print a line on the error stream."""
    print(f"camwright: {text}", file=sys.stderr)  # noqa: T201 - rich would parse markup


def show_json(document: object) -> None:
    """Print a document as JSON on the output stream."""
    print(json.dumps(document, indent=2, ensure_ascii=False))  # noqa: T201 - rich would wrap it


def use_cache(enabled: bool) -> None:
    """Switch off the disk cache unless enabled."""
    from camwright.pipeline.base import disk_cache

    if not enabled:
        disk_cache.switch_off()


@contextmanager
def progress_shown() -> Iterator[Progress]:
    """Progress bars on a terminal, plain lines elsewhere; on the error stream."""
    if stderr.is_terminal:
        with Bars(stderr) as bars:
            yield bars
    else:
        yield Lines(lambda text: print(text, file=sys.stderr, flush=True))  # noqa: T201


def show(document: dict[str, Any], folder: Path | None) -> None:
    """Print checks by utilisation, remarks, verdict, scope and path of the report."""
    from camwright.pipeline.results.check_report import (
        binding_lines,
        consistency_line,
        deeper_lines,
        remarks,
        table,
    )
    from camwright.pipeline.results.run_reader import within_depth

    checks = within_depth(document["checks"])
    stdout.print(table(checks))
    for line in (*remarks(checks), *deeper_lines(document["checks"])):
        stdout.print(line, markup=False)
    if "changes" in document:
        from camwright.pipeline.results.baseline_comparison import lines

        for line in lines(document["changes"]):
            stdout.print(f"baseline: {line}", markup=False)
    line = document["verdict_line"]
    if document["verdict"] is None:
        stdout.print(f"screen: {line}; no verdict below the certified depth", markup=False)
    else:
        count = document["trials"]
        trials = f"{count} trial{'s' if count > 1 else ''}"
        stdout.print(f"verdict: {line}; after {trials}", markup=False)
    if folder is not None and document["statement"]:
        stdout.print(document["statement"], markup=False)
    if document["to_be_confirmed"]:
        values = "; ".join(document["to_be_confirmed"])
        stdout.print(f"values to be confirmed: {values}", markup=False)
    if document["scope"]["statement"]:
        stdout.print(document["scope"]["statement"], markup=False)
    for line in binding_lines(document["checks"], document["binding"]):
        stdout.print(line, markup=False)
    for finding in document.get("consistency", ()):
        stdout.print(consistency_line(finding), markup=False)
    if folder is not None and (folder / "8_report.html").is_file():
        stdout.print(f"report: {folder / '8_report.html'}", markup=False)

"""Lines of the command line in this process: what they print, or the error that they raise."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import redirect_stdout
from typing import NamedTuple

from camwright.geometry.errors import CamError
from camwright.pipeline.cli import run_line


class Ran(NamedTuple):
    """Output, exit code and error of a line; None where it has raised, or has not."""

    stdout: str
    code: int | None
    exception: CamError | None


def ran(words: Sequence[str]) -> Ran:
    printed = io.StringIO()
    with redirect_stdout(printed):
        try:
            code, error = run_line(words), None
        except CamError as raised:
            code, error = None, raised
    return Ran(printed.getvalue(), code, error)

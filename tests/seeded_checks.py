"""Drawn cases by `camwright check`: a verdict or one clear line, in time, and no NaN shown."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from camwright.geometry.errors import CamError
from camwright.pipeline.case.case_writer import tables_text
from camwright.pipeline.cli import run_line

SECONDS = 10.0
"""Most CPU time of one check; the wall time depends on who else computes."""


def checked(
    name: str, tables: dict[str, Any], folder: Path, capsys: pytest.CaptureFixture[str]
) -> tuple[int, str, float]:
    """Exit code, words and CPU time of the check of a case."""
    file = folder / f"{name}.toml"
    file.write_text(tables_text(tables), encoding="utf-8")
    begun = time.process_time()
    try:
        code, words = run_line(["check", str(file)]), ""
    except CamError as error:
        code, words = 2, str(error)
    spent = time.process_time() - begun
    shown = capsys.readouterr()
    return code, words + shown.out, spent


def faults(name: str, code: int, words: str, spent: float) -> Iterator[str]:
    """What is wrong with the answer for a case."""
    if code == 2:
        refused = words.strip()
        if "\n" in refused or " = " not in refused or "must be" not in refused:
            yield f"{name}: not one clear line: {refused!r}"
    elif not re.search(r"screen: (PASS|FAIL|OPEN|INCOMPLETE)", words):
        yield f"{name}: no verdict, exit code {code}: {words[-300:]!r}"
    if re.search(r"\bnan\b", words, re.IGNORECASE):
        yield f"{name}: shows NaN"
    if spent > SECONDS:
        yield f"{name}: {spent:.1f} s"

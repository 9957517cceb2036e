"""Progress of a long computation: bars on a terminal, plain lines elsewhere."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    ProgressColumn,
    Task,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
)
from rich.progress import (
    Progress as RichProgress,
)
from rich.text import Text

USUAL = {
    "synthesis": 3.0, "preview": 1.5, "mesh": 0.2, "checks": 3.5, "benchmarks": 0.5,
    "workshop": 0.4, "report": 3.0, "remedies": 4.0, "contact": 2.0, "conflicting limits": 30.0,
    "fit": 2.0, "pictures": 2.0, "figures": 2.0,
}  # fmt: skip
"""Usual duration of the stages without steps, s, of the reference case on two cores: their percent
and remaining time on a terminal are estimates by it."""
_ESTIMATED_MOST = 0.99  # share of an estimate that is exceeded


class Progress(Protocol):
    """Receiver of the progress of a run."""

    def stage(self, name: str) -> None:
        """A stage starts."""

    def advance(self, k: int, total: int) -> None:
        """`k` of `total` steps of the stage are complete."""

    def note(self, text: str) -> None:
        """A remark for the user."""


class Silent:
    """Progress without output."""

    def stage(self, name: str) -> None: ...

    def advance(self, k: int, total: int) -> None: ...

    def note(self, text: str) -> None: ...


SILENT = Silent()


class Lines:
    """Progress as plain lines, one per stage and remark, for a file or pipe."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say

    def stage(self, name: str) -> None:
        self._say(name)

    def advance(self, k: int, total: int) -> None: ...

    def note(self, text: str) -> None:
        self._say(text)


def share(task: Task) -> float | None:
    """Share of a stage that is complete, 0 to 1, by its steps or its usual duration;
    None: unknown.
    """
    if task.total:
        return task.completed / task.total
    usual: float | None = task.fields.get("usual")
    return None if usual is None else min((task.elapsed or 0.0) / usual, _ESTIMATED_MOST)


class _Percent(ProgressColumn):
    def render(self, task: Task) -> Text:
        part = share(task)
        return Text("" if part is None else f"{part:>4.0%}".replace("%", " %"))


class _Remaining(ProgressColumn):
    def render(self, task: Task) -> Text:
        """Remaining time of a stage as text, from its share so far; empty while that is unknown."""
        part = share(task)
        if not part:
            return Text("")
        left = (task.elapsed or 0.0) * (1.0 / part - 1.0)
        return Text(f"{timedelta(seconds=round(left))} remaining")


class Bars:
    """Progress bars with percent and remaining time, one per stage; a context manager."""

    def __init__(self, console: Console) -> None:
        """Progress bars printed on `console`, before their first stage."""
        self._console = console
        self._bars = RichProgress(
            TextColumn("{task.description}"),
            BarColumn(),
            _Percent(),
            TimeElapsedColumn(),
            _Remaining(),
            console=console,
            transient=True,
        )
        self._task: TaskID | None = None
        self._name = ""

    def __enter__(self) -> Self:
        self._bars.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._bars.stop()

    def stage(self, name: str) -> None:
        """Begin a stage with a bar of its own; the one before is printed as done."""
        if self._task is not None:
            self._bars.remove_task(self._task)
            self._console.print(f"{self._name} done", highlight=False, markup=False)
        self._name = name
        usual = USUAL.get(name.rpartition(": ")[2].partition(" of ")[0])
        self._task = self._bars.add_task(name, total=None, usual=usual)

    def advance(self, k: int, total: int) -> None:
        if self._task is not None:
            self._bars.update(self._task, completed=k, total=total)

    def note(self, text: str) -> None:
        self._console.print(text, highlight=False, markup=False)


def utc(ago: float = 0.0) -> str:
    """Date and time `ago` seconds before now, UTC, such as ``2026-01-31T12:00:00Z``."""
    moment = datetime.now(UTC) - timedelta(seconds=ago)
    return f"{moment:%Y-%m-%dT%H:%M:%SZ}"


def process_began() -> float:
    """`time.perf_counter` at the start of this process; now, where the system does not say it."""
    now = time.perf_counter()
    try:
        stated = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        ticks = int(stated[19])  # field 22, since the boot
        age = time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError, IndexError, AttributeError):
        return now
    return now - max(age, 0.0)

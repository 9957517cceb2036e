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
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import (
    Progress as RichProgress,
)


class Progress(Protocol):
    """Receiver of the progress of a run."""

    def stage(self, name: str) -> None:
        """A stage starts."""

    def advance(self, k: int, total: int) -> None:
        """`k` of `total` steps of the stage are complete."""

    def note(self, text: str) -> None:
        """A remark for the user."""


class Silent:
    """No output."""

    def stage(self, name: str) -> None: ...

    def advance(self, k: int, total: int) -> None: ...

    def note(self, text: str) -> None: ...


SILENT = Silent()


class Lines:
    """A plain line for each stage and remark, for a file or pipe."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say

    def stage(self, name: str) -> None:
        self._say(name)

    def advance(self, k: int, total: int) -> None: ...

    def note(self, text: str) -> None:
        self._say(text)


class Bars:
    """A bar with percent and remaining time for each stage; a context manager."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bars = RichProgress(
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(text_format="{task.percentage:>3.0f} %"),
            TimeElapsedColumn(),
            TextColumn("remaining"),
            TimeRemainingColumn(),
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
        if self._task is not None:
            self._bars.remove_task(self._task)
            self._console.print(f"{self._name} done", highlight=False, markup=False)
        self._name = name
        self._task = self._bars.add_task(name, total=None)

    def advance(self, k: int, total: int) -> None:
        if self._task is not None:
            self._bars.update(self._task, completed=k, total=total)

    def note(self, text: str) -> None:
        self._console.print(text, highlight=False, markup=False)


def utc(ago: float = 0.0) -> str:
    """Time of day `ago` seconds before now, UTC, such as ``2026-01-31T12:00:00Z``."""
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

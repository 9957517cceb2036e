"""Exchange of run folders: a complete run takes the place of an earlier one.

A run is written in ``.DIR.partial`` beside its final path DIR, under a lock. It is complete when
its sign-off record is written and its state is deleted. The earlier run waits in ``.DIR.replaced``
until the new one is at its path. What a killed process leaves on the way is settled by the next.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from typing import IO

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import locked
from camwright.pipeline.results import signoff

STATE, CHUNKS = ".state.json", ".chunks"
"""Input of an interrupted run, and its solved pieces."""

KEPT = "what is solved is kept; run the command again with --resume to resume"
"""Note of an exception after which a run can be resumed."""

OURS = re.compile(
    r"case\.toml|(run|signoff|corners)\.json|inputs|fields|figures|exports|workshop|inspection|trial_\d+"
    r"|scene\.html|\d+_\w+\.(csv|html|json|pdf)"
)
"""Names of the files and folders of an unsigned run."""


def absolute(out: Path) -> Path:
    """Final path of a run, links resolved; ResultError if it cannot be that of a folder."""
    try:
        resolved = out.resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise ResultError(f"{out}: {error}") from None
    if not resolved.name:
        raise ResultError(f"{out}: is not a folder to write a run to")
    return resolved


def partial_of(out: Path) -> Path:
    """Folder in which a run is written."""
    return out.with_name(f".{out.name}.partial")


def _replaced(out: Path) -> Path:
    return out.with_name(f".{out.name}.replaced")


def _lock_file(out: Path) -> Path:
    return out.with_name(f".{out.name}.lock")


def lock_of(out: Path) -> IO[str] | None:
    """Lock of a final path for this process; ResultError if another run is writing to it."""
    return locked(_lock_file(out), f"{out}: another run is writing to it")


def unlock(out: Path, lock: IO[str]) -> None:
    """End a lock and delete its file."""
    _lock_file(out).unlink(missing_ok=True)
    lock.close()


def complete_exchange(out: Path) -> None:
    """Move a run that was complete when its process was killed to its final path.

    Raises
    ------
    ResultError
        If another process writes to it, or it cannot be moved.
    """
    out = absolute(out)
    if not any(path.exists() for path in (partial_of(out), _replaced(out), _lock_file(out))):
        return
    try:
        lock = lock_of(out)
        try:
            settle(out)
        finally:
            if lock is not None:
                unlock(out, lock)
    except OSError as error:
        raise ResultError(f"{out}: {error.strerror or error}") from None


def settle(out: Path) -> None:
    """Complete the exchange at which a process was killed; the caller holds the lock."""
    replaced = _replaced(out)
    if is_complete(partial_of(out)) and _may_be_replaced(out):
        exchange(out)
    elif replaced.is_dir() and not os.path.lexists(out):
        replaced.rename(out)
    elif replaced.is_dir() and _holds_ours(replaced):
        shutil.rmtree(replaced)


def exchange(out: Path) -> None:
    """Put a complete run in the place of an earlier one; the caller holds the lock."""
    partial, replaced = partial_of(out), _replaced(out)
    shutil.rmtree(partial / CHUNKS, ignore_errors=True)
    if out.exists():
        shutil.rmtree(replaced, ignore_errors=True)
        out.rename(replaced)
    try:
        partial.rename(out)
    except OSError:
        if replaced.exists():
            replaced.rename(out)
        raise
    shutil.rmtree(replaced, ignore_errors=True)


def is_complete(partial: Path) -> bool:
    """Whether the run in a folder lacks nothing but its final path."""
    whole = not partial.is_symlink() and (partial / signoff.NAME).is_file()
    return whole and not (partial / STATE).exists()


def _may_be_replaced(out: Path) -> bool:
    """Whether a path is free, an empty folder or an unsigned run."""
    return not os.path.lexists(out) or (out.is_dir() and _holds_ours(out))


def _holds_ours(folder: Path) -> bool:
    return all(OURS.fullmatch(entry.name) for entry in folder.iterdir())

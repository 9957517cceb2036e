"""Output folder of one command: no foreign files, one writing process at a time."""

from __future__ import annotations

import os
import re
import shutil
from contextlib import suppress
from pathlib import Path
from typing import IO, Self

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import locked, require_plain, shown_name

LOCK = ".lock"

ASIDE = re.compile(r"\.[\w.-]+\.tmp")
"""Name of a file or folder while it is written; a killed process leaves it."""


class OwnedFolder:
    """Context manager: locked folder that may hold the files of one command alone.

    Within the context the folder is there and locked for this process, and what a killed process
    left aside is deleted. After it the lock is gone, as is a folder made for it that is empty.

    Parameters
    ----------
    path : Path      of the folder; may be a link
    ours : Pattern   names of what stands at its top
    what : str       what it holds, in a word: ``study``
    lock : Path      file of the lock of a folder that is exchanged as a whole; None: ``.lock`` in
                     the folder

    Raises
    ------
    ResultError
        As `entries` and `take`; or if it cannot be written.
    """

    def __init__(
        self, path: Path, ours: re.Pattern[str], what: str, lock: Path | None = None
    ) -> None:
        """Name a folder; it is locked by `take`. For the parameters see the class."""
        self.path, self._ours, self._what = path, ours, what
        self._whole = lock is not None
        self._lock_file = path / LOCK if lock is None else lock
        self._lock: IO[str] | None = None
        self._made: list[Path] = []
        self.taken = False

    def __enter__(self) -> Self:
        self.entries()
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def entries(self) -> list[str]:
        """Names of the command's files at the top of the folder, sorted; none without a folder.

        Raises
        ------
        ResultError
            If it is no folder, cannot be read, or holds anything that is not ours at its top, or a
            link, pipe, socket or device at any depth.
        """
        if not os.path.lexists(self.path):
            return []
        try:
            if not self.path.is_dir():
                raise ResultError(f"{self.path}: is not a folder")
            names = sorted(each.name for each in self.path.iterdir())
        except OSError as error:
            raise ResultError(f"{self.path}: {error.strerror or error}") from None
        own = names if self._whole else [name for name in names if not self._is_passing(name)]
        for name in own:
            if not self._ours.fullmatch(name):
                raise self.stranger(name)
        require_plain(self.path)
        return own

    def stranger(self, name: str) -> ResultError:
        """Error for a folder that holds a foreign file."""
        reason = f"holds {shown_name(name)}, which is not of a {self._what}"
        return ResultError(f"{self.path}: {reason}; choose another folder")

    def take(self) -> None:
        """Lock the folder, and delete the temporary files of a killed process.

        Raises
        ------
        ResultError
            If another process has the lock, or the folder cannot be written; a lock is not made
            through a link.
        """
        place = self._lock_file.parent
        self._made = [each for each in (place, *place.parents) if not each.exists()]
        try:
            while not self.taken:
                place.mkdir(parents=True, exist_ok=True)
                with suppress(FileNotFoundError):  # another process deleted the empty folder
                    busy = f"{self.path}: another {self._what} is writing to it"
                    self._lock = locked(self._lock_file, busy)
                    self.taken = True
            if not self._whole:
                self._sweep()
        except (OSError, ResultError) as error:
            self.release()
            if isinstance(error, ResultError):
                raise
            where = error.filename or place
            raise ResultError(f"{where}: {error.strerror or error}") from None

    def release(self) -> None:
        """Release the lock, and delete its file and the empty folders made for it."""
        if self._lock is not None:
            with suppress(OSError):
                self._lock_file.unlink(missing_ok=True)
            self._lock.close()
            self._lock = None
        self.taken = False
        for each in self._made:
            with suppress(OSError):  # holds files
                each.rmdir()
        self._made = []

    def _is_passing(self, name: str) -> bool:
        """Whether a name is that of the lock, or of what is written aside."""
        return name == LOCK or ASIDE.fullmatch(name) is not None

    def _sweep(self) -> None:
        """Delete files and folders under temporary names that a killed process left in the
        folder.
        """
        aside = [each for each in self.path.rglob(".*.tmp") if ASIDE.fullmatch(each.name)]
        for each in aside:
            if each.is_dir():
                shutil.rmtree(each)
            else:
                each.unlink(missing_ok=True)  # it may have been in such a folder

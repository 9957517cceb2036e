"""Atomic replacement of run folders and of files in them.

A run is written in ``.DIR.partial`` beside its final path DIR, under a lock. It is complete when
its sign-off record is written and its state is deleted. The earlier run waits in ``.DIR.replaced``
until the new one is at its path. What a killed process leaves on the way is settled by the next.

Files that are added to a finished run, such as its page, are written in ``DIR/.amendment/partial``.
That folder is renamed to ``complete`` when it is whole, and its files are moved into the run, the
sign-off record last.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from camwright.geometry.errors import AlteredError, ResultError
from camwright.pipeline.base.files import files_in, read_json, require_plain, sha256_of
from camwright.pipeline.base.owned_folder import OwnedFolder
from camwright.pipeline.results import signoff

STATE, CHUNKS = ".state.json", ".chunks"
"""Input of an interrupted run, and its solved pieces."""

_LOCK = "lock"

KEPT = "solved points are kept; run the command again with --resume to resume"
"""Note of an exception after which a run can be resumed."""

OURS = re.compile(
    r"case\.toml|(run|signoff|corners)\.json|inputs|fields|figures|exports|workshop|inspection|trial_\d+"
    r"|scene\.html|motion\.svg|\d+_\w+\.(csv|html|json|pdf)"
    rf"|{re.escape(signoff.AMENDMENT)}"
)
"""Names of the files and folders of an unsigned run."""

_BY_OTHERS = ("inspection/", "exports/")
"""Folders of a run that `inspect` and `contact deck` write."""


def absolute(out: Path) -> Path:
    """Final path of a run, links resolved; ResultError if it cannot be a folder's."""
    try:
        resolved = out.resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise ResultError(f"{out}: {error}") from None
    if not resolved.name:
        raise ResultError(f"{out}: is not a folder to write a run to")
    return resolved


def partial_of(out: Path) -> Path:
    """Temporary folder in which a run is written."""
    return out.with_name(f".{out.name}.partial")


def _replaced(out: Path) -> Path:
    return out.with_name(f".{out.name}.replaced")


def _lock_file(out: Path) -> Path:
    return out.with_name(f".{out.name}.lock")


def owned(out: Path) -> OwnedFolder:
    """Context manager: final path of a run, locked for this process."""
    return OwnedFolder(out, OURS, "run", _lock_file(out))


def complete_exchange(out: Path) -> None:
    """Move a complete run to its final path after its process was killed.

    Raises
    ------
    ResultError
        If another process writes to it, or it cannot be moved.
    """
    out = absolute(out)
    if not any(path.exists() for path in (partial_of(out), _replaced(out), _lock_file(out))):
        return
    home = owned(out)
    home.take()
    try:
        settle(out)
    except OSError as error:
        raise ResultError(f"{out}: {error.strerror or error}") from None
    finally:
        home.release()


def settle(out: Path) -> None:
    """Complete an exchange interrupted by a killed process; the caller holds the lock."""
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


def is_being_written(folder: Path) -> bool:
    """Whether a folder is the temporary one of a run; see `partial_of`."""
    named = folder.name.startswith(".") and folder.suffix == ".partial"
    return named and (folder / STATE).is_file() and not (folder / signoff.NAME).exists()


def is_complete(partial: Path) -> bool:
    """Whether the run in a folder is complete but for its final path."""
    whole = not partial.is_symlink() and (partial / signoff.NAME).is_file()
    return whole and not (partial / STATE).exists()


def _may_be_replaced(out: Path) -> bool:
    """Whether a path is free, an empty folder or an unsigned run without a file of the user."""
    if not os.path.lexists(out):
        return True
    return out.is_dir() and _holds_ours(out) and not unrecorded(out)


def unrecorded(out: Path) -> list[str]:
    """Files of a run folder, by relative name, that its record omits; all without a record."""
    known = _hashes_of(out)
    return [name for name in _names_in(out) if name not in known]


def of_the_user(run: Path) -> list[str]:
    """Files in a run folder that `run` has not written, by name; changed ones are not listed.

    In a folder without a record, as of a damaged run, those that no run has by their name.
    """
    if not (run / signoff.NAME).is_file():
        return [each.name for each in run.iterdir() if not OURS.fullmatch(each.name)]
    by_others = (name for name in _names_in(run) if name.startswith(_BY_OTHERS))
    return [*unrecorded(run), *by_others]


def kept_by_nothing(out: Path) -> list[str]:
    """Recorded files that a new run in the same folder would lose: added or changed ones.

    Those of `inspect` and `contact deck`, and those that were changed since they were recorded.
    """
    known = _hashes_of(out)
    return [
        name
        for name in _names_in(out)
        if name.startswith(_BY_OTHERS) or sha256_of(out / name) != known[name]
    ]


def _names_in(out: Path) -> list[str]:
    """Files under a run folder, hidden ones too, but for record and files on their way into it."""
    names = (each.relative_to(out).as_posix() for each in out.rglob("*") if each.is_file())
    own = (signoff.NAME, signoff.SIGNATURES)
    return sorted(n for n in names if n not in own and not n.startswith(f"{signoff.AMENDMENT}/"))


def _hashes_of(out: Path) -> dict[str, str]:
    """Hash by file name from the sign-off record of a run of any schema; empty without a readable
    record.
    """
    try:
        files = read_json(out / signoff.NAME)["files"]
    except (ResultError, LookupError, TypeError):
        return {}
    return files if isinstance(files, dict) else {}


def _holds_ours(folder: Path) -> bool:
    return all(OURS.fullmatch(entry.name) for entry in folder.iterdir())


# --- files added to a finished run


@contextmanager
def amended(path: Path) -> Iterator[Path]:
    """Context manager: folder for files to add to a finished run together with its record.

    After an exception the run is as before. The record of a file that is not written stays, also
    where the file differs from it. A run without a record is not finished: its files are written
    at once, into `path`.

    Raises
    ------
    ResultError
        If the run is signed, another process writes into it, or it cannot be written.
    """
    if not (path / signoff.NAME).is_file():
        yield path
        return
    complete_amendment(path)
    if (path / signoff.SIGNATURES).exists():
        raise ResultError(f"{path}: is signed, nothing more is written into it; use a copy")
    with staged(path) as place:
        differing = {each.name for each in signoff.changes(path) if not each.added}
        yield place
        if differing <= {name for name, _ in files_in(place)}:
            signoff.write_amended(path, place)


def complete_amendment(path: Path) -> None:
    """Complete or delete the amendment of a run interrupted by a killed process.

    Raises
    ------
    ResultError
        If another process writes into the run, or it cannot be written.
    """
    if os.path.lexists(path / signoff.AMENDMENT):
        with staged(path):
            pass


def settle_recorded(path: Path) -> None:
    """Complete an interrupted amendment; refuse a run that differs from its record.

    Raises
    ------
    AlteredError
        See `signoff.require_recorded`.
    ResultError
        If another process writes into the run, or it cannot be written.
    """
    complete_amendment(path)
    signoff.require_recorded(path)


@contextmanager
def staged(path: Path) -> Iterator[Path]:
    """Context manager: folder whose files are moved into a run unless an exception is raised.

    Raises
    ------
    AlteredError
        If the run holds more than files and folders, such as a link; nothing is written then.
    ResultError
        If another process writes into the run, or it cannot be written.
    """
    require_plain(path, AlteredError)
    home = path / signoff.AMENDMENT
    partial, complete = home / "partial", path / signoff.COMPLETE
    owner = OwnedFolder(path, OURS, "process", home / _LOCK)
    owner.take()
    try:
        _put_in_place(complete, path)
        shutil.rmtree(partial, ignore_errors=True)
        yield partial
        if partial.is_dir():
            for name, _ in files_in(partial):
                (path / name).parent.mkdir(parents=True, exist_ok=True)
            partial.rename(complete)
            _put_in_place(complete, path)
    except OSError as error:
        raise ResultError(f"{error.filename or path}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        owner.release()
        with suppress(OSError):  # that of a killed process, or it holds what cannot be moved
            home.rmdir()


def _put_in_place(complete: Path, path: Path) -> None:
    """Move complete files into a run folder, its sign-off record last, and delete their folder.

    Parameters
    ----------
    complete : Path   folder of the files
    path : Path       run folder
    """
    files = dict(files_in(complete))
    for name in sorted(files, key=lambda name: name == signoff.NAME):
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        files[name].replace(path / name)
    if complete.exists():
        shutil.rmtree(complete)

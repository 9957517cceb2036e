"""Folders of one command: no foreign files, one writer at a time, nothing left of killed ones."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import IO

import pytest

from camwright.geometry.errors import ResultError
from camwright.pipeline.base import owned_folder
from camwright.pipeline.base.owned_folder import LOCK, OwnedFolder
from camwright.pipeline.results import folder_exchange
from camwright.pipeline.search.machine import design_study
from camwright.pipeline.search.parts import redesign_study
from camwright.pipeline.studies.batch.study_folder import StudyFolder

OURS = re.compile(r"table\.csv|parts")


def owned(path: Path, lock: Path | None = None) -> OwnedFolder:
    return OwnedFolder(path, OURS, "study", lock)


def whole(path: Path) -> OwnedFolder:
    """A folder that is exchanged as a whole, with its lock beside it."""
    return owned(path, path.with_name(f".{path.name}.lock"))


def names(folder: Path) -> list[str]:
    return sorted(each.relative_to(folder).as_posix() for each in folder.rglob("*"))


def pipe(path: Path) -> None:
    os.mkfifo(path)


def link(path: Path) -> None:
    path.symlink_to(path.parent.parent)


def broken_link(path: Path) -> None:
    path.symlink_to("nowhere")


def socket_file(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        place = Path.cwd()
        os.chdir(path.parent)  # the path of a socket has a greatest length
        try:
            made.bind(path.name)
        finally:
            os.chdir(place)


def test_the_folder_is_made_and_locked_meanwhile(tmp_path: Path) -> None:
    with owned(tmp_path / "a" / "b") as home:
        assert home.taken and names(home.path) == [LOCK] and home.entries() == []
        (home.path / "table.csv").write_text("1")
        assert home.entries() == ["table.csv"]
    assert not home.taken
    assert names(tmp_path) == ["a", "a/b", "a/b/table.csv"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit, ZeroDivisionError])
def test_nothing_is_left_of_a_folder_that_is_empty(
    tmp_path: Path, error: type[BaseException]
) -> None:
    with pytest.raises(error), owned(tmp_path / "a" / "b"):
        raise error
    assert names(tmp_path) == []
    (tmp_path / "own").mkdir()
    with owned(tmp_path / "own"):
        pass
    assert names(tmp_path) == ["own"]


@pytest.mark.parametrize("make", [owned, whole])
@pytest.mark.parametrize("name", ["letter.txt", "table.csv.bak", ".hidden", "a\x1b[1m"])
def test_a_stranger_is_named(
    tmp_path: Path, make: Callable[[Path], OwnedFolder], name: str
) -> None:
    (tmp_path / "f").mkdir()
    (tmp_path / "f" / name).write_text("mine")
    shown = name if name.isprintable() else ascii(name)
    words = rf"f: holds {re.escape(shown)}, which is not of a study; choose another folder"
    with pytest.raises(ResultError, match=words), make(tmp_path / "f"):
        pass
    assert names(tmp_path) == ["f", f"f/{name}"]


@pytest.mark.parametrize("make", [owned, whole])
@pytest.mark.parametrize("odd", [link, broken_link, pipe, socket_file])
@pytest.mark.parametrize("name", ["table.csv", "parts/a", "parts/.b/c"])
def test_what_is_no_file_and_no_folder_is_refused(
    tmp_path: Path, make: Callable[[Path], OwnedFolder], odd: Callable[[Path], None], name: str
) -> None:
    path = tmp_path / "f" / name
    path.parent.mkdir(parents=True)
    odd(path)
    before = names(tmp_path)
    with pytest.raises(ResultError, match=rf"{name}: is a (link|named pipe|socket)"):
        make(tmp_path / "f").__enter__()
    assert names(tmp_path) == before


@pytest.mark.parametrize("make", [owned, whole])
def test_a_path_that_is_no_folder_is_refused(
    tmp_path: Path, make: Callable[[Path], OwnedFolder]
) -> None:
    (tmp_path / "f").write_text("mine")
    broken_link(tmp_path / "g")
    for name in ("f", "g"):
        with pytest.raises(ResultError, match=f"{name}: is not a folder"):
            make(tmp_path / name).__enter__()
    assert names(tmp_path) == ["f", "g"]


def test_the_path_may_be_a_link(tmp_path: Path) -> None:
    (tmp_path / "f").mkdir()
    (tmp_path / "latest").symlink_to("f")
    with owned(tmp_path / "latest") as home:
        (home.path / "table.csv").write_text("1")
    assert names(tmp_path / "f") == ["table.csv"]


def test_what_a_killed_process_left_aside_is_deleted(tmp_path: Path) -> None:
    aside = (".k3_x9.tmp", ".table.csv.tmp", "parts/.a1.tmp", "parts/x/.b.tmp/.c.tmp")
    own = ("table.csv", "parts/a.tmp", "parts/.my notes.tmp")
    for name in (*aside, *own):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("1")
    (tmp_path / LOCK).write_text("")
    with owned(tmp_path):
        pass
    assert [name for name in names(tmp_path) if (tmp_path / name).is_file()] == sorted(own)


def test_a_folder_that_is_exchanged_has_nothing_aside(tmp_path: Path) -> None:
    (tmp_path / "f").mkdir()
    for name in (".k3_x9.tmp", LOCK):
        (tmp_path / "f" / name).write_text("mine")
        with pytest.raises(ResultError, match=f"holds {re.escape(name)}, which is not of a study"):
            whole(tmp_path / "f").__enter__()
        (tmp_path / "f" / name).unlink()


@pytest.mark.parametrize("make", [owned, whole])
def test_one_process_writes(tmp_path: Path, make: Callable[[Path], OwnedFolder]) -> None:
    with make(tmp_path / "f") as first:
        (tmp_path / ".x.tmp").write_text("1")
        for _ in range(2):
            with pytest.raises(ResultError, match="f: another study is writing to it"):
                make(tmp_path / "f").take()
        assert first.taken
    with make(tmp_path / "f"):
        pass
    assert names(tmp_path) == [".x.tmp"]


def test_what_the_writer_has_aside_is_not_deleted_by_another(tmp_path: Path) -> None:
    with owned(tmp_path / "f"):
        (tmp_path / "f" / ".x.tmp").write_text("1")
        with pytest.raises(ResultError, match="another study"):
            owned(tmp_path / "f").__enter__()
        assert (tmp_path / "f" / ".x.tmp").read_text() == "1"


@pytest.mark.parametrize("make", [owned, whole])
def test_the_lock_of_a_killed_process_has_ended(
    tmp_path: Path, make: Callable[[Path], OwnedFolder]
) -> None:
    script = (
        "import re, sys, time; from pathlib import Path\n"
        "from camwright.pipeline.base.owned_folder import OwnedFolder\n"
        "lock = Path(sys.argv[2]) if sys.argv[2:] else None\n"
        "with OwnedFolder(Path(sys.argv[1]), re.compile('table.csv'), 'study', lock) as home:\n"
        "    home.path.mkdir(exist_ok=True)\n"
        "    (home.path / 'table.csv').write_text('1')\n"
        "    print('taken', flush=True); time.sleep(600)\n"
    )
    place = tmp_path / "f"
    lock = [str(tmp_path / ".f.lock")] if make is whole else []
    child = subprocess.Popen(
        [sys.executable, "-c", script, str(place), *lock], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    with child, child.stdout:
        assert child.stdout.readline() == "taken\n"
        with pytest.raises(ResultError, match="another study"):
            make(place).take()
        child.send_signal(signal.SIGKILL)
        child.wait()
    with make(place) as home:
        assert home.entries() == ["table.csv"]
    assert names(tmp_path) == ["f", "f/table.csv"]


@pytest.mark.parametrize("make", [owned, whole])
def test_a_lock_is_not_made_through_a_link(
    tmp_path: Path, make: Callable[[Path], OwnedFolder]
) -> None:
    (tmp_path / "f").mkdir()
    lock = tmp_path / ("f/.lock" if make is owned else ".f.lock")
    lock.symlink_to(tmp_path / "outside")
    with pytest.raises(ResultError, match=rf"{lock.name}: .*links"):
        make(tmp_path / "f").take()
    assert lock.is_symlink() and not (tmp_path / "outside").exists()


def test_a_folder_that_its_last_owner_deletes_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    true, deleted = owned_folder.locked, list[Path]()

    def locked(path: Path, busy: str) -> IO[str] | None:
        if not deleted:
            deleted.append(path)
            path.parent.rmdir()
        return true(path, busy)

    monkeypatch.setattr(owned_folder, "locked", locked)
    with owned(tmp_path / "f") as home:
        assert deleted and names(home.path) == [LOCK]


@pytest.mark.parametrize("call", ["mkdir", "rglob"])
def test_a_folder_that_cannot_be_written_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    with monkeypatch.context() as patch:
        patch.setattr(Path, call, fails)
        with pytest.raises(ResultError, match="f: Permission denied"):
            owned(tmp_path / "f").__enter__()
    assert names(tmp_path) == []


def test_names_of_the_commands_do_not_hide_what_is_aside() -> None:
    """What a command owns must not match what is deleted."""
    home = StudyFolder(Path("s"), resume=False)._home
    for ours in (
        folder_exchange.OURS, home._ours, redesign_study._OURS, design_study._OURS,
    ):  # fmt: skip
        assert not any(map(ours.fullmatch, (".a.tmp", ".dataset.parquet.tmp", LOCK)))

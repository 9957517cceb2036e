"""Run folders of processes that are killed, or that cannot write, at every operation on a file:
while a run is written, and while files or a signature are added to a finished one.
"""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from small_machine import small_machine
from small_run import TORQUE, check, summary, values, write_run, write_trial

from camwright.geometry.errors import AlteredError, ResultError
from camwright.pipeline.base.files import file_hashes, write_atomic
from camwright.pipeline.base.store import Arrays
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.commands.terminal import ALTERED, ERROR, PASSED
from camwright.pipeline.cycle.contact_store import kept_piece
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.folder_exchange import (
    amended,
    complete_amendment,
    complete_exchange,
)
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.signatures import sign
from camwright.pipeline.results.signing_keys import write_key

Command = Callable[..., tuple[int, str, str]]

CHANGES = ("os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.chmod", "tempfile.mkstemp")
"""Audit events of operations that change a folder."""

PIECES = 3


def later_version() -> Any:
    return parse_case(small_machine("small").replace('"400 N"', '"401 N"'))


def solve(out: Path, *, resume: bool = False) -> int:
    """A run in place of an earlier version of its case; number of pieces that were not solved."""
    with RunFolder(out, later_version(), resume=resume, replace=True) as folder:
        solved: list[int] = []

        def piece(index: int) -> Arrays:
            solved.append(index)
            return {"p0": np.arange(3) / (7.0 + index)}

        for index in range(PIECES):
            kept_piece(folder.contact_store(1), "idle", index, "a", partial(piece, index))
        folder.write("1_torque.csv", values(TORQUE))
        write_trial(folder, [check("fail")])
        folder.write_summary(summary("fail"))
        (folder.path / "8_report.html").write_text("page")
        folder.finish(summary("fail"))
    return PIECES - len(solved)


def contents(folder: Path) -> dict[str, str]:
    return file_hashes(folder, lambda _: True)


def entries(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def pieces_in(folder: Path) -> int:
    return len(list(folder.rglob(".chunks/*/*/[0-9]*.npz")))


def changes_counted(folder: Path, at: int, act: Callable[[], None]) -> Callable[[], int]:
    """Act before the change number `at` in a folder; returns the count of changes so far."""
    count = 0

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal count
        if event in CHANGES and changed(arguments).startswith(str(folder)):
            count += 1
            if count == at:
                act()

    sys.addaudithook(hook)
    return lambda: count


def changed(arguments: tuple[Any, ...]) -> str:
    """Path that an operation changes, also where it is relative to an open folder."""
    path, opened = str(arguments[0]), arguments[-1]
    if isinstance(opened, int) and opened >= 0:
        path = str(Path(f"/proc/self/fd/{opened}").readlink() / path)
    return os.path.abspath(path)  # noqa: PTH100 - a link is not to be resolved


def in_a_child(work: Callable[[], None]) -> int:
    """Wait status of a forked process that does the work: an audit hook cannot be removed."""
    child = os.fork()
    if child == 0:
        try:
            work()
        finally:
            os._exit(1)
    return os.waitpid(child, 0)[1]


def kill_myself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, str], int]:
    """Files of a run without interruption, and the number of changes that it makes."""
    out = write_run(tmp_path_factory.mktemp("whole") / "run")

    def work() -> None:
        counted = changes_counted(out.parent, 0, kill_myself)
        solve(out)
        os._exit(counted())

    count = os.waitstatus_to_exitcode(in_a_child(work))
    assert 40 < count < 200
    return contents(out), count


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("step", [24, pytest.param(1, marks=pytest.mark.slow)])
def test_a_run_resumes_from_a_kill_before_every_change(
    undisturbed: tuple[dict[str, str], int], tmp_path: Path, step: int
) -> None:
    """Every change or each 24th, and each of the last 14, when the run takes its place.

    The earlier run or the new one is there, whole, and after a resumption nothing is left over.
    """
    whole, count = undisturbed
    between = 0
    for number in (*range(1, count - 13, step), *range(count - 13, count + 1)):
        place = tmp_path / str(number)
        out = write_run(place / "run")
        before = contents(out)

        def killed(place: Path = place, out: Path = out, number: int = number) -> None:
            changes_counted(place, number, kill_myself)
            solve(out)

        assert os.waitstatus_to_exitcode(in_a_child(killed)) == -signal.SIGKILL
        if out.exists():
            assert contents(out) in (before, whole), number
        else:
            between += 1
        solved = pieces_in(place)
        complete_exchange(out)
        if contents(out) != whole:
            assert solve(out, resume=True) == solved, number
        assert contents(out) == whole, number
        assert entries(place) == ["run"], number
        assert signoff.changes(out) == []
    assert between == 1, "between the two renames"


@contextmanager
def full_disk(name: str, at: int) -> Iterator[None]:
    """A function of `os` that fails in its call number `at`."""
    calls, works = iter(range(1, 10_000)), getattr(os, name)

    def fails(*arguments: Any, **more: Any) -> Any:
        if next(calls) == at:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return works(*arguments, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, name, fails)
        yield


def test_a_full_disk_loses_nothing_solved(
    undisturbed: tuple[dict[str, str], int], tmp_path: Path
) -> None:
    """At each write of a run; what was solved before is there to resume."""
    whole, _ = undisturbed
    for number in range(1, 100):
        out = write_run(tmp_path / str(number) / "run")
        try:
            with full_disk("fsync", number):
                solve(out)
            break
        except ResultError as error:
            solved = pieces_in(out.parent)
            words = " ".join((str(error), *getattr(error, "__notes__", ())))
        assert "No space left on device" in words
        assert ("--resume" in words) == (solved > 0)
        assert (entries(out.parent) == ["run"]) == (solved == 0)
        assert solve(out, resume=True) == solved
        assert contents(out) == whole
        assert entries(out.parent) == ["run"]
    assert number > 12, "10 writes after the first piece"


PAGE, PICTURE = "8_report.html", "figures/lift.png"


def amend(run: Path, words: str = "new") -> None:
    """Write a page and a picture into a finished run."""
    with amended(run) as place:
        for name in (PAGE, PICTURE):
            write_atomic(place / name, words)


def sign_it(run: Path) -> None:
    private = Ed25519PrivateKey.from_private_bytes(bytes(32))
    sign(run, private, "checked", "A. Meyer", "2026-01-31T12:00:00Z")


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("write", [amend, sign_it])
def test_a_finished_run_is_whole_after_a_kill_before_every_change(
    write: Callable[[Path], None], tmp_path: Path, command: Command
) -> None:
    """As before, as after, or named by `check` as incomplete until a command completes it."""
    original = write_run(tmp_path / "original")
    amend(original, "old")
    before = contents(original)
    write(shutil.copytree(original, tmp_path / "whole"))
    whole = contents(tmp_path / "whole")
    assert whole != before
    half = 0
    for number in range(1, 100):
        out = shutil.copytree(original, tmp_path / str(number))

        def killed(out: Path = out, number: int = number) -> None:
            changes_counted(out, number, kill_myself)
            write(out)
            os._exit(0)

        status = os.waitstatus_to_exitcode(in_a_child(killed))
        code, _, errors = command("check", out)
        assert "Traceback" not in errors
        if status == 0:
            break
        assert status == -signal.SIGKILL
        if code == ALTERED:
            half += 1
            assert errors.splitlines() == [
                f"camwright: {out}/.amendment: an interrupted `camwright report`, `inspect`, "
                "`contact deck` or `sign run` has not moved all its files into place: run it again"
            ]
        else:
            assert code == PASSED
            assert contents(out) in (before, whole), number
            left = any(each.is_file() for each in out.rglob(".amendment/**/*"))
            assert left == ("running or was interrupted" in errors), number
        complete_amendment(out)
        assert contents(out) in (before, whole), number
        if contents(out) == before:
            write(out)
        assert contents(out) == whole, number
        assert entries(out) == entries(tmp_path / "whole"), number
        assert signoff.changes(out) == []
    assert number > 10
    moved = {*whole.items()} - {*before.items()}
    assert half == 2 * len(moved), "before its folder is made sure of, and before it is moved"


@pytest.mark.parametrize(("call", "last"), [("fsync", 3), ("rename", 1), ("replace", 3)])
def test_a_full_disk_leaves_a_finished_run_as_it_was(tmp_path: Path, call: str, last: int) -> None:
    out = write_run(tmp_path / "run")
    amend(out, "old")
    before, names = contents(out), entries(out)
    for number in range(1, last + 1):
        with pytest.raises(ResultError, match="No space left"), full_disk(call, number):
            amend(out)
        assert contents(out) == before
        assert entries(out) == names
        assert signoff.changes(out) == []
    amend(out)
    assert (out / PAGE).read_text() == "new"


def test_files_that_cannot_all_be_moved_are_moved_by_the_next_command(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    amend(out, "old")
    with pytest.raises(ResultError, match="No space left"), full_disk("replace", 5):
        amend(out)
    assert (out / PAGE).read_text() == "new"
    assert (out / PICTURE).read_text() == "old"
    assert [each.added for each in signoff.changes(out)] == [False]
    with pytest.raises(ResultError, match="signed alone"), amended(out):
        raise ResultError("signed alone")
    assert (out / PICTURE).read_text() == "new"
    assert signoff.changes(out) == []


def test_two_processes_do_not_write_into_a_run(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    with amended(out) as place:
        write_atomic(place / PAGE, "first")
        with pytest.raises(ResultError, match="another process is writing to it"):
            amend(out)
    assert (out / PAGE).read_text() == "first"
    assert signoff.changes(out) == []


@pytest.mark.parametrize("name", [".amendment", ".amendment/complete", ".amendment/lock"])
def test_a_link_in_place_of_added_files_is_not_followed(tmp_path: Path, name: str) -> None:
    out = write_run(tmp_path / "run")
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "letter.txt").write_text("private")
    (out / name).parent.mkdir(exist_ok=True)
    (out / name).symlink_to(tmp_path / "home")
    assert [each.name for each in signoff.changes(out)] == [name]
    with pytest.raises(AlteredError, match=f"{name}: is a link"):
        amend(out)
    assert (tmp_path / "home" / "letter.txt").read_text() == "private"


def test_an_interrupted_report_does_not_keep_a_run_from_being_replaced(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    write_atomic(out / ".amendment" / "partial" / PAGE, "half")
    solve(out)
    assert entries(out.parent) == ["run"]
    assert ".amendment" not in entries(out)


def read_only(folder: Path) -> None:
    """Refuse every change in a folder for the rest of this process, as a read-only disk does."""

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        writes = event in CHANGES or (event == "open" and arguments[2] & (os.O_WRONLY | os.O_RDWR))
        if writes and changed(arguments if event in CHANGES else arguments[:1]).startswith(
            str(folder)
        ):
            raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(arguments[0]))

    sys.addaudithook(hook)


STUDY = """
name = "small"
case = "case.toml"
depth = "preview"
[[factor]]
key = "spring.preload"
list = ["400 N", "401 N"]
[sampling]
method = "grid"
"""


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize(
    "line",
    [
        "run case.toml --depth preview --out disk/new",
        pytest.param("run case.toml --out disk/run --replace", marks=pytest.mark.slow),
        "report disk/run",
        "contact deck disk/run --angle 10",
        "sign run disk/run --key key --role checked --name A",
        "study run study.toml --jobs 1 --out disk/study",
        "check disk/run",
    ],
)
def test_a_read_only_disk_is_named_in_one_line(
    line: str, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`check` writes nothing; every other command says what it cannot write."""
    disk = tmp_path / "disk"
    write_run(disk / "run")
    (tmp_path / "case.toml").write_text(small_machine("small"))
    (tmp_path / "study.toml").write_text(STUDY)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    write_key(tmp_path / "key")
    monkeypatch.chdir(tmp_path)
    said = tmp_path / "said.json"

    def work() -> None:
        read_only(disk)
        said.write_text(json.dumps(command(*line.split())))

    before = contents(disk)
    in_a_child(work)
    code, _, errors = json.loads(said.read_text())
    assert contents(disk) == before
    if line.startswith("check"):
        assert (code, errors) == (PASSED, "")
    else:
        assert code == ERROR
        assert re.fullmatch(r"(designs\n)?camwright: .*disk.*: Read-only file system\n", errors)


@pytest.mark.parametrize("number", [1, 2])
def test_a_complete_run_that_cannot_take_its_place_is_kept(
    undisturbed: tuple[dict[str, str], int], tmp_path: Path, number: int
) -> None:
    out = write_run(tmp_path / "run")
    before = contents(out)
    with pytest.raises(ResultError, match="No space left") as raised, full_disk("rename", number):
        solve(out)
    assert "--resume" in raised.value.__notes__[0]
    assert contents(out) == before
    complete_exchange(out)
    assert contents(out) == undisturbed[0]
    assert entries(tmp_path) == ["run"]


def test_a_signed_run_is_not_replaced_by_one_that_was_complete(tmp_path: Path) -> None:
    """Signed after the process that would have replaced it was killed."""
    out = write_run(tmp_path / "run")
    solve(tmp_path / "other")
    (tmp_path / "other").rename(tmp_path / ".run.partial")
    (out / signoff.SIGNATURES).write_text("{}")
    complete_exchange(out)
    assert run_reader.read_run(out).verdict == "pass"
    (out / signoff.SIGNATURES).unlink()
    complete_exchange(out)
    assert run_reader.read_run(out).verdict == "fail"
    assert entries(tmp_path) == ["run"]

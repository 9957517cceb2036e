"""Run folders of processes that are killed, or that cannot write, at every operation on a file."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_machine import small_machine
from small_run import TORQUE, check, summary, values, write_run, write_trial

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import file_hashes
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.folder_exchange import complete_exchange
from camwright.pipeline.results.run_folder import RunFolder

CHANGES = ("os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.chmod", "tempfile.mkstemp")
"""Audit events of operations that change a folder."""

PIECES = 3


def later_version() -> Any:
    return parse_case(small_machine("small").replace('"400 N"', '"401 N"'))


def solve(out: Path, *, resume: bool = False) -> int:
    """A run in place of an earlier version of its case; number of pieces that were not solved."""
    with RunFolder(out, later_version(), resume=resume, replace=True) as folder:
        store = folder.contact_store(1)
        known = store.load("idle", "a")
        for index in range(PIECES):
            if index not in known:
                store.save("idle", index, {"p0": np.arange(3) / (7.0 + index)}, "a")
        folder.write_torque(values(TORQUE))
        write_trial(folder, [check("fail")])
        folder.write_summary(summary("fail"))
        (folder.path / "8_report.html").write_text("page")
        folder.finish(summary("fail"))
    return len(known)


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
        if event in CHANGES and str(arguments[0]).startswith(str(folder)):
            count += 1
            if count == at:
                act()

    sys.addaudithook(hook)
    return lambda: count


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

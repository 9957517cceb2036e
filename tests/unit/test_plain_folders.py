"""Run and study folders hold files and folders alone: a link, pipe, socket or device is refused by
name before anything is read or written. No array is larger than its file can hold.
"""

from __future__ import annotations

import io
import os
import shutil
import socket
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from small_machine import small_machine
from small_run import small_case, write_run

from camwright.geometry.errors import AlteredError, ResultError
from camwright.pipeline.base.files import (
    file_hashes,
    npz_bytes,
    read_npz,
    require_plain,
    write_atomic,
)
from camwright.pipeline.commands.terminal import ALTERED, ERROR
from camwright.pipeline.cycle.contact_store import kept_piece
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.field_file import read_series
from camwright.pipeline.results.folder_exchange import amended
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.signing_keys import write_key
from camwright.pipeline.studies.batch.study_folder import StudyFolder

Command = Callable[..., tuple[int, str, str]]

ODD: dict[str, tuple[str, Callable[[Path, Path], object]]] = {
    "link to a folder": ("a link", lambda place, home: place.symlink_to(home)),
    "link to the run": ("a link", lambda place, _: place.symlink_to(".")),
    "link to a file": ("a link", lambda place, home: place.symlink_to(home / "letter.txt")),
    "broken link": ("a link", lambda place, _: place.symlink_to("nowhere")),
    "link to a pipe": ("a link", lambda place, home: place.symlink_to(home / "pipe")),
    "pipe": ("a named pipe", lambda place, _: os.mkfifo(place)),
    "socket": ("a socket", lambda place, _: bound(place)),
}
PLACES = ("keys", "trial_1/keys", ".amendment/complete/keys", "1_speed.csv", "inputs")
COMMANDS = (
    ("check", "--recompute"),
    ("check", "--verify-record", "--trusted", "{keys}"),
    ("report",),
    ("sign run", "--key", "{key}", "--role", "checked", "--name", "A"),
    ("contact deck", "--angle", "10"),
    ("inspect", "{points}"),
)


def bound(place: Path) -> None:
    there = Path.cwd()
    os.chdir(place.parent)  # the path of a socket is short
    try:
        with socket.socket(socket.AF_UNIX) as one:
            one.bind(place.name)
    finally:
        os.chdir(there)


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of the user outside of the run."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    folder = tmp_path / "home"
    folder.mkdir()
    (folder / "letter.txt").write_text("private")
    (folder / "points.csv").write_text("x_mm,y_mm\n1,2\n")
    os.mkfifo(folder / "pipe")
    write_key(folder / "key")
    return folder


def contents(folder: Path) -> dict[str, str]:
    """Every entry by its kind and bytes; no link is followed and no pipe opened."""
    return {
        str(each.relative_to(folder)): str(
            each.readlink()
            if each.is_symlink()
            else each.read_bytes()
            if each.is_file()
            else each.stat().st_mode
        )
        for each in folder.rglob("*")
    }


@pytest.fixture(scope="module")
def run_of_all(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("all") / "run")


def refused(run: Path, home: Path, odd: str, line: tuple[str, ...], command: Command) -> None:
    """At every place of a run a command names what is no file, and touches nothing."""
    kind, make = ODD[odd]
    known = {"key": home / "key", "keys": home / "key.pub", "points": home / "points.csv"}
    name, *options = (each.format(**known) for each in line)
    for place in PLACES:
        (run / place).parent.mkdir(parents=True, exist_ok=True)
        make(run / place, home)
        before = contents(run) | contents(home)
        code, said, errors = command(*name.split(), run, *options)
        assert (code, said) == (ALTERED, "")
        assert errors.strip().endswith(f"{run / place}: is {kind}; only files and folders are read")
        assert contents(run) | contents(home) == before
        (run / place).unlink()


@pytest.mark.parametrize("odd", ODD)
def test_what_is_no_file_is_refused_by_name(
    run_of_all: Path, home: Path, odd: str, command: Command
) -> None:
    refused(run_of_all, home, odd, ("check",), command)


@pytest.mark.parametrize("line", COMMANDS, ids=lambda line: line[0])
def test_every_command_refuses_what_is_no_file(
    run_of_all: Path, home: Path, line: tuple[str, ...], command: Command
) -> None:
    for odd in ("link to a folder", "pipe"):
        refused(run_of_all, home, odd, line, command)


def test_a_file_outside_is_not_overwritten_by_files_on_their_way(
    home: Path, tmp_path: Path, command: Command
) -> None:
    run = write_run(tmp_path / "run")
    (run / "keys").symlink_to(home)
    write_atomic(run / ".amendment" / "complete" / "keys" / "letter.txt", "forged")
    for name, *options in (
        ("report",),
        ("sign run", "--key", home / "key", "--role", "checked", "--name", "A"),
    ):
        code, _, errors = command(*name.split(), run, *options)
        assert code == ALTERED
        assert "keys: is a link" in errors
        assert (home / "letter.txt").read_text() == "private"
    _, _, errors = command("check", run)
    assert "run it again" not in errors


def test_a_signed_file_in_place_of_which_there_is_a_link_is_not_accepted(
    home: Path, tmp_path: Path, command: Command
) -> None:
    run = write_run(tmp_path / "run")
    key = home / "key"
    assert command("sign", "run", run, "--key", key, "--role", "checked", "--name", "A")[0] == 0
    verify = ("check", run, "--verify-record", "--trusted", f"{key}.pub")
    assert command(*verify)[0] == 0
    table = run / "trial_1" / "5_cycle.csv"
    table.rename(home / table.name)
    table.symlink_to(home / table.name)
    code, _, errors = command(*verify)
    assert code == ALTERED
    assert "trial_1/5_cycle.csv: is a link" in errors


def test_the_path_of_a_run_may_be_a_link(tmp_path: Path) -> None:
    run = write_run(tmp_path / "run")
    (tmp_path / "latest").symlink_to(run)
    assert signoff.changes(tmp_path / "latest") == []
    assert signoff.read_run(tmp_path / "latest").verdict == "pass"


def test_a_file_of_two_names_keeps_its_other_name(tmp_path: Path) -> None:
    """A hard link is a plain file; what is written takes the place of one name."""
    run = write_run(tmp_path / "run")
    with amended(run) as place:
        write_atomic(place / "8_report.html", "old")
    os.link(run / "8_report.html", tmp_path / "copy.html")
    assert signoff.changes(run) == []
    with amended(run) as place:
        write_atomic(place / "8_report.html", "new")
    assert (run / "8_report.html").read_text() == "new"
    assert (tmp_path / "copy.html").read_text() == "old"


def test_a_run_is_not_written_over_or_resumed_through_a_link(home: Path, tmp_path: Path) -> None:
    run = write_run(tmp_path / "run")
    (run / "workshop").symlink_to(home)
    with pytest.raises(ResultError, match="workshop: is a link"):
        RunFolder(run, small_case(), replace=True)
    with pytest.raises(KeyboardInterrupt), RunFolder(tmp_path / "new", small_case()) as folder:
        kept_piece(folder.contact_store(1), "idle", 0, "a", lambda: {"p0": np.arange(3.0)})
        raise KeyboardInterrupt
    shutil.rmtree(tmp_path / ".new.partial" / ".chunks" / "trial_1")
    (tmp_path / ".new.partial" / ".chunks" / "trial_1").symlink_to(home)
    with pytest.raises(ResultError, match="trial_1: is a link"):
        RunFolder(tmp_path / "new", small_case(), resume=True)
    assert (home / "letter.txt").read_text() == "private"


def test_a_lock_is_not_made_through_a_link(home: Path, tmp_path: Path) -> None:
    (tmp_path / ".run.lock").symlink_to(home / "new")
    with pytest.raises(ResultError):
        RunFolder(tmp_path / "run", small_case())
    assert not (home / "new").exists()


@pytest.mark.parametrize("name", ["shards/a.parquet", "runs/a", "runs/a/b", "dataset.parquet"])
def test_a_study_folder_holds_files_and_folders_alone(
    home: Path, tmp_path: Path, name: str, command: Command
) -> None:
    study = tmp_path / "study"
    with StudyFolder(study, resume=False) as made:
        made.write_inputs("x = 1\n", ())
    (study / name).parent.mkdir(parents=True, exist_ok=True)
    (study / name).symlink_to(home)
    before = contents(tmp_path)
    with pytest.raises(ResultError, match=name), StudyFolder(study, resume=True):
        pass
    code, _, errors = command("study", "report", study)
    assert code == ERROR
    assert f"{name}: is a link" in errors
    assert contents(tmp_path) == before


def test_a_baseline_and_a_read_run_too(home: Path, tmp_path: Path, command: Command) -> None:
    run, baseline = write_run(tmp_path / "run"), write_run(tmp_path / "baseline")
    (baseline / "notes").symlink_to(home)
    assert command("check", run, "--baseline", baseline)[0] == ALTERED
    for read in (run_reader.read_run, signoff.read_run, run_reader.read_verdict):
        with pytest.raises(AlteredError, match="notes: is a link"):
            read(baseline)


def test_deep_folders_are_walked(tmp_path: Path) -> None:
    deep = tmp_path
    for _ in range(300):
        deep = deep / "a"
    deep.mkdir(parents=True)
    require_plain(tmp_path)
    (deep / "x").symlink_to(".")
    with pytest.raises(ResultError, match="a/x: is a link"):
        require_plain(tmp_path)


# --- sizes

ARRAYS: dict[str, Any] = {
    "numbers": np.arange(24.0).reshape(2, 3, 4),
    "columns": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    "words": np.array(["idle", "a longer word"]),
    "none": np.zeros((0, 3)),
    "one": np.array(7),
    "flags": np.array([True, False]),
    "same": np.zeros(200_000),
}


@pytest.mark.parametrize("compressed", [True, False])
def test_arrays_are_read_as_numpy_reads_them(tmp_path: Path, compressed: bool) -> None:
    file = write_atomic(tmp_path / "a.npz", npz_bytes(ARRAYS, compressed=compressed))
    arrays = read_npz(file)
    with np.load(file, allow_pickle=False) as stored:
        assert list(arrays) == stored.files
        for name, values in arrays.items():
            assert values.dtype == stored[name].dtype
            assert values.flags.f_contiguous == stored[name].flags.f_contiguous
            np.testing.assert_array_equal(values, stored[name])


def header(shape: str, kind: str = "<f8") -> bytes:
    """A file of numpy whose header claims a shape, with 80 bytes of data."""
    whole = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        whole, {"descr": kind, "fortran_order": False, "shape": (10,)}
    )
    claimed = whole.getvalue().replace(b"(10,)", shape.encode().ljust(5))
    added = len(claimed) - len(whole.getvalue())
    return claimed.replace(b" " * (added + 1), b" ", 1)[: len(whole.getvalue())] + bytes(80)


def archive(content: bytes, **changes: int) -> bytes:
    """An archive of one member, whose central directory claims another size."""
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as opened:
        opened.writestr("a.npy", content)
        for name, value in changes.items():
            setattr(opened.filelist[0], name, value)
    return whole.getvalue()


@pytest.mark.parametrize(
    "content",
    [
        archive(header("(10**13,)".replace("10**13", str(10**13)))),
        archive(header("(11,)")),
        archive(header("(9,)")),
        archive(header("(10,)"), file_size=1 << 31),
        archive(header("(10,)"), compress_size=1 << 31),
        archive(header("(10,)", "|O")),
        archive(bytes(1 << 20)),
        archive(b""),
        archive(header("(10,)"))[:-30],
        b"no archive",
    ],
    ids=[
        "80 TB", "one more", "one less", "member", "packed", "objects", "zeros", "empty", "cut",
        "text",
    ],
)  # fmt: skip
def test_an_archive_that_claims_more_than_it_holds_is_refused(
    tmp_path: Path, content: bytes
) -> None:
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(ResultError, match=r"a\.npz"):
        read_npz(tmp_path / "a.npz")


def field(path: Path, change: Callable[[h5py.Group], object]) -> Path:
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root["Steps/Values"] = np.arange(3.0)
        root["FieldData/p0"] = np.arange(3.0)
        root.create_dataset("Points", data=np.zeros((50_000, 3)), chunks=True, compression="gzip")
        change(root)
    return path


def test_a_field_that_claims_more_than_it_holds_is_refused(tmp_path: Path) -> None:
    whole = read_series(field(tmp_path / "a.vtkhdf", lambda _: None))
    assert whole.times.tolist() == [0.0, 1.0, 2.0]
    write_atomic(tmp_path / "outside.h5", "")
    changes: dict[str, Callable[[h5py.Group], object]] = {
        "FieldData/big": lambda root: root.create_dataset(
            "FieldData/big", (10**13,), "f8", chunks=(1000,)
        ),
        "FieldData/far": lambda root: root.__setitem__(
            "FieldData/far", h5py.ExternalLink("outside.h5", "/")
        ),
        "FieldData/raw": lambda root: root.create_dataset(
            "FieldData/raw", (10,), "f8", external=[(str(tmp_path / "raw"), 0, 80)]
        ),
    }
    for name, change in changes.items():
        with pytest.raises(ResultError, match=f"{name} (claims|lies)"):
            read_series(field(tmp_path / "b.vtkhdf", change))


def test_a_case_beside_its_run(tmp_path: Path, command: Command) -> None:
    """The files of a case are plain, too: no pipe is opened."""
    text = small_machine("small")
    engine = text[text.index("[engine]") : text.index("[mechanism]")]
    case = tmp_path / "case.toml"
    case.write_text(text.replace(engine, '[engine]\nkind = "table"\nfile = "torque.csv"\n'))
    os.mkfifo(tmp_path / "torque.csv")
    assert command("run", case, "--out", tmp_path / "run")[0] == ERROR
    assert command("inspect", write_run(tmp_path / "b"), tmp_path / "torque.csv")[0] == ERROR
    assert file_hashes(tmp_path, lambda name: name.startswith("run/")) == {}

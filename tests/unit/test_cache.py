"""The store of arrays between runs."""

import multiprocessing
import os

import numpy as np
import pytest

from camwright.pipeline.base import disk_cache, store

MODULES = (disk_cache,)


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.delenv(disk_cache.OFF, raising=False)
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path / "kept"))
    return tmp_path / "kept"


class Maker:
    def __init__(self, value=1.0):
        self.calls, self.value = 0, value

    def __call__(self):
        self.calls += 1
        return {"a": np.full((3, 2), self.value), "b": np.arange(4.0)}


def asked(maker, what=(0.3, 16)):
    return disk_cache.kept("thing", what, maker, MODULES)


def test_computes_once_and_reads_back_bit_for_bit(place):
    maker = Maker(1 / 3)
    first, second = asked(maker), asked(maker)
    assert maker.calls == 1
    assert sorted(second) == ["a", "b"]
    assert all(np.array_equal(first[name], second[name]) for name in first)
    assert [path.suffix for path in place.iterdir()] == [".npz"]


@pytest.mark.parametrize("off", ["", "1"])
def test_arrays_lie_in_memory_as_they_are_read_back(place, monkeypatch, off):
    monkeypatch.setenv(disk_cache.OFF, off)
    made = disk_cache.kept("thing", 1, lambda: {"a": np.ones((3, 4)).T, "n": np.array(7)}, MODULES)
    assert made["a"].flags.c_contiguous
    assert made["n"].shape == ()


def test_another_question_is_another_entry(place):
    maker = Maker()
    asked(maker), asked(maker, (0.3, 8))
    assert maker.calls == 2
    assert len(list(place.iterdir())) == 2


@pytest.mark.parametrize("spoil", ["empty", "cut", "flipped", "text"])
def test_a_broken_entry_is_computed_again(place, spoil):
    maker = Maker()
    asked(maker)
    (path,) = place.iterdir()
    good = path.read_bytes()
    middle = len(good) // 2
    path.write_bytes(
        {
            "empty": b"",
            "cut": good[:middle],
            "flipped": good.replace(np.float64(1.0).tobytes(), np.float64(2.0).tobytes(), 1),
            "text": b"not an archive",
        }[spoil]
    )
    assert path.read_bytes() != good
    found = asked(maker)
    assert maker.calls == 2
    assert (found["a"] == 1.0).all()
    assert asked(maker)["a"].shape == (3, 2)
    assert maker.calls == 2, "the broken entry was not replaced"


def test_new_versions_leave_old_entries_behind(place, monkeypatch):
    maker = Maker()
    asked(maker)
    monkeypatch.setattr(store, "_versions", lambda: ("camwright 99",))
    asked(maker)
    assert maker.calls == 2


def test_a_changed_recipe_leaves_old_entries_behind(place, monkeypatch):
    maker = Maker()
    asked(maker)
    monkeypatch.setattr(store, "_source", lambda module: b"another text")
    asked(maker)
    assert maker.calls == 2


def test_switched_off_it_neither_reads_nor_writes(place, monkeypatch):
    maker = Maker()
    asked(maker)
    monkeypatch.setenv(disk_cache.OFF, "1")
    asked(maker), asked(maker, "other")
    assert maker.calls == 3
    assert len(list(place.iterdir())) == 1


def test_what_was_not_used_for_longest_makes_room(place, monkeypatch):
    maker = Maker()
    for number in range(3):
        asked(maker, number)
    entries = sorted(place.iterdir(), key=lambda path: path.stat().st_mtime_ns)
    for age, path in zip((30, 20, 10), entries, strict=True):
        os.utime(path, (1e9 - age, 1e9 - age))
    asked(maker, 0)  # used again: now the newest
    monkeypatch.setattr(disk_cache, "LARGEST", 2 * entries[0].stat().st_size + 10)
    asked(maker, 3)
    assert maker.calls == 4
    left = set(place.iterdir())
    assert len(left) == 2
    assert entries[0] in left and not {entries[1], entries[2]} & left


def test_a_folder_that_cannot_be_made_is_no_error(place):
    place.write_text("a file in the way")
    maker = Maker()
    asked(maker), asked(maker)
    assert maker.calls == 2
    assert place.read_text() == "a file in the way"


def test_the_users_cache_folder_is_the_default(monkeypatch, tmp_path):
    monkeypatch.delenv(disk_cache.OFF, raising=False)
    monkeypatch.delenv(disk_cache.FOLDER, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert disk_cache.folder() == tmp_path / "camwright"


def _write_often(folder):
    os.environ[disk_cache.FOLDER] = folder
    for turn in range(20):
        found = disk_cache.kept("race", turn % 3, Maker(float(turn % 3)), MODULES)
        if not (found["a"] == turn % 3).all():
            raise ValueError("a torn entry was read")


def test_writers_at_one_time_leave_whole_entries(place):
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        pool.map(_write_often, [str(place)] * 2)
    assert len(list(place.glob("*.npz"))) == 3
    assert not list(place.glob(".*.tmp"))

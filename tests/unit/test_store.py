"""Stores: whoever writes and whatever fails, an entry is whole, or counts as missing."""

from __future__ import annotations

import errno
import os
import pickle
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from camwright.geometry.errors import ResultError
from camwright.pipeline.base import store
from camwright.pipeline.base.store import ARRAYS, JSON, PACKED, Format, Store, key_of

FEW = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
KEY = "idle/000007"  # keys may name a folder

names = st.text("abcdefgh_", min_size=1, max_size=6)
numbers = st.floats(allow_nan=False, allow_infinity=False)
integers = st.integers(-(2**63), 2**63 - 1)
plain = st.one_of(st.none(), st.booleans(), integers, numbers, st.text('aä"\\'))
records = st.dictionaries(st.text(max_size=8), plain, max_size=4)
shapes = st.lists(st.integers(0, 4), max_size=3).map(tuple)
arrays = st.dictionaries(
    names,
    st.tuples(shapes, st.sampled_from("CF"), numbers).map(
        lambda each: np.full(each[0], each[2], order=each[1])
    ),
    min_size=1,
    max_size=3,
)
values = st.one_of(
    st.tuples(st.just(JSON), records),
    st.tuples(st.sampled_from([ARRAYS, PACKED]), arrays),
)


def same(one: Any, two: Any) -> bool:
    """Whether two values are equal, arrays in shape, type and order too."""
    if isinstance(one, np.ndarray):
        alike = (
            one.shape == two.shape
            and one.dtype == two.dtype
            and one.flags.f_contiguous == two.flags.f_contiguous
        )
        return alike and bool((one == two).all())
    if isinstance(one, dict):
        return list(one) == list(two) and all(same(one[name], two[name]) for name in one)
    return type(one) is type(two) and bool(one == two)


@pytest.fixture(autouse=True)
def no_loss_of_power(monkeypatch: pytest.MonkeyPatch) -> None:
    """No entry waits for the disk."""
    monkeypatch.setattr(os, "fsync", lambda _: None)


@contextmanager
def folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as name:
        yield Path(name) / "kept"


def files(place: Path) -> list[str]:
    """Files under a folder, those that were written aside too."""
    return sorted(each.name for each in place.rglob("*") if each.is_file())


def content(of: Store[Any], key: str = KEY) -> bytes:
    path = of.path(key)
    assert path is not None
    return path.read_bytes()


@contextmanager
def failing(call: str, code: int, after: int = 0) -> Iterator[None]:
    """An operation on files that fails, after some calls of it."""
    module, _, name = call.rpartition(".")
    place: Any = {"os": os, "tempfile": tempfile, "Path": Path}[module]
    true: Callable[..., Any] = getattr(place, name)
    left = after

    def fails(*arguments: Any, **named: Any) -> Any:
        nonlocal left
        if left > 0:
            left -= 1
            return true(*arguments, **named)
        raise OSError(code, os.strerror(code))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(place, name, fails)
        yield


@FEW
@given(values)
def test_a_value_is_read_back_to_the_bit(given: tuple[Format[Any], Any]) -> None:
    file_format, value = given
    with folder() as place:
        of = Store(place, file_format)
        assert of.get(KEY) is None and not of.holds(KEY)
        first = of.kept(KEY, lambda: value)
        again = of.kept(KEY, lambda: pytest.fail("computed again"))
        assert same(first, again) and same(of.get(KEY), file_format.as_read(value))
        assert of.holds(KEY) and files(place) == [f"000007{file_format.suffix}"]
        whole = content(of)
        of.put(KEY, value)
        assert content(of) == whole == file_format.write(again)
        of.delete(KEY)
        of.delete(KEY)
        assert not of.holds(KEY) and files(place) == []


@FEW
@given(values, st.data())
def test_a_cut_entry_is_missing_and_written_again(
    given: tuple[Format[Any], Any], data: st.DataObject
) -> None:
    file_format, value = given
    with folder() as place:
        of = Store(place, file_format)
        of.put(KEY, value)
        path, whole = place / f"{KEY}{file_format.suffix}", content(of)
        # the last character of a record is a line end
        least = 2 if file_format is JSON else 1
        path.write_bytes(whole[: data.draw(st.integers(0, len(whole) - least))])
        assert of.get(KEY) is None
        assert same(of.kept(KEY, lambda: value), file_format.as_read(value))
        assert of.get(KEY) is not None and files(place) == [path.name]


@FEW
@given(st.sampled_from([ARRAYS, PACKED]), arrays, st.data())
def test_an_altered_archive_is_never_another_value(
    file_format: Format[Any], value: Any, data: st.DataObject
) -> None:
    with folder() as place:
        of = Store(place, file_format)
        of.put(KEY, value)
        altered = bytearray(content(of))
        at = data.draw(st.integers(0, len(altered) - 1))
        altered[at] ^= data.draw(st.integers(1, 255))
        (place / f"{KEY}.npz").write_bytes(altered)
        known, true = of.get(KEY), file_format.as_read(value)
        # outside of what the check sums cover stand the names of the members
        assert known is None or all(
            any(same(each, other) for other in true.values()) for each in known.values()
        )


@pytest.mark.parametrize("text", ["", "[]", "3", '"a"', '{"a": NaN}', '{"a": 1, "a": 2}', "\xff"])
def test_what_is_no_record_is_missing(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.json").write_bytes(text.encode("latin-1"))
    assert Store(tmp_path, JSON).get("a") is None


@FEW
@given(values, st.booleans())
def test_writers_of_one_entry_leave_a_whole_one(given: tuple[Format[Any], Any], must: bool) -> None:
    """Another writer, and a reader, between what one writes aside and its move."""
    file_format, value = given
    with folder() as place:
        of = Store(place, file_format, must=must)
        move, seen = Path.replace, list[Any]()

        def moved(path: Path, target: Path) -> Path:
            with pytest.MonkeyPatch.context() as inner:
                inner.setattr(Path, "replace", move)
                seen.append(of.get(KEY))
                of.put(KEY, value)
                seen.append(of.get(KEY))
            return move(path, target)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Path, "replace", moved)
            of.put(KEY, value)
        assert seen[0] is None and seen[1] is not None and same(seen[1], of.get(KEY))
        assert files(place) == [f"000007{file_format.suffix}"]


@FEW
@given(values, st.sampled_from(["tempfile.mkstemp", "os.fdopen", "Path.chmod", "Path.replace"]))
def test_an_entry_that_cannot_be_written(given: tuple[Format[Any], Any], call: str) -> None:
    """It is an error where it must be; an earlier one stays, and nothing is left aside."""
    file_format, value = given
    reason = errno.EACCES if call in ("tempfile.mkstemp", "Path.chmod") else errno.ENOSPC
    with folder() as place:
        may, must = Store(place, file_format, must=False), Store(place, file_format)
        with failing(call, reason):
            assert same(may.kept(KEY, lambda: value), file_format.as_read(value))
            with pytest.raises(ResultError, match=os.strerror(reason)):
                must.kept(KEY, lambda: value)
        assert may.get(KEY) is None and files(place) == []
        must.put(KEY, value)
        whole = content(must)
        with failing(call, reason):
            may.put(KEY, value)
            with pytest.raises(ResultError):
                must.put(KEY, value)
            assert same(must.kept(KEY, lambda: pytest.fail("computed")), file_format.as_read(value))
        assert content(must) == whole and files(place) == [f"000007{file_format.suffix}"]


def test_an_entry_that_must_be_written_is_on_the_disk(tmp_path: Path) -> None:
    with failing("os.fsync", errno.ENOSPC):
        Store(tmp_path, JSON, must=False).put("a", {})
        with pytest.raises(ResultError, match="No space left"):
            Store(tmp_path, JSON).put("b", {})
    assert files(tmp_path) == ["a.json"]


def test_a_read_only_folder_is_read(tmp_path: Path) -> None:
    """Its entries cannot be marked as used, and none can be deleted for others."""
    value = {"a": np.arange(3.0)}
    Store(tmp_path, ARRAYS).put("a", value)
    of = Store(tmp_path, ARRAYS, most=1, must=False)
    with failing("Path.touch", errno.EROFS), failing("Path.unlink", errno.EROFS):
        assert same(of.get("a"), value)
    with failing("tempfile.mkstemp", errno.EROFS):
        of.put("b", value)
    assert files(tmp_path) == ["a.npz"]


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="may write anywhere")
def test_a_folder_without_the_right_to_write(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        assert Store(tmp_path, JSON, must=False).kept("a", lambda: {"b": 1}) == {"b": 1}
        with pytest.raises(ResultError, match="Permission denied"):
            Store(tmp_path, JSON).put("a", {"b": 1})
    finally:
        tmp_path.chmod(0o700)
    assert files(tmp_path) == []


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("mine")
    assert Store(tmp_path / "kept", JSON, must=False).kept("a", lambda: {"b": 1}) == {"b": 1}
    with pytest.raises(ResultError):
        Store(tmp_path / "kept", JSON).put("a", {"b": 1})
    assert (tmp_path / "kept").read_text() == "mine"


@FEW
@given(values)
def test_without_a_folder_nothing_is_stored(given: tuple[Format[Any], Any]) -> None:
    file_format, value = given
    of = Store(None, file_format)
    of.put(KEY, value)
    of.delete(KEY)
    assert of.path(KEY) is None and not of.holds(KEY) and of.get(KEY) is None
    assert same(of.kept(KEY, lambda: value), file_format.as_read(value))


@pytest.mark.parametrize("file_format", [JSON, ARRAYS, PACKED])
def test_a_store_is_handed_to_processes(file_format: Format[Any], tmp_path: Path) -> None:
    of = Store(tmp_path, file_format, most=7, must=False)
    assert pickle.loads(pickle.dumps(of)) == of


def test_a_value_that_does_not_fit_is_computed_again(tmp_path: Path) -> None:
    of = Store(tmp_path, JSON)
    of.put("a", {"of": "another"})
    assert of.get("a", lambda record: record["of"] == "this") is None
    assert of.kept("a", lambda: {"of": "this"}, lambda record: record["of"] == "this")
    assert of.get("a") == {"of": "this"}


@FEW
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 40)), min_size=1, max_size=12),
       st.integers(0, 6000), st.booleans())  # fmt: skip
def test_the_entries_are_no_larger_than_allowed(
    puts: list[tuple[int, int]], most: int, anew: bool
) -> None:
    """The newest alone may be; anew: each by a process that has not measured the folder."""
    with folder() as place:
        of = Store(place, ARRAYS, most=most, must=False)
        store._sizes.clear()
        for clock, (number, size) in enumerate(puts):
            if anew:
                store._sizes.clear()
            of.put(str(number), {"a": np.zeros(size)})
            newest = place / f"{number}.npz"
            os.utime(newest, (clock, clock))
            sizes = {each: each.stat().st_size for each in place.iterdir()}
            assert newest in sizes
            assert sum(sizes.values()) <= max(most, sizes[newest])


def test_the_key_is_that_of_all_that_decides_the_value(monkeypatch: pytest.MonkeyPatch) -> None:
    keys = {key_of("a", (1, 2)), key_of("b", (1, 2)), key_of("a", (1, 3)),
            key_of("a", (1, 2), (store,)), key_of("a", (1, 2), (store, os))}  # fmt: skip
    assert len(keys) == 5
    assert key_of("a", (1, 2)) in keys and key_of("a", (1, 2)).startswith("a-")
    monkeypatch.setattr(store, "_versions", lambda: ("camwright 99",))
    assert key_of("a", (1, 2)) not in keys

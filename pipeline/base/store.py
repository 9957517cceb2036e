"""Key-value store, each value in a file of its folder.

An entry is written aside and moved. Writers of one entry write the same bytes, so they need no
lock. A damaged entry counts as missing.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import sys
from collections.abc import Callable, Hashable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, Generic, TypeVar

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import json_text, npz_bytes, read_json, read_npz, write_atomic

_LIBRARIES = ("camwright", "gmsh", "numpy", "scikit-fem", "scipy")

Arrays = Mapping[str, Array]

T = TypeVar("T")


def _same(value: T) -> T:
    return value


def _any(_: object) -> bool:
    return True


@dataclass(frozen=True)
class Format(Generic[T]):
    """File format of a store: suffix, writer, reader.

    Parameters
    ----------
    suffix : str        of the file names
    write : function    value -> bytes, the same for the same value
    read : function     path -> value; ResultError if the file is missing or damaged
    as_read : function  value -> value that its file gives back
    """

    suffix: str
    write: Callable[[T], bytes]
    read: Callable[[Path], T]
    as_read: Callable[[T], T] = _same


def _json_bytes(record: dict[str, Any]) -> bytes:
    return f"{json_text(record)}\n".encode()


def _read_record(path: Path) -> dict[str, Any]:
    """Record of a JSON file; ResultError if it is no object."""
    record = read_json(path)
    if not isinstance(record, dict):
        raise ResultError(f"{path}: is no record")
    return record


def _laid_out(arrays: Arrays) -> Arrays:
    """Arrays in C order, as they are read back: sums over them then agree to the bit."""
    return {name: np.array(values, order="C") for name, values in arrays.items()}


def _in_order(arrays: Arrays) -> Arrays:
    return {name: np.asarray(values, order="C") for name, values in arrays.items()}


def _loose(arrays: Arrays) -> bytes:
    return npz_bytes(_in_order(arrays), compressed=False)


def _packed(arrays: Arrays) -> bytes:
    return npz_bytes(_in_order(arrays))


JSON: Format[dict[str, Any]] = Format(".json", _json_bytes, _read_record)
ARRAYS: Format[Arrays] = Format(".npz", _loose, read_npz, _laid_out)
PACKED: Format[Arrays] = replace(ARRAYS, write=_packed)
"""Arrays, compressed."""


@dataclass(frozen=True)
class Store(Generic[T]):
    """Key-value store in a folder, each value in a file ``KEY.suffix``.

    Parameters
    ----------
    folder : Path   created when it is needed; None: nothing is stored
    format : Format   of the files
    most : int      bytes of all entries, the least recently used being deleted; None: no limit
    must : bool     an entry is on the disk when it is stored, and one that cannot be written is an
                    error; else it may be missing or cut short after a loss of power
    """

    folder: Path | None
    format: Format[T]
    most: int | None = None
    must: bool = True

    def path(self, key: str) -> Path | None:
        """File of an entry; None if nothing is stored."""
        return None if self.folder is None else self.folder / f"{key}{self.format.suffix}"

    def holds(self, key: str) -> bool:
        """Whether there is a file for a key, damaged or not."""
        path = self.path(key)
        return path is not None and path.is_file()

    def get(self, key: str, fits: Callable[[T], bool] = _any) -> T | None:
        """Value of a key; None if it is missing, damaged or not of the wanted form.

        Parameters
        ----------
        key : str         of the entry
        fits : callable   value -> whether it has the wanted form
        """
        path = self.path(key)
        if path is None:
            return None
        try:
            value = self.format.read(path)
        except ResultError:
            return None
        if not fits(value):
            return None
        if self.most is not None:
            with suppress(OSError):  # a read-only folder
                path.touch()
        return value

    def put(self, key: str, value: T) -> None:
        """Store a value in place of an earlier entry; see `put_written`."""
        if self.folder is not None:
            self.put_written(key, self.format.write(value))

    def put_written(self, key: str, content: bytes) -> None:
        """Store a value whose bytes another process has made.

        Raises
        ------
        ResultError
            If the entry must be written and cannot be, such as on a full disk.
        """
        path = self.path(key)
        if path is None:
            return
        try:
            write_atomic(path, content, durable=self.must)
        except ResultError:
            if self.must:
                raise
            return
        if self.most is not None:
            with suppress(OSError):
                _make_room(path, self.most)

    def delete(self, key: str) -> None:
        """Delete the value of a key, if any."""
        path = self.path(key)
        if path is not None and path.is_file():
            path.unlink(missing_ok=True)

    def kept(self, key: str, compute: Callable[[], T], fits: Callable[[T], bool] = _any) -> T:
        """Value of an entry, or computed and stored where there is none; equal in both cases, to
        the bit.

        Parameters
        ----------
        key : str            of the entry
        compute : callable   -> value
        fits : callable      value -> whether a stored one has the wanted form

        Raises
        ------
        ResultError
            See `put_written`.
        """
        value = self.get(key, fits)
        if value is None:
            value = self.format.as_read(compute())
            self.put(key, value)
        return value


def key_of(kind: str, inputs: Hashable, modules: tuple[ModuleType, ...] = ()) -> str:
    """Key of a value: its kind and the hash of all its inputs.

    Parameters
    ----------
    kind : str         first word of the key
    inputs : hashable  their repr enters the hash, as do the versions of the libraries
    modules : tuple    modules whose source text decides the value
    """
    digest = hashlib.sha256(repr((kind, inputs, _versions(), sys.version_info[:2])).encode())
    for module in modules:
        digest.update(_source(module))
    return f"{kind}-{digest.hexdigest()[:40]}"


def _make_room(newest: Path, most: int) -> None:
    """Delete the least recently used entries of a folder until all are no larger than `most`,
    bytes; not the newest.

    The folder is measured at the first entry of a process and when its own entries fill it.

    Parameters
    ----------
    newest : Path   entry just written
    most : int      bytes of all entries
    """
    place, size = newest.parent, newest.stat().st_size
    if place in _sizes and _sizes[place] + size <= most:
        _sizes[place] += size
        return
    others = [each for each in place.glob(f"*{newest.suffix}") if each != newest]
    entries = [(each.stat(), each) for each in others]
    kept = size
    for state, entry in sorted(entries, key=lambda pair: pair[0].st_mtime, reverse=True):
        kept += state.st_size
        if kept > most:
            entry.unlink(missing_ok=True)
    _sizes[place] = min(kept, most)


_sizes: dict[Path, int] = {}
"""Bytes of the entries of a folder as far as this process knows."""


@lru_cache(maxsize=1)
def _versions() -> tuple[str, ...]:
    """Names of the libraries on which stored values depend, with their versions."""
    versions = []
    for name in _LIBRARIES:
        try:
            versions.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            versions.append(name)
    return tuple(versions)


@lru_cache(maxsize=64)
def _source(module: ModuleType) -> bytes:
    file = module.__file__
    return module.__name__.encode() if file is None else Path(file).read_bytes()

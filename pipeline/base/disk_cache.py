"""Disk cache of arrays that depend on their key alone, kept between runs.

The key is a hash of the inputs, of the versions of the libraries and of the source text of the
modules that compute the arrays, so that a changed module makes a new entry. An unreadable entry
counts as missing. Writers of one entry write the same bytes and replace the file in one step, so
they need no lock.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import sys
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from types import ModuleType

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import npz_bytes, read_npz, write_atomic

FOLDER, OFF = "CAMWRIGHT_CACHE", "CAMWRIGHT_NO_CACHE"
LARGEST = 400_000_000  # bytes in all; the least recently used entry is deleted first
_LIBRARIES = ("camwright", "gmsh", "numpy", "scikit-fem", "scipy")

Arrays = Mapping[str, Array]


def folder() -> Path | None:
    """Folder of the entries; None without a home folder or with the cache switched off."""
    if os.environ.get(OFF):
        return None
    stated = os.environ.get(FOLDER)
    if stated:
        return Path(stated)
    try:
        if sys.platform == "win32":
            return Path(os.environ["LOCALAPPDATA"]) / "camwright" / "Cache"
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches" / "camwright"
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "camwright"
    except (KeyError, RuntimeError):
        return None


def switch_off() -> None:
    """Neither read nor write entries any more, in this process and those it starts."""
    os.environ[OFF] = "1"


@contextmanager
def left_out() -> Iterator[None]:
    """Neither read nor write entries meanwhile, in this process and those it starts."""
    before = os.environ.get(OFF)
    switch_off()
    try:
        yield
    finally:
        if before is None:
            del os.environ[OFF]
        else:
            os.environ[OFF] = before


def key(kind: str, inputs: Hashable, modules: tuple[ModuleType, ...]) -> str:
    """Hash of the inputs, of the libraries' versions and of the modules' source text."""
    digest = hashlib.sha256(repr((kind, inputs, _versions(), sys.version_info[:2])).encode())
    for module in modules:
        digest.update(_source(module))
    return f"{kind}-{digest.hexdigest()[:40]}"


def kept(
    kind: str, inputs: Hashable, compute: Callable[[], Arrays], modules: tuple[ModuleType, ...]
) -> Arrays:
    """Arrays by name, from the cache or computed and written to it.

    Parameters
    ----------
    kind : str               first word of the entry's file name
    inputs : hashable        all that decides the arrays; its repr enters the key
    compute : function       () -> arrays by name
    modules : tuple          modules whose source text decides the arrays
    """
    place = folder()
    if place is None:
        return _laid_out(compute())
    path = place / f"{key(kind, inputs, modules)}.npz"
    arrays = _read(path)
    if arrays is None:
        arrays = _laid_out(compute())
        _write(path, arrays)
    return arrays


def holds(kind: str, inputs: Hashable, modules: tuple[ModuleType, ...]) -> bool:
    """Whether there is an entry; see `kept`."""
    place = folder()
    return place is not None and (place / f"{key(kind, inputs, modules)}.npz").is_file()


def _laid_out(arrays: Arrays) -> dict[str, Array]:
    """Arrays in C order, as they are read back: sums over them then agree to the bit."""
    return {name: np.array(values, order="C") for name, values in arrays.items()}


def _read(path: Path) -> dict[str, Array] | None:
    """Arrays of an entry; None if it is missing, cut short or altered (zip has check sums)."""
    try:
        arrays = read_npz(path)
    except ResultError:
        return None
    with suppress(OSError):  # a read-only folder
        path.touch()
    return arrays


def _write(path: Path, arrays: Arrays) -> None:
    """Write an entry; a folder that cannot be written is no error."""
    with suppress(OSError, ResultError):
        write_atomic(path, npz_bytes(arrays, compressed=False), durable=False)
        _make_room(path)


def _make_room(newest: Path) -> None:
    """Delete the least recently used entries until the rest is no larger than `LARGEST`.

    The folder is measured at the first entry of a process and when its own entries fill it.
    """
    place, size = newest.parent, newest.stat().st_size
    if place in _sizes and _sizes[place] + size <= LARGEST:
        _sizes[place] += size
        return
    entries = [(entry.stat(), entry) for entry in place.glob("*.npz") if entry != newest]
    kept = size
    for state, entry in sorted(entries, key=lambda pair: pair[0].st_mtime, reverse=True):
        kept += state.st_size
        if kept > LARGEST:
            entry.unlink(missing_ok=True)
    _sizes[place] = min(kept, LARGEST)


_sizes: dict[Path, int] = {}
"""Bytes of the entries of a folder as far as this process knows."""


@lru_cache(maxsize=1)
def _versions() -> tuple[str, ...]:
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

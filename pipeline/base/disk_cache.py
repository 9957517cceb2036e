"""Arrays that are costly to compute and depend on nothing but their key, kept between runs.

The key holds what the arrays were asked for, the versions of the libraries they come from and
the text of the modules that compute them, so that an entry never outlives its recipe. A broken
or foreign entry counts as none. Writers of one entry write the same bytes, each to a file of
its own that then takes the place, so they need no lock.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import sys
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from types import ModuleType

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import npz_bytes, write_atomic

FOLDER, OFF = "CAMWRIGHT_CACHE", "CAMWRIGHT_NO_CACHE"
LARGEST = 400_000_000  # bytes in all; what was not used for longest goes first
_LIBRARIES = ("camwright", "gmsh", "numpy", "scikit-fem", "scipy")
_BROKEN = (
    *(OSError, ValueError, KeyError, EOFError, MemoryError, NotImplementedError),
    zipfile.BadZipFile,
)

Arrays = Mapping[str, Array]


def folder() -> Path | None:
    """Where entries lie; None where there is no home or the cache is switched off."""
    if os.environ.get(OFF):
        return None
    given = os.environ.get(FOLDER)
    if given:
        return Path(given)
    try:
        if sys.platform == "win32":
            return Path(os.environ["LOCALAPPDATA"]) / "camwright" / "Cache"
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches" / "camwright"
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "camwright"
    except (KeyError, RuntimeError):
        return None


def switch_off() -> None:
    """No reading and no writing from here on, in this process and those it starts."""
    os.environ[OFF] = "1"


def key(kind: str, asked: object, modules: tuple[ModuleType, ...]) -> str:
    """Fingerprint of a question, of the libraries and of the modules that answer it."""
    digest = hashlib.sha256(repr((kind, asked, _versions(), sys.version_info[:2])).encode())
    for module in modules:
        digest.update(_source(module))
    return f"{kind}-{digest.hexdigest()[:40]}"


def kept(
    kind: str, asked: object, compute: Callable[[], Arrays], modules: tuple[ModuleType, ...]
) -> Arrays:
    """Arrays by name from the cache, or computed and put there.

    Parameters
    ----------
    kind : str               first word of the entry's file name
    asked : object           what was asked for; its repr enters the key
    compute : function       () -> arrays by name
    modules : tuple          modules whose text decides the arrays
    """
    place = folder()
    if place is None:
        return _laid_out(compute())
    path = place / f"{key(kind, asked, modules)}.npz"
    found = _read(path)
    if found is None:
        found = _laid_out(compute())
        _write(path, found)
    return found


def _laid_out(arrays: Arrays) -> dict[str, Array]:
    """Rows one after the other, as they are read back: sums over them then agree to the bit."""
    return {name: np.array(values, order="C") for name, values in arrays.items()}


def _read(path: Path) -> dict[str, Array] | None:
    """Arrays of an entry; None for one that is missing, cut short or altered (zip has sums)."""
    try:
        with np.load(path, allow_pickle=False) as entry:
            found = {name: entry[name] for name in entry.files}
    except _BROKEN:
        return None
    with suppress(OSError):  # a folder shared for reading alone
        path.touch()
    return found


def _write(path: Path, arrays: Arrays) -> None:
    """Write an entry; a folder that cannot be written is no error."""
    with suppress(OSError, ResultError):
        write_atomic(path, npz_bytes(arrays, compressed=False))
        _make_room(path)


def _make_room(newest: Path) -> None:
    """Delete the entries not used for longest until the rest is no larger than `LARGEST`."""
    entries = [(entry.stat(), entry) for entry in newest.parent.glob("*.npz") if entry != newest]
    room = LARGEST - newest.stat().st_size
    for state, entry in sorted(entries, key=lambda pair: pair[0].st_mtime, reverse=True):
        room -= state.st_size
        if room < 0:
            entry.unlink(missing_ok=True)


@lru_cache(maxsize=1)
def _versions() -> tuple[str, ...]:
    found = []
    for name in _LIBRARIES:
        try:
            found.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(name)
    return tuple(found)


@lru_cache(maxsize=64)
def _source(module: ModuleType) -> bytes:
    file = module.__file__
    return module.__name__.encode() if file is None else Path(file).read_bytes()

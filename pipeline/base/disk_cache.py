"""Disk cache of computed arrays, kept between runs by a hash of their inputs.

The key is a hash of the inputs, of the versions of the libraries and of the source text of the
modules that compute the arrays, so that a changed module makes a new entry.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import TypeAlias

from camwright.pipeline.base import store
from camwright.pipeline.base.store import ARRAYS, Store, key_of

FOLDER, OFF = "CAMWRIGHT_CACHE", "CAMWRIGHT_NO_CACHE"
LARGEST = 400_000_000  # bytes in all

Arrays: TypeAlias = store.Arrays


def folder() -> Path | None:
    """Folder of the cache; None without a home folder or with the cache switched off."""
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
    """Switch the cache off in this process and those it starts."""
    os.environ[OFF] = "1"


@contextmanager
def left_out() -> Iterator[None]:
    """Context manager: cache switched off in this process and those it starts."""
    before = os.environ.get(OFF)
    switch_off()
    try:
        yield
    finally:
        if before is None:
            del os.environ[OFF]
        else:
            os.environ[OFF] = before


def cache() -> Store[Arrays]:
    """Store of the cache; a folder that cannot be written is no error."""
    return Store(folder(), ARRAYS, most=LARGEST, must=False)


def kept(
    kind: str, inputs: Hashable, compute: Callable[[], Arrays], modules: tuple[ModuleType, ...]
) -> Arrays:
    """Arrays by name, read from the cache, or computed and written to it; see `store.key_of`.

    Parameters
    ----------
    kind : str               first word of the entry's file name
    inputs : hashable        all that decides the arrays
    compute : function       () -> arrays by name
    modules : tuple          modules whose source text decides the arrays
    """
    return cache().kept(key_of(kind, inputs, modules), compute)


def holds(kind: str, inputs: Hashable, modules: tuple[ModuleType, ...]) -> bool:
    """Whether the cache has an entry of a key; see `kept`."""
    return cache().holds(key_of(kind, inputs, modules))

"""Shared by all tests: one BLAS thread, the command line, data that not every machine has."""

from __future__ import annotations

import ctypes
import gc
import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_variable] = "1"  # before numpy is imported

# As the command does: arrays go by their counts of references; the search for cycles costs 10 %.
gc.set_threshold(50_000)

# Tests signal this process and its children; what runs in the background ignores both signals.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of reference data too large or not free to ship; skips where there is none."""
    folder = Path(os.environ.get("CAMWRIGHT_SHARED", ROOT.parent / "shared"))
    if not folder.is_dir():
        pytest.skip("no reference data: set CAMWRIGHT_SHARED to its folder")
    return folder


@pytest.fixture
def command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Runs `camwright` in this process: exit code, output, errors."""
    from camwright.pipeline import cli

    def call(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["camwright", *map(str, arguments)])
        handlers = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)}
        try:
            with pytest.raises(SystemExit) as leaving:
                cli.main()
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
        captured = capsys.readouterr()
        return int(leaving.value.code or 0), captured.out, captured.err

    return call


@pytest.fixture
def measured(record_property: Callable[[str, object], None]) -> Callable[..., None]:
    """Asserts that a figure is its reference within a share, and records it for the documentation.

    Its name and unit are one row of docs/verification.md, whatever the number of tests: the worst.
    """

    def call(name: str, value: float, reference: float, *, rtol: float, unit: str = "") -> None:
        assert value == pytest.approx(reference, rel=rtol), name
        figure = [name, float(value), float(reference), rtol, unit]
        record_property("measured", json.dumps(figure))

    return call


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "measured" in getattr(item, "fixturenames", ()):
            item.add_marker("measured")


def pytest_collection_finish() -> None:
    gc.freeze()  # ten thousand tests, which no later search for cycles goes through


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> object:
    """Frees at the end of a file of tests what it kept for its own tests."""
    result = yield
    if nextitem is None or nextitem.path != item.path:
        _clear_caches()
        if _memory() > item.config.stash.get(_KEPT, GROWTH) + GROWTH:
            item.config.stash[_KEPT] = _memory_returned()
    return result


GROWTH = 5e8
"""Bytes by which a test process grows before it searches for cycles, a second or more, and returns
what glibc keeps."""
_KEPT = pytest.StashKey[float]()
"""Memory after it last did so."""


def _clear_caches() -> None:
    """Empty the caches of the functions of all test files; those of the modules that they share,
    and of the program, stay.
    """
    for name, module in list(sys.modules.items()):
        if name.startswith("test_"):
            for made in list(vars(module).values()):
                if getattr(made, "__module__", "") == name and hasattr(made, "cache_clear"):
                    made.cache_clear()


def _memory() -> float:
    """Resident memory of this process, bytes; 0 where the system does not tell."""
    pages = Path("/proc/self/statm")
    if not pages.is_file():
        return 0.0
    return float(pages.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def _memory_returned() -> float:
    """Resident memory, bytes, after cycles are collected and free memory is returned."""
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
    return _memory()


DIED = 70
"""Exit code after the death of a test process (EX_SOFTWARE of sysexits.h): `make test` repeats."""
_DIED = pytest.StashKey[bool]()


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node, error) -> None:
    """How a test process ended, which pytest-xdist does not say."""
    if error:
        status = node.gateway._io.popen.wait(timeout=10)
        sys.stderr.write(f"\ntest process {node.gateway.id} ended with status {status}: {error}\n")
        node.config.stash[_DIED] = True


def pytest_sessionfinish(session: pytest.Session) -> None:
    if session.config.stash.get(_DIED, False):
        session.exitstatus = DIED

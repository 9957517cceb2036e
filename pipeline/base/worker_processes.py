"""Worker processes for independent tasks; commands that run modules of the package.

Each has one BLAS thread, and none imports from the working folder or from the folder of the user's
script: a file there may be named as a library is.
"""

from __future__ import annotations

import copyreg
import gc
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from multiprocessing import active_children
from multiprocessing.context import SpawnContext, SpawnProcess
from multiprocessing.popen_spawn_posix import Popen
from multiprocessing.process import (  # type: ignore[attr-defined]
    ORIGINAL_DIR,
    BaseProcess,
)
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

import camwright
from camwright.geometry.errors import InputError

if TYPE_CHECKING:
    from concurrent.futures import ProcessPoolExecutor

_JOBS_MOST = 4
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_SAFE_PATH = "PYTHONSAFEPATH"
_LOOK_EVERY_S = 1.0
_HOME = str(Path(camwright.__file__).absolute().parents[1])
"""Folder from which this package is imported."""


def _read_only(table: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(table)


def _pickled(table: MappingProxyType[Any, Any]) -> tuple[Any, ...]:
    return _read_only, (dict(table),)


copyreg.pickle(MappingProxyType, _pickled)  # read-only tables, such as those of a case


def workers_for(jobs: int | None, tasks: int) -> int:
    """Number of worker processes: `jobs`, or one per processor up to 4; at most one per task."""
    return max(1, min(jobs or min(os.cpu_count() or 1, _JOBS_MOST), tasks))


def import_path() -> list[str]:
    """Import path of this process without the working folder and the folder of the script.

    What PYTHONPATH names stays, and the folder of this package.
    """
    named = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    wanted = {_HOME, *(str(Path(each).absolute()) for each in named)}
    script = getattr(sys.modules["__main__"], "__file__", None)
    near = {"", str(Path.cwd()), ORIGINAL_DIR or ""}
    if script is not None:
        near |= {str(Path(script).absolute().parent), str(Path(script).resolve().parent)}
    return [place for place in sys.path if place in wanted or place not in near]


def module_command(module: str, *arguments: str) -> list[str]:
    """Command that runs a module of the package in a new interpreter with the flags of this one."""
    flags = subprocess._args_from_interpreter_flags()  # type: ignore[attr-defined]
    return [sys.executable, *flags, "-P", "-m", module, *arguments]


class _Process(SpawnProcess):
    """Spawned process that does not run the user's script again, nor import from its folder.

    A spawned process imports the script of its parent for the functions defined there; the tasks
    here are functions of the package. So a script needs no ``if __name__ == "__main__"``.
    """

    @staticmethod
    def _Popen(process_obj: BaseProcess) -> Popen:  # noqa: N802 - name of multiprocessing
        """Start the process without the script that this process runs, and without its working
        folder on the import path.
        """
        script = vars(sys.modules["__main__"])
        hidden = script.copy()
        script.pop("__file__", None)
        script["__spec__"] = None
        path, sys.path = sys.path, import_path()
        try:
            return Popen(process_obj)
        finally:
            sys.path = path
            script.update(hidden)


class _Context(SpawnContext):
    Process = _Process


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Context manager: pool of `workers` spawned processes; an error cancels the waiting tasks.

    An interrupt, or the death of a process, ends them at once: of what they solve nothing is read
    any more.

    The number of threads is set before the processes load a BLAS: many processes of one thread are
    faster than few of many. Workers ignore the keyboard interrupt, which the parent handles, and
    end by themselves where the parent is killed.

    Raises
    ------
    InputError
        If Python ignores the environment, by which the processes learn not to import from the
        working folder, and is not told so by a flag either.
    """
    if sys.flags.ignore_environment and not sys.flags.safe_path:
        raise InputError("python", "-E", "-E -P, or -I, to start processes")
    variables = (*THREADS, _SAFE_PATH)
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(dict.fromkeys(variables, "1"))
    from concurrent.futures import BrokenExecutor, ProcessPoolExecutor

    workers_pool = ProcessPoolExecutor(
        workers,
        mp_context=_Context(),
        initializer=as_worker,
        initargs=(os.getpid(), gc.get_threshold()),
    )
    try:
        yield workers_pool
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt | BrokenExecutor):
            for process in active_children():
                process.terminate()
            _stop_sending(workers_pool)
        workers_pool.shutdown(cancel_futures=True)
        raise
    finally:
        workers_pool.shutdown()
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _stop_sending(workers_pool: ProcessPoolExecutor) -> None:
    """Let the pool end although it is sending a task that no process reads any more.

    Before Python 3.11.5 a pool waits for ever for its thread that writes to the pipe
    (https://github.com/python/cpython/issues/94777). Later ones close the pipe themselves, in a
    thread of theirs: to close it here, too, could close a descriptor twice.
    """
    queue = getattr(workers_pool, "_call_queue", None)
    if queue is not None and sys.version_info < (3, 11, 5):
        with suppress(OSError):  # the thread that writes has closed it meanwhile
            queue._reader.close()


class PendingCall(Protocol):
    """Future of a call in a worker process."""

    def result(self) -> Any:
        """Result of the call; its exception is raised here."""
        ...


@dataclass
class _Later:
    """A call made in this process when its result is first read."""

    call: Callable[[], Any]
    _made: list[Any] = field(default_factory=list)

    def result(self) -> Any:
        if not self._made:
            self._made.append(self.call())
        return self._made[0]


class Crew:
    """Pool of worker processes for the tasks of a run; see `crew`."""

    def __init__(self, workers: int, stack: ExitStack) -> None:
        self.workers = workers
        self._stack = stack
        self._pool: ProcessPoolExecutor | None = None

    def prepare(self, module: str) -> None:
        """Start the processes, which import a module meanwhile; nothing with a single process."""
        if self.workers > 1:
            for _ in range(self.workers):
                self.submit(_imported, module)

    def submit(self, function: Callable[..., Any], *arguments: object) -> PendingCall:
        """Call a function of the package with its arguments in a worker process; where there is one
        process, in this one when the result is read.
        """
        if self.workers <= 1:
            return _Later(partial(function, *arguments))
        if self._pool is None:
            self._pool = self._stack.enter_context(pool(self.workers))
        return self._pool.submit(function, *arguments)

    def dismiss(self) -> None:
        """End the processes after their tasks, without waiting; the last call of the crew."""
        if self._pool is not None:
            self._pool.shutdown(wait=False)


ALONE = Crew(1, ExitStack())
"""No process but this one, in which a task runs when its result is read."""


def _imported(module: str) -> None:
    import_module(module)


@contextmanager
def crew(jobs: int | None) -> Iterator[Crew]:
    """Context manager: pool of worker processes, started with the first task.

    Parameters
    ----------
    jobs : int   processes; None: one a processor, at most 4. With one a task runs in this process
                 when its result is read
    """
    with ExitStack() as stack:
        yield Crew(workers_for(jobs, _JOBS_MOST if jobs is None else jobs), stack)


def as_worker(parent: int, collect_after: Sequence[int] = ()) -> None:
    """Make this process a worker: it ignores interrupts, and ends with its parent.

    Parameters
    ----------
    collect_after : sequence   thresholds of the search for cycles of objects; (): as they are
    """
    if collect_after:
        gc.set_threshold(*collect_after)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with, args=(parent,), daemon=True).start()


def _leave_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_LOOK_EVERY_S)
    os._exit(1)

"""Supervised process that solves designs: limits of time and memory, restart.

A worker of the cluster supervises one such process. What a design does to it, by a hang in gmsh, a
crash or all of the memory, is a row of the dataset, and the worker lives on.
"""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.worker_processes import THREADS, as_worker, module_command
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.studies.batch import design_rows
from camwright.pipeline.studies.batch.case_template import Template
from camwright.pipeline.studies.batch.design_rows import Files, Row
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted

DEATHS_MAX = 3
"""Deaths of the process after which a design is a row."""
_LOOK_EVERY_S = 0.05
_START_S = 120.0
_TRIMMED = "MALLOC_TRIM_THRESHOLD_"
"""Set by Dask in its workers; memory returned at each release costs a sixth in page faults."""
_PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


class _OutOfTimeError(Exception):
    pass


class _OutOfMemoryError(Exception):
    pass


class _DiedError(Exception):
    pass


class EndedError(Exception):
    """Process ended for good while it solved."""


@dataclass
class SolverProcess:
    """Supervised solver process, restarted after a death.

    Parameters
    ----------
    templates : sequence
    settings : Settings   with the bounds of time and memory of one design
    """

    templates: Sequence[Template]
    settings: Settings
    _process: subprocess.Popen[bytes] | None = None
    _pipe: Connection | None = None
    _ready: bool = False
    _ended: bool = False
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def begin(self) -> tuple[Connection, subprocess.Popen[bytes]]:
        """Start the solver process unless it runs; returns the pipe to it, and the process, whose
        imports go on while the caller works.

        Raises
        ------
        EndedError
            If the worker has been ended.
        """
        if self._process is not None and self._pipe is not None and self._process.poll() is None:
            return self._pipe, self._process
        self.close()
        if self._ended:
            raise EndedError
        ours, theirs = Pipe()
        environment = os.environ | dict.fromkeys(THREADS, "1")
        environment.pop(_TRIMMED, None)
        with theirs:
            process = subprocess.Popen(  # noqa: S603 - this interpreter, this module
                module_command(__name__, str(theirs.fileno())),
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=environment,
            )
        self._pipe, self._process = ours, process
        return ours, process

    def rows(
        self, task: Task, wanted: Wanted | None = None
    ) -> tuple[bytes, bytes, dict[str, Files]]:
        """Rows of a task and their clock figures, each as a Parquet file, and the files of runs by
        design id.

        Parameters
        ----------
        wanted : Wanted   designs whose run is made from the solution of their row; None: none
        """
        with self._lock:
            if task.tier is Tier.SCREENING:
                with contextlib.suppress(_OutOfTimeError, _OutOfMemoryError, _DiedError):
                    start = time.perf_counter()
                    reply = self._asked("screened", task)
                    share = (time.perf_counter() - start) / len(task.ids)
                    if reply is not None:
                        return *self._encoded(task, reply, [share] * len(task.ids)), {}
            made, walls, runs = [], [], {}
            for row, name in enumerate(task.ids):
                start = time.perf_counter()
                cells = self._row(task, row, wanted)
                walls.append(time.perf_counter() - start)
                made.append(cells)
                if wanted is not None and self._ready:
                    runs[name] = self._files(self._reply)
            kept = {name: files for name, files in runs.items() if files}
            return *self._encoded(task, design_rows.columns_of(made), walls), kept

    def _encoded(
        self, task: Task, columns: Mapping[str, Any], walls: Sequence[float]
    ) -> tuple[bytes, bytes]:
        """Rows and clock figures of a task as the bytes of two Parquet files, written by the solver
        process, or here where it dies.

        Parameters
        ----------
        task : Task         designs of the rows
        columns : mapping   values by name of column
        walls : sequence    time of each design, s
        """
        with contextlib.suppress(_OutOfTimeError, _OutOfMemoryError, _DiedError):
            files: tuple[bytes, bytes] | None = self._asked("encoded", task, columns, walls)
            if files is not None:
                return files
        return design_rows.encoded(task, columns, walls, self.settings.outputs)

    def run_folder(self, task: Task, row: int) -> Files:
        """Run files of a design; none without a result."""
        with self._lock:
            return self._files(lambda: self._asked("run_folder", task, row))

    def presented(self, files: Files) -> Files:
        """Run files with their page; none where it cannot be made."""
        with self._lock:
            return self._files(lambda: self._asked("presented", files))

    def _files(self, reply: Callable[[], Any]) -> Files:
        """Run files, by name, that `reply` fetches from the solver process; empty where this
        exceeds time or memory or dies.
        """
        with contextlib.suppress(_OutOfTimeError, _OutOfMemoryError, _DiedError):
            files: Files = reply()
            return files
        return {}

    def end(self) -> None:
        """End the process for good; a waiting caller receives `EndedError`."""
        self._ended = True
        if self._process is not None:
            self._process.kill()

    def close(self) -> None:
        """End the process; the next request starts another."""
        if self._pipe is not None:
            self._pipe.close()
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        self._process = self._pipe = None
        self._ready = False

    def _row(self, task: Task, row: int, wanted: Wanted | None) -> Row:
        """Row of the dataset, value by name of column, for the design in a row of a task, solved by
        the process; a row that says so where it exceeds time or memory, or has died `DEATHS_MAX`
        times.

        With `wanted`, the rule for designs to be kept, the process sends the files of its run next,
        see `_reply`.
        """
        for _ in range(DEATHS_MAX):
            try:
                solved: Row = (
                    self._asked("solved", task, row)
                    if wanted is None
                    else self._asked("solved_and_run", task, row, wanted)
                )
            except _OutOfTimeError:
                return design_rows.out_of_time(self.settings)
            except _OutOfMemoryError:
                return design_rows.out_of_memory(self.settings)
            except _DiedError:
                continue
            return solved
        return design_rows.died(DEATHS_MAX)

    def _asked(self, method: str, *arguments: Any) -> Any:
        """Result of a method of the `DesignSolver` in the solver process, called by name with its
        arguments, within the limits of time and memory.
        """
        pipe, _ = self._started()
        try:
            pipe.send((method, arguments))
        except OSError:
            self.close()
            raise _DiedError from None
        return self._reply()

    def _reply(self) -> Any:
        """Next reply of the solver process; beyond the limit of time or memory it is ended and an
        error raised.
        """
        pipe, process = self._pipe, self._process
        if pipe is None or process is None:
            raise _DiedError
        try:
            deadline = time.monotonic() + self.settings.seconds
            while not pipe.poll(_LOOK_EVERY_S):
                if time.monotonic() > deadline:
                    raise _OutOfTimeError
                if resident(process.pid) > self.settings.bytes:
                    raise _OutOfMemoryError
            return pipe.recv()
        except (EOFError, OSError):
            self.close()
            raise _DiedError from None
        except (_OutOfTimeError, _OutOfMemoryError):
            self.close()
            raise

    def _started(self) -> tuple[Connection, subprocess.Popen[bytes]]:
        """Pipe to the solver process, and the process, once it has templates and settings and its
        versions are those of the study.
        """
        pipe, process = self.begin()
        if self._ready:
            return pipe, process
        try:
            pipe.send((self.templates, self.settings))
            if not pipe.poll(_START_S):
                raise EOFError
            self._require(pipe.recv())
        except (EOFError, OSError):
            self.close()
            raise _DiedError from None
        self._ready = True
        return pipe, process

    def _require(self, here: Mapping[str, str]) -> None:
        """Refuse a worker of other versions, whose rows would differ."""
        for name, version in self.settings.versions.items():
            if here.get(name) != version:
                self.close()
                words = f"{name} {here.get(name, 'missing')} on {socket.gethostname()}"
                raise ResultError(f"worker: {words}, must be {version}")


def resident(pid: int) -> int:
    """Resident memory of a process, bytes; 0 where the system does not state it."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE
    except (OSError, ValueError, IndexError):
        return 0


def serve(pipe: Connection) -> None:
    """Loop of the solver process: calls the method that a request names and sends the result, until
    the pipe is closed.
    """
    from camwright.pipeline.studies.batch.design_plan import study_versions
    from camwright.pipeline.studies.batch.design_solver import DesignSolver

    templates, settings = pipe.recv()
    solver = DesignSolver(templates, settings)
    pipe.send(study_versions())
    while True:
        method, arguments = pipe.recv()
        if method == "solved_and_run":
            task, row, wanted = arguments
            solver.solved_and_run(task, row, wanted, pipe.send)
        else:
            pipe.send(_answer(getattr(solver, method), arguments))


def _answer(method: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """Result of a method; None of an array solution that fails as a whole, {} of files."""
    try:
        return method(*arguments)
    except Exception:  # noqa: BLE001 - each design is then solved alone, where it is a row
        return {} if method.__name__ in ("run_folder", "presented") else None


def main() -> None:
    """Entry point of the process; the argument is the number of its pipe end."""
    as_worker(os.getppid())
    with contextlib.suppress(EOFError, OSError):
        serve(Connection(int(sys.argv[1])))


if __name__ == "__main__":
    main()

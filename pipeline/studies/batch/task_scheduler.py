"""Task scheduling on a Dask cluster: local processes, or a running cluster."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import logging
import re
import tempfile
from asyncio import CancelledError
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from camwright.geometry.errors import CamError, InputError, ResultError
from camwright.pipeline.studies.batch.case_template import Template
from camwright.pipeline.studies.batch.dataset import (
    joined,
    parquet_bytes,
    table_from,
)
from camwright.pipeline.studies.batch.design_rows import (
    Files,
    columns_of,
    died,
    encoded,
)
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted
from camwright.pipeline.studies.batch.solver_process import DEATHS_MAX

if TYPE_CHECKING:
    from distributed import Client, LocalCluster

    from camwright.pipeline.studies.batch.cluster_worker import Bare, Shard

Work = TypeVar("Work")
Result = TypeVar("Result")
_AHEAD = 3
"""Tasks at a worker at once: one running, the next ones there."""
_CONNECT_S = 30
_LOOPBACK = "127.0.0.1:0"  # any free port
_ADDRESS = re.compile(r"(?:(?:tcp|tls)://)?(?:[\w.-]+|\[[0-9A-Fa-f:.]+\]):([0-9]{1,5})", re.ASCII)


def require_address(address: str) -> None:
    """Refuse text that is no scheduler address; InputError."""
    match = _ADDRESS.fullmatch(address)
    if match is None or not 1 <= int(match[1]) <= 65535:
        raise InputError("--scheduler", repr(address)[:80], "tcp://HOST:PORT or tls://HOST:PORT")


def _options() -> dict[str, object]:
    """Configuration of Dask."""
    return {
        "distributed.scheduler.allowed-failures": DEATHS_MAX - 1,
        "distributed.scheduler.worker-saturation": 1.0,  # at the end no task waits at a busy worker
        "distributed.comm.timeouts.connect": f"{_CONNECT_S}s",
        "distributed.worker.memory.spill": False,
        # What Dask watches by default every 10 to 100 ms takes 3 % of each core.
        "distributed.worker.profile.enabled": False,
        "distributed.worker.memory.monitor-interval": "1s",
        "distributed.admin.system-monitor.interval": "5s",
        "distributed.admin.tick.interval": "200ms",
        "distributed.admin.log-format": "%(message)s",
    }


async def _reach(address: str) -> None:
    """Connect to a scheduler and exchange the first words, for which a client waits for ever."""
    from distributed import Security
    from distributed.comm import connect

    words = Security().get_connection_args("client")
    await (await connect(address, timeout=_CONNECT_S, **words)).close()


def _client_at(address: str) -> Client:
    """Client of a running cluster; InputError if no scheduler answers in `_CONNECT_S`."""
    from distributed import Client

    try:
        asyncio.run(asyncio.wait_for(_reach(address), _CONNECT_S))
        return Client(address, timeout=_CONNECT_S)
    except TimeoutError:
        reason = f"no answer within {_CONNECT_S} s"
    except (Exception, CancelledError) as error:  # noqa: BLE001 - by what answers: many
        reason = " ".join(str(error).split())[:200] or type(error).__name__
    raise InputError("--scheduler", f"{address} ({reason})", "a running scheduler")


class TaskScheduler:
    """Scheduler of a study's tasks on a cluster, started with the first task.

    Parameters
    ----------
    jobs : int             local processes
    address : str          of a running cluster; None: local processes
    templates : sequence   sent once to each worker
    settings : Settings

    Raises
    ------
    InputError
        On `begin`, if no scheduler answers at the address.
    """

    def __init__(
        self, jobs: int, address: str | None, templates: Sequence[Template], settings: Settings
    ) -> None:
        """Prepare a scheduler; nothing is started before `begin`. For the parameters see
        the class.
        """
        self._jobs, self._address = jobs, address
        self._templates, self._settings = templates, settings
        self._plugin = f"camwright-{settings.sha256[:16]}"
        self._stack = contextlib.ExitStack()
        self._local: LocalCluster | None = None
        self._connected: Client | None = None

    def __enter__(self) -> TaskScheduler:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def begin(self) -> None:
        """Connect to the cluster, or start the local processes without waiting for them."""
        if self._local is not None or self._connected is not None:
            return
        import dask
        import distributed

        with contextlib.ExitStack() as stack:
            stack.enter_context(dask.config.set(_options()))
            stack.callback(logging.disable, logging.root.manager.disable)
            logging.disable(logging.CRITICAL)  # Dask logs what is one line here
            if self._address is None:
                folder = tempfile.TemporaryDirectory(prefix="camwright-dask-")
                # Workers are threads that wait for a process each: see `solver_process`.
                self._local = distributed.LocalCluster(
                    n_workers=0,
                    threads_per_worker=1,
                    processes=False,
                    dashboard_address=None,
                    # Without an address both listen for HTTP on every interface.
                    worker_dashboard_address=_LOOPBACK,
                    scheduler_kwargs={"dashboard_address": _LOOPBACK},
                    memory_limit=0,
                    local_directory=stack.enter_context(folder),
                    silence_logs=logging.CRITICAL,
                )
                stack.enter_context(self._local)
                self._local.scale(self._jobs)
            else:
                self._connected = stack.enter_context(_client_at(self._address))
            self._stack = stack.pop_all()
        if self._local is not None:
            _ = self._client  # by whose plugin the processes start

    def release(self) -> None:
        """End the local processes while the caller goes on; no task follows."""
        if self._local is not None:
            self._local.scale(0)

    @functools.cached_property
    def _client(self) -> Client:
        """Dask client whose workers have the templates; waits until the local processes run."""
        from distributed import Client

        from camwright.pipeline.studies.batch.cluster_worker import StudyPlugin

        self.begin()
        client = self._connected or self._stack.enter_context(Client(self._local))
        client.register_plugin(StudyPlugin(self._plugin, self._templates, self._settings))
        return client

    def shards(
        self, tasks: Iterable[Task], wanted: Callable[[], Wanted | None] = lambda: None
    ) -> Iterator[tuple[Task, Shard]]:
        """Tasks with their shards, rows, clock figures and run files, as they complete.

        Parameters
        ----------
        tasks : iterable    designs of one case each
        wanted : callable   called as a task is handed out -> rule for the designs whose run is made
                            with their row, or None
        """
        from camwright.pipeline.studies.batch.cluster_worker import solve_shard

        def apart(task: Task) -> Shard:
            return self._apart(task, wanted)

        return self._completed(solve_shard, tasks, apart, wanted)

    def runs(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Files]]:
        """Single-design tasks with their run files; none without a result."""
        from camwright.pipeline.studies.batch.cluster_worker import solve_run

        return self._completed(solve_run, tasks, lambda _: {})

    def pages(self, runs: Iterable[Bare]) -> Iterator[tuple[Bare, Files]]:
        """Runs without page, each with files and page; none where it cannot be made."""
        from camwright.pipeline.studies.batch.cluster_worker import make_page

        return self._completed(make_page, runs, lambda _: {})

    def _completed(
        self,
        method: Callable[..., Result],
        tasks: Iterable[Work],
        killed: Callable[[Work], Result],
        *arguments: Callable[[], object],
    ) -> Iterator[tuple[Work, Result]]:
        """Tasks with their results, in the order in which they complete; at most `_AHEAD` tasks per
        worker are submitted at a time.

        Parameters
        ----------
        method : callable      task, name of the plugin, arguments -> result; called on a worker
        tasks : iterable       the tasks
        killed : callable      task that ended its worker too often -> its result
        arguments : callable   each called as a task is submitted, for an argument

        Raises
        ------
        ResultError
            If the cluster is lost.
        """
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        waiting = iter(tasks)
        running: dict[Any, Work] = {}
        finished = as_completed(loop=self._client.loop)

        def submit() -> bool:
            task = next(waiting, None)
            if task is None:
                return False
            values = [each() for each in arguments]
            future = self._client.submit(method, task, self._plugin, *values, pure=False)
            running[future] = task
            finished.add(future)
            return True

        there = len(self._client.scheduler_info(n_workers=-1)["workers"])
        workers = max(1, there if self._local is None else self._jobs)
        for _ in range(_AHEAD * workers):
            submit()
        try:
            while running:
                try:
                    future = next(finished)
                    task = running.pop(future)
                    result = future.result()
                except KilledWorker:
                    result = killed(task)
                except CamError:
                    raise
                except (Exception, CancelledError) as error:  # noqa: BLE001 - of the cluster: many
                    words = " ".join(str(error).split())[:200]
                    lost = "scheduler-connection-lost" in words
                    reason = "lost" if lost else f"{type(error).__name__} {words}"
                    raise ResultError(f"cluster: {reason}; --resume completes the study") from None
                future.release()
                submit()
                yield task, result
        finally:
            with contextlib.suppress(Exception):  # a cluster that is lost
                self._client.cancel(list(running), force=True)

    def _apart(self, task: Task, wanted: Callable[[], Wanted | None]) -> Shard:
        """Shard of a task that ended its worker too often: each design is solved as a task of its
        own; a single one gets a row that says so.

        Parameters
        ----------
        task : Task         the designs
        wanted : callable   as of `shards`
        """
        import pyarrow as pa

        if len(task.ids) == 1:
            columns = columns_of([died(DEATHS_MAX)])
            return *encoded(task, columns, [0.0], self._settings.outputs), {}
        alone = [task.alone(row) for row in range(len(task.ids))]
        parts = {each.ids[0]: shard for each, shard in self.shards(alone, wanted)}
        rows = joined([table_from(parts[name][0]) for name in task.ids])
        clocks = pa.concat_tables([table_from(parts[name][1]) for name in task.ids])
        runs = {name: files for part in parts.values() for name, files in part[2].items()}
        return parquet_bytes(rows), parquet_bytes(clocks), runs

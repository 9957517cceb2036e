"""Tasks on a Dask cluster: local processes, or a running cluster by its address."""

from __future__ import annotations

import contextlib
import logging
import re
import tempfile
from asyncio import CancelledError
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from camwright.geometry.errors import CamError, InputError, ResultError
from camwright.pipeline.base.worker_processes import THREADS
from camwright.pipeline.studies.batch.case_template import Template
from camwright.pipeline.studies.batch.dataset import (
    joined,
    parquet_bytes,
    table_from,
    table_of,
    timings_of,
)
from camwright.pipeline.studies.batch.design_plan import Settings, Task
from camwright.pipeline.studies.batch.design_rows import columns_of, completed, died
from camwright.pipeline.studies.batch.solver_process import DEATHS_MAX

if TYPE_CHECKING:
    from distributed import Client

    from camwright.pipeline.studies.batch.cluster_worker import Shard

Result = TypeVar("Result")
_AHEAD = 3
"""Tasks at a worker at once: one running, the next ones there."""
_WORKER_MEMORY = "2GB"
_CONNECT_S = 30
_ADDRESS = re.compile(r"(?:(?:tcp|tls)://)?(?:[\w.-]+|\[[0-9A-Fa-f:.]+\]):([0-9]{1,5})", re.ASCII)
MISSING = 'Dask is missing; install it with: pip install "camwright[study]"'


def require_address(address: str) -> None:
    """Refuse text that is no address of a scheduler; InputError."""
    match = _ADDRESS.fullmatch(address)
    if match is None or not 1 <= int(match[1]) <= 65535:
        raise InputError("--scheduler", repr(address)[:80], "tcp://HOST:PORT or tls://HOST:PORT")


@contextlib.contextmanager
def cluster(jobs: int, address: str | None) -> Iterator[Client]:
    """Client of a cluster: of `jobs` local processes, or of that at an address.

    Raises
    ------
    ResultError
        If Dask is not installed.
    InputError
        If no scheduler answers at the address.
    """
    try:
        import dask
        import distributed
        import pyarrow as pa  # noqa: F401 - needed by the workers and for the dataset
    except ImportError:
        raise ResultError(MISSING) from None
    options = {
        "distributed.scheduler.allowed-failures": DEATHS_MAX - 1,
        "distributed.comm.timeouts.connect": f"{_CONNECT_S}s",
        "distributed.worker.memory.spill": False,
        "distributed.worker.profile.enabled": False,  # a sample every 10 ms in each process
        "distributed.admin.log-format": "%(message)s",
    }
    with contextlib.ExitStack() as stack:
        stack.enter_context(dask.config.set(options))
        stack.callback(logging.disable, logging.root.manager.disable)
        logging.disable(logging.CRITICAL)  # Dask logs what is one line here
        if address is None:
            scratch = stack.enter_context(tempfile.TemporaryDirectory(prefix="camwright-dask-"))
            local = distributed.LocalCluster(
                n_workers=jobs,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address=None,
                memory_limit=_WORKER_MEMORY,
                local_directory=scratch,
                silence_logs=logging.CRITICAL,
                env=dict.fromkeys(THREADS, "1"),
            )
            stack.enter_context(local)
            yield stack.enter_context(distributed.Client(local))
            return
        try:
            client = distributed.Client(address, timeout=_CONNECT_S)
        except (OSError, ValueError, TypeError) as error:  # TypeError: tls without certificates
            words = " ".join(str(error).split())[:200]
            raise InputError("--scheduler", f"{address} ({words})", "a running scheduler") from None
        yield stack.enter_context(client)


class TaskScheduler:
    """Runs the tasks of a study on a cluster.

    Parameters
    ----------
    client : Client        of the cluster
    templates : sequence   sent once to each worker
    settings : Settings
    """

    def __init__(self, client: Client, templates: Sequence[Template], settings: Settings) -> None:
        from camwright.pipeline.studies.batch.cluster_worker import StudyPlugin

        self._client, self._settings = client, settings
        self._plugin = f"camwright-{settings.sha256[:16]}"
        client.register_plugin(StudyPlugin(self._plugin, templates, settings))

    def shards(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Shard]]:
        """Tasks with their shards, as they complete."""
        from camwright.pipeline.studies.batch.cluster_worker import solve_shard

        return self._completed(solve_shard, tasks, self._apart)

    def runs(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, dict[str, bytes]]]:
        """Tasks of one design each with the files of its run; none where it has no result."""
        from camwright.pipeline.studies.batch.cluster_worker import solve_run

        return self._completed(solve_run, tasks, lambda _: {})

    def _completed(
        self,
        method: Callable[[Task, str], Result],
        tasks: Iterable[Task],
        killed: Callable[[Task], Result],
    ) -> Iterator[tuple[Task, Result]]:
        """Results as they complete; a few tasks a worker are known to the scheduler at once."""
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        waiting = iter(tasks)
        running: dict[Any, Task] = {}
        finished = as_completed()

        def submit() -> bool:
            task = next(waiting, None)
            if task is None:
                return False
            future = self._client.submit(method, task, self._plugin, pure=False)
            running[future] = task
            finished.add(future)
            return True

        workers = max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))
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

    def _apart(self, task: Task) -> Shard:
        """Shard of a task that ended its worker too often: each design on its own."""
        import pyarrow as pa

        if len(task.ids) == 1:
            rows = completed(task, columns_of([died(DEATHS_MAX)]), self._settings.outputs)
            return parquet_bytes(table_of(rows, task.units)), parquet_bytes(timings_of(rows, [0.0]))
        alone = [task.alone(row) for row in range(len(task.ids))]
        parts = {each.ids[0]: shard for each, shard in self.shards(alone)}
        rows = joined([table_from(parts[name][0]) for name in task.ids])
        clock = pa.concat_tables([table_from(parts[name][1]) for name in task.ids])
        return parquet_bytes(rows), parquet_bytes(clock)

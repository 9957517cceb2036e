"""Fresh processes for independent pieces of work, each with one BLAS thread."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context

_JOBS_MOST = 4
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_LOOK_EVERY_S = 1.0


def workers_for(jobs: int | None, tasks: int) -> int:
    """Processes to use: as asked, else the processors there are, at most 4 and one a task."""
    return max(1, min(jobs or min(os.cpu_count() or 1, _JOBS_MOST), tasks))


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """A pool of fresh processes; work not yet begun is dropped when it is left by an error.

    They read the number of threads before they load a BLAS: many small ones beat few wide ones.
    An interrupt is for the parent to handle; where the parent is killed they end by themselves.
    """
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    found = ProcessPoolExecutor(
        workers, mp_context=get_context("spawn"), initializer=_as_worker, initargs=(os.getpid(),)
    )
    try:
        yield found
    except BaseException:
        found.shutdown(cancel_futures=True)
        raise
    finally:
        found.shutdown()
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _as_worker(parent: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with, args=(parent,), daemon=True).start()


def _leave_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_LOOK_EVERY_S)
    os._exit(1)

"""Which angles the certificate looks at, and the processes that work it out."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

import numpy as np

from geometry.arrays import Array
from pipeline.contact.history import CertificatePoint, ContactHistory
from pipeline.contact.pair import ContactPair
from pipeline.contact.pair_certificate import certificate_point
from pipeline.trial import Trial

_JOBS_MOST = 4
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def positions_to_certify(trial: Trial, count: int) -> tuple[tuple[int, int], ...]:
    """Load case and position of the `count` angles to certify, the worst first.

    The extremes of pressure, load, curvature and its change over all load cases, then equal
    steps over the turn of the first. Angles closer than four positions count as one.
    """
    if trial.mesh is None:
        return ()
    wanted: list[tuple[int, int]] = []

    def take(case: int, index: int) -> None:
        loaded = trial.cycles[case].contact.p0[index] > 0
        near = any(c == case and abs(i - index) < 4 for c, i in wanted)
        if loaded and not near and len(wanted) < count:
            wanted.append((case, index))

    for extreme in _EXTREMES:
        for case, cycle in enumerate(trial.cycles):
            take(case, int(np.argmax(extreme(cycle.contact))))
    size = trial.cycles[0].theta.size
    for index in np.linspace(0, size, 4 * count, endpoint=False).astype(int):
        take(0, int(index))
    return tuple(wanted)


def _change(history: ContactHistory) -> Array:
    curvature = 1 / history.relative_radius
    return np.abs(np.roll(curvature, -1) - np.roll(curvature, 1))


_EXTREMES: tuple[Callable[[ContactHistory], Array], ...] = (
    lambda h: np.nan_to_num(h.p0),
    lambda h: h.line_load,
    lambda h: h.relative_radius,
    lambda h: -h.relative_radius,
    _change,
    lambda h: np.nan_to_num(h.half_width),
    lambda h: -np.where(h.line_load > 0, h.line_load, np.inf),
)


def certified(
    pair: ContactPair,
    trial: Trial,
    chosen: Iterable[tuple[int, int]],
    jobs: int | None,
    tell: Callable[[int, int], None],
) -> tuple[CertificatePoint, ...]:
    """Certificate points at chosen (load case, position), worked out in `jobs` processes."""
    tasks = [
        (pair, trial.cycles[case].contact, index, float(trial.cycles[case].theta[index]))
        for case, index in chosen
    ]
    workers = min(jobs or min(os.cpu_count() or 1, _JOBS_MOST), len(tasks))
    if workers <= 1:
        found = []
        for task in tasks:
            found.append(certificate_point(*task))
            tell(len(found), len(tasks))
        return tuple(found)
    # Fresh processes read this before they load a BLAS: many small ones beat few wide ones.
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            futures = [pool.submit(certificate_point, *task) for task in tasks]
            for done, _ in enumerate(as_completed(futures), start=1):
                tell(done, len(tasks))
            return tuple(future.result() for future in futures)
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name)
            else:
                os.environ[name] = value

"""Angles of the certificate, and their solution in worker processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import as_completed

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.worker_processes import pool, workers_for
from camwright.pipeline.contact.certificate import certificate_point
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.cycle.cycle import Cycle


def positions_to_certify(cycles: Sequence[Cycle], count: int) -> tuple[tuple[int, int], ...]:
    """Load case and position of the `count` angles to certify, the most critical first.

    Extremes of pressure, load, curvature and its change over all load cases, then equal steps over
    the turn of the first. Of angles closer than four positions only one is certified.
    """
    wanted: list[tuple[int, int]] = []

    def take(case: int, index: int) -> None:
        loaded = cycles[case].contact.p0[index] > 0
        near = any(c == case and abs(i - index) < 4 for c, i in wanted)
        if loaded and not near and len(wanted) < count:
            wanted.append((case, index))

    for extreme in _EXTREMES:
        for case, cycle in enumerate(cycles):
            take(case, int(np.argmax(extreme(cycle.contact))))
    size = cycles[0].theta.size
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
    cycles: Sequence[Cycle],
    chosen: Iterable[tuple[int, int]],
    jobs: int | None,
    advance: Callable[[int, int], None],
) -> tuple[CertificatePoint, ...]:
    """Certificate points at chosen (load case, position), solved in `jobs` processes."""
    tasks = [
        (pair, cycles[case].contact, index, float(cycles[case].theta[index]))
        for case, index in chosen
    ]
    workers = workers_for(jobs, len(tasks))
    if workers <= 1:
        points = []
        for task in tasks:
            points.append(certificate_point(*task))
            advance(len(points), len(tasks))
        return tuple(points)
    with pool(workers) as fresh:
        futures = [fresh.submit(certificate_point, *task) for task in tasks]
        for count, _ in enumerate(as_completed(futures), start=1):
            advance(count, len(tasks))
        return tuple(future.result() for future in futures)

"""External force on the follower, and its mean with the weight."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.errors import InputError
from camwright.pipeline.base.external_force import NO_FORCE, ExternalForce
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case, kept_as
from camwright.pipeline.torque.angle_trace import read_trace
from camwright.pipeline.torque.tabled_torque import require_cycle


def external_force(case: Case) -> ExternalForce:
    """External force of the machine on the follower, N, over the cam angle; zero where the case has
    none.

    Raises
    ------
    InputError
        If its file cannot be read or has wrong contents; by file and line.
    """
    follower = case.follower
    name = follower.external_force_file
    if name is not None:
        return _from_file(case.path(name), case.included[kept_as(name)])
    if not follower.external_force:
        return NO_FORCE
    return ExternalForce.constant(follower.external_force)


def dead_load(case: Case) -> float:
    """Weight and mean external force, N, positive towards the cam; of an arm at zero lift."""
    follower, mean = case.follower, external_force(case).mean
    if follower.pivot is not None and follower.arm is not None:
        prime, offset = case.cam.prime_radius, case.facing.offset
        pivot = follower.pivot.about(follower.arm, follower.mass, prime, offset, case.output)
        return float(pivot.applied(mean, pivot.direction(0.0)))
    return follower.mass * follower.gravity_along_axis + mean


def closing_preload(case: Case) -> float:
    """Closing force at zero lift and standstill, N: preload, weight and mean external force; of a
    cam that pulls it may be negative.

    Raises
    ------
    InputError
        If it is not positive under a cam that does not pull: no lift stores the work of a torque.
    """
    dead = dead_load(case)
    if case.cam.pulls:
        return case.spring.preload + dead
    require_closing("spring.preload", case.spring.preload, dead)
    return case.spring.preload + dead


def require_closing(key: str, preload: float, dead: float) -> None:
    """Refuse a preload that weight and mean external force cancel."""
    if not preload + dead > 0.0:
        limit = f"> {shown(-dead, 'N')}, as weight and external force pull the follower off"
        raise InputError(key, shown(preload, "N"), limit)


@lru_cache(maxsize=8)
def _from_file(path: Path, _content: bytes) -> ExternalForce:
    """External force of a file; `_content`: its bytes, by which a changed file is read anew, see
    the cache.
    """
    trace = read_trace(path, "force", period=FULL_TURN, part="cam")
    if not trace.values.any():
        text = f"{trace.source}, {trace.column}"
        raise InputError(text, "0 N at every angle", "a force, or left out")
    require_cycle(trace, "N")
    return ExternalForce(trace.angle, trace.values)

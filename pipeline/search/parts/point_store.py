"""Points solved in worker processes and stored by case."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Literal

from camwright.geometry.errors import CamError
from camwright.pipeline.base.store import JSON, Store
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.records.redesign_document import (
    ConflictPoint,
    PointRecord,
    RefusedPoint,
    RoughRecord,
)
from camwright.pipeline.search.parts.design_point import point_of, rough_point
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.torque.torque import Torque

Answer = RoughRecord | PointRecord | ConflictPoint | RefusedPoint
"""Of the tiers coarse and rough, whole, conflict; the last where a case has no cam."""

SOLVED = "solved"


@dataclass(frozen=True)
class PointTask:
    """A case as text, to be solved by the synthesis alone, also on few cam angles, in full, or for
    its conflict of limits.

    base: the original case, whose torque all variants share; folder: of the included files and of
    the store ``solved/``; version: of the source.
    """

    text: str
    base: str
    folder: Path
    version: str
    tier: Literal["coarse", "rough", "whole", "conflict"]

    @property
    def key(self) -> str:
        """Key of the point in the store."""
        digest = hashlib.sha256(f"{self.version}\0{self.base}\0{self.text}".encode()).hexdigest()
        return f"{self.tier}_{digest[:24]}"


def points(folder: Path) -> Store[Any]:
    """Store of solved points of a folder."""
    return Store(folder / SOLVED, JSON)


def solved(task: PointTask) -> Any:
    """Record of a point from the store, or solved; or its refusal."""
    return points(task.folder).kept(task.key, partial(_record, task), lambda r: "feasible" in r)


def _record(task: PointTask) -> Answer:
    try:
        case = parse_case(task.text, task.folder)
        if task.tier == "rough":
            return rough_point(case, _torques(task.base, task.folder)).as_record()
        if task.tier == "coarse":
            return rough_point(case, engine_torques(case), fine=False).as_record()
        if task.tier == "conflict":
            problem = problem_of(case, _torques(task.base, task.folder))
            conflict: ConflictPoint = {"feasible": False, **infeasibility(problem).as_record()}
            return conflict
        return point_of(case).as_record()
    except CamError as error:
        return {"feasible": False, "why": str(error)}


@lru_cache(maxsize=1)
def _torques(base: str, folder: Path) -> Mapping[str, Torque]:
    """Engine torques of the original case by load case."""
    return engine_torques(parse_case(base, folder))

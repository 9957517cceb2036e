"""Points solved in worker processes and cached on disk by case."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

from camwright.geometry.errors import CamError
from camwright.pipeline.base.files import json_text, read_json, write_atomic
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.studies.redesign.design_point import point_of, rough_point
from camwright.pipeline.torque.torque import Torque

Record = dict[str, Any]

SOLVED = "solved"


@dataclass(frozen=True)
class PointTask:
    """A case as text, to be solved by the synthesis alone, also on few cam angles, in full, or for
    its conflict of limits.

    base: the original case, whose torque all variants share; folder: of the included files and of
    the cache ``solved/``; version: of the source.
    """

    text: str
    base: str
    folder: Path
    version: str
    tier: Literal["coarse", "rough", "whole", "conflict"]

    @property
    def path(self) -> Path:
        """File of the point in the cache."""
        digest = hashlib.sha256(f"{self.version}\0{self.base}\0{self.text}".encode()).hexdigest()
        return self.folder / SOLVED / f"{self.tier}_{digest[:24]}.json"


def solved(task: PointTask) -> Record:
    """Record of a point, cached or solved; ``why`` states the reason of a missing cam."""
    known = _read(task.path)
    if known is not None:
        return known
    try:
        case = parse_case(task.text, task.folder)
        if task.tier == "rough":
            record = rough_point(case, _torques(task.base, task.folder)).as_record()
        elif task.tier == "coarse":
            record = rough_point(case, engine_torques(case), fine=False).as_record()
        elif task.tier == "conflict":
            problem = problem_of(case, _torques(task.base, task.folder))
            record = {"feasible": False, **infeasibility(problem).as_record()}
        else:
            record = point_of(case).as_record()
    except CamError as error:
        record = {"feasible": False, "why": str(error)}
    write_atomic(task.path, json_text(record) + "\n")
    return record


def _read(path: Path) -> Record | None:
    """Record of a cached point; None without one."""
    if not path.is_file():
        return None
    try:
        record = read_json(path)
    except CamError:  # damaged file: solved again
        return None
    return record if isinstance(record, dict) and "feasible" in record else None


@lru_cache(maxsize=1)
def _torques(base: str, folder: Path) -> Mapping[str, Torque]:
    """Engine torques of the original case by load case."""
    return engine_torques(parse_case(base, folder))

"""Points solved in a process of their own and kept on disk, by the case they are of."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

from camwright.geometry.errors import CamError
from camwright.pipeline.base.files import json_text, read_json, write_atomic
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.studies.redesign.design_point import point_of, rough_point

SOLVED = "solved"


@dataclass(frozen=True)
class Task:
    """A case as text to be solved on a coarse turn or whole.

    base is the case all variants come from, whose torque they share; folder holds the files they
    include, and ``solved/`` what is kept; version names what solves it.
    """

    text: str
    base: str
    folder: Path
    version: str
    tier: Literal["rough", "whole"]

    @property
    def path(self) -> Path:
        """Where the point is kept."""
        digest = hashlib.sha256(f"{self.version}\0{self.base}\0{self.text}".encode()).hexdigest()
        return self.folder / SOLVED / f"{self.tier}_{digest[:24]}.json"


def solved(task: Task) -> dict[str, Any]:
    """The record of a point, as kept or solved now; what cannot be a cam has its ``why``."""
    known = _read(task.path)
    if known is not None:
        return known
    try:
        case = parse_case(task.text, task.folder)
        if task.tier == "rough":
            record = asdict(rough_point(case, _torques(task.base, task.folder)))
        else:
            record = point_of(case).as_record()
    except CamError as error:
        record = {"feasible": False, "why": str(error)}
    write_atomic(task.path, json_text(record) + "\n")
    return record


def _read(path: Path) -> dict[str, Any] | None:
    if not path.is_file():
        return None
    try:
        record = read_json(path)
    except CamError:  # torn by a crash of the machine: solved anew
        return None
    return record if isinstance(record, dict) and "feasible" in record else None


@lru_cache(maxsize=1)
def _torques(base: str, folder: Path) -> Mapping[str, Torque]:
    return engine_torques(parse_case(base, folder))

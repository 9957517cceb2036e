"""The smallest run folder that holds together, for tests of what reads and writes one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.template import template
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.run_folder import RunFolder

ROWS = 5


def small_case(name: str = "small") -> Case:
    return parse_case(template(name))


def values(columns: tuple[Column, ...], rows: int = ROWS) -> dict[str, Any]:
    """SI values for every column, none of them a round number."""
    made: dict[str, Any] = {}
    for k, column in enumerate(columns):
        made[column.name] = np.sin(np.arange(rows) + k) / 3.0
    if "load_case" in made:
        made["load_case"] = np.array(["idle"] * rows)
    return made


def check(status: str = "pass", **changes: Any) -> dict[str, Any]:
    demand = {"pass": 1.0, "fail": 3.0, "waived": 3.0, "not_evaluated": None}[status]
    record = {
        "id": "pressure_angle",
        "title": "Pressure angle",
        "demand": demand,
        "limit": 2.0,
        "unit": "deg",
        "utilisation": None if demand is None else demand / 2.0,
        "status": status,
        "load_case": "idle",
        "cam_angle_deg": 12.5,
        "source": "Rothbart",
        "method": "refined between samples",
        "sense": "at_most",
        "must_have": True,
    }
    return record | changes


def summary(verdict: str = "pass", trials: int = 1) -> dict[str, Any]:
    return {
        "timings_s": {"total": 1.0},
        "trials": trials,
        "verdict": verdict,
        "binding": [] if verdict == "pass" else ["pressure_angle"],
        "headline": dict.fromkeys(run_reader.HEADLINE, 1.0),
    }


def write_trial(folder: RunFolder, checks: list[Mapping[str, Any]], number: int = 1) -> None:
    folder.write_lift(number, values(run_reader.LIFT))
    folder.write_contour(number, values(run_reader.CONTOUR))
    folder.write_cycle(number, values(run_reader.CYCLE))
    folder.write_checks(number, checks)
    folder.write_trial(number, {"smoother": {"kind": "none"}, "widths": np.arange(2.0)})


def write_run(out: Path, case: Case | None = None, status: str = "pass") -> Path:
    """A finished run whose only check has this status."""
    with RunFolder(out, case or small_case()) as folder:
        folder.write_torque(np.arange(ROWS) / 7.0, {"total": np.arange(ROWS) / 3.0})
        write_trial(folder, [check(status)])
        folder.finish(summary("pass" if status in ("pass", "waived") else "fail"))
    return out

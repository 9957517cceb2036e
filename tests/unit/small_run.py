"""The smallest run folder that holds together, for tests of what reads and writes one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from small_machine import small_machine

from camwright.pipeline.base.tables import CAM_ANGLE, CRANK_ANGLE, LOAD_CASE, Column, Values
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.scope_section import Scope
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.run_folder import RunFolder

ROWS = 5
LIFT = (CAM_ANGLE, CRANK_ANGLE, Column("lift", "mm"), Column("lift_d1", "mm/rad"),
        Column("lift_d2", "mm/rad^2"), Column("lift_d3", "mm/rad^3"))  # fmt: skip
CONTOUR = (CAM_ANGLE, Column("contour_x", "mm"), Column("contour_y", "mm"))
CYCLE = (LOAD_CASE, CAM_ANGLE, CRANK_ANGLE, Column("lift", "mm"), Column("normal_force", "N"),
         Column("pressure_angle", "deg"), Column("p0_hertz", "MPa", unknown=True),
         Column("p0_fe", "MPa", unknown=True), Column("von_mises", "MPa", unknown=True),
         Column("torque_before", "N m", unknown=True),
         Column("torque_after", "N m", unknown=True))  # fmt: skip
TRIAL = {
    "number": 1, "why": "", "smoothing_kind": "none", "smoothing_strength": 1.0,
    "smoothing_width_deg": None, "smoothing_description": "none", "prices": None,
    "synthesis": None, "closure_mm": 0.0, "table_step_deg": 0.0,
    "depth": "certified", "contact_method": "", "hertz_difference": None, "balance": {},
    "mesh": None, "certificate": [],
    "widths": np.arange(2.0),
}  # fmt: skip
VERDICT_OF = {
    "pass": "pass", "waived": "pass", "fail": "fail", "not_evaluated": "incomplete",
}  # fmt: skip
TORQUE = (CRANK_ANGLE, Column("total", "N m"))


def small_case(name: str = "small") -> Case:
    return parse_case(small_machine(name))


def values(columns: tuple[Column, ...], rows: int = ROWS) -> dict[Column, Any]:
    """SI values for every column, none of them a round number."""
    made: dict[Column, Any] = {}
    for k, column in enumerate(columns):
        made[column] = np.sin(np.arange(rows) + k) / 3.0
    if LOAD_CASE in made:
        made[LOAD_CASE] = np.array(["idle"] * rows)
    return made


def named(columns: Values) -> dict[str, Any]:
    """Values by the bare name of their column."""
    return {column.name: values for column, values in columns.items()}


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
        "waiver": "A. Engineer, 2025-01-02: proven" if status == "waived" else None,
        "waived_up_to": 3.5 if status == "waived" else None,
        "not_proven": False,
        "note": "",
        "error": None,
        "corner": "",
        "corner_demand": None,
        "evidence": False,
        "judged_at": "",
    }
    return record | changes


def summary(verdict: str = "pass", trials: int = 1) -> dict[str, Any]:
    return {
        "timings_s": {"total": 1.0},
        "trials": trials,
        "final_trial": trials,
        "trial_points": [],
        "ripple_map": None,
        "depth": "certified",
        "verdict": verdict,
        "screen": None,
        "binding": [] if verdict == "pass" else ["pressure_angle"],
        "scope": Scope().as_record(),
        "statement": "",
        "headline": dict.fromkeys(run_reader.HEADLINE, 1.0),
        "prices": None,
        "machine_prices": None,
        "benchmarks": None,
        "speed": None,
        "consistency": [],
    }


def write_trial(folder: RunFolder, checks: list[Mapping[str, Any]], number: int = 1) -> None:
    folder.write("2_lift.csv", values(LIFT), number)
    folder.write("3_contour.csv", values(CONTOUR), number)
    folder.write("5_cycle.csv", values(CYCLE), number)
    folder.write("6_checks.json", checks, number)
    folder.write("trial.json", TRIAL, number)


def write_run(out: Path, case: Case | None = None, status: str = "pass") -> Path:
    """A finished run whose only check has this status."""
    with RunFolder(out, case or small_case()) as folder:
        folder.write("1_torque.csv", values(TORQUE))
        write_trial(folder, [check(status)])
        folder.finish(summary(VERDICT_OF[status]))
    return out

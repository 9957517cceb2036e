"""Case and contour of a finished run as solved."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.run_records import SPLINE
from camwright.pipeline.smoothing.scenario import DesignVariables, redrawn

_SPLINE_ROUNDING = 1e-9  # of coefficients computed by another machine


def drawn_cam(run: Path) -> tuple[Case, Contour]:
    """Case of a run with spring and prime radius of its final trial, and its contour.

    The contour is the one that was solved, drawn and certified, whatever the number of positions.

    Raises
    ------
    ResultError
        If the run is unreadable, or the coefficients of its lift are not those of a C4 spline.
    """
    case, final = read_case(run / "case.toml"), run_reader.read_run(run).final
    design = final.record["synthesis"]
    if design is not None and case.smoothing.free:
        try:
            rate, radius = design["spring_rate_N_per_mm"], design["prime_radius_mm"]
            case = redrawn(case, DesignVariables(1e3 * rate, design["preload_N"], 1e-3 * radius))
        except (KeyError, TypeError) as error:
            raise ResultError(f"{final.path / 'trial.json'}: synthesis: {error}") from None
    return case, case.contour(_drawn_lift(final))


def _drawn_lift(trial: run_reader.TrialRecord) -> Lift:
    """Lift of a trial from the coefficients of its spline in the run folder.

    Raises
    ------
    ResultError
        If the file cannot be read, or its coefficients are not those of a C4 spline.
    """
    file, record = trial.path / run_reader.SPLINE_FILE, trial.record
    columns = read_table(file)
    try:
        values, *others = (columns[column.header] for column in SPLINE)
        closure, step = record["closure_mm"], record["table_step_deg"]
        lift = Lift(uniform_turn(len(values)), values, 1e-3 * closure, float(np.radians(step)))
    except (InputError, KeyError, TypeError) as error:
        raise ResultError(f"{file}: {error}") from None
    for stated, exact in zip(others, lift.spline.coefficients[1:], strict=True):
        if np.abs(stated - exact).max() > _SPLINE_ROUNDING * np.abs(exact).max():
            raise ResultError(f"{file}: the coefficients are not those of a C4 spline")
    return lift

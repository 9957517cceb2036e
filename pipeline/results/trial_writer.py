"""Files of a trial in a run folder."""

from __future__ import annotations

from camwright.meshes.mesh_files import write_msh
from camwright.pipeline.cycle.axial_pressure import axial_arrays
from camwright.pipeline.cycle.guide_pressure import guide_arrays
from camwright.pipeline.cycle.rolling_history import envelope_arrays
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_records import (
    contour_columns,
    cycle_columns,
    lift_columns,
    limit_columns,
    pressure_arrays,
    spline_columns,
    sweep_columns,
    trial_record,
)
from camwright.pipeline.results.trial import Trial


def write_trial_files(folder: RunFolder, trial: Trial) -> None:
    """Write lift, contour, mesh, cycle, checks and record of a trial.

    The pressure along the line of contact is that of half-spaces; the certificate states the
    correction of it.
    """
    number, case = trial.number, trial.case
    cycles = tuple(cycle.with_ends(None) for cycle in trial.cycles)
    folder.write_spline(number, spline_columns(trial.lift))
    folder.write_lift(number, lift_columns(case, trial.lift))
    if trial.limits_in_use is not None:
        folder.write_limits(number, limit_columns(*trial.limits_in_use))
    folder.write_contour(number, contour_columns(case, trial.contour))
    if (mesh := trial.mesh) is not None:
        bodies = {"cam": mesh.cam, mesh.name: mesh.follower}
        write_msh(folder.mesh_path(number), bodies)
        turns = {cycle.load_case: cycle.rolling for cycle in cycles}
        folder.write_envelope(number, envelope_arrays(turns))
    folder.write_cycle(number, cycle_columns(cycles))
    folder.write_speed_sweep(number, sweep_columns(trial.solution.speed_sweeps))
    folder.write_pressure(number, pressure_arrays(cycles))
    folder.write_guides(number, guide_arrays(cycles))
    if (axial := axial_arrays(cycles)) is not None:
        folder.write_length(number, axial)
    write_judgement(folder, trial)


def write_judgement(folder: RunFolder, trial: Trial) -> None:
    """Write checks and record of a trial; again after its certificate."""
    folder.write_checks(trial.number, [check.as_record() for check in trial.checks])
    folder.write_trial(trial.number, trial_record(trial))

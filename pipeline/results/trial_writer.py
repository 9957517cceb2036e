"""Writing of a trial's files in a run folder."""

from __future__ import annotations

from camwright.meshes.mesh_files import write_msh
from camwright.pipeline.cycle.axial_pressure import axial_arrays
from camwright.pipeline.cycle.guide_pressure import guide_arrays, pivot_arrays
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
    """Write the files of a trial into a run folder: lift, contour, mesh, cycle, checks and record.

    The pressure along the line of contact is that of half-spaces; the certificate states the
    correction of it.
    """
    number, case = trial.number, trial.case
    cycles = tuple(cycle.with_ends(()) for cycle in trial.cycles)
    folder.write("2_spline.csv", spline_columns(trial.lift), number)
    folder.write("2_lift.csv", lift_columns(case, trial.lift), number)
    if trial.limits_in_use is not None:
        folder.write("2_limits.csv", limit_columns(*trial.limits_in_use), number)
    folder.write("3_contour.csv", contour_columns(case, trial.contour), number)
    if (mesh := trial.mesh) is not None:
        bodies = {"cam": mesh.cam, mesh.name: mesh.follower}
        write_msh(folder.mesh_path(number), bodies)
        turns = {cycle.load_case: cycle.rolling for cycle in cycles}
        folder.write("5_envelope.npz", envelope_arrays(turns), number)
    folder.write("5_cycle.csv", cycle_columns(cycles), number)
    folder.write("5_speed_sweep.csv", sweep_columns(trial.solution.speed_sweeps), number)
    folder.write("5_pressure.npz", pressure_arrays(cycles), number)
    if trial.solution.machine.arm is None:
        folder.write("5_guides.npz", guide_arrays(cycles), number)
    if (pivot := pivot_arrays(cycles)) is not None:
        folder.write("5_pivot.npz", pivot, number)
    if (axial := axial_arrays(cycles)) is not None:
        folder.write("5_length.npz", axial, number)
    write_judgement(folder, trial)


def write_judgement(folder: RunFolder, trial: Trial) -> None:
    """Write checks and record of a trial; repeated after its certificate."""
    folder.write("6_checks.json", [check.as_record() for check in trial.checks], trial.number)
    folder.write("trial.json", trial_record(trial), trial.number)

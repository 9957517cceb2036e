"""Inspection of a measured cam: fit to the nominal contour, cycle and checks of the real one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.geometry.measured_contour import Inspection, inspected, real_contour, surface_of_lift
from camwright.geometry.track_deviation import EXACT, MeasuredTracks, TrackDeviation
from camwright.pipeline.base import units
from camwright.pipeline.base.files import json_text, write_atomic
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.tables import CAM_ANGLE, Column, table
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import verdict
from camwright.pipeline.case.case import Case
from camwright.pipeline.records.inspection_document import CycleFigures, InspectionDocument
from camwright.pipeline.records.run_summary import HeadlineRecord
from camwright.pipeline.results import check_records, run_reader
from camwright.pipeline.results.run_records import cycle_columns, headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.results.workshop_files import SECOND_TRACKS, measured_surface, real_cam
from camwright.pipeline.solver import solve
from camwright.pipeline.torque.angle_trace import read_trace
from camwright.pipeline.torque.trace_file import trace_text

FOLDER = "inspection"
_WAVES_LISTED = 12

_PLACES = (("measured_x_mm", "measured_y_mm"), ("x_mm", "y_mm"))
_LIFT = ("cam_angle_deg", "lift_mm")
_POLAR = (("polar_angle_deg", "measured_radius_mm"), ("angle_deg", "radius_mm"))


@dataclass(frozen=True, eq=False)
class RealPart:
    """Measured cam: fit to the nominal surface, real contour, and trial on it; track: the measured
    one, where it was stated.
    """

    fit: Inspection
    surface: Contour
    contour: Contour
    trial: Trial
    track: str | None = None


def read_measured(path: Path, contour: Contour) -> Array:
    """Measured surface points, (2, n), m, from a CSV file with a header.

    Columns, in mm and deg about the cam axis: ``measured_x_mm, measured_y_mm`` (the completed
    inspection sheet), or ``x_mm, y_mm``, or ``polar_angle_deg, measured_radius_mm``, or
    ``angle_deg, radius_mm``; or a column of the cam angle and one of the lift over it, in any unit,
    such as ``cam_angle_deg, lift_mm``: see `surface_of_lift`. Columns are separated by semicolons,
    tabs or commas; the decimal sign is a point, or a comma where it does not separate columns. Rows
    with empty measured cells are skipped; a table of the lift has none.

    Parameters
    ----------
    contour : Contour   nominal, under the follower with which a lift was measured

    Raises
    ------
    InputError
        With file, line, value and limit: if the file is missing, a folder, empty, binary or over
        64 MiB, without these columns, or with a value that is no finite number.
    """
    text = trace_text(path, ",".join(_PLACES[0]))
    for pair in (*_PLACES, *_POLAR):
        if set(text.header).issuperset(pair):
            first, second = text.numbers([text.header.index(name) for name in pair], gaps=True).T
            if not first.size:
                raise InputError(f"{text.name}, {', '.join(pair)}", "empty", "measured in a row")
            if pair in _PLACES:
                return np.stack([first, second]) * units.factor("mm")
            turned = np.radians(first)
            return np.stack([np.cos(turned), np.sin(turned)]) * second * units.factor("mm")
    lifts = [name for name in text.header if "lift" in name.lower()]
    if len(lifts) == 1:
        trace = read_trace(path, "lift", column=lifts[0], period=FULL_TURN, part="cam")
        return surface_of_lift(contour, trace.angle, trace.values)
    known = " or ".join(", ".join(pair) for pair in (*_PLACES, *_POLAR, _LIFT))
    raise InputError(f"{text.name} header", ", ".join(text.header)[:200], known)


def inspect_part(
    case: Case,
    contour: Contour,
    measured: Array,
    *,
    track: str | None = None,
    keep_phase: bool = False,
    jobs: int | None = None,
    progress: Progress = SILENT,
) -> RealPart:
    """Fit a measured contour to the nominal one, solve the measured cam in its case, and check it.

    Parameters
    ----------
    case : Case               of the cam
    contour : Contour         nominal
    measured : array (2, n)   surface points, m
    track : str               which is measured, see `measured_surface`; the motion is that of it,
                              the clearance that of both
    keep_phase : bool         measured angles are relative to the keyway
    jobs : int                processes of the certificate; None: number of cores, at most 4
    progress : Progress       told each stage

    Raises
    ------
    InputError, GeometryError
        If the measured points are not of this cam.
    """
    progress.stage("fit")
    surface = measured_surface(case, contour, track)
    fit = inspected(surface, measured)
    real = real_contour(surface, fit, keep_phase=keep_phase)
    real = real_cam(case, contour, track, real)
    deviation = measured_tracks(case, track, fit, keep_phase=keep_phase)
    trial = solve(case, real, deviation=deviation, jobs=jobs, progress=progress)
    return RealPart(fit, surface, real, replace(trial, why="measured contour"), track)


def measured_tracks(
    case: Case, track: str | None, fit: Inspection, *, keep_phase: bool = False
) -> TrackDeviation:
    """Deviations of a cam that pulls with one measured track: the other one is as drawn. Both faces
    of a yoke run on the measured one.
    """
    if not case.cam.pulls:
        return EXACT
    ahead = fit.phase if keep_phase and case.cam.spacing is not None else 0.0
    if track in SECOND_TRACKS:
        return MeasuredTracks(turn=-ahead, second=fit)
    return MeasuredTracks(turn=ahead, first=fit, second=fit if case.cam.yoke is not None else None)


def _clearance(part: RealPart) -> Array:
    """Clearance between two tracks over the turn (n,), m; of an interference below zero."""
    machine, path = part.trial.solution.machine, part.contour.pitch
    cam, theta = machine.cam, uniform_turn(path.lift.search_count)
    drawn = cam.clearance if cam.conjugate is None else cam.conjugate.gap
    return drawn + machine.deviation.opened(path, cam.second, theta)


def write_inspection(
    run: Path, part: RealPart, tolerance: float, folder: Path
) -> InspectionDocument:
    """Write the files of an inspection: deviations, cycle, checks and record.

    Parameters
    ----------
    run : Path          folder of the run of the nominal cam
    part : RealPart     fit and solved cam
    tolerance : float   width of the tolerance zone of the profile, m
    folder : Path       of the inspection

    Returns
    -------
    dict    the contents of ``inspection.json``
    """
    fit = part.fit
    order = np.argsort(fit.theta)
    theta = fit.theta[order]
    nominal, normal = part.surface.points(theta), part.surface.normal(theta)
    deviation = {
        CAM_ANGLE: theta,
        Column("deviation", "um"): fit.deviation[order],
        Column("form", "um"): fit.form(theta),
        **{Column(f"nominal_{axis}", "mm"): each for axis, each in zip("xy", nominal, strict=True)},
        **{Column(f"normal_{axis}"): each for axis, each in zip("xy", normal, strict=True)},
    }
    write_atomic(folder / "deviation.csv", table(deviation).to_csv())
    write_atomic(folder / "cycle.csv", table(cycle_columns(part.trial.cycles)).to_csv())
    records = [check.as_record() for check in part.trial.checks]
    write_atomic(folder / "checks.json", json_text(records) + "\n")
    record: InspectionDocument = {
        "phase_deg": in_unit(fit.phase, "deg"),
        "size_um": in_unit(fit.size, "um"),
        "deviation_min_um": in_unit(float(fit.deviation.min()), "um"),
        "deviation_max_um": in_unit(float(fit.deviation.max()), "um"),
        "scatter_rms_um": in_unit(fit.scatter, "um"),
        "points": int(fit.theta.size),
        "tolerance_um": in_unit(tolerance, "um"),
        "within_tolerance": bool(np.abs(fit.deviation).max() <= 0.5 * tolerance),
        "waves_um": _waves(fit),
        "nominal": _figures_of(run_reader.read_run(run).summary["headline"]),
        "measured": _figures_of(headline(part.trial.solution)),
        "verdict": verdict(part.trial.checks),
        "verdict_line": check_records.verdict_line(run_reader.read_records(folder / "checks.json")),
        "scope": part.trial.case.scope_record,
        "binding": list(part.trial.binding),
    }
    if part.track is not None:
        record["track"] = part.track
    if part.trial.case.cam.pulls:
        left = _clearance(part)
        record["clearance_um"] = [in_unit(float(each), "um") for each in (left.min(), left.max())]
    write_atomic(folder / "inspection.json", json_text(record) + "\n")
    return record


def _waves(fit: Inspection) -> dict[str, float]:
    """Amplitudes of the largest waves, um, by number per turn."""
    sizes = {k: in_unit(fit.wave(k), "um") for k in range(1, len(fit.cosine))}
    largest = sorted(sizes, key=lambda k: -sizes[k])[:_WAVES_LISTED]
    return {str(k): sizes[k] for k in sorted(largest)}


def _figures_of(key_figures: HeadlineRecord) -> CycleFigures:
    """Figures of an inspection of the key figures of a run."""
    figures: CycleFigures = {
        "normal_force_max_N": key_figures["normal_force_max_N"],
        "normal_force_min_N": key_figures["normal_force_min_N"],
        "p0_max_MPa": key_figures["p0_max_MPa"],
        "von_mises_max_MPa": key_figures["von_mises_max_MPa"],
        "pressure_angle_max_deg": key_figures["pressure_angle_max_deg"],
    }
    if (ripple := key_figures["torque_std_after_Nm"]) is not None:
        figures["torque_after_std_Nm"] = ripple
    return figures


def _fit_of(record: InspectionDocument) -> list[str]:
    """Line of the clearance or interference of two tracks."""
    if "clearance_um" not in record:
        return []
    least, greatest = record["clearance_um"]
    if greatest > 0.0:
        return [f"clearance {least:.2f} to {greatest:.2f} um over the turn"]
    return [f"interference {-greatest:.2f} to {-least:.2f} um over the turn"]


def lines(record: InspectionDocument) -> list[str]:
    """Lines of text of an inspection record."""
    side = "within" if record["within_tolerance"] else "outside"
    text = [
        *([f"track: {record['track']}"] if "track" in record else []),
        f"phase {record['phase_deg']:.4f} deg, size {record['size_um']:+.2f} um",
        f"deviation {record['deviation_min_um']:+.2f} to {record['deviation_max_um']:+.2f} um, "
        f"{side} the tolerance zone of {record['tolerance_um']:g} um; scatter "
        f"{record['scatter_rms_um']:.2g} um rms",
        *_fit_of(record),
        "waves per turn: " + ", ".join(f"{k}: {v:.2f} um" for k, v in record["waves_um"].items()),
    ]
    nominal: Mapping[str, Any] = record["nominal"]
    for name, drawn in nominal.items():
        real = record["measured"].get(name)
        if drawn is not None and real is not None:
            text.append(f"{name}: {drawn:.5g} nominal, {real:.5g} measured")
    text.append(f"verdict on the measured cam: {record['verdict_line']}")
    if record["scope"]["statement"]:
        text.append(record["scope"]["statement"])
    if record["binding"]:
        text.append(f"binding: {', '.join(record['binding'])}")
    return text

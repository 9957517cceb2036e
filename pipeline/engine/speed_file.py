"""Crank speed from a file: case tables, edge times, speeds per tooth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, Count, FileName, In, Known, Part, Share, Used
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, RunningGear
from camwright.pipeline.engine.speed_trace import (
    HARMONICS,
    TAPER,
    TAPERED,
    Filter,
    Harmonics,
    SpeedTrace,
    speed_from_edges,
    speed_from_teeth,
)
from camwright.pipeline.engine.tooth_pattern import Recording, ToothPattern, tooth_pattern
from camwright.pipeline.engine.trigger_wheel import (
    Edges,
    MissingTeeth,
    Teeth,
    ToothShare,
    TriggerWheel,
    counted,
)
from camwright.pipeline.engine.wheel_calibration import (
    PITCH_TOLERANCES,
    Calibrator,
    EdgeRecord,
    PitchTolerance,
    WheelClass,
    WheelReference,
)
from camwright.pipeline.torque.angle_trace import guard_order, guard_span, without_end
from camwright.pipeline.torque.trace_file import (
    QUANTITY_UNITS,
    HeaderText,
    TraceText,
    angle_column,
    columns_of,
    has_angle,
    has_unit,
    is_series,
    named_columns,
    require_alike,
    trace_text,
    without_unit,
)

PRIMARY = "PriLevel"
_LEVELS = [{low, high} for low, high in (("0", "1"), ("0.0", "1.0"), ("0,0", "1,0"))]
UNLIKE = 0.2  # rms difference of columns of speed over their rms
TEETH = 36  # where neither case nor signal states another number


@dataclass(frozen=True, kw_only=True)
class WheelTable(Part):
    """Case table of a measurement at a trigger wheel: file, wheel, filter of the speed.

    Raises
    ------
    InputError
        As `TriggerWheel`.
    """

    table: ClassVar[str] = "engine"
    defaults: ClassVar[Mapping[str, str]] = {"pitch_tolerance": "that of wheel_class"}

    file: FileName
    column: HeaderText = ""
    teeth: Annotated[Teeth | None, Known("counted", 36)] = None
    """teeth of the trigger wheel, missing ones included"""
    missing_teeth: Annotated[MissingTeeth | None, Known("counted", 2)] = None
    """teeth left out at the gap, or at each of several gaps, as 2 of 36-2-2-2"""
    reference_angle: Annotated[Angle, Known("measured at the engine")] = 0.0
    """crank angle of the first tooth after the gap, of several gaps the one before the longest row
    of teeth"""
    harmonics: Annotated[Harmonics, Known("own choice")] = HARMONICS
    """harmonics of the cycle that are kept: the bandwidth"""
    taper: Annotated[Share, TAPERED, Known("own choice")] = TAPER
    wheel_class: Annotated[WheelClass, Known("drawing")] = "stamped"
    """making of the trigger wheel, for the tolerance of its edges"""
    pitch_tolerance: Annotated[PitchTolerance | None, Known("measured, or drawing", "0.02 deg")] = (
        None
    )
    """standard deviation of the place of an edge of the wheel"""
    reference: Annotated[WheelReference | None, Used("torque")] = None
    """second record at the same trigger wheel, for its pitch errors"""
    running_gear: Annotated[RunningGear | None, Used("torque")] = None
    """crank, connecting rod and piston, for their inertia in the pitch errors of the wheel"""

    def __post_init__(self) -> None:
        """Refuse a wheel with too many missing teeth, and a reference record that lacks running
        gear or pitch tolerance.
        """
        super().__post_init__()
        _ = self.wheel  # refuses too many missing teeth
        reference = self.reference
        if reference is None:
            return
        if self.running_gear is None and reference.kind != "no_torque":
            limit = f'given with engine.reference.kind = "{reference.kind}", for its inertia'
            raise InputError("engine.running_gear", "missing", limit)
        if not self.edge_tolerance > 0.0:
            raise InputError("engine.pitch_tolerance", "0 deg", "> 0 deg with engine.reference")

    @property
    def edge_tolerance(self) -> float:
        """Standard deviation of the place of an edge, rad: as stated, else of the wheel's class."""
        stated = self.pitch_tolerance
        return PITCH_TOLERANCES[self.wheel_class] if stated is None else stated

    def calibrator(self, inertia: float, path: Callable[[str], Path]) -> Calibrator:
        """Calibrator of the wheel.

        Parameters
        ----------
        inertia : float   kg m2, of the crankshaft
        path : function   of a file in the case
        """
        known, kind = self.reference, "" if self.reference is None else self.reference.kind
        file = None if known is None else path(known.file)
        return Calibrator(self.edge_tolerance, inertia, self.running_gear, file, kind)

    @property
    def wheel(self) -> TriggerWheel:
        return TriggerWheel(self.teeth or TEETH, self.missing_teeth or 0, self.reference_angle)

    @property
    def band(self) -> Filter:
        """Filter of the speed."""
        return Filter(self.harmonics, self.taper)


@dataclass(frozen=True, kw_only=True)
class SpeedTable(WheelTable):
    """Case table: file of tooth times, or of speed per tooth over crank angle."""

    kind: Literal["speed"] = "speed"
    teeth: Teeth = TEETH
    missing_teeth: MissingTeeth = 0
    speed_unit: Annotated[HeaderText, Known("the file", "rpm")] = ""
    """unit of the speeds of columns whose headers have none"""
    edges: Annotated[int, Count(1, 2), Known("the file")] = 2
    """edges recorded of each tooth"""
    tooth_share: Annotated[ToothShare, Known("drawing")] = 0.5
    """tooth over pitch of the wheel"""
    averaged_over: Annotated[
        float, In("deg", at_least=0, at_most=60), Known("data acquisition")
    ] = 0.0
    """angle over which each speed of the file is a mean"""

    @property
    def wheel(self) -> TriggerWheel:
        return replace(super().wheel, tooth_share=self.tooth_share)


def edges_from_csv(
    path: str | Path, wheel: TriggerWheel, both_edges: bool = True, column: str = ""
) -> EdgeRecord:
    """Edges of a trigger wheel in each run of a file: a column of their times per run, or a logic
    level over time.

    Columns of levels, 0 and 1, are those whose header begins with `column`, else ``PriLevel``, the
    primary trigger in the composite log of an engine control, else the only one. Of a wheel with
    several gaps the record shows the teeth between them.

    Parameters
    ----------
    path : path            of the file
    wheel : TriggerWheel   as stated
    both_edges : bool      in a file of times, whether every second edge is a falling one; of
                           levels, whether falling edges are used as well
    column : str           beginning of the headers of the columns to read; "": see above

    Raises
    ------
    InputError
        As `read_trace` and `counted`; if one of several levels is to be named.
    """
    text = trace_text(Path(path), "time_s", one_column=True)
    levels = _level_columns(text, column)
    runs = _changes(text, levels) if levels else _times(text, column)
    both = both_edges or bool(levels)
    edges = []
    for label, run in runs.items():
        # The gap lies between teeth; if it does between rising and falling edges, teeth are at 0.
        inverted = bool(levels and wheel.missing_teeth) and _longest(run[1:]) > _longest(run)
        run_edges, wheel = _counted(f"{text.name} {label}", run[int(inverted) :], wheel, both)
        edges.append(run_edges[: 1 + both_edges])
    return EdgeRecord(text.name, edges, wheel)


def _longest(times: Array) -> float:
    """Greatest time from a falling edge to the next, over the usual one; the first edge rises."""
    between = times[2::2] - times[1:-1:2]
    return float(between.max() / np.median(between)) if between.size else 0.0


def _counted(
    field: str, run: Array, wheel: TriggerWheel, both: bool
) -> tuple[tuple[Edges, ...], TriggerWheel]:
    """Edges of a run with their places on the wheel, and the wheel; where the run shows several
    gaps in a turn, the wheel has the rows of teeth between them.

    Parameters
    ----------
    field : str            name of the run, for messages
    run : array (n,)       times of the edges, s
    wheel : TriggerWheel   as stated
    both : bool            whether every second edge is a falling one
    """
    if wheel.missing_teeth and not wheel.rows and (np.diff(run) > 0.0).all():
        kinds = (run[::2], run[1::2]) if both else (run,)
        for kind in kinds:
            shown = tooth_pattern(kind)
            stated = (shown.teeth, shown.missing_teeth) == (wheel.teeth, wheel.missing_teeth)
            if shown.rows and stated:
                wheel = replace(wheel, rows=shown.rows)
    return counted(field, run, wheel, both), wheel


def _times(text: TraceText, column: str) -> dict[str, Array]:
    """Times of edges (n,), s, from each column of time, a run each, by its header.

    Parameters
    ----------
    text : TraceText   the file
    column : str       beginning of the headers of the columns to read; "": all of time
    """
    wanted = columns_of(text.header, "time", column)
    if not wanted:
        limit = f"a column of time with its unit ({', '.join(QUANTITY_UNITS['time'])})"
        raise InputError(f"{text.name} header", ", ".join(text.header), limit)
    table = text.numbers(tuple(wanted))
    return {text.header[at]: factor * table[:, k] for k, (at, factor) in enumerate(wanted.items())}


def _level_columns(text: TraceText, column: str) -> list[int]:
    """Indices, from 0, of the columns of a trace to be read as logic levels (0 or 1) of the tooth
    sensor; empty for a file of edge times.

    Those that `column`, the value of `engine.column`, names; where it is "", the only one, or of
    several the one whose header is `PRIMARY`.

    Raises
    ------
    InputError
        If there are several and none is to be preferred.
    """
    header = text.header
    bare = [at for at, head in enumerate(header) if not has_unit(head)]
    levels = [at for at in bare if set(text.cells(at)) in _LEVELS]
    if column:
        return named_columns(header, column, levels)
    if len(levels) > 1:
        levels = named_columns(header, PRIMARY, levels)
        if len(levels) != 1:
            limit = f"the header of a level in {text.name}: {', '.join(header)}"
            raise InputError("engine.column", "missing", limit)
    return levels


def _changes(text: TraceText, levels: Sequence[int]) -> dict[str, Array]:
    """Times (n,), s, at which each logic level of a file changes, by header of the level; from its
    first rising change on.

    Parameters
    ----------
    text : TraceText    the file, with one column of time
    levels : sequence   indices of the columns of the levels
    """
    header = text.header
    times = columns_of(header, "time")
    if len(times) > 1:
        times = {at: factor for at, factor in times.items()
                 if without_unit(header[at]).lower() == "time"}  # fmt: skip
    if len(times) != 1:
        limit = f"one column of time with its unit ({', '.join(QUANTITY_UNITS['time'])})"
        raise InputError(f"{text.name} header", ", ".join(header), limit)
    ((time_at, factor),) = times.items()
    table = text.numbers((time_at, *levels))
    runs = {}
    for k, at in enumerate(levels, start=1):
        change = np.flatnonzero(np.diff(table[:, k])) + 1
        first = int(table[change[0], k] < 1.0)
        runs[header[at]] = factor * table[change[first:], 0]
    return runs


def speed_from_csv(
    path: str | Path,
    wheel: TriggerWheel,
    band: Filter,
    *,
    both_edges: bool = True,
    column: str = "",
    unit: str = "",
    averaged_over: float = 0.0,
    calibrator: Calibrator | None = None,
) -> SpeedTrace:
    """Crank speed from a file of tooth times, or of speed per tooth over crank angle.

    A file with a column of crank angle has speeds, a column per run; any other has edges; see
    `edges_from_csv`. Without a gap in the wheel the cycle begins with the record; the turn with the
    expansion follows from the speed.

    Parameters
    ----------
    path : path               of the file
    wheel : TriggerWheel      of which edges are the edges; not used with speeds
    band : Filter             of the speed
    both_edges : bool         times: every second edge is a falling one
    column : str              beginning of the headers of the columns to read
    unit : str                speeds: the unit of columns without one
    averaged_over : float     speeds: rad over which each is a mean
    calibrator : Calibrator   of the pitch errors; None: a wheel without pitch errors

    Raises
    ------
    InputError
        As `read_trace`, `counted`, `speed_from_edges` and `Calibrator`; if speeds have a reference.
    """
    text = trace_text(Path(path), "time_s", one_column=True)
    if has_angle(text.header):
        angle, speeds = _speed_table(text, column, unit)
        if calibrator is None:
            return speed_from_teeth(text.name, angle, speeds, band, averaged_over)
        if calibrator.reference is not None:
            limit = "left out with speeds against crank angle: pitch errors need times of edges"
            raise InputError("engine.reference", "a table", limit)
        return speed_from_teeth(text.name, angle, speeds, band, averaged_over, calibrator.tolerance)
    record = edges_from_csv(path, wheel, both_edges, column)

    def read(reference: Path) -> EdgeRecord:
        return edges_from_csv(reference, wheel, both_edges)

    trace = speed_of_record(record, band, calibrator, read)
    pattern = ToothPattern(wheel.teeth, wheel.missing_teeth, rows=record.wheel.rows)
    return replace(trace, recording=Recording(len(record.runs), pattern))


def speed_of_record(
    record: EdgeRecord,
    band: Filter,
    calibrator: Calibrator | None,
    read: Callable[[Path], EdgeRecord],
) -> SpeedTrace:
    """Crank speed over the cycle from the edge times of a record, with the expansion in the second
    turn of each cycle.

    Parameters
    ----------
    record : EdgeRecord       name, runs and wheel
    band : Filter             of the speed
    calibrator : Calibrator   of the pitch errors; None: a wheel without pitch errors
    read : function           edges of a second record in a file of the same form

    Raises
    ------
    InputError
        As `speed_from_edges` and `Calibrator`.
    """
    source, runs, wheel = record
    if calibrator is None:
        return speed_from_edges(source, runs, wheel, band).with_firing()
    calibration = calibrator(record, read, band.last)
    kinds = calibration.errors.errors.size // wheel.present
    runs = [run[:kinds] for run in runs]
    trace = speed_from_edges(source, runs, wheel, band, calibration.errors)
    return replace(trace.with_firing(), calibration=calibration)


def _speed_table(text: TraceText, column: str, unit: str) -> tuple[Array, Array]:
    """Crank angles (n,), rad, and speeds (m, n), rad/s, of one cycle, from m columns of a file.

    Parameters
    ----------
    text : TraceText   the file
    column : str       beginning of the headers of the columns to read; "": all of speed, which have
                       to be alike
    unit : str         of columns without a unit in the header; "": these are not read

    Raises
    ------
    InputError
        If the unit is not known, no column has a speed, or the angles are not in order over one
        cycle.
    """
    name, header = text.name, text.header
    at, factor = angle_column(name, header)
    wanted = columns_of(header, "speed", column)
    known = ", ".join(QUANTITY_UNITS["speed"])
    if unit:
        if unit not in QUANTITY_UNITS["speed"]:
            raise InputError("engine.speed_unit", unit, f"one of {known}")
        if not wanted:
            wanted = dict.fromkeys(
                _without_unit(name, header, column), QUANTITY_UNITS["speed"][unit]
            )
    if not wanted:
        limit = f"a column of speed with its unit ({known}), or of time"
        raise InputError(f"{name} header", ", ".join(header), limit)
    table = text.numbers((at, *wanted))
    guard_order(name, text.line_numbers, table[:, 0], header[at])
    angle, values = table[:, 0] * factor, table[:, 1:] * np.array(list(wanted.values()))
    guard_span(name, angle, factor, CYCLE_ANGLE)
    angle, values = without_end(angle, values, CYCLE_ANGLE)
    if not column:
        require_alike(name, [header[k] for k in wanted], values.T, UNLIKE)
    return angle, np.asarray(values.T)


def _without_unit(name: str, header: Sequence[str], column: str) -> list[int]:
    """Indices, from 0, of the columns of a file without a unit in the header: those whose header
    begins with `column`, else all.

    Parameters
    ----------
    name : str          of the file, for messages
    header : sequence   of each column
    column : str        beginning of the headers wanted; "": all

    Raises
    ------
    InputError
        If `column` is "" and the headers differ in more than numbers.
    """
    bare = [at for at, head in enumerate(header) if not has_unit(head)]
    named = named_columns(header, column, bare)
    if not column and not is_series(header[k] for k in bare):
        heads = ", ".join(header[k] for k in bare)
        limit = f"the beginning of the headers of speed in {name}, of {heads}"
        raise InputError("engine.column", "missing", limit)
    return named

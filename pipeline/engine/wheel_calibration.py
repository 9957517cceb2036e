"""Calibration of a trigger wheel: pitch errors from a second record, or a tolerance."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import FileName, In, Known, Part
from camwright.pipeline.engine.crankshaft import Inertia
from camwright.pipeline.engine.cylinder import RunningGear
from camwright.pipeline.engine.passing_times import passages_of
from camwright.pipeline.engine.pitch_errors import PitchErrors, pitch_errors
from camwright.pipeline.engine.trigger_wheel import Edges, TriggerWheel
from camwright.pipeline.torque.torque import SAMPLES, uniform_cycle

WheelClass = Literal["milled", "stamped"]
PITCH_TOLERANCES: Mapping[WheelClass, float] = MappingProxyType(
    {"milled": float(np.radians(0.02)), "stamped": float(np.radians(0.05))}
)
"""Standard deviation of the place of an edge, rad.

Equally probable within the general tolerance of a length to 6 mm, ISO 2768-1: 0.05 mm of the class
fine for a milled wheel, 0.1 mm of the class medium for a stamped one, at a radius of 75 mm (60
teeth of module 2.5 mm), 0.05 / sqrt(3) / 75 rad = 0.022 deg and 0.044 deg, rounded.
"""
WIDE = 1.5  # rms of the estimated errors over the tolerance, from which it is too small

ReferenceKind = Literal["second_speed", "run_down", "no_torque"]
PitchTolerance = Annotated[float, In("deg", at_least=0, at_most=2)]


@dataclass(frozen=True, kw_only=True)
class WheelReference(Part):
    """Case table of a second record at the same trigger wheel, for its pitch errors.

    In a run-down the gas torque is the same in every cycle. Without gas torque the wheel is driven,
    as by a motor or with the spark plug removed.
    """

    table: ClassVar[str] = "engine.reference"

    file: Annotated[FileName, Known("test bench", "fast.csv")]
    """data file of the second record, in the form of the first"""
    kind: Annotated[ReferenceKind, Known("test bench", "second_speed")]
    """the gas torque of the measurement at another speed, a run-down without firing, or no gas
    torque"""


class EdgeRecord(NamedTuple):
    """Edges of the runs of a record with their wheel; see `counted`."""

    source: str
    runs: Sequence[Sequence[Edges]]
    wheel: TriggerWheel


@dataclass(frozen=True, eq=False)
class Calibration:
    """Calibrated pitch errors of a trigger wheel, with kind and speed range of the reference.

    Parameters
    ----------
    errors : PitchErrors
    kind : str              of the reference; "": none, so that the tolerance is all
    speeds : tuple          rad/s, least and greatest mean speed of the cycles used
    """

    errors: PitchErrors
    kind: ReferenceKind | Literal[""] = ""
    speeds: tuple[float, float] = (0.0, 0.0)

    @property
    def too_wide(self) -> bool:
        """Whether the estimated errors are too large for the tolerance of the wheel."""
        return bool(self.kind) and self.errors.rms > WIDE * self.errors.tolerance


@dataclass(frozen=True)
class Calibrator:
    """Estimator of a wheel's pitch errors from a second record.

    Two speeds, or the falling speed of a run-down, separate pitch errors from torque only if the
    inertia of crankshaft and running gear is known and the gas torque is the same at all speeds.

    Parameters
    ----------
    tolerance : float              rad, standard deviation of the place of an edge
    inertia : float                kg m2, of the crankshaft, reciprocating masses left out
    running_gear : RunningGear     None: no reciprocating mass
    reference : path               of the second record; None: none, so that the tolerance is all
    kind : str                     of the second record
    """

    tolerance: float
    inertia: float
    running_gear: RunningGear | None = None
    reference: Path | None = None
    kind: ReferenceKind | Literal[""] = ""

    def __call__(
        self, record: EdgeRecord, read: Callable[[Path], EdgeRecord], harmonics: int
    ) -> Calibration:
        """Pitch errors of the wheel of a record.

        Parameters
        ----------
        record : EdgeRecord   of the measurement
        read : function       file -> edge record, for the second record
        harmonics : int       of the cycle, of the torque

        Raises
        ------
        InputError
            If the wheels of the two records differ; as `passages_of`.
        CamError
            As `pitch_errors`.
        """
        if self.reference is None:
            edges = len(record.runs[0]) * record.wheel.present
            return Calibration(PitchErrors.unknown(edges, self.tolerance))
        record, second = _alike(record, read(self.reference))
        first = passages_of(*record, harmonics)
        same = self.kind == "second_speed"
        further = passages_of(*second, harmonics, first.half_orders if same else None)
        records = [first, further] if same else [further]
        order = harmonics if self.kind != "no_torque" else 0

        def estimated(tolerance: float) -> PitchErrors:
            return pitch_errors(records, self._turning, tolerance, order)

        errors = estimated(self.tolerance)
        if errors.rms > WIDE * self.tolerance:  # its class says nothing of such a wheel
            errors = replace(estimated(errors.rms), tolerance=self.tolerance)
        if not same:  # noise of the measurement has no part in these errors
            errors = replace(errors, noise=0.0, shared=np.empty((0, 0)))
        speeds = np.concatenate([one.speeds for one in records])
        return Calibration(errors, self.kind, (float(speeds.min()), float(speeds.max())))

    @property
    def _turning(self) -> Inertia:
        """Inertia of crank and running gear over the crank angle of a cycle, kg m2."""
        if self.running_gear is None:
            return Inertia.constant_only(self.inertia, SAMPLES)
        varying = self.running_gear.reciprocating_inertia(uniform_cycle(SAMPLES))
        return Inertia(self.inertia, varying)


def _between(rows: tuple[int, ...]) -> str:
    return f" between rows of {', '.join(map(str, rows))}" if rows else ""


def _alike(record: EdgeRecord, second: EdgeRecord) -> tuple[EdgeRecord, EdgeRecord]:
    """Two records of one wheel, both with only the kinds of edges, rising or falling, that both
    have.

    Raises
    ------
    InputError
        If the wheel of the second record has another number of teeth or other gaps.
    """
    value, limit = (
        f"{wheel.teeth} teeth, {wheel.missing_teeth} missing{_between(wheel.rows)}"
        for _, _, wheel in (second, record)
    )
    if value != limit:
        raise InputError(f"engine.reference.file {second.source}", value, limit)
    kinds = min(len(one.runs[0]) for one in (record, second))
    first, further = (
        one._replace(runs=[run[:kinds] for run in one.runs]) for one in (record, second)
    )
    return first, further

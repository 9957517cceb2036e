"""Requirements on a design: smoothing, tolerances, load cases, waivers, confirmations; solver."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from math import radians
from typing import Annotated, Literal, Self

from pydantic import Field, field_validator, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    Characters,
    Duration,
    FileName,
    GasPressure,
    In,
    Length,
    Preload,
    Rate,
    Ratio,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.section import Name, Section, StatedSource, Text


class Mechanism(Section):
    """The drive between shaft and cam: shaft turns per cam turn, a number or ``"3:2"``.

    A cam turn holds a whole number of cycles of the machine, one per lobe of the cam.
    compensation is the share of the torque that the cam balances.
    """

    gear_ratio: Annotated[float, Ratio(above=0, at_most=100)] = 2.0
    compensation: Annotated[float, In(above=0, at_most=1)] = 1.0


FreeName = Literal["initial_energy", "spring_rate", "preload", "prime_radius", "phase"]
Order = Annotated[float, In(at_least=0.5, at_most=180)]
Phase = Annotated[float, In("deg", at_least=-180, at_most=180)]


_OF_FILTER: Mapping[str, tuple[str, ...]] = {
    "moving_average": ("points", "spacing"),
    "gaussian": ("width",),
    "harmonic": ("harmonics", "taper"),
    "savitzky_golay": ("points", "spacing", "degree"),
    "smoothing_spline": ("cutoff",),
}
"""Keys of `[smoothing]` that a filter uses."""


class Smoothing(Section):
    """Smoothing of the torque before the lift is computed from it; angles are crank angles.

    Several filters may be stated, of which kind takes one; a kind whose keys are all missing beside
    those of another filter is refused.
    `constrained` computes the lift of least ripple within all limits; values named by `free` are
    variables within their ranges. Each weight is that of a term over its reference: ripple of
    torque, speed and harmonics (rms) over that of the engine; loss of guides and roller bearing per
    cam turn and greatest energy of the spring over the energy swing of the engine torque; contact
    force at standstill (mean) and greatest contact force over that of the greatest engine torque at
    the prime radius; size, the mean of both means of energy and force at standstill.
    harmonic_orders are periods per crank turn. robust_weight is that of the torque ripple at speeds
    and loads of 1 -+ robust_speed and 1 -+ robust_load. The phase is that of the cam on its shaft,
    in cam angle. The optimisation starts from `starts` points, all but one random, to find several
    local optima. coefficients is the number of splines of the turn, the same in each lobe; where it
    is missing it rises until the ripple changes by less than ripple_convergence. Where limits
    conflict, the relaxations keep them with the corrections of the nearest solved cam, greater by
    correction_margin, and failed checks are kept at the tolerance corners and with their error
    bars; with a margin of 0 relaxations of the closed form alone are stated, for nominal values.
    """

    kind: Literal[
        "none",
        "moving_average",
        "gaussian",
        "harmonic",
        "savitzky_golay",
        "smoothing_spline",
        "constrained",
    ] = "none"
    points: Annotated[int, Field(ge=1, le=720)] = 12
    spacing: Annotated[float, In("deg", above=0, at_most=120)] = radians(5.0)
    width: Duration = radians(60.0)
    harmonics: Annotated[float, In(at_least=1, at_most=360)] = 12.0
    taper: Annotated[float, In(at_least=0, below=1)] = 0.25
    degree: Annotated[int, Field(ge=0, le=20)] = 2
    cutoff: Duration = radians(120.0)
    free: Annotated[tuple[FreeName, ...], Field(strict=False)] = ("initial_energy",)
    spring_rate_range: Annotated[tuple[Rate, Rate], Field(strict=False)] | None = None
    preload_range: Annotated[tuple[Preload, Preload], Field(strict=False)] | None = None
    prime_radius_range: Annotated[tuple[Length, Length], Field(strict=False)] | None = None
    phase_range: Annotated[tuple[Phase, Phase], Field(strict=False)] | None = None
    coefficients: Annotated[int, Field(ge=12, le=240)] | None = None
    ripple_convergence: Annotated[float, In(at_least=1e-5, at_most=0.1)] = 0.005
    starts: Annotated[int, Field(ge=1, le=40)] = 4
    torque_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 1.0
    speed_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    harmonic_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    harmonic_orders: Annotated[tuple[Order, ...], Field(strict=False, max_length=64)] = ()
    loss_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 1.0
    size_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    spring_energy_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    rest_force_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    peak_force_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    robust_weight: Annotated[float, In(at_least=0, at_most=1)] = 0.0
    robust_speed: Annotated[float, In(at_least=0, below=1)] = 0.1
    robust_load: Annotated[float, In(at_least=0, below=1)] = 0.1
    jerk_weight: Annotated[float, In(at_least=0, at_most=1e3)] = 1e-5
    correction_margin: Annotated[float, In(at_least=0, at_most=1)] = 0.03
    corners: bool = False
    source: StatedSource = NO_SOURCE

    @property
    def of_spring(self) -> set[str]:
        """Free variables that change the spring."""
        return {"spring_rate", "preload"} & {*self.free}

    @model_validator(mode="after")
    def _has_its_ranges(self) -> Self:
        for name in self.free:
            if name == "initial_energy":
                continue
            ends = getattr(self, f"{name}_range")
            if ends is None or not ends[0] < ends[1]:
                field = f"smoothing.{name}_range"
                raise InputError(field, ends, "two rising values, as smoothing.free names it")
        return self

    @model_validator(mode="after")
    def _uses_what_is_stated(self) -> Self:
        """Several filters may be stated, for a study of kinds; one alone is that of the kind."""
        every = dict.fromkeys(key for keys in _OF_FILTER.values() for key in keys)
        stated = [key for key in every if key in self.model_fields_set]
        if stated and "kind" not in self.model_fields_set:
            limit = f"given with smoothing.{stated[0]}: without it nothing is smoothed"
            raise InputError("smoothing.kind", "missing", limit)
        own = _OF_FILTER.get(self.kind, ())
        if own and stated and not {*own} & {*stated}:
            limit = f"given: kind = {self.kind} does not use smoothing.{stated[0]}"
            raise InputError(f"smoothing.{own[0]}", "missing", limit)
        return self

    @model_validator(mode="after")
    def _has_its_orders(self) -> Self:
        if self.harmonic_weight > 0 and not self.harmonic_orders:
            raise InputError("smoothing.harmonic_orders", "missing", "given with harmonic_weight")
        return self


CamAngle = Annotated[float, In("deg", at_least=-360, at_most=360)]


class Solver(Section):
    """Resolution and number of trials."""

    positions: Annotated[int, Field(ge=36, le=7200)] = 720
    max_trials: Annotated[int, Field(ge=1, le=20)] = 6
    certificate_positions: Annotated[int, Field(ge=1, le=64)] = 8
    end_elements: Annotated[int, Field(ge=0, le=12)] = 6
    end_angles: tuple[CamAngle, ...] = ()

    @field_validator("end_elements")
    @classmethod
    def _none_or_two(cls, value: int) -> int:
        if value == 1:
            raise InputError("solver.end_elements", value, "0, without finite elements, or >= 2")
        return value


class Waiver(Section):
    """A failed check that a named person has accepted up to a value, and why.

    up_to is in the unit of the check, such as ``"1200 MPa"``, or a number without a unit.
    """

    check: Name
    up_to: Annotated[str, Characters(1, 40)] | Annotated[float, In()]
    name: Annotated[str, Characters(1, 200)]
    reason: Annotated[str, Characters(1, 2000)]
    date: dt.date


class Confirmation(Section):
    """A value to be confirmed that a source, or a named person on a date, confirms.

    value is its dotted name, such as ``materials.s355.endurance_pressure``.
    """

    value: Annotated[str, Characters(1, 200)]
    source: StatedSource = NO_SOURCE
    name: Text = ""
    date: dt.date | None = None

    @model_validator(mode="after")
    def _confirms(self) -> Self:
        signed = bool(self.name.strip()) and self.date is not None
        if not signed and not self.source.confirmed:
            shown = str(self.source) or "missing"
            limit = "a source that confirms the value, or a name and a date"
            raise InputError(f"confirmed.{self.value}.source", shown, limit)
        return self


class Tolerances(Section):
    """Tolerances: shares of the nominal values, phase in crank angle.

    mass is that of the follower, inertia that of the crankshaft. Tolerances of the spring and of
    the line profile are in their own sections; friction ranges from guides.*.friction_min to
    friction_max if these are given. A tolerance tighter than its default needs `source`, and is to
    be confirmed.
    """

    friction: Annotated[float, In(above=0, below=1)] = 0.5
    mass: Annotated[float, In(above=0, below=1)] = 0.03
    inertia: Annotated[float, In(above=0, below=1)] = 0.05
    phase: Annotated[float, In("deg", above=0, at_most=90)] = radians(1.0)
    samples: Annotated[int, Field(ge=0, le=1000)] = 16
    seed: Annotated[int, Field(ge=0, le=2**31)] = 1
    source: StatedSource = NO_SOURCE


STANDSTILL, OVER_SPEED = "standstill", "over-speed"
"""Names of the load cases in which every case is judged."""


class LoadCase(Section):
    """A load case: crank speed, and what differs from the rest of the case.

    Standstill, and over-speed where limits.overspeed is stated, are judged besides.

    At speed 0 spring and friction act, inertia does not. The torque ripple counts in the synthesis
    with its weight. torque_reduction and speed_reduction are those required in the load case, 0:
    none; left out, those of `limits` at a weight above 0, none at weight 0. A preload acts on the
    cam designed for spring.preload. duty is the share of the operating time: the shares add to 1,
    and life and wear count each load case with its own; without any, the worst one all the time.
    With a cylinder model the intake pressure sets the engine load, and an unfired load case is
    motored, at cranking speed if its speed is 0. power is the mean power of the machine, where it
    is not that of its torque.
    """

    name: Name
    speed: Annotated[float, In("rpm", at_least=0, below=20_000)]
    preload: Preload | None = None
    torque: FileName | None = None
    intake_pressure: GasPressure | None = None
    fired: bool = True
    ripple_weight: Annotated[float, In(at_least=0, at_most=1000)] = 1.0
    torque_reduction: Annotated[float, In(at_least=0, below=1)] | None = None
    speed_reduction: Annotated[float, In(at_least=0, below=1)] | None = None
    duty: Annotated[float, In(at_least=0, at_most=1)] | None = None
    power: Annotated[float, In("W", above=0, at_most=1e9)] | None = None
    source: StatedSource = NO_SOURCE

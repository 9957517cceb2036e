"""Requirements of a case: smoothing, tolerances, load cases, waivers, confirmations; solver."""

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
    Known,
    Length,
    Preload,
    Rate,
    Ratio,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.section import Name, Section, SourceOfTable, StatedSource, Text
from camwright.pipeline.engine.speed_trace import TAPERED


class Mechanism(Section):
    """The drive between the shaft of the machine and the cam.

    A cam turn holds a whole number of cycles of the machine, one per lobe of the cam.
    """

    gear_ratio: Annotated[float, Ratio(above=0, at_most=100), Known("teeth of the gears")] = 2.0
    """shaft turns per cam turn, a number or "3:2\""""
    compensation: Annotated[float, In(above=0, at_most=1), Known("own choice")] = 1.0
    """share of the engine torque that the cam balances"""


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
    the prime radius; size, the mean of both means of energy and force at standstill. The ranges of
    `robust_weight` are 1 -+ `robust_speed` and 1 -+ `robust_load`. Several starting points find
    several local optima. The number of splines is the same in each lobe.

    Where limits conflict, the relaxations keep them with the corrections of the nearest solved cam,
    and failed checks are kept at the tolerance corners and with their error bars; relaxations of
    the closed form are stated for nominal values.
    """

    kind: Annotated[
        Literal[
            "none",
            "moving_average",
            "gaussian",
            "harmonic",
            "savitzky_golay",
            "smoothing_spline",
            "constrained",
        ],
        Known("own choice", "constrained"),
    ] = "none"
    """smoother; `constrained`: lift of least ripple within all limits"""
    points: Annotated[int, Field(ge=1, le=720), Known("own choice")] = 12
    """points of the window of a moving average or Savitzky-Golay filter"""
    spacing: Annotated[float, In("deg", above=0, at_most=120), Known("own choice")] = radians(5.0)
    """crank angle between the points of the window"""
    width: Annotated[Duration, Known("own choice")] = radians(60.0)
    """width of a Gaussian filter: crank angle of the box of equal variance"""
    harmonics: Annotated[float, In(at_least=1, at_most=360), Known("own choice")] = 12.0
    """harmonics that a low-pass keeps"""
    taper: Annotated[float, In(at_least=0, below=1), TAPERED, Known("own choice")] = 0.25
    degree: Annotated[int, Field(ge=0, le=20), Known("own choice")] = 2
    """degree of the polynomial of Savitzky and Golay"""
    cutoff: Annotated[Duration, Known("own choice")] = radians(120.0)
    """wavelength at which a smoothing spline halves, crank angle"""
    free: Annotated[tuple[FreeName, ...], Field(strict=False), Known("own choice")] = (
        "initial_energy",
    )
    """values that the synthesis may change beside the lift"""
    spring_rate_range: Annotated[
        tuple[Rate, Rate] | None, Field(strict=False), Known("own choice", ("20 kN/m", "200 kN/m"))
    ] = None
    """range of a free spring rate"""
    preload_range: Annotated[
        tuple[Preload, Preload] | None,
        Field(strict=False),
        Known("own choice", ("200 N", "1200 N")),
    ] = None
    """range of a free preload"""
    prime_radius_range: Annotated[
        tuple[Length, Length] | None,
        Field(strict=False),
        Known("installation space", ("40 mm", "60 mm")),
    ] = None
    """range of a free prime radius"""
    phase_range: Annotated[
        tuple[Phase, Phase] | None, Field(strict=False), Known("own choice", ("-10 deg", "10 deg"))
    ] = None
    """range of a free phase of the cam on its shaft, cam angle"""
    coefficients: Annotated[int | None, Field(ge=12, le=240), Known("own choice", 48)] = None
    """splines of the lift over the turn; left out, raised until the ripple converges"""
    ripple_convergence: Annotated[float, In(at_least=1e-5, at_most=0.1), Known("own choice")] = (
        0.005
    )
    """change of the ripple at which the number of splines suffices"""
    starts: Annotated[int, Field(ge=1, le=40), Known("own choice")] = 4
    """starting points of the synthesis, all but one random"""
    torque_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 1.0
    """weight of the torque ripple"""
    speed_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the speed ripple"""
    harmonic_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the harmonics of `harmonic_orders`"""
    harmonic_orders: Annotated[
        tuple[Order, ...],
        Field(strict=False, max_length=64),
        Known("resonances of the mounts", (0.5, 1.0)),
    ] = ()
    """periods per crank turn that `harmonic_weight` weighs"""
    loss_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 1.0
    """weight of the mean loss of guides and roller bearing"""
    size_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the size: mean energy of the spring and mean contact force at standstill"""
    spring_energy_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the greatest energy of the spring"""
    rest_force_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the contact force at standstill"""
    peak_force_weight: Annotated[float, In(at_least=0, at_most=1e6), Known("own choice")] = 0.0
    """weight of the greatest contact force"""
    robust_weight: Annotated[float, In(at_least=0, at_most=1), Known("own choice")] = 0.0
    """weight of the ripple at the ends of a range of speed and load"""
    robust_speed: Annotated[float, In(at_least=0, below=1), Known("range of operation")] = 0.1
    """half of the range of speed of `robust_weight`, relative"""
    robust_load: Annotated[float, In(at_least=0, below=1), Known("range of operation")] = 0.1
    """half of the range of load of `robust_weight`, relative"""
    jerk_weight: Annotated[float, In(at_least=0, at_most=1e3), Known("own choice")] = 1e-5
    """weight of the jerk of the lift"""
    correction_margin: Annotated[float, In(at_least=0, at_most=1), Known("own choice")] = 0.03
    """share by which the corrections by finite elements may grow with a relaxation; 0: relaxations
    of the closed form"""
    corners: Annotated[bool, Known("own choice")] = False
    """whether the limits hold at the ends of the tolerances in the synthesis"""
    source: SourceOfTable = NO_SOURCE

    @property
    def of_spring(self) -> set[str]:
        """Free variables of the spring."""
        return {"spring_rate", "preload"} & {*self.free}

    @model_validator(mode="after")
    def _has_its_ranges(self) -> Self:
        """Refuse a free variable without a rising range of its values."""
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
        """Refuse keys of filters without a kind, and a kind of which no key is stated beside those
        of another. Several filters may be stated, for a study of kinds; one alone is that of the
        kind.
        """
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

    positions: Annotated[int, Field(ge=36, le=7200), Known("own choice")] = 720
    """positions of a cam turn that are solved"""
    max_trials: Annotated[int, Field(ge=1, le=20), Known("own choice")] = 6
    """greatest number of trials with smoothing between them"""
    certificate_positions: Annotated[int, Field(ge=1, le=64), Known("own choice")] = 8
    """cam angles at which the contact is certified on three meshes"""
    end_elements: Annotated[int, Field(ge=0, le=12), Known("own choice")] = 6
    """finite elements per half-width of the certificate of the ends of the contact, at least 2; its
    meshes are kept on disk and serve every run of the same bodies; 0: half-spaces alone, with
    stated error bars"""
    end_angles: Annotated[tuple[CamAngle, ...], Known("own choice", ("30 deg", "200 deg"))] = ()
    """cam angles at which the ends of the contact are solved by finite elements, beside the
    worst"""

    @field_validator("end_elements")
    @classmethod
    def _none_or_two(cls, value: int) -> int:
        if value == 1:
            raise InputError("solver.end_elements", value, "0, without finite elements, or >= 2")
        return value


class Waiver(Section):
    """A failed check that a named person has accepted up to a value, and why.

    `up_to` is text with a unit, such as ``"1200 MPa"``, or a number without one.
    """

    check: Annotated[Name, Known("camwright check", "roller_static")]
    """id of the check"""
    up_to: (
        Annotated[str, Characters(1, 40)] | Annotated[float, In(), Known("own responsibility", 0.8)]
    )
    """worst demand that is accepted, in the unit of the check"""
    name: Annotated[str, Characters(1, 200), Known("own responsibility", "A. Engineer")]
    """name of who accepts it"""
    reason: Annotated[str, Characters(1, 2000), Known("own responsibility", "test rig only")]
    """why it is accepted"""
    date: Annotated[dt.date, Known("own responsibility", dt.date(2025, 6, 30))]
    """date of the acceptance"""


class Confirmation(Section):
    """A value to be confirmed that a source, or a named person on a date, confirms."""

    value: Annotated[
        str,
        Characters(1, 200),
        Known("camwright check, values to be confirmed", "limits.jump_speed"),
    ]
    """dotted key of the value"""
    source: Annotated[
        StatedSource, Known("test report, certificate, standard", "test bench, report 12")
    ] = NO_SOURCE
    """source that confirms it; without one, name and date"""
    name: Annotated[Text, Known("own responsibility", "A. Engineer")] = ""
    """name of who confirms it"""
    date: Annotated[dt.date | None, Known("own responsibility", dt.date(2025, 1, 2))] = None
    """date of the confirmation"""

    @model_validator(mode="after")
    def _confirms(self) -> Self:
        """Refuse a confirmation without a confirming source and without a name and date."""
        signed = bool(self.name.strip()) and self.date is not None
        if not signed and not self.source.confirmed:
            shown = str(self.source) or "missing"
            limit = "a source that confirms the value, or a name and a date"
            raise InputError(f"confirmed.{self.value}.source", shown, limit)
        return self


class Tolerances(Section):
    """Tolerances of friction, masses and phase.

    Those of the spring and of the line profile are in their own sections; friction ranges from
    guides.*.friction_min to friction_max if these are given. A tolerance tighter than its default
    needs `source`, and is to be confirmed.
    """

    friction: Annotated[float, In(above=0, below=1), Known("data sheet of the bush")] = 0.5
    """relative tolerance of the friction coefficients"""
    mass: Annotated[float, In(above=0, below=1), Known("drawing")] = 0.03
    """relative tolerance of the follower mass"""
    inertia: Annotated[float, In(above=0, below=1), Known("drawing")] = 0.05
    """relative tolerance of the crankshaft inertia"""
    phase: Annotated[
        float, In("deg", above=0, at_most=90), Known("tolerance chain of key and gear")
    ] = radians(1.0)
    """tolerance of the phase by key and gear, crank angle"""
    samples: Annotated[int, Field(ge=0, le=1000), Known("own choice")] = 16
    """corners drawn at random, all tolerances at once"""
    seed: Annotated[int, Field(ge=0, le=2**31), Known("own choice")] = 1
    """seed of the random tolerance corners"""
    source: SourceOfTable = NO_SOURCE


STANDSTILL, OVER_SPEED = "standstill", "over-speed"
"""Names of the load cases in which every case is judged."""


class LoadCase(Section):
    """A load case: crank speed, and what differs from the rest of the case.

    Standstill, and over-speed where limits.overspeed is stated, are judged besides.

    At speed 0 spring and friction act, inertia does not. The torque ripple counts in the synthesis
    with its weight. A reduction of 0 requires none; one that is left out is that of `limits` at a
    weight above 0, none at weight 0. A preload acts on the cam designed for spring.preload. Life
    and wear count each load case with its duty; without any, the worst one all the time. An unfired
    load case of a cylinder model is motored, at cranking speed if its speed is 0.
    """

    name: Annotated[Name, Known("own choice", "idle")]
    """name of the load case"""
    speed: Annotated[
        float, In("rpm", at_least=0, below=20_000), Known("data sheet of the machine", "1500 rpm")
    ]
    """speed of the machine's shaft"""
    preload: Annotated[Preload | None, Known("adjustment of the spring", "300 N")] = None
    """preload in this load case, in place of spring.preload"""
    torque: Annotated[FileName | None, Known("test bench or simulation", "rated.csv")] = None
    """torque file of this load case"""
    intake_pressure: Annotated[GasPressure | None, Known("measured", "90 kPa")] = None
    """absolute pressure in the intake manifold: the engine load"""
    fired: Annotated[bool, Known("range of operation")] = True
    """whether the engine fires; false: motored"""
    ripple_weight: Annotated[float, In(at_least=0, at_most=1000), Known("own choice")] = 1.0
    """weight of the ripple of this load case in the synthesis"""
    torque_reduction: Annotated[
        float | None, In(at_least=0, below=1), Known("requirement", 0.1)
    ] = None
    """reduction of the torque ripple required in it, in place of that of the limits"""
    speed_reduction: Annotated[float | None, In(at_least=0, below=1), Known("requirement", 0.1)] = (
        None
    )
    """reduction of the speed ripple required in it, in place of that of the limits"""
    duty: Annotated[float | None, In(at_least=0, at_most=1), Known("load collective", 0.9)] = None
    """share of the operating time; all add to 1"""
    power: Annotated[
        float | None, In("W", above=0, at_most=1e9), Known("data sheet of the machine", "250 W")
    ] = None
    """mean power of the machine, for the share of the friction; left out, that of its torque"""
    source: SourceOfTable = NO_SOURCE

"""What is asked of a design: smoothing, limits, tolerances, load cases, the solver's settings."""

from __future__ import annotations

import datetime as dt
from math import radians
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, field_validator, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    Duration,
    Fraction,
    GasPressure,
    In,
    Length,
    Preload,
    Pressure,
    Rate,
    Residual,
    Safety,
)
from camwright.pipeline.case.section import (
    FileName,
    Name,
    Section,
    Text,
    printable,
    refusal,
    suggestion,
)


class Mechanism(Section):
    """The drive between crank and cam: crank turns per cam turn.

    compensation is the share of the engine's torque that the cam is cut to take.
    """

    gear_ratio: Annotated[float, In(above=0, at_most=100)] = 2.0
    compensation: Annotated[float, In(above=0, at_most=1)] = 1.0


FreeName = Literal["initial_energy", "spring_rate", "preload", "pitch_base_radius", "phase"]
Phase = Annotated[float, In("deg", at_least=-180, at_most=180)]


class Smoothing(Section):
    """What is done to the torque before the lift is drawn from it; angles are crank angles.

    `constrained` draws the lift of least ripple within all limits; what is `free` it may change
    as well, within its range: a phase is one of the cam on its shaft, in degrees of cam. It is
    looked for from `starts` places, all but one of them random, so that its optimum is known for
    one of many or not.
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
    pitch_base_radius_range: Annotated[tuple[Length, Length], Field(strict=False)] | None = None
    phase_range: Annotated[tuple[Phase, Phase], Field(strict=False)] | None = None
    coefficients: Annotated[int, Field(ge=12, le=240)] = 96
    starts: Annotated[int, Field(ge=1, le=40)] = 4
    torque_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 1.0
    speed_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    jerk_weight: Annotated[float, In(at_least=0, at_most=1e3)] = 1e-5
    corners: bool = False
    source: Text = ""

    @model_validator(mode="after")
    def _knows_how_far(self) -> Self:
        for name in self.free:
            if name == "initial_energy":
                continue
            ends = getattr(self, f"{name}_range")
            if ends is None or not ends[0] < ends[1]:
                field = f"smoothing.{name}_range"
                raise InputError(field, ends, "two rising values, as it is free")
        return self

    @model_validator(mode="after")
    def _fits_into_a_cycle(self) -> Self:
        if self.points * self.spacing > radians(720.0) + 1e-9:
            raise InputError("smoothing.points", self.points, "<= 720 deg over smoothing.spacing")
        return self


class Limits(Section):
    """What the checks compare with; a safety above 1 asks for more than the bare limit."""

    closure: Annotated[float, In("mm", above=0, at_most=1)] = 1e-9
    pressure_angle: Annotated[float, In("deg", above=0, below=90)] = radians(30.0)
    curvature_ratio: Annotated[float, In(at_least=1, at_most=100)] = 1.5
    undercut_factor: Annotated[float, In(above=0, below=1)] = 0.3
    # The depth no cam is ground to.
    second_contact_depth: Annotated[float, In("mm", above=0, at_most=1)] = 1e-6
    tool_radius: Length | None = None
    curvature_rate: Annotated[float, In("1/m/rad", above=0, at_most=1e9)] | None = None
    # Outside over inside radius of the ring about the bore.
    minimum_wall: Annotated[float, In(at_least=1, at_most=100)] = 1.75
    contact_safety: Safety = 1.0
    yield_safety: Safety = 1.0
    shakedown_safety: Safety = 1.0
    contact_force_margin: Annotated[float, In(above=0, below=1)] = 0.2
    jump: Safety = 1.0
    overspeed: Annotated[float, In("rpm", above=0, below=20_000)] | None = None
    jump_speed: Annotated[float, In(at_least=1, at_most=100)] = 1.3
    clearance: Annotated[float, In("mm", above=0, at_most=1000)] = 0.001
    cam_radius: Length | None = None
    target_life: Annotated[float, In("h", above=0, at_most=1e6)] | None = None
    edge_factor: Annotated[float, In(at_least=1, at_most=5)] = 1.3
    waviness: Annotated[float, In(above=0, at_most=1)] = 0.2
    chord_share: Fraction = 0.25
    jam_index: Annotated[float, In(above=0, below=1)] = 0.5
    roller_static_safety: Safety = 1.0
    roller_life: Annotated[float, In("h", above=0, at_most=1e6)] | None = None
    roller_speed_share: Fraction = 0.7
    pin_share: Fraction = 0.6
    spring_fatigue: Safety = 1.2
    spring_solid: Annotated[float, In(above=0, at_most=10)] = 0.1
    spring_surge: Annotated[float, In(above=0, at_most=1e4)] = 13.0
    key_pressure: Pressure = 100e6
    bore_pressure: Pressure = 100e6
    key_shear: Pressure = 60e6
    shaft_safety: Safety = 1.5
    shaft_bearing_life: Annotated[float, In("h", above=0, at_most=1e6)] | None = None
    gear_bending_safety: Safety = 1.4
    gear_contact_safety: Safety = 1.0
    unbalance: Annotated[float, In("mm/s", above=0, at_most=1e4)] | None = None
    film_ratio: Annotated[float, In(above=0, at_most=100)] = 1.0
    skid: Annotated[float, In(above=0, at_most=1)] = 0.5
    fatigue_safety: Safety = 1.0
    case_safety: Safety = 1.0
    case_depth_ratio: Safety = 2.0
    bore_safety: Safety = 1.0
    viscosity_ratio: Safety = 1.0
    wear_depth: Length = 5e-5
    # Of the swing: a jump spreads over a few samples, a smooth law does not.
    acceleration_step: Fraction = 0.2
    guide_length: Safety = 2.0
    torque_reduction: Annotated[float, In(above=0, below=1)] = 0.4
    speed_reduction: Annotated[float, In(above=0, below=1)] | None = None
    energy_closure: Residual = 1e-9
    friction_balance: Residual = 1e-6
    equilibrium: Residual = 1e-9
    complementarity: Residual = 1e-9
    mesh_uncertainty: Annotated[float, In(above=0, at_most=1)] = 0.03
    sources: dict[str, Text] = Field(default_factory=dict)

    @field_validator("sources")
    @classmethod
    def _name_limits(cls, given: dict[str, str]) -> dict[str, str]:
        known = [name for name in cls.model_fields if name != "sources"]
        for key in given:
            if key not in known:
                raise refusal(f"a known limit{suggestion(key, known)}", unknown_key=key)
        return given


class Solver(Section):
    """How finely and how long to compute."""

    positions: Annotated[int, Field(ge=36, le=7200)] = 720
    max_trials: Annotated[int, Field(ge=1, le=20)] = 6
    certificate_positions: Annotated[int, Field(ge=1, le=64)] = 8


class Waiver(Section):
    """A failed check that a named person has accepted, and why."""

    check: Name
    name: Annotated[str, Field(min_length=1, max_length=200), AfterValidator(printable)]
    reason: Annotated[str, Field(min_length=1, max_length=2000), AfterValidator(printable)]
    date: dt.date


class Tolerances(Section):
    """How far the case may be from what is built: shares of the nominal, phase in crank degrees.

    mass is that of the follower, inertia that of the crankshaft. Those of the spring and the line
    profile stand in their own sections; friction goes from
    guides.*.friction_min to friction_max where they are given.
    """

    friction: Annotated[float, In(at_least=0, below=1)] = 0.0
    mass: Annotated[float, In(at_least=0, below=1)] = 0.0
    inertia: Annotated[float, In(at_least=0, below=1)] = 0.0
    phase: Annotated[float, In("deg", at_least=0, at_most=90)] = 0.0
    samples: Annotated[int, Field(ge=0, le=1000)] = 16
    seed: Annotated[int, Field(ge=0, le=2**31)] = 1
    source: Text = ""


class LoadCase(Section):
    """One state the cam has to bear: crank speed and, where it differs, the torque.

    At speed 0 the cam stands or creeps: springs and friction act, inertia does not. The ripple
    counts with its weight; at 0 the case only loads the cam and no reduction is asked for.
    A preload of its own loads the cam that was cut for spring.preload. Of a cylinder model the
    case may have an intake pressure of its own, which is its load, and be turned over unfired; so
    an engine is started, slowly, where the speed is 0.
    """

    name: Name
    speed: Annotated[float, In("rpm", at_least=0, below=20_000)]
    preload: Preload | None = None
    torque: FileName | None = None
    intake_pressure: GasPressure | None = None
    fired: bool = True
    ripple_weight: Annotated[float, In(at_least=0, at_most=1000)] = 1.0
    source: Text = ""

"""What is asked of a design: smoothing, tolerances, load cases, the solver's settings."""

from __future__ import annotations

import datetime as dt
from math import radians
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

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
)
from camwright.pipeline.case.section import Name, Section, Text


class Mechanism(Section):
    """The drive between crank and cam: crank turns per cam turn.

    compensation is the share of the engine's torque that the cam is cut to take.
    """

    gear_ratio: Annotated[float, In(above=0, at_most=100)] = 2.0
    compensation: Annotated[float, In(above=0, at_most=1)] = 1.0


FreeName = Literal["initial_energy", "spring_rate", "preload", "prime_radius", "phase"]
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
    prime_radius_range: Annotated[tuple[Length, Length], Field(strict=False)] | None = None
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


class Solver(Section):
    """How finely and how long to compute."""

    positions: Annotated[int, Field(ge=36, le=7200)] = 720
    max_trials: Annotated[int, Field(ge=1, le=20)] = 6
    certificate_positions: Annotated[int, Field(ge=1, le=64)] = 8


class Waiver(Section):
    """A failed check that a named person has accepted, and why."""

    check: Name
    name: Annotated[str, Characters(1, 200)]
    reason: Annotated[str, Characters(1, 2000)]
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

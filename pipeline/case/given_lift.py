"""Lift stated in a case: table, segments, points or eccentric circle."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np

from camwright.geometry.arm_path import disc_lift
from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError
from camwright.geometry.lift import NEGATIVE_TOLERANCE, Lift
from camwright.geometry.lift_fit import (
    FittedLift,
    fitted_lift,
    lift_through,
    measured_lift,
    overshoot,
)
from camwright.geometry.rocker_lift import RockerLinkage
from camwright.pipeline.case.lift_section import (
    GivenLift,
    LiftEccentric,
    LiftPoints,
    LiftSegments,
    LiftTable,
    motion_of,
)
from camwright.pipeline.case.parts_section import Follower
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.torque.angle_trace import read_trace


class LiftSource(Protocol):
    """Sections of a case that determine its stated lift."""

    @property
    def lift(self) -> GivenLift | None: ...

    @property
    def cam(self) -> CamBody: ...

    @property
    def follower(self) -> Follower: ...

    @property
    def rocker(self) -> Rocker | None: ...

    @property
    def rocker_linkage(self) -> RockerLinkage | None: ...

    def path(self, name: str) -> Path: ...


def eccentric_of(case: LiftSource, section: LiftEccentric) -> Eccentric:
    """Eccentric disc of a case; its minimum pitch radius is the prime radius."""
    rod = case.cam.prime_radius + section.eccentricity
    return Eccentric(section.eccentricity, rod, case.cam.offset)


def given_lift(case: LiftSource) -> Lift:
    """Lift that a case states, by its kind: segments, points, eccentric circle, or table, fitted
    where that is noisy.

    Raises
    ------
    InputError
        If the lift does not close, has gaps or is negative, or a rocker does not reach it.
    """
    lift, rocker, linkage = _stated_lift(case), case.rocker, case.rocker_linkage
    if rocker is None or linkage is None or rocker.lift == "follower":
        return lift
    return linkage.follower_lift(lift, rocker.ramp_angle)


def _stated_lift(case: LiftSource) -> Lift:
    """Lift as the case states it, m over the cam angle: of the follower, or of the output of a
    rocker where the case says so.

    Raises
    ------
    InputError
        If the case has no lift, or its file cannot be read.
    """
    section = case.lift
    if isinstance(section, LiftSegments):
        return motion_of(section).lift()
    if isinstance(section, LiftPoints):
        return lift_through(*_points(section))
    if isinstance(section, LiftEccentric):
        arm = case.follower.arm
        if case.follower.face is not None:
            return case.follower.face.disc_lift(section.eccentricity, case.cam, arm)
        if arm is not None:
            return disc_lift(section.eccentricity, case.cam.prime_radius, arm.linkage)
        return eccentric_of(case, section).lift()
    if section is None:
        raise InputError("lift", "missing", "given without an engine")
    fit = _fitted(case)
    if fit is not None:
        return fit.lift
    trace = read_trace(case.path(section.file), "lift", period=FULL_TURN)
    return Lift.from_samples(trace.angle, trace.values)


def lift_origin(case: LiftSource) -> str:
    """Sentence on the origin of the lift, with the residual of a fitted table."""
    section, fit = case.lift, _fitted(case)
    if fit is not None:
        stated = isinstance(section, LiftTable) and section.noise is not None
        words = f"noise of {1e6 * fit.noise:.3g} um, estimated from its differences"
        noise = "" if stated else f" that falls below zero, without lift.noise: {words}"
        return (
            f"the lift is fitted to a table{noise}: residual {1e6 * fit.residual_rms:.3g} um rms, "
            f"{1e6 * fit.residual_max:.3g} um at most, by {fit.parts} spline parts"
        )
    if isinstance(section, LiftPoints):
        angles, lifts = _points(section)
        away, place = overshoot(angles, lifts, _stated_lift(case), level=True)
        over = f"; between equal points it overshoots by {1e3 * abs(away):.3g} mm at "
        over += f"{np.degrees(place):.4g} deg"
        return "the lift is a spline through points" + over * (abs(away) > NEGATIVE_TOLERANCE)
    if isinstance(section, LiftSegments):
        laws = dict.fromkeys(part.law for part in section.segments)
        times = f", {section.repeat} times a turn" if section.repeat > 1 else ""
        return f"the lift is given by segments: {', '.join(laws)}{times}"
    if isinstance(section, LiftEccentric):
        return "the lift is that of an eccentric circle"
    return "the lift is given"


def table_overshoot(case: LiftSource) -> tuple[float, float] | None:
    """Greatest overshoot of the curve through a lift table beyond its rows, as a share of the
    stroke, and its cam angle, rad; None for another lift, or one fitted to its table.
    """
    if not isinstance(case.lift, LiftTable) or _fitted(case) is not None:
        return None
    trace = read_trace(case.path(case.lift.file), "lift", period=FULL_TURN)
    away, place = overshoot(trace.angle, trace.values, Lift.from_samples(trace.angle, trace.values))
    return abs(away) / float(np.ptp(trace.values)), place


def _points(section: LiftPoints) -> tuple[list[float], list[float]]:
    """Cam angles, rad, and lifts, m, of points."""
    return [point.angle for point in section.points], [point.lift for point in section.points]


def _fitted(case: LiftSource) -> FittedLift | None:
    """Lift fitted to a table within its noise, stated or, where lifts are below zero, estimated;
    None where the lift passes through every row, or is no table.
    """
    section = case.lift
    if not isinstance(section, LiftTable):
        return None
    trace = read_trace(case.path(section.file), "lift", period=FULL_TURN)
    if section.noise is not None:
        return fitted_lift(trace.angle, trace.values, section.noise)
    if trace.values.min() >= -NEGATIVE_TOLERANCE:
        return None
    return measured_lift(trace.angle, trace.values)

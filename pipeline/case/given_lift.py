"""The lift that a case gives, for a road that starts there and not at the torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.eccentric import Eccentric, face_lift
from camwright.geometry.errors import InputError
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.lift_fit import FittedLift, fitted_lift, lift_through
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.lift_section import (
    LiftEccentric,
    LiftPoints,
    LiftSegments,
    LiftTable,
    motion_of,
)
from camwright.pipeline.engine.angle_trace import read_trace

if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case


def eccentric_of(case: Case, given: LiftEccentric) -> Eccentric:
    """The eccentric disc of a case: the lowest place of its roller is the pitch base radius."""
    rod = case.cam.pitch_base_radius + given.eccentricity
    return Eccentric(given.eccentricity, rod, case.cam.offset)


def given_lift(case: Case) -> Lift:
    """The lift of a case that gives one.

    Raises
    ------
    InputError
        For a lift that does not close, leaves gaps or goes below zero.
    """
    given = case.lift
    if isinstance(given, LiftSegments):
        return motion_of(given).lift()
    if isinstance(given, LiftPoints):
        return lift_through(
            [point.angle for point in given.points], [point.lift for point in given.points]
        )
    if isinstance(given, LiftEccentric):
        if case.follower.kind == "flat":
            return face_lift(given.eccentricity)
        return eccentric_of(case, given).lift()
    if given is None:
        raise InputError("lift", "missing", "given where the road starts at it")
    fit = _fitted(case)
    if fit is not None:
        return fit.lift
    trace = read_trace(case.path(given.file), "lift", period=FULL_TURN)
    return Lift.from_samples(trace.angle, trace.values)


def contour_of(case: Case, lift: Lift) -> Contour:
    """The cam that moves the follower of a case so, whatever its kind.

    Raises
    ------
    InputError
        For a roller or an offset beyond the base radius, or a face that the contact runs off.
    """
    base, offset = case.cam.pitch_base_radius, case.cam.offset
    if case.follower.face is None:
        return RollerContour(PitchCurve(lift, base, offset), case.roller.radius)
    contour = FlatFaceContour(FacePath(lift, base, offset))
    contour.require_face(case.follower.face.width)
    return contour


def lift_origin(case: Case) -> str:
    """One line on where a given lift comes from; a fitted table states its residual."""
    given, fit = case.lift, _fitted(case)
    if fit is not None:
        return (
            f"the lift is fitted to a table: residual {1e6 * fit.residual_rms:.3g} um rms, "
            f"{1e6 * fit.residual_max:.3g} um at most, by {fit.parts} spline parts"
        )
    if isinstance(given, LiftSegments):
        laws = dict.fromkeys(part.law for part in given.segments)
        times = f", {given.repeat} times a turn" if given.repeat > 1 else ""
        return f"the lift is given by segments: {', '.join(laws)}{times}"
    if isinstance(given, LiftEccentric):
        return "the lift is that of an eccentric circle"
    return "the lift is given"


def _fitted(case: Case) -> FittedLift | None:
    given = case.lift
    if not isinstance(given, LiftTable) or given.noise is None:
        return None
    trace = read_trace(case.path(given.file), "lift", period=FULL_TURN)
    return fitted_lift(trace.angle, trace.values, given.noise)

"""Checks of a flat face sliding on the cam: width and PV value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base import value_groups as given
from camwright.pipeline.checks.check import Demand, Kept, check, of_key
from camwright.pipeline.checks.contact_strength import line_pressure
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam, face_of
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.flat_face_motion import MEAN_SHARE


@check(
    title="Required face width",
    tier=Tier.SCREENING,
    unit="mm",
    source="contact inside the face, Norton (2009) ch. 7",
    method="twice the sum of |s' - e| and contact half-width, greatest over the turn",
    lift_can_help=True,
    needs="face",
    kept_as="width of the flat face",
    formula="2 (|s' - e| + a) <= w; s': slope of the lift, e: cam.offset, a: half-width of the"
    " contact, w: follower.face.width",
    reason="beyond the face the contact runs on its edge",
    levers=(levers.one("follower.face.width"), *levers.GENTLER),
    page="Flat face",
).measured("angles", allowed=of_key("follower.face.width"), deviation=0.001, kept=Kept(unit="mm"))
def face_width(cam: LoadedCam) -> Array:
    """Required width of the face, contact half-width included, m."""
    return 2.0 * (magnitude(face_of(cam.motion).arm) + cam.half_width)


def _of_its_source(demand: Demand, solution: Solution) -> Demand:
    return replace(demand, source=solution.machine.face.source)


def _sliding(cam: LoadedCam) -> Array:
    """Mean over peak pressure of Hertz times the sliding speed, m/s."""
    return np.asarray(MEAN_SHARE * cam.speed * face_of(cam.motion).height)


@check(
    title="PV value of the flat face",
    tier=Tier.SCREENING,
    unit="MPa m/s",
    source="PV limit of the face",
    method="greatest pi/4 p0 w (r + s) over the turn",
    lift_can_help=True,
    needs="face",
    kept_as="PV of the flat face",
    formula="pi/4 p0 omega (r + s) <= PV; p0: contact pressure, omega: speed of the cam, r: base"
    " radius, s: lift, PV: follower.face.pv_limit",
    reason="a face slides at all angles, and beyond its PV limit it seizes or melts",
    values=(*given.CONTACT, "follower.face.pv_limit"),
    levers=(levers.one("follower.face.depth"), *levers.GENTLER),
    page="Flat face",
).measured(
    "angles",
    allowed=of_key("follower.face.pv_limit"),
    remark=_of_its_source,
    deviation=0.001,
    kept=Kept(lambda cam, limit: line_pressure(cam, limit / _sliding(cam)), unit="MPa m/s"),
)
def face_pv(cam: LoadedCam) -> Array:
    """Mean contact pressure times sliding speed, Pa m/s."""
    return _sliding(cam) * cam.p0

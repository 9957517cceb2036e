"""Torque that the cam is to deliver, and its lift."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.energy import lift_of_spring, signed_deflection
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.external_load import closing_preload
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.follower.spring import stored_lift
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed
from camwright.pipeline.torque.torque import Torque

_TORQUE_ROUND_OFF = 1e-9  # of the torque


def cam_lift(case: Case, torques: Mapping[str, Torque], smoother: Smoother | None = None) -> Lift:
    """Lift of a case: that which the case states, or the one required by the smoothed engine
    torque.

    Parameters
    ----------
    torques : mapping     engine torque by load case; the design load case is used
    smoother : Smoother   None: that of the case
    """
    if case.lift is not None:
        return given_lift(case)
    torque = torques[case.load_cases[0].name]
    return required_lift(case, torque, smoother or Smoother.from_case(case.smoothing, case.period))


def required_torque(case: Case, torque: Torque, smoother: Smoother) -> Array:
    """Crank torque (n,) to compensate, N m: smoothed ripple times compensation."""
    share = smoothed(torque.without_mean().total, smoother)
    return np.asarray(case.mechanism.compensation * share)


def required_lift(case: Case, torque: Torque, smoother: Smoother) -> Lift:
    """Lift whose spring stores and returns the work of the torque that the cam has to deliver.

    With the spring the weight and the mean external force store work; the varying part of the
    external force does not enter the lift.

    Parameters
    ----------
    case : Case           with spring and gear ratio
    torque : Torque       of the design load case
    smoother : Smoother   of this torque

    Raises
    ------
    InputError
        If the smoothing leaves no torque, weight and external force pull the follower off, or the
        spring of a cam that pulls is too weak, see `signed_deflection`.
    """
    target = case.mechanism.gear_ratio * required_torque(case, torque, smoother)
    _require_ripple(torque, target, smoother)
    spring, closing = case.spring, closing_preload(case)

    def deflection(energy: ArrayLike) -> Array:
        stored = np.asarray(energy)
        if closing > 0.0:
            return stored_lift(stored, spring.rate, closing, spring.shape)
        return signed_deflection(stored, spring.rate, closing)  # a cam that pulls

    return lift_of_spring(uniform_turn(target.size), target, deflection)


def _require_ripple(torque: Torque, target: Array, smoother: Smoother) -> None:
    """Refuse a smoothing that leaves nothing but round-off of the torque."""
    before, after = float(np.ptp(torque.total)), float(np.ptp(target))
    if before > 0.0 and not after > _TORQUE_ROUND_OFF * before:
        smoother.refuse_as_too_wide()

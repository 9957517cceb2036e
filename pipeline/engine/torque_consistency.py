"""Consistency of torque, speed, inertia and work in the inputs of one engine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import finite
from camwright.geometry.errors import InputError
from camwright.pipeline.engine.crankshaft import energy_swing
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.records.run_summary import ImpliedRecord

FLAG_ABOVE = 0.10


@dataclass(frozen=True)
class Implied:
    """Stated quantity beside the value implied by other inputs.

    Parameters
    ----------
    id, title, unit : str
    stated, implied : float   in `unit`
    how : str                 derivation of the implied value
    """

    id: str
    title: str
    stated: float
    implied: float
    unit: str
    how: str

    @property
    def difference(self) -> float:
        """(implied - stated) / |stated|; infinite if stated is zero and they differ."""
        off = self.implied - self.stated
        if self.stated == 0.0:
            return 0.0 if off == 0.0 else float(np.copysign(np.inf, off))
        return off / abs(self.stated)

    @property
    def flagged(self) -> bool:
        """Whether they differ by more than 10 %; NaN included."""
        return not abs(self.difference) <= FLAG_ABOVE

    def as_record(self) -> ImpliedRecord:
        """Plain values; a difference beyond all bounds is null."""
        percent = 100.0 * self.difference
        return {
            "id": self.id,
            "title": self.title,
            "given": self.stated,
            "implied": self.implied,
            "unit": self.unit,
            "difference_percent": percent if np.isfinite(percent) else None,
            "flagged": self.flagged,
            "how": self.how,
        }


def implied_inertia(
    torque: ArrayLike, mean_speed: float, speed_std: float, span: float = CYCLE_ANGLE
) -> float:
    """Inertia implied by a torque and its measured speed ripple, kg m2.

    J = std(integral of T - mean T) / (mean omega std omega), from J omega domega = T dtheta in
    the limit of a small ripple.

    Parameters
    ----------
    torque : array (n,)    N m at equal shaft angles over a span (rad) of whole cycles
    mean_speed : float     rad/s, > 0
    speed_std : float      rad/s, > 0
    """
    if not 0.0 < mean_speed < np.inf:
        raise InputError("mean_speed", mean_speed, "> 0 rad/s")
    if not 0.0 < speed_std < np.inf:
        raise InputError("speed_std", speed_std, "> 0 rad/s")
    return float(energy_swing(torque, span).std()) / (mean_speed * speed_std)


def inertia_finding(
    stated: float,
    torque: ArrayLike,
    mean_speed: float,
    speed_std: float,
    span: float = CYCLE_ANGLE,
) -> Implied:
    """Stated inertia against the value implied by torque and measured speed ripple."""
    return Implied(
        "inertia",
        "inertia at the crank",
        stated,
        implied_inertia(torque, mean_speed, speed_std, span),
        "kg m^2",
        "std of the torque's integral / (mean speed x std of the measured speed)",
    )


def ratio_finding(crank_torque: ArrayLike, cam_torque: ArrayLike, gear_ratio: float) -> Implied:
    """Gear ratio against the ratio of cam torque to balanced crank torque.

    The cam speed is the crank speed over the gear ratio: for equal power at every angle the cam
    torque must be the crank torque times the ratio.

    Parameters
    ----------
    crank_torque : array (n,)   N m about its mean, to be balanced by the cam
    cam_torque : array (n,)     N m, of the spring on the cam at the same angles
    gear_ratio : float          crank turns per cam turn
    """
    crank, cam = finite("crank_torque", crank_torque), finite("cam_torque", cam_torque)
    return Implied(
        "power",
        "power balance crank to cam, torque ratio",
        gear_ratio,
        float(cam @ crank) / float(crank @ crank),
        "-",
        "regression of the cam's torque on the crank's about its mean, against the gear ratio",
    )


def energy_finding(
    crank_torque: ArrayLike,
    stored: float,
    title: str = "energy stored per cycle",
    span: float = CYCLE_ANGLE,
) -> Implied:
    """Spring energy over the lift against the energy swing of the balanced torque, J."""
    swing = float(np.ptp(energy_swing(crank_torque, span)))
    return Implied(
        "energy", title, swing, stored, "J",
        "spring energy at full lift against the swing of the torque's integral",
    )  # fmt: skip


def work_finding(friction_loss: float, crank_work: float) -> Implied:
    """Work of the shaft on the mechanism per cycle against the friction loss of the guides, J."""
    return Implied(
        "work",
        "work of the mechanism per cycle",
        friction_loss,
        crank_work,
        "J",
        "work taken from the shaft at its varying speed against guide friction at constant speed",
    )

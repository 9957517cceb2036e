"""Whether torque, speed, inertia and work of one engine fit together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import finite
from camwright.geometry.errors import InputError
from camwright.pipeline.engine.crankshaft import energy_swing

FLAG_ABOVE = 0.10


@dataclass(frozen=True)
class Finding:
    """One quantity as it was given and as the other inputs imply it.

    Parameters
    ----------
    id, title, unit : str
    given, implied : float    in `unit`
    how : str                 where the implied value comes from
    """

    id: str
    title: str
    given: float
    implied: float
    unit: str
    how: str

    @property
    def difference(self) -> float:
        """(implied - given) / given; infinite where that is zero and they differ."""
        off = self.implied - self.given
        if self.given == 0.0:
            return 0.0 if off == 0.0 else float(np.copysign(np.inf, off))
        return off / abs(self.given)

    @property
    def flagged(self) -> bool:
        """Whether they differ by more than 10 %; NaN included."""
        return not abs(self.difference) <= FLAG_ABOVE

    def as_record(self) -> dict[str, str | float | None]:
        """Plain values; a difference beyond all bounds is null."""
        percent = 100.0 * self.difference
        return {
            "id": self.id,
            "title": self.title,
            "given": self.given,
            "implied": self.implied,
            "unit": self.unit,
            "difference_percent": percent if np.isfinite(percent) else None,
            "flagged": self.flagged,
            "how": self.how,
        }


def implied_inertia(torque: ArrayLike, mean_speed: float, speed_std: float) -> float:
    """Inertia that a torque and the ripple of the speed it makes imply, kg m2.

    J = std(integral of T - mean T) / (mean omega std omega), from J omega domega = T dtheta in
    the limit of a small ripple.

    Parameters
    ----------
    torque : array (n,)    N m at equal crank angles over the cycle
    mean_speed : float     rad/s, > 0
    speed_std : float      rad/s, > 0
    """
    if not 0.0 < mean_speed < np.inf:
        raise InputError("mean_speed", mean_speed, "> 0 rad/s")
    if not 0.0 < speed_std < np.inf:
        raise InputError("speed_std", speed_std, "> 0 rad/s")
    return float(energy_swing(torque).std()) / (mean_speed * speed_std)


def inertia_finding(
    given: float, torque: ArrayLike, mean_speed: float, speed_std: float
) -> Finding:
    """The inertia stated against the one that torque and a measured speed ripple imply."""
    return Finding(
        "inertia",
        "inertia at the crank",
        given,
        implied_inertia(torque, mean_speed, speed_std),
        "kg m^2",
        "std of the torque's integral / (mean speed x std of the measured speed)",
    )


def ratio_finding(crank_torque: ArrayLike, cam_torque: ArrayLike, gear_ratio: float) -> Finding:
    """Torque at the cam over the torque at the crank that it balances, against the gear ratio.

    Speeds stand as 1 to the gear ratio, so for equal power at every angle the cam's torque must be
    that of the crank times the ratio.

    Parameters
    ----------
    crank_torque : array (n,)   N m about its mean, that the cam should balance
    cam_torque : array (n,)     N m, that the spring gives the cam at the same angles
    gear_ratio : float          crank turns per cam turn
    """
    crank, cam = finite("crank_torque", crank_torque), finite("cam_torque", cam_torque)
    return Finding(
        "power",
        "power balance crank to cam, torque ratio",
        gear_ratio,
        float(cam @ crank) / float(crank @ crank),
        "-",
        "regression of the cam's torque on the crank's about its mean, against the gear ratio",
    )


def energy_finding(
    crank_torque: ArrayLike, stored: float, title: str = "energy stored per cycle"
) -> Finding:
    """Energy a spring stores against the swing of the torque it should balance, J."""
    swing = float(np.ptp(energy_swing(crank_torque)))
    return Finding(
        "energy", title, swing, stored, "J",
        "spring energy at full lift against the swing of the torque's integral",
    )  # fmt: skip


def work_finding(friction_loss: float, crank_work: float) -> Finding:
    """Work the crank gives the mechanism per cycle against the heat of its guides, J."""
    return Finding(
        "work",
        "work of the mechanism per cycle",
        friction_loss,
        crank_work,
        "J",
        "work taken from the crank at its varying speed against guide friction at constant speed",
    )

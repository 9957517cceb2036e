"""Form closure: the walls of a groove, parallel curves of the path of its roller."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.geometry.contour import require_round
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.interference import SecondContact, second_contact
from camwright.geometry.pitch_curve import CentrePath

Side = Literal["inner", "outer"]


@dataclass(frozen=True, eq=False, repr=False)
class Groove(Displayed):
    """Groove around the path of a roller: two walls, one on either side.

    The roller runs on one of them at a time; between them it has the clearance of the groove.

    Parameters
    ----------
    pitch : CentrePath       path of the roller centre in the middle of the groove
    roller_radius : float    r, m, > 0
    clearance : float        width of the groove less the roller diameter, m, >= 0

    Raises
    ------
    InputError
        If the roller does not fit or the clearance is negative; NaN included. An undercut is a
        result, not an error.

    References
    ----------
    Rothbart, Cam Design Handbook (2004), sec. 6.4: parallel curves of the pitch curve.
    """

    pitch: CentrePath
    roller_radius: float
    clearance: float = 0.0

    def __post_init__(self) -> None:
        require_round("roller.radius", self.roller_radius, self.pitch.radius_base)
        if not 0.0 <= self.clearance < np.inf:
            raise InputError("cam.groove.clearance", self.clearance, ">= 0 m")

    @property
    def half_width(self) -> float:
        """Distance of each wall from the middle of the groove, m."""
        return self.roller_radius + 0.5 * self.clearance

    def _outward(self, side: Side) -> float:
        return self.half_width if side == "outer" else -self.half_width

    def points(self, theta: ArrayLike, side: Side) -> Array:
        """Wall, (2, ...), m, where the roller touches it at cam angles, rad."""
        wall: Array = self.pitch.points(theta) + self._outward(side) * self.pitch.normal(theta)
        return wall

    def second_contact(self, side: Side) -> SecondContact:
        """Minimum gap between the roller and a wall away from their contact."""

        def gap(contact: Array, other: Array) -> Array:
            away = self.points(other, side) - self.pitch.points(contact)
            return np.asarray(np.hypot(*away) - self.half_width)

        return second_contact(gap, len(self.pitch.lift.theta))

    def section(self) -> tuple[float, Array]:
        """Area of the groove, m2, and its first moment about the cam axis (2,), m3."""
        theta = uniform_turn(self.pitch.lift.search_count)
        speed, curvature = self.pitch.speed_and_curvature(theta)
        # a strip across the groove is as long as the path at its distance n: 1 + n kappa
        step, half = theta[1] - theta[0], self.half_width
        middle = 2.0 * half * speed * step
        aside = (2.0 / 3.0) * half**3 * speed * curvature * step
        moment = (middle * self.pitch.points(theta)).sum(axis=1)
        moment = moment + (aside * self.pitch.normal(theta)).sum(axis=1)
        return float(middle.sum()), readonly(moment)

"""A roller centre's path at single places, from lift and derivatives; complex steps pass through.

The pitch curve judges by these functions and the synthesis differentiates them, so that both see
the same cam. Derivatives are by the cam angle, in the follower's axes: `along` = s' - e and
`across` = d is the velocity of the centre, m/rad.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# Real, or complex while a derivative is taken by a complex step.
Values = Any


def magnitude(values: Values) -> Values:
    """|x| of the real part, its sign put to the whole, so that a complex step passes through."""
    return values * np.sign(np.real(values))


def speed_and_curvature(
    along: Values, across: Values, slope: Values, bend: Values
) -> tuple[Values, Values]:
    """Length of the path per radian, m, and its curvature, 1/m, positive where convex.

    Parameters
    ----------
    along, across : array (...)   s' - e and d, m/rad and m
    slope, bend : array (...)     s' and s'', m/rad^k
    """
    speed = np.sqrt(along**2 + across**2)
    turning = along * (along + slope) - across * (bend - across)
    return speed, turning / speed**3


def curvature_slope(
    along: Values, across: Values, slope: Values, bend: Values, jerk: Values
) -> Values:
    """Change of the path's curvature per radian of cam angle, 1/(m rad).

    Parameters
    ----------
    along, across : array (...)       s' - e and d, m/rad and m
    slope, bend, jerk : array (...)   s', s'', s''', m/rad^k
    """
    square = along**2 + across**2
    turning = along * (along + slope) - across * (bend - across)
    change = bend * (3.0 * along + slope) - slope * (bend - across) - across * (jerk - slope)
    stretching = along * bend + across * slope
    return (change - 3.0 * turning * stretching / square) / square**1.5

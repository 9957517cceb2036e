"""Outer ring of a bearing as roller: bending on its balls, body in contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.ring_body import BallRing, RingBody, unit_bend
from camwright.pipeline.contact.rolling_bearing import Bearing, OuterRing
from camwright.pipeline.follower.bearing_ring import Ring, RingBending, ball_stiffness
from camwright.pipeline.follower.bearing_ring_elements import ring_bending

# Half the length of the contact of a ball along the groove over its diameter, recalled for point
# contacts in conforming grooves. A factor of 2 changes p0 by 0.1 %.
_FOOTPRINT = 0.05
# Tolerance of equal radii of roller and ring, m.
_SAME_RADIUS = 1e-6


@dataclass(frozen=True)
class RingOnBalls:
    """Outer ring on its balls: bending per newton, contact bodies over and between balls."""

    ring: Ring
    bending: RingBending
    body: RingBody
    between_balls: RingBody

    def midway(self, line_load: Array, relative_radius: Array) -> Array:
        """Relative change (n,) of p0 between contact over a ball and midway between two.

        p0 is proportional to the root of the relative curvature, which the bending of the ring
        reduces; the bending of the cam is of second order and neglected.

        Parameters
        ----------
        line_load, relative_radius : array (n,)   N/m, m

        References
        ----------
        Johnson, Contact Mechanics (1985), sec. 4.2(c).
        """
        curvature = 1.0 / relative_radius
        over = curvature - line_load * unit_bend(self.body)
        between = curvature - line_load * unit_bend(self.between_balls)
        return np.asarray(np.sqrt(np.maximum(between, 0.0) / over) - 1.0)


def solid_reason(radius: float, bearing: Bearing) -> str:
    """Why a roller is modelled as solid, in words; "" where it is modelled as a ring on its balls.

    Parameters
    ----------
    radius : float      of the roller, m
    bearing : Bearing   with its outer ring, if described
    """
    ring = bearing.ring
    if ring is None:
        return "ring and balls of the bearing are not specified"
    if abs(0.5 * ring.outer_diameter - radius) > _SAME_RADIUS:
        return "the roller is not the outer ring of the bearing"
    return ""


@lru_cache(maxsize=32)
def ring_on_balls(
    ring: OuterRing, steel: Elastic, radius: float, roller_width: float, width: float, load: float
) -> RingOnBalls:
    """Outer ring on its balls under a line contact.

    Balls have their secant stiffness at the load: four times the load increases it by a factor 1.6
    and changes p0 over a ball by at most 0.4 %.

    Parameters
    ----------
    steel : Elastic              of ring and balls
    radius, roller_width : float   of the roller, m
    width : float                of the line contact, m
    load : float                 on the bearing, N
    """
    per_row = ball_stiffness(load / ring.rows, ring.ball_diameter, steel.modulus, steel.poisson)
    thin = Ring(
        radius=0.5 * (ring.outer_diameter - ring.thickness),
        thickness=ring.thickness,
        width=roller_width,
        modulus=steel.modulus,
        balls=ring.balls,
        ball_stiffness=ring.rows * per_row,
    )
    bending = ring_bending(thin, poisson=steel.poisson)

    def body(position: int) -> RingBody:
        balls = BallRing(
            thickness=ring.thickness,
            balls=bending.carrying(position),
            ball_stiffness=thin.ball_stiffness,
            footprint=_FOOTPRINT * ring.ball_diameter,
        )
        return RingBody(radius, balls, width, steel)

    return RingOnBalls(thin, bending, body(0), body(-1))

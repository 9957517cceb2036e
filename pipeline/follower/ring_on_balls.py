"""The outer ring of a bearing that is itself the roller: its bending, its contact body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.ring_body import BallRing, RingBody, unit_bend
from camwright.pipeline.follower.bearing_ring import Ring, RingBending, ball_stiffness
from camwright.pipeline.follower.bearing_ring_elements import ring_bending
from camwright.pipeline.follower.roller_parts import Bearing, OuterRing

# Half length of a ball's contact along the groove over its diameter: recalled of point contacts
# in close grooves. Half or twice as much moves p0 by 0.1 %.
_FOOTPRINT = 0.05
# The roller's surface is the ring's where their radii agree to this, m.
_SAME_RADIUS = 1e-6


@dataclass(frozen=True)
class RingOnBalls:
    """An outer ring on its balls: bending per newton of load, and body of the contact."""

    ring: Ring
    bending: RingBending
    body: RingBody
    between_balls: RingBody

    def midway(self, line_load: Array, relative_radius: Array) -> Array:
        """Relative change of p0 from a contact over a ball to one between two balls, (n,).

        p0 is proportional to the root of the relative curvature, which the ring's bending
        reduces; the cam's own bending is of second order and neglected.

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
    """Reason why a roller of a radius (m) is modelled as solid; "" for a ring on its balls."""
    ring = bearing.ring
    if ring is None:
        return "no ring and balls of the bearing are given"
    if abs(0.5 * ring.outer_diameter - radius) > _SAME_RADIUS:
        return "the roller is not the bearing's outer ring itself"
    return ""


@lru_cache(maxsize=32)
def ring_on_balls(
    ring: OuterRing, steel: Elastic, radius: float, roller_width: float, width: float, load: float
) -> RingOnBalls:
    """The outer ring under a contact of a width (m).

    The stiffness of the balls is that under the load (N): four times the load makes them 1.6
    times as stiff and moves p0 over a ball by 0.4 % at most.

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

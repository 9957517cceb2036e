"""The outer ring of a case's bearing where it is itself the roller: its bending, its contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.ring_body import BallRing, RingBody, unit_bend
from camwright.pipeline.follower.bearing_ring import Ring, RingBending, ball_stiffness
from camwright.pipeline.follower.bearing_ring_elements import ring_bending

# A ball's contact reaches so far along the groove, of its diameter, at loads a bearing bears:
# recalled of point contacts in close grooves. Half or twice as much moves p0 by 0.1 %.
_FOOTPRINT = 0.05
# The roller's surface is the ring's where their radii agree so far, m.
_SAME_RADIUS = 1e-6


@dataclass(frozen=True)
class OuterRing:
    """A ring on its balls under loads per newton, and as a body of the contact."""

    ring: Ring
    bending: RingBending
    body: RingBody
    between_balls: RingBody

    def midway(self, line_load: Array, relative_radius: Array) -> Array:
        """Share by which p0 changes from a contact over a ball to one between two balls, (n,).

        p0 goes with the root of the relative curvature, of which the ring's bending takes away;
        what the cam's own bending adds to that is of the second order and left out.

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


def why_solid(case: Case) -> str:
    """Why the roller is taken as solid on its hub; empty where it is a ring on balls."""
    if case.roller_given is None:
        return "there is no roller"
    ring = case.roller.bearing.ring
    if ring is None:
        return "no ring and balls of the bearing are given"
    if abs(0.5 * ring.outer_diameter - case.roller.radius) > _SAME_RADIUS:
        return "the roller is not the bearing's outer ring itself"
    return ""


def roller_in_words(case: Case) -> str:
    """How the contact takes the roller; "" under a flat face."""
    if case.roller_given is None:
        return ""
    solid = why_solid(case)
    if solid:
        return f"the roller is solid on its hub, as {solid}"
    return "the roller is its bearing's outer ring on balls, in contact over one of them"


def outer_ring(case: Case, width: float) -> OuterRing | None:
    """The ring under a contact of a width (m); None where the roller is solid: `why_solid`.

    Balls give way as under the static rating, where the case has one, else as under the preload.
    Four times that load makes them 1.6 times as stiff and moves p0 over a ball by 0.4 % at most.
    """
    given = None if why_solid(case) else case.roller.bearing.ring
    if given is None:
        return None
    steel = case.material(case.roller.material)
    load = case.roller.bearing.C0 or case.spring.preload
    ring = Ring(
        radius=0.5 * (given.outer_diameter - given.thickness),
        thickness=given.thickness,
        width=case.roller.width,
        modulus=steel.E,
        balls=given.balls,
        ball_stiffness=given.rows
        * ball_stiffness(load / given.rows, given.ball_diameter, steel.E, steel.nu),
    )
    bending = ring_bending(ring, poisson=steel.nu)

    def body(position: int) -> RingBody:
        balls = BallRing(
            thickness=given.thickness,
            balls=bending.carrying(position),
            ball_stiffness=ring.ball_stiffness,
            footprint=_FOOTPRINT * given.ball_diameter,
        )
        return RingBody(case.roller.radius, balls, width, Elastic(steel.E, steel.nu))

    return OuterRing(ring, bending, body(0), body(-1))

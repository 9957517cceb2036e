"""Contact pair of cam and follower of a machine."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.form_closure import groove_wall
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.cycle.cam_balance import drilled_hole
from camwright.pipeline.follower.follower_forces import Loads, wall_of
from camwright.pipeline.follower.roller import on_second_track


def contact_pair(machine: Machine, contour: Contour) -> ContactPair:
    """Contour, bodies and materials of the contact, the same in every load case.

    In a groove the inner wall is on the disc within, held at its bore. The outer wall is on the rim
    around it. The web under the groove carries the rim; in the plane the rim is held at its outer
    circle instead, many half-widths behind the contact. A second roller presses on that rim or on a
    disc of its own with the same bore and keyway, the second face of a yoke on the same cam; its
    block is like the first.
    """
    cam, width = machine.cam, machine.contact_width
    pair = ContactPair(
        contour=contour,
        width=width,
        bore_radius=cam.bore_radius,
        keyway=cam.keyway,
        cam=Elastic(cam.material.E, cam.material.nu),
        follower=machine.follower.body(width, machine.stem, machine.spring.preload),
        counter_hole=drilled_hole(cam, contour),
    )
    second = cam.second
    if second is not None:
        track, body = second.track(contour.pitch), pair.follower
        if contour.rolls:
            roller = on_second_track(machine.roller, cam)
            body = roller.body(width, machine.stem, machine.spring.preload)
        pulling = replace(
            pair, contour=track.contour, follower=body, turn=track.turn, own_body=cam.yoke is None,
            counter_hole=pair.counter_hole if cam.yoke is not None else None,
            rim_radius=None if cam.groove is None else cam.groove.outer_radius,
        )  # fmt: skip
        return replace(pair, pulling=pulling)
    if cam.groove is None:
        return pair
    inner = contour.require_roller()
    wall = groove_wall(inner, "outer", inner.roller_radius)
    return replace(pair, pulling=replace(pair, contour=wall, rim_radius=cam.groove.outer_radius))


def under_load(pair: ContactPair, loads: Loads) -> ContactPair:
    """Contact pair of one load case: on the track that carries at each cam angle."""
    if not loads.held:
        return pair
    wall = CarryingWall(loads.theta, loads.signed_force)
    return replace(pair, wall=wall)


@dataclass(frozen=True, eq=False)
class CarryingWall:
    """Surface by which a cam that pulls carries: 1 where it pushes, -1 where it pulls.

    theta : array (n,)      cam angles, rad
    required : array (n,)   axial force on the follower, N
    """

    theta: Array
    required: Array

    def __call__(self, theta: Array) -> Array:
        """Sign of the force between the angles."""
        between = np.interp(theta, self.theta, self.required, period=FULL_TURN)
        return wall_of(np.asarray(between), held=True)

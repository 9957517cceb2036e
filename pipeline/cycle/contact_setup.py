"""Contact pair of cam and follower of a machine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.cycle.cam_balance import drilled_hole
from camwright.pipeline.follower.follower_forces import Loads, wall_of


def contact_pair(machine: Machine, contour: Contour) -> ContactPair:
    """Contour, bodies and materials of the contact, the same in every load case."""
    cam, width = machine.cam, machine.contact_width
    return ContactPair(
        contour=contour,
        width=width,
        bore_radius=cam.bore_radius,
        keyway=cam.keyway,
        cam=Elastic(cam.material.E, cam.material.nu),
        follower=machine.follower.body(width, machine.stem, machine.spring.preload),
        counter_hole=drilled_hole(cam, contour),
    )


def under_load(pair: ContactPair, loads: Loads) -> ContactPair:
    """Contact pair of one load case: in a groove on the wall that carries at each cam angle."""
    if not loads.held:
        return pair
    required = loads.required_force

    def wall(theta: Array) -> Array:
        between = np.interp(theta, loads.theta, required, period=FULL_TURN)
        return wall_of(np.asarray(between), held=True)

    return replace(pair, wall=wall)

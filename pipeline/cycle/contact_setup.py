"""TODO."""

from __future__ import annotations

from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.outer_ring import outer_ring
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody, FollowerBody, RollerBody
from camwright.pipeline.cycle.cam_balance import drilled_hole


def contact_width(case: Case) -> float:
    """Width of the line contact, m: what both cam and follower carry, chamfers left out."""
    return float(min(case.cam.width, case.facing.line_width))


def follower_body(case: Case) -> FollowerBody:
    """Roller, outer ring on its balls or block of the face, as the contact meshes it."""
    card, face = case.material(case.facing.material), case.follower.face
    elastic = Elastic(card.E, card.nu)
    if face is None:
        roller, ring = case.roller, outer_ring(case, contact_width(case))
        solid = RollerBody(roller.radius, roller.hub_radius, elastic)
        return solid if ring is None else ring.body
    return FaceBody(face.width, face.thickness, case.follower.stem_diameter, elastic)


def contact_pair(case: Case, contour: Contour) -> ContactPair:
    """Cam and follower of a case."""
    cam = case.material(case.cam.material)
    return ContactPair(
        contour=contour,
        width=contact_width(case),
        bore_radius=case.cam.bore_radius,
        keyway=case.cam.keyway,
        cam=Elastic(cam.E, cam.nu),
        follower=follower_body(case),
        counter_hole=drilled_hole(case, contour),
    )

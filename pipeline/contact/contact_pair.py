"""Cam and follower as a contact pair: shapes, materials, gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import HoleLike, KeywayLike
from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import BodyMesh
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, Springs
from camwright.pipeline.contact.follower_body import FollowerBody


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Cam and follower: contour, effective width of the line contact (m), bodies, materials."""

    contour: Contour
    width: float
    bore_radius: float
    keyway: KeywayLike | None
    cam: Elastic
    follower: FollowerBody
    counter_hole: HoleLike | None = None

    @property
    def contact_modulus(self) -> float:
        other = self.follower.material
        return hertz.contact_modulus(
            self.cam.modulus, self.cam.poisson, other.modulus, other.poisson
        )

    def relative_radius(self, theta: ArrayLike) -> Array:
        """Relative radius of curvature (...), m; 1/R = 1/r_r + 1/r_c; a face is endlessly round.

        Raises
        ------
        ContactError
            If the cam is so hollow that the follower does not fit.
        """
        curvature = self.contour.follower_curvature + self.contour.curvature(theta)
        if not (curvature > 0).all():
            worst = float(np.atleast_1d(theta)[np.argmin(np.atleast_1d(curvature))])
            name = self.follower.name
            place = shown(worst, "deg", 6)
            raise ContactError(f"the {name} does not fit the concave contour at {place}")
        return 1 / curvature

    def gap(self, theta: Array, xi: Array) -> Array:
        """Distance (n, q) between contour and follower, along the normal, before loading.

        theta (n,) rad; xi (n, q) m along the tangent of a contact frame, which runs clockwise,
        against the contour's own.
        """
        return self.contour.follower_gap(xi) - self.contour.surface_offset(theta, -xi)


def elastic_body(
    mesh: BodyMesh, material: Elastic, held: str, springs: Springs | None = None
) -> ElasticBody:
    """A body on its mesh; held nowhere but by its springs where `held` is empty."""
    return ElasticBody(mesh, material.modulus, material.poisson, held or {}, springs)

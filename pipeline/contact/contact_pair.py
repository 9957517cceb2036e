"""Cam and follower in contact: contour, materials, relative radius, gap."""

from __future__ import annotations

from collections.abc import Callable
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
    """Cam and follower in line contact: contour, contact width, bore radius (m), materials."""

    contour: Contour
    width: float
    bore_radius: float
    keyway: KeywayLike | None
    cam: Elastic
    follower: FollowerBody
    counter_hole: HoleLike | None = None
    wall: Callable[[Array], Array] | None = None
    """of a groove: cam angles (...) -> 1 where the inner wall carries, -1 the outer"""

    @property
    def contact_modulus(self) -> float:
        """E*, Pa."""
        other = self.follower.material
        return hertz.contact_modulus(
            self.cam.modulus, self.cam.poisson, other.modulus, other.poisson
        )

    def relative_radius(self, theta: ArrayLike) -> Array:
        """Relative radius of curvature R (...), m: 1/R = 1/r_r + 1/r_c; 1/r_r = 0 for a face.

        Raises
        ------
        ContactError
            If the contour is undercut: 1/R = 1/(r_r (1 - r_r kappa_p)) is positive elsewhere.
        """
        if self.wall is None:
            curvature = self.contour.follower_curvature + self.contour.curvature(theta)
        else:
            at = np.asarray(theta, dtype=float)
            curvature = 1.0 / self.contour.require_roller().relative_radius(at, self.wall(at))
        if not (curvature > 0).all():
            worst = float(np.atleast_1d(theta)[np.argmin(np.atleast_1d(curvature))])
            name, place = self.follower.name, shown(worst, "deg")
            raise ContactError(f"the contour is undercut at {place}: the {name} has no contact")
        return 1 / curvature

    def gap(self, theta: Array, xi: Array) -> Array:
        """Distance (n, q), m, of contour and follower along the normal, unloaded.

        theta (n,) rad; xi (n, q) m along the tangent of the contact frame, which is opposite to
        that of the contour.
        """
        return self.contour.follower_gap(xi) - self.contour.surface_offset(theta, -xi)


def elastic_body(
    mesh: BodyMesh, material: Elastic, held: str, springs: Springs | None = None
) -> ElasticBody:
    """Elastic body on a mesh, held on boundaries; on springs alone where `held` is empty."""
    return ElasticBody(mesh, material.modulus, material.poisson, held or {}, springs)

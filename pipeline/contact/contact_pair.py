"""Cam and follower in contact: contour, materials, relative radius, gap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import HoleLike, KeywayLike
from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import BodyMesh, cam_mesh, rim_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, Springs
from camwright.pipeline.contact.follower_body import FollowerBody


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Cam and follower in line contact: contour, contact width, bore radius (m), materials.

    The body of the cam is the plane region between contour and bore, held at the bore; or, with the
    radius of a rim (m), that between the outer wall of a groove and this circle, held there. A cam
    that pulls as well has a second pair, by whose surface it does. All cam angles are those of the
    first track.
    """

    contour: Contour
    width: float
    bore_radius: float
    keyway: KeywayLike | None
    cam: Elastic
    follower: FollowerBody
    counter_hole: HoleLike | None = None
    rim_radius: float | None = None
    pulling: ContactPair | None = None
    wall: Callable[[Array], Array] | None = None
    """of a cam that pulls: cam angles (...) -> 1 where it pushes, -1 where it pulls"""
    turn: float = 0.0
    """by which the cam angles of its contour are ahead of those of the first track, rad"""
    own_body: bool = True
    """of a pair by which a cam pulls: whether on a body of its own, as all but the second face of a
    yoke are"""

    @property
    def held(self) -> str:
        """Boundary of the cam's mesh that is held."""
        return "bore" if self.rim_radius is None else "outer"

    def cam_mesh(self, sizing: ElementSize, refinement: float = 1.0) -> BodyMesh:
        """Mesh of the body of the cam, refined at a contact point on its boundary "contour".

        refinement : divides the element size everywhere outside the contact zone
        """
        if self.rim_radius is not None:
            return rim_mesh(self.contour, self.rim_radius, sizing, refinement)
        return cam_mesh(
            self.contour, self.bore_radius, self.keyway, sizing, self.counter_hole, refinement
        )

    def carrying(self, theta: float) -> ContactPair:
        """The pair that carries at a cam angle, rad, alone: this one, or that by which the cam
        pulls.
        """
        if self.pulling is None or self.wall is None:
            return self
        pushes = bool(self.wall(np.asarray(theta)) > 0)
        return replace(self, pulling=None, wall=None) if pushes else self.pulling

    def on_walls(self, theta: Array) -> list[tuple[ContactPair, NDArray[np.bool_]]]:
        """Pairs that carry, each with the cam angles (n,), rad, of `theta` at which it does."""
        if self.pulling is None or self.wall is None:
            return [(self, np.ones(theta.size, dtype=bool))]
        pushes = self.wall(theta) > 0
        both = (self, pushes), (self.pulling, ~pushes)
        return [(pair, at) for pair, at in both if at.any()]

    @property
    def other_track(self) -> ContactPair:
        """This pair on the track that does not carry at each cam angle."""
        if self.wall is None:
            return self
        carries = self.wall
        return replace(self, wall=lambda theta: -carries(theta))

    def contacts(self, theta: Array) -> tuple[Array, Array]:
        """Contact points (2, n), m, on the surface that carries at cam angles (n,), rad, and its
        outward normals (2, n).
        """
        points, normals = np.empty((2, theta.size)), np.empty((2, theta.size))
        for pair, at in self.on_walls(theta):
            points[:, at], normals[:, at] = pair.touched(theta[at])
        return points, normals

    def touched(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Contact points (2, ...), m, on this surface, and its outward normals, at cam angles, rad,
        whether it carries or not.
        """
        at = self.angle(theta)
        return self.contour.points(at), self.contour.normal(at)

    def angle(self, theta: ArrayLike) -> Array:
        """Cam angles (...) of its contour at those of the first track, rad."""
        return np.asarray(theta, dtype=float) + self.turn

    def follower_contacts(self, theta: Array) -> tuple[Array, Array]:
        """Contact points (2, n), m, and outward normals in the frame of the follower's body; (2, 1)
        where all are equal.
        """
        return self.follower.contacts(self.contour, self.angle(theta))

    @property
    def contact_modulus(self) -> float:
        """E*, Pa."""
        other = self.follower.material
        return hertz.contact_modulus(
            self.cam.modulus, self.cam.poisson, other.modulus, other.poisson
        )

    def relative_radius(self, theta: ArrayLike) -> Array:
        """Relative radius of curvature R (...), m, at cam angles theta (...), rad.

        1/R = 1/r_r + 1/r_c, roller and contour; 1/r_r = 0 for a face. In a groove that of the wall
        which carries.

        Raises
        ------
        ContactError
            If the contour is undercut: 1/R = 1/(r_r (1 - r_r kappa_p)) is positive elsewhere.
        """
        curvature = self._relative_curvature(theta)
        if self.wall is not None and self.pulling is not None:
            pushes = self.wall(np.asarray(theta, dtype=float)) > 0
            curvature = np.where(pushes, curvature, self.pulling._relative_curvature(theta))
        if not (curvature > 0).all():
            worst = float(np.atleast_1d(theta)[np.argmin(np.atleast_1d(curvature))])
            name, place = self.follower.name, shown(worst, "deg")
            raise ContactError(f"the contour is undercut at {place}: the {name} has no contact")
        return 1 / curvature

    def _relative_curvature(self, theta: ArrayLike) -> Array:
        return self.contour.follower_curvature + self.curvature(theta)

    def curvature(self, theta: ArrayLike) -> Array:
        """Curvature of the contour (...), 1/m, at the contact at cam angles, rad."""
        return np.asarray(self.contour.curvature(self.angle(theta)))

    def gap(self, theta: Array, xi: Array) -> Array:
        """Distance (n, q), m, of contour and follower along the normal, unloaded.

        theta (n,) rad; xi (n, q) m along the tangent of the contact frame, which is opposite to
        that of the contour.
        """
        return self.contour.follower_gap(xi) - self.contour.surface_offset(self.angle(theta), -xi)


def elastic_body(
    mesh: BodyMesh, material: Elastic, held: str, springs: Springs | None = None
) -> ElasticBody:
    """Elastic body on a mesh, held on boundaries; on springs alone where `held` is empty."""
    return ElasticBody(mesh, material.modulus, material.poisson, held or {}, springs)

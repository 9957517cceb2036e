"""Outer ring of a roller bearing in contact with the cam: annulus supported by balls.

The ring bends over lengths of its thickness, ten times the contact: it enters the contact as any
body, by its correction of the half-plane field, in plane strain.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import body_compliance, contact_patch, follower_body
from camwright.pipeline.contact.body_compliance import LoadedBody
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, Springs
from camwright.pipeline.contact.follower_body import EDGES_ACROSS_WALL, RollerBody

# Over the ball stiffness: supports against rotation of the ring on its balls.
_HOLD = 1e-6
# Quadrature points over the footprint of a ball, under an elliptic pressure.
_QUADRATURE_POINTS = 32
# Modules whose source enters the cache key.
RECIPE = (
    *(sys.modules[__name__], follower_body),
    *(*body_compliance.RECIPE, *contact_patch.MESH_RECIPE),
)


@dataclass(frozen=True)
class BallRing:
    """Outer ring and its loaded balls, at angles from the contact.

    Parameters
    ----------
    thickness : float          below the groove, m, > 0
    balls : tuple of float     angles of the loaded balls from the contact, rad
    ball_stiffness : float     of each with its raceways, N/m, > 0
    footprint : float          half the length of a ball's contact along the groove, m, > 0
    """

    thickness: float
    balls: tuple[float, ...]
    ball_stiffness: float
    footprint: float

    def __post_init__(self) -> None:
        """Refuse sizes that are not positive, and a ring without a loaded ball."""
        for name in ("thickness", "ball_stiffness", "footprint"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"ring.{name}", getattr(self, name), "> 0")
        if not self.balls:
            raise InputError("ring.balls", "none", "at least one loaded ball")


@dataclass(frozen=True)
class RingBody:
    """Outer ring in contact with the cam, supported by its balls.

    radius: outer radius, m; width of the contact, m, over which the ball stiffness is spread.
    """

    radius: float
    ring: BallRing
    width: float
    material: Elastic
    name: str = "roller"
    part: str = "ring of the roller"
    surface: str = "rim"
    held: str = ""
    free: tuple[str, ...] = ("hub",)

    @property
    def hub_radius(self) -> float:
        """Inner radius, m."""
        return self.radius - self.ring.thickness

    @property
    def _annulus(self) -> RollerBody:
        return RollerBody(self.radius, self.hub_radius, self.material)

    @property
    def far_size(self) -> float:
        return self.ring.thickness / EDGES_ACROSS_WALL

    def coarse_mesh(self) -> BodyMesh:
        return self._annulus.coarse_mesh()

    def contacts(self, contour: Contour, theta: Array) -> tuple[Array, Array]:
        """The top of the ring, for every cam angle: the balls keep their place to the contact."""
        return self._annulus.contacts(contour, theta)

    def mesh_at(self, contour: Contour, theta: float, sizing: ElementSize) -> BodyMesh:
        return self._annulus.mesh_at(contour, theta, sizing)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> Springs:
        """Balls as springs on the mesh of the ring at cam angle `theta`, rad, in the cam frame; in
        the ring's own frame where `contour` is None.
        """
        if contour is None:
            return ball_springs(mesh, np.zeros(2), 0.5 * np.pi, self.ring, self.width)
        normal = contour.normal(theta)
        centre = contour.points(theta) + self.radius * normal
        facing = float(np.arctan2(-normal[1], -normal[0]))
        return ball_springs(mesh, centre, facing, self.ring, self.width)


@lru_cache(maxsize=32)
def unit_bend(body: RingBody) -> float:
    """Change of the ring's outer curvature at the contact per line load, 1/m per N/m.

    Positive where the ring flattens; by the mesh of the cycle. Cached on disk.
    """
    return float(disk_cache.kept("bend", body, lambda: {"bend": _bend(body)}, RECIPE)["bend"])


def _bend(body: RingBody) -> Array:
    """Bend of the outer ring at a contact, 1/m per N/m, as an array; see
    `LoadedBody.correction`.
    """
    mesh = body.coarse_mesh()
    material = body.material
    elastic = ElasticBody(
        mesh, material.modulus, material.poisson, {}, body.springs(mesh, None, 0.0)
    )
    contact, normal = np.array([[0.0], [body.radius]]), np.array([[0.0], [1.0]])
    bend = LoadedBody(elastic, body.surface, body.free).correction(contact, normal).bend
    return np.asarray(bend[0])


def ball_springs(
    mesh: BodyMesh, centre: Array, facing: float, ring: BallRing, width: float
) -> Springs:
    """Balls as springs on the mean inner displacement over their footprints.

    Parameters
    ----------
    mesh : BodyMesh     of the ring, inner circle "hub"
    centre : (2,)       of the ring, m
    facing : float      direction from the centre to the contact, rad
    ring : BallRing
    width : float       of the contact, m

    Returns
    -------
    Springs   the balls, then two weak tangential ones against rigid motion of the ring
    """
    stiffness = ring.ball_stiffness / width
    nearest = min(ring.balls, key=lambda angle: abs(np.cos(0.5 * angle) - 1.0))
    ways = [
        _mean_way(mesh, centre, facing + angle, ring.footprint, inwards=True)
        for angle in ring.balls
    ]
    ways += [
        _mean_way(mesh, centre, facing + angle, ring.footprint, inwards=False)
        for angle in (nearest, nearest + 0.5 * FULL_TURN)
    ]
    weak = 2 * [_HOLD * stiffness]
    return Springs(np.stack(ways), np.array([stiffness] * len(ring.balls) + weak))


def _mean_way(mesh: BodyMesh, centre: Array, angle: float, half: float, inwards: bool) -> Array:
    """Weights (2, nodes) of the mean inward or tangential displacement of the inner circle over the
    footprint of a ball, under an elliptic pressure.

    By quadrature over the footprint, which is shorter than a facet.

    Parameters
    ----------
    centre : array (2,)   of the ring, m
    angle : float         direction from the centre to the ball, rad
    half : float          half the length of the footprint, m
    inwards : bool        displacement towards the centre; else counter-clockwise
    """
    facets = mesh.facet_triples("hub")
    arm = mesh.points[:, facets] - np.reshape(centre, (2, 1, 1))
    radius = float(np.hypot(*arm[:, 0]).mean())
    place = np.pi * np.arange(1, _QUADRATURE_POINTS + 1) / (_QUADRATURE_POINTS + 1)
    at = angle + half / radius * np.cos(place)
    share = 2.0 / (_QUADRATURE_POINTS + 1) * np.sin(place) ** 2
    bearing = np.arctan2(arm[1], arm[0])
    # Facets of a hole run clockwise.
    length = (bearing[0] - bearing[1]) % FULL_TURN
    behind = (bearing[0][:, None] - at) % FULL_TURN
    facet = np.argmin(behind / length[:, None], axis=0)
    s = behind[facet, np.arange(at.size)] / length[facet]
    shapes = np.stack([(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)]) * share
    way = np.stack([-np.cos(at), -np.sin(at)] if inwards else [-np.sin(at), np.cos(at)])
    weights = np.zeros_like(mesh.points)
    for component in range(2):
        np.add.at(weights[component], facets[:, facet], way[component] * shapes)
    return weights

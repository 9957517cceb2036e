"""The outer ring of a bearing as the body that touches the cam: an annulus on its balls.

The ring bends over lengths of its thickness, the contact is a tenth of that: so the ring comes in
as any body does, by what it adds to the half-plane. It is in plane strain like the contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.element_size import Sizing
from camwright.pipeline.contact.body_compliance import LoadedBody
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, Springs
from camwright.pipeline.contact.follower_body import EDGES_ACROSS_WALL, RollerBody

# Of a ball's stiffness, against the ring's turning on its balls, which no load asks for.
_HOLD = 1e-6
# Points over a ball's footprint; its pressure is an ellipse, so each weighs as its sine squared.
_POINTS = 32


@dataclass(frozen=True)
class BallRing:
    """An outer ring with the balls that carry it, seen from its contact.

    Parameters
    ----------
    thickness : float          under the groove, m, > 0
    balls : tuple of float     angles of the carrying balls from the contact, rad
    ball_stiffness : float     of each with its raceways, N/m, > 0
    footprint : float          half the length of a ball's contact along the groove, m, > 0
    """

    thickness: float
    balls: tuple[float, ...]
    ball_stiffness: float
    footprint: float

    def __post_init__(self) -> None:
        for name in ("thickness", "ball_stiffness", "footprint"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"ring.{name}", getattr(self, name), "> 0")
        if not self.balls:
            raise InputError("ring.balls", "none", "at least one that carries")


@dataclass(frozen=True)
class RingBody:
    """The ring in contact with the cam, on its balls alone.

    radius of its outside, m; width of the contact, m, over which the balls' stiffness is spread.
    """

    radius: float
    ring: BallRing
    width: float
    material: Elastic
    name: str = "roller"
    surface: str = "rim"
    held: str = ""
    free: tuple[str, ...] = ("hub",)

    @property
    def hub_radius(self) -> float:
        """Of the ring's inside, m."""
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
        """One place for all: the balls stand as they do, wherever on the cam it is."""
        return self._annulus.contacts(contour, theta)

    def mesh_at(self, contour: Contour, theta: float, sizing: Sizing) -> BodyMesh:
        return self._annulus.mesh_at(contour, theta, sizing)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> Springs:
        """The balls, under its mesh at a cam angle; without a contour under its own mesh."""
        if contour is None:
            return ball_springs(mesh, np.zeros(2), 0.5 * np.pi, self.ring, self.width)
        normal = contour.normal(theta)
        centre = contour.points(theta) + self.radius * normal
        facing = float(np.arctan2(-normal[1], -normal[0]))
        return ball_springs(mesh, centre, facing, self.ring, self.width)


@lru_cache(maxsize=32)
def unit_bend(body: RingBody) -> float:
    """Curvature that the ring's outside takes on at its contact, 1/m per N/m, from a push there.

    Positive where it flattens; found on the mesh of the cycle.
    """
    mesh = body.coarse_mesh()
    material = body.material
    elastic = ElasticBody(
        mesh, material.modulus, material.poisson, {}, body.springs(mesh, None, 0.0)
    )
    contact, normal = np.array([[0.0], [body.radius]]), np.array([[0.0], [1.0]])
    return float(LoadedBody(elastic, body.surface, body.free).correction(contact, normal).bend[0])


def ball_springs(
    mesh: BodyMesh, centre: Array, facing: float, ring: BallRing, width: float
) -> Springs:
    """The balls as springs on the ring's inside, pressed by its mean way over their footprints.

    Parameters
    ----------
    mesh : BodyMesh     the ring, its inside the circle "hub"
    centre : (2,)       of the ring, m
    facing : float      direction from the centre to the contact, rad
    ring : BallRing
    width : float       of the contact, m

    Returns
    -------
    Springs   the balls, then two weak ones along the inside against turning and drifting
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
    """Weights (2, nodes) of the mean way towards the centre, or along the circle, about an angle.

    The footprint is shorter than a facet, so the mean is taken at points of its own.
    """
    facets = mesh.facet_triples("hub")
    arm = mesh.points[:, facets] - np.reshape(centre, (2, 1, 1))
    radius = float(np.hypot(*arm[:, 0]).mean())
    place = np.pi * np.arange(1, _POINTS + 1) / (_POINTS + 1)
    at = angle + half / radius * np.cos(place)
    share = 2.0 / (_POINTS + 1) * np.sin(place) ** 2
    bearing = np.arctan2(arm[1], arm[0])
    # A hole's facets run clockwise.
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

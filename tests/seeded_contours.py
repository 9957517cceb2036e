"""Seeded cams with follower, bore and contact, of every family that a study may reach."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from synthesis_ratings import rated
from synthesis_scenarios import loaded_with

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.energy import lift_from_torque
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.contact.cam_body import Keyway
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody, RollerBody
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed
from camwright.pipeline.smoothing.synthesis_problem import Problem

FAMILIES = (
    "constrained", "smoothed", "lobes", "offset", "concave", "thin wall", "keyway", "flat face",
)  # fmt: skip
STEEL = Elastic(210e9, 0.3)
POINTS = 720


class Contact(NamedTuple):
    """A pair, a cam angle, rad, and a maximum Hertz pressure, Pa."""

    pair: ContactPair
    theta: float
    pressure: float

    @property
    def half_width(self) -> float:
        """Hertz half-width a = 2 p0 R / E*, m."""
        radius = float(self.pair.relative_radius(self.theta))
        return 2.0 * self.pressure * radius / self.pair.contact_modulus

    @property
    def force(self) -> float:
        """Normal force of that pressure, pi a p0 w / 2, N."""
        return 0.5 * np.pi * self.half_width * self.pressure * self.pair.width

    @property
    def slender(self) -> bool:
        """Whether a body is thinner than 20 half-widths: its bending adds to Hertz."""
        follower, pair = self.pair.follower, self.pair
        if isinstance(follower, RollerBody):
            walls = [follower.radius - follower.hub_radius]
        else:
            walls = [follower.width, follower.thickness]
        depth = 0.0 if pair.keyway is None else pair.keyway.depth
        walls.append(float(np.hypot(*pair.contour.points(self.theta))) - pair.bore_radius - depth)
        return self.half_width > 0.05 * min(walls)

    @property
    def varying(self) -> float:
        """Relative change of the curvature of the pair within the half-width, of even order.

        Hertz presumes none.
        """
        contour, theta = self.pair.contour, self.theta
        step = self.half_width / float(np.hypot(*contour.velocity(theta)))
        before, here, after = contour.curvature(theta + step * np.array([-1.0, 0.0, 1.0]))
        radius = float(self.pair.relative_radius(theta))
        odd, even = 0.5 * (after - before) * radius, (before + after - 2.0 * here) * radius
        return abs(even) + odd**2


def contact(family: str, seed: int) -> Contact:
    """Contact of a family: 12 to 120 mm of prime radius, 30 MPa to 2 GPa."""
    random = np.random.default_rng([FAMILIES.index(family), seed])
    base = float(np.exp(random.uniform(np.log(0.012), np.log(0.12))))
    if family in ("constrained", "smoothed"):
        base, lift = _from_torque(family, random)
    else:
        lift = _harmonics(random, base * random.uniform(0.02, 0.5))
    contour, follower = _contour(family, random, base, lift)
    least = float(contour.radius_min().value)
    wall = random.uniform(0.02, 0.1) if family == "thin wall" else random.uniform(0.3, 0.6)
    bore, keyway = least * (1.0 - wall), None
    if family == "keyway":
        bore = least * random.uniform(0.3, 0.7)
        keyway = Keyway(
            width=bore * random.uniform(0.2, 0.8),
            depth=(least - bore) * random.uniform(0.2, 0.9),
            angle=random.uniform(0.0, 2.0 * np.pi),
        )
    pair = ContactPair(contour, base * random.uniform(0.1, 0.5), bore, keyway, STEEL, follower)
    return Contact(pair, random.uniform(0.0, 2.0 * np.pi), 10 ** random.uniform(7.5, 9.3))


def _from_torque(family: str, random: np.random.Generator) -> tuple[float, Lift]:
    """Prime radius and lift that balance a random torque of zero mean."""
    rate, preload, base = random.uniform(15e3, 60e3), random.uniform(200.0, 900.0), 0.05
    points = 90 if family == "constrained" else POINTS
    theta, order = uniform_turn(points), np.arange(1, 9)
    size = random.uniform(2.0, 20.0, order.size) / order
    phase = random.uniform(0.0, 2.0 * np.pi, order.size)
    torque = (size[:, None] * np.cos(order[:, None] * theta + phase[:, None])).sum(axis=0)
    if family == "smoothed":
        # The period of the torque is one cam turn: the smoother's cycle.
        wanted = smoothed(torque, Smoother("gaussian", width=random.uniform(0.5, 4.0)))
        return base, lift_from_torque(theta, wanted, rate, preload)
    limits = rated(
        roller_radius=0.012, travel=0.045, pressure_angle=np.pi / 6, curvature_ratio=1.5,
        undercut_factor=0.3, contact_force_margin=0.2, normal_force=4000.0, overspeed=150.0,
    )  # fmt: skip
    load = loaded_with("one", 78.0, torque, 0.175, 0.08, 0.03, 0.15, 0.12)
    design = DesignVariables(rate, preload, base)
    problem = Problem((load,), limits, design, coefficients=24, points=points, jerk_weight=1e-7)
    return base, synthesise(problem).lift()


def _harmonics(random: np.random.Generator, rise: float) -> Lift:
    """Lift of one to six harmonics; every second one of equal lobes."""
    theta = uniform_turn(POINTS)
    lobes = random.random() < 0.4
    orders = [random.integers(2, 9)] if lobes else random.integers(1, 9, random.integers(1, 7))
    values: Array = np.zeros(POINTS)
    for order in orders:
        values += random.normal() / order**1.5 * np.cos(order * theta + random.uniform(0, 6.3))
    values -= values.min()
    return Lift(theta, rise * values / values.max())


def _contour(
    family: str, random: np.random.Generator, base: float, lift: Lift
) -> tuple[Contour, RollerBody | FaceBody]:
    if family == "flat face":
        theta = uniform_turn(POINTS)
        hollow = -float((lift(theta) + lift(theta, 2)).min())
        path = FacePath(lift, max(base, hollow + base * random.uniform(0.05, 0.5)))
        width = 2.4 * float(np.abs(lift(theta, 1)).max()) + 0.004
        # A slender block bends, and Hertz does not hold: thickness 0.6 to 1.2 of the width.
        thick, stem = width * random.uniform(0.6, 1.2), width * random.uniform(0.4, 0.9)
        return FlatFaceContour(path), FaceBody(width, thick, stem, STEEL)
    ratio = random.uniform(0.03, 0.12) if family == "concave" else random.uniform(0.1, 0.45)
    offset = base * random.uniform(-0.5, 0.5) if family == "offset" else 0.0
    roller = base * ratio
    hub = roller * random.uniform(0.2, 0.5)
    return RollerContour(PitchCurve(lift, base, offset), roller), RollerBody(roller, hub, STEEL)

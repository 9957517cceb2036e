"""Pin in a bush in three dimensions by finite elements: both elastic, with clearance and tilt.

The bush is held at its outside, as in a rigid housing; the pin is held at a core about its axis,
which is a line that moves and turns in the plane of the load. Half of both is solved. Neither the
slices nor the foundation of `pivot_bush` are used.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex1, ElementVector, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.elasticity.radial_compliance import SolidBar
from camwright.pipeline.follower.guide_reactions import Guide

_CORE = 0.15  # radius at which the pin is held over that of its surface
_BEYOND = np.array([0.06, 0.15, 0.3, 0.5])  # of the pin at either end, over the length of the bush
_WINDOW = np.radians(60.0)  # on either side, beyond any contact


class PressedPin(NamedTuple):
    """Tilt, rad; pressure (m, k), Pa, at angles (m,) and places (k,), m; line load (k,), N/m."""

    tilt: float
    pressure: Array
    angle: Array
    place: Array
    line: Array


class WholeBushByElements:
    """The same all around, for a force out of the plane of the couple.

    Every load is the sum of one that is alike on both sides of that plane and of one that is
    opposite: two solutions of one half.
    """

    def __init__(self, bush: Guide, pin: SolidBar, fine: float = 0.5) -> None:
        radius, length = 0.5 * bush.diameter, bush.length
        half = np.linspace(0.0, np.pi, round(60 * fine) + 1)
        along = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, round(26 * fine) + 1)))
        self.place, self.gap = length * (along - 0.5), 0.5 * bush.clearance
        nodes = np.array([(a, z) for a in half for z in self.place])
        beside = np.flatnonzero((nodes[:, 0] > 1e-9) & (nodes[:, 0] < np.pi - 1e-9))
        self.nodes = np.concatenate([nodes, nodes[beside] * [-1.0, 1.0]])
        alike = np.hstack([np.eye(len(nodes)), np.eye(len(nodes))[:, beside]])
        opposite = np.hstack([np.eye(len(nodes)), -np.eye(len(nodes))[:, beside]])
        opposite[np.setdiff1d(np.arange(len(nodes)), beside)] = 0.0
        outside = radius + bush.wall_share * bush.diameter
        walls = np.linspace(radius, outside, round(6 * fine) + 1)
        far = 0.5 * length + length * _BEYOND
        ends = np.r_[-far[::-1], self.place, far]
        rings = radius * np.geomspace(_CORE, 1.0, round(10 * fine) + 1)
        bodies = (
            (
                _ring(half, walls, self.place),
                (radius, outside),
                (bush.material.E, bush.material.nu),
            ),
            (_ring(half, rings, ends), (radius, rings[0]), (pin.modulus, pin.poisson)),
        )
        self.compliance = sum(
            0.5 * way.T @ _radial(*body, nodes, symmetric=symmetric) @ way
            for body in bodies
            for way, symmetric in ((alike, True), (opposite, False))
        )
        self.cell = radius * half[1] * np.tile(_shares(self.place), len(self.nodes) // along.size)

    def pressed(self, force: float, aside: float, couple: float) -> tuple[float, float]:
        """Greatest pressure, Pa, and tilt in the plane of the couple, rad, under a force in it and
        one across, N, and the couple, N m, by an active set.
        """
        angle, place = self.nodes.T
        ways = np.stack([np.cos(angle), np.sin(angle)])
        rigid = np.vstack([ways, place * ways]).T
        active, steps = np.cos(angle - np.arctan2(aside, force)) > 0.9, 8
        for step in range(1, steps + 1):  # of the couple, from the contact under the last one
            load = np.array([force, aside, step / steps * couple, 0.0])
            active, forces, motion = self._settled(active, rigid, load)
        return float((forces / self.cell).max()), float(motion[2])

    def _settled(
        self, active: NDArray[np.bool_], rigid: Array, load: Array
    ) -> tuple[NDArray[np.bool_], Array, Array]:
        """Contact, forces at the nodes and motion of the axis under a load."""
        for _ in range(100):
            on = np.flatnonzero(active)
            matrix = np.zeros((on.size + 4, on.size + 4))
            matrix[:-4, :-4] = self.compliance[np.ix_(on, on)]
            matrix[:-4, -4:], matrix[-4:, :-4] = -rigid[on], rigid[on].T
            solved = np.linalg.solve(matrix, np.r_[np.full(on.size, -self.gap), load])
            forces = np.zeros(active.size)
            forces[on] = solved[:-4]
            gap = self.gap - rigid @ solved[-4:] + self.compliance @ forces
            kept = np.where(active, forces >= 0.0, gap < -1e-12 * self.gap)
            if (kept == active).all():
                return active, forces, solved[-4:]
            active = kept
        raise AssertionError("the contact does not settle")


class BushByElements:
    """Compliance of a pin and its bush at the nodes of their contact; fine: elements per length."""

    def __init__(self, bush: Guide, pin: SolidBar, fine: float = 0.5) -> None:
        radius, length = 0.5 * bush.diameter, bush.length
        near = np.linspace(0.0, _WINDOW, round(20 * fine) + 1)
        between = np.linspace(_WINDOW, np.pi - _WINDOW, round(4 * fine) + 1)[1:-1]
        angles = np.r_[near, between, (np.pi - near)[::-1]]
        along = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, round(26 * fine) + 1)))
        self.place = length * (along - 0.5)  # dense at both ends
        self.angle = np.r_[near, (np.pi - near)[::-1]]
        self.gap = 0.5 * bush.clearance
        self.cell = radius * np.outer(
            np.r_[_shares(near), _shares(near)[::-1]], _shares(self.place)
        )
        self.nodes = np.array([(a, z) for a in self.angle for z in self.place])
        outside = radius + bush.wall_share * bush.diameter
        walls = np.linspace(radius, outside, round(6 * fine) + 1)
        far = 0.5 * length + length * _BEYOND
        whole = np.r_[-far[::-1], self.place, far]
        rings = radius * np.geomspace(_CORE, 1.0, round(10 * fine) + 1)
        card = bush.material
        self.compliance = _radial(
            _ring(angles, walls, self.place), (radius, outside), (card.E, card.nu), self.nodes
        ) + _radial(
            _ring(angles, rings, whole), (radius, rings[0]), (pin.modulus, pin.poisson), self.nodes
        )

    def pressed(self, force: float, couple: float) -> PressedPin:
        """Pin under a force, N, in the middle of the bush and a couple, N m, by an active set."""
        cosine, place = np.cos(self.nodes[:, 0]), self.nodes[:, 1]
        rigid_motion = np.stack([cosine, place * cosine], axis=1)
        active = cosine > 0.97
        for _ in range(200):
            on = np.flatnonzero(active)
            matrix = np.zeros((on.size + 2, on.size + 2))
            matrix[:-2, :-2] = self.compliance[np.ix_(on, on)]
            matrix[:-2, -2:], matrix[-2:, :-2] = -rigid_motion[on], rigid_motion[on].T
            load = np.r_[np.full(on.size, -self.gap), 0.5 * force, 0.5 * couple]
            *pushed, shift, tilt = np.linalg.solve(matrix, load)
            forces = np.zeros(active.size)
            forces[on] = pushed
            gap = self.gap - rigid_motion @ [shift, tilt] + self.compliance @ forces
            kept = np.where(active, forces >= 0.0, gap < -1e-12 * self.gap)
            if (kept == active).all():
                size = (self.angle.size, self.place.size)
                line = 2.0 * (forces * cosine).reshape(size).sum(axis=0) / _shares(self.place)
                pressure = forces.reshape(size) / self.cell
                return PressedPin(float(tilt), pressure, self.angle, self.place, line)
            active = kept
        raise AssertionError("the contact does not settle")


def _shares(places: Array) -> Array:
    """Length (n,) that belongs to each of the nodes of a line."""
    half = 0.5 * np.diff(places)
    return np.r_[half, 0.0] + np.r_[0.0, half]


def _ring(angles: Array, radii: Array, places: Array) -> MeshHex:
    """Hexahedra of a half ring about z."""
    flat = MeshHex.init_tensor(angles, radii, places)
    angle, radius, z = flat.p
    return MeshHex(np.stack([radius * np.cos(angle), radius * np.sin(angle), z]), flat.t)


def _radial(
    mesh: MeshHex,
    radii: tuple[float, float],
    card: tuple[float, float],
    nodes: Array,
    *,
    symmetric: bool = True,
) -> Array:
    """Yielding (n, n), m/N, of the surface at nodes (n, 2), angle and place, under radial forces
    there; radii: of the surface and where the body is held, m; card: E, Pa, and Poisson ratio.

    symmetric : bool   loads alike on both sides of the plane, or opposite ones
    """
    basis = Basis(mesh, ElementVector(ElementHex1()))
    stiffness = linear_elasticity(*lame_parameters(*card)).assemble(basis)
    x, y, z = mesh.p
    radius, size = np.hypot(x, y), max(radii)
    held = np.flatnonzero(np.abs(radius - radii[1]) < 1e-9 * size)
    plane = np.flatnonzero(np.abs(y) < 1e-9 * size)
    still = basis.nodal_dofs[[1] if symmetric else [0, 2]][:, plane]
    fixed = np.union1d(basis.nodal_dofs[:, held].ravel(), still.ravel())
    free = np.setdiff1d(np.arange(basis.N), fixed)
    surface = np.flatnonzero(np.abs(radius - radii[0]) < 1e-9 * size)
    far = np.abs(np.arctan2(y[surface], x[surface])[:, None] - nodes[:, 0])
    at = surface[np.argmin(far + np.abs(z[surface][:, None] - nodes[:, 1]) / size, axis=0)]
    pushes, columns = np.zeros((basis.N, len(nodes))), np.arange(len(nodes))
    for axis, part in enumerate((np.cos(nodes[:, 0]), np.sin(nodes[:, 0]))):
        pushes[basis.nodal_dofs[axis, at], columns] = part
    pushes = pushes[free]
    solved = splu(stiffness[free][:, free].tocsc()).solve(pushes)
    return np.asarray(pushes.T @ solved)

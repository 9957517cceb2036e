"""An outer ring on its balls as a closed chain of beam elements: independent of the product's.

The balls are springs that only push; there are no gaps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.follower.bearing_ring import Ring, RingBending

_ELEMENTS_PER_GAP = 24  # between two balls
_HOLD = 1e-6  # of the balls' stiffness, against turning on the balls, which costs nothing
_HOLD_SIDEWAYS = 1e-10  # of the balls' stiffness, while a single ball is thought to carry


def beam_ring_bending(ring: Ring, phases: int = 5) -> RingBending:
    """What `RingBending` holds, by Euler-Bernoulli beams."""
    count = 2 * (phases - 1) * -(-_ELEMENTS_PER_GAP // (2 * (phases - 1)))  # per gap
    nodes = ring.balls * count
    stiffness = ring_stiffness(ring, nodes)
    stiffness += _held(ring, nodes)
    found = [
        _pushed(ring, stiffness, count, k * count // (2 * (phases - 1))) for k in range(phases)
    ]
    gap = FULL_TURN / ring.balls
    phase = np.linspace(0.0, 0.5 * gap, phases)
    return RingBending(phase, *(np.array(part) for part in zip(*found, strict=True)))


def _pushed(
    ring: Ring, stiffness: Array, count: int, shift: int
) -> tuple[Array, float, float, float, float, float]:
    """What `RingBending` holds of one ball position; the push is at node 0, inwards."""
    nodes = len(stiffness) // 3
    at = (shift + count * np.arange(ring.balls)) % nodes
    load = np.zeros(3 * nodes)
    load[0] = -1.0
    carrying = np.cos(FULL_TURN * at / nodes) > 0.0
    seen: set[bytes] = set()
    while carrying.tobytes() not in seen:
        seen.add(carrying.tobytes())
        system = stiffness.copy()
        rows = 3 * at[carrying]
        system[rows, rows] += ring.ball_stiffness
        motion = cho_solve(cho_factor(system), load)
        squeezed = motion[3 * at] < 0.0
        if (squeezed == carrying).all():
            share = np.where(carrying, -ring.ball_stiffness * motion[3 * at], 0.0)
            moment, hoop = ring_section_forces(ring, motion)
            stress = ring.stress_inside(moment, hoop)
            most, least = float(stress.max()), float(stress.min())
            return share, float(moment.max()), float(moment.min()), most, least, float(-motion[0])
        carrying = squeezed
    raise AssertionError("the balls that carry were not found")


def _held(ring: Ring, nodes: int) -> Array:
    """Just enough stiffness against the ring's motions as a body to solve for them, (3n, 3n)."""
    angle = FULL_TURN / nodes * np.arange(nodes)
    bodily = np.zeros((3, 3 * nodes))
    bodily[0, 0::3], bodily[0, 1::3] = np.cos(angle), -np.sin(angle)
    bodily[1, 0::3], bodily[1, 1::3] = np.sin(angle), np.cos(angle)
    bodily[2, 1::3], bodily[2, 2::3] = 1.0, 1.0 / ring.radius
    share = ring.ball_stiffness * np.array([_HOLD_SIDEWAYS, _HOLD_SIDEWAYS, _HOLD]) / nodes
    return np.asarray((bodily.T * share) @ bodily)


def ring_stiffness(ring: Ring, nodes: int) -> Array:
    """Stiffness (3n, 3n) of the closed ring; at each node radial, tangential way and turning.

    Straight Euler-Bernoulli elements between the nodes, exact for end loads.
    """
    local, turn = _element(ring, nodes)
    block = turn.T @ local @ turn
    stiffness = np.zeros((3 * nodes, 3 * nodes))
    for k in range(nodes):
        dofs = _dofs(k, nodes)
        stiffness[np.ix_(dofs, dofs)] += block
    return stiffness


def ring_section_forces(ring: Ring, motion: Array) -> tuple[Array, Array]:
    """Bending moment, N m, positive where the inside is stretched, and pull, N, at the nodes."""
    nodes = len(motion) // 3
    local, turn = _element(ring, nodes)
    ends = np.array([local @ turn @ motion[_dofs(k, nodes)] for k in range(nodes)])
    return ends[:, 2], -ends[:, 0]


def _dofs(k: int, nodes: int) -> NDArray[np.intp]:
    after = (k + 1) % nodes
    return np.array([3 * k, 3 * k + 1, 3 * k + 2, 3 * after, 3 * after + 1, 3 * after + 2])


def _element(ring: Ring, nodes: int) -> tuple[Array, Array]:
    """Stiffness of one straight element along its axis, and its axes from those of the ring."""
    half = 0.5 * FULL_TURN / nodes
    length = 2.0 * ring.radius * np.sin(half)
    stretch = ring.modulus * ring.width * ring.thickness / length
    bend = ring.bending_stiffness / length**3
    local = np.zeros((6, 6))
    local[np.ix_([0, 3], [0, 3])] = stretch * np.array([[1.0, -1.0], [-1.0, 1.0]])
    L = length
    local[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = bend * np.array(
        [
            [12.0, 6.0 * L, -12.0, 6.0 * L],
            [6.0 * L, 4.0 * L**2, -6.0 * L, 2.0 * L**2],
            [-12.0, -6.0 * L, 12.0, -6.0 * L],
            [6.0 * L, 2.0 * L**2, -6.0 * L, 4.0 * L**2],
        ]
    )
    # Axial way is along the chord, the other one to its left, which points into the ring.
    turn = np.zeros((6, 6))
    for end, angle in ((0, half), (3, -half)):
        c, s = np.cos(angle), np.sin(angle)
        turn[end : end + 3, end : end + 3] = [[-s, c, 0.0], [-c, -s, 0.0], [0.0, 0.0, 1.0]]
    return local, turn

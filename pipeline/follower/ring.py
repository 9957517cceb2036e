"""Bending of a bearing's outer ring that rolls on a cam, carried by its balls alone.

The ring is a closed chain of beam elements in its plane, the balls are springs that only push,
the cam pushes at one place. No gaps: everything grows with the load, so one unit load tells all.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from geometry.arrays import FULL_TURN, Array, freeze
from geometry.errors import ContactError, InputError

_ELEMENTS_PER_GAP = 24  # between two balls
_HOLD = 1e-6  # of the balls' stiffness, against turning on the balls, which costs nothing
_HOLD_SIDEWAYS = 1e-10  # of the balls' stiffness, while a single ball is thought to carry


@dataclass(frozen=True)
class Ring:
    """A thin ring of rectangular section on equal balls.

    Parameters
    ----------
    radius : float            of the middle line, m, > 0
    thickness, width : float  m, > 0; the thickness below half the radius
    modulus : float           E, Pa, > 0
    balls : int               >= 3
    ball_stiffness : float    of each ball with its raceways, N/m, > 0
    """

    radius: float
    thickness: float
    width: float
    modulus: float
    balls: int
    ball_stiffness: float

    def __post_init__(self) -> None:
        for name in ("radius", "thickness", "width", "modulus", "ball_stiffness"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"ring.{name}", getattr(self, name), "> 0")
        if not self.thickness < 0.5 * self.radius:
            raise InputError("ring.thickness", self.thickness, "< half the radius, a thin ring")
        if self.balls < 3:
            raise InputError("ring.balls", self.balls, ">= 3")

    @property
    def section_modulus(self) -> float:
        """w t^2/6, m3."""
        return self.width * self.thickness**2 / 6.0

    @property
    def bending_stiffness(self) -> float:
        """E I, N m2."""
        return self.modulus * self.width * self.thickness**3 / 12.0


@dataclass(frozen=True, eq=False)
class RingBending:
    """Per newton of the cam's push, at ball positions `phase` (n,), rad, from the push.

    `ball_load` (n, balls) as shares of the push, >= 0; `moment_max`, `moment_min` (n,) in the
    ring, m, positive where the inside is stretched; `compliance` (n,) under the push, m/N.
    """

    phase: Array
    ball_load: Array
    moment_max: Array
    moment_min: Array
    compliance: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    def stress_range(self, ring: Ring, force: float) -> float:
        """From the greatest to the least bending stress a point of the groove meets, Pa.

        Each point of the ring passes under the push and midway between; the range is taken over
        all places and ball positions.
        """
        swing = float(self.moment_max.max() - self.moment_min.min())
        return swing * force / ring.section_modulus

    def greatest_ball_load(self, force: float) -> float:
        """N."""
        return float(self.ball_load.max()) * force


@lru_cache(maxsize=16)
def ring_bending(ring: Ring, phases: int = 5) -> RingBending:
    """Ring under a unit push at ball positions from right below it to midway between two.

    Raises
    ------
    ContactError
        If the balls that carry cannot be found.

    References
    ----------
    Timoshenko, Strength of Materials II: thin rings; Harris and Kotzalas, Advanced Concepts of
    Bearing Technology (2007): flexibly supported outer rings.
    """
    count = 2 * (phases - 1) * -(-_ELEMENTS_PER_GAP // (2 * (phases - 1)))  # per gap
    nodes = ring.balls * count
    stiffness = ring_stiffness(ring, nodes)
    stiffness += _held(ring, nodes)
    found = [
        _pushed(ring, stiffness, count, k * count // (2 * (phases - 1))) for k in range(phases)
    ]
    loads, most, least, soft = (np.array(part) for part in zip(*found, strict=True))
    gap = FULL_TURN / ring.balls
    return RingBending(np.linspace(0.0, 0.5 * gap, phases), loads, most, least, soft)


def flattening(ring: Ring, bending: RingBending, force: Array, curvature: Array) -> Array:
    """Share by which the ring's bending changes a line contact's greatest pressure, (n,), <= 0.

    Under the push the ring loses the curvature M/(E I), taken at the ball position that bends it
    most; p0 goes with the root of the relative curvature, the half-width with its reciprocal.
    The dent of the contact itself is left to Hertz, whose p0 for the round ring is thus an upper
    bound.

    Parameters
    ----------
    force : array (n,)       N, >= 0
    curvature : array (n,)   of the contact with the round ring, 1/R, 1/m, > 0

    References
    ----------
    Timoshenko, Strength of Materials II: thin rings; Johnson (1985), sec. 4.2(c).
    """
    lost = bending.moment_max.max() * force / ring.bending_stiffness
    return np.asarray(np.sqrt(np.maximum(1.0 - lost / curvature, 0.0)) - 1.0)


def _pushed(
    ring: Ring, stiffness: Array, count: int, shift: int
) -> tuple[Array, float, float, float]:
    """Ball loads, greatest and least moment, compliance; the push is at node 0, inwards."""
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
            moment = ring_moments(ring, motion)
            return share, float(moment.max()), float(moment.min()), float(-motion[0])
        carrying = squeezed
    raise ContactError("ring: the balls that carry were not found")


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


def ring_moments(ring: Ring, motion: Array) -> Array:
    """Bending moment (n,) at the nodes, N m, positive where the inside is stretched."""
    nodes = len(motion) // 3
    local, turn = _element(ring, nodes)
    ends = np.array([(local @ turn @ motion[_dofs(k, nodes)])[2] for k in range(nodes)])
    return np.asarray(ends)


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


def ball_stiffness(force: float, diameter: float, modulus: float, poisson: float) -> float:
    """Of a ball between two raceways under a force, secant, N/m; an estimate.

    Each contact as that of a ball on a flat, d = (9 F^2/(16 E*^2 R))^(1/3), stiffened by the
    grooves' osculation by the usual 1.3 (recalled, verify); the ring's bending hardly asks.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 4.2(a); Harris and Kotzalas (2007), ch. 6.
    """
    for name, value in (("force", force), ("diameter", diameter), ("modulus", modulus)):
        if not 0.0 < value < np.inf:
            raise InputError(f"ball.{name}", value, "> 0")
    contact = modulus / (2.0 * (1.0 - poisson**2))
    way = (9.0 * force**2 / (16.0 * contact**2 * 0.5 * diameter)) ** (1.0 / 3.0)
    return 1.3 * force / (2.0 * way)


def pin_bending_stress(
    force: float, diameter: float, width: float, span: float, overhung: bool = False
) -> float:
    """Greatest bending stress of the roller's pin, Pa, the load spread over the bearing's width.

    Parameters
    ----------
    force : float      N, >= 0
    diameter : float   of the pin, m, > 0
    width : float      of the bearing, m, > 0
    span : float       between the supports' middles (straddled) or from the support's face to
                       the middle of the bearing (overhung), m, > 0
    overhung : bool

    Raises
    ------
    InputError
        If a value is out of these bounds, or a straddling support lies inside the bearing.
    """
    for name, value in (("diameter", diameter), ("width", width), ("span", span)):
        if not 0.0 < value < np.inf:
            raise InputError(f"roller.pin_{name}", value, "> 0 m")
    if not 0.0 <= force < np.inf:
        raise InputError("roller.force", force, ">= 0 N")
    if not overhung and span < width:
        raise InputError("roller.pin_span", span, f">= {width:g} m, the width of the bearing")
    moment = force * span if overhung else force * (span / 4.0 - width / 8.0)
    return 32.0 * moment / (np.pi * diameter**3)

"""Springs for a design as arrays: catalogue springs, and wound ones of standard wires."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.cards.spring_catalogue import SpringDemand, SpringRoom
from camwright.pipeline.follower.spring import HelicalSpring, Spring
from camwright.pipeline.follower.wound_wire import Number, WoundWire

WIRES = (1.0, 1.25, 1.6, 2.0, 2.5, 3.0, 3.6, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 8.0, 8.5, 9.0,
         10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0)  # fmt: skip
"""Wire diameters of EN 10270-2, mm."""
INDEXES = (3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0, 8.0)
COILS = (2.0, 14.0)
ROOM = SpringRoom(
    greatest=1.08,
    least=1.0 / (1.0 + Spring.preload_tolerance),
    strength=0.88,
    surge=1.05,
)
"""Room of a design within the limits of its spring: the search that follows changes preload and
travel, and solves the surge. The least force is that of the nominal preload."""
LOOSE_GAPS, LOOSE_SOLID = 1.15, 1.3
"""Free length of a wound spring: gaps and clearance to solid over their limits."""


@dataclass(frozen=True)
class SpringPoint:
    """Spring in operation: winding, preload, N, greatest lift, m."""

    spring: HelicalSpring
    preload: float
    travel: float

    @property
    def greatest(self) -> float:
        """Force at the greatest lift, N."""
        return self.preload + self.spring.rate * self.travel

    @property
    def energy(self) -> float:
        """Energy stored up to the greatest lift, J."""
        return (self.preload + 0.5 * self.spring.rate * self.travel) * self.travel


def wound(
    wire: HelicalSpring,
    rate: Array,
    preload: Array,
    travel: Array,
    cam_speed: float,
) -> list[SpringPoint]:
    """Lightest wound spring within its limits for each rate, preload and travel.

    Those without one are left out. Rates are rounded with the number of coils.

    Parameters
    ----------
    wire : HelicalSpring        its wire, treatment, temperature and relaxation are used
    rate, preload, travel : array (m,)   N/m, N, m
    cam_speed : float           at the over-speed, rad/s
    """
    if not rate.size:
        return []
    d = 1e-3 * np.array(WIRES)[:, None]
    D = 5e-4 * np.round(d * np.array(INDEXES) / 5e-4)
    k, P, h = (each[:, None, None] for each in (rate, preload, travel))
    n = np.round(20.0 * wire.shear_modulus * d**4 / (8.0 * D**3 * k)) / 20.0
    fits = (n >= COILS[0]) & (n <= COILS[1])
    n = np.clip(n, *COILS)
    shape = n.shape
    springs = WoundWire(
        wire_diameter=np.broadcast_to(d, shape),
        mean_diameter=np.broadcast_to(D, shape),
        coils=n,
        free_length=np.full(shape, 1.0),
        end_factor=np.full(shape, wire.end_factor),
        shear_modulus=np.full(shape, wire.shear_modulus),
        elastic_modulus=None,
        density=np.full(shape, wire.density),
        strength_at_1mm=np.full(shape, wire.strength_at_1mm),
        strength_exponent=np.full(shape, wire.strength_exponent),
        treatment=wire.treatment,
        temperature=wire.temperature,
        relaxation=None,
    )
    demand = _demand(springs.rate, P, h, cam_speed)
    work = demand.work(springs)
    deflection = springs.deflection(work.preload) + h
    clear = np.maximum(
        LOOSE_GAPS * springs.minimum_gaps, LOOSE_SOLID * demand.solid_clearance * deflection
    )
    length = 1e-3 * np.ceil(1e3 * (springs.solid_length + deflection + clear))
    springs = replace(springs, free_length=length)
    for kept in demand.kept(springs).values():
        fits &= kept
    mass = np.where(fits, springs.mass, np.inf).reshape(shape[0], -1)
    best = mass.argmin(axis=1)
    points = []
    for row, at in enumerate(best):
        if not np.isfinite(mass[row, at]):
            continue
        place = (row, *np.unravel_index(at, shape[1:]))
        own = replace(
            wire,
            wire_diameter=float(springs.wire_diameter[place]),
            mean_diameter=float(springs.mean_diameter[place]),
            coils=float(n[place]),
            free_length=float(length[place]),
        )
        points.append(SpringPoint(own, float(preload[row]), float(travel[row])))
    return points


def _demand(rate: Number, preload: Number, travel: Number, speed: float) -> SpringDemand[Number]:
    """Demand on a spring of a rate, N/m, preload, N, and travel, m, at a cam speed, rad/s."""
    return SpringDemand(rate, preload, travel, cam_speed=speed, room=ROOM)


def of_catalogue(
    springs: Sequence[HelicalSpring],
    energies: Sequence[float],
    travels: Sequence[float],
    cam_speed: float,
) -> list[SpringPoint]:
    """Catalogue springs that store an energy over a travel, each with the preload at which it does;
    those that would exceed a limit, or have too little preload, are left out.

    Parameters
    ----------
    springs : sequence             of the catalogue
    energies, travels : sequence   J; m: every pair of both is tried
    cam_speed : float              rad/s, for the surge
    """
    points = []
    for spring in springs:
        for energy in energies:
            for travel in travels:
                preload = energy / travel - 0.5 * spring.rate * travel
                if preload < 0.1 * spring.rate * travel:
                    continue
                if not _demand(spring.rate, preload, travel, cam_speed).shortfalls(spring):
                    points.append(SpringPoint(spring, preload, travel))
    return points

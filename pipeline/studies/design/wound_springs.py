"""Springs of a design: those of a catalogue, and wound ones of standard wires, as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.case_values import WoundSprings
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SURGE
from camwright.pipeline.follower.spring import HelicalSpring

WIRES = (1.0, 1.25, 1.6, 2.0, 2.5, 3.0, 3.6, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 8.0, 8.5, 9.0,
         10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0)  # fmt: skip
"""Wire diameters of EN 10270-2, mm."""
INDEXES = (3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0, 8.0)
COILS = (2.0, 14.0)
_TOLERANCE = 1.05  # of rate and preload
_SURGE_FORCE = 1.08  # of the greatest force, by the surge
_USED = 0.88  # of strength, fatigue and solid stress
_SURGE = 1.05  # over the limit of the surge frequency
_GAPS = 1.15  # over the least gaps between the coils
_SOLID = 0.13  # clearance to solid over the greatest deflection


@dataclass(frozen=True)
class SpringPoint:
    """A spring at work: its winding, preload, N, and greatest lift, m."""

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
    """The lightest wound spring of each rate, preload and travel that meets its limits.

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
    springs = WoundSprings(
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
    deflection = _TOLERANCE * P / springs.rate + h
    clear = np.maximum(_GAPS * springs.minimum_gaps, _SOLID * deflection)
    length = 1e-3 * np.ceil(1e3 * (springs.solid_length + deflection + clear))
    springs = replace(springs, free_length=length)
    fits &= _holds(springs, P, h, cam_speed)
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


def _holds(springs: WoundSprings, P: Array, h: Array, cam_speed: float) -> Array:
    """Whether springs hold a preload and travel: strength, fatigue, solid, buckling, surge."""
    greatest = _SURGE_FORCE * _TOLERANCE * (P + springs.rate * h)
    strength = springs.static_strength
    holds = springs.stress(greatest) <= _USED * strength
    holds &= springs.fatigue_use(P, greatest) <= _USED / SPRING_FATIGUE.default
    holds &= springs.solid_stress(_TOLERANCE * springs.rate) <= strength
    holds &= springs.buckling_deflection >= _TOLERANCE * P / springs.rate + h
    slowest = _SURGE * SPRING_SURGE.default * cam_speed / (2.0 * np.pi)
    return np.asarray(holds & (springs.surge_frequency >= slowest))


def of_catalogue(
    springs: Sequence[HelicalSpring],
    energies: Sequence[float],
    travels: Sequence[float],
    cam_speed: float,
) -> list[SpringPoint]:
    """Springs of a catalogue with the preload at which they store an energy, J, over a travel, m.

    Those that do not hold it are left out.
    """
    points = []
    for spring in springs:
        for energy in energies:
            for travel in travels:
                preload = energy / travel - 0.5 * spring.rate * travel
                if preload < 0.1 * spring.rate * travel:
                    continue
                if _holds_one(spring, preload, travel, cam_speed):
                    points.append(SpringPoint(spring, preload, travel))
    return points


def _holds_one(spring: HelicalSpring, preload: float, travel: float, cam_speed: float) -> bool:
    greatest = _SURGE_FORCE * _TOLERANCE * (preload + spring.rate * travel)
    deflection = _TOLERANCE * preload / spring.rate + travel
    return bool(
        spring.static_use(greatest) <= _USED
        and spring.fatigue_safety(preload, greatest) >= SPRING_FATIGUE.default / _USED
        and spring.gap_left(_TOLERANCE * preload, travel) >= spring.minimum_gaps
        and spring.solid_clearance(_TOLERANCE * preload, travel) >= 0.1
        and spring.solid_stress(_TOLERANCE * spring.rate) <= spring.static_strength
        and deflection <= spring.buckling_deflection
        and spring.surge_frequency >= SPRING_SURGE.default * cam_speed / (2.0 * np.pi)
    )

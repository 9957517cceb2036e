"""Unbalance of the cam, its counter-hole, and the centrifugal force on the shaft."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.form_closure import Groove
from camwright.geometry.second_track import discs_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.cycle.pressed_discs import pressed_discs
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    CounterHole,
    SecondDisc,
    ShaftLoads,
    Unbalance,
    counter_hole,
    greatest_hole,
    less_bore,
    rotating_force,
    shaft_loads,
    unbalance,
)
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.records.trial_contents import BalanceRecord

WALL = 3e-3
"""Wall around a proposed hole, which no case states, m."""
_GRAM_MILLIMETRE = 1e-6  # kg m


@dataclass(frozen=True, eq=False)
class Balance:
    """Unbalance of a cam, and its counter-hole.

    hole balances the cam, or reduces the unbalance as far as it can where `missed` states why none
    balances it; None where none fits or none is necessary. density is per area, kg/m2.
    """

    unbalance: Unbalance
    hole: CounterHole | None
    missed: str
    drilled: bool
    density: float

    @property
    def left(self) -> Unbalance:
        """Residual unbalance with the counter-hole; without one the full unbalance."""
        if self.hole is None:
            return self.unbalance
        area = np.pi * self.hole.radius**2
        moment: Array = self.unbalance.moment - area * self.hole.centre
        mass = self.unbalance.mass - self.density * area
        product = self.density * float(np.hypot(*moment))
        return Unbalance(self.unbalance.area - area, moment, mass, product)

    @property
    def as_made(self) -> Unbalance:
        """Unbalance of the cam as manufactured."""
        return self.left if self.drilled else self.unbalance

    def record(self) -> BalanceRecord:
        """Record in ``trial.json``."""
        hole = self.hole
        return {
            "mass_g": 1e3 * self.unbalance.mass,
            "unbalance_g_mm": self.unbalance.product / _GRAM_MILLIMETRE,
            "unbalance_angle_deg": float(np.degrees(self.unbalance.angle) % 360.0),
            "residual_unbalance_g_mm": self.left.product / _GRAM_MILLIMETRE,
            "hole_diameter_mm": None if hole is None else 2e3 * hole.radius,
            "hole_x_mm": None if hole is None else 1e3 * float(hole.centre[0]),
            "hole_y_mm": None if hole is None else 1e3 * float(hole.centre[1]),
            "hole_drilled": self.drilled and hole is not None,
            "hole_note": self.missed,
        }


def balance(cam: CamBody, contour: Contour) -> Balance:
    """Unbalance of the cam with bore and keyway, and the counter-hole that removes it or as much of
    it as it can.
    """
    unbalance, order = undrilled(cam, contour), cam.counter_hole
    wall = WALL if order is None else order.wall
    depth = 0.0 if cam.keyway is None else cam.keyway.depth
    hole, missed = None, ""
    for search in (counter_hole,) if unbalance.balanced else (counter_hole, greatest_hole):
        try:
            hole = search(contour, unbalance, cam.bore_radius, wall, depth)
            break
        except GeometryError as error:
            missed = str(error)
    return Balance(unbalance, hole, missed, order is not None, cam.material.density * cam.width)


def undrilled(cam: CamBody, contour: Contour) -> Unbalance:
    """Unbalance and mass of the cam with bore and keyway, of both discs of a conjugate pair in one
    plane, without a counter-hole.
    """
    density = cam.material.density
    if cam.groove is None:
        first, *others = _each_disc(cam, contour)
        return sum(others, first)
    track = contour.require_roller()
    left, moment = np.pi * cam.groove.outer_radius**2, np.zeros(2)
    for step in cam.groove.steps(track.roller_radius):
        area, aside = step.section(track.pitch)
        share = step.depth / cam.width
        left, moment = left - share * area, moment - share * aside
    return less_bore(left, moment, cam.bore_radius, cam.keyway, cam.width, density)


@lru_cache(maxsize=8)
def _each_disc(cam: CamBody, contour: Contour) -> tuple[Unbalance, ...]:
    """Unbalance of each disc of a cam with bore and keyway."""
    stated = cam.bore_radius, cam.keyway, cam.width, cam.material.density
    return tuple(unbalance(each.contour, *stated) for each in discs_of(contour, cam.second))


def groove_of(cam: CamBody, contour: Contour) -> Groove:
    """Groove of a cam around the path of its roller, of two that on the outer wall.

    Raises
    ------
    InputError
        If the cam has none.
    """
    if cam.groove is None:
        raise InputError("cam.groove", "missing", "given for its checks")
    track = contour.require_roller()
    second = cam.groove.second
    radius = track.roller_radius if second is None else second.radius
    return Groove(track.pitch, radius, cam.groove.clearance)


def design_mass(case: Case, contour: Contour) -> float:
    """Mass of cam, follower and half of the spring, kg."""
    spring = case.spring.design
    bodies = undrilled(case.cam, contour).mass + case.follower.mass
    return float(bodies + (0.0 if spring is None else 0.5 * spring.mass))


def camshaft_loads(
    loads: Loads, shaft: Camshaft, cam: CamBody, contour: Contour, cam_speed: float
) -> ShaftLoads:
    """Forces on the camshaft and its bearings over a turn, with the centrifugal forces of cam and
    counterweight; cam_speed : rad/s.

    Each disc of a pair presses the bearings from its own place, of preloaded ones both at once.
    """
    manufactured, weight = _as_made(cam, contour), shaft.counterweight
    thrown = rotating_force(manufactured.product, manufactured.angle, cam_speed, loads.theta)
    held, pressed, second = np.zeros_like(thrown), np.array(loads.on_shaft), None
    if weight is not None:
        held = rotating_force(*weight.set_against(manufactured), cam_speed, loads.theta)
    if cam.conjugate is not None:
        disc, alone = pressed_discs(contour, loads)[1], _each_disc(cam, contour)[1]
        push = disc.force * _seen(disc.contour.normal(disc.theta), loads.theta)
        there = rotating_force(alone.product, alone.angle, cam_speed, loads.theta)
        pressed, thrown = pressed - push, thrown - there
        second = SecondDisc(cam.conjugate.spacing, there - push, disc.torque)
    along, across = pressed
    return shaft_loads(along, across, loads.cam_torque, shaft, thrown, held, second)


def _seen(vector: Array, theta: Array) -> Array:
    """Vector (2, n) of the cam frame at cam angles (n,), rad, in the frame of `ShaftLoads`."""
    (x, y), cos, sin = vector, np.cos(theta), np.sin(theta)
    return np.stack([x * cos + y * sin, x * sin - y * cos])


def rotor_unbalance(cam: CamBody, contour: Contour, shaft: Camshaft | None) -> float:
    """Unbalance of cam and counterweight together, kg m: magnitude of their vector sum; of two
    discs the sum of those at both bearings, with their couple.

    References
    ----------
    ISO 21940-11, tolerance planes at the bearings; one resultant between them has the same sum.
    """
    weight, cam_alone = None if shaft is None else shaft.counterweight, _as_made(cam, contour)
    total = cam_alone.product * np.exp(1j * cam_alone.angle)
    against = 0.0j
    if weight is not None:
        product, direction = weight.set_against(cam_alone)
        against = product * np.exp(1j * direction)
        total += against
    if shaft is None or cam.spacing is None:
        return float(abs(total))
    first, second = (each.product * np.exp(1j * each.angle) for each in _each_disc(cam, contour))
    moment = first * shaft.cam_position + second * (shaft.cam_position + cam.spacing)
    if weight is not None:
        moment += against * weight.position
    at_second = moment / shaft.bearing_spacing
    return float(abs(total - at_second) + abs(at_second))


@lru_cache(maxsize=8)
def _as_made(cam: CamBody, contour: Contour) -> Unbalance:
    """Unbalance of the cam as manufactured; each load case and check of the shaft reads it."""
    return undrilled(cam, contour) if cam.counter_hole is None else balance(cam, contour).as_made


def drilled_hole(cam: CamBody, contour: Contour) -> CounterHole | None:
    """Counter-hole to drill; None where the case requests none, or none fits."""
    return None if cam.counter_hole is None else balance(cam, contour).hole

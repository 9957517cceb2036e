"""Arm of an oscillating follower as a beam: sections, moments, stresses, compliance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value, distinct
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.follower_kind import FollowerKind
from camwright.pipeline.follower.pin_strength import support_force
from camwright.pipeline.follower.roller_parts import Fork, Pin
from camwright.pipeline.follower.shaft_strength import equivalent_stress
from camwright.pipeline.follower.spring_link import SpringLink

_ODD = np.arange(1.0, 80.0, 2.0)  # terms of the series of a twisted rectangle
_EQUAL_AREA = 0.808  # diameter of a round section over the root of a rectangle's area


def torsion_of_rectangle(width: Value, depth: Value) -> tuple[Value, Value]:
    """Torsion constant, m4, and section modulus of torsion, m3, of a rectangular bar (...).

    Parameters
    ----------
    width, depth : float or array (...)   sides of the rectangle, m, in any order

    References
    ----------
    Timoshenko and Goodier, Theory of Elasticity, sec. 109: series of the rectangular bar.
    """
    short, long = np.minimum(width, depth), np.maximum(width, depth)
    half = 0.5 * np.pi * _ODD * np.asarray(long / short)[..., None]
    decay = np.exp(-half)  # cosh overflows on a thin strip
    over_sides = np.sum(np.tanh(half) / _ODD**5, axis=-1)
    constant = 1.0 - 192.0 / np.pi**5 * short / long * over_sides
    in_middle = np.sum(2.0 * decay / (1.0 + decay**2) / _ODD**2, axis=-1)
    greatest = 1.0 - 8.0 / np.pi**2 * in_middle
    twist = long * short**3 / 3.0 * constant
    return twist, twist / (short * greatest)


class SectionLoads(NamedTuple):
    """Loads of a section of the arm (...): moments, N m, and force along the arm, N.

    bending: in the plane of the cam; sideways: across it; twisting: about the arm; along: > 0 in
    tension.
    """

    bending: Array
    along: Array
    sideways: Array
    twisting: Array


class ArmSection(NamedTuple):
    """Rectangular section of the arm with a hole through the middle of its depth.

    distance: from the pivot, m; width: along the cam axis, m; hole: diameter, m, 0 without one;
    notch: fatigue notch factor; cheeks: of a fork, 0 of the arm itself; eye: under the pin of the
    roller.
    """

    name: str
    distance: Value
    width: Value
    depth: Value
    notch: Value
    hole: Value = 0.0
    cheeks: int = 0
    eye: bool = False

    @property
    def area(self) -> Value:
        """m2."""
        return self.width * (self.depth - self.hole)

    @property
    def modulus(self) -> Value:
        """Section modulus in the plane of the cam, m3."""
        return self.width * (self.depth**3 - self.hole**3) / (6.0 * self.depth)

    @property
    def side_modulus(self) -> Value:
        """Section modulus across the plane of the cam, m3."""
        return self.area * self.width / 6.0

    @property
    def torsion_modulus(self) -> Value:
        """m3; beside a hole of the two bars that it leaves."""
        bars = np.where(np.asarray(self.hole) > 0.0, 2.0, 1.0)
        return bars * torsion_of_rectangle(self.width, (self.depth - self.hole) / bars)[1]

    @property
    def diameter(self) -> Value:
        """Diameter of the round section of equal fatigue strength, m.

        References
        ----------
        Shigley's Mechanical Engineering Design, 10th ed., eq. 6-25: not rotating (recalled,
        verify).
        """
        return _EQUAL_AREA * np.sqrt(self.area)

    def normal(self, loads: SectionLoads) -> Array:
        """Normal stress at the four corners of the section (4, ...), Pa, of bending in both planes
        and the force along the arm, times the fatigue notch factor.

        Parameters
        ----------
        loads : SectionLoads   of the section (...)
        """
        bent, aside = loads.bending / self.modulus, loads.sideways / self.side_modulus
        pulled = loads.along / self.area
        signs = ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0))
        return np.stack([self.notch * (pulled + a * bent + b * aside) for a, b in signs])

    def shear(self, loads: SectionLoads) -> Array:
        """Shear stress (...) of torsion, Pa, with the notch factor."""
        return np.asarray(self.notch * loads.twisting / self.torsion_modulus)

    def amplitude_and_mean(self, loads: SectionLoads) -> tuple[Array, Array]:
        """Von Mises amplitude and mean stress at the four corners of the section, (4, ..., 1) each,
        Pa, from the ranges of normal and shear stress over a turn.

        Parameters
        ----------
        loads : SectionLoads   of the section over the turn (..., n)
        """
        normal, shear = self.normal(loads), self.shear(loads)
        ends = (np.max(each, axis=-1, keepdims=True) for each in (normal, -normal, shear, -shear))
        high, low, most, least = ends
        return _in_range(high, -low, most, -least)

    def range_to(self, loads: SectionLoads) -> tuple[Array, Array]:
        """Von Mises amplitude and mean stress at the four corners, (4, n) each, Pa, were the loads
        of a cam angle the greatest of the turn.

        From the range of normal and shear stress between that angle and the least of the turn, in
        the sense of the greater extreme.

        Parameters
        ----------
        loads : SectionLoads   of the section over the turn (n,)
        """
        normal, shear = (_upward(each) for each in (self.normal(loads), self.shear(loads)))
        return _in_range(normal, normal.min(axis=-1, keepdims=True), shear, shear.min())

    def greatest(self, loads: SectionLoads) -> Array:
        """Greatest von Mises stress (...) of its corners, Pa; complex for a step."""
        normal = (
            magnitude(loads.bending) / self.modulus
            + magnitude(loads.along) / self.area
            + magnitude(loads.sideways) / self.side_modulus
        )
        return equivalent_stress(self.notch * normal, self.shear(loads))


def _in_range(high: Array, low: Array, most: Array, least: Array) -> tuple[Array, Array]:
    """Von Mises amplitude and mean, Pa, of a normal stress from low to high and a shear from least
    to most.
    """
    return (
        equivalent_stress(0.5 * (high - low), 0.5 * (most - least)),
        equivalent_stress(0.5 * (high + low), 0.5 * (most + least)),
    )


def _upward(stress: Array) -> Array:
    """Stress (..., n) with the sign that makes its extreme of greater size over n positive."""
    size = stress.max(axis=-1) >= -stress.min(axis=-1)
    return np.where(size, 1.0, -1.0)[..., None] * stress


class ArmForces(NamedTuple):
    """Forces on the arm (...), N.

    across, closing, inertia: moments about the pivot over the length of the arm, of the contact, of
    spring, weight and machine, and of the mass, of both arms of conjugate discs together, the two
    latter without what acts on the second arm of a rocker; pressed, along: of the contact across
    and along the arm where it acts, along > 0 in tension; normal: of the contact; away: of the
    contact force from the middle of the roller along the cam axis, m, >= 0.
    """

    across: Array
    pressed: Array
    along: Array
    normal: Array
    closing: Array
    inertia: Array
    away: Array


def _or(stated: Value | None, default: Value) -> Value:
    return default if stated is None else stated


@dataclass(frozen=True)
class ArmBar:
    """Straight bar on a pivot, which the contact bends at its end.

    Parameters
    ----------
    arm : FollowerArm    with its width, depth, material and notch factors
    held : float         distance from the pivot at which the spring acts, m
    end_share : float    of roller, pin and fork in the whole moment of inertia about the pivot
    bar_share : float    of the arm as a uniform bar in it
    pin, fork : or None  of the roller; None: not described, or a face
    holds_pin : bool     of a roller
    """

    length: Value
    width: Value
    depth: Value
    material: Material
    arm: FollowerArm
    held: Value
    end_share: Value
    bar_share: Value
    pin: Pin | None = None
    fork: Fork | None = None
    holds_pin: bool = True

    @classmethod
    def each(
        cls,
        arm: FollowerArm | None,
        end: FollowerKind,
        mass: Value,
        link: SpringLink | None,
        second: tuple[Value, FollowerKind] | None = None,
    ) -> tuple[ArmBar, ...]:
        """Bar of an arm of a follower with the roller or face `end`, and of the second arm of
        conjugate discs; () of a stem, and of an arm without section or material.

        The second is like the first but for its length and roller, and no spring acts on it. Each
        swings the mass at its own end, the rest of the moment of inertia is that of both bars.

        Parameters
        ----------
        end : FollowerKind   roller or face on the arm
        mass : float         that moves with it, kg
        link : SpringLink    None: of another spring
        second : tuple       length, m, and roller of a second arm; None: without one
        """
        if arm is None or arm.width is None or arm.depth is None or arm.material is None:
            return ()
        pin, fork = end.parts.get("pin"), end.parts.get("fork")
        arms: list[tuple[Value, FollowerKind, Value]] = [(arm.length, end, arm.held(link))]
        if second is not None:
            arms.append((*second, 0.0))
        ratios = [length / arm.length for length, *_ in arms]
        swung = [
            ratio**2 * sum(part for part in each.moving.masses.values() if part is not None)
            for ratio, (_, each, _) in zip(ratios, arms, strict=True)
        ]
        most, cube = np.maximum(mass, sum(swung)), sum(ratio**3 for ratio in ratios)
        return tuple(
            cls(
                *(length, arm.width, arm.depth, arm.material, arm, held),
                at_end / most,
                (1.0 - sum(swung) / most) * ratio**3 / cube,
                pin if isinstance(pin, Pin) else None,
                fork if isinstance(fork, Fork) else None,
                "pin" in end.parts,
            )
            for ratio, at_end, (length, _, held) in zip(ratios, swung, arms, strict=True)
        )

    @property
    def pivot(self) -> tuple[ArmSection, ...]:
        """Sections at the pivot: through its bore, and where the arm leaves the hub."""
        arm, notch = self.arm, _or(self.arm.pivot_notch, np.nan)
        beside = ("beside the pivot", 0.5 * _or(arm.hub, 0.0), self.width, self.depth, notch)
        if arm.bore is None:
            return (ArmSection(*beside),)
        hub = _or(arm.hub, self.depth)
        through = ArmSection("through the bore of the pivot", 0.0, self.width, hub, notch, arm.bore)
        return through, ArmSection(*beside)

    @property
    def roller(self) -> tuple[ArmSection, ...]:
        """Sections at the roller: the eye of the pin, where the pin is described, and the cheeks or
        the arm where they leave the eye.
        """
        notch, (reach, width, depth, cheeks) = _or(self.arm.roller_notch, np.nan), self._end
        left = (width, depth) if cheeks else (self.width, self.depth)
        beside = ArmSection("beside the roller", self.length - reach, *left, notch, cheeks=cheeks)
        if self.pin is None or not np.any(self.pin.diameter < depth):
            return (beside,)
        # of many designs one without an eye has no stress there
        has_eye = np.asarray(self.pin.diameter < depth)
        hole = self.pin.diameter if has_eye.all() else has_eye * self.pin.diameter
        notch = notch if has_eye.all() else has_eye * notch
        eye = ArmSection(
            "eye of the roller's pin", self.length, width, depth, notch, hole, cheeks, eye=True
        )
        return eye, beside

    @property
    def _end(self) -> tuple[Value, Value, Value, int]:
        """Eye at the end of the arm: reach along the arm from the roller centre, m, width of all
        cheeks together, m, depth, m, and number of cheeks; 0 cheeks where the arm itself is the
        eye.
        """
        hub, pin, fork = _or(self.arm.roller_hub, self.depth), self.pin, self.fork
        if pin is None or fork is None or fork.cheek_height is None or fork.cheek_length is None:
            return 0.5 * hub, self.width, hub, 0
        cheeks = fork.cheeks(pin)
        return fork.cheek_length, cheeks * fork.cheek_width, fork.cheek_height, cheeks

    def mass_at_end(self, inset: float) -> float:
        """Mass at its end with the moment of inertia of the bar less an inset there, m, kg.

        Its hubs are left out.
        """
        reach = np.maximum(self.length - inset, 0.0)
        section = self.material.density * self.width * self.depth
        return float(section * reach**3 / (3.0 * self.length**2))

    @property
    def sections(self) -> tuple[ArmSection, ...]:
        """Judged sections, at the pivot and at a roller."""
        return (*self.pivot, *(self.roller if self.holds_pin else ()))

    def bending(self, distance: Value, forces: ArmForces) -> Array:
        """Bending moment (...), N m, of a section, in the plane of the cam, > 0 as the contact
        bends the arm.

        Of the contact, of the spring between the pivot and where it acts, and of the inertia of
        roller, pin and fork at the end and of a uniform bar.

        Parameters
        ----------
        distance : float or array   of the section from the pivot, m
        forces : ArmForces          (...), N
        """
        share = distance / self.length
        bar = 1.0 - 1.5 * share + 0.5 * share**3
        swung = self.end_share * (1.0 - share) + self.bar_share * bar
        acts = np.asarray(self.held) > 0.0
        sprung = np.maximum(1.0 - distance / np.where(acts, self.held, 1.0), 0.0) * acts
        moment = forces.across - forces.pressed * share - forces.inertia * swung
        moment = moment - forces.closing * sprung
        return np.asarray(self.length * moment)

    def loads(self, section: ArmSection, forces: ArmForces) -> SectionLoads:
        """Moments and force (...) in a section of the arm under the forces (...) on it.

        The cheeks of a fork carry the couple of the contact by unequal forces: the loads are those
        of all cheeks, each as loaded as the most loaded one.
        """
        bent, none, away = self.bending(section.distance, forces), 0.0 * forces.normal, forces.away
        pin, uneven = self.pin, 1.0 + none
        if pin is not None and section.cheeks:
            uneven = section.cheeks * support_force(uneven, away, pin.span, pin.overhung)
        if section.eye:
            return SectionLoads(none, forces.normal * uneven, none, none)
        if section.cheeks > 1:
            return SectionLoads(bent * uneven, forces.along * uneven, none, none)
        offset = away + self._offset(section)
        return SectionLoads(bent, forces.along, forces.along * offset, forces.pressed * offset)

    def _offset(self, section: ArmSection) -> Value:
        """Distance of the middle of a section from that of the roller, m."""
        if self.pin is None or self.fork is None or not section.cheeks:
            return self.arm.plane_offset
        return 0.5 * sum(self.fork.faces(self.pin))

    @property
    def compliance(self) -> float:
        """Deflection of the end of the arm over the force across it there, m/N, while pivot and
        spring hold it.

        Bending and shear of the arm and its cheeks, between its pivot and the place of the spring.

        References
        ----------
        Timoshenko, Strength of Materials I: unit-load method. Cowper, J. Appl. Mech. 33 (1966) 335:
        shear coefficient of the rectangle.
        """
        reach, width, depth, cheeks = self._end
        root = self.length - reach if cheeks else self.length
        ends = (0.0, min(self.held, self.length), root, self.length)
        corners = distinct([float(each) for each in ends])
        total, card = 0.0, self.material
        shear = card.E / (2.0 * (1.0 + card.nu))
        kappa = 10.0 * (1.0 + card.nu) / (12.0 + 11.0 * card.nu)
        for start, end in pairwise(corners.tolist()):
            b, h = (width, depth) if start >= root else (self.width, self.depth)
            moments = self._unit_moments((start, 0.5 * (start + end), end))
            # the square of a linear moment: Simpson's rule is exact
            squares = np.array([1.0, 4.0, 1.0]) @ moments**2 / 6.0
            force = (moments[2] - moments[0]) / (end - start)
            total += (end - start) * squares / (card.E * b * h**3 / 12.0)
            total += (end - start) * force**2 / (kappa * shear * b * h)
        return float(total)

    @property
    def couple_compliance(self) -> Value:
        """Slope of the line of contact over the couple of the contact in the plane of its normal
        and the cam axis, rad/(N m).

        Twist of the arm and bending of its cheeks to either side, at a pressure angle of zero.
        """
        (reach, width, depth, cheeks), card, pin = self._end, self.material, self.pin
        shear = card.E / (2.0 * (1.0 + card.nu))
        twisted = self.length - reach if cheeks else self.length
        slope = twisted / (shear * torsion_of_rectangle(self.width, self.depth)[0])
        if cheeks > 1 and pin is not None:
            bent = card.E * (width / cheeks) * depth**3 / 12.0
            slope += 2.0 * reach**3 / (3.0 * bent * pin.span**2)
        elif cheeks:
            slope += reach / (shear * torsion_of_rectangle(width, depth)[0])
        return slope

    def _unit_moments(self, places: Sequence[float]) -> Array:
        """Moment of a unit force across the end at places, m."""
        x, held = np.asarray(places, dtype=float), self.held
        inside = (self.length - held) * x / held if held else self.length - x
        return np.where(x < held, inside, self.length - x)

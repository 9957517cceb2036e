"""Stiffness from cam to follower mass: compliances of the members in series."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.contact.rolling_bearing import OuterRing
from camwright.pipeline.follower.bearing_ring import ball_stiffness
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.ring_on_balls import RingOnBalls
from camwright.pipeline.follower.roller_parts import Fork, Pin
from camwright.pipeline.follower.stem_beam import Stem


def in_series(compliances: Iterable[float]) -> float:
    """Stiffness, N/m, of compliances, m/N, in series.

    Raises
    ------
    InputError
        If the sum is not positive; NaN included.
    """
    total = sum(compliances)
    if not total > 0.0:
        raise InputError("follower compliance", total, "> 0 m/N")
    return 1.0 / total


def bearing_compliance(solved: RingOnBalls, ring: OuterRing, load: float) -> float:
    """Radial compliance of outer ring and balls of a roller, m/N, mean over the positions of the
    balls.

    The ring was solved with balls of another stiffness; by Castigliano's theorem its compliance
    changes by the sum of squared ball loads per newton times the change of the balls' compliance.

    Parameters
    ----------
    solved : RingOnBalls   bending of the ring under a unit force
    ring : OuterRing       with its balls and rows
    load : float           radial load that sets the stiffness of the balls, N
    """
    steel, bending = solved.body.material, solved.bending
    per_row = ball_stiffness(load / ring.rows, ring.ball_diameter, steel.modulus, steel.poisson)
    softer = 1.0 / (ring.rows * per_row) - 1.0 / solved.ring.ball_stiffness
    squares = np.sum(bending.ball_load**2, axis=1)
    return float(np.mean(bending.compliance + squares * softer))


def pin_compliance(pin: Pin, width: float) -> float:
    """Bending and shear compliance of the pin of a roller at the middle of the bearing, m/N.

    Straddled: simply supported under a load uniform over the width of the bearing. Overhung:
    clamped, load at the middle of the bearing.

    Parameters
    ----------
    pin : Pin       with its span
    width : float   of the bearing, m

    References
    ----------
    Timoshenko, Strength of Materials I: beams; II: effect of shear.
    """
    bar = Stem(pin.diameter, pin.material.E, pin.material.nu, shear=True)
    span = pin.span
    if pin.overhung:
        return span**3 / (3.0 * bar.bending_stiffness) + span * bar.shear_flexibility
    bending = (8.0 * span**3 - 4.0 * span * width**2 + width**3) / (384.0 * bar.bending_stiffness)
    return bending + (0.25 * span - 0.125 * width) * bar.shear_flexibility


def fork_compliance(fork: Fork, pin: Pin) -> float | None:
    """Axial compliance of the fork's cheeks, m/N; None without height or length."""
    height, length = fork.cheek_height, fork.cheek_length
    if height is None or length is None:
        return None
    return length / (fork.material.E * fork.cheeks(pin) * fork.cheek_width * height)


def stem_compliance_along(stem: Stem, length: float) -> float:
    """Axial compliance of the stem over a length (m), m/N."""
    area = 0.25 * np.pi * (stem.diameter**2 - stem.bore**2)
    return float(length / (stem.elastic_modulus * area))


def shaft_compliance(shaft: Camshaft, spacing: float = 0.0) -> float | None:
    """Bending and shear compliance of the camshaft at the cam, or at a disc a spacing, m, from it,
    m/N; None without diameter or material.

    A plain bar on two hinged bearings, the disc between or beyond them.

    References
    ----------
    Timoshenko, Strength of Materials I: beams; II: effect of shear.
    """
    if shaft.diameter is None or shaft.material is None:
        return None
    card = shaft.material
    bar = Stem(shaft.diameter, card.E, card.nu, shear=True)
    span, first = shaft.bearing_spacing, shaft.cam_position + spacing
    second = span - first
    if first >= 0.0 and second >= 0.0:
        bending = (first * second) ** 2 / (3.0 * bar.bending_stiffness * span)
        return bending + first * second / span * bar.shear_flexibility
    over = -min(first, second)
    bending = over**2 * (span + over) / (3.0 * bar.bending_stiffness)
    return bending + over * (1.0 + over / span) * bar.shear_flexibility


def shaft_between(shaft: Camshaft, spacing: float) -> float:
    """Deflection of the camshaft at the cam per force at a disc a spacing, m, from it, or the other
    way round, m/N; 0 without diameter or material.

    The bar of `shaft_compliance`; unit-load method, exact, since both moments are linear between
    the forces.
    """
    if shaft.diameter is None or shaft.material is None:
        return 0.0
    card, span = shaft.material, shaft.bearing_spacing
    bar = Stem(shaft.diameter, card.E, card.nu, shear=True)
    discs = np.array([[shaft.cam_position], [shaft.cam_position + spacing]])
    corners = np.unique([0.0, span, *discs.ravel()])
    start, step = corners[:-1], np.diff(corners)

    def moments(places: Array) -> Array:
        """Bending moments (2, k) of a unit force at each disc."""
        held = discs / span * np.maximum(places - span, 0.0)
        held = held + (1.0 - discs / span) * np.maximum(places, 0.0)
        return np.asarray(held - np.maximum(places - discs, 0.0))

    low, middle, high = (moments(start + share * step) for share in (0.0, 0.5, 1.0))
    bending = np.prod(low, axis=0) + 4.0 * np.prod(middle, axis=0) + np.prod(high, axis=0)
    shear = np.prod((high - low) / step, axis=0) * bar.shear_flexibility
    return float(np.sum(step * (bending / (6.0 * bar.bending_stiffness) + shear)))

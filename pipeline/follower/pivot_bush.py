"""Rigid pin in an elastic bush with clearance under a force and a couple: tilt and line load."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.follower.guide_reactions import Guide

_HALVINGS = 60  # of the tilt between its bounds, to round-off


class PressedBush(NamedTuple):
    """Rigid pin in its bush, arrays (...), >= 0: tilt, rad; greatest line load, N/m; lengths in
    contact on the side of the force and on the other side, m.
    """

    tilt: Array
    line_load: Array
    reach: Array
    beyond: Array


def pressed_bush(bush: Guide, force: Array, couple: Array) -> PressedBush:
    """Tilt and greatest line load of a rigid pin in a bush.

    The bush is an elastic foundation of the modulus k beyond half of its diametral clearance c, on
    both sides. Force and couple are in one plane with the pin.

    - C <= F l/6: the load is linear over the whole length, F/l + 6 C/l^2 at the end
    - beyond: a triangle over a = 3 (l/2 - C/F), with 2 F/a at the end
    - once the tilt t has used the clearance: triangles over a and b at both ends, on either side,
      with the line loads k t a and k t b

    The foundation is that of half of the bore in contact: with clearance it is too stiff, and the
    elastic tilt on one side about a third of that in three dimensions; the line load at the end is
    up to 8 % too great, between both edges a third.

    Parameters
    ----------
    bush : Guide                  one, or with the values of many designs, each (m, 1)
    force, couple : array (...)   F, N, in the middle of the bush, and C, N m; >= 0

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 4.3: elastic foundation.
    """
    of_bush = bush.length, bush.foundation_modulus, bush.clearance
    push, turn, length, modulus, play = np.broadcast_arrays(
        *(np.asarray(each, dtype=float) for each in (force, couple, *of_bush))
    )
    full = 6.0 * turn <= push * length
    loaded = np.where(push > 0.0, push, 1.0)
    reach = np.where(push > 0.0, 3.0 * (0.5 * length - turn / loaded), 0.0)
    reach = np.where(full | (reach > 0.0), np.where(full, length, reach), 0.0)
    some = np.where(reach > 0.0, reach, 1.0)
    greatest = np.where(full, push / length + 6.0 * turn / length**2, 2.0 * push / some)
    tilt = np.where(full, 12.0 * turn / length**3, greatest / some) / modulus
    both = ~full & ((reach == 0.0) | (tilt * length - greatest / modulus > play))
    values = tilt.copy(), greatest.copy(), np.maximum(reach, 0.0), 0.0 * reach
    if both.any():
        at = (each[both] for each in (length, modulus, play, push, turn))
        for value, solved in zip(values, _between_edges(*at), strict=True):
            value[both] = solved
    return PressedBush(*values)


def bush_lines(bush: Guide, force: Array, couple: Array, places: Array) -> Array:
    """Line load (k, n), N/m, on a rigid pin along its elastic bush, positive where the force
    presses.

    Parameters
    ----------
    bush : Guide          length, stiffness, clearance
    force : array (n,)    on the pin, N
    couple : array (n,)   N m; presses the end of greatest place, see `pressed_bush`
    places : array (k,)   from the middle of the bush, m
    """
    pressed = pressed_bush(bush, force, couple)
    modulus, gap = bush.foundation_modulus, 0.5 * bush.clearance
    end = gap + pressed.line_load / modulus
    sunk = end - pressed.tilt * (0.5 * bush.length - np.asarray(places)[:, None])
    loads = modulus * np.sign(sunk) * np.maximum(np.abs(sunk) - gap, 0.0)
    return np.asarray(np.where(pressed.line_load > 0.0, loads, 0.0))


def _between_edges(
    length: Array, modulus: Array, play: Array, force: Array, couple: Array
) -> PressedBush:
    """Rigid pin that presses on both sides of its bush; tilt by bisection.

    Parameters
    ----------
    length, modulus, play : array (m,)   of the bush, m; of its foundation, N/m2; clearance, m
    force : array (m,)                   on the pin, N
    couple : array (m,)                  N m, great enough that both ends touch
    """

    def ends(tilt: Array) -> tuple[Array, Array]:
        """Lengths in contact on the side of the force, and on the other."""
        total, apart = length - play / tilt, 2.0 * force / (modulus * tilt)
        return 0.5 * (total + apart / total), 0.5 * (total - apart / total)

    def carried(tilt: Array) -> Array:
        parts = (each**2 * (0.5 * length - each / 3.0) for each in ends(tilt))
        return np.asarray(0.5 * modulus * tilt * sum(parts))

    # with one end alone (l - c/tilt)^2 = 2 F/(k tilt); without clearance 12 C/(k l^3)
    dent = force / (modulus * length)
    low = (play + dent + np.sqrt(dent * (dent + 2.0 * play))) / length
    high = low + play / length + 12.0 * couple / (modulus * length**3)
    while (short := carried(high) < couple).any():
        high = np.where(short, 2.0 * high, high)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        less = carried(middle) < couple
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    tilt = 0.5 * (low + high)
    reach, beyond = ends(tilt)
    return PressedBush(tilt, modulus * tilt * reach, reach, beyond)

"""Flash temperature of a flat face over a turn."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.flash_temperature import effusivity, flash_temperature
from camwright.pipeline.follower.flat_face_motion import FaceSliding


def flash_history(
    machine: Machine,
    pair: ContactPair,
    path: FollowerPath,
    theta: Array,
    contact: ContactHistory,
    sliding: FaceSliding,
) -> Array | None:
    """Flash temperature rise (n,), K; None without friction or thermal data.

    Where the face reverses its motion through the contact it takes no heat: the cusp between two
    angles is that of the nearer.
    """
    taken = _effusivity(machine.cam.material), _effusivity(machine.face.material)
    if machine.face.friction is None or np.isnan(taken).any():
        return None
    through = machine.cam_speed * path.lift(theta, 2)
    heat = sliding.power / pair.width
    half_width = np.where(heat > 0, contact.half_width, 1.0)
    rise = flash_temperature(heat, (through + sliding.speed, through), taken, half_width)
    after = np.roll(through, -1)
    before = np.flatnonzero(through * after < 0)
    share = through[before] / (through[before] - after[before])
    heat, speed, half_width = (
        values[before] + share * (np.roll(values, -1) - values)[before]
        for values in (heat, sliding.speed, half_width)
    )
    cusp = flash_temperature(heat, (speed, 0.0), taken, half_width)
    np.maximum.at(rise, (before + np.rint(share).astype(int)) % theta.size, cusp)
    return rise


def _effusivity(card: Material) -> float:
    """Effusivity of a card, NaN without its thermal data."""
    if card.conductivity is None or card.specific_heat is None:
        return np.nan
    return effusivity(card.conductivity, card.density, card.specific_heat)

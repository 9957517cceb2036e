"""Flash temperature of a flat face, and of a roller that slips, over a turn."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.flash_temperature import effusivity, flash_temperature
from camwright.pipeline.contact.traction import RollingContact
from camwright.pipeline.follower.flat_face_motion import FaceSliding
from camwright.pipeline.follower.roller_motion import RollingRoller


def flash_history(
    machine: Machine,
    pair: ContactPair,
    theta: Array,
    contact: ContactHistory,
    sliding: FaceSliding,
) -> Array | None:
    """Flash temperature rise of a sliding face at cam angles theta (n,), rad, equally spaced, (n,),
    K; None without its friction or thermal data.

    Where the face reverses its motion through the contact it takes no heat: the cusp between two
    angles is that of the nearer.

    Parameters
    ----------
    contact : ContactHistory   at theta: half-widths
    sliding : FaceSliding      at theta: friction power and speed of the cam on the face
    """
    if machine.face.friction is None:
        return None
    along = np.empty(theta.size)
    for each, at in pair.on_walls(theta):
        along[at] = each.contour.pitch.slide(each.angle(theta[at])).along_face
    through = machine.cam_speed * along
    heat = sliding.power / pair.width
    half_width = np.where(heat > 0, contact.half_width, 1.0)
    return flash_rise(machine, heat, sliding.speed, through, half_width)


def flash_rise(
    machine: Machine, heat: Array, sliding: Array, through: Array, half_width: Array
) -> Array | None:
    """Flash temperature rise (..., n) of a flat face over its turn, K; None without thermal data.

    Parameters
    ----------
    heat : array (..., n)               friction power per length of the line, W/m
    sliding, through : array (..., n)   speed of the cam on the face, and of the contact along it,
                                        m/s
    half_width : array (..., n)         m, > 0
    """
    taken = _effusivity(machine.cam.material), _effusivity(machine.face.material)
    if np.isnan(taken).any():
        return None
    rise = flash_temperature(heat, (through + sliding, through), taken, half_width)
    after = np.roll(through, -1, axis=-1)
    reverses = through * after < 0
    share = np.divide(through, through - after, out=np.zeros_like(through), where=reverses)
    heat, sliding, half_width = (
        values + share * (np.roll(values, -1, axis=-1) - values)
        for values in (heat, sliding, half_width)
    )
    cusp = np.where(reverses, flash_temperature(heat, (sliding, 0.0), taken, half_width), 0.0)
    nearer = np.rint(share) == 1.0
    before = np.where(nearer, 0.0, cusp)
    behind = np.roll(np.where(nearer, cusp, 0.0), 1, axis=-1)
    return np.asarray(np.maximum(rise, np.maximum(before, behind)))


def slip_flash(
    machine: Machine,
    width: float,
    rolling: RollingRoller,
    driven: RollingContact,
    contact: ContactHistory,
) -> Array | None:
    """Flash temperature rise of a roller that slips (n,), K; None without thermal data.

    Its surface runs through the contact at the speed of the cam less the slip: backwards while it
    still turns as on the other track.

    Parameters
    ----------
    width : float              of the contact, m
    rolling : RollingRoller    without slip
    driven : RollingContact    traction and slip
    contact : ContactHistory   half-widths
    """
    taken = _effusivity(machine.cam.material), _effusivity(machine.roller.material)
    if np.isnan(taken).any():
        return None
    heat = np.abs(driven.force * driven.slip) / width
    of_cam = np.abs(rolling.rolling_speed)
    of_roller = of_cam - np.sign(rolling.spin) * driven.slip
    half_width = np.where(heat > 0.0, contact.half_width, 1.0)
    return flash_temperature(heat, (of_cam, of_roller), taken, half_width)


def _effusivity(card: Material) -> float:
    """Effusivity of a card, NaN without its thermal data."""
    if card.conductivity is None or card.specific_heat is None:
        return np.nan
    return effusivity(card.conductivity, card.density, card.specific_heat)

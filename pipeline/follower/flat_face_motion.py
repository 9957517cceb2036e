"""Sliding of a flat face on the cam: speeds, pv value, friction loss."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.tables import Column

MEAN_SHARE = pi / 4.0  # mean over peak pressure of Hertz


@dataclass(frozen=True, eq=False)
class SlidingFace:
    """Contact position (n,), m, and surface speeds (n,), m/s, under a face.

    place: of the contact from the middle of the face; sliding: speed of the cam surface along the
    face; entrainment: mean surface speed through the contact, which moves along the face, at w s''
    on a stem.
    """

    place: Array
    sliding: Array
    entrainment: Array

    def __post_init__(self) -> None:
        freeze(self, place=self.place, sliding=self.sliding, entrainment=self.entrainment)

    def where(self, pulls: NDArray[np.bool_], second: SlidingFace) -> SlidingFace:
        """Motion of the face that carries: of the second one where that pulls (n,)."""
        names = self.__dataclass_fields__
        pairs = {name: (getattr(second, name), getattr(self, name)) for name in names}
        return SlidingFace(**{name: np.where(pulls, *pair) for name, pair in pairs.items()})


def face_motion(path: FollowerPath, cam_speed: float, theta: ArrayLike) -> SlidingFace:
    """Contact position and surface speeds of a face: sliding, on a stem w (r + s), entrainment.

    Parameters
    ----------
    path : FollowerPath  of a face
    cam_speed : float    w, rad/s
    theta : array (n,)   rad

    Raises
    ------
    InputError
        If a value is not finite.

    References
    ----------
    Dowson, Harrison and Taylor, Inst. Mech. Engrs C 255 (1986): cam and flat-faced follower.
    """
    angle, speed = finite("theta", theta), float(finite("cam_speed", cam_speed))
    slide = path.slide(angle)
    passing = np.abs(speed * (0.5 * slide.slip + slide.along_face))
    return SlidingFace(np.asarray(slide.on_face), np.asarray(speed * slide.slip), passing)


def sliding_pv(peak: Array, speed: Array) -> Array:
    """PV value of a face, Pa m/s: mean contact pressure times sliding speed; arrays (...)."""
    return MEAN_SHARE * peak * speed


@dataclass(frozen=True, eq=False)
class FaceSliding:
    """Sliding of a face over one turn, arrays (n,) at equal angles.

    place of the contact on the face, m; speed, m/s; pv, mean contact pressure times speed, Pa m/s;
    friction power, W, and loss per turn, J, zero without a friction coefficient.
    """

    place: Array
    speed: Array
    pv: Array
    power: Array
    loss: float

    def __post_init__(self) -> None:
        names = ("place", "speed", "pv", "power")
        freeze(self, **{name: getattr(self, name) for name in names})

    @classmethod
    def of(
        cls, motion: SlidingFace, peak: Array, force: Array, friction: float, cam_speed: float
    ) -> FaceSliding:
        """From peak pressures (n,) Pa and normal forces (n,) N."""
        power = friction * np.maximum(force, 0.0) * motion.sliding
        loss = float(power.mean()) * FULL_TURN / cam_speed
        return cls(motion.place, motion.sliding, sliding_pv(peak, motion.sliding), power, loss)

    def columns(self) -> dict[Column, Array]:
        """Columns of ``5_cycle.csv``."""
        return {
            Column(
                "face_contact_offset", "mm", "Offset of the contact from the middle of the face"
            ): self.place,
            Column("sliding_speed", "m/s", "Sliding speed of the cam on the face"): self.speed,
            Column(
                "face_pv", "MPa m/s", "Mean contact pressure times sliding speed", unknown=True
            ): self.pv,
            Column("face_friction_power", "W", "Friction power of the face"): self.power,
        }

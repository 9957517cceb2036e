"""Kinds of follower behind one protocol: roller, flat face, later an oscillating arm."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.material import Material
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.follower_body import FollowerBody
from camwright.pipeline.contact.traction import RollingContact
from camwright.pipeline.follower.flat_face_motion import FaceSliding
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, eq=False)
class SurfaceMotion:
    """Motion of the surfaces through the contact, arrays (n,), SI.

    entrainment, m/s; traction_share, traction over friction times normal force, None without a
    friction coefficient; traction_demand, traction of rolling without slip over normal force, NaN
    where the contact is open, None where nothing rolls; rolling, with creep and slip; sliding, of
    a face.
    """

    entrainment: Array
    traction_share: Array | None = None
    traction_demand: Array | None = None
    rolling: RollingContact | None = None
    sliding: FaceSliding | None = None


class FollowerKind(Protocol):
    """Duties of the part that touches the cam.

    `word` names it in files and texts, `table` in the case file; `line_width` is the width of the
    line contact it can carry, m; `friction` that of sliding on the cam; `roughness` its rms, m.
    """

    @property
    def word(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def material(self) -> Material: ...
    @property
    def line_width(self) -> float: ...
    @property
    def friction(self) -> float | None: ...
    @property
    def roughness(self) -> float | None: ...
    @property
    def crowned(self) -> bool: ...

    @property
    def side_friction(self) -> float:
        """Coefficient of the friction that drags the follower sideways; 0 for a roller."""
        ...

    @property
    def contact_radius(self) -> float | None:
        """Radius of its surface, m; None for a flat one."""
        ...

    @property
    def extent(self) -> float:
        """Distance that it reaches from its reference point towards guide A, m."""
        ...

    @property
    def held_depth(self) -> float | None:
        """Material between contact surface and held surface, m; None where it is held afar."""
        ...

    @property
    def body_model(self) -> str:
        """How its body is modelled, in words; "" where there is nothing to say."""
        ...

    def contour(self, lift: Lift, cam: CamBody) -> Contour:
        """Cam contour that moves it by a lift.

        Raises
        ------
        InputError
            If there is no such cam; of a face also where the contact would run off it.
        """
        ...

    def body(self, width: float, stem: Stem, preload: float) -> FollowerBody:
        """Its body in the contact.

        Parameters
        ----------
        width : float      of the line contact, m
        stem : Stem        that holds it
        preload : float    of the spring, N
        """
        ...

    def motion(
        self, contour: Contour, contact: ContactHistory, force: Array, theta: Array, speed: float
    ) -> SurfaceMotion:
        """Motion of its surface on the cam.

        Parameters
        ----------
        force : array (n,)   normal force, N, at the angles
        theta : array (n,)   equal cam angles of a turn, rad
        speed : float        of the cam, rad/s
        """
        ...

"""Face of a follower: dimensions, cam contour, contact body, sliding on the cam."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin, sqrt
from typing import Annotated, ClassVar

from camwright.geometry.arm_face import (
    ArmFaceContour,
    ArmFacePath,
    CurvedFaceContour,
    CurvedFacePath,
    face_disc_lift,
)
from camwright.geometry.arm_path import disc_lift
from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.eccentric import face_lift
from camwright.geometry.flat_face_contour import FacedContour, FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import In, Known, Length, Part, TableSource, Used
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.flat_face_motion import FaceSliding, face_motion
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.follower_kind import ElasticParts, MovingParts, SurfaceMotion
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, kw_only=True)
class FollowerFace(Part):
    """Face of a follower: flat, or curved at the end of an arm.

    That of a stem is perpendicular to it and centred on it. A flat one of an arm lies along the arm
    with its middle at the length of the arm; a curved one is round about the end of the arm.
    """

    table: ClassVar[str] = "follower.face"
    word: ClassVar[str] = "face"
    width_key: ClassVar[str] = "follower.face.depth"
    slides: ClassVar[bool] = True
    axial_offset: ClassVar[None] = None
    parts: ClassVar[Mapping[str, Part | None]] = {}
    spared: ClassVar[tuple[str, ...]] = ("follower.arm.roller_notch",)
    drag: ClassVar[None] = None
    defaults: ClassVar[Mapping[str, str]] = {
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
        "offset": "the face is that of a stem, or a curved one",
        "radius": "the face is flat",
    }

    width: Annotated[Length, Known("drawing", "30 mm")]
    """length in the plane of motion; of a curved face its chord"""
    depth: Annotated[Length, Known("drawing", "10 mm")]
    """length along the cam axis"""
    thickness: Annotated[Length, Known("drawing", "6 mm")]
    """thickness of the block along the stem, or in the direction of the swing"""
    offset: Annotated[
        float | None, In("mm", at_least=-1000, at_most=1000), Known("drawing", "0 mm")
    ] = None
    """distance of a flat face along an arm from its pivot, positive towards the cam"""
    radius: Annotated[Length | None, Known("drawing", "20 mm")] = None
    """radius of a curved face, whose centre is the end of the arm"""
    friction: Annotated[
        float | None, In(above=0, at_most=1), Known("textbooks: 0.05 to 0.12 oiled steel", 0.08)
    ] = None
    """coefficient of friction on the cam"""
    roughness: Annotated[
        float | None, In("um", above=0, at_most=1000), Known("drawing or measured", "0.2 um")
    ] = None
    """rms roughness Rq of the face"""
    pv_limit: Annotated[
        float | None,
        In("MPa m/s", above=0, at_most=1e9),
        Known("maker of the face or coating", "3000 MPa m/s"),
    ] = None
    """permissible mean contact pressure times sliding speed"""
    material: Annotated[MadeOf, Known("drawing", "case_hardened")]
    end: Annotated[BodyEnd | None, Used("contact of finite length")] = None
    """ends of the face; without them the pressure at the ends of the contact is not evaluated"""
    crown: Annotated[AxialCrown | None, Used("contact of finite length")] = None
    """crown of the face along the axis; added to that of the cam"""
    source: TableSource = NO_SOURCE

    @property
    def line_width(self) -> float:
        """Maximum width of the line contact, m: without the ends."""
        return flat_width(self.depth, self.end)

    @property
    def side_friction(self) -> float:
        """Friction coefficient of the side force on the stem; 0 where the case has none."""
        return self.friction or 0.0

    @property
    def contact_radius(self) -> float | None:
        """Radius of a curved face, m; None of a flat one."""
        return self.radius

    @property
    def kinds(self) -> frozenset[str]:
        """See `FollowerKind`."""
        curved = {"round"} if self.radius is not None else set()
        return frozenset({"face", *curved, *({"swung_face"} if self.on_arm else ())})

    @property
    def on_arm(self) -> bool:
        """Whether it is the face of an arm, not of a stem."""
        return self.offset is not None or self.radius is not None

    @property
    def reference(self) -> str:
        """See `FollowerKind`."""
        return "end of the arm" if self.on_arm else "middle of the face"

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on the place or radius of the face of an arm; see `FollowerKind`."""
        offset, radius = (each and shown(each, "mm") for each in (self.offset, self.radius))
        if radius is not None:
            return (f"face of radius {radius} about the end of the arm",)
        return (f"face {offset or '0 mm'} from the pivot towards the cam",) if self.on_arm else ()

    @property
    def extent(self) -> float:
        """Thickness of the block towards guide A, m."""
        return self.thickness

    @property
    def held_depth(self) -> None:
        """None: the block is held at the stem."""
        return None

    @property
    def body_depth(self) -> float:
        """Thickness of the block, m."""
        return self.thickness

    @property
    def body_model(self) -> str:
        """Empty: the block is modelled without simplification."""
        return ""

    @property
    def _round_off(self) -> float:
        """Difference of area, m2, between the rectangle in which the block of a curved face lies
        and the block; 0 of a flat face.
        """
        if self.radius is None:
            return 0.0
        half = min(0.5 * self.width, self.radius)
        turned = self.radius * asin(half / self.radius)
        return half * (2.0 * self.radius - sqrt(self.radius**2 - half**2)) - self.radius * turned

    @property
    def moving(self) -> MovingParts:
        """Block of the face; see `FollowerKind`."""
        area = self.width * self.thickness - self._round_off
        mass = self.material.density * area * self.depth
        return MovingParts({"face": mass}, self.thickness, {})

    def ring(self, width: float, preload: float) -> None:
        """None: the face has no bearing."""

    def elastic(self, width: float, preload: float) -> ElasticParts:  # noqa: ARG002
        """None: the block is rigid; see `FollowerKind`."""
        return ElasticParts({}, 0.0)

    def turns(self, path: Array | float) -> float:  # noqa: ARG002
        """Zero: the face does not turn with the cam."""
        return 0.0

    def pin_stress(self, force: Array, moment: Array) -> None:
        """None: a face has no pin; see `FollowerKind`."""

    def rolling(self, contour: Contour, loads: Loads, speed: float) -> None:
        """None: the face slides."""

    def contour(self, lift: Lift, cam: CamBody, arm: FollowerArm | None = None) -> Contour:
        """Cam contour under the face; see `FollowerKind`."""
        contour = self._contour(lift, cam, arm)
        contour.require_face(self.width)
        return contour

    def _contour(self, lift: Lift, cam: CamBody, arm: FollowerArm | None) -> FacedContour:
        """Contour of the cam under the face, by its kind: flat on a stem, curved or flat on an arm.

        Parameters
        ----------
        lift : Lift         of the follower
        cam : CamBody       prime radius and offset
        arm : FollowerArm   None: the face is on a stem
        """
        if arm is None:
            return FlatFaceContour(FacePath(lift, cam.prime_radius, cam.offset))
        linkage, start = arm.linkage, arm.start(cam.prime_radius, self.offset)
        if self.radius is not None:
            return CurvedFaceContour.of(CurvedFacePath(lift, linkage, start, self.radius))
        return ArmFaceContour(ArmFacePath(lift, linkage, start, self.offset or 0.0))

    def disc_lift(self, eccentricity: float, cam: CamBody, arm: FollowerArm | None) -> Lift:
        """Lift of the follower on an eccentric disc, zero at cam angle 0.

        Parameters
        ----------
        eccentricity : float   of the disc, m
        cam : CamBody          with its base circle
        arm : FollowerArm      None: the face is on a stem

        Raises
        ------
        InputError
            If the eccentricity is not positive, or an arm does not reach the disc.
        """
        if arm is None:
            return face_lift(eccentricity)
        if self.offset is None:
            return disc_lift(eccentricity, cam.prime_radius, arm.linkage)
        return face_disc_lift(eccentricity, cam.prime_radius, arm.linkage, self.offset)

    def body(self, width: float, stem: Stem, preload: float) -> FaceBody:  # noqa: ARG002
        """Contact body of the face: a block held by its stem, or over its whole back by an arm; see
        `FollowerKind`.

        Parameters
        ----------
        width : float     of contact; not used
        stem : Stem       which holds the block
        preload : float   not used
        """
        elastic = Elastic(self.material.E, self.material.nu)
        held = self.width if self.on_arm else stem.diameter
        part = "flat face" if self.radius is None else "curved face"
        return FaceBody(self.width, self.thickness, held, elastic, self.radius, part=part)

    def motion(
        self,
        contour: Contour,
        contact: ContactHistory,
        loads: Loads,
        speed: float,
        idle: ContactHistory | None = None,  # noqa: ARG002
    ) -> SurfaceMotion:
        """Sliding of the face; see `FollowerKind`."""
        motion, force = face_motion(contour.pitch, speed, loads.theta), loads.normal_force
        if loads.second is not None:
            track = loads.second.track(contour.pitch)
            second = face_motion(track.contour.pitch, speed, loads.theta + track.turn)
            motion = motion.where(loads.wall < 0.0, second)
        return SurfaceMotion(
            motion.entrainment,
            traction_share=(force > 0).astype(float),
            sliding=FaceSliding.of(motion, contact.p0, force, self.side_friction, speed),
        )

"""Flat-faced follower: dimensions, contact body, sliding on the cam."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import In, Known, Length, Part, TableSource, Used
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.flat_face_motion import FaceSliding, face_motion
from camwright.pipeline.follower.follower_kind import ElasticParts, MovingParts, SurfaceMotion
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, kw_only=True)
class FlatFace(Part):
    """Flat face of a follower, perpendicular to the stem and centred on it."""

    table: ClassVar[str] = "follower.face"
    word: ClassVar[str] = "face"
    width_key: ClassVar[str] = "follower.face.depth"
    slides: ClassVar[bool] = True
    axial_offset: ClassVar[None] = None
    parts: ClassVar[Mapping[str, Part | None]] = {}
    drag: ClassVar[None] = None
    defaults: ClassVar[Mapping[str, str]] = {
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
    }

    width: Annotated[Length, Known("drawing", "30 mm")]
    """length in the plane of motion"""
    depth: Annotated[Length, Known("drawing", "10 mm")]
    """length along the cam axis"""
    thickness: Annotated[Length, Known("drawing", "6 mm")]
    """thickness of the block along the stem"""
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
    def contact_radius(self) -> None:
        """None: the face is flat."""
        return None

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
    def moving(self) -> MovingParts:
        """Block of the face; see `FollowerKind`."""
        mass = self.material.density * self.width * self.depth * self.thickness
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

    def rolling(self, contour: Contour, theta: Array, speed: float) -> None:
        """None: the face slides."""

    def contour(
        self,
        lift: Lift,
        cam: CamBody,
        arm: FollowerArm | None = None,  # noqa: ARG002
    ) -> Contour:
        """Cam contour under the face, which no arm has; see `FollowerKind`."""
        contour = FlatFaceContour(FacePath(lift, cam.prime_radius, cam.offset))
        contour.require_face(self.width)
        return contour

    def body(self, width: float, stem: Stem, preload: float) -> FaceBody:  # noqa: ARG002
        """Block of the face on its stem; see `FollowerKind`."""
        elastic = Elastic(self.material.E, self.material.nu)
        return FaceBody(self.width, self.thickness, stem.diameter, elastic)

    def motion(
        self, contour: Contour, contact: ContactHistory, force: Array, theta: Array, speed: float
    ) -> SurfaceMotion:
        """Sliding of the face; see `FollowerKind`."""
        motion = face_motion(contour.pitch, speed, theta)
        return SurfaceMotion(
            motion.entrainment,
            traction_share=(force > 0).astype(float),
            sliding=FaceSliding.of(motion, contact.p0, force, self.side_friction, speed),
        )

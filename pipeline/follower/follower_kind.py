"""Protocol of follower types: roller and face."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, dataclass
from typing import ClassVar, Literal, NamedTuple, Protocol, Self

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.follower_body import FollowerBody
from camwright.pipeline.contact.traction import Drag, RollingContact
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.flat_face_motion import FaceSliding
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.ring_on_balls import RingOnBalls
from camwright.pipeline.follower.roller_motion import RollingRoller
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, eq=False)
class SurfaceMotion:
    """Surface speeds through the contact, arrays (n,), SI.

    entrainment: speed, m/s; traction_share: traction over friction times normal force, None without
    a friction coefficient; traction_demand: traction of rolling without slip over normal force, NaN
    without contact, None without rolling; rolling: with creep and slip; sliding: of a face.
    """

    entrainment: Array
    traction_share: Array | None = None
    traction_demand: Array | None = None
    rolling: RollingContact | None = None
    sliding: FaceSliding | None = None


class MovingParts(NamedTuple):
    """Masses and lengths of the moving parts below the stem.

    masses: by name, kg, None: not known; inset: length of the stem that they replace, m; missing:
    keys that the case lacks for the mass of a part of the scope.
    """

    masses: Mapping[str, float | None]
    inset: float
    missing: Mapping[Literal["pin", "fork"], tuple[str, ...]]


class ElasticParts(NamedTuple):
    """Compliances of the parts below the stem by name, m/N; None: not known."""

    compliances: Mapping[str, float | None]
    held: float


class FollowerKind(Protocol):
    """Interface of the part that touches the cam: roller or face.

    `word`: its name in files and texts; `table`: in the case file; `width_key`: key of its width
    along the line of contact; `line_width`: maximum width of the line contact, m; `friction`:
    coefficient of sliding on the cam; `roughness`: rms, m; `slides`: whether its surface slides on
    the cam, not rolls; `end`: of its surface, None where it is not stated; `crown`: None for a
    straight one; `offset`: of a flat face on an arm from the pivot towards the cam, m, None of any
    other; `axial_offset`: of its middle from that of the cam, m, None where it is not
    stated; `parts`: those of the scope by their names there, None: not described; `spared`: keys
    that other parts do not need with it; `drag`: against rolling, None without it.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[object]]]

    @property
    def word(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def width_key(self) -> str: ...
    @property
    def material(self) -> Material: ...
    @property
    def line_width(self) -> float: ...
    @property
    def friction(self) -> float | None: ...
    @property
    def roughness(self) -> float | None: ...
    @property
    def slides(self) -> bool: ...
    @property
    def end(self) -> BodyEnd | None: ...
    @property
    def crown(self) -> AxialCrown | None: ...
    @property
    def axial_offset(self) -> float | None: ...
    @property
    def offset(self) -> float | None: ...
    @property
    def parts(self) -> Mapping[str, Part | None]: ...
    @property
    def spared(self) -> tuple[str, ...]: ...
    @property
    def drag(self) -> Drag | None: ...
    @property
    def moving(self) -> MovingParts: ...
    def with_values(self, values: Mapping[str, float]) -> Self: ...

    def pin_stress(self, force: Array, moment: Array) -> Array | None:
        """Bending stress of the pin (n,), Pa; None without one.

        Under a contact force (n,), N, and its moment about the middle of the follower (n,), N m.
        """
        ...

    @property
    def side_friction(self) -> float:
        """Friction coefficient of the side force on the stem; 0 for a roller."""
        ...

    @property
    def kinds(self) -> frozenset[str]:
        """Words of the checks that it has: roller or face, and round with a round surface."""
        ...

    @property
    def reference(self) -> str:
        """Its reference point, in words."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on the drawing of the cam, of what the contour alone does not tell."""
        ...

    @property
    def contact_radius(self) -> float | None:
        """Radius of the surface, m; None for a flat one."""
        ...

    @property
    def extent(self) -> float:
        """Extent of the part from its reference point towards guide A, m."""
        ...

    @property
    def held_depth(self) -> float | None:
        """Distance of contact surface and held or supported surface, m; None for a flat face."""
        ...

    @property
    def body_depth(self) -> float:
        """Distance of contact surface and opposite surface, m."""
        ...

    @property
    def body_model(self) -> str:
        """Simplifications of its body model, in words; "" without any."""
        ...

    def ring(self, width: float, preload: float) -> RingOnBalls | None:
        """Outer ring on balls; None for other parts. Arguments: see `body`."""
        ...

    def elastic(self, width: float, preload: float) -> ElasticParts:
        """Compliances of the part. Arguments: see `body`."""
        ...

    def turns(self, path: Array | float) -> float:
        """Mean turns of the part per cam turn, from its path speed per cam angle, m/rad."""
        ...

    def rolling(self, contour: Contour, loads: Loads, speed: float) -> RollingRoller | None:
        """Motion without slip; None without rolling. Arguments: see `motion`."""
        ...

    def contour(self, lift: Lift, cam: CamBody, arm: FollowerArm | None = None) -> Contour:
        """Cam contour of a lift, under a stem or an arm.

        Raises
        ------
        InputError
            If there is no such cam, or the contact leaves the width of a face.
        """
        ...

    def body(self, width: float, stem: Stem, preload: float) -> FollowerBody:
        """Body of the contact.

        Parameters
        ----------
        width : float      of the line contact, m
        stem : Stem        of the follower
        preload : float    of the spring, N
        """
        ...

    def motion(
        self,
        contour: Contour,
        contact: ContactHistory,
        loads: Loads,
        speed: float,
        idle: ContactHistory | None = None,
    ) -> SurfaceMotion:
        """Motion of the surfaces in the contact.

        Parameters
        ----------
        loads : Loads        at equal cam angles of a turn
        speed : float        of the cam, rad/s
        idle : ContactHistory   on the track that bears less, of preloaded discs
        """
        ...

"""Cam disc: base shape, bore, keyway, key and material."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError
from camwright.geometry.form_closure import GrooveStep
from camwright.geometry.second_track import (
    CoaxialRoller,
    ConjugateArm,
    OppositeFace,
    OppositeRoller,
    SecondFollower,
)
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import Angle, In, Known, Length, Part, TableSource, Used
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.contact.shrink_fit import SeatFit


@dataclass(frozen=True, kw_only=True)
class Keyway(Part):
    """A keyway in the bore.

    The fillet counts for the stress at the root alone.
    """

    fillet: ClassVar[float] = 0.0  # its inner corners are meshed sharp
    table: ClassVar[str] = "cam.keyway"
    defaults: ClassVar[Mapping[str, str]] = {
        "root_radius": "least of DIN 6885-1, by a standard width of the keyway"
    }

    width: Annotated[Length, Known("DIN 6885-1 by the shaft diameter", "5 mm")]
    """width of the keyway"""
    depth: Annotated[Length, Known("DIN 6885-1 by the shaft diameter", "2.3 mm")]
    """depth in the hub, from the bore"""
    angle: Annotated[Angle, Known("drawing")] = 0.0
    """direction of the centre line of the keyway in the cam frame"""
    root_radius: Annotated[Length | None, Known("DIN 6885-1, or drawing", "0.16 mm")] = None
    """fillet between side and floor"""


class StandardKey(NamedTuple):
    """Row of DIN 6885-1, m: key height h, depth t1 in the shaft, greatest and least key chamfer s,
    least fillet radius r of the keyways.
    """

    height: float
    shaft_depth: float
    chamfer: float
    least_chamfer: float
    fillet: float


_MILLIMETRE = 1e-3  # m
STANDARD_KEYS: Mapping[int, StandardKey] = {
    width: StandardKey(*(_MILLIMETRE * each for each in row))
    for width, *row in (
        (2, 2, 1.2, 0.25, 0.16, 0.08), (3, 3, 1.8, 0.25, 0.16, 0.08),
        (4, 4, 2.5, 0.25, 0.16, 0.08), (5, 5, 3.0, 0.40, 0.25, 0.16),
        (6, 6, 3.5, 0.40, 0.25, 0.16), (8, 7, 4.0, 0.40, 0.25, 0.16),
        (10, 8, 5.0, 0.60, 0.40, 0.25), (12, 8, 5.0, 0.60, 0.40, 0.25),
        (14, 9, 5.5, 0.60, 0.40, 0.25), (16, 10, 6.0, 0.60, 0.40, 0.25),
        (18, 11, 7.0, 0.60, 0.40, 0.25), (20, 12, 7.5, 0.80, 0.60, 0.40),
        (22, 14, 9.0, 0.80, 0.60, 0.40), (25, 14, 9.0, 0.80, 0.60, 0.40),
        (28, 16, 10.0, 0.80, 0.60, 0.40),
    )
}  # fmt: skip
"""Parallel keys of DIN 6885-1 by their width, mm (recalled, verify)."""


@dataclass(frozen=True, kw_only=True)
class ParallelKey(Part):
    """Parallel key of the cam.

    h of DIN 6885-1 is `height`, t1 `shaft_depth`. Round ends do not transmit torque.
    """

    table: ClassVar[str] = "cam.key"
    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("height", "shaft_depth", "chamfer"), "DIN 6885-1, by a standard width of the keyway"
    )

    length: Annotated[Length | None, Known("drawing; DIN 6885-1", "14 mm")] = None
    """length, round ends of form A included"""
    height: Annotated[Length | None, Known("DIN 6885-1", "5 mm")] = None
    """height of the key"""
    shaft_depth: Annotated[Length | None, Known("DIN 6885-1", "3 mm")] = None
    """depth of the keyway in the shaft"""
    chamfer: Annotated[Length | None, Known("DIN 6885-1", "0.4 mm")] = None
    """chamfer of the edges of the key"""
    form: Annotated[Literal["A", "B"], Known("DIN 6885-1; drawing")] = "A"
    """A with round ends, B with square ends"""
    material: Annotated[MadeOf | None, Known("drawing; C45 is usual", "c45")] = None
    application_factor: Annotated[
        float, In(at_least=1, at_most=10), Known("DIN 3990; own choice")
    ] = 1.5
    """K_A on the solved torque, for impact where it reverses"""
    source: TableSource = NO_SOURCE


class KeyFlanks(NamedTuple):
    """Flanks of a key that transmit torque, m: width b, bearing length l_tr, height in hub and in
    shaft.
    """

    width: float
    length: float
    hub_height: float
    shaft_height: float


EFFECTIVE_LENGTH = 1.3
"""Bearing length of a key over the shaft diameter, at most: DIN 6892 (recalled, verify)."""


Process = Literal["ground", "milled", "cut"]
WAVES: Mapping[str, float] = MappingProxyType({"ground": 0.8e-3, "milled": 3e-3, "cut": 8e-3})
"""Height of the waves of a track over their length, crest to trough, by process: 4, 15 and 40 um at
5 mm, workshop practice, recalled: verify. cut: by laser, plasma or flame."""


@dataclass(frozen=True, kw_only=True)
class BalanceHole(Part):
    """Request for a hole through the cam that removes its unbalance."""

    table: ClassVar[str] = "cam.counter_hole"

    wall: Annotated[Length, Known("own choice")] = 0.003
    """least wall between the hole and contour, bore or keyway"""


Closure = Literal["spring", "gravity", "groove", "conjugate", "yoke"]
TWO_TRACKS = ("groove", "conjugate", "yoke")
"""Closures of a cam that pulls as well, each with a table of its own in [cam]."""
NARROWING = {"roller radius": 1, "second track": 0, "both contours": 1, "wear of the tracks": 0}
"""End, 0 for low or 1 for high, of what narrows the clearance at every cam angle, see
`CamBody.deviations`; the others narrow it at some angles and widen it at others."""
FitTolerance = Annotated[float, In("mm", at_least=0, at_most=1)]
_AS_DRAWN = "none: as drawn"
SECOND_BEARING = "cam.groove.second.bearing"
"""Table of the bearing of a second roller on the pin of the first."""


@dataclass(frozen=True, kw_only=True)
class GrooveRoller(Part):
    """Second roller on the pin of the first, which runs on the outer wall in a step of its own.

    The larger roller is in the upper step, at the face of the disc; of equal ones the first.
    """

    table: ClassVar[str] = "cam.groove.second"
    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("bearing", "roller_tolerance"), "that of the first roller"
    )
    source: TableSource = NO_SOURCE

    radius: Annotated[Length, Known("bearing catalogue", "21 mm")]
    """radius of the roller on the outer wall, which is like the first otherwise"""
    spacing: Annotated[Length, Known("drawing", "18.5 mm")]
    """distance of the middles of both rollers along their pin"""
    step_depth: Annotated[Length, Known("drawing", "18.5 mm")]
    """depth of the upper step of the groove, below the face of the disc"""
    relief: Annotated[float, In("mm", above=0, at_most=100), Known("drawing", "0.5 mm")]
    """gap between each roller and the wall opposite to that on which it runs"""
    undercut: Annotated[
        float, In("mm", at_least=0, at_most=100), Known("drawing, T-slot cutter", "0.5 mm")
    ] = 0.0
    """greatest depth by which the lower step may reach under the upper one, as that of equal
    rollers does: no cutter comes there from the face"""
    bearing: Annotated[Bearing | None, Used("checks of the second roller's bearing")] = None
    """bearing of the second roller; in the use of the first, where it states no other"""
    roller_tolerance: Annotated[FitTolerance | None, Known("drawing of the roller", "0.005 mm")] = (
        None
    )
    """tolerance of its radius, either way"""

    @property
    def roller(self) -> CoaxialRoller:
        """Second roller on the path of the first."""
        return CoaxialRoller(self.radius)

    def rim_distance(self, radius: Value) -> Value:
        """Distance, m, of the outer wall from the path where the rim that bears it is thinnest.

        At the face it presses above the relieved wall of the first roller, of a radius, m, which
        bears the rim at the floor; below, that of the larger first roller is above it, unloaded.
        """
        relieved = np.maximum(self.radius, radius + self.relief)
        return np.where(self.radius > radius, relieved, self.radius)

    def under(self, radius: Value, clearance: Value) -> Value:
        """Depth, m, by which the relieved wall of the lower step is under the wall of the upper one
        that bears; not positive without an undercut.

        radius : of the first roller, m; clearance : of the groove, m
        """
        lower, upper = np.minimum(self.radius, radius), np.maximum(self.radius, radius)
        return lower + self.relief - (upper + 0.5 * clearance)

    def beyond(self, radius: Value) -> Value:
        """Distance by which it is farther into the groove than the first roller, of a radius, m."""
        return np.where(self.radius > radius, -self.spacing, self.spacing)


@dataclass(frozen=True, kw_only=True)
class CamGroove(Part):
    """Groove in the face of a disc, in which the roller runs between two walls."""

    table: ClassVar[str] = "cam.groove"
    defaults: ClassVar[Mapping[str, str]] = {
        "roller_tolerance": _AS_DRAWN,
        "wear_depth": _AS_DRAWN,
        "second": "none: one roller runs on both walls",
    }
    source: TableSource = NO_SOURCE

    clearance: Annotated[
        float, In("mm", above=0, at_most=1), Known("drawing, tolerance chain", "0.02 mm")
    ]
    """width of the groove less the diameter of the roller; of two rollers the play of their pin"""
    depth: Annotated[Length, Known("drawing", "12 mm")]
    """depth of the groove along the shaft"""
    corner_radius: Annotated[float, In("mm", at_least=0, at_most=100), Known("cutter", "1 mm")] = (
        0.0
    )
    """fillet between the walls and the floor of the groove"""
    outer_radius: Annotated[Length, Known("drawing", "100 mm")]
    """radius of the disc around the groove"""
    second: Annotated[GrooveRoller | None, Used("cycle, checks of both walls, workshop files")] = (
        None
    )
    """second roller on the same pin, for the outer wall alone"""
    roller_tolerance: Annotated[FitTolerance | None, Known("drawing of the roller", "0.005 mm")] = (
        None
    )
    """tolerance of the radius of the roller, either way"""
    wear_depth: Annotated[FitTolerance | None, Known("own choice, or measured", "0.01 mm")] = None
    """depth that each wall loses with the roller until it is replaced"""

    def middle(self, radius: Value, width: Value, second: GrooveRoller | None) -> Value:
        """Depth of the middle of the first roller below the face of the disc, m: with a roller
        above the fillet of the floor.

        radius, width : of the roller, m; second : that on the same pin, if any
        """
        lowest: Value = self.depth - self.corner_radius - 0.5 * width
        if second is None:
            return lowest
        return np.minimum(lowest, lowest - second.beyond(radius))

    def carrying(self, radius: float) -> tuple[float, float]:
        """Distances, m, of the inner and the outer wall from the path of the rollers.

        radius : of the roller on the inner wall, m
        """
        outer = radius if self.second is None else self.second.radius
        return radius + 0.5 * self.clearance, outer + 0.5 * self.clearance

    def steps(self, radius: float) -> tuple[GrooveStep, ...]:
        """Steps of the groove from the face of the disc down, of one roller one.

        radius : of the roller, m, of two that on the inner wall
        """
        (on_inner, on_outer), second = self.carrying(radius), self.second
        if second is None:
            return (GrooveStep(0.0, self.depth, on_inner, on_outer),)
        inner = on_inner, radius + second.relief
        outer = second.radius + second.relief, on_outer
        upper, lower = (outer, inner) if second.radius > radius else (inner, outer)
        middle = second.step_depth
        return GrooveStep(0.0, middle, *upper), GrooveStep(middle, self.depth, *lower)


@dataclass(frozen=True, kw_only=True)
class CamConjugate(Part):
    """Second disc on the same shaft, and its roller on the same stem or arm, which pull it back."""

    table: ClassVar[str] = "cam.conjugate"
    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        (
            "roller_tolerance",
            "place_tolerance",
            "centre_tolerance",
            "turn_tolerance",
            "wear_depth",
        ),
        _AS_DRAWN,
    )
    source: TableSource = NO_SOURCE

    roller_radius: Annotated[Length, Known("drawing", "15 mm")]
    """radius of the second roller, which is like the first otherwise"""
    distance: Annotated[Length | None, Used("contour, cycle"), Known("drawing", "120 mm")] = None
    """of a stem: between the centres of the opposite rollers"""
    arm_length: Annotated[Length | None, Used("contour, cycle"), Known("drawing", "60 mm")] = None
    """of an arm: length of its second arm, from the pivot to the roller centre"""
    arm_angle: Annotated[
        float | None, In("deg", above=0, below=360), Known("drawing", "80 deg")
    ] = None
    """of an arm: angle between both arms, across the line of centres"""
    clearance: Annotated[
        float | None, In("mm", above=0, at_most=1), Known("drawing, tolerance chain", "0.02 mm")
    ] = None
    """between the second disc and its roller while the first presses"""
    interference: Annotated[
        float | None, In("mm", above=0, at_most=1), Known("drawing, adjusted", "0.02 mm")
    ] = None
    """in place of a clearance: of the second disc with its roller, which loads both"""
    spacing: Annotated[Length, Known("drawing", "20 mm")]
    """of the second disc from the first along the shaft, between their middles, away from bearing
    1"""
    roller_tolerance: Annotated[
        FitTolerance | None, Known("drawing of the rollers", "0.005 mm")
    ] = None
    """tolerance of the radius of each roller, either way"""
    place_tolerance: Annotated[FitTolerance | None, Known("drawing", "0.005 mm")] = None
    """tolerance of the place of the second roller along its travel, either way: of `distance`, or
    of the angle between the arms"""
    centre_tolerance: Annotated[FitTolerance | None, Known("drawing", "0.005 mm")] = None
    """of an arm: tolerance of the distance of its pivot from the cam axis, either way"""
    turn_tolerance: Annotated[
        float | None, In("deg", at_least=0, at_most=5), Known("drawing", "0.02 deg")
    ] = None
    """tolerance of the angle of the second disc against the first, either way"""
    wear_depth: Annotated[FitTolerance | None, Known("own choice, or measured", "0.01 mm")] = None
    """depth that each disc loses with its roller until they are replaced"""

    @property
    def gap(self) -> float:
        """Clearance of the second roller, m, or its interference below zero."""
        return (self.clearance or 0.0) - (self.interference or 0.0)

    @property
    def roller(self) -> SecondFollower:
        """Second roller on its stem or arm.

        Raises
        ------
        InputError
            If neither is described.
        """
        if self.arm_length is not None and self.arm_angle is not None:
            return ConjugateArm(self.arm_length, self.arm_angle, self.roller_radius)
        if self.distance is not None:
            return OppositeRoller(self.distance, self.roller_radius)
        raise InputError("cam.conjugate.distance", "missing", "given for the second roller")


@dataclass(frozen=True, kw_only=True)
class CamYoke(Part):
    """Second face of the follower, parallel to the first on the other side of the cam."""

    table: ClassVar[str] = "cam.yoke"
    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("place_tolerance", "wear_depth"), _AS_DRAWN
    )
    source: TableSource = NO_SOURCE

    clearance: Annotated[
        float, In("mm", above=0, at_most=1), Known("drawing, tolerance chain", "0.05 mm")
    ]
    """distance of the faces less the greatest breadth of the cam"""
    place_tolerance: Annotated[FitTolerance | None, Known("drawing", "0.01 mm")] = None
    """tolerance of the distance of the faces, either way"""
    wear_depth: Annotated[FitTolerance | None, Known("own choice, or measured", "0.01 mm")] = None
    """depth that the cam loses with each face until they are replaced"""


@dataclass(frozen=True, kw_only=True)
class CamBody(Part):
    """The cam disc."""

    table: ClassVar[str] = "cam"
    width_key: ClassVar[str] = "cam.width"
    defaults: ClassVar[Mapping[str, str]] = {
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
        "waviness_height": "of the process at the wavelength, within the profile tolerance",
        "groove": "another closure",
        "conjugate": "another closure",
        "yoke": "another closure",
    }

    closure: Annotated[Closure, Known("own choice", "groove")] = "spring"
    """what keeps the follower on the cam: the force of a spring, the weight of the follower, the
    outer wall of a groove, the second disc of a conjugate pair, or the faces of a yoke"""
    groove: Annotated[CamGroove | None, Used("contour, cycle, checks of the groove")] = None
    """groove of a roller, with `closure` groove"""
    conjugate: Annotated[CamConjugate | None, Used("contour, cycle, checks of both discs")] = None
    """second disc and its roller, with `closure` conjugate"""
    yoke: Annotated[CamYoke | None, Used("cycle, checks of both faces")] = None
    """second face on the other side of the cam, with `closure` yoke"""
    prime_radius: Annotated[Length, Known("drawing, or own choice", "60 mm")]
    """base circle radius plus roller radius; of a flat face the base circle radius"""
    offset: Annotated[float, In("mm", above=-10_000, below=10_000), Known("drawing")] = 0.0
    """distance of the follower axis from the cam axis"""
    width: Annotated[Length, Known("drawing", "10 mm")]
    """width of the disc along the shaft"""
    bore_radius: Annotated[Length, Known("drawing", "8.5 mm")]
    """half of the bore diameter"""
    material: Annotated[MadeOf, Known("drawing", "case_hardened")]
    keyway: Annotated[Keyway | None, Used("contour, meshes, checks of the key")] = None
    """keyway in the bore"""
    key: Annotated[ParallelKey | None, Used("checks of the key")] = None
    """parallel key of the cam"""
    fit: Annotated[
        SeatFit | None,
        Used("slip of the seat, pressure and stress of the bore, stress at the keyway's root"),
    ] = None
    """press or sliding fit of the cam on its shaft"""
    roughness: Annotated[
        float | None, In("um", above=0, at_most=1000), Known("drawing or measured", "0.3 um")
    ] = None
    """rms roughness Rq of the track, 1.1 to 1.25 Ra"""
    profile_tolerance: Annotated[float, In("mm", above=0, at_most=10), Known("drawing")] = 1e-4
    """width of the line profile tolerance, ISO 1101"""
    process: Annotated[Process, Known("drawing")] = "ground"
    """last process of the track, which sets the height of its waves; cut: by laser, plasma or
    flame"""
    waviness_length: Annotated[Length, Known("measured; the machine")] = 0.005
    """wavelength of the waviness of the track"""
    waviness_height: Annotated[Length | None, Known("measured", "2 um")] = None
    """height of the waves from crest to trough"""
    end: Annotated[BodyEnd | None, Used("contact of finite length")] = None
    """ends of the cam's track; without them the pressure at the ends of the contact is not
    evaluated"""
    crown: Annotated[AxialCrown | None, Used("contact of finite length")] = None
    """crown of the cam's track along the axis; added to that of the follower"""
    counter_hole: Annotated[BalanceHole | None, Used("unbalance, meshes, workshop files")] = None
    """hole through the cam that removes its unbalance"""
    source: TableSource = NO_SOURCE

    @property
    def line_width(self) -> float:
        """Maximum width of the line contact, m: without the ends."""
        return flat_width(self.width, self.end)

    @property
    def pulls(self) -> bool:
        """Whether the cam pulls the follower as well, so that no force need close the contact."""
        return self.closure in TWO_TRACKS

    @property
    def _two_tracks(self) -> CamGroove | CamConjugate | CamYoke | None:
        """Groove, second disc or yoke; None of one track."""
        return self.groove or self.conjugate or self.yoke

    @property
    def closed_by(self) -> tuple[str, ...]:
        """Kinds of closure to which it belongs, see `Declaration.closed_by`."""
        force = "form" if self.pulls else "force"
        if self.on_pin is not None:
            return self.closure, force, "rollers"
        if self.conjugate is not None and self.conjugate.interference is not None:
            return self.closure, force, "plate", "preload"
        return (self.closure, force) if self.groove is not None else (self.closure, force, "plate")

    @property
    def second(self) -> SecondFollower | None:
        """Second roller, on a disc or an outer wall of its own, or face; None without one."""
        if self.yoke is not None:
            return OppositeFace()
        if self.on_pin is not None:
            return self.on_pin.roller
        return None if self.conjugate is None else self.conjugate.roller

    @property
    def on_pin(self) -> GrooveRoller | None:
        """Second roller on the pin of the first; None without one."""
        return None if self.groove is None else self.groove.second

    @property
    def spacing(self) -> float | None:
        """Of a second disc from the first along the shaft, m; None of one disc."""
        return None if self.conjugate is None else self.conjugate.spacing

    @property
    def clearance(self) -> float:
        """Clearance of the follower between both tracks, square to them, m; 0 of one track."""
        stated = self._two_tracks
        return 0.0 if stated is None else stated.clearance or 0.0

    @property
    def deviations(self) -> Mapping[str, Mapping[str, tuple[float, float]]]:
        """Least and greatest of fields of `TrackDeviation` by what varies them together, SI.

        Two rollers on a pin are both greatest where they close the clearance most, and both least
        where they open it. Of an interference the tolerance of the contours is left out: its checks
        have it.
        """
        stated = self._two_tracks
        half = 0.5 * self.profile_tolerance if self.clearance > 0.0 else 0.0
        named = {
            "roller radius": ("rollers", "roller_tolerance"),
            "second track": ("apart", "place_tolerance"),
            "centre distance": ("centre", "centre_tolerance"),
            "phase of the discs": ("turn", "turn_tolerance"),
        }
        either = {
            label: {field: getattr(stated, key, None) or 0.0}
            for label, (field, key) in named.items()
        } | {"both contours": {"tracks": half}}
        if self.on_pin is not None and self.on_pin.roller_tolerance is not None:
            first = either["roller radius"]
            first["second_roller"] = self.on_pin.roller_tolerance - first["rollers"]
        ranges = {
            label: {field: (-most, most) for field, most in moved.items()}
            for label, moved in either.items()
        }
        return ranges | {"wear of the tracks": {"wear_depth": (0.0, self.wear_depth)}}

    @property
    def wear_depth(self) -> float:
        """Depth that each of two tracks loses with its roller, m."""
        stated = self._two_tracks
        return 0.0 if stated is None else stated.wear_depth or 0.0

    @property
    def held_radius(self) -> float:
        """Maximum radius of the held surface, m: bore and keyway."""
        return self.bore_radius + (0.0 if self.keyway is None else self.keyway.depth)

    @property
    def key_data(self) -> Mapping[str, float | None]:
        """Length, height, shaft depth and chamfer of the key, m, standard ones filled in.

        None: not stated, and of no standard width.
        """
        key, row = self.key or ParallelKey(), self._standard_key
        return {
            "length": key.length,
            "height": key.height or (row and row.height),
            "shaft_depth": key.shaft_depth or (row and row.shaft_depth),
            "chamfer": key.chamfer or (row and row.chamfer),
        }

    @property
    def key_corner(self) -> float | None:
        """Chamfer of the key, m: as stated, else the least of its standard; None without either."""
        row = self._standard_key
        stated = None if self.key is None else self.key.chamfer
        return stated or (row and row.least_chamfer)

    @property
    def keyway_root_radius(self) -> float | None:
        """Fillet radius at the root of the keyway, m; None without one or without a datum."""
        row = self._standard_key
        stated = None if self.keyway is None else self.keyway.root_radius
        return stated or (row and row.fillet)

    @property
    def _standard_key(self) -> StandardKey | None:
        width = 0.0 if self.keyway is None else self.keyway.width
        return next(
            (row for b, row in STANDARD_KEYS.items() if abs(b * _MILLIMETRE - width) < 1e-6), None
        )

    @property
    def key_flanks(self) -> KeyFlanks | None:
        """Flanks of the key that transmit torque; None without a key, a keyway or a measure of the
        key.

        The bearing length is at most the width of the cam and 1.3 shaft diameters.

        References
        ----------
        DIN 6892: bearing length without round ends, heights without the chamfer (recalled, verify).
        """
        data = self.key_data
        length, height, depth, chamfer = (
            data[name] for name in ("length", "height", "shaft_depth", "chamfer")
        )
        if self.key is None or self.keyway is None:
            return None
        if length is None or height is None or depth is None or chamfer is None:
            return None
        ends = self.keyway.width if self.key.form == "A" else 0.0
        return KeyFlanks(
            self.keyway.width,
            min(length - ends, self.width, EFFECTIVE_LENGTH * 2.0 * self.bore_radius),
            min(height - depth, self.keyway.depth) - chamfer,
            depth - chamfer,
        )

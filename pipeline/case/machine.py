"""`Machine`: parts and loads of a case in one load case, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.track_deviation import EXACT, TrackDeviation
from camwright.pipeline.base import units
from camwright.pipeline.base.cooling import Cooling
from camwright.pipeline.base.external_force import ExternalForce
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.external_load import external_force
from camwright.pipeline.case.limits import (
    OVERSPEED,
    SPEED_REDUCTION,
    TORQUE_REDUCTION,
    AnyLimit,
    Limits,
)
from camwright.pipeline.case.requirements_section import OVER_SPEED, STANDSTILL, LoadCase
from camwright.pipeline.case.scope_section import (
    OF_ARM,
    OF_STEM,
    ROCKER,
    PartName,
    Scope,
    ScopeName,
)
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd
from camwright.pipeline.contact.cam_body import CamBody, CamConjugate, GrooveRoller
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length.axial_drop import (
    BodyCrown,
    Crown,
    CrownPlace,
    FiniteBody,
    FinitePair,
    Straight,
    SummedCrown,
    TabulatedCrown,
    crown_of,
)
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.contact.oil_film import Lubricant
from camwright.pipeline.engine.crankshaft import Crankshaft
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.arm_beam import ArmBar
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.disc_preload import Compliances, DiscPreload
from camwright.pipeline.follower.flat_face import FollowerFace
from camwright.pipeline.follower.follower_forces import FollowerSystem
from camwright.pipeline.follower.follower_kind import FollowerKind
from camwright.pipeline.follower.follower_stiffness import (
    in_series,
    shaft_between,
    shaft_compliance,
    stem_compliance_along,
)
from camwright.pipeline.follower.follower_tilt import FollowerTilt, StemTilt, arm_tilt
from camwright.pipeline.follower.guide_friction import FrictionRange
from camwright.pipeline.follower.guide_reactions import GuidePair
from camwright.pipeline.follower.pivot import Pivot
from camwright.pipeline.follower.pivot_forces import FRICTION, ArmPivot
from camwright.pipeline.follower.rocker import Rocker, RockerOutput
from camwright.pipeline.follower.roller import Roller, on_second_track
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.stem_beam import Stem
from camwright.pipeline.torque.period import Period
from camwright.pipeline.torque.torque import Torque

_UNLOADED = {
    "torque": None,
    "intake_pressure": None,
    "fired": True,
    "ripple_weight": 0.0,
    TORQUE_REDUCTION.id: None,
    SPEED_REDUCTION.id: None,
    "source": "every case is judged at standstill and over-speed",
}
NO_TORQUES: Mapping[str, Torque] = MappingProxyType({})
# Greatest depth of a body under the contact, over the length of contact.
_DEPTH_OVER_LENGTH = 2.0
# Crank speed of a load case at rest, rad/s: inertia, film and heat are negligible.
CREEP = 1e-3
_MOST_REBOUND = 0.999  # of a follower without damping, which else never came to rest


@dataclass(frozen=True)
class Corner:
    """Tolerance corner: factors on nominal values; phase, rad of crank; profile error, m;
    deviations that change the clearance between two tracks, see `TrackDeviation`.
    """

    name: str
    friction_a: float = 1.0
    friction_b: float = 1.0
    rate: float = 1.0
    preload: float = 1.0
    mass: float = 1.0
    inertia: float = 1.0
    phase: float = 0.0
    profile: float = 0.0
    tracks: float = 0.0
    rollers: float = 0.0
    second_roller: float = 0.0
    apart: float = 0.0
    centre: float = 0.0
    turn: float = 0.0
    wear_depth: float = 0.0

    @property
    def deviation(self) -> TrackDeviation:
        """Deviations of a follower between two tracks."""
        return TrackDeviation(
            **{each.name: getattr(self, each.name) for each in fields(TrackDeviation)}
        )


@dataclass(frozen=True, repr=False)
class Machine(Displayed):
    """Parts, loads and limits of one load case, SI.

    Parameters
    ----------
    load_case : str
    speed : float              of the crank, rad/s, >= 0; 0: at rest
    period : Period            cycle of the machine, and shaft turns per cam turn
    ripple_weight : float      weight of its torque ripple in the synthesis
    torque_reduction, speed_reduction : float   required of the ripple; None: none is required
    duty : float               share of the operating time; None: not known
    cam : CamBody
    follower : FollowerKind    the part that touches the cam, roller or face
    cam_drops, follower_drops : TabulatedCrown   of their crowns by a table; None: of no table
    mass : float               that moves with the follower, kg, spring_mass of it of the spring
    viscous_damping : float    of the guides, N s/m
    gravity_along_axis : float component of g towards the cam, m/s2
    external : ExternalForce   on the follower
    stem : Stem
    overhang_at_max_lift : float    guide A to roller centre or face, m
    stiffness : float          from cam to follower mass, N/m; None: of the members described
    damping_ratio : float      of the elastic stem
    restitution : float        of a landing between two tracks; None: by the damping ratio
    guides : GuidePair
    friction : FrictionRange   of both guides
    spring : Spring            with the preload of this load case
    camshaft, crankshaft, lubricant : or None   None: not described
    limits : Limits
    scope : Scope              parts that the sign-off covers
    torque : Torque            of the engine at `speed`, over a cam turn; None: without one, or not
                               stated, where the parts alone are needed
    arm : FollowerArm          that carries the follower; None: the stem in its guides does, which
                               an arm has without mass, friction and clearance
    pivot : Pivot              of the arm, whose friction is then that of `friction`; None: left out
    deviation : TrackDeviation of a follower between two tracks
    """

    load_case: str
    speed: float
    period: Period
    ripple_weight: float
    torque_reduction: float | None
    speed_reduction: float | None
    duty: float | None
    cam: CamBody
    follower: FollowerKind
    cam_drops: TabulatedCrown | None
    follower_drops: TabulatedCrown | None
    mass: float
    spring_mass: float
    viscous_damping: float
    gravity_along_axis: float
    external: ExternalForce
    stem: Stem
    overhang_at_max_lift: float
    stiffness: float | None
    damping_ratio: float
    guides: GuidePair
    friction: FrictionRange
    spring: Spring
    camshaft: Camshaft | None
    crankshaft: Crankshaft | None
    lubricant: Lubricant | None
    cooling: Cooling
    limits: Limits
    scope: Scope
    torque: Torque | None = field(default=None, compare=False)
    arm: FollowerArm | None = None
    pivot: Pivot | None = None
    output: RockerOutput | None = None
    deviation: TrackDeviation = EXACT
    rocker: Rocker | None = None
    restitution: float | None = None

    @property
    def rebound_share(self) -> float:
        """Speed of the follower off a track over that of its landing, < 1.

        Of an elastic follower the half-period of its damped oscillation, exp(-pi z/sqrt(1 - z^2)).
        """
        if self.restitution is not None:
            return self.restitution
        damped = self.damping_ratio / np.sqrt(1.0 - self.damping_ratio**2)
        return float(min(np.exp(-np.pi * damped), _MOST_REBOUND))

    @property
    def crank_speed(self) -> float:
        """rad/s, > 0 also at rest."""
        return max(self.speed, CREEP)

    @property
    def gear_ratio(self) -> float:
        """Shaft turns per cam turn."""
        return self.period.ratio

    @property
    def cam_speed(self) -> float:
        """rad/s."""
        return self.crank_speed / self.gear_ratio

    @property
    def roller(self) -> Roller:
        """Roller of the follower; refused for a face.

        Raises
        ------
        InputError
            If it is another.
        """
        if isinstance(self.follower, Roller):
            return self.follower
        raise InputError("roller", "missing", "given for its checks")

    @property
    def face(self) -> FollowerFace:
        """Face of the follower; refused for a roller.

        Raises
        ------
        InputError
            If it is another.
        """
        if isinstance(self.follower, FollowerFace):
            return self.follower
        raise InputError("follower.face", "missing", "given for its checks")

    def describes(self, part: PartName) -> bool:
        """Whether the case describes a part of the machine."""
        shaft = self.camshaft
        described: Mapping[str, object] = {
            **self.follower.parts,
            **self.spring.parts,
            "arm": self.arm if self.arm is not None and self.arm.is_described else None,
            "rocker": self.rocker if self.rocker is not None and self.rocker.is_described else None,
            "guides": self.guides,
            "camshaft": shaft,
            "camshaft_bearings": shaft and (shaft.bearing_rating or shaft.bearing_static_rating),
            "key": self.cam.keyway,
            "gear": shaft and shaft.gear,
            "pivot": self.pivot,
        }
        return described.get(part) is not None

    @property
    def carrier(self) -> Literal["stem", "arm"]:
        """What carries the roller or face."""
        return "stem" if self.arm is None else "arm"

    @property
    def absent(self) -> tuple[ScopeName, ...]:
        """What a follower on a stem, or on an arm with or without a second one, does not have."""
        if self.arm is None:
            return OF_ARM
        return OF_STEM if self.rocker is not None else (*OF_STEM, ROCKER)

    @property
    def arm_bar(self) -> ArmBar | None:
        """Arm as a beam, the first of two; None of a stem, and of an arm that is not described."""
        return next(iter(self.arm_bars), None)

    @property
    def arm_bars(self) -> tuple[ArmBar, ...]:
        """Each arm as a beam; () where it is not described."""
        output, pair = 0.0 if self.output is None else self.output.reduced_mass, self.cam.conjugate
        length = None if pair is None else pair.arm_length
        return ArmBar.each(
            *(self.arm, self.follower, self.mass - output, self.spring.link),
            None if length is None else (length, on_second_track(self.roller, self.cam)),
        )

    @property
    def tilting(self) -> FollowerTilt:
        """Compliance and clearance by which the follower tilts in the plane of contact normal and
        cam axis: of the stem in its guides, or of an arm and its pivot where one of them is
        described.
        """
        bush = None if self.pivot is None else self.pivot.bush
        of_arm = None if self.arm is None else arm_tilt(self.arm, self.arm_bar, bush)
        return StemTilt(self.stem, self.guides) if of_arm is None else of_arm

    @property
    def contact_width(self) -> float:
        """Width of the line contact, m: the overlap of the flats of cam and follower."""
        low, high = self._overlap
        return high - low

    @property
    def contact_modulus(self) -> float:
        """E* of the contact, Pa."""
        cam, other = self.cam.material, self.follower.material
        return contact_modulus(cam.E, cam.nu, other.E, other.nu)

    @property
    def _axial_offset(self) -> float:
        return self.follower.axial_offset or 0.0

    @property
    def _overlap(self) -> tuple[float, float]:
        """Ends of the line contact, m, from the middle of the cam."""
        cam, other = 0.5 * self.cam.line_width, 0.5 * self.follower.line_width
        return max(-cam, self._axial_offset - other), min(cam, self._axial_offset + other)

    @property
    def stem_offset(self) -> float:
        """Distance of the middle of the line contact from the stem axis, m."""
        low, high = self._overlap
        return abs(0.5 * (low + high) - self._axial_offset)

    @property
    def is_crowned(self) -> bool:
        """Whether cam or follower has a crown."""
        return self.cam.crown is not None or self.follower.crown is not None

    @property
    def finite_pairs(self) -> tuple[FinitePair, ...]:
        """Contacts of finite length: one, or one for each end at an axial offset.

        Empty where the case lacks an end. The curvature is that of the base circle.

        Raises
        ------
        InputError
            If a crown does not fit the contact.
        """
        parts: tuple[CamBody | FollowerKind, ...] = (self.cam, self.follower)
        if any(part.end is None for part in parts):
            return ()
        low, high = self._overlap
        length, offset = high - low, self._axial_offset
        depths = self.base_radius - self.cam.held_radius, self.follower.body_depth
        pairs = []
        for side in (-1, 1) if offset else (1,):
            reach = high if side > 0 else -low
            bodies = []
            for part, depth, middle in zip(parts, depths, (0.0, offset), strict=True):
                end = replace(part.end or BodyEnd(), source=NO_SOURCE)
                overhang = 0.5 * part.line_width + side * middle - reach
                whole = length + 2.0 * (overhang + end.size)
                material = Elastic(part.material.E, part.material.nu)
                bodies.append(
                    FiniteBody(material, whole, end, min(depth, _DEPTH_OVER_LENGTH * length))
                )
            crown = self._crown(0.5 * (low + high), side)
            pairs.append(FinitePair((bodies[0], bodies[1]), self._base_curvature, crown))
        return tuple(pairs)

    def with_second_in_place(self, contour: Contour) -> Machine:
        """The machine with the bodies of the second disc and its roller in place of the first;
        contour : of the first disc. Itself without a second disc.
        """
        second = self.cam.second
        if second is None or not second.own_disc:
            return self
        least = float(second.track(contour.pitch).contour.radius_min().value)
        roller = on_second_track(self.roller, self.cam)
        cam = replace(self.cam, prime_radius=least + second.radius)
        return replace(self, follower=roller, cam=cam)

    @property
    def _base_curvature(self) -> float:
        """1/R of the base circle and the follower, 1/m."""
        radius = self.follower.contact_radius
        return 1.0 / self.base_radius + (0.0 if radius is None else 1.0 / radius)

    @property
    def crowns(self) -> dict[str, BodyCrown]:
        """Crowns of both bodies by name, each about its own middle.

        Raises
        ------
        InputError
            If a crown does not fit the contact.
        """
        radius = self.follower.contact_radius
        place = CrownPlace(
            length=self.contact_width,
            curvature=self._base_curvature,
            modulus=self.contact_modulus,
            diameter=None if radius is None else 2.0 * radius,
        )
        shapes = {
            "cam": (self.cam.crown, self.cam_drops),
            self.follower.word: (self.follower.crown, self.follower_drops),
        }
        if self._axial_offset:
            for word, (shape, drops) in shapes.items():
                if shape is not None and drops is not None and not drops.is_symmetric:
                    limit = "a drop alike on both sides at an axial offset"
                    raise InputError(f"{word}.crown.file", shape.file, limit)
        return {
            word: crown_of(shape, place, drops)
            for word, (shape, drops) in shapes.items()
            if shape is not None
        }

    def _crown(self, middle: float, side: int) -> Crown:
        """Crowns of both bodies about the middle of the contact, m from that of the cam."""
        crowns = tuple(
            (crown, (0.0 if word == "cam" else self._axial_offset) - middle)
            for word, crown in self.crowns.items()
        )
        return SummedCrown(crowns, side) if crowns else Straight()

    @property
    def base_radius(self) -> float:
        """Radius of the base circle, m."""
        return self.cam.prime_radius - (self.follower.contact_radius or 0.0)

    @property
    def bodies(self) -> dict[str, Material]:
        """Materials of the two bodies in contact: the cam, and the roller or face."""
        return {"cam": self.cam.material, self.follower.word: self.follower.material}

    @property
    def compliances(self) -> dict[str, float]:
        """Compliances, m/N, by name, of the members between cam and the mass of the follower that
        are described, along the travel.

        The stem counts to its far guide; an arm bends with its fork, on the bush of its pivot. The
        line contact and the cam, an arm that is not described and needles are taken as rigid.
        """
        return self._compliances_to(None)

    def _compliances_to(self, pair: CamConjugate | None) -> dict[str, float]:
        """As `compliances`, of the second disc of a pair along the travel of its own roller, with
        the second arm, or the stem on to that roller; None: of the first.
        """
        parts, held = self.follower.elastic(self.contact_width, self.spring.preload)
        reach, bars = self.overhang_at_max_lift + self.guides.spacing - held, self.arm_bars
        beyond, spacing = (0.0, 0.0) if pair is None else (pair.distance or 0.0, pair.spacing)
        members = {
            **parts,
            **({"fork": None, "arm": bars[0 if pair is None else 1].compliance} if bars else {}),
            "pivot": self._pivot_compliance(sprung=pair is None),
            "stem": stem_compliance_along(self.stem, reach + beyond) if self.arm is None else None,
            "camshaft": None if self.camshaft is None else shaft_compliance(self.camshaft, spacing),
        }
        return {name: each for name, each in members.items() if each is not None}

    def _pivot_compliance(self, *, sprung: bool) -> float | None:
        """Compliance of the bush of the pivot, m/N, reduced to the end of an arm, on which the
        spring acts or not; None without a bush.
        """
        if self.arm is None or self.pivot is None or self.pivot.bush is None:
            return None
        held = float(self.arm.held(self.spring.link)) if sprung else 0.0
        bush, share = self.pivot.bush, self.arm.pivot_share(held)
        return share**2 / (bush.foundation_modulus * bush.length)

    @property
    def track_stiffnesses(self) -> tuple[float, ...]:
        """Stiffness from each disc, or wall with a roller of its own, to the follower mass along
        the travel of the first roller, N/m: stated, else members in series.
        """
        pair, on_pin = self.cam.conjugate, self.cam.on_pin
        if self.stiffness is not None:
            one = pair is None and on_pin is None
            return (self.stiffness,) if one else (self.stiffness, self.stiffness)
        first = in_series(self.compliances.values())
        if on_pin is not None:
            return first, in_series(self._at_second_of_pin(on_pin).compliances.values())
        if pair is None:
            return (first,)
        return first, in_series(self._compliances_to(pair).values()) / self._leverage**2

    def _at_second_of_pin(self, second: GrooveRoller) -> Machine:
        """Machine with the first roller at the place of a second on its pin."""
        roller = self.roller
        if roller.pin is None:
            return self
        span = roller.pin.span + float(second.beyond(roller.radius))
        return replace(self, follower=replace(roller, pin=replace(roller.pin, span=span)))

    @property
    def _leverage(self) -> float:
        """Force along the travel of the second roller over that of the first; 1 of a stem."""
        pair = self.cam.conjugate
        if self.arm is None or pair is None or pair.arm_length is None:
            return 1.0
        return self.arm.length / pair.arm_length

    @property
    def axial_stiffness(self) -> float:
        """Stiffness from cam to follower mass, N/m: stated, else members in series; of two discs
        that of the softer track.
        """
        return min(self.track_stiffnesses)

    @property
    def follower_frequency(self) -> float:
        """Natural frequency of the mass on stem and spring, the cam held, rad/s."""
        stiffness = self.axial_stiffness + self.spring.rate
        return float(np.sqrt(stiffness / self.mass_without_spring))

    @property
    def friction_keys(self) -> tuple[str, str]:
        """Dotted keys of the two coefficients of `friction`."""
        return ("guides.a.friction" if self.pivot is None else FRICTION), "guides.b.friction"

    @property
    def guide_friction(self) -> FrictionRange:
        """Friction of both guides: none of those in place of an arm's pivot."""
        return self.friction if self.pivot is None else FrictionRange(*((0.0, 0.0),) * 3)

    @property
    def arm_pivot(self) -> ArmPivot | None:
        """Pivot of the arm with what acts about it; None without one."""
        if self.arm is None or self.pivot is None:
            return None
        prime, offset = self.cam.prime_radius, self.follower.offset
        pivot = self.pivot.about(self.arm, self.mass, prime, offset, self.output)
        return replace(pivot, friction=self.friction.nominal[0], spring=self.spring.shape)

    @property
    def system(self) -> FollowerSystem:
        """Spring, mass, friction and external force of the follower."""
        guided = self.guide_friction.nominal
        return FollowerSystem(
            mass=self.mass,
            spring=self.spring,
            guide_spacing=self.guides.spacing,
            overhang_at_max_lift=self.overhang_at_max_lift,
            friction_a=guided[0],
            friction_b=guided[1],
            gravity_along_axis=self.gravity_along_axis,
            external=self.external,
            viscous_damping=self.viscous_damping,
            output=self.output,
            face_friction=self.follower.side_friction,
            pivot=self.arm_pivot,
            held=self.cam.pulls,
            second=self.cam.second,
            preload=self.disc_preload,
        )

    @property
    def disc_preload(self) -> DiscPreload | None:
        """Preload of conjugate discs by their interference; None of other cams."""
        pair = self.cam.conjugate
        if pair is None or pair.interference is None:
            return None
        return DiscPreload(pair.interference, self.roller_compliances, self.deviation)

    @property
    def roller_compliances(self) -> Compliances:
        """Compliances of both rollers of conjugate discs.

        On a stem those of roller, pin and fork, of the second with the stem between the rollers,
        which goes on there with its section: the stem beyond bears the axial force alone. On arms,
        and of a stated stiffness, those from each disc to the follower mass. The camshaft bends
        under both forces.

        Raises
        ------
        InputError
            If nothing of a roller is compliant.
        """
        pair = self.cam.conjugate
        if self.stiffness is not None:
            return Compliances(1.0 / self.stiffness, 1.0 / self.stiffness)
        if self.arm is None:
            parts, _ = self.follower.elastic(self.contact_width, self.spring.preload)
            first = sum(value for value in parts.values() if value is not None)
            distance = 0.0 if pair is None else pair.distance or 0.0
            second = first + stem_compliance_along(self.stem, distance)
        else:
            members = [self._compliances_to(one) for one in (None, pair)]
            first, second = (sum(each.values()) - each.get("camshaft", 0.0) for each in members)
        if not first > 0.0:
            raise InputError("follower.stiffness", "missing", "given with an interference")
        if self.camshaft is None or pair is None:
            return Compliances(first, second)
        discs = [shaft_compliance(self.camshaft, at) or 0.0 for at in (0.0, pair.spacing)]
        return Compliances(
            first, second, discs[0], shaft_between(self.camshaft, pair.spacing), discs[1]
        )

    def clearance_on(self, path: FollowerPath, theta: Array) -> Array:
        """Clearance of the follower between both tracks at cam angles (n,), rad, square to the
        second, m; `path` : of the first roller or face.

        Raises
        ------
        InputError
            If the tracks close in on the follower.
        """
        opened = self.deviation.opened(path, self.cam.second, theta)
        clearance = np.asarray(self.cam.clearance + opened)
        if not float(clearance.min()) >= 0.0:
            shown = units.shown(float(clearance.min()), "mm")
            raise InputError(f"cam.{self.cam.closure}.clearance", shown, ">= 0 mm at every angle")
        return clearance

    @property
    def mass_without_spring(self) -> float:
        """Mass of the follower without the spring's part, kg."""
        return self.mass - self.spring_mass

    def at_corner(self, corner: Corner) -> Machine:
        """Machine with the factors and the profile error of a tolerance corner; the contour is not
        part of it.
        """
        spring, shaft = self.spring, self.crankshaft
        rate = spring.rate * corner.rate
        # A profile deviation outwards compresses the spring by as much.
        preload = spring.preload * corner.preload + rate * corner.profile
        return replace(
            self,
            mass=self.mass * corner.mass,
            spring=replace(spring, rate=rate, preload=preload),
            friction=self.friction.scaled(corner.friction_a, corner.friction_b),
            pivot=self.pivot and self.pivot.with_mass(corner.mass),
            crankshaft=shaft and replace(shaft, inertia=shaft.inertia * corner.inertia),
            deviation=self.deviation.beside(corner.deviation),
        )


def machines(
    case: Case, torques: Mapping[str, Torque] = NO_TORQUES, deviation: TrackDeviation = EXACT
) -> tuple[Machine, ...]:
    """Machines of all judged load cases, the design load case first.

    Parameters
    ----------
    torques : mapping   engine torque by load case, such as of `engine_torques`
    deviation : TrackDeviation   of measured tracks
    """
    every = (machine(case, each, torques.get(each.name)) for each in judged_load_cases(case))
    return tuple(replace(each, deviation=deviation) for each in every)


def judged_load_cases(case: Case) -> tuple[LoadCase, ...]:
    """Load cases of the case, completed by standstill and over-speed.

    Lowest and highest running speed are those of the case. Standstill and over-speed are judged
    at every preload, without an engine torque; over-speed only where the case limits the speed.
    They have no share of a duty that the case states.
    """
    stated, over = case.load_cases, case.limits[OVERSPEED]
    duty = None if stated[0].duty is None else 0.0
    added = []
    for name, speed in ((STANDSTILL, 0.0), (OVER_SPEED, over)):
        if speed is None:
            continue
        known = {state.preload for state in stated if state.speed == speed}
        preloads = dict.fromkeys(state.preload for state in stated)
        for preload in preloads:
            if preload in known:
                continue
            label = name if len(preloads) == 1 else f"{name}-{list(preloads).index(preload) + 1}"
            state = {"name": label, "speed": speed, "preload": preload, "duty": duty} | _UNLOADED
            added.append(stated[0].model_copy(update=state))
    return (*stated, *added)


def machine(case: Case, state: LoadCase, torque: Torque | None = None) -> Machine:
    """Machine of a case in one load case: its parts, loads and limits.

    Parameters
    ----------
    case : Case        resolved
    state : LoadCase   speed, preload, requirements
    torque : Torque    at the shaft over a cam turn; None: no torque is balanced
    """
    follower, guides, spring = case.follower, case.guides, case.spring
    card = follower.stem_material
    length = np.inf if follower.stem_length is None else follower.stem_length
    stem = Stem(follower.stem_diameter, card.E, card.nu, length=length)
    return Machine(
        load_case=state.name,
        speed=state.speed,
        period=case.period,
        ripple_weight=state.ripple_weight,
        torque_reduction=_required(case, state, TORQUE_REDUCTION),
        speed_reduction=_required(case, state, SPEED_REDUCTION),
        duty=state.duty,
        cam=case.cam,
        follower=case.facing,
        cam_drops=_drops(case, case.cam.crown),
        follower_drops=_drops(case, case.facing.crown),
        mass=follower.mass,
        spring_mass=case.spring_mass,
        viscous_damping=follower.viscous_damping,
        gravity_along_axis=follower.gravity_along_axis,
        external=external_force(case),
        stem=stem,
        overhang_at_max_lift=follower.overhang_at_max_lift,
        stiffness=follower.stiffness,
        damping_ratio=follower.damping_ratio,
        guides=guides,
        friction=friction_range(case),
        spring=spring if state.preload is None else replace(spring, preload=state.preload),
        camshaft=case.camshaft,
        crankshaft=case.crankshaft,
        lubricant=case.lubricant,
        cooling=case.cooling,
        limits=case.limits,
        scope=case.scope,
        torque=torque,
        arm=follower.arm,
        pivot=follower.pivot,
        output=case.output,
        rocker=case.rocker,
        restitution=follower.restitution,
    )


def friction_range(case: Case) -> FrictionRange:
    """Least, nominal and greatest friction coefficient of guides A and B; of an arm on a pivot that
    of the pivot in place of A.
    """
    pivot, tolerance = case.follower.pivot, case.tolerances.friction
    if pivot is None:
        return FrictionRange.of(case.guides.a, case.guides.b, tolerance)
    return FrictionRange.of(pivot.bearing, case.guides.b, tolerance)


def _drops(case: Case, crown: AxialCrown | None) -> TabulatedCrown | None:
    """Table of a crown; None of a crown without one."""
    return (
        None if crown is None or crown.file is None else TabulatedCrown.read(case.path(crown.file))
    )


def _required(case: Case, state: LoadCase, row: AnyLimit) -> float | None:
    """Reduction of a ripple required in a load case, a share; None: none is required.

    A load case that states none has that of the case if its ripple counts in the synthesis; one
    that states 0 has none.

    Parameters
    ----------
    case : Case        with its limits
    state : LoadCase   the load case
    row : AnyLimit     limit of the reduction, of torque or speed
    """
    stated: float | None = getattr(state, row.id)
    if stated is None:
        return case.limits[row] if state.ripple_weight > 0 else None
    return stated or None

"""Roller follower: dimensions, contact body, rolling on the cam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve, rolling_share
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import In, Known, Length, Mass, Part, Used
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.cam_body import CamBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FollowerBody, RollerBody
from camwright.pipeline.contact.oil_film import entrainment_speed
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.contact.traction import Drag, RollingContact, ring_inertia, rolling_contact
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.follower_kind import ElasticParts, MovingParts, SurfaceMotion
from camwright.pipeline.follower.follower_stiffness import (
    bearing_compliance,
    fork_compliance,
    pin_compliance,
)
from camwright.pipeline.follower.pin_strength import bending_per_moment, pin_moment
from camwright.pipeline.follower.ring_on_balls import RingOnBalls, ring_on_balls, solid_reason
from camwright.pipeline.follower.roller_motion import RollingRoller, roller_motion
from camwright.pipeline.follower.roller_parts import Fork, Pin
from camwright.pipeline.follower.spring import NO_FORCE
from camwright.pipeline.follower.stem_beam import Stem

Turned = TypeVar("Turned", RollingRoller, RollingContact)
_NO_SLIP = 1e6  # friction coefficient of rolling without slip


@dataclass(frozen=True, kw_only=True)
class Roller(Part):
    """Roller of the follower."""

    table: ClassVar[str] = "roller"
    word: ClassVar[str] = "roller"
    offset: ClassVar[None] = None
    width_key: ClassVar[str] = "roller.width"
    slides: ClassVar[bool] = False
    spared: ClassVar[tuple[str, ...]] = ()
    defaults: ClassVar[Mapping[str, str]] = {
        "inertia": "that of a solid ring from hub to surface, an upper bound",
        "mass": "that of a solid ring from pin, or else hub, to surface",
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
    }

    radius: Annotated[Length, Known("bearing catalogue", "23.5 mm")]
    """outer radius of the roller"""
    width: Annotated[Length, Known("bearing catalogue", "17.5 mm")]
    """width of the roller"""
    hub_radius: Annotated[Length, Known("bearing catalogue", "11.5 mm")]
    """radius of the inner ring's shoulder, or of the pin"""
    inertia: Annotated[
        float | None, In("kg mm^2", above=0, at_most=1e9), Known("drawing", "30 kg mm^2")
    ] = None
    """moment of inertia of the part that turns"""
    mass: Annotated[Mass | None, Known("bearing catalogue, or weighed", "150 g")] = None
    """roller with its bearing, without the pin"""
    axial_offset: Annotated[
        float | None,
        In("mm", at_least=0, at_most=1000),
        Known("drawing, tolerance chain", "0.3 mm"),
    ] = None
    """greatest offset of the roller's middle from that of the cam"""
    friction: Annotated[
        float | None, In(above=0, at_most=1), Known("textbooks: 0.05 to 0.12 oiled steel", 0.1)
    ] = None
    """coefficient of sliding friction on the cam"""
    roughness: Annotated[
        float | None,
        In("um", above=0, at_most=1000),
        Known("bearing maker; 0.1 um ground", "0.1 um"),
    ] = None
    """rms roughness Rq of the surface"""
    material: Annotated[MadeOf, Known("bearing maker; bearing steel", "bearing_steel")]
    end: Annotated[BodyEnd | None, Used("contact of finite length")] = None
    """ends of the roller's surface; without them the pressure at the ends of the contact is not
    evaluated"""
    crown: Annotated[AxialCrown | None, Used("contact of finite length")] = None
    """crown of the roller's surface along the axis; added to that of the cam"""
    bearing: Annotated[Bearing, Used("checks of the roller bearing")]
    """bearing of the roller"""
    pin: Annotated[Pin | None, Used("checks of the pin, follower mass")] = None
    """pin of the roller"""
    fork: Annotated[Fork | None, Used("checks of the fork, follower mass")] = None
    """fork that holds the pin"""

    @property
    def line_width(self) -> float:
        """Maximum width of the line contact, m: without the ends."""
        return flat_width(self.width, self.end)

    @property
    def side_friction(self) -> float:
        """Zero: a roller has no friction force on the stem."""
        return 0.0

    @property
    def kinds(self) -> frozenset[str]:
        """See `FollowerKind`."""
        return frozenset({"roller", "round"})

    @property
    def reference(self) -> str:
        """See `FollowerKind`."""
        return "roller centre"

    @property
    def notes(self) -> tuple[str, ...]:
        """None: the roller has a drawing of its own; see `FollowerKind`."""
        return ()

    @property
    def contact_radius(self) -> float:
        """Radius of the surface, m."""
        return self.radius

    @property
    def extent(self) -> float:
        """Extent of roller and fork from the roller centre towards guide A, m."""
        return max(self.radius, self.moving.inset)

    @property
    def held_depth(self) -> float:
        """Depth below the surface at which the contact body of the roller is held, m: thickness of
        an outer ring, or down to a solid hub.
        """
        ring = self.bearing.ring
        if ring is not None and not self.solid_reason:
            return ring.thickness
        return self.radius - self.hub_radius

    @property
    def body_depth(self) -> float:
        """Depth of the contact body, m."""
        return self.held_depth

    @property
    def solid_reason(self) -> str:
        """Why the roller is modelled as solid on its hub; "" for a ring on its balls."""
        return solid_reason(self.radius, self.bearing)

    @property
    def body_model(self) -> str:
        """Model of the roller in the contact, in words; see `FollowerKind`."""
        reason = self.solid_reason
        if reason:
            return f"roller solid on its hub: {reason}"
        return "roller: outer ring of its bearing on balls, contact over a ball"

    @property
    def rotor_inertia(self) -> float:
        """Moment of inertia of the rolling part, kg m2: of the case, else of the solid ring."""
        if self.inertia is not None:
            return self.inertia
        solid = ring_inertia(self.radius, self.hub_radius, self.width, self.material.density)
        return float(solid)

    @property
    def drawn_mass(self) -> float:
        """Mass of roller and bearing, kg: stated, else of a solid ring about the pin."""
        if self.mass is not None:
            return self.mass
        inside = self.hub_radius if self.pin is None else 0.5 * self.pin.diameter
        area = np.pi * (self.radius**2 - inside**2)
        return self.material.density * self.width * area

    @property
    def parts(self) -> Mapping[str, Part | None]:
        """Bearing, pin and fork; see `FollowerKind`."""
        return {"roller_bearing": self.bearing, "pin": self.pin, "fork": self.fork}

    @property
    def moving(self) -> MovingParts:
        """Masses of roller, pin and fork, kg, extent of the fork along the stem, m, and keys that
        lack; see `FollowerKind`.
        """
        pin, fork = self.pin, self.fork
        of_pin = None if pin is None else pin.mass(0.0 if fork is None else fork.cheek_width)
        of_fork = None if pin is None or fork is None else fork.mass(pin)
        without = ("",) if fork is None else tuple(f".{name}" for name in fork.lacking)
        return MovingParts(
            {"roller": self.drawn_mass, "pin": of_pin, "fork": of_fork},
            0.0 if fork is None else (fork.cheek_length or 0.0) + (fork.bridge_length or 0.0),
            {
                "pin": (Pin.table,) if pin is None else (),
                "fork": tuple(Fork.table + key for key in without),
            },
        )

    def pin_stress(self, force: Array, moment: Array) -> Array | None:
        """Bending stress of the pin (n,), Pa; None without a pin.

        Parameters
        ----------
        force : array (n,)    normal force on the roller, N
        moment : array (n,)   of it along the axis, N m, see `pin_moment`
        """
        pin = self.pin
        if pin is None:
            return None
        bent = pin_moment(force, moment, self.width, pin.span, pin.overhung)
        return np.asarray(bent * bending_per_moment(pin.diameter))

    def contour(self, lift: Lift, cam: CamBody, arm: FollowerArm | None = None) -> Contour:
        """Cam contour under the roller; see `FollowerKind`."""
        if arm is not None:
            return arm.roller_contour(lift, cam.prime_radius, self.radius)
        return RollerContour(PitchCurve(lift, cam.prime_radius, cam.offset), self.radius)

    def ring(self, width: float, preload: float) -> RingOnBalls | None:
        """Outer ring of the bearing on its balls, solved for its bending; None for a roller that is
        modelled as solid.

        Parameters
        ----------
        width : float     of contact, m
        preload : float   of the spring, N; the balls have their stiffness at the static rating,
                          without one at the preload
        """
        ring = self.bearing.ring
        if ring is None or self.solid_reason:
            return None
        steel = Elastic(self.material.E, self.material.nu)
        load = self.bearing.C0 or preload
        return ring_on_balls(ring, steel, self.radius, self.width, width, load)

    def elastic(self, width: float, preload: float) -> ElasticParts:
        """Compliances of bearing, pin and fork, m/N, and length of the fork, m; see `FollowerKind`.

        Parameters
        ----------
        width : float     of contact, m
        preload : float   of the spring, N, at which the balls have their stiffness
        """
        pin, fork, ring, solved = self.pin, self.fork, self.bearing.ring, self.ring(width, preload)
        cheeks = None if fork is None or pin is None else fork_compliance(fork, pin)
        # without a preload as stiff as at the static rating, which the outer ring has as well
        load = self.bearing.C0 or preload if preload <= NO_FORCE else preload
        compliances = {
            "bearing": None
            if ring is None or solved is None
            else bearing_compliance(solved, ring, load),
            "pin": None if pin is None else pin_compliance(pin, self.width),
            "fork": cheeks,
        }
        held = None if fork is None or cheeks is None else fork.cheek_length
        return ElasticParts(compliances, held or 0.0)

    def turns(self, path: Array | float) -> float:
        """See `FollowerKind`."""
        return float(np.mean(np.abs(rolling_share(np.asarray(path), self.radius))))

    def rolling(self, contour: Contour, loads: Loads, speed: float) -> RollingRoller:
        """Motion without slip of the roller that carries at each cam angle, on the wall that
        carries; see `FollowerKind`.

        Parameters
        ----------
        speed : float   of the cam, rad/s
        """
        rollers = self._rollers(contour, loads, speed)
        return _carrying(rollers, [each.motion for each in rollers])

    def _rollers(self, contour: Contour, loads: Loads, speed: float) -> list[_Turning]:
        """Motion of the roller of each track without slip, and the cam angles at which it carries.

        Parameters
        ----------
        speed : float   of the cam, rad/s
        """
        pitch, theta, pulls = contour.require_roller().pitch, loads.theta, loads.wall < 0.0
        if loads.second is None:
            motion = roller_motion(pitch, self.radius, speed, theta, wall=loads.wall)
            every = np.ones(theta.size, dtype=bool)
            return [_Turning(motion, self.radius, every, loads.normal_force)]
        track, first = loads.second.track(pitch), roller_motion(pitch, self.radius, speed, theta)
        disc, there = track.contour.require_roller(), theta + track.turn
        second = roller_motion(disc.pitch, disc.roller_radius, speed, there, wall=disc.wall)
        near, far = loads.track_forces
        return [
            _Turning(first, self.radius, ~pulls, near),
            _Turning(second, disc.roller_radius, pulls, far),
        ]

    def body(self, width: float, stem: Stem, preload: float) -> FollowerBody:  # noqa: ARG002
        """Contact body of the roller: solid on its hub, or outer ring on balls; see `FollowerKind`.

        Parameters
        ----------
        width : float     of contact, m
        stem : Stem       not used
        preload : float   of the spring, N, see `ring`
        """
        ring = self.ring(width, preload)
        if ring is not None:
            return ring.body
        return RollerBody(self.radius, self.hub_radius, Elastic(self.material.E, self.material.nu))

    def motion(
        self,
        contour: Contour,
        contact: ContactHistory,
        loads: Loads,
        speed: float,
        idle: ContactHistory | None = None,
    ) -> SurfaceMotion:
        """Rolling of the roller on the cam over the turn: with creep, or without a friction
        coefficient free of slip. See `FollowerKind`.

        Parameters
        ----------
        contour : Contour          of the cam
        contact : ContactHistory   pressures and half-widths
        loads : Loads              normal force
        speed : float              of the cam, rad/s
        idle : ContactHistory      on the track that bears less, of preloaded discs
        """
        rollers, force = self._rollers(contour, loads, speed), loads.normal_force
        motion = _carrying(rollers, [each.motion for each in rollers])
        less = contact if idle is None else idle
        driven = _carrying(
            rollers,
            [self._driven(each, less.where(each.carries, contact), speed) for each in rollers],
        )
        loaded = force > (NO_FORCE if loads.held else 0.0)  # no quotient where the track changes
        demand = np.abs(driven.demand) / np.where(loaded, force, np.nan)
        if self.friction is None:
            return SurfaceMotion(entrainment_speed(motion.rolling_speed), traction_demand=demand)
        carried = driven.force / np.where(loaded, self.friction * force, 1.0)
        return SurfaceMotion(
            entrainment_speed(motion.rolling_speed, driven.slip),
            traction_share=np.clip(np.abs(carried), 0.0, 1.0),
            traction_demand=demand,
            rolling=driven,
        )

    @property
    def drag(self) -> Drag:
        """Inertia and bearing drag of the roller; no slip without a friction coefficient."""
        return Drag(
            inertia=self.rotor_inertia,
            friction=_NO_SLIP if self.friction is None else self.friction,
            torque=self.bearing.drag_torque or 0.0,
            bearing_friction=self.bearing.friction or 0.0,
            pin_radius=self.hub_radius,
        )

    def _driven(self, roller: _Turning, contact: ContactHistory, speed: float) -> RollingContact:
        """Rolling contact of a roller under inertia and bearing drag."""
        motion = roller.motion
        return rolling_contact(
            roller.force,
            motion.spin,
            motion.spin_acceleration,
            motion.rolling_speed,
            contact.half_width,
            contact.relative_radius,
            drag=self.drag,
            radius=roller.radius,
            period=FULL_TURN / speed,
        )


def on_second_track(roller: Roller, cam: CamBody) -> Roller:
    """Roller on the second track of a cam, like the first but for what the case states of it; the
    first of one track.
    """
    second = cam.second
    if second is None:
        return roller
    bearing = None if cam.on_pin is None else cam.on_pin.bearing
    beside = roller.bearing if bearing is None else bearing.beside(roller.bearing)
    return replace(roller, radius=second.radius, bearing=beside)


class _Turning(NamedTuple):
    """Roller of a disc: motion without slip, radius, m, whether it carries (n,), bool, and its
    normal force (n,), N.
    """

    motion: RollingRoller
    radius: float
    carries: NDArray[np.bool_]
    force: Array


def _carrying(rollers: Sequence[_Turning], each: Sequence[Turned]) -> Turned:
    """Motion, or rolling contact, of the roller that carries at each cam angle, of those `each`."""
    joined = each[0]
    for roller, other in zip(rollers[1:], each[1:], strict=True):
        joined = joined.where(roller.carries, other)
    return joined

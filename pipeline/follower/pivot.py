"""Pivot of an oscillating arm: its bearing, and the mass and loads about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Self

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Mass,
    Part,
    TableSource,
    Temperature,
    Used,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.contact.rolling_bearing import DynamicRating, StaticRating
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.guide_reactions import Guide, require_about
from camwright.pipeline.follower.pivot_forces import ArmPivot
from camwright.pipeline.follower.rocker import RockerOutput

_Friction = Annotated[float | None, In(at_least=0, at_most=1)]
_Turned = In("deg", at_least=-180, at_most=180)


@dataclass(frozen=True, kw_only=True)
class NeedleBearing(Part):
    """Needle bearing of a pivot, on its pin or inner ring."""

    table: ClassVar[str] = "follower.pivot.needle_bearing"
    defaults: ClassVar[Mapping[str, str]] = {
        "friction_min": "friction less the tolerance of friction",
        "friction_max": "friction plus the tolerance of friction",
    }

    diameter: Annotated[Length, Known("bearing catalogue", "16 mm")]
    """diameter of the raceway on pin or inner ring"""
    length: Annotated[Length, Known("bearing catalogue", "16 mm")]
    """width of the bearing"""
    friction: Annotated[
        float, In(at_least=0, at_most=1), Known("bearing catalogue; 0.0025 of needles", 0.0025)
    ]
    """coefficient of friction at that diameter"""
    friction_min: Annotated[_Friction, Known("bearing catalogue", 0.002)] = None
    """least coefficient of friction of the needles"""
    friction_max: Annotated[_Friction, Known("bearing catalogue", 0.004)] = None
    """greatest coefficient of friction of the needles"""
    C: Annotated[DynamicRating | None, Known("bearing catalogue", "10.5 kN")] = None
    C0: Annotated[StaticRating | None, Known("bearing catalogue", "14 kN")] = None
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a least or greatest friction on the wrong side of the nominal one."""
        super().__post_init__()
        require_about(self.table, self.friction, self.friction_min, self.friction_max)


@dataclass(frozen=True, kw_only=True)
class Pivot(Part):
    """Pivot of an arm in a bush or a needle bearing, and what swings about it.

    Raises
    ------
    InputError
        Unless it has exactly one of both bearings.
    """

    table: ClassVar[str] = "follower.pivot"
    defaults: ClassVar[Mapping[str, str]] = {
        "bush": "the pivot has a needle bearing",
        "needle_bearing": "the pivot has a bush",
        "swinging_mass": "`follower.mass` without the share of `rocker.output_mass`",
        "mass_distance": "`follower.arm.length`",
        "gravity_angle": "the weight is left out",
        "load_distance": "`follower.arm.length`",
    }

    bush: Annotated[Guide | None, Used("cycle, checks of the pivot")] = None
    """bush on the pin of the pivot, or around it"""
    needle_bearing: Annotated[NeedleBearing | None, Used("cycle, checks of the pivot")] = None
    """needle bearing on the pin of the pivot"""
    pin_material: Annotated[MadeOf | None, Known("drawing", "case_hardened")] = None
    """material of the pin"""
    ambient_temperature: Annotated[
        Temperature | None, Known("measured at the machine", "60 degC")
    ] = None
    """temperature around the pivot in operation, at least that of the mechanism"""
    swinging_mass: Annotated[Mass | None, Known("weighed, or drawing", "900 g")] = None
    """mass of all that swings about the pivot"""
    mass_distance: Annotated[
        float | None, In("mm", at_least=0, at_most=10_000), Known("drawing", "40 mm")
    ] = None
    """distance of its centre of mass from the pivot"""
    mass_angle: Annotated[float, _Turned, Known("drawing")] = 0.0
    """angle at the pivot from the arm to the centre of mass, positive in the outward swing"""
    gravity_angle: Annotated[float | None, _Turned, Known("drawing of the machine", "90 deg")] = (
        None
    )
    """angle from the upward vertical to the line from the cam axis to the pivot, positive in the
    sense of rotation of the cam"""
    load_distance: Annotated[Length | None, Known("drawing", "60 mm")] = None
    """distance from the pivot of the point at which the external force acts, square to the line to
    it"""
    load_angle: Annotated[float, _Turned, Known("drawing")] = 0.0
    """angle at the pivot from the arm to that point, positive in the outward swing"""
    load_moment: Annotated[
        float, In("N m", at_least=-1e7, at_most=1e7), Known("process, or measured", "2 N m")
    ] = 0.0
    """constant external moment on the arm, positive towards the cam"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a pivot without or with both of its bearings."""
        super().__post_init__()
        if (self.bush is None) == (self.needle_bearing is None):
            both = "neither" if self.bush is None else "both"
            limit = "exactly one of the two"
            raise InputError("follower.pivot.bush, follower.pivot.needle_bearing", both, limit)

    @property
    def bearing(self) -> Guide | NeedleBearing:
        """Bush or needle bearing of the pivot, whichever it has."""
        if self.needle_bearing is not None:
            return self.needle_bearing
        if self.bush is not None:
            return self.bush
        raise InputError("follower.pivot", "no bearing", "a bush or a needle bearing")

    def with_mass(self, factor: float) -> Self:
        """With a stated mass times a factor."""
        mass = self.swinging_mass
        return self if mass is None else replace(self, swinging_mass=factor * mass)

    def about(
        self,
        arm: FollowerArm,
        mass: float,
        prime_radius: float,
        offset: float | None,
        output: RockerOutput | None = None,
    ) -> ArmPivot:
        """Pivot of an arm with a mass at its reference point, kg, at a prime radius, m; offset of a
        flat face from the pivot, m, None of a round surface; output: of its second arm.
        """
        swinging = mass - (0.0 if output is None else output.reduced_mass)
        return ArmPivot(
            length=arm.length,
            sense=arm.sense,
            start=arm.start(prime_radius, offset),
            radius=0.5 * self.bearing.diameter,
            friction=self.bearing.friction,
            mass=swinging if self.swinging_mass is None else self.swinging_mass,
            mass_distance=arm.length if self.mass_distance is None else self.mass_distance,
            mass_angle=self.mass_angle,
            gravity_angle=self.gravity_angle,
            load_distance=arm.length if self.load_distance is None else self.load_distance,
            load_angle=self.load_angle,
            load_moment=self.load_moment,
            output=output,
        )

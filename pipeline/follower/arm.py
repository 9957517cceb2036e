"""Arm of an oscillating follower: dimensions, and the cam contour under its roller."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import Value
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import In, Known, Length, Part, Resolved, TableSource
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.camshaft_loads import Notch, Surface
from camwright.pipeline.follower.spring_link import SpringLink

_REACHED = 0.95  # of the greatest radius of the reference point that is left for a swing


@dataclass(frozen=True, kw_only=True)
class FollowerArm(Part):
    """Arm of an oscillating follower on a fixed pivot.

    The lift is the arc at its length, of the roller centre or the middle of a face, and forces,
    masses and springs are those reduced to it: a moment about the pivot over the length, an inertia
    and an angular rate over its square. The section of a straight arm is a rectangle; a fatigue
    notch factor holds for all stresses of its place. The fatigue_bending of the material is that of
    a polished specimen.

    Raises
    ------
    InputError
        If a value is out of its bounds, or a bore leaves no hub.
    """

    table: ClassVar[str] = "follower.arm"
    resolved: ClassVar[Mapping[str, Resolved]] = {
        "start_angle": Resolved(
            "> 0, < 180 deg",
            "angle at the pivot from the line to the cam axis to the arm at zero lift, in place of"
            " `cam.prime_radius`, which follows from it",
            Known("drawing", "35 deg"),
            In("deg", above=0, below=180),
            "cam.prime_radius",
        ),
        "inertia": Resolved(
            "> 0 kg m^2",
            "moment of inertia of all that swings about the pivot, in place of `follower.mass`,"
            " which follows from it",
            Known("drawing, or measured", "0.005 kg m^2"),
            In("kg m^2", above=0),
            "follower.mass",
        ),
    }

    defaults: ClassVar[Mapping[str, str]] = {
        "bore": "the arm is solid at its pivot",
        "hub": "depth",
        "roller_hub": "depth",
        "spring_distance": "that of `spring.link`, else the pivot, where it bends the arm most",
    }

    centre_distance: Annotated[Length, Known("drawing", "90 mm")]
    """distance of the pivot from the cam axis"""
    length: Annotated[Length, Known("drawing", "80 mm")]
    """distance of the roller centre, or of the middle of a face, from the pivot"""
    swing: Annotated[Literal["with", "against"], Known("drawing", "with")]
    """sense of the outward swing: with the rotation of the cam, or against it"""
    width: Annotated[Length | None, Known("drawing", "25 mm")] = None
    """width of the arm along the cam axis"""
    depth: Annotated[Length | None, Known("drawing", "25 mm")] = None
    """depth of the arm across its length in the plane of the cam"""
    bore: Annotated[Length | None, Known("drawing; seat of the bush", "20 mm")] = None
    """diameter of the bore at the pivot"""
    hub: Annotated[Length | None, Known("drawing", "35 mm")] = None
    """outer diameter of the hub around the pivot"""
    roller_hub: Annotated[Length | None, Known("drawing", "25 mm")] = None
    """outer diameter of the hub around the roller's pin; of a fork that is described its height"""
    plane_offset: Annotated[float, In("mm", at_least=0, at_most=1000), Known("drawing", "0 mm")] = (
        0.0
    )
    """distance of the middle of the arm from that of the roller along the cam axis; of conjugate
    discs towards the second"""
    spring_distance: Annotated[
        float | None, In("mm", at_least=0, at_most=10_000), Known("drawing", "60 mm")
    ] = None
    """distance from the pivot at which the spring acts on the arm"""
    material: Annotated[MadeOf | None, Known("drawing", "c45")] = None
    surface: Annotated[Surface, Known("drawing")] = "machined"
    """surface finish of the arm"""
    pivot_notch: Annotated[
        Notch | None, Known("Peterson's Stress Concentration Factors: hole or fillet", 2.0)
    ] = None
    """fatigue notch factor of the arm at its pivot"""
    roller_notch: Annotated[
        Notch | None, Known("Peterson's Stress Concentration Factors: eye or fillet", 3.0)
    ] = None
    """fatigue notch factor of the arm at the roller"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a bore that leaves no hub."""
        super().__post_init__()
        hub = self.depth if self.hub is None else self.hub
        if self.bore is not None and hub is not None and not self.bore < hub:
            key = "depth" if self.hub is None else "hub"
            limit = f"< {shown(hub, 'mm')}, follower.arm.{key}"
            raise InputError("follower.arm.bore", shown(self.bore, "mm"), limit)

    @property
    def is_described(self) -> bool:
        """Whether the section of the arm is stated, by one of its dimensions at least."""
        return self.width is not None or self.depth is not None

    def held(self, link: SpringLink | None) -> Value:
        """Distance from the pivot at which the spring acts, along the arm, m: as stated, else by
        the spring's end on the arm, not below 0; 0 without such a spring.
        """
        if self.spring_distance is not None:
            return self.spring_distance
        if link is None:
            return 0.0
        held: Value = np.maximum(link.arm_radius * np.cos(link.arm_angle), 0.0)
        return held

    def pivot_share(self, held: float) -> float:
        """Force on the pivot per force across the end of the arm, held at a distance, m."""
        return abs(self.length / held - 1.0) if held else 1.0

    @property
    def sense(self) -> float:
        """Sense of the outward swing: 1 with the rotation of the cam, -1 against it."""
        return 1.0 if self.swing == "with" else -1.0

    @property
    def linkage(self) -> Arm:
        """Geometry of the arm."""
        return Arm(self.centre_distance, self.length, self.sense)

    def start(self, prime_radius: float, offset: float | None = None) -> float:
        """Angle at the pivot from the line to the cam axis to the arm at zero lift, rad.

        offset: of a flat face, see `Arm.start_angle`; None: a roller or curved face
        """
        return float(self.linkage.start_angle(prime_radius, offset))

    def reach(self, offset: float | None = None) -> tuple[float, float]:
        """Prime radii, m, between which the arm may swing: apart from the least and the greatest
        that it reaches by a twentieth of them.

        offset: of a flat face, which the arm holds below the line square to it, as of `start`
        """
        distance, length = self.centre_distance, self.length
        if offset is not None:
            return 0.0, _REACHED * distance - offset
        return abs(distance - length) / _REACHED, _REACHED * (distance + length)

    def roller_contour(self, lift: Lift, prime_radius: float, roller_radius: float) -> Contour:
        """Cam contour under the roller of the arm.

        Raises
        ------
        InputError
            If the arm does not reach the prime circle, or swings past a line of centres.
        """
        path = ArmPath(lift, self.linkage, self.start(prime_radius))
        return ArmContour(path, roller_radius)

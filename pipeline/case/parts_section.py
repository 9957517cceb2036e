"""Follower and valve-train sections of a case file."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.external_force import STANDARD_GRAVITY
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import FileName, In, Known, Length, Mass, Share, Used
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.section import (
    MaterialName,
    Section,
    SourceOfTable,
    Table,
)
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.flat_face import FollowerFace
from camwright.pipeline.follower.pivot import Pivot


class ValveTrain(Section):
    """Requests the machine motion of a valve cam."""

    cam_mass: Annotated[Mass, Known("drawing, or weighed", "300 g")]
    """mass of the cam, taken as a disc"""
    source: SourceOfTable = NO_SOURCE


class Follower(Section):
    """Translating or oscillating follower with a roller or a face."""

    defaults: ClassVar[Mapping[str, str]] = {
        "face": "the follower has a roller",
        "arm": "the follower translates",
        "pivot": "the pivot of an arm is left out",
        "stem_length": "the stem is long",
        "stiffness": "bearing, pin, fork, stem or arm, and camshaft in series",
        "external_force": "0 N, without a file",
        "external_force_file": "the external force is constant",
        "gravity_angle": "the weight is left out",
        "restitution": "that of the damped elastic follower in half of its natural period",
    }

    kind: Annotated[Literal["roller", "flat", "oscillating"], Known("own choice")] = "roller"
    """stem with a roller or a flat face, or oscillating arm with a roller or a face"""
    face: Annotated[Table[FollowerFace] | None, Used("contour, contact, checks")] = None
    """face of the follower, flat or curved"""
    arm: Annotated[Table[FollowerArm] | None, Used("lift, contour, cycle")] = None
    """arm of an oscillating follower on its pivot"""
    pivot: Annotated[Table[Pivot] | None, Used("cycle, checks of the pivot")] = None
    """pivot of the arm"""
    mass: Annotated[Mass, Known("weighed, or drawing", "610 g")]
    """mass of all that moves with the follower, with its share of the spring; of an arm the moment
    of inertia about its pivot over the square of its length"""
    stem_diameter: Annotated[Length, Known("drawing", "16 mm")]
    """diameter of the stem in its guides"""
    stem_length: Annotated[Length | None, Known("drawing", "205 mm")] = None
    """length of the stem from the roller centre or face to its end"""
    stem_material: Annotated[MadeOf, MaterialName(), Known("drawing", "c45")]
    overhang_at_max_lift: Annotated[Length, Known("drawing", "30 mm")]
    """distance from the middle of guide A to the roller centre or face at maximum lift"""
    viscous_damping: Annotated[float, In("N s/m", at_least=0, at_most=1e6), Known("measured")] = 0.0
    """viscous damping of the follower"""
    stiffness: Annotated[
        float | None,
        In("N/mm", above=0, at_most=1e12),
        Known("measured, or finite elements", "20000 N/mm"),
    ] = None
    """stiffness from cam to follower mass"""
    damping_ratio: Annotated[float, In(at_least=0, below=1), Known("measured; 0.03 to 0.1")] = 0.05
    """damping of the elastic follower"""
    restitution: Annotated[float | None, In(at_least=0, below=1), Known("measured", 0.5)] = None
    """of a cam that pulls: speed of the follower off a track after a landing over that before"""
    anti_rotation: Annotated[
        Literal["flat", "key", "square", "guided_fork", "not_needed"] | None,
        Known("drawing", "guided_fork"),
    ] = None
    """means that keeps the stem from turning; not_needed of a flat face alone"""
    spring_share: Annotated[Share, Known("a third by Rayleigh")] = 1.0 / 3.0
    """share of the spring mass that moves with the follower"""
    external_force: Annotated[
        float | None, In("N", at_least=-1e9, at_most=1e9), Known("process, or measured", "50 N")
    ] = None
    """constant force of the machine on the follower along its axis, positive towards the cam"""
    external_force_file: Annotated[FileName | None, Known("process, or measured", "force.csv")] = (
        None
    )
    """that force over the cam angle: columns of cam angle and force, linear between rows"""
    gravity_angle: Annotated[
        float | None, In("deg", at_least=0, at_most=180), Known("drawing of the machine", "0 deg")
    ] = None
    """angle of the outward stroke from the upward vertical: at 0 deg the weight presses the
    follower on the cam, at 180 deg it pulls it off"""
    source: SourceOfTable = NO_SOURCE

    @model_validator(mode="after")
    def _has_its_face(self) -> Self:
        """Refuse a flat follower without a face, and a roller with one."""
        if self.kind == "flat" and self.face is None:
            raise InputError("follower.face", "missing", 'given with follower.kind = "flat"')
        if self.kind == "roller" and self.face is not None:
            limit = 'left out, or follower.kind = "flat"'
            raise InputError("follower.face", "a table", limit)
        return self

    @model_validator(mode="after")
    def _has_a_face_of_its_kind(self) -> Self:
        """Refuse a face with the keys of another kind: offset or radius belong to an arm, which
        needs exactly one of them.
        """
        if self.face is None:
            return self
        shape = {name: getattr(self.face, name) for name in ("offset", "radius")}
        for name, value in shape.items():
            if self.kind == "flat" and value is not None:
                limit = 'left out, or follower.kind = "oscillating"'
                raise InputError(f"follower.face.{name}", units.shown(value, "mm"), limit)
        if self.kind == "oscillating" and None not in shape.values():
            value = units.shown(shape["offset"], "mm")
            raise InputError("follower.face.offset", value, "left out with follower.face.radius")
        if self.kind == "oscillating" and not any(each is not None for each in shape.values()):
            limit = "given for a flat face along the arm, or follower.face.radius for a curved one"
            raise InputError("follower.face.offset", "missing", limit)
        return self

    @model_validator(mode="after")
    def _has_its_arm(self) -> Self:
        """Refuse an oscillating follower without arm, the pivot of another, and the gravity angle
        of a stem with an arm.
        """
        if self.pivot is not None and self.arm is None:
            raise InputError("follower.pivot", "a table", "left out, or given with follower.arm")
        if self.kind == "oscillating" and self.arm is None:
            raise InputError("follower.arm", "missing", 'given with follower.kind = "oscillating"')
        if self.arm is not None and self.gravity_angle is not None:
            stated = units.shown(self.gravity_angle, "deg")
            limit = "left out with an arm: see follower.pivot.gravity_angle"
            raise InputError("follower.gravity_angle", stated, limit)
        return self

    @model_validator(mode="after")
    def _has_one_force(self) -> Self:
        """Refuse an external force that is stated both as a number and as a file."""
        if self.external_force_file is not None and self.external_force is not None:
            value = units.shown(self.external_force, "N")
            limit = "left out with follower.external_force_file"
            raise InputError("follower.external_force", value, limit)
        return self

    def arm_angle(self, lift: Array, prime_radius: float) -> Array | None:
        """Angle at the pivot from the line to the cam axis to the arm (...), rad; None of a stem.

        Parameters
        ----------
        lift : array (...)   m
        """
        if self.arm is None:
            return None
        offset = None if self.face is None else self.face.offset
        return np.asarray(self.arm.start(prime_radius, offset) + lift / self.arm.length)

    @property
    def gravity_along_axis(self) -> float:
        """Component of the acceleration of free fall towards the cam, m/s2."""
        if self.gravity_angle is None:
            return 0.0
        return STANDARD_GRAVITY * cos(self.gravity_angle)

"""Sections of a case file without a part of their own: follower, valve train."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos
from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.external_force import STANDARD_GRAVITY
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import FileName, In, Length, Mass, Share
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.case.section import MaterialName, Section, StatedSource, Table
from camwright.pipeline.follower.flat_face import FlatFace


class ValveTrain(Section):
    """Requests the machine motion of a valve cam; the cam mass is taken as that of a disc."""

    cam_mass: Mass
    source: StatedSource = NO_SOURCE


class Follower(Section):
    """Translating follower with a roller or a flat face.

    The overhang is from guide A to the roller centre, or to the face. stiffness: from cam to
    follower mass; left out, bearing, pin, fork, stem and camshaft in series. mass: of all that
    moves, with spring_share of the spring, a third by Rayleigh. anti_rotation: means that keeps
    the stem from turning about its axis. External force: along the axis, positive towards the cam;
    from a file over the cam angle. gravity_angle: of the outward stroke from the upward vertical.
    """

    defaults: ClassVar[Mapping[str, str]] = {
        "face": "the follower has a roller",
        "stem_length": "the stem is long",
        "stiffness": "bearing, pin, fork, stem and camshaft in series",
        "external_force": "0 N, without a file",
        "external_force_file": "the external force is constant",
        "gravity_angle": "the weight is left out",
    }

    kind: Literal["roller", "flat"] = "roller"
    face: Table[FlatFace] | None = None
    mass: Mass
    stem_diameter: Length
    stem_length: Length | None = None
    stem_material: Annotated[Material, MaterialName()]
    overhang_at_max_lift: Length
    viscous_damping: Annotated[float, In("N s/m", at_least=0, at_most=1e6)] = 0.0
    stiffness: Annotated[float, In("N/mm", above=0, at_most=1e12)] | None = None
    damping_ratio: Annotated[float, In(at_least=0, below=1)] = 0.05
    anti_rotation: Literal["flat", "key", "square", "guided_fork", "not_needed"] | None = None
    spring_share: Share = 1.0 / 3.0
    external_force: Annotated[float, In("N", at_least=-1e9, at_most=1e9)] | None = None
    external_force_file: FileName | None = None
    gravity_angle: Annotated[float, In("deg", at_least=0, at_most=180)] | None = None
    source: StatedSource = NO_SOURCE

    @model_validator(mode="after")
    def _has_its_face(self) -> Self:
        if self.kind == "flat" and self.face is None:
            raise InputError("follower.face", "missing", 'given with follower.kind = "flat"')
        if self.kind == "roller" and self.face is not None:
            limit = 'left out, or follower.kind = "flat"'
            raise InputError("follower.face", "a table", limit)
        return self

    @model_validator(mode="after")
    def _has_one_force(self) -> Self:
        if self.external_force_file is not None and self.external_force is not None:
            value = units.shown(self.external_force, "N")
            limit = "left out with follower.external_force_file"
            raise InputError("follower.external_force", value, limit)
        return self

    @property
    def gravity_along_axis(self) -> float:
        """Component of the acceleration of free fall towards the cam, m/s2."""
        if self.gravity_angle is None:
            return 0.0
        return STANDARD_GRAVITY * cos(self.gravity_angle)

"""The cam disc: base shape, bore, keyway and material."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Angle, In, Length, Part


@dataclass(frozen=True, kw_only=True)
class Keyway(Part):
    """A keyway in the bore; angle of its centre line in the cam frame."""

    fillet: ClassVar[float] = 0.0  # its inner corners are meshed sharp
    table: ClassVar[str] = "cam.keyway"

    width: Length
    depth: Length
    angle: Angle = 0.0


@dataclass(frozen=True, kw_only=True)
class BalanceHole(Part):
    """Request for a hole through the cam that removes its unbalance.

    wall: minimum thickness between the hole and contour, bore or keyway.
    """

    table: ClassVar[str] = "cam.counter_hole"

    wall: Length = 0.003


@dataclass(frozen=True, kw_only=True)
class CamBody(Part):
    """The cam disc.

    prime_radius: minimum distance of the roller centre from the cam axis, for a flat face the base
    radius; offset: distance of the follower axis from the cam axis.
    """

    table: ClassVar[str] = "cam"
    defaults: ClassVar[Mapping[str, str]] = {
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
    }

    prime_radius: Length
    offset: Annotated[float, In("mm", above=-10_000, below=10_000)] = 0.0
    width: Length
    bore_radius: Length
    material: Material
    keyway: Keyway | None = None
    roughness: Annotated[float, In("um", above=0, at_most=1000)] | None = None
    profile_tolerance: Annotated[float, In("mm", above=0, at_most=10)] | None = None
    waviness_length: Length = 0.005
    counter_hole: BalanceHole | None = None
    source: str = ""

    @property
    def held_radius(self) -> float:
        """Maximum radius of the held surface, m: bore and keyway."""
        return self.bore_radius + (0.0 if self.keyway is None else self.keyway.depth)

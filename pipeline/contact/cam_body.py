"""The cam disc: base shape, bore, keyway and material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Angle, In, Length, Part


@dataclass(frozen=True, kw_only=True)
class Keyway(Part):
    """A keyway in the bore; the angle is that of its middle, in the cam frame."""

    fillet: ClassVar[float] = 0.0  # its inner corners are meshed sharp
    table: ClassVar[str] = "cam.keyway"

    width: Length
    depth: Length
    angle: Angle = 0.0


@dataclass(frozen=True, kw_only=True)
class BalanceHole(Part):
    """Order for a hole through the cam that removes its unbalance.

    wall is the least steel between the hole and contour, bore or keyway.
    """

    table: ClassVar[str] = "cam.counter_hole"

    wall: Length = 0.003


@dataclass(frozen=True, kw_only=True)
class CamBody(Part):
    """The cam disc.

    The prime radius is the least distance of the roller's centre from the cam axis; of a flat
    face it is the base radius. The offset is that of the follower's axis from the cam's.
    """

    table: ClassVar[str] = "cam"

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
        """Greatest radius of the held surface, m: bore and keyway."""
        return self.bore_radius + (0.0 if self.keyway is None else self.keyway.depth)

"""The cam disc: base shape, bore, keyway, key and material."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, NamedTuple

from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Angle, In, Length, Part
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd, flat_width
from camwright.pipeline.contact.shrink_fit import SeatFit


@dataclass(frozen=True, kw_only=True)
class Keyway(Part):
    """A keyway in the bore; angle of its centre line in the cam frame.

    root_radius: fillet between side and floor, for the stress at the root.
    """

    fillet: ClassVar[float] = 0.0  # its inner corners are meshed sharp
    table: ClassVar[str] = "cam.keyway"
    defaults: ClassVar[Mapping[str, str]] = {
        "root_radius": "least of DIN 6885-1, by a standard width of the keyway"
    }

    width: Length
    depth: Length
    angle: Angle = 0.0
    root_radius: Length | None = None


class StandardKey(NamedTuple):
    """Row of DIN 6885-1, m: key height h, depth t1 in the shaft, greatest key chamfer s, least
    fillet radius r of the keyways.
    """

    height: float
    shaft_depth: float
    chamfer: float
    fillet: float


_MM = 1e-3
STANDARD_KEYS: Mapping[int, StandardKey] = {
    width: StandardKey(height * _MM, depth * _MM, chamfer * _MM, fillet * _MM)
    for width, height, depth, chamfer, fillet in (
        (2, 2, 1.2, 0.25, 0.08), (3, 3, 1.8, 0.25, 0.08), (4, 4, 2.5, 0.25, 0.08),
        (5, 5, 3.0, 0.40, 0.16), (6, 6, 3.5, 0.40, 0.16), (8, 7, 4.0, 0.40, 0.16),
        (10, 8, 5.0, 0.60, 0.25), (12, 8, 5.0, 0.60, 0.25), (14, 9, 5.5, 0.60, 0.25),
        (16, 10, 6.0, 0.60, 0.25), (18, 11, 7.0, 0.60, 0.25), (20, 12, 7.5, 0.80, 0.40),
        (22, 14, 9.0, 0.80, 0.40), (25, 14, 9.0, 0.80, 0.40), (28, 16, 10.0, 0.80, 0.40),
    )
}  # fmt: skip
"""Parallel keys of DIN 6885-1 by their width, mm (recalled, verify)."""


@dataclass(frozen=True, kw_only=True)
class ParallelKey(Part):
    """Parallel key of the cam.

    height, h; shaft_depth, t1: of its keyway in the shaft; chamfer: of its edges; form A has round
    ends, which do not transmit torque, and length includes them. application_factor: K_A, on the
    solved torque, for impact where the torque reverses.
    """

    table: ClassVar[str] = "cam.key"
    defaults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("height", "shaft_depth", "chamfer"), "DIN 6885-1, by a standard width of the keyway"
    )

    length: Length | None = None
    height: Length | None = None
    shaft_depth: Length | None = None
    chamfer: Length | None = None
    form: Literal["A", "B"] = "A"
    material: Material | None = None
    application_factor: Annotated[float, In(at_least=1, at_most=10)] = 1.5
    source: Source = NO_SOURCE


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
    width_key: ClassVar[str] = "cam.width"
    defaults: ClassVar[Mapping[str, str]] = {
        "roughness": "unknown: the film ratio, which is advisory, is not evaluated",
        "waviness_height": "of the process at the wavelength, within the profile tolerance",
    }

    prime_radius: Length
    offset: Annotated[float, In("mm", above=-10_000, below=10_000)] = 0.0
    width: Length
    bore_radius: Length
    material: Material
    keyway: Keyway | None = None
    key: ParallelKey | None = None
    fit: SeatFit | None = None
    roughness: Annotated[float, In("um", above=0, at_most=1000)] | None = None
    profile_tolerance: Annotated[float, In("mm", above=0, at_most=10)] = 1e-4
    process: Process = "ground"
    waviness_length: Length = 0.005
    waviness_height: Length | None = None
    end: BodyEnd | None = None
    crown: AxialCrown | None = None
    counter_hole: BalanceHole | None = None
    source: Source = NO_SOURCE

    @property
    def line_width(self) -> float:
        """Maximum width of the line contact, m: without the ends."""
        return flat_width(self.width, self.end)

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
    def keyway_root_radius(self) -> float | None:
        """Fillet radius at the root of the keyway, m; None without one or without a datum."""
        row = self._standard_key
        stated = None if self.keyway is None else self.keyway.root_radius
        return stated or (row and row.fillet)

    @property
    def _standard_key(self) -> StandardKey | None:
        width = 0.0 if self.keyway is None else self.keyway.width
        return next((row for b, row in STANDARD_KEYS.items() if abs(b * _MM - width) < 1e-6), None)

    @property
    def key_flanks(self) -> KeyFlanks | None:
        """Flanks of the key; None without a key or a datum of it.

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

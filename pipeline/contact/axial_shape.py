"""Axial shape of a body in contact: its ends and its crown, as a case states them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import FileName, In, Known, Length, Part, TableSource
from camwright.pipeline.base.source import NO_SOURCE

EndKind = Literal["sharp", "chamfer", "radius"]
CrownKind = Literal["circular", "lundberg", "johns_gohar", "iso16281", "table"]

# Keys of each kind of crown, and whether it needs them.
_KEYS: Mapping[CrownKind, Mapping[str, bool]] = {
    "circular": {"radius": True},
    "lundberg": {"line_load": True, "length": False},
    "johns_gohar": {"line_load": True, "length": False},
    "iso16281": {},
    "table": {"file": True},
}


@dataclass(frozen=True)
class BodyEnd(Part):
    """Both ends of a body.

    A radius ends at the end face.
    """

    table: ClassVar[str] = "end"

    kind: Annotated[EndKind, Known("drawing")] = "sharp"
    """sharp edge, chamfer of 45 deg, or radius tangent to the track"""
    size: Annotated[float, In("mm", at_least=0, at_most=1000), Known("drawing", "0.3 mm")] = 0.0
    """width of the chamfer, or the radius; 0 at a sharp edge"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a size, m, of a sharp end, and a chamfer or rounding without a positive one."""
        super().__post_init__()
        if self.kind == "sharp" and self.size != 0:
            raise InputError("end.size", self.size, "0 m at a sharp end")
        if self.kind != "sharp" and not 0 < self.size < np.inf:
            raise InputError("end.size", self.size, "> 0 m")

    def drop(self, beyond: Array) -> Array:
        """Drop of the end below the flat track, (...), m, at axial distances `beyond` the end of
        the flat, (...), m; 0 on the flat and at a sharp end.

        A chamfer drops by the distance itself, a radius by that of a quarter circle, at most the
        radius.
        """
        reach = np.maximum(beyond, 0.0)
        if self.kind == "radius":
            inside = np.minimum(reach / self.size, 1.0)
            return np.asarray(self.size * (1.0 - np.sqrt(1.0 - inside**2)))
        return reach if self.kind == "chamfer" else np.zeros_like(reach)


def flat_width(width: float, end: BodyEnd | None) -> float:
    """Width of a body without its chamfers or roundings, m; the full width if none are stated."""
    return width - 2.0 * (0.0 if end is None else end.size)


@dataclass(frozen=True, kw_only=True)
class AxialCrown(Part):
    """Crown of a body along the axis.

    Each kind has keys of its own, those of `_KEYS`, and refuses the others.
    """

    table: ClassVar[str] = "crown"
    defaults: ClassVar[Mapping[str, str]] = {
        "radius": "of a circular crown alone",
        "line_load": "of a logarithmic crown alone",
        "length": "length of the contact",
        "file": "of a table alone",
    }

    kind: Annotated[CrownKind, Known("drawing", "johns_gohar")]
    """arc, logarithmic crown of Lundberg or of Johns and Gohar, reference geometry of ISO/TS 16281,
    or table"""
    radius: Annotated[float | None, In("mm", above=0, at_most=1e6), Known("drawing", "500 mm")] = (
        None
    )
    """radius of the arc along the axis"""
    line_load: Annotated[
        float | None,
        In("N/mm", above=0, at_most=1e6),
        Known("own choice: greatest line load of the cycle", "200 N/mm"),
    ] = None
    """line load of uniform pressure, for which the crown is designed"""
    length: Annotated[Length | None, Known("drawing", "16 mm")] = None
    """length on which the crown is designed"""
    file: Annotated[FileName | None, Known("drawing, or measured", "crown.csv")] = None
    """CSV file of the drop, columns y_mm from the middle and drop_um, relative to the case file"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a missing key of the kind of crown, and a key that this kind does not have."""
        super().__post_init__()
        known = _KEYS[self.kind]
        for name in ("radius", "line_load", "length", "file"):
            value = getattr(self, name)
            if value is None and known.get(name):
                raise InputError(f"crown.{name}", "missing", f'given with kind = "{self.kind}"')
            if value is not None and name not in known:
                raise InputError(f"crown.{name}", value, f'left out with kind = "{self.kind}"')

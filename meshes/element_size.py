"""Element size from the Hertz half-width and the distance from the contact."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze, positive
from camwright.geometry.errors import InputError

EDGES_PER_TURN = 40  # minimum element edges around a full circle
MILLIMETRE = 1e-3  # unit of lengths in gmsh, whose tolerances suit numbers around one
_SPOTS_MAX = 40  # longer formulas slow the mesher
_DECIMALS = 6  # of a size over its limit: sizes nearer to each other are equal


@dataclass(frozen=True, eq=False, kw_only=True)
class ElementSize:
    """Element size of one body: constant at the contact, growing with the distance.

    The size is ``min(far_size, contact_size + growth * max(0, r - contact_extent))`` at the
    distance r from the contact point.

    Parameters
    ----------
    far_size : float                maximum size, m
    contact_size : float or None    size in the contact zone, m; None: `far_size` everywhere
    contact_extent : float          radius of the zone of constant size, m
    contact_point : (2,) or None    centre of the zone, m; set by the mesh of a roller or half disc
    growth : float                  increase of size per distance, m/m
    phase : float                   shift of the facet ends in the contact, in facets, 0..1
    wall_edges : float              minimum number of elements across a wall of the cam

    Raises
    ------
    InputError
        If a value is out of bounds; NaN included.
    """

    far_size: float
    contact_size: float | None = None
    contact_extent: float = 0.0
    contact_point: Array | None = None
    growth: float = 0.15
    phase: float = 0.0
    wall_edges: float = 1.0

    def __post_init__(self) -> None:
        """Refuse sizes, growth and extents out of their bounds, and a contact point that is not
        (2,).
        """
        positive("sizing.far_size", self.far_size, "m")
        positive("sizing.wall_edges", self.wall_edges)
        positive("sizing.growth", self.growth)
        if self.contact_size is not None:
            positive("sizing.contact_size", self.contact_size, "m")
            if self.contact_size > self.far_size:
                raise InputError(
                    "sizing.contact_size", self.contact_size, f"<= far_size ({self.far_size:g} m)"
                )
        if not (np.isfinite(self.contact_extent) and self.contact_extent >= 0):
            raise InputError("sizing.contact_extent", self.contact_extent, ">= 0 m")
        if not 0 <= self.phase <= 1:
            raise InputError("sizing.phase", self.phase, "in 0..1")
        if self.contact_point is not None:
            point = finite("sizing.contact_point", self.contact_point)
            if point.shape != (2,):
                raise InputError("sizing.contact_point", point.shape, "two coordinates")
            freeze(self, contact_point=point)

    @classmethod
    def from_half_width(
        cls,
        half_width: float,
        far_size: float,
        *,
        contact_point: ArrayLike | None = None,
        edges: float = 8.0,
        reach: float = 2.0,
        growth: float = 0.15,
        phase: float = 0.0,
    ) -> ElementSize:
        """Sizing of `edges` per Hertz half-width (m), constant up to `reach` half-widths.

        Eight quadratic elements per half-width, up to 1.8 half-widths, resolve the maximum
        subsurface shear stress to about 0.3 %.
        """
        positive("half_width", half_width, "m")
        positive("edges", edges)
        return cls(
            far_size=far_size,
            contact_size=min(half_width / edges, far_size),
            contact_extent=reach * half_width,
            contact_point=None if contact_point is None else finite("contact_point", contact_point),
            growth=growth,
            phase=phase,
        )

    @property
    def refined(self) -> bool:
        """Whether the sizing has a contact zone."""
        return self.contact_size is not None and self.contact_point is not None

    @property
    def steps(self) -> int:
        """Facets of `contact_size` on either side of the contact point; 0 without a zone."""
        if self.contact_size is None or self.contact_point is None:
            return 0
        return max(2, int(np.ceil(self.contact_extent / self.contact_size - 1e-9)))

    def field(self) -> SizeField:
        """Element size as a function of position."""
        spots: tuple[Spot, ...] = ()
        if self.contact_size is not None and self.contact_point is not None:
            spots = (Spot(self.contact_point, self.contact_size, self.contact_extent),)
        return SizeField(self.far_size, self.growth, spots)


@dataclass(frozen=True, eq=False)
class Spot:
    """Refinement: elements of `size` within `extent` of `point`, m."""

    point: Array
    size: float
    extent: float


@dataclass(frozen=True, eq=False)
class SizeField:
    """Element size by position, m: the minimum of `far_size` and of the size of every spot.

    The size of a spot grows by `growth` per distance from it.
    """

    far_size: float
    growth: float
    spots: tuple[Spot, ...] = field(default=())

    def __call__(self, points: ArrayLike) -> Array:
        """Element size (n,), m, at points (2, n), m."""
        x, y = np.asarray(points, dtype=float)
        size = np.full(x.shape, self.far_size)
        for spot in self.spots:
            beyond = np.hypot(x - spot.point[0], y - spot.point[1]) - spot.extent
            np.minimum(size, spot.size + self.growth * np.maximum(0.0, beyond), out=size)
        return size

    def formulas(self) -> tuple[str, ...]:
        """Size of every spot as a formula of gmsh's MathEval, mm.

        The field is the minimum of them and of `far_size`. MathEval has no maximum:
        ``max(0, a) = (a + |a|)/2``.
        """
        texts = []
        for spot in self.spots:
            x, y = (_number(value) for value in spot.point)
            beyond = f"Sqrt((x-({x}))^2+(y-({y}))^2)-{_number(spot.extent)}"
            texts.append(f"{_number(spot.size)}+{0.5 * self.growth!r}*({beyond}+Fabs({beyond}))")
        return tuple(texts)

    def with_spot(self, point: ArrayLike, size: float, extent: float) -> SizeField:
        """Field with elements of at most `size` within `extent` of `point`, m."""
        return replace(self, spots=(*self.spots, Spot(finite("spot", point), size, extent)))

    def on_grid(self, step: float) -> SizeField:
        """Field whose sizes and places are multiples of a step, m."""

        def near(value: float) -> float:
            return float(np.rint(value / step)) * step

        return replace(
            self,
            far_size=near(self.far_size),
            spots=tuple(
                Spot(np.rint(each.point / step) * step, near(each.size), near(each.extent))
                for each in self.spots
            ),
        )

    def capped(self, size: float) -> SizeField:
        """Field of at most `size`, m."""
        return replace(self, far_size=min(self.far_size, size))

    def refined(self, by: float) -> SizeField:
        """Field of the sizes divided by a factor, everywhere."""
        return replace(
            self,
            far_size=self.far_size / by,
            growth=self.growth / by,
            spots=tuple(replace(each, size=each.size / by) for each in self.spots),
        )

    def below(self, points: Array, limits: Array, slack: float = 1.25) -> SizeField:
        """Field with spots added until it is below `slack * limits` (n,) at `points` (2, n), m.

        If that requires too many spots, the whole field is capped instead.
        """
        result = self
        while len(result.spots) < _SPOTS_MAX:
            excess = np.round(result(points) / limits, _DECIMALS)  # equal on an arc: the first
            worst = int(np.argmax(excess))
            if not excess[worst] > slack:
                return result
            size = float(limits[worst])
            result = result.with_spot(points[:, worst], size, 8.0 * size)
        return self.capped(float(limits.min()))


def _number(metres: float) -> str:
    """Length in millimetres as text that reads back exactly."""
    return repr(float(metres) / MILLIMETRE)

"""Element size from the contact half-width."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze, positive
from camwright.geometry.errors import InputError

EDGES_PER_TURN = 40  # least number of element edges around a full circle
MILLIMETRE = 1e-3  # gmsh's tolerances are made for numbers around one
_SPOTS_MAX = 40  # a formula longer than this slows the mesher


@dataclass(frozen=True, eq=False, kw_only=True)
class Sizing:
    """Element size of one body: fine at the contact, growing with distance.

    The size is ``min(far_size, contact_size + growth * max(0, r - contact_extent))`` at the
    distance r from the contact point.

    Parameters
    ----------
    far_size : float                size far from the contact, m
    contact_size : float or None    size in the contact zone, m; None meshes with `far_size` alone
    contact_extent : float          radius of the zone of constant size, m
    contact_point : (2,) or None    centre of the zone, m; bodies that know their own contact
                                    (roller, half disc) fill it in
    growth : float                  increase of size per distance
    phase : float                   shift of the facet ends under the contact, in facets, 0..1

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

    def __post_init__(self) -> None:
        positive("sizing.far_size", self.far_size, "m")
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
    ) -> Sizing:
        """Sizing for a Hertz half-width: `edges` across it, constant out to `reach` of it.

        Quadratic elements with eight edges across the half-width, kept to 1.8 of it, resolve the
        subsurface maximum of the shear stress to about 0.3 %.
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
        """Whether there is a contact zone."""
        return self.contact_size is not None and self.contact_point is not None

    @property
    def steps(self) -> int:
        """Facets of `contact_size` on either side of the contact point (0 without a zone)."""
        if self.contact_size is None or self.contact_point is None:
            return 0
        return max(2, int(np.ceil(self.contact_extent / self.contact_size - 1e-9)))

    def field(self) -> SizeField:
        """The element size as a function of position."""
        spots: tuple[Spot, ...] = ()
        if self.contact_size is not None and self.contact_point is not None:
            spots = (Spot(self.contact_point, self.contact_size, self.contact_extent),)
        return SizeField(self.far_size, self.growth, spots)


@dataclass(frozen=True, eq=False)
class Spot:
    """A place of small elements: `size` within `extent` of `point` (m)."""

    point: Array
    size: float
    extent: float


@dataclass(frozen=True, eq=False)
class SizeField:
    """Element size as a function of position: the least of `far_size` and of every spot's size.

    Away from a spot its size grows by `growth` per distance.
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
        """One formula per spot, millimetres, in the language of gmsh's MathEval.

        The field is the least of them and of `far_size`. MathEval has no maximum;
        ``max(0, a) = (a + |a|)/2``.
        """
        texts = []
        for spot in self.spots:
            x, y = (_number(value) for value in spot.point)
            beyond = f"Sqrt((x-({x}))^2+(y-({y}))^2)-{_number(spot.extent)}"
            texts.append(f"{_number(spot.size)}+{0.5 * self.growth!r}*({beyond}+Fabs({beyond}))")
        return tuple(texts)

    def with_spot(self, point: ArrayLike, size: float, extent: float) -> SizeField:
        """This field with elements no larger than `size` within `extent` of `point`."""
        return replace(self, spots=(*self.spots, Spot(finite("spot", point), size, extent)))

    def capped(self, size: float) -> SizeField:
        """This field, nowhere larger than `size`."""
        return replace(self, far_size=min(self.far_size, size))

    def below(self, points: Array, limits: Array, slack: float = 1.25) -> SizeField:
        """This field with spots added until it stays under `slack * limits` (n,) at `points`.

        When that takes too many spots the whole field is capped instead.
        """
        result = self
        while len(result.spots) < _SPOTS_MAX:
            excess = result(points) / limits
            worst = int(np.argmax(excess))
            if not excess[worst] > slack:
                return result
            size = float(limits[worst])
            result = result.with_spot(points[:, worst], size, 8.0 * size)
        return self.capped(float(limits.min()))


def _number(metres: float) -> str:
    """A length in millimetres, written so that it reads back exactly."""
    return repr(float(metres) / MILLIMETRE)

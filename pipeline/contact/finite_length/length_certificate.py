"""Axial pressure by finite elements at chosen angles of a cycle, beside the half-spaces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.length_tiers import (
    SIZES,
    TierResult,
    both_tiers,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes

# Contacts whose half-widths lie within this ratio have the cells of the widest.
_ONE_MESH = 1.5


@dataclass(frozen=True, eq=False)
class LengthLoad:
    """Contact of bodies with ends at one cam angle, rad: force, N; moment, N m, about the middle.

    The curvature of the pair is that at the angle.
    """

    load_case: str
    theta: float
    pair: FinitePair
    force: float
    moment: float


@dataclass(frozen=True, eq=False)
class LengthPoint:
    """One contact by both tiers."""

    load: LengthLoad
    half_space: TierResult
    finite_elements: TierResult

    @property
    def difference(self) -> Array:
        """Half-spaces less finite elements (4,), over p0: centre, greatest, means at the ends."""
        values: Array = self.half_space.factors.all[0] - self.finite_elements.factors.all[0]
        return values


@dataclass(frozen=True, eq=False)
class LengthCertificate:
    """Points by both tiers, the first the most critical; cells per half-width."""

    points: tuple[LengthPoint, ...]
    mean_length: float
    elements: float


def length_certificate(
    loads: Sequence[LengthLoad],
    mean_length: float,
    elements: float = SIZES.per_half_width,
    advance: Callable[[int, int], None] = lambda *_: None,
) -> LengthCertificate:
    """Contacts by both tiers; bodies are condensed once for all loads of about one half-width.

    Parameters
    ----------
    loads : sequence      the most critical first
    mean_length : float   of the means at the ends, m
    elements : float      per half-width, at least
    advance : callable    receives the number of solved contacts and of all
    """
    ratio = SIZES.per_half_width / elements
    points = []
    for load, widest in zip(loads, _mesh_half_widths(loads), strict=True):
        tiers = both_tiers(
            load.pair,
            load.force,
            moment=load.moment,
            mean_length=mean_length,
            sizes=_sizes(ratio),
            mesh_half_width=widest,
        )
        points.append(LengthPoint(load, *tiers))
        advance(len(points), len(loads))
    return LengthCertificate(tuple(points), mean_length, elements)


def _mesh_half_widths(loads: Sequence[LengthLoad]) -> list[float]:
    """Half-width (m) of the cells of each load: of the widest within the ratio of one mesh."""
    half_widths = [plane_strain(load.pair, load.force)[0] for load in loads]
    meshes: list[float] = []
    for value in sorted(half_widths, reverse=True):
        if not meshes or value * _ONE_MESH < meshes[-1]:
            meshes.append(value)
    return [min(mesh for mesh in meshes if mesh >= value) for value in half_widths]


def _sizes(ratio: float) -> CellSizes:
    """Cells coarser by a ratio, as wide as those of one."""
    sizes = SIZES if ratio == 1 else SIZES.coarser(ratio)
    return replace(sizes, window=SIZES.window)

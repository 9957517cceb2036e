"""Axial pressure of two bodies over plane strain by half-spaces and by finite elements.

`half_space`: half-spaces with mirrored ends, for every angle of a cycle. `finite_elements`: blocks
of the length and depth of the bodies, their bases held; their compliance depends neither on
curvature nor on load and is kept on disk.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import elastic_body
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence, converged
from camwright.pipeline.contact.finite_length import brick_body, length_contact
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody, FinitePair, Straight
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid, QuarterCompliance
from camwright.pipeline.contact.finite_length.half_space import (
    shared_compliance,
)
from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.pressure_cells import (
    CellSizes,
    PressureCells,
    graded,
    pressure_cells,
)

TierName = Literal["half_space", "finite_elements"]
Condensed = Callable[[BrickGrid, float], QuarterCompliance]
"""Compliance of the cells of a block at a Poisson ratio."""

MEAN_LENGTH = 1e-4
"""Length of the mean pressure at an end, m."""

FACTORS = ("centre", "greatest", "end1_mean", "end2_mean")
"""Names of the columns of `AxialFactors.all`."""

SIZES = CellSizes()
# Ratio of the cells of successive meshes, and their sizes: the half-spaces on the last three, the
# finite elements on the first three.
_MESH_RATIO = 1.5
_MESHES = tuple(_MESH_RATIO**k for k in (2, 1, 0, -1))
# Ladder of half-widths and depths of the blocks, so that the compliances kept are shared.
_LADDER, _LADDER_START = 1.1, 1e-4
# Growth of the elements into the block and beside the contact.
_BLOCK_GROWTH = 2.0
# Width of a block to each side over that of its cells, at least.
_BLOCK_WIDTH = 2.0
# Greatest depth of a block over its first element, by memory; greatest tilt, rad.
_DEPTH_OVER_CELL, _TILT = 2e4, 0.1
# Moment over force and length up to which the load is not concentrated near an end.
_LIGHT_MOMENT = 0.2
# Width of the cells of tilted contacts, in half-widths: near one end the load is concentrated.
_TILTED = 5.0
# The same under the light loads of a cycle: at a chamfer the contact is up to 8 times as wide.
_OVER_CYCLE = 10.0
# Sizes along a crowned contact: where a tilt presses an end, a logarithmic crown drops by as much
# as the indentation within some micrometres.
_CROWNED_END, _CROWNED_UNIFORM, _CROWNED_GROWTH = 5e-6, 2, 1.8
_CROWNED_LARGEST, _CROWNED_SHARE = 2e-4, 1.0 / 18.0


@dataclass(frozen=True, eq=False)
class AxialFactors:
    """Pressures of `count` contacts over the plane-strain peak pressure at the mean line load.

    centre (count,); greatest (count,) of the centre line; end_means (count, 2) over the last
    `mean_length` (m) of contact at y < 0 and y > 0.
    """

    centre: Array
    greatest: Array
    end_means: Array
    mean_length: float

    def __post_init__(self) -> None:
        freeze(self, centre=self.centre, greatest=self.greatest, end_means=self.end_means)

    @classmethod
    def of(cls, contact: LengthContact, p0: ArrayLike, mean_length: float) -> AxialFactors:
        """Factors of contacts over p0 (count,), Pa."""
        peak = np.asarray(p0, dtype=float)
        ends = contact.end_means(mean_length)
        return cls(
            contact.centre / peak, contact.greatest / peak, ends / peak[..., None], mean_length
        )

    @property
    def all(self) -> Array:
        """Columns (count, 4): centre, greatest, both means."""
        return np.column_stack([self.centre, self.greatest, self.end_means])


@dataclass(frozen=True, eq=False)
class TierResult:
    """Contact by one tier: pressures, factors on the finest cells, mesh convergence.

    signed: pressure that is signed, over that of plane strain; at_corner: whether that is a mean.
    coarser: the contact on the next coarser of three meshes.
    """

    tier: TierName
    contact: LengthContact
    factors: AxialFactors
    convergence: tuple[Convergence, ...]
    signed: Convergence
    at_corner: bool
    unknowns: int
    coarser: LengthContact

    @property
    def greatest_is_at_an_end(self) -> bool:
        """Whether the greatest pressure is in the first or last cell of the centre line."""
        line = self.contact.centre_line[0]
        return int(line.argmax()) in (0, line.size - 1)


def cycle_sizes(pair: FinitePair) -> CellSizes:
    """Cells of contacts over a cycle: for any tilt; finer along a crowned contact, which is shorter
    under light loads.
    """
    sizes = CellSizes(window=_OVER_CYCLE)
    if isinstance(pair.crown, Straight):
        return sizes
    return replace(
        sizes,
        at_end=_CROWNED_END,
        uniform=_CROWNED_UNIFORM,
        growth=_CROWNED_GROWTH,
        largest=_CROWNED_LARGEST,
        largest_share=_CROWNED_SHARE,
    )


def on_ladder(length: float) -> float:
    """Length, m, rounded up to a step of the geometric ladder of half-widths and depths."""
    step = np.ceil(np.log(length / _LADDER_START) / np.log(_LADDER) - 1e-9)
    return float(_LADDER_START * _LADDER**step)


def least_window(pair: FinitePair, force: float, moment: float | None) -> float:
    """Least window of the cells under a force, N, and a moment, N m, which widens one end."""
    heavy = moment is not None and abs(moment) > _LIGHT_MOMENT * force * pair.contact_length
    return _TILTED if heavy else 0.0


def plane_strain(pair: FinitePair, force: float) -> tuple[float, float]:
    """Plane-strain half-width, m, and peak pressure, Pa, at the mean line load of a force, N."""
    half_width, p0 = hertz.line_contact(
        force / pair.contact_length, 1.0 / pair.curvature, pair.contact_modulus
    )
    return float(half_width), float(p0)


def both_tiers(
    pair: FinitePair,
    force: float,
    *,
    tilt: float | None = None,
    moment: float | None = None,
    mean_length: float = MEAN_LENGTH,
    sizes: CellSizes = SIZES,
    mesh_half_width: float | None = None,
    condensed: Condensed | None = None,
) -> tuple[TierResult, TierResult]:
    """Contact of one pair by half-spaces and by finite elements.

    Parameters
    ----------
    force : float         N, > 0
    tilt : float          rad, of the bases of the blocks; the half-spaces get its moment, as a
                          half-space has no base
    moment : float        N m, about y = 0, instead of the tilt
    mean_length : float   of the means at the ends, m
    sizes : CellSizes     of the cells; error bars by two coarser ones, of the half-spaces by a
                          coarser and a finer one
    mesh_half_width : float   m, of the cells; default: that of plane strain
    condensed : callable  compliance of a block; default: `condensed_block`

    Half-widths of the cells and depths of the blocks are rounded up to a ladder, so that bodies and
    loads that are nearly the same share the compliances kept.

    Raises
    ------
    InputError
        If force, tilt or moment is out of bounds.
    ContactError
        If the bodies tip over or the contact leaves its cells.
    """
    _require_load(pair, force, tilt, moment)
    half_width, p0 = plane_strain(pair, force)
    sizes = replace(sizes, window=max(sizes.window, least_window(pair, force, moment)))
    pair = with_depths_on_ladder(pair)
    mesh_width = mesh_half_width or half_width
    meshes = meshes_of(pair, mesh_width, sizes)
    blocks, unknowns = [], 0
    for cells in meshes[:-1]:
        compliance, unknowns = block_compliance(cells, pair.bodies, condensed)
        gap = cells.integrated_gap(pair)
        blocks.append(length_contact.solve(cells, compliance, gap, force, tilt=tilt, moment=moment))
    balanced = float(blocks[-1].moment[0])
    wide = on_ladder(mesh_width) / half_width
    fitted = replace(sizes.coarser(1.0 / _MESH_RATIO), window=wide * sizes.window)
    halves = [
        length_contact.solve(
            cells,
            shared_compliance(cells, pair.bodies),
            cells.integrated_gap(pair),
            force,
            moment=balanced,
        )
        for cells in (*meshes, pressure_cells(pair, half_width, fitted))
    ]
    lines = [_SignedLine.of(each, pair, p0, mean_length) for each in halves]
    by_blocks = [_SignedLine.of(each, pair, p0, mean_length) for each in blocks]
    return (
        _result("half_space", lines[1:-1], 1, 2 * meshes[2].areas.size),
        _result("finite_elements", by_blocks, 2, unknowns, (*lines[:3], lines[-1])),
    )


@dataclass(frozen=True, eq=False)
class _SignedLine:
    """One contact on one mesh: factors over plane strain; signed pressure, whether a mean."""

    contact: LengthContact
    factors: AxialFactors
    signed: float
    at_corner: bool

    @classmethod
    def of(
        cls, contact: LengthContact, pair: FinitePair, p0: float, mean_length: float
    ) -> _SignedLine:
        """Pressures of a contact over p0, Pa."""
        signed = length_contact.signed_pressure(
            contact.edges,
            contact.centre_line / p0,
            pair.contact_length,
            mean_length,
            has_corner=pair.has_singular_end,
        )
        factors = AxialFactors.of(contact, [p0], mean_length)
        return cls(contact, factors, float(signed.value[0]), bool(signed.at_corner[0]))

    @property
    def values(self) -> Array:
        """Factors and signed pressure (5,)."""
        return np.append(self.factors.all[0], self.signed)


def _result(
    tier: TierName,
    lines: Sequence[_SignedLine],
    place: int,
    unknowns: int,
    halves: Sequence[_SignedLine] = (),
) -> TierResult:
    """Result of one method, with error bars, from a contact on three meshes.

    Parameters
    ----------
    lines : three _SignedLine           coarse to fine
    place : int                         number of the mesh whose contact is kept
    unknowns : int                      of the finest mesh
    halves : four _SignedLine or none   by half-spaces on the same cells, and on finer ones that fit
        the contact
    """
    values = np.array([each.values for each in lines]).T
    beside = np.array([each.values for each in halves]).T if halves else [None] * len(values)
    *factors, signed = (_converged(*each) for each in zip(values, beside, strict=True))
    return TierResult(
        tier,
        lines[place].contact,
        lines[-1].factors,
        tuple(factors),
        signed,
        lines[-1].at_corner,
        unknowns,
        lines[-2].contact,
    )


def _converged(values: Array, halves: Array | None) -> Convergence:
    """Convergence of a pressure on three meshes.

    Cells wider than the contact needs scatter it, and err alike in both tiers: of values without an
    observed order, the error of the half-spaces on the same cells is taken off before the bar is
    taken, and added to it; the lesser bar holds. A pressure that is zero, in the middle of a line
    which its tilt lifts there, scatters by nothing.

    Parameters
    ----------
    values : array (3,)           coarse to fine
    halves : array (4,) or None   by half-spaces on the same cells, and on finer ones that fit the
        contact
    """
    plain = converged(values.tolist(), _MESH_RATIO)
    if halves is None or plain.order is not None or not (halves > 0.0).all():
        return plain
    corrected = values * halves[-1] / halves[:-1]
    freed = converged(corrected.tolist(), _MESH_RATIO)
    bar = freed.gci + abs(float(corrected[-1] / values[-1]) - 1.0)
    return plain if plain.gci <= bar else replace(freed, values=plain.values, gci=bar)


def with_depths_on_ladder(pair: FinitePair) -> FinitePair:
    """Pair with the depths of its blocks rounded up to the ladder."""
    first, second = (replace(body, depth=on_ladder(body.depth)) for body in pair.bodies)
    return replace(pair, bodies=(first, second))


def meshes_of(pair: FinitePair, half_width: float, sizes: CellSizes) -> list[PressureCells]:
    """Cells of both tiers, coarse to fine; finite elements use all but the finest."""
    return [pressure_cells(pair, on_ladder(half_width), sizes.coarser(each)) for each in _MESHES]


def _require_load(pair: FinitePair, force: float, tilt: float | None, moment: float | None) -> None:
    """Refuse a force that is not positive, a tilt or moment beyond its bound, and both at once."""
    if not 0 < force < np.inf:
        raise InputError("force", force, "> 0 N")
    if tilt is not None and not abs(tilt) < _TILT:
        raise InputError("tilt", shown(tilt, "mrad"), f"within {shown(_TILT, 'mrad')}")
    if moment is not None:
        if tilt is not None:
            raise InputError("moment", moment, "left out beside a tilt")
        most = 0.5 * force * pair.contact_length
        if not abs(moment) < most:
            limit = f"within {shown(most, 'N mm')}, the force at an end"
            raise InputError("moment", shown(moment, "N mm"), limit)


def block_compliance(
    cells: PressureCells,
    bodies: tuple[FiniteBody, FiniteBody],
    condensed: Condensed | None = None,
) -> tuple[Array, int]:
    """Compliance (n, n), m3/Pa, of the cells on both blocks together, and the number of unknowns of
    both.

    Parameters
    ----------
    condensed : callable   compliance of a block; default: `condensed_block`
    """
    solve = condensed or condensed_block
    total, unknowns = np.zeros((cells.areas.size, cells.areas.size)), 0
    for body in bodies:
        grid = block_grid(cells, body)
        quarter = solve(grid, body.material.poisson)
        total += quarter.both_sides(grid.cells[0]) / body.material.modulus
        unknowns += 2 * grid.unknowns  # of both symmetries
    return total, unknowns


def block_grid(cells: PressureCells, body: FiniteBody) -> BrickGrid:
    """Element grid of a quarter of a block.

    Its half-width is its depth, or twice the half-width of the cells where that is larger.

    Raises
    ------
    InputError
        If the block is not deeper than half of the cells' width, or too deep for elements of that
        size.
    """
    if not body.depth < _DEPTH_OVER_CELL * cells.x[1]:
        limit = f"< {shown(_DEPTH_OVER_CELL * cells.x[1], 'mm')} at this half-width"
        raise InputError("depth", shown(body.depth, "mm"), limit)
    if not body.depth > cells.x[-1]:
        limit = f"> {shown(cells.x[-1], 'mm')}, half the width of the cells"
        raise InputError("depth", shown(body.depth, "mm"), limit)
    middle = cells.shape[0] // 2
    x, y = cells.x, cells.y[middle:]
    width = max(body.depth, _BLOCK_WIDTH * x[-1])
    beside = graded(width - x[-1], x[-1] - x[-2], _BLOCK_GROWTH, np.inf)
    deep = graded(body.depth, x[1], _BLOCK_GROWTH, np.inf)
    step, overhang = y[-1] - y[-2], 0.5 * body.length - y[-1]
    if overhang > 0.5 * step:
        y = np.concatenate([y, y[-1] + graded(overhang, step, SIZES.growth, np.inf)[1:]])
    return BrickGrid(np.concatenate([x, x[-1] + beside[1:]]), y, deep, (cells.shape[1], middle))


def condensed_block(grid: BrickGrid, poisson: float) -> QuarterCompliance:
    """Compliance of a block, from memory, from the disk cache, or computed."""
    axes = grid.x.tobytes(), grid.y.tobytes(), grid.z.tobytes()
    return condensed_block_of(*axes, grid.cells, poisson)


def is_kept(grid: BrickGrid, poisson: float) -> bool:
    """Whether the disk cache holds the compliance of a block."""
    return disk_cache.holds(_KEPT_AS, _inputs(grid, poisson), _MODULES)


@lru_cache(maxsize=8)
def condensed_block_of(
    x: bytes, y: bytes, z: bytes, cells: tuple[int, int], poisson: float
) -> QuarterCompliance:
    """Compliance of a block by the bytes of its grid, which are hashable; see `condensed_block`."""
    grid = BrickGrid(np.frombuffer(x), np.frombuffer(y), np.frombuffer(z), cells)

    def compute() -> dict[str, Array]:
        quarter = brick_body.condensed(grid, poisson)
        return {"symmetric": quarter.symmetric, "antisymmetric": quarter.antisymmetric}

    arrays = disk_cache.kept(_KEPT_AS, _inputs(grid, poisson), compute, _MODULES)
    return QuarterCompliance(**arrays)


def _inputs(grid: BrickGrid, poisson: float) -> Hashable:
    return tuple(grid.x), tuple(grid.y), tuple(grid.z), grid.cells, poisson


_KEPT_AS, _MODULES = "block", (brick_body, elastic_body)

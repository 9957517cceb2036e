"""Axial pressure by finite elements at chosen angles of a cycle, to certify the half-spaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import ContactError
from camwright.pipeline.base.worker_processes import ALONE, Crew, PendingCall
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid, QuarterCompliance
from camwright.pipeline.contact.finite_length.half_space import shared_compliance
from camwright.pipeline.contact.finite_length.length_tiers import (
    SIZES,
    TierResult,
    block_grid,
    both_tiers,
    condensed_block,
    is_kept,
    least_window,
    meshes_of,
    plane_strain,
    with_depths_on_ladder,
)
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes, PressureCells

# Contacts whose half-widths lie within this ratio have the cells of the widest.
ONE_MESH = 1.5
# Widths of the cells in half-widths, ascending: the contact is wide at a chamfer under light loads.
_WINDOWS = (SIZES.window, 5.0, 10.0)


@dataclass(frozen=True, eq=False)
class LengthLoad:
    """Contact of finite length at one cam angle, rad: force, N; moment about the middle, N m.

    The curvature of the pair is that at the angle. factor, centre: signed pressure and pressure in
    the middle by the half-spaces of the cycle, over plane strain. second: on the second of
    preloaded discs; bears_less: on that of them which bears less there.
    """

    load_case: str
    theta: float
    pair: FinitePair
    force: float
    moment: float
    factor: float
    centre: float
    second: bool = False
    bears_less: bool = False


@dataclass(frozen=True, eq=False)
class LengthPoint:
    """Contact at one cam angle by half-spaces and by finite elements."""

    load: LengthLoad
    half_space: TierResult
    finite_elements: TierResult

    @property
    def difference(self) -> Array:
        """Half-spaces less finite elements (4,), over p0: centre, greatest, means at the ends."""
        values: Array = self.half_space.factors.all[0] - self.finite_elements.factors.all[0]
        return values

    @property
    def ratio(self) -> float:
        """Stated pressure, finite elements over the half-spaces of the cycle."""
        return self.finite_elements.signed.values[-1] / self.load.factor

    @property
    def centre_ratio(self) -> float:
        """Pressure in the middle, finite elements over the half-spaces of the cycle; 1 where its
        tilt lifts the line there.
        """
        if not self.load.centre > 0.0:
            return 1.0
        return float(self.finite_elements.factors.centre[0]) / self.load.centre


@dataclass(frozen=True)
class EndCorrection:
    """Ratio of finite elements to the half-spaces of the cycle, with relative error bars.

    Greatest ratios and bars of the certified angles: of the signed pressure, of the middle; of one
    disc, or of that which carries at each angle (n,).
    """

    signed: Value
    signed_error: Value
    centre: Value
    centre_error: Value

    @classmethod
    def of_points(cls, points: Sequence[LengthPoint]) -> EndCorrection:
        """Greatest ratios of finite elements to half-spaces over points, with their error bars."""
        blocks = [point.finite_elements for point in points]
        return cls(
            max(point.ratio for point in points),
            max(each.signed.gci for each in blocks),
            max(point.centre_ratio for point in points),
            max(each.convergence[0].gci for each in blocks),
        )

    def where(self, first: NDArray[np.bool_], other: EndCorrection) -> EndCorrection:
        """This correction at some angles (n,), that of another disc at the others."""
        pairs = zip(astuple(self), astuple(other), strict=True)
        return EndCorrection(*(np.where(first, *pair) for pair in pairs))


@dataclass(frozen=True, eq=False)
class LengthCertificate:
    """Points by half-spaces and finite elements, the most critical first; cells per half-width.

    refused: why finite elements cannot solve the contact, without points then.
    """

    points: tuple[LengthPoint, ...]
    mean_length: float
    elements: float
    refused: str = ""

    @property
    def corrections(self) -> tuple[EndCorrection, ...]:
        """Correction by all points; of two preloaded discs that of each by its own. Empty without
        points.
        """
        both = [[one for one in self.points if one.load.second is at] for at in (False, True)]
        return tuple(EndCorrection.of_points(points) for points in both if points)


@dataclass(frozen=True, eq=False)
class _Mesh:
    """Half-width, m, and sizes of the cells of loads of about one half-width."""

    half_width: float
    sizes: CellSizes


@dataclass(frozen=True, eq=False)
class BegunEnds:
    """Certificate whose blocks are being condensed in worker processes; see `begun_ends`.

    fresh: number of blocks that are not in the disk cache.
    """

    loads: tuple[LengthLoad, ...]
    mean_length: float
    elements: float
    meshes: tuple[_Mesh, ...]
    blocks: Mapping[object, PendingCall]
    fresh: int

    def certificate(
        self, advance: Callable[[int, int], None] = lambda *_: None
    ) -> LengthCertificate:
        """Certificate once its blocks are condensed: each load by half-spaces and by finite
        elements.

        advance : callable   receives the number of condensed blocks and solved loads, and of all

        Raises
        ------
        ContactError
            If a contact leaves its cells or the bodies tip over.
        """
        total, steps = len(self.blocks) + len(self.loads), 0
        for task in self.blocks.values():
            task.result()
            steps += 1
            advance(steps, total)

        def condensed(grid: BrickGrid, poisson: float) -> QuarterCompliance:
            quarter: QuarterCompliance = self.blocks[_key(grid, poisson)].result()
            return quarter

        points = []
        for load, mesh in zip(self.loads, self.meshes, strict=True):
            tiers = both_tiers(
                load.pair,
                load.force,
                moment=load.moment,
                mean_length=self.mean_length,
                sizes=mesh.sizes,
                mesh_half_width=mesh.half_width,
                condensed=condensed,
            )
            points.append(LengthPoint(load, *tiers))
            steps += 1
            advance(steps, total)
        return LengthCertificate(tuple(points), self.mean_length, self.elements)


def begun_ends(
    loads: Sequence[LengthLoad],
    mean_length: float,
    elements: float = SIZES.per_half_width,
    workers: Crew = ALONE,
) -> BegunEnds:
    """Certificate of contacts with its blocks submitted to worker processes.

    Bodies are condensed once for all loads of about one half-width.

    Parameters
    ----------
    loads : sequence      the most critical first
    mean_length : float   of the means at the ends, m
    elements : float      cells per half-width of contact, at least

    Raises
    ------
    InputError
        If a block is not deep enough for the width of its contact.
    ContactError
        If a contact is wider than the widest cells.
    """
    meshes = _meshes(loads, SIZES.per_half_width / elements)
    grids: dict[object, tuple[BrickGrid, float]] = {}
    for load, mesh in zip(loads, meshes, strict=True):
        pair = with_depths_on_ladder(load.pair)
        for cells in reversed(meshes_of(pair, mesh.half_width, mesh.sizes)[:-1]):
            for body in pair.bodies:
                grid, poisson = block_grid(cells, body), body.material.poisson
                grids[_key(grid, poisson)] = grid, poisson
    fresh = sum(not is_kept(*each) for each in grids.values())
    tasks = {key: workers.submit(condensed_block, *each) for key, each in grids.items()}
    return BegunEnds(tuple(loads), mean_length, elements, meshes, tasks, fresh)


def _key(grid: BrickGrid, poisson: float) -> object:
    return grid.x.tobytes(), grid.y.tobytes(), grid.z.tobytes(), grid.cells, poisson


def _meshes(loads: Sequence[LengthLoad], ratio: float) -> tuple[_Mesh, ...]:
    """Mesh of each load; loads whose half-widths differ by less than the ratio `ONE_MESH` share
    that of the widest.

    Parameters
    ----------
    ratio : float   cell sizes over those of `SIZES`, 1 or more

    Raises
    ------
    ContactError
        If a contact is wider than the widest cells.
    """
    half_widths = [plane_strain(load.pair, load.force)[0] for load in loads]
    groups: list[float] = []
    for value in sorted(half_widths, reverse=True):
        if not groups or value * ONE_MESH < groups[-1]:
            groups.append(value)
    widest = [min(group for group in groups if group >= value) for value in half_widths]
    meshes = {}
    for group in groups:
        members = [load for load, mesh in zip(loads, widest, strict=True) if mesh == group]
        meshes[group] = _Mesh(group, _sizes(members, group, ratio))
    return tuple(meshes[each] for each in widest)


def _sizes(loads: Sequence[LengthLoad], half_width: float, ratio: float) -> CellSizes:
    """Cell sizes `ratio` times those of `SIZES`, whose window covers the contacts of all loads by
    half-spaces.

    Parameters
    ----------
    half_width : float   of the cells, m

    Raises
    ------
    ContactError
        If a contact is wider than the widest window.
    """
    sizes = SIZES if ratio == 1 else SIZES.coarser(ratio)
    least = max(least_window(load.pair, load.force, load.moment) for load in loads)
    for window in _WINDOWS:
        chosen = replace(sizes, window=max(window, least))
        if all(_is_covered(load, half_width, chosen) for load in loads):
            return chosen
    raise ContactError("contact wider than the window of its pressure cells")


def _is_covered(load: LengthLoad, half_width: float, sizes: CellSizes) -> bool:
    """Whether the contact of a load, by half-spaces, leaves the last two cells across it without
    pressure; False where it cannot be solved.
    """
    cells: PressureCells = meshes_of(load.pair, half_width, sizes)[1]
    try:
        contact = length_contact.solve(
            cells,
            shared_compliance(cells, load.pair.bodies),
            cells.integrated_gap(load.pair),
            load.force,
            moment=load.moment,
        )
    except ContactError:
        return False
    return not (contact.pressure[:, :, -2:] > 0).any()

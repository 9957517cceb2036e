"""Axial pressure of one pair of bodies by half-spaces, interpolated in a table kept on disk.

The pressure over the peak pressure of plane strain depends on the half-width and on the moment over
force and length; with a crown or a rounded end on the line load, too. The centre line is tabulated,
so that its greatest value and the means at its ends follow at any place of the table. A node is
computed when an interpolation first needs it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import active_set
from camwright.pipeline.contact.finite_length import (
    half_space,
    length_contact,
    length_tiers,
    pressure_cells,
)
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair, Straight
from camwright.pipeline.contact.finite_length.length_tiers import AxialFactors, cycle_sizes

Index = NDArray[np.intp]

# Ratios of the half-widths, without and with a crown, and of the line loads of neighbouring nodes;
# nodes of ladder index 0.
_WIDTH_RATIO, _CROWNED_WIDTH_RATIO, _LOAD_RATIO = 2.0, 3.0, 2.0
_WIDTH, _LOAD = 1e-4, 1e5  # m, N/m
# Moments over force and length: of light tilts, and up to a force near the end of the contact.
_LIGHT: Array = np.linspace(0.0, 0.24, 9)
_HEAVY: Array = np.array([0.265, 0.29, 0.315, 0.34, 0.36, 0.38, 0.40, 0.415, 0.43, 0.44, 0.45])
_MOMENTS = np.concatenate([_LIGHT, _HEAVY])
_SIGNED: Array = np.concatenate([-_MOMENTS[:0:-1], _MOMENTS])
_ZERO = _MOMENTS.size - 1
# Fewest cells along a crowned contact; its approach over load per length and pi E* at most.
_FEWEST, _APPROACH = 4, 60.0
# Ratio by which the load of a shorter contact is raised, and how often at most.
_RAISE, _RAISES = 2.0, 60

_FEW = 3000  # rows of an interpolation: those of a turn, untilted and tilted to both sides

# Errors of the interpolation, verified by tests.
_ERROR, _CROWNED_ERROR, _ROUNDED_ERROR = 2e-3, 5e-3, 0.1

GREATEST_MOMENT = float(_MOMENTS[-1])
"""Greatest moment over force and length of contact: the force acts near the end."""


@dataclass(frozen=True, eq=False)
class FactorTable:
    """Factors of a pair of bodies over half-width, moment and, where it matters, line load.

    mean_length (m) of the means at the ends; the curvature of the pair is not used. A crowned
    contact too light for the cells, shorter than four of them, has the pressure of the lightest one
    that is not: an upper bound.
    """

    pair: FinitePair
    mean_length: float
    _nodes: dict[tuple[int, int], _Node] = field(default_factory=dict, repr=False)

    @property
    def interpolation_error(self) -> float:
        """Error of centre, greatest and mean pressure at a singular end, over the greatest.

        Up to a moment of 0.2 of force and length; three times that beyond. The cells of a rounded
        end do not resolve its peak better.
        """
        if self._is_rounded:
            return _ROUNDED_ERROR
        return _ERROR if isinstance(self.pair.crown, Straight) else _CROWNED_ERROR

    def factors(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike = 0.0
    ) -> AxialFactors:
        """Factors of `count` contacts.

        Parameters
        ----------
        curvature : array (count,)  1/m, > 0
        force : array (count,)      N, > 0
        moment : array (count,)     N m, about y = 0

        Raises
        ------
        InputError
            If an input is out of bounds.
        """
        edges, line, peaks = self._interpolated(curvature, force, moment)
        middle = (edges.size - 1) // 2
        means, _ = length_contact.means_at_ends(edges, line, self.mean_length)
        centre = 0.5 * (line[:, middle - 1] + line[:, middle])
        # The steep peak of a rounded end moves from cell to cell with the load.
        greatest = (peaks if self._is_rounded else line).max(axis=1)
        return AxialFactors(centre, greatest, means, self.mean_length)

    def axial_pressure(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Edges (m + 1,), m, along y and pressures (count, m) over plane-strain p0, x = 0.

        Inputs as those of `factors`.
        """
        edges, line, _ = self._interpolated(curvature, force, moment)
        return edges, line

    def _interpolated(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike
    ) -> tuple[Array, Array, Array]:
        """Edges, pressures of `axial_pressure`; greatest of the nodes at y < 0 and y > 0."""
        kappa, load, couple = _alike(curvature, force, moment)
        share = couple / (load * self.pair.contact_length)
        if not (np.abs(share) <= GREATEST_MOMENT).all():
            worst = int(np.argmax(np.abs(share)))
            most = GREATEST_MOMENT * load[worst] * self.pair.contact_length
            raise InputError("moment", float(couple[worst]), f"within {most:.4g} N m, near an end")
        place = self._place(kappa, load, share)
        first, weights = _moment_stencil(share)
        nodes, columns, values = place.rows
        # Rows of the table: every node has one row per moment.
        columns = columns[:, :, None] * _SIGNED.size + (first[:, None] + np.arange(4))[:, None]
        values = values[:, :, None] * weights[:, None]
        edges, lines = _lines(tuple(nodes))
        flat = (load.size, -1)
        interpolated = _weighted(columns.reshape(flat), values.reshape(flat), lines)
        scaled = np.maximum(interpolated, 0.0) * place.factor[:, None]
        return edges, scaled[:, :-2], scaled[:, -2:]

    def moment_at_tilt(self, curvature: ArrayLike, force: ArrayLike, tilt: ArrayLike) -> Array:
        """Moment (count,), N m, of contacts tilted by `tilt` (count,), rad, as half-spaces.

        At most `GREATEST_MOMENT` of force and length.
        """
        kappa, load, angle = _alike(curvature, force, tilt)
        share = np.zeros(load.size)
        for _ in range(2):
            place = self._place(kappa, load, share)
            nodes, columns, values = place.rows
            turns = _weighted(columns, values, np.array([node.turn for node in nodes]))
            half_width, _ = self._hertz(kappa, place.load)
            target = angle * self.pair.contact_length / (kappa * half_width**2)
            # The second pass has the heavy tilts of those beyond the light ones.
            inner = turns[:, _ZERO - _LIGHT.size + 2], turns[:, _ZERO + _LIGHT.size - 2]
            beyond = (target < inner[0]) | (target > inner[1])
            if not beyond.any() or not (share[beyond] <= _LIGHT[-1]).all():
                break
            share = np.where(beyond, GREATEST_MOMENT, share)
        return np.asarray(_inverse(turns, target) * load * self.pair.contact_length)

    @property
    def _depends_on_load(self) -> bool:
        return self._is_rounded or not isinstance(self.pair.crown, Straight)

    @property
    def _width_ratio(self) -> float:
        return _WIDTH_RATIO if isinstance(self.pair.crown, Straight) else _CROWNED_WIDTH_RATIO

    @property
    def _is_rounded(self) -> bool:
        return any(body.end.kind == "radius" for body in self.pair.bodies)

    def _hertz(self, curvature: Array, force: Array) -> tuple[Array, Array]:
        return hertz.line_contact(
            force / self.pair.contact_length, 1.0 / curvature, self.pair.contact_modulus
        )

    def _place(self, curvature: Array, force: Array, share: Array) -> _Place:
        """Nodes and weights of contacts, with loads raised where a crowned contact is too light."""
        load = force.copy()
        heavy = np.abs(share) > _LIGHT[-2]
        for _ in range(_RAISES):
            half_width, _ = self._hertz(curvature, load)
            across = np.log(half_width / _WIDTH) / np.log(self._width_ratio)
            along = np.zeros_like(across)
            if self._depends_on_load:
                line_load = load / self.pair.contact_length
                along = np.log(line_load / _LOAD) / np.log(_LOAD_RATIO)
            place = self._stencils(across, along, heavy, np.sqrt(load / force), load)
            nodes, columns, _ = place.rows
            light = np.array([node.is_too_light for node in nodes])[columns].any(axis=1)
            lacks = ~np.array([node.is_heavy for node in nodes])[columns].all(axis=1)
            light |= heavy & lacks
            if not light.any():
                return place
            load = np.where(light, load * _RAISE, load)
        raise ContactError("crown: the contact does not fill its cells under any load")

    def _stencils(
        self, across: Array, along: Array, heavy: NDArray[np.bool_], factor: Array, load: Array
    ) -> _Place:
        first, width_weights = _uniform_stencil(across)
        if self._depends_on_load:
            second, load_weights = _uniform_stencil(along)
        else:
            second, load_weights = np.zeros_like(first), np.ones((across.size, 1))
        size = load_weights.shape[1]
        least, count = second.min(), np.ptp(second) + 1
        corners, inverse = np.unique(first * count + (second - least), return_inverse=True)
        pairs = zip((corners // count).tolist(), (corners % count + least).tolist(), strict=True)
        reach = [[(a + i, b + j) for i in range(4) for j in range(size)] for a, b in pairs]
        has_heavy = np.bincount(inverse, heavy, minlength=len(reach)) > 0
        needed: dict[tuple[int, int], bool] = {}
        for cells, is_heavy in zip(reach, has_heavy.tolist(), strict=True):
            for key in cells:
                needed[key] = needed.get(key, False) or is_heavy
        keys = sorted(needed)
        nodes = [self._node(key, heavy=needed[key]) for key in keys]
        number = {key: index for index, key in enumerate(keys)}
        columns = np.array([[number[key] for key in cells] for cells in reach])[inverse]
        weights = (width_weights[:, :, None] * load_weights[:, None, :]).reshape(columns.shape)
        return _Place((nodes, columns, weights), factor, load)

    def _node(self, key: tuple[int, int], *, heavy: bool) -> _Node:
        if key not in self._nodes:
            self._nodes[key] = self._computed(key, _LIGHT)
        known = self._nodes[key]
        if heavy and not known.is_tried and not known.is_too_light:
            self._nodes[key] = known.joined(self._computed(key, _HEAVY))
        return self._nodes[key]

    def _computed(self, key: tuple[int, int], moments: Array) -> _Node:
        """Pressures of one half-width and line load at moments, from the disk cache or computed."""
        half_width, line_load = _WIDTH * self._width_ratio ** key[0], _LOAD * _LOAD_RATIO ** key[1]
        curvature = 4.0 * line_load / (np.pi * self.pair.contact_modulus * half_width**2)
        here = replace(self.pair, curvature=curvature)
        cells = pressure_cells.pressure_cells(here, half_width, cycle_sizes(self.pair))
        middle = cells.shape[0] // 2
        drops = here.crown.drop(cells.y[[middle - _FEWEST // 2, middle + _FEWEST // 2]])
        if drops.min() > _APPROACH * line_load / (np.pi * self.pair.contact_modulus):
            return _Node.of(cells.y, moments, np.empty((0, cells.shape[0])), np.empty(0))
        gap = cells.integrated_gap(here)
        if not self.pair.is_symmetric:
            moments = np.concatenate([-moments[moments > 0][::-1], moments])
        bodies = tuple((body.material, body.length) for body in self.pair.bodies)

        def compute() -> dict[str, Array]:
            force = line_load * self.pair.contact_length
            couples = moments * force * self.pair.contact_length
            compliance = half_space.shared_compliance(cells, self.pair.bodies)
            # A crowned contact is begun with all cells: from others its active set may recur.
            near = None if self._depends_on_load else cells.centres[0] < half_width
            gaps = np.tile(gap, (moments.size, 1))
            try:
                level = length_contact.solve(cells, compliance, gap, force, guess=near)
                if np.count_nonzero(level.centre_line > 0) < _FEWEST:
                    raise ContactError("contact of too few cells to be tilted")
                contact = length_contact.solve(
                    cells,
                    compliance,
                    gaps,
                    force,
                    moment=couples,
                    guess=level.pressure.ravel() > 0,
                )
            except ContactError:
                if not self._depends_on_load:
                    raise
                return {"line": np.empty((0, cells.shape[0])), "turn": np.empty(0)}
            p0 = 0.5 * self.pair.contact_modulus * curvature * half_width
            turn = contact.tilt * self.pair.contact_length / (curvature * half_width**2)
            return {"line": contact.centre_line / p0, "turn": turn}

        inputs = (cells.x.tobytes(), cells.y.tobytes(), gap.tobytes(), bodies, moments.tobytes())
        modules = (active_set, half_space, length_contact, length_tiers, pressure_cells)
        kept = disk_cache.kept("factors", inputs, compute, modules)
        return _Node.of(cells.y, moments, kept["line"], kept["turn"])


@dataclass(frozen=True, eq=False)
class _Place:
    """Nodes, columns (count, k) and weights; factor (count,) of p0; loads (count,), N."""

    rows: tuple[list[_Node], Index, Array]
    factor: Array
    load: Array


@dataclass(frozen=True, eq=False)
class _Node:
    """Edges (m + 1,), m, along y; line (2 moments - 1, m) over p0, turn (2 moments - 1,).

    The turn is the tilt times the length over curvature and half-width squared. Rows of heavy
    tilts are not numbers before they are tried, or where the contact leaves its cells.
    """

    edges: Array
    line: Array
    turn: Array
    is_tried: bool = False

    @classmethod
    def of(cls, edges: Array, moments: Array, line: Array, turn: Array) -> _Node:
        """Rows of all moments from those computed; those below zero by symmetry where left out."""
        lines, turns = (
            np.full((_SIGNED.size, edges.size - 1), np.nan),
            np.full(_SIGNED.size, np.nan),
        )
        if len(line):
            signs = (1,) if (moments < 0).any() else (-1, 1)
            for sign in signs:
                rows = np.searchsorted(_SIGNED, sign * moments - 1e-9)
                lines[rows], turns[rows] = line[:, ::sign], sign * turn
        return cls(edges, lines, turns)

    def joined(self, other: _Node) -> _Node:
        """The rows of both."""
        here = np.isfinite(self.turn)
        lines = np.where(here[:, None], self.line, other.line)
        return _Node(self.edges, lines, np.where(here, self.turn, other.turn), is_tried=True)

    @cached_property
    def is_heavy(self) -> bool:
        """Whether the rows of heavy tilts are computed."""
        return bool(np.isfinite(self.turn[[0, -1]]).all())

    @cached_property
    def is_too_light(self) -> bool:
        """Whether the untilted contact covers too few cells."""
        return not np.count_nonzero(self.line[_ZERO] > 0) >= _FEWEST


def factor_table(pair: FinitePair, mean_length: float) -> FactorTable:
    """Table of a pair of bodies; nodes come from the disk cache, or are computed where needed.

    Parameters
    ----------
    pair : FinitePair     its curvature and the depths of its bodies are not used
    mean_length : float   of the means at the ends, m
    """
    if not 0 < mean_length <= pair.contact_length:
        raise InputError("mean_length", mean_length, f"in (0, {pair.contact_length:.4g}] m")
    return FactorTable(pair, mean_length)


@lru_cache(maxsize=16)
def _lines(nodes: tuple[_Node, ...]) -> tuple[Array, Array]:
    """Edges of the longest nodes; their pressures and greatest of both halves as rows."""
    widest = max(nodes, key=lambda node: node.edges.size).edges
    padded = []
    for node in nodes:
        beyond = (widest.size - node.edges.size) // 2
        halves = np.split(node.line, 2, axis=1)
        peaks = [half.max(axis=1) for half in halves]
        padded.append(np.column_stack([np.pad(node.line, ((0, 0), (beyond, beyond))), *peaks]))
    return widest, readonly(np.concatenate(padded))


def _alike(*values: ArrayLike) -> list[Array]:
    """Curvature, force and a third input as arrays (count,)."""
    arrays = [np.atleast_1d(np.asarray(value, dtype=float)) for value in values]
    kappa, load, third = np.broadcast_arrays(*arrays)
    for name, each in (("curvature", kappa), ("force", load)):
        if not ((each > 0) & np.isfinite(each)).all():
            raise InputError(name, float(each[~((each > 0) & np.isfinite(each))][0]), "> 0")
    if not np.isfinite(third).all():
        raise InputError("moment or tilt", float(third[~np.isfinite(third)][0]), "finite")
    return [kappa, load, third]


def _uniform_stencil(position: Array) -> tuple[Index, Array]:
    """First index (count,) and Lagrange weights (count, 4) at positions on a uniform ladder."""
    base = np.floor(position).astype(np.intp)
    return base - 1, _lagrange(
        position - base, np.broadcast_to(np.arange(-1.0, 3.0), (base.size, 4))
    )


def _moment_stencil(share: Array) -> tuple[Index, Array]:
    """First row (count,) of four moments and their Lagrange weights (count, 4)."""
    after = np.searchsorted(_SIGNED, share, side="right")
    first = np.clip(after - 2, 0, _SIGNED.size - 4).astype(np.intp)
    return first, _lagrange(share, _SIGNED[first[:, None] + np.arange(4)])


def _lagrange(place: Array, nodes: Array) -> Array:
    """Weights (count, 4) of the cubic through four nodes (count, 4)."""
    weights = np.ones(nodes.shape)
    for i in range(4):
        for j in _others(i):
            weights[:, i] *= (place - nodes[:, j]) / (nodes[:, i] - nodes[:, j])
    return weights


def _others(i: int) -> Iterable[int]:
    return (j for j in range(4) if j != i)


def _weighted(columns: Index, weights: Array, table: Array) -> Array:
    """Rows (count, m): weighted sums of the rows `columns` (count, k) of a table (rows, m).

    Of many rows as a sparse matrix, whose import takes a tenth of a second; the sums are the same.
    """
    count, size = columns.shape
    if count > _FEW:
        starts = np.arange(0, count * size + 1, size)
        matrix = scipy.sparse.csr_array(
            (weights.ravel(), columns.ravel(), starts), shape=(count, len(table))
        )
        return np.asarray(matrix @ table)
    sums = np.zeros((count, table.shape[1]))
    for column, weight in zip(columns.T, weights.T, strict=True):
        sums += weight[:, None] * table[column]
    return sums


def _inverse(turns: Array, target: Array) -> Array:
    """Moments (count,) over force and length at turns `target` of ascending rows (count, k)."""
    known = np.where(np.isfinite(turns), turns, np.where(_SIGNED < 0, -np.inf, np.inf))
    after = (known <= target[:, None]).sum(axis=1)
    low = np.argmax(np.isfinite(turns), axis=1)
    high = turns.shape[1] - 1 - np.argmax(np.isfinite(turns[:, ::-1]), axis=1)
    clipped = np.clip(after, low + 1, high)
    first = np.clip(clipped - 2, low, high - 3)
    rows = np.arange(target.size)
    knots = first[:, None] + np.arange(4)
    place = np.clip(target, known[rows, low], known[rows, high])
    weights = _lagrange(place, turns[rows[:, None], knots])
    moments = (weights * _SIGNED[knots]).sum(axis=1)
    return np.asarray(np.clip(moments, _SIGNED[clipped - 1], _SIGNED[clipped]))

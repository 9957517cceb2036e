"""Axial pressure factors of a pair of bodies by half-spaces, interpolated in a cached table.

The pressure over the peak pressure of plane strain depends on the half-width and on the moment over
force and length; with a crown or a rounded end on the line load, too. The centre line is tabulated,
so that its greatest value and the means at its ends follow at any place of the table. A node is
computed when an interpolation first needs it. The cells of a crowned or rounded contact follow it
from node to node: their edges are interpolated as their pressures are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache, units
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import active_set
from camwright.pipeline.contact.finite_length import (
    axial_drop,
    contact_span,
    half_space,
    length_contact,
    length_tiers,
    pressure_cells,
)
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair, Straight
from camwright.pipeline.contact.finite_length.length_contact import WideContactError
from camwright.pipeline.contact.finite_length.length_tiers import AxialFactors, cycle_sizes
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes

Index = NDArray[np.intp]

# Ratios of neighbouring nodes: of half-widths; where the load matters of line loads and curvatures,
# with straight lines between rounded ends and with a crown. Nodes of ladder index 0.
_WIDTH_RATIO, _LOAD_RATIO, _ROUNDED_CURVATURE_RATIO, _CROWNED_CURVATURE_RATIO = 2.0, 3.0, 4.0, 9.0
_GRID_HALF_WIDTH, _CURVATURE, _LOAD = 1e-4, 40.0, 1e5  # m, 1/m, N/m
_TABLED_MOMENT = 0.24  # greatest light moment over force and length
_FEW_ROWS = 3000  # rows of an interpolation: those of a turn, untilted and tilted to both sides

# Places along the line at which the drop of a crown decides the tables kept.
_LINE_POINTS = 2001
# Wider cells across for contacts that leave theirs: ratio, and how often at most.
_WIDER, _WIDENINGS = 2.0, 3
# Errors of the interpolation, verified by tests.
_ERROR, _LOADED_ERROR = 2e-3, 5e-3

GREATEST_MOMENT = 0.45
"""Greatest moment over force and length of contact: the force acts near the end."""
_HEAVY = (0.265, 0.29, 0.315, 0.34, 0.36, 0.38, 0.40, 0.415, 0.43, 0.44, GREATEST_MOMENT)


class _Ladder:
    """Moments over force and length of the rows of a node: of light tilts, up to `_HEAVY`.

    Parameters
    ----------
    light : int     number of light moments
    batches : int   numbers of moments from zero that are computed together

    Attributes: moments (n,), >= 0; signed (2 n - 1,), all; zero: number of the row of no moment.
    """

    def __init__(self, light: int, *batches: int) -> None:
        self.moments = np.concatenate([np.linspace(0.0, _TABLED_MOMENT, light), _HEAVY])
        self.signed: Array = np.concatenate([-self.moments[:0:-1], self.moments])
        self.zero = self.moments.size - 1
        self.batches = *batches, self.moments.size


# Where all moments have the same cells, one more costs next to nothing.
_SAME_CELLS, _OWN_CELLS = _Ladder(9, 1, 9), _Ladder(5, 1, 3, 5, 8, 12)


@dataclass(frozen=True, eq=False)
class FactorTable:
    """Axial pressure factors of a pair over half-width, moment and, for a crown, line load.

    mean_length (m) of the means at the ends; the curvature of the pair is not used.
    """

    pair: FinitePair
    mean_length: float
    _nodes: dict[tuple[int, int], _Node] = field(default_factory=dict, repr=False)
    _beside: list[FactorTable] = field(default_factory=list, repr=False)

    @property
    def interpolation_error(self) -> float:
        """Error of centre, greatest and mean pressure at a singular end, over the greatest.

        Up to a moment of 0.2 of force and length; three times that beyond.
        """
        return _LOADED_ERROR if self._depends_on_load else _ERROR

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
        edges, line = self.axial_pressure(curvature, force, moment)
        means, _ = length_contact.means_at_ends(edges, line, self.mean_length)
        centre = length_contact.at_middle(edges, line)
        return AxialFactors(centre, line.max(axis=1), means, self.mean_length)

    def axial_pressure(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Pressure along the middle of the line, x = 0, of `count` contacts: edges of the cells
        along y (count, m + 1), m, and pressures on them (count, m) over plane-strain p0.

        Inputs as those of `factors`.

        Raises
        ------
        InputError
            If an input is out of bounds, or a moment over force and length above `GREATEST_MOMENT`.
        """
        kappa, load, couple = _checked_inputs(curvature, force, moment)
        share = couple / (load * self.pair.contact_length)
        if not (np.abs(share) <= GREATEST_MOMENT).all():
            worst = int(np.argmax(np.abs(share)))
            most = GREATEST_MOMENT * load[worst] * self.pair.contact_length
            raise InputError("moment", float(couple[worst]), f"within {most:.4g} N m, near an end")
        signed, zero = self._ladder.signed, self._ladder.zero
        first, weights = _moment_stencil(signed, share)
        outermost = np.maximum(zero - first, first + weights.shape[1] - 1 - zero)
        place = self._place(kappa, load, np.where(share == 0, 1, outermost + 1))
        nodes, columns, values = place
        # Rows of the table: every node has one row per moment.
        columns = columns[:, :, None] * signed.size + (first[:, None] + np.arange(4))[:, None]
        values = values[:, :, None] * weights[:, None]
        flat = (load.size, -1)
        lines = _lines(tuple(nodes))
        interpolated = _weighted(columns.reshape(flat), values.reshape(flat), lines)
        ends = nodes[0].edges.shape[1]
        return interpolated[:, :ends], np.maximum(interpolated[:, ends:], 0.0)

    def of_one(self, curvature: float, force: float) -> tuple[Array, Array]:
        """Cell edges (m + 1,), m, along y and pressures (m,) over plane-strain p0 of one contact
        without a moment; solved directly where results depend on the load, as the table would need
        16 nodes.

        Parameters
        ----------
        curvature, force : float   1/R1 + 1/R2, 1/m; N
        """
        if not self._depends_on_load:
            return self.axial_pressure(curvature, force)
        pair = replace(self.pair, curvature=curvature)
        _, p0 = self._hertz(np.array([curvature]), np.array([force]))
        edges, line, _ = _solved(pair, force, np.zeros(1))
        return edges, line / p0

    def edges_of_line(self, curvature: float, force: float) -> Array:
        """Cell edges (m + 1,), m, along the whole line at a curvature, 1/m, and force, N."""
        half_width, _ = self._hertz(np.array([curvature]), np.array([force]))
        pair = replace(self.pair, curvature=curvature)
        return pressure_cells.edges_along(pair, float(half_width[0]), cycle_sizes(pair))

    def moment_at_tilt(
        self,
        curvature: ArrayLike,
        force: ArrayLike,
        tilt: ArrayLike,
        most: ArrayLike = np.inf,
        compliance: ArrayLike = 0.0,
    ) -> Array:
        """Moment (count,), N m, about y = 0 that tilted contacts exert, as half-spaces.

        Its amount is limited to `most` and to `GREATEST_MOMENT` of force and length.

        Parameters
        ----------
        curvature, force : array (count,)   1/R1 + 1/R2, 1/m; N
        tilt : array (count,)               of the bodies to each other without load, rad
        most : array (count,)               greatest moment, N m
        compliance : array (count,)         by which the supports yield to the moment, rad/(N m)
        """
        kappa, load, angle = _checked_inputs(curvature, force, tilt)
        length = load * self.pair.contact_length
        limit = np.minimum(most, GREATEST_MOMENT * length)
        if self.pair.is_symmetric and not (angle * limit).any():
            return np.zeros(load.size)
        half_width, _ = self._hertz(kappa, load)
        per_tilt = self.pair.contact_length / (kappa * half_width**2)
        target = angle * per_tilt
        yielding = (np.asarray(compliance) * length * per_tilt)[:, None] * self._ladder.signed
        ladder, rows = self._ladder, np.arange(load.size)
        batches = [count for count in ladder.batches if count > 1]
        count = np.full(load.size, batches[0])
        for more in [*batches[1:], 0]:
            nodes, columns, values = self._place(kappa, load, count)
            turns = _weighted(columns, values, np.array([node.turn for node in nodes])) + yielding
            # A target between the last two moments takes one more.
            inner = turns[rows, ladder.zero + 2 - count], turns[rows, ladder.zero - 2 + count]
            beyond = (target < inner[0]) | (target > inner[1])
            beyond &= ladder.moments[count - 2] * length < limit
            if not more or not beyond.any():
                break
            count = np.where(beyond, more, count)
        return np.clip(_inverse(ladder.signed, turns, target) * length, -limit, limit)

    @cached_property
    def _ladder(self) -> _Ladder:
        return _SAME_CELLS if isinstance(self.pair.crown, Straight) else _OWN_CELLS

    @property
    def _depends_on_load(self) -> bool:
        rounded = any(body.end.kind == "radius" for body in self.pair.bodies)
        return rounded or not isinstance(self.pair.crown, Straight)

    @property
    def _curvature_ratio(self) -> float:
        is_straight = isinstance(self.pair.crown, Straight)
        return _ROUNDED_CURVATURE_RATIO if is_straight else _CROWNED_CURVATURE_RATIO

    def _hertz(self, curvature: Array, force: Array) -> tuple[Array, Array]:
        return hertz.line_contact(
            force / self.pair.contact_length, 1.0 / curvature, self.pair.contact_modulus
        )

    def _place(self, curvature: Array, force: Array, count: Index) -> _Place:
        """Interpolation in the table: its nodes about the contacts, and for each contact the
        numbers of its nodes and their weights, both (contacts, k).

        Parameters
        ----------
        curvature, force : array (contacts,)   1/R1 + 1/R2, 1/m; N
        count : array (contacts,)              number of moments that each contact needs at its
            nodes; missing ones are computed
        """
        if self._depends_on_load:
            line_load = force / self.pair.contact_length
            first, first_weights = _uniform_stencil(curvature, _CURVATURE, self._curvature_ratio)
            second, load_weights = _uniform_stencil(line_load, _LOAD, _LOAD_RATIO)
        else:
            half_width, _ = self._hertz(curvature, force)
            first, first_weights = _uniform_stencil(half_width, _GRID_HALF_WIDTH, _WIDTH_RATIO)
            second, load_weights = np.zeros_like(first), np.ones((force.size, 1))
        size = load_weights.shape[1]
        least, span = second.min(), np.ptp(second) + 1
        corners, inverse = np.unique(first * span + (second - least), return_inverse=True)
        pairs = zip((corners // span).tolist(), (corners % span + least).tolist(), strict=True)
        reach = [[(a + i, b + j) for i in range(4) for j in range(size)] for a, b in pairs]
        most = np.zeros(len(reach), dtype=np.intp)
        np.maximum.at(most, inverse, count)
        needed: dict[tuple[int, int], int] = {}
        for cells, moments in zip(reach, most.tolist(), strict=True):
            for key in cells:
                needed[key] = max(needed.get(key, 0), moments)
        keys = sorted(needed)
        nodes = [self._node(key, needed[key]) for key in keys]
        number = {key: index for index, key in enumerate(keys)}
        columns = np.array([[number[key] for key in cells] for cells in reach])[inverse]
        weights = (first_weights[:, :, None] * load_weights[:, None, :]).reshape(columns.shape)
        return _Place(nodes, columns, weights)

    def _node(self, key: tuple[int, int], count: int) -> _Node:
        """Node of a key, see `_computed`, with at least `count` moments, counted from zero; missing
        ones are computed.
        """
        for before, after in pairwise((0, *self._ladder.batches)):
            if self._count(key) == before < count:
                moments = self._ladder.moments[before:after]
                for table in (self, *self._beside):
                    if table._count(key) == before:
                        table._extend(key, table._computed(key, moments))
        return self._nodes[key]

    def _count(self, key: tuple[int, int]) -> int:
        """Number of moments of a node that are computed."""
        return self._nodes[key].count if key in self._nodes else 0

    def _extend(self, key: tuple[int, int], computed: _Node) -> None:
        known = self._nodes.get(key)
        self._nodes[key] = computed if known is None else known.joined(computed)

    def _computed(self, key: tuple[int, int], moments: Array) -> _Node:
        """Node of the table for moments (k,), >= 0, over force and length; read from the disk cache
        or computed.

        It holds cell edges, m, pressure along the line over p0, and tilt times length of contact
        over curvature times squared half-width.

        Parameters
        ----------
        key : two ints   power of the ratio of neighbouring nodes of the half-width or, where
            results depend on the load, of the curvature; then that of the line load
        """
        line_load = _LOAD * _LOAD_RATIO ** key[1]
        per_curvature = 4.0 * line_load / (np.pi * self.pair.contact_modulus)
        if self._depends_on_load:
            curvature = _CURVATURE * self._curvature_ratio ** key[0]
            half_width = float(np.sqrt(per_curvature / curvature))
        else:
            half_width = _GRID_HALF_WIDTH * _WIDTH_RATIO ** key[0]
            curvature = per_curvature / half_width**2
        here = replace(self.pair, curvature=curvature)
        if not self.pair.is_symmetric:
            moments = np.concatenate([-moments[moments > 0][::-1], moments])

        def compute() -> dict[str, Array]:
            force = line_load * self.pair.contact_length
            edges, line, turn = _solved(here, force, moments * force * self.pair.contact_length)
            p0 = 0.5 * self.pair.contact_modulus * curvature * half_width
            turned = turn * self.pair.contact_length / (curvature * half_width**2)
            return {"edges": edges, "line": line / p0, "turn": turned}

        places = 0.5 * self.pair.contact_length * np.linspace(-1.0, 1.0, _LINE_POINTS)
        bodies = tuple(
            (body.material, body.length, body.end.kind, body.end.size) for body in self.pair.bodies
        )
        inputs = (
            half_width,
            line_load,
            self.pair.crown.drop(places).tobytes(),
            bodies,
            moments.tobytes(),
        )
        modules = (
            *(active_set, axial_drop, contact_span, half_space, length_contact, length_tiers),
            pressure_cells,
        )
        kept = disk_cache.kept("factors", inputs, compute, modules)
        return _Node.of(self._ladder, moments, kept["edges"], kept["line"], kept["turn"])


def _solved(pair: FinitePair, force: float, couples: Array) -> tuple[Array, Array, Array]:
    """Cell edges along y (count, m + 1), m, pressures on the centre line (count, m), Pa, and tilts
    (count,), rad, of a pair under a force, N, and moments `couples` (count,), N m; on wider cells
    where the contact leaves them.
    """
    sizes = cycle_sizes(pair)
    for _ in range(_WIDENINGS):
        try:
            return _solved_on(pair, force, couples, sizes)
        except WideContactError:
            sizes = replace(sizes, window=_WIDER * sizes.window)
    return _solved_on(pair, force, couples, sizes)


def _solved_on(
    pair: FinitePair, force: float, couples: Array, sizes: CellSizes
) -> tuple[Array, Array, Array]:
    """Results of `_solved` on cells of the sizes `sizes`.

    Raises
    ------
    WideContactError
        If the contact leaves the cells.
    """
    line, turn, ends, begin = [], [], [], None
    # Each contact begins with the cells that touch under the moment before.
    order = np.argsort(np.abs(couples), kind="stable")
    for couple in couples[order].tolist():
        cells = contact_span.contact_cells(pair, force, couple, sizes)
        if begin is None or begin.shape != cells.shape:
            begin = (cells.centres[0] < cells.x[int(sizes.per_half_width)]).reshape(cells.shape)
        contact = length_contact.solve(
            cells,
            half_space.shared_compliance(cells, pair.bodies),
            cells.integrated_gap(pair),
            force,
            moment=couple,
            guess=begin.ravel(),
        )
        begin = contact.pressure[0] > 0
        ends.append(cells.y)
        line.append(contact.centre_line[0])
        turn.append(contact.tilt[0])
    back = np.argsort(order)
    return np.array(ends)[back], np.array(line)[back], np.array(turn)[back]


class _Place(NamedTuple):
    """Nodes, columns and weights (count, k) of contacts."""

    nodes: list[_Node]
    columns: Index
    weights: Array


@dataclass(frozen=True, eq=False)
class _Node:
    """Edges (2 moments - 1, m + 1), m, along y; line (2 moments - 1, m) over p0, turn.

    The turn is the tilt times the length over curvature and half-width squared; not a number at
    moments that are not computed.
    """

    edges: Array
    line: Array
    turn: Array

    @classmethod
    def of(cls, ladder: _Ladder, moments: Array, edges: Array, line: Array, turn: Array) -> _Node:
        """Node with a row per signed moment of a ladder, filled where computed; rows of negative
        moments by symmetry where `moments` has none.

        Parameters
        ----------
        moments : array (p,)       over force and length, of the computed rows
        edges : array (p, m + 1)   of the cells along y, m
        line : array (p, m)        pressures over p0
        turn : array (p,)          scaled tilts, see the class
        """
        ends, lines = (np.zeros((ladder.signed.size, each.shape[1])) for each in (edges, line))
        turns = np.full(ladder.signed.size, np.nan)
        signs = (1,) if (moments < 0).any() else (-1, 1)
        for sign in signs:
            rows = np.searchsorted(ladder.signed, sign * moments - 1e-9)
            ends[rows], lines[rows] = sign * edges[:, ::sign], line[:, ::sign]
            turns[rows] = sign * turn
        return cls(ends, lines, turns)

    def joined(self, other: _Node) -> _Node:
        """The rows of both."""
        here = np.isfinite(self.turn)
        edges, line = (
            np.where(here[:, None], one, two)
            for one, two in ((self.edges, other.edges), (self.line, other.line))
        )
        return _Node(edges, line, np.where(here, self.turn, other.turn))

    @cached_property
    def count(self) -> int:
        """Number of moments from zero that are computed."""
        return int(np.isfinite(self.turn[self.turn.size // 2 :]).sum())


def factor_table(pair: FinitePair, mean_length: float) -> FactorTable:
    """Table of a pair of bodies; nodes come from the disk cache or are computed on demand.

    Parameters
    ----------
    pair : FinitePair     its curvature and the depths of its bodies are not used
    mean_length : float   of the means at the ends, m

    Raises
    ------
    InputError
        If the mean length is not within the length of contact.
    """
    if not 0 < mean_length <= pair.contact_length:
        shown, whole = (units.shown(each, "mm") for each in (mean_length, pair.contact_length))
        raise InputError("limits.end_mean_length", shown, f"> 0 and <= {whole}, the contact")
    return FactorTable(pair, mean_length)


def fill_together(tables: Sequence[FactorTable]) -> None:
    """Let tables of pairs that differ only in length share the computation of a node.

    Their cells are the same there: so is what does not depend on the lengths, see `half_space`.
    """
    for table in tables:
        table._beside[:] = [
            other for other in tables if other is not table and other.pair.crown == table.pair.crown
        ]


@lru_cache(maxsize=16)
def _lines(nodes: tuple[_Node, ...]) -> Array:
    """Edges and pressures of nodes side by side as rows."""
    return readonly(np.concatenate([np.hstack([node.edges, node.line]) for node in nodes]))


def _checked_inputs(*values: ArrayLike) -> list[Array]:
    """Curvatures, 1/m, forces, N, and a third input (moment or tilt), broadcast to arrays (count,).

    Raises
    ------
    InputError
        If a curvature or force is not positive, or a value not finite.
    """
    arrays = [np.atleast_1d(np.asarray(value, dtype=float)) for value in values]
    kappa, load, third = np.broadcast_arrays(*arrays)
    for name, each in (("curvature", kappa), ("force", load)):
        if not ((each > 0) & np.isfinite(each)).all():
            raise InputError(name, float(each[~((each > 0) & np.isfinite(each))][0]), "> 0")
    if not np.isfinite(third).all():
        raise InputError("moment or tilt", float(third[~np.isfinite(third)][0]), "finite")
    return [kappa, load, third]


def _uniform_stencil(values: Array, start: float, ratio: float) -> tuple[Index, Array]:
    """First index (count,) and Lagrange weights (count, 4) of values on a geometric ladder."""
    position = np.log(values / start) / np.log(ratio)
    base = np.floor(position).astype(np.intp)
    return base - 1, _lagrange(
        position - base, np.broadcast_to(np.arange(-1.0, 3.0), (base.size, 4))
    )


def _moment_stencil(signed: Array, share: Array) -> tuple[Index, Array]:
    """First row (count,) of four moments and their Lagrange weights (count, 4)."""
    after = np.searchsorted(signed, share, side="right")
    first = np.clip(after - 2, 0, signed.size - 4).astype(np.intp)
    return first, _lagrange(share, signed[first[:, None] + np.arange(4)])


def _lagrange(place: Array, nodes: Array) -> Array:
    """Weights (count, 4), by Lagrange, of the values at four nodes (count, 4) in the cubic through
    them at a place (count,).
    """
    weights = np.ones(nodes.shape)
    for i in range(4):
        for j in _others(i):
            weights[:, i] *= (place - nodes[:, j]) / (nodes[:, i] - nodes[:, j])
    return weights


def _others(i: int) -> Iterable[int]:
    return (j for j in range(4) if j != i)


def _weighted(columns: Index, weights: Array, table: Array) -> Array:
    """Weighted sums (count, m) of rows of a table (rows, m).

    Of many rows as a sparse matrix, whose import takes a tenth of a second; the sums are the same.

    Parameters
    ----------
    columns : array (count, k)   numbers of the rows of each sum
    weights : array (count, k)   of these rows
    """
    count, size = columns.shape
    if count > _FEW_ROWS:
        starts = np.arange(0, count * size + 1, size)
        matrix = scipy.sparse.csr_array(
            (weights.ravel(), columns.ravel(), starts), shape=(count, len(table))
        )
        return np.asarray(matrix @ table)
    sums, rows = np.zeros((2, count, table.shape[1]))
    for column, weight in zip(columns.T, weights.T, strict=True):
        np.take(table, column, axis=0, out=rows, mode="clip")  # unbuffered; none is out of bounds
        rows *= weight[:, None]
        sums += rows
    return sums


def _inverse(signed: Array, turns: Array, target: Array) -> Array:
    """Moments over force and length (count,) at which the scaled tilts `turns` (count, k), which
    rise with the moments `signed` (k,), are `target` (count,); cubic, clipped to the computed rows.
    """
    known = np.where(np.isfinite(turns), turns, np.where(signed < 0, -np.inf, np.inf))
    after = (known <= target[:, None]).sum(axis=1)
    low = np.argmax(np.isfinite(turns), axis=1)
    high = turns.shape[1] - 1 - np.argmax(np.isfinite(turns[:, ::-1]), axis=1)
    clipped = np.clip(after, low + 1, high)
    first = np.clip(clipped - 2, low, high - 3)
    rows = np.arange(target.size)
    knots = first[:, None] + np.arange(4)
    place = np.clip(target, known[rows, low], known[rows, high])
    weights = _lagrange(place, turns[rows[:, None], knots])
    moments = (weights * signed[knots]).sum(axis=1)
    return np.asarray(np.clip(moments, signed[clipped - 1], signed[clipped]))

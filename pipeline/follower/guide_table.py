"""Loads of the guides as tables over load and place, for many followers at once.

Stem and guides fixed, the guides know of the cam a side force and its moment about the middle of
guide A. Under a roller their loads over those of point supports are functions of side force,
overhang and spacing; under a flat face, whose axial force bends the stem by its couple as well,
their loads over the size of side force and moment are functions of that size, of the ratio of both
and of the spacing. They are solved at nodes and interpolated.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError
from camwright.pipeline.follower.follower_forces import Push, levers
from camwright.pipeline.follower.guide_reactions import (
    GuidePair,
    GuideReactions,
    guide_reactions,
)
from camwright.pipeline.follower.stem_beam import Stem

_FORCES = np.geomspace(0.1, 1e6, 155)
"""Nodes of the load, N: 22 a decade. Below the first the stem only tilts in its clearance."""
_OVERHANG_STEP = 0.03  # of the overhang over the spacing
_DIRECTION_STEP = np.pi / 120.0  # of the angle of moment over spacing against side force
_COUPLE_ALONE = 60.0  # steps of the direction: a right angle
_TOGETHER = 4  # nodes of a spacing that are solved at once
_SPACING_STEP = 0.03  # of the logarithm of the spacing


class GuideLoads(NamedTuple):
    """Loads of guides A and B, N, or per unit load, arrays (...).

    rubbing: sum of the pushes on both sides; bearing: see `GuideReactions`; net: the magnitude of
    the reaction.
    """

    rubbing_a: Array
    rubbing_b: Array
    bearing_a: Array
    bearing_b: Array
    net_a: Array
    net_b: Array


class Place(NamedTuple):
    """Interpolation nodes in overhang and spacing with weights, (2 or 4, ...)."""

    rows: NDArray[np.intp]
    weights: Array

    def of(self, positions: NDArray[np.intp]) -> Place:
        """Nodes and weights of some positions of the flattened arrays."""
        corners = self.rows.shape[0]
        rows, weights = self.rows.reshape(corners, -1), self.weights.reshape(corners, -1)
        return Place(rows[:, positions], weights[:, positions])


def _between_forces(load: Array) -> tuple[NDArray[np.intp], Array]:
    """Index of the node of the table below each load, and the part of the way to the next node, by
    the logarithm of the load; (...) each.

    Parameters
    ----------
    load : array (...)   N; bounded by the first and last node
    """
    bounded = np.clip(load, _FORCES[0], _FORCES[-1])
    at = np.log(bounded / _FORCES[0]) / np.log(_FORCES[1] / _FORCES[0])
    below = np.minimum(at.astype(np.intp), _FORCES.size - 2)
    return below, at - below


@dataclass(frozen=True, eq=False)
class GuideTable(ABC):
    """Interpolation tables of guide loads of a stem, rows computed on demand.

    The values depend on the stem and the guides alone, not on the places looked up before: nodes
    next to one another are solved together, those of one spacing in fixed groups.
    """

    stem: Stem
    guides: GuidePair
    _number: dict[tuple[int, int], int] = field(default_factory=dict)
    _tables: list[Array] = field(default_factory=list)
    _flats: dict[int, Array] = field(default_factory=dict)

    @abstractmethod
    def _nodes(self, along: NDArray[np.intp], guides: GuidePair) -> GuideLoads:
        """Loads over their units (nodes, forces) at nodes (nodes, 1), in guides of a spacing."""

    def between(self, along: Array, spacing: float | Array) -> Place:
        """Interpolation nodes with weights about places in overhang or direction, and spacing; for
        `ratios`.

        Parameters
        ----------
        along : array (...)              overhang or direction, in steps of the table
        spacing : float or array (...)   of the guides, m
        """
        steps, width = np.broadcast_arrays(along, spacing)
        if np.all(spacing == self.guides.spacing):
            across, share = np.full(steps.shape, _STATED), np.zeros(steps.shape)
        else:
            logarithm = np.log(width) / _SPACING_STEP
            across = np.floor(logarithm).astype(np.intp)
            share = logarithm - across
        below = np.floor(steps).astype(np.intp)
        part = steps - below
        rows, weights = [], []
        for up, weight in ((0, 1.0 - part), (1, part)):
            for beside, other in ((0, 1.0 - share), (1, share)):
                if beside and not share.any():
                    continue
                rows.append(self._rows(below + up, across + beside))
                weights.append(weight * other)
        return Place(np.stack(rows), np.stack(weights))

    def ratios(self, load: Array, place: Place) -> GuideLoads:
        """Loads over their units at loads (...), N, >= 0, and their places."""
        return GuideLoads(*self._interpolated(load, place, 6))

    def rubbing(self, load: Array, place: Place) -> tuple[Array, Array]:
        """Ratios of the rubbing loads alone."""
        on_a, on_b = self._interpolated(load, place, 2)
        return on_a, on_b

    def _interpolated(self, load: Array, place: Place, count: int) -> list[Array]:
        """The first `count` ratios of `GuideLoads` (...), interpolated: linear in the logarithm of
        the load and between the nodes of a place.

        Parameters
        ----------
        load : array (...)   N
        place : Place        nodes with weights
        count : int          number of ratios
        """
        below, part = _between_forces(load)
        tables = [self._flat(q) for q in range(count)]
        results = [np.zeros(load.shape) for _ in tables]
        for rows, weights in zip(place.rows, place.weights, strict=True):
            at = rows * _FORCES.size + below
            for q, table in enumerate(tables):
                low = table.take(at)
                results[q] += weights * (low + part * (table.take(at + 1) - low))
        return results

    def _flat(self, q: int) -> Array:
        """Ratio at all nodes of the tables solved so far, rows of forces one after another."""
        if q not in self._flats or self._flats[q].size != len(self._tables) * _FORCES.size:
            self._flats[q] = np.concatenate([table[q] for table in self._tables])
        return self._flats[q]

    def _rows(self, along: NDArray[np.intp], across: NDArray[np.intp]) -> NDArray[np.intp]:
        """Indices of the tables at nodes (...); nodes without a table are solved.

        Parameters
        ----------
        along : array (...)    node in overhang or direction
        across : array (...)   node in spacing
        """
        keys = np.stack([along, across], axis=-1).reshape(-1, 2)
        low = keys.min(axis=0)
        extent = keys.max(axis=0) - low + 1
        flat = (keys[:, 0] - low[0]) * extent[1] + (keys[:, 1] - low[1])
        needed = np.flatnonzero(np.bincount(flat))
        numbers = np.empty(extent[0] * extent[1], dtype=np.intp)
        for each in needed:
            key = int(low[0] + each // extent[1]), int(low[1] + each % extent[1])
            if key not in self._number:
                self._solve(*key)
            numbers[each] = self._number[key]
        return np.asarray(numbers[flat].reshape(along.shape))

    def _solve(self, along: int, across: int) -> None:
        """Solve a node of the table, and the others of its group, and keep the ratios of
        `GuideLoads` (6, forces).

        Parameters
        ----------
        along : int    node in overhang or direction
        across : int   node in spacing, or `_STATED`: that of the guides
        """
        guides = self.guides
        if across != _STATED:
            guides = replace(guides, spacing=float(np.exp(across * _SPACING_STEP)))
        group = along // _TOGETHER * _TOGETHER + np.arange(_TOGETHER)
        try:
            solved = self._nodes(group[:, None], guides)
        except ContactError:  # of another node of the group
            group = np.array([along])
            solved = self._nodes(group[:, None], guides)
        for k, node in enumerate(group.tolist()):
            if (node, across) not in self._number:
                self._number[node, across] = len(self._tables)
                self._tables.append(np.stack([ratio[k] for ratio in solved]))

    @property
    def _long(self) -> Stem:
        return replace(self.stem, length=np.inf)


class OverhangTable(GuideTable):
    """Guide loads over side force and overhang, in units of point-support reactions."""

    def _nodes(self, along: NDArray[np.intp], guides: GuidePair) -> GuideLoads:
        """Guide loads over the reactions of point supports (nodes, forces), under side forces
        alone.

        Parameters
        ----------
        along : array (nodes, 1)   overhang, in steps
        guides : GuidePair         at the spacing of the nodes
        """
        # The roller does not enter guide A: positions just outside take the node at its mouth.
        overhang = np.maximum(along * _OVERHANG_STEP * guides.spacing, 0.5 * guides.a.length)
        force, reach = np.broadcast_arrays(_FORCES, overhang)
        reactions = guide_reactions(force.ravel(), reach.ravel(), self._long, guides)
        on_a, on_b = (_FORCES * each for each in levers(overhang, guides.spacing))
        return _over(reactions, on_a, on_b)


class MomentTable(GuideTable):
    """Guide loads over size and direction of side force and moment over spacing."""

    def _nodes(self, along: NDArray[np.intp], guides: GuidePair) -> GuideLoads:
        """Guide loads over the size of the load (nodes, forces), under side force and moment.

        Parameters
        ----------
        along : array (nodes, 1)   direction of side force and moment over spacing, in steps
        guides : GuidePair         at the spacing of the nodes
        """
        angle = along * _DIRECTION_STEP
        side = np.ravel(_FORCES * np.cos(angle))
        moment = np.ravel(_FORCES * np.sin(angle) * guides.spacing)
        mouth = 0.5 * guides.a.length
        reach = np.full(side.size, mouth)
        reactions = guide_reactions(side, reach, self._long, guides, side * mouth - moment)
        units = np.broadcast_to(_FORCES, (along.size, _FORCES.size))
        return _over(reactions, units, units)


def _over(reactions: GuideReactions, on_a: Array, on_b: Array) -> GuideLoads:
    """Loads over their units (nodes, forces), N."""
    shape = on_a.shape
    return GuideLoads(
        rubbing_a=reactions.rubbing_load_a.reshape(shape) / on_a,
        rubbing_b=reactions.rubbing_load_b.reshape(shape) / on_b,
        bearing_a=reactions.bearing_load_a.reshape(shape) / on_a,
        bearing_b=reactions.bearing_load_b.reshape(shape) / on_b,
        net_a=np.abs(reactions.reaction_a).reshape(shape) / on_a,
        net_b=np.abs(reactions.reaction_b).reshape(shape) / on_b,
    )


_STATED = -(10**6)  # number of the spacing of the guides themselves


@lru_cache(maxsize=128)
def _table(kind: type[GuideTable], stem: Stem, guides: GuidePair) -> GuideTable:
    """Tables of a stem in guides, kept by both."""
    return kind(stem, guides)


def loads_under_couple(stem: Stem, guides: GuidePair, couple: Array, spacing: Array) -> GuideLoads:
    """Loads of the guides (...), N, under a couple on the stem (...), N m, alone.

    spacing : array (...)   of the guides, m
    """
    table, load = _table(MomentTable, stem, guides), couple / spacing
    ratios = table.ratios(load, table.between(np.full(load.shape, _COUPLE_ALONE), spacing))
    return GuideLoads(*(ratio * load for ratio in ratios))


@dataclass(frozen=True, eq=False)
class SupportOfMany:
    """Guide loads under many cams; arrays (...).

    load: that of the table over the axial force; factor: side-load factor; shares: units of the
    loads of guides A and B over axial force and side-load factor; on_points: rubbing loads of point
    supports over the same, those without load.
    """

    table: GuideTable
    place: Place
    load: Array
    factor: Array
    shares: tuple[Array, Array]
    on_points: tuple[Array, Array]

    @classmethod
    def of(cls, stem: Stem, guides: GuidePair, push: Push, overhang: Array) -> SupportOfMany:
        """Guide loads of a stem whose guides have the spacing of the push.

        Parameters
        ----------
        overhang : array (...)   m
        """
        factor, on_points = push.side_factor, push.rubbing_on_points(overhang)
        if not push.arm.any():
            table = _table(OverhangTable, stem, guides)
            nodes = table.between(overhang / push.spacing / _OVERHANG_STEP, push.spacing)
            return cls(table, nodes, factor, factor, on_points, on_points)
        _, moment = push.on_points(*levers(overhang, push.spacing))
        table = _table(MomentTable, stem, guides)
        nodes = table.between(np.arctan2(moment, push.side) / _DIRECTION_STEP, push.spacing)
        size = np.hypot(push.side, moment)
        share = np.divide(size, factor, out=np.ones_like(size), where=factor > 0.0)
        return cls(table, nodes, size, factor, (share, share), on_points)

    def rubbing(self, axial_force: Array) -> tuple[Array, Array]:
        """Rubbing loads over axial force and side-load factor at axial forces (...), N, >= 0."""
        ratios = self.table.rubbing(axial_force * self.load, self.place)
        on_a, on_b = (
            np.where(axial_force > 0.0, ratio * share, unloaded)
            for ratio, share, unloaded in zip(ratios, self.shares, self.on_points, strict=True)
        )
        return on_a, on_b

    def loads(self, axial_force: Array) -> GuideLoads:
        """Loads (...), N, at axial forces (...), N, >= 0."""
        ratios = self.table.ratios(axial_force * self.load, self.place)
        on_a, on_b = (share * (axial_force * self.factor) for share in self.shares)
        return GuideLoads(
            ratios.rubbing_a * on_a, ratios.rubbing_b * on_b,
            ratios.bearing_a * on_a, ratios.bearing_b * on_b,
            ratios.net_a * on_a, ratios.net_b * on_b,
        )  # fmt: skip
